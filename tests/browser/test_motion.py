"""Paused in the middle of a motion, picture, sliders, words, arrows, map and plots tell one configuration."""

import numpy as np
import pytest

from coursekit import ik, jacobians, path, robots, rotations
from coursekit.view import text
from coursekit.view.explorers import singularities as loss

pytestmark = pytest.mark.browser

MARKS = """() => [...document.querySelectorAll(".ck-marks span")].map((mark) => {
    const [own, all] = [mark, mark.parentElement].map((one) => one.getBoundingClientRect());
    const [x, y] = [own.left + own.width / 2, own.bottom - own.height / 2];
    return [(x - all.left) / all.width, (all.bottom - y) / all.height];
})"""
ARROW = """(path) => {
    const { viewer } = document.querySelector(".ck-viewer").coursekit;
    const steps = [...path.split("/").filter((s) => s), "<object>"];
    return viewer.scene_tree.find(steps).object.children[0].matrix.elements;
}"""


def ask(explorer, expression):
    """The value of an expression of the panel p."""
    return explorer.notebook.kernel(f"[{expression} for p in [{explorer.panel}]][0]")


def paused(explorer, number):
    """Pause where this pose (counted from 1) is shown, or soon after: the configuration and its index."""
    assert explorer.pause_from(number) >= number
    explorer.settle()
    shown = int(explorer.page.locator(".ck-count").inner_text().split("/")[0]) - 1
    assert explorer.kernel("viewer.frame") == shown
    theta = np.array(explorer.kernel("motion.theta.tolist()"))
    explorer.assert_arm_stands_at(theta)
    return theta, shown


def marked(explorer):
    """Where the page shows the mark of the plot, in the plot's data: (x, y)."""
    ((x, y),) = explorer.page.evaluate(MARKS)
    figure = "[b._figure for b in p.below if hasattr(b, 'svg')][0]"
    place = f"figure.axes[0].transData.inverted().transform([{x}, {y}] * figure.bbox.size).tolist()"
    return ask(explorer, f"[{place} for figure in [{figure}]][0]")


def test_conventions(opened):
    kr6 = robots.kuka_kr6()
    explorer = opened("conventions", kr6, "view.explore(robots.kuka_kr6())")
    explorer.notebook.kernel("panel.play(np.linspace(panel.values['theta'], np.full(6, 0.5), 61))")
    theta, shown = paused(explorer, 10)
    assert 9 <= shown < 60
    np.testing.assert_allclose(explorer.sliders(6), theta, atol=1e-4)
    x, y, z = np.round(1000 * kr6.fk(theta)[:3, 3], 3) + 0.0
    assert f"x = {x:9.3f}  y = {y:9.3f}  z = {z:9.3f} mm" in explorer.words()

    explorer.slide("θ1", ["PageUp"])  # goes on from where it rests, and the motion is over
    moved = explorer.values()
    np.testing.assert_allclose(moved[1:], theta[1:], atol=1e-12)
    explorer.assert_arm_stands_at(moved)
    assert not explorer.page.locator(".ck-player").is_visible()


def test_newtons_steps(opened):
    kr6 = robots.kuka_kr6()
    explorer = opened("inverse", kr6, "view.explore_inverse()")
    explorer.press("show Newton's steps")
    theta, shown = paused(explorer, 3)
    pose, guess = explorer.values("pose"), explorer.values("guess")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotations.from_zyx(pose[3:]), pose[:3]
    history = ik.newton(kr6, T, guess, max_iterations=50, tol=1e-9).history
    np.testing.assert_allclose(theta, history[shown].theta, atol=1e-12)
    assert f"shown: Newton's step {shown} of {len(history) - 1}, {text.degrees(theta)}" in explorer.words()
    assert marked(explorer)[0] == pytest.approx(shown, abs=0.05)  # to a fraction of a pixel

    explorer.slide("x", ["PageUp"])  # another target: those steps led elsewhere
    assert not explorer.page.locator(".ck-player").is_visible()
    assert "Newton's step" not in explorer.words()
    explorer.assert_arm_stands_at(np.array(explorer.kernel("scene.robots['robot'].theta.tolist()")))


