"""Numeric inverse kinematics: the textbook's steps, success, and a plain word where there is none."""

from itertools import pairwise

import numpy as np
import pytest

from coursekit import Robot, ik, lie, robots
from coursekit.kinematics.ik import engine, iteration
from coursekit.kinematics.ik.engine import _arrays, _numbers, look

from .conftest import GOLDEN_ROBOTS, load

ALL = robots.all()
RNG = np.random.default_rng(11)
SLIDING = Robot.from_axes(
    [[0, 0, 1], [0, 0, 1], [1, 0, 0]],
    [[0, 0, 0], [0.5, 0, 0], [0, 0, 0]],
    lie.exp6([0, 0, 0, 0.5, 0, 0.2]),
    ["revolute", "prismatic", "prismatic"],
    name="sliding arm",
)


@pytest.mark.parametrize("case", load("numeric_ik")["cases"], ids=lambda case: case["robot"])
def test_golden_steps(case):
    robot = ALL[GOLDEN_ROBOTS[case["robot"]]]
    T, guess = np.array(case["T"]), np.array(case["guess"])
    e, J = lie.log6(lie.inverse(robot.fk(guess)) @ T), robot.jacobian_body(guess)
    assert np.allclose(e, case["body_error"], atol=1e-11)
    for step, key in [
        (ik.newton_step(J, e), "newton_step"),
        (ik.transpose_step(J, e), "transpose_step"),
        (ik.dls_step(J, e, case["dls_step_k"]), "dls_step"),
    ]:
        assert np.abs(step - case[key]).max() < 1e-8 * np.abs(case[key]).max() + 1e-11


@pytest.mark.parametrize("case", load("numeric_ik")["cases"][::5], ids=lambda case: case["robot"])
def test_the_methods_take_the_golden_steps(case):
    robot = ALL[GOLDEN_ROBOTS[case["robot"]]]
    guess = np.array(case["guess"])
    for found, key in [
        (ik.newton(robot, case["T"], guess, max_iterations=1), "newton_step"),
        (ik.transpose(robot, case["T"], guess, gain=1.0, max_iterations=1), "transpose_step"),
        (ik.damped_least_squares(robot, case["T"], guess, case["dls_step_k"], max_iterations=1), "dls_step"),
    ]:
        step = found.history[1].theta - guess
        assert np.abs(step - case[key]).max() < 1e-8 * np.abs(case[key]).max() + 1e-10


PITCH = Robot.from_screws(
    np.array([[0, 0, 1, 0, 0, 0.1], [0, 1, 0, 0, 0, -0.3]]).T, lie.exp6([0, 0, 0, 0.5, 0, 0]), name="drill"
)


@pytest.mark.parametrize("robot", [*ALL.values(), SLIDING, PITCH], ids=lambda robot: robot.name)
def test_what_an_iteration_sees_is_the_body_error_and_jacobian(robot):
    theta, T = RNG.uniform(-2, 2, (20, robot.n)), robot.fk(RNG.uniform(-2, 2, (20, robot.n)))
    J, e = robot.jacobian_body(theta), lie.log6(lie.inverse(robot.fk(theta)) @ T)
    turn = np.zeros((20, 6, 6))
    turn[:, :3, :3] = turn[:, 3:, 3:] = robot.fk(theta)[:, :3, :3]
    Jt, omega, v, gap, (angle, distance) = look(robot, theta, _arrays(T))
    assert np.allclose(np.swapaxes(Jt, 1, 2), turn @ J, atol=1e-12)
    assert np.allclose(np.stack([*omega, *v], axis=-1), (turn @ e[..., None])[..., 0], atol=1e-10)
    assert np.allclose(angle, np.linalg.norm(e[:, :3], axis=1), atol=1e-12)
    assert np.allclose(distance, np.linalg.norm(np.stack(gap), axis=0), atol=1e-14)
    one = look(robot, theta[0], _numbers(T[0]))
    assert np.allclose(one[0], Jt[0], atol=1e-15)
    assert np.allclose([*one[1], *one[2]], [x[0] for x in (*omega, *v)], atol=1e-12)


