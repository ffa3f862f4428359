"""Notebook 06: its numbers against the golden S and the source's figures, as the notebook stores them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coursekit import lie, path, robots, rotations
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "06_path_speed.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
GOLDEN = load("s_curve_arcs")
SOURCE = load("numbers_of_the_sources")["IRB 1200 project"]
PROSE = "\n".join(cell["source"] for cell in CELLS.values() if cell["cell_type"] == "markdown")


def printed(cell_id):
    """What a cell printed when it was stored."""
    outputs = CELLS[cell_id]["outputs"]
    return "".join("".join(out["text"]) for out in outputs if out["output_type"] == "stream")


def numbers(text):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])", text)]


@pytest.fixture(scope="module")
def solved():
    """What the set-up cell and the exercises' solutions define."""
    return notebook.references(PATH)


@pytest.fixture(scope="module")
def followed():
    """The S of 101 points, and the eight ways along it."""
    points = path.s_curve(101)
    return points, path.follow(robots.abb_irb1200(), path.frames(points))


# -- the path and its attitude


def test_the_frames_are_the_golden_ones(solved):
    points = np.array(GOLDEN["p"])
    T = solved.tool_frames(points, np.array(path.SPHERE_CENTER))
    np.testing.assert_allclose(T, path.frames(points), rtol=0, atol=1e-14)
    np.testing.assert_allclose([solved.zyx(R) for R in T[:, :3, :3]], GOLDEN["zyx"], atol=1e-9)
    q = np.array([solved.quaternion(R) for R in T[:, :3, :3]])
    np.testing.assert_allclose(q * np.sign(q[:, :1]), GOLDEN["quat_wxyz"], atol=1e-9)


def test_the_first_pose_in_three_forms():
    words = printed("figure-attitudes")
    first = numbers(words)[:11]
    expected = [*GOLDEN["quat_wxyz"][0], *GOLDEN["zyx"][0], *GOLDEN["rotvec"][0]]
    np.testing.assert_allclose(first, [*expected, np.linalg.norm(GOLDEN["rotvec"][0])], atol=5.1e-5)
    assert f"largest angle {np.linalg.norm(GOLDEN['rotvec'], axis=1).max():.4f}" in words


def test_equal_steps():
    words = printed("path-of-101")
    step = np.linalg.norm(np.diff(GOLDEN["p"], axis=0), axis=1)
    assert f"100 steps of {1000 * step.mean():.3f} mm, {step.sum():.4f} m in all" in words
    assert f"{GOLDEN['by_N']['101']['max_abs_step_minus_mean']:.1e} m at most" in words


def test_the_sources_first_pose():
    R = rotations.from_zyx([-0.9907, 0.7572, -0.5264])
    np.testing.assert_allclose(rotations.quaternion(R), [0.8351, -0.0431, 0.4289, -0.3419], atol=1e-4)
    assert "angle      1.1651 rad" in printed("first-pose")
    flipped = lie.log3(R.T @ rotations.from_zyx([0.9907, -0.7572, 0.5264]))
    assert np.degrees(np.linalg.norm(flipped)) == pytest.approx(139.7, abs=0.05)
    assert "139.7 deg" in printed("first-pose")
    assert (
        "(−0.9907, 0.7572, −0.5264), angle 1.1651 rad, quaternion (0.8351, −0.0431, 0.4289, −0.3419)" in PROSE
    )


def test_the_printed_q2_is_wrong_and_the_repaired_one_right():
    R = rotations.from_quaternion(GOLDEN["quat_wxyz"][0])
    (a, d, e), (f, b, g), (h, i, c) = R
    mended = np.sqrt(((i - g) ** 2 + (d + f) ** 2 + (h + e) ** 2) / (3 - a + b + c)) / 2
    printed_one = np.sqrt(((i - g) ** 2 + (d + f) ** 2 + (g + i) ** 2) / (3 + a + b + c)) / 2
    wanted = abs(GOLDEN["quat_wxyz"][0][1])
    assert mended == pytest.approx(wanted, abs=1e-9)
    assert abs(printed_one - wanted) > 0.05


def test_angle_and_axis_of_the_golden_attitudes(solved):
    for q, beta in zip(GOLDEN["quat_wxyz"], GOLDEN["rotvec"], strict=True):
        np.testing.assert_allclose(solved.angle_axis(rotations.from_quaternion(q)), beta, rtol=0, atol=1e-9)
    assert printed("figure-weakness").count("loses digits: yes; quaternion off below 1e-14") == 2


def test_slerp_against_quaternions(solved):
    """Along the S, from every tenth attitude to the next: on the arc of the golden quaternions."""
    for a, b in zip(GOLDEN["quat_wxyz"][::10], GOLDEN["quat_wxyz"][10::10], strict=False):
        a, b = np.array(a), np.array(b) * np.sign(np.dot(a, b))
        angle = np.arccos(a @ b)
        for t in (0.0, 0.3, 0.5, 1.0):
            arc = (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)
            found = solved.slerp(rotations.from_quaternion(a), rotations.from_quaternion(b), t)
            np.testing.assert_allclose(found, rotations.from_quaternion(arc), rtol=0, atol=1e-9)


def test_slerp_is_the_shorter_and_the_steadier_way():
    (angle, even), (longer, uneven) = (
        (float(line.split("by ")[1].split(" deg")[0]), float(line.split(" ")[-1]))
        for line in printed("figure-slerp").splitlines()
    )
    assert even == 1.0 and uneven > 2 and longer > 1.5 * angle


