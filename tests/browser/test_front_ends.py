"""One explorer each where most students are not: Notebook 7, Firefox, WebKit (Safari's engine), Voila."""

import contextlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from coursekit import robots
from coursekit.classroom.lab import private_folders
from tests.browser.drivers import Firefox, WebKit
from tests.browser.explorer import IMPORT, SHOW
from tests.browser.lab import Notebook, Server, free_port
from tests.needs import needed

pytestmark = pytest.mark.browser

ORANGE = """() => {
    const canvas = document.querySelector(".ck-viewer canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [red, green, blue] = data.slice(i, i + 3);
      count += red > 150 && green < 0.75 * red && blue < 0.5 * red;
    }
    return count / (data.length / 4);
}"""
SAID = "(words) => document.querySelector('.ck-control .ck-text').innerText.includes(words)"
DRAWN_ANEW = "(old) => document.querySelector('.ck-viewer canvas').toDataURL() !== old"


@contextlib.contextmanager
def chromium(request, folder):
    context = request.getfixturevalue("browser").new_context(viewport={"width": 1280, "height": 900})
    yield context.new_page()
    context.close()


def assert_a_slider_moves_the_arm_and_the_words(notebook):
    """Ten degrees more at the first: the page moves the arm, the kernel writes the words; gives theta."""
    page, kr6 = notebook.page, robots.kuka_kr6()
    assert page.evaluate(ORANGE) > 0.01  # the arm is in the picture
    before = notebook.pixels()
    page.focus("[role=slider]")
    page.keyboard.press("PageUp")
    theta = kr6.home + np.radians([10, 0, 0, 0, 0, 0])
    tool = kr6.fk(theta)
    np.testing.assert_allclose(notebook.wait_transform("/ck/robot/6/tool", tool), tool, atol=1e-9)
    page.wait_for_function(SAID, arg=f"x = {1000 * tool[0, 3]:9.3f}", timeout=30_000)
    page.wait_for_function(DRAWN_ANEW, arg=before, timeout=30_000)
    assert page.evaluate(ORANGE) > 0.01
    return theta


@pytest.mark.parametrize(
    ("where", "driver"),
    [("notebooks", None), ("lab/tree", Firefox), ("lab/tree", WebKit)],
    ids=["Notebook 7", "Firefox", "WebKit"],
)
def test_a_slider_moves_the_arm_and_the_words(where, driver, lab, request, tmp_path):
    opened = contextlib.closing(driver(tmp_path)) if driver else chromium(request, tmp_path)
    with opened as page:
        notebook = Notebook(lab, page)
        name = f"{driver.__name__ if driver else 'seven'}.ipynb"
        notebook.open(lab.write(name, IMPORT, SHOW), where)
        others = list(notebook.errors)  # of the page itself, before anything of the course ran in it
        notebook.run_all()
        notebook.wait_view()
        theta = assert_a_slider_moves_the_arm_and_the_words(notebook)
        notebook.settle()
        np.testing.assert_allclose(notebook.kernel("panel.values['theta'].tolist()"), theta, atol=1e-9)
        if folder := os.environ.get("COURSEKIT_SCREENSHOTS"):
            notebook.screenshot(Path(folder) / f"{name}.png")
        assert notebook.errors == others
        assert not driver or page.errors() == []


def test_in_voila_a_slider_moves_the_arm_and_the_words(lab, request, tmp_path):
    needed("voila")
    url = f"http://127.0.0.1:{free_port()}"
    command = [sys.executable, "-m", "voila", str(lab.notebooks / lab.write("voila.ipynb", IMPORT, SHOW))]
    command += ["--no-browser", "--Voila.ip=127.0.0.1", f"--port={url.rpartition(':')[2]}"]
    # not asked for the page itself until a person does: each time it is, all cells run
    server = Server("voila", f"{url}/voila/static/voila.js", command, tmp_path, private_folders(tmp_path))
    with contextlib.closing(server), chromium(request, tmp_path) as page:
        thrown = []
        page.on("pageerror", lambda error: thrown.append(str(error)))
        notebook = Notebook(lab, page)
        page.goto(url, wait_until="domcontentloaded", timeout=60_000)
        notebook.wait_view()
        assert_a_slider_moves_the_arm_and_the_words(notebook)
        assert thrown == []
