"""What a function may be given: every error here says what was expected, what came, and for whom."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

# The default of a dataclass field that __post_init__ fills: None at first, then what the field's type says.
NOT_GIVEN: Any = None

POSE_TOLERANCE = 1e-6  # how far from a rotation the upper left block of a pose may be (R'R - I, max abs)
UNIT = 1e-9  # how far from 1 the length of a direction may be that is given as a unit vector


def array(value: ArrayLike, shape: tuple[int, ...], name: str) -> np.ndarray:
    """`value` as a float array whose last axes are `shape`; a ValueError says what came instead.

    shape: tuple of ints, the trailing axes; leading (batch) axes are free.

    >>> array([1, 2, 3], (3,), "w").tolist()
    [1.0, 2.0, 3.0]
    """
    try:
        result = np.asarray(value, dtype=float)
    except (TypeError, ValueError) as error:
        expected = _words(shape)
        raise ValueError(f"{name} must be an array of real numbers of shape {expected}: {error}") from None
    if result.shape[result.ndim - len(shape) :] != shape or result.ndim < len(shape):
        raise ValueError(f"{name} must have shape {_words(shape)}, got {result.shape}")
    return result


def joint_angles(theta: ArrayLike, n: int, robot_name: str) -> np.ndarray:
    """theta as a float array (..., n), or a ValueError that names the robot."""
    try:
        result = np.asarray(theta, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{robot_name}: theta must be {n} numbers, one per joint: {error}") from None
    if result.shape[-1:] != (n,):
        raise ValueError(f"{robot_name} has {n} joints: theta must have shape (..., {n}), got {result.shape}")
    return result


def pose(T: ArrayLike, name: str) -> np.ndarray:
    """T as a float array (..., 4, 4) in SE(3); a ValueError says which condition fails.

    NaN passes (it is data that is missing, not an error): whatever is computed from it is NaN.
    """
    T = array(T, (4, 4), name)
    R = T[..., :3, :3]
    error = np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3))
    if np.any(error > POSE_TOLERANCE):
        worst = np.nanmax(error)
        raise ValueError(
            f"{name} is not in SE(3): R'R differs from the identity by {worst:.2g} in its rotation R"
        )
    (a, b, c), (d, e, f), (g, h, i) = np.moveaxis(R, (-2, -1), (0, 1))
    # np.linalg.det takes ten times as long
    if np.any(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0):
        raise ValueError(f"{name} is not in SE(3): det R = -1, so R is a reflection, not a rotation")
    if np.any(np.abs(T[..., 3, :] - [0, 0, 0, 1]) > POSE_TOLERANCE):
        raise ValueError(f"{name} is not in SE(3): its last row must be 0 0 0 1")
    return T


def rotation(R: ArrayLike, name: str) -> np.ndarray:
    """R as a float array (..., 3, 3) in SO(3); a ValueError says which condition fails. NaN passes."""
    R = array(R, (3, 3), name)
    T = np.zeros((*R.shape[:-2], 4, 4))
    T[..., :3, :3], T[..., 3, 3] = R, 1
    try:
        pose(T, name)
    except ValueError as error:
        raise ValueError(str(error).replace("SE(3)", "SO(3)")) from None
    return R


def frozen(value: ArrayLike, name: str, shape: tuple[int, ...] | None = None) -> np.ndarray:
    """A read-only float copy of `value`, of exactly `shape` (None leaves the shape free)."""
    result = np.array(value, dtype=float) if shape is None else np.array(array(value, shape, name))
    if shape is not None and result.shape != shape:
        raise ValueError(f"{name} must have shape {shape}, got {result.shape}")
    result.setflags(write=False)
    return result


def _words(shape):
    return "(" + ", ".join(["...", *map(str, shape)]) + ")"
