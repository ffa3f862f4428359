"""Exercises of notebook 01: Denavit-Hartenberg against the product of exponentials."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import POSE, Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb01 as inputs
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._axes import (
    NEAR,
    between,
    deg,
    is_rotation,
    mm,
    pose_gap,
    screws_gap,
    turn,
)
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


# ---- how far a wrong answer misses


def _mm(length):
    return f"{1000 * length + 0.0:.4g} mm"


def _axes_gap(T, right, names):
    for k, what in names:
        if (angle := between(T[:3, k], right[:3, k])) > NEAR:
            return f"{what}; yours points {deg(angle)} away from there"
    return ""


def _dh_gap(args, T, right):
    a, alpha, d, theta = args
    p, far = T[:3, 3], np.hypot(*T[:2, 3])
    if abs(p[2] - d) > NEAR:
        return f"the new frame stands d = {_mm(d)} up the old z axis; yours stands {_mm(p[2])} up"
    if abs(far - abs(a)) > NEAR:
        return f"the new frame stands a = {_mm(a)} from the old z axis; yours stands {_mm(far)} from it"
    if (gap := np.linalg.norm(p - right[:3, 3])) > NEAR:
        return (
            "your frame is at the right distance from the old z axis and at the right height, but on another"
            f" side of it: {mm(gap)} from the right place"
        )
    return _axes_gap(
        T,
        right,
        (
            (
                0,
                f"the new x axis is the old one, turned by theta = {np.degrees(theta):.0f} deg"
                f" about the old z",
            ),
            (
                2,
                f"the new z axis is the old one, tilted by alpha = {np.degrees(alpha):.0f} deg"
                f" about the new x",
            ),
            (1, "the new y axis is perpendicular to the new x and the new z"),
        ),
    )


def _mdh_gap(args, T, right):
    a, alpha, d, theta = args
    p = T[:3, 3]
    if abs(p[0] - a) > NEAR:
        return f"the new frame stands a = {_mm(a)} along the old x axis; yours stands {_mm(p[0])} along it"
    along = p @ right[:3, 2]
    if abs(along - d) > NEAR:
        return f"the new frame stands d = {_mm(d)} along its own z axis; yours stands {_mm(along)} along it"
    if (gap := np.linalg.norm(p - right[:3, 3])) > NEAR:
        return f"d leads along the new z axis alone; your frame stands {mm(gap)} beside it"
    return _axes_gap(
        T,
        right,
        (
            (
                2,
                f"the new z axis is the old one, tilted by alpha = {np.degrees(alpha):.0f} deg"
                f" about the old x",
            ),
            (
                0,
                f"the new x axis is the old one, turned by theta = {np.degrees(theta):.0f} deg"
                f" about the new z",
            ),
            (1, "the new y axis is perpendicular to the new x and the new z"),
        ),
    )


def _tool_gap(args, T, right):
    return pose_gap(T, right, "tool")


def _motion_gap(args, T, right):
    """Where a point of the axis lands, then how far the body turns."""
    S, theta = args
    (w, v), R, p = (S[:3], S[3:]), T[:3, :3], T[:3, 3]
    turned = turn(R) if is_rotation(R) else np.nan
    if not w.any():
        if turned > NEAR:
            return f"a slide turns nothing; yours turns by {deg(turned)}"
        if (gap := np.linalg.norm(p - theta * v)) > NEAR:
            goes = f"this slide goes {_mm(theta)} along v"
            return f"{goes}; yours ends {mm(gap)} from there" if p.any() else f"{goes}; yours does not move"
        return ""
    q, slides = np.cross(w, v), theta * (w @ v)
    if (gap := np.linalg.norm(R @ q + p - q - slides * w)) > NEAR:
        if abs(slides) <= NEAR:
            return f"a point of the axis must stay where it is; yours is carried {mm(gap)} away"
        return f"a point of the axis must slide {mm(slides)} along the axis; yours ends {mm(gap)} from there"
    if (angle := turn(right[:3, :3].T @ R) if is_rotation(R) else 0) > NEAR:
        return f"the axis is where it should be, but the turn about it is {deg(angle)} away from theta"
    return ""


def _screws_gap(args, S, right):
    return screws_gap(S, right)


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
        residual=_dh_gap,
        unit="m, rad",
        samples=3,
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
        residual=_mdh_gap,
        unit="m, rad",
        samples=3,
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
            Edge("where all joints are at zero", inputs.dh_arm_at_zero),
            Edge("where all offsets are zero", inputs.dh_arm_without_offsets),
            Edge("for an arm with one joint", lambda rng: inputs.dh_arm(rng, 1)),
            Edge("for an arm with seven joints", lambda rng: inputs.dh_arm(rng, 7)),
            Edge("for the KR6 of this notebook", inputs.dh_kr6),
            Edge("for whole numbers", inputs.whole_dh_arm),
        ),
        usual="for other arms",
        blocks=POSE,
        residual=_tool_gap,
        laws=(
            ("the tool comes last: it multiplies the pose from the right", _tool_last),
            ("the base comes first: it multiplies the pose from the left", _base_first),
        ),
        unit="m, rad",
        samples=3,
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
        residual=_motion_gap,
        laws=(
            ("by theta = 0 nothing moves: the answer is the identity", _nothing_moves_at_zero),
            ("the motion by 2 theta is the motion by theta, done twice", _twice_is_double),
        ),
        unit="m, rad",
        samples=3,
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
            Edge("where M is the identity", inputs.poe_arm_without_M),
            Edge("for an arm with one joint", lambda rng: inputs.poe_arm(rng, 1, inputs.hinge)),
            Edge("for an arm with slides only", lambda rng: inputs.poe_arm(rng, 3, inputs.slide)),
            Edge("for the KR6 of this notebook", inputs.poe_kr6),
            Edge("for an arm with seven joints", lambda rng: inputs.poe_arm(rng, 7)),
            Edge("for whole numbers", inputs.whole_poe_arm),
        ),
        usual="for other arms",
        blocks=POSE,
        residual=_tool_gap,
        laws=(("with every joint at zero the tool is at its home pose M", _home_at_zero),),
        unit="m, rad",
        samples=3,
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
        residual=_screws_gap,
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
            Hint("no_base", "these screws are in frame 0: the base takes them to the space frame"),
            Hint("no_offset", "the table's own offsets belong to the frames at theta = 0"),
        ),
    ),
    RANGES_TO_DH,
]
