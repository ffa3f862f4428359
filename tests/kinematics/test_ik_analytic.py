"""Analytic inverse kinematics: as many solutions as other programs find, the same ones, and no others."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coursekit import Robot, ik, lie, robots

from .conftest import SIX_HINGES as SIX
from .conftest import load

ALL = robots.all()
RNG = np.random.default_rng(7)

elsewhere = lie.exp6([0.3, -0.8, 1.1, 0.5, -0.2, 0.9])
tool = lie.exp6([-1.2, 0.4, 0.7, 0.05, 0.11, -0.07])
VARIANTS = {
    "as it is": lambda robot: robot,
    "tool": lambda robot: robot.with_tool(tool),
    "base": lambda robot: robot.with_base(elsewhere),
    "both": lambda robot: robot.with_base(elsewhere).with_tool(tool),
}


def turned_apart(a, b):
    """Largest difference of two configurations, round the circle."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi).max(axis=-1)


def residual(solutions):
    """|FK(theta) - T| of the solutions that exist."""
    error = np.abs(solutions.robot.fk(solutions.theta) - solutions.T[..., None, :, :]).max(axis=(-2, -1))
    return error[solutions.exists].max(initial=0)


@pytest.mark.parametrize("full_name", SIX)
def test_golden_solutions_all_and_no_others(full_name):
    robot, cases = ALL[SIX[full_name]], load(f"ik_{full_name}")["cases"]
    solutions = ik.analytic(robot, [case["T"] for case in cases])
    assert solutions.theta.shape == (len(cases), 8, 6)
    assert residual(solutions) < 1e-11  # the poses of the file are rounded to 12 decimals
    for i, case in enumerate(cases):
        found = solutions.theta[i, solutions.exists[i]]
        assert len(found) == case["n"]
        inside = solutions.within_limits[i, solutions.exists[i]]
        for wanted, within in zip(case["solutions"], case.get("within_limits", []), strict=True):
            distance = turned_apart(found, np.array(wanted))
            assert distance.min() < 1e-8
            assert inside[distance.argmin()] == within
        assert all(solutions.reasons(i)[k] for k in np.flatnonzero(~solutions.exists[i]))


def test_golden_planar_arm():
    cases = load("ik_planar_2r")["cases"]
    T = np.tile(np.eye(4), (len(cases), 1, 1))
    T[:, :2, 3] = [case["p"] for case in cases]
    solutions = ik.analytic(ALL["planar_2r"], T)
    for i, case in enumerate(cases):
        found = solutions.theta[i, solutions.exists[i]]
        assert len(found) == case["n"]
        for wanted in case["solutions"]:
            assert turned_apart(found, np.array(wanted)).min() < 1e-9


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", SIX.values())
def test_round_trip_and_residual(name, variant):
    robot = VARIANTS[variant](ALL[name])
    theta = RNG.uniform(-np.pi, np.pi, (500, 6))
    solutions = ik.analytic(robot, robot.fk(theta))
    assert residual(solutions) < 1e-12
    assert np.nanmax(np.abs(solutions.theta)) <= np.pi
    assert np.nanmin(solutions.theta) > -np.pi
    assert np.all(np.nanmin(turned_apart(solutions.theta, theta[:, None]), axis=1) < 1e-6)


@given(st.tuples(*[st.floats(-3.14, 3.14)] * 6), st.sampled_from(sorted(SIX.values())))
@settings(max_examples=200)
def test_any_configuration_is_reached_again(theta, name):
    robot = ALL[name]
    solutions = ik.analytic(robot, robot.fk(theta))
    assert solutions.exists.any()
    assert residual(solutions) < 1e-9


