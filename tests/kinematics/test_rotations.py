"""Four ways to write a rotation: golden data, there and back, and the attitudes where one is lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coursekit import lie, rotations

SHAPES = [(), (1,), (3, 1, 2)]
QUARTER = np.pi / 2


def random_rotations(shape, rng):
    """Uniform rotations, from quaternions of normal numbers."""
    return rotations.from_quaternion(rng.normal(size=(*shape, 4)))


def gap(a, b):
    """The largest difference of angles, modulo whole turns."""
    difference = np.asarray(a) - np.asarray(b)
    return np.abs((difference + np.pi) % (2 * np.pi) - np.pi).max()


# -- golden data --


def test_golden_quaternions(golden):
    for case in golden("rotations")["cases"]:
        q, expected = rotations.quaternion(case["R"]), np.array(case["quat_wxyz"])
        either_sign = abs(expected[0]) < 1e-12
        error = min(np.abs(q - expected).max(), np.abs(q + expected).max() if either_sign else np.inf)
        assert error <= 1e-14, case["kind"]
        assert np.abs(rotations.from_quaternion(expected) - case["R"]).max() <= 1e-14


def test_golden_zyx(golden):
    for case in golden("rotations")["cases"]:
        angles = rotations.zyx(case["R"])
        assert np.abs(rotations.from_zyx(angles) - case["R"]).max() <= 2e-14, case["kind"]
        assert np.abs(rotations.from_zyx(case["zyx"]) - case["R"]).max() <= 2e-14
        if case["kind"] != "gimbal":
            assert gap(angles, case["zyx"]) <= 1e-9, case["kind"]


def test_golden_xyx(golden):
    for case in golden("rotations")["cases"]:
        angles = rotations.xyx(case["R"])
        assert 0 <= angles[1] <= np.pi
        assert np.abs(rotations.from_xyx(angles) - case["R"]).max() <= 2e-14, case["kind"]
        assert np.abs(rotations.from_xyx(case["xyx"]) - case["R"]).max() <= 2e-14
        if np.sin(case["xyx"][1]) > 1e-6:
            assert gap(angles, case["xyx"]) <= 1e-9, case["kind"]


def test_golden_angle_axis(golden):
    for case in golden("rotations")["cases"]:
        w = lie.log3(case["R"])
        signs = [1, -1] if case["kind"] == "half_turn" else [1]
        assert min(np.abs(sign * w - case["rotvec"]).max() for sign in signs) <= 2e-14, case["kind"]
        assert abs(np.linalg.norm(w) - case["angle"]) <= 2e-14


# -- there and back --


@pytest.mark.parametrize("shape", SHAPES)
def test_every_form_gives_the_rotation_back(shape):
    R = random_rotations(shape, np.random.default_rng(3))
    for write, read in [
        (rotations.quaternion, rotations.from_quaternion),
        (rotations.zyx, rotations.from_zyx),
        (rotations.xyx, rotations.from_xyx),
        (lie.log3, lie.exp3),
    ]:
        back = read(write(R))
        assert back.shape == R.shape == (*shape, 3, 3)
        assert np.abs(back - R).max() <= 2e-15
        for index in np.ndindex(shape):
            assert np.array_equal(write(R)[index], write(R[index].tolist()))


def test_quaternion_is_accurate_everywhere():
    """Each of the four rows of 4 q q' is the longest somewhere; near the seams between them too."""
    rng = np.random.default_rng(4)
    q = rng.normal(size=(20000, 4))
    q[:4000] = np.sign(q[:4000]) + 1e-9 * q[4000:8000]
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    q *= np.sign(q[:, :1])
    assert np.abs(rotations.quaternion(rotations.from_quaternion(q)) - q).max() <= 1e-15


def test_quaternion_multiplies_like_rotations_do():
    R = random_rotations((2, 50), np.random.default_rng(5))
    (w, *v), (u, *y) = (np.moveaxis(rotations.quaternion(r), -1, 0) for r in R)
    v, y = np.array(v), np.array(y)
    product = np.concatenate([[w * u - (v * y).sum(0)], w * y + u * v + np.cross(v.T, y.T).T])
    assert np.abs(rotations.from_quaternion(product.T) - R[0] @ R[1]).max() <= 2e-15


angle = st.floats(-10, 10, allow_subnormal=False)


@given(angle, st.floats(-QUARTER + 0.01, QUARTER - 0.01), angle)
def test_zyx_reads_the_angles_it_was_made_of(yaw, pitch, roll):
    assert gap(rotations.zyx(rotations.from_zyx([yaw, pitch, roll])), [yaw, pitch, roll]) <= 1e-13


@given(angle, st.floats(0.01, np.pi - 0.01), angle)
def test_xyx_reads_the_angles_it_was_made_of(a, b, c):
    assert gap(rotations.xyx(rotations.from_xyx([a, b, c])), [a, b, c]) <= 1e-13


@given(arrays(float, (4,), elements=st.floats(-1, 1, allow_subnormal=False)), st.floats(0.001, 1000))
def test_the_length_and_the_sign_of_a_quaternion_mean_nothing(q, scale):
    if np.linalg.norm(q) < 1e-3:
        q = np.array([1.0, 0, 0, 0])
    R = rotations.from_quaternion(q)
    assert np.abs(R.T @ R - np.eye(3)).max() <= 1e-14
    assert np.linalg.det(R) > 0
    assert np.abs(rotations.from_quaternion(-scale * q) - R).max() <= 1e-14
    assert rotations.quaternion(R)[0] >= 0


