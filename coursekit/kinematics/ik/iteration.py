"""Inverse kinematics by iteration: Newton-Raphson, the Jacobian transpose, damped least squares.

All three repeat theta <- theta + step(J_b, e), with the body Jacobian J_b and the body error
e = log(T_sb(theta)^-1 T_sd) = (omega; v), until the angle and the distance that are left are below tol. Each
finds one solution, and which one depends on the guess. Limits are not enforced; `within_limits` tells whether
the answer keeps them.
Sources: Lynch & Park, Modern Robotics (2017), section 6.2; Panda programming assignment.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .. import checks, lie
from ..robot import Robot
from .engine import Step, closest, iterate

CONVERGED = "converged"
LIMIT = "iteration limit: still coming nearer"
WANDERING = "iteration limit: wandering, no longer coming nearer"
CLOSEST = "not reached: this is the closest pose found"
DIVERGED = "diverged"
NOT_A_NUMBER = "not a number"

IDENTITY = np.eye(6)
SINGULAR = 1e-12  # singular values below this share of the largest are rounding, and count as 0
SHRINK = 1e-2  # damping without a number: k = SHRINK |e|, so that it all but vanishes at the solution
LEAST = 1e-7  # but never less than this: enough for J J^T + k^2 I to have an inverse at a singular pose
LONGEST = 0.8  # rad; no joint moves further in one step of that method


@dataclass(frozen=True, eq=False)
class Numeric:
    """What an iteration found, for one target or a batch (...).

    theta       (..., n) the solution, or the nearest that was found
    converged   (...) whether angle and distance are below the tolerance
    iterations  (...) number of steps, over all tries
    error       (..., 2) angle in rad and distance in m from the tool at theta to the target
    reason      (...) why it stopped, in words
    history     for a single target: one `Step` per step of the method, the guess first; else ()
    """

    robot: Robot
    T: np.ndarray
    theta: np.ndarray
    converged: np.ndarray
    iterations: np.ndarray
    error: np.ndarray
    reason: np.ndarray
    history: tuple[Step, ...] = ()

    @cached_property
    def within_limits(self) -> np.ndarray:
        """Whether theta can be brought inside the joint limits by whole turns: bool (...)."""
        return self.robot.within_limits(self.theta)


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
    """gain J^T e: steepest descent of |e|^2 / 2. J (..., m, n), e (..., m) -> (..., n).

    Near a solution it converges for 0 < gain < 2 / sigma_max(J)^2, which depends on the unit of length: what
    converges in metres may diverge in millimetres.

    >>> transpose_step([[2.0, 0], [0, 4]], [2.0, 4], gain=0.1).round(6).tolist()
    [0.4, 1.6]
    """
    J, e = _step_arguments(J, e)
    return gain * (np.swapaxes(J, -1, -2) @ e[..., None])[..., 0]


def dls_step(J: ArrayLike, e: ArrayLike, damping: ArrayLike) -> np.ndarray:
    """J^T (J J^T + k^2 I)^-1 e with k = damping: a Newton step that stays short near singular poses.

    J (..., m, n), e (..., m), damping (...) -> (..., n). It minimises |J step - e|^2 + k^2 |step|^2.

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
    """The loop itself, for one target T (4, 4), as the book writes it. -> (theta (n,), number of steps).

    The methods below do the same for many targets at once, in a fraction of the time, and say what came of
    it. Source: Lynch & Park, section 6.2.2.

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
    """Every configuration of that loop, whether it arrives or not: the guess first. -> (steps + 1, n)

    T (4, 4), theta (n,), step(J_b, e) -> (n,). Source: Lynch & Park, section 6.2.2.

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


