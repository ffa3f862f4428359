"""The catalogue: every robot against golden data, its conventions against each other, its data sheet."""

import numpy as np
import pytest

from coursekit import lie, robots
from tests.kinematics.conftest import FOLDER, GOLDEN_ROBOTS, SIX_HINGES, load

ALL = robots.all()
AXES_ONLY = {"kuka_kr10_report"}  # robots whose source gives no DH table: theirs is made from the axes
ROUNDED = 1e-11  # golden poses and Jacobians are rounded to 12 decimals
every_golden_robot = pytest.mark.parametrize("golden_name", GOLDEN_ROBOTS)
every_robot = pytest.mark.parametrize("name", ALL)


def cases_of(golden_name):
    """Golden configurations of one robot: {field: array over the cases}."""
    cases = load(f"fk_jac_{golden_name}")["cases"]
    return {key: np.array([case[key] for case in cases]) for key in cases[0]}


def test_the_catalogue_is_complete():
    assert set(GOLDEN_ROBOTS.values()) <= set(ALL)  # a newer one may have no golden data
    assert all(getattr(robots, name)().name == robot.name for name, robot in ALL.items())
    assert len({robot.name for robot in ALL.values()}) == len(ALL)


def test_a_robot_is_made_when_it_is_asked_for(monkeypatch):
    made = []
    monkeypatch.setattr(robots, "kuka_kr6", lambda: made.append("kuka_kr6"))
    robots.all()["ur5"]
    assert not made
    with pytest.raises(KeyError, match="kuka_kr7"):
        robots.all()["kuka_kr7"]


# -- golden data --


@every_golden_robot
def test_golden_data_are_complete(golden_name, golden):
    """What a line in GOLDEN_ROBOTS asks for. Where this fails, other tests end in a KeyError."""
    files = [f"fk_jac_{golden_name}"] + [f"ik_{golden_name}"] * (golden_name in SIX_HINGES)
    missing = [f"{name}.json" for name in files if not (FOLDER / f"{name}.json").exists()]
    if golden_name not in golden("robots")["robots"]:
        missing.append(f"robots.json: robots, {golden_name}")
    if golden_name in SIX_HINGES:
        singular = golden("singular")
        if golden_name not in singular["det_formula"]:
            missing.append(f"singular.json: det_formula, {golden_name}")
        if not any(case["robot"] == golden_name for case in singular["cases"]):
            missing.append(f"singular.json: cases of {golden_name}")
    assert not missing, f"tests/golden has no {'; no '.join(missing)}: see CONTRIBUTING, A robot"


@every_golden_robot
def test_golden_poses_and_jacobians(golden_name):
    robot, cases = ALL[GOLDEN_ROBOTS[golden_name]], cases_of(golden_name)
    q = cases["q"]
    assert len(q) >= 27
    assert np.abs(robot.fk(q) - cases["T"]).max() <= ROUNDED
    assert np.abs(robot.jacobian_space(q) - cases["J_space"]).max() <= ROUNDED
    assert np.abs(robot.jacobian_body(q) - cases["J_body"]).max() <= ROUNDED
    R = cases["T"][:, :3, :3]
    geometric = np.concatenate([R @ cases["J_body"][:, :3], R @ cases["J_body"][:, 3:]], axis=1)
    assert np.abs(robot.jacobian_geometric(q) - geometric).max() <= 2 * ROUNDED


@every_golden_robot
def test_golden_sizes_of_the_jacobian(golden_name):
    robot, cases = ALL[GOLDEN_ROBOTS[golden_name]], cases_of(golden_name)
    J = robot.jacobian_body(cases["q"])
    singular = np.linalg.svd(J, compute_uv=False)
    assert np.abs(singular - cases["singular_values"]).max() <= ROUNDED
    for rows, key in ((J[:, 3:], "lin_eig"), (J[:, :3], "ang_eig")):
        assert np.abs(np.linalg.eigvalsh(rows @ np.swapaxes(rows, -1, -2)) - cases[key]).max() <= ROUNDED
    if "manip" in cases:
        assert np.abs(singular.prod(axis=-1) - cases["manip"]).max() <= ROUNDED
    if "det_J_body" in cases:
        assert np.abs(np.linalg.det(J) - cases["det_J_body"]).max() <= ROUNDED


