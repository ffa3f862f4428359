"""Notebook 04: its numbers against the golden data, computed by the notebook's own cells."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from PIL import Image

from coursekit import ik, lie, robots, singularity, symbolic
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import GOLDEN_ROBOTS, load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "04_singularities.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
KR6 = robots.kuka_kr6()
SOURCES = load("numbers_of_the_sources")
NAMED = load("singular")["named"]


def printed(cell_id):
    """What a cell printed when it was stored."""
    return "".join(
        "".join(output["text"]) for output in CELLS[cell_id]["outputs"] if output["output_type"] == "stream"
    )


def row(cell_id, start):
    """The cells of the first printed line that starts like this."""
    line = next(line for line in printed(cell_id).splitlines() if line.startswith(start))
    return re.split(r"\s{2,}", line)


def named(label):
    return next(case for case in NAMED if case["label"].startswith(label))


@pytest.fixture(scope="module")
def solved():
    """What the set-up cell and the exercises' solutions define."""
    return notebook.references(PATH)


@pytest.mark.parametrize("name", [name for name, key in GOLDEN_ROBOTS.items() if robots.all()[key].n == 6])
def test_solutions_on_golden_jacobians(solved, name):
    robot = robots.all()[GOLDEN_ROBOTS[name]]
    for case in load(f"fk_jac_{name}")["cases"]:
        J = np.array(case["J_body"])
        assert solved.rank(J, 1e-9) == (np.array(case["singular_values"]) > 1e-9).sum()
    for case in load("singular")["cases"]:
        if case["robot"] == name and case["rank"] == 5:
            lost = solved.lost_motion(robot.jacobian_space(case["q"]))
            assert abs(lost @ singularity.lost_motion(robot, case["q"])) == pytest.approx(1, abs=1e-9)


def test_det_from_blocks_is_the_determinant_at_the_wrist(solved):
    wrist = KR6.with_tool(lie.exp6([0, 0, 0, -0.08, 0, 0]))
    theta = np.random.default_rng(2).uniform(-3, 3, (20, 6))
    for q in theta:
        J = wrist.jacobian_body(q)
        assert np.abs(J[3:, 3:]).max() < 1e-12
        assert solved.det_from_blocks(J) == pytest.approx(singularity.determinant(KR6, q), abs=1e-14)


def test_singular_angles(solved):
    lengths = [0.025, 0.455, 0.035, 0.420, 0.080]
    assert solved.elbow_angle(0.035, 0.420) == pytest.approx(
        SOURCES["TPK4170 report"]["elbow_theta3"], abs=1e-12
    )
    shoulder = SOURCES["TPK4170 report"]["shoulder_theta3_for_theta2_m2_701"]
    assert np.abs(solved.shoulder_theta3(-2.701, lengths) - shoulder).min() < 1e-10
    assert solved.elbow_angle(0.025, 0.515) == pytest.approx(
        SOURCES["KR10 assignment"]["true_robot_elbow_q3"]
    )


def test_the_stored_factors_are_the_determinant():
    *_, equation = (
        output["data"]["text/plain"]
        for output in CELLS["three-factors"]["outputs"]
        if output["output_type"] == "display_data"
    )
    right = sp.sympify("".join(equation).removeprefix("Eq(det J, ").removesuffix(")"))
    arm = symbolic.arm(KR6)
    q = [0.3, -0.7, 0.9, 0.5, 0.8, 0.2]
    names = {str(s): float(v) for s, v in arm.lengths.items()} | {
        f"theta_{i + 1}": t for i, t in enumerate(q)
    }
    assert float(right.subs(names)) == pytest.approx(singularity.determinant(KR6, q), abs=1e-15)
    assert printed("three-factors") == "det J + det J12 det J21 = 0\n"


def test_the_exam_by_hand():
    assert "Matrix([[0, 0, 0]])" in printed("exam-position")
    assert "p_n = (1.230, 0.000, 1.550) m" in printed("exam-position")
    exam = SOURCES["S030 exam"]
    rows = [re.split(r"\s{2,}", line.strip()) for line in printed("kawasaki").splitlines()[-4:]]
    assert [row[0] for row in rows] == ["f+", "f-", "b+", "b-"]
    expected = [exam["ik"][key] for key in ("f_plus", "f_minus", "b_plus", "b_minus")]
    shown = np.array([row[2:5] for row in rows], float)
    np.testing.assert_allclose(shown, np.degrees(expected), rtol=0, atol=6e-3)
    assert float(rows[2][5]) == pytest.approx(exam["b_plus_q2_plus_2pi_deg"], abs=6e-3)
    assert [row[-1] for row in rows] == ["yes"] * 4
    assert len({line.split()[-1] for line in printed("exam-frames").splitlines()}) == 1, "one det for all"


