"""Notebook 01: its numbers against the golden data, computed by the notebook's own cells."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from coursekit import dh, robots
from coursekit.classroom import ask
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "01_dh_vs_poe.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
SOURCES = load("numbers_of_the_sources")
REPORT = SOURCES["TPK4170 report"]


def in_mm(T):
    return np.asarray(T) * np.where(np.arange(16).reshape(4, 4) % 4 == 3, [[1000], [1000], [1000], [1]], 1)


def printed(cell_id):
    """What a cell printed when it was stored."""
    return "".join(
        "".join(output["text"]) for output in CELLS[cell_id]["outputs"] if output["output_type"] == "stream"
    )


def numbers(text):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])", text)]


@pytest.fixture(scope="module")
def solved():
    """What the set-up cell and the exercises' solutions define."""
    return notebook.references(PATH)


@pytest.fixture
def run():
    """run("cell-id", ...) -> the namespace after these cells, the set-up cell before them."""

    def run_cells(*ids, **known):
        namespace = {"__name__": "notebook", **known}
        for cell_id in ("setup", *ids):
            notebook.run_cell(CELLS[cell_id]["source"], f"01_dh_vs_poe, {cell_id}", namespace)
        return namespace

    return run_cells


def standard_rows(table):
    return np.column_stack([table.a, table.alpha, table.d, table.theta])


@pytest.mark.parametrize("name", ["kuka_kr6", "abb_irb1200", "kawasaki_s030", "puma560", "franka_panda"])
def test_the_solutions_agree_with_the_robots(solved, name):
    robot = robots.all()[name]
    theta = np.random.default_rng(7).uniform(-np.pi, np.pi, robot.n)
    table, modified = robot.standard_dh, robot.modified_dh
    T = solved.fk_dh(standard_rows(table), theta, table.base, table.tool)
    np.testing.assert_allclose(T, robot.fk(theta), rtol=0, atol=2e-15)
    np.testing.assert_allclose(solved.fk_poe(robot.S, robot.M, theta), robot.fk(theta), rtol=0, atol=2e-15)
    S = solved.screws_from_dh(standard_rows(modified), modified.base)
    np.testing.assert_allclose(S, robot.S, rtol=0, atol=1e-14)


def test_a_slide_goes_straight(solved):
    T = solved.screw_exp(np.array([0, 0, 0, 0.6, 0, 0.8]), 0.5)
    np.testing.assert_allclose(T, [[1, 0, 0, 0.3], [0, 1, 0, 0], [0, 0, 1, 0.4], [0, 0, 0, 1]], atol=1e-15)


@pytest.mark.parametrize("key", ["eq3.8", "eq3.9", "eq3.10"])
def test_the_three_matrices_of_figure_3_6(key):
    theta = {"eq3.8": np.zeros(6), "eq3.9": [0, 0, -np.pi / 2, np.pi / 2, 0, 0], "eq3.10": np.ones(6)}[key]
    T = in_mm(robots.kuka_kr6().standard_dh.fk(theta))
    np.testing.assert_allclose(T, REPORT["FK"][key], rtol=0, atol=1e-9)


def test_the_stored_matrices_are_those_of_figure_3_6():
    stored = printed("figure-3-6").split("theta =")[1:]
    for block, key in zip(stored, ("eq3.8", "eq3.9", "eq3.10"), strict=True):
        said, *lines = block.splitlines()[1:6]
        np.testing.assert_allclose([numbers(line) for line in lines], REPORT["FK"][key], atol=5.1e-4)
        assert said == "fk_dh: yours and the course's agree."


def test_frames_of_the_kr6():
    standard, modified = printed("table-shift").split("MODIFIED")
    origins = "(25, 0, 400) (480, 0, 400) (480, 0, 435) (900, 0, 435) (900, 0, 435) (900, 0, 435)"
    assert origins in standard
    assert "(0, 0, 400) (25, 0, 400) (480, 0, 400) (900, 0, 435) (900, 0, 435) (900, 0, 435)" in modified