@pytest.mark.parametrize("t5", [-5.960464477539063e-08, 3e-8, 1e-7, 1e-6, 1e-5])
def test_a_stretched_arm_is_reached_where_the_hand_is_nearly_stretched_too(t5):
    """Three parallel axes: the turn about them has lost digits, by which the arm may seem too short."""
    ur5, turns = ALL["ur5"], np.linspace(-3, 3, 200)
    for theta3 in (0.0, np.pi - 1e-9):
        theta = np.zeros((len(turns), 6))
        theta[:, 2], theta[:, 3], theta[:, 4] = theta3, turns, t5
        solutions = ik.analytic(ur5, ur5.fk(theta))
        assert solutions.exists.any(axis=-1).all()
        assert residual(solutions) < 1e-9


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
@pytest.mark.parametrize("name, k, n", [("kuka_kr6", 8, 6), ("ur5", 8, 6), ("planar_2r", 2, 2)])
def test_shapes(name, k, n, shape):
    robot = ALL[name]
    theta = RNG.uniform(-1, 1, (*shape, n))
    solutions = ik.analytic(robot, robot.fk(theta))
    assert solutions.theta.shape == (*shape, k, n)
    assert np.array_equal(np.isnan(solutions.theta).any(axis=-1), np.isnan(solutions.theta).all(axis=-1))
    assert solutions.exists.shape == solutions.within_limits.shape == (*shape, k)
    assert len(solutions.branches) == len(set(solutions.branches)) == k
    assert len(solutions.reasons(tuple(0 for _ in shape))) == k
    alone = ik.analytic(robot, robot.fk(theta.reshape(-1, n)[0])).theta
    assert np.allclose(alone, solutions.theta.reshape(-1, k, n)[0], atol=1e-15, equal_nan=True)


def test_more_poses_than_one_block():
    robot = ALL["kuka_kr6"]
    T = robot.fk(RNG.uniform(-2, 2, (2500, 6)))
    assert np.allclose(ik.analytic(robot, T).theta[2400], ik.analytic(robot, T[2400]).theta, atol=1e-14)


def test_table_4_1_of_the_kuka_report():
    robot, numbers = ALL["kuka_kr6"], load("numbers_of_the_sources")["TPK4170 report"]
    solutions = ik.analytic(robot, robot.fk([2, -1, -1, 2.5, 0.6, 0]))
    wanted = np.array(numbers["all_8_solutions"])
    assert solutions.exists.all()
    assert np.all(turned_apart(solutions.theta[:, None], wanted).min(axis=0) < 1e-9)
    rows = numbers["table4_1_rows"]
    names = {word: solutions.branches[solutions.nearest(row)] for word, row in rows.items()}
    assert names == {
        "Elbow up": "front elbow-up no-flip",
        "Elbow down": "front elbow-down no-flip",
        "Numerical A": "front elbow-down flip",
        "Numerical B": "back elbow-down no-flip",
    }


def test_four_solutions_of_the_kawasaki_exam_are_all_feasible():
    robot, numbers = ALL["kawasaki_s030"], load("numbers_of_the_sources")["S030 exam"]
    found = ik.first_joints(robot, numbers["p_n"])
    wanted = np.array([numbers["ik"][key] for key in ("f_plus", "f_minus", "b_minus", "b_plus")])
    assert np.allclose(turned_apart(found, wanted), 0, atol=1e-9)
    with_wrist = np.concatenate([found, np.tile(robot.home[3:], (4, 1))], axis=1)
    assert robot.within_limits(with_wrist).all()
    assert np.allclose(ik.wrist_centre(robot, robot.fk(with_wrist)), numbers["p_n"], atol=1e-12)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_arm_is_what_analytic_uses(shape):
    robot = ALL["kuka_kr6"]
    T = robot.fk(RNG.uniform(-2, 2, (*shape, 6)))
    first = ik.first_joints(robot, ik.wrist_centre(robot, T))
    assert first.shape == (*shape, 4, 3)
    whole = ik.analytic(robot, T).theta.reshape(*shape, 4, 2, 6)[..., :3]
    assert np.allclose(first[..., None, :], whole, atol=1e-12, equal_nan=True)


