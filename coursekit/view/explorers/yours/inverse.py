"""Notebook 03: solutions of the student as translucent arms, and the steps of their Newton."""

import numpy as np

from coursekit.kinematics import rotations
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import ZERO, Trouble, apart, gap, like_the_kr6

from .steps import ahead, alike, iterate, run, wrist


class Inverse(Explorer):
    """Notebook 03: solutions of the student as translucent arms, and the steps of their Newton."""

    def _wrist_centre(self, sketch, _values):
        _, tool = like_the_kr6(self.robot)
        return sketch.point("P", self.mine.ask("wrist_centre", self.T, tool), wrist(self.T, tool))

    def _all_solutions(self, sketch, _values):
        lengths, tool, right = self._solved()
        thetas = self.mine.ask("all_solutions", self.T, lengths, tool)
        return self._solutions(sketch, thetas, self.robot.fk(thetas), self.T, _found(thetas, right))

    def _wrist_angles(self, sketch, _values):
        _, _, right = self._solved()
        t1, t2, t3 = arm = self.shown[:3]
        R = (rotations.rotz(-t1) @ rotations.roty(t2 + t3)).T @ self.T[:3, :3]
        thetas = np.array([[*arm, *angles] for angles in self.mine.ask("wrist_angles", R)])
        found = _found(thetas, right[alike(right[:, :3], arm)])
        return self._solutions(sketch, thetas, self.robot.fk(thetas), self.T, found)

    def _elbow_solutions(self, sketch, _values):
        lengths, tool, right = self._solved()
        t1, P = self.shown[0], wrist(self.T, tool)
        r = float(P @ rotations.rotz(-t1)[:, 0])
        pairs = self.mine.ask("elbow_solutions", r, float(P[2]), lengths)
        thetas = np.array([[t1, *pair, *self.shown[3:]] for pair in pairs])
        ends, goal = np.tile(np.eye(4), (2, 1, 1)), np.eye(4)  # wrists without a hand: that is not theirs
        ends[:, :3, 3], goal[:3, 3] = wrist(self.robot.fk(thetas), tool), P
        found = _found(pairs, right[alike(right[:, :1], self.shown[:1])][:, 1:3])
        found = found[::2] if len(found) > 2 else found  # each stands there twice, once for each wrist
        return self._solutions(sketch, thetas, ends, goal, found)

    def _solved(self):
        """Lengths, tool and solutions (k, 6) of an arm like the KR6; Trouble for others, and out of reach."""
        lengths, tool = like_the_kr6(self.robot)
        if not self.reached:
            raise Trouble("the target is out of reach: there is no solution to find")
        return lengths, tool, self.theta[~np.isnan(self.theta).any(axis=1)]

    def _solutions(self, sketch, thetas, ends, goal, found):
        """Those of the student's that miss: they end at `ends` (k, 4, 4), not at `goal` (4, 4)."""
        distance, angle = apart(ends, goal)
        off, worst = np.flatnonzero((distance > ZERO) | (angle > ZERO)), int(np.argmax(distance + angle))
        sketch.arms(self.robot, thetas[off])
        for k, end in enumerate(ends):
            sketch.gap(f"gap{k}", goal[:3, 3], (end if k in off else goal)[:3, 3], k == worst)
        words = f"{sum(found)} of {len(found)} solutions found"
        if not off.size:
            return f"{words}, each hits the target, below 1e-9"
        miss = f"{off.size} of your {len(thetas)} miss the target, solution {worst + 1}"
        return f"{words}; {miss} by {gap(distance[worst], angle[worst])}"

    def _newton_step(self, sketch, values):
        robot, theta, T = self.robot, values["guess"], self.T

        def step(theta):
            return self.mine.ask("newton_step", robot.jacobian_body(theta), robot.fk(theta), T)

        first = np.linalg.pinv(robot.jacobian_body(theta)) @ ahead(robot, theta, T)
        thetas, left = iterate(robot, theta, T, step)
        sketch.way(robot.fk(thetas)[:, :3, 3])
        return run(thetas, left, first)


def _found(thetas, right):
    """Which of the right solutions (k, n) are among the student's."""
    return [bool(alike(thetas, theta).any()) for theta in right]
