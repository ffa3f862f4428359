"""Every configuration that reaches a pose, of any arm: by the closed form, or else found by restarts.

What is found by restarts is a lower bound, and an arm with joints to spare has endlessly many solutions: then
some that differ well are shown, and they are followed from one pose to the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import ik
from coursekit.kinematics.robot import Robot
from coursekit.view.chain import hinges

TRIES = 60  # random starts; for the arms of the catalogue they miss about one solution in a thousand
MOST = 8  # shown of endlessly many
ALIKE = 0.5  # rad or m; a solution that is nearer to one of before goes on from it


@dataclass(frozen=True, eq=False)
class Ways:
    """k ways to reach a pose.

    theta    (k, n) turned into the limits where that is possible; NaN for a branch that does not exist
    exists   (k,) bool
    inside   (k,) bool: exists, and keeps the limits
    names    k names
    reasons  k sentences: why a way is out, "" for one inside the limits
    count    how many there are, in words
    """

    theta: np.ndarray
    exists: np.ndarray
    inside: np.ndarray
    names: tuple[str, ...]
    reasons: tuple[str, ...]
    count: str


class Solver:
    """Finds the ways of one arm.

    closed   whether there is a formula;  why_not   what the arm lacks for it, "" where there is one
    rows     "all", or "linear": the last pose could be reached by its position alone
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.turns = hinges(robot)
        self.why_not = ""
        try:
            ik.analytic(robot, robot.M)
        except ik.NoClosedForm as error:
            self.why_not = error.condition
        self.closed = not self.why_not
        self.rows = "linear" if self.closed and robot.n < 6 else "all"

    def solve(self, T: ArrayLike, before: ArrayLike | None = None) -> Ways:
        """The ways to T (4, 4). before: (m, n), those of a pose nearby, which are followed."""
        before = np.empty((0, self.robot.n)) if before is None else np.asarray(before, float)
        return self._by_formula(T) if self.closed else self._by_restarts(T, before)

    def reaches(self, T: ArrayLike) -> np.ndarray:
        """Which poses T (..., 4, 4) the formula reaches, and which inside the limits: bool (2, ...)."""
        found = ik.analytic(self.robot, T)
        return np.stack([found.exists.any(axis=-1), found.within_limits.any(axis=-1)])

    def nearest(self, ways: Ways, theta: ArrayLike) -> int:
        """The number of the way nearest to theta (n,), angles compared round the circle; -1 where none is."""
        if not ways.exists.any():
            return -1
        away = np.linalg.norm(self.apart(ways.theta, np.asarray(theta, float)), axis=-1)
        return int(np.where(ways.exists, away, np.inf).argmin())

    def apart(self, a: np.ndarray, b: ArrayLike) -> np.ndarray:
        """a - b of configurations (..., n), angles round the circle."""
        return np.where(self.turns, np.remainder(a - b + np.pi, 2 * np.pi) - np.pi, a - b)

    def _by_formula(self, T):
        found = ik.analytic(self.robot, T)
        exists, inside = found.exists, found.within_limits
        count = f"{exists.sum()} of {len(exists)} solutions, {inside.sum()} inside the limits"
        theta = half_turns(found.turned)
        return Ways(theta, exists, inside, found.branches, found.reasons(), count)

    def _by_restarts(self, T, before):
        robot, starts = self.robot, before[~np.isnan(before).any(axis=-1)]
        self.rows = "all"
        found = ik.search(robot, T, TRIES, starts=starts)
        if not len(found.theta) and robot.n < 6:  # it cannot hold every rotation
            self.rows = "linear"
            found = ik.search(robot, T, TRIES, rows="linear", starts=starts)
        theta, endless = half_turns(robot.nearest_turn(found.theta)), not found.isolated.all()
        if endless:
            theta = self._some(theta, starts)
        inside = robot.within_limits(theta)
        names = tuple(f"solution {k + 1}" for k in range(len(theta)))
        reasons = tuple(ik.why_outside(robot, q) for q in theta)
        many = f"endlessly many, {len(theta)} of them shown" if endless else f"at least {len(theta)}"
        free = ", the rotation is free" if self.rows == "linear" else ""
        count = f"found by restarts: {many}{free}, {inside.sum()} inside the limits"
        return Ways(theta, np.ones(len(theta), bool), inside, names, reasons, count)

    def _some(self, theta, starts):
        """At most MOST of many: first what goes on from `starts`, then always the one that differs most."""
        theta = theta[np.argsort(~self.robot.within_limits(theta), kind="stable")]
        chosen: list[int] = []
        for start in starts[:MOST]:
            away = np.abs(self.apart(theta, start)).max(axis=-1, initial=0)
            away[chosen] = np.inf
            if len(away) and away.min() < ALIKE:
                chosen.append(int(away.argmin()))
        inside = self.robot.within_limits(theta)
        while len(chosen) < min(MOST, len(theta)):
            gaps = np.linalg.norm(self.apart(theta[:, None], theta[chosen][None]), axis=-1)
            score = gaps.min(axis=-1, initial=np.inf) if chosen else np.zeros(len(theta))
            score = np.where(inside, score + 100, score)  # those inside the limits first
            score[chosen] = -np.inf
            chosen.append(int(score.argmax()))
        return theta[chosen]


def half_turns(theta: np.ndarray) -> np.ndarray:
    """Half a turn is +180 degrees, whichever way rounding went."""
    return np.where(np.abs(theta + np.pi) < 1e-9, np.pi, theta)
