"""Notebook 05: its numbers against the golden data, computed or stored by the notebook's own cells."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coursekit import ik, jacobians, lie, robots, rotations
from coursekit.classroom.author import notebook
from tests.kinematics.conftest import load

PATH = Path(__file__).resolve().parents[2] / "notebooks" / "05_jacobian_methods.ipynb"
CELLS = {cell["id"]: cell for cell in notebook.read(PATH)["cells"]}
SOURCES = load("numbers_of_the_sources")
ARMS = {
    "kuka_kr10": "kuka_kr10_r1100_2",
    "kuka_kr10_report": "kuka_kr10_r1100_2_report",
    "franka_panda": "franka_panda",
    "kawasaki_s030": "kawasaki_s030",
}


def printed(cell_id):
    """What a cell printed when it was stored."""
    outputs = CELLS[cell_id]["outputs"]
    return "".join("".join(out["text"]) for out in outputs if out["output_type"] == "stream")


def numbers(line):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])", line)]


@pytest.fixture(scope="module")
def solved():
    """What the set-up cell and the exercises' solutions define."""
    return notebook.references(PATH)


def cases(name):
    return load(f"fk_jac_{ARMS[name]}")["cases"][:20]


@pytest.mark.parametrize("name", ARMS)
def test_the_solutions_agree_with_the_golden_jacobians(solved, name):
    robot = robots.all()[name]
    for case in cases(name):
        q, T = np.array(case["q"]), np.array(case["T"])
        J_s = np.array(case["J_space"])
        np.testing.assert_allclose(solved.jacobian_space(robot.S, q), J_s, rtol=0, atol=1e-11)
        axes = J_s[:3].T
        origins = np.cross(axes, J_s[3:].T)
        J = solved.jacobian_geometric(axes, origins, T[:3, 3])
        turned = np.vstack([T[:3, :3] @ np.array(case["J_body"])[k : k + 3] for k in (0, 3)])
        np.testing.assert_allclose(J, turned, rtol=0, atol=1e-11)
        by_differences = solved.jacobian_by_differences(robot.fk, q, 1e-5)
        np.testing.assert_allclose(by_differences, turned, rtol=0, atol=3e-10)


def test_space_and_body_jacobian_of_the_panda():
    for case in cases("franka_panda"):
        J_s = lie.adjoint(np.array(case["T"])) @ np.array(case["J_body"])
        np.testing.assert_allclose(J_s, case["J_space"], rtol=0, atol=1e-11)


def test_the_ellipsoid_of_the_student_has_the_golden_eigenvalues(solved):
    for case in cases("franka_panda"):
        J = np.array(case["J_body"])
        for rows, key in ((J[:3], "ang_eig"), (J[3:], "lin_eig")):
            lengths, axes = solved.ellipsoid(rows)
            np.testing.assert_allclose(lengths[::-1] ** 2, case[key], rtol=0, atol=1e-10)
            np.testing.assert_allclose(axes @ np.diag(lengths**2) @ axes.T, rows @ rows.T, atol=1e-12)


def test_the_damped_steps_are_the_golden_ones(solved):
    golden = load("numeric_ik")["cases"]
    names = {
        "kuka_kr6_r900_sixx": "kuka_kr6",
        "abb_irb1200_5_90": "abb_irb1200",
        **{v: k for k, v in ARMS.items()},
    }
    tried = [case for case in golden if case["robot"] in names]
    assert len(tried) >= 20
    for case in tried:
        robot = robots.all()[names[case["robot"]]]
        J, e = robot.jacobian_body(case["guess"]), np.array(case["body_error"])
        step = solved.dls_step(J, e, case["dls_step_k"])
        np.testing.assert_allclose(step, case["dls_step"], rtol=1e-7, atol=1e-10)


def test_four_methods_below_the_promised_bounds():
    lines = printed("four-methods").splitlines()
    assert [line.split(": ")[1] for line in lines[1:]] == ["below 1e-12", "below 1e-12", "below 3e-10"]
    everything = "".join(printed(i) for i, cell in CELLS.items() if cell["cell_type"] == "code")
    assert "NOT below" not in everything and "differs" not in everything and "not written" not in everything


