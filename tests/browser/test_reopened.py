"""A saved notebook of yesterday: its explorers show their picture, and move although no kernel has them."""

import io

import nbformat
import numpy as np
import pytest
from PIL import Image

from coursekit import robots, view
from coursekit.view.reopened import Exporter
from tests.browser.explorer import IMPORT
from tests.browser.test_explorers import dark_theme
from tests.browser.test_kinematics import link

pytestmark = pytest.mark.browser

KR6 = robots.kuka_kr6()
SHUT_DOWN = "() => window.jupyterapp.shell.currentWidget.context.sessionContext.shutdown()"

FIGURES = """import matplotlib.pyplot as plt
from coursekit.view import figures
figures.blank((3, 2)).set_xlabel("width")
figures.show()
plt.figure(figsize=(1, 1), facecolor="#004000").subplots()  # made for the dark
plt.show()"""


def corner(picture):
    """Color of a picture's first pixel, as the page shows it."""
    picture.scroll_into_view_if_needed()
    shown = Image.open(io.BytesIO(picture.screenshot())).convert("RGB")
    return np.array(shown.getpixel((3, 3)))


def the_pictures_have_words_and_the_pages_ground(notebook):
    page = notebook.page
    own, other = (page.locator(".jp-OutputArea .jp-RenderedImage img").nth(k) for k in range(2))
    page.evaluate("() => window.jupyterapp.shell.currentWidget.content.scrollToItem(2, 'start')")
    page.wait_for_function("() => document.querySelectorAll('.jp-RenderedImage img[alt]').length === 2")
    assert own.get_attribute("alt").startswith("y, 0 to 1, over width, 0 to 1")
    assert other.get_attribute("alt") == "<Figure size 100x100 with 1 Axes>"
    assert tuple(corner(own)) == (255, 255, 255)
    with dark_theme(notebook):
        paper = page.locator(".jp-Notebook").first.evaluate("e => getComputedStyle(e).backgroundColor")
        ground = [int(number) for number in paper.strip("rgb()").split(",")]
        looks = 0
        while abs(corner(own) - ground).max() > 2 and looks < 20:  # a new theme takes a while
            page.wait_for_timeout(200)
            looks += 1
        assert abs(corner(own) - ground).max() <= 2
        np.testing.assert_array_equal(corner(other), [0, 64, 0])
        page.frame_locator(".ck-saved iframe").locator("body[data-jp-theme-light=false]").wait_for()


def moves(page):
    """The page in the output follows its slider."""
    frame = page.locator(".ck-saved iframe").first.content_frame
    frame.locator("[role=slider]").first.press("PageUp", timeout=60_000)
    page.wait_for_timeout(500)
    inner = next(frame for frame in page.frames if frame.url.startswith("blob:"))
    inner.wait_for_function("() => document.querySelector('.ck-viewer')?.coursekit?.stage.frames > 0")
    theta = KR6.home + np.radians([10, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(link(inner, "/ck/robot/6"), KR6.displacements(theta)[-1], atol=1e-12)
    assert "joints (10.0, -90.0" in inner.inner_text("#words")
    needed = inner.evaluate("() => document.querySelector('main').scrollHeight")
    page.wait_for_timeout(300)
    assert 0 <= page.locator(".ck-saved iframe").first.bounding_box()["height"] - needed <= 4
    assert "Run the cell" in page.inner_text(".ck-saved p")


def test_the_next_day_its_kernel_gone(notebook, lab):
    notebook.open(lab.write("yesterday.ipynb", IMPORT, "view.explore(robots.kuka_kr6())", FIGURES))
    notebook.run_all()
    notebook.wait_view()
    notebook.save()
    notebook.page.evaluate(SHUT_DOWN)
    notebook.reload()
    page = notebook.page
    page.wait_for_selector(".ck-saved img, .ck-saved iframe")
    assert not page.get_by_text("model not found").first.is_visible()
    moves(page)
    the_pictures_have_words_and_the_pages_ground(notebook)
    notebook.run_all()  # and the cell brings all of it back
    notebook.wait_view()
    assert page.locator(".ck-saved").count() == 0


def test_not_trusted_because_only_some_cells_were_run(notebook, lab):
    name = lab.write("sent.ipynb", IMPORT, "view.explore(robots.kuka_kr6())", "1 + 1")
    notebook.open(name)
    notebook.command("notebook:run-all-above")
    notebook.run_all()
    notebook.wait_view()
    notebook.save()
    stored = nbformat.read(lab.notebooks / name, as_version=4)
    nbformat.write(stored, lab.notebooks / "received.ipynb")  # by mail, say: nobody has trusted this file
    notebook.open("received.ipynb")
    notebook.page.wait_for_selector(".ck-saved img, .ck-saved iframe")
    moves(notebook.page)


def test_an_arm_of_ones_own_keeps_its_picture(notebook, lab):
    own = "import dataclasses\nview.explore(dataclasses.replace(robots.kuka_kr6(), name='my arm'))"
    notebook.open(lab.write("own.ipynb", IMPORT, own))
    notebook.run_all()
    notebook.wait_view()
    notebook.save()
    notebook.page.evaluate(SHUT_DOWN)
    notebook.reload()
    notebook.page.wait_for_selector(".ck-saved img")
    notebook.page.wait_for_timeout(3000)
    assert notebook.page.locator(".ck-saved iframe").count() == 0
    assert "Run the cell" in notebook.page.inner_text(".ck-saved p")
    assert notebook.page.evaluate("() => document.querySelector('.ck-saved img').naturalWidth") == 640


def test_a_page_by_nbconvert_moves_and_is_as_high_as_it_needs(browser, tmp_path):
    panel = view.explore()
    stored = nbformat.v4.new_output("display_data", {"text/plain": repr(panel)})
    panel.close()
    cell = nbformat.v4.new_code_cell("view.explore()", outputs=[stored])
    written, _ = Exporter().from_notebook_node(nbformat.v4.new_notebook(cells=[cell]))
    (tmp_path / "page.html").write_text(written, "utf-8")
    context = browser.new_context(offline=True)
    page = context.new_page()
    page.goto((tmp_path / "page.html").as_uri())
    inner = page.locator("iframe").content_frame
    inner.locator("[role=slider]").first.press("PageUp", timeout=60_000)
    inner.get_by_text("joints (10.0, -90.0").wait_for()
    needed = inner.locator("main").evaluate("main => main.scrollHeight")
    page.wait_for_timeout(300)
    assert 0 <= page.locator("iframe").bounding_box()["height"] - needed <= 4
    context.close()
