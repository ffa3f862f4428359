"""What a wrong answer looks like: the right one solid, yours translucent, the gap marked.

The only module of the classroom that draws: it takes colours and axes from `view`.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from .attempt import Attempt
from .exercise import Exercise, thaw
from .verdict import Example, Verdict

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

YOURS = "accent"  # the one colour of what a student wrote, here as in the explorers
SIZE = (3.6, 3.2)  # inches
MARGIN = 8  # pixels
FAR = 8.0  # times the size of the right picture: what is farther away is not drawn


def picture(exercise: Exercise, found: Verdict, examples: list[Example], attempts: list[Attempt]) -> bytes:
    """A PNG of the example that shows the mistake, b'' if there is nothing to see.

    Solid: the right answer; translucent: the student's; dotted: from one to the other.
    """
    k = found.example
    parts = attempts[k].parts if 0 <= k < len(attempts) else ()
    if exercise.look is None or not parts or any(not np.isfinite(part).all() for part in parts):
        return b""
    if any(a.shape != b.shape for a, b in zip(parts, examples[k].right, strict=True)):
        return b""  # nothing that could be drawn beside the right one
    arguments = thaw(examples[k].arguments)
    try:
        with np.errstate(all="ignore"):
            right = exercise.look(arguments, exercise.value(list(examples[k].right)))
            mine = exercise.look(arguments, exercise.value(list(parts)))
    except (ValueError, IndexError, ArithmeticError, np.linalg.LinAlgError):
        return b""
    return _drawn(right, mine)


def _drawn(right: dict, mine: dict) -> bytes:
    from coursekit.view.figures import INK, palette  # isort: skip  # first: it keeps matplotlib quiet

    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    middle, half, near = _room(right, mine)
    figure = Figure(figsize=SIZE, layout="constrained")
    ax = figure.add_subplot(projection="3d")
    ax.set_proj_type("ortho")
    ax.set_axis_off()
    for letter, centre in zip("xyz", middle, strict=True):
        ax.set(**{f"{letter}lim": (centre - half, centre + half)})
    ax.set_box_aspect((1, 1, 1), zoom=1.45)
    _triad(ax, np.eye(4), 0.3 * half, ["#9AA3AF"] * 3, 1.0, "{s}")
    _draw(ax, right, half, INK, [palette(letter) for letter in "xyz"], 1.0)
    ours, theirs = Line2D([], [], color=INK, lw=2), Line2D([], [], color=palette(YOURS), lw=2, alpha=0.6)
    words = ["right", "yours"]
    if near:
        _draw(ax, mine, half, palette(YOURS), [palette(YOURS)] * 3, 0.55)
        for a, b in zip(_anchors(right), _anchors(mine), strict=False):
            ax.plot(*np.transpose([a, b]), ls=":", lw=1.2, color=palette(YOURS))
    else:
        words[1] = "yours: far outside"
    figure.legend([ours, theirs], words, loc="outside lower center", fontsize=8, frameon=False, ncols=2)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return _cropped(np.asarray(canvas.buffer_rgba())[..., :3])


def _cropped(pixels: np.ndarray) -> bytes:
    """Without the empty paper round it, nor between it and what its colours mean."""
    from PIL import Image

    inked: np.ndarray = np.min(pixels, axis=-1) < 250
    rows, columns = np.flatnonzero(inked.any(axis=1)), np.flatnonzero(inked.any(axis=0))
    top, bottom = max(rows[0] - MARGIN, 0), rows[-1] + MARGIN
    left, right = max(columns[0] - MARGIN, 0), columns[-1] + MARGIN
    file = io.BytesIO()
    words = np.flatnonzero(np.diff(rows) > 1)[-1:]  # after this row of ink comes what the colours mean
    empty = [*range(rows[words[0]] + MARGIN, rows[words[0] + 1] - MARGIN)] if words.size else []
    Image.fromarray(np.delete(pixels, empty, axis=0)[top : bottom - len(empty), left:right]).save(file, "PNG")
    return file.getvalue()


def _room(right: dict, mine: dict) -> tuple[np.ndarray, float, bool]:
    """Centre and half edge of a cube that holds both and the origin; and whether yours is near enough."""
    seen = np.array([[0, 0, 0], *_points(right)], float)
    size = max(np.ptp(seen, axis=0).max(), 0.2)
    theirs = np.array(_points(mine) or [[0, 0, 0]], float)
    near = bool(np.abs(theirs).max() < FAR * size)
    seen = np.vstack([seen, theirs]) if near else seen
    low, high = seen.min(axis=0), seen.max(axis=0)
    return (low + high) / 2, 0.75 * max((high - low).max(), 0.2), near


def _points(look: dict) -> list:
    found = [T[:3, 3] for T in look.get("frames", ())] + list(look.get("points", ()))
    found += [p for chain in look.get("chains", ()) for p in chain]
    found += [end for tail, way in look.get("arrows", ()) for end in (tail, np.add(tail, way))]
    found += [point for point, _ in look.get("lines", ())]
    if "ellipsoid" in look:
        found += [*np.transpose(look["ellipsoid"]), *-np.transpose(look["ellipsoid"])]
    return found


def _anchors(look: dict) -> list:
    """Points of the right picture and of yours that should coincide."""
    found = [T[:3, 3] for T in look.get("frames", ())] + list(look.get("points", ()))
    found += [chain[-1] for chain in look.get("chains", ())]
    return found + [np.add(tail, way) for tail, way in look.get("arrows", ())]


def _draw(ax: Axes3D, look: dict, half: float, ink: str, xyz: list[str], alpha: float) -> None:
    frames = look.get("frames", ())
    for T in frames:
        _triad(ax, T, half * (0.5 if len(frames) == 1 else 0.22), xyz, alpha)
    for chain in look.get("chains", ()):
        ax.plot(*np.transpose(chain), color=ink, lw=4, alpha=alpha, solid_capstyle="round", marker="o", ms=4)
    for point, way in look.get("lines", ()):
        way = np.asarray(way) / max(np.linalg.norm(way), 1e-12)
        ends = np.transpose([np.subtract(point, 0.8 * half * way), np.add(point, 0.8 * half * way)])
        ax.plot(*ends, color=ink, lw=2, alpha=alpha)
        ax.quiver(*point, *(0.5 * half * way), color=ink, lw=2, alpha=alpha, arrow_length_ratio=0.3)
    for tail, way in look.get("arrows", ()):
        ax.quiver(*tail, *way, color=ink, lw=2.5, alpha=alpha, arrow_length_ratio=0.18)
    for point in look.get("points", ()):
        ax.plot(*np.reshape(point, (3, 1)), "o", color=ink, ms=7, alpha=alpha)
    if "ellipsoid" in look:
        _ellipsoid(ax, np.asarray(look["ellipsoid"], float), ink, alpha)


def _triad(ax: Axes3D, T: np.ndarray, length: float, colors: list[str], alpha: float, name: str = "") -> None:
    for axis, color in zip(np.transpose(T[:3, :3]), colors, strict=True):
        tip = np.clip(length * axis, -3 * length, 3 * length)  # of a matrix that is no rotation
        ax.plot(*np.transpose([T[:3, 3], T[:3, 3] + tip]), color=color, lw=2.2, alpha=alpha)
    if name:
        ax.text(*T[:3, 3], name, fontsize=7, color=colors[0], ha="right", va="top")


def _ellipsoid(ax: Axes3D, axes: np.ndarray, color: str, alpha: float) -> None:
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi, 13))
    ball = np.array([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    ax.plot_wireframe(*np.einsum("ij,jkl->ikl", axes, ball), color=color, lw=0.7, alpha=0.7 * alpha)
