"""The library in the box: what answers an exercise is physically absent, what is allowed works."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coursekit import robots
from coursekit.classroom.author import tables
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import box, follow_on, locked, worker
from coursekit.classroom.grader.box import bubblewrap
from tests.classroom.small import grade_small

needs_box = pytest.mark.skipif(
    not bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here"
)
UNITS = the_course().units
PROBE = """
import numpy as np
from coursekit import Robot, dh, ik, lie, robots, rotations
from coursekit.kinematics import checks
from coursekit.view import text
def attempt(call):
    try:
        return "works" if call() is not None else "none"
    except Exception as error:
        return type(error).__name__
arm = robots.planar_2r()
print(*[attempt(call) for call in (
    lambda: lie.hat3([1, 2, 3]),
    lambda: arm.S,
    lambda: text.number(1.5),
    lambda: lie.exp6([0, 0, 1, 0, 0, 0]),
    lambda: arm.fk([0.1, 0.2]),
    lambda: arm.B(),
    lambda: Robot(arm.S, arm.M),
    lambda: Robot.from_screws(arm.S, arm.M),
    lambda: rotations.rotz(1.0),
    lambda: ik.analytic(arm, arm.M).theta,
    lambda: robots.planar_2r(1.0, l2=0.8),
    lambda: checks.array([1, 2], (2,), "x"),
)])
"""


def run(folder, code):
    """What plain Python prints with a locked library."""
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_allowed_works_and_everything_else_raises(tmp_path):
    locked.write_files(locked.locked_files(("lie.hat3",)), tmp_path)
    probed = run(tmp_path, PROBE)
    assert probed[:3] == ["works"] * 3
    assert probed[3:] == ["LibraryLocked"] * 9


@pytest.mark.parametrize("unit", UNITS)
def test_what_is_allowed_works_as_it_does_outside(tmp_path, unit):
    """Its own examples, run in the locked library, but for those that need what is absent there."""
    course = the_course()
    locked.write_files(worker.library(course, unit, 1), tmp_path)
    code = """
import builtins, doctest, importlib
for name in NAMES:
    module = importlib.import_module(f"coursekit.kinematics.{name}")
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    for one in doctest.DocTestFinder().find(module):
        names = {n for e in one.examples for n in compile(e.source, "", "exec").co_names}
        if all(hasattr(builtins, n) or n in vars(module) or n in ("tolist", "round", "pi") for n in names):
            runner.run(one)
    print(runner.tries, runner.failures)
"""
    modules = sorted({name.split(".")[0] for name in course.allowed(unit)} - {"robot"})
    numbers = [int(x) for x in run(tmp_path, code.replace("NAMES", repr(modules)))]
    assert all(numbers[0::2]) and not any(numbers[1::2]), dict(zip(modules, numbers[0::2], strict=True))


def test_robots_are_tables_of_numbers(tmp_path):
    """Every arm, with what it is made from; its fk only where that is on the list."""
    locked.write_files(locked.locked_files(("robot.Robot.fk",)), tmp_path)
    code = """
import json
from coursekit import robots
print(json.dumps({k: [r.n, r.S.tolist(), r.home.tolist(), r.fk([r.home, r.home + 0.3]).tolist(),
                      r.standard_dh and r.standard_dh.a.tolist()] for k, r in robots.all().items()}))
"""
    found = json.loads("".join(run(tmp_path, code)))
    assert list(found) == list(robots.all())
    for name, (n, S, home, T, a) in found.items():
        robot = robots.all()[name]
        assert n == robot.n and a == robot.standard_dh.a.tolist()
        assert np.array_equal(S, robot.S) and np.array_equal(home, robot.home)
        assert np.abs(np.array(T) - robot.fk([robot.home, robot.home + 0.3])).max() < 1e-14


def test_what_robots_can_do_is_what_they_do_outside(tmp_path):
    """Given with the question; every name that a list allows is there."""
    can = ("fk", "jacobian_body", "jacobian_space", "n")
    known = ("lie", *(f"robot.Robot.{name}" for name in can))
    for unit in UNITS:
        asked = {one for one in the_course().allowed(unit) if one.startswith("robot.Robot.")}
        assert asked <= set(known), unit
    locked.write_files(locked.locked_files(known), tmp_path)
    source, names = locked.methods(known)
    assert sorted(names) == ["jacobian_body", "jacobian_space"] and locked.methods(("lie",))[1] == []
    code = f"""
import json, runner
from coursekit import robots
arms = robots.all()
runner.teach({source!r}, {names!r})
print(json.dumps({{k: [r.jacobian_space([r.home + 0.2, r.home]).tolist(),
                       r.jacobian_body(r.home + 0.2).tolist()] for k, r in arms.items()}}))
