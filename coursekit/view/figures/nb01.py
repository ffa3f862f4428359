"""Pictures of notebook 01: the half steps of a DH row, the frames of two conventions, near-parallel axes.

Every function shows one figure and returns None.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import dh
from coursekit.kinematics.robot import Robot
from coursekit.view.figures import INK, axes_3d, blank, limits_3d, palette, show
from coursekit.view.figures.side import GREY, INTO, mark_axis, mark_frame, side_view

CROWD = 0.1  # m: frames nearer to each other than this are fanned out


def half_steps() -> None:
    """One row of a standard table: frame i - 1, the frame i' after the turn and shift on z, and frame i."""
    a, alpha, d, theta = 0.5, 0.9, 0.4, 0.7
    first = dh.Table([0.0], [0.0], [d], [theta]).fk([0.0])
    last = dh.Table([a], [alpha], [d], [theta]).fk([0.0])
    (ax,) = axes_3d(1, (6.4, 4.6))
    for T, length in ((np.eye(4), 0.62), (last, 0.34)):  # the two joint axes
        ends = T[:3, 3] + np.outer([-0.5 * length, length], T[:3, 2])
        ax.plot(*ends.T, ls=(0, (6, 3)), lw=1, color=palette("axis"))
    for T in (np.eye(4), first, last):
        _triad(ax, T, 0.16)
    for pair, name, color in (
        ([np.zeros(3), first[:3, 3]], "d", "trace"),
        ([first[:3, 3], last[:3, 3]], "a", "accent"),
    ):
        ends = np.array(pair)
        ax.plot(*ends.T, lw=2.5, color=palette(color), alpha=0.8)
        ax.text(
            *(ends.mean(axis=0) + [0.03, 0, 0.03]), name, fontsize=13, style="italic", color=palette(color)
        )
    _arc(ax, np.eye(4), 0, theta, 0.12, "θ", "trace")
    tilted = np.eye(4)
    tilted[:3, :3], tilted[:3, 3] = first[:3, [1, 2, 0]], last[:3, 3]  # alpha turns about x
    _arc(ax, tilted, np.pi / 2, np.pi / 2 + alpha, 0.12, "α", "accent")
    limits_3d(ax, [(-0.15, 0.65), (-0.2, 0.6), (-0.2, 0.75)], ticks=(0, 0.25, 0.5), unit="m")
    ax.view_init(20, -18)
    _name(ax, [np.eye(4), first, last], ["i−1", "i′", "i"], 0.2)
    show()


def common_normals() -> None:
    """The KR6 from its side, frames 0 to 4 of its table: at zero, and with joint 3 turned by 90 degrees.

    A sketch, not to scale: 25 and 35 mm are drawn longer, so that frames stand apart.
    """
    axes = blank((9.8, 4.9), 2, sharey=True)
    s, top, two, three = (0, 0), (0, 300), (140, 300), (440, 300)
    up, down, forward = (0, 1), (0, -1), (1, 0)
    at_zero = (440, 430), (740, 430), (810, 430), up, (-1, 0)
    turned = (570, 300), (570, 0), (570, -70), forward, up
    for ax, title, (corner, wrist, tool, x, z) in (
        (axes[0], "at zero: x₃ stands upright", at_zero),
        (axes[1], "joint 3 turned by 90 deg: every x leads forward", turned),
    ):
        ax.plot(*np.array([s, top, two, three, corner, wrist, tool]).T, color=GREY, lw=7)
        behind = 1.45 * np.array(corner) - 0.45 * np.array(wrist)
        for line in (((0, -50), (0, 430)), (behind, 1.3 * np.array(wrist) - 0.3 * np.array(corner))):
            ax.plot(*np.array(line).T, ls=(0, (6, 3)), lw=1, color=palette("axis"))
        for name, start, end in (("a₁ = 25", top, two), ("a₂ = 455", two, three), ("a₃ = 35", three, corner)):
            ax.plot(*np.array([start, end]).T, color=palette("accent"), lw=2.6)
            beside = (
                {"xytext": (6, 0)}
                if start[0] == end[0]
                else {"xytext": (0, 20), "ha": "center"}  # above the letter of the x axis
            )
            ax.annotate(
                name, np.mean([start, end], axis=0), textcoords="offset points", fontsize=10, **beside
            )
        ax.annotate("d₁ = −400", (0, 150), (6, 0), textcoords="offset points", fontsize=10)
        beside = {"xytext": (18, 8), "ha": "center"} if x == up else {"xytext": (6, 0)}
        middle = np.mean([corner, wrist], axis=0)
        ax.annotate("d₄ = −420", middle, textcoords="offset points", fontsize=10, **beside)
        for number, place in (("axis 2", two), ("axis 3", three), ("axis 5", wrist)):
            mark_axis(ax, number, place, INTO)
        mark_frame(ax, "0", s, [("x₀", forward), ("z₀", down)], beside=(-24, -4))
        mark_frame(ax, "1", two, [("x₁", forward)], beside=(-8, -32))
        mark_frame(ax, "2", three, [("x₂", forward)], beside=(-8, -32))
        mark_frame(ax, "3", corner, [("x₃", x), ("z₃", z)], beside=(10, 8))
        mark_frame(ax, "4", wrist, [("x₄", x)], beside=(-8, -32) if x == up else (-36, -4))
        ax.set(title=title, xlim=(-90, 900), ylim=(-160, 600), aspect="equal", xticks=[], yticks=[])
    show()


