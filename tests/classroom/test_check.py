"""What a student reads from `check`: one or two lines that name the mistake and no expected number."""

from __future__ import annotations

import re

import numpy as np
import pytest

from coursekit.classroom import CheckFailed, check, compare
from coursekit.classroom.author import tables
from coursekit.classroom.check import demand, judge, permitted
from coursekit.classroom.course import the_course
from coursekit.classroom.exercise import Exercise, Hint, thaw
from tests.classroom.small import COURSE

EXERCISES = {e.name: e for e in COURSE.exercises("nb01")}
RIGHT = tables.solutions(COURSE, "nb01")


def verdict(name, function):
    return judge(EXERCISES[name], function, COURSE.samples("nb01")[name], COURSE.allowed("nb01"))


def raising(theta, l1, l2):
    x = l1 - l1
    return 1 / x


def with_library(theta, l1, l2):
    from coursekit import robots

    return robots.planar_2r(l1, l2).fk(theta)[:2, 3]


def with_allowed_library(theta, l1, l2):
    from coursekit import rotations

    a = rotations.rotz(theta[0])[:2, 0]
    b = rotations.rotz(theta.sum())[:2, 0]
    return l1 * a + l2 * b


def unwritten(theta, l1, l2):
    raise NotImplementedError


@pytest.mark.parametrize(
    "function, outcome, text",
    [
        (unwritten, "unwritten", "not written yet"),
        (raising, "error", r"ZeroDivisionError: .*\n  in line 3 of raising: return 1 / x"),
        (lambda theta: 1, "error", r"does not take the arguments of fk\(theta, l1, l2\)"),
        (lambda *a: None, "misfit", "None"),
        (lambda *a: [1, 2, 3], "misfit", r"the shape is \(3,\), expected \(2,\)"),
        (lambda *a: RIGHT.fk(*a) + 0j, "misfit", "complex"),
        (lambda *a: "text", "misfit", "dtype"),
        (lambda *a: [[1], [1, 2]], "misfit", "not an array of numbers"),
        (lambda *a: [np.nan, 1], "misfit", "NaN"),
        (lambda *a: -RIGHT.fk(*a), "common", "every sign"),
        (lambda *a: 1000 * RIGHT.fk(*a), "common", "1000 times"),
        (lambda *a: RIGHT.fk(*a) + 0.1, "different", r"example 1 differs\n  for the arguments \[-?\d"),
        (with_library, "forbidden", r"calls coursekit's own robots.planar_2r"),
        (with_allowed_library, "right", "right on 4 examples"),
        (3, "misfit", r'check\("fk", fk\)'),
    ],
)
def test_it_says_what_is_wrong(function, outcome, text):
    found = verdict("fk", function)
    assert found.outcome == outcome, found
    assert re.search(text, found.text)
    assert found.text.count("\n") <= 1


def test_no_verdict_tells_an_expected_number():
    """Not one number of the right answers, to four digits, in anything it says about wrong ones."""
    wrong = [lambda *a: RIGHT.fk(*a) + 0.1, lambda *a: [np.nan, 1], lambda *a: [1, 2, 3]]
    texts = " ".join(verdict("fk", function).text for function in wrong)
    for row in COURSE.samples("nb01")["fk"]:
        for number in RIGHT.fk(*thaw(row["args"])):
            assert f"{abs(number):.4g}" not in texts


def test_a_law_is_named_when_it_breaks():
    found = verdict("ik", lambda p, l1, l2: np.array([0.1, 0.2]))
    assert found.outcome == "law"
    assert "do not reach the point" in found.text


def test_any_solution_is_right_and_so_is_a_set_in_any_order():
    def other_elbow(p, l1, l2):
        return RIGHT.ik_all(p, l1, l2)[1] + [2 * np.pi, 0]

    assert verdict("ik", other_elbow).right
    assert verdict("ik_all", lambda *a: RIGHT.ik_all(*a)[::-1] + [[2 * np.pi, -2 * np.pi]]).right
    assert verdict("ik_all", lambda *a: RIGHT.ik_all(*a)[[0, 0]]).outcome == "different"


