"""What is left of an explorer where no kernel runs: the picture in the notebook and in its HTML page."""

import base64
import re
from pathlib import Path

import nbformat
from nbconvert import HTMLExporter

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
