"""det J and its factors, names, ranks and lost motions: against golden data and against their definitions."""

import math

import numpy as np
import pytest

from coursekit import Robot, ik, jacobians, lie, robots, singularity
from tests.kinematics.conftest import GOLDEN_ROBOTS, SIX_HINGES

SHAPES = [(), (1,), (3, 1, 2)]
GOLDEN = {name: robots.all()[key] for name, key in GOLDEN_ROBOTS.items()}
SIX = {name: GOLDEN[name] for name in SIX_HINGES}


def random_angles(robot, count=300, seed=0):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, robot.n))


@pytest.mark.parametrize("name", SIX)
def test_the_determinant_is_the_published_formula(golden, name):
    robot = SIX[name]
    theta = random_angles(robot)
    names = {f"t{i + 1}": theta[:, i] for i in range(6)}
    formula = eval(golden("singular")["det_formula"][name], {"cos": np.cos, "sin": np.sin, **names})
    assert np.abs(singularity.determinant(robot, theta) - formula).max() <= 5e-15


@pytest.mark.parametrize("name", SIX)
def test_the_determinant_is_that_of_every_jacobian(name):
    robot = SIX[name]
    theta = random_angles(robot)
    moved = robot.with_tool(lie.exp6([0.3, -0.2, 0.5, 0.1, 0.2, 0.3])).with_base(
        lie.exp6([1, 2, 0.3, 1, 2, 3])
    )
    value = singularity.determinant(robot, theta)
    for J in (robot.jacobian_space(theta), robot.jacobian_body(theta), moved.jacobian_body(theta)):
        assert np.abs(np.linalg.det(J) - value).max() <= 2e-14
    assert np.abs(singularity.determinant(moved, theta) - value).max() <= 2e-14


@pytest.mark.parametrize("name", SIX)
def test_the_product_of_the_factors_is_the_determinant(name):
    robot = SIX[name]
    theta = random_angles(robot)
    factors = singularity.factors(robot, theta)
    assert tuple(factors) == singularity.NAMES
    product = math.prod(factors.values())
    assert np.abs(product - np.linalg.det(robot.jacobian_body(theta))).max() <= 5e-15
    assert np.all(np.abs(list(singularity.relative_factors(robot, theta).values())) <= 1 + 1e-12)


def test_the_factors_of_the_kr6_are_those_of_the_drawing():
    theta = random_angles(robots.kuka_kr6())
    _, t2, t3, _, t5, _ = theta.T
    factors = singularity.factors(robots.kuka_kr6(), theta)
    assert factors["wrist"] == pytest.approx(np.sin(t5))
    assert factors["elbow"] == pytest.approx(0.455 * (0.035 * np.cos(t3) - 0.420 * np.sin(t3)))
    reach = 0.025 + 0.455 * np.cos(t2) + 0.420 * np.cos(t2 + t3) + 0.035 * np.sin(t2 + t3)
    assert factors["shoulder"] == pytest.approx(reach)


def test_joints_that_turn_the_other_way_round():
    """Axis 3, then axis 4 of the UR5, point against axis 2: the same arm with counted-backwards angles."""
    for robot, flipped in (
        (robots.kuka_kr6(), [2]),
        (robots.ur5(), [2]),
        (robots.ur5(), [3]),
        (robots.ur5(), [2, 3]),
    ):
        S = robot.S.copy()
        S[:, flipped] *= -1
        other = Robot.from_screws(S, robot.M)
        theta = random_angles(robot)
        product = math.prod(singularity.factors(other, theta).values())
        assert np.abs(product - np.linalg.det(other.jacobian_space(theta))).max() <= 5e-15


def test_an_arm_without_that_geometry_still_has_a_determinant():
    rng = np.random.default_rng(4)
    robot = Robot.from_axes(rng.normal(size=(6, 3)), rng.normal(size=(6, 3)), np.eye(4))
    theta = random_angles(robot, 20)
    expected = np.linalg.det(robot.jacobian_space(theta))
    assert singularity.determinant(robot, theta) == pytest.approx(expected)


@pytest.mark.parametrize("name", SIX)
def test_golden_singular_poses(golden, name):
    robot = SIX[name]
    cases = [case for case in golden("singular")["cases"] if case["robot"] == name]
    assert len(cases) == 33
    for case in cases:
        q = case["q"]
        assert singularity.determinant(robot, q) == pytest.approx(case["det"], abs=1e-11)
        assert singularity.sigma_min(robot, q) == pytest.approx(case["singular_values"][-1], abs=1e-11)
        assert singularity.rank(robot, q) == case["rank"]
        expected = () if case["kind"] == "regular" else tuple(case["kind"].split("+"))
        assert singularity.classify(robot, q) == expected


