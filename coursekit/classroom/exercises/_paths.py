"""Paths, limits and motions for the exercises of notebook 06: how their arguments are drawn."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises import _attitudes as attitudes


def curve(rng, m=None):
    """A few points on a sphere, neighbours about a quarter radius apart, and its centre."""
    centre, radius = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.3, 0.7)
    first, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    angle = np.cumsum(rng.uniform(0.15, 0.35, m or int(rng.integers(3, 6))))
    sway = np.outer(np.sin(3 * angle + rng.uniform(0, 6)), 0.3 * np.cross(first, towards))
    points = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), towards) + sway
    return centre + radius * points / np.linalg.norm(points, axis=1, keepdims=True), centre


def about_the_origin(rng):
    points, centre = curve(rng, 3)
    return points - centre, np.zeros(3)


def whole_points(rng):
    """On a sphere of radius 3 about (1, 0, -1)."""
    points = rng.permutation([[1, 2, 2], [2, 1, 2], [2, -2, 1], [-1, 2, -2]])
    return points + [1, 0, -1], [1, 0, -1]


def configurations(rng):
    """Configurations up to one and a half turns away, and limits: some narrow, some beyond half a turn."""
    n = int(rng.integers(2, 5))
    lower, upper = -rng.uniform(1.5, 4.5, n), rng.uniform(1.5, 4.5, n)
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (24, n)), lower, upper


def several_turns(rng):
    _, lower, upper = configurations(rng)
    return rng.uniform(-6 * np.pi, 6 * np.pi, (12, len(lower))), lower, upper


def one_joint(rng):
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (8, 1)), [-rng.uniform(0.5, 1)], [rng.uniform(1, 4)]


def as_many_as_joints(rng):
    """A square theta, whose rows and columns are easily confused."""
    theta, lower, upper = configurations(rng)
    return theta[: len(lower)], lower, upper


def exactly_on_a_limit(rng):
    """Numbers that are exact in binary, so that no rounding decides."""
    theta = [[-1.5, 0.25], [2.25, 0.25], [0.5, -0.75], [0.5, 3.5], [-1.625, 0], [0, 3.625], [2.25, 3.5]]
    return rng.permutation(theta), [-1.5, -0.75], [2.25, 3.5]


def both_positive(rng):
    """Limits on one side of 0, for which an angle of the other side has to turn."""
    side = rng.choice([-1, 1])
    limits = np.sort(side * rng.uniform([[0.6], [3.6]], [[1.2], [5.5]], (2, 2)), axis=0)
    return rng.uniform(-1.4 * np.pi, 1.4 * np.pi, (12, 2)), *limits


def exam(rng):
    """Its theta_2, and limits of 35 to 325 degrees for joint 5 of the same arm."""
    theta = np.radians([[-174.72, 90], [-174.72, -20], [-174.72, -90], [10, 180], [-60, 180]])
    return theta, np.radians([-50, 35]), np.radians([195, 325])


def more_than_a_turn(rng):
    lower, upper = np.radians([-350, -100]), np.radians([350, 100])
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (8, 2)), lower, upper


def whole_angles(rng):
    return rng.integers(-9, 10, (12, 2)), [-3, -1], [2, 4]


def motion(rng, m=8, n=None):
    """A joint path that crosses half a turn, uneven steps of the tool, another bound for every joint."""
    n = n or int(rng.integers(3, 7))
    q = np.cumsum(rng.uniform(-0.2, 0.2, (m, n)), axis=0) + rng.uniform(-0.5, 0.5, n)
    q[:, rng.integers(n)] = np.pi - 0.4 + np.cumsum(rng.uniform(0.08, 0.2, m))
    points = np.cumsum(directions(rng, m) * rng.uniform(0.01, 0.04, (m, 1)), axis=0)
    return q, points, rng.uniform(1.5, 6.0, n)


def directions(rng, m):
    return np.array([attitudes.direction(rng) for _ in range(m)])


def one_that_hardly_moves(rng):
    q, points, v_max = motion(rng, n=3)
    q[:, 1] = 0.7 + 1e-9 * np.arange(len(q))
    return q, points, v_max


def a_slow_one(rng):
    q, points, v_max = motion(rng, n=3)
    q[:, 1] = 0.7 + np.cumsum(rng.uniform(4e-5, 9e-5, len(q)))
    return q, points, v_max * [1, 1e-4, 1]


def one_that_rests(rng):
    """Joint 2 stands still all along, also in the step that sets the speed."""
    q, points, v_max = motion(rng, n=3)
    q[:, 1] = 0.7
    return q, points, v_max


def a_step_of_more_than_half_a_turn(rng):
    """Few points: in one step joint 1 turns by four rad, and no number of turns is taken off."""
    q, points, v_max = motion(rng, n=3)
    q[4:, 0] += 4.0
    return q, points, v_max


def equal_steps(rng):
    q, _, v_max = motion(rng, n=3)
    return q, np.cumsum(0.02 * directions(rng, len(q)), axis=0), v_max


def moves_most_but_may(limit):
    """The joint that turns most is not the one that sets the speed; `limit` does, turning backwards."""

    def draw(rng):
        q, points, v_max = motion(rng, n=3)
        most = (limit + 1) % 3
        q[:, limit] = -np.cumsum(rng.uniform(0.05, 0.1, len(q)))
        q[:, most] = np.cumsum(rng.uniform(0.2, 0.3, len(q)))
        v_max[:] = 4.0
        v_max[limit], v_max[most] = 0.5, 12.0
        return q, points, v_max

    return draw


def whole_motion(rng):
    q = [[0, 1], [2, 0], [1, -2], [1, 1]]
    return q, [[0, 0, 0], [1, 2, 2], [1, 2, 3], [1, 5, 7]], rng.permutation([2, 3])
