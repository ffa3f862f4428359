"""Notebook 05: a column of the student, their ellipsoids, and their damped steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from coursekit.kinematics import ik, jacobians
from coursekit.view.controls import Action, Control
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import ZERO, Trouble, size

from .steps import ahead, iterate, run


class Jacobians(Explorer):
    """Notebook 05: a column of the student, their ellipsoids, and their damped steps."""

    run: Any
    start: Any
    target: Any
    scale: Any
    running: bool
    draw: Any

    def more(self) -> Sequence[Control]:
        """See `Explorer`."""
        self.run = None
        return [Action("mine", "play yours", self._play)] if "dls_step" in self.mine.functions else []

    def yours(self, name: str, values: dict[str, Any]) -> str:
        """See `Explorer`."""
        theta, sketch = values["theta"], self.sketch(name)
        if name == "ellipsoid":
            return self._ellipsoids(sketch, values)
        if name == "dls_step":
            return self._damped(sketch, values["damping"])
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

    def _damped(self, sketch, damping):
        robot, rows = self.robot, slice(0 if self.robot.n > 5 else 3, 6)
        self.run = None
        first = ik.dls_step(
            robot.jacobian_body(self.start)[rows], ahead(robot, self.start, self.target)[rows], damping
        )

        def step(theta):
            J, e = robot.jacobian_body(theta)[rows], ahead(robot, theta, self.target)[rows]
            return self.mine.ask("dls_step", J, e, damping)

        self.run, error = iterate(robot, self.start, self.target, step, 1e-8, rows)
        sketch.way(robot.fk(self.run)[:, :3, 3])
        off = np.abs(self.run[1] - self.run[0] - first).max() if len(self.run) > 1 else 0.0
        return run(self.run, error, off)

    def _play(self):
        if self.run is not None:
            self.running = True
            self.panel.play(self.run, fps=2.0, follow=self.draw)
