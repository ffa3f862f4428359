"""Every explorer opens with every arm of the catalogue, and with arms of one's own, and tells the truth."""

import re
from pathlib import Path

import numpy as np
import pytest

from coursekit import Robot, ik, jacobians, path, robots, rotations, singularity, view
from coursekit.view import text

URDF = Path(__file__).parents[1] / "urdf"
X, Y, Z = np.eye(3)


def at(*p):
    T = np.eye(4)
    T[:3, 3] = p
    return T


def own():
    """Arms nobody knows, with 2 to 8 joints, slides among them."""
    yield Robot.from_axes([Z, Y], [at(0, 0, 0)[:3, 3], (0, 0, 0.4)], at(0.5, 0, 0.4), name="pan and tilt")
    yield Robot.from_axes([Z, X], np.zeros((2, 3)), at(0.5, 0, 0.4), "RP", name="turn and slide")
    yield Robot.from_axes(np.eye(3), np.zeros((3, 3)), at(0.2, 0, 0.4), "PPP", name="gantry")
    yield Robot.from_axes(
        [Z, Y, Y, Y, X],
        [(0, 0, 0), (0, 0, 0.4), (0.5, 0, 0.4), (0.9, 0, 0.4), (0.9, 0, 0.4)],
        at(1, 0, 0.4),
        name="five hinges",
    )
    yield Robot.from_screws(
        np.array([[0, 0, 1, 0, 0, 0.1], [0, 1, 0, -0.4, 0, 0], [0, 1, 0, -0.4, 0, 0.5]]).T,
        at(0.9, 0, 0.4),
        name="a pitch",
    )
    tilted = rotations.rotx(2 * 1.5708 - np.pi) @ Z  # parallel but for 7e-6 rad, as in many a URDF
    w = [Z, tilted, Y, Z, X, Y]
    q = [(0, 0, 0), (0.3, 0.1, 0), (0.6, 0, 0.1), (0.8, 0, 0.1), (1, 0, 0), (1.1, 0, 0.1)]
    yield Robot.from_axes(w, q, at(1.2, 0, 0.1), name="six hinges askew")
    for name, tip in (("kuka_iiwa14", None), ("tilted_gantry", None), ("franka_panda_hand", "tcp_link")):
        yield Robot.from_urdf(URDF / f"{name}.urdf", tip)


ARMS = {**robots.all(), **{arm.name: arm for arm in own()}}
every_arm = pytest.mark.parametrize("robot", ARMS.values(), ids=ARMS)


@pytest.fixture
def opened():
    """Function that opens an explorer and looks at what a notebook stores of it."""
    panels = []

    def run(explore, robot):
        panels.append(explore(robot))
        data, _ = panels[-1]._repr_mimebundle_()
        assert data["image/png"].startswith(b"\x89PNG")
        assert robot.name in data["text/plain"]
        return panels[-1]

    yield run
    for panel in panels:
        (formula,) = panel.formula
        assert set(formula.says) <= set(panel.viewer.pointers), "every part of the formula shows something"
        panel.close()


def elsewhere(robot, panel):
    """A configuration between the ends of the sliders, away from where they are."""
    ends = np.array([(s.min / s.shown_per_si, s.max / s.shown_per_si) for s in panel._controls["theta"].used])
    return ends.T[0] + np.linspace(0.55, 0.62, robot.n) * (ends.T[1] - ends.T[0])


def line(panel, begin):
    return next(line for line in panel.line.value.splitlines() if line.startswith(begin))


@every_arm
def test_conventions(robot, opened):
    panel = opened(view.explore, robot)
    theta = elsewhere(robot, panel)
    panel.set(theta=theta, standard=True, modified=True, screws=True)
    x, y, z = np.round(1000 * robot.fk(theta)[:3, 3], 3) + 0.0
    assert f"x = {x:9.3f}  y = {y:9.3f}  z = {z:9.3f} mm" in line(panel, "product of exponentials")
    if robot.standard_dh is None:
        assert "no DH table to compare with" in panel.line.value
    else:
        assert float(line(panel, "largest difference").split()[-1]) < 1e-9
    assert (" km away" in panel.line.value) == (robot.name == "six hinges askew")


@every_arm
def test_screws(robot, opened):
    panel = opened(view.explore_screws, robot)
    for i, kind in enumerate(robot.joint_types):
        panel.set(joint=f"joint {i + 1}", frame="flange frame: B")
        slider = panel._controls["turn"]
        slides = kind == "prismatic"
        assert (slider.unit, slider.label.split()[0]) == (("mm", "slide") if slides else ("deg", "turn"))
        moved = 0.5 * slider.max / slider.shown_per_si
        panel.set(turn=moved)
        theta = np.where(np.arange(robot.n) == i, moved, 0.0)
        assert text.row(robot.B[:, i]) in line(panel, f"column {i + 1} of B")
        told = line(panel, "tool at")
        assert text.millimetres(robot.fk(theta)[:3, 3]) in told
        assert (text.millimetres(moved) if slides else text.degrees(moved)) in told
        assert ("-w x q" in panel.line.value) == (not slides)
        np.testing.assert_allclose(panel.scene.robots["robot"].theta, theta, atol=1e-12)
        panel.set(turn=0.0)


