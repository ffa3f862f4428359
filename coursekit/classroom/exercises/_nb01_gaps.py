"""How far a wrong answer of notebook 01 misses."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises._axes import (
    NEAR,
    between,
    deg,
    is_rotation,
    mm,
    pose_gap,
    screws_gap,
    turn,
)


def _mm(length):
    return f"{1000 * length + 0.0:.4g} mm"


def _axes_gap(T, right, names):
    for k, what in names:
        if (angle := between(T[:3, k], right[:3, k])) > NEAR:
            return f"{what}; yours points {deg(angle)} away from there"
    return ""


def dh_gap(args, T, right):
    a, alpha, d, theta = args
    p, far = T[:3, 3], np.hypot(*T[:2, 3])
    if abs(p[2] - d) > NEAR:
        return f"the new frame stands d = {_mm(d)} up the old z axis; yours stands {_mm(p[2])} up"
    if abs(far - abs(a)) > NEAR:
        return f"the new frame stands a = {_mm(a)} from the old z axis; yours stands {_mm(far)} from it"
    if (gap := np.linalg.norm(p - right[:3, 3])) > NEAR:
        return (
            "your frame is at the right distance from the old z axis and at the right height, but on another"
            f" side of it: {mm(gap)} from the right place"
        )
    return _axes_gap(
        T,
        right,
        (
            (
                0,
                f"the new x axis is the old one, turned by theta = {np.degrees(theta):.0f} deg"
                f" about the old z",
            ),
            (
                2,
                f"the new z axis is the old one, tilted by alpha = {np.degrees(alpha):.0f} deg"
                f" about the new x",
            ),
            (1, "the new y axis is perpendicular to the new x and the new z"),
        ),
    )


def mdh_gap(args, T, right):
    a, alpha, d, theta = args
    p = T[:3, 3]
    if abs(p[0] - a) > NEAR:
        return f"the new frame stands a = {_mm(a)} along the old x axis; yours stands {_mm(p[0])} along it"
    along = p @ right[:3, 2]
    if abs(along - d) > NEAR:
        return f"the new frame stands d = {_mm(d)} along its own z axis; yours stands {_mm(along)} along it"
    if (gap := np.linalg.norm(p - right[:3, 3])) > NEAR:
        return f"d leads along the new z axis alone; your frame stands {mm(gap)} beside it"
    return _axes_gap(
        T,
        right,
        (
            (
                2,
                f"the new z axis is the old one, tilted by alpha = {np.degrees(alpha):.0f} deg"
                f" about the old x",
            ),
            (
                0,
                f"the new x axis is the old one, turned by theta = {np.degrees(theta):.0f} deg"
                f" about the new z",
            ),
            (1, "the new y axis is perpendicular to the new x and the new z"),
        ),
    )


def tool_gap(args, T, right):
    return pose_gap(T, right, "tool")


def motion_gap(args, T, right):
    """Where a point of the axis lands, then how far the body turns."""
    S, theta = args
    (w, v), R, p = (S[:3], S[3:]), T[:3, :3], T[:3, 3]
    turned = turn(R) if is_rotation(R) else np.nan
    if not w.any():
        if turned > NEAR:
            return f"a slide turns nothing; yours turns by {deg(turned)}"
        if (gap := np.linalg.norm(p - theta * v)) > NEAR:
            goes = f"this slide goes {_mm(theta)} along v"
            return f"{goes}; yours ends {mm(gap)} from there" if p.any() else f"{goes}; yours does not move"
        return ""
    q, slides = np.cross(w, v), theta * (w @ v)
    if (gap := np.linalg.norm(R @ q + p - q - slides * w)) > NEAR:
        if abs(slides) <= NEAR:
            return f"a point of the axis must stay where it is; yours is carried {mm(gap)} away"
        return f"a point of the axis must slide {mm(slides)} along the axis; yours ends {mm(gap)} from there"
    if (angle := turn(right[:3, :3].T @ R) if is_rotation(R) else 0) > NEAR:
        return f"the axis is where it should be, but the turn about it is {deg(angle)} away from theta"
    return ""


def axes_gap(args, S, right):
    return screws_gap(S, right)
