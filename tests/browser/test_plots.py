"""Plots in the page: in its ink, with its names kept apart, and the hands of a person on them."""

import os

import numpy as np
import pytest

from coursekit import robots
from tests.browser.explorer import Explorer
from tests.browser.test_sight import AXE, IMPORT, darken

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
MAP = "view.explore_singularities(robots.kuka_kr6())"
BOTH = "for show in (view.explore_inverse, view.explore_path):\n    display(show())"
INK = """() => ["text", "use"].map((name) => {
    const { fill, stroke } = getComputedStyle(document.querySelector(`.ck-plot svg ${name}`));
    return [fill, stroke].find((color) => color !== "none").match(/[\\d.]+/g).map(Number);
})"""
COUNT = """() => {
    window.messages = 0;
    window.drawings = 0;
    const { kernel } = window.jupyterapp.shell.currentWidget.context.sessionContext.session;
    kernel.anyMessage.connect((_, { msg }) => (messages += /^comm|^execute/.test(msg.header.msg_type)));
    const seen = new MutationObserver((changes) => (drawings += changes.length));
    seen.observe(document.querySelector(".ck-plot [role=img]"), { childList: true });
}"""


def open_one(lab, page, name, line, file):
    page.open(lab.write(f"plots_{file}.ipynb", IMPORT, line))
    page.run_all()
    page.wait_view()
    page.page.wait_for_selector(".ck-plot svg")
    return Explorer(page, name, KR6)


@pytest.fixture(scope="module")
def map_04(lab, open_page):
    return open_one(lab, open_page(), "singularities", MAP, "map")


def place(explorer, x, y):
    """Where data of the map is in the window."""
    explorer.page.locator(".ck-plot").scroll_into_view_if_needed()
    area = explorer.page.locator(".ck-plot").bounding_box()
    figure = explorer.kernel("below[0]._figure.bbox.size.tolist()")
    pixels = explorer.kernel(f"below[0]._figure.axes[0].transData.transform(({x}, {y})).tolist()")
    across, up = np.array(pixels) / figure
    return area["x"] + across * area["width"], area["y"] + (1 - up) * area["height"]


def degrees(explorer):
    return np.degrees(explorer.values()[1:3])


def test_the_theme_changes_the_ink_and_no_kernel_is_asked(map_04):
    map_04.page.evaluate(COUNT)
    for theme, is_right in (("Dark", lambda c: min(c) > 180), ("Light", lambda c: max(c) < 80)):
        darken(map_04, theme)
        for color in map_04.page.evaluate(INK):
            assert is_right(color[:3]), (theme, color)
    assert map_04.page.evaluate("[messages, drawings]") == [0, 0]
    assert map_04.notebook.errors == []


def test_the_map_is_dragged(map_04):
    map_04.page.evaluate(COUNT)
    map_04.page.mouse.move(*place(map_04, -100, 40))
    map_04.page.mouse.down()
    for x in np.linspace(-100, -40, 8):
        map_04.page.mouse.move(*place(map_04, x, 40))
    map_04.settle()  # still held
    np.testing.assert_allclose(degrees(map_04), [-40, 40], atol=1)
    map_04.assert_arm_stands_at(map_04.values())
    map_04.page.mouse.move(*place(map_04, 300, 40))  # beyond the axes the arm stays at its limit
    map_04.page.mouse.up()
    map_04.settle()
    np.testing.assert_allclose(degrees(map_04), [45, 40], atol=1)
    map_04.page.mouse.move(*place(map_04, -100, 40))  # let go
    map_04.settle()
    np.testing.assert_allclose(degrees(map_04), [45, 40], atol=1)
    map_04.assert_arm_stands_at(map_04.values())
    assert map_04.page.evaluate("drawings") == 0, "the map is the same"
    assert map_04.notebook.errors == []


def touch(explorer, *points):
    session = explorer.page.context.new_cdp_session(explorer.page)
    for k, (x, y) in enumerate(points):
        told = {"type": "touchMove" if k else "touchStart", "touchPoints": [{"x": float(x), "y": float(y)}]}
        session.send("Input.dispatchTouchEvent", told)
        explorer.page.wait_for_timeout(60)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    explorer.settle()


def test_a_finger_drags_the_mark_taps_the_map_and_swipes_past_it(lab, open_page):
    page = open_page(has_touch=True)
    explorer = open_one(lab, page, "singularities", MAP, "touch")
    start = degrees(explorer)
    touch(
        explorer, place(explorer, *start), *(place(explorer, start[0] + 10 * k, start[1]) for k in (1, 2, 3))
    )
    np.testing.assert_allclose(degrees(explorer), start + [30, 0], atol=1)
    touch(explorer, place(explorer, -120, 30))
    np.testing.assert_allclose(degrees(explorer), [-120, 30], atol=1)

    scrolled = (
        """() => { const s = document.querySelector(".jp-WindowedPanel-outer"); return s.scrollTop; }"""
    )
    x, y = place(explorer, 0, 100)
    before = page.page.evaluate(scrolled)
    touch(explorer, (x, y), (x, y + 40), (x, y + 90), (x, y + 140))
    assert page.page.evaluate(scrolled) < before, "the page scrolls"
    np.testing.assert_allclose(degrees(explorer), [-120, 30], atol=1)
    assert page.errors == []


def test_a_click_on_the_rates_of_a_motion_that_plays_stops_it_there(lab, open_page):
    explorer = open_one(lab, open_page(), "path", "view.explore_path()", "rates")
    explorer.page.get_by_label("playing speed").select_option("0.1")
    explorer.press("play the motion")
    explorer.page.wait_for_function("() => parseInt(document.querySelector('.ck-count').textContent) > 3")
    explorer.page.mouse.click(*place(explorer, 1.0, 50))
    explorer.settle()
    rests = explorer.kernel("motion.frame")
    assert 40 < rests < 70 and not explorer.kernel("viewer.playing")
    assert explorer.page.locator(".ck-count").inner_text() == f"{rests + 1} / 101"
    assert explorer.page.locator(".ck-play").inner_text() == "play"
    assert explorer.notebook.errors == []


@pytest.mark.parametrize("theme", ["Dark", "Light"])
def test_two_plots_keep_their_names_apart_and_axe_finds_nothing(lab, open_page, theme):
    if not AXE.is_file():
        (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)("axe-core is not installed")
    page = open_page()
    explorer = open_one(lab, page, "path", BOTH, f"both_{theme}")
    darken(explorer, theme)
    for fold in page.page.locator(".ck-figure summary").all():
        fold.click()
    names = page.page.eval_on_selector_all(".ck-plot svg [id]", "all => all.map((one) => one.id)")
    assert len(names) > 20 and len(set(names)) == len(names)
    used = page.page.eval_on_selector_all(
        ".ck-plot svg use", "all => all.map((u) => u.getAttribute('xlink:href'))"
    )
    assert used and {name.removeprefix("#") for name in used} <= set(names)
    page.page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.page.evaluate(
        """async () => (await axe.run({ include: [[".ck-panel"]] }, { resultTypes: ["violations"] }))
                         .violations.map((one) => [one.id, one.nodes[0].html])"""
    )
    assert found == []
