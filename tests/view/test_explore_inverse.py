"""The explorer of inverse kinematics without a browser."""

import ipywidgets
import numpy as np
import pytest

from coursekit import ik, robots, rotations, view
from coursekit.view import target


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


def test_the_answer_to_a_hand_begins_with_the_solutions(panel, monkeypatch):
    """Neither an echo nor the sliders, the words or Newton's run go before what the picture waits for."""
    told, run = [], ik.newton

    def send(widget, message, buffers=None):
        told.append((widget, {*message["state"], *(path[0] for path in message["buffer_paths"])}))

    monkeypatch.setattr(ipywidgets.Widget, "_send", send)
    monkeypatch.setattr(
        ik, "newton", lambda *args, **more: (told.append((None, {"newton"})), run(*args, **more))[1]
    )
    goal = panel.values["pose"] + [0.01, 0, 0, 0, 0, 0]
    shown = [*1000 * goal[:3], *np.degrees(goal[3:])]
    panel.viewer.set_state({"dragged": {"what": "/ck/target", "values": shown, "live": True, "count": 1}})
    first, told_first = told[0]
    assert first is panel.viewer and {"pose", "theta"} <= told_first
    later = [what for _, what in told[1:]]
    assert {"newton"} in later and {"heard"} in later and not any("pose" in what for what in later)
    moved = {widget.name for widget, what in told[1:] if "value" in what}
    assert {"x", "text"} <= moved


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
    pose[2] = 1.5
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


@pytest.mark.parametrize("name", ["kuka_kr6", "puma560", "ur5", "planar_2r"])
def test_the_bands_say_where_the_target_is_in_reach(name):
    """Along each slider, the others held: against one pose after the other, and a little outside each end."""
    robot = robots.all()[name]
    panel = view.explore_inverse(robot)
    sliders, pose = panel._controls["pose"].sliders, panel.values["pose"]
    bands = [slider.bands for slider in sliders]
    panel.close()
    outside = 0
    for k, slider in enumerate(sliders):
        per, fine = slider.shown_per_si, 0.2  # mm, deg

        def looked(values, k=k, per=per):
            poses = np.repeat(pose[None], len(values), axis=0)
            poses[:, k] = np.array(values) / per
            T = np.tile(np.eye(4), (len(values), 1, 1))
            T[:, :3, :3], T[:, :3, 3] = rotations.from_zyx(poses[:, 3:]), poses[:, :3]
            found = ik.analytic(robot, T)
            return found.exists.any(axis=-1), found.within_limits.any(axis=-1)

        for runs, which in zip(bands[k], range(2), strict=True):
            values = np.linspace(slider.min, slider.max, 397)
            near = [np.abs(values - end) < fine for run in runs for end in run]
            clear = ~np.any(near, axis=0) if near else np.full(len(values), True)
            told = np.any([(low <= values) & (values <= high) for low, high in runs], axis=0)
            np.testing.assert_array_equal((looked(values)[which] & clear), told & clear, f"{slider.name}")
            ends = np.array(runs).reshape(-1, 2)
            assert looked(ends.ravel())[which].all()
            beyond = (ends + [-fine, fine]).ravel()
            beyond = beyond[(beyond > slider.min) & (beyond < slider.max)]
            assert not looked(beyond)[which].any()
            outside += len(beyond)
    assert outside > 4


def test_the_bands_hold_what_is_shown_and_follow_the_other_sliders(panel):
    x, *_, roll = panel._controls["pose"].sliders
    before = x.bands
    assert any(low <= x.value <= high for low, high in before[1])
    pose = panel.values["pose"]
    panel.set(pose=[*pose[:2], pose[2] + 0.1, *pose[3:]])
    assert x.bands != before and any(low <= x.value <= high for low, high in x.bands[0])
    panel.set(pose=[*pose[:2], 1.5, *pose[3:]])
    assert x.bands == roll.bands == [[], []]


def test_bands_follow_a_drag_only_where_they_are_quick(panel):
    sliders = panel._controls["pose"]
    x, z = sliders.sliders[0], sliders.sliders[2]
    for cost, follows in ((0.0, True), (1.0, False)):
        before, sliders._cost = x.bands, cost
        z.set_state({"value": z.value - 20, "live": True, "touched": z.touched + 1})
        assert (x.bands != before) is follows
        z.set_state({"live": False, "touched": z.touched + 1})
        assert x.bands != before


def test_an_arm_without_a_formula_has_no_bands():
    panel = view.explore_inverse(robots.franka_panda())
    target = panel._controls["pose"]
    assert all(slider.bands == [] for slider in target.sliders)
    target.sliders[0].set_state({"value": target.sliders[0].value + 10, "live": True})
    assert target not in panel._stale  # which would draw everything once more when the drag ends
    panel.close()


@pytest.mark.parametrize("name", robots.all())
def test_the_sliders_of_a_target_end_a_little_beyond_what_the_tool_can_reach(name):
    robot = robots.all()[name]
    sliders = target.pose_sliders(robot.M, robot).used[:3]
    free = np.where(np.array(robot.joint_types) == "prismatic", 1.0, np.pi)
    low, high = np.clip(robot.q_min, -free, None), np.clip(robot.q_max, None, free)
    places = robot.fk(np.random.default_rng(5).uniform(low, high, (20000, robot.n)))[:, :3, 3]
    for slider, way in zip(sliders, [*places.T], strict=True):
        assert slider.min <= 1000 * way.min() and 1000 * way.max() <= slider.max
        assert slider.max - slider.min < 1000 * (1.25 * np.ptp(way) + 0.3)
