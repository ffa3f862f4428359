"""The solved notebook: the only source of every solution; student version and references come from it.

Markers and cell metadata are nbgrader's (schema 3): a cell whose `nbgrader.solution` is true holds what the
student writes, one with `nbgrader.grade` holds its check. Tags: `setup` (imports), `instructor` (not for
students).
"""

from __future__ import annotations

import copy
import json
import linecache
import os
import re
from pathlib import Path
from types import SimpleNamespace

from ..document import is_check as is_check
from ..document import is_solution, read, tags, write
from ..document import role as role

STUB = "# your code here\nraise NotImplementedError"

KERNEL = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}

# names a live widget by a random id: nothing without its kernel, where the stored picture should show instead
_LIVE_VIEW = "application/vnd.jupyter.widget-view+json"

_SOLUTION = re.compile(r"^([ \t]*)### BEGIN SOLUTION[ \t]*\n.*?^[ \t]*### END SOLUTION[ \t]*$", re.S | re.M)

# the answer to a question: `ask("lever").answer(-0.4)`
_ANSWER = re.compile(r"^(ask\(.*?\)\.answer)\(.*\)[ \t]*$", re.M)


def references(path: Path) -> SimpleNamespace:
    """What the set-up cell and the solution cells of a solved notebook define. Run trusted notebooks only."""
    namespace = {"__name__": "solved"}
    for number, cell in enumerate(read(path)["cells"]):
        if is_solution(cell) or (cell["cell_type"] == "code" and "setup" in tags(cell)):
            run_cell(cell["source"], f"{Path(path).name}, cell {cell.get('id', number)}", namespace)
    return SimpleNamespace(**namespace)


def run_cell(source: str, name: str, namespace: dict) -> None:
    """Execute plain Python so that a traceback can show its lines."""
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    exec(compile(source, name, "exec"), namespace)


def student_version(notebook: dict) -> dict:
    """Without solutions, instructors' cells and outputs."""
    notebook = copy.deepcopy(notebook)
    notebook["cells"] = [cell for cell in notebook["cells"] if "instructor" not in tags(cell)]
    for cell in notebook["cells"]:
        cell["source"] = without_solution(cell["source"])
        if cell["cell_type"] == "code":
            cell["source"] = _ANSWER.sub(r"\1(...)", cell["source"])
            cell["outputs"], cell["execution_count"] = [], None
    return notebook


def without_solution(source: str) -> str:
    """A stub in place of everything between the markers; ValueError if they do not pair up."""

    def stub(match):
        return "\n".join(match[1] + line for line in STUB.splitlines())

    source = _SOLUTION.sub(stub, source).rstrip("\n")
    if re.search(r"###\s*(BEGIN|END)\s", source):
        raise ValueError(f"unbalanced solution marker in the cell that begins {source[:60]!r}")
    return source


def execute(path: Path, timeout: float = 120) -> None:
    """Run a notebook top to bottom and store its outputs, normalised; raises where a cell does.

    Nothing is stored that differs from one machine or run to the next: versions, times, widget state.
    A failing check raises.
    """
    import nbformat
    from nbclient import NotebookClient

    path = Path(path)
    document = nbformat.from_dict(read(path))
    client = NotebookClient(
        document,
        kernel_name="python3",
        timeout=timeout,
        store_widget_state=False,
        record_timing=False,
        coalesce_streams=True,
        extra_arguments=["--log-level=ERROR"],  # a kernel of one's own machine warns of eavesdroppers
        resources={"metadata": {"path": str(path.parent)}},
    )
    client.execute(env={**os.environ, "CI": "1"})
    write(path, _pictures_with_fewer_colours(normalised(json.loads(nbformat.writes(document)))))


def normalised(notebook: dict) -> dict:
    """The same in every editor and on every machine."""
    notebook = copy.deepcopy(notebook)
    notebook["metadata"] = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    notebook["nbformat"], notebook["nbformat_minor"] = 4, 5
    for cell in notebook["cells"]:
        cell["metadata"] = {k: v for k, v in cell["metadata"].items() if k in ("nbgrader", "tags")}
        if isinstance(cell["source"], list):
            cell["source"] = "".join(cell["source"])
        cell["source"] = cell["source"].rstrip("\n")
        for output in cell.get("outputs", ()):
            output.get("data", {}).pop(_LIVE_VIEW, None)
    return notebook


def _pictures_with_fewer_colours(notebook: dict) -> dict:
    """A figure of lines needs no 16 million colours: with 256 a stored notebook is a third as large."""
    import base64
    import io

    from PIL import Image

    for cell in notebook["cells"]:
        for output in cell.get("outputs", ()):
            if "image/png" not in output.get("data", {}):
                continue
            image = Image.open(io.BytesIO(base64.b64decode(output["data"]["image/png"])))
            if image.mode == "RGBA":
                white = Image.new("RGBA", image.size, "white")
                plain = Image.alpha_composite(white, image).convert("RGB")
                plain.quantize(256, dither=Image.Dither.NONE).save(
                    small := io.BytesIO(), "PNG", optimize=True
                )
                output["data"]["image/png"] = base64.b64encode(small.getvalue()).decode() + "\n"
    return notebook