@pytest.mark.parametrize("angle", [np.pi, np.pi - 1e-9, np.pi - 1e-4, 1e-9, 0.0])
def test_half_a_turn_and_none(angle):
    robot = ALL["kuka_kr6"]
    T = robot.M @ lie.exp6([0, 0.6 * angle, 0.8 * angle, 0, 0, 0])
    for found in (
        look(robot, np.zeros(6), _numbers(T))[1],
        np.ravel(look(robot, np.zeros((1, 6)), _arrays(T[None]))[1]),
    ):
        assert np.allclose(np.abs(found), [0, 0.6 * angle, 0.8 * angle], atol=1e-7)


METHODS = {
    "newton": ik.newton,
    "transpose": lambda *a, **k: ik.transpose(*a, **{"max_iterations": 10_000, **k}),
    "damped": ik.damped_least_squares,
    "damped 0.1": lambda *a, **k: ik.damped_least_squares(*a, damping=0.1, **{"max_iterations": 2000, **k}),
}


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
@pytest.mark.parametrize("method", METHODS)
def test_near_guesses_converge_in_every_shape(method, shape):
    robot = ALL["kuka_kr6"]
    theta = np.array([0.3, -1, 0.6, 0.4, 0.9, 0.2]) + RNG.uniform(-0.1, 0.1, (*shape, 6))
    T = robot.fk(theta)
    found = METHODS[method](robot, T, theta + RNG.uniform(-0.05, 0.05, (*shape, 6)), tol=1e-7)
    assert found.theta.shape == (*shape, 6) and found.error.shape == (*shape, 2)
    assert np.shape(found.converged) == np.shape(found.reason) == np.shape(found.iterations) == shape
    assert np.all(found.converged) and np.all(found.reason == iteration.CONVERGED)
    assert np.abs(robot.fk(found.theta) - T).max() < 1e-6
    assert np.all(found.error < 1e-7)
    assert np.shape(found.within_limits) == shape


def test_guess_and_target_broadcast():
    robot = ALL["abb_irb1200"]
    T = robot.fk([0.2, 0.3, -0.4, 0.5, 0.6, 0.7])
    guesses = np.array([0.2, 0.3, -0.4, 0.5, 0.6, 0.7]) + RNG.uniform(-0.1, 0.1, (4, 3, 6))
    found = ik.newton(robot, T, guesses)
    assert found.theta.shape == (4, 3, 6) and found.converged.all()
    assert ik.newton(robot, np.tile(T, (5, 1, 1)), guesses[0, 0]).theta.shape == (5, 6)


def test_one_and_many_go_the_same_way():
    robot = ALL["franka_panda"]
    T = robot.fk(RNG.uniform(robot.q_min, robot.q_max, (30, 7)))
    many = ik.damped_least_squares(robot, T, robot.home)
    for i in range(30):
        one = ik.damped_least_squares(robot, T[i], robot.home)
        assert one.converged == many.converged[i]
        if one.converged:
            assert one.iterations == many.iterations[i]
            assert np.allclose(one.theta, many.theta[i], atol=1e-6)


@pytest.mark.parametrize("name", ["kuka_kr6", "franka_panda", "ur5", "scara", "stanford"])
@pytest.mark.parametrize("method", ["newton", "damped", "transpose"])
def test_the_engine_goes_the_way_of_the_plain_loop(method, name):
    """Step by step from the same guess: where the book's loop is, the fast one is, alone and in a batch."""
    robot = ALL[name]
    theta = robot.home + RNG.uniform(-0.2, 0.2, robot.n)
    T, guess = robot.fk(theta), theta + RNG.uniform(-0.1, 0.1, robot.n)
    step, fast = {
        "newton": (ik.newton_step, ik.newton),
        "damped": (
            lambda J, e: ik.dls_step(J, e, 0.05),
            lambda *a, **k: ik.damped_least_squares(*a, damping=0.05, **k),
        ),
        "transpose": (
            lambda J, e: ik.transpose_step(J, e, 0.3),
            lambda *a, **k: ik.transpose(*a, gain=0.3, **k),
        ),
    }[method]
    one = fast(robot, T, guess, max_iterations=12, tol=1e-9)
    for k, seen in enumerate(one.history):
        plain, count = ik.by_the_book(robot, T, guess, step, max_iterations=k, tol=1e-9)
        assert count == k and np.abs(plain - seen.theta).max() < 1e-9
    assert ik.by_the_book(robot, T, guess, step, 12, 1e-9)[1] == one.iterations
    many = fast(robot, np.tile(T, (3, 1, 1)), guess, max_iterations=12, tol=1e-9)
    assert many.iterations.tolist() == [one.iterations] * 3
    if one.converged:
        assert np.abs(many.theta - one.theta).max() < 1e-9