def test_golden_configurations_of_the_sources(golden):
    for case in golden("singular")["named"]:
        robot = GOLDEN[case["robot"]]
        assert singularity.rank(robot, case["q"]) == case["rank_tol_1e9"]
        assert singularity.sigma_min(robot, case["q"]) == pytest.approx(
            case["singular_values"][-1], abs=1e-11
        )
        if case["det"] is not None:
            assert singularity.determinant(robot, case["q"]) == pytest.approx(case["det"], abs=1e-11)
            assert bool(singularity.classify(robot, case["q"])) == (case["rank_tol_1e9"] < 6)


@pytest.mark.parametrize("name", SIX)
def test_no_joint_rate_gives_the_lost_motions(golden, name):
    robot = SIX[name]
    for case in golden("singular")["cases"]:
        if case["robot"] != name or case["rank"] == 6:
            continue
        J = robot.jacobian_space(case["q"])
        assert np.abs(J.T @ singularity.lost_motion(robot, case["q"])).max() <= 1e-11
        lost = singularity.lost_motions(robot, case["q"])
        assert lost.shape == (6 - case["rank"], 6)
        assert np.abs(lost @ J).max() <= 1e-11
        assert np.abs(lost @ lost.T - np.eye(len(lost))).max() <= 1e-14


def distance_to_axes(robot, q, wrench):
    """Distances between the line of the wrench and the six axes, as lines in space."""
    J = robot.jacobian_space(q)
    for w, v in zip(J[:3].T, J[3:].T, strict=True):
        on_axis, normal = np.cross(w, v), np.cross(w, wrench.direction)
        apart = on_axis - wrench.point
        if np.linalg.norm(normal) < 1e-9:  # parallel lines meet at infinity
            yield 0.0
        else:
            yield abs(apart @ normal) / np.linalg.norm(normal)


@pytest.mark.parametrize("kind", ["elbow", "shoulder"])
def test_a_lost_force_acts_along_a_line_that_meets_every_axis(golden, kind):
    for case in golden("singular")["cases"]:
        if case["kind"] == kind and case["robot"] != "ur5":  # it has no spherical wrist
            robot = SIX[case["robot"]]
            wrench = singularity.lost_wrench(robot, case["q"])
            assert abs(wrench.pitch) <= 1e-9
            assert max(distance_to_axes(robot, case["q"], wrench)) <= 1e-9


def test_the_lost_wrench_of_a_wrist_has_a_pitch():
    q = [0.3, -0.7, 0.9, 0.5, 0, 0.2]
    wrench = singularity.lost_wrench(robots.kuka_kr6(), q)
    moment = np.cross(wrench.point, wrench.direction) + wrench.pitch * wrench.direction
    lost = np.concatenate([moment, wrench.direction])
    assert np.abs(robots.kuka_kr6().jacobian_space(q).T @ lost).max() <= 1e-12
    assert abs(wrench.pitch) > 0.01
    assert np.linalg.norm(wrench.direction) == pytest.approx(1)


def test_a_lost_moment_has_no_line():
    """Slides take every force; two hinges about y and z leave the moment about x."""
    axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [0, 0, 1], [0, 1, 0]]
    robot = Robot.from_axes(axes, np.zeros((6, 3)), np.eye(4), "PPPPRR")
    wrench = singularity.lost_wrench(robot, np.zeros(6))
    assert np.isinf(wrench.pitch)
    assert np.isnan(wrench.point).all()
    assert np.abs(wrench.direction).round(12).tolist() == [1, 0, 0]


def test_alignment_is_a_shoulder_singularity_with_axis_6_on_axis_1():
    robot = robots.kuka_kr10_report()
    shoulder = [0, -np.pi / 6, -2.2829525304720546, 0, np.pi / 6, 0]  # what the assignment calls alignment
    aligned = [0, -np.pi / 6, -2.2829525304720546, 0, 1.2357549792754567, 0]
    assert singularity.classify(robot, shoulder) == singularity.classify(robot, aligned) == ("shoulder",)
    assert singularity.aligned(robot, [shoulder, aligned]).tolist() == [False, True]


@pytest.mark.parametrize("shape", SHAPES)
def test_shapes(shape):
    robot = robots.kuka_kr6()
    theta = random_angles(robot, math.prod(shape)).reshape(*shape, 6)
    for value in (
        singularity.determinant(robot, theta),
        singularity.sigma_min(robot, theta),
        singularity.rank(robot, theta),
        singularity.aligned(robot, theta),
        singularity.lost_wrench(robot, theta).pitch,
        *singularity.factors(robot, theta).values(),
    ):
        assert np.shape(value) == shape
    assert singularity.lost_motion(robot, theta).shape == (*shape, 6)
    assert singularity.lost_wrench(robot, theta).point.shape == (*shape, 3)


def test_sigma_min_is_zero_where_the_determinant_is():
    """|det J| is the product of the singular values, also for arms whose determinant is made of factors."""
    for robot in SIX.values():
        theta = random_angles(robot, 50)
        assert np.abs(singularity.determinant(robot, theta)) == pytest.approx(
            jacobians.manipulability(robot.jacobian_body(theta)), abs=1e-13
        )


