"""Directions, points and lines: against their definitions, and with one tolerance."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coursekit import lie
from coursekit.kinematics import axes

seeds = st.integers(0, 2**32 - 1)


def random_lines(seed, k=2):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(k, 3))
    return rng.uniform(-1, 1, (k, 3)), w / np.linalg.norm(w, axis=1, keepdims=True)


@given(seeds)
def test_the_foot_is_on_the_line_and_straight_below(seed):
    (q, p), (w, _) = random_lines(seed)
    foot = axes.foot(p, q, w)
    assert np.abs(np.cross(foot - q, w)).max() < 1e-14
    assert abs((p - foot) @ w) < 1e-14


@given(seeds)
def test_feet_are_on_their_lines_and_what_lies_between_is_across_both(seed):
    (q_1, q_2), (w_1, w_2) = random_lines(seed)
    foot_1, foot_2 = axes.feet(q_1, w_1, q_2, w_2)
    slack = 1e-13 / axes.sine(w_1, w_2) ** 2
    for foot, q, w in ((foot_1, q_1, w_1), (foot_2, q_2, w_2)):
        assert np.abs(np.cross(foot - q, w)).max() < slack
        assert abs((foot_2 - foot_1) @ w) < slack


@given(seeds, st.integers(2, 4))
def test_lines_through_a_point_meet_there(seed, k):
    q, w = random_lines(seed, k)
    there = q[0]
    point, miss = axes.meeting_point(there + np.arange(1, k + 1)[:, None] * w, w)
    slack = 1e-13 / max(axes.sine(w[0], v) for v in w[1:]) ** 2
    assert np.abs(point - there).max() < slack and miss < slack


def test_points_and_directions_of_screws():
    S = np.array([[0, 0, 1, 0.2, -0.5, 0], [0, 0, 1, 0, 0, 0.1], [0, 0, 0, 0, 1, 0]]).T
    assert axes.points_on(S).tolist() == [[0.5, 0.2, 0], [0, 0, 0], [0, 0, 0]]
    assert axes.directions_of(S).tolist() == [[0, 0, 1], [0, 0, 1], [0, 1, 0]]


@pytest.mark.parametrize("angle, same", [(5e-11, True), (5e-10, False)])
def test_one_tolerance_for_every_question(angle, same):
    z, x = np.array([0, 0, 1.0]), np.array([1.0, 0, 0])
    tilted = lie.exp3([0, angle, 0]) @ z
    assert axes.parallel(z, tilted) == axes.parallel(z, -tilted) == same
    assert axes.perpendicular(x, tilted) == same
    q = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 2], [0, angle, 2], [0, 0, 2]], dtype=float)
    w = np.eye(3)[[2, 1, 1, 2, 0, 2]]
    if same:
        assert axes.wrist(q, w)[0] == "spherical"
    else:
        with pytest.raises(ValueError, match="miss a common point by 5e-10 m"):
            axes.wrist(q, w)


def test_a_wrist_of_parallel_axes_is_told_from_a_spherical_one():
    q = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [2, 0.3, 1], [2.5, 0.3, 1]])
    w = np.eye(3)[[2, 1, 1, 1, 0, 2]]
    family, point = axes.wrist(q, w)
    assert family == "parallel" and point.tolist() == [2.5, 0.3, 1]
    q[3] = 2.5, 0, 1
    assert axes.wrist(q, w)[0] == "spherical"  # axis 4 goes through the point, too
    q[5, 1] = 0.4
    with pytest.raises(ValueError, match=r"axes 5 and 6 do not meet: they miss a common point by 0\.1 m"):
        axes.wrist(q, w)


@given(seeds)
def test_a_rotation_has_its_z_and_leans_where_it_should(seed):
    _, (z, towards) = random_lines(seed)
    R = axes.rotation_to(z, towards)
    assert np.abs(R.T @ R - np.eye(3)).max() < 1e-14 and np.linalg.det(R) > 0
    assert R[:, 2].tolist() == z.tolist()
    assert R[:, 0] @ towards > 0 and abs(R[:, 1] @ towards) < 1e-14
    along = axes.rotation_to(z, -2 * z)  # no help: as if it were not given
    assert along.tolist() == axes.rotation_to(z).tolist()


def test_cross_is_numpys_for_numbers_and_arrays():
    a, b = np.random.default_rng(0).normal(size=(2, 3, 5))
    assert np.array_equal(axes.cross(a, b), np.cross(a, b, axis=0))
    assert axes.cross([1, 0, 0], [0, 1, 0]) == (0, 0, 1)
