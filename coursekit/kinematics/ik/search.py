"""Every solution that random starts find: for arms without a closed form, and honest about what that means.

Downhill from many random configurations (`engine.closest`); ends that agree are one solution. Nobody knows
what no start has led to, so the count is a lower bound. How often each solution was met tells how good it is:
where even the rarest was met many times, one that was never met would have to be much harder to find.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np  # but numpy.random, loaded where it is used: hence its name in quotes
from numpy.typing import ArrayLike

from .. import checks
from ..robot import Robot
from .engine import closest
from .iteration import check_settings

SAME_SOLUTION = 1e-3  # rad or m in every joint; at singular poses ends scatter by the root of the tolerance
STUCK = 1e-6  # smallest singular value of J_b; below it the joints can move while the tool rests
STROKE = 1.0  # m; how far from home a slide without limits is started


@dataclass(frozen=True, eq=False)
class Found:
    """What `search` found for one pose.

    theta      (k, n) distinct solutions, rad in (-pi, pi] or m, in the order of their joints
    hits       (k,) how many of the random starts ended at each
    isolated   (k,) False for one of a whole family: from there the joints can move while the tool rests
    tries      number of random starts
    """

    robot: Robot
    theta: np.ndarray
    hits: np.ndarray
    isolated: np.ndarray
    tries: int

    @cached_property
    def within_limits(self) -> np.ndarray:
        """Which solutions can be brought inside the joint limits by whole turns: bool (k,)."""
        return self.robot.within_limits(self.theta)

    @property
    def text(self) -> str:
        """The count in words: "at least 8 found; ..." """
        if not len(self.theta):
            return f"none found from {self.tries} random starts"
        starts = f"{self.hits.sum()} of {self.tries} random starts arrived"
        if not self.isolated.any():
            return f"endlessly many, {len(self.theta)} found (joints can move while the tool rests); {starts}"
        if not self.isolated.all():
            return f"at least {len(self.theta)} found, and endlessly many beside some of them; {starts}"
        return f"at least {len(self.theta)} found; {starts}, at each of them {self.hits.min()} or more"


def search(
    robot: Robot,
    T: ArrayLike,
    tries: int = 100,
    tol: float = 1e-10,
    rows: str = "all",
    starts: ArrayLike | None = None,
    rng: "np.random.Generator | None" = None,
) -> Found:
    """Distinct solutions for one pose, found downhill from random starts.

    Joint limits do not restrict the search; `within_limits` tells which solutions keep them. Raises
    ValueError for T not in SE(3) and settings that make no sense. None is found where T holds NaN.

    Parameters
    ----------
    robot : Robot
    T : (4, 4), the pose
    tries : number of starts: hinges anywhere on the circle, slides within their limits
    tol : rad and m, for the angle and the distance that are left
    rows : "all", or "linear": position alone
    starts : (m, n), configurations to begin from beside the random ones: such as solutions of a pose nearby
    rng : numpy Generator; None: np.random.default_rng(0)

    Returns
    -------
    Found

    Examples
    --------
    >>> from coursekit import ik, robots
    >>> kr6 = robots.kuka_kr6()
    >>> found = ik.search(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]))
    >>> found.text[:16], found.theta.shape
    ('at least 8 found', (8, 6))
    """
    T = checks.pose(checks.array(T, (4, 4), f"{robot.name}: T"), f"{robot.name}: T")
    if T.ndim != 2:
        raise ValueError(f"{robot.name}: search takes one pose (4, 4), got {T.shape}")
    check_settings(robot, tol, rows, tries=tries)
    rng = np.random.default_rng(0) if rng is None else rng
    turns = np.array([kind == "revolute" for kind in robot.joint_types])
    low = np.where(np.isfinite(robot.q_min), robot.q_min, robot.home - STROKE)
    high = np.where(np.isfinite(robot.q_max), robot.q_max, robot.home + STROKE)
    low, high = np.where(turns, -np.pi, low), np.where(turns, np.pi, high)
    begin = rng.uniform(low, high, (tries, robot.n))
    if starts is not None:
        begin = np.concatenate([checks.joint_angles(starts, robot.n, robot.name).reshape(-1, robot.n), begin])
    ends = closest(robot, np.broadcast_to(T, (len(begin), 4, 4)), begin, tol, rows)
    theta = ends.theta[ends.converged]
    theta = np.where(turns, -np.remainder(np.pi - theta, 2 * np.pi) + np.pi, theta)
    by_chance = np.flatnonzero(ends.converged) >= len(begin) - tries
    found, hits = _distinct(theta, turns, by_chance)
    order = np.lexsort(found.round(6).T[::-1])
    found, hits = found[order], hits[order]
    J = robot.jacobian_body(found)[:, 0 if rows == "all" else 3 :]
    enough = robot.n <= J.shape[1]
    isolated = np.linalg.svd(J, compute_uv=False)[:, -1] > STUCK if enough else np.zeros(len(found), bool)
    return Found(robot, found, hits, isolated, tries)


def _distinct(theta, turns, by_chance):
    """Solutions that differ, angles compared round the circle, and how often chance led to each."""
    found, hits = [], []
    while len(theta):
        apart = theta - theta[0]
        apart = np.where(turns, np.remainder(apart + np.pi, 2 * np.pi) - np.pi, apart)
        same = np.abs(apart).max(axis=-1) < SAME_SOLUTION
        found.append(theta[0])
        hits.append(by_chance[same].sum())
        theta, by_chance = theta[~same], by_chance[~same]
    return np.array(found).reshape(-1, len(turns)), np.array(hits, dtype=int)