def test_tables_of_the_kuka_report():
    robot, numbers = ALL["kuka_kr6"], load("numbers_of_the_sources")["TPK4170 report"]
    T = robot.fk([2, -1, -1, 2.5, 0.6, 0])
    a = ik.newton(robot, T, [2, -1, -1, -1, -0.5, 3])
    b = ik.newton(robot, T, [-1, -2, 1, 0, 0.3, 0])
    for found, row in ((a, "Numerical A"), (b, "Numerical B")):
        assert found.converged
        difference = np.remainder(found.theta - numbers["table4_1_rows"][row] + np.pi, 2 * np.pi) - np.pi
        assert np.abs(difference).max() < 1e-3


def test_from_home_most_targets_are_reached_and_all_with_restarts():
    robot = ALL["kuka_kr6"]
    T = robot.fk(RNG.uniform(robot.q_min, robot.q_max, (1500, 6)))
    once = ik.damped_least_squares(robot, T, robot.home)
    assert once.converged.mean() > 0.94
    again = ik.damped_least_squares(robot, T, robot.home, restarts=50)
    assert again.converged.all()
    assert np.abs(robot.fk(again.theta) - T).max() < 1e-9
    at_once = once.converged & (once.iterations <= 20)
    assert np.array_equal(again.theta[at_once], once.theta[at_once])


def test_singular_targets_are_solved_one_by_one_and_together():
    """At a singular solution J J^T has no inverse; damping in proportion to the error gives it none."""
    robot = ALL["kuka_kr6"]
    theta = RNG.uniform(-1, 1, (200, 6))
    theta[:, 4] = 0
    T = robot.fk(theta)
    found = ik.damped_least_squares(robot, T, theta + 0.1, restarts=3)
    assert found.converged.mean() > 0.95
    assert np.abs(robot.fk(found.theta) - T)[found.converged].max() < 1e-9
    assert all(np.isfinite(ik.damped_least_squares(robot, T[i], theta[i]).theta).all() for i in range(20))


def test_restarts_are_reproducible():
    robot = ALL["kuka_kr6"]
    T = robot.fk(RNG.uniform(robot.q_min, robot.q_max, (300, 6)))
    a, b = (ik.damped_least_squares(robot, T, robot.home, restarts=9) for _ in range(2))
    assert np.array_equal(a.theta, b.theta)
    c = ik.damped_least_squares(robot, T, robot.home, restarts=9, rng=np.random.default_rng(5))
    assert c.converged.mean() > 0.99


def test_prismatic_joints():
    theta = np.array([0.4, 0.1, -0.2])
    for method in (ik.newton, ik.damped_least_squares):
        found = method(SLIDING, SLIDING.fk(theta), np.zeros(3))
        assert found.converged and np.allclose(found.theta, theta, atol=1e-9)


# -- targets that cannot be reached -------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_out_of_reach_ends_at_the_closest_pose(method):
    robot = ALL["kuka_kr6"]
    T = robot.M.copy()
    T[:3, 3] *= 1.6
    found = METHODS[method](robot, T, robot.home)
    assert not found.converged and found.reason == iteration.CLOSEST
    nearest = np.linalg.norm(T[:3, 3] - [0.025, 0, 0.4]) - 0.455 - np.hypot(0.42, 0.035) - 0.08
    assert nearest - 1e-3 < found.error[1] < 1.02 * nearest
    assert np.isclose(np.linalg.norm(T[:3, 3] - robot.fk(found.theta)[:3, 3]), found.error[1])
    J, e = robot.jacobian_geometric(found.theta), np.zeros(6)
    e[3:] = T[:3, 3] - robot.fk(found.theta)[:3, 3]
    e[:3] = lie.log3(T[:3, :3] @ robot.fk(found.theta)[:3, :3].T)
    assert np.abs(J.T @ e).max() < 1e-3  # no joint brings it nearer
    assert robot.fk(found.history[0].theta).tolist() == robot.fk(robot.home).tolist()


