"""A notebook that somebody works in, brought to a corrected release: what they wrote stays.

A release notes in each notebook what stood in its cells (`document.stamp`), so that three things can be told
apart: what the student wrote, what the student left alone, and what the release changes.
"""

from __future__ import annotations

import copy
import re
from dataclasses import dataclass, field

from .document import digest, is_solution, key, mark_of, role

KEPT = "# yours, kept: this cell was changed by you and by the corrected release, which stands above\n"


@dataclass
class Changes:
    """What a corrected release does to one notebook, for a person to read."""

    changed: list[str] = field(default_factory=list)  # names of cells
    added: list[str] = field(default_factory=list)
    gone: list[str] = field(default_factory=list)
    kept: int = 0  # cells that the student wrote in, among those released
    own: int = 0  # cells that the student added
    both: list[str] = field(default_factory=list)  # changed on both sides: both stand there now
    asked: list[str] = field(default_factory=list)  # exercises whose beginning is another one now
    points: list[str] = field(default_factory=list)

    @property
    def lines(self) -> list[str]:
        """Sentences; none if nothing of the course changed."""
        told = [
            *_line("changed", self.changed),
            *_line("new", self.added),
            *_line("no longer there", self.gone),
            *_line("changed by you and by the release, both stand there now", self.both),
            *_line("asked otherwise now, what you wrote is kept: look whether it fits", self.asked),
            *self.points,
        ]
        return [*told, self.of_yours] if told and self.kept + self.own else told

    @property
    def of_yours(self) -> str:
        return f"kept: {_count(self.kept, 'cell')} you wrote in, {_count(self.own, 'cell')} of your own"


def merge(mine: dict, new: dict) -> tuple[dict, Changes]:
    """The new release of a notebook with everything in it that its student wrote, and what changed.

    Cells are found by their id, exercises by their grade_id where the id is lost. Cells of one's own stay
    behind the cell they stood behind. Outputs stay where the code stays. In a notebook whose notes are lost,
    every cell that differs may be the student's, and stays beside the release's.
    """
    base, fresh = _noted(mine), _noted(new)
    changes, partners = Changes(), _partners(mine["cells"], new["cells"])
    pair_of = {id(old): number for number, old in partners.items()}
    merged: list[list[dict]] = [
        _one(old, cell, base, fresh, changes) for old, cell in _pairs(partners, new["cells"])
    ]
    still = {key(cell) for cell in new["cells"]}
    front: list[dict] = []
    behind = front  # where a cell of one's own goes: behind the released cell that it stood behind
    for cell in mine["cells"]:
        if id(cell) in pair_of:
            behind = merged[pair_of[id(cell)]]
        elif (
            base is None or key(cell) not in base or key(cell) in still
        ):  # theirs, or a copy of a released one
            changes.own += 1
            behind.append(copy.deepcopy(cell))
        elif base[key(cell)] != digest(cell["source"]):
            changes.gone.append(f"{_name(cell)} (yours is kept)")
            behind.append(copy.deepcopy(cell))
        else:
            changes.gone.append(_name(cell))
    document = copy.deepcopy({**mine, "nbformat_minor": new["nbformat_minor"], "cells": []})
    document["metadata"]["coursekit"] = copy.deepcopy(mark_of(new))
    document["cells"] = [*front, *(cell for group in merged for cell in group)]
    _unique_ids(document["cells"])
    return document, changes


def _pairs(partners: dict[int, dict], cells: list[dict]) -> list[tuple[dict | None, dict]]:
    return [(partners.get(number), cell) for number, cell in enumerate(cells)]


def _partners(mine: list[dict], new: list[dict]) -> dict[int, dict]:
    """{place in the new notebook: the student's cell that it replaces}."""
    found: dict[int, dict] = {}
    free = list(mine)
    for same in (_same_id, _same_exercise, _same_text):
        for number, cell in enumerate(new):
            if number not in found and (old := next((one for one in free if same(one, cell)), None)):
                found[number] = old
                free = [one for one in free if one is not old]
    return found


