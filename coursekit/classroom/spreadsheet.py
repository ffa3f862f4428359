"""A table that people keep in a spreadsheet and save as CSV: a roster, overrides, extensions."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path


def rows(
    path: Path, columns: tuple[str, ...], needed: tuple[str, ...]
) -> Iterator[tuple[int, dict[str, str]]]:
    """(line, {column: text}) of every row in which one of these columns is filled; other columns come along.

    `;` may stand for `,`, and a mark before the first letter does not count, which spreadsheets put there.
    ValueError with the file, and the line where there is one, if it is not UTF-8 or lacks a needed column.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path} is not UTF-8: export it as CSV UTF-8") from None
    first = text.partition("\n")[0]
    table = csv.DictReader(text.splitlines(), delimiter=";" if first.count(";") > first.count(",") else ",")
    names = [name.strip().lower() for name in table.fieldnames or ()]
    if not set(needed) <= set(names):
        expected = ", ".join(columns)
        raise ValueError(f"{path}, line 1: the columns {expected} are expected, not {first.strip()!r}")
    table.fieldnames = names
    for row in table:
        one = {column: (row.get(column) or "").strip() for column in (*columns, *names)}
        if any(one[column] for column in columns):
            yield table.line_num, one
