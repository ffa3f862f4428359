"""How far a pose, a screw or an axis misses the right one, in millimetres and degrees.

Every function returns a clause about "your ..." or '' where nothing can be said, and takes any numbers.
"""

from __future__ import annotations

import numpy as np

NEAR = 1e-6  # less than this is rounding: metres, radians


def mm(length: float | np.floating) -> str:
    """ "83 mm", "0.4 mm", of a length in metres: as much as one can picture."""
    length = 1000 * abs(float(length)) if abs(float(length)) > NEAR else 0.0
    if length == 0:
        return "0 mm"
    return f"{length:.0f} mm" if length >= 10 else f"{length:.2g} mm"


def deg(angle: float) -> str:
    """ "34 deg", of an angle in radians."""
    angle = float(np.degrees(abs(angle)))
    return f"{angle:.0f} deg" if angle >= 10 else f"{angle:.2g} deg"


def between(a: np.ndarray, b: np.ndarray) -> float:
    """The angle between two vectors, 0 to pi."""
    return float(2 * np.arctan2(np.linalg.norm(_unit(a) - _unit(b)), np.linalg.norm(_unit(a) + _unit(b))))


def is_rotation(R: np.ndarray) -> bool:
    return bool(np.allclose(R.T @ R, np.eye(3), atol=NEAR) and np.linalg.det(R) > 0)


def turn(R: np.ndarray) -> float:
    """By how much a rotation turns, 0 to pi."""
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    return float(np.arctan2(np.linalg.norm(axis), np.trace(R) - 1))


def pose_gap(mine: np.ndarray, right: np.ndarray, what: str) -> str:
    """ "your tool stands 41 mm from the right place and is turned by 90 deg against the right one"."""
    if not np.isfinite(mine).all():
        return ""
    shift = np.linalg.norm(mine[:3, 3] - right[:3, 3])
    angle = turn(right[:3, :3].T @ mine[:3, :3]) if is_rotation(mine[:3, :3]) else None
    if angle is None:  # no rotation: that is said by itself
        return f"your {what} stands {mm(shift)} from the right place" if shift > NEAR else ""
    if angle <= NEAR:
        return (
            f"your {what} is turned rightly, but stands {mm(shift)} from the right place"
            if shift > NEAR
            else ""
        )
    turned = f"turned by {deg(angle)} against the right one"
    if shift <= NEAR:
        return f"your {what} stands in the right place, but is {turned}"
    return f"your {what} stands {mm(shift)} from the right place and is {turned}"


def screw_gap(mine: np.ndarray, right: np.ndarray, mine_is: str) -> str:
    """ "your axis 2 lies 83 mm beside the right one"; `mine_is` begins the clause: "your axis 2"."""
    if not np.isfinite(mine).all() or np.allclose(mine, right, rtol=0, atol=NEAR):
        return ""
    (w, v), (w0, v0) = (mine[:3], mine[3:]), (right[:3], right[3:])
    if not w0.any():
        return _slide_gap(w, v, v0, mine_is)
    length = np.linalg.norm(w)
    if length < NEAR:
        return f"{mine_is} has omega = 0 as a slide has, but it is a hinge"
    if abs(length - 1) > NEAR:
        return f"{mine_is} has an omega of length {length:.3g}, not 1"
    if (angle := between(w, w0)) > NEAR:
        return f"{mine_is} points {deg(angle)} away from the right direction"
    pitch, pitch0 = w @ v, w0 @ v0
    if abs(pitch - pitch0) > NEAR and abs(pitch0) <= NEAR:
        return f"{mine_is} slides by {mm(pitch)} along itself in each radian, which a hinge does not"
    if (beside := np.linalg.norm(np.cross(w, v) - np.cross(w0, v0))) > NEAR:
        return f"{mine_is} has the right direction, but lies {mm(beside)} beside the right one"
    return f"{mine_is} is the right line, but slides {pitch:.3g} m in each radian, not {pitch0:.3g} m"


def _slide_gap(w: np.ndarray, v: np.ndarray, v0: np.ndarray, mine_is: str) -> str:
    if w.any():
        return f"{mine_is} has an omega that is not zero, but it is a slide"
    length, length0 = np.linalg.norm(v), np.linalg.norm(v0)
    if abs(length - length0) > NEAR:
        return f"{mine_is}, a slide, has a v of length {length:.3g}, not {length0:.3g}"
    return f"{mine_is}, a slide, points {deg(between(v, v0))} away from the right direction"


def screws_gap(mine: np.ndarray, right: np.ndarray, seen: str = "") -> str:
    """The first of the screws (6, n) that misses."""
    if mine.shape != right.shape:
        return f"the arm has {right.shape[1]} joints, so there are as many columns; yours are {mine.shape[1]}"
    for k, (a, b) in enumerate(zip(mine.T, right.T, strict=True), 1):
        if text := screw_gap(a, b, f"your axis {k}{seen}"):
            return text
    return ""


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)
