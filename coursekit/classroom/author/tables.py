"""The sample tables: public inputs, the right answer and that of each typical mistake, all as plain numbers.

Instructors write them (`coursekit samples`); they are committed, and the same in the repository and in a
release, so that a check takes one path everywhere.
"""

from __future__ import annotations

import json
import os
import re
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from ..course import TOML, Course, the_course
from ..exercise import Exercise, Misfit, answer, misshapen, thaw
from ..your_course import YourCourse
from . import notebook
from .verify import verify


def write_samples(course: Course | None = None) -> list[str]:
    """Write every table of the course's own, and where solutions live elsewhere the notebooks without them.

    The list of units. ValueError, and nothing is written, if the course is not whole.
    """
    course = course or the_course()
    verify(course, tables=False)
    units = [unit for unit in course.units if course.exercises(unit) and course.is_at_home(unit)]
    made = {course.samples_path(unit): dump(table(course, unit)) for unit in units}
    for path, text in made.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    if isinstance(course, YourCourse) and course.is_split:
        _write_public(course)
    return units


def _write_public(course: YourCourse) -> None:
    for unit in course.units:
        solved = course.notebook(unit)
        if solved.parent == course.solved:
            notebook.write(course.notebooks / solved.name, notebook.student_version(notebook.read(solved)))
    pointer = course.solved / TOML
    if not pointer.exists():
        there = Path(os.path.relpath(course.notebooks, course.solved)).as_posix()
        pointer.write_text(f"public = {json.dumps(there)}\n", encoding="utf-8", newline="\n")


def dump(tables: dict) -> str:
    """JSON, one example a line."""
    exercises = []
    for name, one in tables.items():
        lines = ",\n".join("  " + json.dumps(row) for row in one["examples"])
        head = f'{json.dumps(name)}: {{"place": {json.dumps(one["place"], ensure_ascii=False)}, "examples": ['
        exercises.append(f"{head}\n{lines}\n]}}")
    return "{\n" + ",\n".join(exercises) + "\n}\n"


def table(course: Course, unit: str, only_own: bool = False) -> dict:
    """{exercise: {place, examples}} of a unit; only_own: of those that ask for one's own arm."""
    tables = {}
    places = sections(course, unit)
    for exercise in course.exercises(unit):
        if only_own and not exercise.own:
            continue
        rng = np.random.default_rng(zlib.crc32(f"samples/{unit}/{exercise.name}".encode()))
        examples = rows(course, unit, exercise, exercise.least + exercise.samples, rng)
        tables[exercise.name] = {"place": places.get(exercise.name, ""), "examples": examples}
    return tables


def sections(course: Course, unit: str) -> dict[str, str]:
    """{exercise: the heading it stands under}, read off the solved notebook."""
    places, heading = {}, ""
    for cell in notebook.read(course.notebook(unit))["cells"]:
        if cell["cell_type"] == "markdown":
            found = re.findall(r"^#{2,3} +(.+)$", cell["source"], re.M)
            heading = found[-1].strip() if found else heading
        elif notebook.is_solution(cell):
            places[cell["metadata"]["nbgrader"].get("grade_id", "")] = heading
    return places


def rows(course: Course, unit: str, exercise: Exercise, count: int, rng: np.random.Generator) -> list[dict]:
    """The examples of one exercise: every edge, and drawn ones up to `count`."""
    right = getattr(solutions(course, unit), exercise.name, None)
    if right is None:
        raise ValueError(
            f"{course.notebook(unit).name} holds no solution of {exercise.name}: "
            "no cell with nbgrader.solution in its metadata defines it"
        )
    wrong = course.wrong(unit).get(exercise.name, {})
    made = []
    for case, arguments, tol in exercise.draws(rng, count):
        answers = {key: _answer(exercise, wrong[key], arguments, key) for key in wrong}
        row = {"case": case, "args": arguments, "right": _answer(exercise, right, arguments, "the solution")}
        made.append({**row, "wrong": answers, **({} if tol == exercise.tol else {"tol": tol})})
    return made


def _answer(exercise: Exercise, function: Callable, arguments: list, what: str) -> list:
    """What a function answers, as plain data with ten digits: more than any tolerance needs."""
    try:
        with np.errstate(all="ignore"):
            parts = answer(exercise, function(*thaw(arguments)))
        if what == "the solution" and (text := misshapen(exercise, parts)):
            raise Misfit(text)
    except Misfit as misfit:
        raise ValueError(f"{exercise.name}, {what}: {misfit}") from None
    except Exception as error:
        raise ValueError(f"{exercise.name}, {what} raised {type(error).__name__}: {error}") from error
    return [_short(part) for part in parts]


def _short(part: np.ndarray) -> list | float:
    digits = np.vectorize(lambda x: float(f"{x:.10g}"), otypes=[float])
    return (digits(part) if part.size else part).tolist()


def solutions(course: Course, unit: str) -> SimpleNamespace:
    """The functions of the unit's solved notebook."""
    path = course.notebook(unit)
    return _solutions(path, path.stat().st_mtime_ns)


@cache
def _solutions(path: Path, changed: int) -> SimpleNamespace:
    return notebook.references(path)
