"""The explorer of inverse kinematics without a browser."""

import ipywidgets
import numpy as np
import pytest

from coursekit import ik, robots, rotations, view


@pytest.fixture
def panel():
    """At the pose of table 4.1 of the report, and the configuration given there."""
    kr6 = robots.kuka_kr6()
    panel = view.explore_inverse(target=kr6.fk([2, -1, -1, 2.5, 0.6, 0]))
    panel.set(solution=2)
    yield panel
    panel.close()


def pose_values(T):
    return np.concatenate([T[:3, 3], rotations.zyx(T[:3, :3])])


def ghosts(panel):
    """Names of the translucent arms that are shown."""
    return sorted(ghost["path"].removeprefix("/ck/") for ghost in panel.scene.ghosts if ghost["shown"])


def test_it_opens_at_the_pose_of_the_report(panel):
    kr6 = robots.kuka_kr6()
    np.testing.assert_allclose(panel.scene.robots["robot"].theta, [2, -1, -1, 2.5, 0.6, 0], rtol=0, atol=1e-9)
    assert "8 of 8 solutions, 8 inside the limits; shown: front elbow-down no-flip" in panel.line.value
    assert "6 steps to back elbow-down no-flip" in panel.line.value
    assert len(ghosts(panel)) == 7
    target = kr6.fk([2, -1, -1, 2.5, 0.6, 0])
    for name in ("robot", *ghosts(panel)):
        np.testing.assert_allclose(kr6.fk(panel.scene.robots[name].theta), target, rtol=0, atol=1e-12)


def test_the_table_chooses_the_solid_arm(panel):
    kr6 = robots.kuka_kr6()
    expected = ik.analytic(kr6, kr6.fk([2, -1, -1, 2.5, 0.6, 0]))
    panel.set(solution=6)
    np.testing.assert_allclose(panel.scene.robots["robot"].theta, expected.theta[6], rtol=0, atol=1e-9)
    assert "branch6" not in ghosts(panel) and "branch2" in ghosts(panel)
    rows = panel._controls["solution"].rows
    assert [row[0] for row in rows] == list(expected.branches)
    assert rows[6][1] == f"{np.degrees(expected.theta[6, 0]):.1f}"
    panel.set(others=False)
    assert ghosts(panel) == []


def test_moving_the_target_keeps_the_branch(panel):
    kr6 = robots.kuka_kr6()
    panel.set(solution=7)
    for theta in ([1.8, -1.1, -0.9, 2.4, 0.7, 0.1], [1.6, -1.2, -0.8, 2.2, 0.8, 0.2]):
        T = kr6.fk(theta)
        panel.set(pose=pose_values(T))
        np.testing.assert_allclose(kr6.fk(panel.scene.robots["robot"].theta), T, rtol=0, atol=1e-12)
        np.testing.assert_allclose(
            panel.scene.robots["robot"].theta, ik.analytic(kr6, T).turned[7], rtol=0, atol=1e-9
        )


def test_a_branch_that_ends_hands_over_to_the_nearest(panel):
    kr6 = robots.kuka_kr6()
    panel.set(solution=6)
    T = kr6.fk([0.2, -0.1, 0.3, 0.4, 0.9, -0.5])  # far out: only the four front branches reach it
    solutions = ik.analytic(kr6, T)
    assert solutions.exists.sum() == 4
    panel.set(pose=pose_values(T))
    assert "4 of 8 solutions" in panel.line.value
    np.testing.assert_allclose(kr6.fk(panel.scene.robots["robot"].theta), T, rtol=0, atol=1e-12)
    assert len(ghosts(panel)) == 3


def test_out_of_reach_the_arm_stays_and_the_closest_pose_is_shown(panel):
    before, pose = panel.scene.robots["robot"].theta, panel.values["pose"]
    pose[2] = 1.6
    panel.set(pose=pose)
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, before)
    assert "out of reach" in panel.line.value
    assert ghosts(panel) == ["closest"]
    gap = np.linalg.norm(robots.kuka_kr6().fk(panel.scene.robots["closest"].theta)[:3, 3] - pose[:3])
    assert f"{1000 * gap:.1f} mm away" in panel.line.value
    assert all(row[1] == "-" for row in panel._controls["solution"].rows)
    panel.reset()
    assert "8 of 8" in panel.line.value


def test_the_limits_are_explained():
    panel = view.explore_inverse(robots.kawasaki_s030())
    try:
        limits = [row[-1] for row in panel._controls["solution"].rows]
        assert any("joint" in text and "limits" in text for text in limits)
    finally:
        panel.close()


def test_newton_from_another_guess_reaches_another_solution(panel):
    panel.set(guess=[2, -1, -1, 2.4, 0.5, 0.1])
    assert "to front elbow-down no-flip" in panel.line.value


@pytest.mark.parametrize("name", ["abb_irb1200", "kuka_kr10", "puma560", "ur5", "planar_2r"])
def test_every_arm_with_a_formula(name):
    robot = robots.all()[name]
    panel = view.explore_inverse(robot)
    try:
        T = robot.fk(panel.scene.robots["robot"].theta)
        np.testing.assert_allclose(T[:3, 3], panel.values["pose"][:3], rtol=0, atol=1e-9)
    finally:
        panel.close()


def test_the_redundant_arm_goes_on_from_where_it_stands():
    """Endlessly many solutions: the ones that are shown follow the target, as the one chosen does."""
    panda = robots.franka_panda()
    panel = view.explore_inverse(panda)
    try:
        panel.set(solution=3)
        before = {name: arm.theta for name, arm in panel.scene.robots.items()}
        T = panda.fk(panel.scene.robots["robot"].theta)
        for step in range(1, 6):
            panel.set(pose=pose_values(T) + [0, 0, -0.005 * step, 0, 0, 0])
        names = {name for name in before if name in panel.scene.robots}
        went = {name: np.abs(panel.scene.robots[name].theta - before[name]).max() for name in names}
        assert went["robot"] < 0.3
        assert sum(way < 0.5 for way in went.values()) >= 6
        assert "endlessly many, 8 of them shown" in panel.line.value
    finally:
        panel.close()


def test_a_picture_a_line_and_no_leak():
    view.explore_inverse().close()
    before = len(ipywidgets.widgets.widget._instances)
    panel = view.explore_inverse()
    bundle, _ = panel._repr_mimebundle_()
    assert "image/png" in bundle
    assert bundle["text/plain"].startswith("Explorer of inverse kinematics: KUKA KR6 R900 sixx")
    panel.close()
    assert len(ipywidgets.widgets.widget._instances) == before
