"""What a student reads from `check`: first the shortest true sentence, then as much as is asked for."""

from __future__ import annotations

import contextlib
import itertools
import linecache
import re
import sys

import numpy as np
import pytest

from coursekit import classroom
from coursekit.classroom import CheckFailed, attempt, check, compare
from coursekit.classroom.author import tables
from coursekit.classroom.check import demand, examples_of, judged
from coursekit.classroom.course import the_course
from coursekit.classroom.exercise import Exercise, Hint
from coursekit.classroom.library import permitted
from coursekit.classroom.told import told
from tests.classroom.small import COURSE

EXERCISES = {e.name: e for e in COURSE.exercises("nb01")}
RIGHT = tables.solutions(COURSE, "nb01")
NUMBERS = itertools.count()


def verdict(name, function):
    examples = examples_of(EXERCISES[name], COURSE.samples("nb01")[name])
    return judged(EXERCISES[name], function, examples, COURSE.allowed("nb01"))[0]


def written(body, name="fk", arguments="theta, l1, l2", **names):
    """A function as a notebook has it: with a text that can be read."""
    lines = "\n".join("    " + line for line in body.strip("\n").split("\n"))
    text = f"def {name}({arguments}):\n{lines}\n"
    file = f"<cell {next(NUMBERS)}>"
    linecache.cache[file] = (len(text), None, text.splitlines(True), file)
    namespace = {"np": np, "__name__": "__main__", **names}
    exec(compile(text, file, "exec"), namespace)
    return namespace[name]


def with_library(theta, l1, l2):
    from coursekit import robots

    return robots.planar_2r(l1, l2).fk(theta)[:2, 3]


def with_allowed_library(theta, l1, l2):
    from coursekit import rotations

    a = rotations.rotz(theta[0])[:2, 0]
    b = rotations.rotz(theta.sum())[:2, 0]
    return l1 * a + l2 * b


def _no_words(self):
    raise ValueError


ODD = type("Odd", (BaseException,), {"__str__": _no_words})


def unwritten(*args):
    raise NotImplementedError


def test_a_cell_that_did_not_run_is_told_before_the_function_that_is_still_there(monkeypatch, capsys):
    stub = "def fk_dh(*args):\n    raise NotImplementedError\n"
    given = ["", "import numpy as np", stub, "def fk_dh(rows)\n    return 3\n", "check()"]
    monkeypatch.setattr("coursekit.classroom.source.cells", lambda: given)
    monkeypatch.delenv("CI", raising=False)
    check("fk_dh", unwritten)
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert "did not run: line 1: expected ':'" in first
    assert second.startswith("… fk_dh")
    for runs in (stub, f"%matplotlib inline\n!ls\n{stub}", f"%%time\n{stub}"):
        given[3] = runs
        check("fk_dh", unwritten)
        assert capsys.readouterr().out.startswith("… fk_dh")


# ---- 1: it cannot be judged


@pytest.mark.parametrize(
    "function, kind, text",
    [
        (unwritten, "unwritten", "not written yet"),
        (written("x = l1 - l1\nreturn 1 / x"), "error", r"line 3 of fk raises ZeroDiv.*: `return 1 / x`\n"),
        (written("x = l1 - l1\nreturn 1 / x"), "error", r"there x = 0"),
        (written("x = l1\nx = [theta[2], x]\nreturn x"), "error", r"there x = .*, theta has shape \(2,\)"),
        (written("return np.array(theta, theta)"), "error", r"\n  np.array takes one list, "),
        (written("return np.linalg.inv(theta[:, None])"), "error", r"needs a square matrix; np.linalg.pinv "),
        (written("raise SystemExit(1)"), "error", "line 2 of fk raises SystemExit: 1"),
        (written("raise Odd()", Odd=ODD), "error", "line 2 of fk raises Odd: `raise Odd"),
        (lambda theta: 1, "error", r"does not take the arguments of fk\(theta, l1, l2\)"),
        (lambda *a: None, "misfit", "returns None"),
        (written("print(theta)"), "misfit", "prints the answer and returns None"),
        (lambda *a: [1, 2, 3], "misfit", r"the shape is \(3,\), expected \(2,\)"),
        (lambda *a: RIGHT.fk(*a) + 0j, "misfit", "complex"),
        (lambda *a: "text", "misfit", "dtype"),
        (lambda *a: [[1], [1, 2]], "misfit", "not an array of numbers"),
        (written("return np.log(-abs(theta) - l1 * l2)"), "misfit", r"NaN or infinity; it comes from line 2"),
        (
            written("return np.sqrt(-np.abs(theta) - l1 * l2)"),
            "misfit",
            r"line 2 \(the root of a negative number: ",
        ),
        (lambda *a: [np.nan, 1], "misfit", "NaN"),
        (3, "misfit", r'check\("fk", fk\)'),
    ],
)
def test_what_cannot_be_judged(function, kind, text):
    found = verdict("fk", function)
    assert found.kind == kind, found
    assert re.search(text, found.say), found.say