def newton(
    robot: Robot,
    T: ArrayLike,
    theta0: ArrayLike,
    max_iterations: int = 50,
    tol: float = 1e-10,
    rows: str = "all",
) -> Numeric:
    """Newton-Raphson: theta <- theta + J_b^+ e. T (..., 4, 4), theta0 (..., n) -> Numeric, (...) broadcast.

    Near a solution each step doubles the number of right digits; far from one, or near a singular pose, steps
    may be of any size. It does not find "the closest solution" of a target out of reach by itself: it
    wanders. Where it has not converged, a search downhill from its best pose therefore decides: if that ends
    short of the target, its end is the answer, with converged = False and the reason; if it gets there, the
    best pose of the iteration itself is the answer. Angles and distances count alike (1 rad as 1 m).

    max_iterations  number of steps
    tol             rad and m, for the angle and the distance that are left
    rows            "all", or "linear": position alone, the rotation is free

    Raises ValueError for T not in SE(3), wrong shapes, and settings that make no sense. NaN in, NaN out.
    Source: Lynch & Park, section 6.2.2.

    >>> from coursekit import ik, robots
    >>> kr6 = robots.kuka_kr6()
    >>> found = ik.newton(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]), [2, -1, -1, 2, 0.5, 0])
    >>> bool(found.converged), (found.theta.round(6) + 0.0).tolist()
    (True, [2.0, -1.0, -1.0, 2.5, 0.6, 0.0])
    >>> [f"{step.error.max():.0e}" for step in found.history[:4]]
    ['5e-01', '3e-02', '7e-04', '9e-08']
    """
    return _solve(robot, T, theta0, newton_step, max_iterations, tol, rows)


def transpose(
    robot: Robot,
    T: ArrayLike,
    theta0: ArrayLike,
    gain: float = 0.5,
    max_iterations: int = 2000,
    tol: float = 1e-6,
    rows: str = "all",
) -> Numeric:
    """The Jacobian transpose: theta <- theta + gain J_b^T e. Arguments and result as `newton`.

    Steepest descent: no inverse, no trouble at singular poses, and slow, since each step takes off a fixed
    share of the error. It converges only for 0 < gain < 2 / sigma_max(J_b)^2; see transpose_step. With
    rows="linear" and gain=1 it is the method of the Panda programming assignment (the rotation is left over).

    >>> from coursekit import ik, robots
    >>> arm = robots.planar_2r()
    >>> found = ik.transpose(arm, arm.fk([0.3, 0.8]), [0.5, 0.5], rows="linear")
    >>> bool(found.converged), found.theta.round(3).tolist()
    (True, [0.3, 0.8])
    """
    if not gain > 0:
        raise ValueError(f"{robot.name}: gain must be positive, got {gain}")
    return _solve(robot, T, theta0, lambda J, e: transpose_step(J, e, gain), max_iterations, tol, rows)


def damped_least_squares(
    robot: Robot,
    T: ArrayLike,
    theta0: ArrayLike,
    damping: float | None = None,
    max_iterations: int | None = None,
    tol: float = 1e-10,
    rows: str = "all",
    restarts: int = 0,
    rng: np.random.Generator | None = None,
) -> Numeric:
    """Damped least squares: theta <- theta + J^T (J J^T + k^2 I)^-1 e. Arguments and result as `newton`.

    damping         a number: k, which keeps steps short near singular poses and slows convergence everywhere.
                    None: k shrinks with the error (k = 0.01 |e|) and no joint moves more than 0.8 rad a step:
                    safe far away and as fast as Newton near the solution
    max_iterations  number of steps of each try; None: 50 (20 with restarts; 1000 if damping is a number)
    restarts        how often a target that was not reached is tried again, from a random configuration
                    inside the joint limits
    rng             numpy Generator for the restarts; None: np.random.default_rng(0)

    >>> from coursekit import ik, robots
    >>> kr6 = robots.kuka_kr6()
    >>> bool(ik.damped_least_squares(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]), kr6.home).converged)
    True
    """
    if damping is not None and not damping > 0:
        raise ValueError(f"{robot.name}: damping must be positive (or None), got {damping}")
    check_settings(robot, tol, rows, restarts=restarts)
    rule = _careful_step if damping is None else lambda J, e: dls_step(J, e, damping)
    if max_iterations is None:
        max_iterations = 1000 if damping is not None else 20 if restarts else 50
    return _solve(robot, T, theta0, rule, max_iterations, tol, rows, restarts, rng)