@pytest.mark.parametrize("turn, axis", [(rotations.rotx, 0), (rotations.roty, 1), (rotations.rotz, 2)])
def test_elementary_turns(turn, axis):
    angles = np.linspace(-7, 7, 29)
    w = np.zeros((29, 3))
    w[:, axis] = angles
    assert np.abs(turn(angles) - lie.exp3(w)).max() <= 2e-15
    assert turn(angles.reshape(29, 1)).shape == (29, 1, 3, 3)
    assert turn(0.0).tolist() == np.eye(3).tolist()


# -- where a form is not unique --


@pytest.mark.parametrize("pitch", [QUARTER, -QUARTER])
@pytest.mark.parametrize("yaw, roll", [(0.4, 0), (0.4, 0.7), (-2.0, 3.0), (0, 0)])
def test_gimbal_lock_puts_everything_into_yaw(pitch, yaw, roll):
    R = rotations.from_zyx([yaw, pitch, roll])
    angles = rotations.zyx(R)
    assert angles[2] == 0
    assert angles[1] == pytest.approx(pitch, abs=1e-15)
    assert gap(angles[0], yaw - np.sign(pitch) * roll) <= 1e-15
    assert np.abs(rotations.from_zyx(angles) - R).max() <= 2e-15


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9, 1e-11])
def test_next_to_gimbal_lock_nothing_is_given_up(distance):
    for pitch in (QUARTER - distance, distance - QUARTER):
        R = rotations.from_zyx([0.4, pitch, 0.7])
        assert np.abs(rotations.from_zyx(rotations.zyx(R)) - R).max() <= 2e-15
        assert gap(rotations.zyx(R), [0.4, pitch, 0.7]) <= 1e-15 / distance


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9, 1e-11, 1e-13])
@pytest.mark.parametrize(
    "write, read, lock",
    [
        (rotations.zyx, rotations.from_zyx, QUARTER),
        (rotations.zyx, rotations.from_zyx, -QUARTER),
        (rotations.xyx, rotations.from_xyx, 0.0),
        (rotations.xyx, rotations.from_xyx, np.pi),
    ],
)
def test_the_rotation_comes_back_however_near_the_lock(write, read, lock, distance):
    """R as a product of matrices, with rounding in every entry: the angles lose digits there, R does not."""
    first, last = np.random.default_rng(6).uniform(-3, 3, (2, 500))
    middle = np.full(500, lock + distance if lock <= 0 else lock - distance)
    R = rotations.rotz(-0.1) @ (rotations.rotz(0.1) @ read(np.stack([first, middle, last], axis=-1)))
    locked = distance < rotations.GIMBAL  # then the distance itself is dropped
    assert np.abs(read(write(R)) - R).max() <= (2 * distance if locked else 2e-15)


@pytest.mark.parametrize("b", [0.0, np.pi])
@pytest.mark.parametrize("a, c", [(0.4, 0), (0.4, 0.7), (-2.0, 3.0), (0, 0)])
def test_straight_wrist_puts_everything_into_the_first_angle(a, b, c):
    R = rotations.from_xyx([a, b, c])
    angles = rotations.xyx(R)
    assert angles[2] == 0
    assert angles[1] == pytest.approx(b, abs=1e-15)
    assert gap(angles[0], a + c if b == 0 else a - c) <= 2e-15
    assert np.abs(rotations.from_xyx(angles) - R).max() <= 2e-15


@pytest.mark.parametrize(
    "axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0.6, -0.8], [-0.48, 0.64, 0.6], [0.6, 0, -0.8]]
)
def test_half_turns_make_the_first_component_positive(axis):
    axis = np.array(axis)
    R = 2 * np.outer(axis, axis) - np.eye(3)
    q = rotations.quaternion(R)
    first = q[1:][np.abs(q[1:]) > 1e-9][0]
    assert abs(q[0]) <= 1e-15
    assert first > 0
    assert np.abs(rotations.from_quaternion(q) - R).max() <= 2e-15


def test_identity():
    assert rotations.quaternion(np.eye(3)).tolist() == [1, 0, 0, 0]
    assert rotations.zyx(np.eye(3)).tolist() == [0, 0, 0]
    assert rotations.xyx(np.eye(3)).tolist() == [0, 0, 0]


# -- what is refused, and NaN --


@pytest.mark.parametrize(
    "function, wrong, message",
    [
        (rotations.quaternion, np.eye(4), r"R must have shape \(\.\.\., 3, 3\), got \(4, 4\)"),
        (rotations.zyx, np.eye(2), r"R must have shape \(\.\.\., 3, 3\), got \(2, 2\)"),
        (rotations.xyx, [1, 2, 3], r"R must have shape \(\.\.\., 3, 3\), got \(3,\)"),
        (rotations.from_quaternion, [1, 0, 0], r"q must have shape \(\.\.\., 4\), got \(3,\)"),
        (rotations.from_quaternion, [[1, 0, 0, 0], [0, 0, 0, 0]], "q must not be the zero quaternion"),
        (rotations.from_zyx, [1, 0], r"angles must have shape \(\.\.\., 3\), got \(2,\)"),
        (rotations.from_xyx, [1, 0], r"angles must have shape \(\.\.\., 3\), got \(2,\)"),
        (rotations.rotx, "east", "angle must be an array of real numbers"),
    ],
)
def test_wrong_input_says_what_was_expected(function, wrong, message):
    with pytest.raises(ValueError, match=message):
        function(wrong)


def test_nan_stays_in_its_own_row():
    R = np.stack([np.eye(3), np.full((3, 3), np.nan)])
    for write, read in [
        (rotations.quaternion, rotations.from_quaternion),
        (rotations.zyx, rotations.from_zyx),
        (rotations.xyx, rotations.from_xyx),
    ]:
        assert np.isnan(read(write(R))[1]).any()
        assert read(write(R))[0].tolist() == np.eye(3).tolist()
