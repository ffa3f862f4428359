"""Shapes as numbers: turned parts, lofts and tubes, each a handful of numpy lines.

A `Mesh` is vertices, triangles and normals. Every shape is drawn around its own z axis; the caller places it.
Turned parts have a profile, a list of (radius, height) from bottom to top; a point given twice makes a sharp
edge there, because normals are averaged around each profile point.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Mesh(NamedTuple):
    """Triangles: vertices (v, 3) in metres, faces (f, 3) anticlockwise from outside, unit normals (v, 3)."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray

    def moved(self, T: ArrayLike) -> Mesh:
        """The mesh after the rigid (or scaling) transform T (4, 4)."""
        T = np.asarray(T, float)
        normals = self.normals @ np.linalg.inv(T[:3, :3])  # normals transform with the inverse transpose
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        return Mesh(self.vertices @ T[:3, :3].T + T[:3, 3], self.faces, normals)


def frame_along(
    direction: ArrayLike, origin: ArrayLike = (0, 0, 0), side: ArrayLike | None = None
) -> np.ndarray:
    """A pose (4, 4) at `origin` whose z axis is `direction` and whose x axis leans towards `side`.

    >>> frame_along([0, 1, 0])[:3, 2].tolist()
    [0.0, 1.0, 0.0]
    """
    z = np.asarray(direction, float) / np.linalg.norm(direction)
    side = np.eye(3)[np.argmin(np.abs(z))] if side is None else np.asarray(side, float)
    x = side - (side @ z) * z
    if np.linalg.norm(x) < 1e-6:  # `side` is parallel to z: any other direction serves
        return frame_along(z, origin)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    T[:3, 3] = origin
    return T


# --- turned parts: profiles, and the mesh of a profile ---


def bevelled(
    radius: float, low: float, high: float, bevel: float, steps: int = 3
) -> list[tuple[float, float]]:
    """Profile of a cylinder from height low to high whose two edges are rounded with radius `bevel`."""
    bevel = min(bevel, radius, (high - low) / 2)
    turn = np.linspace(0, np.pi / 2, steps + 1)
    inner, rise = radius - bevel + bevel * np.sin(turn), bevel - bevel * np.cos(turn)
    bottom = [(r, low + h) for r, h in zip(inner, rise, strict=True)]
    top = [(r, high - h) for r, h in zip(inner[::-1], rise[::-1], strict=True)]
    return [(0.0, low), *bottom, *top, (0.0, high)]


def arrow(length: float, radius: float, head: float | None = None) -> list[tuple[float, float]]:
    """Profile of an arrow along z: a shaft, then a cone of 2.6 times its radius."""
    head = min(7 * radius, length / 2) if head is None else head
    neck = length - head
    return [
        (0.0, 0.0), (radius, 0.0), (radius, 0.0), (radius, neck), (radius, neck),
        (2.6 * radius, neck), (2.6 * radius, neck), (0.0, length),
    ]  # fmt: skip


def ball(radius: float, steps: int = 12) -> list[tuple[float, float]]:
    """Profile of a sphere about the origin."""
    turn = np.linspace(-np.pi / 2, np.pi / 2, steps + 1)
    return [(max(radius * np.cos(t), 0.0), radius * np.sin(t)) for t in turn]


def lathe(profile: ArrayLike, segments: int = 32) -> Mesh:
    """Mesh of a profile turned about z."""
    radius, height = np.asarray(profile, float).T
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    rings = np.empty((len(radius), segments, 3))
    rings[..., 0] = radius[:, None] * np.cos(angle)
    rings[..., 1] = radius[:, None] * np.sin(angle)
    rings[..., 2] = height[:, None]
    return _skin(rings)


# --- links and wires ---


def loft(sections: ArrayLike, segments: int = 28, steps: int = 4) -> Mesh:
    """Mesh through cross-sections (k, 6): height, centre x, centre y, half width x, half width y, squareness.

    Squareness 2 is an ellipse, 4 nearly a rectangle with round corners. Between two sections all numbers run
    smoothly from one to the next. Both ends are closed and flat.
    """
    sections = np.asarray(sections, float)
    way = np.linspace(0, 1, steps + 1)[:-1, None]
    ease = way**2 * (3 - 2 * way)
    blends = []
    for a, b in pairwise(sections):
        rows = a + (b - a) * ease
        rows[:, 0] = (a + (b - a) * way)[:, 0]  # heights are spaced evenly, everything else eases in and out
        blends.append(rows)
    rows = np.vstack([*blends, sections[-1:]])
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    power = 2 / rows[:, 5:6]
    rings = np.empty((len(rows), segments, 3))
    rings[..., 0] = rows[:, 1:2] + rows[:, 3:4] * np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** power
    rings[..., 1] = rows[:, 2:3] + rows[:, 4:5] * np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** power
    rings[..., 2] = rows[:, 0:1]
    return _skin(_closed(rings))


def tube(points: ArrayLike, radius: float, segments: int = 8) -> Mesh:
    """Mesh of a round wire through points (k, 3)."""
    points = np.asarray(points, float)
    tangent = np.gradient(points, axis=0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    side = frame_along(tangent[0])[:3, 0]
    rings = []
    # carry one side vector along, so that the wire never twists
    for p, t in zip(points, tangent, strict=True):
        side = side - (side @ t) * t
        side /= max(np.linalg.norm(side), 1e-12)
        rings.append(
            p + radius * (np.outer(np.cos(angle), side) + np.outer(np.sin(angle), np.cross(t, side)))
        )
    return _skin(_closed(np.array(rings)))


def plate(size: float) -> Mesh:
    """Mesh of a square in the x, y plane, seen from both sides."""
    s = size / 2
    corner = np.array([[-s, -s, 0], [s, -s, 0], [s, s, 0], [-s, s, 0]])
    return Mesh(corner, np.array([[0, 1, 2], [0, 2, 3]]), np.tile([0.0, 0.0, 1.0], (4, 1)))


def _closed(rings):
    """Rings with a flat cap at both ends; the rim is doubled so that its edge stays sharp."""
    first, last = rings[0], rings[-1]
    poles = [np.broadcast_to(r.mean(axis=0), r.shape) for r in (first, last)]
    return np.concatenate([[poles[0], first], rings, [last, poles[1]]])


def _skin(rings):
    """Mesh over rings (m, k, 3) that are closed around; faces without area are left out."""
    m, k, _ = rings.shape
    vertices = rings.reshape(-1, 3)
    index = np.arange(m * k).reshape(m, k)
    right = np.roll(index, -1, axis=1)
    a, b, c, d = index[:-1].ravel(), right[:-1].ravel(), right[1:].ravel(), index[1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    area = np.cross(
        vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]]
    )
    solid = np.linalg.norm(area, axis=1) > 1e-14
    faces, area = faces[solid], area[solid]
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], area)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return Mesh(vertices, faces, normals)
