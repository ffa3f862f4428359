"""A robot in the box: the numbers of its data sheet, and `fk` where the exercises allow it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import checks, lie

from .absent import names_of, refuse

_missing = names_of("robot.Robot")


class _Kind(type):
    """Where Robot.from_screws and the like are looked for."""

    def __getattr__(cls, name):
        return _missing(name)


class Robot(metaclass=_Kind):
    """S, M, name, joint_types, limits, home and tables; whatever is computed from them is absent."""

    S: np.ndarray
    M: np.ndarray
    n: int
    name: str

    def __init__(self, *args: object, **more: object) -> None:
        refuse("robot.Robot")

    def __getattr__(self, name):
        return _missing(name)

    def fk(self, theta: ArrayLike) -> np.ndarray:
        """theta (..., n) -> T (..., 4, 4), Lynch & Park, eq. 4.14."""
        theta = checks.joint_angles(theta, self.n, self.name)
        T = np.eye(4)
        for i in range(self.n):
            T = T @ lie.exp6(self.S[:, i] * theta[..., i : i + 1])
        return T @ self.M
