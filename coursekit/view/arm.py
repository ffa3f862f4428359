"""A robot arm drawn from its screws alone: `solid`, the painted parts, and `skeleton`, the lines behind them.

Each link is a list of parts in the space frame at theta = 0. Three kinds of housings stand on the axes: a
drum where the arm bends, a collar where it twists, a sleeve where it slides. Links are lofts between them.
Whatever turns against its neighbour is round about their axis, so a moving joint never opens a gap.
"""

import numpy as np

from coursekit.kinematics.robot import Robot

from .chain import chain
from .paint import Part
from .shapes import ball, bevelled, frame_along, loft

ROUND, SQUARE = 2.0, 3.2  # squareness of a cross-section at a collar and at a drum


def solid(robot: Robot) -> list[list[Part]]:
    """Painted parts: n + 1 lists of Part, the base first.

    >>> from coursekit import robots
    >>> len(solid(robots.planar_2r()))
    3
    """
    arm = chain(robot)
    first = arm.joints[0]
    links = [_base(arm)]
    for before, after in zip(arm.joints[:-1], arm.joints[1:], strict=True):
        links.append(_start(before) + _between(before, after) + _end(after, _arrives_sideways(before, after)))
    links.append(_start(arm.joints[-1]) + _flange(arm))
    links[0] += _end(first, False)
    return links


# --- the base and the tool end ---


def _base(arm):
    first = arm.joints[0]
    r, height = first.radius, float((first.split - arm.foot) @ arm.up)
    thick = min(0.25 * r, 0.4 * height)
    stand = frame_along(arm.up, arm.foot)
    foot = loft([(0, 0, 0, 1.42 * r, 1.42 * r, 7), (thick, 0, 0, 1.42 * r, 1.42 * r, 7)], steps=1)
    waist = min(0.9 * r, 0.25 * height)
    body = [(0, 0.5 * thick), (1.22 * r, 0.5 * thick), (1.2 * r, thick), (1.06 * r, thick + waist)]
    body += [(0.98 * r, height), (0.94 * r, height + 0.03 * r), (0, height + 0.03 * r)]
    return [Part(foot, "dark", stand), Part(body, "dark", stand)]


def _flange(arm):
    """From the last joint to the tool point: a short body and a metal disc, or a bar with a round end."""
    last = arm.joints[-1]
    r, aside = last.radius, np.linalg.norm(np.cross(arm.tool - last.leave, last.along))
    if last.bends or aside > 1.2 * r:  # the tool is away from the last axis
        tip = frame_along(last.along, arm.tool)
        bar = _loft(last.split if last.bends else last.leave, last, arm.tool, last, end_scale=0.8)
        drum = [Part(bevelled(0.85 * r, -0.75 * r, 0.75 * r, 0.15 * r), "body", tip)]
        disc = [Part(bevelled(0.55 * r, -0.85 * r, 0.85 * r, 0.08 * r), "metal", tip)]
        return bar + drum + disc
    length = float((last.leave - last.split) @ last.along)
    thick = min(0.3 * r, 0.35 * length)
    at = frame_along(last.along, last.split)
    body = bevelled(0.82 * r, 0.12 * r, length - 0.5 * thick, 0.1 * r)
    disc = bevelled(0.95 * r, length - thick, length, 0.2 * thick)
    return [Part(body, "dark", at), Part(disc, "metal", at)]


# --- housings ---


def _end(joint, sideways):
    """What link i - 1 carries of joint i."""
    r = joint.radius
    here = frame_along(joint.along, joint.split)
    if joint.travel is not None:
        sleeve = bevelled(1.15 * r, -1.3 * r, 1.3 * r, 0.2 * r)
        lip = bevelled(0.85 * r, -1.38 * r, 1.38 * r, 0.06 * r)
        return [Part(sleeve, "body", here), Part(lip, "dark", here)]
    if joint.bends:
        return _drum(here, r, -r, r)
    ring = [Part(bevelled(0.92 * _collar(joint), -0.03 * r, 0.14 * r, 0.02 * r), "metal", here)]
    if not sideways:
        return ring
    back = float((joint.enter - joint.split) @ joint.along) - r
    return ring + _drum(here, _collar(joint), back, 0.0, caps=(True, False))


def _start(joint):
    """What link i carries of joint i, before its own body begins."""
    r = joint.radius
    if joint.travel is None:
        return []
    low, high = joint.travel
    if np.isnan(high):
        low, high = 0.0, 4 * r + joint.length
    out = max(joint.length, 1.4 * r)
    rod = bevelled(0.55 * r, -max(high, 0) - 1.6 * r, max(out, out - low), 0.08 * r)
    return [Part(rod, "metal", frame_along(joint.along, joint.enter))]


def _drum(here, r, low, high, caps=(True, True)):
    """A bevelled cylinder about the axis from low to high, with a dark cover sunk into each open side."""
    bevel = 0.16 * r
    parts = [Part(bevelled(r, low, high, bevel), "body", here)]
    lid = (low - 0.06 * r if caps[0] else low + bevel, high + 0.06 * r if caps[1] else high - bevel)
    return parts + [Part(bevelled(0.68 * r, *lid, 0.05 * r), "dark", here)]


def _collar(joint):
    """Radius of the round section where a joint twists."""
    return 0.8 * joint.radius


# --- the bodies of links ---


