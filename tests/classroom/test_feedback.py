"""The proof that `check` meets the student: no wrong answer is accepted, nearly all are named or placed.

`wrong/played.json` holds 306 wrong answers written while the released notebooks were played as a student
would, without a look at the rest; `wrong/slips.json` those of 1,660 such answers that taught something, and
what is to be said of them; the other files hold those that their authors thought of while they wrote the
feedback. `right/` holds right versions of every exercise in other styles.
"""

from __future__ import annotations

import contextlib
import importlib
import itertools
import json
import linecache
import math
import os
import subprocess
import sys
import warnings
from collections import Counter
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import coursekit
from coursekit import classroom
from coursekit.classroom import repair
from coursekit.classroom.course import the_course
from coursekit.classroom.mistakes import Solved
from coursekit.classroom.repair import finite, texts
from tests.classroom.mutations import reasons, survivors

HERE = Path(__file__).resolve().parent
COURSE = the_course()
EXERCISES = [(unit, exercise) for unit in COURSE.units for exercise in COURSE.exercises(unit)]
NAMES = [exercise.name for _, exercise in EXERCISES]
FILES = sorted((HERE / "wrong").glob("*.json"))
NUMBERS = itertools.count()
HELPED = ("named", "placed", "error", "misfit", "library")
MODULES = ("lie", "rotations", "dh", "robots", "ik", "path", "jacobians", "singularity", "Robot")


def names_of_a_notebook() -> dict:
    """What a student has around: numpy, the package, and every exercise solved."""
    names = {"np": np, "numpy": np, "math": math, **{name: getattr(coursekit, name) for name in MODULES}}
    for unit, exercise in EXERCISES:
        names[exercise.name] = getattr(Solved(unit), exercise.name)
    return names


def run(code: str, names: dict, readable: bool = True) -> None:
    """As a notebook runs a cell: its text can be read afterwards."""
    file = f"<answer {next(NUMBERS)}>"
    if readable:
        linecache.cache[file] = (len(code), None, code.splitlines(True), file)
    exec(compile(code, file, "exec"), names)


def diagnosis(row: dict, readable: bool = True) -> classroom.Diagnosis:
    names = names_of_a_notebook()
    with contextlib.suppress(Exception):
        run(row.get("setup", ""), names)
    run(row["code"], names, readable)
    return classroom.diagnose(row["exercise"], names[row["exercise"]])


@cache  # which takes an argument left out and its default for two things
def judged(file: Path, readable: bool) -> list[tuple[dict, classroom.Diagnosis]]:
    return [(row, diagnosis(row, readable)) for row in json.loads(file.read_text("utf-8"))]


@pytest.mark.parametrize("readable", [True, False], ids=["with its text", "without"])
@pytest.mark.parametrize("file", FILES, ids=lambda path: path.stem)
def test_no_wrong_answer_is_accepted_and_nearly_all_are_helped(file, readable):
    rows = judged(file, readable)
    accepted = [f"{row['exercise']}: {row['label']}" for row, found in rows if found.right]
    assert not accepted
    count = Counter(found.kind for _, found in rows)
    helped = sum(count[kind] for kind in HELPED)
    left = [f"{row['exercise']}: {row['label']}" for row, found in rows if found.kind not in HELPED]
    assert helped >= 0.95 * len(rows), (count, left)


def test_a_slip_is_told_in_the_words_that_it_was_given():
    missed = [
        f"{row['exercise']}, {row['label']}: {found.text}"
        for row, found in judged(HERE / "wrong" / "slips.json", True)
        if row["say"] not in " ".join(found.text.split())
    ]
    assert not missed, "\n\n".join(missed)


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.stem)
def test_the_first_sentence_is_short(file):
    """Text first, no wall of numbers; what is asked for later is another matter."""
    for row, found in judged(file, True):
        first = found.text.split("\n  Look again")[0].split("\n  Example")[0]
        assert len(first.splitlines()) <= 8, f"{row['exercise']}, {row['label']}: {found.text}"
        assert len(found.say.split()) <= 60, f"{row['exercise']}, {row['label']}: {found.say}"


