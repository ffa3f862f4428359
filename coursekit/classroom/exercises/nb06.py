"""Exercises of notebook 06: attitudes along a path, and how fast an arm may follow it."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics.
ALLOW = ("rotations.rotx", "rotations.roty", "rotations.rotz", "path.steps")


def _direction(rng):
    k = rng.normal(size=3)
    return k / np.linalg.norm(k)


def _attitude(rng):
    """A rotation: by less than a right angle, by more than a third of a turn, or by exactly a half turn."""
    k, kind = _direction(rng), rng.integers(3)
    if kind == 0:
        return (2 * np.outer(k, k) - np.eye(3),)
    angle = rng.uniform(0.3, 1.4) if kind == 1 else rng.uniform(2.3, 3.1)
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return (np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K,)


def _away_from_lock(rng):
    """A rotation whose pitch is at least 0.2 rad from a right angle."""
    yaw, roll = np.pi / 2 * rng.integers(-2, 2, 2) + rng.uniform(0.2, 1.3, 2)
    pitch = rng.choice([-1, 1]) * rng.uniform(0.2, 1.3)
    (cz, sz), (cy, sy), (cx, sx) = ((np.cos(a), np.sin(a)) for a in (yaw, pitch, roll))
    turns = [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]], [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]
    return (np.linalg.multi_dot([*turns, [[1, 0, 0], [0, cx, -sx], [0, sx, cx]]]),)


def _curve(rng):
    """A few points on a sphere, neighbours about a quarter radius apart, and its centre."""
    centre, radius = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.3, 0.7)
    first, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    angle = np.cumsum(rng.uniform(0.15, 0.35, int(rng.integers(4, 8))))
    sway = np.outer(np.sin(3 * angle + rng.uniform(0, 6)), 0.3 * np.cross(first, towards))
    points = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), towards) + sway
    return centre + radius * points / np.linalg.norm(points, axis=1, keepdims=True), centre


def _configurations(rng):
    """Configurations up to one and a half turns away, and limits: some narrow, some beyond half a turn."""
    n = int(rng.integers(2, 5))
    lower, upper = -rng.uniform(1.5, 4.5, n), rng.uniform(1.5, 4.5, n)
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (24, n)), lower, upper


def _motion(rng):
    """A joint path that crosses half a turn, uneven steps of the tool, another bound for every joint."""
    m, n = 12, int(rng.integers(3, 7))
    q = np.cumsum(rng.uniform(-0.2, 0.2, (m, n)), axis=0) + rng.uniform(-0.5, 0.5, n)
    q[:, rng.integers(n)] = np.pi - 0.6 + np.cumsum(rng.uniform(0.08, 0.2, m))
    points = np.cumsum(rng.normal(size=(m, 3)) * rng.uniform(0.01, 0.04, (m, 1)), axis=0)
    return q, points, rng.uniform(1.5, 6.0, n)


def _unit(f, args, q):
    return bool(abs(np.sum(q * q) - 1) < 1e-9)


def _half_as_fast(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q, points, v_max / 2), speed / 2))


def _turned_once(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q + 2 * np.pi, points, v_max), speed))


EXERCISES = [
    Exercise(
        "tool_frames(points, centre)",
        points=3,
        draw=_curve,
        shape=(None, 4, 4),
        unit="m",
        hints=(
            Hint("inward", "x points to the centre of the sphere; the outward normal leads away from it"),
            Hint("left_handed", "these axes are left-handed: x cross y is z, y cross x is not"),
            Hint(
                "y_not_perpendicular",
                "y is not perpendicular to x: a step between two points of a sphere is no tangent",
            ),
            Hint("x_along", "x and y have changed places: x is the normal, y the direction of motion"),
            Hint("about_origin", "the normal is measured from the origin; the sphere has its own centre"),
            Hint("no_last", "a pose is missing: the last point has one, too, with the step before it"),
            Hint(
                "last_copied",
                "the last y is a copy: take the step before it again, but the normal at the last point",
            ),
        ),
    ),
    Exercise(
        "quaternion(R)",
        points=3,
        draw=_attitude,
        shape=(4,),
        compare="up_to_sign",
        samples=6,
        hints=(
            Hint(
                "wrong_entries",
                "the second component takes the wrong entries of R, in the sums and below the fraction line",
            ),
            Hint("vector_first", "the order here is (w, x, y, z): yours ends with the scalar"),
            Hint(
                "roots_only",
                "a root has no sign: the signs of x, y and z are in the differences of entries of R",
            ),
            Hint(
                "lost_at_half_turn",
                "at half a turn the differences that give the signs vanish, and your vector part with them",
            ),
            Hint(
                "turned_back", "this is the inverse rotation: the differences are taken the other way round"
            ),
        ),
        laws=(("a unit quaternion has length 1", _unit),),
    ),
    Exercise(
        "zyx(R)",
        points=2,
        draw=_away_from_lock,
        shape=(3,),
        compare="angle",
        unit="rad",
        hints=(
            Hint("signs_flipped", "every angle has the wrong sign: check which entry carries the minus"),
            Hint("pitch_sign", "the pitch has the wrong sign: a positive turn about y lowers the x axis"),
            Hint("reversed", "the order here is (yaw, pitch, roll): yours begins with the turn about x"),
            Hint("arcsin", "an arcsin never leaves the right half of the circle; yaw and roll go all round"),
            Hint(
                "xyz",
                "these angles belong to the product Rx Ry Rz: here the turn about z stands first",
            ),
            Hint("degrees", "the answer is in radians: yours looks like degrees"),
        ),
    ),
    Exercise(
        "inside(theta, lower, upper)",
        points=2,
        draw=_configurations,
        shape=(None,),
        hints=(
            Hint(
                "no_turns",
                "whole turns are not tried: -174.72 degrees and 185.28 degrees are one place of the joint",
            ),
            Hint("wrapped", "wrapping to half a turn is not enough: a limit may lie beyond half a turn"),
            Hint("any_joint", "one joint inside is not enough: a configuration is inside if all joints are"),
            Hint("turns_up_only", "turns go both ways: above the upper limit a turn has to be taken off"),
        ),
    ),
    Exercise(
        "largest_speed(q, points, v_max)",
        points=3,
        draw=_motion,
        shape=(),
        unit="m/s",
        hints=(
            Hint(
                "wrapped",
                "angles wrapped before their differences: one that passes half a turn seems to jump by 2 pi",
            ),
            Hint("one_bound", "one bound for all joints: each joint has its own entry of v_max"),
            Hint(
                "mean",
                "a mean of the rates for their maximum: somewhere on the path a joint turns faster than that",
            ),
            Hint("one_step", "the steps of this path are not alike: divide each difference by its own step"),
            Hint("signed", "a joint that turns backwards counts, too: compare sizes"),
        ),
        laws=(
            ("with half the bounds the tool may go half as fast", _half_as_fast),
            ("a joint that begins a whole turn further on is no slower", _turned_once),
        ),
    ),
]
