"""Three ways to one Jacobian, and its ellipsoids: against each other, golden data, and singular poses."""

import numpy as np
import pytest

from coursekit import Robot, jacobians, lie, robots
from tests.kinematics.conftest import GOLDEN_ROBOTS

SHAPES = [(), (1,), (3, 1, 2)]
METHODS = [jacobians.skew_theory, jacobians.by_matrix_derivative, jacobians.by_differences]
TOLERANCE = {"skew_theory": 1e-12, "by_matrix_derivative": 1e-12, "by_differences": 3e-10}
ALL = robots.all()


def sliding_arm():
    """Turn, slide along a slanted line, turn, slide: every joint type in every place."""
    w, q = [[0, 0, 1], [1, 2, 2], [0, 1, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 0], [0.3, 0.1, 0.4], [0, 0, 0]]
    return Robot.from_axes(w, q, lie.exp6([0.1, 0.2, 0.3, 0.5, 0.4, 0.6]), "RPRP", name="RPRP")


def climbing_arm():
    """Screws with a pitch: they turn and slide at once."""
    S = np.array([[0, 0, 1, 0, 0, 0.1], [0, 1, 0, -0.4, 0.2, 0], [1, 0, 0, -0.3, 0.2, 0.5]]).T
    return Robot.from_screws(S, lie.exp6([0.3, 0.2, 0.1, 0.4, 0.5, 0.6]), name="screws with pitch")


ARMS = {**ALL, "sliding": sliding_arm(), "climbing": climbing_arm()}


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("method", METHODS, ids=lambda f: f.__name__)
def test_every_method_gives_the_geometric_jacobian(name, method):
    robot = ARMS[name]
    theta = np.random.default_rng(0).uniform(-3, 3, (200, robot.n))
    difference = np.abs(method(robot, theta) - robot.jacobian_geometric(theta))
    assert difference.max() <= TOLERANCE[method.__name__]


@pytest.mark.parametrize("file", GOLDEN_ROBOTS)
def test_golden_jacobians(golden, file):
    robot = ALL[GOLDEN_ROBOTS[file]]
    for case in golden(f"fk_jac_{file}")["cases"]:
        J_s, J_b = robot.jacobian_space(case["q"]), robot.jacobian_body(case["q"])
        assert np.abs(J_s - case["J_space"]).max() <= 1e-11
        assert np.abs(J_b - case["J_body"]).max() <= 1e-11
        R = np.array(case["T"])[:3, :3]
        turned = np.vstack([R @ np.array(case["J_body"])[:3], R @ np.array(case["J_body"])[3:]])
        assert np.abs(jacobians.skew_theory(robot, case["q"]) - turned).max() <= 1e-11


@pytest.mark.parametrize("file", GOLDEN_ROBOTS)
def test_golden_ellipsoids(golden, file):
    robot = ALL[GOLDEN_ROBOTS[file]]
    for case in golden(f"fk_jac_{file}")["cases"]:
        J = robot.jacobian_body(case["q"])
        for part, key in (("linear", "lin_eig"), ("angular", "ang_eig")):
            eigenvalues = np.sort(jacobians.ellipsoid(J, part).lengths ** 2)
            assert np.abs(eigenvalues - np.sort(case[key])).max() <= 1e-11
        if "manip" in case:
            assert jacobians.manipulability(J) == pytest.approx(case["manip"], abs=1e-11)


def test_golden_planar_arm(golden):
    robot = robots.planar_2r()
    for case in golden("fk_jac_planar_2r")["cases"]:
        J = jacobians.planar(robot, case["q"])
        assert np.abs(J - case["J_planar"]).max() <= 1e-11
        assert jacobians.manipulability(J) == pytest.approx(case["manip_planar"], abs=1e-11)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("method", METHODS, ids=lambda f: f.__name__)
