"""Exercises of notebook 01: Denavit-Hartenberg against the product of exponentials."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics.
ALLOW = ("lie.hat3", "lie.vee3", "rotations.rotx", "rotations.roty", "rotations.rotz")


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.2, 1.3, n)


def _dh_row(rng):
    alpha, theta = _angles(rng, 2)
    return rng.uniform(0.1, 0.8), alpha, rng.uniform(-0.6, 0.6), theta


def _rows(rng, n):
    """n rows a, alpha, d, theta offset."""
    lengths = rng.uniform(0.1, 0.8, (2, n))
    return np.column_stack([lengths[0], _angles(rng, n), lengths[1], _angles(rng, n)])


def _pose(rng):
    """A rotation about a random axis and a shift."""
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, y, np.cross(x, y)]), rng.uniform(-0.5, 0.5, 3)
    return T


def _dh_arm(rng):
    n = int(rng.integers(2, 6))
    return _rows(rng, n), _angles(rng, n), _pose(rng), _pose(rng)


def _screw(rng):
    """A hinge (with pitch or without) or, in one case out of three, a slide."""
    w, q = rng.normal(size=3), rng.uniform(-0.6, 0.6, 3)
    w = w / np.linalg.norm(w)
    if rng.random() < 1 / 3:
        return np.concatenate([np.zeros(3), w])
    pitch = rng.choice([0.0, rng.uniform(0.05, 0.2)])
    return np.concatenate([w, np.cross(q, w) + pitch * w])


def _one_screw(rng):
    return _screw(rng), _angles(rng, 1)[0]


def _poe_arm(rng):
    n = int(rng.integers(2, 7))
    return np.column_stack([_screw(rng) for _ in range(n)]), _pose(rng), _angles(rng, n)


def _modified_arm(rng):
    return _rows(rng, int(rng.integers(2, 6))), _pose(rng)


def _first_column(f, args, S):
    """Where rows hold no lengths and the base is the identity, every axis goes through the origin."""
    rows = args[0] * [0, 1, 0, 1]
    return bool(np.allclose(f(rows, np.eye(4))[3:], 0, atol=1e-9))


EXERCISES = [
    Exercise(
        "dh_transform(a, alpha, d, theta)",
        points=2,
        draw=_dh_row,
        shape=(4, 4),
        compare="rotation",
        unit="m, rad",
        hints=(
            Hint(
                "alpha_for_a",
                "the last column holds lengths: a, not alpha, goes with cos and sin of theta",
            ),
            Hint("entry_22", "look at entry (2, 2): sin(theta) stands there in place of cos(theta)"),
            Hint(
                "modified",
                "that is the modified transform: in the standard one, the turn about z comes first",
            ),
            Hint("degrees", "alpha and theta are in radians: your numbers are what degrees would give"),
            Hint("transposed", "this is the transpose: the translation belongs in the last column"),
        ),
    ),
    Exercise(
        "mdh_transform(a_prev, alpha_prev, d, theta)",
        points=2,
        draw=_dh_row,
        shape=(4, 4),
        compare="rotation",
        unit="m, rad",
        hints=(
            Hint("plus_sin", "look at entry (1, 2): a turn about z has -sin(theta) there"),
            Hint("no_a", "the last column begins with a_{i-1}: the step along x is missing"),
            Hint(
                "standard",
                "that is the standard transform: in the modified one, the turn about x comes first",
            ),
            Hint("d_on_old_z", "d is measured along the new z, which alpha_{i-1} has already tilted"),
            Hint("degrees", "both angles are in radians: your numbers are what degrees would give"),
        ),
    ),
    Exercise(
        "fk_dh(rows, theta, base, tool)",
        points=3,
        draw=_dh_arm,
        shape=(4, 4),
        compare="rotation",
        unit="m, rad",
        hints=(
            Hint("no_offset", "theta alone is not the angle of a row: add the offset in its fourth column"),
            Hint("no_tool", "the tool is missing: the last factor takes frame n to the tool"),
            Hint("no_base", "the base is missing: the first factor takes the space frame to frame 0"),
            Hint(
                "reversed",
                "the links are multiplied in reverse: frame 1 hangs on frame 0, so A_1 comes first",
            ),
            Hint("read_as_modified", "these are standard rows; you read them as modified ones"),
        ),
    ),
    Exercise(
        "screw_exp(S, theta)",
        points=3,
        draw=_one_screw,
        shape=(4, 4),
        compare="rotation",
        unit="m, rad",
        samples=6,
        hints=(
            Hint("v_first", "S is (omega; v): you took its first three numbers for v"),
            Hint("theta_v", "theta v is the translation of a slide; a hinge moves the origin along an arc"),
            Hint("sin_sin", "the last coefficient is theta - sin(theta): one sine, not two"),
            Hint(
                "no_pitch", "v may have a part along omega: such a screw slides as it turns, yours only turns"
            ),
            Hint("slide_turns", "where omega is zero nothing turns: the joint slides along v"),
            Hint("turned_back", "it turns the wrong way round: check the signs in [omega]"),
        ),
    ),
    Exercise(
        "fk_poe(S, M, theta)",
        points=2,
        draw=_poe_arm,
        shape=(4, 4),
        compare="rotation",
        unit="m, rad",
        hints=(
            Hint("no_M", "at theta = 0 your tool is at the origin: the home pose M is missing"),
            Hint("M_left", "M on the left belongs to body screws; these are space screws"),
            Hint(
                "reversed",
                "the exponentials are in reverse: joint 1 carries all the others, so it comes first",
            ),
            Hint("body_screws", "you turned S into body screws; with M on the right it must stay as it is"),
            Hint("degrees", "theta is in radians: your numbers are what degrees would give"),
        ),
    ),
    Exercise(
        "screws_from_dh(rows, base)",
        points=3,
        draw=_modified_arm,
        shape=(6, None),
        unit="m, rad",
        laws=(
            ("where all lengths are zero, every axis goes through the origin: v must vanish", _first_column),
        ),
        hints=(
            Hint("about_x", "a joint turns about its own z; your [A] turns about x"),
            Hint("frame_before", "you stopped one frame short: axis i is the z of frame i, M_1 ... M_i"),
            Hint("one_side", "[A] changes its frame as T [A] T^-1: the factor on its right is missing"),
            Hint("no_base", "these screws are in frame 0: the base takes them to the space frame"),
            Hint("no_offset", "the table's own offsets belong to the frames at theta = 0"),
        ),
    ),
]