@every_golden_robot
def test_golden_data_sheet(golden_name, golden):
    robot, sheet = ALL[GOLDEN_ROBOTS[golden_name]], golden("robots")["robots"][golden_name]
    assert robot.n == sheet["n"]
    for key in ("S", "M", "B"):
        assert np.abs(getattr(robot, key) - sheet[key]).max() <= 1e-14, key
    assert np.abs(robot.home - sheet["home"]).max() <= 1e-14
    for key in ("q_min", "q_max"):
        # The author of the KR10's limits wrote degrees as 0.0174532925 rad.
        assert np.abs(getattr(robot, key) - sheet[key]).max() <= 3e-8, key
    v_max = np.array(sheet["v_max"], dtype=float)  # None becomes NaN
    assert np.allclose(robot.v_max, v_max, rtol=2e-5, atol=0, equal_nan=True)


@every_golden_robot
def test_golden_dh_tables(golden_name, golden):
    robot, sheet = ALL[GOLDEN_ROBOTS[golden_name]], golden("robots")["robots"][golden_name]
    rows = {
        "standard_dh": (sheet["sdh_rows_a_alpha_d_offset"], sheet["tool"]),
        "modified_dh": (sheet["mdh_rows_aim1_alphaim1_d_offset"], sheet["mdh_tool"]),
    }
    for key, (expected, tool) in rows.items():
        table = getattr(robot, key)
        assert (GOLDEN_ROBOTS[golden_name] in AXES_ONLY) == (expected is None), key
        if expected is not None:
            columns = np.stack([table.a, table.alpha, table.d, table.theta], axis=-1)
            assert np.abs(columns - np.array(expected, dtype=float)).max() <= 1e-14, key
            assert np.abs(table.tool - tool).max() <= 1e-14, key
            assert np.abs(table.base - sheet["base"]).max() <= 1e-14, key


@pytest.mark.parametrize("golden_name", SIX_HINGES)
def test_golden_limits(golden_name, golden):
    """Each solution of the golden inverse kinematics is inside its limits or not, whole turns tried."""
    robot, seen = ALL[GOLDEN_ROBOTS[golden_name]], 0
    for case in golden(f"ik_{golden_name}")["cases"]:
        if case["n"]:
            assert robot.within_limits(case["solutions"]).tolist() == case["within_limits"]
            seen += case["n"]
    assert seen >= 150


# -- three conventions, one arm --


@every_robot
def test_three_conventions_agree(name):
    """Screws are read off a drawing, tables are the published ones: nobody derived one from the other."""
    robot = ALL[name]
    theta = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, robot.n))
    T = robot.fk(theta)
    product = np.broadcast_to(robot.M, T.shape)
    for i in reversed(range(robot.n)):
        product = lie.exp6(robot.S[:, i] * theta[:, i : i + 1]) @ product
    assert np.abs(product - T).max() <= 2e-15
    assert (robot.standard_dh.convention, robot.modified_dh.convention) == ("standard", "modified")
    assert np.abs(robot.standard_dh.fk(theta) - T).max() <= 2e-15
    assert np.abs(robot.modified_dh.fk(theta) - T).max() <= 2e-15


@every_robot
def test_screws_from_the_tables_are_the_screws_of_the_drawing(name):
    robot = ALL[name]
    for table in filter(None, (robot.standard_dh, robot.modified_dh)):
        S, M = table.screws()
        assert np.abs(S - robot.S).max() <= 1e-15
        assert np.abs(M - robot.M).max() <= 1e-15


@every_robot
def test_at_zero_the_jacobians_are_the_screws(name):
    robot = ALL[name]
    assert np.abs(robot.jacobian_space(np.zeros(robot.n)) - robot.S).max() <= 1e-15
    assert np.abs(robot.jacobian_body(np.zeros(robot.n)) - robot.B).max() <= 1e-15


@every_robot
def test_link_frames_end_at_the_tool_and_lie_on_their_axes(name):
    robot = ALL[name]
    theta = np.random.default_rng(1).uniform(-3, 3, (20, robot.n))
    frames = robot.link_frames(theta)
    assert np.abs(frames[:, -1] - robot.fk(theta)).max() <= 2e-15
    J = robot.jacobian_space(theta)
    for i in range(robot.n - 1):
        z, origin = frames[:, i, :3, 2], frames[:, i, :3, 3]
        if robot.joint_types[i] == "prismatic":
            assert np.abs(z - J[:, 3:, i]).max() <= 5e-15
            continue
        assert np.abs(z - J[:, :3, i]).max() <= 5e-15
        assert np.abs(np.cross(origin, z) - J[:, 3:, i]).max() <= 5e-15
    frames_of_the_table = robot.modified_dh.frames(theta)
    if name in AXES_ONLY:  # the same directions, and where the axes were given
        frames, frames_of_the_table = frames[..., :3], frames_of_the_table[..., :3]
    assert np.abs(frames[:, :-1] - frames_of_the_table[:, :-1]).max() <= 2e-15