def test_theta2_is_that_of_the_four_arms(solved):
    lengths, s030 = (0.15, 0.68, 0.87, 1.08), robots.kawasaki_s030()
    for p in np.random.default_rng(3).uniform([-1.5, -1.5, 0.3], [1.5, 1.5, 2.0], (20, 3)):
        for t1, t2, t3 in ik.first_joints(s030, p):
            if np.isfinite(t2):
                gap = solved.theta2_system(p, t1, t3, lengths) - t2
                assert abs((gap + np.pi) % (2 * np.pi) - np.pi) < 1e-9


def test_the_exam_determinant():
    stored = "".join(CELLS["exam-determinant"]["outputs"][1]["data"]["text/plain"])
    expected = "a_2*d_4*cos(theta_3)*(a_1 + a_2*cos(theta_2) + d_4*sin(theta_2 + theta_3))"
    assert sp.expand(sp.sympify(stored) - sp.sympify(expected)) == 0
    assert "(-65, 225) deg" in printed("exam-determinant")


@pytest.mark.parametrize(
    ("start", "label"),
    [
        ("1   as printed", "TPK4170 report table 5.1 case1"),
        ("2,5 as printed", "TPK4170 report table 5.1 case2/5 as printed"),
        ("2,5 exact", "TPK4170 report case2/5 exact"),
        ("3   as printed", "TPK4170 report table 5.1 case3 as printed"),
        ("3   exact", "TPK4170 report case3 exact"),
        ("3   aligned", "TPK4170 report case3 exact with axis 6 on axis 1"),
        ("4   exact", "TPK4170 report table 5.1 case4 exact"),
    ],
)
def test_table_5_1(start, label):
    case = named(label)
    cells = row("table-5-1", start)
    angles, det, sigma, rank, aligned = cells[-5:]
    np.testing.assert_allclose(np.array(angles.strip("()").split(", "), float), case["q"][1:5], atol=6e-7)
    assert float(det) == pytest.approx(case["det"], rel=0.06, abs=1e-12)
    assert float(sigma) == pytest.approx(case["singular_values"][-1], rel=0.06, abs=1e-12)
    assert int(rank) == case["rank_tol_1e9"]
    assert aligned == ("yes" if "axis 6 on axis 1" in label else "no")


def test_only_two_values_of_theta_4_make_axes_parallel():
    parallel = [line.split()[1] for line in printed("theta-4").splitlines()[2:]]
    assert parallel == ["1.000", "0.878", "0.540", "0.000", "1.000"]
    assert printed("theta-4").count("below 1e-12") == 5


def test_lines_that_meet_six_axes():
    assert row("lost-lines", "elbow")[1:] == ["0.0000"] + ["0.0"] * 6
    assert row("lost-lines", "shoulder")[1:] == ["0.0000", "0.0", "-", "-", "0.0", "0.0", "0.0"]
    wrist = [float(x) for x in row("lost-lines", "wrist")[1:]]
    assert wrist[0] == pytest.approx(0.1526) and min(wrist[1:]) > 50


def test_rank_of_elbow_and_wrist():
    ranks = [line.split()[-1] for line in printed("rank-4-or-5").splitlines()[2:]]
    assert ranks == ["4", "5", "5", "5", "4"]


def test_joint_rates_at_the_boundary():
    lines = [line.split() for line in printed("rates").splitlines()[2:7]]
    assert [float(line[1]) for line in lines] == pytest.approx([1.5, 4.6, 15.2, 45.7, 152.4], abs=0.01)
    assert all(0.456 < float(line[2]) < 0.46 for line in lines), "they grow as 1 / eps"
    assert "0.1 b / (a2 a) = 0.457" in printed("rates")


