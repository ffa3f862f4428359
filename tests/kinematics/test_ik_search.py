"""Solutions from random starts: how many of the golden ones are met, and what is said of them."""

import numpy as np
import pytest

from coursekit import Robot, ik, robots
from tests.kinematics.conftest import SIX_HINGES, load

ALL = robots.all()


def turned_apart(a, b):
    """Largest difference of two configurations, round the circle."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi).max(axis=-1)


def residual(robot, found, T):
    return np.abs(robot.fk(found.theta) - T).max(initial=0)


@pytest.mark.parametrize("full_name", SIX_HINGES)
def test_recall_of_the_golden_solutions(full_name):
    """Every start is random, every solution counts: 100 tries met all of them, 50 missed 1 of 1300."""
    robot, met, wanted = ALL[SIX_HINGES[full_name]], 0, 0
    for case in load(f"ik_{full_name}")["cases"]:
        found = ik.search(robot, case["T"], tries=100)
        assert residual(robot, found, case["T"]) < 1e-9
        assert len(found.theta) <= case["n"]  # none is invented
        for solution in case["solutions"]:
            wanted += 1
            met += bool(np.any(turned_apart(found.theta, np.array(solution)) < 1e-6))
        assert found.hits.sum() <= found.tries == 100
    assert wanted > 150 and met >= 0.99 * wanted


def test_recall_of_the_planar_arm():
    robot, met, wanted = ALL["planar_2r"], 0, 0
    for case in load("ik_planar_2r")["cases"]:
        T = np.eye(4)
        T[:2, 3] = case["p"]
        found = ik.search(robot, T, tries=40, rows="linear")
        assert len(found.theta) <= max(case["n"], 0)
        wanted += case["n"]
        met += sum(bool(np.any(turned_apart(found.theta, np.array(s)) < 1e-6)) for s in case["solutions"])
    assert met == wanted > 20


def test_a_scara_reaches_a_pose_in_two_ways():
    robot = ALL["scara"]
    found = ik.search(robot, robot.fk([0.3, 0.8, 0.1, -0.4]))
    assert found.theta[:, 1].round(9).tolist() == [0.8, -0.8] or found.theta[:, 1].round(9).tolist() == [
        -0.8,
        0.8,
    ]
    assert np.abs(found.theta[:, 2] - 0.1).max() < 1e-9 and found.isolated.all()
    assert found.text.startswith("at least 2 found; ")


def test_the_stanford_arm_reaches_a_pose_with_its_wrist_either_way():
    """Joints 4 to 6 turned by (pi, -q_5, pi) make the same rotation: solutions come in pairs."""
    robot, rng = ALL["stanford"], np.random.default_rng(0)
    for _ in range(5):
        theta = rng.uniform(robot.q_min, robot.q_max)
        found = ik.search(robot, robot.fk(theta))
        assert residual(robot, found, robot.fk(theta)) < 1e-9
        assert turned_apart(found.theta, theta).min() < 1e-6
        for solution in found.theta:
            other = solution * [1, 1, 1, 1, -1, 1] + [0, 0, 0, np.pi, 0, np.pi]
            assert turned_apart(found.theta, other).min() < 1e-6


@pytest.mark.parametrize("draw", range(5))
def test_any_six_hinges(draw):
    """No closed form, at most 16 solutions (Raghavan and Roth, 1990), an even number of them."""
    rng = np.random.default_rng(draw)
    robot = Robot.from_axes(rng.normal(size=(6, 3)), rng.uniform(-0.5, 0.5, (6, 3)), np.eye(4))
    theta = rng.uniform(-3, 3, 6)
    found = ik.search(robot, robot.fk(theta), tries=400)
    assert turned_apart(found.theta, theta).min() < 1e-6
    assert residual(robot, found, robot.fk(theta)) < 1e-9
    assert len(found.theta) <= 16 and len(found.theta) % 2 == 0
    apart = turned_apart(found.theta[:, None], found.theta[None]) + 9 * np.eye(len(found.theta))
    assert apart.min() > 1e-3


def test_a_redundant_arm_has_endlessly_many():
    robot = ALL["franka_panda"]
    found = ik.search(robot, robot.fk(robot.home), tries=30)
    assert len(found.theta) > 10 and not found.isolated.any()
    assert found.text.startswith(f"endlessly many, {len(found.theta)} found")


def test_a_stretched_wrist_leaves_a_family_beside_single_solutions():
    robot = ALL["kuka_kr6"]
    found = ik.search(robot, robot.fk([0.3, -1, 0.5, 0.7, 0, 0.4]), tries=100)
    assert not found.isolated.all()
    assert "endlessly many" in found.text


def test_out_of_reach_and_not_a_number():
    robot = ALL["kuka_kr6"]
    far = robot.M.copy()
    far[0, 3] = 9
    for T in (far, np.full((4, 4), np.nan)):
        found = ik.search(robot, T, tries=20)
        assert found.theta.shape == (0, 6) and found.within_limits.shape == (0,)
        assert found.text == "none found from 20 random starts"


def test_it_is_reproducible_and_sorted():
    robot = ALL["ur5"]
    T = robot.fk([0.3, -1, 0.6, 0.4, 0.9, 0.2])
    first, again = (ik.search(robot, T, tries=100).theta for _ in range(2))
    assert np.array_equal(first, again)
    other = ik.search(robot, T, tries=100, rng=np.random.default_rng(5)).theta
    assert np.abs(first - other).max() < 1e-6  # the same solutions in the same order
    assert (np.diff(first[:, 0]) >= -1e-6).all()
    assert first.min() > -np.pi and first.max() <= np.pi


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda r: ik.search(r, np.diag([1, 1, -1, 1])), r"KUKA KR6 R900 sixx: T is not in SE\(3\)"),
        (lambda r: ik.search(r, r.M[None]), r"search takes one pose \(4, 4\), got \(1, 4, 4\)"),
        (lambda r: ik.search(r, r.M, tries=1.5), "tries must be 0 or a positive whole number, got 1.5"),
        (lambda r: ik.search(r, r.M, rows="all of them"), 'rows must be "all" or "linear"'),
        (lambda r: ik.search(r, r.M, tol=0), "tol must be positive, got 0"),
    ],
)
def test_errors_say_what_is_valid(call, message):
    with pytest.raises(ValueError, match=message):
        call(ALL["kuka_kr6"])


def test_given_starts_are_tried_and_do_not_count_as_chance():
    kr6 = ALL["kuka_kr6"]
    q = np.array([0.4, -1.1, 0.9, 0.6, 0.8, -0.3])
    found = ik.search(kr6, kr6.fk(q), tries=1, starts=[q + 1e-3], rng=np.random.default_rng(5))
    assert np.abs(found.theta - q).max(axis=1).min() < 1e-9
    assert found.hits.sum() <= found.tries == 1
    with pytest.raises(ValueError, match="has 6 joints: theta must have shape"):
        ik.search(kr6, kr6.M, starts=[0, 0])


def test_why_an_arm_has_no_closed_form():
    with pytest.raises(ik.NoClosedForm, match="no analytic inverse kinematics: it has 7 joints") as caught:
        ik.analytic(ALL["franka_panda"], np.eye(4))
    assert caught.value.condition == "it has 7 joints: redundant, so a pose leaves 1 of them free"


def test_limits_of_a_slide_are_told_in_millimetres():
    assert ik.why_outside(ALL["scara"], [0, 0, 0.1, 0]) == ""
    scara = ALL["scara"]
    low, high = np.degrees([scara.q_min[1], scara.q_max[1]])
    assert ik.why_outside(scara, [0, 3.0, 0.5, 0]) == (
        f"joint 2 would need 171.9 deg; limits {low:.1f} to {high:.1f} deg; "
        "joint 3 would need 500.0 mm; limits 0.0 to 210.0 mm"
    )