# -- what the names mean -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SIX.values())
def test_front_is_where_the_arm_reaches_at_zero(name):
    robot = ALL[name]
    theta = RNG.uniform(-0.3, 0.3, (50, 6))
    theta[:, 1:3] *= 0.1
    nearest = ik.analytic(robot, robot.fk(theta)).nearest(theta)
    assert all(ik.analytic(robot, robot.M).branches[k].startswith("front") for k in nearest)


@pytest.mark.parametrize(
    "name", ["kuka_kr6", "abb_irb1200", "kuka_kr10", "kuka_kr10_report", "kawasaki_s030", "puma560"]
)
def test_elbow_up_is_above_the_line_from_shoulder_to_wrist(name):
    robot = ALL[name]
    solutions = ik.analytic(robot, robot.fk(RNG.uniform(-2, 2, (100, 6))))
    frames = robot.link_frames(solutions.theta)
    side = frames[..., 1, :3, 2]  # the direction of axis 2: forward is across it, and horizontal

    def in_plane(x):
        return x[..., 0] * side[..., 1] - x[..., 1] * side[..., 0], x[..., 2]

    (shoulder, shoulder_z), (elbow, elbow_z) = (
        in_plane(frames[..., 1, :3, 3]),
        in_plane(frames[..., 2, :3, 3]),
    )
    wrist, wrist_z = in_plane(np.broadcast_to(ik.wrist_centre(robot, solutions.T)[:, None], side.shape))
    line_z = shoulder_z + (elbow - shoulder) / (wrist - shoulder) * (wrist_z - shoulder_z)
    plain = solutions.exists & (
        (wrist - shoulder) * wrist > 0
    )  # past the shoulder, not leaning back behind it
    up = np.array(["elbow-up" in branch for branch in solutions.branches])
    assert plain.sum() > 200
    assert np.array_equal((elbow_z > line_z)[plain], np.broadcast_to(up, plain.shape)[plain])


@pytest.mark.parametrize("name", ["kuka_kr6", "abb_irb1200", "kuka_kr10", "kuka_kr10_report", "puma560"])
def test_no_flip_is_a_positive_joint_5(name):
    robot = ALL[name]
    solutions = ik.analytic(robot, robot.fk(RNG.uniform(-2, 2, (100, 6))))
    no_flip = np.array(["no-flip" in branch for branch in solutions.branches])
    positive = solutions.theta[..., 4] > 0
    assert np.array_equal(
        positive[solutions.exists], np.broadcast_to(no_flip, positive.shape)[solutions.exists]
    )


# -- singular and boundary poses ----------------------------------------------------------------------------


@pytest.mark.parametrize("full_name", SIX)
def test_golden_singular_poses(full_name):
    cases = [case for case in load("singular")["cases"] if case["robot"] == full_name]
    robot = ALL[SIX[full_name]]
    solutions = ik.analytic(robot, robot.fk([case["q"] for case in cases]))
    assert len(cases) > 5
    assert solutions.exists.any(axis=-1).all()
    assert residual(solutions) < 1e-9


def test_wrist_stretched_out_leaves_all_to_joint_6():
    robot = ALL["kuka_kr6"]
    solutions = ik.analytic(robot, robot.fk([0.3, -1, 0.5, 0.7, 0, 0.4]))
    k = solutions.branches.index("front elbow-up no-flip")
    k = k if abs(solutions.theta[k, 4]) < 1e-9 else solutions.branches.index("front elbow-down no-flip")
    assert np.allclose(solutions.theta[k], [0.3, -1, 0.5, 0, 0, 1.1], atol=1e-9)


def test_wrist_on_axis_1_takes_theta_1_zero():
    robot = ALL["abb_irb1200"]
    p = np.array([0, 0, 0.3991 + 0.6])
    first = ik.first_joints(robot, p)
    assert np.isfinite(first).all()
    assert np.array_equal(first[:, 0], np.zeros(4))
    whole = np.concatenate([first, np.zeros((4, 3))], axis=1)
    assert np.allclose(ik.wrist_centre(robot, robot.fk(whole)), p, atol=1e-12)


