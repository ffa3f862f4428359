"""Notebook 05: a column of the student, their ellipsoids, their torques, and their damped steps."""

import numpy as np

from coursekit.kinematics import ik, jacobians, lie
from coursekit.view import text
from coursekit.view.controls import Action
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import COLOR, ZERO, Trouble, apart, size

from .steps import STEPS, THERE, ahead, iterate, run

LOAD = 100.0  # N
TWIST = 10.0  # N m, about y
FAINT = 0.06  # where both ellipsoids agree, the colour seen is that of the right one


class Jacobians(Explorer):
    """Notebook 05: a column of the student, their ellipsoids, their torques, and their damped steps."""

    def _more(self):
        self.run, self.rows = None, slice(0 if self.robot.n > 5 else 3, 6)
        runs = {"dls_step", "dls_loop"} & set(self.mine.functions)
        return [Action("mine", "play yours", self._play)] if runs else []

    def _is_ready(self, _name):
        return self.run is not None

    def _jacobian_space(self, sketch, values):
        robot, theta = self.robot, values["theta"]
        mine = self.mine.ask("jacobian_space", robot.S, theta)
        at_tool = mine[3:] + np.cross(mine[:3].T, robot.fk(theta)[:3, 3]).T  # what it does by these columns
        return self._columns(sketch, theta, np.vstack([mine[:3], at_tool]))

    def _jacobian_geometric(self, sketch, values):
        robot, theta = self.robot, values["theta"]
        if "prismatic" in robot.joint_types:
            raise Trouble(f"it is for joints that turn, and one of {robot.name} slides")
        w, v = np.split(robot.jacobian_space(theta).T, 2, axis=1)
        mine = self.mine.ask("jacobian_geometric", w.copy(), np.cross(w, v), robot.fk(theta)[:3, 3])
        return self._columns(sketch, theta, mine)

    def _jacobian_by_differences(self, sketch, values):
        mine = self.mine.ask("jacobian_by_differences", self.robot.fk, values["theta"], 1e-5)
        return self._columns(sketch, values["theta"], mine, bound=1e-6)

    def _jacobian_column(self, sketch, values):
        """By the student's column of J_b, which is turned into the directions of the base."""
        robot, theta = self.robot, values["theta"]
        T, columns = robot.fk(theta), []
        for kind, screw in zip(robot.joint_types, robot.jacobian_space(theta).T, strict=True):
            w, v = np.split(screw, 2)
            axis = (w, np.cross(w, v)) if kind == "revolute" else (v, np.zeros(3))
            column = self.mine.ask("jacobian_column", kind, *axis, T)
            columns.append(np.concatenate([T[:3, :3] @ column[:3], T[:3, :3] @ column[3:]]))
        return self._columns(sketch, theta, np.array(columns).T)

    def _transform_rate(self, sketch, values):
        """By the student's rate of T = T_left e^[S]theta T_right."""
        robot, theta = self.robot, values["theta"]
        before = np.array([np.eye(4), *robot.displacements(theta)])
        parts = zip(before, robot.S.T, theta, lie.inverse(before[1:]) @ robot.fk(theta), strict=False)
        columns = [self.mine.ask("transform_rate", T, S.copy(), q, after)[1] for T, S, q, after in parts]
        return self._columns(sketch, theta, np.array(columns).T)

    def _columns(self, sketch, theta, mine, bound=ZERO):
        """The first column that is off: the velocity of the tool by the student's and by the right one."""
        right, tool = self.robot.jacobian_geometric(theta), self.robot.fk(theta)[:3, 3]
        if mine.shape != right.shape:
            raise Trouble(f"it returns shape {mine.shape}, expected {right.shape}")
        off = np.flatnonzero(np.abs(mine - right).max(axis=0) > bound)
        if not off.size:
            self.scene.remove(sketch.path)
            return f"every column agrees, below {bound:.0e}".replace("e-0", "e-")
        k = int(off[0])
        (w, v), (right_w, right_v) = np.split(mine[:, k], 2), np.split(right[:, k], 2)
        turns = np.linalg.norm(v - right_v) <= bound  # then omega is what there is to see
        yours, correct = (w, right_w) if turns else (v, right_v)
        scale = 0.35 * self.scene.size / max(np.linalg.norm(yours), np.linalg.norm(correct))
        what = f"{'omega' if turns else 'v'} of joint {k + 1}"
        sketch.arrow("mine", tool, scale * yours, f"{sketch.label}: {what}")
        sketch.arrow("right", tool, scale * correct, what, "bone")
        listed = ", ".join(str(i + 1) for i in off)
        return (
            f"off: columns {listed}. Joint {k + 1}: omega by {size(np.linalg.norm(w - right_w))}, the tool's "
            f"velocity by {size(1000 * np.linalg.norm(v - right_v))} mm/s at 1 rad/s"
        )

    def _torques(self, sketch, values):
        """What the joints must give for a force that the tool gives downwards, and a moment about y."""
        theta = values["theta"]
        T, moment, force = self.robot.fk(theta), np.array([0, TWIST, 0]), np.array([0, 0, -LOAD])
        right = self.robot.jacobian_geometric(theta).T @ np.concatenate([moment, force])
        units = ["N m" if kind == "revolute" else "N" for kind in self.robot.joint_types]
        load = f"for {LOAD:.0f} N downwards and {TWIST:.0f} N m about y"
        mine = self.mine.ask("torques", self.robot.jacobian_body(theta), T, moment, force)
        if mine.shape != right.shape:
            raise Trouble(f"it returns shape {mine.shape}, expected {right.shape}")
        sketch.arrow("force", T[:3, 3], 0.3 * self.scene.size * force / LOAD, f"{LOAD:.0f} N")
        off, k = np.abs(mine - right), int(np.abs(right).argmax())
        if off.max() <= ZERO * LOAD:
            most = f"joint {k + 1} gives most, {text.number(right[k], 1)} {units[k]}"
            return f"{load} every torque agrees, below 1e-9; {most}"
        i = int(np.flatnonzero(off > ZERO * LOAD)[0])
        told = f"{text.number(mine[i], 1)} {units[i]}, the right one is {text.number(right[i], 1)}"
        return f"{load} joint {i + 1} gives {told}"

    def _ellipsoid(self, sketch, values):
        theta, words = values["theta"], []
        J, tool = self.robot.jacobian_geometric(theta), self.robot.fk(theta)[:3, 3]
        for part, rows in (("linear", J[3:]), ("angular", J[:3])):
            lengths, axes = self.mine.ask("ellipsoid", rows.copy())
            right = np.sort(jacobians.ellipsoid(J, part).lengths)[::-1]
            is_frame = np.abs(axes.T @ axes - np.eye(3)).max() < 1e-6
            half = self.scale[part] * lengths
            if values[part] and is_frame and half.max() < self.scene.size and (lengths >= 0).all():
                self.scene.ellipsoid(f"{sketch.path}/{part}", axes, half, tool, COLOR, FAINT)
            else:
                self.scene.remove(f"{sketch.path}/{part}")
            off = np.abs(lengths - right).max()
            turned = np.abs(axes * lengths**2 @ axes.T - rows @ rows.T).max()
            if not is_frame:
                words.append(f"{part}: your directions are not three of length 1 at right angles")
            elif off > ZERO:
                words.append(f"{part}: half axes off by up to {size(off)}")
            elif turned > ZERO:
                words.append(f"{part}: the half axes are right, their directions are not")
            else:
                words.append(f"{part}: below 1e-9")
        return "; ".join(words)

    def _dls_step(self, sketch, values):
        def step(theta):
            return self.mine.ask("dls_step", *self._task(theta), values["damping"])

        self.run = None
        steps = iterate(self.robot, self.start, self.target, step, THERE, self.rows)
        return self._damped(sketch, values, *steps)

    def _dls_loop(self, sketch, values):
        """The student's run, until it stays at the target or runs away, and what is left at its end."""
        self.run, wanted = None, (STEPS + 1, self.robot.n)
        thetas = self.mine.ask("dls_loop", self.robot, self.target, self.start, values["damping"], STEPS)
        if thetas.shape != wanted:
            raise Trouble(f"it returns shape {thetas.shape}, expected {wanted}")
        if np.abs(thetas[0] - self.start).max() > ZERO:
            raise Trouble("its first row is not where the arm stands")
        far = np.flatnonzero(np.abs(thetas).max(axis=1) > 1e4)
        if far.size:
            return self._damped(sketch, values, thetas[: far[0]], None)
        distance, angle = apart(self.robot.fk(thetas), self.target)
        missing = np.flatnonzero(np.fmax(distance, angle) >= THERE)
        end = min(STEPS, missing[-1] + 1 if missing.size else 0)
        return self._damped(sketch, values, thetas[: end + 1], (float(angle[end]), float(distance[end])))

    def _task(self, theta):
        """J_b and the twist to the target, in the rows that count."""
        return self.robot.jacobian_body(theta)[self.rows], ahead(self.robot, theta, self.target)[self.rows]

    def _damped(self, sketch, values, thetas, left):
        self.run = thetas
        sketch.way(self.robot.fk(thetas)[:, :3, 3])
        return run(thetas, left, ik.dls_step(*self._task(self.start), values["damping"]))

    def _play(self):
        self.playing = "yours"
        self.panel.play(self.run, fps=2.0, follow=self.draw)
