"""The letter that an arm draws in the explorer of a path, and how an arm of any kind follows it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import ik, path
from coursekit.kinematics.robot import Robot
from coursekit.view import text
from coursekit.view.chain import chain, ends_of
from coursekit.view.explorers.solver import Solver, Ways

SAMPLES = 101  # points by which it is decided which letter an arm can follow
TRACED, PULLED = 501, 101  # points at most where they are followed, or found, one after the other
SMALL = (0.3, 0.15, 0.07)  # height of the letter near the tool, as a part of the arm's length


@dataclass(frozen=True, eq=False)
class Followed:
    """Every way along a path: points (m, 3), q (k, m, n), and how many are reached and inside (k,)."""

    points: np.ndarray
    q: np.ndarray
    reached: np.ndarray
    inside: np.ndarray
    names: tuple[str, ...]


class Letter:
    """The curve for one arm: on the sphere, or where the arm cannot follow that, a smaller one near its tool.

    on_sphere  whether the tool stands upright on the sphere
    most       points that are followed in good time
    remarks    sentences for people: which letter it is, and what was found how
    turns      (n,) which joints are hinges
    """

    def __init__(self, robot: Robot, curve: ArrayLike | None = None) -> None:
        if robot.n < 2:
            raise ValueError(f"{robot.name} has one joint: its tool knows one curve only, and no letter")
        self.robot, self.curve, self.solver = robot, curve, Solver(robot)
        self.turns, self.on_sphere = self.solver.turns, True
        self.remarks: list[str] = []
        self.most: float = np.inf if self.solver.closed else TRACED
        self._ways: Ways | None = None  # at the first point, of an arm that is traced
        self._rows = "all"
        reached = self.follow(SAMPLES).reached.max(initial=0)
        if reached < SAMPLES and curve is not None:
            raise ValueError(
                f"{robot.name} cannot follow this path: it reaches {reached} of {SAMPLES} points"
            )
        if reached < SAMPLES:
            self._go_where_the_tool_can()
        if self._ways and not self.solver.closed:
            self.remarks.append(f"{self._ways.count}; each followed from point to point")

    def follow(self, n: int) -> Followed:
        """Every way along n points."""
        points, T = self._on_sphere(n) if self.on_sphere else self._near_tool(n)
        if self.solver.closed and self.on_sphere:
            q, names = path.follow(self.robot, T), ik.analytic(self.robot, T[0]).branches
        else:
            if self._ways is None:
                self._ways = self.solver.solve(T[0], None if self.on_sphere else self._start[None])
            ways = self._ways
            names = tuple(np.array(ways.names, dtype=object)[ways.exists])
            starts = ways.theta[ways.exists]
            if self.on_sphere and self.solver.rows == "linear":  # it cannot hold the tool upright
                starts, names = starts[:0], ()
            q = path.trace(self.robot, T, starts, self._rows)
        inside = self.robot.within_limits(q).sum(axis=-1)
        return Followed(points, q, path.points_reached(q), inside, names)

    def _on_sphere(self, n):
        points = path.s_curve(n) if self.curve is None else path.resample(self.curve, n)
        return points, path.frames(points)

    # -- a smaller letter --------------------------------------------------------------------------------

    def _go_where_the_tool_can(self):
        """Lay a flat letter where the tool moves freely; small enough, or pulled onto what can be reached."""
        robot, self.on_sphere = self.robot, False
        self._rows = "all" if robot.n >= 6 else "linear"
        self._start = _freest(robot)
        length = chain(robot).size
        for self._pulled, inside_too in ((False, True), (True, True), (False, False), (True, False)):
            self.most = PULLED if self._pulled else TRACED
            for share in SMALL:
                self._size, self._ways = share * length, None
                found = self.follow(SAMPLES)
                complete = found.reached == SAMPLES
                if np.any(complete & (found.inside == SAMPLES) if inside_too else complete):
                    self._say_where()
                    return
        raise ValueError(f"{robot.name} can follow neither the sphere nor a letter near its tool")

    def _say_where(self):
        size = text.millimetres(self._size, 0)
        rotation = (
            "the tool keeps its rotation" if self._rows == "all" else "the rotation of the tool is free"
        )
        where = "pulled onto the surface that its tool can reach" if self._pulled else "where its tool can go"
        self.remarks.append(
            f"not on the sphere, which it cannot follow: a letter of {size} {where}; {rotation}"
        )

    def _near_tool(self, n):
        """n points of a flat letter through the tool at `_start`, with the poses to follow."""
        T_0 = self.robot.fk(self._start)
        flat = path.resample(path.letter_s() * self._size, n)
        points = T_0[:3, 3] + flat @ _plane(self.robot, self._start)
        T = np.tile(T_0, (n, 1, 1))
        T[:, :3, 3] = points
        if self._pulled:
            theta = self._start
            for i in range(n):
                theta = ik.damped_least_squares(self.robot, T[i], theta, rows=self._rows).theta
                T[i] = self.robot.fk(theta)
            points = T[:, :3, 3]
        return points, T


def _freest(robot):
    """Of some configurations inside the limits, the one whose tool point moves most freely."""
    low, high = ends_of(robot)
    middle, half = (low + high) / 2, 0.35 * (high - low)  # not at the ends
    some = middle + np.random.default_rng(0).uniform(-half, half, (300, robot.n))
    sigma = np.linalg.svd(robot.jacobian_geometric(some)[:, 3:], compute_uv=False)
    directions = min(2 if sigma[:, -1].max() < 1e-6 else 3, robot.n)
    return some[sigma[:, directions - 1].argmax()]


def _plane(robot, theta):
    """Two unit vectors (2, 3) of the plane in which the tool point moves best, the second pointing up."""
    normal = np.linalg.svd(robot.jacobian_geometric(theta)[3:])[0][:, 2]
    level = abs(normal[2]) > 0.9
    up = np.array([0.0, 1, 0]) if level else np.array([0, 0, 1.0])
    up = up - normal * (normal @ up)
    up = up / np.linalg.norm(up)
    return np.stack([np.cross(up, normal), up])
