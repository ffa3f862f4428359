"""Pictures of notebook 02: the drawing that M and S are read from, and the axes in space."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot
from coursekit.view.figures import INK, axes_3d, blank, limits_3d, palette, show
from coursekit.view.figures.side import INTO, OUT_OF, draw_arm, mark_axis, mark_frame, side_view


def drawing(robot: Robot) -> None:
    """Side view of an arm like the KR6 at zero with its lengths in mm."""
    ax = blank((8.2, 4.4))
    draw_arm(ax, robot)
    show()


def steps(directions: Sequence[str], P_mm: ArrayLike) -> None:
    """The IRB 1200 at zero: direction h_i of each joint and the steps P_{i-1,i} from one to the next.

    directions: a letter per joint, "z", "y", ...; P_mm (n + 1, 3), the last step leads to the tool.
    """
    ax = blank((7.4, 5.4), grid=0.2)
    corners = [(0, 0), *np.asarray(P_mm, dtype=float).cumsum(axis=0)[:, [0, 2]]]
    flat = np.array([p for p in corners for _ in (0, 1)])[1:-1]
    ax.plot(*flat.T, color=INK, lw=5, alpha=0.15)
    for i, (start, end) in enumerate(pairwise(corners)):
        if np.linalg.norm(np.subtract(end, start)) > 1:
            style = {"arrowstyle": "-|>", "color": palette("trace"), "lw": 2.2}
            ax.annotate("", end, start, arrowprops=style)
            name = f"$P_{{{i}{i + 1}}}$" if i < len(directions) else "$P_{6T}$"
            beside = (-40, -4) if start[0] == end[0] else (-14, -36 if i == len(directions) else -18)
            middle = np.mean([start, end], axis=0)
            ax.annotate(name, middle, beside, textcoords="offset points", fontsize=11)
    _directions(ax, directions, np.array(corners[1:-1]))
    mark_frame(ax, "T", corners[-1], [("x", (1, 0)), ("z", (0, 1))], beside=(8, -16))
    mark_frame(ax, "s", corners[0], [("x", (1, 0)), ("z", (0, 1))])
    ax.set(xlabel="x [mm]", ylabel="z [mm]", xlim=(-170, 760), ylim=(-90, 1170), aspect="equal")
    show()


def telescope_arm() -> Robot:
    """The arm of the drawing `telescope`: two hinges, a slide, two hinges.

    >>> telescope_arm().joint_types[2]
    'prismatic'
    """
    S = np.zeros((6, 5))
    S[[2, 1, 3, 0, 1], range(5)] = 1, -1, 1, 1, 1  # directions; joint 3 slides
    S[:, 1] += 0, 0, 0, 0.6, 0, -0.15
    S[4, 3] = 0.72
    S[:, 4] += 0, 0, 0, -0.72, 0, 0.85
    M = [(1, 0, 0, 0.85), (0, -1, 0, 0), (0, 0, -1, 0.52), (0, 0, 0, 1)]
    return Robot.from_screws(S, M, joint_types="RRPRR", name="telescope")


def telescope() -> None:
    """The arm with a slide whose M and S are to be read: its lengths A to E, five axes, both frames."""
    A, B, C, D, E = 150, 600, 120, 700, 200  # mm
    ax = blank((8.2, 5.2))
    corners = [(0, 0), (0, B), (A, B), (A, B + C), (A + D, B + C), (A + D, B + C - E)]
    side_view(ax, corners, [f"{name} = {x:g}" for name, x in zip("BACDE", (B, A, C, D, E), strict=True)])
    mark_axis(ax, "1", (0, 0.45 * B), (0, 1))
    mark_axis(ax, "2", (A, B), OUT_OF)
    mark_axis(ax, "3 slides", (A + 0.2 * D, B + C), (1, 0), slides=True)
    mark_axis(ax, "4", (A + 0.65 * D, B + C), (1, 0))
    mark_axis(ax, "5", (A + D, B + C), INTO)
    mark_frame(ax, "s", (0, 0), [("x", (1, 0)), ("z", (0, 1))])
    mark_frame(ax, "b", corners[-1], [("x", (1, 0)), ("z", (0, -1))], beside=(-26, -10))
    ax.set(xlabel="x [mm]", ylabel="z [mm]")
    show()


def axes_in_space(robot: Robot) -> None:
    """Every joint axis of an arm like the KR6 at zero as an arrow with its number, and the line of links."""
    length = 0.16
    (ax,) = axes_3d(1, (7.4, 4.8))
    points = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
    elbow = points[2] + [0, 0, points[3, 2] - points[2, 2]]  # where the forearm begins
    ax.plot(*np.vstack([np.zeros(3), points[:3], elbow, points[3:]]).T, color=INK, lw=4, alpha=0.25)
    along = (0, 0, 0, 0.1, 0, -0.3)  # arrows on one line stand apart
    for i, (point, w) in enumerate(zip(points, robot.S[:3].T, strict=True)):
        start = point + along[i] * w
        ax.quiver(*start, *(length * w), color=palette("axis"), lw=2, arrow_length_ratio=0.25)
        ax.text(
            *(start + (length + 0.03) * w + [0.04, 0, 0.02]), f"S{i + 1}", color=palette("axis"), fontsize=11
        )
    for T, letter in ((np.eye(4), "s"), (robot.M, "b")):
        for axis, name in zip(T[:3, :3].T, "xyz", strict=True):
            ax.quiver(*T[:3, 3], *(0.12 * axis), color=palette(name), lw=1.6, arrow_length_ratio=0.25)
        ax.text(*(T[:3, 3] + [0, 0, -0.09]), f"{{{letter}}}", color=INK)
    limits_3d(ax, [(-0.1, 1.3), (-0.3, 0.3), (0, 0.6)], (-0.2, 0, 0.2, 0.4, 0.6, 0.8, 1, 1.2), "m", zoom=1.15)
    ax.view_init(24, -62)
    show()


def _directions(ax, letters, points):
    """An arrow or a crossed circle for each joint; arrows of one place stand above it, on a dotted line."""
    for i, (letter, point) in enumerate(zip(letters, points, strict=True)):
        if letter == "y":
            mark_axis(ax, f"$h_{i + 1}$", point, INTO)
            continue
        way = np.array({"x": (1, 0), "z": (0, 1)}[letter])
        above = np.array([0, 110 + 35 * (i - 3)]) if letter == "x" else np.array([-85, 0])
        ax.plot(*np.array([point, point + above]).T, ls=":", lw=1, color=palette("axis"))
        mark_axis(ax, f"$h_{i + 1}$", point + above, way)
