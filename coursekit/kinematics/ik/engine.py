"""The engine of the numeric inverse kinematics: from a configuration to the Jacobian and the error, and on.

It goes the same way, step by step, as the plain loop `book.by_the_book`, which says what is meant.
The methods are written with J_b and e = log(T_sb^-1 T_sd). Here both are taken along the axes of the space
frame, about the tool point: diag(R, R) J_b and diag(R, R) e. No step notices: J^+ e, J^T e and
J^T (J J^T + k^2 I)^-1 e stay as they are when J and e are turned together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .. import lie
from ..axes import cross
from ..robot import Robot

CHUNK = 2048  # targets per block: the working set stays in the cache
NEAR_PI = 1e-6  # rad; closer than this to half a turn the rotation vector is taken from the quaternion
TINY = 1e-200  # keeps 0/0 out of quotients whose limit is known
SETTLED = 1e-6  # `closest` ends where a step promises less than this share of the score
DOWNHILL = 100  # steps of `closest`
LEAST_DAMPING = 1e-13


@dataclass(frozen=True, eq=False)
class Step:
    """One pose of an iteration: theta (n,), error (2,) in rad and m, and how long the step there was."""

    theta: np.ndarray
    error: np.ndarray
    step: float


@dataclass(eq=False)
class State:
    """Where N targets stand: the best pose of each so far. score = angle^2 + distance^2 (or distance^2)."""

    theta: np.ndarray  # (N, n)
    error: np.ndarray  # (N, 2) rad, m
    score: np.ndarray  # (N,) infinite while there is none
    converged: np.ndarray  # (N,) bool
    iterations: np.ndarray  # (N,) int
    nearing: np.ndarray  # (N,) bool: the last pose is the best
    diverged: np.ndarray  # (N,) bool: numbers overflowed

    @classmethod
    def new(cls, N: int, n: int) -> State:
        """Nothing found yet."""
        theta, error, score = np.full((N, n), np.nan), np.full((N, 2), np.nan), np.full(N, np.inf)
        return cls(
            theta, error, score, np.zeros(N, bool), np.zeros(N, int), np.zeros(N, bool), np.zeros(N, bool)
        )

    def take(self, rows: np.ndarray, other: State, which: np.ndarray | slice = slice(None)) -> None:
        """Put `other`, where `which`, in place of the targets `rows`; iterations add up."""
        for key, mine in vars(self).items():
            theirs = getattr(other, key)[which]
            mine[rows] = mine[rows] + theirs if key == "iterations" else theirs


def iterate(
    robot: Robot,
    goals: np.ndarray,
    guess: np.ndarray,
    rule: Callable[[np.ndarray, np.ndarray], np.ndarray],
    max_iterations: int,
    tol: float,
    rows: str = "all",
    history: list[Step] | None = None,
) -> State:
    """theta <- theta + rule(J, e) from guess (N, n) towards goals (N, 4, 4). -> State.

    rows "linear": J without the rotation, and e is the way that the tool point has to go.
    history: a list that collects the Steps of a single target.
    """
    state = State.new(*guess.shape)
    used = slice(0 if rows == "all" else 3, 6)
    with np.errstate(all="ignore"):
        if len(goals) == 1:
            _iterate_one(robot, goals[0], guess[0], rule, max_iterations, tol, used, state, history)
        else:
            for start in range(0, len(goals), CHUNK):
                block = slice(start, start + CHUNK)
                part = State(*(array[block] for array in vars(state).values()))
                _iterate_block(robot, goals[block], guess[block], rule, max_iterations, tol, used, part)
    return state


def _iterate_block(robot, goals, theta, rule, max_iterations, tol, used, state):
    """Many targets: those that are done leave the block."""
    active, goals = np.arange(len(goals)), _arrays(goals)
    for k in range(max_iterations + 1):
        Jt, omega, v, gap, error = look(robot, theta, goals)
        error = np.stack(error, axis=-1)
        counted = error[:, used.start // 3 :]
        score = (counted * counted).sum(axis=-1)
        nearer = score < state.score[active]
        best = active[nearer]
        state.theta[best], state.error[best], state.score[best] = theta[nearer], error[nearer], score[nearer]
        state.nearing[active], state.iterations[active] = nearer, k
        done, lost = (counted < tol).all(axis=-1), ~np.isfinite(score)
        state.converged[active[done]], state.diverged[active[lost]] = True, True
        go_on = ~(done | lost)
        if k == max_iterations or not go_on.any():
            return
        e = np.stack([*omega, *v] if used.start == 0 else gap, axis=-1)
        J = np.swapaxes(Jt, -1, -2)[:, used]
        if not go_on.all():
            active, theta, J, e = active[go_on], theta[go_on], J[go_on], e[go_on]
            goals = goals[..., go_on]
        theta = theta + rule(J, e)


def _iterate_one(robot, goal, theta, rule, max_iterations, tol, used, state, history):
    """One target: the same in plain numbers, on which numpy's calls would cost more than the arithmetic."""
    goal, best, step = _numbers(goal), math.inf, 0.0
    for k in range(max_iterations + 1):
        Jt, omega, v, gap, error = look(robot, theta, goal)
        counted = error[used.start // 3 :]
        score = sum(x * x for x in counted)
        if history is not None:
            history.append(Step(theta, np.array(error), step))
        state.iterations[0], state.nearing[0] = k, score < best
        if score < best:
            best, state.theta[0], state.error[0], state.score[0] = score, theta, error, score
        state.converged[0], state.diverged[0] = max(counted) < tol, not math.isfinite(score)
        if state.converged[0] or state.diverged[0] or k == max_iterations:
            return
        change = rule(Jt.T[used], np.array([*omega, *v] if used.start == 0 else gap))
        theta, step = theta + change, math.sqrt(change @ change)


def closest(robot: Robot, goals: np.ndarray, theta: np.ndarray, tol: float, rows: str = "all") -> State:
    """Downhill from theta (N, n) to a minimum of angle^2 + distance^2 (rows "linear": distance^2). -> State.

    Levenberg-Marquardt: a damped least squares step counts only if it brings the tool nearer; the damping
    falls after each that does and rises after each that does not. So it never cycles.
    """
    used = slice(0 if rows == "all" else 3, 6)
    goals = _arrays(goals)

    def see(theta):
        Jt, omega, _, gap, error = look(robot, theta, goals)
        e = np.stack([*omega, *gap], axis=-1)[:, used]
        return theta, Jt[..., used], e, np.stack(error, axis=-1), (e * e).sum(axis=-1)

    hinges = np.array([kind == "revolute" for kind in robot.joint_types])
    # far turns have few digits
    theta = np.where(hinges, np.remainder(theta + np.pi, 2 * np.pi) - np.pi, theta)
    here, damping2 = see(theta), np.full(len(theta), 1e-2)
    with np.errstate(all="ignore"):
        for k in range(DOWNHILL + 1):
            theta, Jt, e, error, score = here
            H = np.swapaxes(Jt, -1, -2) @ Jt + damping2[:, None, None] * np.eye(Jt.shape[-1])
            step = (Jt @ np.linalg.solve(H, e[..., None]))[..., 0]
            gain = (step * (Jt @ e[..., None])[..., 0]).sum(axis=-1)  # what the step promises, to first order
            done = (error[:, used.start // 3 :] < tol).all(axis=-1)
            if k == DOWNHILL or (done | (gain < SETTLED * score)).all():
                break
            there = see(theta + step)
            good = there[-1] < score
            here = tuple(
                np.where(good.reshape(-1, *[1] * (a.ndim - 1)), a, b)
                for a, b in zip(there, here, strict=True)
            )
            # never none at all: J^T J of a planar arm has no inverse
            damping2 = np.maximum(damping2 * np.where(good, 0.25, 4.0), LEAST_DAMPING)
    state = State.new(*theta.shape)
    state.theta[:], state.error[:], state.score[:], state.converged[:] = theta, error, score, done
    return state


def look(robot: Robot, theta: np.ndarray, goal: np.ndarray | list) -> tuple:
    """J^T (N, n, 6) and what is left to do: omega, v, gap (3 each) and (angle, distance).

    theta (N, n) and goal = `_arrays` of N poses. omega and v are log(T_sb^-1 T_sd), gap is the way from the
    tool to the goal, all along the space frame. For one target, theta (n,) and goal = `_numbers` of its pose,
    arrays (N,) become plain numbers: the formulas are the same, `math` takes the place of numpy.
    """
    if theta.ndim == 2:
        J, tool = robot.links.screws(theta.T)
        J[3:] += cross(J[:3], tool[3][:, None])
        return np.ascontiguousarray(J.T), *_error(tool, goal, np)
    *frames, tool = (frame[:, :, 0].tolist() for frame in robot.links.along(theta[:, None]))
    # the same in plain numbers: column i of J is (z; (o - p) x z), (0; z) where it slides
    J = np.array([[*z, *cross(_minus(o, tool[3]), z)] for _, _, z, o in frames])
    for i in robot.links.sliding:
        turns, along = robot.links.turns[i], robot.links.slides[i] * J[i, :3]
        J[i, 3:], J[i, :3] = J[i, 3:] * turns + along, J[i, :3] * turns
    return J, *_error(tool, goal, math)


def _error(tool, goal, m):
    """omega, v, gap, (angle, distance) between two poses given by their columns; m: math or numpy.

    R = R_d R_b^T turns tool to goal. x cross x_d + y cross y_d + z cross z_d is 2 sin(angle) times its axis
    (Siciliano et al., eq. 3.95), and x . x_d + y . y_d + z . z_d = 1 + 2 cos(angle) its trace.
    v = p - 1/2 w x p + D w x (w x p) with D = (1 - t/2 cot t/2) / t^2 (Lynch & Park, eq. 3.92).
    """
    (x, y, z, p), (x_d, y_d, z_d, p_d) = tool, goal
    twice_sine = _plus(_plus(cross(x, x_d), cross(y, y_d)), cross(z, z_d))
    length = m.sqrt(_dot(twice_sine, twice_sine))
    trace = _dot(x, x_d) + _dot(y, y_d) + _dot(z, z_d)
    angle = m.atan2(length, trace - 1)
    k = (angle + 0.5 * TINY) / (length + TINY)
    omega = _times(k, twice_sine)
    half_turn = angle > math.pi - NEAR_PI
    if half_turn if m is math else half_turn.any():  # twice_sine has lost its direction
        omega = _from_quaternion(half_turn, omega, tool, goal)
    gap = _minus(p_d, p)
    once = cross(omega, gap)
    twice = cross(omega, once)
    # t/2 cot t/2 = t/2 (1 + cos t) / sin t
    D = (1 - 0.5 * k * (trace + 1)) / (angle * angle + TINY)
    v = _plus(gap, _plus(_times(-0.5, once), _times(D, twice)))
    return omega, v, gap, (angle, m.sqrt(_dot(gap, gap)))


def _from_quaternion(where, omega, tool, goal):
    """omega from lie.log3, which is exact at half a turn too, for the targets `where`."""
    # transposed, one per target
    R_b, R_d = (np.array(columns[:3]).reshape(3, 3, -1).T for columns in (tool, goal))
    exact = lie.log3(np.swapaxes(R_d, -1, -2) @ R_b).T
    return exact[:, 0].tolist() if where is True else np.where(where, exact, omega)


def _arrays(T):
    """Columns x, y, z, p of poses (..., N, 4, 4), each as 3 arrays (N,)."""
    return np.ascontiguousarray(np.moveaxis(T[..., :3, :], (-1, -2, -3), (-3, -2, -1)))


def _numbers(T):
    """Columns x, y, z, p of poses (..., 4, 4), each as 3 plain numbers."""
    return np.swapaxes(T[..., :3, :], -1, -2).tolist()


def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _plus(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _times(k, a):
    return k * a[0], k * a[1], k * a[2]


def _minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]