def test_the_chain_is_the_assignments():
    """U_5 and O_5 as printed, against the product of its plain turns and shifts."""
    turn = rotations.rotz(0.3) @ rotations.roty(-0.7 + 0.9) @ rotations.rotx(0.5)
    np.testing.assert_allclose(numbers(printed("chain-read"))[:3], turn[:, 1], rtol=0, atol=6e-4)
    assert "T_6 - fk: below 1e-12" in printed("chain-read")


def test_the_derivative_gives_the_golden_columns(solved):
    robot = robots.kuka_kr10()
    for case in cases("kuka_kr10"):
        q, T, left = np.array(case["q"]), np.array(case["T"]), np.eye(4)
        for i, S in enumerate(robot.S.T):
            after = left @ lie.exp6(S * q[i])
            T_dot, column = solved.transform_rate(left, S, q[i], lie.inverse(after) @ T)
            body = np.array(case["J_body"])[:, i]
            turned = np.concatenate([T[:3, :3] @ body[:3], T[:3, :3] @ body[3:]])
            np.testing.assert_allclose(column, turned, rtol=0, atol=1e-11)
            np.testing.assert_allclose(T_dot, T @ lie.hat6(body), rtol=0, atol=1e-11)
            left = after


def test_torques_by_virtual_work(solved):
    """Along any motion the joints give the power that the tool takes, here by differences."""
    rng, robot = np.random.default_rng(8), robots.franka_panda()
    for case in cases("franka_panda")[:8]:
        q, m, f = np.array(case["q"]), rng.normal(size=3), rng.normal(size=3)
        tau = solved.torques(np.array(case["J_body"]), np.array(case["T"]), m, f)
        for i, d in enumerate(1e-5 * np.eye(7)):
            behind, ahead = robot.fk(q - d), robot.fk(q + d)
            turn = lie.log3(ahead[:3, :3] @ behind[:3, :3].T)
            work = m @ turn + f @ (ahead - behind)[:3, 3]
            assert tau[i] == pytest.approx(work / 2e-5, abs=1e-7)


def test_the_damped_run_begins_with_the_golden_step(solved):
    names = {"kuka_kr6_r900_sixx": "kuka_kr6", "abb_irb1200_5_90": "abb_irb1200"}
    for case in load("numeric_ik")["cases"]:
        if case["robot"] in names:
            robot, guess = robots.all()[names[case["robot"]]], np.array(case["guess"])
            target = robot.fk(guess) @ lie.exp6(case["body_error"])
            rows = solved.dls_loop(robot, target, guess, case["dls_step_k"], 1)
            np.testing.assert_allclose(rows[1] - rows[0], case["dls_step"], rtol=1e-6, atol=1e-8)


def test_weights_by_the_slope_of_the_energy():
    shown = printed("weights")
    assert shown.count("slope of the energy: below 1e-06") == 2
    load = numbers(shown.split("stretched: load")[1].split("links")[0])
    np.testing.assert_allclose(load[1], -98.1 * (1.19 - 0.025), atol=0.06)  # lever from axis 2 to the flange


def test_a_tenth_of_the_step_is_a_hundredth_of_the_central_error():
    (_, c2, f2), (_, c3, f3) = (numbers(line) for line in printed("figure-differences").splitlines()[:2])
    assert c2 / c3 == pytest.approx(100, rel=0.02)
    assert f2 / f3 == pytest.approx(10, rel=0.02)


