"""Inverse kinematics in closed form: every configuration that reaches a pose, and why the others do not.

The derivation is in steps, what it needs of an arm in geometry.
Sources: TPK4170 report 2021, section 4; RPI mini project 3 (2021); Robotics I exam, 17 June 2019, ex. 1d.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .. import checks
from ..robot import Robot
from .geometry import TwoHinges, geometry
from .steps import (
    OFF_PLANE,
    elbow,
    needed,
    reach,
    solve,
    solve_planar,
    square,
    store,
    undo_joint1,
    without_hand,
)

CHUNK = 2048  # poses per block: the working set stays in the cache


@dataclass(frozen=True, eq=False)
class Solutions:
    """All solutions for one pose or a batch (...): k = 8 branches for a 6R arm, 2 for the planar arm.

    robot      the arm
    T          (..., 4, 4) the poses asked for
    theta      (..., k, n) rad in (-pi, pi]; NaN where a branch does not exist
    branches   k names; the words are explained in `analytic`
    """

    robot: Robot
    T: np.ndarray
    theta: np.ndarray
    branches: tuple[str, ...]

    @cached_property
    def exists(self) -> np.ndarray:
        """Which branches exist: bool (..., k)."""
        return ~np.isnan(self.theta[..., 0])

    @cached_property
    def within_limits(self) -> np.ndarray:
        """Which branches exist and can be brought inside the joint limits (by whole turns): bool (..., k)."""
        return self.robot.within_limits(self.theta)

    @cached_property
    def turned(self) -> np.ndarray:
        """theta, joints turned by whole turns into their limits where that is possible: (..., k, n)."""
        return self.robot.nearest_turn(self.theta)

    def nearest(self, theta0: ArrayLike) -> np.ndarray:
        """Number of the branch nearest to theta0 (..., n): int (...), -1 where no branch exists.

        Nearest by the root of the sum of squares, differences taken round the circle.
        """
        theta0 = checks.joint_angles(theta0, self.robot.n, self.robot.name)
        difference = np.abs(np.remainder(self.theta - theta0[..., None, :] + np.pi, 2 * np.pi) - np.pi)
        distance = np.where(self.exists, np.sqrt((difference**2).sum(axis=-1)), np.inf)
        return np.where(self.exists.any(axis=-1), distance.argmin(axis=-1), -1)

    def reasons(self, index: int | tuple[int, ...] = ()) -> tuple[str, ...]:
        """Why each branch of one pose is out: k sentences with numbers, "" for a branch inside the limits.

        index: which pose of the batch, an int or a tuple; not needed for a single pose.
        """
        batch = self.exists.shape[:-1]
        index = index if isinstance(index, tuple) else (index,)
        if len(index) != len(batch):
            raise ValueError(
                f"reasons needs the index of one pose: {len(batch)} numbers for a batch {batch}, got {index}"
            )
        missing = _why_missing(self.robot, self.T[index])
        return tuple(
            why_outside(self.robot, theta) if exists else reason
            for theta, exists, reason in zip(self.theta[index], self.exists[index], missing, strict=True)
        )


def analytic(robot: Robot, T: ArrayLike) -> Solutions:
    """Every configuration that puts the tool of the robot at T. T (..., 4, 4) -> Solutions.

    For arms with six hinges and a spherical wrist (or, as the UR5, three parallel axes). The 8 branches are
    named by what one sees:

    front, back            the wrist is on that side of axis 1 where it is at theta = 0; or joint 1 has turned
                           round and the arm bends backwards over it
    elbow-up, elbow-down   the elbow is above or below the line from shoulder to wrist, seen in the direction
                           of reach. Up is the direction of axis 1 that is nearer to z of the space frame
    no-flip, flip          joint 5 bends the hand away from axis 4 in its positive or its negative sense

    The shoulder is axis 2, the elbow axis 3, the wrist its centre (for three parallel axes: axis 4). A branch
    changes its name only in a singular pose. The planar arm has two branches, elbow-up (left of the line from
    axis 1 to the tool point) and elbow-down; only the position of T counts, its rotation is free.

    In singular poses: at the end of the reach both elbow branches exist and are equal; further out by more
    than rounding (subproblems.EDGE, about 1e-11 m) there is none. With the wrist on axis 1, theta_1 = 0 is
    taken. With the hand stretched out, the turn about axis 4 is taken to be 0 (for three parallel axes: such
    that the elbow is bent as nearly to 90 deg as can be), and joint 6 does the rest.

    NaN in, NaN out. Raises ValueError if T is not in SE(3), and NoClosedForm (a ValueError) for an arm of
    another kind: the text names the condition that fails.

    >>> from coursekit import ik, robots
    >>> kr6 = robots.kuka_kr6()
    >>> solutions = ik.analytic(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]))
    >>> bool(solutions.exists.all()), solutions.branches[2]
    (True, 'front elbow-down no-flip')
    >>> (solutions.theta[2].round(6) + 0.0).tolist()
    [2.0, -1.0, -1.0, 2.5, 0.6, 0.0]
    """
    g = geometry(robot)
    T = checks.pose(T, f"{robot.name}: T")
    flat = T.reshape(-1, 4, 4)
    planar = isinstance(g, TwoHinges)
    # reach, elbow, wrist, joint, pose: the poses come last in memory, because every step runs along them
    theta = np.empty((1, 2, 1, 2, len(flat)) if planar else (2, 2, 2, 6, len(flat)))
    for start in range(0, len(flat), CHUNK):
        block = slice(start, start + CHUNK)
        if isinstance(g, TwoHinges):
            solve_planar(g, flat[block], theta[..., block])
        else:
            solve(g, flat[block], theta[..., block])
    theta = np.moveaxis(theta, -1, 0).reshape(*T.shape[:-2], len(g.branches), robot.n)
    return Solutions(robot, T, theta, g.branches)


def first_joints(robot: Robot, p: ArrayLike) -> np.ndarray:
    """Joints 1 to 3 of an arm with a spherical wrist for the wrist centre p. p (..., 3) m -> (..., 4, 3) rad.

    The four solutions: front up, front down, back up, back down; NaN where there is none. The names are
    explained in `analytic`. Source: Robotics I exam, 17 June 2019, exercise 1d.

    >>> from coursekit import ik, robots
    >>> ik.first_joints(robots.kawasaki_s030(), [1.23, 0, 1.55])[0, :2].round(4).tolist()
    [0.0, 1.5708]
    """
    g = _spherical(robot, "first_joints")
    p = checks.array(p, (3,), f"{robot.name}: p")
    local = (p.reshape(-1, 3) - g.frame[:3, 3]) @ g.frame[:3, :3]
    t1, target = reach(g, local.T.reshape(3, 1, 1, 1, -1))
    theta = np.empty((2, 2, 1, 3, len(local)))
    store(theta, g, (t1, *elbow(g, target)))
    return np.moveaxis(theta, -1, 0).reshape(*p.shape[:-1], 4, 3)


def wrist_centre(robot: Robot, T: ArrayLike) -> np.ndarray:
    """Where axes 4, 5 and 6 meet when the tool is at T. T (..., 4, 4) -> (..., 3) m, space frame.

    >>> from coursekit import ik, robots
    >>> ik.wrist_centre(robots.kuka_kr6(), robots.kuka_kr6().M).round(6).tolist()
    [0.9, 0.0, 0.435]
    """
    g = _spherical(robot, "wrist_centre")
    T = checks.pose(T, f"{robot.name}: T")
    return T[..., :3, :3] @ g.point + T[..., :3, 3]


def _spherical(robot, function):
    g = geometry(robot)
    if isinstance(g, TwoHinges) or g.family != "spherical":
        raise ValueError(
            f"{robot.name}: {function} needs a spherical wrist: axes 4, 5 and 6 through one point"
        )
    return g


# -- why not ---------------------------------------------------------------------------------------------


def _why_missing(robot, T):
    """One sentence per branch for T (4, 4): what keeps the arm away. For branches that do not exist."""
    g = geometry(robot)
    if np.isnan(T).any():
        return ("the pose holds NaN",) * len(g.branches)
    if isinstance(g, TwoHinges):
        x, y, height = g.frame[:3, :3].T @ (T[:3, 3] - g.frame[:3, 3])
        if abs(height - g.height) > OFF_PLANE:
            return (f"the tool point would be {abs(height - g.height):.3g} m off the plane of the arm",) * 2
        return (_too_far_or_near(g, np.hypot(x, y), "tool point", "axis 1"),) * 2
    P, axis6, axis5 = needed(g, T[None])
    what = "wrist centre" if g.family == "spherical" else "crossing of axes 5 and 6"
    distance = float(np.hypot(P[0], P[2]).squeeze())
    if distance < abs(g.side):
        return (
            f"{what} is {distance:.3f} m from axis 1 and cannot come nearer than {abs(g.side):.3f} m",
        ) * 8
    t1, target = reach(g, P)
    if g.family == "parallel":
        what = "axis 4"
        target, _ = without_hand(g, target, undo_joint1(t1, axis6), undo_joint1(t1, axis5))
    distance = np.broadcast_to(np.sqrt(square(target)), (2, 2, 2, 1)).ravel()
    return tuple(_too_far_or_near(g, d, what, "axis 2") for d in distance)


def _too_far_or_near(g, distance, what, shoulder):
    upper, fore = np.hypot(*g.upper), np.hypot(*g.fore)
    if distance > upper + fore:
        return f"{what} is {_metres(distance - upper - fore)} beyond reach"
    return f"{what} is {_metres(abs(upper - fore) - distance)} too near {shoulder}"


def _metres(x):
    return f"{x:.3f} m" if x > 5e-4 else f"{x:.1e} m"


def why_outside(robot: Robot, theta: ArrayLike) -> str:
    """Which joints a configuration theta (n,) needs outside their limits, in words; "" where it keeps them.

    >>> from coursekit import robots
    >>> why_outside(robots.scara(), [0, 0, 0.5, 0])
    'joint 3 would need 500.0 mm; limits 0.0 to 210.0 mm'
    """
    sentences = []
    for i in np.flatnonzero(~robot.inside(theta)):
        per, unit = (180 / np.pi, "deg") if robot.joint_types[i] == "revolute" else (1000, "mm")
        needed, low, high = (per * q[i] for q in (robot.nearest_turn(theta), robot.q_min, robot.q_max))
        limits = f"limits {low:.1f} to {high:.1f} {unit}"
        sentences.append(f"joint {i + 1} would need {needed:.1f} {unit}; {limits}")
    return "; ".join(sentences)