def _arrives_sideways(before, after):
    """Whether link i reaches a twisting joint i + 1 from the side, so that it needs a drum there."""
    if after.bends or after.travel is not None:
        return False
    gap = np.linalg.norm(after.enter - _departure(before))
    if gap > 1.4 * max(before.radius, after.radius):
        return abs((after.enter - _departure(before)) @ after.along) < 0.7 * gap
    return not before.bends and abs(before.along @ after.along) < 0.7


def _departure(joint):
    return joint.split if joint.bends else joint.leave


def _between(before, after):
    """The body of link i, from joint i to joint i + 1."""
    sideways = _arrives_sideways(before, after)
    enters = not after.bends and (sideways or after.travel is not None)
    goal = after.enter if enters else after.split
    gap = np.linalg.norm(goal - before.leave)
    near = not after.bends or gap < 1.5 * max(after.radius, 1e-9)
    if before.bends or (before.travel is None and not sideways and near):
        return _loft(before.split, before, goal, after)
    r, here = _collar(before), frame_along(before.along, before.split)
    out = float((before.leave - before.split) @ before.along)
    if before.travel is not None:
        here, out = frame_along(before.along, before.leave), 0.0
        corner = _drum(here, r, -0.8 * r, 0.8 * r)
    else:
        corner = _drum(here, r, 0.13 * r, out + r, caps=(False, True))
    if gap > 0.5 * after.radius:
        corner += _loft(before.leave, before, goal, after, in_drum=True)
    return corner


def _loft(start, a, goal, b, in_drum=False, end_scale=1.0):
    """A body from `start` on joint a to `goal` on joint b.

    A collar asks for round sections across its axis, so there all sections are parallel and their centres
    shift; between two drums they stand across the straight line.
    """
    step = goal - start
    if np.linalg.norm(step) < 1e-9:
        return []
    from_collar = not a.bends and a.travel is None and not in_drum
    to_collar = not b.bends and b.travel is None and np.allclose(goal, b.split)
    z = step / np.linalg.norm(step)
    if from_collar and step @ a.along > 0.6 * np.linalg.norm(step):
        z = a.along
    elif to_collar and step @ b.along > 0.6 * np.linalg.norm(step):
        z = b.along
    side = b.along if from_collar and not to_collar else a.along
    T = frame_along(z, start, side)
    x, y, length = T[:3, :3].T @ step
    first = _section(a, from_collar, T)
    last = _section(b, to_collar, T) * np.array([end_scale, end_scale, 1])
    lift = 0.13 * a.radius if from_collar else 0.0
    rows = [[lift, 0, 0, *first], [length, x, y, *last]]
    if from_collar and not to_collar:
        rows.insert(1, [lift + 0.3 * (length - lift), 0.1 * x, 0.1 * y, *first])
    elif length > 4 * (a.radius + b.radius):
        waist = 0.9 * (first + last) / 2
        waist[2] = SQUARE
        rows.insert(1, [0.5 * length, 0.5 * x, 0.5 * y, *waist])
    return [Part(loft(rows), "body", T)]


def _section(joint, collar, T):
    """Half widths and squareness where a body meets a joint: round at a collar, else within the drum."""
    if collar:
        r = _collar(joint)
        return np.array([r, r, ROUND])
    wide, narrow = 0.84 * joint.radius, 0.66 * joint.radius
    lies_along_x = abs(joint.along @ T[:3, 0]) > 0.7
    return np.array([narrow, wide, SQUARE] if lies_along_x else [wide, narrow, SQUARE])


# --- the skeleton ---


def skeleton(robot: Robot) -> list[list[Part]]:
    """The lines behind the paint: n + 1 lists of Part. Link i has axis i and the stick to axis i + 1."""
    arm = chain(robot)
    r = 0.004 * arm.size
    links = [_stick(arm.foot, arm.joints[0].enter, r)]
    for i, joint in enumerate(arm.joints):
        goal = arm.joints[i + 1].enter if i + 1 < robot.n else arm.tool
        reach = 2.2 * joint.radius
        low, high = joint.enter - (reach if i else 0) * joint.along, joint.leave + reach * joint.along
        # a rod that slides out takes the part along that lies in its sleeve at zero
        start = joint.enter - (joint.travel[1] if joint.travel and joint.travel[1] > 0 else 0) * joint.along
        parts = _dashes(low, high, 0.6 * r) + _stick(start, joint.leave, r) + _stick(joint.leave, goal, r)
        parts += [
            Part(ball(2 * r), "accent", frame_along([0, 0, 1], p), xray=0.7) for p in (joint.leave, goal)
        ]
        links.append(parts)
    return links


def _stick(a, b, r, color="bone"):
    length = np.linalg.norm(b - a)
    if length < 1e-9:
        return []
    rod = [(0, 0), (r, 0), (r, length), (0, length)]
    return [Part(rod, color, frame_along(b - a, a), glow=0.2, xray=0.75, casts=False, segments=10)]


def _dashes(a, b, r):
    """A dash-dotted line, as axes are drawn."""
    length, parts, at = np.linalg.norm(b - a), [], 0.0
    along = (b - a) / length
    while at < length:
        for dash, gap in ((9 * r, 4 * r), (2 * r, 4 * r)):
            if at + dash <= length:
                parts += _stick(a + at * along, a + (at + dash) * along, r, "axis")
            at += dash + gap
    return parts
