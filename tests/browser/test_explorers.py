"""The six notebooks as a student meets them: run from top to bottom, the explorer moved, played, darkened.

Each test opens the real notebook file. With COURSEKIT_SCREENSHOTS=folder every explorer leaves two pictures
there, light and dark, for someone to look at.
"""

import contextlib
import os
import re
from pathlib import Path

import nbformat
import numpy as np
import pytest

from coursekit import robots
from coursekit.view import text
from tests.browser.explorer import Explorer
from tests.browser.lab import Notebook

pytestmark = pytest.mark.browser

NOTEBOOKS = Path(__file__).resolve().parents[2] / "notebooks"
COUNT_WEBGL = """
    const original = HTMLCanvasElement.prototype.getContext;
    window.webgl = new Set();
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      if (/webgl/.test(kind)) window.webgl.add(this);
      return original.call(this, kind, ...rest);
    };"""


BANDS = """(slider) => {
    const track = slider.parentElement, all = track.querySelector(".ck-bands").getBoundingClientRect();
    const ends = (kind) => [...track.querySelectorAll(kind)].map((one) => one.getBoundingClientRect())
        .map(({ left, right }) => [(left - all.left) / all.width, (right - all.left) / all.width]);
    return { says: document.getElementById(slider.getAttribute("aria-describedby")).textContent,
             lines: ends(".ck-band:not(.ck-inside)"), bars: ends(".ck-inside") };
}"""


def bands_tell_where_the_target_is_in_reach(explorer):
    """A line and a bar under the slider of x, in words too, that move with the slider of z."""
    seen = []
    for keys in ([], ["PageDown"]):
        explorer.slide("z", keys)
        shown = explorer.page.get_by_role("slider", name="x", exact=True).evaluate(BANDS)
        slider = "_controls['pose'].sliders[0]"
        reached, inside = explorer.kernel(f"{slider}.bands")
        low, high = explorer.kernel(f"{slider}.min"), explorer.kernel(f"{slider}.max")
        assert len(reached) == 1 and inside == reached
        expected = (np.array(reached) - low) / (high - low)
        np.testing.assert_allclose(shown["lines"], expected, atol=0.005)
        np.testing.assert_allclose(shown["bars"], expected, atol=0.005)
        ends = " to ".join(f"{end:.0f}" for end in reached[0])
        assert shown["says"] == f"reachable from {ends} millimetres, inside the joint limits"
        seen.append(ends)
    assert seen[0] != seen[1]
    explorer.slide("z", ["PageUp"])


# -- what is special about each explorer: move it, and compare the page with the kinematics ----------------


def conventions(explorer):
    explorer.slide("θ2", ["PageUp", "PageUp"])
    theta = explorer.values()
    explorer.assert_arm_stands_at(theta)
    x, y, z = np.round(1000 * explorer.robot.fk(theta)[:3, 3], 3) + 0.0  # never -0.000
    lines = explorer.words().splitlines()
    assert [line.split("x =")[1] for line in lines[:3]] == [f" {x:9.3f}  y = {y:9.3f}  z = {z:9.3f} mm"] * 3
    assert float(lines[3].split(":")[1]) < 1e-14


def screws(explorer):
    explorer.choose("joint", "joint 3")
    explorer.slide("turn joint", ["PageUp"])
    explorer.assert_arm_stands_at(np.radians([0, 0, 10, 0, 0, 0]))
    assert f"column 3 of S = {text.row(explorer.robot.S[:, 2])}" in explorer.words()


