"""Questions and goals of notebook 06."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.question import Question


def _inside(low, high, a, b, c):
    """How many of three angles keep the limits, whole turns allowed; degrees."""
    return sum(any(low <= x + turn <= high for turn in (-360, 0, 360)) for x in (a, b, c))


QUESTIONS = [
    Question(
        name="recall_place",
        draw=lambda rng: {
            "x": int(rng.integers(1, 4)) / 10,
            "y": int(rng.integers(1, 5)) / 10,
            "px": int(rng.integers(5, 9)) / 10,
        },
        text="From notebook 01. T_sb turns by 90 degrees about z and shifts to ({x}, {y}, 0) m. A point lies "
        "at ({px}, 0, 0) m in {{b}}. Where is it in {{s}}, as a list of three numbers, in metres?",
        answer=lambda x, y, px: [x, y + px, 0],
        slips={
            "The x axis of {b} points along y of {s}.": lambda x, y, px: [x + px, y, 0],
            "The turn leads from x to y, not from y to x.": lambda x, y, px: [x, y - px, 0],
        },
    ),
    Question(
        name="recall_rate",
        draw=lambda rng: {"r": int(rng.integers(2, 9)) / 10, "v": int(rng.integers(1, 7)) / 10},
        text="From notebook 05. One hinge alone moves the tool, {r} m away from its axis, at {v} m/s. How "
        "fast does it turn, in rad/s?",
        answer=lambda r, v: v / r,
        slips={"Speed is rate times lever: divide.": lambda r, v: v * r},
        tolerance=0.006,
    ),
    Question(
        name="projected",
        draw=lambda rng: {"Y": float(rng.choice([-0.5, 0.5, 1.0])), "Z": float(rng.choice([0.0, 0.5, 1.0]))},
        text="A point of the letter has Y = {Y}, Z = {Z}. Where on the sphere does it lie, as a list x, y, "
        "z, in metres (to three digits)?",
        answer=lambda Y, Z: (np.array([1, Y, Z]) / (1 + Y * Y + Z * Z) + [-0.5, 0, 0.5]).tolist(),
        slips={
            "This is the point of the plane, before the projection.": lambda Y, Z: [0.5, Y, 0.5 + Z],
            "x begins at the pole, -0.5; z at the centre, 0.5.": lambda Y, Z: (
                np.array([1, Y, Z]) / (1 + Y * Y + Z * Z)
            ).tolist(),
        },
        tolerance=1e-3,
    ),
    Question(
        name="component",
        draw=lambda rng: {
            "w": int(rng.integers(4, 9)) / 10,
            "r13": int(rng.integers(2, 5)) / 10,
            "r31": -int(rng.integers(5, 8)) / 10,
        },
        text="A rotation has w = {w}, r13 = {r13} and r31 = {r31}. What is y of its quaternion?",
        answer=lambda w, r13, r31: (r13 - r31) / (4 * w),
        slips={
            "The sign: 4wy = r13 - r31.": lambda w, r13, r31: (r31 - r13) / (4 * w),
            "The sum belongs to 4xz.": lambda w, r13, r31: (r13 + r31) / (4 * w),
            "Divide by 4w: the product stands there.": lambda w, r13, r31: r13 - r31,
        },
        tolerance=0.003,
    ),
    Question(
        name="trace",
        draw=lambda rng: {"trace": int(rng.choice([-1, 0, 1, 2]))},
        text="The trace of a rotation is {trace}. By what angle does it turn, in degrees?",
        answer=lambda trace: np.degrees(np.arccos((trace - 1) / 2)),
        slips={"Take 1 away before you halve.": lambda trace: np.degrees(np.arccos(trace / 2))},
        tolerance=0.1,
    ),
    Question(
        name="halfway",
        draw=lambda rng: {"a": 10 * int(rng.integers(14, 18)), "b": -10 * int(rng.integers(10, 16))},
        text="A tool turned by {a} degrees about z goes to {b} degrees about z on the short way. Where is it "
        "half way, in degrees from 0 to 360?",
        answer=lambda a, b: (a + b + 360) / 2,
        slips={
            "That is the middle of the long way: the short one leads through 180 degrees.": lambda a, b: (
                (a + b) / 2 % 360
            ),
            "That is how far it turns.": lambda a, b: (b + 360 - a) / 2,
        },
        tolerance=0.1,
    ),
    Question(
        name="one_step",
        draw=lambda rng: {
            "step": 5 * int(rng.integers(2, 6)),
            "one": int(rng.integers(3, 6)) / 100,
            "two": int(rng.integers(6, 12)) / 100,
        },
        text="In a step of {step} mm joint 1 turns by {one} rad and joint 2 by -{two} rad. Joint 1 may turn "
        "at 1 rad/s, joint 2 at 4 rad/s. How fast may the tool go, in m/s?",
        answer=lambda step, one, two: step / 1000 / max(one / 1, two / 4),
        slips={
            "The joint that turns most is not the one that limits: it may turn four times as fast.": (
                lambda step, one, two: step / 1000 / (two / 4)
            ),
            "Each joint has its own bound.": lambda step, one, two: step / 1000 / two,
            "The step is in millimetres.": lambda step, one, two: step / max(one, two / 4),
        },
        tolerance=0.006,
    ),
    Question(
        name="test_pitch",
        draw=lambda rng: {"r": int(rng.choice([-1, 1])) * int(rng.integers(3, 9)) / 10},
        text="Test. r31 = {r}. What is the pitch, in degrees?",
        answer=lambda r: -np.degrees(np.arcsin(r)),
        slips={"The sign: r31 is minus the sine.": lambda r: np.degrees(np.arcsin(r))},
        tolerance=0.1,
    ),
    Question(
        name="test_axis",
        draw=lambda rng: {"x": int(rng.integers(3, 8)) / 10, "z": int(rng.integers(8, 14)) / 10},
        text="Test. beta = ({x}, 0, {z}) rad. By what angle does it turn, in rad?",
        answer=lambda x, z: float(np.hypot(x, z)),
        slips={"Its length is the angle, not the sum of its components.": lambda x, z: x + z},
        tolerance=0.006,
    ),
    Question(
        name="test_limits",
        draw=lambda rng: {
            "a": int(rng.choice([-170, -185])),
            "b": int(rng.choice([210, 250])),
            "c": int(rng.choice([330, 350])),
        },
        text="Test. A joint has limits of -50 and 200 degrees. How many of the angles {a}, {b}, {c} degrees "
        "does it reach, whole turns allowed?",
        answer=lambda a, b, c: _inside(-50, 200, a, b, c),
        slips={"Try a whole turn up and down.": lambda a, b, c: sum(-50 <= x <= 200 for x in (a, b, c))},
    ),
    Question(
        name="test_bounds",
        draw=lambda rng: {"v": int(rng.integers(2, 7)) / 10, "factor": int(rng.integers(3, 6))},
        text="Test. At {v} m/s joint 6 just meets its bound; all others use at most half of theirs. Joint 6 "
        "is replaced by one {factor} times as quick. How fast may the tool go now at least, in m/s?",
        answer=lambda v, factor: 2 * v,
        slips={
            "Now another joint limits: it uses half of its bound at the old speed.": lambda v, factor: (
                v * factor
            )
        },
    ),
]

GOALS = {
    "frames along a curve": ["tool_frames", "recall_place", "projected"],
    "three forms of a rotation": ["zyx", "quaternion", "angle_axis", "component", "trace", "test_axis"],
    "from attitude to attitude": ["slerp", "halfway"],
    "continuous joint angles, inside the limits": ["next_on_branch", "inside", "test_limits"],
    "the largest speed": ["largest_speed", "one_step", "recall_rate", "test_bounds"],
}
