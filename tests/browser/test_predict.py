"""Predict in the picture: the point is dragged, the answer told, and nothing gives it away before."""

import re

import numpy as np
import pytest

from coursekit import robots, singularity
from tests.browser.test_handles import ON_PAGE, centre, drag, handle

pytestmark = pytest.mark.browser


def ask(explorer):
    explorer.page.get_by_role("checkbox", name="predict first").check()
    explorer.settle()


def drag_guess_to(explorer, point):
    """Drag the point, which stays as deep in the picture as it is, to where `point` (3,) is seen."""
    there = np.array(explorer.page.evaluate(ON_PAGE, [float(x) for x in point]))
    start = centre(explorer, "move your guess")
    drag(explorer, start, there - start)


def test_where_the_tool_will_be(opened):
    explorer = opened("conventions", robots.kuka_kr6(), "view.explore(robots.kuka_kr6())")
    assert handle(explorer, "move the tool").is_visible()
    assert not explorer.page.get_by_role("button", name="show answer").is_visible()
    ask(explorer)
    assert "theta1 goes from 0.0 deg to 60.0 deg. Where will the tool be?" in explorer.words()
    assert handle(explorer, "move the tool").count() == 0, "it would try what is to be predicted"
    before = explorer.values("prediction")
    theta = explorer.values()
    drag(explorer, centre(explorer, "move your guess along its y"), (20, -8))
    moved = explorer.values("prediction") - before
    assert moved[1] > 0.05 and np.abs(moved[[0, 2]]).max() < 1e-9
    before = before + moved
    handle(explorer, "move your guess along its y").focus()
    explorer.page.keyboard.press("ArrowRight")
    explorer.settle()
    handle(explorer, "move your guess").focus()
    for key in ("ArrowUp", "PageUp"):
        explorer.page.keyboard.press(key)
        explorer.settle()
    np.testing.assert_allclose(explorer.values("prediction") - before, [0, 0.02, 0.01], atol=1e-9)
    turned = explorer.robot.fk(theta + np.eye(6)[0] * np.pi / 3)[:3, 3]
    drag_guess_to(explorer, turned)
    np.testing.assert_array_equal(explorer.values(), theta)
    told = np.linalg.norm(explorer.values("prediction") - turned)
    explorer.press("show answer")
    explorer.played_to_the_end(31)
    said = re.search(r"([\d.]+) mm off", explorer.words().splitlines()[1])[1]
    assert float(said) == pytest.approx(1000 * told, abs=0.51)
    assert " off" in explorer.words().splitlines()[1]
    np.testing.assert_allclose(explorer.values()[0], np.pi / 3, atol=1e-9)
    assert handle(explorer, "move your guess").count() == 0, "what is answered stays"


def test_a_hand_on_a_slider_ends_the_question(opened):
    explorer = opened("conventions", robots.kuka_kr6(), "view.explore(robots.kuka_kr6())")
    ask(explorer)
    explorer.slide("θ1", ["ArrowRight"])
    assert explorer.words().startswith("You moved the arm")
    assert handle(explorer, "move your guess").count() == 0
    explorer.press("next question")
    explorer.settle()
    assert explorer.words().startswith("Predict: ")
    assert handle(explorer, "move your guess").is_visible()


def test_along_the_lost_direction(opened):
    kr6 = robots.kuka_kr6()
    explorer = opened("singularities", kr6, "view.explore_singularities(robots.kuka_kr6())")
    explorer.press("to the elbow")
    explorer.played_to_the_end(31)
    ask(explorer)
    theta = explorer.values()
    assert "one direction in which the wrist cannot move" in explorer.words()
    assert "lost: force" not in explorer.words()
    force, wrist = singularity.lost_motion(kr6, theta)[3:], kr6.link_frames(theta)[4, :3, 3]
    drag_guess_to(explorer, wrist + 0.5 * force / np.linalg.norm(force))
    way = explorer.values("prediction") - wrist
    assert np.linalg.norm(way) == pytest.approx(0.2 * explorer.kernel("scene.size")), (
        "an arrow as long as before"
    )
    cosine = abs(way @ force) / np.linalg.norm(way) / np.linalg.norm(force)
    explorer.press("show answer")
    explorer.settle()
    assert f"{np.degrees(np.arccos(cosine)):.0f} deg off" in explorer.words().splitlines()[1].replace(
        ".0 ", " "
    )
    assert "lost: force" in explorer.words()