def test_to_the_elbow(opened):
    kr6 = robots.kuka_kr6()
    explorer = opened("singularities", kr6, "view.explore_singularities()")
    explorer.press("to the elbow")
    theta, shown = paused(explorer, 8)
    assert shown < 30
    np.testing.assert_allclose(explorer.sliders(6), theta, atol=1e-4)
    assert explorer.words() == loss.words(kr6, theta)
    np.testing.assert_allclose(marked(explorer), np.degrees(theta[1:3]), atol=1)
    explorer.page.mouse.wheel(0, -5000)
    arrow = np.reshape(explorer.page.evaluate(ARROW, "/ck/lost/force"), (4, 4)).T
    np.testing.assert_allclose(arrow[:3, 3], kr6.link_frames(theta)[4, :3, 3], atol=1e-6)

    explorer.choose("robot", "Kawasaki S030")  # the motion was another arm's
    assert not explorer.page.locator(".ck-player").is_visible()
    explorer.robot = robots.kawasaki_s030()
    explorer.assert_arm_stands_at(explorer.values())


def test_damped_least_squares(opened):
    panda = robots.franka_panda()
    explorer = opened("jacobians", panda, "view.explore_jacobians()")
    start = explorer.values()
    explorer.press("play damped")
    theta, shown = paused(explorer, 2)
    np.testing.assert_allclose(explorer.sliders(7), theta, atol=1e-4)
    lengths = jacobians.ellipsoid(panda.jacobian_geometric(theta), "linear").lengths
    assert f"linear   half axes {text.row(lengths)} m/s" in explorer.words()
    assert f"shown: step {shown}" in explorer.words()
    assert marked(explorer)[0] == pytest.approx(shown, abs=0.05)
    body = np.array(explorer.notebook.transform("/ck/linear/body"))
    np.testing.assert_allclose(body[:3, 3], panda.fk(theta)[:3, 3], atol=1e-9)

    explorer.slide("damping k", ["PageUp"])  # another run, from the same start
    np.testing.assert_allclose(explorer.values(), start, atol=1e-12)
    explorer.assert_arm_stands_at(start)


def test_a_named_pose_beyond_the_limits(opened):
    model = robots.kuka_kr10_report()
    theta = [0, -np.pi / 6, -2.2829525304720546, 0, np.pi / 6, 0]  # the slider of joint 3 ends at -120 deg
    line = f"view.explore_jacobians(robots.kuka_kr10_report(), poses={{'alignment as printed': {theta}}})"
    explorer = opened("jacobians", model, line)
    explorer.press("alignment as printed")
    explorer.played_to_the_end(31)
    np.testing.assert_allclose(explorer.sliders(6), theta, atol=1e-4)
    explorer.assert_arm_stands_at(theta)
    lengths = jacobians.ellipsoid(model.jacobian_geometric(theta), "linear").lengths
    assert f"linear   half axes {text.row(lengths)} m/s" in explorer.words()


def test_along_the_path(opened):
    abb = robots.abb_irb1200()
    explorer = opened("path", abb, "view.explore_path()")
    explorer.page.get_by_label("playing speed").select_option("0.1")
    explorer.press("play the motion")
    theta, shown = paused(explorer, 5)
    q = path.follow(abb, path.frames(path.s_curve(101)))[explorer.kernel("values['branch']"), shown]
    np.testing.assert_allclose(theta, q, atol=1e-12)
    assert f"joints {text.degrees(theta)}" in explorer.words()
    assert f"point {shown + 1} of 101" in explorer.page.locator(".ck-text").first.inner_text()
    s = np.append(0, np.cumsum(path.steps(path.s_curve(101))))
    assert marked(explorer)[0] == pytest.approx(s[shown], abs=0.01)


def test_without_motion_wished_for_the_end_is_shown_at_once(opened, notebook):
    notebook.page.emulate_media(reduced_motion="reduce")
    explorer = opened("singularities", robots.kuka_kr6(), "view.explore_singularities()")
    explorer.press("to the wrist")
    explorer.page.wait_for_selector(".ck-player:not([hidden])")
    assert explorer.page.locator(".ck-count").inner_text() == "31 / 31"
    explorer.settle()
    assert "wrist singularity" in explorer.words()
    explorer.assert_arm_stands_at(explorer.values())