ONE_BEND = """
def wrist_angles(R):
    t4, t6 = -np.arctan2(R[1, 0], -R[2, 0]), -np.arctan2(R[0, 1], R[0, 2])
    return np.array({})
"""
T5 = "np.arctan2(np.hypot(R[0, 1], R[0, 2]), R[0, 0])"


@pytest.mark.parametrize(
    "exercise, code, say",
    [
        ("wrist_angles", ONE_BEND.format(f"[t4, {T5}, t6]"), "that is one of the two solutions"),
        ("wrist_angles", ONE_BEND.format(f"[[t4, {T5}, t6]]"), "that is one of the two solutions"),
        ("det_from_blocks", "def det_from_blocks(J):\n    return np.linalg.det(J)", "of the whole J"),
        ("lost_motion", "def lost_motion(J): return np.linalg.svd(J)[2][:, -1]", "look at line 1: "),
    ],
)
def test_what_was_wrong_is_said_however_it_was_written(exercise, code, say):
    assert say in diagnosis({"exercise": exercise, "code": code}).say


FASTEST = """
def largest_speed(q, points, v_max):
    slope = np.abs(np.diff(q, axis=0)) / np.linalg.norm(np.diff(points, axis=0), axis=1)[:, None]
    j = np.argmax(slope.max(axis=0))
    return v_max[j] / slope[:, j].max()
"""


@pytest.mark.parametrize(
    "exercise, code, say",
    [
        (
            "fk_dh",
            "def fk_dh(rows, theta, base, tool):\n    T = base\n"
            "    for (a, alpha, d, offset), q in zip(rows, theta):\n"
            "        T = T @ dh_transform(a, alpha, d, q + offset)\n"
            "    return T\n",
            "the last factor takes frame n to the tool; look at line 5",
        ),
        (
            "slerp",
            "def slerp(R_0, R_1, t):\n    return R_0 @ lie.exp3(angle_axis(R_0.T @ R_1))\n",
            "it does not use its argument `t`; look at line 2",
        ),
        ("largest_speed", FASTEST, "then look for the smallest. Look at line 3"),
        (
            "adjoint",
            "def turned(p, R): return R @ lie.hat3(p)\n\n\ndef adjoint(T):\n    A = np.zeros((6, 6))\n"
            "    A[:3, :3] = A[3:, 3:] = T[:3, :3]\n    A[3:, :3] = turned(T[:3, 3], T[:3, :3])\n"
            "    return A\n",
            "then cross with p; look at line 1 of `turned`",
        ),
    ],
)
def test_a_mistake_with_a_name_has_its_line(exercise, code, say):
    assert say in diagnosis({"exercise": exercise, "code": code}).say


@pytest.mark.parametrize(
    "body",
    [
        "w = np.einsum('i->i', w)\n    return np.r_[w, -np.cross(w, q)]",
        "if kind.upper() == 'REVOLUTE': return np.r_[w, np.cross(w, q)]\n    return np.r_[np.zeros(3), w]",
        "w = np.einsum('i->i', w)\n    return np.r_[w, -np.cross(w, q)] if w[0] > 0 else no",
    ],
    ids=["no word at all", "a right one and a wrong sign", "an error"],
)
def test_a_word_of_another_use_is_not_called_wrong(body):
    code = f"def joint_screw(kind, w, q):\n    {body}\n"
    told = diagnosis({"exercise": "joint_screw", "code": code})
    assert not told.right and "letter for letter" not in told.say


def test_a_line_is_found_where_a_function_has_arguments_by_name_alone():
    """`*, sign` of a function of the student's own ended the check with an error, and a default was lost."""
    code = """
def lever(w, q, *, sign, power=1):
    return (-sign) ** power * np.cross(w, q)


def joint_screw(kind, w, q):
    w = w / np.linalg.norm(w)
    return np.r_[w, lever(w, q, sign=-1)] if kind == "revolute" else np.r_[np.zeros(3), w]
"""
    told = diagnosis({"exercise": "joint_screw", "code": code})
    assert "look at line" in told.say, told.say