def test_shapes(method, shape):
    robot = robots.franka_panda()
    theta = np.random.default_rng(1).uniform(-2, 2, (*shape, 7))
    J = method(robot, theta)
    assert J.shape == (*shape, 6, 7)
    one_by_one = [method(robot, q) for q in theta.reshape(-1, 7)]
    assert np.abs(J.reshape(-1, 6, 7) - one_by_one).max() <= 1e-12
    found = jacobians.ellipsoid(J, "linear")
    assert found.axes.shape == (*shape, 3, 3)
    assert found.lengths.shape == (*shape, 3)
    for value in (found.volume, found.isotropy, found.condition, jacobians.manipulability(J)):
        assert np.shape(value) == shape


@pytest.mark.parametrize("part", ["angular", "linear"])
def test_an_ellipsoid_is_what_unit_rates_reach(part):
    """J maps the unit sphere of joint rates onto the ellipsoid: x' (J J')^-1 x = 1 on its surface."""
    rng = np.random.default_rng(2)
    robot = robots.kuka_kr6()
    J = robot.jacobian_body(rng.uniform(-2, 2, (50, 6)))
    A = J[:, jacobians.PARTS[part]]
    found = jacobians.ellipsoid(J, part)
    tips = found.axes * found.lengths[:, None, :]
    assert np.abs(tips @ np.swapaxes(tips, 1, 2) - A @ np.swapaxes(A, 1, 2)).max() <= 1e-12
    assert np.all(np.diff(found.lengths, axis=-1) <= 0)
    assert np.linalg.det(found.axes) == pytest.approx(np.ones(50))
    eigenvalues = np.linalg.eigvalsh(A @ np.swapaxes(A, 1, 2))
    assert found.condition == pytest.approx(eigenvalues[:, 2] / eigenvalues[:, 0])
    assert found.isotropy == pytest.approx(np.sqrt(found.condition))
    assert found.volume == pytest.approx(4 / 3 * np.pi * np.sqrt(np.linalg.det(A @ np.swapaxes(A, 1, 2))))


def test_the_ellipsoid_of_a_singular_pose_is_flat():
    """The Panda at zero: eigenvalues 4, 3, 0, exactly (not 1e-17), so no volume and no finite ratio."""
    flat = jacobians.ellipsoid(robots.franka_panda().jacobian_body(np.zeros(7)), "angular")
    assert flat.lengths == pytest.approx([2, np.sqrt(3), 0])
    assert flat.lengths[2] == 0
    assert flat.volume == flat.product == 0
    assert flat.isotropy == flat.condition == np.inf
    for theta in np.random.default_rng(1).uniform(-3, 3, (20, 2)):  # turned, so that rounding has its say
        T = lie.exp6([0.3, *theta, 0, 0, 0])
        turned = lie.adjoint(T) @ robots.franka_panda().jacobian_body(np.zeros(7))
        assert jacobians.ellipsoid(turned, "angular").lengths[2] == 0


def test_the_ellipsoid_of_an_arm_that_moves_along_a_line():
    J = np.zeros((6, 1))
    J[3] = 2.0
    found = jacobians.ellipsoid(J, "linear")
    assert found.lengths.tolist() == [2, 0, 0]
    assert np.abs(found.axes[:, 0]).tolist() == [1, 0, 0]
    assert jacobians.ellipsoid(J, "angular").lengths.tolist() == [0, 0, 0]


def test_the_sign_of_a_singular_vector_is_fixed():
    """Its largest component is positive, whatever the sign of what came in."""
    A = np.random.default_rng(3).normal(size=(50, 6, 6))
    U, sigma = jacobians.left_singular(A)
    assert np.all(np.take_along_axis(U, np.abs(U).argmax(axis=-2, keepdims=True), axis=-2) > 0)
    assert np.allclose(jacobians.left_singular(-A)[0], U)
    assert np.allclose(
        np.swapaxes(U, -1, -2) @ A @ np.swapaxes(A, -1, -2) @ U, sigma[:, None] ** 2 * np.eye(6)
    )


def test_nan_stays_where_it_is():
    robot = robots.kuka_kr6()
    theta = np.full((2, 6), 0.3)
    theta[1, 2] = np.nan
    J = robot.jacobian_body(theta)
    found = jacobians.ellipsoid(J, "linear")
    for value in (found.axes, found.lengths, found.volume, found.condition, jacobians.manipulability(J)):
        assert np.isfinite(value[0]).all()
        assert np.isnan(value[1]).any()
    assert np.isnan(jacobians.by_differences(robot, theta)[1]).any()


