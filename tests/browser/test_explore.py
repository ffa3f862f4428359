"""The explorer of notebook 01 as a student meets it: a real JupyterLab, a real browser, keys and mouse."""

import numpy as np
import pytest

from coursekit import robots
from tests.browser.explorer import IMPORT, SHOW

pytestmark = pytest.mark.browser

TOOL = "/ck/robot/6/tool"


def sliders(notebook):
    """What the sliders say, in radians."""
    shown = notebook.page.eval_on_selector_all(
        "[role=slider]:not(.ck-scrub)", "all => all.map((one) => Number(one.getAttribute('aria-valuenow')))"
    )
    return np.radians(shown)


def assert_tool_is_where_the_sliders_say(notebook, view=0):
    kr6 = robots.kuka_kr6()
    theta = np.array(notebook.kernel("panel.values['theta'].tolist()"))
    np.testing.assert_allclose(
        theta, sliders(notebook)[:6], atol=1e-4
    )  # what the page shows has two decimals
    found = notebook.wait_transform(TOOL, kr6.fk(theta), view)
    np.testing.assert_allclose(found, kr6.fk(theta), rtol=0, atol=1e-12)


def drag(notebook, index, share):
    """Drag the handle of a slider to a share of its track, in small steps as a hand does."""
    page = notebook.page
    track = page.locator("[role=slider]").nth(index)
    area = track.bounding_box()
    ends = [float(track.get_attribute(name)) for name in ("aria-valuemin", "aria-valuenow", "aria-valuemax")]
    knob = 8 + (area["width"] - 16) * (ends[1] - ends[0]) / (ends[2] - ends[0])
    y = area["y"] + area["height"] / 2
    page.mouse.move(area["x"] + knob, y)
    page.mouse.down()
    page.mouse.move(area["x"] + 8 + share * (area["width"] - 16), y, steps=12)
    page.mouse.up()


def test_keyboard_and_drag_move_the_robot_exactly(explorer):
    assert_tool_is_where_the_sliders_say(explorer)
    before = explorer.pixels()

    explorer.page.locator("[role=slider]").nth(0).focus()
    for key in ("ArrowRight", "ArrowRight", "PageUp", "Shift+ArrowLeft"):
        explorer.page.keyboard.press(key)
    explorer.settle()
    np.testing.assert_allclose(sliders(explorer)[0], np.radians(11.9))
    assert_tool_is_where_the_sliders_say(explorer)
    after_keys = explorer.pixels()
    assert after_keys != before

    drag(explorer, 1, 0.25)
    explorer.settle()
    assert abs(np.degrees(sliders(explorer)[1]) - (-190 + 0.25 * 235)) < 4
    assert_tool_is_where_the_sliders_say(explorer)
    assert explorer.pixels() != after_keys


def test_number_box_takes_any_number_and_keeps_to_the_limits(explorer):
    box = explorer.page.locator(".ck-number").nth(4)
    box.fill("12.345")
    box.press("Enter")
    explorer.settle()
    assert explorer.kernel("panel.values['theta'][4]") == pytest.approx(np.radians(12.345), abs=1e-15)
    box.fill("999")
    box.press("Enter")
    explorer.settle()
    assert explorer.kernel("panel.values['theta'][4]") == pytest.approx(robots.kuka_kr6().q_max[4], abs=1e-12)
    assert_tool_is_where_the_sliders_say(explorer)


def test_nothing_is_drawn_while_nothing_changes(explorer):
    before = explorer.frames()
    explorer.page.wait_for_timeout(1500)
    assert explorer.frames() == before


def test_the_switches_show_the_frames_and_reset_goes_back(explorer):
    page = explorer.page
    shown = """() => [...document.querySelectorAll('.ck-label')]
        .filter((l) => l.style.display !== 'none').map((l) => l.textContent).sort()"""
    page.get_by_role("button", name="reset").click()  # which labels have room depends on the pose
    explorer.settle()
    few = page.evaluate(shown)
    page.get_by_label("standard DH frames").check()
    explorer.settle()
    assert {f"{{s{k}}}" for k in range(7)} <= set(page.evaluate(shown))  # letters of axes may give way
    page.locator("[role=slider]").nth(2).press("PageUp")
    page.get_by_role("button", name="reset").click()
    explorer.settle()
    assert page.evaluate(shown) == few
    np.testing.assert_allclose(sliders(explorer)[:6], robots.kuka_kr6().home, atol=1e-12)
    assert_tool_is_where_the_sliders_say(explorer)


def test_run_all_does_not_overwrite_what_a_later_cell_sets(notebook, lab):
    later = "theta = [0.4, -0.3, 0.2, 0.1, -0.7, 1.1]\npanel.set(theta=theta)"
    notebook.open(lab.write("later.ipynb", IMPORT, SHOW, later))
    notebook.run_all()
    notebook.wait_view()
    notebook.settle()
    assert notebook.kernel("panel.values['theta'].tolist()") == [0.4, -0.3, 0.2, 0.1, -0.7, 1.1]
    assert_tool_is_where_the_sliders_say(notebook)
    assert notebook.errors == []


