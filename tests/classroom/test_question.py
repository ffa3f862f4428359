"""Questions whose numbers change, and the ticks of goals."""

import importlib
import types
from collections import Counter
from pathlib import Path

import pytest

from coursekit.classroom import ask, goals, question
from coursekit.classroom.author import notebook
from coursekit.classroom.course import the_course

PAGES = sorted(Path(question.__file__).with_name("questions").glob("nb*.py"))

LEVER = question.Question(
    name="lever",
    draw=lambda rng: {"h": float(rng.choice([0.3, 0.4, 0.5])), "n": int(rng.integers(1000))},
    text="An axis along +y at height {h} m ({n}): the x part of v?",
    answer=lambda h, n: -h,
    slips={"The sign is that of w x q.": lambda h, n: h},
)
CHOICE = question.Question("side", lambda rng: {}, "left (a) or right (b)?", lambda: "b")


@pytest.fixture(autouse=True)
def a_small_course(monkeypatch, tmp_path):
    module = types.SimpleNamespace(
        QUESTIONS=[LEVER, CHOICE], GOALS={"Levers": ["lever"], "Arms": ["lever", "fk_dh"]}
    )
    monkeypatch.setattr(question, "_module", lambda unit: module)
    monkeypatch.setattr(question, "_units", lambda: ["nb01"])
    monkeypatch.setattr(question, "_done", set())
    (tmp_path / "01_mine.ipynb").touch()
    monkeypatch.chdir(tmp_path)


def test_the_same_draw_has_the_same_numbers_and_another_draw_others():
    assert ask("lever").text == ask("lever").text
    assert len({ask("lever", draw=d).text for d in range(1, 6)}) > 1


def test_an_answer_is_right_a_known_slip_or_not_yet(capsys):
    h = ask("lever").numbers["h"]
    for answer, words in ((-h, "✓ right"), (h, "✗ not yet. The sign is that"), (9, "✗ not yet.\n")):
        ask("lever").answer(answer)
        assert words in capsys.readouterr().out


@pytest.mark.parametrize("answer", ["b", None, [1, 2]])
def test_another_kind_of_thing_is_told(answer, capsys):
    ask("lever").answer(answer)
    assert "✗ the answer is one number" in capsys.readouterr().out


def test_dots_show_the_question_only(capsys):
    ask("lever").answer(...)
    said = capsys.readouterr().out
    assert said.startswith(ask("lever").text)
    assert "in place of the dots" in said


def test_a_letter_in_any_case(capsys):
    ask("side").answer("B")
    assert "✓" in capsys.readouterr().out
    ask("side").answer(2)
    assert "a letter in quotes" in capsys.readouterr().out


@pytest.mark.parametrize("answer", ["(b)", "b)", " B. "])
def test_a_letter_that_was_copied_with_its_brackets(answer, capsys):
    ask("side").answer(answer)
    assert "✓ right" in capsys.readouterr().out


def test_a_word_is_no_letter(capsys):
    ask("side").answer("right")
    assert "✗ the answer is a letter in quotes" in capsys.readouterr().out


def _asked(right, text="?", tolerance=1e-3):
    return question.Asked(question.Question("one", lambda rng: {}, text, lambda: right, {}, tolerance), {})


