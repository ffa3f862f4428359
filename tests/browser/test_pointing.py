"""Parts of a formula point into the picture: by mouse, by Tab and by a finger, and without a kernel."""

import numpy as np
import pytest

from coursekit import ik, robots
from tests.browser.explorer import centre, finger

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
# What can be seen: of these paths, those that neither they nor anything above them hide.
SEEN = """(paths) => {
    const { viewer } = document.querySelector(".ck-viewer").coursekit;
    const seen = (object) => !object || (object.visible && seen(object.parent));
    return paths.filter((path) => seen(viewer.scene_tree.find(path.split("/").filter((s) => s)).object));
}"""
# Handles that lie over the tool's.
OVER_TOOL = """() => {
    const all = [...document.querySelectorAll(".ck-handle")];
    const shown = all.filter((one) => one.style.visibility !== "hidden");
    const box = shown.find((one) => one.matches(".tool")).getBoundingClientRect();
    return shown.filter((one) => !one.matches(".tool")).filter((one) => {
        const { left, right, top, bottom } = one.getBoundingClientRect();
        return left < box.right && right > box.left && top < box.bottom && bottom > box.top;
    }).map((one) => one.ariaLabel);
}"""
LABELS = """() => [...document.querySelectorAll(".ck-label")].filter((l) => l.style.display !== "none")
    .map((l) => l.textContent)"""
OPACITY = """(path) => {
    const { viewer } = document.querySelector(".ck-viewer").coursekit;
    let most = 0;
    viewer.scene_tree.find(path.split("/").filter((s) => s)).object.traverse((part) => {
        const pale = [].concat(part.material || []).filter((m) => m.transparent && m.colorWrite);
        most = Math.max(most, ...pale.map((m) => m.opacity));
    });
    return most;
}"""


def part(explorer, text):
    return explorer.page.get_by_role("button", name=text, exact=True)


def seen(explorer, *paths):
    explorer.notebook.rest()
    return explorer.page.evaluate(SEEN, list(paths))


def meaning(explorer):
    return explorer.page.locator(".ck-meaning").first.inner_text()


def away(explorer):
    explorer.page.mouse.move(2, 2)
    explorer.page.evaluate("() => document.activeElement.blur()")


def test_parts_of_the_forward_kinematics_show_axes_and_rows(opened):
    explorer = opened("conventions", KR6, "view.explore(robots.kuka_kr6())")
    axes = [f"/ck/robot/{k}/theta" for k in range(1, 7)]
    assert seen(explorer, *axes) == []
    explorer.page.locator(".ck-formula div").first.locator("button").nth(2).hover()
    assert seen(explorer, *axes) == [axes[2]]
    assert "axis 3" in explorer.page.evaluate(LABELS) and "joint 3" in meaning(explorer)
    away(explorer)
    assert seen(explorer, *axes) == [] and "axis 3" not in explorer.page.evaluate(LABELS)

    # row 2 of the standard table: its two frames, which are switched off, and a = 455 mm
    frames = [f"/ck/robot/{k}/standard" for k in range(7)]
    explorer.page.locator(".ck-formula div").nth(1).locator("button").nth(1).focus()
    assert seen(explorer, *frames, "/ck/robot/2/standard2_a") == [*frames[1:3], "/ck/robot/2/standard2_a"]
    assert "a = 455.0 mm" in meaning(explorer) and "a 455.0 mm" in explorer.page.evaluate(LABELS)
    explorer.page.keyboard.press("Tab")
    assert seen(explorer, *frames) == frames[2:4], "Tab goes to the next row"

    # a slider points at its axis, and what a switch has shown meanwhile stays shown
    explorer.page.get_by_role("slider", name="θ5", exact=True).focus()
    assert seen(explorer, *axes) == [axes[4]]
    explorer.page.get_by_role("checkbox", name="standard DH frames").click()
    explorer.settle()
    away(explorer)
    assert seen(explorer, *axes, *frames) == frames


def test_a_screw_shows_its_line_its_lever_and_its_v(opened):
    explorer = opened("screws", KR6, "view.explore_screws()")
    parts = [f"/ck/screws/{k}/{name}" for k in (2, 4) for name in "wqv"]
    part(explorer, "S₄").hover()
    assert seen(explorer, *parts) == parts[3:]
    part(explorer, "ω").hover()
    assert seen(explorer, *parts) == parts[:1], "of the chosen joint, 2"
    explorer.choose("joint", "joint 4")
    part(explorer, "v").focus()
    assert seen(explorer, *parts) == parts[5:]
    assert "column 2 of S" not in meaning(explorer)


