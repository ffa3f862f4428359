"""A student gets no solutions and no instructor's cells: no cell that is left may need a name of theirs."""

from __future__ import annotations

import builtins
import symtable
from pathlib import Path

import pytest

from coursekit.classroom.author import notebook

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
GIVEN = {*dir(builtins), "display"}  # what a notebook has before its first cell


def made(table):
    """Names a cell leaves behind for the cells after it."""
    return {
        s.get_name() for s in table.get_symbols() if s.is_assigned() or s.is_imported() or s.is_namespace()
    }


def needed(table, top=True):
    """Names of the notebook that a cell reads, also inside its functions and comprehensions."""
    names = {s.get_name() for s in table.get_symbols() if s.is_referenced() and (top or s.is_global())}
    return names.union(*(needed(child, top=False) for child in table.get_children()))


def missing(cells):
    """Cell id -> the names it needs and no cell before it makes."""
    known, found = set(GIVEN), {}
    for cell in cells:
        if cell["cell_type"] == "code":
            table = symtable.symtable(cell["source"], cell["id"], "exec")
            found[cell["id"]] = needed(table) - made(table) - known
            known |= made(table)
    return {i: names for i, names in found.items() if names}


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_no_cell_needs_what_a_student_does_not_get(path):
    assert missing(notebook.student_version(notebook.read(path))["cells"]) == {}


def test_a_name_made_nowhere_is_found():
    cells = [
        {"cell_type": "code", "id": "one", "source": "import math\ndef f(R):\n    return R * g(math.pi)"},
        {"cell_type": "code", "id": "two", "source": "print([R for k in range(3)], f)"},
    ]
    assert missing(cells) == {"one": {"g"}, "two": {"R"}}
