"""Side views of an arm with its dimensions: what M, screws and DH tables are read from.

The page shows forward to the right and up upwards, in millimetres; the third direction points into the page.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from coursekit.kinematics.robot import Robot
from coursekit.view.figures import INK, palette

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INTO, OUT_OF = "into the page", "out of the page"
AXIS = 110.0  # mm, how long an axis is drawn
SAME = 0.5  # mm: shorter than this is no length
GREY = "#C9CFD8"


def side_view(
    ax: Axes,
    corners: Sequence | np.ndarray,
    names: Sequence[str] = (),
    margin: float = 70.0,
    room: float = 160.0,
) -> None:
    """The arm as a thick line through its corners, and the length of every piece.

    corners : (k, 2) mm; every piece runs along one of the two directions of the page.
    names   : one text for each piece; without them its length in mm. Pieces without length are left out.
    margin  : how far from the arm the lengths stand; room: how much paper is left around it, mm.
    """
    p = np.asarray(corners, dtype=float)
    ax.plot(*p.T, color=GREY, lw=6, solid_capstyle="round", solid_joinstyle="round")
    low, high = p.min(axis=0), p.max(axis=0)
    spans: list[tuple[float, float]] = []  # of the upright lengths that stand on the left
    for k, (start, end) in enumerate(pairwise(p)):
        if np.abs(end - start).max() < SAME:
            continue
        text = names[k] if len(names) else f"{np.abs(end - start).max():.5g}"
        if abs(end[1] - start[1]) < SAME:
            _length(ax, (start[0], high[1] + margin), (end[0], high[1] + margin), text)
            continue
        span = (min(start[1], end[1]), max(start[1], end[1]))
        free = all(span[1] <= a + SAME or span[0] >= b - SAME for a, b in spans)
        if free:
            spans.append(span)
        x = low[0] - margin if free else high[0] + margin
        _length(ax, (x, span[0]), (x, span[1]), text, left=free)
    ax.set(xlim=(low[0] - margin - room, high[0] + margin + room))
    ax.set(ylim=(low[1] - 110, high[1] + margin + 90), aspect="equal")
    ax.grid(alpha=0.2)


def mark_axis(ax: Axes, name: str, at: Sequence[float] | np.ndarray, way: Any, slides: bool = False) -> None:
    """A joint axis: INTO (a cross), OUT_OF (a dot), or an arrow along `way`, a direction of the page."""
    color, here = palette("axis"), _point(at)
    if isinstance(way, str):
        ax.plot(*here, "o", ms=13, mfc="white", mec=color, mew=2, zorder=4)
        ax.plot(*here, "x" if way == INTO else "o", ms=6 if way == INTO else 4, color=color, mew=2, zorder=5)
        ax.annotate(name, here, (9, -18), textcoords="offset points", color=color)
        return
    size = {"lw": 5, "mutation_scale": 20} if slides else {"lw": 2, "mutation_scale": 12}
    style = {"arrowstyle": "-|>", "color": color, **size}
    ax.annotate("", _point(here, way, AXIS), here, arrowprops=style, zorder=4)
    beside = (6, 8) if abs(way[0]) > 0.5 else (8, -4)
    ax.annotate(name, _point(here, way, AXIS / 2), beside, textcoords="offset points", color=color)


def mark_frame(
    ax: Axes,
    letter: str,
    at: Sequence[float] | np.ndarray,
    axes: Iterable[tuple[str, Any]],
    length: float = 80.0,
    beside: tuple[float, float] = (-5, -16),
) -> None:
    """A frame: its axes in the page as (name, direction), lettered; its name stands `beside` it, points."""
    for name, way in axes:
        tip = _point(at, way, length)
        style = {"arrowstyle": "-|>", "color": palette(name[0]), "lw": 2}
        ax.annotate("", tip, _point(at), arrowprops=style, zorder=6)
        ax.annotate(name, tip, (3, 3), textcoords="offset points", color=palette(name[0]), fontsize=9)
    ax.annotate(f"{{{letter}}}", _point(at), beside, textcoords="offset points", color=INK, weight="bold")


def draw_arm(ax: Axes, robot: Robot) -> None:
    """An arm like the KR6 at zero from its side: lengths, axes, the space frame and the tool frame.

    Its places must lie in one upright plane, and the forearm behind axis 3 first rise, then lead forwards.
    """
    forward = np.eye(3)[np.abs([*robot.places, robot.M[:3, 3]]).max(axis=0)[:2].argmax()]
    page = 1000 * np.array([forward, [0, 0, 1]])
    joints, tool = robot.places @ page.T, page @ robot.M[:3, 3]
    column, elbow = (0.0, joints[1, 1]), (joints[2, 0], joints[4, 1])
    corners = [(0, 0), column, joints[1], joints[2], elbow, joints[4], tool]
    side_view(ax, corners, margin=max(70.0, 0.11 * tool[1]))
    into = np.cross([0, 0, 1], forward)
    between = np.array([0.45 * elbow[0] + 0.55 * joints[4, 0], joints[4, 1]])
    where = {0: (0, 0.6 * column[1]), 3: between, 5: tool + [120, 0]}
    for i, w in enumerate(robot.S[:3].T):
        if abs(w @ into) > 0.5:
            mark_axis(ax, f"{i + 1}", joints[i], INTO if w @ into > 0 else OUT_OF)
        else:
            way = page @ w / 1000
            mark_axis(ax, f"{i + 1}", where[i] - 55 * way, way)
    letter = "xy"[int(forward[1])]
    for name, T in (("s", np.eye(4)), ("b", robot.M)):
        flat = [(k, page @ axis / 1000) for k, axis in zip("xyz", T[:3, :3].T, strict=True)]
        at = page @ T[:3, 3]
        shown = [(k, way) for k, way in flat if np.abs(way).max() > 0.5]
        mark_frame(ax, name, at, shown, beside=(4, -16) if name == "b" else (-5, -16))
    ax.set(xlabel=f"{letter} [mm]", ylabel="z [mm]", xlim=(-250, tool[0] + 240))


def _length(ax, start, end, text, left=True):
    """A measured length between two points; an upright one has its text on the left or on the right."""
    ax.annotate(
        "", end, start, arrowprops={"arrowstyle": "|-|,widthA=0.25,widthB=0.25", "color": INK, "lw": 1}
    )
    upright = abs(start[0] - end[0]) < SAME
    place = {"ha": "right" if left else "left", "va": "center"}
    place = place if upright else {"ha": "center", "va": "bottom"}
    middle = np.mean([start, end], axis=0)
    offset = (-5 if left else 5, 0) if upright else (0, 4)
    ax.annotate(text, middle, offset, textcoords="offset points", fontsize=9, color=INK, **place)


def _point(start: Any, way: Any = (0, 0), length: float = 0.0) -> tuple[float, float]:
    """A point of the page: so far from `start` along `way`."""
    return float(start[0] + length * way[0]), float(start[1] + length * way[1])
