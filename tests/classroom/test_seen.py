"""The line at the end of a failing check opens the student's function in 3D."""

import re

import numpy as np
import pytest

import coursekit
from coursekit import classroom, view
from coursekit.classroom import seen
from coursekit.classroom.course import the_course
from coursekit.classroom.mistakes import Solved
from coursekit.view import mine

NAMES = [name for names in mine.WANTED.values() for name, wanted in names.items() if wanted.signature]


@pytest.fixture(autouse=True)
def no_plots(monkeypatch):
    monkeypatch.setattr(view.Plot, "refresh", lambda plot, values: None)


def pasted(lines, function):
    """The panel that these lines open, in the names that every notebook has."""
    names = {"np": np, "robots": coursekit.robots, "view": view, function.__name__: function}
    *before, last = lines
    exec("\n".join(before), names)
    return eval(last, names)


def test_every_function_that_an_explorer_shows_has_its_line():
    assert set(seen.OPENERS) == set(NAMES) and set(seen.ARMS) <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_the_line_opens_the_explorer_that_shows_the_function(name):
    unit, exercise = the_course().find(name)
    right = getattr(Solved(unit), name)

    def function(*arguments):
        return right(*arguments)

    for written in (name, "my_own"):
        function.__name__ = written
        panel = pasted([seen.line(exercise, written)], function)
        assert f"yours, {name}: " in panel.line.value and "NOT" not in panel.line.value
        panel.close()


@pytest.mark.parametrize("name", seen.ARMS)
def test_every_example_that_is_an_arm_can_be_opened(name):
    unit, exercise = the_course().find(name)
    right = getattr(Solved(unit), name)

    def wrong(*arguments):
        return np.asarray(right(*arguments)) * 0.9

    wrong.__name__ = name
    for number in range(len(the_course().samples(unit)[name]["examples"])):
        panel = pasted(seen.lines(exercise, name, number), wrong)
        assert "off" in panel.line.value.split(f"yours, {name}: ")[1]
        panel.close()


@pytest.mark.parametrize("show", [None, "example", "all"])
def test_the_text_of_a_failing_check_ends_with_it(capsys, monkeypatch, show):
    def screw_axis(w, q):
        w = w / np.linalg.norm(w)
        return np.concatenate([w, np.cross(w, q)])

    monkeypatch.delenv("CI", raising=False)
    classroom.check("screw_axis", screw_axis, show)
    text = capsys.readouterr().out.rstrip()
    found = re.split(r"See it in 3D:\s*", text)[1]
    panel = pasted([line.strip() for line in found.splitlines()], screw_axis)
    assert "yours, screw_axis: off: joint" in panel.line.value
    panel.close()


@pytest.mark.parametrize("function", [lambda w, q: None, lambda w, q: q[9], lambda w: w])
def test_where_nothing_can_be_seen_there_is_no_line(function):
    function.__name__ = "screw_axis"
    assert "3D" not in classroom.diagnose("screw_axis", function).text
