"""The explorer of Jacobian methods without a browser."""

import ipywidgets
import numpy as np
import pytest

from coursekit import ik, jacobians, robots, singularity, view
from coursekit.view import text
from coursekit.view.camera import ASPECT
from coursekit.view.picture import _Eye


@pytest.fixture
def panel():
    panel = view.explore_jacobians()
    yield panel
    panel.close()


def test_it_opens_near_a_singularity_and_inside_the_limits(panel):
    panda = robots.franka_panda()
    theta = panel.scene.robots["robot"].theta
    assert panda.within_limits(theta)
    assert singularity.sigma_min(panda, theta) < 0.06
    assert panel.values["linear"] and not panel.values["angular"]


@pytest.mark.parametrize("part", ["linear", "angular"])
def test_the_text_gives_the_half_axes_of_the_arm_as_it_stands(panel, part):
    panda, theta = robots.franka_panda(), np.array([0.3, -0.4, 0.2, -1.5, 0.6, 1.2, 0.1])
    panel.set(theta=theta)
    found = jacobians.ellipsoid(panda.jacobian_body(theta), part)
    (line,) = [line for line in panel.line.value.splitlines() if line.startswith(part)]
    assert text.row(found.lengths) in line


def test_the_ellipsoids_are_drawn_at_the_tool_to_the_scale_the_text_gives(panel):
    panda, theta = robots.franka_panda(), np.array([0.3, -0.4, 0.2, -1.5, 0.6, 1.2, 0.1])
    panel.set(theta=theta, angular=True)
    for part in ("linear", "angular"):
        placed = panel.scene.worlds([f"/ck/{part}/body"])[f"/ck/{part}/body"]
        np.testing.assert_allclose(placed[:3, 3], panda.fk(theta)[:3, 3], rtol=0, atol=1e-12)
        (line,) = [line for line in panel.line.value.splitlines() if line.startswith(part)]
        scale = float(line.split("drawn ")[1].split(" mm")[0]) / 1000
        lengths = jacobians.ellipsoid(panda.jacobian_geometric(theta), part).lengths
        np.testing.assert_allclose(np.linalg.norm(placed[:3, :3], axis=0), scale * lengths, rtol=1e-9)


def test_the_target_and_the_ellipsoid_of_every_named_pose_are_in_the_picture():
    model, poses = robots.kuka_kr10_report(), {"stretched": np.zeros(6), "up": [0, -1.6, 0.04, 0, 0.5, 0]}
    panel = view.explore_jacobians(model, poses=poses)
    eye = _Eye(panel.scene.views["home"], 470 * ASPECT, 470)
    corners = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    for theta in poses.values():
        panel.set(theta=theta)
        worlds = panel.scene.worlds(["/ck/linear/body", "/ck/target"])
        ellipsoid, goal = worlds["/ck/linear/body"], worlds["/ck/target"]
        ends = goal[:3, 3] + 0.14 * panel.scene.size * goal[:3, :3].T
        round_ball = corners / np.sqrt(3) @ ellipsoid[:3, :3].T + ellipsoid[:3, 3]
        pixels = eye.project(np.vstack([ends, round_ball]))[0]
        assert np.all((pixels > 5) & (pixels < [470 * ASPECT - 5, 465]))
    panel.close()


def test_a_right_ellipsoid_of_the_student_leaves_the_colour_that_the_switch_names():
    def ellipsoid(J):
        U, lengths, _ = np.linalg.svd(J)
        return lengths, U

    panel = view.explore_jacobians(mine=ellipsoid)
    bodies = [
        part for path, parts in panel.scene.parts.items() if path.endswith("/linear/body") for part in parts
    ]
    right, mine = (part.opacity for part in bodies)
    panel.close()
    assert mine < right / 4, "magenta over teal looks like the violet of the other one"


def test_the_switches_hide_the_ellipsoids(panel):
    panel.set(linear=False, angular=True)
    assert not panel.scene.visible("/ck/linear")
    assert panel.scene.visible("/ck/angular")
    assert "hidden" in panel.line.value.splitlines()[0]


def test_the_methods_agree_and_the_text_says_how_far(panel):
    line = next(line for line in panel.line.value.splitlines() if "exponentials" in line)
    skew, derivative, differences = (float(part.split()[-1]) for part in line.split(": ")[1].split(", "))
    assert skew < 1e-14 and derivative < 1e-14 and 0 < differences < 3e-10


def test_newton_leaps_and_damping_tames_it(panel):
    panda, start = robots.franka_panda(), panel.values["theta"]
    target = panda.fk(panda.home)
    longest = {}
    for name, run in {
        "Newton": ik.newton(panda, target, start, tol=1e-8),
        "damped, k = 0.10": ik.damped_least_squares(panda, target, start, damping=0.1, tol=1e-8),
    }.items():
        longest[name] = max(step.step for step in run.history)
        assert f"{name}: {run.iterations} steps, the longest {longest[name]:.2f} rad" in panel.line.value
    assert longest["Newton"] > 4 * longest["damped, k = 0.10"]
    panel.set(damping=0.3)
    assert "damped, k = 0.30" in panel.line.value


