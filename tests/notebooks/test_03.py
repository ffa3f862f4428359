"""Notebook 03: its numbers against the golden data, computed by the notebook's own cells."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coursekit import ik, lie, path, robots, rotations
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "03_inverse_kinematics.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
SOURCES = load("numbers_of_the_sources")
REPORT, EXAM = SOURCES["TPK4170 report"], SOURCES["S030 exam"]
LENGTHS = np.array([0.025, 0.400, 0.455, 0.035, 0.420])


def printed(cell_id):
    """What a cell printed when it was stored."""
    return "".join(
        "".join(output["text"]) for output in CELLS[cell_id]["outputs"] if output["output_type"] == "stream"
    )


def numbers(text):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])", text)]


def rows_of(text):
    """The lines of a printed table below its rule, as cells."""
    lines = text.splitlines()
    rule = next(k for k, line in enumerate(lines) if set(line) <= {"-", " "} and line)
    body = lines[rule + 1 :]
    return [re.split(r"\s{2,}", line.strip()) for line in body[: body.index("") if "" in body else None]]


@pytest.fixture(scope="module")
def solved():
    """What the set-up cell and the exercises' solutions define."""
    return notebook.references(PATH)


@pytest.fixture
def target():
    T = np.array(REPORT["T_sd_table4_1"])
    T[:3, 3] /= 1000
    return T


def around(a, b):
    """Differences of angles, round the circle."""
    return np.abs((np.asarray(a) - b + np.pi) % (2 * np.pi) - np.pi)


def test_the_eight_solutions_of_the_report(solved, target):
    found = solved.all_solutions(target, LENGTHS, 0.08)
    golden = np.array(REPORT["all_8_solutions"])
    distance = around(found[:, None], golden).max(axis=-1)
    assert sorted(distance.argmin(axis=1)) == list(range(8))
    assert distance.min(axis=1).max() < 1e-9


def test_table_4_1_stands_in_the_table_of_eight():
    rows = {row[-1]: row for row in rows_of(printed("table-of-eight")) if len(row) == 9}
    assert set(rows) == set(REPORT["table4_1_rows"])
    for name, theta in REPORT["table4_1_rows"].items():
        assert around(np.array(rows[name][1:7], float), theta).max() <= 1e-3
    assert len(rows_of(printed("table-of-eight"))) == 8


def test_the_wrist_centre_of_the_report(solved, target):
    np.testing.assert_allclose(
        1000 * solved.wrist_centre(target, 0.08), [-26.73, -58.40, 1150.21], rtol=0, atol=6e-3
    )
    assert numbers(printed("the-target"))[-3:] == [-26.73, -58.40, 1150.21]


def test_the_elbows_of_figure_4_2():
    assert numbers(printed("figure-elbows")) == [806.4, 782.9]


@pytest.mark.parametrize("name", ["kuka_kr6", "kuka_kr10"])
def test_the_solutions_put_the_tool_where_it_was(solved, name):
    robot = robots.all()[name]
    lengths = LENGTHS if name == "kuka_kr6" else np.array([0.025, 0.4, 0.56, 0.025, 0.515])
    tool = 0.08 if name == "kuka_kr6" else 0.09
    rng, reached = np.random.default_rng(5), 0
    for theta in rng.uniform(robot.q_min, robot.q_max, (40, 6)):
        T = robot.fk(theta)
        if ik.analytic(robot, T).exists.all():
            found = solved.all_solutions(T, lengths, tool)
            np.testing.assert_allclose(robot.fk(found), np.broadcast_to(T, (8, 4, 4)), rtol=0, atol=1e-11)
            assert around(found, theta).max(axis=1).min() < 1e-7
            reached += 1
    assert reached > 30


def test_subproblem1_and_wrist_angles_undo_a_turn(solved):
    rng = np.random.default_rng(6)
    for _ in range(20):
        w, x, (a, b, c) = *rng.normal(size=(2, 3)), rng.uniform(-3, 3, 3)
        k = w / np.linalg.norm(w)
        assert around(solved.subproblem1(k, x, lie.exp3(k * a) @ x), a) < 1e-9
        R = rotations.rotx(-a) @ rotations.roty(b) @ rotations.rotx(-c)
        assert around(solved.wrist_angles(R), [a, b, c]).max(axis=1).min() < 1e-9


@pytest.mark.parametrize(
    "robot", [robots.kuka_kr6(), robots.franka_panda(), robots.scara()], ids=lambda r: r.name
)
def test_columns_make_the_body_jacobian(solved, robot):
    """The notebook's own assembly, for hinges and a slide."""
    namespace = {}
    for cell in ("setup", "ex-jacobian-column"):
        notebook.run_cell(CELLS[cell]["source"], f"03, {cell}", namespace)
    notebook.run_cell(CELLS["body-jacobian"]["source"].split("\n\n\nfor ")[0], "03, body-jacobian", namespace)
    theta = robot.home + 0.2
    J = namespace["body_jacobian"](robot, theta)
    np.testing.assert_allclose(J, robot.jacobian_body(theta), rtol=0, atol=1e-12)


