"""The four Paden-Kahan subproblems: which turns about given axes bring a point where it is wanted.

rot(k, t) x is x turned by t rad about the axis through the origin with unit direction k; points are measured
from a point of the axis. Whatever the subproblem, what is left in the end is an equation in the plane across
the axis, and `unit` and `swing` solve it. The inverse kinematics calls these two directly.
Sources: Murray, Li & Sastry, A Mathematical Introduction to Robotic Manipulation (1994), section 3.3.2, for
subproblems 1 to 3; RPI mini project 3 (2021) for subproblem 4. None of them returns a least-squares answer.
"""

import numpy as np
from numpy.typing import ArrayLike

from . import checks

__all__ = ["subproblem1", "subproblem2", "subproblem3", "subproblem4"]

Number = float | np.ndarray
Pair = tuple[Number, Number]  # (cos, sin) of an angle, or a vector of a plane

# a cos t + b sin t = c has no root where |c| > sqrt(a^2 + b^2). A pose exactly at the end of the reach must
# keep its double root in spite of rounding, so the edge is this much wider, as a fraction of sqrt(a^2 + b^2).
EDGE = 1e-11
NOTHING = 1e-12  # m; a vector shorter than this has no direction: every angle is right, and 0 is taken
MISS = 1e-9  # how far two lengths may differ (relative) for subproblems 1 and 2 to call them equal


def subproblem1(k: ArrayLike, x: ArrayLike, y: ArrayLike) -> np.ndarray:
    """The turn about k that carries x to y: rot(k, t) x = y.

    With x' and y' for the parts across the axis: cos t is along x' . y', sin t along k . (x' cross y').

    Parameters
    ----------
    k : (..., 3), unit vector
    x, y : (..., 3)

    Returns
    -------
    t : (...), rad in (-pi, pi]
        NaN where x and y are not equally far from the axis and equally high along it: no turn does it.
        0 where both lie on the axis: every turn does it.

    Examples
    --------
    >>> round(float(subproblem1([0, 0, 1], [1, 0, 5], [0, 1, 5])), 6)
    1.570796
    """
    k, x, y = _vectors(k=k, x=x, y=y)
    kx, ky = _dot(k, x), _dot(k, y)
    t = angle(unit(_dot(x, y) - kx * ky, _dot(k, np.cross(x, y))))
    size = np.sqrt(_dot(x, x) + _dot(y, y))
    same_height = np.abs(kx - ky) <= MISS * size
    same_distance = np.abs(_dot(x, x) - _dot(y, y)) <= MISS * size**2
    return np.where(same_height & same_distance, t, np.nan)


def subproblem2(k1: ArrayLike, k2: ArrayLike, x: ArrayLike, y: ArrayLike) -> np.ndarray:
    """The turns with rot(k1, t1) rot(k2, t2) x = y, for two axes that meet in the origin.

    In between, the point is z = rot(k2, t2) x = rot(k1, -t1) y: where the circle of x about k2 meets the
    circle of y about k1. z = a k1 + b k2 + g k1 cross k2, with a and b from the heights k1 . z = k1 . y and
    k2 . z = k2 . x, and g = +- what the length of y leaves. Raises ValueError for parallel axes.

    Parameters
    ----------
    k1, k2 : (..., 3), unit vectors
    x, y : (..., 3)

    Returns
    -------
    t : (..., 2, 2), rad; row i is the solution (t1, t2) number i
        Circles that touch give the solution twice, circles that do not meet give NaN.

    Examples
    --------
    >>> subproblem2([0, 0, 1], [0, 1, 0], [0, 0, 1], [0, 1, 0]).round(4).tolist()
    [[1.5708, 1.5708], [-1.5708, -1.5708]]
    """
    k1, k2, x, y = _vectors(k1=k1, k2=k2, x=x, y=y)
    c, across = _dot(k1, k2), np.cross(k1, k2)
    n2 = _dot(across, across)
    if np.any(n2 < NOTHING):
        raise ValueError("subproblem 2 needs two different axes: k1 and k2 are parallel; use subproblem 1")
    y1, x2 = _dot(k1, y), _dot(k2, x)
    a, b = (y1 - c * x2) / n2, (x2 - c * y1) / n2
    y_across = y - y1[..., None] * k1
    g2 = _dot(y_across, y_across) - b * b * n2  # the parts of y and z across k1 are equally long
    size2 = _dot(x, x) + _dot(y, y)
    same_length = np.abs(_dot(x, x) - _dot(y, y)) <= MISS * size2
    g = np.where(same_length, _root(g2, size2), np.nan) / np.sqrt(n2)
    solutions = []
    for sign in (-1, 1):
        z = a[..., None] * k1 + b[..., None] * k2 + (sign * g)[..., None] * across
        turns = subproblem1(k1, z, y), subproblem1(k2, x, z)
        solutions.append(np.stack(turns, axis=-1))
    return np.stack(solutions, axis=-2)


