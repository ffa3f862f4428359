"""What was lost or wrong once before an explorer: typing, keys, menus, a silent kernel, ghosts, copies."""

import numpy as np
import pytest

from coursekit import ik, robots, rotations, view
from tests.browser.explorer import IMPORT, SHOW

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
CELLS = "() => window.jupyterapp.shell.currentWidget.content.widgets.length"


@pytest.mark.parametrize(
    ("typed", "degrees"),
    [("12,5", 12.5), ("−20", -20), ("90°", 90), ("pi/3", 60), ("0.5 rad", 28.6478897565412)],
)
def test_numbers_are_read_as_people_type_them(explorer, typed, degrees):
    box = explorer.page.locator(".ck-number").first
    box.fill(typed)
    box.press("Enter")
    explorer.settle()
    assert explorer.kernel("panel.values['theta'][0]") == pytest.approx(np.radians(degrees), abs=1e-14)
    assert explorer.page.locator(".ck-hint").first.inner_text() == ""


def test_what_is_no_number_or_too_large_is_told(explorer):
    box, hint = explorer.page.locator(".ck-number").first, explorer.page.locator(".ck-hint").first
    box.fill("12.5.5")
    box.press("Enter")
    assert "“12.5.5” is no number here: write 12.5" in hint.inner_text()
    assert box.input_value() == "0"
    box.fill("999")
    box.press("Enter")
    assert hint.inner_text() == "999 is beyond the limit, 170 deg"
    explorer.settle()
    assert explorer.kernel("panel.values['theta'][0]") == pytest.approx(KR6.q_max[0], abs=1e-14)


PASTE = """([box, text]) => {
  const clipboardData = new DataTransfer();
  clipboardData.setData("text", text);
  return !box.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
}"""


def test_a_vector_pasted_fills_the_boxes_from_there_on(explorer):
    boxes, hints = explorer.page.locator(".ck-number"), explorer.page.locator(".ck-hint")
    explorer.page.evaluate(
        PASTE, [boxes.first.element_handle(), "array([ 0.1, -0.5,  0.3, 0.2, -0.1, 0.25]) rad"]
    )
    explorer.settle()
    pasted = explorer.kernel("panel.values['theta'].tolist()")
    np.testing.assert_allclose(pasted, [0.1, -0.5, 0.3, 0.2, -0.1, 0.25], rtol=1e-12)
    assert hints.all_inner_texts() == [""] * 6
    boxes.nth(3).fill("(10, 400, -30)")
    boxes.nth(3).press("Enter")
    explorer.settle()
    typed = np.degrees(explorer.kernel("panel.values['theta'][3:].tolist()"))
    np.testing.assert_allclose(typed, [10, 120, -30], rtol=1e-12)
    assert hints.nth(3).inner_text() == "3 numbers, in the units shown here"
    assert hints.nth(4).inner_text() == "400 is beyond the limit, 120 deg"
    boxes.nth(5).fill("[1, 2]")  # more than there are boxes
    boxes.nth(5).press("Enter")
    assert "is no number here" in hints.nth(5).inner_text()


def test_what_was_changed_is_put_back_gesture_by_gesture(explorer):
    """By keys at a slider, a vector at once, a hand in the picture: three times Ctrl+Z."""
    theta = "panel.values['theta'].tolist()"
    ranges, boxes = explorer.page.locator(".ck-range"), explorer.page.locator(".ck-number")
    before = [explorer.kernel(theta)]
    ranges.nth(1).press("ArrowRight")
    explorer.settle()
    before.append(explorer.kernel(theta))
    explorer.page.evaluate(PASTE, [boxes.first.element_handle(), "[10, -20, 30, 40, 50, 60]"])
    explorer.settle()
    before.append(explorer.kernel(theta))
    handle = explorer.page.get_by_role("button", name="move the tool")
    area = handle.bounding_box()
    explorer.page.mouse.move(area["x"] + area["width"] / 2, area["y"] + area["height"] / 2)
    explorer.page.mouse.down()
    for step in range(1, 8):
        explorer.page.mouse.move(area["x"] + 4 * step, area["y"] + 5 * step)
    explorer.page.mouse.up()
    explorer.settle()
    assert not np.allclose(explorer.kernel(theta), before[-1], atol=1e-3)
    for place in (handle, ranges.nth(2), ranges.first):
        place.press("Control+z")
        explorer.settle()
        np.testing.assert_allclose(explorer.kernel(theta), before.pop(), atol=1e-12)
    ranges.first.press("Control+z")  # there is no more
    boxes.first.fill("12")
    boxes.first.press("Control+z")  # what is being typed is the browser's own
    explorer.settle()
    assert explorer.page.evaluate(CELLS) >= 1


def test_theta_is_copied_as_numpy(explorer):
    explorer.page.evaluate(
        "() => addEventListener('copy', (event) => (window.got = event.clipboardData.getData('text/plain')))"
    )
    explorer.kernel("panel.set(theta=[0.1, -1.4, 1.55, 0, -0.5, 0])")
    explorer.settle()
    explorer.page.locator(".ck-range").nth(3).press("Control+c")
    copied = explorer.page.evaluate("() => window.got")
    np.testing.assert_allclose(
        eval(copied, {"np": np}), explorer.kernel("panel.values['theta'].tolist()"), atol=1e-12
    )
    assert explorer.page.locator(".ck-hint").nth(3).inner_text() == f"copied: {copied}"