def test_the_actions_move_the_arm_and_play_both_runs(panel):
    near = panel.values["theta"]
    panel._controls["newton"].act()
    panel._controls["damped"].act()
    panel._controls["bent"].act()
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, robots.franka_panda().home)
    assert "Newton: 0 steps" in panel.line.value  # it stands at the target
    panel._controls["newton"].act()
    panel._controls["near"].act()
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, near)


def test_the_ellipsoids_go_along_while_a_run_is_played(panel):
    panda, start = robots.franka_panda(), panel.values["theta"]
    before = panel.scene.pose()
    panel._controls["damped"].act()
    played = np.frombuffer(panel.viewer.motion_poses).reshape(panel.viewer.motion["frames"], -1, 4, 4)
    steps = ik.damped_least_squares(panda, panda.fk(panda.home), start, damping=0.1, tol=1e-8).history
    body = panel.viewer.motion["moving"].index("/ck/linear/body")
    for frame, step in zip(played, steps, strict=True):
        np.testing.assert_allclose(frame[body].T[:3, 3], panda.fk(step.theta)[:3, 3], atol=1e-9)
    np.testing.assert_array_equal(panel.scene.pose(), before)


def test_a_students_loop_is_shown_as_far_as_the_target():
    panda = robots.franka_panda()
    counted = []

    def dls_loop(robot, T_sd, theta, k, steps):
        """Goes on at the target, as the exercise asks: every run has all of its steps."""
        counted.append(steps)
        return ik.trail(robot, T_sd, theta, lambda J, e: ik.dls_step(J, e, k), steps)

    panel = view.explore_jacobians(mine=dls_loop)
    steps = ik.damped_least_squares(
        panda, panda.fk(panda.home), panel.values["theta"], damping=panel.values["damping"], tol=1e-8
    ).iterations
    assert f"the first step is right, below 1e-9; {steps} steps to the target" in panel.line.value
    panel._controls["mine"].act()
    assert panel.viewer.motion["frames"] == steps + 1 < counted[-1] + 1
    panel.close()


def test_a_named_pose_is_reached_beyond_the_limits_too():
    model, theta = robots.kuka_kr10_report(), [0, -np.pi / 6, -2.2829525304720546, 0, np.pi / 6, 0]
    assert not model.within_limits(theta)
    panel = view.explore_jacobians(model, poses={"alignment as printed": theta, "zero": np.zeros(6)})
    try:
        panel._controls["to_alignment_as_printed"].act()
        panel.viewer.set_trait("playing", False)
        panel.viewer.set_trait("frame", 30)  # as the page says when the motion rests
        np.testing.assert_allclose(panel.values["theta"], theta, atol=1e-9)
        assert "shown: step" not in panel.line.value  # the runs begin here
        played = np.frombuffer(panel.viewer.motion_poses).reshape(panel.viewer.motion["frames"], -1, 4, 4)
        body = panel.viewer.motion["moving"].index("/ck/linear/body")
        np.testing.assert_allclose(played[-1][body].T[:3, 3], model.fk(theta)[:3, 3], atol=1e-9)
    finally:
        panel.close()


def test_a_named_pose_of_another_arm_is_refused():
    with pytest.raises(ValueError, match="6 joints"):
        view.explore_jacobians(robots.kuka_kr10(), poses={"home": np.zeros(7)})


@pytest.mark.parametrize("name", robots.all())
def test_every_arm(name):
    robot = robots.all()[name]
    panel = view.explore_jacobians(robot)
    try:
        assert robot.within_limits(panel.scene.robots["robot"].theta)
        assert panel.values["pose"][2] >= 0, "the target is in the floor"
        assert "Newton: " in panel.line.value and "Error" not in panel.line.value
    finally:
        panel.close()


def test_a_picture_a_line_and_no_leak():
    view.explore_jacobians().close()
    before = len(ipywidgets.widgets.widget._instances)
    panel = view.explore_jacobians()
    bundle, _ = panel._repr_mimebundle_()
    assert bundle["image/png"].startswith(b"\x89PNG")
    assert bundle["text/plain"].startswith("Explorer of Jacobian methods: Franka Emika Panda")
    open_now = len(ipywidgets.widgets.widget._instances)
    panel = view.explore_jacobians()  # as when the cell runs again
    assert len(ipywidgets.widgets.widget._instances) == open_now
    panel.close()
    assert len(ipywidgets.widgets.widget._instances) == before
