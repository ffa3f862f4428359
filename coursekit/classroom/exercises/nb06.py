"""Exercises of notebook 06: attitudes along a path, and how fast an arm may follow it."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _attitudes as attitudes
from coursekit.classroom.exercises import _nb06 as residuals
from coursekit.classroom.exercises import _paths as draws
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._nb06_branch import NEXT_ON_BRANCH

# What the student's functions may call from coursekit.kinematics: what earlier notebooks had them write, and
# the elementary turns.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.inverse",
    "lie.exp3",
    "lie.exp6",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
    "path.steps",
)


def _unit(f, args, q):
    return bool(abs(np.sum(q * q) - 1) < 1e-9)


def _there_and_back(f, args, R):
    R_0, R_1, t = args
    return bool(np.allclose(f(R_1, R_0, 1 - t), R, atol=1e-6))


def _half_as_fast(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q, points, v_max / 2), speed / 2))


def _turned_once(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q + 2 * np.pi, points, v_max), speed))


EXERCISES = [
    Exercise(
        "tool_frames(points, centre)",
        look=looks.poses,
        points=3,
        draw=draws.curve,
        shape=(None, 4, 4),
        unit="m",
        compare="rotation",
        samples=3,
        usual="for an ordinary path",
        blocks=(
            Block("x", np.s_[:, :3, 0]),
            Block("y", np.s_[:, :3, 1]),
            Block("z", np.s_[:, :3, 2]),
            Block("the position", np.s_[:, :3, 3]),
            Block("the last row", np.s_[:, 3]),
        ),
        edges=(
            Edge("for two points", lambda rng: draws.curve(rng, 2)),
            Edge("for a sphere about the origin", draws.about_the_origin),
            Edge("for whole numbers", draws.whole_points),
        ),
        residual=residuals.frame_missed,
        hints=(
            Hint("inward", "x points to the centre of the sphere; the outward normal leads away from it"),
            Hint("left_handed", "these axes are left-handed: x cross y is z, y cross x is not"),
            Hint(
                "y_not_perpendicular",
                "y is not perpendicular to x: a step between two points of a sphere is no tangent",
            ),
            Hint("not_unit", "y has not length 1: divide it by its length once x is taken out of it"),
            Hint("x_along", "x and y have changed places: x is the normal, y the direction of motion"),
            Hint("about_origin", "the normal is measured from the origin; the sphere has its own centre"),
            Hint("no_last", "a pose is missing: the last point has one, too, with the step before it"),
            Hint("backward", "the step at point i leads to point i + 1; yours comes from point i - 1"),
            Hint("central", "the step at point i leads from it to point i + 1; yours begins at point i - 1"),
            Hint(
                "last_copied",
                "the last y is a copy: take the step before it again, but the normal at the last point",
            ),
            Hint("pose_copied", "the last pose is a copy: it belongs at the last point, with its normal"),
            Hint("round_the_end", "the last point has no next one: yours goes round to the first (np.roll?)"),
        ),
    ),
    Exercise(
        "quaternion(R)",
        look=looks.from_quaternion,
        points=3,
        draw=attitudes.attitude,
        shape=(4,),
        compare="up_to_sign",
        samples=3,
        n=32,
        blocks=tuple(Block(name, i) for i, name in enumerate("wxyz")),
        usual="for ordinary angles",
        edges=(
            Edge("for no turn at all", lambda rng: (np.eye(3, dtype=int),)),
            Edge("for a quarter turn", attitudes.quarter_turn),
            Edge("where w, x, y and z are equal", attitudes.right_angles),
            Edge("where w, x, y and z add up to 0", attitudes.adding_up_to_nothing),
            Edge("for a small turn", attitudes.small_turn),
            Edge("where x is the largest", attitudes.large(0)),
            Edge("where y is the largest", attitudes.large(1)),
            Edge("where z is the largest", attitudes.large(2)),
            Edge("where x is by far the largest", attitudes.nearly_about(0)),
            Edge("where y is by far the largest", attitudes.nearly_about(1)),
            Edge("where z is by far the largest", attitudes.nearly_about(2)),
            Edge("for a half turn about x", attitudes.half_turn_about(0)),
            Edge("for a half turn about y", attitudes.half_turn_about(1)),
            Edge("for a half turn about z", attitudes.half_turn_about(2)),
            Edge("for a half turn about any line", attitudes.half_turn, 2),
            *attitudes.WHERE_SIGNS_ARE_LOST,
            *attitudes.HALF_TURNS_ABOUT_NEARLY_AN_AXIS,
            Edge("for nearly half a turn", attitudes.nearly_half_a_turn),
        ),
        residual=residuals.attitude_missed,
        hints=(
            Hint(
                "wrong_entries",
                "the second component takes the wrong entries of R, in the sums and below the fraction line",
            ),
            Hint("y_sign", "the indices of 4wy run round the circle: r13 - r31, not r31 - r13"),
            Hint("vector_first", "the order here is (w, x, y, z): yours ends with the scalar"),
            Hint("no_mirror", "half of the table is not printed: what stands below its diagonal mirrors it"),
            Hint(
                "roots_only",
                "a root has no sign: the signs of x, y and z are in the differences of entries of R",
            ),
            Hint(
                "lost_at_half_turn",
                "at half a turn the differences that give the signs vanish, and your vector part with them",
            ),
            Hint(
                "divided_by_w",
                "you divide by w, which is 0 at half a turn: divide by the largest of the four, see its row",
            ),
            Hint(
                "turned_back", "this is the inverse rotation: the differences are taken the other way round"
            ),
            Hint(
                "quarter", "a quarter of a line is q times its largest number: divide the line by its length"
            ),
            Hint("no_one", "the four entries of the diagonal begin with a 1: it is missing"),
        ),
        laws=(("a unit quaternion has length 1", _unit),),
    ),
    Exercise(
        "zyx(R)",
        look=looks.from_zyx,
        points=2,
        draw=attitudes.away_from_lock,
        shape=(3,),
        compare="angle",
        unit="rad",
        samples=3,
        usual="for ordinary angles",
        blocks=(Block("the yaw", 0), Block("the pitch", 1), Block("the roll", 2)),
        edges=(
            Edge(
                "where yaw and roll lie between -90 and 0 deg",
                lambda rng: attitudes.away_from_lock(rng, [-1]),
            ),
            Edge(
                "where R[0, 0] and R[2, 2] are negative", lambda rng: attitudes.away_from_lock(rng, (-2, 1))
            ),
            Edge("where the pitch is steep", lambda rng: attitudes.away_from_lock(rng, pitch=(1.56, 1.57))),
            Edge("for no turn at all", lambda rng: (np.eye(3, dtype=int),)),
            Edge("for a quarter turn about z", attitudes.quarter_turn),
            *(Edge("for a half turn about an axis", attitudes.half_turn_about(i)) for i in range(3)),
            *attitudes.RIGHT_AND_SLIGHT_ANGLES,
        ),
        residual=residuals.zyx_missed,
        hints=(
            Hint("signs_flipped", "every angle has the wrong sign: check which entry carries the minus"),
            Hint("pitch_sign", "the pitch has the wrong sign: a positive turn about y lowers the x axis"),
            Hint("reversed", "the order here is (yaw, pitch, roll): yours begins with the turn about x"),
            Hint("arcsin", "an arcsin never leaves the right half of the circle; yaw and roll go all round"),
            Hint(
                "xyz",
                "these angles belong to the product Rx Ry Rz: here the turn about z stands first",
            ),
            Hint(
                "of_the_inverse",
                "these are the angles of the inverse: rows and columns of R have changed places",
            ),
            Hint("arctan", "arctan of a quotient loses which of the two was negative: arctan2 takes both"),
            Hint(
                "zyz", "these are ZYZ angles, whose second turn is about y, but whose third is about z again"
            ),
            Hint("degrees", "the answer is in radians: yours looks like degrees"),
            Hint("arccos", "an arccos never leaves the upper half of the circle; yaw and roll go all round"),
        ),
    ),
    Exercise(
        "inside(theta, lower, upper)",
        points=2,
        draw=draws.configurations,
        shape=(None,),
        samples=3,
        usual="for ordinary limits",
        edges=(
            Edge("for the limits of the exam", draws.exam),
            Edge("where an angle is exactly on a limit", draws.exactly_on_a_limit),
            Edge("several turns away", draws.several_turns),
            Edge("where 0 is outside the limits", draws.both_positive),
            Edge("where the limits are more than a turn apart", draws.more_than_a_turn),
            Edge("for one joint", draws.one_joint),
            Edge("for as many configurations as joints", draws.as_many_as_joints),
            Edge("for whole numbers", draws.whole_angles),
        ),
        residual=residuals.configuration_missed,
        hints=(
            Hint(
                "no_turns",
                "whole turns, 2 pi in radians, are not tried: -174.72 and 185.28 degrees are one place of the"
                " joint",
            ),
            Hint(
                "wrapped",
                "you wrap to half a turn first: limits may lie beyond it. Bring theta to the first place at"
                " or above lower",
            ),
            Hint(
                "wrapped_by_mod",
                "`% (2 * pi)` brings every angle to half a turn up or down: limits may lie beyond it. Bring"
                " theta to the first place at or above lower",
            ),
            Hint(
                "wrapped_upwards",
                "you bring every angle to 0 to 360 degrees first: a lower limit may be negative. Bring theta"
                " to the first place at or above lower",
            ),
            Hint("turns_down_only", "turns go both ways: below the lower limit a turn has to be added"),
            Hint("one_turn", "one turn up or down is not always enough: an angle may be several turns away"),
            Hint(
                "joints_together",
                "every joint may take its own number of turns; yours turns all joints alike",
            ),
            Hint("any_joint", "one joint inside is not enough: a configuration is inside if all joints are"),
            Hint("turns_up_only", "turns go both ways: above the upper limit a turn has to be taken off"),
        ),
    ),
    Exercise(
        "largest_speed(q, points, v_max)",
        points=3,
        draw=draws.motion,
        shape=(),
        unit="m/s",
        samples=3,
        usual="for an ordinary motion",
        edges=(
            Edge("for equal steps", draws.equal_steps),
            Edge("for a single step", lambda rng: draws.motion(rng, 2)),
            Edge("for one joint", lambda rng: draws.motion(rng, 5, 1)),
            Edge("where a joint hardly moves", draws.one_that_hardly_moves),
            Edge("where a joint rests", draws.one_that_rests),
            Edge("where a joint turns by more than half a turn", draws.a_step_of_more_than_half_a_turn),
            Edge("where joint 1 sets the speed", draws.moves_most_but_may(0)),
            Edge("where the last joint sets the speed", draws.moves_most_but_may(2)),
            Edge("for whole numbers", draws.whole_motion),
            Edge("where a joint that hardly moves sets the speed", draws.a_slow_one),
        ),
        residual=residuals.speed_missed,
        hints=(
            Hint(
                "wrapped",
                "angles wrapped before their differences: one that passes half a turn seems to jump by 2 pi",
            ),
            Hint(
                "bound_of_the_fastest",
                "the joint that turns most need not be the worst: its bound may be large. Divide first, then"
                " look for the smallest",
            ),
            Hint(
                "wrapped_differences",
                "differences wrapped to half a turn: a joint that turns farther in one step counts in full",
            ),
            Hint("joints_added", "the joints have no common speed: each joint is held against its own bound"),
            Hint(
                "whole_length", "each step has its own length: `norm` without axis=1 makes one number of all"
            ),
            Hint("last_joint", "you look at the last joint alone: any joint may set the speed"),
            Hint("one_bound", "one bound for all joints: each joint has its own entry of v_max"),
            Hint("largest_bound", "the largest bound for all joints: each joint has its own entry of v_max"),
            Hint(
                "mean",
                "a mean of the rates for their maximum: somewhere on the path a joint turns faster than that",
            ),
            Hint("one_step", "the steps of this path are not alike: divide each difference by its own step"),
            Hint("signed", "a joint that turns backwards counts, too: compare sizes"),
            Hint("signed_speeds", "a joint that turns backwards has no negative speed limit: take sizes"),
        ),
        laws=(
            ("with half the bounds the tool may go half as fast", _half_as_fast),
            ("a joint that begins a whole turn further on is no slower", _turned_once),
        ),
    ),
    Exercise(
        "angle_axis(R)",
        look=looks.turn_about,
        points=2,
        draw=attitudes.attitude,
        shape=(3,),
        compare="turn",
        unit="rad",
        samples=3,
        usual="for ordinary angles",
        edges=(
            Edge("for no turn at all", lambda rng: (np.eye(3, dtype=int),)),
            Edge("for a tiny turn", attitudes.tiny_turn, tol=1e-11),
            Edge("for a quarter turn about z", attitudes.quarter_turn),
            Edge("for a third of a turn", attitudes.right_angles),
            Edge("where x is the largest, and negative", attitudes.large_and_negative(0)),
            Edge("where y is the largest, and negative", attitudes.large_and_negative(1)),
            Edge("where z is the largest, and negative", attitudes.large_and_negative(2)),
            Edge("for nearly half a turn", attitudes.nearly_half_a_turn),
            Edge("for very nearly half a turn", attitudes.very_nearly_half_a_turn, tol=2e-9),
            *(Edge("for half a turn about an axis", attitudes.half_turn_about(i)) for i in range(3)),
            Edge("for half a turn about any line", attitudes.half_turn),
            *attitudes.WHERE_AN_AXIS_IS_LOST,
        ),
        residual=residuals.turn_missed,
        hints=(
            Hint(
                "textbook",
                "right away from half a turn: there sin(theta) is nearly 0, and the arccosine flat. Take both"
                " from the quaternion",
            ),
            Hint("axis_alone", "this is k, of length 1; the product is k theta"),
            Hint("half_angle", "the quaternion holds half the angle: theta = 2 atan2(|(x, y, z)|, w)"),
            Hint(
                "turned_back", "this is the inverse rotation: the differences are taken the other way round"
            ),
            Hint(
                "not_flipped", "more than half a turn: where w < 0, take the quaternion with the other sign"
            ),
            Hint("w_alone", "where w < 0, all four numbers change their sign, not w alone"),
            Hint(
                "arcsine",
                "near half a turn the arcsine is flat, and loses half of the digits: arctan2 loses none",
            ),
            Hint(
                "arccosine", "near 0 the arccosine is flat, and loses half of the digits: arctan2 loses none"
            ),
            Hint("not_divided", "k is a unit vector: divide (x, y, z) by its length"),
        ),
    ),
    Exercise(
        "slerp(R_0, R_1, t)",
        look=looks.attitude,
        points=2,
        draw=attitudes.between(),
        shape=(3, 3),
        compare="rotation",
        samples=3,
        usual="for ordinary attitudes",
        edges=(
            Edge("where t is 0", attitudes.between(0.0)),
            Edge("where t is 1", attitudes.between(1.0)),
            Edge("half way", attitudes.between(0.5)),
            Edge("where R_0 is the identity", attitudes.between(R_0=np.eye(3))),
            Edge("where R_1 is R_0", attitudes.nothing_between),
            Edge("where the short way leads through half a turn", attitudes.through_a_half_turn),
            *attitudes.FAR_AND_NEAR,
            Edge("for whole numbers", attitudes.between_whole),
        ),
        residual=residuals.way_missed,
        hints=(
            Hint("entries", "entries on a straight line make no rotation: interpolate the turn between them"),
            Hint("angles", "ZYX angles one by one: the tool swerves; take the one turn from R_0 to R_1"),
            Hint("chord", "a straight line between quaternions is right in the middle, uneven elsewhere"),
            Hint(
                "far_chord",
                "q and -q are one attitude: take the nearer; and the straight line between is uneven",
            ),
            Hint("wrong_side", "the turn R_0^T R_1 is seen from the tool: it stands behind R_0"),
            Hint("from_identity", "your way begins at the identity, not at R_0"),
            Hint(
                "away",
                "it turns the other way: the turn that is left is R_0^T R_1, not its inverse R_1^T R_0",
            ),
            Hint("backwards", "at t = 0 it has to be R_0, at t = 1 R_1"),
            Hint("vectors", "products k theta do not add: take the product of the turn between, R_0^T R_1"),
            Hint("long_way", "that is the long way round: q and -q are one attitude, take the nearer"),
            Hint("long_way_too", "the long way round: of q_1 and -q_1 take the one that is nearer to q_0"),
            Hint("scaled", "t times a rotation is none: t belongs to the angle, inside the exponential"),
        ),
        laws=(("the way back is the same way", _there_and_back),),
    ),
    NEXT_ON_BRANCH,
]
