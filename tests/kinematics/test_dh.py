"""DH tables: both conventions, the screws they contain, and the common normal between two axes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coursekit import Robot, dh, lie, robots, rotations

SHAPES = [(), (1,), (3, 1, 2)]


def random_pose(rng):
    return lie.exp6(rng.uniform(-1, 1, 6))


def random_table(rng, n=None, convention="standard"):
    """An arm that nobody builds: any twist, any length, joints of both types, any base and tool."""
    n = n or rng.integers(1, 8)
    a, d = rng.uniform(-1, 1, (2, n))
    alpha, theta = rng.uniform(-np.pi, np.pi, (2, n))
    types = rng.choice(["revolute", "prismatic"], n)
    return dh.Table(a, alpha, d, theta, convention, tuple(types), random_pose(rng), random_pose(rng))


def turn(R):
    T = np.eye(4)
    T[:3, :3] = R
    return T


def shift(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


# -- the definition --


def test_link_transforms_are_the_products_of_the_definition():
    rng = np.random.default_rng(0)
    q = rng.uniform(-1, 1, 5)
    for convention in dh.CONVENTIONS:
        table = random_table(rng, 5, convention)
        A = table.link_transforms(q)
        for i in range(5):
            slides = table.joint_types[i] == "prismatic"
            theta, d = table.theta[i] + q[i] * (not slides), table.d[i] + q[i] * slides
            z = turn(rotations.rotz(theta)) @ shift(0, 0, d)
            x = shift(table.a[i], 0, 0) @ turn(rotations.rotx(table.alpha[i]))
            assert np.abs(A[i] - (z @ x if convention == "standard" else x @ z)).max() <= 2e-16


def test_the_matrices_of_the_textbooks():
    a, alpha, d, theta = 0.3, 0.7, 0.2, -0.4
    ca, sa, ct, st_ = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    standard = [
        [ct, -st_ * ca, st_ * sa, a * ct],
        [st_, ct * ca, -ct * sa, a * st_],
        [0, sa, ca, d],
        [0, 0, 0, 1],
    ]
    modified = [
        [ct, -st_, 0, a],
        [st_ * ca, ct * ca, -sa, -d * sa],
        [st_ * sa, ct * sa, ca, d * ca],
        [0, 0, 0, 1],
    ]
    for convention, expected in (("standard", standard), ("modified", modified)):
        A = dh.Table([a], [alpha], [d], [0], convention).link_transforms([theta])
        assert np.abs(A[0] - expected).max() <= 1e-16


@pytest.mark.parametrize("convention", dh.CONVENTIONS)
@pytest.mark.parametrize("shape", SHAPES)
def test_batches_are_their_members(convention, shape):
    rng = np.random.default_rng(1)
    table = random_table(rng, 4, convention)
    q = rng.uniform(-2, 2, (*shape, 4))
    T, A, frames = table.fk(q), table.link_transforms(q), table.frames(q)
    assert T.shape == (*shape, 4, 4)
    assert A.shape == frames.shape == (*shape, 4, 4, 4)
    assert np.abs(frames[..., -1, :, :] @ table.tool - T).max() <= 1e-15
    for index in np.ndindex(shape):
        assert np.array_equal(T[index], table.fk(q[index].tolist()))
        assert np.array_equal(A[index], table.link_transforms(q[index].tolist()))


# -- one arm, three ways to write it --


@pytest.mark.parametrize("draw", range(40))
def test_standard_modified_and_screws_are_the_same_arm(draw):
    rng = np.random.default_rng(draw)
    table = random_table(rng, convention=dh.CONVENTIONS[draw % 2])
    standard, modified = table.to_standard(), table.to_modified()
    assert (standard.convention, modified.convention) == ("standard", "modified")
    q = rng.uniform(-2, 2, (20, table.n))
    T = table.fk(q)
    tolerance = 2e-15 * (2 * table.n + 5)  # metres of reach, and that many products
    assert np.abs(standard.fk(q) - T).max() <= tolerance
    assert np.abs(modified.fk(q) - T).max() <= tolerance
    for form in (standard, modified):
        S, M = form.screws()
        product = M
        for i in reversed(range(table.n)):
            product = lie.exp6(S[:, i] * q[:, i : i + 1]) @ product
        assert np.abs(product - T).max() <= tolerance
        robot = Robot.from_dh(form)
        assert robot.joint_types == table.joint_types
        assert np.abs(robot.fk(q) - T).max() <= tolerance


@pytest.mark.parametrize("draw", range(5))
def test_there_and_back_is_the_same_table(draw):
    table = random_table(np.random.default_rng(draw), 6)
    back = table.to_modified().to_standard()
    q = np.random.default_rng(draw).uniform(-2, 2, (20, 6))
    # What the modified table must put into its tool comes back as part of the tool.
    assert np.array_equal(back.a[:-1], table.a[:-1])
    assert np.array_equal(back.alpha[:-1], table.alpha[:-1])
    assert np.abs(back.fk(q) - table.fk(q)).max() <= 2e-14


def test_a_table_of_the_right_convention_is_returned_as_it_is():
    table = random_table(np.random.default_rng(2))
    assert table.to_standard() is table
    assert table.to_modified().to_modified().convention == "modified"


def test_reading_a_standard_table_as_a_modified_one_is_another_arm():
    table = dh.Table([0.5, 0.25], [0.3, 0], [0, 0], [0, 0])
    misread = dh.Table(table.a, table.alpha, table.d, table.theta, "modified")
    assert np.abs(table.fk([0.4, 0.5]) - misread.fk([0.4, 0.5])).max() > 0.1


# -- the singularity of the DH parameters --


def line(w, q):
    """The unit screw of the line through q along w."""
    w = np.array(w) / np.linalg.norm(w)
    return np.concatenate([w, -np.cross(w, q)])


def test_nearly_parallel_axes_have_a_common_normal_far_away():
    """Axes 455 mm apart, one tilted by 1 mrad: they meet 455 m away, while the screw moves by 1e-3."""
    straight = line([0, 0, 1], [0.455, 0, 0])
    tilted = line([np.sin(1e-3), 0, np.cos(1e-3)], [0.455, 0, 0])
    a, alpha, foot_1, foot_2 = dh.common_normal(line([0, 0, 1], [0, 0, 0]), tilted)
    assert np.abs(tilted - straight).max() == pytest.approx(1e-3, rel=1e-6)
    assert a == pytest.approx(0, abs=1e-10)
    assert alpha == pytest.approx(1e-3, rel=1e-9)
    assert foot_1 == pytest.approx([0, 0, -0.455 / np.tan(1e-3)], abs=1e-6)
    assert abs(foot_1[2]) == pytest.approx(455, abs=0.001)
    assert foot_2 == pytest.approx(foot_1, abs=1e-9)


def test_parallel_axes_take_the_normal_nearest_the_origin():
    a, alpha, foot_1, foot_2 = dh.common_normal(line([0, 0, 1], [1, 0, 5]), line([0, 0, 1], [1, 2, -3]))
    assert (float(a), float(alpha)) == (2, 0)
    assert foot_1.tolist() == [1, 0, 0]
    assert foot_2.tolist() == [1, 2, 0]
    a, alpha, *_ = dh.common_normal(line([0, 0, 1], [0, 0, 0]), line([0, 0, -1], [0, 3, 0]))
    assert (float(a), float(alpha)) == (3, np.pi)


@given(st.integers(0, 2**32 - 1))
def test_the_common_normal_is_perpendicular_to_both_axes_and_shortest(draw):
    rng = np.random.default_rng(draw)
    q_1, q_2 = rng.uniform(-1, 1, (2, 3))
    S_1, S_2 = line(rng.normal(size=3), q_1), line(rng.normal(size=3), q_2)
    a, alpha, foot_1, foot_2 = dh.common_normal(S_1, S_2)
    sine = np.sin(alpha)
    slack = 1e-13 / sine**2
    assert abs((foot_2 - foot_1) @ S_1[:3]) <= slack
    assert abs((foot_2 - foot_1) @ S_2[:3]) <= slack
    for S, foot in ((S_1, foot_1), (S_2, foot_2)):
        assert np.abs(np.cross(foot, S[:3]) - S[3:]).max() <= slack  # the foot lies on its axis
    assert np.cos(alpha) == pytest.approx(S_1[:3] @ S_2[:3], abs=1e-12)
    reciprocal = S_1[:3] @ S_2[3:] + S_1[3:] @ S_2[:3]  # = -+ a sin alpha
    assert abs(reciprocal) == pytest.approx(a * sine, abs=10 * slack)


# -- the table from the axes --


def exact_axes(rng, n):
    """Axes as drawings have them: along x, y or z, points on a coarse grid, so that every case occurs."""
    signs = rng.choice([-1.0, 1.0], (n, 1))
    return np.eye(3)[rng.integers(0, 3, n)] * signs, rng.integers(-2, 3, (n, 3)) / 4


def pose_on_the_grid(rng):
    T = np.eye(4)
    T[:3, :3] = rotations.rotz(np.pi / 2 * rng.integers(4)) @ rotations.rotx(np.pi / 2 * rng.integers(4))
    T[:3, 3] = rng.integers(-2, 3, 3) / 4
    return T


@pytest.mark.parametrize("convention", dh.CONVENTIONS)
@pytest.mark.parametrize("draw", range(60))
def test_a_table_from_axes_is_the_same_arm(draw, convention):
    rng = np.random.default_rng(draw)
    n = int(rng.integers(1, 8))
    if draw % 3:
        (w, q), M = exact_axes(rng, n), pose_on_the_grid(rng)
    else:
        w, q, M = rng.normal(size=(n, 3)), rng.uniform(-1, 1, (n, 3)), random_pose(rng)
    types = rng.choice(["revolute", "prismatic"], n)
    table = dh.from_axes(w, q, M, types, convention)
    assert (table.convention, table.joint_types) == (convention, tuple(types))
    robot = Robot.from_axes(w, q, M, types)
    S, home = table.screws()
    slack = 1e-14 if draw % 3 else 1e-12  # random axes may be nearly parallel
    assert np.abs(S - robot.S).max() < slack and np.abs(home - M).max() < slack
    theta = rng.uniform(-2, 2, (20, n))
    assert np.abs(table.fk(theta) - robot.fk(theta)).max() < 10 * slack


@pytest.mark.parametrize("draw", range(40))
def test_the_steps_are_rows_with_their_reasons(draw):
    rng = np.random.default_rng(draw)
    (w, q), M = exact_axes(rng, 6), pose_on_the_grid(rng)
    steps, table = dh.steps(w, q, M), dh.from_axes(w, q, M)
    for key in ("a", "alpha", "d", "theta"):
        assert [getattr(step, key) for step in steps] == getattr(table, key).tolist()
    frames = np.concatenate([[table.base], table.frames(np.zeros(6))])
    lines = [*zip(w, q, strict=True), (M[:3, 2], M[:3, 3])]
    for i, step in enumerate(steps):
        (z, p), (z_next, p_next) = lines[i], lines[i + 1]
        for foot, direction, point in ((step.foot_1, z, p), (step.foot_2, z_next, p_next)):
            assert np.abs(np.cross(foot - point, direction)).max() < 1e-14  # each foot is on its line
        assert np.abs(frames[i + 1, :3, 3] - step.foot_2).max() < 1e-14
        assert np.abs(frames[i + 1, :3, 0] - step.x).max() < 1e-14
        assert abs(step.x @ z) < 1e-14 and abs(step.x @ z_next) < 1e-14
        along, across = np.abs(z @ z_next) == 1, np.linalg.norm(step.foot_2 - step.foot_1)
        assert (
            step.case
            == {
                (True, True): "parallel",
                (True, False): "same line",
                (False, True): "skew",
                (False, False): "meeting",
            }[along, bool(across > 1e-9)]
        )
        assert (step.free == "") == (step.case == "skew")


def test_the_table_of_the_kr6_comes_out_of_its_axes():
    """Lengths and twists of the published table up to signs that the procedure leaves free."""
    kr6 = robots.kuka_kr6()
    table = dh.from_axes(kr6.S[:3].T, kr6.places, kr6.M)
    assert np.abs(np.abs(table.a) - np.abs(kr6.standard_dh.a)).max() < 1e-15
    assert np.abs(np.abs(table.alpha)[:5] - np.abs(kr6.standard_dh.alpha)[:5]).max() < 1e-15
    assert np.abs(np.abs(table.d)[1:5] - np.abs(kr6.standard_dh.d)[1:5]).max() < 1e-15


@pytest.mark.parametrize(
    "call, message",
    [
        (
            lambda: dh.from_axes([[0, 0, 0]], [[0, 0, 0]], np.eye(4)),
            "dh.from_axes: the axis of joint 1 has dir",
        ),
        (lambda: dh.from_axes([[0, 0, 1]], [[0, 0]], np.eye(4)), r"dh.from_axes: q must have shape"),
        (lambda: dh.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(3)), "dh.from_axes: M must have shape"),
        (
            lambda: dh.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4), "RR"),
            "joint_types must name 1 joints, got 2",
        ),
        (
            lambda: dh.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4), "R", "craig"),
            "convention must be one of",
        ),
        (lambda: dh.steps([[0, 0, 1]], [[0, 0]], np.eye(4)), "dh.steps: q must have shape"),
    ],
)
def test_axes_that_make_no_table(call, message):
    with pytest.raises(ValueError, match=message):
        call()


# -- what is refused --


@pytest.mark.parametrize(
    "fields, message",
    [
        ({"a": [1.0], "alpha": [0.0], "d": [0.0]}, "missing: theta"),
        ({}, "missing: a, alpha, d, theta"),
        (
            {"a": [1, 2], "alpha": [0], "d": [0], "theta": [0]},
            r"one number per joint each; got shapes .*'a': \(2,\)",
        ),
        ({"a": [], "alpha": [], "d": [], "theta": []}, "one number per joint"),
        ({"a": 1, "alpha": 0, "d": 0, "theta": 0}, "one number per joint"),
        ({"convention": "craig"}, r"convention must be one of \('standard', 'modified'\), got 'craig'"),
        ({"joint_types": ["revolute", "helical"]}, "joint_types must be .* got 'helical'"),
        ({"joint_types": "R"}, "joint_types must name 2 joints, got 1"),
        ({"base": 2 * np.eye(4)}, r"base is not in SE\(3\): R'R differs from the identity by 3"),
        ({"tool": np.diag([1, 1, -1, 1])}, r"tool is not in SE\(3\): det R = -1"),
        ({"tool": np.eye(3)}, r"tool must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
    ],
)
def test_bad_tables_say_what_is_wrong(fields, message):
    whole = {"a": [1, 2], "alpha": [0, 0], "d": [0, 0], "theta": [0, 0]}
    with pytest.raises(ValueError, match=message):
        dh.Table(**(fields if "a" in fields or not fields else whole | fields))


def test_the_wrong_number_of_joints_names_the_table():
    table = dh.Table([0.5, 0.25], [0, 0], [0, 0], [0, 0])
    with pytest.raises(
        ValueError, match=r"the standard DH table has 2 joints: theta must have shape \(\.\.\., 2\)"
    ):
        table.fk([0, 0, 0])
    with pytest.raises(ValueError, match="the modified DH table has 2 joints"):
        table.to_modified().link_transforms(0.5)


def test_a_screw_with_no_unit_direction_has_no_common_normal():
    z = line([0, 0, 1], [0, 0, 0])
    with pytest.raises(ValueError, match=r"S_2 must be a revolute screw: \|omega\| must be 1, got 0"):
        dh.common_normal(z, [0, 0, 0, 1, 0, 0])
    with pytest.raises(ValueError, match=r"S_1 must have shape \(\.\.\., 6\), got \(4,\)"):
        dh.common_normal([0, 0, 1, 0], z)


def test_axes_of_a_urdf_that_are_nearly_parallel_have_an_exact_table_and_it_is_said_how_far_away():
    """1.5708 for a quarter turn: 3.7e-6 rad off, so two parallel axes 0.1 m apart get a frame 27 km away."""
    z, tilted = np.array([0, 0, 1.0]), rotations.rotx(2 * 1.5708 - np.pi) @ [0, 0, 1.0]
    w, q, M = [z, tilted], [[0, 0, 0], [0.1, 0.2, 0.3]], np.eye(4)
    first, _ = dh.steps(w, q, M)
    assert first.case == "nearly parallel"
    assert first.free.startswith("nothing: 7.3e-06 rad from parallel, the common normal is ")
    assert abs(first.d) > 1e3 and f"{abs(first.d):.3g} m away" in first.free
    robot = Robot.from_axes(w, q, M)
    theta = [0.4, -1.1]
    np.testing.assert_allclose(robot.standard_dh.fk(theta), robot.fk(theta), rtol=0, atol=1e-9)
    np.testing.assert_allclose(robot.link_frames([0, 0])[0, :3, 3], q[0], atol=1e-12)


def test_tables_cannot_be_changed():
    table = dh.Table([0.5, 0.25], [0, 0], [0, 0], [0, 0])
    with pytest.raises(ValueError, match="read-only"):
        table.a[0] = 1
    with pytest.raises(AttributeError):
        table.a = np.zeros(2)
    for array in (table.alpha, table.d, table.theta, table.base, table.tool):
        assert not array.flags.writeable


def test_a_table_does_not_share_memory_with_what_it_was_made_from():
    a = np.array([0.5, 0.25])
    table = dh.Table(a, [0, 0], [0, 0], [0, 0])
    a[0] = 9
    assert table.a[0] == 0.5


def test_nan_in_nan_out():
    table = random_table(np.random.default_rng(3), 3)
    T = table.fk([[0.1, 0.2, 0.3], [0.1, np.nan, 0.3]])
    assert not np.isnan(T[0]).any()
    assert np.isnan(T[1, :3]).any()


def test_joint_types_are_read_from_words_and_letters():
    assert dh.joint_types(None, 2) == ("revolute", "revolute")
    assert dh.joint_types("RpR", 3) == ("revolute", "prismatic", "revolute")
    assert dh.joint_types(["Prismatic", "r"], 2) == ("prismatic", "revolute")
