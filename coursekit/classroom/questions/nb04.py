"""Questions and goals of notebook 04."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.question import Question


def _wave(rng):
    """a cos t + b sin t = c with a root; (a, b) is a multiple of (3, 4) or (4, 3), c half of its length."""
    a, b = [(3, 4), (4, 3), (6, 8), (8, 6)][rng.integers(4)]
    return {"a": a, "b": b, "c": float(np.hypot(a, b)) / 2}


def _root(a, b, c, side=-1, delta=1):
    return float(np.degrees(delta * np.arctan2(b, a) + side * np.arccos(c / np.hypot(a, b))))


QUESTIONS = [
    Question(
        name="slide_seen_from_the_tool",
        draw=lambda rng: {"speed": float(rng.choice([0.2, 0.3, 0.5]))},
        text="A slide along +x of the room runs at {speed} m/s. The tool frame is turned by +90 degrees "
        "about z: its x axis points along y of the room. The velocity (v_x, v_y, v_z) seen from the tool, "
        "in m/s?",
        answer=lambda speed: [0, -speed, 0],
        slips={
            "That is seen from the room: multiply by R transposed.": lambda speed: [speed, 0, 0],
            "That is R times v: it leads from the tool to the room.": lambda speed: [0, speed, 0],
        },
    ),
    Question(
        name="point_of_an_axis",
        draw=lambda rng: {"a": float(rng.choice([0.2, 0.4])), "b": float(rng.choice([-0.3, 0.5]))},
        text="A hinge has the screw (omega; v) = (0, 0, 1; {a}, {b}, 0). The point of its axis nearest to "
        "the origin, q = w x v, three numbers in metres?",
        answer=lambda a, b: [-b, a, 0],
        slips={
            "That is v x w: the order counts.": lambda a, b: [b, -a, 0],
            "That is v: the velocity of the origin, not a point of the axis.": lambda a, b: [a, b, 0],
        },
    ),
    Question(
        name="wave",
        draw=_wave,
        text="{a} cos t + {b} sin t = {c}. The smaller of the two roots, in degrees (to 0.1)?",
        answer=_root,
        slips={
            "That is the larger root: subtract the arccos.": lambda a, b, c: _root(a, b, c, side=1),
            "delta has the sign of b: here it is positive.": lambda a, b, c: _root(a, b, c, delta=-1),
            "Add delta: the wave is highest there, not at 0.": lambda a, b, c: _root(a, b, c, delta=0),
        },
        tolerance=0.11,
    ),
    Question(
        name="arm_of_the_wrist",
        draw=lambda rng: {
            "rho": float(rng.choice([2.0, 4.0, 5.0])),
            "v": float(rng.choice([0.1, 0.2])),
        },
        text="The wrist is {rho} mm from axis 1 and must move at {v} m/s across the plane of the arm. How "
        "fast does joint 1 turn, in rad/s?",
        answer=lambda rho, v: 1000 * v / rho,
        slips={
            "Metres and millimetres do not mix.": lambda rho, v: v / rho,
            "That is the distance over the speed.": lambda rho, v: rho / (1000 * v),
        },
        tolerance=0.1,
    ),
    Question(
        name="stretched_at",
        draw=lambda rng: {"a3": int(rng.choice([30, 40, 60])), "d4": int(rng.choice([400, 500]))},
        text="A forearm has the legs a3 = {a3} mm and d4 = {d4} mm. theta_3 of the stretched arm, in rad (to "
        "0.00001)?",
        answer=lambda a3, d4: float(np.arctan2(a3, d4)),
        slips={
            "That is the ratio, the tangent of the angle.": lambda a3, d4: a3 / d4,
            "The legs have changed places: a small a3 makes a small angle.": lambda a3, d4: float(
                np.arctan2(d4, a3)
            ),
            "d4 is a leg, not the longest side.": lambda a3, d4: float(np.arcsin(a3 / d4)),
        },
        tolerance=1.1e-5,
    ),
    Question(
        name="how_many_axes",
        draw=lambda rng: {"m": int(rng.choice([4, 5]))},
        text="{m} hinges of a six-axis arm pass through one point; the other axes are as different as can "
        "be. What is the rank of J?",
        answer=lambda m: 3 + 6 - m,
        slips={
            "Four or more axes through one point always span three dimensions only.": lambda m: 6,
            "These axes give three motions together; the others add theirs.": lambda m: 3,
            "One motion is lost for each axis beyond three.": lambda m: 6 - m,
        },
    ),
]

GOALS = {
    "split a determinant into wrist, elbow, shoulder": ["det_from_blocks"],
    "find singular angles exactly": ["elbow_angle", "wave", "shoulder_theta3", "stretched_at"],
    "count the motions that are left": ["point_of_an_axis", "rank", "how_many_axes"],
    "say which motion is lost": ["slide_seen_from_the_tool", "lost_motion"],
    "predict joint rates near a singularity": ["arm_of_the_wrist"],
    "further: the exam by hand": ["theta2_system"],
}