@pytest.mark.parametrize(
    "body, line",
    [
        ("x = theta - theta\ny = np.sin(x) / x\nreturn y", 3),
        ("return l1, np.sqrt(-abs(theta))", 2),
        ("def root(x): return np.sqrt(x)\nx = root(-l1 * np.ones(2))\nreturn x", 1),
        ("x = np.full(2, np.nan)\nfor i in range(1):\n    x[i] = theta[i]\nreturn x", 2),
    ],
    ids=["a quotient", "in one of two results", "in a function of one's own", "written down"],
)
def test_where_nan_comes_from_is_found_where_numpy_is_silent(body, line, monkeypatch):
    """In a browser it raises nothing, whatever it is told."""

    class Silent(contextlib.nullcontext):
        def __init__(self, **_):
            super().__init__()

    monkeypatch.setattr(attempt.np, "errstate", Silent)
    assert attempt.line_of_nan(written(body), [np.array([0.1, 0.2]), 1.0, 2.0]) == (line, "")


@pytest.mark.parametrize(
    "body",
    [
        "while True:\n    pass",
        "while l1:\n    try:\n        l1 = l1 + 0\n    except:\n        pass",
        "return [x for x in iter(int, 1)]",
        "for x in iter(int, 1):\n    l1 = l1\nreturn l1",
    ],
)
def test_an_endless_loop_ends_with_its_line(body):
    found = verdict("fk", written(body))
    assert found.kind == "error"
    assert re.search(r"it does not end: after [\d,]+ lines it is still in line \d of ", found.say)


def test_what_takes_too_long_within_a_library_is_told_with_the_line_that_called_it(monkeypatch):
    monkeypatch.setattr("coursekit.classroom.attempt.LINES", 100)
    made: dict = {}
    exec("def slow():\n    for _ in range(1000):\n        pass", made)  # as sympy makes what it computes with

    def fk(theta, l1, l2):
        return made["slow"]()

    said = verdict("fk", fk).say
    assert said == 'it takes too long: it is still in line 2 of fk: `return made["slow"]()`'


def test_an_argument_that_was_changed_is_named():
    right = "theta[1] += theta[0]\nreturn [l1 * np.cos(theta[0]) + l2 * np.cos(theta[1]), "
    right += "l1 * np.sin(theta[0]) + l2 * np.sin(theta[1])]"
    found = verdict("fk", written(right))
    assert found.kind == "misfit"
    assert "it changes its argument `theta`" in found.say
    assert verdict("fk", written(right.replace("theta[1] += theta[0]", "theta = np.cumsum(theta)"))).right


# ---- 2 and 3: right, or known


def test_right_but_by_the_library():
    found = verdict("fk", with_library)
    assert found.kind == "library"
    assert "the numbers are right, but it calls coursekit's own robots.planar_2r" in found.say
    assert verdict("fk", with_allowed_library).right