def _careful_step(J, e):
    """dls_step with damping in proportion to the error, and no joint further than LONGEST."""
    step = dls_step(J, e, np.maximum(SHRINK * np.sqrt((e * e).sum(axis=-1)), LEAST))
    return step / np.maximum(np.abs(step).max(axis=-1, keepdims=True) / LONGEST, 1.0)


def _solve(robot, T, theta0, rule, max_iterations, tol, rows, restarts=0, rng=None):
    """Check, flatten the batch, iterate, try again, and say what came of it."""
    check_settings(robot, tol, rows, max_iterations=max_iterations)
    T = checks.pose(T, f"{robot.name}: T")
    theta0 = checks.joint_angles(theta0, robot.n, robot.name)
    try:
        batch = np.broadcast_shapes(T.shape[:-2], theta0.shape[:-1])
    except ValueError:
        shapes = f"T {T.shape[:-2]} and theta0 {theta0.shape[:-1]}"
        raise ValueError(f"{robot.name}: the batch axes of {shapes} do not broadcast") from None
    goals = np.broadcast_to(T, (*batch, 4, 4)).reshape(-1, 4, 4)
    guess = np.broadcast_to(theta0, (*batch, robot.n)).reshape(-1, robot.n)
    history = [] if batch == () else None

    state = iterate(robot, goals, guess, rule, max_iterations, tol, rows, history)
    rng = np.random.default_rng(0) if restarts and rng is None else rng
    for _ in range(restarts):
        again = np.flatnonzero(~state.converged & np.isfinite(state.score))
        if not len(again):
            break
        guess = _random_guess(robot, len(again), rng)
        attempt = iterate(robot, goals[again], guess, rule, max_iterations, tol, rows, history)
        nearer = attempt.score < state.score[again]
        state.iterations[again[~nearer]] += attempt.iterations[~nearer]
        state.take(again[nearer], attempt, nearer)

    reason = np.full(len(goals), WANDERING, dtype=object)
    reason[state.nearing] = LIMIT
    reason[state.diverged] = DIVERGED
    reason[state.converged] = CONVERGED
    reason[np.isinf(state.score)] = NOT_A_NUMBER
    failed = np.flatnonzero(~state.converged & np.isfinite(state.score))
    if len(failed):
        end = closest(robot, goals[failed], state.theta[failed], tol, rows)
        short = ~end.converged  # downhill all the way, and still not there
        state.take(failed[short], end, short)
        reason[failed[short]] = CLOSEST
    return Numeric(
        robot,
        T,
        state.theta.reshape(*batch, robot.n),
        state.converged.reshape(batch)[()],
        state.iterations.reshape(batch)[()],
        state.error.reshape(*batch, 2),
        reason.reshape(batch)[()],
        tuple(history or ()),
    )


def check_settings(robot: Robot, tol: float, rows: str, **counts: float) -> None:
    """A ValueError for settings that make no sense, with the robot's name."""
    if rows not in ("all", "linear"):
        raise ValueError(f'{robot.name}: rows must be "all" or "linear", got {rows!r}')
    for name, number in counts.items():
        if number != int(number) or number < 0:
            raise ValueError(f"{robot.name}: {name} must be 0 or a positive whole number, got {number}")
    if not tol > 0:
        raise ValueError(f"{robot.name}: tol must be positive, got {tol}")


def _random_guess(robot, count, rng):
    """Configurations inside the limits; where a hinge has none, within half a turn of home."""
    lower = np.where(np.isfinite(robot.q_min), robot.q_min, robot.home - np.pi)
    upper = np.where(np.isfinite(robot.q_max), robot.q_max, robot.home + np.pi)
    return rng.uniform(lower, upper, (count, robot.n))