def test_a_trial_may_be_the_first_that_uses_a_part_of_numpy(tmp_path):
    """`sum` of an array imports the rest of itself then: a trial that fails at that is an edit overlooked."""
    (tmp_path / "mine.py").write_text("def count(x):\n    return int((x > 1).sum())\n")
    code = "from coursekit.classroom.repair.sandbox import Sandbox; import mine, numpy as np;"
    code += "print(Sandbox(mine.count).compile()(np.array([0.0, 2.0, 3.0])))"
    path = os.pathsep.join([str(tmp_path), str(HERE.parents[1])])
    done = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    assert done.stdout == "2\n", done.stderr


def test_what_an_edit_is_warned_of_is_not_told():
    """An eigenvector made real by some edit: no line of numpy's about it stands in the notebook."""
    code = """
def quaternion(R):
    w, V = np.linalg.eig(R)
    k = np.real(V[:, np.argmin(np.abs(w - 1))])
    angle = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    return np.r_[np.cos(angle / 2), np.sin(angle / 2) * k]
"""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert not diagnosis({"exercise": "quaternion", "code": code}).right
    assert not told, [str(warning.message) for warning in told]


def test_no_edit_hands_lapack_what_it_does_not_come_back_from(capfd):
    """Of an infinity svd may never return, and of a NaN lstsq writes to the terminal itself."""
    code = """
def newton_step(J_b, T_sb, T_sd):
    e = lie.log6(np.linalg.inv(T_sb) @ T_sd)
    return np.linalg.lstsq(J_b, e, rcond=None)
"""
    assert not diagnosis({"exercise": "newton_step", "code": code}).right
    assert "DLASCL" not in "".join(capfd.readouterr())
    for trial in (finite.NUMPY.linalg.svd, finite.NUMPY.linalg.pinv):
        with pytest.raises(np.linalg.LinAlgError):
            trial(np.diag([np.inf, 1.0]))


@pytest.mark.parametrize(
    "setup",
    [
        "line = np.poly1d([1.0, 0.0])",
        "things = [(1.0 for _ in '1')]\nline = lambda x: x if things else 0",
        "def made():\n    def line(x): return x or later\n    return line\n    later = 1\nline = made()",
    ],
    ids=["not hashable", "not to be copied", "not there yet"],
)
def test_a_line_is_looked_for_beside_odd_names(setup):
    code = """
def joint_screw(kind, w, q):
    w = np.asarray(w, float) / np.linalg.norm(w)
    if kind == "prismatic":
        return np.r_[np.zeros(3), w]
    return np.r_[w, line(1.0) * np.cross(w, q)]
"""
    found = diagnosis({"exercise": "joint_screw", "setup": setup, "code": code})
    assert found.say and not found.right


METHOD = """
class Arm:
    def {name}(self, a3, d4):
        return 1.1 * np.arctan2(a3, d4)


elbow_angle = Arm().{name}
"""


@pytest.mark.parametrize(
    "code, line",
    [
        (METHOD.format(name="elbow"), "line 2 of `elbow`"),
        (
            "f = lambda a3, d4: np.arctan2(d4, a3); elbow_angle = lambda a3, d4: 1.1 * np.arctan2(a3, d4)",
            "",
        ),
        (
            "import sympy as s\nx = s.symbols('x:2')\nelbow_angle = s.lambdify(x, 1.1 * s.atan2(x[0], x[1]))",
            "",
        ),
    ],
    ids=["a method that needs no self", "two lambdas in a line", "made by sympy"],
)
def test_a_line_is_told_only_where_it_is_known(code, line):
    found = diagnosis({"exercise": "elbow_angle", "code": code})
    assert found.say.startswith("your answer is 1.1 times the right one")
    assert (line in found.say) if line else ("look at" not in found.say), found.say


