"""Who can see and use an explorer: on narrow screens, in the dark, by keys, by a screen reader."""

import os
from pathlib import Path

import numpy as np
import pytest

from coursekit import lie, robots
from tests.browser.explorer import Explorer

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
AXE = Path(__file__).resolve().parents[2] / ".venv/proxy/node_modules/axe-core/axe.min.js"
IMPORT = "import numpy as np\nfrom coursekit import lie, robots, view"
MINE = """
def fk_poe(S, M, theta):
    T = M
    for screw, angle in zip(S.T, theta):  # the first joint last
        T = lie.exp6(screw * angle) @ T
    return T
view.explore(robots.kuka_kr6(), mine=fk_poe)"""
SIZES = ((1366, 768), (900, 900), (412, 900))
IN_SIGHT = """async (handle) => {
    handle.focus();
    await new Promise((done) => setTimeout(done, 300));
    const pane = document.querySelector(".jp-WindowedPanel-outer").getBoundingClientRect();
    const inside = (box) => box.width > 0 && box.top >= pane.top - 1 && box.bottom <= pane.bottom + 1;
    const column = handle.closest(".ck-column").getBoundingClientRect(), box = handle.getBoundingClientRect();
    return inside(document.querySelector(".ck-viewer").getBoundingClientRect())
           && box.top >= column.top - 1 && box.bottom <= column.bottom + 1 && inside(box);
}"""
BELOW = """() => {
    const place = (one) => document.querySelector(one).getBoundingClientRect();
    const view = place(".ck-viewer"), map = place(".ck-plot");
    return [map.left - view.left, map.top - view.bottom];
}"""
CONTRASTS = """() => {
    const parse = (text) => text.match(/[\\d.]+/g).map(Number);
    const light = ([r, g, b]) => [0.2126 * r, 0.7152 * g, 0.0722 * b].map((v, i) => {
        const c = v / [0.2126, 0.7152, 0.0722][i] / 255;
        return [0.2126, 0.7152, 0.0722][i] * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    }).reduce((a, b) => a + b);
    const arm = [240, 122, 43];
    return [...document.querySelectorAll(".ck-label")].map((label) => {
        const style = getComputedStyle(label), [r, g, b, a = 1] = parse(style.backgroundColor);
        const behind = [r, g, b].map((v, i) => a * v + (1 - a) * arm[i]);
        const [high, low] = [light(parse(style.color)), light(behind)].sort((x, y) => y - x);
        return [label.className, (high + 0.05) / (low + 0.05)];
    });
}"""
SMALL = """() => [...document.querySelectorAll(".ck-panel :is(button, input, select, [tabindex='0'])")]
    .map((one) => (one.closest("label") || one).getBoundingClientRect())
    .filter((box) => box.width > 0 && (box.width < 24 || box.height < 24)).length"""


# What has the focus, if something that scrolls cuts off its ring; "" if nothing does; None beyond the panel.
CUT_OFF = """() => {
    const one = document.activeElement, box = one.getBoundingClientRect(), style = getComputedStyle(one);
    const ring = parseFloat(style.outlineWidth) + parseFloat(style.outlineOffset);
    if (!one.closest(".ck-panel")) return null;
    if (style.outlineStyle === "none") return `no ring: ${one.outerHTML}`;
    for (let o = one.parentElement; o !== document.body; o = o.parentElement) {
        const clip = o.getBoundingClientRect();
        if (getComputedStyle(o).overflowY !== "visible"
            && (box.top - ring < clip.top - 0.5 || box.left - ring < clip.left - 0.5
                || box.right + ring > clip.right + 0.5 || box.bottom + ring > clip.bottom + 0.5)) {
            return `${o.className}: ${one.outerHTML}`;
        }
    }
    return "";
}"""