def test_what_is_refused():
    robot = robots.kuka_kr6()
    J = robot.jacobian_body(np.zeros(6))
    with pytest.raises(ValueError, match="part must be 'angular' or 'linear', got 'both'"):
        jacobians.ellipsoid(J, "both")
    with pytest.raises(ValueError, match=r"J must have shape \(\.\.\., 6, n\)"):
        jacobians.ellipsoid(np.eye(3))
    with pytest.raises(ValueError, match=r"J must have shape \(\.\.\., rows, n\)"):
        jacobians.manipulability(np.ones(3))
    with pytest.raises(ValueError, match="step must be a positive number"):
        jacobians.by_differences(robot, np.zeros(6), step=0)
    with pytest.raises(ValueError, match="KUKA KR6 R900 sixx is not a planar arm: joint 2"):
        jacobians.planar(robot, np.zeros(6))
    with pytest.raises(ValueError, match=r"^J must be an array of real numbers"):
        jacobians.manipulability("J")
    along_x = Robot.from_axes([[1, 0, 0]], [[0, 0, 0]], np.eye(4), name="along x")
    with pytest.raises(ValueError, match="along x is not a planar arm: joint 1"):
        jacobians.planar(along_x, [0.0])
    for method in METHODS:
        with pytest.raises(ValueError, match=r"KUKA KR6 R900 sixx has 6 joints: theta must have shape"):
            method(robot, np.zeros(5))


def test_the_rate_of_a_transform_is_its_slope():
    rng = np.random.default_rng(3)
    left, right = lie.exp6(rng.normal(size=(2, 5, 6)))
    S, theta, h = rng.normal(size=(5, 6)), rng.uniform(-2, 2, 5), 1e-5
    T_dot, column = jacobians.transform_rate(left, S, theta, right)
    ahead, behind = (left @ lie.exp6(S * t[:, None]) @ right for t in (theta + h, theta - h))
    np.testing.assert_allclose(T_dot, (ahead - behind) / (2 * h), rtol=0, atol=1e-8)
    turn = lie.log3(ahead[:, :3, :3] @ np.swapaxes(behind[:, :3, :3], 1, 2)) / (2 * h)
    np.testing.assert_allclose(column, np.hstack([turn, T_dot[:, :3, 3]]), rtol=0, atol=1e-8)


def test_columns_of_hinges_take_batches():
    rng = np.random.default_rng(4)
    w, o, p = rng.normal(size=(3, 4, 3)), rng.normal(size=(3, 4, 3)), rng.normal(size=(3, 3))
    J = jacobians.of_hinges(w, o, p)
    for k in range(3):
        np.testing.assert_allclose(J[k, 3:].T, np.cross(w[k], p[k] - o[k]), rtol=0, atol=1e-14)
        np.testing.assert_array_equal(J[k, :3].T, w[k])


@pytest.mark.parametrize("robot", robots.all().values(), ids=lambda r: r.name)
def test_columns_one_by_one_are_the_body_jacobian(robot):
    theta = np.random.default_rng(8).uniform(-1, 1, robot.n)
    T, before = robot.fk(theta), np.concatenate([np.eye(4)[None], robot.displacements(theta)[:-1]])
    found = []
    for kind, S, D in zip(robot.joint_types, robot.S.T, before, strict=True):
        w = S[:3] if kind == "revolute" else S[3:]
        q = D @ [*np.cross(S[:3], S[3:]), 1]
        found.append(jacobians.column(kind, D[:3, :3] @ w, q[:3], T))
    np.testing.assert_allclose(np.transpose(found), robot.jacobian_body(theta), rtol=0, atol=1e-12)


def test_a_kind_of_joint_that_is_none():
    with pytest.raises(ValueError, match="'revolute' or 'prismatic', got 'hinge'"):
        jacobians.column("hinge", [0, 0, 1], [0, 0, 0], np.eye(4))
