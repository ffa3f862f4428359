"""Exercises of notebook 05: Jacobians by several methods, ellipsoids, damped steps, planar velocities."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics.
ALLOW = (
    "lie.exp6",
    "lie.adjoint",
    "lie.hat3",
    "lie.vee3",
    "lie.log3",
    "robot.Robot.fk",
)


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.2, 1.3, n)


def _axes(rng, n):
    """Unit vectors (n, 3)."""
    w = rng.normal(size=(n, 3))
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def _screws(rng):
    n = int(rng.integers(4, 8))
    w, q = _axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3))
    return np.column_stack([w, np.cross(q, w)]).T, _angles(rng, n)


def _hinges(rng):
    n = int(rng.integers(4, 8))
    return _axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3)), rng.uniform(-1.0, 1.0, 3)


def _arm_and_step(rng):
    """The forward kinematics of an arm, a configuration and a step of 0.0005 to 0.001 rad."""
    names = {"kuka_kr6": 6, "abb_irb1200": 6, "franka_panda": 7, "kawasaki_s030": 6}
    name = str(rng.choice(list(names)))
    return {"fk": name}, _angles(rng, names[name]), rng.uniform(5e-4, 1e-3)


def _rows(rng):
    """Three rows of a Jacobian whose singular values are well apart."""
    n = int(rng.integers(3, 8))
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (3, n))
    return (U @ np.diag(rng.uniform([1.2, 0.6, 0.1], [1.8, 0.9, 0.4])) @ V[:3],)


def _step(rng):
    """A wide or square Jacobian, nearly singular, an error and a damping."""
    m, n = [(6, 7), (6, 6), (3, 7), (3, 3)][rng.integers(4)]
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (m, n))
    sigma = rng.uniform(0.3, 1.5, m)
    sigma[-1] = rng.uniform(0.02, 0.1)
    return U @ np.diag(sigma) @ V[:m], rng.uniform(-0.5, 0.5, m), rng.uniform(0.1, 0.4)


def _planar(rng):
    return _angles(rng, 2), rng.choice([-1, 1], 2) * rng.uniform(0.4, 2.0, 2), rng.uniform(0.2, 0.8, 2)


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
        points=3,
        draw=_screws,
        shape=(6, None),
        unit="1, m",
        laws=(("turning the last joint moves no joint axis: all columns must stay", _own_turn),),
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
        hints=(
            Hint("forward", "a one-sided difference is too coarse for this step: go both ways"),
            Hint("half", "twice too large: between the two poses lie two steps"),
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
        points=2,
        draw=_rows,
        shape=((3,), (3, 3)),
        compare=("close", "columns_up_to_sign"),
        unit="m/s",
        samples=6,
        laws=(("twice the Jacobian makes half axes twice as long", _scaled),),
        hints=(
            Hint("no_root", "these are eigenvalues: a half axis is the root of one"),
            Hint("in_rows", "the directions stand in the rows of your matrix; they belong in its columns"),
            Hint("ascending", "shortest first: the longest half axis should come first, with its direction"),
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
        points=2,
        draw=_planar,
        shape=((2,), (2,)),
        unit="m/s",
        laws=(("a velocity has the same length in every frame", _same_length),),
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
