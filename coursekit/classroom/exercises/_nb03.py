"""By how much a wrong answer of notebook 03 misses, in the terms of the arm."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises._arm import (
    deg,
    degrees_between,
    hand,
    mm,
    turn,
    wrapped,
    wrist,
    wrist_in_plane,
)
from coursekit.classroom.exercises._nb03_draws import turned

NONE = 1e-5  # metres, degrees: a row that is nearer than this is right


def seen_from_the_tool(args, value, right):
    T_sd, tool = args
    if not np.isfinite(value).all():
        return ""
    mine = 1000 * T_sd[:3, :3].T @ (value - T_sd[:3, 3])
    seen = ", ".join(f"{x + 0.0:.4g}" for x in np.round(mine, 1))
    return f"seen from the tool frame, your point is at ({seen}) mm; P is at ({-1000 * tool:.4g}, 0, 0) mm"


def turned_too_far(args, value, right):
    gap = abs(np.degrees(wrapped(value - right)))
    return f"seen along k, x ends {deg(gap)} away from y if it turns by your angle" if gap > NONE else ""


def misses_the_wrist_centre(args, value, right):
    r, z, lengths = args
    out, up = wrist_in_plane(*value.T, lengths)
    return _two_rows(
        np.hypot(out - r, lengths[1] + up - z),
        mm,
        value,
        "put back into the arm, {} the wrist centre by {}",
        "both rows bring P to (r, z), but they are one solution: the other elbow is missing",
    )


def misses_the_rotation(args, value, right):
    return _two_rows(
        np.array([degrees_between(wrist(row), args[0]) for row in value]),
        deg,
        value,
        "put back into Rx(-t4) Ry(t5) Rx(-t6), {} R by {}",
        "both rows give R, but they are one solution: the other bend of the wrist is missing",
    )


def _two_rows(gaps, unit, value, missing, same):
    if not np.isfinite(gaps).all():
        return ""
    if gaps.max() < NONE:
        return same if np.abs(wrapped(value[0] - value[1])).max() < NONE else ""
    if gaps.min() < NONE:
        k = int(gaps.argmax())
        return missing.format(f"row {k} misses", unit(gaps[k])) + f"; row {1 - k} is right there"
    if abs(gaps[0] - gaps[1]) < 0.01 * gaps.max():
        return missing.format("each of your rows misses", unit(gaps[0]))
    return missing.format("your rows miss", f"{unit(gaps[0])} and {unit(gaps[1])}")


def joints_that_miss(args, value, right):
    """Do joints 1 to 3 bring P to its place, and do joints 4 to 6 turn the hand as they should?"""
    T, lengths, tool = args
    if not np.isfinite(value).all():
        return ""
    P = T[:3, 3] - tool * T[:3, 0]
    gaps, turns = [], []
    for theta in value:
        out, up = wrist_in_plane(theta[1], theta[2], lengths)
        gaps.append(np.linalg.norm(turn(2, -theta[0]) @ [out, 0, lengths[1] + up] - P))
        turns.append(degrees_between(hand(theta), T[:3, :3]))
    gaps, turns = np.array(gaps), np.array(turns)
    fine = (gaps < NONE) & (turns < NONE)
    if fine.all():
        return "each of your rows reaches T_sd, but some stand twice" if _repeated(value) else ""
    told = f"{_rows(fine.sum(), len(fine))} T_sd; " if fine.any() else "put through the arm: "
    k = int(gaps.argmax())
    if gaps[k] < NONE:
        k = int(turns.argmax())
        return told + f"joints 1 to 3 bring P to its place, joints 4 to 6 leave the hand {deg(turns[k])} off"
    if turns.max() < NONE:
        return told + f"the hand is turned as it should be, but row {k} brings P {mm(gaps[k])} off"
    return told + f"joints 1 to 3 of row {k} bring P {mm(gaps[k])} off: look at them first"


def _rows(some, all_):
    return f"put through the arm, {some} of your {all_} rows {'reaches' if some == 1 else 'reach'}"


def _repeated(rows):
    gap = np.abs(wrapped(rows[:, None] - rows[None])).max(axis=-1)
    return bool(np.any(gap[np.triu_indices(len(rows), 1)] < NONE))


def moves_the_tool_otherwise(args, value, right):
    J, mine, best = args[0], np.linalg.norm(value), np.linalg.norm(right)
    gap = J @ (value - right)
    turned, shifted = np.degrees(np.linalg.norm(gap[:3])), np.linalg.norm(gap[3:])
    if not np.isfinite(gap).all():
        return ""
    if turned < NONE and shifted < NONE:
        return (
            f"your step moves the tool as Newton's does, but it is not the shortest: "
            f"its length is {mine:.3g}, Newton's is {best:.3g}"
        )
    if turned < NONE:
        return f"J_b times your step has the right omega, but v is {mm(shifted)} off"
    if shifted < NONE:
        return f"J_b times your step has the right v, but omega is {deg(turned)} off"
    return (
        f"J_b times your step should be as near to e as it can be: it is {deg(turned)} and {mm(shifted)} off"
    )


def at_another_distance(args, value, right):
    k, x, y, d = args
    gaps = np.array([np.linalg.norm(y - turned(k, x, t)) - d for t in value])
    if not np.isfinite(gaps).all():
        return ""
    if np.abs(gaps).max() < NONE:
        return "both angles give the distance, but they are one solution: the other side of y is missing"
    worst = gaps[np.abs(gaps).argmax()]
    other = "; the other one is right" if np.abs(gaps).min() < NONE else ""
    return f"turned by one of your angles, x is {mm(abs(worst))} too {'far' if worst > 0 else 'near'}{other}"


def two_turns_that_miss(args, value, right):
    k1, k2, x, y = args
    ends = np.array([turned(k1, turned(k2, x, t2), t1) for t1, t2 in value])
    return _two_rows(
        np.linalg.norm(ends - y, axis=1),
        mm,
        value,
        "put in, {} y by {}",
        "both rows bring x to y, but they are one solution: the other one is missing",
    )


def carries_the_tool_otherwise(args, value, right):
    """The velocities in the room, where one can see them."""
    _, _, _, T = args
    if not np.isfinite(value).all():
        return ""
    turns, moves = (T[:3, :3] @ (value - right)[half] for half in (slice(3), slice(3, 6)))
    told = []
    if np.linalg.norm(turns) > NONE:
        told.append(f"omega by {np.linalg.norm(turns):.3g} rad/s")
    if np.linalg.norm(moves) > NONE:
        told.append(f"the velocity of the tool point by {mm(np.linalg.norm(moves))}/s")
    return f"at 1 rad/s (1 m/s for a slide) your column misses {' and '.join(told)}" if told else ""


def seen_in_space(args, value):
    """What the joint does to the tool: its angular velocity and the velocity of the tool point."""
    T = args[3]
    p, R = T[:3, 3], T[:3, :3]
    return {"frames": [T], "lines": [(args[2], args[1])], "arrows": [(p, R @ value[:3]), (p, R @ value[3:])]}