def test_subproblems_2_and_3_find_both_turns(solved):
    rng = np.random.default_rng(7)
    for _ in range(20):
        k1, k2 = (w / np.linalg.norm(w) for w in rng.normal(size=(2, 3)))
        x, y, (t1, t2) = *rng.normal(size=(2, 3)), rng.uniform(-3, 3, 2)
        there = lie.exp3(k1 * t1) @ lie.exp3(k2 * t2) @ x
        rows = solved.subproblem2(k1, k2, x, there)
        assert around(rows, [t1, t2]).max(axis=1).min() < 1e-6
        for a, b in rows:
            np.testing.assert_allclose(lie.exp3(k1 * a) @ lie.exp3(k2 * b) @ x, there, rtol=0, atol=1e-7)
        distance = np.linalg.norm(y - lie.exp3(k1 * t1) @ x)
        angles = solved.subproblem3(k1, x, y, distance)
        assert around(angles, t1).min() < 1e-6
        for a in angles:
            assert np.linalg.norm(y - lie.exp3(k1 * a) @ x) == pytest.approx(distance, abs=1e-9)


def test_the_panda_drifts_by_the_same_amount_every_lap():
    one, *laps = [float(x) for x in re.findall(r"0\.\d{3}", printed("figure-lap"))]
    assert one == laps[0] == pytest.approx(0.068, abs=1e-3)
    np.testing.assert_allclose(np.diff(laps), 0.068, rtol=0, atol=2e-3)
    assert "below 1e-09" in printed("figure-lap")


def test_which_arms_have_three_axes_that_meet_or_are_parallel():
    rows = {row[0]: row[1:] for row in rows_of(printed("conditions"))}
    assert rows["Universal Robots UR5"] == ["6", "-", "2 3 4"]
    assert rows["Franka Emika Panda"] == ["7", "1 2 3", "-"]
    assert all(rows[name][1] == "4 5 6" for name in ("KUKA KR6 R900 sixx", "PUMA 560", "Stanford arm"))


def test_newton_step_is_that_of_the_library(solved):
    cases = [c for c in load("numeric_ik")["cases"] if c["robot"] == "kuka_kr6_r900_sixx"]
    kr6 = robots.kuka_kr6()
    for case in cases:
        guess, T = np.array(case["guess"]), np.array(case["T"])
        step = solved.newton_step(kr6.jacobian_body(guess), kr6.fk(guess), T)
        np.testing.assert_allclose(step, case["newton_step"], rtol=1e-7, atol=1e-9)
    assert cases


def test_four_repairs_make_the_printed_formulas_right():
    rows = rows_of(printed("bug-hunt-repairs"))
    assert [row[0].split()[0] for row in rows] == ["4.1", "4.3", "4.8", "4.20"]
    missed = np.array([row[-4:] for row in rows], float)
    before = np.array(rows_of(printed("bug-hunt-check"))[0], float)
    assert np.all(before > 1), "every step of the printed formulas is wrong"
    for k, after in enumerate(missed):  # each repair mends its own step and no other
        assert np.all(after[: k + 1] == 0) and np.all(after[k + 1 :] == before[k + 1 :])


def test_808_solutions_by_subproblems():
    namespace = {}
    for cell in ("setup", "ex-subproblem1", "ex-subproblem2", "ex-subproblem3", "figure-abb"):
        source = CELLS[cell]["source"].split("\nabb, targets")[0]
        notebook.run_cell(source, f"03, {cell}", namespace)
    abb, poses = robots.abb_irb1200(), path.frames(path.s_curve())
    for T in poses[::10]:
        found = namespace["abb_solutions"](T)
        expected = ik.analytic(abb, T).theta
        assert around(found[:, None], expected).max(axis=-1).min(axis=1).max() < 1e-9
        np.testing.assert_allclose(abb.fk(found), np.broadcast_to(T, (8, 4, 4)), rtol=0, atol=2e-15)
    assert "101 poses, 808 solutions" in printed("figure-abb")
    assert "below 2e-15" in printed("figure-abb")


def test_newton_reaches_the_two_numerical_rows_of_table_4_1():
    rows = rows_of(printed("figure-newton"))
    assert [row[2] for row in rows] == [
        "back elbow-down no-flip",
        "back elbow-up no-flip",
        "front elbow-down flip",
    ]
    assert rows[0][3] == "Numerical B"
    assert rows[2][3] == "Numerical A"


def test_the_nearest_solution_is_found_less_often_from_afar():
    """The published check has 99 to 27 %: the same course, not the same poses and steps."""
    shares = np.array([row[1] for row in rows_of(printed("figure-rates"))], float)
    assert np.all(np.diff(shares) < 0)
    np.testing.assert_allclose(shares, [99, 97, 95, 83, 55, 27], rtol=0, atol=17)


def test_out_of_reach():
    text = printed("figure-wandering")
    assert "solutions that exist: 0" in text
    assert "Newton settles: no" in text
    kr6 = robots.kuka_kr6()
    far = kr6.fk([2, -1, -1, 2.5, 0.6, 0])
    far[:3, 3] *= 1.6
    closest = ik.damped_least_squares(kr6, far, [-1, -2, 1, 0, 0.3, 0])
    assert numbers(text.splitlines()[-1])[-1] == pytest.approx(closest.error[1], abs=0.006)


def test_formula_and_search_side_by_side():
    rows = rows_of(printed("comparison"))[:3]  # a sentence stands below them
    assert "less than a third of the time: yes" in printed("comparison")
    assert [row[1:3] for row in rows] == [
        ["8 solutions", "1 solution"],
        ["0 solutions", "none"],
        ["no formula", "1 solution"],
    ]
    newtons, another = numbers(printed("comparison").splitlines()[-1])[-2:]
    assert another < newtons, "Newton's end is not the nearest"
