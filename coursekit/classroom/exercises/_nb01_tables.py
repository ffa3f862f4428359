"""Exercises of notebook 01 about tables: making one from a drawing, joints of both kinds, joint ranges."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import POSE, Edge, Exercise, Hint
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._arm import turn
from coursekit.classroom.exercises._axes import NEAR, between, deg, mm, pose_gap
from coursekit.classroom.exercises._nb01 import angles, dh_row

X, Y, Z = np.eye(3)
ANGLES = "alpha", "theta"  # columns 1 and 3 of a table


# ---- making a table: the S030 of the exam


def _lengths(rng):
    """Height, offset, upper arm, forearm and flange of an S030 that was never built."""
    return (rng.uniform([0.4, 0.1, 0.6, 0.7, 0.1], [0.7, 0.3, 0.9, 1.2, 0.3]),)


def _without(k):
    return lambda rng: (_lengths(rng)[0] * (np.arange(5) != k),)


LENGTHS = (
    Edge("for the S030 itself", lambda rng: (np.array([0.68, 0.15, 0.87, 1.08, 0.165]),)),
    Edge("where the offset is zero", _without(1)),
    Edge("where the flange has no length", _without(4)),
    Edge("for whole numbers", lambda rng: (np.array([50, 10, 70, 90, 20]),)),
)


def drawn(lengths):
    """The six axes of the drawing as (direction, point), and the centre of its flange."""
    h, o, u, f, t = lengths
    shoulder, elbow, wrist = (np.array(p) for p in ([o, 0, h], [o, 0, h + u], [o + f, 0, h + u]))
    axes = [(Z, np.zeros(3)), (Y, shoulder), (Y, elbow), (X, elbow), (Y, wrist), (X, wrist)]
    return axes, wrist + t * X


def frames(rows):
    """Frames 0 to 6 of a standard table whose theta column is the drawn pose, (7, 4, 4)."""
    found = [np.eye(4)]
    for a, alpha, d, theta in rows:
        found.append(found[-1] @ _along(2, theta, d) @ _along(0, alpha, a))
    return np.array(found)


def _along(i, angle, slide):
    """A turn about an axis of the frame and a slide along it, (4, 4)."""
    T = np.eye(4)
    T[:3, :3], T[i, 3] = turn(i, angle), slide
    return T


def _table_gap(args, rows, right):
    """The first thing that a table gets wrong; where it is an angle in degrees, that."""
    gap = _misplaced(args[0], rows)
    large = np.argwhere(np.abs(rows[:, [1, 3]]) > 2 * np.pi + NEAR)
    if gap and len(large):
        i, k = large[0]
        return f"row {i + 1} has {ANGLES[k]} = {rows[i, 2 * k + 1]:.3g} rad: angles are in radians here"
    return gap


def _misplaced(lengths, rows):
    """The first thing that does not fit the drawing: a twist, an axis, the flange."""
    for i, alpha in enumerate(rows[:, 1], 1):
        alpha = (alpha + np.pi / 2) % (2 * np.pi) - np.pi / 2  # -90 to 270 deg
        if min(abs(alpha), abs(alpha - np.pi / 2)) > NEAR:
            return f"row {i} has a twist of {np.degrees(alpha):.3g} deg; yours may be 0 or +90 deg only"
    axes, flange = drawn(lengths)
    placed = frames(rows)
    for i, (w, q) in enumerate(axes[1:], 1):
        z, p = placed[i][:3, 2], placed[i][:3, 3]
        if (angle := min(between(z, w), between(-z, w))) > NEAR:
            return f"after row {i}, z_{i} should lie on axis {i + 1}; yours is tilted by {deg(angle)}"
        if (beside := np.linalg.norm(np.cross(w, p - q))) > NEAR:
            return f"after row {i}, z_{i} is parallel to axis {i + 1}, but stands {mm(beside)} beside it"
    if (gap := np.linalg.norm(placed[6][:3, 3] - flange)) > NEAR:
        return f"your frame 6 stands {mm(gap)} from the centre of the flange"
    if (angle := between(placed[6][:3, 2], X)) > NEAR:
        return f"z_6 should point out of the flange; yours points {deg(angle)} away from there"
    return ""


def _fits(f, args, rows):
    return not _table_gap(args, rows, None)


def _frames_seen(args, rows):
    placed = frames(np.reshape(rows, (6, 4)))
    return {"frames": list(placed), "chains": [placed[:, :3, 3]]}


DH_TABLE = Exercise(
    "dh_table(lengths)",
    look=_frames_seen,
    points=4,
    draw=_lengths,
    shape=(6, 4),
    compare="any_solution",
    edges=LENGTHS,
    usual="for other lengths",
    residual=_table_gap,
    unit="m, rad",
    samples=3,
    laws=(
        ("every frame i stands on axis i + 1, and frame 6 on the flange, with twists 0 or +90 deg", _fits),
    ),
    hints=(
        Hint("a_for_d", "a and d are exchanged: a runs along x, on the common normal; d runs along z"),
        Hint("all_angles_zero", "the last column is the drawn pose: theta_i is the turn from x_{i-1} to x_i"),
        Hint("without_flange", "row 6 is all zero: the flange stands further out along z_5"),
        Hint("modified", "that is the modified table: in the standard one, row i holds a_i and alpha_i"),
        Hint("degrees", "the angles are in degrees; radians are expected"),
        Hint(
            "d4_twice",
            "row 6 has the length of row 4: the flange is another length (the exam prints d_4 twice)",
        ),
        Hint("forearm_as_a", "the forearm lies along axis 4: that is a d on z_3, not an a"),
    ),
)


# ---- joints of both kinds


def _joint(kind, **fixed):
    """A row, a joint value and a kind; some numbers of the row are given."""

    def draw(rng):
        row = dict(zip(("a", "alpha", "d", "theta"), dh_row(rng), strict=True))
        q = angles(rng, 1)[0] if kind == "revolute" else rng.choice([-1, 1]) * rng.uniform(0.2, 0.6)
        return np.array([*{**row, **fixed}.values()]), q, kind

    return draw


def _any_joint(rng):
    return _joint(rng.choice(["revolute", "prismatic"]))(rng)


def _at_zero(kind):
    def draw(rng):
        row, _, _ = _joint(kind)(rng)
        return row, 0.0, kind

    return draw


JOINTS = (
    Edge("for a hinge", _joint("revolute"), 2),
    Edge("for a slide", _joint("prismatic"), 2),
    Edge("for a hinge at zero", _at_zero("revolute")),
    Edge("for a slide at zero", _at_zero("prismatic")),
    Edge("for a slide whose offset d is zero", _joint("prismatic", d=0.0)),
    Edge("for a hinge whose offset is zero", _joint("revolute", theta=0.0)),
    Edge("for whole numbers", lambda rng: (np.array([1, 2, -1, 3]), 0.5, "prismatic")),
    Edge("for a hinge that has turned more than once", lambda rng: (np.array(dh_row(rng)), 8.0, "revolute")),
)


def _frame_gap(args, T, right):
    return pose_gap(T, right, "frame")


def _one_more_step(f, args, T):
    """A slide by q more is a shift along the old z; a hinge by q more is a turn about it."""
    row, q, kind = args
    first = f(row, 2 * q, kind) @ np.linalg.inv(T)
    step = np.eye(4)
    if kind == "prismatic":
        step[2, 3] = q
    else:
        step[:2, :2] = [[np.cos(q), -np.sin(q)], [np.sin(q), np.cos(q)]]
    return bool(np.allclose(first, step, atol=1e-9))


JOINT_TRANSFORM = Exercise(
    "joint_transform(row, q, kind)",
    look=looks.pose,
    points=2,
    draw=_any_joint,
    shape=(4, 4),
    compare="rotation",
    edges=JOINTS,
    usual="for other joints",
    blocks=POSE,
    residual=_frame_gap,
    unit="m, rad",
    samples=2,
    laws=(("a joint that moves on by q turns about, or slides along, the old z axis", _one_more_step),),
    hints=(
        Hint("always_turns", "a slide does not turn: its joint value is added to d"),
        Hint("always_slides", "a hinge does not slide: its joint value is added to theta"),
        Hint("kinds_exchanged", "the two kinds are exchanged: a hinge turns, a slide shifts"),
        Hint("without_offset", "the joint value is added to the number in the row; it does not replace it"),
        Hint("along_x", "a slide moves along its axis, z: its value goes to d, not to a"),
        Hint("both", "one of the two numbers moves; the other one keeps the value of the row"),
        Hint("modified", "these are standard rows; you read them as modified ones"),
        Hint("slide_without_theta", "a slide keeps the angle of its row: theta is constant, not zero"),
    ),
)


# ---- joint ranges


def _ranges(rng, n=None, sense=None):
    n = n or int(rng.integers(2, 7))
    lower, upper = rng.uniform(-3, -0.3, n), rng.uniform(0.4, 2.8, n)
    sense = rng.choice([-1.0, 1.0], n) if sense is None else np.full(n, sense)
    return np.column_stack([lower, upper]), sense, np.pi / 2 * rng.integers(-1, 3, n)


def _beyond_zero(rng):
    """Ranges that do not hold the maker's zero: both ends on one side of it."""
    limits, sense, at_zero = _ranges(rng, 4)
    return np.sort(rng.choice([-1, 1], (4, 1)) * np.abs(limits), axis=1), sense, at_zero