@pytest.mark.parametrize(
    "helpers",
    [
        "def one(x, k): return two(x, k - 1) if k else x * 1.1\n"
        "def two(x, k): return one(x, k - 1) if k else x * 1.1",
        "def one(x, k):\n    seen, more = [x], [x]\n    for _ in range(99):\n        seen = seen + more\n"
        "    return seen[-1] * 1.1",
    ],
    ids=["a whole number", "a list"],
)
def test_an_edit_with_which_something_doubles_in_each_round_ends(helpers):
    """k - 1 squared in each call: numbers of 2 ** 1000 digits."""
    code = f"{helpers}\n\n\ndef elbow_angle(a3, d4):\n    return one(np.arctan2(a3, d4) + a3**3, 4)\n"
    assert not diagnosis({"exercise": "elbow_angle", "code": code}).right


def test_a_place_that_tells_nothing_is_not_told():
    """Three kinds of edit at no line of its own: then what is right already is said."""
    three = [("reversed", ""), ("halves", ""), ("flipped", "")]
    assert texts.sentence(three, [1]) == ""
    assert texts.sentence(three, [4]) == "look at line 4: something in this line"
    assert texts.sentence(three[:1], [0]).startswith("look at several lines at once: an order")
    assert texts.sentence(three[:1], [1]).startswith("look at the arguments: an order")
    assert texts.sentence(three[:1], [1, 2]).startswith("look at line 2: an order")
    two = texts.sentence([("transposed", ""), ("inverse", "")], [4])
    assert two.endswith("something that is transposed or should be; or an inverse that is missing")


def test_repair_keeps_its_budget(monkeypatch):
    """Trials are counted, not timed: none takes more than its share of executed lines."""
    spent = []

    class Counted(repair._Search):
        def __init__(self, *arguments):
            super().__init__(*arguments)
            spent.append(self)

    monkeypatch.setattr(repair, "_Search", Counted)
    for row in json.loads((HERE / "wrong" / "played.json").read_text("utf-8"))[::6]:
        diagnosis(row)
    assert len(spent) > 10
    assert all(search.left > -max(map(len, [search.examples])) for search in spent)
    assert all(search.box.ticks <= 3_001 for search in spent)


@pytest.mark.parametrize("unit", COURSE.units)
def test_right_versions_in_other_styles_pass(unit):
    module = importlib.import_module(f"tests.classroom.right.{unit}")
    versions = {name: value for name, value in vars(module).items() if "__" in name.strip("_")}
    for exercise in COURSE.exercises(unit):
        mine = {name: f for name, f in versions.items() if name.split("__")[0] == exercise.name}
        assert len(mine) >= 3, f"{exercise.name} has {len(mine)} versions"
        for name, function in mine.items():
            found = classroom.diagnose(exercise.name, function)
            assert found.right, f"{name}: {found.text}"


@pytest.mark.parametrize("unit, exercise", EXERCISES, ids=NAMES)
def test_every_edit_of_the_solution_is_noticed_or_equivalent(unit, exercise):
    """A survivor without a reason is a wrong function that `check` accepts; a reason without one is stale."""
    known = reasons(unit).get(exercise.name, {})
    assert all(known.values()), "a reason is a sentence"
    found = survivors(COURSE, unit, exercise)
    accepted = "\n".join(f"  {text} ({where})" for text, where in found.items() if text not in known)
    assert not accepted, (
        f"`check` accepts {exercise.name} with one of these edits:\n{accepted}\n"
        f"If an edit changes nothing, survivors/{unit}.json says why, under {exercise.name}: the words before"
        " the parenthesis, and a reason. If it is wrong, the exercise needs an edge that finds it out."
    )
    stale = sorted(set(known) - set(found))
    assert not stale, f"reasons in survivors/{unit}.json for edits that no longer survive"
