"""A sheet for ten minutes: one of the student's own functions, three questions, answers elsewhere."""

from __future__ import annotations

import html
import json
import re
import signal

import numpy as np
import pytest

from coursekit.__main__ import main
from coursekit.classroom import document, own
from coursekit.classroom.author import notebook, tables
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import frames, viva
from coursekit.kinematics import lie

COURSE = the_course()


@pytest.fixture(scope="module")
def submissions(tmp_path_factory):
    """Ada handed in everything as the solved notebooks have it, Bo an untouched one, Cy one function."""
    folder = tmp_path_factory.mktemp("in")
    for unit in COURSE.units:
        solved = notebook.read(COURSE.notebook(unit))
        document.stamp(solved, "1", "ada")
        (folder / "ada").mkdir(exist_ok=True)
        document.write(folder / "ada" / COURSE.notebook(unit).name, solved)
    given = notebook.student_version(notebook.read(COURSE.notebook("nb02")))
    (folder / "bo").mkdir()
    document.write(folder / "bo" / COURSE.notebook("nb02").name, given)
    mine = "# <script>alert(1)</script>\n\n@abs\ndef adjoint(T):\n    a = '<b>'\n    b = 2\n    return T"
    next(c for c in given["cells"] if document.role(c).get("grade_id") == "adjoint")["source"] = mine
    (folder / "cy").mkdir()
    document.write(folder / "cy" / COURSE.notebook("nb02").name, given)
    return folder


ALL = [exercise.name for unit in COURSE.units for exercise in COURSE.exercises(unit)]


@pytest.mark.parametrize("name", ALL)
def test_every_exercise_has_a_sheet_without_its_answers(name, submissions, tmp_path):
    sheet, answers = viva.viva("ada", submissions, tmp_path, exercise=name, seed=3)
    text, told = sheet.read_text("utf-8"), answers.read_text("utf-8")
    assert f"def {name}" in text and re.findall(r"<h2>(\d)</h2>", text) == ["1", "2", "3"]
    kept = re.findall(r"<section><h3>Answer</h3>(.*?)</section>", told, re.S)
    assert len(kept) == 3 and "Answer" not in text
    assert (
        re.sub(r"<section>.*?</section>", "", told, flags=re.S).partition("<h2>")[2]
        == (text.partition("<h2>")[2])
    )
    for answer in kept:
        assert len(re.sub(r"<[^>]+>", "", answer).strip()) > 10
    assert not re.search(r"<script|https?://", text + told)


def test_the_numbers_are_those_of_the_course(submissions, tmp_path):
    """Read back from the page, put into the solution: what the instructor's page says."""
    sheet, answers = viva.viva("ada", submissions, tmp_path, exercise="home_pose", seed=1)
    numbers = re.search(r"lengths = \[(.*?)\]", html.unescape(sheet.read_text("utf-8")))[1]
    lengths = np.array([float(x) for x in numbers.split()])
    right = tables.solutions(COURSE, "nb02").home_pose(lengths)
    first = re.search(r"The right answer:</p><pre>(.*?)</pre>", answers.read_text("utf-8"), re.S)[1]
    shown = np.array([float(x) for x in re.findall(r"-?\d+\.?\d*", first)]).reshape(4, 4)
    np.testing.assert_allclose(shown, right, atol=2e-3)


def test_lines_are_numbered_as_in_the_cell_and_nothing_of_it_is_html(submissions, tmp_path):
    sheet, _ = viva.viva("cy", submissions, tmp_path)
    text = sheet.read_text("utf-8")
    assert "   3  @abs\n   4  def adjoint(T):\n   5      a = &#x27;&lt;b&gt;&#x27;" in text
    assert "alert" not in text


def test_other_seeds_ask_otherwise_and_the_same_seed_the_same(submissions, tmp_path):
    pages = [viva.viva("ada", submissions, tmp_path / str(i), seed=s)[0] for i, s in enumerate((1, 1, 2, 3))]
    texts = [page.read_text("utf-8") for page in pages]
    assert texts[0] == texts[1] and len(set(texts)) == 3