def test_escape_takes_a_typed_number_back(explorer):
    box = explorer.page.locator(".ck-number").first
    box.focus()
    explorer.page.keyboard.type("77")
    explorer.page.keyboard.press("Escape")
    explorer.page.keyboard.press("Tab")
    explorer.settle()
    assert box.input_value() == "0" and explorer.kernel("panel.values['theta'][0]") == 0


def test_keys_on_the_buttons_of_the_view_are_not_the_notebooks(explorer):
    cells = explorer.page.evaluate(CELLS)
    explorer.page.get_by_role("button", name="side", exact=True).click()
    explorer.page.keyboard.press("d")
    explorer.page.keyboard.press("d")
    explorer.page.wait_for_timeout(300)
    assert explorer.page.evaluate(CELLS) == cells


def test_the_right_button_moves_the_picture_and_opens_no_menu(explorer):
    area, page = explorer.page.locator(".ck-pane").bounding_box(), explorer.page
    before = explorer.pixels()
    page.mouse.move(area["x"] + 200, area["y"] + 200)
    page.mouse.down(button="right")
    page.mouse.move(area["x"] + 260, area["y"] + 230, steps=5)
    page.mouse.up(button="right")
    explorer.rest()
    assert explorer.pixels() != before
    assert page.locator(".lm-Menu").count() == 0


def test_a_kernel_that_does_not_answer_is_told_and_its_answer_ends_that(notebook, lab):
    notebook.open(lab.write("silent.ipynb", IMPORT, SHOW))
    notebook.run_all()
    notebook.wait_view()
    said = notebook.page.locator(".ck-silence")
    notebook.page.locator("[role=slider]").first.press("PageUp")
    notebook.settle()
    notebook.page.wait_for_timeout(3000)
    assert said.inner_text() == "", "it has answered"
    notebook.page.evaluate(
        "() => { const n = window.jupyterapp.shell.currentWidget;"
        " n.context.sessionContext.session.kernel.requestExecute({ code: 'import time; time.sleep(8)' }); }"
    )
    notebook.page.wait_for_timeout(300)
    notebook.page.locator("[role=slider]").first.press("PageUp")
    notebook.page.wait_for_function(
        "() => /kernel does not answer/.test(document.querySelector('.ck-silence').textContent)", timeout=7000
    )
    notebook.page.wait_for_function(
        "() => document.querySelector('.ck-silence').textContent === ''", timeout=20_000
    )
    notebook.page.evaluate(
        "() => window.jupyterapp.shell.currentWidget.context.sessionContext.session.kernel.restart()"
    )
    notebook.idle()
    notebook.page.locator("[role=slider]").first.press("PageUp")
    notebook.page.wait_for_function(
        "() => /run the cell again/.test(document.querySelector('.ck-silence').textContent)", timeout=7000
    )


def test_ghosts_stand_at_their_solutions_whatever_is_drawn_anew(notebook, lab):
    notebook.open(lab.write("ghosts.ipynb", IMPORT, "panel = view.explore_inverse()\npanel"))
    notebook.run_all()
    notebook.wait_view()
    notebook.page.get_by_label("Newton's way").check()
    notebook.settle()
    notebook.page.get_by_text("Newton's guess").click()
    notebook.page.get_by_role("slider", name="guess θ1").press("PageUp")
    notebook.settle()
    pose = notebook.kernel("panel.values['pose'].tolist()")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotations.from_zyx(pose[3:]), pose[:3]
    theta = ik.analytic(KR6, T).turned
    shown = notebook.kernel("[g['path'] for g in panel.scene.ghosts]")
    assert len(shown) == 7
    for path in shown:
        expected = KR6.displacements(theta[int(path[-1])])
        np.testing.assert_allclose(notebook.transform(f"{path}/6"), expected[-1], rtol=0, atol=1e-9)
    assert notebook.errors == []


def test_a_view_that_was_closed_asks_for_no_more_pictures(open_page, lab):
    notebook = open_page()
    notebook.page.add_init_script(
        """const original = HTMLCanvasElement.prototype.getContext;
           HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
             return /webgl/.test(kind) ? null : original.call(this, kind, ...rest);
           };"""
    )
    count = "asked = []\npanel.viewer.on_msg(lambda w, c, b: asked.append(c['type']))"
    notebook.open(lab.write("closed.ipynb", IMPORT, SHOW, "panel", count))
    notebook.run_all()
    notebook.page.wait_for_function("() => document.querySelectorAll('.ck-picture').length === 2")
    notebook.page.evaluate(
        """() => { const n = window.jupyterapp.shell.currentWidget.content; n.activeCellIndex = 2;
                   return window.jupyterapp.commands.execute("notebook:clear-cell-output"); }"""
    )
    notebook.page.wait_for_timeout(1500)
    notebook.kernel("asked.clear()")
    notebook.page.locator("[role=slider]").first.press("PageUp")
    for _ in range(100):
        if notebook.kernel("asked.count('need_png')"):
            break
        notebook.page.wait_for_timeout(200)
    notebook.page.wait_for_timeout(1000)  # a second one would come by now
    assert notebook.kernel("asked.count('need_png')") == 1


def test_a_damaged_script_is_told_and_not_waited_for(browser, tmp_path):
    panel = view.explore(KR6)
    text = view.to_html(panel)
    panel.close()
    start = text.index('const BUNDLE = "') + len('const BUNDLE = "')
    file = tmp_path / "damaged.html"
    file.write_text(text[:start] + "AAAA" + text[start + 400 :], encoding="utf-8")
    page = browser.new_context(offline=True).new_page()
    page.goto(file.as_uri())
    page.wait_for_function("() => /came damaged/.test(document.querySelector('.ck-wait')?.textContent)")
    page.context.close()
