"""Every exercise of every notebook: the solution passes, each typical mistake is told by its own hint."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coursekit.classroom import check, compare
from coursekit.classroom.author import notebook, tables
from coursekit.classroom.check import judge
from coursekit.classroom.course import Course, the_course
from coursekit.classroom.exercise import answer, misshapen, thaw

HERE = Path(__file__).resolve().parent / "course"
COURSES = {"small": Course(HERE / "notebooks", HERE), "course": the_course()}

EXERCISES = [
    pytest.param(course, unit, exercise, id=f"{name}-{unit}-{exercise.name}")
    for name, course in COURSES.items()
    for unit in course.units
    for exercise in course.exercises(unit)
]
HINTS = [
    pytest.param(*p.values, hint, id=f"{p.id}-{hint.key}") for p in EXERCISES for hint in p.values[2].hints
]
UNITS = [pytest.param(c, unit, id=f"{n}-{unit}") for n, c in COURSES.items() for unit in c.units]


def verdict(course, unit, exercise, function):
    return judge(exercise, function, course.samples(unit)[exercise.name], course.allowed(unit))


@pytest.mark.parametrize("course, unit, exercise", EXERCISES)
def test_the_solution_is_right(course, unit, exercise):
    solution = getattr(tables.solutions(course, unit), exercise.name)
    assert verdict(course, unit, exercise, solution).right


@pytest.mark.parametrize("course, unit, exercise", EXERCISES)
def test_the_solution_is_right_on_many_inputs_and_keeps_the_laws(course, unit, exercise):
    solution = getattr(tables.solutions(course, unit), exercise.name)
    rng = np.random.default_rng(1)
    for _ in range(50):
        arguments = exercise.arguments(rng)
        json.dumps(arguments, allow_nan=False)  # they travel as plain data
        parts = answer(exercise, solution(*thaw(arguments)))
        assert misshapen(exercise, parts) == ""
        assert all(np.isfinite(part).all() for part in parts) or "nan" in exercise.unit
        value = tuple(parts) if exercise.several else parts[0]
        for text, law in exercise.laws:
            assert law(solution, thaw(arguments), value), text


@pytest.mark.parametrize("course, unit, exercise, hint", HINTS)
def test_a_typical_mistake_gets_its_own_hint(course, unit, exercise, hint):
    found = verdict(course, unit, exercise, course.wrong(unit)[exercise.name][hint.key])
    assert (found.outcome, found.text) == (hint.key, hint.text)


@pytest.mark.parametrize("course, unit, exercise, hint", HINTS)
def test_a_typical_mistake_is_wrong_on_hidden_inputs_too(course, unit, exercise, hint):
    """Or somebody who makes it would be graded right."""
    solution = getattr(tables.solutions(course, unit), exercise.name)
    wrong = course.wrong(unit)[exercise.name][hint.key]
    rng = np.random.default_rng(2)
    agreed = []
    with np.errstate(all="ignore"):
        for _ in range(exercise.n):
            arguments = exercise.arguments(rng)
            right_parts = answer(exercise, solution(*thaw(arguments)))
            parts = answer(exercise, wrong(*thaw(arguments)))
            if exercise.compare == "any_solution":
                agreed.append(not check_laws(exercise, arguments, parts))
            else:
                agreed.append(
                    all(
                        compare.same(kind, a, b, exercise.tol)
                        for kind, a, b in zip(exercise.kinds, parts, right_parts, strict=True)
                    )
                )
    assert not all(agreed)


def check_laws(exercise, arguments, parts):
    from coursekit.classroom.check import broken_law

    return broken_law(exercise, None, arguments, parts)


@pytest.mark.parametrize("course, unit", UNITS)
def test_exercises_hints_and_notebook_name_the_same_things(course, unit):
    exercises = {e.name: e for e in course.exercises(unit)}
    wrong = course.wrong(unit)
    assert set(wrong) == set(exercises)
    for name, exercise in exercises.items():
        keys = [hint.key for hint in exercise.hints]
        assert len(set(keys)) == len(keys)
        assert len({hint.text for hint in exercise.hints}) == len(keys), "two hints read the same"
        assert set(wrong[name]) == set(keys)
    cells = notebook.read(course.notebook(unit))["cells"]
    solved = [c["metadata"]["nbgrader"]["grade_id"] for c in cells if notebook.is_solution(c)]
    points = {c["source"].strip(): c["metadata"]["nbgrader"]["points"] for c in cells if notebook.is_check(c)}
    assert sorted(solved) == sorted(exercises)
    assert points == {f'check("{n}", {n})': e.points for n, e in exercises.items()}


@pytest.mark.parametrize("course, unit", UNITS)
def test_sample_tables_are_up_to_date(course, unit):
    """Floats are compared with some slack: another machine's sine may differ in its last digit."""
    stored, fresh = course.samples(unit), json.loads(tables.dump(tables.table(course, unit)))
    assert stored.keys() == fresh.keys(), "run `coursekit samples`"
    for name, rows in fresh.items():
        for old, new in zip(stored[name], rows, strict=True):
            assert flat(old["args"]) == pytest.approx(flat(new["args"]), rel=1e-9, abs=1e-12, nan_ok=True)
            assert old["wrong"].keys() == new["wrong"].keys()
            assert [p["shape"] for p in old["right"]] == [p["shape"] for p in new["right"]]


