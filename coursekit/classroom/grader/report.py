"""What the grader hands back: grades.csv for the instructor, one page for every student."""

from __future__ import annotations

import csv
import html
import os
import re
import zlib
from collections import Counter
from collections.abc import Iterable
from datetime import date
from pathlib import Path

from ..course import Course
from .marks import Mark, Notebook, Standing, whole

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 50rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; }
caption { text-align: left; font-weight: 600; padding: 1rem 0 .3rem; }
td, th { border-bottom: 1px solid #8888; padding: .3rem .6rem .3rem 0; }
td, th { text-align: left; vertical-align: top; }
td.points { white-space: nowrap; } code { font-size: .95em; overflow-wrap: anywhere; }
th:first-child { width: 30%; } th:nth-child(2) { width: 5rem; }
:root { color-scheme: light dark; }
"""

OURS = ("class",)  # pages that are no student's

HEAD = "".join(f"<th scope='col'>{word}</th>" for word in ("exercise", "points", "feedback"))


def write_grades(path: Path, course: Course, units: list[str], class_: Iterable[Standing], box: str) -> None:
    """grades.csv: student, points, of; points of each notebook and each exercise; days late, notes, box.

    What could not be graded, or is not graded yet, is left empty: it is not a 0. Only a whole table takes the
    place of the one before.
    """
    names = [(unit, e.name) for unit in units for e in course.exercises(unit)]
    twice = {name for name, count in Counter(name for _, name in names).items() if count > 1}
    columns = [f"{unit} {name}" if name in twice else name for unit, name in names]
    part = path.with_name(f".{path.name}.part")
    # with a mark at its beginning: Excel takes letters for others without it
    with part.open("w", newline="", encoding="utf-8-sig", errors="replace") as file:
        table = csv.writer(file, quoting=csv.QUOTE_ALL)  # where `;` separates, too
        table.writerow(["student", "points", "of", *units, *columns, "days late", "notes", "box"])
        for one in class_:
            points = {
                (unit, mark.name): mark.points for unit, nb in one.notebooks.items() for mark in nb.marks
            }
            row: list = [one.student, one.points if len(one.notebooks) == len(units) else None, one.of]
            row += [nb.points if (nb := one.notebooks.get(unit)) else None for unit in units]
            row += [points.get(key) for key in names]
            row += [sum(nb.days_late for nb in one.notebooks.values()) or None, _notes(one), box]
            table.writerow([harmless(cell) for cell in row])
    os.replace(part, path)


def _notes(one: Standing) -> str:
    notes = [f"{unit}: {note}" for unit, nb in one.notebooks.items() for note in nb.notes]
    for unit, nb in one.notebooks.items():
        for mark in nb.marks:
            if mark.note:
                notes.append(f"{unit} {mark.name}: {mark.note}")
            elif mark.text and mark.text not in nb.notes:
                notes.append(f"{unit} {mark.name}: {mark.text}")
    return "; ".join(notes)


def harmless(cell: object) -> object:
    """A spreadsheet would run a text that begins like a formula."""
    if cell is None:
        return ""
    if isinstance(cell, int | float):
        return whole(cell)
    cell = "".join(c if c.isprintable() else " " for c in str(cell))
    formula = cell[:1] in ("=", "+", "-", "@", "\t", "\uff1d", "\uff0b", "\uff0d", "\uff20")
    return "'" + cell if formula else cell


def page_name(student: str) -> str:
    """The file name of a student's page: theirs, unless it is too long, or the name of another file here."""
    if len(os.fsencode(student)) <= 200 and student.lower() not in OURS:
        return f"{student}.html"
    short = student.encode("utf-8", "replace")[:150].decode("utf-8", "ignore")
    return f"{short}-{zlib.crc32(os.fsencode(student)):08x}.html"


def write_page(path: Path, one: Standing) -> None:
    """A student's feedback: points, and what to look at, for every exercise."""
    title = f"Feedback for {text(one.name or one.student)}"
    total = "not graded yet" if one.points is None else f"{whole(one.points)} of {whole(one.of)} points"
    page = (
        "<!doctype html><html lang='en'><head><meta charset='utf-8'>"
        "<meta name='viewport' content='width=device-width'>"
        f"<title>{title}</title><style>{STYLE}</style></head>"
        f"<body><h1>{title}</h1><p>{total}, {date.today().isoformat()}</p>"
        f"{''.join(_table(nb) for nb in one.notebooks.values())}</body></html>\n"
    )
    path.write_text(page, encoding="utf-8", errors="replace")


def _table(nb: Notebook) -> str:
    points = "not graded" if nb.points is None else f"{whole(nb.points)} of {whole(nb.of)}"
    when = f", handed in {nb.submitted:%Y-%m-%d %H:%M}" if nb.submitted and nb.there else ""
    notes = "".join(f"<p>{text(note)}</p>" for note in nb.notes)
    if not nb.there and all(mark.text in nb.notes and not mark.note for mark in nb.marks):
        return (
            f"<table><caption>{text(nb.name)}: {points}</caption></table>{notes}"  # nothing of any exercise
        )
    return (
        f"<table><caption>{text(nb.name)}: {points}{when}</caption>"
        f"<thead><tr>{HEAD}</tr></thead><tbody>{''.join(map(_row, nb.marks))}</tbody></table>{notes}"
    )


def _row(mark: Mark) -> str:
    points = "not graded" if mark.points is None else f"{whole(mark.points)} of {whole(mark.of)}"
    said = [mark.page or mark.text, mark.line and f"In your code: {mark.line}", mark.note]
    if mark.points is not None and not any(said):
        said = ["right"]
    feedback = "<br>".join(text(one) for one in said if one)
    return (
        f"<tr><td><code>{text(mark.name)}</code></td><td class='points'>{points}</td><td>{feedback}</td></tr>"
    )


def text(value: object) -> str:
    """As it stands in a page: what students wrote stays text; `names` in it look like code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(str(value)))