def inverse(explorer):
    bands_tell_where_the_target_is_in_reach(explorer)
    explorer.slide("x", ["PageUp"])
    shown = np.array(explorer.kernel("scene.robots['robot'].theta.tolist()"))
    explorer.assert_arm_stands_at(shown)
    x, y, z = explorer.values("pose")[:3]
    np.testing.assert_allclose(explorer.robot.fk(shown)[:3, 3], [x, y, z], atol=1e-12)
    assert text.degrees(shown) in explorer.words()

    row = explorer.page.locator(".ck-table tbody tr").first
    row.get_by_role("radio").check()
    explorer.settle()
    assert "shown: front elbow-up no-flip" in explorer.words()
    np.testing.assert_allclose(
        explorer.robot.fk(explorer.kernel("scene.robots['robot'].theta.tolist()"))[:3, 3],
        [x, y, z],
        atol=1e-12,
    )

    explorer.press("show Newton's steps")
    assert explorer.pause_from(2) >= 2
    explorer.press("play the motion")
    steps = explorer.kernel("viewer.motion['frames']")
    explorer.played_to_the_end(steps)
    moved = explorer.notebook.transform(f"/ck/robot/{explorer.robot.n}") @ explorer.robot.M
    np.testing.assert_allclose(moved[:3, 3], [x, y, z], atol=1e-8)  # where Newton stops


def singularities(explorer):
    explorer.slide("θ5", ["PageDown"])
    theta = explorer.values()
    explorer.assert_arm_stands_at(theta)
    det = np.linalg.det(explorer.robot.jacobian_space(theta))
    assert f"det J = {text.number(det, 6)} m^3" in explorer.words()

    explorer.press("to the elbow")
    explorer.played_to_the_end(31)
    assert "rank 5: elbow singularity" in explorer.words()
    explorer.assert_arm_stands_at(explorer.values())

    explorer.page.locator(".ck-clickable").click(position={"x": 250, "y": 150})  # on the map
    explorer.settle()
    clicked = explorer.values()
    assert np.flatnonzero(np.abs(clicked - theta) > 1e-6).tolist() == [1, 2]
    explorer.assert_arm_stands_at(clicked)


def jacobians(explorer):
    explorer.slide("θ4", ["PageDown"])
    theta = explorer.values()
    explorer.assert_arm_stands_at(theta)
    lengths = np.linalg.svd(explorer.robot.jacobian_geometric(theta)[3:], compute_uv=False)
    assert f"linear   half axes {text.row(lengths)} m/s" in explorer.words()

    explorer.press("play damped")
    explorer.page.wait_for_selector(".ck-player:not([hidden])")
    explorer.page.locator(".ck-scrub").focus()
    explorer.page.keyboard.press("End")  # its steps take their time: to the last one at once
    explorer.settle()
    moved = explorer.notebook.transform(f"/ck/robot/{explorer.robot.n}") @ explorer.robot.M
    np.testing.assert_allclose(moved, explorer.robot.fk(explorer.robot.home), atol=1e-6)  # the frame {d}


def path(explorer):
    explorer.page.get_by_label("playing speed").select_option("0.1")
    explorer.press("play the motion")
    place = explorer.pause_from(5) - 1
    assert 4 <= place < 100
    explorer.settle()
    theta = np.array(explorer.kernel("scene.robots['robot'].theta.tolist()"))
    explorer.assert_arm_stands_at(theta)
    assert f"point {place + 1} of 101" in explorer.page.locator(".ck-text").first.inner_text()
    explorer.page.get_by_label("playing speed").select_option("1")
    explorer.press("play the motion")
    explorer.played_to_the_end(101)
    last = np.array(explorer.kernel("scene.robots['robot'].theta.tolist()"))
    explorer.assert_arm_stands_at(last)
    tool = explorer.robot.fk(last)[:3, 3]
    np.testing.assert_allclose(np.linalg.norm(tool - [0, 0, 0.5]), 0.5, atol=1e-9)  # on the sphere

    explorer.choose("points", "201")
    assert explorer.page.locator(".ck-count").inner_text() == "1 / 201"


