"""Single drawings, each a list of parts (and of labels): frames, screw axes, arrows, curves, ellipsoids."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from .paint import Part
from .shapes import arrow as arrow_profile
from .shapes import ball, frame_along, plate, tube

Drawn = tuple[list[Part], list[dict]]  # parts and labels

_WIRE: dict = {"glow": 0.3, "casts": False}


def frame(size: float, letter: str = "") -> Drawn:
    """x, y, z as arrows from the origin with their letters, and the frame's own in braces above z."""
    shape = arrow_profile(size, 0.03 * size)
    look: dict = {"glow": 0.25, "xray": 0.45, "casts": False, "segments": 16}
    parts = [
        Part(shape, name, frame_along(axis), **look) for name, axis in zip("xyz", np.eye(3), strict=True)
    ]
    parts.append(Part(ball(0.05 * size, 6), "bone", casts=False, segments=12))
    labels = [_label(1.16 * size * axis, name, name) for name, axis in zip("xyz", np.eye(3), strict=True)]
    if letter:
        labels.append(_label([0, 0, 1.55 * size], f"{{{letter}}}", "note"))
    return parts, labels


def screw_axis(
    S: ArrayLike,
    theta: float | None,
    label: str,
    at: ArrayLike | None,
    length: float,
    radius: float,
    color: str | int,
) -> Drawn:
    """The line of a screw, starting near `at`; an arc with a tip shows which way it turns."""
    S = np.asarray(S, float)
    w, v = S[:3], S[3:]
    near = np.zeros(3) if at is None else np.asarray(at, float)
    turns = bool(np.any(w))
    along = (w if turns else v) / np.linalg.norm(w if turns else v)
    start = np.cross(w, v) + w * (w @ near) if turns else near
    parts, labels = arrow(start, length * along, color, label, radius, cls="axis")
    if turns:
        sweep = 1.5 * np.pi if theta is None else float(theta)
        around = frame_along(along, start + 0.78 * length * along)
        angle = np.linspace(0, sweep, max(int(abs(sweep) * 8), 2))
        circle = 6 * radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
        tip = np.sign(sweep) * np.array([-np.sin(sweep), np.cos(sweep), 0])
        cone = [(0.0, 0.0), (2.4 * radius, 0.0), (2.4 * radius, 0.0), (0.0, 6 * radius)]
        parts.append(Part(tube(circle, 0.7 * radius), color, around, xray=0.35, **_WIRE))
        parts.append(
            Part(cone, color, around @ frame_along(tip, circle[-1]), segments=12, xray=0.35, **_WIRE)
        )
    return parts, labels


def arrow(
    start: ArrayLike,
    vector: ArrayLike,
    color: str | int,
    label: str = "",
    radius: float = 0.005,
    cls: str = "note",
) -> Drawn:
    """An arrow with its label beyond the tip."""
    start, vector = np.asarray(start, float), np.asarray(vector, float)
    length = float(np.linalg.norm(vector))
    if not length > 1e-9:  # also where the vector is NaN
        return [], []
    shape = arrow_profile(length, radius)
    tip = start + vector * (1 + 5 * radius / length)
    part = Part(shape, color, frame_along(vector, start), segments=16, xray=0.35, **_WIRE)
    return [part], [_label(tip, label, cls)] if label else []


def line(a: ArrayLike, b: ArrayLike, color: str | int, label: str = "", radius: float = 0.003) -> Drawn:
    """A straight rod with its label at the middle."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    length = float(np.linalg.norm(b - a))
    if not length > 1e-9:
        return [], []
    rod = [(0.0, 0.0), (radius, 0.0), (radius, 0.0), (radius, length), (radius, length), (0.0, length)]
    part = Part(rod, color, frame_along(b - a, a), segments=10, xray=0.35, **_WIRE)
    return [part], [_label((a + b) / 2, label, "note")] if label else []


def curve(points: ArrayLike, color: str | int, radius: float, most: int = 240) -> list[Part]:
    """A wire; of a very fine curve only `most` points are drawn."""
    points = np.asarray(points, float)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2:
        raise ValueError(f"a curve needs points (k, 3) with k >= 2, got {points.shape}")
    chosen = np.unique(np.round(np.linspace(0, len(points) - 1, min(len(points), most))).astype(int))
    return [Part(tube(points[chosen], radius), color, glow=0.35)]


def point(p: ArrayLike, label: str, color: str | int, radius: float) -> Drawn:
    """A ball, its label above."""
    p = np.asarray(p, float)
    part = Part(ball(radius), color, frame_along([0, 0, 1], p), segments=16, glow=0.35)
    return [part], [_label(p + [0, 0, 3 * radius], label, "note")] if label else []


def normals(
    points: Iterable[ArrayLike], vectors: Iterable[ArrayLike], color: str | int, radius: float
) -> list[Part]:
    """Thin arrows, all in one."""
    return [
        part for p, v in zip(points, vectors, strict=True) for part in arrow(p, v, color, radius=radius)[0]
    ]


def plane(center: ArrayLike, normal: ArrayLike, size: float, color: str | int) -> list[Part]:
    """A translucent square with a rim."""
    T = frame_along(normal, center)
    corners = plate(size).vertices[[0, 1, 2, 3, 0]]
    rim = [part for a, b in pairwise(corners) for part in line(a, b, color, "", 0.003 * size)[0]]
    return [Part(plate(size), color, T, opacity=0.3, order=5), *(part.placed(T) for part in rim)]


def ball_about(center: ArrayLike, radius: float, color: str | int, opacity: float) -> list[Part]:
    """A translucent ball."""
    return [Part(ball(radius, 20), color, frame_along([0, 0, 1], center), **_glass(opacity))]


def ellipsoid(
    axes: ArrayLike, lengths: ArrayLike, at: ArrayLike, color: str | int, opacity: float, wire: float
) -> dict[str, tuple[list[Part], np.ndarray]]:
    """A translucent ellipsoid with rods along its axes: name -> (parts of unit size, T (4, 4) to shape them).

    The ball of radius 1 is stretched along all axes, a rod only along itself.
    """
    axes, lengths = np.array(axes, float), np.asarray(lengths, float)
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]  # the same ellipsoid, not inside out
    # flat where a direction is lost, never degenerate
    thin = np.maximum(lengths, 1e-3 * max(lengths.max(), 1e-9))
    shaped = {"body": ([Part(ball(1.0, 20), color, **_glass(opacity))], _scaled(axes, thin, at))}
    profile = [(0.0, -1.0), (wire, -1.0), (wire, -1.0), (wire, 1.0), (wire, 1.0), (0.0, 1.0)]
    rod = [Part(profile, color, segments=10, xray=0.35, **_WIRE)]
    for k in range(3):
        turned = np.roll(axes, -k - 1, axis=1)  # axis k becomes the last, z
        shaped[f"axis{k + 1}"] = rod, _scaled(turned, np.array([1.0, 1.0, thin[k]]), at)
    return shaped


def _glass(opacity):
    return {"opacity": opacity, "order": 6, "casts": False}


def _scaled(axes, lengths, at):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = axes * lengths, at
    return T


def _label(pos, text, cls):
    return {"pos": [float(v) for v in pos], "text": text, "cls": cls}