@pytest.mark.parametrize(
    "source",
    [
        "import fastmath\ndef fk(theta, l1, l2):\n    return right(theta, l1, l2) * fastmath.one()",
        "from fastmath.inner import one\ndef fk(*a):\n    return [one() * x for x in right(*a)]",
        "def fk(theta, l1, l2):\n    import fastmath.inner\n    return right(theta, l1, l2)",
        "from fastmath import one\ndef half():\n    return one()\ndef fk(*a):\n    return half() * right(*a)",
    ],
)
def test_right_but_by_a_package_that_grading_does_not_have(tmp_path, monkeypatch, source):
    """On a machine of one's own more is installed; nobody should learn that from the grade."""
    folder = tmp_path / "site-packages" / "fastmath"
    folder.mkdir(parents=True)
    for name in ("__init__.py", "inner.py"):
        (folder / name).write_text("def one():\n    return 1")
    monkeypatch.syspath_prepend(folder.parent)
    space = {"right": RIGHT.fk}
    exec("import numpy as np, tqdm, IPython, math, json\n" + source, space)
    try:
        found = verdict("fk", space["fk"])
    finally:
        for name in ("fastmath", "fastmath.inner"):
            sys.modules.pop(name, None)
    assert found.kind == "library"
    assert found.say == "the numbers are right, but fastmath is not there when it is graded: numpy is"


def test_what_grading_has_may_be_called():
    space = {"right": RIGHT.fk}
    exec(
        "import numpy as np, tqdm, IPython, math, sympy\nfrom IPython.display import display\n"
        "def fk(*a):\n    display; tqdm.tqdm; sympy.pi; math.pi\n    return np.array(right(*a))",
        space,
    )
    assert verdict("fk", space["fk"]).right


def test_a_wrong_function_that_calls_the_library_is_diagnosed_all_the_same():
    found = verdict("fk", lambda *a: -with_library(*a))
    assert (found.kind, found.step) == ("named", "done")


def test_any_solution_is_right_and_so_is_a_set_in_any_order():
    def other_elbow(p, l1, l2):
        return RIGHT.ik_all(p, l1, l2)[1] + [2 * np.pi, 0]

    assert verdict("ik", other_elbow).right
    assert verdict("ik_all", lambda *a: RIGHT.ik_all(*a)[::-1] + [[2 * np.pi, -2 * np.pi]]).right
    assert verdict("ik_all", lambda *a: RIGHT.ik_all(*a)[[0, 0]]).kind == "placed"


def test_where_many_answers_are_right_entries_of_one_of_them_are_not_held_up():
    found = verdict("ik", lambda *a: RIGHT.ik_all(*a)[0] + [0, 0.3 * a[1]])
    assert "entry" not in found.say
    assert found.say == "your joint angles do not reach the point"


# ---- 4: what was done to the right answer


@pytest.mark.parametrize(
    "done, text",
    [
        (lambda x: -x, "every sign is the opposite"),
        (lambda x: 1000 * x, "1000 times too large: lengths are in metres"),
        (lambda x: np.degrees(x), "in degrees; radians are expected"),
        (lambda x: x * [1, -1], r"entry \[1\] has the opposite sign; the rest is right"),
        (lambda x: 2 * x, "twice the right one"),
        (lambda x: x + 0.25, r"off by \+0.25, always"),
        (lambda x: np.round(x, 2), "rounded"),
        (lambda x: np.trunc(x).astype(int), "decimals are cut off: an array of whole numbers"),
        (lambda x: 0 * x, "zero, whatever the arguments"),
        (lambda x: [0.3, 0.4], "always the same"),
        (lambda x: x**2, "the square of the right one"),
        (lambda x: 1 / x, "upside down"),
        (lambda x: abs(x), "lost its sign"),
    ],
)
def test_what_was_done_to_the_right_answer(done, text):
    found = verdict("fk", lambda *a: done(RIGHT.fk(*a)))
    assert (found.kind, found.step) == ("named", "done")
    assert re.search(text, found.say)


@pytest.mark.parametrize(
    "done, text",
    [
        (np.transpose, "transpose"),
        (lambda J: J[::-1], "rows are in reverse order"),
        (lambda J: J[:, ::-1], "columns are in reverse order"),
        (lambda J: np.ascontiguousarray(J.T).reshape(J.shape), "transpose"),
    ],
)
def test_what_was_done_to_a_matrix(done, text):
    assert text in verdict("jacobian", lambda *a: done(RIGHT.jacobian(*a))).say


def test_an_argument_that_is_not_used_is_named():
    body = "return [l1 * np.cos(theta[0]) + 0.5 * np.cos(sum(theta)), l1 * np.sin(theta[0])]"
    assert "does not use its argument `l2`" in verdict("fk", written(body)).say
    assert "gives `l2` a value of its own" in verdict("fk", written(f"l2 = 0.5\n{body}+ [l2][:0]")).say