@pytest.mark.parametrize("make", frames.QUESTIONS, ids=lambda make: make.__name__)
@pytest.mark.parametrize("number", range(4))
def test_what_is_said_of_frames_holds(make, number):
    """Worked out another way than the page does."""
    robot = own.arm_of(own.seed_of(f"s{number}"))
    text, answer = make(robot, np.random.default_rng(number))
    points = [np.array([float(x) for x in p.split(",")]) for p in re.findall(r"\(([^()]*,[^()]*)\)", answer)]
    figures = [float(x) for x in re.findall(r"[+-]?\d+", text)]
    zero = np.zeros(6)
    if make is frames._another_space_frame:
        up, turn = figures[0] / 1000, np.sign(figures[1])
        x, y, z = robot.M[:3, 3]
        np.testing.assert_allclose(points[0], 1000 * np.array([turn * y, -turn * x, z - up]), atol=0.051)
    elif make is frames._longer_tool:
        far = robot.M[:3, 3] + figures[0] / 1000 * robot.M[:3, 0]
        np.testing.assert_allclose(points[0], 1000 * far, atol=0.051)
        q, w = robot.places[4], robot.S[:3, 4]
        np.testing.assert_allclose(points[1], robot.M[:3, :3].T @ np.cross(q - far, w) * 1.0, atol=6e-4)
    elif make is frames._joint_counts_backwards:
        joint = int(figures[0]) - 1
        for sign, point in zip((-1, 1), points, strict=True):
            T = lie.exp6(sign * np.pi / 6 * robot.S[:, joint]) @ robot.M
            np.testing.assert_allclose(point, 1000 * T[:3, 3], atol=0.051)
    elif make is frames._another_zero:
        joint, turn = int(figures[0]) - 1, figures[1] * np.pi / 180
        T = lie.exp6(turn * robot.S[:, joint]) @ robot.M
        np.testing.assert_allclose(points[0], 1000 * T[:3, 3], atol=0.051)
    else:
        joint, step = int(re.search(r"joint (\d)", text)[1]) - 1, 1e-6
        theta = zero + step * (np.arange(6) == joint)
        speed = (robot.fk(theta)[:3, 3] - robot.M[:3, 3]) / step
        np.testing.assert_allclose(points[0], speed, atol=6e-4)


def test_it_is_about_the_students_own_arm(submissions, tmp_path):
    sheet, _ = viva.viva("ada", submissions, tmp_path)
    arm = own.sheet_of(own.seed_of("ada")).lengths
    assert f"column {1000 * arm['column']:.0f}, shoulder {1000 * arm['shoulder']:.0f}" in sheet.read_text(
        "utf-8"
    )


@pytest.mark.parametrize(
    ("student", "more", "says"),
    [
        ("adda", [], "there is no student 'adda'. Did you mean 'ada'?"),
        ("bo", [], "the student did not write any function of an exercise"),
        ("cy", ["--exercise", "home_pose"], "the student did not write a function 'home_pose'"),
        ("cy", ["--exercise", "home_pos"], "there is no exercise 'home_pos'. Did you mean 'home_pose'?"),
    ],
)
def test_what_cannot_be_asked_is_one_sentence(student, more, says, submissions, tmp_path, capsys):
    assert main(["viva", student, str(submissions), str(tmp_path / "out"), *more]) == 2
    error = capsys.readouterr().err
    assert says in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_damaged_notebook_is_named(submissions, tmp_path):
    (tmp_path / "in" / "di").mkdir(parents=True)
    (tmp_path / "in" / "di" / COURSE.notebook("nb02").name).write_text(json.dumps({"cells": 3}))
    with pytest.raises(ValueError, match=r"02_msb_derivation\.ipynb: not a readable notebook"):
        viva.viva("di", tmp_path / "in", tmp_path / "out")


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="Windows has none")
def test_a_notebook_that_takes_hours_to_read_is_named(tmp_path, monkeypatch):
    """For Python's tokenizer each of the spaces is an error of its own."""
    monkeypatch.setattr(viva, "READING", 0.5, raising=False)
    (tmp_path / "in" / "slow").mkdir(parents=True)
    cell = {"cell_type": "code", "source": "x" + " " * 190_000 + "!"}
    name = COURSE.notebook("nb01").name
    (tmp_path / "in" / "slow" / name).write_text(json.dumps({"cells": [cell]}))
    with pytest.raises(ValueError, match=r"to read its code takes more than 0.5 s"):
        viva.viva("slow", tmp_path / "in", tmp_path / "out")