def test_screws_from_the_table_are_eq_3_5():
    S, M = robots.kuka_kr6().modified_dh.screws()
    np.testing.assert_allclose(np.vstack([S[:3], 1000 * S[3:]]), REPORT["S"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(in_mm(M), REPORT["M_flange"], rtol=0, atol=1e-12)
    lines = printed("screws-of-table").splitlines()[2:8]
    np.testing.assert_array_equal([numbers(line) for line in lines], REPORT["S"])


def test_the_wrong_reading():
    table = robots.kuka_kr6().standard_dh
    columns = table.a, table.alpha, table.d, table.theta
    wrong = dh.Table(*columns, "modified", base=table.base, tool=table.tool).fk(np.zeros(6))
    assert 1000 * np.linalg.norm((wrong - table.fk(np.zeros(6)))[:3, 3]) == pytest.approx(1099.3, abs=0.05)
    assert "1099.3 mm" in printed("wrong-reading")


def test_nearly_parallel_axes():
    kr6, tilt = robots.kuka_kr6(), 1e-3
    w = np.array([-np.sin(tilt), np.cos(tilt), 0])
    tilted = np.concatenate([w, -np.cross(w, [0.48, 0, 0.4])])
    a, _, foot, _ = dh.common_normal(kr6.S[:, 1], tilted)
    assert a == pytest.approx(0, abs=1e-12)
    assert foot[1] == pytest.approx(455, rel=1e-5)
    assert np.linalg.norm(tilted - kr6.S[:, 2]) == pytest.approx(1.077e-3, rel=1e-3)
    assert "d = 455.0 m" in printed("near-parallel")


def test_m_passes_one_exponential_after_the_other():
    assert "differences all below 4e-15" in printed("identity-steps")


def test_three_arms_agree():
    lines = printed("agreement").splitlines()[2:]
    assert [line.count("below 4e-15") for line in lines] == [2, 2, 2]


def test_both_rows_cost_the_same():
    assert printed("near-parallel").count("DH: 6 multiplications for a row") == 2


def test_an_arm_with_a_slide_by_rows_and_by_exponentials():
    """Where joint 3 slides by 150 mm downwards, the tool is 150 mm lower, and nowhere else."""
    lines = [line for line in printed("scara").splitlines() if "tool at" in line]
    rows, exponentials = (numbers(line) for line in lines)
    assert rows == exponentials
    x, y = 325 * np.array([np.cos(0.4), np.sin(0.4)]) + 275 * np.array([np.cos(-0.5), np.sin(-0.5)])
    assert rows == [pytest.approx(x, abs=0.05), pytest.approx(y, abs=0.05), 387 - 150]


def test_the_table_of_the_exam_is_one_of_those_that_are_right(solved):
    """Table 1 of the exam's solution, with d_6 for its second d_4, and the pose that is drawn."""
    rows = solved.dh_table(np.array([0.680, 0.150, 0.870, 1.080, 0.165]))
    np.testing.assert_allclose(rows[:, 0], [0.150, 0.870, 0, 0, 0, 0])
    np.testing.assert_allclose(rows[:, 1], np.radians([90, 0, 90, 90, 90, 0]))
    np.testing.assert_allclose(rows[:, 2], [0.680, 0, 0, 1.080, 0, 0.165])
    np.testing.assert_allclose(rows[:, 3], np.radians([0, 90, 0, 180, 180, 0]))


def test_the_kawasaki_in_its_drawn_pose():
    T = np.array([numbers(line) for line in printed("kawasaki").splitlines()[-4:]])
    np.testing.assert_array_equal(T, [[0, 0, 1, 1395], [0, -1, 0, 0], [1, 0, 0, 1550], [0, 0, 0, 1]])


def test_another_right_table_has_another_frame_6_and_fk_dh_is_right_all_the_same(run, solved, capsys):
    """z_3 to z_5 of the other sense: as good a table as the course's, but its pose is not the course's."""

    def dh_table(lengths):
        h, o, u, f, t = lengths
        q = np.pi / 2
        return [[o, q, h, 0], [u, 0, 0, q], [0, q, 0, 0], [0, q, f, 0], [0, q, 0, np.pi], [0, 0, t, 0]]

    namespace = run("kawasaki", dh_table=dh_table, fk_dh=solved.fk_dh)
    said = capsys.readouterr().out.splitlines()
    assert said[:2] == [f"{name}: yours and the course's agree." for name in ("dh_table", "fk_dh")]
    assert np.abs(namespace["T"] - robots.kawasaki_s030().fk(robots.kawasaki_s030().home)).max() > 1


def test_the_joint_ranges_of_the_exam():
    rows = [numbers(line) for line in printed("s030-ranges").splitlines()[3:9]]
    assert [row[2:] for row in rows] == [
        [-180, 180],
        [-50, 195],
        [-65, 225],
        [-360, 360],
        [35, 325],
        [-360, 360],
    ]


def test_the_half_filled_rows_are_those_of_the_abb():
    """The questions' formulas, at the lengths of the real arm, against its table."""
    from coursekit.classroom.questions.nb01 import QUESTIONS

    table, lengths = robots.abb_irb1200().standard_dh, {"L1": 399.1, "L2": 448, "L3": 42, "L4": 451}
    for name, i in (("abb_row_2", 1), ("abb_row_4", 3)):
        (question,) = [q for q in QUESTIONS if q.name == name]
        row = [1000 * table.a[i], np.degrees(table.alpha[i]), 1000 * table.d[i], np.degrees(table.theta[i])]
        np.testing.assert_allclose(question.answer(**lengths), row)


@pytest.mark.parametrize("name", ["abb_row_2", "abb_row_4"])
def test_a_row_in_metres_and_radians_is_told_its_units(name, capsys):
    asked = ask(name)
    row = np.array(asked.question.answer(**asked.numbers))
    for length, angle, said in (
        (0.001, np.pi / 180, "a and d in mm, please, and angles in degrees"),
        (0.001, 1, "a and d in mm, please:"),
        (1, np.pi / 180, "alpha and theta in degrees, please"),
    ):
        asked.answer(list(row * [length, angle, length, angle]))
        assert f"not yet. {said}" in capsys.readouterr().out


@pytest.fixture
def hunt(run):
    def run_cells(*more):
        known = {
            "abb": robots.abb_irb1200(),
            "figures": SimpleNamespace(errors_along_path=lambda *a, **k: None),
        }
        return run("bug-hunt-code", "bug-hunt-check", "bug-hunt-modified", *more, **known)

    return run_cells


def test_the_faulty_code_is_as_wrong_as_the_projects():
    """The project's error runs from 324 to 1230 (standard) and 229 to 869 (modified), on another curve."""
    standard, modified = printed("bug-hunt-modified").splitlines()
    assert numbers(standard) == [pytest.approx(324, abs=3), pytest.approx(1230, abs=3)]
    assert numbers(modified) == [pytest.approx(229, abs=3), pytest.approx(869, abs=10)]


def test_the_first_frame_that_is_off_moves_outwards_with_every_repair(hunt):
    """So a fault can be seen where it is: frame 1 (the unit), frame 2 (the entry), frame 6 (the offset)."""
    namespace = hunt()
    source, first = CELLS["bug-hunt-code"]["source"], []
    turn = "T @ np.array([[0, 0, 1, 0], [0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]])"
    for old, new in (
        ("", ""),
        ("L1=399.1, L2=448, L3=42, L4=451, L5=82", "L1=0.3991, L2=0.448, L3=0.042, L4=0.451, L5=0.082"),
        ("ca * st, -sa", "ca * ct, -sa"),
        ("(0, 0, L5, 1)", "(0, 0, L5, 0)"),
        ("*frames, T]", f"*frames, {turn}]"),
    ):
        source = source.replace(old, new) if old else source
        notebook.run_cell(source, "repaired", namespace)
        abb = robots.abb_irb1200()
        rows = namespace["frame_by_frame"](namespace["sdh_check"], abb.standard_dh, abb.fk)
        first.append(next((row[0] for row in rows if max(row[1:]) > 1e-9), "none"))
    assert first == ["frame 1", "frame 2", "frame 6", "tool", "none"]


def test_three_and_five_repairs_make_it_right(hunt):
    rows = hunt("bug-hunt-repairs")["rows"]
    assert [row[0] for row in rows] == ["sdh_check"] * 3 + ["mdh_check"] * 5
    assert [row[-1] for row in rows] == [False, False, True] + [False] * 4 + [True]
