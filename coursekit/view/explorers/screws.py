"""Notebook 02: one joint after the other at the home pose, from the axis and a point on it to the screw."""

import numpy as np

from coursekit.kinematics import dh, lie, robots
from coursekit.kinematics.robot import Robot
from coursekit.view import text
from coursekit.view.controls import Choice, Slider
from coursekit.view.explorers import Explorer
from coursekit.view.panel import Panel


def explore_screws(robot: Robot | None = None, height: int = 470) -> Panel:
    """Open the explorer of screws: a joint axis, a point q on it, v = -w x q, and the column of S or B.

    The arm stands at zero and only the chosen joint turns. The point q can be slid along its axis, and the
    screw can be looked at from the space frame, from the tool, or from where the last two axes meet.

    Parameters
    ----------
    robot : Robot, optional
        An arm with revolute joints; the KUKA KR6 where none is given. ValueError for a sliding joint.
    """
    robot = robots.kuka_kr6() if robot is None else robot
    if "prismatic" in robot.joint_types:
        raise ValueError(f"{robot.name} has a prismatic joint: this explorer shows revolute joints only")
    return _Screws(robot).open(height)


class _Screws(Explorer):
    name, title = "screws", "Explorer of screws"

    def __init__(self, robot):
        super().__init__(robot)
        self.frames = _frames(robot)
        self.turn = Slider("turn", 0.0, -np.pi, np.pi, unit="deg", label="turn this joint")
        self.origins = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
        self.arm = self.scene.robot(robot, np.zeros(robot.n))
        self.arm.look(solid=True, skeleton=True)

    def controls(self):
        return [
            Choice("joint", {f"joint {i + 1}": i for i in range(self.robot.n)}, start="joint 2"),
            Choice("frame", self.frames, label="seen from"),
            Slider("slide", 0.0, -0.3, 0.3, unit="mm", label="q along the axis"),
            self.turn,
        ]

    def drivers(self, values):
        return [self.turn if k == values["joint"] else None for k in range(self.robot.n)]

    def update(self, values):
        i, scene = values["joint"], self.scene
        self.S = self.robot.S[:, i]
        w, v = self.S[:3], self.S[3:]
        nearest = np.cross(w, v)
        self.q = nearest + w * (w @ (self.origins[i] - nearest) + values["slide"])
        self.arm.theta = values["turn"] * np.eye(self.robot.n)[i]
        letter, T = values["frame"]
        scene.screw_axis("/ck/axis", self.S, label=f"S{i + 1}", at=self.q)
        scene.point("/ck/q", self.q, "q", color="accent")
        scene.frame("/ck/seen", T, letter=letter, size=0.14 * scene.size)
        scene.line("/ck/lever", T[:3, 3], self.q)
        scene.arrow("/ck/v", T[:3, 3], v + np.cross(w, T[:3, 3]), color="trace", label="v")

    def words(self, values):
        i, (letter, T) = values["joint"], values["frame"]
        seen = lie.adjoint(lie.inverse(T)) @ self.S
        q_seen = (lie.inverse(T) @ [*self.q, 1])[:3]
        name = "S" if letter == "s" else "B"
        tool = self.robot.fk(self.arm.theta)[:3, 3]
        return "\n".join(
            [
                f"joint {i + 1} of {self.robot.name}, seen from frame {{{letter}}}",
                f"direction w = {text.row(seen[:3])}    point q = {text.millimetres(q_seen)}",
                f"v = -w x q = {text.row(1000 * seen[3:], 1)} mm per rad, of the point at {{{letter}}}",
                f"column {i + 1} of {name} = {text.row(seen)}    (w; v), v in metres",
                f"tool at {text.millimetres(tool)} after {text.degrees(values['turn'])}",
            ]
        )


def _frames(robot):
    """Label -> (letter, pose at zero) of the frames from which a screw can be seen."""
    frames = {"space frame: S": ("s", np.eye(4)), "flange frame: B": ("b", robot.M)}
    if robot.n > 2:
        _, _, on_last, on_before = dh.common_normal(robot.S[:, -1], robot.S[:, -2])
        if np.linalg.norm(on_last - on_before) < 1e-9:
            wrist = robot.M.copy()
            wrist[:3, 3] = on_last
            frames["wrist frame: B of the wrist"] = ("w", wrist)
    return frames
