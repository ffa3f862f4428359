"""The exercise of notebook 06 about going on: which solution of the next pose belongs to the branch."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Edge, Exercise, Hint

TURN = 2 * np.pi


def _drawn(n=None, k=None, turns=1, past=True):
    """Draws the last configuration and solutions of the next pose, as they come: within half a turn.

    n joints, k solutions; the last configuration is up to `turns` away. `past`: a joint passes half a turn,
    and as numbers another solution lies nearer.
    """

    def draw(rng):
        joints, rows = n or int(rng.integers(3, 7)), k or int(rng.integers(3, 8))
        last = rng.uniform(-2.5, 2.5, joints)
        step = rng.uniform(0.02, 0.12, joints) * rng.choice([-1, 1], joints)
        j, side = int(rng.integers(joints)), rng.choice([-1, 1])
        if past:
            last[j], step[j] = side * (np.pi + rng.uniform(-0.05, 0.05)), side * rng.uniform(0.06, 0.12)
        others = last + rng.uniform(1.6, 4.6, (rows, joints)) * rng.choice([-1, 1], (rows, joints))
        if past and joints > 1:  # near as numbers, not as an arm
            others[:, j] = last[j] - side * rng.uniform(0.1, 0.3, rows)
        others[0] = last + step
        whole = TURN * np.rint(rng.uniform(-turns, turns, joints))
        return last + whole, rng.permutation(_wrapped(others))

    return draw


def _wrapped(angles):
    return np.remainder(angles + np.pi, TURN) - np.pi


def _balanced(rng):
    """In the wrong solutions some joints are as far ahead as others are behind: added up, that is nothing."""
    last = rng.uniform(-1.5, 1.5, 4)
    others = last + rng.uniform(0.5, 1.4, (3, 1)) * rng.permutation([1, 1, -1, -1])
    return last, rng.permutation([*others, last + rng.uniform(0.05, 0.12, 4)])


def _near_in_one_joint(rng):
    """Wrong solutions that leave one joint where it is and are far in the others; one is as long as last."""
    last, step = (rng.uniform(*size, 4) * rng.choice([-1, 1], 4) for size in ((0.5, 1.5), (0.05, 0.12)))
    others = last + rng.uniform(0.5, 1.4, (4, 4)) * rng.choice([-1, 1], (4, 4))
    np.fill_diagonal(others, last)
    return last, rng.permutation([*others, -last, last + step])


def _half_a_turn_away(rng):
    """Of the wrong solutions some joints are half a turn away, the others nearly where they were."""
    last = rng.uniform(-1.5, 1.5, 4)
    away = np.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 0], [1, 1, 1, 1]]) * np.pi
    others = last + away + rng.uniform(0.01, 0.03, (4, 4))
    return last, rng.permutation([*_wrapped(others), last + rng.uniform(0.05, 0.12, 4)])


def _whole(rng):
    """Whole numbers; 3 goes on to 2 pi - 3."""
    return [3, 0, -2], rng.permutation([[-3, 0, -2], [3, 2, 0], [1, 0, -2]])


def _each_its_own(rng):
    """Joints that are different numbers of turns away."""
    last, solutions = _drawn(4, 4, turns=0)(rng)
    return last + TURN * rng.permutation([-2, 0, 1, 3]), solutions


def _missed(args, value, right) -> str:
    """Is it a solution at all, the one that goes on, and by how many turns is a joint off?"""
    last, solutions = (np.asarray(x, float) for x in args)
    if value.shape != right.shape or not np.isfinite(value).all():
        return ""
    away = np.abs(_wrapped(solutions - value)).max(axis=1)
    if not away.min() < 1e-6:
        return "your angles are none of the solutions, whichever whole turns are added"
    mine, wanted = (int(np.argmin(np.abs(_wrapped(solutions - x)).max(axis=1))) for x in (value, right))
    if mine != wanted:
        far = [np.degrees(np.abs(_wrapped(solutions[k] - last)).max()) for k in (mine, wanted)]
        return (
            f"you go on with row {mine} (counted from 0), where a joint is {far[0]:.0f} deg away from last;"
            f" in row {wanted} none is more than {far[1]:.0f} deg away, whole turns aside"
        )
    turns = np.rint((value - right) / TURN).astype(int)
    j = int(np.argmax(np.abs(turns)))
    whole = f"{abs(turns[j])} whole turn{'s' if abs(turns[j]) > 1 else ''}"
    return f"row {mine} (counted from 0) is the one, but joint {j + 1} of yours is {whole} away"


NEXT_ON_BRANCH = Exercise(
    "next_on_branch(last, solutions)",
    points=2,
    draw=_drawn(),
    shape=(None,),
    unit="rad",
    samples=3,
    usual="where a joint passes half a turn",
    edges=(
        Edge("where no joint passes half a turn", _drawn(past=False, turns=0)),
        Edge("several turns away", _drawn(turns=4)),
        Edge("where each joint needs its own turns", _each_its_own),
        Edge("for a single solution", _drawn(k=1)),
        Edge("for one joint", _drawn(n=1, k=3, turns=2)),
        Edge("for as many solutions as joints", _drawn(5, 5)),
        Edge("where the differences of a wrong solution cancel", _balanced),
        Edge("where wrong solutions are near in one joint", _near_in_one_joint, 3),
        Edge("where wrong solutions are half a turn away", _half_a_turn_away, 2),
        Edge("for whole numbers", _whole),
    ),
    residual=_missed,
    hints=(
        Hint(
            "nothing_turned",
            "angles are compared as numbers: -179 and 181 degrees are one place of the joint. Add whole turns"
            " first, then look for the nearest",
        ),
        Hint(
            "not_turned",
            "the right solution, as it came: give it back with the whole turns, so that 3.1 goes on to 3.2",
        ),
        Hint(
            "nearest_first",
            "you choose before you turn: as numbers another solution may lie nearer. Add whole turns to all"
            " of them first",
        ),
        Hint("turned_away", "the turns go the other way: round (last - solutions), and add"),
        Hint("one_turn", "one turn up or down is not always enough: count them, (last - solutions) / (2 pi)"),
        Hint("rounded_down", "round to the nearest whole turn: rounding down leaves up to a turn"),
        Hint("mixed", "one row for all joints: yours takes each joint from another solution"),
        Hint(
            "first_row",
            "the first solution need not be the one that goes on (`norm` without axis=1, or `return` inside"
            " the loop?)",
        ),
        Hint("last_row", "you end with the last solution: is the smallest distance remembered?"),
        Hint("joints_alike", "every joint may need its own number of turns; yours turns all joints alike"),
    ),
)
