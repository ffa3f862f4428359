"""Rotations and four ways to write them: quaternion, ZYX (yaw, pitch, roll), XYX, and elementary turns.

The angle-axis product k theta is `lie.log3`. Every function takes batches: angles (...), R (..., 3, 3).
Where a representation is not unique (gimbal lock, half turn) one defined choice is made and documented.
"""

import numpy as np
from numpy.typing import ArrayLike

from . import checks

# Closer than this to a singular attitude (sine of the distance) two angles turn about the same line: one of
# them is set to 0 and the other carries both.
GIMBAL = 1e-12


def rotx(angle: ArrayLike) -> np.ndarray:
    """Turn about x. angle (...) rad -> R (..., 3, 3). Source: Lynch & Park, eq. 3.31.

    >>> rotx(np.pi / 2).round(12).tolist()
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
    """
    return _turn(angle, 1, 2)


def roty(angle: ArrayLike) -> np.ndarray:
    """Turn about y. angle (...) rad -> R (..., 3, 3).

    >>> roty(np.pi / 2).round(12).tolist()
    [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
    """
    return _turn(angle, 2, 0)


def rotz(angle: ArrayLike) -> np.ndarray:
    """Turn about z. angle (...) rad -> R (..., 3, 3).

    >>> rotz(np.pi / 2).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    return _turn(angle, 0, 1)


def _turn(angle, i, j):
    """The rotation that carries axis i towards axis j."""
    angle = checks.array(angle, (), "angle")
    R = np.zeros((*angle.shape, 3, 3))
    R[..., 0, 0] = R[..., 1, 1] = R[..., 2, 2] = 1
    R[..., i, i] = R[..., j, j] = np.cos(angle)
    R[..., j, i] = np.sin(angle)
    R[..., i, j] = -R[..., j, i]
    return R


def quaternion(R: ArrayLike) -> np.ndarray:
    """Unit quaternion (w, x, y, z) of a rotation. R (..., 3, 3) -> (..., 4), w >= 0.

    The symmetric matrix 4 q q' can be written with sums and differences of the entries of R. Each of its rows
    is a multiple of q; the longest one is divided by no small number: no angle loses digits (Shepperd 1978).
    At a half turn (w = 0) both signs are right: the first component that is not 0 is made positive.

    >>> quaternion(rotz(np.pi / 2)).round(6).tolist()
    [0.707107, 0.0, 0.0, 0.707107]
    """
    R = checks.array(R, (3, 3), "R")
    r = np.moveaxis(R, (-2, -1), (0, 1))
    x, y, z = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    a, b, c = r[0, 1] + r[1, 0], r[1, 2] + r[2, 1], r[2, 0] + r[0, 2]
    d0, d1, d2 = r[0, 0], r[1, 1], r[2, 2]
    rows = np.array(
        [
            [1 + d0 + d1 + d2, x, y, z],
            [x, 1 + d0 - d1 - d2, a, c],
            [y, a, 1 - d0 + d1 - d2, b],
            [z, c, b, 1 - d0 - d1 + d2],
        ]
    )
    longest = np.argmax(rows[range(4), range(4)], axis=0)
    q = np.take_along_axis(rows, longest[None, None], axis=0)[0]
    q = np.moveaxis(q / np.sqrt((q * q).sum(axis=0)), 0, -1)
    return q * _sign_of_first(q)[..., None]


def _sign_of_first(q):
    """+1 or -1: the sign of the first component that is not zero (NaN counts as positive)."""
    first = np.argmax(q != 0, axis=-1)[..., None]
    return np.where(np.take_along_axis(q, first, axis=-1)[..., 0] < 0, -1.0, 1.0)


def from_quaternion(q: ArrayLike) -> np.ndarray:
    """Rotation of a quaternion (w, x, y, z). q (..., 4), any length but 0 -> R (..., 3, 3).

    Raises ValueError for a quaternion of length 0: it has no direction.

    >>> from_quaternion([1, 0, 0, 1]).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    q = checks.array(q, (4,), "q")
    length = np.sqrt((q * q).sum(axis=-1, keepdims=True))
    if np.any(length == 0):
        raise ValueError("q must not be the zero quaternion: it stands for no rotation")
    w, x, y, z = np.moveaxis(q / length, -1, 0)
    return _matrix(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def zyx(R: ArrayLike) -> np.ndarray:
    """(yaw, pitch, roll) of R = rotz(yaw) roty(pitch) rotx(roll). R (..., 3, 3) -> (..., 3) rad.

    pitch in [-pi/2, pi/2], yaw and roll in (-pi, pi]. In gimbal lock (pitch = +-pi/2) only yaw -+ roll is
    defined: roll is set to 0. Source: Siciliano et al., section 2.4.2.

    >>> zyx(rotz(0.3) @ roty(-0.2) @ rotx(0.1)).round(12).tolist()
    [0.3, -0.2, 0.1]
    """
    r = np.moveaxis(checks.array(R, (3, 3), "R"), (-2, -1), (0, 1))
    cos_pitch = np.hypot(r[0, 0], r[1, 0])
    locked = cos_pitch < GIMBAL
    yaw = np.where(locked, np.arctan2(-r[0, 1], r[1, 1]), np.arctan2(r[1, 0], r[0, 0]))
    pitch = np.arctan2(-r[2, 0], cos_pitch)
    # Read after the yaw is undone, not from the last row: near the lock both then err together, and R holds.
    sin_roll = np.sin(yaw) * r[0, 2] - np.cos(yaw) * r[1, 2]
    cos_roll = np.cos(yaw) * r[1, 1] - np.sin(yaw) * r[0, 1]
    roll = np.where(locked, 0.0, np.arctan2(sin_roll, cos_roll))
    return np.stack([yaw, pitch, roll], axis=-1)


def from_zyx(angles: ArrayLike) -> np.ndarray:
    """R = rotz(yaw) roty(pitch) rotx(roll). angles (..., 3) = (yaw, pitch, roll) rad -> R (..., 3, 3).

    >>> zyx(from_zyx([0.3, -0.2, 0.1])).round(12).tolist()
    [0.3, -0.2, 0.1]
    """
    yaw, pitch, roll = np.moveaxis(checks.array(angles, (3,), "angles"), -1, 0)
    return rotz(yaw) @ roty(pitch) @ rotx(roll)


def xyx(R: ArrayLike) -> np.ndarray:
    """(a, b, c) of R = rotx(a) roty(b) rotx(c), b in [0, pi]. R (..., 3, 3) -> (..., 3) rad.

    The angles of a spherical wrist whose axes are x, y, x. Where b is 0 or pi only a +- c is defined: c is
    set to 0. The other solution is (a + pi, -b, c + pi). Source: TPK4170 report 2021, eqs. 4.17-4.21, with
    hypot(R12, R13) for the square root.

    >>> xyx(rotx(0.3) @ roty(0.6) @ rotx(-0.1)).round(12).tolist()
    [0.3, 0.6, -0.1]
    """
    r = np.moveaxis(checks.array(R, (3, 3), "R"), (-2, -1), (0, 1))
    sin_b = np.hypot(r[0, 1], r[0, 2])
    locked = sin_b < GIMBAL
    a = np.where(locked, np.arctan2(r[2, 1], r[1, 1]), np.arctan2(r[1, 0], -r[2, 0]))
    b = np.arctan2(sin_b, r[0, 0])
    # Read after the first turn is undone (see zyx), not from the first row.
    sin_c = -np.cos(a) * r[1, 2] - np.sin(a) * r[2, 2]
    cos_c = np.cos(a) * r[1, 1] + np.sin(a) * r[2, 1]
    c = np.where(locked, 0.0, np.arctan2(sin_c, cos_c))
    return np.stack([a, b, c], axis=-1)


def from_xyx(angles: ArrayLike) -> np.ndarray:
    """R = rotx(a) roty(b) rotx(c). angles (..., 3) = (a, b, c) rad -> R (..., 3, 3).

    >>> xyx(from_xyx([0.3, 0.6, -0.1])).round(12).tolist()
    [0.3, 0.6, -0.1]
    """
    a, b, c = np.moveaxis(checks.array(angles, (3,), "angles"), -1, 0)
    return rotx(a) @ roty(b) @ rotx(c)


def _matrix(rows):
    """Nested lists of arrays (...) -> one array (..., rows, columns)."""
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
