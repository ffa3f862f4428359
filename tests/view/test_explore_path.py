"""The explorer of notebook 06 without a browser."""

import ipywidgets
import numpy as np
import pytest

from coursekit import Robot, path, robots, view
from coursekit.view import png, text


@pytest.fixture(scope="module")
def opened():
    panel = view.explore_path()
    yield panel
    panel.close()


@pytest.fixture
def panel(opened):
    """The explorer as it was when it was opened."""
    opened.set(branch="front elbow-up flip", points="101", bounds="2 rad/s each", wrapped=False)
    opened.viewer.frame = 0
    return opened


def sent(panel):
    """The poses that the page plays, (frames, links, 4, 4)."""
    frames = panel.viewer.motion["frames"]
    return np.frombuffer(panel.viewer.motion_poses).reshape(frames, -1, 4, 4).transpose(0, 1, 3, 2)


def tool(panel):
    return panel.scene.worlds(["/ck/robot/6/tool"])["/ck/robot/6/tool"]


def test_it_starts_at_rest_at_the_first_point(panel):
    T = path.frames(path.s_curve(101))
    np.testing.assert_allclose(tool(panel), T[0], atol=1e-12)
    lines = panel.line.value.splitlines()
    assert lines[0] == "front elbow-up flip"
    assert panel.viewer.motion_texts[0].startswith("point 1 of 101: joints at ")
    assert lines[1].endswith("inside the limits")
    assert lines[2].startswith("largest speed 0.3001 m/s: joint 6 at 2.000 rad/s")
    assert panel.viewer.motion["autoplay"] is False


def test_every_pose_of_the_motion_is_on_the_path(panel):
    abb = robots.abb_irb1200()
    np.testing.assert_allclose(sent(panel)[:, -1] @ abb.M, path.frames(path.s_curve(101)), atol=1e-12)


def test_the_motion_takes_as_long_as_the_arm_would(panel):
    seconds = (panel.viewer.motion["frames"] - 1) / panel.viewer.motion["fps"]
    assert seconds == pytest.approx(1.8308 / 0.300066, rel=1e-4)


def test_reset_goes_back_to_the_first_point(panel):
    panel.viewer.frame = 30
    panel.reset()
    np.testing.assert_allclose(tool(panel), path.frames(path.s_curve(101))[0], atol=1e-12)


@pytest.mark.parametrize("place", [30, 100])
def test_where_the_motion_rests_the_arm_the_text_and_the_pose_follow(panel, place):
    panel.viewer.frame = place  # what the page says after pause or scrub
    assert panel.viewer.frame == place, "the page goes on showing that pose, and its text"
    assert panel.viewer.motion_texts[place].startswith(f"point {place + 1} of 101: joints at ")
    q = path.follow(robots.abb_irb1200(), path.frames(path.s_curve(101)))[panel.values["branch"], place]
    assert f"joints {text.degrees(q)}" in panel.line.value
    np.testing.assert_allclose(tool(panel), path.frames(path.s_curve(101))[place], atol=1e-12)
    pose = np.frombuffer(panel.viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
    np.testing.assert_allclose(pose, sent(panel)[place], rtol=0, atol=1e-15)


def test_many_points_are_thinned_for_the_page_alone(panel):
    panel.set(points="5001")
    assert panel.viewer.motion["frames"] == 501
    assert panel.viewer.motion_texts[0].startswith("point 1 of 5001") and "0.3000 m/s" in panel.line.value
    np.testing.assert_allclose(
        sent(panel)[-1, -1] @ robots.abb_irb1200().M, path.frames(path.s_curve(5001))[-1], atol=1e-12
    )


def test_all_eight_ways_can_be_chosen(panel):
    (choice,) = [control for control in panel._controls.values() if control.name == "branch"]
    assert len(choice.options) == 8
    poses = set()
    for name in choice.options:
        panel.set(branch=name)
        assert panel.line.value.startswith(name)
        np.testing.assert_allclose(tool(panel), path.frames(path.s_curve(101))[0], atol=1e-11)
        poses.add(tuple(np.round(panel.scene.pose()[1].ravel(), 6) + 0.0))
    assert len(poses) == 4, "four ways to hold the upper arm, two wrists each"


def test_wrapped_angles_make_seven_ways_slow(panel):
    (table,) = [control for control in panel._controls.values() if control.name == "ways"]
    assert [row[1] for row in table.rows] == ["0.3001"] * 8
    panel.set(wrapped=True, branch="back elbow-up no-flip")
    speeds = [row[1] for row in table.rows]
    assert (speeds.count("0.0059"), speeds.count("0.3001")) == (7, 1)
    assert "from wrapped angles 0.0059 m/s" in panel.line.value
    panel.set(branch="front elbow-up flip")
    assert "no angle wraps" in panel.line.value


def test_the_robots_own_bounds(panel):
    panel.set(bounds="the robot's own")
    assert "largest speed 1.5093 m/s: joint 1 at 5.027 rad/s" in panel.line.value


def test_a_curve_of_ones_own():
    u = np.linspace(0, 1, 9)
    panel = view.explore_path(points=path.on_sphere(np.stack([0.2 * u, 0.1 * u * u], axis=1)))
    try:
        np.testing.assert_allclose(tool(panel)[:3, 3], [0.5, 0, 0.5], atol=1e-12)
    finally:
        panel.close()


def test_what_cannot_be_followed_is_refused():
    view.Slider("first of all")  # brings the page's script, which stays
    before = len(ipywidgets.widgets.widget._instances)
    with pytest.raises(ValueError, match="cannot follow this path: it reaches 0 of 101"):
        view.explore_path(robots.planar_2r(), path.s_curve(51))
    with pytest.raises(ValueError, match="lift has one joint"):
        view.explore_path(Robot.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4), "P", name="lift"))
    assert len(ipywidgets.widgets.widget._instances) == before


def test_pictures_and_no_widget_left():
    view.Slider("first of all")  # brings the page's script, which stays
    before = len(ipywidgets.widgets.widget._instances)
    panel = view.explore_path()
    assert png(panel.scene, 320, 240).startswith(b"\x89PNG")
    assert panel.below[0].svg.startswith("<svg")
    assert repr(panel).startswith("Explorer of the path: ABB IRB 1200-5/0.9: joints (-28.1, 49.7, 47.8, 0.0")
    panel.close()
    assert len(ipywidgets.widgets.widget._instances) == before
