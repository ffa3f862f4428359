"""The explorer of singularities without a browser: the right numbers, the buttons, the map, no leaks."""

import ipywidgets
import numpy as np
import pytest

from coursekit import Robot, robots, singularity, view
from coursekit.kinematics import axes
from coursekit.view import png
from coursekit.view.explorers import singularities
from tests.kinematics.conftest import GOLDEN_ROBOTS, SIX_HINGES, load

KR6 = robots.kuka_kr6()
SIX = list(SIX_HINGES.values())


@pytest.fixture(scope="module")
def opened():
    panel = view.explore_singularities()
    yield panel
    panel.close()


@pytest.fixture
def panel(opened):
    """The panel as it opens."""
    opened.reset()
    return opened


def press(panel, name):
    """Press a button, and let the page play to the end what that starts."""
    panel._message(panel._controls[name], {"type": "press"}, [])
    panel.viewer.set_state({"frame": panel.viewer.motion["frames"] - 1, "playing": False})


def test_it_opens_regular_with_a_stable_text(panel):
    assert repr(panel) == f"Explorer of singularities: {panel.scene.text()}"
    assert repr(panel).startswith("Explorer of singularities: KUKA KR6 R900 sixx: joints (0.0, -80.0, 110.0")
    assert "rank 6: regular" in panel.line.value
    assert png(panel.scene, 200, 120).startswith(b"\x89PNG")
    assert panel.below[0].svg.startswith("<svg")


def test_the_text_gives_the_golden_numbers():
    robot_of = {name: robots.all()[key] for name, key in GOLDEN_ROBOTS.items()}
    for case in load("singular")["named"]:
        robot = robot_of[case["robot"]]
        if robot.n == 6:
            lines = singularities.words(robot, case["q"]).splitlines()
            assert float(lines[1].split()[3]) == pytest.approx(case["det"], abs=6e-7)
            assert f"rank {case['rank_tol_1e9']}:" in lines[2]
            assert ("regular" in lines[2]) == (case["rank_tol_1e9"] == 6)


@pytest.mark.parametrize(
    ("q", "said"),
    [
        ([0.3, -0.7, 0.08314123188844, 0.5, 0.8, 0.2], "a line that meets all six axes"),
        ([0.3, -2.701, 2.374267308192, 0.5, 0.7, 0.2], "a line that meets all six axes"),
        ([0.3, -0.7, 0.9, 0.5, 0, 0.2], "pitch 0.153 m"),
        ([0.3, -0.7, 0.08314123188844, 0, 0, 0.2], "one of 2 motions that are lost"),
        ([0.3, -2.701, 2.374267308192, 0, np.pi / 2 + 2.701 - 2.374267308192, 0.2], "axes 1 and 6 are one"),
        ([0.3, -0.7, 0.1, 0.5, 0.8, 0.2], "regular; near: elbow"),
    ],
)
def test_what_is_lost_is_named(q, said):
    assert said in singularities.words(KR6, np.array(q))


@pytest.mark.parametrize("name", singularity.NAMES)
@pytest.mark.parametrize("key", SIX)
def test_the_nearest_singularity(key, name):
    """By one joint, inside the limits, and no zero of the factor is nearer along any single joint."""
    robot = robots.all()[key]
    rng = np.random.default_rng(3)
    for _ in range(10):
        theta = rng.uniform(np.maximum(robot.q_min, -3), np.minimum(robot.q_max, 3))
        end = singularities.nearest(robot, theta, name)
        moved = np.flatnonzero(end != theta)
        assert len(moved) == 1 and bool(robot.within_limits(end))
        assert abs(singularity.factors(robot, end)[name]) < 1e-12
        way = 0.999 * np.abs(end - theta).max() * np.linspace(-1, 1, 201)
        for joint in range(6):
            turned = np.tile(theta, (201, 1))
            turned[:, joint] = np.clip(turned[:, joint] + way, robot.q_min[joint], robot.q_max[joint])
            values = singularity.factors(robot, turned)[name]
            assert np.all(values > 0) or np.all(values < 0)


@pytest.mark.parametrize("name", singularity.NAMES)
def test_a_button_drives_there_and_the_line_appears(panel, name):
    press(panel, f"to_{name}")
    theta = panel.values["theta"]
    assert singularity.classify(KR6, theta) == (name,)
    assert f"rank 5: {name} singularity" in panel.line.value
    assert panel.viewer.motion["frames"] == 31
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, theta)
    assert bool(panel.scene.parts["/ck/meets_all"]) == (name != "wrist")


