"""The sample tables: public inputs, hashes of the right answer and of each typical mistake.

Instructors write them (`coursekit samples`); they are committed, and the same in the repository and in a
release, so that a check takes one path everywhere.
"""

from __future__ import annotations

import json
import zlib
from functools import cache
from types import SimpleNamespace

import numpy as np

from .. import compare
from ..check import salt
from ..course import Course, the_course
from ..exercise import Exercise, Misfit, answer, misshapen, thaw
from . import notebook


def write_samples(course: Course | None = None) -> list[str]:
    """Write every unit's table; the list of units."""
    course = course or the_course()
    for unit in course.units:
        course.samples_path(unit).parent.mkdir(exist_ok=True)
        course.samples_path(unit).write_text(dump(table(course, unit)), encoding="utf-8", newline="\n")
    return course.units


def dump(tables: dict) -> str:
    """JSON, one example a line."""
    exercises = []
    for name, rows in tables.items():
        lines = ",\n".join("  " + json.dumps(row) for row in rows)
        exercises.append(f"{json.dumps(name)}: [\n{lines}\n]")
    return "{\n" + ",\n".join(exercises) + "\n}\n"


def table(course: Course, unit: str) -> dict:
    """{exercise: [{args, right, wrong: {hint: ...}}, ...]} of a unit."""
    tables = {}
    for exercise in course.exercises(unit):
        missing = {hint.key for hint in exercise.hints} ^ set(course.wrong(unit).get(exercise.name, ()))
        if missing:
            raise ValueError(f"{exercise.name}: hint or wrong function missing: {', '.join(sorted(missing))}")
        rng = np.random.default_rng(zlib.crc32(f"samples/{unit}/{exercise.name}".encode()))
        tables[exercise.name] = rows(course, unit, exercise, exercise.samples, rng)
    return tables


def rows(course: Course, unit: str, exercise: Exercise, count: int, rng: np.random.Generator) -> list[dict]:
    """The examples of one exercise."""
    right = getattr(solutions(course, unit), exercise.name, None)
    if right is None:
        raise ValueError(
            f"{course.notebook(unit).name} holds no solution of {exercise.name}: "
            "no cell with nbgrader.solution in its metadata defines it"
        )
    wrong = course.wrong(unit).get(exercise.name, {})
    return [_row(exercise, k, rng, right, wrong) for k in range(count)]


def _row(exercise: Exercise, k: int, rng, right, wrong: dict) -> dict:
    arguments = exercise.arguments(rng)

    def hashed(function, what):
        try:
            with np.errstate(all="ignore"):
                parts = answer(exercise, function(*thaw(arguments)))
            if function is right and (text := misshapen(exercise, parts)):
                raise Misfit(text)
        except Misfit as misfit:
            raise ValueError(f"{exercise.name}, {what}: {misfit}") from None
        except Exception as error:
            raise ValueError(f"{exercise.name}, {what} raised {type(error).__name__}: {error}") from error
        return [
            compare.fingerprint(kind, part, exercise.tol, salt(exercise, k, i))
            for i, (kind, part) in enumerate(zip(exercise.kinds, parts, strict=True))
        ]

    return {
        "args": arguments,
        "right": hashed(right, "the solution"),
        "wrong": {hint.key: hashed(wrong[hint.key], hint.key) for hint in exercise.hints},
    }


@cache
def solutions(course: Course, unit: str) -> SimpleNamespace:
    """The functions of the unit's solved notebook."""
    return notebook.references(course.notebook(unit))
