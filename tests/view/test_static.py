"""What is left of an explorer where no kernel runs: the picture in the notebook and in its HTML page."""

import base64
import re
from pathlib import Path

import nbformat
import pytest
from nbconvert import HTMLExporter
from nbconvert.exporters import get_exporter

from coursekit import robots
from coursekit.view import reopened

NOTEBOOK = Path(__file__).resolve().parents[2] / "notebooks" / "01_dh_vs_poe.ipynb"


def test_html_of_a_notebook_shows_the_picture_of_its_explorer():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    cell = next(cell for cell in notebook.cells if cell.source.startswith("view.explore"))
    stored = cell.outputs[0]
    assert stored.data["text/plain"].startswith("Explorer of DH and PoE: KUKA KR6 R900 sixx")
    assert stored.metadata["image/png"]["alt"] == stored.data["text/plain"]

    notebook.cells = [cell]
    page, _ = HTMLExporter(embed_images=True).from_notebook_node(notebook)
    pictures = [base64.b64decode(data) for data in re.findall(r'src="data:image/png;base64,([^"]+)"', page)]
    assert pictures == [base64.b64decode(stored.data["image/png"])]
    assert pictures[0].startswith(b"\x89PNG") and len(pictures[0]) > 5000
    assert "vnd.jupyter.widget" not in page  # a widget without a kernel would be an empty box


def test_nbconvert_makes_a_page_in_which_the_explorer_moves_and_figures_say_their_numbers():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    notebook.cells = [cell for cell in notebook.cells if cell.source.startswith(("view.explore", "figures."))]
    page, _ = get_exporter("coursekit")().from_notebook_node(notebook)
    inner = re.findall(r'srcdoc="([^"]*)"', page)[0]
    assert "KUKA KR6 R900 sixx: joints (0.0, -90.0, 90.0" in inner and "The rest needs Python" in page
    assert 'alt="at zero: x₃ stands upright.' in page and "No description" not in page


@pytest.mark.parametrize("path", sorted(NOTEBOOK.parent.glob("*.ipynb")), ids=lambda path: path.stem)
def test_the_stored_line_of_every_explorer_gives_its_page(path):
    """Every one of an arm of the catalogue: an arm of one's own is known to nobody else."""
    cells = nbformat.read(path, as_version=4).cells
    lines = [
        output["data"]["text/plain"]
        for cell in cells
        for output in cell.get("outputs", [])
        if "data" in output
    ]
    explorers = [line for line in lines if line.startswith("Explorer of")]
    known = [line for line in explorers if line.split(": ")[1] in {arm.name for arm in robots.all().values()}]
    assert known and explorers[0] == known[0]
    for line in known:
        assert reopened.page_of(line).startswith("<!DOCTYPE html>")


def test_nothing_else_gives_a_page():
    for line in (
        "",
        "42",
        "Explorer of screws: my arm: joints (0.0) deg",
        "Explorer of cakes: KUKA KR6 R900 sixx: joints ()",
    ):
        assert reopened.page_of(line) is None
