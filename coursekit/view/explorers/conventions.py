"""Notebook 01: one arm by three conventions, and their frames side by side."""

import numpy as np

from coursekit.kinematics import robots
from coursekit.kinematics.robot import Robot
from coursekit.view.controls import Choice, Toggle, joint_sliders
from coursekit.view.explorers import Explorer
from coursekit.view.panel import Panel


def explore(robot: Robot | None = None, height: int = 470) -> Panel:
    """Open the explorer of standard DH, modified DH and the product of exponentials.

    Sliders move the arm; switches show the frames that standard DH and modified DH attach to its links, the
    screw axes of the product of exponentials, and the skeleton in place of the paint. The text gives the tool
    pose by all three and the largest difference between any two of their matrix entries.

    Parameters
    ----------
    robot : Robot, optional
        One arm. Without it the explorer offers every arm of the catalogue that has a DH table.
    """
    arms = [robot] if robot else [arm for arm in robots.all().values() if _tables(arm)]
    return _Conventions(arms).open(height)


class _Conventions(Explorer):
    name, title = "conventions", "Explorer of DH and PoE"

    def __init__(self, arms):
        super().__init__(arms[0])
        self.arms = {arm.name: arm for arm in arms}
        self.joints = joint_sliders(max(arms, key=lambda arm: arm.n))
        self.show(self.robot)

    def controls(self):
        picker = [Choice("robot", self.arms)] if len(self.arms) > 1 else []
        switches = {"standard": "standard DH frames", "modified": "modified DH frames"}
        switches |= {"screws": "screw axes", "skeleton": "skeleton"}
        return [*picker, self.joints, *(Toggle(name, label) for name, label in switches.items())]

    def show(self, robot):
        """The arm with its tool frame and both sets of DH frames, each fixed to a link."""
        self.robot, scene = robot, self.scene
        scene.remove("/ck/robot")
        self.arm = scene.robot(robot)
        scene.frame(self.arm.link(robot.n) + "/tool", robot.M, letter="tool")
        self.frames = {}
        for name, table in _tables(robot).items():
            poses = [table.base, *table.frames(np.zeros(robot.n))]
            self.frames[name] = [
                scene.frame(f"{self.arm.link(k)}/{name}", T, letter=f"{name[0]}{k}", size=0.1 * scene.size)
                for k, T in enumerate(poses)
            ]
        self.joints.fit(robot)

    def update(self, values):
        if values.get("robot", self.robot) is not self.robot:
            self.show(values["robot"])
        self.arm.theta = self.joints.get()
        self.arm.look(solid=not values["skeleton"], skeleton=values["skeleton"])
        self.arm.show_axes(values["screws"])
        for name, frames in self.frames.items():
            for frame in frames:
                frame.show(values[name])

    def words(self, values):
        """The tool pose by every convention the robot has, and how far they are apart."""
        theta = values["theta"]
        poses = {"product of exponentials": self.robot.fk(theta)}
        poses |= {f"{name} DH": table.fk(theta) for name, table in _tables(self.robot).items()}
        lines = []
        for name, T in poses.items():
            x, y, z = np.round(1000 * T[:3, 3], 3) + 0.0
            lines.append(f"{name:<24} x = {x:9.3f}  y = {y:9.3f}  z = {z:9.3f} mm")
        if len(poses) == 1:
            return "\n".join(
                [*lines, "this arm is given by its screws alone; there is no DH table to compare with"]
            )
        matrices = np.array(list(poses.values()))
        apart = float(np.max(matrices.max(axis=0) - matrices.min(axis=0)))
        return "\n".join([*lines, f"largest difference between any two matrix entries: {apart:.1e}"])


def _tables(robot):
    """Name -> DH table, of those the robot has."""
    tables = {"standard": robot.standard_dh, "modified": robot.modified_dh}
    return {name: table for name, table in tables.items() if table is not None}