@pytest.fixture(scope="module")
def opened(lab, open_page):
    """The explorer of singularities, in the light; a test that changes the theme puts it back."""
    notebook = open_page(viewport={"width": 1366, "height": 768})
    notebook.open(lab.write("sight.ipynb", IMPORT, "view.explore_singularities(robots.kuka_kr6())"))
    notebook.run_all()
    notebook.wait_view()
    return Explorer(notebook, "singularities", KR6)


def darken(explorer, theme):
    explorer.notebook.command("apputils:change-theme", theme=f"JupyterLab {theme}")
    explorer.page.wait_for_function(
        f"() => document.body.dataset.jpThemeLight === '{str(theme == 'Light').lower()}'"
    )
    explorer.settle()


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_the_picture_and_the_control_that_is_moved_are_in_sight_together(opened, size):
    opened.page.set_viewport_size({"width": size[0], "height": size[1]})
    opened.notebook.command("application:toggle-left-area") if size[0] < 800 else None
    opened.page.wait_for_timeout(500)
    opened.page.evaluate("() => document.querySelector('.ck-panel').scrollIntoView({ block: 'start' })")
    sliders = opened.page.locator(".ck-column [role=slider]")
    for k in range(6):
        assert sliders.nth(k).evaluate(IN_SIGHT), f"slider {k + 1} at {size}"
    right, below = opened.page.evaluate(BELOW)  # the map: beside the words where the controls stand beside
    assert size[0] < 1000 or (-2 < right < 10 and 0 <= below < 10)
    opened.notebook.command("application:toggle-left-area") if size[0] < 800 else None
    opened.page.set_viewport_size({"width": 1366, "height": 768})


# Labels that the picture cuts off, or that lie over its buttons, once these stand where a label was.
HIDDEN = """async () => {
    const pane = document.querySelector(".ck-pane").getBoundingClientRect();
    const labels = () => [...document.querySelectorAll(".ck-label:not(.tick)")]
        .map((one) => [one, one.getBoundingClientRect()]).filter(([, box]) => box.width);
    const cut = labels().filter(([, box]) => box.left < pane.left || box.right > pane.right
        || box.top < pane.top || box.bottom > pane.bottom);
    const buttons = document.querySelector(".ck-views"), [, there] = labels()[0];
    buttons.style.left = `${there.left - pane.left}px`;
    buttons.style.top = `${there.top - pane.top}px`;
    document.querySelector(".ck-viewer").coursekit.stage.moved();
    await new Promise((done) => setTimeout(done, 1000));
    const place = buttons.getBoundingClientRect();
    const over = labels().filter(([, box]) => box.right > place.left && box.left < place.right
        && box.bottom > place.top && box.top < place.bottom);
    buttons.removeAttribute("style");
    return [...cut, ...over].map(([one]) => one.textContent);
}"""


def test_no_label_of_a_narrow_picture_is_cut_off_or_under_its_buttons(opened):
    opened.notebook.command("application:toggle-left-area")
    for height in (1500, 900):  # of a high picture more is beside it
        opened.page.set_viewport_size({"width": 412, "height": height})
        opened.page.wait_for_timeout(500)
        opened.notebook.rest()
        assert opened.page.evaluate(HIDDEN) == [], height
    opened.notebook.command("application:toggle-left-area")
    opened.page.set_viewport_size({"width": 1366, "height": 768})


def test_tracks_begin_and_end_below_each_other(opened):
    boxes = opened.page.eval_on_selector_all(
        ".ck-column .ck-range", "all => all.map((one) => [one.getBoundingClientRect().left, one.clientWidth])"
    )
    assert len(boxes) == 6 and np.ptp(boxes, axis=0).max() < 1


