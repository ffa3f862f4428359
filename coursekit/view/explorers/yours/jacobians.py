"""Notebook 05: a column of the student, their ellipsoids, their torques, and their damped steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from coursekit.kinematics import ik, jacobians, lie
from coursekit.view import text
from coursekit.view.controls import Action, Control
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import ZERO, Trouble, apart, size

from .steps import STEPS, ahead, iterate, run

LOAD = 100.0  # N
TWIST = 10.0  # N m, about y


class Jacobians(Explorer):
    """Notebook 05: a column of the student, their ellipsoids, their torques, and their damped steps."""

    run: Any
    start: Any
    target: Any
    scale: Any
    running: bool
    draw: Any

    def more(self) -> Sequence[Control]:
        """See `Explorer`."""
        self.run = None
        runs = {"dls_step", "dls_loop"} & set(self.mine.functions)
        return [Action("mine", "play yours", self._play)] if runs else []

    def yours(self, name: str, values: dict[str, Any]) -> str:
        """See `Explorer`."""
        theta, sketch = values["theta"], self.sketch(name)
        if name == "ellipsoid":
            return self._ellipsoids(sketch, values)
        if name in ("dls_step", "dls_loop"):
            return self._damped(sketch, name, values["damping"])
        if name == "torques":
            return self._torques(sketch, theta)
        return self._columns(sketch, name, theta)

    def _columns(self, sketch, name, theta):
        robot, bound = self.robot, ZERO
        right, tool = robot.jacobian_geometric(theta), robot.fk(theta)[:3, 3]
        in_space = robot.jacobian_space(theta)
        if name == "jacobian_space":
            mine = self.mine.ask(name, robot.S, theta)
        elif name == "jacobian_geometric":
            if "prismatic" in robot.joint_types:
                raise Trouble(f"it is for joints that turn, and one of {robot.name} slides")
            axes = in_space[:3].T.copy()
            mine = self.mine.ask(name, axes, np.cross(axes, in_space[3:].T), tool)
        elif name in ("jacobian_column", "transform_rate"):
            by_joint = self._by_column if name == "jacobian_column" else self._by_rate
            mine = np.array(list(by_joint(theta, in_space))).T
        else:
            bound = 1e-6
            mine = self.mine.ask(name, robot.fk, theta, 1e-5)
        if mine.shape != right.shape:
            raise Trouble(f"it returns shape {mine.shape}, expected {right.shape}")
        if name == "jacobian_space":  # what the tool does by these columns
            mine = np.vstack([mine[:3], mine[3:] + np.cross(mine[:3].T, tool).T])
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

    def _by_column(self, theta, in_space):
        """The columns along the base, by the student's column of J_b."""
        T = self.robot.fk(theta)
        for kind, screw in zip(self.robot.joint_types, in_space.T, strict=True):
            w, v = np.split(screw, 2)
            axis = (w, np.cross(w, v)) if kind == "revolute" else (v, np.zeros(3))
            column = self.mine.ask("jacobian_column", kind, *axis, T)
            yield np.concatenate([T[:3, :3] @ column[:3], T[:3, :3] @ column[3:]])

    def _by_rate(self, theta, _in_space):
        """The columns along the base, by the student's rate of T = T_left e^[S]theta T_right."""
        before = np.array([np.eye(4), *self.robot.displacements(theta)])
        after = lie.inverse(before[1:]) @ self.robot.fk(theta)
        for left, S, angle, right in zip(before, self.robot.S.T, theta, after, strict=False):
            yield self.mine.ask("transform_rate", left, S.copy(), angle, right)[1]

    def _torques(self, sketch, theta):
        """What the joints must give for a force that the tool gives downwards, and a moment about y."""
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

    def _ellipsoids(self, sketch, values):
        theta, words = values["theta"], []
        J, tool = self.robot.jacobian_geometric(theta), self.robot.fk(theta)[:3, 3]
        for part, rows in (("linear", J[3:]), ("angular", J[:3])):
            lengths, axes = self.mine.ask("ellipsoid", rows.copy())
            right = np.sort(jacobians.ellipsoid(J, part).lengths)[::-1]
            is_frame = np.abs(axes.T @ axes - np.eye(3)).max() < 1e-6
            near = np.abs(self.scale[part] * lengths).max() < self.scene.size
            if values[part] and is_frame and near and (lengths >= 0).all():
                sketch.ellipsoid(part, axes, self.scale[part] * lengths, tool)
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

    def _damped(self, sketch, name, damping):
        robot, rows = self.robot, slice(0 if self.robot.n > 5 else 3, 6)
        self.run = None
        first = ik.dls_step(
            robot.jacobian_body(self.start)[rows], ahead(robot, self.start, self.target)[rows], damping
        )

        def step(theta):
            J, e = robot.jacobian_body(theta)[rows], ahead(robot, theta, self.target)[rows]
            return self.mine.ask(name, J, e, damping)

        if name == "dls_loop":
            self.run, error = self._loop(damping)
        else:
            self.run, error = iterate(robot, self.start, self.target, step, 1e-8, rows)
        sketch.way(robot.fk(self.run)[:, :3, 3])
        off = np.abs(self.run[1] - self.run[0] - first).max() if len(self.run) > 1 else 0.0
        return run(self.run, error, off)

    def _loop(self, damping):
        """The student's whole run, as far as it stays finite, and what is left at its end."""
        thetas = self.mine.ask("dls_loop", self.robot, self.target, self.start, damping, STEPS)
        if thetas.shape != (STEPS + 1, self.robot.n):
            raise Trouble(f"it returns shape {thetas.shape}, expected {(STEPS + 1, self.robot.n)}")
        if np.abs(thetas[0] - self.start).max() > ZERO:
            raise Trouble("its first row is not where the arm stands")
        far = np.flatnonzero(np.abs(thetas).max(axis=1) > 1e4)
        if far.size:
            return thetas[: far[0]], None
        distance, angle = apart(self.robot.fk(thetas[-1]), self.target)
        return thetas, (float(angle), float(distance))

    def _play(self):
        if self.run is not None:
            self.playing = "yours"
            self.panel.play(self.run, fps=2.0, follow=self.draw)