def flat(value):
    if isinstance(value, list):
        return [x for y in value for x in flat(y)]
    return [value] if isinstance(value, int | float) else []


def test_the_course_has_at_least_three_mistakes_an_exercise():
    course = the_course()
    assert all(len(e.hints) >= 3 for unit in course.units for e in course.exercises(unit))


def test_check_is_reachable_from_the_face():
    import coursekit

    assert coursekit.check is check


# -- what an author reads who made a slip ------------------------------------------------------------------


def course_with(tmp_path, exercise, wrong="lambda x: x + 1", solution="def double(x):\n    return 2 * x"):
    """A course of one exercise, `double`, in a folder of its own."""
    for folder in ("exercises", "mistakes"):
        (tmp_path / folder).mkdir()
    start = "from coursekit.classroom.exercise import Exercise, Hint\n"
    (tmp_path / "exercises" / "nb01.py").write_text(f"{start}EXERCISES = [Exercise({exercise})]")
    (tmp_path / "mistakes" / "nb01.py").write_text(f"WRONG = {{'double': {{'plus_one': {wrong}}}}}")
    cell = {"cell_type": "code", "id": "a", "source": solution, "outputs": [], "execution_count": None}
    cell["metadata"] = {"nbgrader": {"solution": True}}
    notebook.write(tmp_path / "01_a.ipynb", {"cells": [cell], "metadata": {}})
    return Course(tmp_path, tmp_path)


GOOD = "'double(x)', 1, lambda rng: (rng.normal(),), (), hints=(Hint('plus_one', 'times'),)"


@pytest.mark.parametrize(
    "slip, text",
    [
        ({"wrong": "lambda x: 1 / 0"}, "double, plus_one raised ZeroDivisionError: division by zero"),
        ({"exercise": GOOD.replace(", (), ", ", (2,), ")}, r"double, the solution: the shape is \(\)"),
        ({"solution": "def twice(x):\n    return 2 * x"}, "no solution of double: no cell with nbgrader.sol"),
    ],
)
def test_a_slip_in_an_exercise_is_named(tmp_path, slip, text):
    with pytest.raises(ValueError, match=text):
        tables.write_samples(course_with(tmp_path, **{"exercise": GOOD, **slip}))


def test_without_a_slip_the_table_is_written(tmp_path):
    assert tables.write_samples(course_with(tmp_path, GOOD)) == ["nb01"]
