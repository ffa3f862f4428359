"""A target of the tool: a frame that six sliders move, x, y, z and yaw, pitch, roll."""

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import checks, rotations
from coursekit.kinematics.robot import Robot
from coursekit.view.chain import chain
from coursekit.view.controls import Slider, Sliders

TURNS = {"yaw": np.pi, "pitch": np.pi / 2, "roll": np.pi}  # how far each goes either way


class PoseSliders(Sliders):
    """Where a target is. In the picture its frame, at `path`, has handles that move these sliders."""

    path, letter = "/ck/target", "d"


def pose_sliders(T: ArrayLike, robot: Robot, name: str = "pose") -> PoseSliders:
    """Sliders whose value is (x, y, z, yaw, pitch, roll) in metres and radians, at first those of T (4, 4).

    They go a little further than the arm, so that a target may be out of its reach.
    """
    slides = np.array([kind == "prismatic" for kind in robot.joint_types])
    way = np.maximum(np.abs(robot.q_min), np.abs(robot.q_max))
    stretched = chain(robot).size + np.where(np.isfinite(way), way, 1.0)[slides].sum()
    reach = np.ceil(12 * stretched) / 10
    T = checks.pose(checks.array(T, (4, 4), "T"), "T")
    x_y_z = (Slider(n, p, -reach, reach, "mm") for n, p in zip("xyz", T[:3, 3], strict=True))
    turns = zip(TURNS.items(), rotations.zyx(T[:3, :3]), strict=True)
    return PoseSliders(name, [*x_y_z, *(Slider(n, t, -end, end, "deg") for (n, end), t in turns)])


def pose_of(values: ArrayLike) -> np.ndarray:
    """The pose T (4, 4) that (x, y, z, yaw, pitch, roll) describe.

    >>> pose_of([0, 0, 0.5, 0, 0, 0])[2].tolist()
    [0.0, 0.0, 1.0, 0.5]
    """
    values, T = checks.array(values, (6,), "values"), np.eye(4)
    T[:3, :3], T[:3, 3] = rotations.from_zyx(values[3:]), values[:3]
    return T