def test_the_way_downhill_keeps_its_last_step(monkeypatch):
    robot = ALL["kuka_kr6"]
    start = np.array([[0.3, -1, 0.6, 0.4, 0.9, 0.2]])
    goal = robot.fk(start + 0.3)
    scores = []
    for steps in (0, 1, 2):
        monkeypatch.setattr(engine, "DOWNHILL", steps)
        end = engine.closest(robot, goal, start, 1e-10)
        scores.append(end.score[0])
        assert np.allclose(robot.fk(end.theta)[0, :3, 3] - goal[0, :3, 3], 0, atol=end.error[0, 1] + 1e-12)
    assert scores[0] > scores[1] > scores[2]


def test_out_of_reach_in_a_batch_leaves_the_others_alone():
    robot = ALL["kuka_kr6"]
    T = robot.fk(np.array([0.3, -1, 0.6, 0.4, 0.9, 0.2]) + RNG.uniform(-0.1, 0.1, (4, 6)))
    T[2, :3, 3] *= 3
    found = ik.damped_least_squares(robot, T, [0.3, -1, 0.6, 0.4, 0.9, 0.2], restarts=2)
    assert found.converged.tolist() == [True, True, False, True]
    assert found.reason[2] == iteration.CLOSEST


def test_too_few_iterations():
    robot = ALL["kuka_kr6"]
    T = robot.fk([0.3, -1, 0.6, 0.4, 0.9, 0.2])
    found = ik.transpose(robot, T, [0.3, -1, 0.6, 0.4, 0.8, 0.2], max_iterations=3)
    assert not found.converged and found.reason == iteration.LIMIT and found.iterations == 3
    assert found.error.tolist() == found.history[-1].error.tolist()
    assert np.array_equal(found.theta, found.history[-1].theta)


def test_too_much_gain_wanders():
    robot = ALL["kuka_kr6"]
    theta = np.array([0.3, -1, 0.6, 0.4, 0.9, 0.2])
    bound = 2 / np.linalg.norm(robot.jacobian_body(theta), 2) ** 2
    good = ik.transpose(robot, robot.fk(theta), theta + 0.01, gain=0.9 * bound, max_iterations=3000)
    bad = ik.transpose(robot, robot.fk(theta), theta + 0.01, gain=1.5 * bound, max_iterations=3000)
    assert good.converged and not bad.converged
    assert bad.reason == iteration.WANDERING


def test_diverging_numbers_are_called_so():
    far = ik.transpose(SLIDING, SLIDING.fk([0.4, 0.1, -0.2]), np.zeros(3), gain=50.0, max_iterations=2000)
    assert not far.converged and far.reason == iteration.DIVERGED
    assert np.isfinite(far.theta).all()


def test_position_alone():
    robot = ALL["franka_panda"]
    T = robot.fk(robot.home + 0.1)
    found = ik.transpose(robot, T, robot.home, gain=1.0, rows="linear", tol=1e-9)
    assert found.converged and found.error[1] < 1e-9 and found.error[0] > 0.01
    planar = ALL["planar_2r"]
    target = np.eye(4)
    target[:2, 3] = 0.3, 0.4
    for method in (ik.newton, ik.damped_least_squares):
        found = method(planar, target, planar.home, rows="linear")
        assert found.converged and np.allclose(planar.fk(found.theta)[:2, 3], [0.3, 0.4], atol=1e-9)