EXPLORERS = {
    "01_dh_vs_poe": (conventions, robots.kuka_kr6),
    "02_msb_derivation": (screws, robots.kuka_kr6),
    "03_inverse_kinematics": (inverse, robots.kuka_kr6),
    "04_singularities": (singularities, robots.kuka_kr6),
    "05_jacobian_methods": (jacobians, robots.franka_panda),
    "06_path_speed": (path, robots.abb_irb1200),
}


@pytest.fixture
def notebook(lab, browser):
    context = browser.new_context(viewport={"width": 1280, "height": 1150})
    context.add_init_script(COUNT_WEBGL)
    page = context.new_page()
    page.set_default_timeout(15_000)
    yield Notebook(lab, page)
    context.close()


@pytest.mark.parametrize("name", EXPLORERS)
def test_notebook_runs_and_its_explorer_works(notebook, lab, name):
    move, robot = EXPLORERS[name]
    source = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    for cell in source.cells:
        if cell.cell_type == "code":  # whatever is seen below was made here
            cell.outputs, cell.execution_count = [], None
    cells = [k for k, cell in enumerate(source.cells) if re.search(r"^view\.explore", cell.source, re.M)]
    for k in cells[1:]:  # run, but not shown: here the first one is looked at
        source.cells[k].source = source.cells[k].source.rstrip() + ";"
    nbformat.write(source, lab.notebooks / f"{name}.ipynb")
    notebook.open(f"{name}.ipynb")
    notebook.run_all()
    assert (
        notebook.page.evaluate(
            """() => window.jupyterapp.shell.currentWidget.content.widgets
                   .flatMap((cell) => cell.model.outputs ? cell.model.outputs.toJSON() : [])
                   .filter((output) => output.output_type === "error").map((output) => output.evalue)"""
        )
        == []
    )
    notebook.page.evaluate(
        """async (k) => {
             const notebook = window.jupyterapp.shell.currentWidget.content;
             notebook.activeCellIndex = k;
             await notebook.scrollToItem(k, "start");
           }""",
        cells[0],
    )
    notebook.wait_view()
    explorer = Explorer(notebook, move.__name__, robot())
    words, pixels = explorer.words(), notebook.pixels()
    photograph(explorer, f"{name}_light")

    move(explorer)
    assert explorer.words() != words
    assert notebook.pixels() != pixels

    with dark_theme(notebook):
        explorer.settle()
        ink, paper = notebook.page.eval_on_selector(
            ".ck-text", "e => [getComputedStyle(e).color, getComputedStyle(document.body).backgroundColor]"
        )
        assert brightness(ink) - brightness(paper) > 100
        photograph(explorer, f"{name}_dark")
    for _ in range(10):  # a late layout of JupyterLab, when it is busy, may ask for a frame once more
        notebook.rest()
        before = notebook.frames()
        notebook.page.wait_for_timeout(1000)
        if notebook.frames() == before:
            break
    else:
        pytest.fail("frames are drawn although nothing moves")
    assert notebook.page.evaluate("() => window.webgl.size") == 1
    assert notebook.errors == []


@contextlib.contextmanager
def dark_theme(notebook):
    """JupyterLab in its dark theme, and light again for the next test."""
    try:
        notebook.command("apputils:change-theme", theme="JupyterLab Dark")
        notebook.page.wait_for_selector("[data-jp-theme-light=false]", state="attached")
        yield
    finally:
        notebook.command("apputils:change-theme", theme="JupyterLab Light")
        notebook.page.wait_for_selector("[data-jp-theme-light=true]", state="attached")


def brightness(css):
    """Mean of the three channels of a color as the browser computes it."""
    return np.mean([float(number) for number in re.findall(r"[\d.]+", css)[:3]])


def photograph(explorer, name):
    """Leave a picture of the explorer, where someone asked for it."""
    folder = os.environ.get("COURSEKIT_SCREENSHOTS")
    if folder:
        Path(folder).mkdir(parents=True, exist_ok=True)
        explorer.notebook.screenshot(Path(folder) / f"{name}.png")
