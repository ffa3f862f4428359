"""Notebook 03: solutions of the student as translucent arms, and the steps of their Newton."""

from typing import Any

import numpy as np

from coursekit.kinematics import rotations
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import ZERO, Trouble, apart, gap, like_the_kr6

from .steps import ahead, alike, iterate, run, wrist


class Inverse(Explorer):
    """Notebook 03: solutions of the student as translucent arms, and the steps of their Newton."""

    T: Any
    shown: Any
    reached: bool
    theta: Any

    def yours(self, name: str, values: dict[str, Any]) -> str:
        """See `Explorer`."""
        sketch = self.sketch(name)
        if name == "newton_step":
            return self._newton(sketch, values["guess"])
        lengths, tool = like_the_kr6(self.robot)
        P = wrist(self.T, tool)
        if name == "wrist_centre":
            return sketch.point("P", self.mine.ask(name, self.T, tool), P)
        if not self.reached:
            raise Trouble("the target is out of reach: there is no solution to find")
        t1, t2, t3 = self.shown[:3]
        if name == "all_solutions":
            thetas = self.mine.ask(name, self.T, lengths, tool)
        elif name == "elbow_solutions":
            r = float(P @ rotations.rotz(-t1)[:, 0])
            thetas = [[t1, *pair, *self.shown[3:]] for pair in self.mine.ask(name, r, float(P[2]), lengths)]
        else:
            R = (rotations.rotz(-t1) @ rotations.roty(t2 + t3)).T @ self.T[:3, :3]
            thetas = [[t1, t2, t3, *angles] for angles in self.mine.ask(name, R)]
        thetas = np.array(thetas)
        reached = self.robot.fk(thetas)
        distance, angle = apart(reached, self.T)
        if name == "elbow_solutions":  # the hand is not theirs
            distance, angle = np.linalg.norm(wrist(reached, tool) - P, axis=-1), 0 * distance
            ends, goal = wrist(reached, tool), P
        else:
            ends, goal = reached[:, :3, 3], self.T[:3, 3]
        off, worst = np.flatnonzero((distance > ZERO) | (angle > ZERO)), int(np.argmax(distance + angle))
        sketch.arms(self.robot, thetas[off])
        for k in range(len(thetas)):
            sketch.gap(f"gap{k}", goal, ends[k] if k in off else goal, k == worst)
        words = self._found(thetas, name)
        if not off.size:
            return f"{words}, each hits the target, below 1e-9"
        return (
            f"{words}; {off.size} of your {len(thetas)} miss the target, solution {worst + 1} "
            f"by {gap(distance[worst], angle[worst])}"
        )

    def _found(self, thetas, name):
        """How many of the right solutions are among the student's."""
        right = np.array([theta for theta in self.theta if not np.isnan(theta).any()])
        if name == "elbow_solutions":
            right = right[alike(right[:, :1], self.shown[:1])][:, 1:3]
            thetas = thetas[:, 1:3]
        if name == "wrist_angles":
            right = right[alike(right[:, :3], self.shown[:3])]
        found = [bool(alike(thetas, theta).any()) for theta in right]
        if name == "elbow_solutions":  # each stands there twice, once for each wrist
            found = found[::2] if len(found) > 2 else found
        return f"{sum(found)} of {len(found)} solutions found"

    def _newton(self, sketch, guess):
        robot, theta = self.robot, np.array(guess, float)
        first = np.linalg.pinv(robot.jacobian_body(theta)) @ ahead(robot, theta, self.T)
        thetas, error = iterate(
            robot,
            theta,
            self.T,
            lambda theta: self.mine.ask("newton_step", robot.jacobian_body(theta), robot.fk(theta), self.T),
        )
        sketch.way(robot.fk(thetas)[:, :3, 3])
        off = np.abs(thetas[1] - thetas[0] - first).max() if len(thetas) > 1 else 0.0
        return run(thetas, error, off)