def test_nan_stays_where_it_is():
    robot = robots.kuka_kr6()
    theta = np.full((2, 6), 0.3)
    theta[1] = np.nan
    for value in (
        singularity.determinant(robot, theta),
        singularity.factors(robot, theta)["shoulder"],
        singularity.sigma_min(robot, theta),
        singularity.lost_motion(robot, theta)[:, 0],
    ):
        assert np.isnan(value).tolist() == [False, True]


def other_geometry(change):
    """A KR6 with some axes moved: keyword w or q per joint number."""
    w = np.array([[0, 0, -1], [0, 1, 0], [0, 1, 0], [-1, 0, 0], [0, 1, 0], [-1, 0, 0.0]])
    q = np.array([[0, 0, 0], [0.025, 0, 0.4], [0.48, 0, 0.4], *[[0.9, 0, 0.435]] * 3])
    types = ["revolute"] * 6
    change(w, q, types)
    return Robot.from_axes(w, q, np.eye(4), types, name="changed")


def tilt_axis_3(w, q, types):
    w[2] = [0, 1, 0.1]


def move_axis_6(w, q, types):
    q[5] += [0, 0, 0.05]


def move_axis_4(w, q, types):
    q[3] += [0, 0.05, 0]


def slide_joint_3(w, q, types):
    types[2] = "prismatic"


@pytest.mark.parametrize(
    "change, reason",
    [
        (tilt_axis_3, "axes 2 and 3 are not parallel"),
        (move_axis_6, r"axes 4, 5 and 6 miss a common point by"),
        (
            move_axis_4,
            r"axes 4, 5 and 6 miss a common point by 0\.0.* m \(no spherical wrist\), and axes 2, 3",
        ),
        (slide_joint_3, "its joints are not all hinges"),
    ],
)
def test_factors_name_the_condition_that_fails(change, reason):
    robot = other_geometry(change)
    if change is move_axis_6:  # at zero axis 6 would still meet axis 5 if it moved along it
        robot = other_geometry(lambda w, q, types: (move_axis_6(w, q, types), w.__setitem__(5, [-1, 0.2, 0])))
    with pytest.raises(ValueError, match=f"det J of changed has no factors wrist, elbow, shoulder: {reason}"):
        singularity.factors(robot, np.zeros(6))


@pytest.mark.parametrize("off, same", [(5e-11, True), (5e-10, False)])
def test_factors_and_the_inverse_agree_on_what_a_wrist_is(off, same):
    """One tolerance: axis 6 beside the others is a wrist for both or for neither."""
    robot = other_geometry(lambda w, q, types: q.__setitem__(5, q[5] + [0, off, 0]))
    for judge in (lambda: ik.analytic(robot, robot.M), lambda: singularity.factors(robot, np.zeros(6))):
        if same:
            judge()
        else:
            with pytest.raises(ValueError, match="axes 4, 5 and 6 miss a common point by"):
                judge()


def test_what_is_refused():
    panda, planar, kr6 = robots.franka_panda(), robots.planar_2r(), robots.kuka_kr6()
    with pytest.raises(ValueError, match="Franka Emika Panda has 7 joints: only a 6 x 6 Jacobian"):
        singularity.determinant(panda, np.zeros(7))
    with pytest.raises(ValueError, match=r"det J of Franka Emika Panda .* the arm has 7 joints, not 6"):
        singularity.factors(panda, np.zeros(7))
    with pytest.raises(ValueError, match=r"det J of planar 2R .* the arm has 2 joints, not 6"):
        singularity.classify(planar, np.zeros(2))
    with pytest.raises(ValueError, match="planar 2R has 2 joints and lacks several motions everywhere"):
        singularity.lost_motion(planar, np.zeros(2))
    with pytest.raises(ValueError, match=r"theta must be one configuration \(6,\) here, got \(2, 6\)"):
        singularity.classify(kr6, np.zeros((2, 6)))
    with pytest.raises(ValueError, match="KUKA KR6 R900 sixx has 6 joints: theta must have shape"):
        singularity.factors(kr6, np.zeros(5))
    assert singularity.lost_motions(planar, np.zeros(2)).shape == (4, 6)


def test_the_weakest_motion_of_an_arm_with_few_joints_is_one_it_has():
    scara = robots.all()["scara"]
    theta = np.array([0.3, 1e-4, 0.1, -0.4])  # nearly stretched
    weakest = singularity.weakest_motion(scara, theta)
    J = scara.jacobian_space(theta)
    inside = J @ np.linalg.lstsq(J, weakest, rcond=None)[0]
    np.testing.assert_allclose(inside, weakest, atol=1e-9)
    assert np.linalg.norm(J.T @ weakest) == pytest.approx(np.linalg.svd(J, compute_uv=False)[-1])


def test_the_weakest_motion_of_six_joints_is_the_lost_one():
    kr6, theta = robots.all()["kuka_kr6"], [0.1, -0.9, 1.2, 0.3, 0.4, 0.5]
    np.testing.assert_array_equal(singularity.weakest_motion(kr6, theta), singularity.lost_motion(kr6, theta))
