"""Robot: forward kinematics, link frames, Jacobians and limits of any open chain, not of one catalogue."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coursekit import Robot, dh, lie, robots
from coursekit.kinematics.robot import CHUNK

SHAPES = [(), (1,), (3, 1, 2)]


def random_robot(rng, n=None, helical=False, **more):
    """Any chain: axes in any direction, both joint types, with `helical` also screws that climb."""
    n = n or int(rng.integers(1, 9))
    w, q = rng.normal(size=(n, 3)), rng.uniform(-1, 1, (n, 3))
    types = rng.choice(["revolute", "prismatic"], n)
    robot = Robot.from_axes(w, q, lie.exp6(rng.uniform(-1, 1, 6)), types, **more)
    if not helical:
        return robot
    pitch = np.where(types == "revolute", rng.uniform(-0.2, 0.2, n), 0)
    S = robot.S + np.concatenate([np.zeros((3, n)), pitch * robot.S[:3]])
    return Robot.from_screws(S, robot.M)


def product_of_exponentials(robot, theta):
    """Eq. 4.14, joint by joint."""
    T = robot.M
    for i in reversed(range(robot.n)):
        T = lie.exp6(robot.S[:, i] * theta[i]) @ T
    return T


# -- forward kinematics --


@pytest.mark.parametrize("helical", [False, True])
@pytest.mark.parametrize("draw", range(15))
def test_fk_is_the_product_of_exponentials(draw, helical):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng, helical=helical)
    theta = rng.uniform(-3, 3, (20, robot.n))
    T = robot.fk(theta)
    for i in range(20):
        assert np.abs(T[i] - product_of_exponentials(robot, theta[i])).max() <= 1e-14 * (3 + 3 * robot.n)


@pytest.mark.parametrize("draw", range(5))
def test_body_screws_give_the_same_pose(draw):
    """T = M e^[B_1]theta_1 ... e^[B_n]theta_n (eq. 4.16)."""
    rng = np.random.default_rng(draw)
    robot = random_robot(rng, helical=True)
    theta = rng.uniform(-3, 3, robot.n)
    T = robot.M
    for i in range(robot.n):
        T = T @ lie.exp6(robot.B[:, i] * theta[i])
    assert np.abs(T - robot.fk(theta)).max() <= 1e-13


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "method, trailing",
    [
        ("fk", (4, 4)),
        ("displacements", (5, 4, 4)),
        ("link_frames", (5, 4, 4)),
        ("jacobian_space", (6, 5)),
        ("jacobian_body", (6, 5)),
        ("jacobian_geometric", (6, 5)),
        ("within_limits", ()),
        ("inside", (5,)),
        ("nearest_turn", (5,)),
    ],
)
def test_a_batch_is_its_members(method, trailing, shape):
    rng = np.random.default_rng(0)
    function = getattr(random_robot(rng, 5, q_min=[-1] * 5, q_max=[1] * 5), method)
    theta = rng.uniform(-3, 3, (*shape, 5))
    batch = function(theta)
    assert batch.shape == (*shape, *trailing)
    for index in np.ndindex(shape):
        one = function(theta[index].tolist())
        assert np.shape(one) == trailing
        assert np.abs(np.asarray(one, float) - batch[index]).max() <= 1e-14
    assert function(np.zeros((0, 5))).shape == (0, *trailing)


@pytest.mark.parametrize("size", [CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK + 3])
def test_large_batches_are_worked_in_blocks_without_a_seam(size):
    rng = np.random.default_rng(1)
    robot = random_robot(rng, 3)
    theta = rng.uniform(-3, 3, (size, 3))
    T, D, J = robot.fk(theta), robot.displacements(theta), robot.jacobian_body(theta)
    for i in {0, CHUNK - 2, CHUNK - 1, CHUNK, size - 1} & set(range(size)):
        assert np.abs(T[i] - robot.fk(theta[i])).max() <= 1e-15
        assert np.abs(D[i] - robot.displacements(theta[i])).max() <= 1e-15
        assert np.abs(J[i] - robot.jacobian_body(theta[i])).max() <= 1e-14


# -- link frames --


@pytest.mark.parametrize("draw", range(10))
def test_link_frames_ride_on_their_links(draw):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng)
    theta = rng.uniform(-3, 3, (4, robot.n))
    frames, D = robot.link_frames(theta), robot.displacements(theta)
    at_zero = robot.link_frames(np.zeros(robot.n))
    assert np.abs(frames[:, -1] - D[:, -1] @ robot.M).max() <= 1e-14
    assert np.abs(frames[:, -1] - robot.fk(theta)).max() <= 1e-14
    assert np.abs(frames - D @ at_zero).max() <= 1e-14
    for i in range(robot.n - 1):  # the last frame is the tool's
        axis = (lie.adjoint(D[:, i]) @ robot.S[:, i, None])[..., 0]
        local = np.array([0, 0, 1.0, 0, 0, 0] if robot.joint_types[i] == "revolute" else [0, 0, 0, 0, 0, 1.0])
        assert np.abs(lie.adjoint(frames[:, i]) @ local - axis).max() <= 1e-13


def test_a_joint_moves_its_own_link_and_those_behind_it():
    robot = random_robot(np.random.default_rng(2), 6)
    still = robot.link_frames(np.zeros(6))
    for i in range(6):
        moved = robot.link_frames(np.where(np.arange(6) == i, 0.7, 0.0))
        changed = np.abs(moved - still).max(axis=(1, 2)) > 1e-9
        assert changed.tolist() == [False] * i + [True] * (6 - i)


@pytest.mark.parametrize("draw", range(5))
def test_link_frames_of_a_modified_table_are_its_frames(draw):
    rng = np.random.default_rng(draw)
    a, alpha, d, theta = rng.uniform(-1, 1, (4, 5))
    table = dh.Table(a, alpha, d, theta, "modified", tool=lie.exp6(rng.uniform(-1, 1, 6)))
    q = rng.uniform(-2, 2, (3, 5))
    frames = Robot.from_dh(table).link_frames(q)
    assert np.abs(frames[:, :-1] - table.frames(q)[:, :-1]).max() <= 1e-14
    assert np.abs(frames[:, -1] - table.fk(q)).max() <= 1e-14


# -- where joints stand --

SCARA = {
    "w": [[0, 0, 1]] * 4,
    "q": [[0, 0, 0.4], [0.325, 0, 0.4], [0.6, 0, 0.4], [0.6, 0, 0.2]],
    "M": [[1, 0, 0, 0.6], [0, -1, 0, 0], [0, 0, -1, 0.2], [0, 0, 0, 1]],
    "joint_types": "RRPR",
}


def test_axes_keep_the_places_where_they_were_put():
    robot = Robot.from_axes(**SCARA)
    assert robot.places.tolist() == SCARA["q"]
    assert robot.link_frames(np.zeros(4))[:3, :3, 3].tolist() == SCARA["q"][:3]  # link 4 carries the tool
    T = lie.exp6([0.3, -0.2, 0.5, 0.1, 0.2, 0.3])
    moved = robot.with_base(T).places - (robot.places @ T[:3, :3].T + T[:3, 3])
    assert np.abs(moved).max() < 1e-15
    assert robot.with_tool(T).places.tolist() == SCARA["q"]


def test_screws_have_no_places_but_the_nearest():
    robot = Robot.from_axes(**SCARA)
    bare = Robot.from_screws(robot.S, robot.M)
    assert bare.places.tolist() == [[0, 0, 0], [0.325, 0, 0], [0.325, 0, 0], [0.6, 0, 0]]
    placed = Robot.from_screws(robot.S, robot.M, places=SCARA["q"])
    theta = np.random.default_rng(0).uniform(-2, 2, (9, 4))
    for other in (bare, placed):
        assert np.abs(other.fk(theta) - robot.fk(theta)).max() < 1e-15
    assert np.abs(placed.link_frames(theta) - robot.link_frames(theta)).max() < 1e-15


def test_a_place_beside_its_axis_is_refused():
    with pytest.raises(ValueError, match=r"Nemo: place 2 is 0\.1 m beside its axis"):
        Robot.from_axes(**SCARA, places=[*SCARA["q"][:1], [0.325, 0.1, 0.7], *SCARA["q"][2:]], name="Nemo")
    slid = Robot.from_axes(**SCARA, places=[*SCARA["q"][:2], [0.6, 0.1, 0.7], SCARA["q"][3]])
    assert slid.places[2].tolist() == [0.6, 0.1, 0.7]  # a slide stands anywhere


def test_a_table_says_where_its_joints_stand():
    table = dh.Table([0.325, 0.275, 0, 0], [0, np.pi, 0, 0], [0.4, 0, 0.1, 0], [0] * 4, joint_types="RRPR")
    robot = Robot.from_dh(table)
    assert np.abs(robot.places - table.to_modified().frames(np.zeros(4))[:, :3, 3]).max() < 1e-15


@pytest.mark.parametrize("draw", range(20))
def test_every_arm_has_both_tables(draw):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng)
    theta = rng.uniform(-2, 2, (5, robot.n))
    for table, convention in ((robot.standard_dh, "standard"), (robot.modified_dh, "modified")):
        assert table.convention == convention
        assert np.abs(table.fk(theta) - robot.fk(theta)).max() < 1e-11  # axes may be nearly parallel
    assert random_robot(rng, 4, helical=True).standard_dh is None or "prismatic" in robot.joint_types


@pytest.mark.parametrize(
    "change, message",
    [
        # where a slide stands, S does not say: the fault shows at the next hinge
        ({"a": [0.325, 0.3, 0, 0]}, r"after row 3 of the standard DH table axis 4 is 0 rad and 0\.025 m off"),
        ({"alpha": [0, 0, 0, 0]}, "after row 2 of the standard DH table axis 3 is 2 rad and 0 m off"),
        ({"d": [0.4, 0, 0.3, 0]}, r"after row 4 of the standard DH table the tool is 0 rad and 0\.1 m off"),
        ({"joint_types": "RRRR"}, "after row 2 of the standard DH table axis 3 is 1 rad and"),
        (
            {"convention": "modified"},
            r"after row 1 of the modified DH table axis 1 is 0 rad and 0\.325 m off",
        ),
        (
            {"base": lie.exp6([0, 0, 0, 1, 0, 0])},
            "after the base of the DH table axis 1 is 0 rad and 1 m off",
        ),
    ],
)
def test_a_table_of_another_arm_is_refused(change, message):
    columns = {"a": [0.325, 0.275, 0, 0], "alpha": [0, np.pi, 0, 0], "d": [0.4, 0, 0.2, 0], "theta": [0] * 4}
    columns["joint_types"] = "RRPR"
    robot = Robot.from_dh(dh.Table(**columns))
    with pytest.raises(ValueError, match=f"Nemo: {message}"):
        Robot.from_screws(robot.S, robot.M, name="Nemo", standard_dh=dh.Table(**{**columns, **change}))


def test_a_table_of_other_length_is_refused():
    table = dh.Table([0.5], [0], [0], [0])
    with pytest.raises(ValueError, match="Nemo: the standard DH table has 1 rows for 4 joints"):
        Robot.from_axes(**SCARA, name="Nemo", standard_dh=table)


# -- Jacobians --


@pytest.mark.parametrize("draw", range(15))
def test_jacobians_belong_together(draw):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng, helical=draw % 2 == 1)
    theta = rng.uniform(-3, 3, (10, robot.n))
    T, J_s, J_b, J = (
        f(theta) for f in (robot.fk, robot.jacobian_space, robot.jacobian_body, robot.jacobian_geometric)
    )
    assert np.abs(J_b - lie.adjoint(lie.inverse(T)) @ J_s).max() <= 1e-12
    assert np.abs(J_s - lie.adjoint(T) @ J_b).max() <= 1e-12
    R = T[:, :3, :3]
    assert np.abs(J[:, :3] - R @ J_b[:, :3]).max() <= 1e-12
    assert np.abs(J[:, 3:] - R @ J_b[:, 3:]).max() <= 1e-12


def test_at_zero_the_jacobians_are_the_screws():
    for draw in range(5):
        robot = random_robot(np.random.default_rng(draw), helical=True)
        zero = np.zeros(robot.n)
        assert np.abs(robot.jacobian_space(zero) - robot.S).max() <= 1e-14
        assert np.abs(robot.jacobian_body(zero) - robot.B).max() <= 1e-14


@pytest.mark.parametrize("draw", range(5))
def test_jacobians_are_the_derivative_of_fk(draw):
    rng = np.random.default_rng(draw)
    robot = random_robot(rng, helical=True)
    theta, h = rng.uniform(-2, 2, robot.n), 1e-5
    steps = h * np.eye(robot.n)
    ahead, behind, T = robot.fk(theta + steps), robot.fk(theta - steps), robot.fk(theta)
    J_b = lie.log6(lie.inverse(T) @ ahead) - lie.log6(lie.inverse(T) @ behind)
    assert np.abs(J_b.T / (2 * h) - robot.jacobian_body(theta)).max() <= 2e-9
    velocity = (ahead - behind)[:, :3, 3].T / (2 * h)
    assert np.abs(velocity - robot.jacobian_geometric(theta)[3:]).max() <= 2e-9


# -- tool and base --


@pytest.mark.parametrize("draw", range(10))
def test_another_tool_and_another_base(draw):
    rng = np.random.default_rng(draw)
    if draw % 2:
        robot = random_robot(rng)
    else:
        a, alpha, d, theta = rng.uniform(-1, 1, (4, 4))
        robot = Robot.from_dh(dh.Table(a, alpha, d, theta, joint_types="RPRR"))
    X = lie.exp6(rng.uniform(-1, 1, 6))
    theta = rng.uniform(-3, 3, (5, robot.n))
    tooled, moved = robot.with_tool(X), robot.with_base(X)
    assert np.abs(tooled.fk(theta) - robot.fk(theta) @ X).max() <= 1e-13
    assert np.abs(moved.fk(theta) - X @ robot.fk(theta)).max() <= 1e-13
    assert np.array_equal(tooled.S, robot.S)
    assert np.abs(moved.B - robot.B).max() <= 1e-13
    if robot.modified_dh is not None:  # the frames stay on their links
        assert np.abs(tooled.link_frames(theta) - robot.link_frames(theta))[:, :-1].max() <= 1e-13
        assert np.abs(moved.link_frames(theta) - X @ robot.link_frames(theta))[:, :-1].max() <= 1e-13
    for changed in (tooled, moved):
        assert changed.name == robot.name
        for table in (changed.standard_dh, changed.modified_dh):
            if table is not None:
                assert np.abs(table.fk(theta) - changed.fk(theta)).max() <= 1e-13


# -- limits --


def one_joint(kind="revolute", low=-0.5, high=2.5):
    return Robot.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4), [kind], q_min=[low], q_max=[high])


def test_limits_are_tried_a_whole_turn_further():
    robot, turn = one_joint(), 2 * np.pi
    assert robot.within_limits([[1.0], [1.0 + turn], [1.0 - turn], [1.0 + 3 * turn]]).all()
    assert not robot.within_limits([[3.0], [3.0 - turn], [-0.6], [-0.6 + turn]]).any()
    assert robot.within_limits([[-0.5], [2.5]]).all()
    assert robot.nearest_turn([1.0 - turn])[0] == pytest.approx(1.0)
    assert robot.nearest_turn([3.0 - turn])[0] == 3.0 - turn  # nothing fits: the angle stays


def test_a_sliding_joint_does_not_turn():
    robot = one_joint("prismatic", low=-0.5, high=8.0)
    assert robot.within_limits([8.0])
    assert not robot.within_limits([8.0 + 2 * np.pi])
    assert not robot.within_limits([-0.5 - 2 * np.pi])


def test_limits_wider_than_a_turn_keep_the_angle():
    robot = one_joint(low=-6.2, high=6.2)
    assert robot.nearest_turn([5.0])[0] == 5.0
    assert robot.nearest_turn([7.0])[0] == pytest.approx(7.0 - 2 * np.pi)


def test_a_limit_is_kept_to_a_nanoradian():
    robot = one_joint()
    assert robot.within_limits([[-0.5 - 9e-10], [2.5 + 9e-10], [2.5 + 9e-10 - 2 * np.pi]]).all()
    assert not robot.within_limits([[-0.5 - 2e-9], [2.5 + 2e-9]]).any()
    assert robot.nearest_turn([2.5 + 9e-10])[0] == 2.5 + 9e-10  # told as it is, not moved to the limit


def test_nan_is_outside_and_no_limits_are_no_limits():
    assert not one_joint().within_limits([np.nan])
    free = Robot.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4))
    assert free.within_limits([[1e6], [-1e6]]).all()
    assert (free.q_min[0], free.q_max[0]) == (-np.inf, np.inf)
    assert np.isnan(free.v_max).all()


@given(st.floats(-50, 50), st.floats(-6, 0), st.floats(0, 6))
def test_within_limits_means_that_some_whole_turn_fits(theta, low, high):
    shifted = theta + 2 * np.pi * np.arange(-10, 11)
    if np.min(np.abs(np.concatenate([shifted - low, shifted - high]))) < 1e-9:
        return  # on the edge rounding decides
    expected = bool(np.any((low <= shifted) & (shifted <= high)))
    assert bool(one_joint(low=low, high=high).within_limits([theta])) == expected


# -- how it is made, and what is refused --


def test_axes_are_scaled_and_become_screws():
    robot = Robot.from_axes([[0, 0, 2], [3, 0, 4]], [[1, 0, 0], [0, 7, 0]], np.eye(4), "RP")
    assert robot.S[:, 0].tolist() == [0, 0, 1, 0, -1, 0]
    assert robot.S[:, 1].tolist() == [0, 0, 0, 0.6, 0, 0.8]
    assert robot.joint_types == ("revolute", "prismatic")
    assert not np.signbit(robot.S).any() or robot.S[4, 0] == -1


def test_joint_types_are_read_off_the_screws():
    S = np.array([[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]]).T
    assert Robot.from_screws(S, np.eye(4)).joint_types == ("revolute", "prismatic")
    assert Robot.from_screws(S, np.eye(4), joint_types="RP").joint_types == ("revolute", "prismatic")


Z, EYE = [[0, 0, 1]], np.eye(4)
S_Z = np.array([[0, 0, 1, 0, 0, 0]]).T


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: Robot.from_axes([[0, 0, 0]], [[0, 0, 0]], EYE), "the axis of joint 1 has direction zero"),
        (
            lambda: Robot.from_axes([*Z, [0, 0, 0]], np.zeros((2, 3)), EYE),
            "the axis of joint 2 has direction zero",
        ),
        (lambda: Robot.from_axes(Z, [[0, 0]], EYE), r"q must have shape \(\.\.\., 3\), got \(1, 2\)"),
        (
            lambda: Robot.from_axes(Z, np.zeros((2, 3)), EYE),
            r"w and q must both be \(n, 3\), one row per joint",
        ),
        (lambda: Robot.from_axes(Z, [[0, 0, 0]], EYE, "RR"), "joint_types must name 1 joints, got 2"),
        (lambda: Robot.from_axes(Z, [[0, 0, 0]], EYE, ["X"]), "joint_types must be 'revolute' .* got 'X'"),
        (
            lambda: Robot.from_screws(0 * S_Z, EYE),
            r"screw 1 has direction zero: \(omega; v\) = 0 moves nothing",
        ),
        (lambda: Robot.from_screws(2 * S_Z, EYE), r"screw 1 must have \|omega\| = 1, got 2"),
        (
            lambda: Robot.from_screws([[0], [0], [0], [0], [0.5], [0]], EYE),
            r"screw 1 must have \|v\| = 1, got 0.5",
        ),
        (lambda: Robot.from_screws(S_Z.T, EYE), r"S must be \(6, n\), one screw .* per column, got \(1, 6\)"),
        (lambda: Robot.from_screws(np.zeros((6, 0)), EYE), r"S must be \(6, n\)"),
        (lambda: Robot.from_screws(S_Z, EYE, joint_types="P"), "joint_types say .* but the screws in S are"),
        (lambda: Robot.from_screws(S_Z, np.eye(3)), r"M must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        (lambda: Robot.from_screws(S_Z, 2 * EYE), r"M is not in SE\(3\): R'R differs from the identity"),
        (lambda: Robot.from_screws(S_Z, np.diag([1, 1, -1, 1])), r"M is not in SE\(3\): det R = -1"),
        (
            lambda: Robot.from_screws(S_Z, EYE + np.eye(4, k=-3)),
            r"M is not in SE\(3\): its last row must be 0 0 0 1",
        ),
        (
            lambda: Robot.from_screws(S_Z, EYE, q_min=[0, 0]),
            r"q_min must have shape \(\.\.\., 1\), got \(2,\)",
        ),
        (lambda: Robot.from_screws(S_Z, EYE, home=0), "home must have shape"),
        (
            lambda: Robot.from_screws(S_Z, EYE, q_min=[1], q_max=[-1]),
            "q_min must not exceed q_max; joint 1 has 1 and -1",
        ),
        (lambda: Robot.from_dh([[0, 0, 0, 0]]), "from_dh needs a dh.Table, got list"),
        (lambda: Robot.from_screws(S_Z, EYE).with_tool(np.eye(3)), "the tool must have shape"),
        (lambda: Robot.from_screws(S_Z, EYE).with_base(2 * EYE), r"the base is not in SE\(3\)"),
    ],
)
def test_errors_say_what_was_expected(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_errors_name_the_robot():
    with pytest.raises(ValueError, match=r"^Nemo: screw 1 has direction zero"):
        Robot.from_screws(0 * S_Z, EYE, name="Nemo")
    with pytest.raises(ValueError, match=r"^Nemo: the axis of joint 1"):
        Robot.from_axes([[0, 0, 0]], [[0, 0, 0]], EYE, name="Nemo")
    with pytest.raises(ValueError, match=r"^Nemo: from_dh needs"):
        Robot.from_dh(None, name="Nemo")


@pytest.mark.parametrize(
    "method",
    [
        "fk",
        "displacements",
        "link_frames",
        "jacobian_space",
        "jacobian_body",
        "jacobian_geometric",
        "within_limits",
        "inside",
        "nearest_turn",
    ],
)
def test_the_wrong_number_of_joints_names_the_robot(method):
    function = getattr(robots.kuka_kr6(), method)
    with pytest.raises(
        ValueError, match=r"KUKA KR6 R900 sixx has 6 joints: theta must have .*6\), got \(5,\)"
    ):
        function(np.zeros(5))
    with pytest.raises(ValueError, match=r"got \(\)"):
        function(0.3)
    with pytest.raises(ValueError, match=r"KUKA KR6 R900 sixx: theta must be 6 numbers"):
        function(["a"] * 6)


@pytest.mark.parametrize(
    "method", ["fk", "displacements", "jacobian_space", "jacobian_body", "jacobian_geometric"]
)
def test_nan_in_nan_out(method):
    function = getattr(random_robot(np.random.default_rng(3), 4), method)
    theta = np.zeros((3, 4))
    theta[1, 0] = np.nan
    result = function(theta)
    assert np.isnan(result[1]).any()
    assert np.array_equal(result[[0, 2]], function(theta[[0, 2]]))


# -- nothing changes --


def test_a_robot_is_frozen_and_its_arrays_are_read_only():
    robot = robots.kuka_kr6()
    with pytest.raises(dataclasses.FrozenInstanceError):
        robot.M = np.eye(4)
    for key in ("S", "M", "B", "q_min", "q_max", "v_max", "home"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(robot, key)[0] = 0


def test_a_robot_does_not_share_memory_with_what_it_was_made_from():
    S, M = S_Z.astype(float), np.eye(4)
    robot = Robot.from_screws(S, M)
    S[2], M[0, 3] = 0, 9
    assert robot.S[2, 0] == 1
    assert robot.M[0, 3] == 0


def test_results_are_the_callers_own():
    robot = random_robot(np.random.default_rng(4), 1)
    for method in (
        "fk",
        "displacements",
        "link_frames",
        "jacobian_space",
        "jacobian_body",
        "jacobian_geometric",
    ):
        before = getattr(robot, method)([0.2])
        getattr(robot, method)([0.2])[...] = 7
        assert np.array_equal(getattr(robot, method)([0.2]), before)


def test_the_angles_given_are_not_changed():
    theta = np.full((2, 6), 9.0)
    robot = robots.kuka_kr6()
    for method in ("fk", "jacobian_geometric", "within_limits", "nearest_turn"):
        getattr(robot, method)(theta)
    assert (theta == 9.0).all()
