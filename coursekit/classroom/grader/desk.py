"""Where tables and pages are written, from the journal and the instructor's decisions."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from ..course import Course
from ..roster import Student
from . import class_page, gradebooks, report
from .box import as_root
from .decisions import Decisions
from .journal import Journal
from .marks import Standing, standing
from .naming import printable
from .submissions import Submissions

EVERY = 30.0  # seconds between two tables while the grading goes on


class Desk:
    """Writes the tables and pages: all of them at the end, grades.csv also while the grading goes on."""

    def __init__(
        self,
        out: Path,
        course: Course,
        units: list[str],
        people: dict[str, Student],
        decided: Decisions,
        handed_in: Submissions,
        journal: Journal,
        box: bool,
    ) -> None:
        self.out, self.course, self.units, self.people = out, course, units, people
        self.decided, self.handed_in, self.journal = decided, handed_in, journal
        self.box = "NO BOX" if not box else "bubblewrap, as root" if as_root() else "bubblewrap"
        self.next = time.monotonic() + EVERY

    def look(self) -> None:
        """Write grades.csv if it is some time ago."""
        if time.monotonic() > self.next:
            report.write_grades(self.out / "grades.csv", self.course, self.units, self._class(), self.box)
            self.next = time.monotonic() + EVERY

    def write(self) -> str:
        """Write everything; what sums it up."""
        class_ = list(self._class())
        report.write_grades(self.out / "grades.csv", self.course, self.units, class_, self.box)
        for one in class_:
            report.write_page(self.out / report.page_name(one.student), one)
        class_page.write_class_page(self.out / "class.html", class_)
        if self.people:
            gradebooks.write_canvas(
                self.out / "canvas.csv", class_, self.people, self.handed_in.platform("canvas")
            )
            gradebooks.write_moodle(
                self.out / "moodle.csv", class_, self.people, self.handed_in.platform("moodle")
            )
        return "\n".join(map(printable, self._told(class_)))

    def _class(self) -> Iterator[Standing]:
        for student in self.handed_in.students:
            name = self.people[student].name if student in self.people else ""
            yield standing(student, name, self.course, self.units, self._record, self.decided)

    def _record(self, student: str, unit: str) -> dict | None:
        """The journal's, with the time as it is known now."""
        record = self.journal.record(student, unit)
        when, late = self.handed_in.time(student, unit)
        return record if record is None or not when else {**record, "submitted": when, "late": late}

    def _not_given_anew(self, class_: list[Standing]) -> list[str]:
        """Notebooks whose grade should be given anew, but whose file is not among the submissions."""
        pairs = [(one.student, unit) for one in class_ for unit in self.units]
        return [
            f"{s} {u}" for s, u in pairs if self.journal.has_grade(s, u) and self.journal.is_forgotten(s, u)
        ]

    def _told(self, class_: list[Standing]) -> Iterator[str]:
        failed = sum(nb.points is None for one in class_ for nb in one.notebooks.values())
        text = f"{len(class_)} students, {len(self.units)} notebooks: {self.out / 'grades.csv'}"
        yield text + (f"; {failed} COULD NOT BE GRADED, run it again" if failed else "")
        if old := self._not_given_anew(class_):
            names = ", ".join(old[:5])
            yield f"graded earlier and not here to be graded anew: {names} ({len(old)} notebooks)"
        if strangers := sorted({one.student for one in class_} - self.people.keys() if self.people else ()):
            yield f"not in the roster ({len(strangers)}): {', '.join(strangers[:10])}"
        if strays := self.handed_in.strays:
            yield (
                f"{len(strays)} files beside the students' folders were not graded ({', '.join(strays[:3])}"
                "): `coursekit collect` sorts them into folders"
            )
        if as_root():
            yield (
                "You are root, for whom limits on processes do nothing, and whose Python nobody else may "
                "read: grade as an ordinary user if you can"
            )