# Where a line of words begins: [left, top, right], and where the picture and the controls end.
LINES = """() => {
    const rows = [], range = document.createRange();
    for (const words of document.querySelectorAll(".ck-top > .ck-control")) {
        const letters = document.createTreeWalker(words, NodeFilter.SHOW_TEXT);
        while (letters.nextNode()) {
            range.selectNodeContents(letters.currentNode);
            rows.push(...range.getClientRects());
        }
    }
    const place = (which) => document.querySelector(which).getBoundingClientRect();
    const [scene, column] = [place(".ck-viewer"), place(".ck-column")];
    return [rows.map((box) => [box.left, box.top, box.right]), [scene.left, scene.bottom], column.bottom];
}"""


def test_words_fill_the_room_under_the_controls(opened):
    opened.page.wait_for_timeout(500)  # the map is drawn anew for the wide page, and the words with it
    opened.settle()
    said = opened.words() + 30 * "\n." + "\n" + 30 * "long "
    opened.kernel(f"line.__setattr__('value', {said!r})")
    opened.page.wait_for_function(
        "() => document.querySelector('.ck-control .ck-text').innerText.includes('long')"
    )
    opened.page.locator(".ck-viewer").scroll_into_view_if_needed()
    lines, (left, bottom), controls = opened.page.evaluate(LINES)
    beside = [right for _, top, right in lines if top < bottom]
    assert len(beside) >= 3 and max(beside) < left - 5, "beside the picture, and not under it"
    assert min(top for _, top, _ in lines) >= controls - 1
    reached = "(at) => Boolean(document.elementFromPoint(...at)?.closest('.ck-scene'))"
    assert opened.page.evaluate(reached, [left + 9, bottom - 9]), "no words lie over the picture"
    assert max(right for *_, right in lines) > left, "below it they have all of the width"
    heights = opened.page.eval_on_selector_all(".ck-whole", "all => all.map((one) => one.offsetHeight)")
    assert heights and max(heights) < 25, "every vector stands on one line"
    opened.kernel("refresh()")
    opened.page.wait_for_function("() => document.querySelector('.ck-control .ck-text').offsetHeight < 300")


def test_fewer_words_pull_nothing_up_before_they_rest(opened):
    height = """() => {
        const words = document.querySelector(".ck-control .ck-text"), heights = [words.offsetHeight];
        window.heights = heights;
        new MutationObserver(() => heights.push(words.offsetHeight)).observe(words, { childList: true });
    }"""
    opened.page.evaluate(height)
    said = [opened.words() + 5 * "\na line more", "a line"]
    opened.kernel(f"line.__setattr__('value', {said[0]!r})")
    opened.kernel(f"line.__setattr__('value', {said[1]!r})")
    opened.page.wait_for_function("() => window.heights.length === 3")
    before, more, fewer = opened.page.evaluate("() => window.heights")
    assert before < more == fewer
    opened.page.wait_for_function(
        "(most) => document.querySelector('.ck-control .ck-text').offsetHeight < most", arg=before
    )
    opened.kernel("refresh()")


def test_everything_that_can_be_pressed_is_large_enough(opened):
    assert opened.page.evaluate(SMALL) == 0


def test_the_ring_of_the_focus_is_not_cut_off(opened):
    opened.page.locator("[role=slider]").first.focus()
    cut = []
    for _ in range(80):
        found = opened.page.evaluate(CUT_OFF)
        if found is None:
            break
        cut += [found] if found else []
        opened.page.keyboard.press("Tab")
    assert found is None and cut == []


def test_the_map_is_walked_by_arrow_keys(opened):
    before = opened.values()
    opened.page.get_by_label("arrow keys move the arm on this map", exact=False).focus()
    for key in ("ArrowRight", "ArrowUp", "ArrowUp", "Shift+ArrowLeft"):
        opened.page.keyboard.press(key)
        opened.settle()
    np.testing.assert_allclose(np.degrees(opened.values() - before), [0, 4, 10, 0, 0, 0], atol=1e-9)
    opened.assert_arm_stands_at(opened.values())


