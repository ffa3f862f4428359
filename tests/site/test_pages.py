"""The pages of the site: what they hold, and what a reader sees and moves without a kernel."""

import html
import inspect
import json
import re

import numpy as np
import pytest

import coursekit
from coursekit import robots, site
from coursekit.classroom.author import notebook
from coursekit.classroom.course import Course, the_course
from coursekit.site import notices, reference, shown
from tests import needs
from tests.browser.test_kinematics import link
from tests.classroom import leaks
from tests.classroom.small import COURSE
from tests.site.server import Visit
from tests.unpacked import unpacked

NOTEBOOKS = [the_course().notebook(unit) for unit in the_course().units]


def text_of(path):
    return html.unescape(re.sub(r"<[^>]*>", "", path.read_text("utf-8")))


def student_cells(path):
    return notebook.student_version(notebook.read(path))["cells"]


# -- what lies in the folder


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_cell_that_students_get_is_on_the_page(pages, path):
    page = (pages / f"{path.stem}.html").read_text("utf-8")
    shown_text = text_of(pages / f"{path.stem}.html")
    for cell in student_cells(path):
        assert f'id="{cell["id"]}"' in page
        if cell["cell_type"] == "code":
            assert cell["source"].strip() in shown_text


def test_no_answer_lies_anywhere(pages):
    texts = {
        str(path.relative_to(pages)): unpacked(path.read_text("utf-8"))
        for path in pages.rglob("*")
        if path.suffix in (".html", ".js", ".css", ".txt", ".json") and "mathjax" not in path.parts
    }
    assert len(texts) > 15
    assert leaks.found(the_course(), texts) == {}


def test_every_public_name_has_its_place(pages):
    for name in coursekit.__all__:
        thing = getattr(coursekit, name)
        if inspect.ismodule(thing):
            text = text_of(pages / f"reference_{name}.html")
            for one, what in reference.offered(thing):
                assert one in text
                begins = (inspect.getdoc(what) or "").replace("`", "").split()[:4]
                assert " ".join(begins) in " ".join(text.split())
    assert 'class="gp"' in (pages / "reference_lie.html").read_text("utf-8")  # examples, in colour
    ik = (pages / "reference_ik.html").read_text("utf-8")
    assert "search(robot, T" in ik and "&lt;function" not in ik


def test_the_index_names_every_notebook_with_its_goals_and_minutes(pages):
    text = text_of(pages / "index.html")
    for path in NOTEBOOKS:
        first, second = (cell["source"] for cell in notebook.read(path)["cells"][:2])
        assert re.search("^# (.+)", first)[1] in text
        assert re.search(r"(\d+ minutes)", first)[1] in text
        assert re.search(r"^- ([^$`\[\n]+)", first + second, re.M)[1].rstrip(";.") in text


def test_a_cell_that_waits_for_an_exercise_says_so(pages):
    page = (pages / "03_inverse_kinematics.html").read_text("utf-8")
    assert "Traceback" not in page
    assert "… wrist_centre: not written yet" in page


def test_every_explorer_moves(pages):
    for path in NOTEBOOKS:
        frames = re.findall(r'data-src="([^"]+)"', (pages / f"{path.stem}.html").read_text("utf-8"))
        assert frames, path.stem
        assert all(100_000 < (pages / frame).stat().st_size < 300_000 for frame in frames)


def test_what_a_browser_keeps_of_the_pages_is_light(pages):
    """It comes with the first page, beside what "Run it here" loads."""
    kept = json.loads(re.search(r"PAGES = (.*);", (pages / "offline.js").read_text("utf-8"))[1])
    assert sum((pages / name).stat().st_size for name in kept if name != "./") < 6_000_000


def test_licences_lie_beside_what_they_are_for(pages):
    listed = (pages / "licences" / "README.txt").read_text()
    for name in notices.OF_PAGES:
        assert name in listed
    for name in re.findall(r"^    (.+)$", listed, re.M):
        assert (pages / "licences" / name).stat().st_size > 50
    assert "three.js" in "".join(path.read_text() for path in (pages / "licences").glob("meshcat*"))
    if (pages / "run").is_dir():
        assert "Mozilla Public License 2.0" in listed
        assert "https://github.com/pyodide/pyodide/tree/0.27.7" in listed