def test_the_face_prints_returns_none_and_raises_in_ci_only(monkeypatch, capsys):
    name = the_course().exercises("nb01")[0].name

    def not_begun(*args):
        raise NotImplementedError

    monkeypatch.delenv("CI", raising=False)
    assert check(name, not_begun) is None
    assert capsys.readouterr().out.startswith(f"… {name}: ")
    monkeypatch.setenv("CI", "true")
    with pytest.raises(CheckFailed):
        check(name, lambda *a: None)
    with pytest.raises(ValueError, match=f"no exercise '{name}s'. Did you mean '{name}'"):
        check(name + "s", not_begun)
    with pytest.raises(CheckFailed):
        demand(name, lambda *a: None, "[]")


# ---- comparing, with numbers and with hashes


@pytest.mark.parametrize("kind", ["close", "angle", "up_to_sign", "columns_up_to_sign", "set"])
def test_hashes_and_numbers_agree_about_what_is_near(kind):
    rng = np.random.default_rng(3)
    shape = {"columns_up_to_sign": (3, 3), "set": (4, 3)}.get(kind, (3,))
    for _ in range(200):
        value = rng.uniform(-4, 4, shape)
        tol = 10.0 ** rng.uniform(-8, -4)
        stored = compare.fingerprint(kind, value, tol, "salt")
        # a product of two entries, each at most 4, moves at most 8 times as far as they do
        slack = 16 if "sign" in kind else 1
        near = value + rng.uniform(-1, 1, shape) * tol * 0.99 / slack
        far = value + np.where(rng.random(shape) < 0.5, 1, -1) * 1e4 * tol
        assert compare.matches(kind, near, tol, "salt", stored)
        assert compare.same(kind, near, value, tol)
        assert not compare.matches(kind, far, tol, "salt", stored)
        assert not compare.same(kind, far, value, tol)


def test_what_counts_as_the_same():
    v = np.array([0.3, -0.4, 0.5])
    m = np.random.default_rng(1).normal(size=(3, 3))
    s = np.array([[0.1, 0.2], [0.3, 0.4], [np.pi, -1]])
    pairs = [
        ("angle", v, v + [2 * np.pi, 0, -4 * np.pi], True),
        ("angle", np.array([np.pi]), np.array([-np.pi]), True),
        ("close", v, -v, False),
        ("up_to_sign", v, -v, True),
        ("up_to_sign", v, v * [1, -1, 1], False),
        ("columns_up_to_sign", m, m * [1, -1, 1], True),
        ("columns_up_to_sign", m, m[:, ::-1], False),
        ("set", s, s[[2, 0, 1]] * [[-1, 1], [1, 1], [1, 1]], True),
        ("set", s, s[[0, 0, 1]], False),
        ("set", s, s[:2], False),
    ]
    for kind, a, b, expected in pairs:
        assert compare.same(kind, a, b, 1e-6) is expected
        assert compare.matches(kind, b, 1e-6, "salt", compare.fingerprint(kind, a, 1e-6, "salt")) is expected


def test_the_tolerance_is_at_least_a_bin_everywhere():
    """Half a bin beside an edge as well as in the middle of a bin; two bins away never."""
    for offset in np.linspace(-0.5, 0.5, 41):
        right = np.array([(7 + offset) * 1e-3])
        stored = compare.fingerprint("close", right, 1e-3, "s")
        assert all(compare.matches("close", right + d * 1e-3, 1e-3, "s", stored) for d in (-0.99, 0.99))
        assert not any(compare.matches("close", right + d * 1e-3, 1e-3, "s", stored) for d in (-2.01, 2.01))


# ---- definitions that make no sense are refused


def test_an_exercise_is_checked_when_it_is_defined():
    with pytest.raises(ValueError, match="valid are close"):
        Exercise("f(x)", 1, lambda rng: (1,), (), compare="nearly")
    with pytest.raises(ValueError, match="2 shapes, 1 ways"):
        Exercise("f(x)", 1, lambda rng: (1,), ((), (3,)), compare=("close",))
    several = Exercise("f(x)", 1, lambda rng: (1,), ((), (3,)), hints=(Hint("a", "b"),))
    assert (several.name, several.several, several.kinds) == ("f", True, ("close", "close"))


def test_names_on_the_list_of_allowed_functions():
    allowed = ("lie", "robot.Robot.fk")
    assert permitted("lie.exp6", allowed)
    assert permitted("robot.Robot.fk", allowed)
    assert not permitted("robot.Robot.__post_init__", allowed)
    assert permitted("robot.Robot.__repr__", allowed)
    assert not permitted("lies.exp6", allowed)
    assert permitted("robot.Robot.__post_init__", ("robot.Robot",))
