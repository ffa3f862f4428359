"""Every notebook as a student has it, from top to bottom: nothing written, all wrong, all raising.

No cell may raise: what is missing is said in one sentence, and the cells below go on.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.course import the_course

COURSE = the_course()
# Stands below each exercise in place of what a student wrote there.
WRONG = """
from coursekit.classroom.course import the_course as _course
{name} = _course().wrong({unit!r})[{name!r}][{key!r}]
{name}.__name__ = {name!r}
"""
RAISING = """
def {name}(*arguments):
    return arguments[0] / [][len(arguments)]
"""


def written(unit, kind):
    """The released notebook with something in place of every exercise."""
    found = notebook.student_version(notebook.read(COURSE.notebook(unit)))
    wrong = COURSE.wrong(unit)
    for cell in found["cells"]:
        if not notebook.is_solution(cell) or kind == "empty":
            continue
        name = cell["metadata"]["nbgrader"]["grade_id"]
        if kind == "wrong":
            cell["source"] += WRONG.format(name=name, unit=unit, key=next(iter(wrong[name])))
        else:
            cell["source"] = RAISING.format(name=name)
    return found


@pytest.mark.parametrize("kind", ["empty", "wrong", "raising"])
@pytest.mark.parametrize("unit", COURSE.units)
def test_no_cell_raises(unit, kind, tmp_path):
    import nbformat
    from nbclient import NotebookClient

    document = nbformat.from_dict(written(unit, kind))
    for data in COURSE.notebooks.glob("*.csv"):
        (tmp_path / data.name).write_bytes(data.read_bytes())
    environment = {name: value for name, value in os.environ.items() if name != "CI"}
    environment["PYTHONPATH"] = str(Path(notebook.__file__).resolve().parents[3])
    client = NotebookClient(
        document,
        kernel_name="python3",
        timeout=120,
        allow_errors=True,
        store_widget_state=False,
        resources={"metadata": {"path": str(tmp_path)}},
    )
    client.execute(env=environment)
    errors = {
        cell["id"]: f"{output['ename']}: {output['evalue']}"[:200]
        for cell in document["cells"]
        if cell["cell_type"] == "code"
        for output in cell["outputs"]
        if output["output_type"] == "error"
    }
    assert errors == {}