@every_arm
def test_inverse(robot, opened):
    panel = opened(view.explore_inverse, robot)
    rows = panel._controls["solution"].rows

    def assert_arms_reach():
        T = np.eye(4)
        pose = panel.values["pose"]
        T[:3, :3], T[:3, 3] = rotations.from_zyx(pose[3:]), pose[:3]
        free = robot.name == "planar 2R" or "rotation is free" in panel.line.value
        for arm in panel.scene.robots.values():
            off = np.abs(robot.fk(arm.theta) - T)
            assert off[:3, 3].max() < 1e-8
            assert free or off.max() < 1e-8

    assert_arms_reach()
    assert len(rows) == len(panel.scene.robots) or "of 8 solutions" in panel.line.value
    try:
        ik.analytic(robot, robot.M)
        assert "restarts" not in panel.line.value
    except ik.NoClosedForm as error:
        assert f"no closed form for this arm: {error.condition}" in panel.line.value
        assert re.search(r"found by restarts: (at least \d|endlessly many)", panel.line.value)
    before = panel.scene.robots["robot"].theta
    middle = (np.clip(robot.q_min, -9, 9) + np.clip(robot.q_max, -9, 9)) / 2
    T = robot.fk(before + np.where(before > middle, -0.03, 0.03))
    panel.set(pose=[*T[:3, 3], *rotations.zyx(T[:3, :3])])
    assert_arms_reach()
    apart = np.abs(np.remainder(panel.scene.robots["robot"].theta - before + np.pi, 2 * np.pi) - np.pi)
    assert apart.max() < 0.6, "the arm has gone on from where it stood"
    if len(rows) > 1 and rows[1][1] != text.NOTHING:
        panel.set(solution=1)
        assert_arms_reach()
    pose = panel.values["pose"]
    pose[0] = panel._controls["pose"].sliders[0].max / 1000
    panel.set(pose=pose)
    assert "out of reach" in panel.line.value or "prismatic" in robot.joint_types  # slides have no end here
    panel.reset()
    assert_arms_reach()


@every_arm
def test_singularities(robot, opened):
    panel = opened(view.explore_singularities, robot)
    theta = elsewhere(robot, panel)
    panel.set(theta=theta)
    sigma, rank = singularity.sigma_min(robot, theta), int(singularity.rank(robot, theta))
    assert f"smallest singular value {text.number(sigma, 5)}, rank {rank}" in panel.line.value
    loss = line(panel, "weakest" if rank == min(robot.n, 6) else "lost")
    force, moment = (
        np.array([float(x) for x in re.search(rf"{name} \(([^)]*)\)", loss)[1].split(",")])
        for name in ("force", "moment")
    )
    place = robot.link_frames(theta)[4, :3, 3] if loss.endswith("wrist") else robot.fk(theta)[:3, 3]
    wrench = np.append(moment + np.cross(place, force), force)
    weakest = singularity.weakest_motion(robot, theta)
    assert abs(wrench @ weakest) > 0.98 * np.linalg.norm(wrench), "the text tells another motion"
    factors = {"wrist", "elbow", "shoulder"} <= set(re.findall(r"wrist|elbow|shoulder", panel.line.value))
    if robot.n != 6:
        assert "has no determinant" in panel.line.value and not factors
    if "to_weakest" in panel._controls:
        panel._message(panel._controls["to_weakest"], {"type": "press"}, [])
        panel.viewer.set_state({"frame": panel.viewer.motion["frames"] - 1, "playing": False})
        assert singularity.sigma_min(robot, panel.values["theta"]) <= sigma + 1e-9
    if panel.below:
        panel.below[0].on_click(*np.degrees([0.1, 0.1]) if robot.joint_types[1] == "revolute" else (1, 1))


@every_arm
def test_jacobians(robot, opened):
    panel = opened(view.explore_jacobians, robot)
    theta = elsewhere(robot, panel)
    panel.set(theta=theta)
    J = robot.jacobian_geometric(theta)
    assert text.row(jacobians.ellipsoid(J, "linear").lengths) in line(panel, "linear")
    start, told = panel.values["theta"], line(panel, "to {d}")
    T = robot.fk(theta + 0.01)
    panel.set(pose=[*T[:3, 3], *rotations.zyx(T[:3, :3])])
    placed = panel.scene.worlds(["/ck/target"])["/ck/target"]
    np.testing.assert_allclose(placed, T, atol=1e-9)
    np.testing.assert_allclose(panel.values["theta"], start, atol=1e-12)
    assert line(panel, "to {d}") != told
    rows = "all" if robot.n > 5 else "linear"
    found = ik.newton(robot, T, theta, max_iterations=50, tol=1e-8, rows=rows)
    if found.converged:
        assert f"Newton: {found.iterations} steps" in line(panel, "to {d}")


@every_arm
def test_path(robot, opened):
    panel = opened(view.explore_path, robot)
    frames = panel.viewer.motion["frames"]
    links = np.frombuffer(panel.viewer.motion_poses).reshape(frames, -1, 4, 4).transpose(0, 1, 3, 2)
    tool = (links[:, -1] @ robot.M)[:, :3, 3]
    if "not on the sphere" in panel.line.value:
        assert "a letter of" in panel.line.value
        steps = path.steps(tool)
        assert steps.max() < 3 * steps.min()
    else:
        np.testing.assert_allclose(tool, path.s_curve(101), atol=1e-8)
    speed = float(re.search(r"largest speed ([\d.]+) m/s", panel.line.value)[1])
    q = panel.motion.thetas
    assert speed == pytest.approx(float(path.speed_limit(q, tool, 2.0).speed), rel=1e-3)
    panel.set(wrapped=True)
    panel.viewer.frame = 50
    np.testing.assert_allclose(panel.scene.robots["robot"].theta, q[50], atol=1e-12)
