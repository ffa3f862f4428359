"""Inverse kinematics by iteration as the book writes it: three steps, and the loop around them.

All methods repeat theta <- theta + step(J_b, e), with the body Jacobian J_b and the body error
e = log(T_sb(theta)^-1 T_sd) = (omega; v).
Sources: Lynch & Park, Modern Robotics (2017), section 6.2; Panda programming assignment.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from .. import lie
from ..robot import Robot

IDENTITY = np.eye(6)
SINGULAR = 1e-12  # singular values below this share of the largest are rounding, and count as 0


def newton_step(J: ArrayLike, e: ArrayLike) -> np.ndarray:
    """J^+ e: the shortest step that would remove the error e of a linear arm. -> (..., n)

    J (..., m, n), e (..., m).
    J^+ is the pseudo-inverse: J^-1 for a square regular J. Source: Lynch & Park, section 6.2.2.

    >>> newton_step([[2.0, 0], [0, 4]], [2.0, 4]).round(6).tolist()
    [1.0, 1.0]
    """
    J, e = _step_arguments(J, e)
    return (np.linalg.pinv(J, rcond=SINGULAR) @ e[..., None])[..., 0]


def transpose_step(J: ArrayLike, e: ArrayLike, gain: float = 1.0) -> np.ndarray:
    """gain J^T e: steepest descent of |e|^2 / 2.

    Near a solution it converges for 0 < gain < 2 / sigma_max(J)^2, which depends on the unit of length: what
    converges in metres may diverge in millimetres.

    Parameters
    ----------
    J : (..., m, n)
    e : (..., m)
    gain : length of the step

    Returns
    -------
    step : (..., n)

    Examples
    --------
    >>> transpose_step([[2.0, 0], [0, 4]], [2.0, 4], gain=0.1).round(6).tolist()
    [0.4, 1.6]
    """
    J, e = _step_arguments(J, e)
    return gain * (np.swapaxes(J, -1, -2) @ e[..., None])[..., 0]


def dls_step(J: ArrayLike, e: ArrayLike, damping: ArrayLike) -> np.ndarray:
    """J^T (J J^T + k^2 I)^-1 e: a Newton step that stays short near singular poses.

    It minimises |J step - e|^2 + k^2 |step|^2.

    Parameters
    ----------
    J : (..., m, n)
    e : (..., m)
    damping : (...), k

    Returns
    -------
    step : (..., n)

    Examples
    --------
    >>> dls_step([[2.0, 0], [0, 4]], [2.0, 4], damping=0.0).round(6).tolist()
    [1.0, 1.0]
    """
    J, e = _step_arguments(J, e)
    Jt = J.swapaxes(-1, -2)
    k = np.asarray(damping, dtype=float)[..., None, None]
    identity = IDENTITY[: e.shape[-1], : e.shape[-1]]
    return (Jt @ np.linalg.solve(J @ Jt + k * k * identity, e[..., None]))[..., 0]


def _step_arguments(J: ArrayLike, e: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    J, e = np.asarray(J, dtype=float), np.asarray(e, dtype=float)
    if J.ndim < 2 or J.shape[-2:-1] != e.shape[-1:]:
        raise ValueError(f"J must be (..., m, n) and e (..., m), got {J.shape} and {e.shape}")
    return J, e


def by_the_book(
    robot: Robot,
    T: np.ndarray,
    theta: np.ndarray,
    step: Callable[[np.ndarray, np.ndarray], np.ndarray] = newton_step,
    max_iterations: int = 50,
    tol: float = 1e-10,
) -> tuple[np.ndarray, int]:
    """The loop itself, for one target, as the book writes it.

    The methods of `iteration` do the same for many targets at once, in a fraction of the time, and say what
    came of it. Source: Lynch & Park, section 6.2.2.

    Parameters
    ----------
    robot : Robot
    T : (4, 4), the target
    theta : (n,), rad or m, the guess
    step : function of (J_b, e) -> (n,)
    max_iterations : number of steps at most
    tol : rad and m, for the angle and the distance that are left

    Returns
    -------
    theta : (n,), the last configuration
    steps : how many it took

    Examples
    --------
    >>> from coursekit import ik, robots
    >>> kr6 = robots.kuka_kr6()
    >>> theta, steps = ik.by_the_book(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]), np.array([2, -1, -1, 2, 0.5, 0]))
    >>> (theta.round(6) + 0.0).tolist(), steps
    ([2.0, -1.0, -1.0, 2.5, 0.6, 0.0], 4)
    """
    for k in range(max_iterations):
        T_sb = robot.fk(theta)
        e = lie.log6(lie.inverse(T_sb) @ T)  # the body twist that would carry the tool to T in unit time
        angle, distance = np.linalg.norm(e[:3]), np.linalg.norm(T[:3, 3] - T_sb[:3, 3])
        if max(angle, distance) < tol:
            return theta, k
        theta = theta + step(robot.jacobian_body(theta), e)
    return theta, max_iterations


def trail(
    robot: Robot,
    T: np.ndarray,
    theta: np.ndarray,
    step: Callable[[np.ndarray, np.ndarray], np.ndarray] = newton_step,
    steps: int = 10,
) -> np.ndarray:
    """Every configuration of that loop, whether it arrives or not.

    Source: Lynch & Park, section 6.2.2.

    Parameters
    ----------
    robot, T, theta, step : as in `by_the_book`
    steps : how many

    Returns
    -------
    rows : (steps + 1, n), the guess first

    Examples
    --------
    >>> from coursekit import ik, robots
    >>> arm = robots.planar_2r()
    >>> rows = ik.trail(arm, arm.fk([0.4, 0.6]), np.array([0.3, 0.8]), steps=4)
    >>> rows.shape, rows[-1].round(9).tolist()
    ((5, 2), [0.4, 0.6])
    """
    rows = [np.array(theta, dtype=float)]
    for _ in range(steps):
        e = lie.log6(lie.inverse(robot.fk(rows[-1])) @ T)
        rows.append(rows[-1] + step(robot.jacobian_body(rows[-1]), e))
    return np.array(rows)