def test_the_line_meets_every_axis_and_can_be_hidden(panel):
    press(panel, "to_shoulder")
    part = panel.scene.parts["/ck/meets_all"][0]
    point, direction = part.T[:3, 3], part.T[:3, 2]
    J = KR6.jacobian_space(panel.values["theta"])
    assert np.abs(direction @ J[3:] + np.cross(point, direction) @ J[:3]).max() < 1e-12
    panel.set(line=False, lost=False)
    assert not panel.scene.parts["/ck/meets_all"] and not panel.scene.parts["/ck/lost/force"]


def test_the_joint_axes_are_numbered_as_long_as_they_are_shown(panel):
    def numbers():
        return [label["text"] for label in panel.scene.labels if label["path"].endswith("/line/number")]

    assert numbers() == ["1", "2", "3", "4", "5", "6"]
    panel.set(axes=False)
    assert numbers() == []


def test_a_click_on_the_map_sets_two_joints(panel):
    before = panel.values["theta"]
    panel.below[0].on_click(-60.0, 30.0)
    np.testing.assert_allclose(np.degrees(panel.values["theta"][1:3]), [-60, 30], atol=1e-12)
    np.testing.assert_array_equal(np.delete(panel.values["theta"], [1, 2]), np.delete(before, [1, 2]))
    panel.set(across="θ5", up="θ5")
    assert panel.values["across"] != panel.values["up"]
    panel.below[0].on_click(15.0, 20.0)
    assert np.degrees(panel.values["theta"][4]) == pytest.approx(15)


def test_another_robot_starts_regular(panel):
    for key in ("kawasaki_s030", "ur5"):
        robot = robots.all()[key]
        panel.set(robot=robot.name)
        assert panel.values["robot"] is robot or panel.values["robot"].name == robot.name
        assert "rank 6: regular" in panel.line.value
        assert bool(robot.within_limits(panel.values["theta"]))


def test_one_robot_only():
    panel = view.explore_singularities(robots.ur5())
    assert "robot" not in panel.values
    panel.close()


def test_an_arm_whose_det_J_does_not_split_says_why():
    w, q = axes.directions_of(KR6.S), axes.points_on(KR6.S)
    w[2] = [0, 0.6, 0.8]
    askew = Robot.from_axes(w, q, KR6.M, name="askew")
    theta = np.array([0.1, -0.7, 0.9, 0.5, 0.8, 0.2])
    det = np.linalg.det(askew.jacobian_space(theta))
    said = singularities.words(askew, theta)
    reason = "axes 2 and 3 are not parallel"
    assert f"det J = {det:.6f}, not a product of wrist, elbow and shoulder: {reason}" in said
    assert "rank 6: regular" in said and said.splitlines()[-1].endswith("at the tool")


@pytest.mark.parametrize(
    ("name", "theta"),
    [
        ("franka_panda", np.zeros(7)),
        ("stanford", [0, np.pi / 2, 0.3, 0, 0, 0]),
    ],
)
def test_other_arms_lose_motions_too(name, theta):
    robot = robots.all()[name]
    rank = int(singularity.rank(robot, theta))
    assert rank < 6
    assert f"rank {rank}: singular" in singularities.words(robot, theta)


def test_the_tool_point_of_a_stretched_planar_arm():
    said = singularities.words(robots.planar_2r(), [0.3, 0.0])
    assert "2 joints: 4 of 6 motions are lost everywhere" in said
    assert said.endswith("rank 1 of 2, singular")


def test_the_weakest_pose_by_one_joint_is_no_worse_than_any_other():
    stanford = robots.stanford()
    theta = np.array([0.2, 0.9, 0.5, 0.3, 0.7, 0.1])
    end = singularities.weakest(stanford, theta)
    assert (end != theta).sum() == 1 and stanford.within_limits(end)
    low, high = singularities.ends_of(stanford)
    for joint in range(6):
        turned = np.tile(theta, (500, 1))
        turned[:, joint] = np.linspace(low[joint], high[joint], 500)
        others = singularity.sigma_min(stanford, turned)
        assert singularity.sigma_min(stanford, end) < 1.02 * others.min() + 1e-6


def test_an_arm_without_factors_is_not_offered(monkeypatch):
    S = KR6.S.copy()
    S[:3, 2] = [0, 0.6, 0.8]  # axes 2 and 3 are no longer parallel
    other = Robot.from_screws(S, KR6.M, name="other")
    monkeypatch.setattr(robots, "all", lambda: {"other": other, "kuka_kr6": KR6})
    panel = view.explore_singularities()
    assert panel.scene.text().startswith(KR6.name)
    panel.close()


def test_opening_it_again_leaks_nothing():
    view.explore_singularities(KR6).close()
    before = len(ipywidgets.widgets.widget._instances)
    for _ in range(3):
        panel = view.explore_singularities(KR6)
    assert panel.values["theta"].shape == (6,)
    panel.close()
    assert len(ipywidgets.widgets.widget._instances) == before