def test_the_shoulder_flip():
    """Joint 1 as 0.1 m/s over the distance; the fastest joint as in an independent computation."""
    lines = [line.split() for line in printed("flip").splitlines()[2:7]]
    assert [line[0] for line in lines] == ["10.00", "5.00", "1.66", "0.50", "0.17"]
    assert all(line[1] == line[2] for line in lines)
    np.testing.assert_allclose([float(line[3]) for line in lines[2:]], [78, 260, 779], rtol=0.02)


def test_which_columns_of_table_5_1_span_less_than_they_are():
    rows = [re.split(r"\s{2,}", line) for line in printed("five-cases").splitlines()[2:]]
    assert [row[2:] for row in rows] == [
        ["2", "1", "5"],
        ["3", "2", "5"],
        ["3", "3", "5"],
        ["4", "3", "5"],
        ["4", "3", "5"],
        ["6", "5", "5"],
    ]


def test_the_lost_motion_at_the_stretched_elbow_depends_on_the_reference():
    along, _, at_P, _, at_origin = printed("lost-used").splitlines()
    assert along.partition(": ")[2] == at_P.partition(", v ")[2]
    assert "omega (0.000, 0.000, 0.000)" in at_P and "omega (0.000, 0.000, 0.000)" not in at_origin


def test_the_kr10_model_and_the_true_arm():
    model, true = printed("kr10").split("KUKA KR10 R1100-2\n")
    labels = {
        "wrist ": "KR10 assignment wrist",
        "shoulder": "KR10 assignment shoulder",
        "alignment": "KR10 assignment alignment as printed",
        "elbow and": "KR10 assignment elbow+wrist",
        "elbow  ": "KR10 assignment elbow only",
    }
    for text, suffix in ((model, ""), (true, " on the true KR10")):
        for start, label in labels.items():
            case = named(label + suffix)
            line = next(line for line in text.splitlines() if line.startswith(start))
            _, det, rank, sigma, found = re.split(r"\s{2,}", line.strip())
            assert float(det) == pytest.approx(case["det"], rel=0.06, abs=1e-12)
            assert int(rank) == case["rank_tol_1e9"]
            assert float(sigma) == pytest.approx(case["singular_values"][-1], rel=0.06, abs=1e-12)
            assert (found == "regular") == (case["rank_tol_1e9"] == 6)


def test_what_is_blocked():
    x, _, z = (line.split() for line in printed("blocked").splitlines()[1:4])
    assert x == ["0.000"] * 6
    assert [float(v) for v in z] == [0, -1.19, -0.63, 0, -0.09, 0]
    assert "45.0 mm per rad" in printed("blocked")


def test_the_alignment():
    assert "(-0.653, 0.000, 0.757) is 40.8 deg" in printed("bug-hunt-code")
    answer = printed("bug-hunt-answer")
    true = SOURCES["KR10 assignment"]["true_alignment_q5"]
    assert f"theta_5 = {true:.8f}" in answer and "one line: yes" in answer
    case = named("KR10 assignment alignment true: q5=1.2357549792754567 on the true KR10")
    det, sigma = re.search(r"R1100-2 det J (\S+) rank 6 sigma_min (\S+)", answer).groups()
    assert float(det) == pytest.approx(case["det"], rel=0.06)
    assert float(sigma) == pytest.approx(case["singular_values"][-1], rel=0.06)


def test_straight_up_is_10_mm_from_axis_1():
    q = [0, -np.pi / 2, 0, 0, 0.8, 0]
    assert singularity.factors(KR6, q)["shoulder"] == pytest.approx(-0.010, abs=1e-12)
    assert singularity.sigma_min(KR6, q) == pytest.approx(0.00705, abs=1e-5)


def test_of_the_figures_the_map_alone_keeps_its_colours_on_a_dark_page():
    """Pages turn what is on white paper over: there dark would be light, and its caption wrong."""
    pictures = {
        id: base64.b64decode("".join(output["data"]["image/png"]))
        for id, cell in CELLS.items()
        for output in cell.get("outputs", [])
        if "".join(output.get("data", {}).get("text/plain", "")).startswith("<Figure")
    }
    papers = {
        id: min(Image.open(io.BytesIO(png)).convert("RGB").tobytes()[:3]) for id, png in pictures.items()
    }
    kept = [id for id, paper in papers.items() if paper <= 240]
    assert [CELLS[id]["source"].count("figures.singular_map(") for id in kept] == [1]
