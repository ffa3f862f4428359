"""Is a course whole? Every command of an instructor asks this first: nothing half right is handed out."""

from __future__ import annotations

from ..course import Course, the_course
from ..exercise import Exercise
from ..your_course import YourCourse
from . import notebook


def verify(course: Course, tables: bool = True) -> None:
    """ValueError, one sentence with file and field, unless exercises, mistakes, solutions and weights match.

    tables : the sample tables, too: False before they are written
    """
    known: dict[str, str] = {}  # exercise -> unit
    for unit in course.units:
        for name in (exercise.name for exercise in course.exercises(unit)):
            if name in known:
                where = f"{course.exercises_path(known[name])} and {course.exercises_path(unit)}"
                raise ValueError(f"{where}, EXERCISES: two exercises are named {name!r}")
            known[name] = unit
    _weights(course, known)
    for unit in course.units:
        exercises = course.exercises(unit)
        _cells(course, unit, exercises)
        for exercise in exercises:
            _mistakes(course, unit, exercise)
        if tables:
            _tables(course, unit, exercises)


def _mistakes(course: Course, unit: str, exercise: Exercise) -> None:
    hints, wrong = {hint.key for hint in exercise.hints}, set(course.wrong(unit).get(exercise.name, ()))
    if len(hints) < len(exercise.hints):
        raise ValueError(f"{course.exercises_path(unit)}, {exercise.name}, hints: two have the same key")
    if missing := hints - wrong:
        raise ValueError(
            f"{course.mistakes_path(unit)}, WRONG[{exercise.name!r}]: no function makes the mistake of the "
            f"hint {', '.join(sorted(missing))}"
        )
    if spare := wrong - hints:
        raise ValueError(
            f"{course.exercises_path(unit)}, {exercise.name}, hints: no hint for the mistake "
            f"{', '.join(sorted(spare))} of {course.mistakes_path(unit).name}"
        )


def _cells(course: Course, unit: str, exercises: list[Exercise]) -> None:
    path = course.notebook(unit)
    if not path.exists():
        raise ValueError(f"{path} does not exist: {unit} needs its solved notebook there")
    cells = notebook.read(path)["cells"]
    solved = [c["metadata"]["nbgrader"].get("grade_id", "") for c in cells if notebook.is_solution(c)]
    checked = [c["metadata"]["nbgrader"].get("grade_id", "") for c in cells if notebook.is_check(c)]
    for exercise in exercises:
        for found, grade_id, what in (
            (solved, exercise.name, "solution: true"),
            (checked, f"check-{exercise.name}", "grade: true"),
        ):
            if found.count(grade_id) != 1:
                raise ValueError(
                    f"{path}, metadata.nbgrader: one cell with grade_id {grade_id!r} and {what} is expected, "
                    f"there are {found.count(grade_id)}"
                )
        cell = next(c for c in cells if notebook.is_check(c) and notebook.role(c)["grade_id"] == grade_id)
        points = notebook.role(cell).get("points", exercise.points)
        if points != exercise.points:
            raise ValueError(
                f"{path}, {grade_id}, metadata.nbgrader.points: {points} there, {exercise.points} in "
                f"{course.exercises_path(unit).name}"
            )
    for cell in cells:
        try:
            if not notebook.is_solution(cell):
                notebook.without_solution(cell["source"])
            elif notebook.without_solution(cell["source"]) == cell["source"].rstrip("\n"):
                raise ValueError(
                    "no ### BEGIN SOLUTION and ### END SOLUTION, so all of it would be handed out"
                )
        except ValueError as error:
            raise ValueError(f"{path}, cell {cell.get('id', '')}: {error}") from None


def _tables(course: Course, unit: str, exercises: list[Exercise]) -> None:
    table = course.samples(unit)
    for exercise in exercises:
        rows = table.get(exercise.name, {}).get("examples", [])
        stale = not rows or set(rows[0]["wrong"]) != {hint.key for hint in exercise.hints}
        if stale or any(len(row["args"]) != len(exercise.arguments) for row in rows):
            raise ValueError(
                f"{course.samples_path(unit)}, {exercise.name}: not written for this exercise; run "
                "`coursekit samples`"
            )


def _weights(course: Course, known: dict[str, str]) -> None:
    """A table of weights names every exercise, and no other."""
    if not course.weights or not isinstance(course, YourCourse):
        return
    for name, unit in known.items():
        if name not in course.weights:
            raise ValueError(f"{course.toml}, weights: {name} of {course.stem_of(unit)} has none")
    for name in course.weights:
        if name not in known:
            elsewhere = f"; it ships in {the_course().find(name)[0]}" if the_course().has(name) else ""
            raise ValueError(f"{course.toml}, weights: the course has no exercise {name!r}{elsewhere}")
