"""What robots can do where an exercise hands one over, and its list allows it.

This enters the box with the question itself, after all other exercises have been asked: a Jacobian in the box
would answer some of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import lie

if TYPE_CHECKING:
    from .robot import Robot


def jacobian_space(self: Robot, theta: ArrayLike) -> np.ndarray:
    """theta (..., n) -> (..., 6, n), rows (omega; v). Lynch & Park, eq. 5.11."""
    theta = np.asarray(theta, dtype=float)
    T, columns = np.eye(4), []
    for i in range(self.n):
        columns.append((lie.adjoint(T) @ self.S[:, i, None])[..., 0] + 0 * theta[..., :1])
        T = T @ lie.exp6(self.S[:, i] * theta[..., i : i + 1])
    return np.stack(columns, axis=-1)


def jacobian_body(self: Robot, theta: ArrayLike) -> np.ndarray:
    """theta (..., n) -> (..., 6, n), rows (omega; v), in the tool frame. Eq. 5.22."""
    return lie.adjoint(lie.inverse(self.fk(theta))) @ jacobian_space(self, theta)