# theta_3 that stretches the arm out, read off its drawing
STRETCHED = {
    "kuka_kr6": np.arctan2(35, 420),
    "kuka_kr10": np.arctan2(25, 515),
    "kuka_kr10_report": 0.0,
    "abb_irb1200": -np.arctan2(451, 42),
    "kawasaki_s030": np.pi / 2,
    "puma560": np.arctan2(-431.8, 20.3),
    "ur5": 0.0,
}


@pytest.mark.parametrize("name", STRETCHED)
def test_end_of_the_reach_has_its_double_solution(name):
    robot = ALL[name]
    theta = np.array([0.4, -0.7, STRETCHED[name], 0.9, 1.2, -0.3])
    T = robot.fk(theta)
    solutions = ik.analytic(robot, T)
    near = turned_apart(solutions.theta, theta) < 1e-6
    assert near.sum() == 2
    assert residual(solutions) < 1e-9
    up, down = solutions.theta[near]
    assert np.allclose(up, down, atol=1e-6)


@pytest.mark.parametrize("beyond", [1e-9, 1e-6, 0.1])
def test_further_out_there_is_none(beyond):
    robot = ALL["abb_irb1200"]
    reach = 0.448 + np.hypot(0.451, 0.042)
    assert np.isfinite(ik.first_joints(robot, [reach, 0, 0.3991])[:2]).all()
    assert np.isnan(ik.first_joints(robot, [reach + beyond, 0, 0.3991])).all()


def test_three_parallel_axes_with_the_hand_stretched_out():
    robot = ALL["ur5"]
    theta = RNG.uniform(-np.pi, np.pi, (300, 6))
    theta[:, 4] = np.where(theta[:, 4] > 0, 0, np.pi)  # axis 6 parallel to axes 2, 3, 4: one joint is free
    solutions = ik.analytic(robot, robot.fk(theta))
    assert solutions.exists.any(axis=-1).all()
    assert residual(solutions) < 1e-9


# -- reasons -------------------------------------------------------------------------------------------------


def test_reasons_out_of_reach():
    robot = ALL["abb_irb1200"]
    T = robot.M.copy()
    T[:3, 3] = [1.123 + 0.082, 0, 0.3991]
    text = f"wrist centre is {1.123 - 0.448 - np.hypot(0.451, 0.042):.3f} m beyond reach"
    assert ik.analytic(robot, T).reasons() == (text,) * 8
    T[:3, 3] = [0.082 + 0.001, 0, 0.3991]
    assert ik.analytic(robot, T).reasons() == ("wrist centre is 0.004 m too near axis 2",) * 8


def test_reasons_too_near_axis_1():
    robot = ALL["puma560"]
    T = robot.M.copy()
    T[:3, 3] = [0.05, 0, 0.9]
    text = "wrist centre is 0.050 m from axis 1 and cannot come nearer than 0.150 m"
    assert ik.analytic(robot, T).reasons() == (text,) * 8


@pytest.mark.parametrize("name", ["kuka_kr6", "puma560"])
def test_a_joint_at_its_limit_is_inside(name):
    robot, rng = ALL[name], np.random.default_rng(0)
    theta = rng.uniform(robot.q_min, robot.q_max, (200, 6))
    rows, joint = np.arange(200), rng.integers(0, 6, 200)
    theta[rows, joint] = np.where(rng.random(200) < 0.5, robot.q_min[joint], robot.q_max[joint])
    solutions = ik.analytic(robot, robot.fk(theta))
    k = solutions.nearest(theta)
    assert turned_apart(solutions.theta[rows, k], theta).max() < 1e-9
    assert solutions.within_limits[rows, k].all()
    assert all(solutions.reasons(i)[k[i]] == "" for i in range(200))