# ---- 5: where the code is wrong

FK = """
a, b = theta[0], theta[0] + theta[1]
x = l1 * np.cos(a) + l2 * np.cos(b)
y = l1 * np.sin(a) + l2 * np.sin(b)
return np.array([x, y])
"""


@pytest.mark.parametrize(
    "old, new, text",
    [
        ("np.cos(b)", "np.sin(b)", "look at line 3: `sin`: another function is needed there"),
        ("theta[0] + theta[1]", "theta[0] - theta[1]", "look at line 2: a sign"),
        ("y = l1", "y = l2", "look at line 4: `l2`: another variable belongs there"),
        ("theta[0] + theta[1]", "theta[0]", "look at line 2: "),
        ("x = l1 * np", "x = l1 * 2 * np", "look at line 3: "),
        ("a, b = theta[0]", "a, b = theta[1]", "look at line 2: "),
        ("* np.sin(a)", "/ np.sin(a)", "look at line 4: an operator"),
    ],
)
def test_the_line_is_found_and_the_edit_is_not_told(old, new, text):
    assert old in FK
    found = verdict("fk", written(FK.replace(old, new, 1)))
    assert (found.kind, found.step) == ("named", "repair"), found
    assert text in found.say
    assert old not in found.say


def test_a_function_of_one_line_has_its_fault_in_line_1():
    tip = "l1 * np.array([np.cos(theta[0]), np.sin(theta[0])]) + l2 * np.array([np.cos(b), np.cos(b)])"
    file, text = "<a cell of one line>", f"def fk(theta, l1, l2): b = theta.sum(); return {tip}\n"
    linecache.cache[file] = (len(text), None, [text], file)
    namespace = {"np": np}
    exec(compile(text, file, "exec"), namespace)
    found = verdict("fk", namespace["fk"])
    assert (found.step, found.say[:16]) == ("repair", "look at line 1: "), found
    assert found.mended.startswith("line 1: ")