def test_columns_of_the_jacobian_are_arrows_at_the_tool(opened_by_touch):
    panda = robots.franka_panda()
    explorer = opened_by_touch("jacobians", panda, "view.explore_jacobians()")
    explorer.slide("θ2", ["ArrowRight"] * 3)
    part(explorer, "J₄").hover()
    assert seen(explorer, "/ck/columns/4", "/ck/columns/3", "/ck/robot/4/theta") == [
        "/ck/columns/4",
        "/ck/robot/4/theta",
    ]
    theta = explorer.values()
    v = panda.jacobian_geometric(theta)[3:, 3]
    T = np.array(explorer.notebook.transform("/ck/columns/4"))
    np.testing.assert_allclose(T[:3, 2], v, atol=1e-9)
    np.testing.assert_allclose(T[:3, 3], panda.fk(theta)[:3, 3], atol=1e-9)

    explorer.page.set_viewport_size(
        {"width": 412, "height": 900}
    )  # what stands at the tool is near the target's
    explorer.notebook.command("application:toggle-left-area")
    explorer.page.evaluate("() => document.querySelector('.ck-panel').scrollIntoView({ block: 'start' })")
    for name in ("top", "side", "front", "home"):
        explorer.press(name)
        explorer.settle()
        assert explorer.page.evaluate(OVER_TOOL) == [], name
    start, pose = centre(explorer, "move the tool"), explorer.values("pose")
    finger(explorer, start, (-30, 25))
    assert np.linalg.norm(panda.fk(explorer.values())[:3, 3] - panda.fk(theta)[:3, 3]) > 0.03
    np.testing.assert_array_equal(explorer.values("pose"), pose)
    assert explorer.notebook.errors == []


def test_a_small_figure_chooses_its_solution_and_shows_it(opened):
    explorer = opened("inverse", KR6, "view.explore_inverse()")
    figures = explorer.page.locator(".ck-one")
    right = ik.analytic(KR6, np.array(explorer.kernel("scene.moved['/ck/target'].tolist()")))
    assert figures.count() == 8
    names = [text.split("\n")[0] for text in figures.all_inner_texts()]
    assert names == list(right.branches), "the order of the table"
    outside = ["outside the limits" in text for text in figures.all_inner_texts()]
    assert outside == (right.exists & ~right.within_limits).tolist()
    chosen = int(explorer.kernel("values['solution']"))
    pressed = [one == "true" for one in figures.evaluate_all("all => all.map((b) => b.ariaPressed)")]
    assert np.flatnonzero(pressed).tolist() == [chosen]
    other = (chosen + 3) % 8
    pale = explorer.page.evaluate(OPACITY, f"/ck/branch{other}")
    figures.nth(other).hover()
    explorer.notebook.rest()
    assert pale < 0.5 < explorer.page.evaluate(OPACITY, f"/ck/branch{other}")
    # without the other solutions, the one that is pointed at alone
    explorer.page.get_by_role("checkbox", name="other solutions").click()
    explorer.settle()
    ghosts = [f"/ck/branch{k}" for k in range(8)]
    away(explorer)
    assert seen(explorer, *(g for k, g in enumerate(ghosts) if k != chosen)) == []
    figures.nth(other).focus()
    assert seen(explorer, *(g for k, g in enumerate(ghosts) if k != chosen)) == [ghosts[other]]
    explorer.page.keyboard.press("Enter")
    explorer.settle()
    assert explorer.kernel("values['solution']") == other
    moved = KR6.displacements(np.array(explorer.kernel("scene.robots['robot'].theta.tolist()")))
    np.testing.assert_allclose(
        explorer.notebook.wait_transform("/ck/robot/6", moved[-1]), moved[-1], atol=1e-9
    )
    assert figures.nth(other).get_attribute("aria-pressed") == "true"


def test_a_finger_points_and_no_kernel_is_needed(opened_by_touch):
    explorer = opened_by_touch("screws", KR6, "view.explore_screws()")
    explorer.page.evaluate(
        "() => window.jupyterapp.shell.currentWidget.context.sessionContext.session.kernel.shutdown()"
    )
    explorer.page.wait_for_timeout(1000)
    part(explorer, "S₆").tap()
    assert seen(explorer, "/ck/screws/6/w", "/ck/screws/5/w") == ["/ck/screws/6/w"]
    assert meaning(explorer).startswith("column 6 of S")