def test_what_comes_without_a_licence_is_refused(tmp_path):
    with pytest.raises(ValueError, match="not installed"):
        notices.write(tmp_path, {"no-such-package": "nothing"})


# -- building it


def test_it_never_overwrites(tmp_path):
    with pytest.raises(ValueError, match="exists already"):
        site.write(tmp_path, COURSE)


def test_a_notebook_that_fails_by_itself_is_told_and_nothing_is_written(tmp_path):
    needs.what_builds_the_site()
    solved = notebook.read(COURSE.notebook("nb01"))
    broken = {"cell_type": "code", "id": "broken", "metadata": {}, "outputs": [], "execution_count": None}
    solved["cells"].append({**broken, "source": "1 / 0"})
    (tmp_path / "notebooks").mkdir()
    notebook.write(tmp_path / "notebooks" / "01_arm.ipynb", solved)
    with pytest.raises(ValueError, match=r"01_arm.ipynb, cell broken: ZeroDivisionError"):
        site.write(tmp_path / "out", Course(tmp_path / "notebooks", COURSE.classroom))
    assert not (tmp_path / "out").exists()


def test_what_waits_is_told_from_what_fails(tmp_path):
    path = tmp_path / "one.ipynb"
    source = ["def f():\n    raise NotImplementedError", "x = f()", "x + 1", "print('after')"]
    cell = {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": None}
    cells = [{**cell, "id": f"c{n}", "source": text} for n, text in enumerate(source)]
    document = {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    path.write_text(json.dumps(document))
    run = shown.run(path, tmp_path)
    assert ["waits" in one.metadata.get("tags", []) for one in run.cells] == [False, True, True, False]
    assert run.cells[3].outputs[0].text == "after\n"


# -- in a browser, every other host out of reach


@pytest.mark.browser
def test_an_explorer_follows_its_slider_without_a_kernel(browser, served):
    with Visit(browser, served.url) as visit:
        page = visit.open("01_dh_vs_poe.html")
        page.locator(".explorer").first.scroll_into_view_if_needed()
        page.locator(".explorer iframe").first.content_frame.locator("canvas").wait_for(timeout=120_000)
        inner = next(one for one in page.frames if "/explorers/" in one.url)
        inner.wait_for_function(
            "() => document.querySelector('.ck-viewer').coursekit?.stage.frames > 0", timeout=120_000
        )
        inner.press("[role=slider]", "PageUp")
        inner.wait_for_function("() => document.querySelector('#words').textContent.includes('(10.0, -90.0')")
        kr6 = robots.kuka_kr6()
        theta = kr6.home + np.radians([10, 0, 0, 0, 0, 0])
        expected = kr6.displacements(theta)[-1]
        for _ in range(100):  # the words come at once, the arm with the next frame
            if np.allclose(link(inner, "/ck/robot/6"), expected, rtol=0, atol=1e-9):
                break
            page.wait_for_timeout(200)
        np.testing.assert_allclose(link(inner, "/ck/robot/6"), expected, atol=1e-12)
        assert (visit.asked, visit.errors) == ([], [])


@pytest.mark.browser
def test_formulas_are_set_and_nothing_is_asked_of_another_host(browser, served):
    with Visit(browser, served.url) as visit:
        page = visit.open("04_singularities.html")
        page.wait_for_function("() => document.querySelectorAll('.MathJax').length > 60", timeout=60_000)
        page.wait_for_function("() => !document.querySelector('.MathJax_Processing, .MathJax_Processed')")
        assert page.locator(".MathJax_Error, .merror").count() == 0
        assert "$" not in page.inner_text("#title") + page.inner_text("#predict-1")
        assert (visit.asked, visit.errors) == ([], [])


# What must be scrolled sideways to be read, but for columns of numbers.
SCROLLS = """(which) => [...document.querySelectorAll(which)]
  .filter((box) => box.scrollWidth > box.clientWidth && !box.querySelector(".columns"))
  .map((box) => box.innerText)"""


@pytest.mark.browser
@pytest.mark.parametrize("name", ["index.html", "01_dh_vs_poe.html", "05_jacobian_methods.html"])
def test_on_a_phone_nothing_is_wider_than_the_screen(browser, served, name):
    with Visit(browser, served.url, viewport={"width": 412, "height": 900}) as visit:
        page = visit.open(name)
        page.wait_for_function("() => document.querySelectorAll('.MathJax').length > 1", timeout=60_000)
        page.wait_for_timeout(1000)
        assert page.evaluate("document.documentElement.scrollWidth") <= 412
        assert page.evaluate(SCROLLS, ".output") == []  # printed sentences are wrapped
        page.set_viewport_size({"width": 1366, "height": 768})
        assert page.evaluate(SCROLLS, ".highlight pre, .output") == []  # and code is in sight


@pytest.mark.browser
def test_looks_are_kept(browser, served):
    colour = "getComputedStyle(document.body).backgroundColor"
    with Visit(browser, served.url, color_scheme="light") as visit:
        page = visit.open("02_msb_derivation.html")
        assert page.evaluate(colour) == "rgb(255, 255, 255)"
        page.click("#looks summary")
        page.select_option("[name=theme]", "dark")
        page.select_option("[name=size]", "1.5")
        page = visit.open("03_inverse_kinematics.html")
        assert page.evaluate(colour) == "rgb(22, 24, 28)"
        assert page.evaluate("getComputedStyle(document.documentElement).fontSize") == "25.5px"
        page.locator(".explorer").first.scroll_into_view_if_needed()
        inner = page.locator(".explorer iframe").first.content_frame
        inner.locator("[data-jp-theme-light=false]").wait_for(timeout=60_000)
        page.click("#looks summary")
        page.click("#looks [type=reset]")
        assert page.evaluate(colour) == "rgb(255, 255, 255)"
        inner.locator("[data-jp-theme-light=true]").wait_for()


@pytest.mark.browser
def test_pages_read_before_can_be_read_without_a_network(browser, served):
    with Visit(browser, served.url) as visit:
        visit.open("index.html")
        visit.page.evaluate("navigator.serviceWorker.ready.then(() => true)")
        visit.open("04_singularities.html")
        visit.page.wait_for_function("() => document.querySelector('.MathJax')", timeout=60_000)
        visit.context.set_offline(True)
        page = visit.open("02_msb_derivation.html")
        assert "M, S and B" in page.inner_text("h1")
        page.wait_for_function("() => document.querySelector('.MathJax')", timeout=60_000)
        page.locator(".explorer").first.scroll_into_view_if_needed()
        page.locator(".explorer iframe").first.content_frame.locator("[role=slider]").first.wait_for(
            timeout=60_000
        )


@pytest.mark.browser
def test_opened_from_a_folder_it_moves(browser, pages):
    context = browser.new_context(offline=True)
    page = context.new_page()
    page.goto((pages / "02_msb_derivation.html").as_uri())
    page.wait_for_function("() => document.querySelector('.MathJax')", timeout=60_000)
    page.locator(".explorer").first.scroll_into_view_if_needed()
    frame = page.locator(".explorer iframe").first.content_frame
    frame.locator("[role=slider]").first.press("PageUp", timeout=60_000)
    frame.locator("#words").get_by_text("10.0").wait_for()
    context.close()


@pytest.mark.browser
def test_on_paper_an_explorer_is_a_picture(browser, served):
    with Visit(browser, served.url) as visit:
        page = visit.open("01_dh_vs_poe.html")
        page.emulate_media(media="print")
        assert page.locator(".explorer img").first.is_visible()
        assert not page.locator(".explorer iframe").first.is_visible()
        assert not page.locator("header").is_visible()
