"""Exercises of 01_first_arm: what is asked, and what is said of a mistake. Students get this file."""

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint

# What a solution may call from coursekit.kinematics, for example "lie.exp6" or "rotations.rotz".
ALLOW = ()


def arm(rng):
    """Joint angles in radians, and two lengths in metres: other numbers for every example."""
    return rng.uniform(-2.5, 2.5, 2), rng.uniform(0.3, 0.8, 2)


EXERCISES = [
    # "fk_dh",  an exercise that ships is used by its name
    Exercise(
        "tip(theta, lengths)",
        points=2,
        draw=arm,
        shape=(2,),
        unit="m",
        edges=(Edge("for the stretched arm", lambda rng: (np.zeros(2), arm(rng)[1])),),
        blocks=(Block("x", 0), Block("y", 1)),
        hints=(  # each has a function in 01_first_arm_mistakes.py that makes the mistake
            Hint("degrees", "theta is in radians: your numbers are what degrees would give"),
            Hint(
                "not_added",
                "theta[1] turns from the first link: the second link stands at theta[0] + theta[1]",
            ),
            Hint("swapped", "x and y are swapped"),
        ),
    ),
]
