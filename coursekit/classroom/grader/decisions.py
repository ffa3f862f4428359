"""What the instructor decides beside the grader: OUT/overrides.csv and OUT/extensions.csv, and two shares.

Both tables are the instructor's own and are never written here, so they outlive every regrade. A row that
fits nobody is an error, with file and line: a misprint must not pass in silence.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime, time, timedelta
from pathlib import Path

from ..course import Course
from ..exercise import nearest
from ..spreadsheet import rows

OVERRIDES = ("student", "exercise", "points", "reason")
EXTENSIONS = ("student", "notebook", "until", "reason")


@dataclass(frozen=True)
class Override:
    """Points that the instructor gives, and why."""

    points: float
    reason: str


@dataclass
class Decisions:
    """follow_on : share of the points for an exercise that is right once an earlier one is put right
    late : share of a notebook's points that every started day after the deadline costs
    """

    follow_on: float = 1.0
    late: float = 0.1
    overrides: dict[tuple[str, str], Override] = field(default_factory=dict)
    deadlines: dict[tuple[str, str], datetime] = field(default_factory=dict)  # of single students
    everybody: dict[str, datetime] = field(default_factory=dict)  # {unit: deadline}

    def __post_init__(self) -> None:
        for name, share in (("follow-on", self.follow_on), ("late", self.late)):
            if not 0 <= share <= 1:
                raise ValueError(f"--{name} is a share of the points, from 0 to 1; {share:g} came")

    def deadline(self, student: str, unit: str) -> datetime | None:
        """When a student has to hand a notebook in."""
        return self.deadlines.get((student, unit), self.everybody.get(unit))

    def days_late(self, student: str, unit: str, when: datetime | None, flagged: bool) -> int:
        """Started days after the deadline; 1 where only the learning platform says that it was late."""
        if (deadline := self.deadline(student, unit)) is None:
            return 0
        over = (when - deadline) if when else timedelta(0)
        days = math.ceil(over / timedelta(days=1)) if over > timedelta(0) else 0
        return days or int(flagged and (student, unit) not in self.deadlines)


def read(
    folder: Path, course: Course, units: list[str], students: set[str], follow_on: float, late: float
) -> Decisions:
    """The decisions for a class; ValueError with file and line where a row fits nobody or nothing."""
    weights = course.weights
    of = {e.name: float(weights.get(e.name, e.points)) for unit in units for e in course.exercises(unit)}
    stems = {course.notebook(unit).stem: unit for unit in units}
    found = Decisions(follow_on, late)
    for stem, when in course.deadlines.items():
        if stem in stems:
            found.everybody[stems[stem]] = _local(when)
    for where, row in _rows(folder / "overrides.csv", OVERRIDES):
        student, exercise = _one_of(where, row, "student", students), _one_of(where, row, "exercise", of)
        try:
            points = float(row["points"])
        except ValueError:
            points = math.nan
        if not 0 <= points <= of[exercise]:
            raise ValueError(f"{where}, points: 0 to {of[exercise]:g} are expected, not {row['points']!r}")
        if (student, exercise) in found.overrides:
            raise ValueError(f"{where}: {exercise} of {student} stands in an earlier line, too")
        found.overrides[student, exercise] = Override(points, row["reason"])
    for where, row in _rows(folder / "extensions.csv", EXTENSIONS):
        student = _one_of(where, row, "student", students)
        row["notebook"] = row["notebook"].removesuffix(".ipynb")
        unit = stems[_one_of(where, row, "notebook", stems)]
        found.deadlines[student, unit] = _moment(where, row["until"])
    return found


def _rows(path: Path, columns: tuple[str, ...]) -> Iterator[tuple[str, dict[str, str]]]:
    """(file and line, row) of a table, if it is there."""
    if not path.exists():
        return
    for line, row in rows(path, columns, needed=columns):
        yield f"{path}, line {line}", row


def _one_of(where: str, row: dict[str, str], column: str, known) -> str:
    if row[column] not in known:
        raise ValueError(f"{where}, {column}: there is no {row[column]!r}.{nearest(row[column], known)}")
    return row[column]


def _moment(where: str, text: str) -> datetime:
    """A day ends at midnight."""
    try:
        when = datetime.fromisoformat(text)
    except ValueError:
        raise ValueError(
            f"{where}, until: a day such as 2026-12-01 (or 2026-12-01 18:00) is expected, not {text!r}"
        ) from None
    return _local(when if len(text) > 10 else datetime.combine(when, time(23, 59, 59)))


def _local(when: datetime) -> datetime:
    """As the clock of this machine shows it, which the times of files are compared with."""
    return when.astimezone().replace(tzinfo=None) if when.tzinfo else when
