"""Functions that commit the typical mistakes. Instructors and CI only: no release holds this folder."""

from __future__ import annotations

from coursekit.classroom.course import Course, the_course


class Solved:
    """The functions of a unit's solved notebook, read when one of them is first used.

    >>> right = Solved("nb01")            # right.dh_transform(...) is the notebook's own
    """

    def __init__(self, unit: str, course: Course | None = None):
        self._unit, self._course = unit, course or the_course()

    def __getattr__(self, name: str):
        from coursekit.classroom.author.tables import solutions

        return getattr(solutions(self._course, self._unit), name)
