"""A notebook as plain data: read, written, and what its cells are for.

Cell metadata are nbgrader's (schema 3): a cell whose `nbgrader.solution` is true holds what the student
writes, one with `nbgrader.grade` holds its check.
"""

from __future__ import annotations

import copy
import hashlib
import json
from pathlib import Path


def read(path: Path) -> dict:
    """A notebook as plain data, sources joined to strings; ValueError, with its name, if it is none."""
    try:
        notebook = json.loads(Path(path).read_text(encoding="utf-8"))
        for cell in notebook["cells"]:
            if isinstance(cell["source"], list):
                cell["source"] = "".join(cell["source"])
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{path} is no notebook ({type(error).__name__}: {error})") from None
    return notebook


def write(path: Path, notebook: dict) -> None:
    """As Jupyter writes it: sources as lists of lines, indented by one, keys sorted, a newline at the end."""
    Path(path).write_text(text_of(notebook), encoding="utf-8", newline="\n")


def text_of(notebook: dict) -> str:
    """What `write` writes."""
    notebook = copy.deepcopy(notebook)
    for cell in notebook["cells"]:
        cell["source"] = cell["source"].splitlines(keepends=True)
    return json.dumps(notebook, ensure_ascii=False, indent=1, sort_keys=True) + "\n"


def is_solution(cell: dict) -> bool:
    """Does the student write this cell?"""
    return bool(role(cell).get("solution"))


def is_check(cell: dict) -> bool:
    """Does this cell check one the student writes?"""
    return bool(role(cell).get("grade")) and not is_solution(cell)


def role(cell: dict) -> dict:
    """What nbgrader's metadata say of a code cell: grade_id, points, solution, grade."""
    found = cell.get("metadata", {}).get("nbgrader", {})
    return found if cell.get("cell_type") == "code" and isinstance(found, dict) else {}


def tags(cell: dict) -> list:
    """The cell's tags."""
    return cell.get("metadata", {}).get("tags", [])


def digest(source: str) -> str:
    """What tells whether a text was changed; spaces at the ends of it do not count."""
    return hashlib.blake2b(source.strip().encode(), digest_size=6).hexdigest()


# ---- what a release writes into its notebooks: which version, and what stood in each cell


def stamp(notebook: dict, version: str, student: str = "") -> None:
    """Note in a released notebook its version, whose it is, and what stands in each of its cells."""
    cells = {key(cell): digest(cell["source"]) for cell in notebook["cells"]}
    mark = {"version": version, "cells": cells} | ({"student": student} if student else {})
    notebook["metadata"]["coursekit"] = mark


def key(cell: dict) -> str:
    """What a cell is found by: its grade_id, which every editor keeps, or its id."""
    return role(cell).get("grade_id") or cell.get("id", "")


def mark_of(notebook: dict) -> dict:
    """What a release noted in a notebook; {} if nothing, or nothing of that kind."""
    metadata = notebook.get("metadata")
    mark = metadata.get("coursekit") if isinstance(metadata, dict) else None
    return mark if isinstance(mark, dict) else {}


def newer(version: object, than: str) -> bool:
    """Is one version newer than another? "1.10" is newer than "1.9"."""

    def numbers(text: object) -> tuple[int, ...]:
        parts = str(text).split(".")
        return tuple(int(p) for p in parts) if all(p.isdecimal() and len(p) < 9 for p in parts) else ()

    return numbers(version) > numbers(than)
