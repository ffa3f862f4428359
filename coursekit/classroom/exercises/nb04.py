"""Exercises of notebook 04: singularities."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics: nothing, numpy is enough.
ALLOW = ()


def _orthogonal(rng):
    return np.linalg.qr(rng.normal(size=(6, 6)))[0]


def _wrist_jacobian(rng):
    """J with its reference point at a wrist centre: the lower right block is 0."""
    J = rng.uniform(-1, 1, (6, 6))
    J[3:, 3:] = 0
    return (J,)


def _forearm(rng):
    return rng.choice([-1, 1]) * rng.uniform(0.03, 0.2), rng.uniform(0.3, 0.7)


def _arm(rng):
    """theta_2 and the lengths of an arm whose wrist centre can come to axis 1."""
    a1, a2, a3, d4, d6 = rng.uniform([0.02, 0.4, 0.02, 0.35, 0.05], [0.1, 0.6, 0.1, 0.6, 0.15])
    outwards = rng.uniform(-0.8, 0.8) * np.hypot(a3, d4)
    theta2 = -np.arccos(np.clip((outwards - a1) / a2, -0.95, 0.95))
    return theta2, [a1, a2, a3, d4, d6]


def _nearly_singular(rng):
    """J of size 1 or 1000; up to two singular values are nothing but rounding, one may be small."""
    sigma = rng.uniform(0.3, 2, 6)
    sigma[4] = rng.choice([1e-4, 0.5]) * sigma[0]
    zeros = rng.integers(0, 3)
    sigma[:zeros] = 2e-8 * sigma[5]
    return rng.choice([1, 1000]) * _orthogonal(rng) @ np.diag(sigma) @ _orthogonal(rng), 1e-6


def _singular(rng):
    sigma = np.append(rng.uniform(0.3, 2, 5), 0)
    return (_orthogonal(rng) @ np.diag(sigma) @ _orthogonal(rng),)


EXERCISES = [
    Exercise(
        "det_from_blocks(J)",
        points=2,
        draw=_wrist_jacobian,
        shape=(),
        tol=1e-9,
        hints=(
            Hint("no_sign", "the size is right: count how often two rows change places"),
            Hint("diagonal", "these are the blocks on the diagonal; one of them is 0, so look at the others"),
            Hint("sizes", "a block can be singular without being 0: take its determinant, not its size"),
            Hint("arm_only", "this is the arm's block alone: the wrist has its share in det J"),
        ),
    ),
    Exercise(
        "elbow_angle(a3, d4)",
        points=1,
        draw=_forearm,
        shape=(),
        compare="angle",
        tol=1e-7,
        unit="rad",
        hints=(
            Hint("inverted", "you exchanged the lengths: for a small offset a3 the angle must be small"),
            Hint("ratio", "this is the ratio of the lengths, not yet an angle"),
            Hint("sine", "a3 and d4 are the legs of the triangle; you took d4 for its longest side"),
            Hint("rounded", "rounded to three digits: near this pose that already costs a singular value"),
            Hint("sign", "the forearm must turn the other way to bring the wrist into line"),
        ),
    ),
    Exercise(
        "shoulder_theta3(theta2, lengths)",
        points=3,
        draw=_arm,
        shape=(),
        compare="angle",
        tol=1e-7,
        unit="rad",
        hints=(
            Hint("flange", "you brought the flange to axis 1; it is the wrist centre that must lie there"),
            Hint("rounded", "rounded to three digits, as in a printed table: return the full number"),
            Hint("no_a1", "axis 1 is not above axis 2: the length a1 between them is missing"),
            Hint("no_a3", "the forearm is not straight: its offset a3 is missing"),
            Hint("lower", "that is the other solution, with the wrist lower"),
            Hint("upwards", "a positive angle turns downwards here; you let it turn upwards"),
            Hint("sum", "this is theta2 + theta3, the angle of the forearm in the room"),
        ),
    ),
    Exercise(
        "rank(J, tol)",
        points=2,
        draw=_nearly_singular,
        shape=(),
        tol=0.1,
        samples=8,
        hints=(
            Hint("determinant", "a determinant tells 6 from less, but not 5 from 4, and it has a unit"),
            Hint(
                "absolute", "a fixed limit is too low for a large J: compare with the largest singular value"
            ),
            Hint("squares", "you compare squares of singular values with tol"),
            Hint("lost", "you counted the motions that are lost"),
        ),
    ),
    Exercise(
        "lost_motion(J)",
        points=2,
        draw=_singular,
        shape=(6,),
        compare="up_to_sign",
        hints=(
            Hint("joint_rates", "that is the joint motion that moves nothing; the lost motion is a twist"),
            Hint("v_first", "(omega; v): you exchanged the two halves"),
            Hint("row_of_u", "a row of U: the vectors you want are its columns"),
            Hint("easiest", "that is the motion which comes most easily: look at the other end of the list"),
        ),
    ),
]
