"""The grades as Canvas and Moodle import them: one column for each notebook.

No mark stands at the beginning of these files, unlike in grades.csv: programs read them, not Excel. What
nobody handed in has no column: after the first week all weeks to come would count 0 there.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from ..roster import Student
from .marks import Standing, whole
from .report import harmless


def write_canvas(path: Path, class_: list[Standing], people: dict[str, Student], ids: dict[str, str]) -> None:
    """Canvas: Gradebook, Import. Matched by ID (known from collected files) or by SIS Login ID.

    ids : {student: Canvas's own number}
    """
    columns = ["Student", "ID", "SIS Login ID", "Section", *_notebooks(class_)]
    possible = ["    Points Possible", "", "", "", *_possible(class_)]
    rows = [
        [
            _name(one, people),
            ids.get(one.student, ""),
            one.student,
            _section(one, people),
            *_points(one, _units(class_)),
        ]
        for one in class_
    ]
    _write(path, [columns, possible, *rows])


def write_moodle(path: Path, class_: list[Standing], people: dict[str, Student], ids: dict[str, str]) -> None:
    """Moodle: Grades, Import, CSV file. Map "Email address" or "ID number"; empty grades change nothing.

    ids : {student: number of the participant}, which the offline worksheet of an assignment asks for
    """
    columns = ["Identifier", "Full name", "ID number", "Email address", *_notebooks(class_)]
    rows = [
        [
            f"Participant {ids[one.student]}" if ids.get(one.student) else "",
            _name(one, people),
            one.student,
            people[one.student].email if one.student in people else "",
            *_points(one, _units(class_)),
        ]
        for one in class_
    ]
    _write(path, [columns, *rows])


def _units(class_: list[Standing]) -> list[str]:
    found = {unit for one in class_ for unit, nb in one.notebooks.items() if nb.there or nb.points != 0}
    return [unit for unit in class_[0].notebooks if unit in found] if class_ else []


def _notebooks(class_: list[Standing]) -> list[str]:
    return [class_[0].notebooks[unit].name.removesuffix(".ipynb") for unit in _units(class_)]


def _possible(class_: list[Standing]) -> list[float]:
    return [whole(class_[0].notebooks[unit].of) for unit in _units(class_)]


def _points(one: Standing, units: list[str]) -> list[float | str]:
    found = [one.notebooks[unit].points for unit in units]
    return ["" if points is None else whole(points) for points in found]


def _name(one: Standing, people: dict[str, Student]) -> str:
    return (people[one.student].name if one.student in people else "") or one.student


def _section(one: Standing, people: dict[str, Student]) -> str:
    return people[one.student].section if one.student in people else ""


def _write(path: Path, rows: Iterable[Sequence]) -> None:
    part = path.with_name(f".{path.name}.part")
    with part.open("w", newline="", encoding="utf-8", errors="replace") as file:
        csv.writer(file, quoting=csv.QUOTE_ALL).writerows([[harmless(cell) for cell in row] for row in rows])
    os.replace(part, path)
