"""Exercises of notebook 05: Jacobians by several methods, ellipsoids, damped steps, planar velocities."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _jacobians as draws
from coursekit.classroom.exercises import _nb05 as residuals
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._nb05_run import DLS_LOOP

# What the student's functions may call from coursekit.kinematics: what notebooks 01 to 03 had them write or
# told them to use, and what this one tells them to use.
ALLOW = (
    "lie.exp6",
    "lie.adjoint",
    "lie.inverse",
    "lie.hat3",
    "lie.vee3",
    "lie.hat6",
    "lie.vee6",
    "lie.log3",
    "lie.log6",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
    "robot.Robot.fk",
    "robot.Robot.jacobian_body",
    "robot.Robot.n",
)


def _own_turn(f, args, J):
    """No joint moves its own axis, and no joint moves the axes before it."""
    S, theta = args
    return bool(np.allclose(f(S, theta + np.eye(len(theta))[-1]), J, atol=1e-9))


def _tool_on_axis(f, args, J):
    """A tool on axis 1 gets no velocity from joint 1."""
    axes, origins, _ = args
    return bool(np.allclose(f(axes, origins, origins[0] + 0.4 * axes[0])[3:, 0], 0, atol=1e-9))


def _scaled(f, args, value):
    """Twice the Jacobian, twice the velocities."""
    return bool(np.allclose(f(2 * args[0])[0], 2 * np.asarray(value[0]), atol=1e-9))


def _same_length(f, args, value):
    """A velocity has one length, whatever the frame."""
    return bool(np.isclose(np.linalg.norm(value[0]), np.linalg.norm(value[1]), atol=1e-9))


def _much_damping(f, args, step):
    """With a large k only J^T e / k^2 is left."""
    J, e, _ = args
    return bool(np.allclose(1e8 * np.asarray(f(J, e, 1e4)), J.T @ e, atol=1e-4))


def _no_last_row(f, args, value):
    """1 stays 1: its rate is 0."""
    return bool(np.allclose(value[0][3], 0, atol=1e-9))


def _same_power(f, args, tau):
    """Whatever the rates, the joints give as much power as the tool takes."""
    J, T, moment, force = args
    turns = np.kron(np.eye(2), T[:3, :3])
    return bool(np.allclose(tau, np.concatenate([moment, force]) @ turns @ J, atol=1e-6))


EXERCISES = [
    Exercise(
        "jacobian_space(S, theta)",
        look=looks.screws,
        points=3,
        draw=draws.screws,
        shape=(6, None),
        unit="1, m",
        laws=(("turning the last joint moves no joint axis: all columns must stay", _own_turn),),
        usual="for hinges at ordinary angles",
        samples=2,
        edges=(
            Edge(
                "for the KR10 at right angles",
                draws.screws_of_the_kr10(lambda r: np.pi / 2 * r.permutation([1, -1, 2, 1, -1, 0])),
            ),
            Edge("for the KR10 at theta = 0", draws.screws_of_the_kr10(lambda r: np.zeros(6))),
            Edge("for an arm with one joint", lambda rng: draws.screws(rng, 1)),
            Edge("for an arm with seven joints", lambda rng: draws.screws(rng, 7)),
            Edge("for an arm with a slide", draws.screws_with_slide),
            Edge("for screws with pitch", draws.screws_with_pitch),
            Edge("for whole numbers", draws.whole_screws),
            Edge("where joints have turned more than once", draws.screws_turned),
        ),
        residual=residuals.axis_missed,
        hints=(
            Hint("at_zero", "these are the screws at theta = 0: the joints before it carry each axis along"),
            Hint("later_joints", "you moved each axis by the joints after it: that is the rule of J_b"),
            Hint(
                "reversed", "the exponentials are in reverse: joint 1 carries all the others, it comes first"
            ),
            Hint(
                "back", "you moved the axes back instead of forth: check for an inverse, or a minus on theta"
            ),
            Hint("one_before", "all joints before it carry axis i, not joint i - 1 alone: multiply them up"),
            Hint("no_theta", "e^[S] turns by 1 rad whatever the joint does: theta_i is missing"),
            Hint("one_short", "your product stops one joint early: axis i is moved by joint i - 1, too"),
        ),
    ),
    Exercise(
        "jacobian_geometric(axes, origins, tool)",
        points=3,
        draw=draws.hinges,
        shape=(6, None),
        unit="1, m",
        laws=(("joint 1 cannot move a tool that lies on axis 1", _tool_on_axis),),
        samples=3,
        usual="for ordinary hinges",
        edges=(
            Edge("for axes that are whole numbers", draws.hinges_of_the_kr10),
            Edge("for an arm with one joint", lambda rng: draws.hinges(rng, 1)),
            Edge("for an arm with three joints", lambda rng: draws.hinges(rng, 3)),
            Edge("where the tool lies on an axis", draws.tool_on_an_axis),
            Edge("where the tool is at the base origin", draws.tool_at_the_origin),
        ),
        residual=residuals.velocity_missed,
        hints=(
            Hint(
                "reversed", "your lower rows have the wrong sign: a cross product changes it with the order"
            ),
            Hint("rows_swapped", "rows are (omega; v): you have v on top, as the assignment of 2020 does"),
            Hint("next_axis", "column i belongs to axis i; you took the axis after it"),
            Hint("from_base", "the lever goes from the axis to the tool, not from the base to the tool"),
            Hint("space", "that v belongs to the point at the base origin (J_s), not to the tool"),
            Hint("entrywise", "`*` multiplies entry by entry: v is the cross product w x (p - o)"),
        ),
    ),
    Exercise(
        "jacobian_by_differences(fk, theta, step)",
        points=3,
        draw=draws.arm_and_step,
        shape=(6, None),
        unit="1, m",
        tol=2e-6,
        usual="for a small step",
        samples=3,
        edges=(
            Edge("for a step of 0.1 rad", draws.coarse, tol=draws.COARSE_TOL),
            Edge("for an arm with seven joints", lambda rng: draws.arm_and_step(rng, "franka_panda")),
            Edge("for an arm with two joints", lambda rng: draws.arm_and_step(rng, "planar_2r")),
            Edge("for the KR10 at theta = 0", lambda rng: ({"fk": "kuka_kr10"}, np.zeros(6), 1e-3)),
            Edge("where joints have turned more than once", draws.turned_and_step),
            Edge(
                "where theta holds whole numbers",
                lambda rng: ({"fk": "kuka_kr6"}, rng.permutation([1, -1, 2, -2, 1, 3]), 1e-3),
            ),
        ),
        residual=residuals.velocity_missed,
        hints=(
            Hint("forward", "a one-sided difference is too coarse for this step: go both ways"),
            Hint("half", "twice too large: between the two poses lie two steps"),
            Hint(
                "body_by_log6",
                "log6 of T_-^-1 T_+ is a twist along the tool's axes (J_b): take rotation and position apart,"
                " as the two formulas do",
            ),
            Hint(
                "space_by_log6",
                "log6 of T_+ T_-^-1 is a twist whose v belongs to the base origin (J_s), not to the tool",
            ),
            Hint("all_at_once", "you move all joints at once: column i is for joint i alone"),
            Hint(
                "turn_in_tool",
                "your upper rows lie along the tool: R_-^T R_+ turns in the tool, R_+ R_-^T in the base",
            ),
            Hint("body", "all your rows are along the tool's axes (J_b); they belong along the base"),
            Hint("space", "that v belongs to the point at the base origin (J_s), not to the tool"),
            Hint(
                "euler", "differences of Euler angles are not an angular velocity: take the rotation between"
            ),
            Hint("no_log", "R_+ - R_- is no rotation: omega comes from the one between them, R_+ R_-^T"),
            Hint("two_logs", "logarithms of rotations do not subtract: take the one of R_+ R_-^T"),
        ),
    ),
    Exercise(
        "ellipsoid(J)",
        look=looks.ellipsoid,
        points=2,
        draw=draws.rows,
        shape=((3,), (3, 3)),
        compare=("close", "columns_up_to_sign"),
        unit="m/s",
        samples=3,
        usual="for an ordinary J",
        laws=(("twice the Jacobian makes half axes twice as long", _scaled),),
        blocks=(Block("the half axes", plural=True), Block("the directions", part=1, plural=True)),
        edges=(
            Edge("for the Panda at theta = 0", draws.panda_stretched),
            Edge("for a singular J", draws.flat_rows, count=3),
            Edge("for a nearly singular J", draws.nearly_flat_rows),
            Edge("for three joints", lambda rng: draws.rows(rng, 3)),
            Edge("for seven joints", lambda rng: draws.rows(rng, 7)),
        ),
        residual=residuals.half_axis_missed,
        hints=(
            Hint("no_root", "these are eigenvalues: a half axis is the root of one"),
            Hint("in_rows", "the directions stand in the rows of your matrix; they belong in its columns"),
            Hint(
                "rows_reversed", "the directions are columns: V[:, ::-1] turns their order, V[::-1] the rows"
            ),
            Hint("ascending", "shortest first: the longest half axis should come first, with its direction"),
            Hint(
                "half_sorted",
                "the half axes stand shortest first, their directions longest first: sort both alike",
            ),
            Hint("joint_space", "the ellipsoid lives in the space of velocities: J J^T, not J^T J"),
        ),
    ),
    Exercise(
        "dls_step(J, e, k)",
        points=2,
        draw=draws.step,
        shape=(None,),
        unit="rad",
        laws=(("the more damping, the nearer the step comes to J^T e / k^2", _much_damping),),
        samples=3,
        usual="for an ordinary J",
        edges=(
            Edge("for more joints than rows", lambda rng: draws.step(rng, (3, 7))),
            Edge("for as many joints as rows", lambda rng: draws.step(rng, (3, 3))),
            Edge("for fewer joints than rows", lambda rng: draws.step(rng, (4, 3))),
            Edge("for one joint", lambda rng: draws.step(rng, (2, 1))),
            Edge("for a singular J", draws.singular_step),
            Edge("where e and k are small", draws.slight_step),
            Edge("where k is large", lambda rng: (*draws.step(rng)[:2], 5.0)),
            Edge("for whole numbers", draws.whole_step),
        ),
        residual=residuals.factor_missed,
        hints=(
            Hint("not_squared", "k enters squared: your damping is that of its root"),
            Hint("everywhere", "k^2 belongs on the diagonal; numpy added yours to every entry of J J^T"),
            Hint("undamped", "k makes no difference to your step: this is the pseudo-inverse"),
            Hint("away", "this step leads away from the target: check the sign"),
            Hint("transpose", "the inverse is missing: J^T e is the step of the transpose method"),
        ),
    ),
    Exercise(
        "tool_velocity(theta, rate, lengths)",
        look=looks.velocity,
        points=2,
        draw=draws.planar,
        shape=((2,), (2,)),
        unit="m/s",
        laws=(("a velocity has the same length in every frame", _same_length),),
        samples=2,
        usual="for ordinary angles and rates",
        blocks=(Block("v_B"), Block("v_E", part=1)),
        edges=(
            Edge("for the arm of the exam", lambda rng: ([np.pi / 4, -np.pi / 2], [1, -1], [0.5, 0.25])),
            Edge("for a straight arm (theta_2 = 0)", draws.straight),
            Edge("where both angles are 0", lambda rng: ([0.0, 0.0], *draws.planar(rng)[1:])),
            Edge(
                "where joint 2 stands still",
                lambda rng: (draws.angles(rng, 2), [rng.uniform(0.5, 2), 0], [0.6, 0.3]),
            ),
            Edge(
                "where joint 1 stands still",
                lambda rng: (draws.angles(rng, 2), [0, rng.uniform(0.5, 2)], [0.6, 0.3]),
            ),
            Edge("for whole numbers", draws.whole_planar),
            Edge("where joints have turned more than once", draws.planar_turned),
        ),
        residual=residuals.planar_velocity_missed,
        hints=(
            Hint(
                "sign", "the y part of v_B has the wrong sign, as in the exam's solution; your v_E is right"
            ),
            Hint(
                "not_a_turn", "your rotation has two equal signs: it is not a rotation, see its determinant"
            ),
            Hint("turned_wrong_way", "R_BE takes E to B; to see v_B from E you need it the other way round"),
            Hint("theta2_alone", "frame E is turned by theta_1 + theta_2 against the base"),
            Hint("turned_by_theta1", "frame E turns with link 2: by theta_1 + theta_2, not by theta_1 alone"),
            Hint("link2_alone", "link 2 points along theta_1 + theta_2; you took theta_2 for the sum"),
            Hint("rate2_alone", "link 2 turns with both rates: joint 1 carries it along"),
            Hint("sines_added", "s12 is the sine of the sum, sin(theta_1 + theta_2), not a sum of sines"),
            Hint("sines_multiplied", "s12 is the sine of the sum, sin(theta_1 + theta_2), not a product"),
            Hint("on_its_side", "your J lies on its side: a row for each of v_x and v_y, a column per joint"),
        ),
    ),
    Exercise(
        "transform_rate(T_left, S, theta, T_right)",
        look=looks.column,
        points=3,
        draw=draws.factor(),
        shape=((4, 4), (6,)),
        tol=1e-8,
        unit="1, m",
        laws=(("the last row of a pose never changes: that of T-dot is 0 0 0 0", _no_last_row),),
        samples=2,
        usual="for an ordinary hinge",
        blocks=(
            Block("T-dot"),
            Block("the upper half of the column (omega)", np.s_[:3], part=1),
            Block("the lower half of the column (v)", np.s_[3:], part=1),
        ),
        edges=(
            Edge("for a turn about y", draws.turn_about_y),
            Edge("where theta is 0", draws.factor(angle=0.0)),
            Edge("where T_left is the identity", draws.factor(left=np.eye(4))),
            Edge("for a slide", draws.slide),
            Edge("for a screw with pitch", draws.screw_with_pitch),
            Edge("for whole numbers", draws.whole_factor),
            Edge("where theta is more than a turn", draws.factor(angle=8.0)),
        ),
        residual=residuals.rate_missed,
        hints=(
            Hint("no_turn_back", "T-dot still holds the rotation of T: multiply by T_o, then read omega"),
            Hint(
                "space",
                "T_o takes back the rotation alone: with the whole inverse of T, v belongs to the"
                " base origin (J_s)",
            ),
            Hint("body", "the inverse of T on the left gives the column of J_b, along the tool's axes"),
            Hint("swapped", "T_left stands before H, T_right behind it"),
            Hint("at_zero", "H-dot is [S] H: you have [S] alone, which is its value at theta = 0"),
            Hint("seen_from_base", "[S] H stands between T_left and T_right: S is seen from T_left's frame"),
            Hint("undifferentiated", "this is T, not its derivative: one factor has to become H-dot"),
            Hint(
                "rows_swapped", "the column is (omega; v): you have v on top, as the assignment of 2020 does"
            ),
            Hint("wrong_entries", "omega has the wrong sign: it stands in the entries (3,2), (1,3), (2,1)"),
        ),
    ),
    Exercise(
        "torques(J_b, T, moment, force)",
        points=2,
        draw=draws.wrench,
        shape=(None,),
        unit="N m",
        laws=(("the power of the joints is the power of the tool, whatever the rates", _same_power),),
        samples=3,
        usual="for an ordinary arm",
        edges=(
            Edge("where the tool stands along the base", lambda rng: draws.wrench(rng, R=np.eye(3))),
            Edge("for a force alone", lambda rng: draws.wrench(rng, moment=np.zeros(3))),
            Edge("for a moment alone", lambda rng: draws.wrench(rng, force=np.zeros(3))),
            Edge("for six joints", lambda rng: draws.wrench(rng, 6)),
            Edge("for two joints", lambda rng: draws.wrench(rng, 2, moment=draws.SLIGHT)),
            Edge("for whole numbers", draws.whole_wrench),
        ),
        residual=residuals.power_missed,
        hints=(
            Hint("not_turned", "J_b lies along the tool, the force along the base: turn one to the other"),
            Hint("turned_wrong_way", "R carries tool to base; the force has to go the other way"),
            Hint("rows_swapped", "J_b has omega on top: the moment belongs there, the force below"),
            Hint("inverse", "forces need no inverse: it is the transpose that carries them to the joints"),
            Hint("no_moment", "your torques do not change with the moment"),
            Hint("about_base", "the moment is given at the tool point: no p x f has to be added"),
            Hint("point_moved", "Ad(T)^T moves the point as well; here the axes alone change, by R^T"),
            Hint("against", "these torques give way: the joints must push as the tool is to push"),
        ),
    ),
    DLS_LOOP,
]