# -- the sheets --


@every_robot
def test_every_sheet_is_whole(name):
    robot = ALL[name]
    assert np.isfinite(robot.q_min).all()
    assert np.isfinite(robot.q_max).all()
    assert (robot.q_min < robot.q_max).all()
    assert not (robot.v_max <= 0).any()
    assert robot.within_limits(robot.home)
    assert robot.source
    assert all(sentence.endswith(".") for sentence in robot.discrepancies)


@every_robot
def test_links_are_as_long_at_home_as_at_zero(name):
    """The reach from one axis to the next is a property of the arm, whatever the angles."""
    robot = ALL[name]
    theta = np.random.default_rng(2).uniform(-3, 3, (50, robot.n))
    theta[:, [kind == "prismatic" for kind in robot.joint_types]] = 0.1
    frames = robot.link_frames(theta)[:, :-1, :3, 3]
    lengths = np.linalg.norm(np.diff(frames, axis=1), axis=-1)
    assert np.ptp(lengths, axis=0).max(initial=0) <= 5e-15


def test_reach_of_the_data_sheets():
    """Axis 1 to the wrist centre, arm stretched: 901, 1101 mm (KUKA), 901 (ABB); the straight model 1125."""
    for name, elbow, first, reach in [
        ("kuka_kr6", np.arctan2(35, 420), 25, 901.5),
        ("kuka_kr10", np.arctan2(25, 515), 25, 1100.6),
        ("kuka_kr10_report", 0.0, 25, 1125.0),
        ("abb_irb1200", -np.arctan2(451, 42), 0, 901.0),
    ]:
        robot = ALL[name]
        wrist = robot.link_frames([0, 0, elbow, 0, 0, 0])[3:5, :3, 3]
        shoulder = np.array([first, 0, robot.link_frames(np.zeros(6))[1, 2, 3] * 1000])
        distance = np.linalg.norm(1000 * wrist[-1] - shoulder) + first
        assert distance == pytest.approx(reach, abs=0.06), name


def test_the_report_s_numbers(golden):
    """TPK4170 report: M, S and B (in mm), and the pose of table 4.1."""
    numbers, robot = golden("numbers_of_the_sources")["TPK4170 report"], ALL["kuka_kr6"]
    mm = np.array([1, 1, 1, 1000, 1000, 1000])[:, None]
    assert np.abs(robot.S * mm - numbers["S"]).max() <= 1e-12
    assert np.abs(robot.B * mm - numbers["B_flange"]).max() <= 1e-12
    to_wrist = np.eye(4)
    to_wrist[0, 3] = -0.08
    assert np.abs(robot.with_tool(to_wrist).B * mm - numbers["B_wrist_as_printed_eq3_6"]).max() <= 1e-12
    T = robot.fk([2, -1, -1, 2.5, 0.6, 0])
    T[:3, 3] *= 1000
    assert np.abs(T - numbers["T_sd_table4_1"]).max() <= 1e-11


def test_the_planar_arm_takes_its_lengths(golden):
    assert robots.planar_2r(1.0, 0.8).M[0, 3] == pytest.approx(1.8)
    planar = golden("numbers_of_the_sources")["S030 exam"]["planar"]
    J = ALL["planar_2r"].jacobian_geometric(ALL["planar_2r"].home)
    assert np.abs(J[3:5] - np.array(planar["J"])).max() <= 1e-12
    for lengths, wrong in [((0, 1), "l1"), ((1, -1), "l2"), ((np.nan, 1), "l1")]:
        with pytest.raises(ValueError, match=f"planar_2r: {wrong} must be a positive length in metres"):
            robots.planar_2r(*lengths)


def test_the_two_kr10_differ_by_the_offset_of_the_forearm():
    true, report = ALL["kuka_kr10"], ALL["kuka_kr10_report"]
    assert ((true.M - report.M)[:3, 3] * 1000).round(9).tolist() == [-25, 0, 25]
    assert np.array_equal(np.abs(true.S[:3]), np.abs(report.S[:3]))