def test_a_second_view_and_a_reloaded_page_show_the_same_pose(notebook, lab):
    notebook.open(lab.write("twice.ipynb", IMPORT, SHOW, "panel"))
    notebook.run_all()
    notebook.wait_view(2)
    notebook.page.locator("[role=slider]").nth(0).press("PageUp")
    notebook.settle()
    expected = robots.kuka_kr6().fk(notebook.kernel("panel.values['theta'].tolist()"))
    for view in (0, 1):
        found = notebook.wait_transform(TOOL, expected, view)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)

    assert notebook.errors == []
    notebook.save()
    notebook.reload()
    notebook.wait_view(2)
    for view in (0, 1):
        found = notebook.wait_transform(TOOL, expected, view)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
    drag(notebook, 3, 0.8)
    notebook.settle()
    expected = robots.kuka_kr6().fk(notebook.kernel("panel.values['theta'].tolist()"))
    for view in (0, 1):
        found = notebook.wait_transform(TOOL, expected, view)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
    cut = ("WebSocket", "Failed to load resource")  # what a reload does to connections that are under way
    assert not [error for error in notebook.errors if not any(word in error for word in cut)]


def test_running_the_cell_ten_times_leaves_one_panel(explorer):
    models = "len(__import__('ipywidgets').widgets.widget._instances)"
    before = explorer.kernel(models)
    textures = "() => globalThis[Symbol.for('coursekit.page.1')].renderer.info.memory.textures"
    drawn = explorer.page.evaluate(textures)
    browser, modules = explorer.page.context.new_cdp_session(explorer.page), []
    browser.send("Debugger.enable")
    browser.on("Debugger.scriptParsed", lambda module: modules.append(module))
    for _ in range(10):
        explorer.run_cell(1)
        explorer.idle()
    explorer.wait_view()
    browser.detach()
    assert explorer.kernel(models) == before
    # a browser never lets go of a module: those of the controls are short (0.7 MB a run when they were not)
    lengths = [module["length"] for module in modules if module["url"].startswith("blob:")]
    assert len(lengths) > 100 and sum(lengths) < 10 * 30_000
    assert explorer.page.locator(".ck-viewer").count() == 1
    assert explorer.page.evaluate("() => globalThis[Symbol.for('coursekit.page.1')].views.size") == 1
    assert explorer.page.evaluate("() => globalThis[Symbol.for('coursekit.page.1')].evaluated") == 1
    # what each view drew goes with it, its shadow too
    assert explorer.page.evaluate(textures) <= drawn + 1
    assert alive(explorer, "globalThis[Symbol.for('coursekit.page.1')].MeshCat.Viewer.prototype") == 1
    explorer.page.locator("[role=slider]").nth(0).press("PageUp")
    explorer.settle()
    assert_tool_is_where_the_sliders_say(explorer)


def alive(notebook, prototype):
    """How many objects of this kind the page still holds after a garbage collection."""
    browser = notebook.page.context.new_cdp_session(notebook.page)
    browser.send("HeapProfiler.collectGarbage")
    kind = browser.send("Runtime.evaluate", {"expression": prototype})["result"]["objectId"]
    found = browser.send("Runtime.queryObjects", {"prototypeObjectId": kind})["objects"]["objectId"]
    count = {"objectId": found, "functionDeclaration": "function () { return this.length; }"}
    return browser.send("Runtime.callFunctionOn", {**count, "returnByValue": True})["result"]["value"]


def test_after_a_restart_of_the_kernel_the_notebook_runs_again(notebook, lab):
    notebook.open(lab.write("restarted.ipynb", IMPORT, SHOW))
    notebook.run_all()
    notebook.wait_view()
    notebook.page.evaluate(
        "() => window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()"
    )
    notebook.idle()
    notebook.run_all()
    notebook.wait_view()
    notebook.page.locator("[role=slider]").nth(0).press("PageUp")
    notebook.settle()
    assert_tool_is_where_the_sliders_say(notebook)
    assert notebook.page.locator(".ck-viewer").count() == 1
    assert notebook.page.evaluate("() => globalThis[Symbol.for('coursekit.page.1')].views.size") == 1


def test_one_robot_after_another(notebook, lab):
    notebook.open(lab.write("picker.ipynb", IMPORT, "panel = view.explore()\npanel"))
    notebook.run_all()
    notebook.wait_view()
    for arm in (robots.franka_panda(), robots.planar_2r(), robots.kawasaki_s030(), robots.kuka_kr6()):
        notebook.page.locator(".ck-select").select_option(arm.name)
        home = arm.fk(arm.home)
        found = notebook.wait_transform(f"/ck/robot/{arm.n}/tool", home)
        np.testing.assert_allclose(found, home, rtol=0, atol=1e-12)
        notebook.settle()
        visible = notebook.page.locator("[role=slider]:visible")
        assert visible.count() == arm.n
        drawn = notebook.page.evaluate(
            """() => {
                 const { viewer } = document.querySelector(".ck-viewer").coursekit;
                 const links = Object.values(viewer.scene_tree.find(["ck", "robot"]).children);
                 return links.filter((link) => link.children.solid?.children["<object>"]).length;
               }"""
        )
        assert drawn == arm.n + 1
    assert notebook.errors == []


def test_a_lost_webgl_context_comes_back(explorer):
    explorer.page.evaluate(
        """async () => {
             const gl = globalThis[Symbol.for("coursekit.page.1")].renderer.getContext();
             const lose = gl.getExtension("WEBGL_lose_context");
             lose.loseContext();
             await new Promise((done) => setTimeout(done, 300));
             lose.restoreContext();
             await new Promise((done) => setTimeout(done, 300));
           }"""
    )
    before = explorer.pixels()
    explorer.page.locator("[role=slider]").nth(0).press("PageUp")
    explorer.settle()
    assert explorer.pixels() != before
    assert_tool_is_where_the_sliders_say(explorer)
