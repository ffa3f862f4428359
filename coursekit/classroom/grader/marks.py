"""What everybody gets: the journal's records, and what the instructor decided on top of them.

Nothing here is stored: marks follow from the journal, the course's weights and the decisions, so that a
changed weight, deadline or override needs no new grading.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime

from ..course import Course
from .decisions import Decisions


@dataclass(frozen=True)
class Mark:
    """One exercise of one student. points: None if it could not be graded, which is no 0."""

    name: str
    points: float | None
    of: float
    text: str  # what is wrong, '' if it is right
    note: str = ""  # what the instructor decided
    kind: str = ""  # of the verdict
    step: str = ""
    said: str = ""  # the text without its details
    line: str = ""  # where to look, by the search in the student's own code
    page: str = ""  # what the student reads in place of the text, '' if that is the text


@dataclass(frozen=True)
class Notebook:
    """One notebook of one student."""

    unit: str
    name: str
    marks: list[Mark]
    notes: list[str]
    days_late: int = 0
    penalty: float = 0.0  # share of the points
    submitted: datetime | None = None
    there: bool = True  # was anything handed in?

    @property
    def points(self) -> float | None:
        """After the penalty; None if an exercise could not be graded."""
        known = [mark.points for mark in self.marks if mark.points is not None]
        return round(sum(known) * (1 - self.penalty), 2) if len(known) == len(self.marks) else None

    @property
    def of(self) -> float:
        """The most one can get."""
        return sum(mark.of for mark in self.marks)


@dataclass(frozen=True)
class Standing:
    """One student."""

    student: str
    name: str = ""  # from the roster
    notebooks: dict[str, Notebook] = field(default_factory=dict)

    @property
    def points(self) -> float | None:
        """The total; None if a notebook could not be graded."""
        known = [one.points for one in self.notebooks.values() if one.points is not None]
        return round(sum(known), 2) if len(known) == len(self.notebooks) else None

    @property
    def of(self) -> float:
        """The most one can get."""
        return sum(one.of for one in self.notebooks.values())

    @property
    def marks(self) -> dict[str, Mark]:
        """{exercise: its mark}, of all notebooks."""
        return {mark.name: mark for one in self.notebooks.values() for mark in one.marks}


def standing(
    student: str,
    name: str,
    course: Course,
    units: list[str],
    record: Callable[[str, str], dict | None],
    decisions: Decisions,
) -> Standing:
    """What a student has. record(student, unit) gives the journal's, or None before it is graded."""
    found = Standing(student, name)
    for unit in units:
        if (one := record(student, unit)) is not None:
            found.notebooks[unit] = _notebook(student, unit, course, one, decisions)
    return found


def _notebook(student: str, unit: str, course: Course, record: dict, decisions: Decisions) -> Notebook:
    rows = record.get("exercises", {})
    marks = [_mark(student, e, rows.get(e.name), course, decisions) for e in course.exercises(unit)]
    when = datetime.fromisoformat(record["submitted"]) if record.get("submitted") else None
    there = bool(record.get("digest"))
    days = decisions.days_late(student, unit, when, bool(record.get("late"))) if there else 0
    penalty = min(1.0, days * decisions.late)
    notes = list(record.get("notes", ()))
    if days:
        notes.append(
            f"{days} day{'s' if days > 1 else ''} late: {100 * penalty:.3g} % of the points are taken off"
        )
    return Notebook(unit, course.notebook(unit).name, marks, notes, days, penalty, when, there)


def _mark(student: str, exercise, row: dict | None, course: Course, decisions: Decisions) -> Mark:
    of = whole(course.weights.get(exercise.name, exercise.points))
    text, note, points = "", "", None
    more = {key: str((row or {}).get(key, "")) for key in ("page", "kind", "step", "said", "line")}
    if row is not None:
        text, points = row["text"], of if row["points"] else 0
        if not points and row.get("follow_on") and decisions.follow_on:
            points = whole(of * decisions.follow_on)
            note = f"right with a right {row['follow_on']}, which it calls: the points are given"
            if more["kind"] == "unwritten":  # not this exercise, whose own code is right
                text = f"it calls {row['follow_on']}, and something there is not written yet"
            note += "" if decisions.follow_on == 1 else f" in part ({100 * decisions.follow_on:.3g} %)"
    if override := decisions.overrides.get((student, exercise.name)):
        points = whole(override.points)
        note = f"set by your instructor: {override.reason or 'no reason given'}"
    return Mark(exercise.name, points, of, text, note, **more)


def whole(x: float) -> float:
    """2.0 is shown as 2."""
    return int(x) if float(x).is_integer() else round(float(x), 2)
