"""Who is in the class: roster.csv, with the columns id, name and email.

Two more may be there: `aliases`, other names that a learning platform has for a student (between semicolons
or bars), and `section`.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

COLUMNS = ("id", "name", "email")
NOT_IN_AN_ID = '/\\:*?"<>|'  # ids name folders, on every system


@dataclass(frozen=True)
class Student:
    """One row of a roster."""

    id: str
    name: str = ""
    email: str = ""
    aliases: tuple[str, ...] = ()
    section: str = ""


def read(path: Path) -> list[Student]:
    """Everybody in a roster; ValueError with file and line where a row does not fit or an id is there twice.

    `;` may stand for `,`, and other columns may be there. Spreadsheets put a mark before the first letter:
    it does not count.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path} is not UTF-8: export it as CSV UTF-8") from None
    first = text.partition("\n")[0]
    rows = csv.DictReader(text.splitlines(), delimiter=";" if first.count(";") > first.count(",") else ",")
    names = [name.strip().lower() for name in rows.fieldnames or ()]
    if "id" not in names:
        raise ValueError(
            f"{path}, line 1: the columns {', '.join(COLUMNS)} are expected, not {first.strip()!r}"
        )
    rows.fieldnames = names
    found: dict[str, int] = {}
    students = []
    for row in rows:
        one = {column: (row.get(column) or "").strip() for column in COLUMNS}
        if not any(one.values()):
            continue
        where, key = f"{path}, line {rows.line_num}", one["id"].casefold()
        if not one["id"] or one["id"].startswith(".") or set(one["id"]) & set(NOT_IN_AN_ID):
            raise ValueError(f"{where}, id: {one['id']!r} cannot name a folder")
        if key in found:
            raise ValueError(f"{where}, id: {one['id']!r} is there already, in line {found[key]}")
        found[key] = rows.line_num
        aliases = (row.get("aliases") or "").replace("|", ";").split(";")
        students.append(
            Student(
                one["id"],
                one["name"],
                one["email"],
                tuple(alias.strip() for alias in aliases if alias.strip()),
                (row.get("section") or "").strip(),
            )
        )
    if not students:
        raise ValueError(f"{path} names no student")
    return students
