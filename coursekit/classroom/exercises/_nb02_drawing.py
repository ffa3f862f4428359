"""Exercises of notebook 02 from a drawing: joints of both kinds, a whole arm, another space frame."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._axes import NEAR, pose_gap, screw_gap, screws_gap

KINDS = ("revolute", "prismatic")


def _direction(rng):
    w = rng.normal(size=3)
    return w / np.linalg.norm(w)


def _point(rng):
    return rng.uniform(0.2, 1.0, 3) * rng.choice([-1, 1], 3)


# ---- one joint of either kind


def _joint(kind, direction=None, point=None):
    def draw(rng):
        w = rng.uniform(0.4, 2.5) * _direction(rng) if direction is None else np.array(direction)
        return kind, w, _point(rng) if point is None else np.array(point)

    return draw


def _joint_of_length(kind, length):
    return lambda rng: (kind, length * _direction(rng), _point(rng))


def _any_joint(rng):
    return _joint(rng.choice(KINDS))(rng)


JOINTS = (
    Edge("for a hinge", _joint("revolute"), 2),
    Edge("for a slide", _joint("prismatic"), 2),
    *(Edge("for a very short w", _joint_of_length(kind, 1e-4)) for kind in KINDS),
    *(Edge("for a w of nearly length 1", _joint_of_length(kind, 1.00002)) for kind in KINDS),
    Edge("for a slide through the origin", _joint("prismatic", point=(0.0, 0.0, 0.0))),
    Edge("for a hinge through the origin", _joint("revolute", point=(0.0, 0.0, 0.0))),
    Edge("for joint 3 of the SCARA", _joint("prismatic", (0.0, 0.0, -1.0), (0.6, 0.0, 0.387))),
    Edge("for whole numbers", _joint("prismatic", (0, 3, -4), (1, -2, 3))),
    Edge("for whole numbers", _joint("revolute", (0, 3, -4), (1, -2, 3))),
)


def _joint_gap(args, S, right):
    return screw_gap(S, right, "your joint")


def _anywhere(f, args, S):
    """A slide has a direction and no place; a hinge may be told by any point of its axis."""
    kind, w, q = args
    moved = q + 0.3 * w if kind == "revolute" else q + np.array([0.1, 0.2, 0.3])
    return bool(np.allclose(f(kind, w, moved), S, atol=1e-9))


JOINT_SCREW = Exercise(
    "joint_screw(kind, w, q)",
    look=looks.screws,
    points=2,
    draw=_any_joint,
    shape=(6,),
    edges=JOINTS,
    usual="for other joints",
    blocks=(Block("omega", np.s_[:3]), Block("v", np.s_[3:])),
    residual=_joint_gap,
    unit="m",
    samples=3,
    laws=(("a slide has no place: another q must give the same screw", _anywhere),),
    hints=(
        Hint("always_hinge", "a slide does not turn: its omega is 0 and its v is the direction"),
        Hint("v_first", "rows are (omega; v): the direction of a slide goes into the lower half"),
        Hint("slide_on_top", "the direction of a slide stands below, as v: nothing turns, so omega is 0"),
        Hint("slide_not_unit", "the direction of a slide has length 1, as omega has for a hinge"),
        Hint("slide_with_lever", "nothing turns in a slide: no -w x q; its v is the direction alone"),
        Hint("both_halves", "a slide has omega = 0: the direction stands in the lower half only"),
        Hint("slide_of_q", "a slide has a direction and no place: its v is along w, whatever q is"),
    ),
)


# ---- a whole arm: the telescope of the drawing


def _lengths(rng):
    """A to E of a telescope arm that was never built."""
    return (rng.uniform([0.1, 0.4, 0.05, 0.5, 0.1], [0.3, 0.8, 0.2, 1.0, 0.3]),)


def _without(k):
    return lambda rng: (_lengths(rng)[0] * (np.arange(5) != k),)


LENGTHS = (
    Edge("for the lengths of the figure", lambda rng: (np.array([0.15, 0.6, 0.12, 0.7, 0.2]),)),
    *(Edge(f"where {name} is zero", _without(k)) for k, name in enumerate("ABCDE")),
    Edge("for whole numbers", lambda rng: (np.array([1, 6, 2, 8, 3]),)),
)


def _arm_gap(args, answer, right):
    (M, S), (M0, S0) = answer, right
    if np.abs(M - M0).max() > NEAR:
        return pose_gap(M, M0, "tool frame")
    return screws_gap(S, S0)


def _meets_the_wrist(f, args, answer):
    """Axes 4 and 5 meet, and the tool stands E below that point."""
    A, B, C, D, E = args[0]
    M, _ = answer
    return bool(np.allclose(M[:3, 3] - [A + D, 0, B + C], [0, 0, -E], atol=1e-9))


def _arm_seen(args, answer):
    M, S = answer
    return {"frames": [np.reshape(M, (4, 4))], **looks.screws(args, S)}


HOME_AND_SCREWS = Exercise(
    "home_and_screws(lengths)",
    look=_arm_seen,
    points=4,
    draw=_lengths,
    shape=((4, 4), (6, 5)),
    compare=("rotation", "close"),
    edges=LENGTHS,
    usual="for other lengths",
    blocks=(
        Block("the rotation of M", np.s_[:3, :3], part=0),
        Block("the position of M", np.s_[:3, 3], part=0),
        *(Block(f"the screw of joint {k + 1}", np.s_[:, k], part=1) for k in range(5)),
    ),
    residual=_arm_gap,
    unit="m",
    samples=3,
    laws=(("the tool stands E below the point where axes 4 and 5 meet", _meets_the_wrist),),
    hints=(
        Hint("not_turned", "the tool frame is turned: its z points down, so its y points to the other side"),
        Hint("tool_above", "the tool hangs E below the wrist, not above it"),
        Hint("at_the_wrist", "that is the wrist, where axes 4 and 5 meet: the tool stands E below it"),
        Hint("into_the_page", "a dot is the tip of an arrow: axis 2 comes out of the page, along -y"),
        Hint("all_hinges", "joint 3 slides: its omega is 0, its v is the direction of the double arrow"),
        Hint("without_C", "C is missing: the telescope runs C above axis 2"),
        Hint("plus", "the lower half of a hinge is -w x q; yours has the other sign"),
    ),
)


# ---- the same arm in another space frame


def _pose(rng, turn=True, shift=True):
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, y, np.cross(x, y)]) if turn else np.eye(3)
    T[:3, 3] = _point(rng) if shift else 0
    return T


def _screws(rng, n=None):
    found = []
    for _ in range(n or int(rng.integers(2, 6))):
        w, q = _direction(rng), _point(rng)
        slide = rng.random() < 0.25
        found.append(np.concatenate([0 * w, w] if slide else [w, np.cross(q, w)]))
    return np.column_stack(found)


def _arm(turn=True, shift=True, n=None):
    return lambda rng: (_screws(rng, n), _pose(rng), _pose(rng, turn, shift))


def _with_pitch(rng):
    S, M, T = _arm(n=3)(rng)
    return np.vstack([S[:3], S[3:] + rng.uniform(0.05, 0.3, 3) * S[:3]]), M, T


def _kr6_on_a_table(rng):
    from coursekit import robots

    kr6, T = robots.kuka_kr6(), np.eye(4)
    T[2, 3] = 0.7
    return kr6.S, kr6.M, T


def _whole(rng):
    S = np.array([[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, -2, 0], [0, 0, 1], [0, 1, 0]])
    M = np.array([[0, -1, 0, 1], [1, 0, 0, -2], [0, 0, 1, 3], [0, 0, 0, 1]])
    return S, M, np.array([[0, 0, 1, 0.5], [1, 0, 0, 0], [0, 1, 0, 1.5], [0, 0, 0, 1]])


FRAMES = (
    Edge("where the frame does not move", _arm(False, False)),
    Edge("where it is only shifted", _arm(turn=False)),
    Edge("where it is only turned", _arm(shift=False)),
    Edge("for an arm with one joint", _arm(n=1)),
    Edge("for screws with pitch", _with_pitch),
    Edge("for the KR6 on a table", _kr6_on_a_table),
    Edge("for whole numbers", _whole),
)


def _frame_gap(args, answer, right):
    (S, M), (S0, M0) = answer, right
    return pose_gap(M, M0, "tool frame") or screws_gap(S, S0, " as seen from the new frame")


def _there_and_back(f, args, answer):
    S, M, T = args
    back = f(*answer, np.linalg.inv(T))
    return bool(np.allclose(back[0], S, atol=1e-9) and np.allclose(back[1], M, atol=1e-9))


def _frame_seen(args, answer):
    S, M = answer
    return {"frames": [np.reshape(M, (4, 4))], **looks.screws(args, S)}


FROM_ANOTHER_FRAME = Exercise(
    "from_another_frame(S, M, T)",
    look=_frame_seen,
    points=2,
    draw=_arm(),
    shape=((6, None), (4, 4)),
    compare=("close", "rotation"),
    edges=FRAMES,
    usual="for other frames",
    blocks=(Block("S", ..., part=0), Block("M", ..., part=1)),
    residual=_frame_gap,
    unit="m",
    samples=3,
    laws=(("back to the old frame, S and M must be the old ones", _there_and_back),),
    hints=(
        Hint("only_M", "the axes are seen from the new frame, too: S changes as well"),
        Hint("only_S", "M is the pose of the tool in the space frame: it changes with that frame"),
        Hint("inverse", "T maps from the old frame to the new one: no inverse is needed"),
        Hint("M_right", "T is the pose of the old frame in the new one: it stands on the left of M"),
        Hint("moved_as_body", "Ad(T) maps S as it is; Ad(T^-1) is for the way back"),
        Hint("body", "these are body screws, seen from the tool: here the new space frame looks at S"),
        Hint("only_turned", "the screws move as well as turn: Ad(T) has [p] R in its lower left block"),
        Hint("M_shifted", "M turns with the frame, too: T M, not M with p added"),
    ),
)
