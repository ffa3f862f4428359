"""Paths: the letter S and its frames, continuous branches, and the largest speed, against golden data."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from coursekit import ik, lie, path, robots, rotations
from coursekit.kinematics import spline

EXACT = 1e-11  # golden points, frames and branches are rounded to 12 decimals
BOUND = 2.0  # rad/s, the bound of the RPI mini project for every joint
ABB = robots.abb_irb1200()


@pytest.fixture(scope="module")
def branches():
    """The eight joint paths of the ABB arm along the S: {number of points: q (8, n, 6)}."""
    return {n: path.follow(ABB, path.frames(path.s_curve(n))) for n in (101, 201, 1001, 5001)}


# -- the curve and its frames --


def test_golden_points(golden):
    data = golden("s_curve_arcs")
    points = path.s_curve()
    assert points.shape == (101, 3)
    assert np.abs(points - data["p"]).max() <= EXACT
    assert np.abs(np.linspace(0, 1.8313099964089, 101) - data["lam"]).max() <= EXACT


def test_golden_frames(golden):
    data = golden("s_curve_arcs")
    R = path.frames(path.s_curve(), [0, 0, 0.5])[:, :3, :3]
    assert np.abs(rotations.from_zyx(data["zyx"]) - R).max() <= EXACT
    assert np.abs(rotations.from_quaternion(data["quat_wxyz"]) - R).max() <= EXACT
    assert np.abs(lie.exp3(data["rotvec"]) - R).max() <= EXACT
    assert np.abs(rotations.zyx(R) - data["zyx"]).max() <= EXACT


@pytest.mark.parametrize("n", [2, 3, 101, 1000])
def test_the_s_lies_on_its_sphere_in_equal_steps(n):
    points = path.s_curve(n)
    assert points.shape == (n, 3)
    assert np.abs(np.linalg.norm(points - path.SPHERE_CENTER, axis=1) - 0.5).max() <= 1e-9
    steps = path.steps(points)
    assert np.ptp(steps) <= 1e-4 * steps.mean()  # chords of equal arcs: shorter where the curve bends more


@pytest.mark.parametrize("n", [101, 201, 1001, 5001])
def test_golden_steps(n, golden):
    steps = path.steps(path.s_curve(n))
    uneven = golden("s_curve_arcs")["by_N"][str(n)]["max_abs_step_minus_mean"]
    assert np.abs(steps - steps.mean()).max() == pytest.approx(uneven, abs=1e-15)


def test_the_letter_plane_goes_to_the_sphere():
    letter = np.random.default_rng(0).uniform(-3, 3, (3, 1, 50, 2))
    points = path.on_sphere(letter)
    assert points.shape == (3, 1, 50, 3)
    assert np.abs(np.linalg.norm(points - path.SPHERE_CENTER, axis=-1) - 0.5).max() <= 1e-15
    # Pole, point and letter lie on one line: similar triangles seen from (-0.5, 0, 0.5).
    from_pole = points - [-0.5, 0, 0.5]
    assert np.abs(from_pole[..., 1:] / from_pole[..., :1] - letter).max() <= 1e-12


def test_frames_are_poses_with_x_outwards_and_y_forwards():
    points = path.s_curve(301)
    T = path.frames(points)
    R = T[:, :3, :3]
    assert np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max() <= 1e-15
    assert np.linalg.det(R) == pytest.approx(np.ones(301))
    assert np.array_equal(T[:, :3, 3], points)
    assert np.abs(R[:, :, 0] - (points - [0, 0, 0.5]) / 0.5).max() <= 1e-9
    assert ((np.diff(points, axis=0) * R[:-1, :, 1]).sum(axis=1) > 0).all()
    assert np.abs(T[:, 3] - [0, 0, 0, 1]).max() == 0


def test_resampling_a_straight_line_is_exact():
    line = np.outer([0, 0.1, 0.5, 0.6, 2.0], [1, 2, 2])
    points = path.resample(line, 13)
    assert np.abs(points - np.outer(np.linspace(0, 2, 13), [1, 2, 2])).max() <= 1e-13


def test_resampling_a_circle_keeps_to_it():
    angle = np.linspace(0, 6, 400) ** 1.2
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    points = path.resample(circle, 57)
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() <= 1e-6
    assert np.ptp(path.steps(points)) <= 1e-4
    assert np.array_equal(points[0], circle[0])
    assert np.abs(points[-1] - circle[-1]).max() <= 1e-14


@pytest.mark.parametrize("m", [2, 3, 4, 5, 17, 400])
def test_the_spline_is_scipys(m):
    rng = np.random.default_rng(m)
    x = np.cumsum(rng.uniform(0.01, 1, m) ** 3) - 1  # steps from 1e-6 to 1
    y = rng.normal(size=(m, 3))
    at = np.concatenate([np.linspace(x[0], x[-1], 500), x])
    expected = CubicSpline(x, y)(at)
    assert np.abs(spline.not_a_knot(x, y, at) - expected).max() <= 1e-11 * np.abs(expected).max()


@pytest.mark.parametrize("degree", range(4))
def test_a_cubic_is_its_own_spline(degree):
    x = np.array([0, 0.3, 1, 1.1, 2.5, 4])
    at = np.linspace(0, 4, 50)
    assert np.abs(spline.not_a_knot(x, x[:, None] ** degree, at)[:, 0] - at**degree).max() <= 1e-13


def test_resampling_a_letter_is_what_scipy_makes_of_it():
    letter = np.random.default_rng(1).uniform(-0.3, 0.3, (9, 2))
    points = path.on_sphere(letter)
    length = np.append(0, np.cumsum(path.steps(points)))
    expected = CubicSpline(length, points)(np.linspace(0, length[-1], 301))
    assert np.abs(path.resample(points, 301) - expected).max() <= 1e-14


# -- a curve of your own --


@pytest.mark.parametrize(
    "text",
    [
        "0.5,0,0.5\n0.4,0.1,0.5\n",
        "x,y,z\n0.5, 0, 0.5\n\n0.4, 0.1, 0.5",
        "# made by hand\n0.5; 0; 0.5\n0.4; 0.1; 0.5\n",
        "0.5 0 5e-1\r\n0.4\t0.1 0.5\r\n",
    ],
)
def test_curves_are_read_from_text_and_from_files(text, tmp_path):
    expected = [[0.5, 0, 0.5], [0.4, 0.1, 0.5]]
    assert path.load_points(text).tolist() == expected
    file = tmp_path / "curve.csv"
    file.write_text(text, encoding="utf-8-sig")
    assert path.load_points(file).tolist() == expected
    assert path.load_points(str(file)).tolist() == expected


def test_a_curve_in_the_letter_plane_can_be_followed():
    letter = path.load_points("Y, Z\n-0.2, -0.2\n0, 0.1\n0.2, -0.2\n0.1, -0.3")
    points = path.resample(path.on_sphere(letter), 60)
    q = path.follow(ABB, path.frames(points))
    assert (path.points_reached(q) == 60).any()


@pytest.mark.parametrize(
    "text, message",
    [
        ("1,2,3\n1,2,three\n", r"line 2 of the curve \('1,2,three'\) must hold numbers only"),
        ("1,2,3\n1,2\n", r"line 2 of the curve \('1,2'\) must hold 3 numbers, as the lines above, got 2"),
        ("1,2,3,4\n1,2,3,4\n", r"line 1 of the curve \('1,2,3,4'\) must hold 2 or 3 numbers, got 4"),
        ("x,y,z\n1,2,3\n", "a curve needs at least 2 points, got 1"),
        ("\n\n", "a curve needs at least 2 points, got 0"),
        ("1,2,3\n\nx,y,z\n", r"line 3 of the curve \('x,y,z'\) must hold numbers only"),
        ("1,2,3\n1,2,nan\n", r"line 2 of the curve \('1,2,nan'\) must hold finite numbers"),
    ],
)
def test_unreadable_curves_name_the_line(text, message):
    with pytest.raises(ValueError, match=message):
        path.load_points(text)


# -- following it --


def test_tracing_goes_where_the_closed_form_goes(branches):
    T = path.frames(path.s_curve(101))
    start = branches[101][:, 0]
    q = path.trace(ABB, T, start + 0.05)
    assert np.abs(q - branches[101]).max() < 1e-8
    found = ik.search(ABB, T[0]).theta
    assert path.trace(ABB, T, found).shape == (8, 101, 6)
    assert np.abs(path.trace(ABB, T, start[3]) - q[3]).max() < 1e-8


def test_a_redundant_arm_comes_back_with_other_angles():
    """A circle of 0.1 m with the Panda: the tool is exact, the joints have drifted after a lap."""
    panda = robots.franka_panda()
    home = panda.fk(panda.home)
    T = np.tile(home, (200, 1, 1))
    turn = np.linspace(0, 2 * np.pi, 200)
    T[:, 1, 3] += 0.1 * np.sin(turn)
    T[:, 2, 3] += 0.1 * (1 - np.cos(turn))
    q = path.trace(panda, T, panda.home)
    assert np.abs(panda.fk(q) - T).max() < 1e-9
    assert np.abs(np.diff(q, axis=0)).max() < 0.05
    assert 0.01 < np.abs(q[-1] - q[0]).max() < 0.5


def test_a_path_of_one_pose_is_its_solutions():
    T = path.frames(path.s_curve(21))[:1]
    assert np.array_equal(path.follow(ABB, T)[:, 0], ik.analytic(ABB, T[0]).theta, equal_nan=True)


def test_tracing_ends_where_the_arm_does():
    T = path.frames(path.s_curve(21))
    T[11:, :3, 3] *= 3
    q = path.trace(ABB, T, path.follow(ABB, T[:1])[:, 0])
    assert path.points_reached(q).tolist() == [11] * 8


def test_golden_branches(branches, golden):
    data = golden("s_curve_arcs")
    expected, q = np.array(data["branches_every_5th_point"]), branches[101][:, ::5]
    inside = np.array(data["branch_within_limits_per_joint"])
    matched = set()
    for branch, joints in zip(expected, inside, strict=True):
        # Continuous branches may differ by whole turns of a joint, the same all along.
        offset = np.round((branch[0] - q[:, 0]) / (2 * np.pi)) * 2 * np.pi
        error = np.abs(q + offset[:, None] - branch).max(axis=(1, 2))
        found = int(error.argmin())
        assert error[found] <= EXACT
        matched.add(found)
        assert ABB.inside(branches[101][found]).all(axis=0).tolist() == joints.tolist()
    assert matched == set(range(8))


@pytest.mark.parametrize("n", [101, 201, 1001, 5001])
def test_branches_reach_every_pose_without_a_jump(branches, n):
    q, T = branches[n], path.frames(path.s_curve(n))
    assert q.shape == (8, n, 6)
    assert path.points_reached(q).tolist() == [n] * 8
    assert np.abs(ABB.fk(q) - T).max() <= 1e-12
    assert np.abs(np.diff(q, axis=1)).max() <= 12.3 / (n - 1)


def test_branches_begin_in_the_order_of_the_solutions(branches):
    from coursekit import ik

    first = ik.analytic(ABB, path.frames(path.s_curve())[0]).theta
    assert np.abs(branches[101][:, 0] - first).max() <= 1e-15


def test_angles_pass_half_a_turn_and_go_on():
    """The planar arm drives its tool one and a half times round the base: no step is large."""
    arm = robots.planar_2r()
    theta = np.stack([np.linspace(0.3, 0.3 + 3 * np.pi, 200), np.full(200, 1.0)], axis=-1)
    q = path.follow(arm, arm.fk(theta))
    assert q.shape == (2, 200, 2)
    error = np.abs(q - theta).max(axis=(1, 2))
    assert error.min() <= 1e-12
    assert np.abs(np.diff(q, axis=1)).max() <= 0.05


def test_a_branch_that_breaks_is_nan_from_there():
    arm = robots.planar_2r(0.5, 0.25)
    T = np.tile(np.eye(4), (40, 1, 1))
    T[:, 0, 3] = np.linspace(0.5, 1.0, 40)  # out of reach beyond 0.75 m
    T[:, 1, 3] = 0.02
    q = path.follow(arm, T)
    reached = path.points_reached(q)
    last = int(np.sum(np.hypot(T[:, 0, 3], T[:, 1, 3]) <= 0.75))
    assert reached.tolist() == [last, last]
    assert np.isnan(q[:, last:]).all()
    assert not np.isnan(q[:, :last]).any()
    limit = path.speed_limit(q, T[:, :3, 3], BOUND)
    assert np.isnan(limit.speed).all()
    assert limit.joint.tolist() == limit.index.tolist() == [-1, -1]
    assert np.isfinite(path.speed_limit(q[:, :last], T[:last, :3, 3], BOUND).speed).all()


def test_a_leap_to_another_place_breaks_the_branch():
    theta = np.array([[0.1, 1.0], [0.15, 1.0], [2.5, 1.0], [2.55, 1.0]])
    arm = robots.planar_2r()
    q = path.follow(arm, arm.fk(theta))
    assert path.points_reached(q).tolist() == [2, 2]


def test_nan_in_the_path_ends_the_branches_there():
    T = path.frames(path.s_curve(21))
    T[7] = np.nan
    assert path.points_reached(path.follow(ABB, T)).tolist() == [7] * 8


def test_solutions_are_paired_one_to_one():
    """Where two solutions want the same next one, the nearer gets it and the other takes what is left."""
    difference = np.abs(np.array([0.0, 0.2]) - np.array([[0.19], [0.5]])).T  # from (0, 0.2) to (0.19, 0.5)
    assert path._pair(difference[None, :, :, None]).tolist() == [[1, 0]]
    difference[0, 1] = 2.0  # nothing left within a quarter turn
    assert path._pair(difference[None, :, :, None]).tolist() == [[-1, 0]]


# -- how fast --


@pytest.mark.parametrize("n", [101, 201, 1001, 5001])
def test_golden_speeds(branches, golden, n):
    data, q, points = golden("s_curve_arcs")["by_N"][str(n)], branches[n], path.s_curve(n)
    limit = path.speed_limit(q, points, BOUND)
    # The golden figure divides the mean step by the largest turn, speed_limit each step by its own.
    assert limit.speed == pytest.approx(np.array(data["max_path_speed_per_branch"]), rel=1e-6)
    turn = np.abs(np.diff(q, axis=1)).max(axis=(1, 2))
    mean_step = path.steps(points).mean()
    assert BOUND * mean_step / turn == pytest.approx(np.array(data["max_path_speed_per_branch"]), rel=1e-9)
    assert turn == pytest.approx(np.array(data["max_abs_dq"]), abs=1e-12)
    assert (limit.joint + 1).tolist() == data["limiting_joint"]


@pytest.mark.parametrize("n", [101, 1001])
def test_golden_speed_of_each_joint_alone(branches, golden, n):
    expected = np.array(golden("s_curve_arcs")["by_N"][str(n)]["speed_limit_if_only_joint_j_counted"])
    points = path.s_curve(n)
    seen = []
    for joint in (0, 1, 2, 4, 5):  # joint 4 does not move at all
        limit = path.speed_limit(branches[n][..., joint : joint + 1], points, BOUND)
        seen.append(np.sort(limit.speed))
    assert pytest.approx(np.sort(expected[:, [0, 1, 2, 4, 5]], axis=0), rel=1e-10) == np.array(seen).T
    still = path.speed_limit(branches[n][..., 3:4], points, BOUND)
    assert (still.speed > 1e6).all()


@pytest.mark.parametrize("n", [101, 201, 1001, 5001])
def test_golden_spread_of_joint_3(branches, golden, n):
    data, q = golden("s_curve_arcs")["by_N"][str(n)], branches[n]
    assert q[..., 2].std(axis=1, ddof=1) == pytest.approx(np.array(data["std_q3"]), abs=1e-11)
    rates = path.joint_rates(q, path.s_curve(n), speed=data["max_path_speed_per_branch"][0])
    assert rates[..., 2].std(axis=1, ddof=1) == pytest.approx(np.array(data["std_qdot3"]), abs=2e-8)


def test_differences_of_wrapped_angles_look_like_very_slow_paths(branches, golden):
    """What went wrong in the project of 2021: seven of eight branches seemed to crawl."""
    data = golden("s_curve_arcs")["by_N"]["101"]
    wrapped = np.angle(np.exp(1j * branches[101]))
    wrong = np.sort(path.speed_limit(wrapped, path.s_curve(), BOUND).speed)
    expected = np.sort(data["speed_with_wrapped_differences"])
    # Angles of exactly half a turn fall to either side by rounding, so those jumps are not compared in full.
    assert wrong == pytest.approx(expected, rel=0.05)
    right = path.speed_limit(branches[101], path.s_curve(), BOUND).speed
    assert (wrong[:7] < 0.006).all()
    assert (right > 0.3).all()


def test_the_limit_is_reached_and_not_passed(branches):
    points = path.s_curve()
    for q in branches[101]:
        limit = path.speed_limit(q, points, ABB.v_max)
        used = np.abs(path.joint_rates(q, points, limit.speed)) / ABB.v_max
        assert used.max() == pytest.approx(1, abs=1e-12)
        assert used[limit.index, limit.joint] == used.max()


def test_a_bound_per_joint_moves_the_limit(branches):
    points, q = path.s_curve(), branches[101][0]
    everyone = path.speed_limit(q, points, np.full(6, BOUND))
    assert everyone.speed == path.speed_limit(q, points, BOUND).speed
    assert path.speed_limit(q, points, [0.01, *[BOUND] * 5]).joint == 0
    assert path.speed_limit(q, points, [np.inf] * 5 + [BOUND]).joint == 5
    assert np.isnan(path.speed_limit(q, points, [np.nan] * 6).speed)


def test_one_branch_gives_plain_numbers(branches):
    limit = path.speed_limit(branches[101][0], path.s_curve(), BOUND)
    assert np.shape(limit.speed) == np.shape(limit.joint) == np.shape(limit.index) == ()
    assert isinstance(int(limit.joint), int)
    assert f"{limit.speed:.3f}" == "0.300"
    with pytest.raises(AttributeError):
        limit.speed = 0


def test_where_nothing_moves_nothing_limits():
    limit = path.speed_limit(np.zeros((3, 2)), [[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1.0)
    assert (limit.speed, limit.joint, limit.index) == (np.inf, -1, -1)


def test_steps_of_different_length_count_with_their_own_length():
    points = [[0, 0, 0], [0.1, 0, 0], [1.1, 0, 0]]
    limit = path.speed_limit([[0.0], [0.2], [0.6]], points, 1.0)
    assert (limit.speed, limit.joint, limit.index) == (pytest.approx(0.5), 0, 0)
    rates = path.joint_rates([[0.0], [0.2], [0.6]], points, 0.5)
    assert rates == pytest.approx(np.array([[1.0], [0.2]]))


@given(st.floats(0.01, 100), st.floats(0.01, 100))
def test_speed_grows_with_the_bound_and_the_size_of_the_path(bound, scale):
    q, points = (
        np.array([[0, 1.0], [0.3, 0.8], [0.5, 1.1]]),
        np.array([[0, 0, 0], [0.2, 0, 0], [0.3, 0.1, 0]]),
    )
    unit = path.speed_limit(q, points, 1.0)
    scaled = path.speed_limit(q, scale * points, bound)
    assert scaled.speed == pytest.approx(unit.speed * bound * scale)
    assert (scaled.joint, scaled.index) == (unit.joint, unit.index)


# -- what is refused --


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: path.s_curve(1), "n must be at least 2 points, got 1"),
        (lambda: path.resample([[0, 0, 0], [0, 0, 0], [1, 0, 0]], 5), "points 0 and 1 coincide"),
        (lambda: path.resample([[0, 0, 0]], 5), r"points must be \(m, 3\), at least 2 rows, got \(1, 3\)"),
        (lambda: path.steps([1, 2, 3]), r"points must be \(m, 3\), at least 2 rows, got \(3,\)"),
        (lambda: path.frames([[0, 0, 0.5], [0, 0, 1]]), "point 0 lies at the centre"),
        (lambda: path.frames([[0.5, 0, 0.5], [0.6, 0, 0.5]]), "point 0 and the next one lie on one normal"),
        (lambda: path.frames([[0, 0], [1, 1]]), r"points must have shape \(\.\.\., 3\), got \(2, 2\)"),
        (lambda: path.frames(path.s_curve(5), [0, 0]), r"center must have shape \(\.\.\., 3\), got \(2,\)"),
        (lambda: path.on_sphere([[1, 2, 3]]), r"letter must have shape \(\.\.\., 2\), got \(1, 3\)"),
        (lambda: path.follow(ABB, np.eye(4)), r"ABB IRB 1200-5/0.9: the path T must be \(m, 4, 4\)"),
        (lambda: path.follow(ABB, np.eye(3)), r"ABB IRB 1200-5/0.9: the path T must have shape"),
        (lambda: path.follow(ABB, 2 * np.eye(4)[None]), r"ABB IRB 1200-5/0.9: the path T is not in SE\(3\)"),
        (lambda: path.follow(robots.franka_panda(), np.eye(4)[None]), "Franka"),
        (
            lambda: path.joint_rates(np.zeros((3, 6)), path.s_curve(5), 1.0),
            r"q must be \(\.\.\., m, n\) with m = 5",
        ),
        (lambda: path.speed_limit(np.zeros((5, 6)), path.s_curve(5), [1, 2]), "v_max must be one bound or 6"),
        (lambda: path.speed_limit(np.zeros((5, 6)), path.s_curve(5), 0), "v_max must be positive, got 0.0"),
    ],
)
def test_errors_say_what_was_expected(call, message):
    with pytest.raises(ValueError, match=message):
        call()


# -- one step along a branch


def test_step_by_step_every_branch_is_the_one_that_follow_finds(branches):
    solutions = ik.analytic(ABB, path.frames(path.s_curve(101))).theta
    for branch in branches[101]:
        way = [branch[0]]
        for rows in solutions[1:]:
            way.append(path.next_on_branch(way[-1], rows))
        np.testing.assert_allclose(way, branch, rtol=0, atol=1e-12)


def test_a_branch_goes_on_where_it_is_however_many_turns_away_and_past_what_does_not_exist():
    found = path.next_on_branch([3.1 + 6 * np.pi, 0], [[np.nan, np.nan], [-3.1, 0.1], [3.1, 1]])
    np.testing.assert_allclose(found, [6 * np.pi + 2 * np.pi - 3.1, 0.1], rtol=0, atol=1e-12)


@pytest.mark.parametrize("solutions", [[[np.nan, np.nan]], np.empty((0, 2)), [[0.0, 0, 0]]])
def test_a_branch_without_a_solution_says_so(solutions):
    with pytest.raises(ValueError, match="solutions must"):
        path.next_on_branch([0, 0], solutions)
