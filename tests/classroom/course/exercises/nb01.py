"""A small course for the tests: a planar arm with two joints."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

ALLOW = ("rotations.rotz",)


def _arm(rng):
    return rng.uniform(-3, 3, 2), rng.uniform(0.5, 1.5), rng.uniform(0.3, 1.2)


def _reachable(rng):
    theta, l1, l2 = _arm(rng)
    theta = np.array([theta[0], rng.uniform(0.3, 2.5)])
    x = l1 * np.cos(theta[0]) + l2 * np.cos(theta.sum())
    y = l1 * np.sin(theta[0]) + l2 * np.sin(theta.sum())
    return [x, y], l1, l2


def _reaches(f, args, value):
    p, l1, l2 = args
    a, b = value
    return bool(
        np.allclose([l1 * np.cos(a) + l2 * np.cos(a + b), l1 * np.sin(a) + l2 * np.sin(a + b)], p, atol=1e-6)
    )


EXERCISES = [
    Exercise(
        "fk(theta, l1, l2)",
        points=2,
        draw=_arm,
        shape=(2,),
        unit="m",
        n=8,
        timeout=3,
        hints=(
            Hint("degrees", "theta is in radians: your numbers are what degrees would give"),
            Hint("absolute", "theta[1] is measured from the first link: use theta[0] + theta[1]"),
            Hint("swapped", "x and y are swapped"),
        ),
    ),
    Exercise(
        "jacobian(theta, l1, l2)",
        points=3,
        draw=_arm,
        shape=(2, 2),
        unit="m",
        n=8,
        timeout=3,
        hints=(Hint("first_row", "d cos = - sin: the first row has the other sign"),),
    ),
    Exercise(
        "ik(p, l1, l2)",
        points=3,
        draw=_reachable,
        shape=(2,),
        compare="any_solution",
        unit="rad",
        n=8,
        timeout=3,
        laws=(("your joint angles do not reach the point", _reaches),),
        hints=(Hint("atan_swapped", "arctan2 takes y first"),),
    ),
    Exercise(
        "ik_all(p, l1, l2)",
        points=4,
        draw=_reachable,
        shape=(None, 2),
        compare="set",
        unit="rad",
        n=8,
        timeout=3,
        hints=(Hint("one_only", "there is a second elbow"), Hint("double", "one solution is counted twice")),
    ),
]
