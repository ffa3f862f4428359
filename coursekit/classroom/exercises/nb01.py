"""Exercises of notebook 01: Denavit-Hartenberg against the product of exponentials."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import POSE, Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb01 as inputs
from coursekit.classroom.exercises import _nb01_gaps as gaps
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._nb01_tables import DH_TABLE, JOINT_TRANSFORM, RANGES_TO_DH

# What the student's functions may call from coursekit.kinematics.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.hat6",
    "lie.vee6",
    "lie.inverse",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
)


# ---- what must hold whatever the inputs


def _tool_last(f, args, T):
    rows, theta, base, tool = args
    return bool(np.allclose(f(rows, theta, base, np.eye(4)) @ tool, T, atol=1e-9))


def _base_first(f, args, T):
    rows, theta, base, tool = args
    return bool(np.allclose(base @ f(rows, theta, np.eye(4), tool), T, atol=1e-9))


def _nothing_moves_at_zero(f, args, T):
    return bool(np.allclose(f(args[0], 0.0), np.eye(4), atol=1e-9))


def _twice_is_double(f, args, T):
    return bool(np.allclose(f(args[0], 2 * args[1]), T @ T, atol=1e-9))


def _home_at_zero(f, args, T):
    S, M, theta = args
    return bool(np.allclose(f(S, M, 0 * theta), M, atol=1e-9))


def _first_column(f, args, S):
    """Where rows hold no lengths and the base is the identity, every axis goes through the origin."""
    rows = args[0] * [0, 1, 0, 1]
    return bool(np.allclose(f(rows, np.eye(4))[3:], 0, atol=1e-9))


FRAME = (
    Block("the x axis", np.s_[:3, 0]),
    Block("the y axis", np.s_[:3, 1]),
    Block("the z axis", np.s_[:3, 2]),
    Block("the position", np.s_[:3, 3]),
    Block("the last row", np.s_[3]),
)

EXERCISES = [
    Exercise(
        "dh_transform(a, alpha, d, theta)",
        look=looks.pose,
        points=2,
        draw=inputs.dh_row,
        shape=(4, 4),
        compare="rotation",
        n=24,
        edges=inputs.ROWS,
        usual="for other angles",
        blocks=FRAME,
        residual=gaps.dh_gap,
        unit="m, rad",
        samples=2,
        hints=(
            Hint(
                "alpha_for_a",
                "the last column holds lengths: a, not alpha, goes with cos and sin of theta",
            ),
            Hint("entry_22", "look at entry (2, 2): sin(theta) stands there in place of cos(theta)"),
            Hint(
                "a_on_old_x",
                "a runs along the new x axis, which theta has turned: a cos(theta), a sin(theta)",
            ),
            Hint(
                "modified",
                "that is the modified transform: in the standard one, the turn about z comes first",
            ),
            Hint("degrees", "alpha and theta are in radians: your numbers are what degrees would give"),
            Hint("transposed", "this is the transpose: the translation belongs in the last column"),
        ),
    ),
    DH_TABLE,
    Exercise(
        "mdh_transform(a_prev, alpha_prev, d, theta)",
        look=looks.pose,
        points=2,
        draw=inputs.dh_row,
        shape=(4, 4),
        compare="rotation",
        n=24,
        edges=inputs.ROWS,
        usual="for other angles",
        blocks=FRAME,
        residual=gaps.mdh_gap,
        unit="m, rad",
        samples=2,
        hints=(
            Hint("plus_sin", "look at entry (1, 2): a turn about z has -sin(theta) there"),
            Hint("no_a", "the last column begins with a_{i-1}: the step along x is missing"),
            Hint(
                "standard",
                "that is the standard transform: in the modified one, the turn about x comes first",
            ),
            Hint("d_on_old_z", "d is measured along the new z, which alpha_{i-1} has already tilted"),
            Hint("degrees", "both angles are in radians: your numbers are what degrees would give"),
        ),
    ),
    Exercise(
        "fk_dh(rows, theta, base, tool)",
        look=looks.pose,
        points=3,
        draw=inputs.dh_arm,
        shape=(4, 4),
        compare="rotation",
        edges=(
            Edge("where base and tool are the identity", inputs.dh_arm_bare),
            Edge("where the base is the identity", inputs.dh_arm_without_base),
            Edge("where the tool is the identity", inputs.dh_arm_without_tool),
            Edge("where all joints are at zero", inputs.dh_arm_at_zero),
            Edge("where some joints are at zero", inputs.dh_arm_partly_at_zero),
            Edge("where all offsets are zero", inputs.dh_arm_without_offsets),
            Edge("for an arm with one joint", lambda rng: inputs.dh_arm(rng, 1)),
            Edge("for an arm with seven joints", lambda rng: inputs.dh_arm(rng, 7)),
            Edge("for the KR6 of this notebook", inputs.dh_kr6),
            Edge("for whole numbers", inputs.whole_dh_arm),
            Edge("where joints have turned more than once", inputs.dh_arm_turned),
        ),
        usual="for other arms",
        blocks=POSE,
        residual=gaps.tool_gap,
        laws=(
            ("the tool comes last: it multiplies the pose from the right", _tool_last),
            ("the base comes first: it multiplies the pose from the left", _base_first),
        ),
        unit="m, rad",
        samples=2,
        hints=(
            Hint("no_offset", "theta alone is not the angle of a row: add the offset in its fourth column"),
            Hint("no_tool", "the tool is missing: the last factor takes frame n to the tool"),
            Hint("no_base", "the base is missing: the first factor takes the space frame to frame 0"),
            Hint(
                "reversed",
                "the links are multiplied in reverse: frame 1 hangs on frame 0, so A_1 comes first",
            ),
            Hint(
                "other_order",
                "a row holds a, alpha, d, offset in this order: you read it as a, d, alpha, offset",
            ),
            Hint("read_as_modified", "these are standard rows; you read them as modified ones"),
            Hint(
                "tool_each_time",
                "the tool stands on the last frame alone: multiply by it once, after the loop",
            ),
            Hint("theta_first", "dh_transform takes a, alpha, d, theta, in this order"),
        ),
    ),
    JOINT_TRANSFORM,
    Exercise(
        "screw_exp(S, theta)",
        look=looks.pose,
        points=3,
        draw=inputs.one_hinge,
        shape=(4, 4),
        compare="rotation",
        n=24,
        edges=inputs.SCREWS,
        usual="for a hinge",
        blocks=POSE,
        residual=gaps.motion_gap,
        laws=(
            ("by theta = 0 nothing moves: the answer is the identity", _nothing_moves_at_zero),
            ("the motion by 2 theta is the motion by theta, done twice", _twice_is_double),
        ),
        unit="m, rad",
        samples=2,
        hints=(
            Hint("v_first", "S is (omega; v): you took its first three numbers for v"),
            Hint("theta_v", "theta v is the translation of a slide; a hinge moves the origin along an arc"),
            Hint("sin_sin", "the last coefficient is theta - sin(theta): one sine, not two"),
            Hint(
                "no_pitch", "v may have a part along omega: such a screw slides as it turns, yours only turns"
            ),
            Hint(
                "theta_everywhere", "I theta is theta * np.eye(3): theta alone is added to all nine entries"
            ),
            Hint("slide_turns", "where omega is zero nothing turns: the joint slides along v"),
            Hint("v_for_q", "v is not a point of the axis: for a hinge through q, v = -omega x q"),
            Hint("each_entry", "np.exp takes every entry by itself; a matrix has another exponential"),
            Hint("no_last_term", "the translation has three terms: that with [omega]^2 v is missing"),
            Hint(
                "terms_exchanged",
                "in the translation, 1 - cos(theta) goes with [omega] and theta - sin(theta) with its square",
            ),
            Hint(
                "about_q",
                "a turn about the axis alone: a part of v along omega is lost, and a slide does not move",
            ),
            Hint("turned_back", "it turns the wrong way round: check the signs in [omega]"),
            Hint("two_terms", "the rotation has three terms: (1 - cos(theta)) [omega]^2 is missing"),
        ),
    ),
    Exercise(
        "fk_poe(S, M, theta)",
        look=looks.pose,
        points=2,
        draw=inputs.poe_arm,
        shape=(4, 4),
        compare="rotation",
        edges=(
            Edge("where all joints are at zero", inputs.poe_arm_at_zero),
            Edge("where some joints are at zero", inputs.poe_arm_partly_at_zero),
            Edge("where M is the identity", inputs.poe_arm_without_M),
            Edge("for an arm with one joint", lambda rng: inputs.poe_arm(rng, 1, inputs.hinge)),
            Edge("for an arm with slides only", lambda rng: inputs.poe_arm(rng, 3, inputs.slide)),
            Edge("for the KR6 of this notebook", inputs.poe_kr6),
            Edge("for an arm with seven joints", lambda rng: inputs.poe_arm(rng, 7)),
            Edge("for whole numbers", inputs.whole_poe_arm),
            Edge("where joints have turned more than once", inputs.poe_arm_turned),
        ),
        usual="for other arms",
        blocks=POSE,
        residual=gaps.tool_gap,
        laws=(("with every joint at zero the tool is at its home pose M", _home_at_zero),),
        unit="m, rad",
        samples=2,
        hints=(
            Hint("no_M", "at theta = 0 your tool is at the origin: the home pose M is missing"),
            Hint("M_left", "M on the left belongs to body screws; these are space screws"),
            Hint(
                "reversed",
                "the exponentials are in reverse: joint 1 carries all the others, so it comes first",
            ),
            Hint(
                "M_each_time", "M stands there once, after all exponentials: yours comes in with every joint"
            ),
            Hint("M_twice", "M stands there once, after all exponentials: yours stands there twice"),
            Hint(
                "exp_of_sum",
                "e^A e^B is not e^(A + B): each joint has its own exponential, and they are multiplied",
            ),
            Hint("body_screws", "you turned S into body screws; with M on the right it must stay as it is"),
            Hint("degrees", "theta is in radians: your numbers are what degrees would give"),
        ),
    ),
    Exercise(
        "screws_from_dh(rows, base)",
        look=looks.screws,
        points=3,
        draw=inputs.modified_arm,
        shape=(6, None),
        edges=(
            Edge("where the base is the identity", inputs.modified_arm_with(np.eye(4))),
            Edge("where all lengths are zero", inputs.modified_arm_with(a=0, d=0)),
            Edge("where all offsets are zero", inputs.modified_arm_with(offset=0)),
            Edge("for parallel axes", inputs.modified_arm_with(alpha=0)),
            Edge("for an arm with one joint", lambda rng: inputs.modified_arm(rng, 1)),
            Edge("for the KR6 of this notebook", inputs.modified_kr6),
            Edge("for an arm with seven joints", lambda rng: inputs.modified_arm(rng, 7)),
            Edge("for whole numbers", inputs.whole_modified_arm),
        ),
        usual="for other arms",
        blocks=(
            Block("the directions (upper rows)", np.s_[:3], plural=True),
            Block("the lower rows (v)", np.s_[3:], plural=True),
        ),
        residual=gaps.axes_gap,
        unit="m, rad",
        samples=3,
        laws=(
            ("where all lengths are zero, every axis goes through the origin: v must vanish", _first_column),
        ),
        hints=(
            Hint("about_x", "a joint turns about its own z; your [z] turns about x"),
            Hint("frame_before", "you stopped one frame short: axis i is the z of frame i, N_1 ... N_i"),
            Hint(
                "row_alone", "N_i alone is seen from frame i - 1: axis i needs the whole product N_1 ... N_i"
            ),
            Hint("standard", "these are modified rows: N_i comes from mdh_transform, not from dh_transform"),
            Hint("point_as_v", "v is not the point on the axis: v = -w x q"),
            Hint("one_side", "[z] changes its frame as T [z] T^-1: the factor on its right is missing"),
            Hint(
                "inverse_first",
                "[z] changes its frame as T [z] T^-1: in yours the inverse stands on the left",
            ),
            Hint("no_v", "v is all zero: it is the last column of X, and T^-1 is not the transpose of T"),
            Hint("no_base", "these screws are in frame 0: the base takes them to the space frame"),
            Hint("no_offset", "the table's own offsets belong to the frames at theta = 0"),
        ),
    ),
    RANGES_TO_DH,
]