def test_the_exam_on_the_planar_arm(solved):
    planar = SOURCES["S030 exam"]["planar"]
    theta, rate = np.array([np.pi / 4, -np.pi / 2]), np.array([1.0, -1.0])
    v_B, v_E = solved.tool_velocity(theta, rate, np.array([0.5, 0.25]))
    np.testing.assert_allclose(v_B, planar["Bv"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(v_E, planar["Ev"], rtol=0, atol=1e-12)
    J = jacobians.planar(robots.planar_2r(0.5, 0.25), theta)
    np.testing.assert_allclose(J, planar["J"], rtol=0, atol=1e-12)
    shown = printed("exam-planar")
    for key in ("Bv", "Ev", "dq_B", "dq_E"):
        assert "({:.4f}, {:.4f})".format(*planar[key]) in shown, key
    assert "det J = -0.125" in shown


def test_the_wrist_velocity_of_the_s030():
    exam, shown = SOURCES["S030 exam"], printed("exam-wrist").splitlines()[1:]
    np.testing.assert_array_equal([numbers(line) for line in shown[:3]], exam["J_n"])
    np.testing.assert_allclose(numbers(shown[3]), exam["v_P"], rtol=0, atol=6e-5)


def test_the_ellipsoids_of_the_panda():
    lines = dict(
        zip(
            ("hl", "ha", "zl", "za"), map(numbers, printed("ellipsoid-numbers").splitlines()[6:]), strict=True
        )
    )
    assert lines["hl"][:3] == [0.3377, 0.2648, 0.0653]
    assert lines["hl"][6] == 0.0764 and lines["hl"][-2:] == [2.274, 5.172]
    np.testing.assert_allclose(lines["ha"][:3], [3, 2.707, 1.293], rtol=0, atol=5e-4)
    assert lines["zl"][:6] == [0.4444, 0.0232, 0.0109, 0.667, 0.152, 0.105]
    assert lines["za"][:3] == [4, 3, 0]
    golden = SOURCES["Panda assignment"]
    np.testing.assert_allclose(lines["zl"][2::-1], golden["zero_config_lin_eig"], rtol=0, atol=5e-5)
    np.testing.assert_allclose(lines["za"][2::-1], golden["zero_config_ang_eig"], rtol=0, atol=5e-5)
    assert lines["hl"][7] == pytest.approx(4 / 3 * np.pi * 0.0764, abs=5e-4)  # the volume is 4 pi / 3 times V


def test_damping_makes_the_longest_step_shorter_and_the_run_longer():
    text = printed("figure-steps")
    assert "smallest singular value: 0.028" in text
    rows = [line.split() for line in text.splitlines()[7:]]
    longest, steps = [float(row[-2]) for row in rows], [int(row[-1]) for row in rows]
    assert longest == sorted(longest, reverse=True) == [5.364, 3.422, 1.748, 0.540]
    assert steps == sorted(steps) == [7, 10, 12, 52]


def test_no_pose_of_the_panda_breaks_the_gain_bound():
    panda = robots.franka_panda()
    q = np.random.default_rng(11).uniform(-np.pi, np.pi, (20_000, 7))
    largest = np.linalg.svd(panda.jacobian_body(q)[:, 3:], compute_uv=False)[:, 0].max() ** 2
    assert 1.02 < largest < 1.0376
    assert "gain below 1.93" in printed("transpose")


def test_the_transpose_leaves_the_rotation_and_diverges_in_millimetres():
    panda = robots.franka_panda()
    run = ik.transpose(panda, panda.fk(panda.home), panda.home + 0.1, gain=1, rows="linear")
    assert run.converged and run.error[1] < 1e-6
    assert run.error[0] == pytest.approx(0.141, abs=5e-4)
    metres, millimetres = printed("transpose").splitlines()[3:]
    assert metres.split()[-3:] == ["yes", str(run.iterations), "0.141"]
    assert millimetres.split()[-3:] == ["no", "-", "-"]


def test_a_wide_jacobian_has_two_formulas_and_an_idle_direction():
    shown = printed("branches")
    assert shown.count("below 1e-12") == 3
    assert "rank of J^T J, 7 x 7: 6" in shown


def test_how_many_joint_rates():
    rows = [line.split("  ") for line in printed("counting").splitlines()[2:]]
    assert [row[-1] for row in rows] == ["none", "one", "infinitely many", "none", "infinitely many"]


def test_the_bug_hunt_is_off_and_its_repair_is_not():
    page, repair = (printed(f"bug-hunt-{i}").splitlines()[2:] for i in ("page", "repair"))
    assert [line.split()[-1] for line in page] == ["1.000", "0.707", "0.000", "0.500", "0.500"]
    assert [line.split()[-1] for line in repair] == ["0.000"] * 5


def test_six_named_poses_of_the_assignment():
    named = printed("named-poses").splitlines()
    assert len(named) == 6
    assert [int(line.split("rank ")[1][0]) for line in named] == [5, 5, 5, 4, 5, 5]
    assert ["no" in line.split(": ")[-1] for line in named] == [False, False, True, False, False, True]


def test_one_lap_of_the_circle():
    shown = printed("circle")
    assert "below 1e-11" in shown
    assert max(map(abs, numbers(shown.splitlines()[1]))) > 0.01  # it drifts
