"""SO(3) and SE(3): against 60-digit arithmetic, golden data, and the group axioms over batch shapes."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from coursekit import lie

SHAPES = [(), (1,), (3, 1, 2)]
# From the smallest turn to the largest, with the places where formulas usually lose digits.
ANGLES = [
    0,
    1e-12,
    1e-9,
    1e-7,
    1e-5,
    1e-3,
    0.0099,
    0.0101,
    0.1,
    1,
    2,
    3,
    np.pi - 1e-5,
    np.pi - 1e-8,
    np.pi - 1e-10,
]
AXES = np.array([[1, 0, 0], [0, -1, 0], [0.6, 0, 0.8], [1, -2, 3], [-3, 1, 0.01]])
AXES = AXES / np.linalg.norm(AXES, axis=1, keepdims=True)


def exact_exp6(xi):
    """exp6 of a twist of floats with 60 digits, rounded once at the end."""
    with mpmath.workdps(60):
        w, v = mpmath.matrix(xi[:3].tolist()), mpmath.matrix(xi[3:].tolist())
        t = mpmath.sqrt((w.T * w)[0])
        W = mpmath.matrix([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        if t == 0:
            A, B, C = mpmath.mpf(1), mpmath.mpf(1) / 2, mpmath.mpf(1) / 6
        else:
            A, B, C = mpmath.sin(t) / t, (1 - mpmath.cos(t)) / t**2, (t - mpmath.sin(t)) / t**3
        R = mpmath.eye(3) + A * W + B * W * W
        p = v + B * W * v + C * W * W * v
        T = np.eye(4)
        T[:3, :3] = [[float(R[i, j]) for j in range(3)] for i in range(3)]
        T[:3, 3] = [float(x) for x in p]
        return T


def twists(angle):
    """A few twists that turn by `angle`, with velocities of ordinary size."""
    v = np.array([[0.3, -0.5, 0.7], [0, 0, 0], [-1, 0.2, 0.4], [0.01, 0.9, -0.3], [0.5, 0.5, 0.5]])
    return np.concatenate([angle * AXES, v], axis=1)


@pytest.mark.parametrize("angle", [*ANGLES, np.pi])
def test_exp_holds_14_digits(angle):
    for xi in twists(angle):
        exact = exact_exp6(xi)
        assert np.abs(lie.exp6(xi) - exact).max() <= 1e-14
        assert np.abs(lie.exp3(xi[:3]) - exact[:3, :3]).max() <= 1e-14


@pytest.mark.parametrize("angle", ANGLES)
def test_log_holds_14_digits(angle):
    for xi in twists(angle):
        T = exact_exp6(xi)
        assert np.abs(lie.log6(T) - xi).max() <= 1e-14
        assert np.abs(lie.log3(T[:3, :3]) - xi[:3]).max() <= 1e-14


def test_log_of_half_a_turn_is_one_of_two_answers():
    for xi in twists(np.pi):
        T = exact_exp6(xi)
        w = lie.log3(T[:3, :3])
        assert min(np.abs(w - xi[:3]).max(), np.abs(w + xi[:3]).max()) <= 1e-14
        assert np.abs(lie.exp6(lie.log6(T)) - T).max() <= 1e-14


def test_exact_half_turns_take_the_axis_whose_first_component_is_positive():
    for axis in (*np.eye(3), *-np.eye(3)):
        R = 2 * np.outer(axis, axis) - np.eye(3)
        assert lie.log3(R).tolist() == (np.pi * np.abs(axis)).tolist()


def test_small_turns_keep_their_relative_digits():
    for angle in (1e-12, 1e-9, 1e-5):
        w = angle * AXES
        assert np.abs(lie.log3(lie.exp3(w)) - w).max() <= 1e-14 * angle


# -- golden data --


def test_golden_exponentials(golden):
    for case in golden("se3_exp_log")["exp_log"]:
        assert np.abs(lie.exp6(case["twist"]) - case["T"]).max() <= 2e-14, case["region"]


def test_golden_logarithms(golden):
    for case in golden("se3_exp_log")["exp_log"]:
        answers = [case["twist"], case["also"]] if case["region"] == "pi" else [case["twist"]]
        error = min(np.abs(lie.log6(case["T"]) - answer).max() for answer in answers)
        assert error <= case["log_tol"], (case["region"], case["angle"])


def test_golden_adjoints_and_inverses(golden):
    for case in golden("se3_exp_log")["adjoint"]:
        assert np.abs(lie.adjoint(case["T"]) - case["adjoint"]).max() <= 1e-14
        assert np.abs(lie.inverse(case["T"]) - case["inverse"]).max() <= 1e-14


# -- the axioms, over batch shapes --


def sample_twists(shape, rng):
    """Twists of a batch shape, among them pure translations, tiny turns and turns next to pi."""
    w = rng.normal(size=(*shape, 3))
    w /= np.linalg.norm(w, axis=-1, keepdims=True)
    angle = rng.choice([0, 1e-12, 1e-5, 0.3, 2.0, np.pi - 1e-6, np.pi - 1e-10], size=(*shape, 1))
    return np.concatenate([angle * w, rng.uniform(-2, 2, (*shape, 3))], axis=-1)


@pytest.mark.parametrize("draw", range(10))
@pytest.mark.parametrize("shape", SHAPES)
def test_group_axioms(shape, draw):
    rng = np.random.default_rng(draw)
    xi, eta, zeta = (sample_twists(shape, rng) for _ in range(3))
    A, B, C = lie.exp6(xi), lie.exp6(eta), lie.exp6(zeta)
    eye = np.broadcast_to(np.eye(4), A.shape)

    def close(a, b, tolerance=2e-14):
        assert a.shape == b.shape
        assert np.abs(a - b).max() <= tolerance

    close((A @ B) @ C, A @ (B @ C))
    close(A @ lie.inverse(A), eye)
    close(lie.inverse(A) @ A, eye)
    close(lie.inverse(A @ B), lie.inverse(B) @ lie.inverse(A))
    close(lie.exp6(-xi), lie.inverse(A))
    close(lie.exp6(lie.log6(A)), A)
    close(lie.log6(A), xi)
    close(lie.adjoint(A @ B), lie.adjoint(A) @ lie.adjoint(B), 1e-13)
    close(lie.adjoint(lie.inverse(A)) @ lie.adjoint(A), np.broadcast_to(np.eye(6), (*shape, 6, 6)), 1e-13)
    close((lie.adjoint(A) @ eta[..., None])[..., 0], lie.vee6(A @ lie.hat6(eta) @ lie.inverse(A)), 1e-13)
    R = A[..., :3, :3]
    close(np.swapaxes(R, -1, -2) @ R, eye[..., :3, :3])
    assert np.allclose(np.linalg.det(R), 1)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "function, trailing",
    [
        (lie.hat3, (3,)),
        (lie.hat6, (6,)),
        (lie.exp3, (3,)),
        (lie.exp6, (6,)),
    ],
)
def test_a_batch_is_its_members_one_by_one(function, trailing, shape):
    x = np.random.default_rng(1).uniform(-1, 1, (*shape, *trailing))
    batch = function(x)
    for index in np.ndindex(shape):
        assert np.array_equal(batch[index], function(x[index].tolist()))


@pytest.mark.parametrize("function", [lie.log6, lie.inverse, lie.adjoint, lie.vee6])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_batch_of_poses_is_its_members_one_by_one(function, shape):
    T = lie.exp6(sample_twists(shape, np.random.default_rng(2)))
    batch = function(T)
    for index in np.ndindex(shape):
        assert np.array_equal(batch[index], function(T[index].tolist()))


def test_empty_batches_pass():
    assert lie.exp6(np.zeros((0, 6))).shape == (0, 4, 4)
    assert lie.log6(np.zeros((0, 4, 4))).shape == (0, 6)


# -- free input --

numbers = st.floats(-1e3, 1e3, allow_subnormal=False)


@given(arrays(float, (6,), elements=numbers))
def test_vee_undoes_hat(xi):
    assert lie.vee6(lie.hat6(xi)).tolist() == xi.tolist()
    assert lie.vee3(lie.hat3(xi[:3])).tolist() == xi[:3].tolist()
    assert np.allclose(lie.hat3(xi[:3]) @ xi[3:], np.cross(xi[:3], xi[3:]))


@given(arrays(float, (6,), elements=numbers))
def test_any_twist_gives_a_pose_and_its_log_is_the_short_way(xi):
    T = lie.exp6(xi)
    R = T[:3, :3]
    assert np.abs(R.T @ R - np.eye(3)).max() <= 1e-12
    log = lie.log6(T)
    assert np.linalg.norm(log[:3]) <= np.pi + 1e-12
    assert np.allclose(lie.exp6(log), T, rtol=0, atol=1e-9 * (1 + np.abs(xi).max()))


@given(arrays(float, (3,), elements=st.floats(-0.6, 0.6, allow_subnormal=False)), st.floats(-4, 4))
def test_turns_about_one_axis_add_up(w, t):
    assert np.abs(lie.exp3(w) @ lie.exp3(t * w) - lie.exp3((1 + t) * w)).max() <= 1e-14


def test_pure_translation_is_exact():
    v = np.array([0.1, -2.0, 3.5])
    T = lie.exp6([0, 0, 0, *v])
    assert T[:3, 3].tolist() == v.tolist()
    assert T[:3, :3].tolist() == np.eye(3).tolist()
    assert lie.log6(T).tolist() == [0, 0, 0, *v]


# -- what is refused, and NaN --


@pytest.mark.parametrize(
    "function, wrong, message",
    [
        (lie.hat3, [1, 2], r"w must have shape \(\.\.\., 3\), got \(2,\)"),
        (lie.vee3, np.eye(4), r"W must have shape \(\.\.\., 3, 3\), got \(4, 4\)"),
        (lie.hat6, [1, 2, 3], r"xi must have shape \(\.\.\., 6\), got \(3,\)"),
        (lie.vee6, np.eye(3), r"X must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        (lie.exp3, np.eye(4), r"w must have shape \(\.\.\., 3\), got \(4, 4\)"),
        (lie.exp6, 0.5, r"xi must have shape \(\.\.\., 6\), got \(\)"),
        (lie.log3, np.eye(4), r"R must have shape \(\.\.\., 3, 3\), got \(4, 4\)"),
        (lie.log6, np.eye(3), r"T must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        (lie.inverse, np.eye(3), r"T must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        (lie.adjoint, np.eye(3), r"T must have shape \(\.\.\., 4, 4\), got \(3, 3\)"),
        (lie.exp6, ["a"] * 6, "xi must be an array of real numbers"),
    ],
)
def test_wrong_shapes_say_what_was_expected(function, wrong, message):
    with pytest.raises(ValueError, match=message):
        function(wrong)


def test_nan_stays_in_its_own_row():
    xi = np.ones((2, 6))
    xi[1, 0] = np.nan
    for result in (
        lie.exp6(xi),
        lie.log6(lie.exp6(xi)),
        lie.inverse(lie.exp6(xi)),
        lie.adjoint(lie.exp6(xi)),
    ):
        assert not np.isnan(result[0]).any()
        assert np.isnan(result[1]).any()
    assert np.isnan(lie.log6(np.full((4, 4), np.nan))).all()
    assert np.isnan(lie.log3(np.full((3, 3), np.nan))).all()


def test_an_angle_whose_square_is_nothing():
    """1e-170 rad: its square underflows, the vector itself does not."""
    w = np.array([0.0, 3e-170, 0.0])
    assert np.allclose(lie.log3(lie.exp3(w)) / 3e-170, [0, 1, 0])


def test_slerp_turns_about_one_axis_at_constant_speed():
    rng = np.random.default_rng(12)
    R_0, R_1 = lie.exp3(rng.normal(size=(2, 6, 3)))
    t = np.linspace(0, 1, 11)
    way = lie.slerp(R_0[:, None], R_1[:, None], t)
    np.testing.assert_allclose(way[:, [0, -1]], np.stack([R_0, R_1], axis=1), rtol=0, atol=1e-14)
    turns = lie.log3(way[:, :-1].swapaxes(-1, -2) @ way[:, 1:])
    np.testing.assert_allclose(turns, np.broadcast_to(turns[:, :1], turns.shape), rtol=0, atol=1e-14)
    assert (10 * np.linalg.norm(turns[:, 0], axis=-1) <= np.pi + 1e-12).all()


def test_slerp_refuses_what_is_no_rotation():
    with pytest.raises(ValueError, match=r"R_1 is not in SO\(3\)"):
        lie.slerp(np.eye(3), 2 * np.eye(3), 0.5)