@pytest.mark.parametrize(
    ("right", "text", "answer", "words"),
    [
        ([1.5, 2, 0], "", (1.5, 2, 0), "✓ right"),
        ([1.5, 2, 0], "", ([1.5, 2],), "✗ the answer is a list of 3 numbers; yours has 2"),
        ([1.5, 2, 0], "", (7,), "✗ the answer is a list of 3 numbers; yours is one number"),
        ([1.5, 2, 0], "", ([-1.5, -2, 0],), "✗ not yet. It is right but for the signs of all numbers."),
        (-75, "in degrees", (75,), "✗ not yet. It is right but for the sign."),
        (-75, "in degrees", (-1.309,), "✗ not yet. That is in radians; degrees are asked for."),
        (0.119429, "in rad", (6.84,), "✗ not yet. That is in degrees; radians are asked for."),
        (100, "in rad/s", (0.1,), "✗ not yet. It is off by a factor of 1000: look at the units."),
        (0.119429, "in rad", (0.119,), "✗ not yet. It is rounded too far: more digits are asked for."),
        (0.119429, "in rad", (0,), "✗ not yet.\n"),
        (4, "", (5,), "✗ not yet.\n"),
        (4.2, "", (4.1,), "✗ not yet.\n"),
    ],
)
def test_what_is_known_of_a_number_is_told(right, text, answer, words, capsys):
    _asked(right, text, 1e-5).answer(*answer)
    assert words in capsys.readouterr().out


def test_a_goal_that_is_begun_says_what_is_still_to_do(capsys):
    question.remember("fk_dh")
    goals("01")
    assert capsys.readouterr().out.splitlines()[1:] == ["  Arms: still to do lever"]


def test_goals_are_ticked_by_answers_and_remembered_in_the_folder(capsys, tmp_path, monkeypatch):
    ask("lever").answer(-ask("lever").numbers["h"])
    capsys.readouterr()
    goals("01")
    assert capsys.readouterr().out.startswith("1 of 2 goals: ✓ Levers · ○ Arms\n")
    monkeypatch.setattr(question, "_done", set())  # another day
    question.remember("fk_dh")
    goals("01")
    assert capsys.readouterr().out == "2 of 2 goals: ✓ Levers · ✓ Arms\n"
    assert {p.name for p in tmp_path.iterdir()} == {question.PROGRESS, "01_mine.ipynb"}


def test_progress_is_one_line(tmp_path):
    assert question.progress(tmp_path) == ""
    question.remember("lever")
    assert question.progress(tmp_path) == "goals reached: 01: 1 of 2"


def test_nothing_is_written_where_no_notebooks_are(tmp_path):
    (tmp_path / "01_mine.ipynb").unlink()
    question.remember("fk_dh")
    assert not list(tmp_path.iterdir())


def test_a_torn_file_of_ticks_costs_nothing(capsys, tmp_path):
    (tmp_path / question.PROGRESS).write_text("[torn")
    goals("01")
    assert "0 of 2 goals" in capsys.readouterr().out


def test_an_unknown_question_is_refused_by_name():
    with pytest.raises(ValueError, match=r"no question 'levers'. Did you mean 'lever'"):
        ask("levers")


def test_the_students_version_holds_no_answer():
    cells = [{"cell_type": "code", "metadata": {}, "source": 'ask("lever", draw=2).answer([0, -0.4])'}]
    (cell,) = notebook.student_version({"cells": cells})["cells"]
    assert cell["source"] == 'ask("lever", draw=2).answer(...)'


def test_every_question_of_the_course_has_a_name_of_its_own_and_every_goal_its_parts():
    course = the_course()
    exercises = {exercise.name for unit in course.units for exercise in course.exercises(unit)}
    modules = [importlib.import_module(f"coursekit.classroom.questions.{path.stem}") for path in PAGES]
    names = [q.name for module in modules for q in module.QUESTIONS]
    assert [name for name, count in Counter(names).items() if count > 1] == []
    for module in modules:
        wanted = {name for goal in module.GOALS.values() for name in goal}
        assert wanted <= exercises | set(names), module.__name__


def test_a_slip_is_never_the_answer():
    """Or a right answer could not be told from a wrong one that has a sentence of its own."""
    for one in question._questions():
        for draw in range(1, 30):
            asked = question.ask(one.name, draw)
            right = one.answer(**asked.numbers)
            for slip, wrong in one.slips.items():
                value = wrong(**asked.numbers)
                if not question._unlike(value, right):
                    assert not question._agree(value, right, one.tolerance), (one.name, slip, asked.numbers)