def subproblem3(k: ArrayLike, x: ArrayLike, y: ArrayLike, distance: ArrayLike) -> np.ndarray:
    """The turns about k that bring x to a distance from y: |y - rot(k, t) x| = distance.

    Squared, it is subproblem 4: y . rot(k, t) x = (|x|^2 + |y|^2 - distance^2) / 2. The law of cosines is the
    special case with x and y in one plane: the elbow of an arm.

    Parameters
    ----------
    k : (..., 3), unit vector
    x, y : (..., 3)
    distance : (...), in the unit of x and y

    Returns
    -------
    t : (..., 2), rad; as in `subproblem4`

    Examples
    --------
    >>> subproblem3([0, 0, 1], [1, 0, 0], [1, 0, 0], np.sqrt(2)).round(6).tolist()
    [-1.570796, 1.570796]
    """
    k, x, y = _vectors(k=k, x=x, y=y)
    distance = checks.array(distance, (), "distance")
    return subproblem4(y, k, x, 0.5 * (_dot(x, x) + _dot(y, y) - distance**2))


def subproblem4(h: ArrayLike, k: ArrayLike, x: ArrayLike, d: ArrayLike) -> np.ndarray:
    """The turns about k that bring x to a plane: h . rot(k, t) x = d.

    With Rodrigues' formula: a cos t + b sin t = d - (h . k)(k . x), where a = h . x - (h . k)(k . x) and
    b = h . (k cross x).

    Parameters
    ----------
    h, k, x : (..., 3); k is a unit vector
    d : (...)

    Returns
    -------
    t : (..., 2), rad
        Two roots; the same twice where the circle of x touches the plane, NaN where it misses.

    Examples
    --------
    >>> subproblem4([1, 0, 0], [0, 0, 1], [2, 0, 0], 1.0).round(6).tolist()
    [-1.047198, 1.047198]
    """
    h, k, x = _vectors(h=h, k=k, x=x)
    d = checks.array(d, (), "d")
    fixed = _dot(h, k) * _dot(k, x)
    a, b, c = _dot(h, x) - fixed, _dot(h, np.cross(k, x)), d - fixed
    return np.stack([angle(swing(a, b, c, sign)) for sign in (-1, 1)], axis=-1)


# -- in the plane: angles are carried as (cos, sin), so that no inverse trigonometric function is needed ---


def unit(c: np.ndarray, s: np.ndarray) -> Pair:
    """(c, s) scaled to length 1: the cosine and sine of its direction, (1, 0) where it has none."""
    length = np.sqrt(c * c + s * s)
    none = length < NOTHING
    if none.any():
        length = np.where(none, 1.0, length)
        c, s = np.where(none, 1.0, c), np.where(none, 0.0, s)
    return c / length, s / length


def swing(a: Number, b: Number, c: Number, sign: Number) -> Pair:
    """(cos t, sin t) of a root of a cos t + b sin t = c: t = atan2(b, a) + sign acos(c / r), r^2 = a^2 + b^2.

    sign: -1 or +1. NaN where |c| > r (beyond EDGE). Where a = b = c = 0 every t is right and 0 is taken.
    """
    r2 = a * a + b * b
    free = (r2 < NOTHING**2) & (np.abs(c) < NOTHING)
    if np.any(free):
        a, c, r2 = np.where(free, 1.0, a), np.where(free, 1.0, c), np.where(free, 1.0, r2)
    with np.errstate(divide="ignore", invalid="ignore"):
        c, w = c / r2, sign * _root(r2 - c * c, r2) / r2
        return a * c - b * w, b * c + a * w


def _root(square, scale):
    """Square root; 0 where rounding made the square a little negative, NaN where it is less than that."""
    with np.errstate(invalid="ignore"):
        return np.where(square < -2 * EDGE * scale, np.nan, np.sqrt(np.maximum(square, 0)))


def turn(cs: Pair, x: Number, y: Number) -> Pair:
    """The vector (x, y) of a plane, turned by the angle cs = (cos, sin). Two angles: turn(a, *b) is a + b."""
    c, s = cs
    return c * x - s * y, s * x + c * y


def undo(cs: Pair) -> Pair:
    """The opposite angle."""
    return cs[0], -cs[1]


def angle(cs: Pair) -> np.ndarray:
    """The angle in (-pi, pi] of (cos, sin)."""
    t = np.arctan2(cs[1] + 0.0, cs[0])  # + 0.0: no -0, neither here nor in the angle
    other_end = t == -np.pi
    return np.where(other_end, np.pi, t) if other_end.any() else t


def _vectors(**named: ArrayLike) -> list[np.ndarray]:
    """The arguments as float arrays (..., 3), or a ValueError that names the wrong one."""
    return [checks.array(value, (3,), name) for name, value in named.items()]


def _dot(a, b):
    return (a * b).sum(axis=-1)
