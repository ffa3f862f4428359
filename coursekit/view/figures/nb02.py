"""Pictures of notebook 02: the drawing that M and S are read from, and the axes in space."""

from collections.abc import Sequence

import numpy as np

from coursekit.kinematics.robot import Robot
from coursekit.view.figures import INK, palette


def drawing() -> None:
    """Side view of the KR6 at zero with its lengths in mm: y points into the page."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(8.2, 4.0), layout="constrained")
    arm = np.array([(0, 0), (0, 400), (25, 400), (480, 400), (480, 435), (900, 435), (980, 435)])
    ax.plot(*arm.T, color=INK, lw=5, solid_capstyle="round", alpha=0.25)
    for number, x, z in ((2, 25, 400), (3, 480, 400), (5, 900, 435)):  # axes into the page
        ax.plot(x, z, "o", ms=13, mfc="white", mec=palette("axis"), mew=2)
        ax.plot(x, z, "x", ms=6, color=palette("axis"), mew=2)
        ax.annotate(f"{number}", (x, z), (9, -18), textcoords="offset points", color=palette("axis"))
    for number, start, end in (
        (1, (0, 330), (0, 210)),
        (4, (760, 435), (640, 435)),
        (6, (1190, 435), (1090, 435)),
    ):
        ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": palette("axis"), "lw": 2})
        middle = np.mean([start, end], axis=0)
        ax.annotate(f"{number}", middle, (6, 7), textcoords="offset points", color=palette("axis"))
    _dimension(ax, (-70, 0), (-70, 400), "400")
    _dimension(ax, (0, 520), (25, 520), "25")
    _dimension(ax, (25, 520), (480, 520), "455")
    _dimension(ax, (480, 520), (900, 520), "420")
    _dimension(ax, (900, 520), (980, 520), "80")
    _dimension(ax, (420, 400), (420, 435), "35")
    for origin, letter in (((0, 0), "s"), ((980, 435), "b")):
        for step, axis, name in (((75, 0), "x", "x"), ((0, 75), "z", "z")):
            tip = (origin[0] + step[0], origin[1] + step[1])
            ax.annotate("", tip, origin, arrowprops={"arrowstyle": "-|>", "color": palette(axis), "lw": 2})
            ax.annotate(name, tip, (3, 3), textcoords="offset points", color=palette(axis))
        ax.annotate(f"{{{letter}}}", origin, (-4, -16), textcoords="offset points", color=INK)
    ax.set(xlabel="x [mm]", ylabel="z [mm]", xlim=(-150, 1230), ylim=(-60, 580), aspect="equal")
    ax.grid(alpha=0.25)
    plt.show()


def axes_in_space(
    robot: Robot, along: Sequence[float] | np.ndarray = (0, 0, 0, 0.1, 0, -0.3), length: float = 0.16
) -> None:
    """Every joint axis of a robot at zero as an arrow with its number, and the line of links.

    `along` shifts each arrow on its axis (m), so that arrows on one line stand apart.
    """
    import matplotlib.pyplot as plt

    ax = plt.figure(figsize=(7.4, 4.8), layout="constrained").add_subplot(projection="3d")
    ax.set_proj_type("ortho")
    points = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
    elbow = points[2] + [0, 0, points[3, 2] - points[2, 2]]  # where the forearm begins
    ax.plot(*np.vstack([np.zeros(3), points[:3], elbow, points[3:]]).T, color=INK, lw=4, alpha=0.25)
    for i, (point, w) in enumerate(zip(points, robot.S[:3].T, strict=True)):
        start = point + along[i] * w
        ax.quiver(*start, *(length * w), color=palette("axis"), lw=2, arrow_length_ratio=0.25)
        ax.text(
            *(start + (length + 0.03) * w + [0, 0, 0.02]), f"S{i + 1}", color=palette("axis"), fontsize=11
        )
    for T, letter in ((np.eye(4), "s"), (robot.M, "b")):
        for axis, name in zip(T[:3, :3].T, "xyz", strict=True):
            ax.quiver(*T[:3, 3], *(0.12 * axis), color=palette(name), lw=1.6, arrow_length_ratio=0.25)
        ax.text(*(T[:3, 3] + [0, 0, -0.09]), f"{{{letter}}}", color=INK)
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", xlim=(-0.1, 1.3), ylim=(-0.3, 0.3), zlim=(0, 0.6))
    ax.set_box_aspect((1.4, 0.6, 0.6), zoom=1.15)
    ax.view_init(24, -62)
    plt.show()


def _dimension(ax, start, end, label):
    """A measured length between two points, in mm."""
    ax.annotate(
        "", end, start, arrowprops={"arrowstyle": "|-|,widthA=0.25,widthB=0.25", "color": INK, "lw": 1}
    )
    upright = start[0] == end[0]
    place = {"ha": "right", "va": "center"} if upright else {"ha": "center", "va": "bottom"}
    offset = (-5, 0) if upright else (0, 4)
    middle = np.mean([start, end], axis=0)
    ax.annotate(label, middle, offset, textcoords="offset points", fontsize=9, color=INK, **place)
