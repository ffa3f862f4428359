"""The one formatter: what it prints is the same on every machine."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coursekit import lie, rotations
from coursekit.view import text

# -- one number --


@pytest.mark.parametrize(
    "x, digits, expected",
    [
        (1.23456, 3, "1.235"),
        (-1.23456, 1, "-1.2"),
        (0.0, 3, "0.000"),
        (-0.0, 3, "0.000"),
        (-1e-17, 3, "0.000"),
        (-0.0004, 3, "0.000"),
        (-0.4, 0, "0"),
        (7, 2, "7.00"),
        (1e6, 1, "1000000.0"),
        (np.float32(0.5), 2, "0.50"),
        (np.array(0.25), 2, "0.25"),
        (True, 1, "1.0"),
        (np.nan, 3, "-"),
        (np.inf, 3, "inf"),
        (-np.inf, 3, "-inf"),
    ],
)
def test_numbers(x, digits, expected):
    assert text.number(x, digits) == expected


@given(st.integers(-10_000_000, 10_000_000), st.integers(0, 5), st.floats(-1e-13, 1e-13))
def test_rounding_noise_never_shows(thousandths, digits, noise):
    """Not even on the halves, where a rest of 1e-17 would otherwise tip the last digit."""
    x = thousandths / 1000
    assert text.number(x + noise, digits) == text.number(x, digits)


@given(st.floats(allow_nan=True, allow_infinity=True), st.integers(0, 6))
def test_never_minus_zero(x, digits):
    shown = text.number(x, digits)
    assert shown == "-" or not shown.startswith("-") or any(c in "123456789i" for c in shown)


@given(st.floats(-1e6, 1e6), st.integers(0, 6))
def test_what_is_shown_is_the_number_rounded(x, digits):
    shown = text.number(x, digits)
    assert abs(float(shown) - x) <= 0.501 * 10.0**-digits
    assert len(shown.partition(".")[2]) == digits


def test_scientific():
    assert text.scientific(1.432e-5) == "1.4e-05"
    assert text.scientific(-1234.5, digits=4) == "-1.234e+03"
    assert text.scientific(-0.0) == "0"
    assert text.scientific(np.nan) == "-"


# -- verdicts --


def test_below_prints_the_bound_and_never_the_noise():
    assert text.below(3.1e-16, 2e-15) == text.below([0, -4.4e-16], 2e-15) == "below 2e-15"
    assert text.below(2e-15, 2e-15) == "below 2e-15"
    assert text.below(np.zeros((3, 0)), 1e-9) == "below 1e-09"
    assert text.below(-0.25, 1e-12) == "NOT below 1e-12: 0.25"
    assert text.below([1e-20, np.nan], 1e-12) == "NOT below 1e-12: not a number"


# -- rows, angles, lengths, poses --


def test_rows():
    assert text.row([1, -0.0, np.nan]) == "(1.000, 0.000, -)"
    assert text.row([0.12345], digits=1) == "(0.1)"
    assert text.degrees(np.radians([30, -174.72])) == "(30.0, -174.7) deg"
    assert text.degrees(np.pi, digits=2) == "180.00 deg"
    assert text.degrees(np.nan) == "- deg"
    assert text.millimetres([0.445, 0, -1e-9]) == "(445.0, 0.0, 0.0) mm"
    assert text.millimetres(0.0825, digits=2) == "82.50 mm"


def test_poses():
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotations.from_zyx(np.radians([10, -20, 30])), [0.1, 0.2, 0.3]
    assert text.pose(T) == "position (100.0, 200.0, 300.0) mm, yaw pitch roll (10.0, -20.0, 30.0) deg"
    with pytest.raises(ValueError, match=r"T must have shape \(\.\.\., 4, 4\)"):
        text.pose(np.eye(3))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_half_turn_prints_the_same_with_every_sign_of_zero(axis):
    turn = np.zeros(6)
    turn[axis] = np.pi
    shown = {
        text.pose(lie.exp6(sign * turn) * zeros)
        for sign in (1, -1)
        for zeros in (1.0, np.where(np.eye(4), 1, -1))
    }
    assert len(shown) == 1
    assert "-180" not in shown.pop()


# -- matrices and tables --


def test_matrices_are_aligned_column_by_column():
    shown = text.matrix([[1, 10, -0.5], [-1, 2, np.nan]], digits=2)
    assert shown == " 1.00  10.00  -0.50\n-1.00   2.00      -"
    assert text.matrix([1, 2]) == "1.000  2.000"
    assert text.matrix(np.eye(2), digits=0) == "1  0\n0  1"


def test_tables():
    rows = [["shoulder", 12, 0.5, True], ["elbow", 3, np.nan, None]]
    assert text.table(rows, ["where", "n", "angle", "ok"], digits=2).split("\n") == [
        "where      n  angle  ok",
        "--------  --  -----  ---",
        "shoulder  12   0.50  yes",
        "elbow      3      -  -",
    ]
    assert text.table([[1, 2.0], [10, -0.0]], digits=1) == " 1  2.0\n10  0.0"
    assert text.table([[1.0, 2.0]], ["a", "b"], digits=[0, 3]) == "a      b\n-  -----\n1  2.000"
    assert text.table([], ["a", "bc"]) == "a  bc\n-  --"
    assert text.table([[np.int64(4), np.bool_(False), np.float64(1)]]) == "4  no  1.000"
    assert text.table(np.array([[1.5, 2.5]]), digits=1) == "1.5  2.5"


def test_no_line_ends_in_blanks():
    shown = text.table([["a", "long cell"], ["long cell", "b"]], ["x", "y"])
    assert all(line == line.rstrip() for line in shown.split("\n"))


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: text.table([[1, 2], [3]]), r"every row of the table must have 2 cells, got \[2, 1\]"),
        (lambda: text.table([[1, 2]], ["a"]), r"every row of the table must have 1 cells, got \[2\]"),
        (
            lambda: text.table([[1, 2]], digits=[1]),
            "digits must be one number or one for each of 2 columns, got 1",
        ),
    ],
)
def test_errors_say_what_was_expected(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_nothing_prints(capsys):
    text.table([[1]], ["a"])
    text.matrix(np.eye(4))
    text.pose(np.eye(4))
    assert capsys.readouterr().out == ""