def _same_id(old: dict, cell: dict) -> bool:
    return "id" in cell and old.get("id") == cell["id"] and old["cell_type"] == cell["cell_type"]


def _same_exercise(old: dict, cell: dict) -> bool:
    grade_id = role(cell).get("grade_id")
    return grade_id is not None and role(old).get("grade_id") == grade_id


def _same_text(old: dict, cell: dict) -> bool:
    """For editors that lose ids."""
    return "id" not in old and (old["cell_type"], old["source"]) == (cell["cell_type"], cell["source"])


def _noted(notebook: dict) -> dict | None:
    """{key: digest of what was released} of a notebook's cells; None if its notes are lost."""
    cells = mark_of(notebook).get("cells")
    return cells if isinstance(cells, dict) else None


def _one(old: dict | None, cell: dict, base: dict | None, fresh: dict | None, changes: Changes) -> list[dict]:
    """What stands in place of a cell of the new release."""
    if old is None:
        changes.added.append(_name(cell))
        return [copy.deepcopy(cell)]
    if fresh is not None and key(cell) not in fresh:  # undone: a cell of the student's own stands in both
        return [copy.deepcopy(old)]
    now = copy.deepcopy({**cell, "metadata": {**old["metadata"], **cell["metadata"]}})
    if base is None and is_solution(cell):
        released = digest(cell["source"])
    else:
        released = (base or {}).get(key(old), "")
    theirs = digest(old["source"]) != released  # written in by the student
    ours = digest(cell["source"]) != released  # changed by the release
    _compare_points(old, cell, changes)
    if theirs and (is_solution(cell) or not ours):
        changes.kept += digest(old["source"]) != digest(cell["source"])
        if ours and base is not None and is_solution(cell):
            changes.asked.append(_name(cell))
        now["source"] = old["source"]
    elif ours and old["source"].strip() != cell["source"].strip():
        changes.changed.append(_name(cell))
    if old["cell_type"] == "code" and digest(now["source"]) == digest(old["source"]):
        now["outputs"] = copy.deepcopy(old.get("outputs", []))
        now["execution_count"] = old.get("execution_count")
    if theirs and ours and digest(now["source"]) != digest(old["source"]):
        changes.changed.remove(_name(cell))
        changes.both.append(_name(cell))
        kept = copy.deepcopy(old)
        kept["source"] = (KEPT if old["cell_type"] == "code" else "") + old["source"]
        kept["metadata"] = {}
        kept.pop("id", None)
        return [now, kept]
    return [now]


def _compare_points(old: dict, cell: dict, changes: Changes) -> None:
    before, after = role(old).get("points"), role(cell).get("points")
    if before is not None and after is not None and before != after:
        name = role(cell).get("grade_id", "").removeprefix("check-")
        changes.points.append(f"{name} counts {after:g} points, {before:g} before")


def _name(cell: dict) -> str:
    """What a person calls the cell: its exercise, its heading, or its first line."""
    if grade_id := role(cell).get("grade_id"):
        return grade_id.replace("check-", "the check of ")
    heading = re.search(r"^#+ +(.+)$", cell["source"], re.M) if cell["cell_type"] == "markdown" else None
    first = next((line for line in cell["source"].splitlines() if line.strip()), "an empty cell")
    text = heading[1] if heading else first.strip()
    return text if len(text) <= 60 else text[:57] + "..."


def _unique_ids(cells: list[dict]) -> None:
    """nbformat wants an id for each cell, and each once."""
    seen: set[str] = set()
    for number, cell in enumerate(cells):
        if not cell.get("id") or cell["id"] in seen:
            cell["id"] = next(
                name for n in range(len(cells) + 1) if (name := f"own-{number + n}") not in seen
            )
        seen.add(cell["id"])


def _line(what: str, names: list[str]) -> list[str]:
    return [f"{what}: {', '.join(names)}"] if names else []


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
