"""The page moves the arm itself: before the kernel answers, and where there is none."""

import re

import numpy as np
import pytest

from coursekit import robots, view
from coursekit.view.explorers.jacobians import arrow_at
from tests.browser.test_pointing import SEEN

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
IMPORT = "import numpy as np\nfrom coursekit import robots, view"
BUSY = """() => { window.jupyterapp.shell.currentWidget.context.sessionContext.session.kernel
                  .requestExecute({ code: "import time; time.sleep(6)" }); }"""
# Where link 6 is in the first frame after a key, and how many milliseconds that took.
NEXT_FRAME = """async (key) => {
    const range = document.querySelector(".ck-range");
    const { viewer } = document.querySelector(".ck-viewer").coursekit;
    const link = viewer.scene_tree.find(["ck", "robot", "1"]).object;
    range.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    await new Promise(requestAnimationFrame);
    await new Promise(requestAnimationFrame);
    return link.quaternion.toArray();
}"""


# The labels that are shown, and those of them that a handle covers.
UNDER_A_HANDLE = """() => {
    const shown = (kind) => [...document.querySelectorAll(kind)]
        .filter((one) => one.style.display !== "none" && one.style.visibility !== "hidden")
        .map((one) => ({ text: one.textContent, box: one.getBoundingClientRect() }));
    const labels = shown(".ck-label"), handles = shown(".ck-handle");
    const meet = ({ box: a }, { box: b }) => a.left < b.right - 1 && a.right > b.left + 1
        && a.top < b.bottom - 1 && a.bottom > b.top + 1;
    const covered = labels.filter((label) => handles.some((handle) => meet(label, handle)));
    return [labels, covered].map((all) => all.map(({ text }) => text));
}"""


@pytest.mark.parametrize("busy", [False, True])
def test_the_arm_follows_its_slider_in_the_next_frame(notebook, lab, busy):
    notebook.open(lab.write(f"next{busy}.ipynb", IMPORT, "panel = view.explore(robots.kuka_kr6())\npanel"))
    notebook.run_all()
    notebook.wait_view()
    if busy:
        notebook.page.evaluate(BUSY)
        notebook.page.wait_for_timeout(300)
    x, y, z, w = notebook.page.evaluate(NEXT_FRAME, "PageUp")
    half = -np.radians(10) / 2  # about -z, as axis 1 of this arm
    np.testing.assert_allclose([x, y, z, w], [0, 0, np.sin(half), np.cos(half)], rtol=0, atol=1e-12)
    notebook.idle()
    notebook.rest()
    theta = notebook.kernel("panel.values['theta'].tolist()")
    np.testing.assert_allclose(notebook.transform("/ck/robot/6"), KR6.displacements(theta)[-1], atol=1e-12)
    before = notebook.frames()
    notebook.page.wait_for_timeout(1000)
    assert notebook.frames() == before, "frames are drawn although nothing moves"
    assert notebook.errors == []


@pytest.fixture
def offline(browser, tmp_path):
    """Function: a panel as a page of its own, opened without a network."""
    contexts, errors = [], []

    def open_it(panel):
        file = tmp_path / "page.html"
        file.write_text(view.to_html(panel), encoding="utf-8")
        panel.close()
        contexts.append(browser.new_context(offline=True, viewport={"width": 1280, "height": 800}))
        page = contexts[-1].new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(file.as_uri())
        page.wait_for_function("() => document.querySelector('.ck-viewer')?.coursekit?.stage.frames > 0")
        return page

    yield open_it
    for context in contexts:
        context.close()
    assert errors == []


def link(page, path):
    columns = page.evaluate(
        """(path) => document.querySelector(".ck-viewer").coursekit.viewer
                       .scene_tree.find(path.split("/").filter((s) => s)).object.matrix.elements""",
        path,
    )
    return np.reshape(columns, (4, 4)).T


def assert_link_comes_to(page, path, expected):
    """In one of the next frames, each of which may take a second on a machine that is busy."""
    for _ in range(100):
        found = link(page, path)
        if np.allclose(found, expected, rtol=0, atol=1e-12):
            break
        page.wait_for_timeout(200)
    np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("name", ["explore", "explore_screws", "explore_singularities", "explore_jacobians"])