def _from_zero(rng):
    """Ranges of which one end is the maker's zero itself: a number like any other."""
    limits, sense, at_zero = _ranges(rng, 4)
    return limits * rng.permuted([[0, 1], [1, 0], [0, 1], [1, 0]], axis=0), sense, at_zero


def _s030(rng):
    limits = np.radians([(-180, 180), (-105, 140), (-155, 135), (-360, 360), (-145, 145), (-360, 360)])
    return limits, np.array([1.0, -1, 1, 1, 1, 1]), np.pi / 2 * np.array([0, 1, 1, 2, 2, 0])


RANGES = (
    Edge("where every sense agrees", lambda rng: _ranges(rng, 4, 1.0)),
    Edge("where no sense agrees", lambda rng: _ranges(rng, 4, -1.0)),
    Edge("for one joint", lambda rng: _ranges(rng, 1, -1.0)),
    Edge("where the maker's zero is outside the range", _beyond_zero),
    Edge("where a range begins or ends at the maker's zero", _from_zero),
    Edge("for the S030", _s030),
    Edge(
        "for whole numbers",
        lambda rng: (np.array([[-2, 1], [-1, 3]]), np.array([-1, 1]), np.array([1, 0])),
    ),
)


def _range_gap(args, mine, right):
    if (mine[:, 0] > mine[:, 1]).any():
        return "a lower end is larger than its upper end: where the sense turns, the ends change places"
    k = int(np.argmax(np.abs(mine - right).max(axis=1)))
    low, high = np.degrees(right[k])
    yours = " to ".join(f"{x:.0f}" for x in np.degrees(mine[k]))
    return f"joint {k + 1} may go from {low:.0f} to {high:.0f} deg; yours goes from {yours} deg"


