"""What the grader hands back: grades.csv for the instructor, one page for every student."""

from __future__ import annotations

import csv
import html
import os
import zlib
from pathlib import Path

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 50rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; }
caption { text-align: left; font-weight: 600; padding: 1rem 0 .3rem; }
td, th { border-bottom: 1px solid #8888; padding: .3rem .6rem .3rem 0; }
td, th { text-align: left; vertical-align: top; }
td.points { white-space: nowrap; } code { font-size: .95em; }
:root { color-scheme: light dark; }
"""


OURS = ("class",)  # pages that are no student's

HEAD = "".join(f"<th scope='col'>{word}</th>" for word in ("exercise", "points", "feedback"))


class Gradebook:
    """grades.csv, row by row: student, total, points of each unit, notes, and how the code was boxed."""

    def __init__(self, path: Path, units: list[str], boxed: bool) -> None:
        self._path, self._part = path, path.with_name(f".{path.name}.part")
        # with a mark at its beginning: Excel takes letters for others without it
        self._file = self._part.open("w", newline="", encoding="utf-8-sig", errors="replace")
        self._writer = csv.writer(self._file, quoting=csv.QUOTE_ALL)  # where `;` separates, too
        self._units = units
        self._box = "bubblewrap" if boxed else "NO BOX"
        self._writer.writerow(["student", "points", "of", *units, "notes", "box"])

    def row(self, student: str, results: dict[str, dict]) -> None:
        """results: {unit: record of the journal}. What could not be graded is left empty, and is not a 0."""
        points = {u: total(r, "points") for u, r in results.items()}
        of = sum(total(r, "of") or 0 for r in results.values())
        known = [p for p in points.values() if p is not None]
        whole = sum(known) if len(known) == len(points) else None
        notes = [f"{unit}: {note}" for unit in self._units for note in results[unit]["notes"]]
        notes += [
            f"{unit} {name}: {row['text']}"
            for unit in self._units
            for name, row in results[unit]["exercises"].items()
            if row["text"] and row["text"] not in results[unit]["notes"]
        ]
        cells = [student, whole, of, *(points[u] for u in self._units), "; ".join(notes), self._box]
        self._writer.writerow([_harmless(cell) for cell in cells])

    def close(self) -> None:
        """Only a whole table takes the place of the one before."""
        self._file.close()
        os.replace(self._part, self._path)


def total(record: dict, key: str) -> int | None:
    """Sum over the exercises; None if the submission could not be graded."""
    return None if record.get("failed") else sum(row[key] for row in record["exercises"].values())


def _harmless(cell):
    """A spreadsheet would run a text that begins like a formula."""
    if cell is None:
        return ""
    if isinstance(cell, str):
        cell = "".join(c if c.isprintable() else " " for c in cell)
        return (
            "'" + cell
            if cell[:1] in ("=", "+", "-", "@", "\t", "\uff1d", "\uff0b", "\uff0d", "\uff20")
            else cell
        )
    return cell


def page_name(student: str) -> str:
    """The file name of a student's page: theirs, unless it is too long, or the name of another file here."""
    if len(os.fsencode(student)) <= 200 and student.lower() not in OURS:
        return f"{student}.html"
    short = student.encode("utf-8", "replace")[:150].decode("utf-8", "ignore")
    return f"{short}-{zlib.crc32(os.fsencode(student)):08x}.html"


def write_page(path: Path, student: str, results: dict[str, dict]) -> None:
    """A student's feedback: points, and what to look at, for every exercise."""
    tables = []
    for record in results.values():
        rows = "".join(
            f"<tr><td><code>{_text(name)}</code></td><td class='points'>{row['points']} of {row['of']}</td>"
            f"<td>{_text(row['text']) or 'right'}</td></tr>"
            for name, row in record["exercises"].items()
        )
        notes = "".join(f"<p>{_text(note)}</p>" for note in record["notes"])
        tables.append(
            f"<table><caption>{_text(record['name'])}</caption>"
            f"<thead><tr>{HEAD}</tr></thead><tbody>{rows}</tbody></table>{notes}"
        )
    page = (
        "<!doctype html><html lang='en'><head><meta charset='utf-8'>"
        f"<title>Feedback for {_text(student)}</title><style>{STYLE}</style></head>"
        f"<body><h1>Feedback for {_text(student)}</h1>{''.join(tables)}</body></html>\n"
    )
    path.write_text(page, encoding="utf-8", errors="replace")


def _text(value) -> str:
    return html.escape(str(value))
