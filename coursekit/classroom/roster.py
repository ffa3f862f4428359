"""Who is in the class: roster.csv, with the columns id, name and email.

Two more may be there: `aliases`, other names that a learning platform has for a student (between semicolons
or bars), and `section`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .spreadsheet import rows

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
    found: dict[str, int] = {}
    students = []
    for line, one in rows(path, COLUMNS, needed=("id",)):
        where, key = f"{path}, line {line}", one["id"].casefold()
        if not one["id"] or one["id"].startswith(".") or set(one["id"]) & set(NOT_IN_AN_ID):
            raise ValueError(f"{where}, id: {one['id']!r} cannot name a folder")
        if key in found:
            raise ValueError(f"{where}, id: {one['id']!r} is there already, in line {found[key]}")
        found[key] = line
        aliases = one.get("aliases", "").replace("|", ";").split(";")
        students.append(
            Student(
                one["id"],
                one["name"],
                one["email"],
                tuple(alias.strip() for alias in aliases if alias.strip()),
                one.get("section", ""),
            )
        )
    if not students:
        raise ValueError(f"{path} names no student")
    return students
