"""Every exercise of every notebook: the solution passes, each typical mistake is told by its own hint."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coursekit.classroom.author import notebook, tables
from coursekit.classroom.check import check, examples_of, judged
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
    examples = examples_of(exercise, course.samples(unit)[exercise.name])
    return judged(exercise, function, examples, course.allowed(unit))[0]


def hidden(course, unit, exercise, count, seed):
    rows = tables.rows(course, unit, exercise, max(count, exercise.least), np.random.default_rng(seed))
    return examples_of(exercise, {"examples": rows})


@pytest.mark.parametrize("course, unit, exercise", EXERCISES)
def test_the_solution_is_right(course, unit, exercise):
    solution = getattr(tables.solutions(course, unit), exercise.name)
    found = verdict(course, unit, exercise, solution)
    assert found.right, found


@pytest.mark.parametrize("course, unit, exercise", EXERCISES)
def test_the_solution_is_right_on_many_inputs_and_keeps_the_laws(course, unit, exercise):
    solution = getattr(tables.solutions(course, unit), exercise.name)
    for _, arguments, _ in exercise.draws(np.random.default_rng(1), 50):
        json.dumps(arguments, allow_nan=False)  # they travel as plain data
        parts = answer(exercise, solution(*thaw(arguments)))
        assert misshapen(exercise, parts) == ""
        assert all(np.isfinite(part).all() for part in parts) or "nan" in exercise.unit
        for text, law in exercise.laws:
            assert law(solution, thaw(arguments), exercise.value(parts)), text
        if exercise.residual:
            right = exercise.value(parts)
            assert isinstance(exercise.residual(thaw(arguments), right, right), str)


@pytest.mark.parametrize("course, unit, exercise, hint", HINTS)
def test_a_typical_mistake_gets_its_own_hint(course, unit, exercise, hint, monkeypatch):
    monkeypatch.setattr("coursekit.classroom.verdict.repair", lambda *_: "")  # its line: test_feedback
    found = verdict(course, unit, exercise, course.wrong(unit)[exercise.name][hint.key])
    assert (found.kind, found.step, found.say) == ("named", hint.key, hint.text)


@pytest.mark.parametrize("course, unit, exercise, hint", HINTS)
def test_a_typical_mistake_is_wrong_on_hidden_inputs_too(course, unit, exercise, hint):
    """Or somebody who makes it would be graded right."""
    examples = hidden(course, unit, exercise, exercise.n, 2)
    wrong = course.wrong(unit)[exercise.name][hint.key]
    with np.errstate(all="ignore"):
        parts = [tuple(answer(exercise, wrong(*thaw(e.arguments)))) for e in examples]
    assert not all(e.agrees(p) for e, p in zip(examples, parts, strict=True))


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
    for name, one in fresh.items():
        assert stored[name]["place"] == one["place"], "run `coursekit samples`"
        assert flat(stored[name]) == pytest.approx(flat(one), rel=1e-6, abs=1e-8, nan_ok=True)
        for old, new in zip(stored[name]["examples"], one["examples"], strict=True):
            assert old["case"] == new["case"]
            assert old["wrong"].keys() == new["wrong"].keys()


def flat(value):
    if isinstance(value, dict):
        return [x for key in sorted(value) for x in flat(value[key])]
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
    head, body = solution.split("\n")
    marked = f"{head}\n    ### BEGIN SOLUTION\n{body}\n    ### END SOLUTION"
    cells = [
        {"cell_type": "code", "id": name, "source": source, "metadata": {"nbgrader": role}}
        for name, source, role in (
            ("a", marked, {"grade_id": "double", "solution": True}),
            ("b", 'check("double", double)', {"grade_id": "check-double", "grade": True}),
        )
    ]
    notebook.write(tmp_path / "01_a.ipynb", {"cells": cells, "metadata": {}})
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
