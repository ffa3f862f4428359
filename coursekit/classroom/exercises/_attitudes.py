"""Rotations for the exercises of notebook 06: how their arguments are drawn."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np

from coursekit.classroom.exercise import Edge


def direction(rng):
    k = rng.normal(size=3)
    return k / np.linalg.norm(k)


def turn(k, angle):
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return (np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K,)


def attitude(rng):
    """A rotation by less than a right angle, or by more than a third of a turn."""
    return turn(direction(rng), rng.uniform(0.3, 1.4) if rng.integers(2) else rng.uniform(2.3, 3.1))


def small_turn(rng):
    """w is by far the largest."""
    return turn(direction(rng), rng.uniform(0.3, 0.8))


def large(axis):
    """A turn by more than a third of a turn about a line near one axis: that component is the largest."""

    def draw(rng):
        k = rng.choice([-1, 1], 3) * np.roll([0.8, 0.48, 0.36], axis)
        return turn(k, rng.uniform(2.3, 2.9))

    return draw


def large_and_negative(axis):
    """As `large`, but the largest component is negative: divided by it, w comes out negative, too."""
    k = np.roll([-0.8, 0.48, 0.36], axis)
    return lambda rng: turn(k, rng.uniform(2.3, 2.9))


def nearly_about(axis):
    """Nearly half a turn about nearly an axis: that component is the largest even if its size is wrong."""

    def draw(rng):
        k = rng.choice([-1, 1], 3) * np.roll([1.0, 0.03, 0.02], axis)
        return turn(k / np.linalg.norm(k), np.pi - rng.uniform(0.02, 0.04))

    return draw


def adding_up_to_nothing(rng):
    """w + x + y + z = 0: the lines of the table, added up, are a quaternion only elsewhere."""
    q = rng.normal(size=4)
    w, *v = q - q.mean()
    length = np.linalg.norm(v)
    return turn(np.array(v) / length, 2 * np.arctan2(length, w))


def _half_turn_along(k):
    return (2 * np.outer(k, k) - np.eye(3) + 0.0,)  # no -0.0, which has a sign after all


def half_turn(rng):
    return _half_turn_along(direction(rng))


def half_turn_in_a_plane(axis, side):
    """About a line square to this axis: its component is 0, and gives the two others no sign."""

    def draw(rng):
        a = side * rng.uniform(0.3, 1.2)
        return _half_turn_along(np.roll([0, np.cos(a), np.sin(a)], axis))

    return draw


HALF_TURNS_IN_A_PLANE = tuple(
    Edge(f"for half a turn about a line square to {'xyz'[axis]}", half_turn_in_a_plane(axis, side))
    for axis, side in product(range(3), (-1, 1))
)


def half_turn_about_nearly(largest, next_):
    """A line so near to an axis that of the two small components the larger one is lost in rounding."""
    return lambda rng: _half_turn_along(np.eye(3)[largest] + 1e-7 * np.eye(3)[next_])


HALF_TURNS_ABOUT_NEARLY_AN_AXIS = tuple(
    Edge(f"for half a turn about nearly {'xyz'[i]}", half_turn_about_nearly(i, k))
    for i, k in permutations(range(3), 2)
)


def half_turn_about(axis):
    return lambda rng: (np.diag(2 * np.eye(3, dtype=int)[axis] - 1),)


def nearly_half_a_turn(rng):
    return turn(direction(rng), np.pi - 1e-7)


def very_nearly_half_a_turn(rng):
    """So near that the arcsine of |(x, y, z)| takes it for half a turn."""
    return turn(direction(rng), np.pi - 2e-8)


def right_angles(rng):
    """Every axis on another one: a third of a turn, w = x = y = z."""
    return ([[0, 0, 1], [1, 0, 0], [0, 1, 0]],)


def quarter_turn(rng):
    c, s = 0, int(rng.choice([-1, 1]))
    return ([[c, -s, 0], [s, c, 0], [0, 0, 1]],)


def away_from_lock(rng, quarters=(-2, -1, 0, 1), pitch=(0.2, 1.3)):
    """A rotation whose pitch, up or down, lies between these two: it is never a right angle."""
    yaw, roll = np.pi / 2 * rng.choice(quarters, 2) + rng.uniform(0.2, 1.3, 2)
    pitch = rng.choice([-1, 1]) * rng.uniform(*pitch)
    return _turned_by(*map(_legs, (yaw, pitch, roll)))


def _legs(angle):
    return np.cos(angle), np.sin(angle)


def _turned_by(yaw, pitch, roll):
    """About z, y and x by these angles, whose cosines and sines are given."""
    (cz, sz), (cy, sy), (cx, sx) = yaw, pitch, roll
    turns = [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]], [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]
    return (np.linalg.multi_dot([*turns, [[1, 0, 0], [0, cx, -sx], [0, sx, cx]]]) + 0.0,)


def one_of_a_right_angle(which):
    """The yaw (0) or the roll (2) is -90 degrees, without rounding: its cosine is 0, and tells no sign."""

    def draw(rng):
        angles = rng.choice([-1, 1], 3) * rng.uniform(0.3, 0.9, 3)
        turns = list(map(_legs, angles))
        turns[which] = 0.0, -1.0
        return _turned_by(*turns)

    return draw


def tiny_turn(rng):
    """By 1e-7 rad: the arccosine of its trace keeps not one digit of that."""
    return turn(direction(rng), 1e-7)


def slight_angles(rng):
    angles = rng.choice([-1, 1], 3) * rng.uniform(2e-4, 5e-4, 3)
    return _turned_by(*map(_legs, angles))


RIGHT_AND_SLIGHT_ANGLES = (
    Edge("where the yaw is a right angle", one_of_a_right_angle(0)),
    Edge("where the roll is a right angle", one_of_a_right_angle(2)),
    Edge("for slight angles", slight_angles),
)
SLIGHT_TURNS = (
    Edge("for a slight turn", lambda rng: turn(direction(rng), 5e-4)),
    Edge("for a turn of some degrees", lambda rng: turn(direction(rng), 0.05)),
    Edge("for nearly half a turn", lambda rng: turn(direction(rng), np.pi - 5e-4)),
)
WHERE_SIGNS_ARE_LOST = *HALF_TURNS_IN_A_PLANE, SLIGHT_TURNS[0]  # of a quaternion
WHERE_AN_AXIS_IS_LOST = *HALF_TURNS_IN_A_PLANE[::2], *SLIGHT_TURNS


def between(t=None, R_0=None):
    """Two attitudes 0.5 to 2.4 rad apart, and where to stand between them."""

    def draw(rng):
        start = attitude(rng)[0] if R_0 is None else R_0
        end = start @ turn(direction(rng), rng.uniform(0.5, 2.4))[0]
        place = rng.choice([rng.uniform(0.15, 0.35), rng.uniform(0.65, 0.85)])
        return start, end, place if t is None else t

    return draw


def nothing_between(rng):
    """Rounding carries the trace of R^T R past 3, and the cosine past 1."""
    R = np.eye(3)
    while np.trace(R.T @ R) < 3 + 2e-15:
        R = attitude(rng)[0] @ attitude(rng)[0]
    return R, R, rng.uniform(0.2, 0.8)


def through_a_half_turn(rng):
    """2.8 rad one way, 2.8 the other: their quaternions with w > 0 lie far apart, the attitudes do not."""
    k = direction(rng)
    return turn(k, 2.8)[0], turn(k, -2.8)[0], rng.uniform(0.2, 0.4)


def close_together(rng):
    (R,) = attitude(rng)
    return R, R @ turn(direction(rng), 2e-4)[0], rng.uniform(0.2, 0.8)


def another_largest(rng):
    """First -x, then w: quaternions whose largest number is positive lie far apart."""
    back = np.array([-1, 0, 0])
    return turn(back, np.pi / 2 + 0.03)[0], turn(back, np.pi / 2 - 0.03)[0], rng.uniform(0.2, 0.4)


def far_apart(rng):
    (R,) = attitude(rng)
    return R, R @ turn(direction(rng), rng.uniform(2.8, 3.0))[0], rng.uniform(0.2, 0.4)


FAR_AND_NEAR = (
    Edge("for a large turn between them", far_apart),
    Edge("where R_1 is near R_0", close_together),
    Edge("where another number of the quaternion becomes the largest", another_largest),
)


def between_whole(rng):
    (R_0,), (R_1,) = quarter_turn(rng), right_angles(rng)
    return R_0, R_1, int(rng.integers(2))
