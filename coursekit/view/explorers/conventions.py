"""Notebook 01: one arm by three conventions, and their frames side by side."""

import numpy as np

from coursekit.kinematics import robots
from coursekit.kinematics.robot import Robot
from coursekit.view.controls import Choice, Toggle, joint_sliders
from coursekit.view.panel import Panel
from coursekit.view.scene import Scene


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
    catalogue = (
        {robot.name: robot} if robot else {arm.name: arm for arm in robots.all().values() if _tables(arm)}
    )
    first = next(iter(catalogue.values()))
    scene = Scene()
    _draw(scene, first)
    shown = [first]
    picker = [Choice("robot", list(catalogue))] if len(catalogue) > 1 else []
    joints = joint_sliders(max(catalogue.values(), key=lambda arm: arm.n))
    joints.fit(first)
    switches = [
        Toggle("standard", "standard DH frames"),
        Toggle("modified", "modified DH frames"),
        Toggle("screws", "screw axes"),
        Toggle("skeleton", "skeleton"),
    ]

    def update(values):
        arm = catalogue[values["robot"]] if picker else first
        if arm is not shown[0]:
            scene.remove("/ck/robot")
            _draw(scene, arm)
            shown[0] = arm
            joints.fit(arm)
        scene.set_theta("robot", joints.get())
        scene.look("robot", solid=not values["skeleton"], skeleton=values["skeleton"])
        scene.axes("robot", values["screws"])
        for convention in _tables(arm):
            for k in range(arm.n + 1):
                scene.show(f"/ck/robot/{k}/{convention}", values[convention])

    return Panel(
        "conventions",
        scene,
        [*picker, joints, *switches],
        update,
        lambda values: _comparison(shown[0], values["theta"]),
        title="Explorer of DH and PoE",
        height=height,
    )


def _tables(robot):
    """Name -> DH table, of those the robot has."""
    tables = {"standard": robot.standard_dh, "modified": robot.modified_dh}
    return {name: table for name, table in tables.items() if table is not None}


def _draw(scene, robot):
    """The arm with its tool frame and both sets of DH frames; each is fixed to a link and moves with it."""
    scene.robot(robot)
    scene.frame(f"/ck/robot/{robot.n}/tool", robot.M, letter="tool")
    at_zero = np.zeros(robot.n)
    for name, table in _tables(robot).items():
        for k, T in enumerate([table.base, *table.frames(at_zero)]):
            scene.frame(f"/ck/robot/{k}/{name}", T, letter=f"{name[0]}{k}", size=0.1 * scene.size)


def _comparison(robot, theta):
    """The tool pose by every convention the robot has, and how far they are apart."""
    poses = {"product of exponentials": robot.fk(theta)}
    poses |= {f"{name} DH": table.fk(theta) for name, table in _tables(robot).items()}
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
