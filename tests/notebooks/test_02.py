"""Notebook 02: what its cells stored, against the numbers of the sources."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coursekit import lie, robots
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "02_msb_derivation.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
REPORT = load("numbers_of_the_sources")["TPK4170 report"]
MM = np.array([[1], [1], [1], [0.001], [0.001], [0.001]])


@pytest.fixture(scope="module")
def solved():
    return notebook.references(PATH)


def rows(cell_id, count):
    """The blocks of `count` lines of numbers that a cell printed, as arrays."""
    text = "".join(
        "".join(output["text"]) for output in CELLS[cell_id]["outputs"] if output["output_type"] == "stream"
    )
    lines = [line.split() for line in text.splitlines()]
    numeric = [[float(x) for x in line] for line in lines if line and all(_is_number(x) for x in line)]
    return [np.array(numeric[k : k + count]) for k in range(0, len(numeric), count)]


def _is_number(word):
    return word.lstrip("-").replace(".", "", 1).isdigit()


def test_the_screws_read_off_the_drawing_are_those_of_the_report():
    (S_mm,) = rows("six-screws", 6)
    assert np.array_equal(S_mm, REPORT["S"])


def test_both_body_screws_stand_under_their_frames():
    flange, wrist = rows("both-frames", 6)
    assert np.array_equal(flange, REPORT["B_flange"])
    assert np.array_equal(wrist, REPORT["B_wrist_as_printed_eq3_6"])


def test_the_pose_of_frame_6_and_the_home_pose():
    T_06, M = rows("home-pose", 4)
    kr6 = robots.kuka_kr6()
    assert np.allclose(M, kr6.M)
    assert np.allclose(T_06, [[0, 0, -1, 0.9], [0, -1, 0, 0], [-1, 0, 0, -0.435], [0, 0, 0, 1]])


def test_the_bug_hunt_prints_the_poses_of_both_frames():
    text = "".join("".join(output.get("text", "")) for output in CELLS["bug-hunt-answer"]["outputs"])
    for tool in ("(445.00, 0.00, 900.00)", "(-6.16, -95.25, -403.51)"):  # figure 3.6, with 980 mm
        assert tool in text
    for tool in ("(445.00, 0.00, 820.00)", "(69.09, -107.61, -379.34)"):  # the same with 900 mm
        assert tool in text


@pytest.mark.parametrize("name", ["kuka_kr6", "abb_irb1200", "franka_panda", "kawasaki_s030", "ur5"])
def test_the_solutions_hold_for_every_robot(solved, name):
    robot = robots.all()[name]
    assert np.allclose(solved.body_screws(robot.S, robot.M), robot.B, atol=1e-15)
    assert np.allclose(solved.adjoint(robot.M), lie.adjoint(robot.M), atol=1e-15)
    for S in robot.S.T:
        w, q, pitch = solved.axis_of(S)
        assert np.allclose(solved.screw_axis(3 * w, q - 0.7 * w), S, atol=1e-15)
        assert abs(pitch) < 1e-15


def test_the_home_pose_of_the_abb(solved):
    lengths = load("numbers_of_the_sources")["IRB 1200 project"]["L"]
    assert np.allclose(solved.home_pose(np.array(lengths)), robots.abb_irb1200().M)