def exam_drawing() -> None:
    """The Kawasaki S030 in its drawn pose: five lengths, axes without a sense, frames 0 and 6."""
    ax = blank((7.4, 5.9))
    corners = [(0, 0), (0, 680), (150, 680), (150, 1550), (1230, 1550), (1395, 1550)]
    side_view(ax, corners, ["h = 680", "o = 150", "u = 870", "f = 1080", "t = 165"], margin=110, room=260)
    for name, ends in (("1", [(0, -120), (0, 860)]), ("4, 6", [(-20, 1550), (1620, 1550)])):
        ax.plot(*np.array(ends).T, ls=(0, (6, 3)), lw=1.2, color=palette("axis"))
        ax.annotate(name, ends[1], (4, 6), textcoords="offset points", color=palette("axis"))
    for name, place in (("2", (150, 680)), ("3", (150, 1550)), ("5", (1230, 1550))):
        ax.plot(*place, "o", ms=13, mfc="white", mec=palette("axis"), mew=2, zorder=4)
        ax.annotate(name, place, (9, -18), textcoords="offset points", color=palette("axis"))
    mark_frame(ax, "0", (0, 0), [("x₀", (1, 0)), ("z₀", (0, 1))], length=170)
    mark_frame(ax, "6", (1395, 1550), [("z₆", (1, 0))], length=170)
    ax.set(xlabel="x [mm]", ylabel="z [mm]")
    show()


def placements(robot: Robot) -> None:
    """The frames of the standard and of the modified table of one robot at theta = 0, side by side."""
    if robot.standard_dh is None or robot.modified_dh is None:
        raise ValueError(f"{robot.name} has no DH tables of both conventions")
    zero = np.zeros(robot.n)
    axes = axes_3d(2, (9.6, 5.0))
    for ax, table, axis in zip(axes, (robot.standard_dh, robot.modified_dh), ("i + 1", "i"), strict=True):
        frames = np.concatenate([table.base[None], table.frames(zero)])
        _scene(ax, robot, zero, frames, [str(i) for i in range(robot.n + 1)], (0, 0, 0.32))
        ax.set_title(f"{table.convention}: frame i on axis {axis}", fontsize=11)
    show()


def poses(robot: Robot, *thetas: Sequence[float] | np.ndarray) -> None:
    """The modified frames and the tool frame of a robot in several configurations, seen from above."""
    if robot.modified_dh is None:
        raise ValueError(f"{robot.name} has no modified DH table")
    names = [*(str(i + 1) for i in range(robot.n)), "tool"]
    axes = axes_3d(len(thetas), (9.6, 6.2))
    for ax, theta in zip(axes, thetas, strict=True):
        frames = np.concatenate([robot.modified_dh.frames(theta), robot.fk(theta)[None]])
        _scene(ax, robot, theta, frames, names, (0.5, 0, 0.1), view=(50, -90), zoom=1.25)
        ax.set_title(f"θ₁ = {np.degrees(theta[0]):.0f} deg", fontsize=11)
    show()


def near_parallel(tilt: ArrayLike, d: ArrayLike, change: ArrayLike, marked: float) -> None:
    """How far the common normal runs away, and how little the screw changes, over the tilt of an axis."""
    ax = blank((6.4, 3.4))
    ax.loglog(tilt, np.abs(d), "-", color=palette("accent"), marker="o", ms=4, label="DH: |d| [m]")
    ax.loglog(tilt, change, "--", color=palette("trace"), marker="s", ms=4, label="screw: |change of S|")
    ax.axvline(marked, color=INK, lw=0.8, ls=":")
    ax.set(xlabel="tilt of axis 3 [rad]", ylabel="size [m], [rad]")
    ax.legend(frameon=False)
    show()


