"""The expressions of symbolic: equal to the numbers at random angles, exact, and of the published form."""

import numpy as np
import pytest
import sympy as sp

from coursekit import Robot, lie, robots, rotations, singularity, symbolic
from coursekit.kinematics import dh

ARMS = {name: (robot, symbolic.arm(robot)) for name, robot in robots.all().items()}
SPHERICAL = ["kuka_kr6", "kuka_kr10", "kuka_kr10_report", "abb_irb1200", "kawasaki_s030", "puma560"]
PROVED = ["kuka_kr6", "abb_irb1200", "kawasaki_s030"]  # a second or two each
a1, a2, a3, d1, d4, d6 = sp.symbols("a_1 a_2 a_3 d_1 d_4 d_6", positive=True)
t1, t2, t3, t4, t5, t6 = sp.symbols("theta_1:7", real=True)


def value(arm, expression, theta):
    """The expression as numbers."""
    function = sp.lambdify([arm.theta, list(arm.lengths)], expression, cse=True)
    numbers = np.array(function(theta, [float(metres) for metres in arm.lengths.values()]), dtype=float)
    return numbers.reshape(expression.shape if isinstance(expression, sp.MatrixBase) else ())


def angles(robot, seed=0):
    return np.random.default_rng(seed).uniform(-3, 3, robot.n)


@pytest.mark.parametrize("name", ARMS)
def test_home_pose_and_screws(name):
    robot, arm = ARMS[name]
    for expression, number in ((arm.S, robot.S), (arm.M, robot.M), (arm.B, robot.B)):
        assert np.abs(np.array(arm.numbers(expression), dtype=float) - number).max() <= 1e-14
        assert not expression.atoms(sp.Float)
        assert not expression.atoms(sp.sin, sp.cos)  # a quarter turn is exact


@pytest.mark.parametrize("name", ARMS)
def test_forward_kinematics_and_jacobian(name):
    robot, arm = ARMS[name]
    theta = angles(robot)
    assert np.abs(value(arm, symbolic.fk(arm), theta) - robot.fk(theta)).max() <= 1e-13
    assert np.abs(value(arm, symbolic.jacobian(arm), theta) - robot.jacobian_space(theta)).max() <= 1e-13


@pytest.mark.parametrize("name", [name for name, (robot, _) in ARMS.items() if robot.standard_dh])
def test_dh_matrices(name):
    robot, arm = ARMS[name]
    theta = angles(robot)
    numbers = robot.standard_dh.link_transforms(theta)
    for A, number in zip(arm.A, numbers, strict=True):
        assert np.abs(value(arm, A, theta) - number).max() <= 1e-14
    T = sp.prod([arm.base, *arm.A, arm.tool])
    assert np.abs(value(arm, T, theta) - robot.fk(theta)).max() <= 1e-13


def test_a_dh_row_in_both_conventions():
    symbols = sp.symbols("a alpha d theta")
    numbers = [0.3, -0.7, 0.2, 1.1]
    for convention in dh.CONVENTIONS:
        A = symbolic.dh_matrix(*symbols, convention).subs(dict(zip(symbols, numbers, strict=True)))
        column = [[x] for x in numbers]
        assert (
            np.abs(np.array(A, float) - dh.Table(*column, convention).link_transforms([0])[0]).max() <= 1e-14
        )
    with pytest.raises(ValueError, match="convention must be 'standard' or 'modified', got 'Craig'"):
        symbolic.dh_matrix(*symbols, "Craig")


@pytest.mark.parametrize("slide", [False, True])
def test_screw_exp(slide):
    theta = sp.Symbol("theta")
    w, q = np.array([2, -1, 2]) / 3, np.array([0.4, 0.5, -0.2])
    S = np.concatenate([0 * w, w]) if slide else np.concatenate([w, -np.cross(w, q)])
    exact = [sp.nsimplify(x, rational=True) for x in S]
    E = symbolic.screw_exp(exact, theta)
    for angle in (0.3, -2.5):
        assert np.abs(np.array(E.subs(theta, angle), float) - lie.exp6(S * angle)).max() <= 1e-13


def test_turns_and_the_xyx_matrix():
    """TPK4170 report, eq. 4.17; its entry (2, 2) is misprinted there."""
    numbers = [0.3, 0.7, -1.1]
    a, b, c = sp.symbols("a b c")
    R = symbolic.xyx(a, b, c)
    assert (
        np.abs(
            np.array(R.subs(dict(zip((a, b, c), numbers, strict=True))), float) - rotations.from_xyx(numbers)
        ).max()
        <= 1e-15
    )
    assert R[1, 1] == sp.cos(a) * sp.cos(c) - sp.cos(b) * sp.sin(a) * sp.sin(c)
    for name in ("rotx", "roty", "rotz"):
        turned = np.array(getattr(symbolic, name)(sp.Float(0.7)), float)
        assert np.abs(turned - getattr(rotations, name)(0.7)).max() <= 1e-15


