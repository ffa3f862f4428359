"""The steps of the analytic inverse kinematics, for many poses at once.

In the frame of the arm (see geometry) each step is one of the subproblems in a plane:

    joint 1        turns P until its side coordinate is what it was at theta = 0      subproblem 4
    joint 3        makes shoulder and P as far apart as they must be                  subproblem 3
    joint 2        turns the bent arm onto P                                          subproblem 1
    joints 4, 5    point axis 6 where the pose wants it                               subproblem 2
    joint 6        turns the hand about axis 6                                        subproblem 1

Steps 1, 3 and (4, 5) have two solutions each: 2 x 2 x 2 = 8 branches. Each step starts from what the ones
before it really did, so that a root that lost digits near a singular pose is made good by the next joint.

Vectors are tuples of arrays, angles are pairs (cos, sin), and arrays have the axes (reach, elbow, wrist,
pose), of length 1 where a step makes no difference.
"""

import numpy as np

from ..subproblems import EDGE, NOTHING, Number, Pair, angle, swing, turn, undo, unit
from .geometry import SixHinges, TwoHinges

Direction = tuple[Number, Number, Number]  # (forward, up, side) in the frame of the arm

DIGITS = 1e-15  # of a direction
OFF_PLANE = 1e-9  # m; a planar arm reaches points nearer than this to its plane

# Which root of a subproblem is which branch.
REACH = np.array([-1.0, 1.0]).reshape(2, 1, 1, 1)  # front, back
ELBOW = np.array([[-1.0, 1.0], [1.0, -1.0]]).reshape(2, 2, 1, 1)  # up and down change sides with the reach
WRIST = np.array([1.0, -1.0]).reshape(1, 1, 2, 1)  # no-flip, flip


def solve(g: SixHinges, T: np.ndarray, out: np.ndarray) -> None:
    """All branches for T (N, 4, 4) into out (2, 2, 2, 6, N)."""
    P, axis6, axis5 = needed(g, T)
    t1, target = reach(g, P)
    axis6, axis5 = undo_joint1(t1, axis6), undo_joint1(t1, axis5)
    if g.family == "spherical":
        t2, t3 = elbow(g, target)
        t23 = turn(t2, *t3)
        t4, t5, t6 = _wrist(g, _undo_arm(t23, axis6), _undo_arm(t23, axis5))
    else:
        target, (t234, t5, t6) = without_hand(g, target, axis6, axis5)
        t2, t3 = elbow(g, target)
        t4 = turn(undo(turn(t2, *t3)), *t234)
    store(out, g, (t1, t2, t3, t4, t5, t6))


def needed(g: SixHinges, T: np.ndarray) -> np.ndarray:
    """P and the directions of axes 6 and 5 that T asks for: (forward, up, side) each, in the arm's frame."""
    numbers = g.of_pose @ T.reshape(-1, 16).T
    return numbers.reshape(3, 3, 1, 1, 1, -1).swapaxes(0, 1)


def reach(g: SixHinges, P: np.ndarray) -> tuple[Pair, Pair]:
    """Joint 1, and P in the plane of the arm as seen from axis 2.

    Undoing joint 1 must give P the side coordinate that it had at theta = 0:
    sin t1 forward + cos t1 side = g.side.
    """
    forward, up, side = P
    t1 = swing(side, forward, g.side, REACH)
    return t1, (t1[0] * forward - t1[1] * side - g.shoulder, up)


def elbow(g: SixHinges | TwoHinges, target: Pair, side: np.ndarray = ELBOW) -> tuple[Pair, Pair]:
    """Joints 2 and 3 that bring the forearm's end to the target: rot(t2)(upper + rot(t3) fore) = target."""
    upper, fore = g.upper, g.fore
    c = 0.5 * (square(target) - square(upper) - square(fore))  # = upper . rot(t3) fore, the law of cosines
    t3 = swing(_dot(upper, fore), _cross(fore, upper), c, side)
    bent = turn(t3, *fore)
    bent = upper[0] + bent[0], upper[1] + bent[1]
    return unit(_dot(bent, target), _cross(bent, target)), t3


def _wrist(g, axis6, axis5, free=lambda: (1.0, 0.0), settle=lambda t4, doubt: t4):
    """Turns about axis 4, axis 5 and axis 6 that bring axes 6 and 5 to these directions.

    With b the angle from axis 4 to axis 6 about axis 5, axis 6 is (cos b, sin b sin t4, -sin b cos t4) along
    (axis 4, axis 5, their cross product). sin b comes from its two last components, not from cos b: near
    b = 0 that keeps all digits. `free()` is the turn about axis 4 where b = 0 or pi leaves it open, and
    `settle` chooses among turns that cannot be told apart near there: about axis 4, and by how much (rad).
    """
    u, v = _along(g.wrist, axis6), _along(g.wrist, axis5)
    sin_b = np.sqrt(u[1] * u[1] + u[2] * u[2])
    c4, s4 = -u[2], u[1]
    stretched = sin_b < NOTHING
    length = np.where(stretched, 1.0, sin_b)
    c4, s4 = WRIST * (c4 / length), WRIST * (s4 / length)
    if stretched.any():
        free_c, free_s = free()
        c4, s4 = np.where(stretched, free_c, c4), np.where(stretched, free_s, s4)
    if (sin_b < DIGITS / EDGE).any():  # elsewhere the edge of the reach is wider than the doubt
        c4, s4 = settle((c4, s4), DIGITS / length)
    sin_b = WRIST * sin_b
    across, beside = turn((c4, -s4), v[1], v[2])
    t6 = across, u[0] * beside + sin_b * v[0]
    return (c4, s4), turn(undo(g.bend), u[0], sin_b), t6


