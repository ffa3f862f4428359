"""Questions and goals of notebook 05."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.question import Question


def _tenths(rng, low, high):
    """A number with one decimal, low to high."""
    return int(rng.integers(round(10 * low), round(10 * high) + 1)) / 10


QUESTIONS = [
    Question(
        name="recall_lever",
        draw=lambda rng: {
            "x": _tenths(rng, 0.2, 0.4),
            "z": _tenths(rng, 0.5, 0.9),
        },
        text="From notebook 02. A joint axis along +y passes through ({x}, 0, {z}) m. Its screw is "
        "(0, 1, 0; v). What is v, as a list of three numbers, in metres?",
        answer=lambda x, z: [-z, 0, x],
        slips={
            "That is w x q. v is -w x q: turn all signs.": lambda x, z: [z, 0, -x],
            "This is the point q itself.": lambda x, z: [x, 0, z],
        },
    ),
    Question(
        name="recall_rank",
        draw=lambda rng: {
            "values": str(
                rng.choice(
                    [
                        "1.9, 1.2, 0.8, 0.3, 0.04, 2e-14",
                        "1.7, 1.1, 0.6, 0.2, 3e-13, 8e-14",
                        "2.3, 1.4, 0.9, 0.5, 0.08, 4e-13",
                        "2.1, 1.6, 0.7, 0.03, 9e-14, 5e-14",
                    ]
                )
            )
        },
        text="From notebook 04. The singular values of a 6 x 6 Jacobian are {values}. What is its rank?",
        answer=lambda values: 6 - values.count("e-"),
        slips={"You counted the directions that are lost.": lambda values: values.count("e-")},
    ),
    Question(
        name="hinge_column",
        draw=lambda rng: {
            "x": _tenths(rng, 0.3, 0.6),
            "y": _tenths(rng, 0.1, 0.3),
            "X": _tenths(rng, 0.8, 1.1),
            "Y": _tenths(rng, 0.4, 0.7),
        },
        text="A planar 3R. The axis of joint 2 (along +z) passes through ({x}, {y}, 0) m, the tool is at "
        "({X}, {Y}, 0) m. What is v in column 2, as a list of three numbers, in metres?",
        answer=lambda x, y, X, Y: [y - Y, X - x, 0],
        slips={
            "Your cross product is reversed: w stands first.": lambda x, y, X, Y: [Y - y, x - X, 0],
            "The lever begins at the axis, not at the base.": lambda x, y, X, Y: [-Y, X, 0],
        },
    ),
    Question(
        name="slide_column",
        draw=lambda rng: {
            "c": float(rng.choice([0.6, 0.8])),
            "p": float(rng.choice([0.3, 0.5])),
        },
        text="A slide pushes along (0, {c}, s), a unit vector with s > 0. The tool is {p} m away from its "
        "line. What is the whole column (omega; v), as a list of six numbers?",
        answer=lambda c, p: [0, 0, 0, 0, c, float(np.sqrt(1 - c**2))],
        slips={
            "A slide turns nothing: its omega is 0.": lambda c, p: [0, c, float(np.sqrt(1 - c**2)), 0, 0, 0],
            "No lever enters: every point moves alike.": (
                lambda c, p: [0, 0, 0, 0, p * c, p * float(np.sqrt(1 - c**2))]
            ),
        },
    ),
    Question(
        name="body_column",
        draw=lambda rng: {
            "l1": _tenths(rng, 0.4, 0.8),
            "l2": _tenths(rng, 0.2, 0.3),
            "theta": int(rng.choice([90, -90])),
        },
        text="A planar 2R with links of {l1} m and {l2} m stands at theta_2 = {theta} degrees. What is v in "
        "column 1 of J_b, along the tool's axes, as a list of three numbers, in metres?",
        answer=lambda l1, l2, theta: [l1 * np.sin(np.radians(theta)), l2 + l1 * np.cos(np.radians(theta)), 0],
        slips={
            "The arm is bent: link 1 lies along the tool's y axis, not its x axis.": (
                lambda l1, l2, theta: [0, l1 + l2, 0]
            ),
            "The sign of the x part: joint 1 carries the tool to the side of link 1.": lambda l1, l2, theta: [
                -l1 * np.sin(np.radians(theta)),
                l2,
                0,
            ],
        },
    ),
    Question(
        name="read_rate",
        draw=lambda rng: {
            "a": float(rng.choice([0.6, 0.8])),
            "b": float(rng.choice([0.28, 0.96])),
            "x": _tenths(rng, 0.1, 0.4),
            "y": _tenths(rng, -0.5, -0.2),
        },
        text="T-dot T_o has the rows (0, -{a}, {b}, {x}), ({a}, 0, 0, {y}), (-{b}, 0, 0, 0), (0, 0, 0, 0). "
        "What is omega, as a list of three numbers?",
        answer=lambda a, b, x, y: [0, b, a],
        slips={
            "The sign: omega_z stands in row 2, column 1.": lambda a, b, x, y: [0, -b, -a],
            "This is v, the last column.": lambda a, b, x, y: [x, y, 0],
            "The order: (3,2), (1,3), (2,1) are x, y, z.": lambda a, b, x, y: [a, b, 0],
        },
    ),
    Question(
        name="payload",
        draw=lambda rng: {
            "m": int(rng.integers(2, 11)),
            "r": _tenths(rng, 0.4, 0.9),
            "angle": int(rng.choice([30, 60])),
        },
        text="An arm of {r} m turns about a level axis and stands {angle} degrees above the level. It holds "
        "{m} kg at its end. How large is the torque, in N m (g = 9.81 m/s^2)?",
        answer=lambda m, r, angle: 9.81 * m * r * np.cos(np.radians(angle)),
        slips={
            "Only the level part of the lever counts.": lambda m, r, angle: 9.81 * m * r,
            "Sine for cosine: upright it would need nothing.": lambda m, r, angle: (
                9.81 * m * r * np.sin(np.radians(angle))
            ),
            "A mass is no force: multiply by g.": lambda m, r, angle: m * r * np.cos(np.radians(angle)),
        },
        tolerance=0.02,
    ),
    Question(
        name="damping",
        draw=lambda rng: {"e": _tenths(rng, 0.3, 0.9), "step": _tenths(rng, 1.0, 1.4)},
        text="The error has length {e}. No step may be longer than {step} rad, whatever the singular values. "
        "What is the smallest k that promises this?",
        answer=lambda e, step: e / (2 * step),
        slips={
            "1/(2k) is the largest factor: do not forget the 2.": lambda e, step: e / step,
            "The other way round: more damping, shorter steps.": lambda e, step: step / (2 * e),
        },
        tolerance=0.003,
    ),
    Question(
        name="gain",
        draw=lambda rng: {"sigma": _tenths(rng, 1.5, 4.0)},
        text="The largest singular value of J is {sigma}. Below which gain g does the transpose method "
        "converge near the target?",
        answer=lambda sigma: 2 / sigma**2,
        slips={
            "sigma enters squared: once in J, once in J^T.": lambda sigma: 2 / sigma,
            "At this gain the error is gone in one step; it may be twice as large.": lambda sigma: (
                1 / sigma**2
            ),
        },
        tolerance=0.003,
    ),
    Question(
        name="test_slide",
        draw=lambda rng: {
            "r": _tenths(rng, 0.4, 0.7),
            "rate": int(rng.integers(2, 4)),
            "push": _tenths(rng, 0.3, 0.6),
        },
        text="A hinge turns at {rate} rad/s, the tool is {r} m from its axis. A slide pushes "
        "it at right angles to that motion, at {push} m/s. How fast is the tool, in m/s?",
        answer=lambda r, rate, push: float(np.hypot(r * rate, push)),
        slips={"The two velocities are at right angles.": lambda r, rate, push: r * rate + push},
        tolerance=0.006,
    ),
    Question(
        name="test_half_axes",
        draw=lambda rng: {"a": int(rng.choice([1, 4, 9])), "b": int(rng.choice([16, 25, 36, 49]))},
        text="The linear J J^T has the eigenvalues 0.0{a}, 0.{b} and 1. How fast is the tool in its slowest "
        "direction, in m/s, for joint rates of length 1?",
        answer=lambda a, b: np.sqrt(a) / 10,
        slips={"A half axis is the root of an eigenvalue.": lambda a, b: a / 100},
    ),
    Question(
        name="test_power",
        draw=lambda rng: {
            "f": 5 * int(rng.integers(3, 9)),
            "v": _tenths(rng, 0.2, 0.5),
            "rate": _tenths(rng, 0.6, 0.9),
        },
        text="One joint alone turns at {rate} rad/s; the tool moves at {v} m/s and pushes along its motion "
        "with {f} N. What torque does the joint give, in N m?",
        answer=lambda f, v, rate: f * v / rate,
        slips={"The powers are equal: torque times rate is force times speed.": lambda f, v, rate: f * v},
        tolerance=0.02,
    ),
    Question(
        name="test_left",
        draw=lambda rng: {"sigma": _tenths(rng, 0.1, 0.3), "k": _tenths(rng, 0.4, 0.7)},
        text="Damped least squares with k = {k}, along a direction with sigma = {sigma}. What share of the "
        "error is left after one step (of a linear arm)?",
        answer=lambda sigma, k: k**2 / (sigma**2 + k**2),
        slips={
            "This is what the step takes away.": lambda sigma, k: sigma**2 / (sigma**2 + k**2),
            "This is the factor of the step, in rad per unit of error.": lambda sigma, k: (
                sigma / (sigma**2 + k**2)
            ),
        },
        tolerance=0.003,
    ),
]

GOALS = {
    "a Jacobian three ways": [
        "jacobian_geometric",
        "jacobian_space",
        "transform_rate",
        "hinge_column",
        "slide_column",
        "read_rate",
    ],
    "its frames": ["tool_velocity", "body_column", "recall_lever"],
    "force to torques": ["torques", "payload", "test_power"],
    "ellipsoids": ["ellipsoid", "recall_rank", "test_half_axes"],
    "a damped run": ["dls_step", "dls_loop", "damping", "gain", "test_left"],
    "further: by differences": ["jacobian_by_differences"],
}
