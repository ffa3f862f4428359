"""What a release noted in a notebook: whose it was, and which version of the course. Read without trust."""

from __future__ import annotations

import json

from .. import own
from ..course import Course
from ..document import mark_of, newer
from .naming import printable


def handed_out(data: bytes, student: str, course: Course) -> tuple[int, list[str]]:
    """(seed of the arm that the exercises ask for, what an instructor should know).

    A notebook from a release for a roster is judged with the arm of the student who hands it in, whoever's
    name stands in it: somebody else's numbers do not fit.
    """
    mark = mark_of(json.loads(data))
    notes = []
    whose = mark.get("student", "")
    if newer(mark.get("version", ""), course.version):
        notes.append(
            f"the notebook is of version {printable(str(mark['version'])[:20])}, newer than this course "
            f"({course.version}): grade with that version"
        )
    if whose and whose != student:
        notes.append(f"the notebook was handed out to {printable(str(whose)[:60])}")
    return own.seed_of(student) if whose else own.NOBODY, notes
