"""Questions and goals of notebook 03."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.question import Question


def _triangle(rng):
    """Sides with which a triangle exists, in mm."""
    return {
        "a2": int(rng.choice([400, 450, 500])),
        "a": int(rng.choice([380, 420, 440])),
        "b": int(rng.choice([500, 600, 700])),
    }


def _shoulder_angle(a2, a, b, sign=-1, side="a"):
    opposite, other = (a, a2) if side == "a" else (b, a)
    near = b if side == "a" else a2
    cosine = (near**2 + other**2 + sign * opposite**2) / (2 * near * other)
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def _first_column(rng):
    t4, t5 = rng.choice([-150, -120, -60, -30, 30, 60, 120, 150]), rng.choice([30, 60, 90])
    s = np.sin(np.radians(t5))
    return {
        "R11": round(float(np.cos(np.radians(t5))), 4) + 0.0,
        "R21": round(float(-s * np.sin(np.radians(t4))), 4),
        "R31": round(float(-s * np.cos(np.radians(t4))), 4),
    }


def _second_column(rng):
    a, b = rng.choice([-150, -120, -60, -30, 30, 60, 120, 150]), rng.choice([30, 60, 90])
    s = np.sin(np.radians(b))
    return {
        "R12": round(float(-s * np.cos(np.radians(a))), 4),
        "R22": round(float(np.cos(np.radians(b))), 4) + 0.0,
        "R32": round(float(s * np.sin(np.radians(a))), 4),
    }


def _atan2(y, x):
    return float(np.degrees(np.arctan2(y, x)))


QUESTIONS = [
    Question(
        name="point_of_b",
        draw=lambda rng: {
            "x": float(rng.choice([0.2, 0.3, 0.4])),
            "y": float(rng.choice([0.1, 0.5])),
            "h": float(rng.choice([0.15, 0.25])),
        },
        text="Frame b is turned by +90 degrees about z; its origin is at ({x}, {y}, 0) m in frame s. A point "
        "has the coordinates (0, {h}, 0) m in b. Its coordinates in s, T_sb p_b, three numbers in metres?",
        answer=lambda x, y, h: [x - h, y, 0],
        slips={
            "That is R turned the other way: y of b points along -x of s.": lambda x, y, h: [x + h, y, 0],
            "The rotation is missing: y of b is not y of s.": lambda x, y, h: [x, y + h, 0],
        },
    ),
    Question(
        name="axis_down",
        draw=lambda rng: {
            "x": float(rng.choice([0.2, 0.3])),
            "y": float(rng.choice([0.1, 0.4])),
        },
        text="A hinge along -z passes through ({x}, {y}, 0) m. The lower half of its screw, v = -w x q, "
        "three numbers?",
        answer=lambda x, y: [-y, x, 0],
        slips={
            "That is w x q: the minus sign is missing.": lambda x, y: [y, -x, 0],
            "That is q itself: v is at right angles to it.": lambda x, y: [x, y, 0],
        },
    ),
    Question(
        name="triangle_by_hand",
        draw=_triangle,
        text="A triangle: upper arm a2 = {a2} mm, elbow to P a = {a} mm, shoulder to P b = {b} mm. The angle "
        "alpha at the shoulder, in degrees (to 0.1)?",
        answer=_shoulder_angle,
        slips={
            "The square of the opposite side, a, is subtracted.": lambda a2, a, b: _shoulder_angle(
                a2, a, b, sign=1
            ),
            "That is beta, at the elbow: alpha is opposite a.": lambda a2, a, b: _shoulder_angle(
                a2, a, b, side="b"
            ),
        },
        tolerance=0.11,
    ),
    Question(
        name="wrist_by_hand",
        draw=_first_column,
        text="A wrist has R11 = {R11}, R21 = {R21} and R31 = {R31}. theta_4 in degrees, for the solution "
        "with theta_5 > 0?",
        answer=lambda R11, R21, R31: _atan2(-R21, -R31),
        slips={
            "Both entries carry a minus sign: that is the flipped solution.": lambda R11, R21, R31: _atan2(
                R21, R31
            ),
            "The sine comes first in atan2, and R21 holds the sine.": lambda R11, R21, R31: _atan2(
                -R31, -R21
            ),
            "Only one of the two entries lost its minus sign.": lambda R11, R21, R31: _atan2(R21, -R31),
        },
        tolerance=0.2,
    ),
    Question(
        name="yzy_wrist",
        draw=_second_column,
        text="A wrist turns about y, z and y: R = Ry(a) Rz(b) Ry(c). It has R12 = {R12}, R22 = {R22} and "
        "R32 = {R32}. The angle a in degrees, for the solution with b > 0?",
        answer=lambda R12, R22, R32: _atan2(R32, -R12),
        slips={
            "Multiply Ry(a) with (-sin b, cos b, 0): R12 has a minus, R32 has none.": lambda R12, R22, R32: (
                _atan2(R32, R12)
            ),
            "That is the flipped solution, with b < 0.": lambda R12, R22, R32: _atan2(-R32, R12),
            "The sine comes first in atan2, and R32 holds the sine.": lambda R12, R22, R32: _atan2(-R12, R32),
        },
        tolerance=0.2,
    ),
    Question(
        name="planar_3r",
        draw=lambda rng: {
            "l1": float(rng.choice([0.4, 0.5])),
            "l2": float(rng.choice([0.2, 0.3])),
            "l3": float(rng.choice([0.1, 0.15])),
        },
        text="A planar arm has three links of {l1}, {l2} and {l3} m and the angles (0, 90, 0) degrees. "
        "Column 1 is (1; -(l2 + l3), l1). Column 2, as (omega_z, v_x, v_y)?",
        answer=lambda l1, l2, l3: [1, -(l2 + l3), 0],
        slips={
            "The lever begins at joint 2, not at the base.": lambda l1, l2, l3: [1, -(l2 + l3), l1],
            "z x (0, h) is (-h, 0).": lambda l1, l2, l3: [1, l2 + l3, 0],
            "That is the lever p - q; v is z x (p - q).": lambda l1, l2, l3: [1, 0, l2 + l3],
        },
    ),
    Question(
        name="whole_turn",
        draw=lambda rng: {
            "limit": int(rng.choice([200, 205, 210])),
            "t": int(rng.choice([-170, -168, -165])),
        },
        text="Joint 6 goes from -20 to {limit} degrees. The formula says {t}. Which angle inside is the same "
        "attitude, in degrees?",
        answer=lambda limit, t: t + 360,
        slips={
            "That turns the other way round: only whole turns change nothing.": lambda limit, t: -t,
            "Half a turn is another attitude.": lambda limit, t: t + 180,
        },
    ),
    Question(
        name="speed_by_a_hinge",
        draw=lambda rng: {
            "h": float(rng.choice([0.3, 0.4])),
            "x": float(rng.choice([0.5, 0.6])),
            "z": float(rng.choice([0.7, 0.9])),
        },
        text="A hinge along +y passes through (0, 0, {h}) m, the tool point is at ({x}, 0, {z}) m. How fast "
        "does it move at 1 rad/s, (v_x, v_y, v_z) in m/s?",
        answer=lambda h, x, z: [z - h, 0, -x],
        slips={
            "That is (p - q) x w: the sign is reversed.": lambda h, x, z: [h - z, 0, x],
            "The lever begins at the axis: subtract its height.": lambda h, x, z: [z, 0, -x],
        },
    ),
    Question(
        name="other_wrist",
        draw=lambda rng: dict(
            zip(
                ("outer", "inner"),
                [("z", "y"), ("z", "x"), ("y", "x"), ("y", "z")][rng.integers(4)],
                strict=True,
            )
        ),
        text="A wrist turns about {outer}, then {inner}, then {outer} again: R = R{outer}(a) "
        "R{inner}(b) R{outer}(c). Which row and column of R hold all you need? "
        "(a) the first (b) the second (c) the third (d) none",
        answer=lambda outer, inner: {"y": "b", "z": "c"}[outer],
        slips={
            "That is the axis in the middle: look where cos b stands alone.": lambda outer, inner: {
                "x": "a",
                "y": "b",
                "z": "c",
            }[inner],
        },
    ),
    Question(
        name="farthest",
        draw=lambda rng: {
            "a2": int(rng.choice([400, 500])),
            "a3": int(rng.choice([50, 60])),
            "d4": int(rng.choice([300, 400])),
        },
        text="Upper arm {a2} mm, kink {a3} mm, forearm {d4} mm. How far from the shoulder can P be at most, "
        "in mm (to 1)?",
        answer=lambda a2, a3, d4: float(a2 + np.hypot(a3, d4)),
        slips={
            "The kink and the forearm are the legs of a right triangle.": lambda a2, a3, d4: a2 + a3 + d4,
        },
        tolerance=1.0,
    ),
]

GOALS = {
    "cut the problem at the wrist centre": ["point_of_b", "wrist_centre", "subproblem1"],
    "solve the triangle and the rotation": [
        "triangle_by_hand",
        "wrist_by_hand",
        "other_wrist",
        "yzy_wrist",
        "elbow_solutions",
        "wrist_angles",
    ],
    "list all solutions and test the limits": ["all_solutions", "whole_turn", "farthest"],
    "write a column of the Jacobian": ["axis_down", "planar_3r", "jacobian_column", "speed_by_a_hinge"],
    "search with Newton's method": ["newton_step"],
    "further: two more subproblems": ["subproblem2", "subproblem3"],
}