@pytest.mark.parametrize("theme", ["Dark", "Light"])
def test_labels_can_be_read_over_the_arm(opened, theme):
    darken(opened, theme)
    contrasts = opened.page.evaluate(CONTRASTS)
    assert len(contrasts) > 3 and min(value for _, value in contrasts) >= 4.5, contrasts


@pytest.mark.parametrize("theme", ["Dark", "Light"])
def test_axe_finds_nothing(opened, theme):
    if not AXE.is_file():
        (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)(
            "axe-core is not installed (.ci/run)"
        )
    darken(opened, theme)
    opened.page.evaluate(AXE.read_text(encoding="utf-8"))
    found = opened.page.evaluate(
        """async () => (await axe.run({ include: [[".ck-panel"]] }, { resultTypes: ["violations"] }))
                         .violations.map((one) => [one.id, one.nodes[0].html])"""
    )
    assert found == []


# Whether a handle that stands where a button over the picture is can be taken hold of.
ON_TOP = """() => {
    const place = (which) => document.querySelector(which).getBoundingClientRect();
    const [button, pane] = [place(".ck-views button"), place(".ck-pane")];
    const handle = document.querySelector(".ck-handle");
    handle.style.transform = `translate(${button.left - pane.left}px, ${button.top - pane.top}px)`;
    return document.elementFromPoint(button.left + 12, button.top + 12) === handle;
}"""
# Letters of the plot, once it is drawn for the room that there is.
LETTERS = """() => {
    const [plot, text] = [".ck-plot", ".ck-plot svg"].map((which) => document.querySelector(which));
    const scale = plot.clientWidth / text.viewBox.baseVal.width;
    const all = [...text.querySelectorAll("text")];
    const sizes = all.map((one) => parseFloat(getComputedStyle(one).fontSize));
    return all.length > 5 && scale * Math.min(...sizes) >= 11;
}"""


def test_on_a_narrow_screen_the_small_figures_stand_below_the_picture_and_above_the_controls(lab, open_page):
    notebook = open_page(viewport={"width": 412, "height": 900})
    notebook.open(lab.write("narrow.ipynb", IMPORT, "view.explore_inverse()"))
    notebook.command("application:toggle-left-area")
    notebook.run_all()
    notebook.wait_view()
    page = notebook.page
    page.wait_for_function(LETTERS)
    page.evaluate("() => document.querySelector('.ck-panel').scrollIntoView({ block: 'start' })")
    page.wait_for_timeout(500)
    outer = page.locator(".jp-WindowedPanel-outer").bounding_box()
    tops = [outer["y"] - 1]
    for part in (".ck-viewer", ".ck-figures", ".ck-column"):
        box = page.locator(part).bounding_box()
        tops += [box["y"], box["y"] + box["height"]]
    assert page.evaluate(ON_TOP), "a handle, and not the button under it"
    assert tops == sorted(tops) and tops[-1] <= outer["y"] + outer["height"]
    last = page.locator(".ck-one").last
    last.focus()  # the row scrolls to it
    box = last.bounding_box()
    assert outer["x"] <= box["x"] and box["x"] + box["width"] <= outer["x"] + outer["width"]


def test_yours_follows_the_sliders(lab, open_page):
    notebook = open_page()
    notebook.open(lab.write("mine.ipynb", IMPORT, MINE))
    notebook.run_all()
    notebook.wait_view()
    explorer = Explorer(notebook, "conventions", KR6)
    for label, keys in (("θ2", ["PageUp"] * 3), ("θ4", ["PageDown"] * 2)):
        explorer.slide(label, keys)
        theta = explorer.values()
        explorer.assert_arm_stands_at(theta)
        turned = np.eye(4)
        for screw, angle in zip(KR6.S.T, theta, strict=True):
            turned = lie.exp6(screw * angle) @ turned
        found = notebook.wait_transform("/ck/yours/fk_poe/arm/6", turned)
        np.testing.assert_allclose(found, turned, atol=1e-9)
        assert "is the first that is off, by " in explorer.words()
    assert notebook.errors == []
