"""A release is searched for everything that would give an answer away, and is used as a student would."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from coursekit.classroom.author import notebook, release
from coursekit.classroom.course import CLASSROOM, the_course
from tests.classroom import leaks
from tests.classroom.small import COURSE

COURSES = {"small": COURSE, "course": the_course()}


@pytest.fixture(scope="module", params=COURSES)
def released(request, tmp_path_factory):
    course = COURSES[request.param]
    out = tmp_path_factory.mktemp("release") / "out"
    release.release(out, course)
    return course, out


def texts(out) -> dict[str, str]:
    return {str(p.relative_to(out)): p.read_text("utf-8") for p in out.rglob("*") if p.is_file()}


def test_it_holds_what_is_needed_and_no_more(released):
    _, out = released
    assert {p.name for p in out.iterdir()} == {
        "README.md",
        "coursekit",
        "LICENSE",
        "environment.txt",
        "notebooks",
        "pyproject.toml",
        "release.json",
    }
    modules = {p.name for p in (out / "coursekit" / "classroom").iterdir()}
    ours = {p.name for p in CLASSROOM.iterdir() if p.is_dir() or p.suffix == ".py"} - {"__pycache__"}
    assert modules == ours - set(release.INSTRUCTORS)
    assert {"exercises", "samples", "check.py"} <= modules
    assert not [p for p in out.rglob("*") if p.name.startswith(".git") or p.name == "__pycache__"]


def test_no_solution_and_no_marker_is_left(released):
    course, out = released
    assert leaks.found(course, {name: t for name, t in texts(out).items() if "kinematics" not in name}) == {}


def test_no_cell_for_instructors_and_no_output_is_left(released):
    course, out = released
    for unit in course.units:
        solved = notebook.read(course.notebook(unit))
        given = notebook.read(out / "notebooks" / course.notebook(unit).name)
        secret = [c["source"] for c in solved["cells"] if "instructor" in notebook.tags(c)]
        sources = [c["source"] for c in given["cells"]]
        assert not set(secret) & set(sources)
        assert len(sources) == len(solved["cells"]) - len(secret)
        code = [c for c in given["cells"] if c["cell_type"] == "code"]
        assert all(c["outputs"] == [] and c["execution_count"] is None for c in code)
        for exercise in course.exercises(unit):
            assert any(exercise.name in s and "raise NotImplementedError" in s for s in sources)


def run_in(folder, code: str) -> str:
    """Python in a release, which it imports coursekit from."""
    environment = {k: v for k, v in os.environ.items() if k != "CI"} | {"PYTHONPATH": str(folder)}
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.mark.parametrize("released", ["course"], indirect=True)
def test_a_student_can_check_there(released):
    course, out = released
    unit = course.units[0]
    exercise = course.exercises(unit)[0]
    cells = notebook.read(course.notebook(unit))["cells"]
    solution = next(c["source"] for c in cells if notebook.is_solution(c))
    stub = notebook.without_solution(solution)
    say = f"from coursekit import check\nimport numpy as np\n{{}}\ncheck({exercise.name!r}, {exercise.name})"
    assert run_in(out, say.format(stub)) == f"… {exercise.name}: not written yet\n"
    assert run_in(out, say.format(solution)).startswith(f"✓ {exercise.name}: right on")
    where = run_in(out, "import coursekit; print(coursekit.__file__)")
    assert where.startswith(str(out))


@pytest.mark.parametrize("released", ["course"], indirect=True)
@pytest.mark.parametrize("command", [["grade", "a", "b"], ["samples"], ["release", "x"], ["site", "x"]])
def test_instructors_commands_are_not_there(released, command):
    _, out = released
    environment = {**os.environ, "PYTHONPATH": str(out)}
    run = [sys.executable, "-m", "coursekit", *command]
    done = subprocess.run(run, cwd=out, env=environment, capture_output=True, text=True)
    assert done.returncode == 2
    assert "not part of the students' version" in done.stderr


def test_it_never_overwrites_what_is_no_release(tmp_path):
    (tmp_path / "diary.txt").write_text("mine")
    with pytest.raises(ValueError, match="exists already and is no release"):
        release.release(tmp_path, COURSE)
    assert [p.name for p in tmp_path.iterdir()] == ["diary.txt"]
    assert not list(tmp_path.parent.glob(".release*"))


def test_an_unbalanced_marker_is_an_error():
    with pytest.raises(ValueError, match="unbalanced"):
        notebook.without_solution("def f():\n    ### BEGIN SOLUTION\n    return 1\n")
