"""Notebook 02: what its cells stored, against the numbers of the sources."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coursekit import lie, robots
from coursekit.classroom import own_arm, yours
from coursekit.classroom.author import notebook
from coursekit.view import text as text_module
from coursekit.view.figures.nb02 import telescope_arm
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


def test_the_tables_of_the_abb_and_its_steps():
    text = "".join("".join(output.get("text", "")) for output in CELLS["abb-tables"]["outputs"])
    assert "h and P against both tables, 1000 poses: below 4e-15" in text
    namespace = {"__name__": "notebook", "robots": robots, "np": np}
    notebook.run_cell("\n".join(CELLS["figure-abb"]["source"].splitlines()[:3]), "P", namespace)
    assert np.allclose(namespace["P"].sum(axis=0), [0.533, 0, 0.8891])


def test_by_steps_and_by_screws_the_abb_goes_to_the_same_place():
    text = "".join("".join(output.get("text", "")) for output in CELLS["abb-home"]["outputs"])
    places = [line.partition("tool at")[2] for line in text.splitlines() if "tool at" in line]
    expected = 1000 * robots.abb_irb1200().fk([0.4, 0.2, -0.5, 1.0, 0.7, -0.3])[:3, 3]
    assert len(places) == 2
    for place in places:
        numbers = [float(word.strip("(), ")) for word in place.replace("mm", "").split()]
        assert np.allclose(numbers, expected, atol=0.051)


def test_the_panda_turned_by_60_degrees():
    panda = robots.franka_panda()
    turned = panda.modified_dh.frames(np.pi / 3 * np.eye(7)[0])
    expected = lie.exp6([0, 0, np.pi / 3, 0, 0, 0]) @ panda.modified_dh.frames(np.zeros(7))
    assert np.allclose(turned, expected, atol=1e-15)
    text = "".join("".join(output.get("text", "")) for output in CELLS["figure-panda"]["outputs"])
    assert "(44.0, 76.2, 926.0) mm" in text


def test_the_bug_hunt_ends_at_the_wrist_and_nowhere_else(solved):
    """What a student changes in its cell: x and z of the frame."""
    source = CELLS["bug-hunt-printed"]["source"]
    for x, z, ends in ((0.980, 0.435, False), (0.900, 0.400, False), (0.900, 0.435, True)):
        namespace = {"np": np, "lie": lie, "kr6": robots.kuka_kr6(), "adjoint": solved.adjoint}
        namespace |= {"yours": lambda function, *args, course: function(*args), "text": text_module}
        notebook.run_cell(source.replace("x, z = 0.980, 0.435", f"x, z = {x}, {z}"), "hunt", namespace)
        assert bool(namespace["off"].max() < 1e-12) == ends


def test_the_telescope_of_the_figure_is_the_one_of_the_exercise(solved):
    arm = telescope_arm()
    M, S = solved.home_and_screws(np.array([0.15, 0.6, 0.12, 0.7, 0.2]))
    assert np.allclose(M, arm.M)
    assert np.allclose(S, arm.S)


def test_the_scara_slides_down(solved):
    scara = robots.scara()
    S = solved.joint_screw("prismatic", np.array([0, 0, -2.0]), np.array([0.6, 0, 0.387]))
    assert np.allclose(S, scara.S[:, 2])


@pytest.mark.parametrize("written", [False, True])
def test_what_is_read_off_is_compared_and_shown_once_it_is_written(written, capsys):
    """M is compared as well; while nothing is written, nothing of the course's passes for the student's."""
    own, cell = own_arm(), CELLS["own-arm"]["source"]
    read = "M, S = own.M.copy(), own.S.copy()\n    M[0, 3] += 0.05\n    S[4, 2] -= 0.2\n    return M, S"
    cell = cell.replace("raise NotImplementedError", read) if written else cell
    namespace = {"own": own, "kr6": robots.kuka_kr6(), "np": np, "yours": yours, "text": text_module}
    namespace["screw_axis"] = len  # of the student
    notebook.run_cell(cell, "own-arm", namespace)
    said = capsys.readouterr().out
    assert (namespace["shown"] is own) == written, "the explorer's words tell what is to be read off"
    if not written:
        assert namespace["mine"] is len
        assert said == "read_off is not written yet: the course's value is used here.\n"
        return
    np.testing.assert_array_equal(namespace["mine"]["S"], namespace["S_own"])
    assert "M off by 0.050\n" in said
    assert "S_1 to S_6 off by (0.000, 0.000, 0.200, 0.000, 0.000, 0.000)\n" in said


def test_the_half_filled_screws_are_those_of_the_abb():
    from coursekit.classroom.questions.nb02 import QUESTIONS

    S = robots.abb_irb1200().S * [[1], [1], [1], [1000], [1000], [1000]]
    for name, i in (("abb_screw_4", 3), ("abb_screw_5", 4)):
        (question,) = [q for q in QUESTIONS if q.name == name]
        assert np.allclose(question.answer(L1=399.1, L2=448, L3=42, L4=451), S[:, i])


@pytest.mark.parametrize("name", ["kuka_kr6", "abb_irb1200", "franka_panda", "scara"])
def test_another_frame_is_another_base(solved, name):
    robot, T = robots.all()[name], lie.exp6([0.3, -0.5, 0.2, 0.4, 0.1, 0.7])
    S, M = solved.from_another_frame(robot.S, robot.M, T)
    moved = robot.with_base(T)
    assert np.allclose(S, moved.S, atol=1e-14)
    assert np.allclose(M, moved.M, atol=1e-14)