def without_hand(
    g: SixHinges, target: Pair, axis6: Direction, axis5: Direction
) -> tuple[Pair, tuple[Pair, Pair, Pair]]:
    """Three parallel axes: the sum of joints 2, 3 and 4, joints 5 and 6, and where that leaves axis 4."""

    def settle(t4, doubt):
        return _signed(_within_reach(g, target, _signed(t4, g.axis4), doubt), g.axis4)

    t234, t5, t6 = _wrist(g, axis6, axis5, lambda: _free_hand(g, target), settle)
    t234 = _signed(t234, g.axis4)  # about axis 4 -> about the side direction
    return _minus(target, turn(t234, *g.hand)), (t234, t5, t6)


def _free_hand(g, target):
    """Three parallel axes, hand stretched out: the turn about axis 4 that bends the elbow nearest 90 deg."""
    wanted = np.sqrt(square(g.upper) + square(g.fore))
    P, hand = np.sqrt(square(target)), np.sqrt(square(g.hand))
    distance = np.clip(wanted, np.abs(P - hand), P + hand)
    c = 0.5 * (P * P + hand * hand - distance * distance)
    return _signed(swing(_dot(target, g.hand), _cross(g.hand, target), c, 1.0), g.axis4)


def _within_reach(g, target, t234, doubt):
    """t234, turned by less than the doubt about it where that brings axis 4 into reach of the elbow.

    The hand then points as before: what it loses about axis 4 it gets back about axis 6.
    """
    hand = turn(t234, *g.hand)
    axis4 = _minus(target, hand)
    far, upper, fore = (np.sqrt(square(a)) for a in (axis4, g.upper, g.fore))
    miss = np.clip(far, np.abs(upper - fore), upper + fore) - far
    rate = -_cross(hand, axis4) / np.maximum(far, NOTHING)  # of far, as t234 turns
    by = np.where(np.abs(miss) < doubt * np.abs(rate), miss / np.where(rate == 0, 1.0, rate), 0.0)
    return turn((np.cos(by), np.sin(by)), *t234) if by.any() else t234


def undo_joint1(t1: Pair, x: Direction) -> Direction:
    """A direction (forward, up, side) as it was before joint 1 turned."""
    forward, side = turn(t1, x[0], x[2])  # turning against the joint is turning from forward to side
    return forward, x[1], side


def _undo_arm(t23, x):
    """A direction (forward, up, side) as it was before joints 2 and 3 turned."""
    return *turn(undo(t23), x[0], x[1]), x[2]


def store(out: np.ndarray, g: SixHinges | TwoHinges, turns: tuple[Pair, ...]) -> None:
    """Turns (cos, sin) in the frame of the arm -> joint angles in out (reach, elbow, wrist, joint, pose)."""
    missing = 0.0 * turns[1][0]  # NaN where joint 2 cannot reach: then no joint has an angle
    for joint, t in enumerate(turns):
        out[:, :, :, joint] = angle(_signed(t, g.signs[joint])) + missing


def solve_planar(g: TwoHinges, T: np.ndarray, out: np.ndarray) -> None:
    """Both branches for T (N, 4, 4) into out (1, 2, 1, 2, N)."""
    x, y, height = ((T[:, :3, 3] - g.frame[:3, 3]) @ g.frame[:3, :3]).T.reshape(3, 1, 1, 1, -1)
    x = np.where(np.abs(height - g.height) > OFF_PLANE, np.nan, x)
    store(out, g, elbow(g, (x, y), ELBOW[:1]))


# -- vectors of a plane: pairs (x, y) of numbers or arrays ----------------------------------------------


def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def square(a: Pair) -> Number:
    """|a|^2."""
    return _dot(a, a)


def _minus(a, b):
    return a[0] - b[0], a[1] - b[1]


def _signed(cs, sign):
    """The angle times +1 or -1."""
    return cs[0], sign * cs[1]


def _along(basis, x):
    """Components of x (3 arrays) along the rows of a constant basis; a coefficient 0 costs nothing."""
    return [sum(c * x_i for c, x_i in zip(row, x, strict=True) if c) for row in basis]
