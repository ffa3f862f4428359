"""What a student wrote is used by the cells below it, and never stops them."""

import numpy as np
import pytest

from coursekit.classroom import use, yours


def right(a):
    return np.array([a, 2 * a])


def test_a_right_function_is_used_and_agrees(capsys):
    assert yours(right, 3.0, course=np.array([3.0, 6.0])).tolist() == [3.0, 6.0]
    assert capsys.readouterr().out == "right: yours and the course's agree.\n"


def test_a_wrong_value_of_the_right_shape_is_used_and_the_difference_told(capsys):
    assert yours(lambda a: np.array([a, a]), 3.0, course=right).tolist() == [3.0, 3.0]
    assert "differs from the course's by up to 3; yours is used" in capsys.readouterr().out


def unwritten(a):
    raise NotImplementedError


def calls_unwritten(a):
    return unwritten(a)


def raising(a):
    b = a
    return b / np.zeros(2)[5]


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (unwritten, "unwritten is not written yet: the course's value is used here."),
        (calls_unwritten, "calls_unwritten needs `unwritten`, which is not written yet"),
        (raising, "raising raises IndexError in its line 3 (index 5 is out of bounds"),
        (lambda a: None, "it returns None: is there a `return`"),
        (lambda a: "no", "not an array of numbers"),
        (lambda a: np.zeros(3), "returns shape (3,) instead of (2,)"),
        (lambda a: np.array([a, np.nan]), "returns NaN"),
    ],
)
def test_a_function_that_gives_nothing_usable_is_one_sentence(function, words, capsys):
    assert yours(function, 3.0, course=right).tolist() == [3.0, 6.0]
    said = capsys.readouterr().out
    assert words in said
    assert said.count("\n") == 1


def test_arguments_are_copies():
    given = np.array([1.0, 2.0])

    def changes(x):
        x *= 2
        return x

    yours(changes, given, course=lambda x: 2 * x)
    assert given.tolist() == [1.0, 2.0]


def test_free_turns_and_signs_are_agreement(capsys):
    """By the exercise of the function's name: `elbow_angle` answers modulo whole turns."""

    def elbow_angle(*_):
        return 0.3 + 2 * np.pi

    yours(elbow_angle, 1.0, course=0.3)
    assert "agree" in capsys.readouterr().out


def test_in_a_loop_it_is_said_once(capsys):
    step = use(unwritten, course=right)
    assert [step(a).tolist() for a in (1.0, 2.0)] == [[1.0, 2.0], [2.0, 4.0]]
    assert capsys.readouterr().out == "unwritten is not written yet: the course's is used here.\n"
    mine = use(lambda a: np.array([a, a]), course=right)
    assert mine(1.0).tolist() == [1.0, 1.0]
    assert capsys.readouterr().out == ""


def test_a_list_that_is_one_of_many_right_answers_is_taken_as_an_array(capsys):
    """The laws of such an exercise count with arrays; what is returned may be a list all the same."""

    def dh_table(lengths):
        h, o, u, f, t = lengths
        q = np.pi / 2
        return [[o, q, h, 0], [u, 0, 0, q], [0, q, 0, 0], [0, q, f, 0], [0, q, 0, 2 * q], [0, 0, t, 0]]

    lengths = np.array([0.68, 0.15, 0.87, 1.08, 0.165])
    yours(dh_table, lengths, course=np.array(dh_table(lengths)))
    assert capsys.readouterr().out == "dh_table: yours and the course's agree.\n"


def test_lists_go_on_as_arrays(capsys):
    """A check takes lists; the cells below multiply and slice what they get."""
    w, q = np.array([0.0, 0, 2]), np.array([0.5, 0, 0])

    def screw_axis(w, q):
        return [0, 0, 1, 0, -0.5, 0]

    def from_another_frame(S, M, T):
        return [S.tolist(), M.tolist()]

    S = use(screw_axis, course=lambda w, q: np.array([0, 0, 1, 0, -0.5, 0]))(w, q)
    np.testing.assert_array_equal(0.5 * S, [0, 0, 0.5, 0, -0.25, 0])
    S, M = yours(
        from_another_frame, np.ones((6, 2)), np.eye(4), np.eye(4), course=(np.ones((6, 2)), np.eye(4))
    )
    assert (S[:, 0].shape, M[:3, 3].shape) == ((6,), (3,))
    assert "agree" in capsys.readouterr().out
