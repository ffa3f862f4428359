"""Inverse kinematics by iteration: Newton-Raphson, the Jacobian transpose, damped least squares.

The steps and the loop are those of `book`, here for many targets at once, until the angle and the distance
that are left are below tol. Each finds one solution, and which one depends on the guess. Limits are not
enforced; `within_limits` tells whether the answer keeps them.
Sources: Lynch & Park, Modern Robotics (2017), section 6.2; Panda programming assignment.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np  # but numpy.random, loaded where it is used: hence its name in quotes
from numpy.typing import ArrayLike

from .. import checks
from ..robot import Robot
from .book import dls_step, newton_step, transpose_step
from .engine import Step, closest, iterate

CONVERGED = "converged"
LIMIT = "iteration limit: still coming nearer"
WANDERING = "iteration limit: wandering, no longer coming nearer"
CLOSEST = "not reached: this is the closest pose found"
DIVERGED = "diverged"
NOT_A_NUMBER = "not a number"

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


def newton(
    robot: Robot,
    T: ArrayLike,
    theta0: ArrayLike,
    max_iterations: int = 50,
    tol: float = 1e-10,
    rows: str = "all",
) -> Numeric:
    """Newton-Raphson: theta <- theta + J_b^+ e.

    Near a solution each step doubles the number of right digits; far from one, or near a singular pose, steps
    may be of any size. It does not find "the closest solution" of a target out of reach by itself: it
    wanders. Where it has not converged, a search downhill from its best pose therefore decides: if that ends
    short of the target, its end is the answer, with converged = False and the reason; if it gets there, the
    best pose of the iteration itself is the answer. Angles and distances count alike (1 rad as 1 m).

    Raises ValueError for T not in SE(3), wrong shapes, and settings that make no sense. NaN in, NaN out.
    Source: Lynch & Park, section 6.2.2.

    Parameters
    ----------
    robot : Robot
    T : (..., 4, 4), targets
    theta0 : (..., n), rad or m, guesses; (...) as for T, or one for all
    max_iterations : number of steps
    tol : rad and m, for the angle and the distance that are left
    rows : "all", or "linear": position alone, the rotation is free

    Returns
    -------
    Numeric

    Examples
    --------
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
    """The Jacobian transpose: theta <- theta + gain J_b^T e.

    Steepest descent: no inverse, no trouble at singular poses, and slow, since each step takes off a fixed
    share of the error. It converges only for 0 < gain < 2 / sigma_max(J_b)^2; see transpose_step. With
    rows="linear" and gain=1 it is the method of the Panda programming assignment (the rotation is left over).

    Parameters
    ----------
    robot, T, theta0, max_iterations, tol, rows : as in `newton`
    gain : length of the step

    Returns
    -------
    Numeric

    Examples
    --------
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
    rng: "np.random.Generator | None" = None,
) -> Numeric:
    """Damped least squares: theta <- theta + J^T (J J^T + k^2 I)^-1 e.

    Parameters
    ----------
    robot, T, theta0, tol, rows : as in `newton`
    damping : k, which keeps steps short near singular poses and slows convergence everywhere
        None: k shrinks with the error (k = 0.01 |e|) and no joint moves more than 0.8 rad a step: safe far
        away and as fast as Newton near the solution
    max_iterations : number of steps of each try
        None: 50 (20 with restarts; 1000 if damping is a number)
    restarts : how often a target that was not reached is tried again
        from a random configuration inside the joint limits
    rng : numpy Generator for the restarts; None: np.random.default_rng(0)

    Returns
    -------
    Numeric

    Examples
    --------
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
