"""Exercises of notebook 05: Jacobians by several methods, ellipsoids, damped steps, planar velocities."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb05 as residuals
from coursekit.classroom.exercises import looks

# What the student's functions may call from coursekit.kinematics: what notebooks 01 to 03 had them write or
# told them to use, and `log3`.
ALLOW = (
    "lie.exp6",
    "lie.adjoint",
    "lie.inverse",
    "lie.hat3",
    "lie.vee3",
    "lie.log3",
    "lie.log6",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
    "robot.Robot.fk",
)
KR10 = (  # its screws: w and a point of each axis
    ((0, 0, -1), (0, 1, 0), (0, 1, 0), (-1, 0, 0), (0, 1, 0), (-1, 0, 0)),
    ((0, 0, 0), (0.025, 0, 0.4), (0.585, 0, 0.4), (0, 0, 0.425), (1.1, 0, 0.425), (0, 0, 0.425)),
)
KR10_TOOL = np.array([1.19, 0, 0.425])


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.2, 1.3, n)


def _axes(rng, n):
    """Unit vectors (n, 3)."""
    w = rng.normal(size=(n, 3))
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def _screws(rng, n=None):
    n = n or int(rng.integers(4, 8))
    w, q = _axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3))
    return np.column_stack([w, np.cross(q, w)]).T, _angles(rng, n)


def _screws_with_slide(rng):
    S, theta = _screws(rng, 5)
    S[:, 2] = [0, 0, 0, *_axes(rng, 1)[0]]
    return S, theta


def _screws_with_pitch(rng):
    S, theta = _screws(rng, 4)
    S[3:] += rng.uniform(0.05, 0.3, 4) * S[:3]
    return S, theta


def _screws_of_the_kr10(angles):
    def draw(rng):
        w, q = map(np.array, KR10)
        return np.column_stack([w, np.cross(q, w)]).T, angles(rng)

    return draw


def _whole_screws(rng):
    """A planar arm with links of 2 m and 1 m, and an axis that lies in its plane."""
    S = np.zeros((6, 4), int)
    S[2, :3], S[4, 1:3], S[0, 3], S[4, 3] = 1, (-2, -3), 1, 1
    return S, rng.permutation([1, 2, -1, -2])


def _hinges(rng, n=None):
    n = n or int(rng.integers(4, 8))
    return _axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3)), rng.uniform(-1.0, 1.0, 3)


def _tool_on_an_axis(rng):
    axes, origins, _ = _hinges(rng, 4)
    return axes, origins, origins[2] + rng.uniform(0.2, 0.6) * axes[2]


def _tool_at_the_origin(rng):
    axes, origins, _ = _hinges(rng, 4)
    return axes, origins, np.zeros(3)


def _hinges_of_the_kr10(rng):
    return np.array(KR10[0]), np.array(KR10[1]), KR10_TOOL


def _arm_and_step(rng, name=None):
    """The forward kinematics of an arm, a configuration and a step of 0.0005 to 0.001 rad."""
    names = {"kuka_kr6": 6, "abb_irb1200": 6, "franka_panda": 7, "kawasaki_s030": 6, "planar_2r": 2}
    name = name or str(rng.choice(list(names)[:4]))
    return {"fk": name}, _angles(rng, names[name]), rng.uniform(5e-4, 1e-3)


def _coarse(rng):
    return {"fk": "kuka_kr6"}, _angles(rng, 6), 0.1


# Central differences of positions are all alike, whatever the step. The turn between two poses may be taken
# as a logarithm, or from the entries of R_+ - R_-: that differs by step^2 / 6.
COARSE_TOL = np.repeat([[0.003], [1e-7]], 3, axis=0)


def _rows(rng, n=None, lowest=(1.2, 0.6, 0.1), highest=(1.8, 0.9, 0.4)):
    """Three rows of a Jacobian whose singular values are well apart."""
    n = n or int(rng.integers(3, 8))
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (3, n))
    return (U @ np.diag(rng.uniform(lowest, highest)) @ V[:3],)


def _flat_rows(rng):
    """Rank 2: rounding makes the least eigenvalue of J J^T a tiny number of either sign."""
    return _rows(rng, 5, (1.2, 0.6, 0.0), (1.8, 0.9, 0.0))


def _panda_stretched(rng):
    """omega of the Panda at theta = 0."""
    return ([[0, 0, 0, 0, 0, 0, 0], [0, 1, 0, -1, 0, -1, 0], [1, 0, 1, 0, 1, 0, -1]],)


def _step(rng, shape=None, least=None):
    """A Jacobian, nearly singular, an error and a damping."""
    m, n = shape or [(6, 7), (6, 6), (3, 7), (3, 3)][rng.integers(4)]
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (m, n))
    r = min(m, n)
    sigma = rng.uniform(0.3, 1.5, r)
    sigma[-1] = rng.uniform(0.02, 0.1) if least is None else least
    return U[:, :r] @ np.diag(sigma) @ V[:r], rng.uniform(-0.5, 0.5, m), rng.uniform(0.1, 0.4)


def _singular_step(rng):
    """A row of zeros: whatever the joints do, nothing moves along it."""
    J, e, k = _step(rng, (3, 4))
    J[rng.integers(3)] = 0
    return J, e, k


def _whole_step(rng):
    return rng.permutation([[1, 0, 2], [0, 1, -1]]), rng.permutation([1, -2]), 3


def _planar(rng):
    return _angles(rng, 2), rng.choice([-1, 1], 2) * rng.uniform(0.4, 2.0, 2), rng.uniform(0.2, 0.8, 2)


def _straight(rng):
    theta, rate, lengths = _planar(rng)
    return theta * [1, 0], rate, lengths


def _whole_planar(rng):
    return rng.permutation([1, 2]), rng.permutation([1, -2]), rng.permutation([2, 1])


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


EXERCISES = [
    Exercise(
        "jacobian_space(S, theta)",
        look=looks.screws,
        points=3,
        draw=_screws,
        shape=(6, None),
        unit="1, m",
        laws=(("turning the last joint moves no joint axis: all columns must stay", _own_turn),),
        usual="for hinges at ordinary angles",
        samples=3,
        edges=(
            Edge(
                "for the KR10 at right angles",
                _screws_of_the_kr10(lambda r: np.pi / 2 * r.permutation([1, -1, 2, 1, -1, 0])),
            ),
            Edge("for the KR10 at theta = 0", _screws_of_the_kr10(lambda r: np.zeros(6))),
            Edge("for an arm with one joint", lambda rng: _screws(rng, 1)),
            Edge("for an arm with seven joints", lambda rng: _screws(rng, 7)),
            Edge("for an arm with a slide", _screws_with_slide),
            Edge("for screws with pitch", _screws_with_pitch),
            Edge("for whole numbers", _whole_screws),
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
            Hint("one_short", "your product stops one joint early: axis i is moved by joint i - 1, too"),
        ),
    ),
    Exercise(
        "jacobian_geometric(axes, origins, tool)",
        points=3,
        draw=_hinges,
        shape=(6, None),
        unit="1, m",
        laws=(("joint 1 cannot move a tool that lies on axis 1", _tool_on_axis),),
        samples=3,
        usual="for ordinary hinges",
        edges=(
            Edge("for axes that are whole numbers", _hinges_of_the_kr10),
            Edge("for an arm with one joint", lambda rng: _hinges(rng, 1)),
            Edge("for an arm with three joints", lambda rng: _hinges(rng, 3)),
            Edge("where the tool lies on an axis", _tool_on_an_axis),
            Edge("where the tool is at the base origin", _tool_at_the_origin),
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
        ),
    ),
    Exercise(
        "jacobian_by_differences(fk, theta, step)",
        points=3,
        draw=_arm_and_step,
        shape=(6, None),
        unit="1, m",
        tol=2e-6,
        usual="for a small step",
        samples=3,
        edges=(
            Edge("for a step of 0.1 rad", _coarse, tol=COARSE_TOL),
            Edge("for an arm with seven joints", lambda rng: _arm_and_step(rng, "franka_panda")),
            Edge("for an arm with two joints", lambda rng: _arm_and_step(rng, "planar_2r")),
            Edge("for the KR10 at theta = 0", lambda rng: ({"fk": "kuka_kr10"}, np.zeros(6), 1e-3)),
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
        ),
    ),
    Exercise(
        "ellipsoid(J)",
        look=looks.ellipsoid,
        points=2,
        draw=_rows,
        shape=((3,), (3, 3)),
        compare=("close", "columns_up_to_sign"),
        unit="m/s",
        samples=3,
        usual="for an ordinary J",
        laws=(("twice the Jacobian makes half axes twice as long", _scaled),),
        blocks=(Block("the half axes", plural=True), Block("the directions", part=1, plural=True)),
        edges=(
            Edge("for the Panda at theta = 0", _panda_stretched),
            Edge("for a singular J", _flat_rows, count=3),
            Edge("for three joints", lambda rng: _rows(rng, 3)),
            Edge("for seven joints", lambda rng: _rows(rng, 7)),
        ),
        residual=residuals.half_axis_missed,
        hints=(
            Hint("no_root", "these are eigenvalues: a half axis is the root of one"),
            Hint("in_rows", "the directions stand in the rows of your matrix; they belong in its columns"),
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
        draw=_step,
        shape=(None,),
        unit="rad",
        laws=(("the more damping, the nearer the step comes to J^T e / k^2", _much_damping),),
        samples=3,
        usual="for an ordinary J",
        edges=(
            Edge("for more joints than rows", lambda rng: _step(rng, (3, 7))),
            Edge("for as many joints as rows", lambda rng: _step(rng, (3, 3))),
            Edge("for fewer joints than rows", lambda rng: _step(rng, (4, 3))),
            Edge("for one joint", lambda rng: _step(rng, (2, 1))),
            Edge("for a singular J", _singular_step),
            Edge("for whole numbers", _whole_step),
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
        draw=_planar,
        shape=((2,), (2,)),
        unit="m/s",
        laws=(("a velocity has the same length in every frame", _same_length),),
        samples=3,
        usual="for ordinary angles and rates",
        blocks=(Block("v_B"), Block("v_E", part=1)),
        edges=(
            Edge("for the arm of the exam", lambda rng: ([np.pi / 4, -np.pi / 2], [1, -1], [0.5, 0.25])),
            Edge("for a straight arm (theta_2 = 0)", _straight),
            Edge("where both angles are 0", lambda rng: ([0.0, 0.0], *_planar(rng)[1:])),
            Edge(
                "where joint 2 stands still",
                lambda rng: (_angles(rng, 2), [rng.uniform(0.5, 2), 0], [0.6, 0.3]),
            ),
            Edge(
                "where joint 1 stands still",
                lambda rng: (_angles(rng, 2), [0, rng.uniform(0.5, 2)], [0.6, 0.3]),
            ),
            Edge("for whole numbers", _whole_planar),
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
            Hint("rate2_alone", "link 2 turns with both rates: joint 1 carries it along"),
        ),
    ),
]