def test_reasons_of_limits():
    robot = ALL["kuka_kr6"]
    solutions = ik.analytic(robot, robot.fk(robot.home))
    reasons = dict(zip(solutions.branches, solutions.reasons(), strict=True))
    assert reasons["front elbow-up no-flip"] == ""
    assert reasons["back elbow-up no-flip"] == "joint 1 would need 180.0 deg; limits -170.0 to 170.0 deg"
    assert np.array_equal([reason == "" for reason in solutions.reasons()], solutions.within_limits)


def test_reasons_of_three_parallel_axes():
    robot = ALL["ur5"]
    solutions = ik.analytic(robot, robot.fk(np.zeros(6)))
    missing = np.flatnonzero(~solutions.exists)
    assert len(missing) == 2
    assert all(solutions.reasons()[k].startswith("axis 4 is 0.0") for k in missing)
    assert all(solutions.reasons()[k].endswith("m beyond reach") for k in missing)


def test_reasons_of_the_planar_arm():
    robot = ALL["planar_2r"]
    T = np.eye(4)
    for p, reason in [
        ((1, 0, 0), "tool point is 0.250 m beyond reach"),
        ((0.1, 0, 0), "tool point is 0.150 m too near axis 1"),
        ((0.5, 0, 0.02), "the tool point would be 0.02 m off the plane of the arm"),
    ]:
        T[:3, 3] = p
        solutions = ik.analytic(robot, T)
        assert not solutions.exists.any()
        assert solutions.reasons() == (reason, reason)


def test_reasons_need_the_index_of_one_pose():
    robot = ALL["kuka_kr6"]
    solutions = ik.analytic(robot, np.tile(robot.M, (3, 2, 1, 1)))
    assert solutions.reasons((2, 1)) == ik.analytic(robot, robot.M).reasons()
    with pytest.raises(
        ValueError, match=r"reasons needs the index of one pose: 2 numbers for a batch \(3, 2\), got \(1,\)"
    ):
        solutions.reasons(1)


# -- what else a solution says ------------------------------------------------------------------------------


def test_nearest_is_the_root_of_the_sum_of_squares():
    """By the sum of the differences another solution would be the nearest."""
    robot = robots.planar_2r()
    solutions = ik.analytic(robot, robot.fk([0.0, 1.0]))  # and (0.64, -1)
    away = np.abs(solutions.theta - [0.0, -0.2])
    assert away.sum(axis=1).tolist() == pytest.approx([1.43974582, 1.2])
    assert solutions.nearest([0.0, -0.2]) == 0


def test_nearest_and_turned():
    robot = ALL["kawasaki_s030"]
    solutions = ik.analytic(robot, robot.fk(robot.home + 0.1))
    k = solutions.nearest(robot.home + 0.1)
    assert turned_apart(solutions.theta[k], robot.home + 0.1) < 1e-9
    assert (
        solutions.theta[k, 4] < -3 and abs(solutions.turned[k, 4] - robot.home[4] - 0.1) < 1e-9
    )  # 35 to 325 deg
    far = robot.M.copy()
    far[0, 3] = 10
    assert ik.analytic(robot, far).nearest(robot.home) == -1
    with pytest.raises(ValueError, match="Kawasaki S030 has 6 joints"):
        solutions.nearest([0, 0])


def test_nan_in_nan_out():
    for name in ("kuka_kr6", "ur5", "planar_2r"):
        robot = ALL[name]
        T = np.stack([robot.M, np.full((4, 4), np.nan)])
        solutions = ik.analytic(robot, T)
        assert solutions.exists[0].any()
        assert np.isnan(solutions.theta[1]).all() and not solutions.exists[1].any()
        assert solutions.reasons(1) == ("the pose holds NaN",) * len(solutions.branches)
    assert np.isnan(ik.first_joints(ALL["kuka_kr6"], [np.nan, 0, 0])).all()


# -- what is refused -----------------------------------------------------------------------------------------