def test_kr6_as_the_report_writes_it():
    arm = ARMS["kuka_kr6"][1]
    assert arm.lengths[a2] == sp.Rational(455, 1000)
    assert arm.lengths[d6] == sp.Rational(80, 1000)
    assert arm.M[:3, 3] == sp.Matrix([a1 + a2 + d4 + d6, 0, a3 + d1])
    assert arm.S[:, 1] == sp.Matrix([0, 1, 0, -d1, 0, a1])


@pytest.mark.parametrize("name", SPHERICAL)
def test_det_j_in_factors(name):
    """The 6 x 6 determinant is that product: compared with numbers, and for three arms proved by sympy."""
    robot, arm = ARMS[name]
    J = symbolic.wrist_jacobian(arm)
    if name in PROVED:
        assert sp.simplify(J.det() - symbolic.determinant(arm)) == 0
    theta = angles(robot)
    numbers = singularity.factors(robot, theta)
    for factor, expression in symbolic.factors(arm).items():
        assert value(arm, expression, theta) == pytest.approx(numbers[factor], abs=1e-14)
    at_wrist = np.linalg.svd(value(arm, J, theta), compute_uv=False)
    center = np.eye(4)
    center[:3, 3] = value(arm, symbolic.wrist_center(arm), theta)[:, 0]
    moved = lie.adjoint(lie.inverse(center)) @ robot.jacobian_space(theta)
    assert at_wrist == pytest.approx(np.linalg.svd(moved, compute_uv=False), abs=1e-13)


def test_the_factors_have_the_published_form():
    elbow, shoulder = (symbolic.factors(ARMS["kuka_kr6"][1])[key] for key in ("elbow", "shoulder"))
    assert sp.expand(elbow - a2 * (a3 * sp.cos(t3) - d4 * sp.sin(t3))) == 0
    assert shoulder == a1 + a2 * sp.cos(t2) + d4 * sp.cos(t2 + t3) + a3 * sp.sin(t2 + t3)
    s030 = symbolic.factors(ARMS["kawasaki_s030"][1])
    assert s030["elbow"] == a2 * d4 * sp.cos(t3)
    assert s030["wrist"] == -sp.sin(t5)


def test_the_wrist_centre_of_the_kawasaki():
    """Robotics I exam, 17 June 2019, eq. 1 and its 3 x 3 Jacobian: det = a2 d4 cos q3 (a1 + ...)."""
    arm = ARMS["kawasaki_s030"][1]
    reach = a1 + a2 * sp.cos(t2) + d4 * sp.sin(t2 + t3)
    P = symbolic.wrist_center(arm)
    expected = [sp.cos(t1) * reach, sp.sin(t1) * reach, d1 + a2 * sp.sin(t2) - d4 * sp.cos(t2 + t3)]
    assert (P - sp.Matrix(expected)).applyfunc(sp.expand).is_zero_matrix
    det = P.jacobian([t1, t2, t3]).det()
    assert sp.simplify(det - a2 * d4 * sp.cos(t3) * reach) == 0
    at_home = value(arm, P, robots.kawasaki_s030().home)[:, 0]
    assert at_home == pytest.approx([1.23, 0, 1.55])


def test_a_sliding_joint():
    table = dh.Table(
        [0, 0.2, 0], [np.pi / 2, -np.pi / 2, 0], [0.3, 0, 0.1], [0, 0.4, np.pi / 6], joint_types="RRP"
    )
    robot = Robot.from_dh(table, name="RRP")
    arm, theta = symbolic.arm(robot), [0.3, -0.8, 0.25]
    assert np.abs(value(arm, symbolic.fk(arm), theta) - robot.fk(theta)).max() <= 1e-14
    assert np.abs(value(arm, symbolic.jacobian(arm), theta) - robot.jacobian_space(theta)).max() <= 1e-14
    assert np.abs(np.array(arm.numbers(arm.S), float) - robot.S).max() <= 1e-14


def test_planar_arm_is_short():
    arm = ARMS["planar_2r"][1]
    p = symbolic.fk(arm)[:2, 3]
    assert p == sp.Matrix([a1 * sp.cos(t1) + a2 * sp.cos(t1 + t2), a1 * sp.sin(t1) + a2 * sp.sin(t1 + t2)])
    assert sp.simplify(p.jacobian([t1, t2]).det()) == a1 * a2 * sp.sin(t2)


def test_arms_without_a_wrist_centre():
    for name, reason in (
        ("franka_panda", "Franka Emika Panda has 7 joints"),
        ("planar_2r", "planar 2R has 2 joints"),
        ("ur5", "axis 6 does not pass through the point where axes 4 and 5 meet"),
    ):
        with pytest.raises(ValueError, match=reason):
            symbolic.wrist_jacobian(ARMS[name][1])
