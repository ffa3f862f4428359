"""Paden-Kahan subproblems: what is turned arrives, every root is found, and what has none is NaN."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coursekit import lie, subproblems

RNG = np.random.default_rng(4)
angles = st.floats(-3.1, 3.1)


def unit_vectors(*shape):
    v = RNG.normal(size=(*shape, 3))
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def rot(k, t, x):
    """rot(k, t) x by the matrix exponential: another way than the subproblems go."""
    R = lie.exp3(np.asarray(t)[..., None] * k)
    return (R @ np.asarray(x)[..., None])[..., 0]


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (200,)])
def test_one_carries_x_to_y(shape):
    k, x, t = unit_vectors(*shape), RNG.normal(size=(*shape, 3)), RNG.uniform(-3.1, 3.1, shape)
    found = subproblems.subproblem1(k, x, rot(k, t, x))
    assert found.shape == shape
    assert np.allclose(found, t, atol=1e-12)


@given(angles)
def test_one_any_angle(t):
    k, x = np.array([0.6, 0, 0.8]), np.array([0.1, -0.5, 0.3])
    assert abs(subproblems.subproblem1(k, x, rot(k, t, x)) - t) < 1e-12


def test_one_is_nan_where_no_turn_does_it_and_zero_where_all_do():
    k, x = [0, 0, 1], [1, 0, 0]
    assert np.isnan(subproblems.subproblem1(k, x, [0, 1, 0.1]))
    assert np.isnan(subproblems.subproblem1(k, x, [0, 1.1, 0]))
    assert subproblems.subproblem1(k, [0, 0, 2], [0, 0, 2]) == 0
    assert subproblems.subproblem1(k, x, [-1, 0, 0]) == np.pi


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (200,)])
def test_two_reaches_y_both_ways(shape):
    k1, k2, x = unit_vectors(*shape), unit_vectors(*shape), RNG.normal(size=(*shape, 3))
    t1, t2 = RNG.uniform(-3, 3, (2, *shape))
    y = rot(k1, t1, rot(k2, t2, x))
    found = subproblems.subproblem2(k1, k2, x, y)
    assert found.shape == (*shape, 2, 2)
    for i in range(2):
        assert np.allclose(rot(k1, found[..., i, 0], rot(k2, found[..., i, 1], x)), y, atol=1e-9)
    wanted = np.stack([t1, t2], axis=-1)[..., None, :]
    assert np.all(np.abs(found - wanted).max(axis=-1).min(axis=-1) < 1e-6)


def test_two_touching_circles_and_none():
    z, x = np.array([0.0, 0, 1]), np.array([1.0, 0, 0])
    touching = subproblems.subproblem2(z, x, [0, 1, 0], [0, 1, 0])
    assert np.allclose(rot(z, touching[:, 0], rot(x, touching[:, 1], [0.0, 1, 0])), [0, 1, 0])
    assert np.isnan(subproblems.subproblem2(z, x, [0.9, 0.1, 0], [0, 0.1, 0.9])).all()
    assert np.isnan(subproblems.subproblem2(z, x, [0, 1, 0], [0, 2, 0])).all()


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
def test_equal_lengths_are_equal_at_every_size(size):
    """A part in 1e10 is rounding, a part in 1e6 is another place, in metres as in millimetres."""
    z, y_axis = np.array([0.0, 0, 1]), np.array([0.0, 1, 0])
    x, y = size * np.array([1.0, 0, 2]), size * np.array([0.0, 1, 2])
    for off, found in ((1e-10, True), (1e-6, False)):
        assert np.isfinite(subproblems.subproblem1(z, x, y * (1 + off))) == found
        higher = y + size * off * z  # as far from the axis, not as high
        assert np.isfinite(subproblems.subproblem1(z, x, higher)) == found
        assert np.isfinite(subproblems.subproblem2(z, y_axis, x, y * (1 + off))).all() == found


def test_two_needs_two_axes():
    with pytest.raises(ValueError, match="subproblem 2 needs two different axes: k1 and k2 are parallel"):
        subproblems.subproblem2([0, 0, 1], [0, 0, -1], [1, 0, 0], [0, 1, 0])


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (200,)])
def test_three_brings_x_to_the_distance(shape):
    k, x, y = unit_vectors(*shape), RNG.normal(size=(*shape, 3)), RNG.normal(size=(*shape, 3))
    t = RNG.uniform(-3, 3, shape)
    distance = np.linalg.norm(y - rot(k, t, x), axis=-1)
    found = subproblems.subproblem3(k, x, y, distance)
    assert found.shape == (*shape, 2)
    for i in range(2):
        assert np.allclose(np.linalg.norm(y - rot(k, found[..., i], x), axis=-1), distance, atol=1e-12)
    assert np.all(np.abs(found - np.asarray(t)[..., None]).min(axis=-1) < 1e-6)


def test_three_at_the_end_of_the_reach():
    k, x, y = [0, 0, 1], [1, 0, 0], [-2, 0, 0]
    assert np.allclose(subproblems.subproblem3(k, x, y, 3.0), [0, 0])
    assert np.isnan(subproblems.subproblem3(k, x, y, 3.0 + 1e-9)).all()
    assert np.isnan(subproblems.subproblem3(k, x, y, 1.0 - 1e-9)).all()


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (200,)])
def test_four_brings_x_to_the_plane(shape):
    h, k, x = unit_vectors(*shape), unit_vectors(*shape), RNG.normal(size=(*shape, 3))
    t = RNG.uniform(-3, 3, shape)
    d = (h * rot(k, t, x)).sum(axis=-1)
    found = subproblems.subproblem4(h, k, x, d)
    assert found.shape == (*shape, 2)
    for i in range(2):
        assert np.allclose((h * rot(k, found[..., i], x)).sum(axis=-1), d, atol=1e-12)
    assert np.all(np.abs(found - np.asarray(t)[..., None]).min(axis=-1) < 1e-6)


def test_four_where_every_turn_or_none_is_right():
    assert subproblems.subproblem4([0, 0, 1], [0, 0, 1], [1, 0, 2], 2.0).tolist() == [0, 0]
    assert np.isnan(subproblems.subproblem4([0, 0, 1], [0, 0, 1], [1, 0, 2], 2.1)).all()


def test_directions_and_angles_where_some_are_special():
    """A pair without a direction counts as (1, 0), and half a turn is +pi, beside pairs that are ordinary."""
    c, s = subproblems.unit(np.array([0.0, 3.0]), np.array([0.0, 4.0]))
    assert (c.tolist(), s.tolist()) == ([1.0, 0.6], [0.0, 0.8])
    found = subproblems.angle((np.array([-1.0, 0.0, -1.0]), np.array([-0.0, 1.0, 1e-300])))
    assert found.tolist() == [np.pi, np.pi / 2, np.pi]
    assert subproblems.angle((np.array([0.0]), np.array([-1.0]))).tolist() == [-np.pi / 2]


def test_nan_in_nan_out():
    nan = [np.nan, 0, 0]
    assert np.isnan(subproblems.subproblem1([0, 0, 1], nan, [1, 0, 0]))
    assert np.isnan(subproblems.subproblem3([0, 0, 1], nan, [1, 0, 0], 1.0)).all()
    assert np.isnan(subproblems.subproblem4([1, 0, 0], [0, 0, 1], [1, 0, 0], np.nan)).all()


@pytest.mark.parametrize(
    "call, message",
    [
        (
            lambda: subproblems.subproblem1([0, 1], [1, 0, 0], [1, 0, 0]),
            r"k must have shape \(\.\.\., 3\), got \(2,\)",
        ),
        (lambda: subproblems.subproblem3([0, 0, 1], [1, 0, 0], 1.0, 1.0), r"y must have shape \(\.\.\., 3\)"),
        (
            lambda: subproblems.subproblem4([0, 0, 1], [1, 0, 0], [1, 0, 0], "far"),
            "d must be an array of real numbers",
        ),
        (
            lambda: subproblems.subproblem3([0, 0, 1], [1, 0, 0], [1, 0, 0], "far"),
            "^distance must be an array of real numbers",
        ),
    ],
)
def test_what_is_no_vector(call, message):
    with pytest.raises(ValueError, match=message):
        call()
