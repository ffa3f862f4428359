"""Directions, points and lines: what is parallel, where lines come nearest, where they meet.

A line is a point q and a unit direction w, (3,) each; several lines are (k, 3) each. One tolerance decides
for the whole room what counts as parallel, as perpendicular and as one point.
"""

from itertools import combinations
from typing import Any

import numpy as np

SAME = 1e-10  # directions (rad) and points (m) that differ by less are the same: rounding of S and M
NEARLY = 1e-4  # rad; a common normal of lines less apart lies far away: 1 m beside becomes 10 km along

Vector = Any  # three numbers, or three arrays of them: an array (3, ...) is one


def points_on(S: np.ndarray) -> np.ndarray:
    """q = w x v: on the axis of every screw (6, n) = (w; v) the point nearest the origin. -> (n, 3).

    A slide has a direction and no place; it gets the origin.

    >>> points_on(np.array([[0, 0, 1.0, 0, -0.5, 0]]).T).tolist()
    [[0.5, 0.0, 0.0]]
    """
    return np.cross(S[:3].T, S[3:].T) + 0.0


def directions_of(S: np.ndarray) -> np.ndarray:
    """Along what each joint with screw (w; v) turns or slides. S (6, n) -> unit vectors (n, 3)."""
    hinge = np.any(S[:3], axis=0)
    return np.where(hinge, S[:3], S[3:]).T


def cross(a: Vector, b: Vector) -> tuple:
    """a x b for numbers and for arrays, components first: np.cross with less ceremony (it costs 15 us)."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def sine(w_1: np.ndarray, w_2: np.ndarray) -> float:
    """Sine of the angle between two directions, 0 or more."""
    return float(np.linalg.norm(np.cross(w_1, w_2)))


def parallel(w_1: np.ndarray, w_2: np.ndarray, tol: float = SAME) -> bool:
    """Whether two directions are the same or opposite; tol in rad."""
    return sine(w_1, w_2) < tol


def perpendicular(w_1: np.ndarray, w_2: np.ndarray) -> bool:
    """Whether two directions are at a right angle."""
    return bool(abs(w_1 @ w_2) < SAME)


def across(w: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The part of x that is perpendicular to w."""
    return x - w * (w @ x)


def foot(p: np.ndarray, q: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The point of a line that is nearest to p.

    >>> foot(np.array([1.0, 2, 3]), np.zeros(3), np.array([0, 0, 1.0])).tolist()
    [0.0, 0.0, 3.0]
    """
    return q + w * (w @ (p - q))


def feet(q_1: np.ndarray, w_1: np.ndarray, q_2: np.ndarray, w_2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where two lines come nearest: the feet of their common normal, on line 1 and on line 2.

    Parallel lines have infinitely many common normals: the one through q_1 is taken.

    >>> [foot.tolist() for foot in feet(*np.array([[0, 0, 0], [0, 0, 1], [1, 0, 2], [0, 1.0, 0]]))]
    [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0]]
    """
    if parallel(w_1, w_2):
        return q_1, foot(q_1, q_2, w_2)
    normal = np.cross(w_1, w_2)
    apart, size2 = q_2 - q_1, normal @ normal
    return (
        q_1 + w_1 * (np.cross(apart, w_2) @ normal) / size2,
        q_2 + w_2 * (np.cross(apart, w_1) @ normal) / size2,
    )


def meeting_point(q: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, float]:
    """Where k lines meet: a point (3,), and by how much it misses one of them at most, in m.

    Where they do not quite meet, it lies on one of the two lines that are least parallel.

    >>> point, miss = meeting_point(np.array([[1.0, 0, 5], [0, 2, 3]]), np.array([[0, 0, 1.0], [1, 0, 0]]))
    >>> point.tolist(), miss
    ([1.0, 0.0, 3.0], 2.0)
    """
    i, j = max(combinations(range(len(w)), 2), key=lambda pair: sine(w[pair[0]], w[pair[1]]))
    point, _ = feet(q[i], w[i], q[j], w[j])
    return point, float(max(np.linalg.norm(point - foot(point, *line)) for line in zip(q, w, strict=True)))


def wrist(q: np.ndarray, w: np.ndarray) -> tuple[str, np.ndarray]:
    """What six axes end in. -> ("spherical" or "parallel", the point (3,) where axes 5 and 6 meet).

    spherical   axis 4 passes through that point, too: the wrist centre
    parallel    axis 4 is parallel to axis 3 (Universal Robots)

    Raises ValueError which says by how much both fail.
    """
    point, miss = meeting_point(q[3:], w[3:])
    if miss < SAME:
        return "spherical", point
    if not parallel(w[2], w[3]):
        raise ValueError(
            f"axes 4, 5 and 6 miss a common point by {miss:.3g} m (no spherical wrist), "
            "and axes 2, 3 and 4 are not parallel either"
        )
    point, miss = meeting_point(q[4:], w[4:])
    if miss > SAME:
        raise ValueError(f"axes 5 and 6 do not meet: they miss a common point by {miss:.3g} m")
    return "parallel", point


def rotation_to(z: np.ndarray, towards: np.ndarray | None = None) -> np.ndarray:
    """A rotation (3, 3) whose z is the unit vector z, and whose x is as near as can be to `towards`.

    Where that is not given or along z: to the x, or failing that the y, of the space frame.

    >>> rotation_to(np.array([0, 1.0, 0])).tolist()
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
    """
    if towards is None or parallel(z, towards):
        towards = np.array([1.0, 0, 0]) if abs(z[0]) < 0.9 else np.array([0, 1.0, 0])
    x = across(z, towards)
    x = x / np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=-1)
