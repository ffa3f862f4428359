"""Exercises of notebook 02: M, S and B from a drawing."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics.
ALLOW = ("lie.hat3", "lie.vee3")


def _direction(rng):
    w = rng.normal(size=3)
    return w / np.linalg.norm(w)


def _line(rng):
    """A direction of any length and a point that is not the nearest one to the origin."""
    return rng.uniform(0.4, 2.5) * _direction(rng), rng.uniform(0.2, 1.0, 3) * rng.choice([-1, 1], 3)


def _lengths(rng):
    """L1 to L5 of an ABB that was never built."""
    return (rng.uniform([0.3, 0.3, 0.02, 0.3, 0.05], [0.6, 0.6, 0.08, 0.6, 0.15]),)


def _pose(rng):
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, y, np.cross(x, y)]), rng.uniform(0.2, 0.8, 3)
    return T


def _one_pose(rng):
    return (_pose(rng),)


def _screw(rng):
    """A screw with pitch, so that a forgotten pitch shows."""
    w, q = _direction(rng), rng.uniform(0.2, 0.8, 3)
    return np.concatenate([w, np.cross(q, w) + rng.uniform(0.05, 0.3) * w])


def _one_screw(rng):
    return (_screw(rng),)


def _screws_and_home(rng):
    n = int(rng.integers(2, 7))
    return np.column_stack([_screw(rng) for _ in range(n)]), _pose(rng)


def _any_point_will_do(f, args, S):
    w, q = args
    return bool(np.allclose(f(w, q + 0.3 * w), S, atol=1e-9))


def _any_length_will_do(f, args, S):
    w, q = args
    return bool(np.allclose(f(2 * w, q), S, atol=1e-9))


def _product(f, args, Ad):
    return bool(np.allclose(f(args[0] @ args[0]), Ad @ Ad, atol=1e-9))


def _nearest(f, args, answer):
    return bool(abs(np.dot(answer[0], answer[1])) < 1e-9)


EXERCISES = [
    Exercise(
        "home_pose(lengths)",
        points=2,
        draw=_lengths,
        shape=(4, 4),
        compare="rotation",
        unit="m",
        hints=(
            Hint("wrist", "that is the wrist centre: the tool frame stands on the flange, L5 further out"),
            Hint("flange_along_z", "L5 leads out of the flange along x at zero, not along z"),
            Hint("column_along_x", "L1 is the height of the column: it goes along z, not along x"),
            Hint("without_elbow", "L3 is missing: the forearm runs L3 above the end of the upper arm"),
        ),
    ),
    Exercise(
        "screw_axis(w, q)",
        points=2,
        draw=_line,
        shape=(6,),
        unit="m",
        hints=(
            Hint("plus", "v = w x q would be the velocity of q seen from the origin: you need its opposite"),
            Hint("v_first", "rows are (omega; v): the direction comes first"),
            Hint("not_unit", "w may come in any length: scale the direction to length 1 first"),
            Hint("q_itself", "the lower half is a velocity, -w x q, not the point q"),
        ),
        laws=(
            ("another point q on the same axis must give the same screw", _any_point_will_do),
            ("a longer vector w along the same axis must give the same screw", _any_length_will_do),
        ),
    ),
    Exercise(
        "axis_of(S)",
        points=3,
        draw=_one_screw,
        shape=((3,), (3,), ()),
        unit="m, m/rad",
        hints=(
            Hint("v_cross_w", "v x w points from the axis to the origin: the point has the opposite sign"),
            Hint("no_pitch", "these screws have a pitch: it is the part of v along w"),
            Hint("v_for_q", "v is the velocity of the point at the origin, not a point on the axis"),
            Hint("whole_v", "the pitch is the part of v along w, not the length of v"),
        ),
        laws=(("of all points of the axis, give the one nearest to the origin", _nearest),),
    ),
    Exercise(
        "adjoint(T)",
        points=3,
        draw=_one_pose,
        shape=(6, 6),
        hints=(
            Hint("v_first", "that is the adjoint for (v; omega): with (omega; v), [p]R stands below R"),
            Hint("R_hat_p", "the lower left block is [p] R, in this order: first turn, then cross with p"),
            Hint("inverse", "that is the adjoint of the inverse: it maps from frame a to frame b"),
            Hint("no_p", "the lower left block is zero only where p is zero"),
        ),
        laws=(("Ad(T T) must be Ad(T) Ad(T)", _product),),
    ),
    Exercise(
        "body_screws(S, M)",
        points=2,
        draw=_screws_and_home,
        shape=(6, None),
        unit="m",
        hints=(
            Hint("ad_of_M", "Ad(M) maps from the tool to the space frame: here the way is the other one"),
            Hint(
                "transposed", "the inverse of Ad(M) is not its transpose: its lower left block is in the way"
            ),
            Hint("minus_p", "the inverse of M has position -R'p, not -p"),
            Hint("only_shifted", "M turns as well: w changes too where the tool frame is turned"),
        ),
    ),
]