def test_a_page_without_a_kernel_follows_its_sliders(offline, name):
    panel = getattr(view, name)()
    robot, start = panel.scene.robots["robot"].robot, panel.scene.robots["robot"].theta
    page = offline(panel)
    sliders = page.locator("[role=slider]")
    assert sliders.count() == (1 if name == "explore_screws" else robot.n)
    joint = 1 if name == "explore_screws" else 0
    sliders.nth(0).press("PageUp")
    theta = start + np.radians(10) * np.eye(robot.n)[joint]
    assert_link_comes_to(page, f"/ck/robot/{robot.n}", robot.displacements(theta)[-1])
    scene = view.Scene()
    scene.robot(robot, theta)
    assert page.inner_text("#words") == scene.text()
    lost = page.evaluate(
        """() => document.querySelector(".ck-viewer").coursekit.viewer
                         .scene_tree.find(["ck", "lost"]).object.visible"""
    )
    assert lost == (name != "explore_singularities")
    if name == "explore_jacobians":
        body, J = link(page, "/ck/linear/body")[:3, :3], robot.jacobian_geometric(theta)[3:]
        np.testing.assert_allclose(body @ body.T, 0.42**2 * J @ J.T, rtol=0, atol=1e-12)  # 0.42 m for 1 m/s
        assert page.evaluate(SEEN, ["/ck/linear"]) == ["/ck/linear"]


def test_the_formula_of_a_page_points_into_its_picture(offline):
    panel = view.explore_jacobians()
    robot, start = panel.scene.robots["robot"].robot, panel.scene.robots["robot"].theta
    page = offline(panel)
    paths = ["/ck/robot/3/theta", "/ck/columns/3"]
    third = page.locator(".ck-part").nth(2)
    assert page.evaluate(SEEN, paths) == []
    third.focus()
    assert page.evaluate(SEEN, paths) == paths
    meaning = page.locator(".ck-meaning")
    assert meaning.inner_text().startswith("column 3: joint 3 at 1 rad/s moves the tool point by (")
    page.wait_for_function(f"() => ({UNDER_A_HANDLE})()[0].includes('v3')")  # once a frame is drawn
    assert page.evaluate(UNDER_A_HANDLE)[1] == []  # where the label belongs stands the handle of the tool

    page.locator("[role=slider]").first.press("PageUp")  # no kernel is told: the page places the arrow itself
    third.focus()
    theta = start + np.radians(10) * np.eye(robot.n)[0]
    column = robot.jacobian_geometric(theta)[3:, 2]
    assert_link_comes_to(page, paths[1], arrow_at(column, robot.fk(theta)[:3, 3]))
    assert page.evaluate(SEEN, paths) == paths
    assert meaning.inner_text().startswith("in the pose that was saved: column 3: joint 3 at ")


def test_a_motion_moves_the_sliders_of_a_page_without_a_kernel(offline):
    panel = view.explore(KR6)
    thetas = np.linspace(KR6.home, KR6.home + 0.4, 21)
    panel.play(thetas, autoplay=False)
    page = offline(panel)
    page.locator(".ck-scrub").focus()
    page.keyboard.press("End")
    assert_link_comes_to(page, "/ck/robot/6", KR6.displacements(thetas[-1])[-1])
    shown = page.eval_on_selector_all(
        "[role=slider]", "all => all.map((s) => +s.getAttribute('aria-valuenow'))"
    )
    np.testing.assert_allclose(np.radians(shown[:6]), thetas[-1], atol=1e-4)
    numbers = [float(x) for x in re.findall(r"-?\d+\.\d", page.inner_text("#words"))]
    np.testing.assert_allclose(numbers[:6], np.degrees(thetas[-1]), atol=0.051)

    page.locator("[role=slider]").first.press("PageUp")
    theta = thetas[-1] + np.radians([10, 0, 0, 0, 0, 0])
    assert_link_comes_to(page, "/ck/robot/6", KR6.displacements(theta)[-1])
    assert not page.locator(".ck-player").is_visible()
