"""Exercises of notebook 02: M, S and B from a drawing."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._axes import (
    NEAR,
    between,
    deg,
    is_rotation,
    mm,
    screw_gap,
    screws_gap,
    turn,
)
from coursekit.classroom.exercises._nb02_drawing import FROM_ANOTHER_FRAME, HOME_AND_SCREWS, JOINT_SCREW

# What the student's functions may call from coursekit.kinematics: what notebook 01 had them write, too.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.hat6",
    "lie.vee6",
    "lie.exp3",
    "lie.exp6",
    "lie.inverse",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
)


def _direction(rng):
    w = rng.normal(size=3)
    return w / np.linalg.norm(w)


def _point(rng):
    """A point away from the planes of the axes."""
    return rng.uniform(0.2, 1.0, 3) * rng.choice([-1, 1], 3)


def _line(rng):
    """A direction of any length and a point that is not the nearest one to the origin."""
    return rng.uniform(0.4, 2.5) * _direction(rng), _point(rng)


def _line_along(*w):
    return lambda rng: (np.array(w), _point(rng))


LINES = (
    Edge("for a w of length 1", lambda rng: (_direction(rng), _point(rng))),
    Edge("for an axis through the origin", lambda rng: (1.7 * _direction(rng), np.zeros(3))),
    Edge("for an axis along x", _line_along(2.0, 0.0, 0.0)),
    Edge("for an axis along y", _line_along(0.0, 0.5, 0.0)),
    Edge("for an axis along -z", _line_along(0.0, 0.0, -3.0)),
    Edge("for a very short w", lambda rng: (1e-4 * _direction(rng), _point(rng))),
    Edge("for a w of nearly length 1", lambda rng: (1.00002 * _direction(rng), _point(rng))),
    Edge("for axis 5 of the KR6", lambda rng: (np.array([0, 1, 0]), np.array([0.9, 0, 0.435]))),
    Edge("for whole numbers", lambda rng: (np.array([0, 3, -4]), np.array([10, -20, 30]))),
)


def _lengths(rng):
    """L1 to L5 of an ABB that was never built."""
    return (rng.uniform([0.3, 0.3, 0.02, 0.3, 0.05], [0.6, 0.6, 0.08, 0.6, 0.15]),)


def _lengths_without(k):
    return lambda rng: (_lengths(rng)[0] * (np.arange(1, 6) != k),)


LENGTHS = (
    Edge("for the ABB itself", lambda rng: (np.array([0.3991, 0.448, 0.042, 0.451, 0.082]),)),
    *(Edge(f"where L{k} is zero", _lengths_without(k)) for k in range(1, 6)),
    Edge("for whole numbers", lambda rng: (np.array([400, 500, 100, 300, 200]),)),
)


def _rotation(rng):
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    return np.column_stack([x, y, np.cross(x, y)])


def _at(R, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def _pose(rng):
    return _at(_rotation(rng), rng.uniform(0.2, 0.8, 3) * rng.choice([-1, 1], 3))


def _one_pose(rng):
    return (_pose(rng),)


KR6 = _at(np.eye(3), [0.98, 0, 0.435])  # M of the KR6
WHOLE = np.array([[0, -1, 0, 1], [1, 0, 0, -2], [0, 0, 1, 3], [0, 0, 0, 1]])  # a quarter turn about z
POSES = (
    Edge("where p is zero", lambda rng: (_at(_rotation(rng), np.zeros(3)),)),
    Edge("where R is the identity", lambda rng: (_at(np.eye(3), _point(rng)),)),
    Edge("for the identity", lambda rng: (np.eye(4),)),
    Edge("for the home pose of the KR6", lambda rng: (KR6,)),
    Edge("where R is half a turn about x", lambda rng: (_at(np.diag([1.0, -1, -1]), _point(rng)),)),
    Edge("where R is half a turn about y", lambda rng: (_at(np.diag([-1.0, 1, -1]), _point(rng)),)),
    Edge("for whole numbers", lambda rng: (WHOLE,)),
)


def _hinge(rng):
    """A hinge with pitch, so that a forgotten pitch shows."""
    return _screw(rng, rng.choice([-1, 1]) * rng.uniform(0.05, 0.3))


def _screw(rng, pitch, through=None):
    w, q = _direction(rng), _point(rng) if through is None else through
    return np.concatenate([w, np.cross(q, w) + pitch * w])


def _screw_square_to_z(rng):
    """x and y of its axis add up to 0."""
    w = np.array([1, -1, 0]) / np.sqrt(2)
    return (np.concatenate([w, np.cross(_point(rng), w) - 0.2 * w]),)


def _one_screw(rng):
    return (_hinge(rng),)


SCREWS = (
    Edge("for a hinge without pitch", lambda rng: (_screw(rng, 0.0),)),
    Edge("for a negative pitch", lambda rng: (_screw(rng, -0.2),)),
    Edge("for an axis through the origin", lambda rng: (_screw(rng, 0.2, np.zeros(3)),)),
    Edge("where v is zero", lambda rng: (_screw(rng, 0.0, np.zeros(3)),)),
    Edge("for axis 5 of the KR6", lambda rng: (np.array([0, 1, 0, -0.435, 0, 0.9]),)),
    Edge("for whole numbers", lambda rng: (np.array([0, 0, -1, 2, 3, 1]),)),
    Edge("for a fine pitch", lambda rng: (_screw(rng, 5e-6),)),
    Edge("for an axis square to z", _screw_square_to_z),
)


def _screws_and_home(rng, n=None):
    n = n or int(rng.integers(2, 6))
    return np.column_stack([_hinge(rng) for _ in range(n)]), _pose(rng)


def _screws_seen_from(make):
    return lambda rng: (_screws_and_home(rng)[0], make(rng))


def _with_a_slide(rng):
    S, M = _screws_and_home(rng, 3)
    S[:, 1] = np.concatenate([np.zeros(3), _direction(rng)])
    return S, M


def _kr6(rng):
    from coursekit import robots

    return robots.kuka_kr6().S, KR6


def _whole_screws(rng):
    """S of whole numbers, of which a copy would cut off the decimals that M brings."""
    S = np.array([[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, -2, 0], [0, 0, 1], [0, 1, 0]])
    return S, _at(WHOLE[:3, :3], [0.5, -0.25, 1.5])


ARMS = (
    Edge("where M is the identity", _screws_seen_from(lambda rng: np.eye(4))),
    Edge("where M does not turn", _screws_seen_from(lambda rng: _at(np.eye(3), _point(rng)))),
    Edge("where M does not shift", _screws_seen_from(lambda rng: _at(_rotation(rng), np.zeros(3)))),
    Edge("for an arm with one joint", lambda rng: _screws_and_home(rng, 1)),
    Edge("for an arm with a slide", _with_a_slide),
    Edge("for the KR6", _kr6),
    Edge("for an arm with seven joints", lambda rng: _screws_and_home(rng, 7)),
    Edge("for whole numbers", _whole_screws),
)


# ---- how far a wrong answer misses


def _home_gap(args, M, right):
    gap = M[:3, 3] - right[:3, 3]
    words = (("far forward", "far back"), ("far to the left", "far to the right"), ("high", "low"))
    told = [f"{mm(x)} too {word[int(x < 0)]}" for x, word in zip(gap, words, strict=True) if abs(x) > NEAR]
    if told:
        return f"your tool frame stands {' and '.join(told)}"
    if is_rotation(M[:3, :3]) and (angle := turn(M[:3, :3])) > NEAR:
        return f"your tool frame is turned by {deg(angle)}; it is parallel to the space frame"
    return ""


def _screw_gap(args, S, right):
    return screw_gap(S, right, "your axis")


def _axis_gap(args, answer, right):
    (w, q, pitch), (w0, q0, pitch0) = answer, right
    if abs(length := np.linalg.norm(w) - 1) > NEAR:
        return f"a direction has length 1; yours has length {length + 1:.3g}"
    if (angle := between(w, w0)) > NEAR:
        return f"your direction is {deg(angle)} away from that of the axis"
    if (beside := np.linalg.norm(np.cross(w0, q - q0))) > NEAR:
        return f"your point lies {mm(beside)} beside the axis"
    if abs(along := w0 @ (q - q0)) > NEAR:
        return f"your point lies on the axis, but {mm(along)} away from the one nearest to the origin"
    if abs(pitch - pitch0) > NEAR:
        return f"in one radian this screw slides {mm(pitch0)} along its axis; your pitch says {mm(pitch)}"
    return ""


def _adjoint_gap(args, Ad, right):
    """What becomes of a hinge, or of a slide, along an axis of the frame: a column of the adjoint."""
    for k in range(6):
        if text := screw_gap(Ad[:, k], right[:, k], "yours"):
            joint = "hinge" if k < 3 else "slide"
            return f"column {k} is a {joint} along the {'xyz'[k % 3]} axis of the frame; {text}"
    return ""


def _body_gap(args, B, right):
    return screws_gap(B, right, " as seen from the tool")


# ---- what must hold whatever the inputs


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


def _seen_from_where_it_is(f, args, B):
    return bool(np.allclose(f(args[0], np.eye(4)), args[0], atol=1e-9))


EXERCISES = [
    Exercise(
        "home_pose(lengths)",
        look=looks.pose,
        points=2,
        draw=_lengths,
        shape=(4, 4),
        compare="rotation",
        unit="m",
        samples=3,
        edges=LENGTHS,
        usual="for other lengths",
        blocks=(
            Block("the rotation", np.s_[:3, :3]),
            Block("x of the position", np.s_[0, 3]),
            Block("y of the position", np.s_[1, 3]),
            Block("the height (z)", np.s_[2, 3]),
            Block("the last row", np.s_[3]),
        ),
        residual=_home_gap,
        hints=(
            Hint("wrist", "that is the wrist centre: the tool frame stands on the flange, L5 further out"),
            Hint("flange_along_z", "L5 leads out of the flange along x at zero, not along z"),
            Hint("column_along_x", "L1 is the height of the column: it goes along z, not along x"),
            Hint("without_elbow", "L3 is missing: the forearm runs L3 above the end of the upper arm"),
        ),
    ),
    Exercise(
        "screw_axis(w, q)",
        look=looks.screws,
        points=2,
        draw=_line,
        shape=(6,),
        unit="m",
        samples=3,
        edges=LINES,
        usual="for other axes",
        blocks=(Block("omega", np.s_[:3]), Block("v", np.s_[3:])),
        residual=_screw_gap,
        hints=(
            Hint("plus", "v is the velocity at the origin, w x (0 - q): yours has the other sign"),
            Hint("v_first", "rows are (omega; v): the direction comes first"),
            Hint("not_unit", "w may come in any length: scale the direction to length 1 first"),
            Hint("all_scaled", "omega has length 1, not all six numbers: scale w first, then take -w x q"),
            Hint("v_not_scaled", "v comes from the direction of length 1, too: scale w first, then -w x q"),
            Hint("q_itself", "the lower half is a velocity, -w x q, not the point q"),
            Hint("q_scaled", "only w is scaled to length 1: q stays where it is"),
            Hint("entrywise", "`*` multiplies entry by entry: the cross product is np.cross(w, q)"),
        ),
        laws=(
            ("another point q on the same axis must give the same screw", _any_point_will_do),
            ("a longer vector w along the same axis must give the same screw", _any_length_will_do),
        ),
    ),
    JOINT_SCREW,
    HOME_AND_SCREWS,
    Exercise(
        "axis_of(S)",
        look=looks.axis,
        points=3,
        draw=_one_screw,
        shape=((3,), (3,), ()),
        unit="m, m/rad",
        samples=3,
        edges=SCREWS,
        usual="for other screws",
        blocks=(
            Block("the direction", ..., part=0),
            Block("the point", ..., part=1),
            Block("the pitch", ..., part=2),
        ),
        residual=_axis_gap,
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
        samples=3,
        edges=POSES,
        usual="for other poses",
        blocks=(
            Block("the upper left block", np.s_[:3, :3]),
            Block("the upper right block", np.s_[:3, 3:]),
            Block("the lower left block", np.s_[3:, :3]),
            Block("the lower right block", np.s_[3:, 3:]),
        ),
        residual=_adjoint_gap,
        hints=(
            Hint("v_first", "that is the adjoint for (v; omega): with (omega; v), [p]R stands below R"),
            Hint("R_hat_p", "the lower left block is [p] R, in this order: first turn, then cross with p"),
            Hint("inverse", "that is the adjoint of the inverse: it maps from frame a to frame b"),
            Hint("minus_p", "[p] has its signs the wrong way round: [p] y must be p x y, for any y"),
            Hint("rows_crossed", "[p] R crosses p with the columns of R; yours with the rows"),
            Hint("no_p", "the lower left block is zero only where p is zero"),
            Hint("no_R", "the lower left block is [p] R: yours is [p] alone"),
            Hint("R_transposed", "R stands in all blocks as it is, not transposed"),
            Hint("I_below", "the lower right block is R: the v of a slide turns with the frame, too"),
        ),
        laws=(("Ad(T T) must be Ad(T) Ad(T)", _product),),
    ),
    Exercise(
        "body_screws(S, M)",
        look=looks.screws,
        points=2,
        draw=_screws_and_home,
        shape=(6, None),
        unit="m",
        samples=3,
        edges=ARMS,
        usual="for other arms",
        blocks=(
            Block("the directions (upper rows)", np.s_[:3], plural=True),
            Block("the lower rows (v)", np.s_[3:], plural=True),
        ),
        residual=_body_gap,
        laws=(
            (
                "a tool frame that is the space frame sees the screws as they are: B = S",
                _seen_from_where_it_is,
            ),
        ),
        hints=(
            Hint("ad_of_M", "Ad(M) maps from the tool to the space frame: here the way is the other one"),
            Hint(
                "transposed", "the inverse of Ad(M) is not its transpose: its lower left block is in the way"
            ),
            Hint("minus_p", "the inverse of M has position -R'p, not -p"),
            Hint("only_turned", "M shifts as well: seen from another point, v is another one"),
            Hint("only_shifted", "M turns as well: w changes too where the tool frame is turned"),
        ),
    ),
    FROM_ANOTHER_FRAME,
]