def changed(name, joint, w=None, q=None):
    """The robot with the axis of one joint (from 1) moved."""
    S = ALL[name].S.copy()
    w = S[:3, joint - 1] if w is None else np.array(w) / np.linalg.norm(w)
    q = np.cross(S[:3, joint - 1], S[3:, joint - 1]) if q is None else q
    S[:, joint - 1] = [*w, *-np.cross(w, q)]
    return Robot.from_screws(S, ALL[name].M, name="other")


@pytest.mark.parametrize(
    "robot, message",
    [
        (
            ALL["franka_panda"],
            "Franka Emika Panda: no analytic inverse kinematics: it has 7 joints: redundant",
        ),
        (Robot.from_screws(ALL["kuka_kr6"].S[:, :3], np.eye(4)), r"it has 3 joints, not 6 \(or 2, planar\)"),
        (
            Robot.from_screws([[0], [0], [0], [0], [0], [1]], np.eye(4)),
            "joint 1 is prismatic, and only hinges are covered",
        ),
        (
            Robot.from_screws([[0, 0], [0, 0], [1, 1], [0, 0], [0, 0], [0, 0.1]], np.eye(4)),
            "joint 2 is a screw with",
        ),
        (changed("kuka_kr6", 3, w=[0.1, 1, 0]), r"axes 2 and 3 are not parallel \(5\.71 deg apart\)"),
        (
            changed("kuka_kr6", 1, w=[0, 0.1, 1]),
            r"axes 1 and 2 are not perpendicular \(84\.2894 deg between them\)",
        ),
        (
            changed("kuka_kr6", 6, q=[0, 0, 0.5]),
            r"axes 4, 5 and 6 miss a common point by .* m \(no spherical wrist\)",
        ),
        (changed("ur5", 6, q=[-0.9, 0, -0.005]), "axes 5 and 6 do not meet: they miss a common point by"),
        (changed("kuka_kr6", 6, w=[1, 0.1, 0], q=[0.9, 0, 0.435]), "axes 5 and 6 are not perpendicular"),
        (changed("kuka_kr6", 5, w=[0.1, 1, 0], q=[0.9, 0, 0.435]), "axes 4 and 5 are not perpendicular"),
        (changed("kuka_kr6", 3, q=[0.025, 0, 0.4]), "axes 2 and 3 coincide"),
        (changed("kuka_kr6", 3, q=[0.9, 0, 0.435]), "the wrist centre lies on axis 3"),
        (changed("ur5", 4, q=[-0.425, 0, 0.089459]), "axes 3 and 4 coincide"),
        (changed("planar_2r", 2, w=[0, 1, 0]), "axes 1 and 2 are not parallel"),
        (changed("planar_2r", 2, q=[0, 0, 0]), "axes 1 and 2 coincide"),
        (changed("planar_2r", 2, q=[0.75, 0, 0]), "the tool point lies on axis 2"),
    ],
)
def test_arms_that_are_not_covered(robot, message):
    with pytest.raises(ValueError, match=message):
        ik.analytic(robot, np.eye(4))


def test_first_joints_and_wrist_centre_need_a_spherical_wrist():
    for name in ("ur5", "planar_2r"):
        with pytest.raises(
            ValueError, match="first_joints needs a spherical wrist: axes 4, 5 and 6 through one point"
        ):
            ik.first_joints(ALL[name], [0, 0, 0])
        with pytest.raises(ValueError, match="wrist_centre needs a spherical wrist"):
            ik.wrist_centre(ALL[name], np.eye(4))


def test_what_is_no_pose():
    with pytest.raises(ValueError, match=r"KUKA KR6 R900 sixx: T is not in SE\(3\): det R = -1"):
        ik.analytic(ALL["kuka_kr6"], np.diag([1, 1, -1, 1]))
    with pytest.raises(ValueError, match=r"KUKA KR6 R900 sixx: p must have shape \(\.\.\., 3\), got \(2,\)"):
        ik.first_joints(ALL["kuka_kr6"], [0, 0])