@pytest.mark.parametrize("method", [ik.newton, ik.damped_least_squares])
def test_position_alone_goes_straight_there_however_far_the_rotation_is(method):
    """With the rotation free, the error is the way of the tool point: a near target takes a few steps."""
    scara = ALL["scara"]
    start = np.array([-1.2, 1.7, 0.1, -3.0])
    T = np.diag([1.0, -1.0, -1.0, 1.0])  # nearly half a turn away
    T[:3, 3] = scara.fk(start + 0.03)[:3, 3]
    found = method(scara, T, start, rows="linear")
    assert found.converged and found.iterations <= 5 and found.error[0] > 1


def test_damping_shortens_the_steps_near_a_singular_pose():
    robot = ALL["franka_panda"]
    guess = np.full(7, 0.02)
    T = robot.fk(np.array([0.5, 0.4, -0.3, -0.9, 0.2, 0.7, 0.1]))
    longest = [
        max(step.step for step in found.history)
        for found in (
            ik.newton(robot, T, guess),
            ik.damped_least_squares(robot, T, guess, damping=0.05),
            ik.damped_least_squares(robot, T, guess, damping=0.3),
        )
    ]
    assert longest[0] > longest[1] > longest[2]


def test_history_is_the_way_from_the_guess():
    robot = ALL["kuka_kr6"]
    found = ik.newton(robot, robot.fk([2, -1, -1, 2.5, 0.6, 0]), [2, -1, -1, 2, 0.5, 0])
    steps = found.history
    assert len(steps) == found.iterations + 1 and steps[0].step == 0
    assert steps[0].theta.tolist() == [2, -1, -1, 2, 0.5, 0]
    for before, after in pairwise(steps):
        assert np.isclose(np.linalg.norm(after.theta - before.theta), after.step)
    assert steps[-1].error.max() < 1e-10 < steps[-2].error.max()
    assert ik.newton(robot, robot.M[None], robot.home).history == ()


# -- NaN and errors ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_nan_in_nan_out(method):
    robot = ALL["kuka_kr6"]
    nan = np.full((4, 4), np.nan)
    for T, theta0 in ((nan, robot.home), (robot.M, robot.home * np.nan)):
        found = METHODS[method](robot, T, theta0)
        assert np.isnan(found.theta).all() and np.isnan(found.error).all()
        assert not found.converged and found.reason == iteration.NOT_A_NUMBER and not found.within_limits
    theta = np.array([0.3, -1, 0.6, 0.4, 0.9, 0.2])
    found = METHODS[method](robot, np.stack([robot.fk(theta), nan]), theta + 0.01, tol=1e-6)
    assert found.converged[0] and np.isnan(found.theta[1]).all()


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda r: ik.newton(r, np.diag([1, 1, -1, 1]), r.home), r"KUKA KR6 R900 sixx: T is not in SE\(3\)"),
        (
            lambda r: ik.newton(r, r.M, [0, 0]),
            r"KUKA KR6 R900 sixx has 6 joints: theta must have shape \(\.\.\., 6\)",
        ),
        (
            lambda r: ik.newton(r, r.M, r.home, rows="angular"),
            'rows must be "all" or "linear", got \'angular\'',
        ),
        (
            lambda r: ik.newton(r, r.M, r.home, max_iterations=-1),
            "max_iterations must be 0 or a positive whole number",
        ),
        (lambda r: ik.newton(r, r.M, r.home, tol=0), "tol must be positive, got 0"),
        (
            lambda r: ik.newton(r, r.M[None].repeat(2, 0), np.zeros((3, 6))),
            r"T \(2,\) and theta0 \(3,\) do not broadcast",
        ),
        (lambda r: ik.transpose(r, r.M, r.home, gain=0), "gain must be positive, got 0"),
        (
            lambda r: ik.damped_least_squares(r, r.M, r.home, damping=0),
            r"damping must be positive \(or None\), got 0",
        ),
        (
            lambda r: ik.damped_least_squares(r, r.M, r.home, restarts=1.5),
            "restarts must be 0 or a positive whole number",
        ),
        (
            lambda r: ik.newton_step(np.eye(6), np.zeros(3)),
            r"J must be \(\.\.\., m, n\) and e \(\.\.\., m\), got \(6, 6\)",
        ),
    ],
)
def test_errors_say_what_came_and_what_is_valid(call, message):
    with pytest.raises(ValueError, match=message):
        call(ALL["kuka_kr6"])
