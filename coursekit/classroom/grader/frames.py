"""Questions about an arm in another frame, with what the library answers: for `viva`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coursekit.kinematics import lie
from coursekit.kinematics.robot import Robot

from ..own import arm_of, sheet_of


def frame_question(seed: int, rng: np.random.Generator) -> tuple[str, str]:
    """(question, answer) about the arm of a seed, as HTML."""
    make = QUESTIONS[rng.integers(len(QUESTIONS))]
    text, answer = make(arm_of(seed), rng)
    return f"<p>Your own arm: {_drawn(seed)}</p><p>{text}</p>", answer


def _drawn(seed: int) -> str:
    sheet = sheet_of(seed)
    lengths = ", ".join(f"{k.replace('_', ' ')} {1000 * v:.0f}" for k, v in sheet.lengths.items())
    signs = ", ".join("+" if sign > 0 else "-" for sign in sheet.signs)
    upper = "stands upright" if sheet.upright else "lies forward"
    return (
        f"{lengths} mm; at zero it points along {sheet.forward} and its upper arm {upper}; "
        f"signs of the joints {signs}."
    )


def _another_space_frame(robot: Robot, rng: np.random.Generator) -> tuple[str, str]:
    turn, up = (1, -1)[rng.integers(2)], int(rng.integers(1, 6)) * 100
    T = np.eye(4)
    T[:2, :2], T[2, 3] = [[0, -turn], [turn, 0]], up / 1000  # the new frame in the old one
    moved = robot.with_base(lie.inverse(T))
    return (
        f"The space frame is lifted by {up} mm and turned by {90 * turn:+d} deg about its z axis; the arm "
        "stays where it is. Where is the tool at zero now, in the new frame? Which of M, S and B change?",
        f"<p>The tool is at {_mm(moved.M)}. M and S change (M is T^-1 M, each screw Ad(T^-1) S); "
        "B does not: the tool sees its axes where it saw them before.</p>",
    )


def _longer_tool(robot: Robot, rng: np.random.Generator) -> tuple[str, str]:
    longer = int(rng.integers(4, 20)) * 10
    T = np.eye(4)
    T[0, 3] = longer / 1000
    grown = robot.with_tool(T)
    v = ", ".join(f"{x:.3f}" for x in grown.B[3:, 4] + 0.0)
    return (
        f"A gripper puts the tool frame {longer} mm further out, along its own x axis. Which of M, S and B "
        "change? Where is the tool at zero now, and what is the lower half (v) of the body screw of joint 5?",
        f"<p>M and B change, S does not. The tool is at {_mm(grown.M)}; v of B_5 is ({v}) m.</p>",
    )


def _joint_counts_backwards(robot: Robot, rng: np.random.Generator) -> tuple[str, str]:
    joint = int(rng.integers(1, 4))
    theta = np.zeros(robot.n)
    theta[joint - 1] = np.pi / 6
    return (
        f"Joint {joint} is wired the other way round, so that it counts backwards. What changes in S, and "
        f"what in M? All joints stand at 0, only joint {joint} shows +30 deg: where is the tool now?",
        f"<p>Column {joint} of S changes its sign, all six numbers; M does not change. The tool is at "
        f"{_mm(robot.fk(-theta))}; before, +30 deg put it at {_mm(robot.fk(theta))}.</p>",
    )


def _another_zero(robot: Robot, rng: np.random.Generator) -> tuple[str, str]:
    joint, turn = int(rng.integers(1, 4)), (1, -1)[rng.integers(2)]
    theta = np.zeros(robot.n)
    theta[joint - 1] = turn * np.pi / 2
    M = robot.fk(theta)
    after = [k for k in range(joint + 1, robot.n + 1)]
    return (
        f"Zero of joint {joint} is set anew, where the joint stands at {90 * turn:+d} deg today. Where is "
        "the tool at the new zero? Which columns of S change?",
        f"<p>The tool is at {_mm(M)}. Columns {after[0]} to {after[-1]} may change, those behind the joint: "
        f"its turn carries their axes along. Column {joint} and those before it do not.</p>",
    )


def _speed_of_the_tool(robot: Robot, rng: np.random.Generator) -> tuple[str, str]:
    joint = int(rng.integers(1, 4))
    J = robot.jacobian_geometric(np.zeros(robot.n))
    v = J[3:, joint - 1] + 0.0
    S = robot.S[3:, joint - 1] + 0.0
    return (
        f"All joints stand at 0, and joint {joint} alone turns at +1 rad/s. How fast does the origin of the "
        f"tool frame move, and in which direction? Is that the lower half (v) of the screw S_{joint}?",
        f"<p>It moves at ({v[0]:.3f}, {v[1]:.3f}, {v[2]:.3f}) m/s, w x (p - q). v of S_{joint} is "
        f"({S[0]:.3f}, {S[1]:.3f}, {S[2]:.3f}) m/s: the velocity of the point that is at the origin of the "
        "space frame.</p>",
    )


def _mm(T: np.ndarray) -> str:
    x, y, z = 1000 * T[:3, 3] + 0.0
    return f"({x:.1f}, {y:.1f}, {z:.1f}) mm"


QUESTIONS: tuple[Callable[[Robot, np.random.Generator], tuple[str, str]], ...] = (
    _another_space_frame,
    _longer_tool,
    _joint_counts_backwards,
    _another_zero,
    _speed_of_the_tool,
)