def _in_order(f, args, ends):
    return bool((ends[:, 0] <= ends[:, 1]).all())


def _as_wide(f, args, ends):
    return bool(np.allclose(np.ptp(ends, axis=1), np.ptp(args[0], axis=1)))


RANGES_TO_DH = Exercise(
    "ranges_to_dh(limits, sense, at_zero)",
    points=2,
    draw=_ranges,
    shape=(None, 2),
    edges=RANGES,
    usual="for other arms",
    residual=_range_gap,
    unit="rad",
    samples=3,
    laws=(
        ("the lower end of a range comes first", _in_order),
        ("a range is as wide in one convention as in the other", _as_wide),
    ),
    hints=(
        Hint("not_swapped", "where the sense is -1 the ends change places: the lower one comes first"),
        Hint("no_sense", "a joint that the maker counts the other way has its range mirrored: use `sense`"),
        Hint("no_shift", "at the maker's zero the DH angle is `at_zero`, not 0: add it"),
        Hint("minus_shift", "theta_DH = at_zero + sense theta_maker: the shift is added"),
        Hint("shift_turned", "only the maker's angle changes its sign, not `at_zero`"),
        Hint("degrees", "the answer is in radians, as the limits are"),
        Hint("wrapped", "a range may reach beyond 180 deg: take no whole turns away"),
    ),
)