"""
    for name, (J_s, J_b) in json.loads("".join(run(tmp_path, code))).items():
        robot = robots.all()[name]
        assert np.abs(np.array(J_s) - robot.jacobian_space([robot.home + 0.2, robot.home])).max() < 1e-13
        assert np.abs(np.array(J_b) - robot.jacobian_body(robot.home + 0.2)).max() < 1e-13


def test_what_is_not_allowed_is_cut_out():
    """Not one formula of it is left."""
    sources = locked.locked_sources(("lie.hat3",))
    functions = {f.name for f in ast.walk(ast.parse(sources["lie.py"])) if isinstance(f, ast.FunctionDef)}
    assert functions == {"hat3"}
    assert "log6" in locked.locked_sources(("lie.log6",))["lie.py"]


def test_every_allowed_name_exists():
    """A misprint on a list would lock what students need."""
    room = locked.PACKAGE / "kinematics"
    course = the_course()
    for unit in course.units:
        for name in course.allowed(unit):
            module, *rest = name.split(".")
            text = (room / f"{module}.py").read_text("utf-8")
            assert not rest or f"def {rest[-1]}(" in text, f"{unit}: {name}"


# ---- nothing in the box answers an exercise


def questions(unit, count=6):
    course, asked = the_course(), []
    for exercise in course.exercises(unit):
        rng = np.random.default_rng(3)
        rows = tables.rows(course, unit, exercise, max(count, exercise.least), rng)
        asked.append([exercise.name, [[row["args"], row["right"]] for row in rows]])
    return asked


def walked(folder, files, asked):
    """What a walk through the box says."""
    locked.write_files(files, folder)
    cell = Path(__file__).with_name("walk.py").read_text("utf-8")
    assert 'json.loads("[]")' in cell
    cell = cell.replace('json.loads("[]")', f"json.loads({json.dumps(asked)!r})")
    one = box.Box(folder, box.Limits(), bubblewrap())
    try:
        assert "error" not in one.ask({"run": cell, "name": "<cell>"}, 60)
        found = []
        for name in ("walk", "files"):
            request = {"ask": name, "calls": [[]], "several": 0, "arguments": []}
            (answer,) = one.ask(request, 120)["answers"]
            found.append([float(x) for x in answer["parts"][0]["values"]] if "parts" in answer else answer)
    finally:
        one.close()
    letters, (strange,) = found
    return "".join(chr(int(x)) for x in letters), strange


@pytest.mark.box
@needs_box
@pytest.mark.parametrize("unit", UNITS)
def test_nothing_that_can_be_reached_in_the_box_answers_an_exercise(tmp_path, unit):
    assert walked(tmp_path, worker.library(the_course(), unit, 1), questions(unit)) == ("", 0)


@pytest.mark.box
@needs_box
def test_a_walk_finds_what_would_answer_an_exercise(tmp_path):
    """With all of the library allowed: else the test above could not fail."""
    everything = ("lie", "rotations", "subproblems")
    asked = [one for unit in ("nb02", "nb03", "nb06") for one in questions(unit)]
    solved, strange = walked(tmp_path, locked.locked_files(everything), asked)
    assert {one.split(" by ")[0] for one in solved.split("; ")} >= {
        "adjoint",
        "subproblem1",
        "quaternion",
        "zyx",
    }
    assert strange == 0


@pytest.mark.box
@needs_box
def test_the_box_has_the_libraries_that_students_have(tmp_path):
    """numpy, sympy and matplotlib with all that they need, and not those that would answer for them."""
    locked.write_files(locked.locked_files(()), tmp_path)
    cell = f"""
import importlib, warnings
def works():
    import matplotlib.pyplot as plt, sympy
    plt.plot([1, 2]); plt.savefig("/tmp/figure.png"); plt.close()
    return sum(importlib.import_module(name) is not None for name in {(*box.LIBRARIES, *box.NEEDED)!r})
def others():
    found = 0
    for name in ("meshcat", "scipy", "nbgrader", "pytest", "jupyterlab"):
        try:
            importlib.import_module(name).__file__
            found += 1
        except (ImportError, AttributeError):
            pass
    return found
"""
    one = box.Box(tmp_path, box.Limits(), bubblewrap())
    try:
        assert "error" not in one.ask({"run": cell, "name": "<cell>"}, 60)
        counts = []
        for name in ("works", "others"):
            request = {"ask": name, "calls": [[]], "several": 0, "arguments": []}
            counts.append(one.ask(request, 60)["answers"][0]["parts"][0]["values"])
    finally:
        one.close()
    assert counts == [[repr(float(len(box.LIBRARIES + box.NEEDED)))], ["0.0"]]


@pytest.mark.box
@needs_box
def test_the_memory_of_a_box_is_watched_also_while_it_talks(tmp_path, monkeypatch):
    locked.write_files(locked.locked_files(()), tmp_path)
    talk = """
import fcntl, os
pipes = [int(n) for n in os.listdir("/proc/self/fd") if os.path.exists(f"/proc/self/fd/{n}")]
(pipe, *_) = [n for n in pipes if n > 2 and fcntl.fcntl(n, fcntl.F_GETFL) & os.O_WRONLY]
while True:
    os.write(pipe, b"{}\\n" * 1000)
"""
    monkeypatch.setattr(box, "used", lambda family: 1 << 40)
    one = box.Box(tmp_path, box.Limits(), bubblewrap())
    try:
        with pytest.raises(box.BoxLost, match="MB of memory"):
            one.ask({"run": talk, "name": "<cell>"}, 3)
    finally:
        one.close()


@pytest.mark.box
@needs_box
def test_the_whole_course_can_be_graded(tmp_path):
    """Its canaries: in the box every solved notebook gets full marks, every untouched one none."""
    (tmp_path / "in").mkdir()
    assert grade_small(tmp_path / "in", tmp_path / "out", course=the_course()).startswith("0 students")


@pytest.mark.parametrize("unit", UNITS)
def test_follow_on_never_brings_the_solution_in_question(unit):
    """Earlier solutions enter a box of their own; the one that is judged does not."""
    course = the_course()
    names = [exercise.name for exercise in course.exercises(unit)]
    for number, name in enumerate(names[1:], 1):
        sources = follow_on.solutions(course, unit, names[:number], name)
        space = {}
        for source in sources:
            exec(source, space)
        assert name not in space
        assert set(names[:number]) <= space.keys()