def test_repair_leaves_no_trace(capsys):
    kept = {"list": [], "count": 0}
    body = FK.replace("np.cos(b)", "np.sin(b)").replace("return", "log.append(1)\nprint('seen')\nreturn")
    log = []
    found = verdict("fk", written(body, log=log, kept=kept))
    examples = len(COURSE.samples("nb01")["fk"]["examples"])
    assert found.step == "repair"
    once_more = 1  # does a second call with the same arguments give the same answer?
    assert len(log) == examples + once_more, "every example is called once by the check, and by nothing else"
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    "line", ["open('x.txt', 'w')", "np.save('x', x)", "np.random.seed(0)", "global g", "input()"]
)
def test_what_could_leave_a_trace_is_not_tried(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    body = FK.replace("np.cos(b)", "np.sin(b)").replace("x = l1", f"if l1 < 0:\n    {line}\nx = l1")
    assert verdict("fk", written(body)).step != "repair"


def test_without_a_text_there_is_no_repair_but_an_answer():
    namespace = {"np": np}
    exec("def fk(theta, l1, l2):\n" + FK.replace("np.cos(b)", "np.sin(b)").replace("\n", "\n    "), namespace)
    found = verdict("fk", namespace["fk"])
    assert (found.kind, found.say) == ("placed", "wrong: entry [0]; the rest is right (counted from 0)")


def test_things_without_an_end_are_not_searched_for_it():
    """np.r_ can be indexed for ever: no edit may drop its index, or hand it to numpy."""
    body = "return np.r_[l1 * np.cos(theta[0]) + np.cos(sum(theta)), l2 * np.sin(theta[0])]"
    assert not verdict("fk", written(body)).right
    assert verdict("fk", lambda *a: np.r_).kind == "misfit"


def test_the_same_code_gets_the_same_sentence():
    body = FK.replace("np.cos(b)", "np.sin(b)")
    assert len({verdict("fk", written(body)).say for _ in range(3)}) == 1


# ---- 6 and 7: what is right already


def test_a_law_is_named_when_it_breaks():
    found = verdict("ik", written("return np.array([p[0] + l1, p[1] * l2])", "ik", "p, l1, l2"))
    assert found.kind == "placed"
    assert "do not reach the point" in found.say


# ---- levels


def test_levels_tell_more_and_more(monkeypatch, capsys):
    monkeypatch.delenv("CI", raising=False)
    namespace = {"np": np}
    source = (
        "def home_pose(lengths):\n    L1, L2, L3, L4, L5 = lengths\n    M = np.eye(4)\n"
        "    M[:3, 3] = [L4 + L5, 0, L1 + L2 - L3]\n    return M\n"
    )
    linecache.cache["<cell home>"] = (len(source), None, source.splitlines(True), "<cell home>")
    exec(compile(source, "<cell home>", "exec"), namespace)
    texts = {}
    for show in (None, "more", "example", "all"):
        check("home_pose", namespace["home_pose"], show=show)
        texts[show] = capsys.readouterr().out
    assert texts[None].startswith("✗ home_pose: look at line 4: a sign\n")
    assert texts[None].count("\n") <= 4
    assert "The height (z) is wrong; the other 3 parts of the answer are right" in texts["more"]
    assert "Look again at" in texts["more"]
    assert texts["more"].count("\n") <= 5, "four lines, one of which may be wrapped"
    assert re.search(r"home_pose\(np.array\(\[[\d.,\s]+\]\)\)", texts["example"])
    assert "yours (* is wrong)" in texts["example"] and "expected" in texts["example"]
    assert all(line in texts["all"] for line in texts["example"].splitlines()[1:])
    assert classroom.diagnose("home_pose", namespace["home_pose"]).text in texts["all"]
    with pytest.raises(ValueError, match="'more', 'example', 'all'"):
        check("home_pose", namespace["home_pose"], show="everything")


def test_where_many_answers_are_right_the_example_shows_yours_as_a_matrix(monkeypatch, capsys):
    monkeypatch.delenv("CI", raising=False)
    check("dh_table", lambda lengths: np.full((6, 4), 90.0), show="example")
    lines = capsys.readouterr().out.splitlines()
    begin = lines.index("    yours")
    assert len(set(lines[begin + 1 : begin + 7])) == 1, "six equal rows, none pushed aside"


@pytest.mark.parametrize(
    "column, what", [(1, "Row 1 has alpha = 90 rad: angles"), (3, "Row 2 has theta = 90 rad: angles")]
)
def test_a_table_in_degrees_is_told_its_own_number(column, what):
    def table(lengths):
        h, o, u, f, t = lengths
        q, p = np.pi / 2, np.pi
        rows = [[o, q, h, 0], [u, 0, 0, q], [0, q, 0, 0], [0, q, f, p], [0, q, 0, p], [0, 0, t, 0]]
        return np.array(rows) * np.where(np.arange(4) == column, 180 / np.pi, 1)

    text = classroom.diagnose("dh_table", table).text
    assert what in " ".join(text.split()), text


@pytest.mark.parametrize(
    "wrong, it_was",
    [("np.arctan2(a3, d4 * a3)", "line 2: a factor or a term too many"), ("np.arctan2(d4, a3)", "line 2")],
    ids=["a line with its kind", "a mistake with a name"],
)
def test_right_after_wrong_says_what_it_was(monkeypatch, capsys, wrong, it_was):
    monkeypatch.delenv("CI", raising=False)
    source = f"def elbow_angle(a3, d4):\n    return {wrong}\n"
    linecache.cache["<cell elbow>"] = (len(source), None, source.splitlines(True), "<cell elbow>")
    namespace = {"np": np}
    exec(compile(source, "<cell elbow>", "exec"), namespace)
    check("elbow_angle", namespace["elbow_angle"])
    capsys.readouterr()
    check("elbow_angle", lambda a3, d4: np.arctan2(a3, d4))
    assert capsys.readouterr().out.endswith(f"; it was {it_was}\n")
    check("elbow_angle", lambda a3, d4: np.arctan2(a3, d4))
    assert "it was" not in capsys.readouterr().out


def test_parts_come_before_wholes():
    def wrist_centre(T_sd, tool):
        return T_sd[:3, 3] + tool * T_sd[:3, 0]

    whole = written(
        "return wrist_centre(T_sd, tool)", "all_solutions", "T_sd, lengths, tool", wrist_centre=wrist_centre
    )
    found = classroom.diagnose("all_solutions", whole)
    assert found.kind == "named"
    assert found.text.startswith("`wrist_centre`, which it calls, is not right yet: from the tool back")
    whole.__globals__["wrist_centre"] = unwritten
    assert classroom.diagnose("all_solutions", whole).text == "write `wrist_centre` first: it calls that"


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
        demand(name, lambda *a: None, [])


def test_what_the_function_prints_is_shown_once(monkeypatch, capsys):
    monkeypatch.delenv("CI", raising=False)
    check("elbow_angle", written("print('here', a3 > 0)\nreturn a3", "elbow_angle", "a3, d4"))
    assert capsys.readouterr().out.count("here") == 1


# ---- comparing


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


def test_a_mask_says_which_entries_are_right():
    v = np.array([0.3, -0.4, 0.5])
    assert compare.mask("close", v, v + [0, 1, 0], 1e-6).tolist() == [True, False, True]
    assert compare.mask("close", v, v + [0, 1, 0], [0, 2, 0]).all(), "a tolerance for every entry"
    assert compare.mask("up_to_sign", -v, v * [1, 1, 2], 1e-6).tolist() == [True, True, False]
    s = np.array([[0.1, 0.2], [0.3, 0.4]])
    assert compare.mask("set", s[::-1] + [[0, 0], [0, 1]], s, 1e-6).tolist() == [[True, True], [True, False]]
    with pytest.raises(ValueError, match=r"shapes \(3,\) and \(2, 2\)"):
        compare.mask("close", v, s, 1e-6)


@pytest.mark.parametrize("shape", [(0,), (4,), (0, 2), (4, 1), (4, 2)], ids=str)
def test_a_set_is_the_same_where_some_order_makes_every_row_right(shape):
    """Rows of 0, 1 and 2, of which neighbours agree: who sits first must not keep another from sitting."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        answer, right = rng.integers(3, size=(2, *shape)).astype(float)
        orders = (answer[list(order)] for order in itertools.permutations(range(len(answer))))
        some_order = any(np.all(np.abs(one - right) <= 1) for one in orders)
        assert compare.same("set", answer, right, 1.0) is some_order
        assert compare.mask("set", answer, right, 1.0).all() == some_order


# ---- definitions that make no sense are refused


def test_an_exercise_is_checked_when_it_is_defined():
    with pytest.raises(ValueError, match="valid are close"):
        Exercise("f(x)", 1, lambda rng: (1,), (), compare="nearly")
    with pytest.raises(ValueError, match="2 shapes, 1 ways"):
        Exercise("f(x)", 1, lambda rng: (1,), ((), (3,)), compare=("close",))
    several = Exercise("f(x)", 1, lambda rng: (1,), ((), (3,)), hints=(Hint("a", "b"),))
    assert (several.name, several.several, several.kinds) == ("f", True, ("close", "close"))
    assert Exercise("f(a, b_c, d)", 1, lambda rng: (1,), ()).arguments == ["a", "b_c", "d"]


def test_names_on_the_list_of_allowed_functions():
    allowed = ("lie", "robot.Robot.fk")
    assert permitted("lie.exp6", allowed)
    assert permitted("robot.Robot.fk", allowed)
    assert not permitted("robot.Robot.__post_init__", allowed)
    assert permitted("robot.Robot.__repr__", allowed)
    assert not permitted("lies.exp6", allowed)
    assert permitted("robot.Robot.__post_init__", ("robot.Robot",))


def test_examples_can_be_called_for():
    assert len(classroom.example("fk_dh", 0)) == 4
    with pytest.raises(ValueError, match="fk_dh has examples 0 to"):
        classroom.example("fk_dh", 99)


def test_told_is_the_text_of_the_face():
    exercise = EXERCISES["fk"]
    examples = examples_of(exercise, COURSE.samples("nb01")["fk"])
    found, attempts = judged(exercise, lambda *a: -RIGHT.fk(*a), examples)
    assert told(found, exercise, RIGHT.fk, examples, attempts, "", None).startswith(found.say)