def test_three_right_forward_kinematics_and_two_wrong_ones():
    right, *wrong = printed("figure-errors").splitlines()
    assert right.endswith("below 2e-15 m")
    assert all(numbers(line.split(": ")[1])[0] > 0.1 for line in wrong)


@pytest.mark.parametrize("pitch", [0.5, -1.2])
def test_zyx_goes_all_round(solved, pitch):
    angles = [2.8, pitch, -2.5]
    np.testing.assert_allclose(solved.zyx(rotations.from_zyx(angles)), angles, atol=1e-12)


def test_a_half_turn_has_a_quaternion(solved):
    q = solved.quaternion(rotations.from_quaternion([0, 0.6, -0.64, 0.48]))
    np.testing.assert_allclose(q * np.sign(q[1]), [0, 0.6, -0.64, 0.48], atol=1e-12)


# -- the eight ways, and how fast


def test_the_branches_and_their_limits(followed):
    rows = [numbers(line) for line in printed("which-branches").splitlines()[2:]]
    inside = np.sum([np.all(branch) for branch in GOLDEN["branch_within_limits_per_joint"]])
    assert [row[4] for row in rows].count(101) == inside == 2
    assert rows[0][:5] == [1, -28, 50, 48, 101]
    assert "half a turn, below 1e-12" in printed("eight-speeds")
    everything = "".join(printed(i) for i, cell in CELLS.items() if cell["cell_type"] == "code")
    assert "NOT below" not in everything and "differs from the course" not in everything


def test_inside_agrees_with_the_robot(solved, followed):
    abb, q = robots.abb_irb1200(), followed[1]
    for branch in q:
        found = solved.inside(branch, abb.q_min, abb.q_max)
        np.testing.assert_array_equal(found, abb.within_limits(branch))
    exam = np.radians([[-174.72]]), np.radians([-50.0]), np.radians([195.0])
    assert solved.inside(*exam).tolist() == [True]


def test_the_largest_speed_is_the_golden_one(solved, followed):
    points, q = followed
    golden = GOLDEN["by_N"]["101"]["max_path_speed_per_branch"]
    found = [solved.largest_speed(branch, points, np.full(6, 2.0)) for branch in q]
    np.testing.assert_allclose(found, golden, rtol=1e-6)  # there with the mean step for each
    own = robots.abb_irb1200().v_max
    expected = path.speed_limit(q, points, own)
    found = [solved.largest_speed(branch, points, own) for branch in q]
    np.testing.assert_allclose(found, expected.speed, rtol=1e-12)
    rows = [
        numbers(line.split("each")[-1].split("own")[-1]) for line in printed("eight-speeds").splitlines()[4:6]
    ]
    assert rows == [[0.3001, 0.3001, 6], [round(expected.speed[0], 4)] * 2 + [1]]


def test_the_spread_of_joint_3_and_of_its_rate():
    golden = GOLDEN["by_N"]["101"]
    lines = printed("eight-speeds").splitlines()[-2:]
    for line, name in zip(lines, ("std_q3", "std_qdot3"), strict=True):
        assert re.findall(r"\d\.\d{4}", line) == [f"{x:.4f}" for x in golden[name]]


def test_the_dependence_on_n():
    rows = [numbers(line) for line in printed("dependence-on-n").splitlines()[2:]]
    assert [int(row[0]) for row in rows] == [101, 201, 1001, 5001]
    assert [row[1] for row in rows][2:] == [round(GOLDEN["by_N"]["5001"]["length"], 4)] * 2
    for N, _, _, spread, slowest, fastest, *wrapped in rows:
        golden = GOLDEN["by_N"][str(int(N))]
        assert slowest == round(min(golden["max_path_speed_per_branch"]), 4)
        assert fastest == round(max(golden["max_path_speed_per_branch"]), 4)
        assert spread == round(golden["std_q3"][0], 4)
        faulty = np.sort(golden["speed_with_wrapped_differences"])
        np.testing.assert_allclose(wrapped, faulty[[6, 7]], atol=1.1e-4)


def test_the_bug_hunt_is_off_and_its_repair_is_not():
    off, mended = (
        [float(line.split()[-1]) for line in printed(f"bug-hunt-{i}").splitlines()[2:5]]
        for i in ("code", "repair")
    )
    np.testing.assert_allclose(off[0], 0.3001 - 0.0059, atol=1.1e-4)
    assert max(mended) <= 1e-4 < 0.002 < off[2]


def test_the_speed_is_constant_and_far_too_low_from_wrapped_angles():
    shown = printed("figure-constancy").splitlines()
    assert [numbers(line.split(": ")[1]) for line in shown[:2]] == [[0.3001] * 2, [0.0059] * 2]


def test_the_sources_figures_are_told_with_their_right_values():
    claim, truth = SOURCE["source_claim"], SOURCE["truth_N101"]
    for value in (claim["v_pose6"], claim["std_qdot3_pose6"], claim["std_qdot3_others"]):
        assert f"{value}" in PROSE
    assert f"limit about {SOURCE['v_limit_N_to_infinity_approx']}" in PROSE
    assert f"std $q_3$ = {truth['std_q3_all_poses']:.4f} rad" in PROSE
    assert f"std $\\dot q_3$ = {truth['std_qdot3_all_poses']:.4f} rad/s" in PROSE


def test_an_own_curve_is_followed():
    words = printed("own-curve-speed")
    assert words.startswith("41 points given")
    rows = [numbers(line) for line in words.splitlines()[3:]]
    assert [row[1] for row in rows] == [1001] * 8
    assert len({row[3] for row in rows}) == 1 and rows[0][4] == 6