def errors_along_path(errors: Mapping[str, np.ndarray], ways: int) -> None:
    """Distances along a path that can be followed in several ways: name -> a number a point, way by way."""
    ax = blank((7.4, 2.8))
    for (name, values), color, style in zip(errors.items(), ("accent", "trace"), ("-", "--"), strict=False):
        first, *others = np.reshape(values, (ways, -1))
        for curve in others:
            ax.plot(np.linspace(0, 1, len(curve)), curve, style, color=palette(color), lw=0.6, alpha=0.5)
        ax.plot(np.linspace(0, 1, len(first)), first, style, color=palette(color), lw=2.2, label=name)
    ax.set(xlabel="λ, share of the path", ylabel="tool off by", ylim=(0, None))
    ax.figure.legend(frameon=False, loc="outside right upper")
    show()


# -- parts of the pictures -------------------------------------------------------------------------------


def _triad(ax, T, length):
    """One frame: three lines in the house colours, lettered."""
    for k, letter in enumerate("xyz"):
        ax.plot(*np.array([T[:3, 3], _along(T, k, length)]).T, lw=2, color=palette(letter))
        ax.text(
            *_along(T, k, 1.3 * length), letter, fontsize=8, color=palette(letter), ha="center", va="center"
        )


def _along(T, k, length):
    """The point at this length on axis k of frame T."""
    return T[:3, 3] + length * T[:3, k]


def _name(ax, frames, names, length):
    """Write {name} beside each frame, on the side where the picture has most room."""
    e, a = np.radians([ax.elev, ax.azim])
    right, up = (
        np.array([-np.sin(a), np.cos(a), 0]),
        np.array([-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]),
    )
    flat = np.stack([right, up], axis=1)
    taken = [_along(T, k, s * length) @ flat for T in frames for k in range(3) for s in (0, 0.5, 1, 1.4)]
    turn = np.arange(0, 2 * np.pi, np.pi / 12)
    for T, name in zip(frames, names, strict=True):
        wide = max(1, len(name) / 2.2)  # a long name keeps farther away to either side
        places = T[:3, 3] + length * (
            0.8 * wide * np.outer(np.cos(turn), right) + 0.65 * np.outer(np.sin(turn), up)
        )
        away = ((places @ flat)[:, None] - np.array(taken)) / [wide, 1]
        room = np.linalg.norm(away, axis=-1).min(axis=1)
        best = places[room.argmax()]
        taken.append(best @ flat)
        ax.text(*best, f"{{{name}}}", fontsize=10, weight="bold", color=INK, ha="center", va="center")


def _arc(ax, T, start, stop, radius, name, color):
    """An angle in the xy plane of frame T, from start to stop."""
    t = np.linspace(start, stop, 31)
    points = T[:3, 3] + radius * (np.outer(np.cos(t), T[:3, 0]) + np.outer(np.sin(t), T[:3, 1]))
    ax.plot(*points.T, lw=1.8, color=palette(color))
    middle = T[:3, 3] + 1.4 * (points[15] - T[:3, 3])
    ax.text(*middle, name, fontsize=12, color=palette(color), ha="center", va="center")


def _scene(ax, robot, theta, frames, names, fan, view=(16, -62), zoom=0.95):
    """The arm as a line through its joints, its axes dashed, and frames, fanned out where they crowd.

    view: elevation and azimuth of the eye, in degrees.
    """
    links = np.concatenate([robot.modified_dh.frames(theta), robot.fk(theta)[None]])
    points = np.concatenate([np.zeros((1, 3)), links[:, :3, 3]])
    ax.plot(*points.T, lw=8, color="#D5DAE1", solid_capstyle="round", solid_joinstyle="round")
    for T in links[:-1]:
        ends = T[:3, 3] + np.outer([-0.11, 0.11], T[:3, 2])
        ax.plot(*ends.T, lw=1.2, ls=(0, (4, 2)), color=palette("axis"))
    shown, crowds = frames.copy(), []  # a crowd: [place of its first frame, how many stand there]
    for T, moved in zip(frames, shown, strict=True):
        crowd = next((c for c in crowds if np.linalg.norm(c[0] - T[:3, 3]) < CROWD), None)
        if crowd is None:
            crowds.append(crowd := [T[:3, 3], 0])
        moved[:3, 3] += crowd[1] * np.array(fan)
        crowd[1] += 1
        ax.plot(*np.array([T[:3, 3], moved[:3, 3]]).T, lw=1, ls=":", color=INK)
        _triad(ax, moved, 0.11)
    points = np.concatenate([points, shown[:, :3, 3]])
    low, high = points.min(axis=0) - 0.16, points.max(axis=0) + 0.16
    limits_3d(ax, list(zip(low, high, strict=True)), np.arange(-2, 2.1, 0.5), "m", zoom)
    ax.view_init(*view)
    _name(ax, shown, names, 0.11)
