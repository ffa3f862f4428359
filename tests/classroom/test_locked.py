"""The locked library: functions that are asked for are physically absent, allowed ones work."""

from __future__ import annotations

import ast
import os
import subprocess
import sys

import pytest

from coursekit import robots
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import locked
from coursekit.classroom.grader.box import bubblewrap
from tests.classroom.small import grade_small

PROBE = """
import numpy as np
from coursekit import Robot, check, dh, lie, robots, rotations, view
from coursekit.view import text
def attempt(call):
    try:
        return "works" if call() is not None else "none"
    except Exception as error:
        return type(error).__name__
arm = robots.planar_2r(1.0, 0.8)
print(*[attempt(call) for call in (
    lambda: lie.hat3([1, 2, 3]),
    lambda: arm.S,
    lambda: lie.exp6([0, 0, 1, 0, 0, 0]),
    lambda: arm.fk([0.1, 0.2]),
    lambda: Robot(arm.S, arm.M).B,
    lambda: Robot.from_screws(arm.S, arm.M),
    lambda: rotations.rotz(1.0),
    lambda: view.explore(arm).anything.at_all(1),
    lambda: text.number(1.5),
    lambda: check("fk", None),
)])
"""


@pytest.fixture(scope="module")
def probed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("library")
    locked.write_files(locked.locked_files(("lie.hat3", "robots")), folder)
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    run = subprocess.run(
        [sys.executable, "-c", PROBE], env=environment, capture_output=True, text=True, cwd=folder
    )
    assert run.returncode == 0, run.stderr
    return run.stdout.split()


def test_allowed_works_and_everything_else_raises(probed):
    assert probed[:2] == ["works", "works"]
    assert probed[2:7] == ["LibraryLocked"] * 5


def test_every_robot_can_be_made_where_answers_are_locked(tmp_path):
    """An exercise may hand over any arm, also one whose tables are made from its axes, and its fk."""
    locked.write_files(locked.locked_files(("robots", "robot.Robot.fk")), tmp_path)
    code = "from coursekit import robots\nfor arm in robots.all().values(): print(arm.fk(arm.home).shape)"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, cwd=tmp_path
    )
    assert run.stdout.splitlines() == ["(4, 4)"] * len(robots.all()), run.stderr


def test_view_and_check_do_nothing(probed):
    assert probed[7:] == ["works", "works", "none"]


def test_what_nobody_needs_has_no_body():
    """Only a line that raises is left, and not one formula."""
    sources = locked.locked_sources(("lie.hat3",))
    body = next(
        node.body
        for node in ast.parse(sources["lie.py"]).body
        if isinstance(node, ast.FunctionDef) and node.name == "log6"
    )
    assert [ast.unparse(line) for line in body] == ["_locked('lie.log6')"]
    allowed = locked.locked_sources(("lie.log6",))
    assert len(allowed["lie.py"]) > len(sources["lie.py"])


def test_every_allowed_name_exists():
    """A misprint on a list would lock what students need."""
    names = {
        name
        for file, source in locked.locked_sources(()).items()
        for name, _ in locked._functions(locked._module(file), ast.parse(source))
    }
    prefixes = {name.rsplit(".", k)[0] for name in names for k in (0, 1, 2)} | names
    course = the_course()
    for unit in course.units:
        assert set(course.allowed(unit)) <= prefixes, unit


@pytest.mark.box
@pytest.mark.skipif(not bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here")
def test_the_whole_course_can_be_graded(tmp_path):
    """Its canaries: in the box every solved notebook gets full marks, every untouched one none."""
    (tmp_path / "in").mkdir()
    assert grade_small(tmp_path / "in", tmp_path / "out", course=the_course()).startswith("0 students")
