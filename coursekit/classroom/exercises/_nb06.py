"""Notebook 06: by how much a wrong answer misses, in words of the notebook."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises._nb05 import degrees_between

SMALL = 1e-6


def frame_missed(args, value, right) -> str:
    """The first frame that is wrong: which axis of it leads where?"""
    points = args[0]
    if value.shape != right.shape:
        return f"your answer has {len(value)} poses for {len(points)} points"
    i = int(np.argmax(np.abs(value - right).max(axis=(1, 2)) > SMALL))
    mine, true = value[i], right[i]
    where = "at the last point" if i == len(points) - 1 else f"at point {i} (counted from 0)"
    if not np.isfinite(mine).all():
        return ""
    beside = np.linalg.norm(mine[:3, 3] - true[:3, 3])
    if beside > SMALL:
        return f"{where} your frame stands {1000 * beside:.3g} mm beside the point"
    meant = ("the outward normal", "the direction of motion", "x cross y")
    for k, (name, wanted) in enumerate(zip("xyz", meant, strict=True)):
        length, turned = np.linalg.norm(mine[:3, k]), degrees_between(mine[:3, k], true[:3, k])
        if abs(length - 1) > SMALL:
            return f"{where} your {name} has length {length:.3g}; an axis has length 1"
        if turned > 1e-3:
            return f"{where} your {name} stands {_degrees(turned)} away from {wanted}"
    return ""


def _degrees(angle: float) -> str:
    return f"{angle:.0f} deg" if angle >= 2 else f"{angle:.2g} deg"


def attitude_missed(args, value, right) -> str:
    """Turn the tool by your quaternion: how far from R is it?"""
    length = np.linalg.norm(value)
    if not np.isfinite(length) or length == 0:
        return ""
    c = abs(value @ right) / length  # half the angle between the two attitudes
    away = 2 * np.degrees(np.arccos(np.clip(c, 0, 1)))
    if away < 1e-3:
        return f"your quaternion has length {length:.3g}: it is the right one, but for its length"
    told = f"the attitude of your quaternion is {_degrees(away)} away from R"
    if np.allclose(np.abs(value), np.abs(right), atol=1e-5):
        return f"the sizes of your components are right, a sign is not: {told}"
    return told


def _rebuilt(angles: np.ndarray) -> np.ndarray:
    (cz, cy, cx), (sz, sy, sx) = np.cos(angles), np.sin(angles)
    turns = [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]], [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]
    return np.linalg.multi_dot([*turns, [[1, 0, 0], [0, cx, -sx], [0, sx, cx]]])


def zyx_missed(args, value, right) -> str:
    """Which angles are off, and how far from R is the attitude that is rebuilt from them?"""
    if not np.isfinite(value).all():
        return ""
    cosine = (np.trace(_rebuilt(value).T @ args[0]) - 1) / 2
    away = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    if away < 1e-3:
        return "rebuilt from your angles, the attitude is right, but the pitch belongs between -90 and 90 deg"
    off = np.degrees((value - right + np.pi) % (2 * np.pi) - np.pi)
    told = [
        f"the {name} by {_degrees(abs(angle))}"
        for name, angle in zip(("yaw", "pitch", "roll"), off, strict=True)
        if abs(angle) > 1e-3
    ]
    return f"off: {', '.join(told)}. Rebuilt from your angles, the attitude is {_degrees(away)} away from R"


def configuration_missed(args, value, right) -> str:
    """One configuration that you judge the other way, and the joint that decides."""
    theta, lower, upper = (np.asarray(x, float) for x in args)
    if value.shape != right.shape:
        return f"your answer has {len(value)} entries for {len(theta)} configurations (rows of theta)"
    row = int(np.argmax(value != right))
    angles, low, high = (np.degrees(x) for x in (theta[row], lower, upper))
    first = low + np.mod(angles - low, 360)
    # lies on a limit but for rounding
    first = np.where((first > high + 1e-6) & (first - 360 > low - 1e-6), first - 360, first)
    limits = [f"{a:.4g} to {b:.4g} deg" for a, b in zip(low, high, strict=True)]
    if not right[row]:
        j = int(np.argmax(first > high + 1e-6))
        return (
            f"configuration {row} (counted from 0) is outside: no whole number of turns brings joint {j + 1}"
            f" from {angles[j]:.4g} deg into its limits, {limits[j]}"
        )
    turned = np.rint((first - angles) / 360)
    on_limit = np.isclose(first, low) | np.isclose(first, high)
    if np.any(turned):
        j = int(np.argmax(np.abs(turned)))
        return (
            f"configuration {row} (counted from 0) is inside: joint {j + 1} at {angles[j]:.4g} deg stands at "
            f"{first[j]:.4g} deg, too, within its limits, {limits[j]}"
        )
    if np.any(on_limit):
        j = int(np.argmax(on_limit))
        return (
            f"configuration {row} (counted from 0) is inside: joint {j + 1} at {angles[j]:.4g} deg is exactly"
            " on its limit, which counts as inside"
        )
    return (
        f"configuration {row} (counted from 0) is inside: all its angles lie within their limits as they are"
    )


def speed_missed(args, value, right) -> str:
    """At your speed: which joint turns too fast, or how much is left?"""
    q, points, v_max = (np.asarray(x, float) for x in args)
    if not np.isfinite(value) or value <= 0:
        return "a largest speed is a positive number"
    lengths = np.sqrt(np.sum((points[1:] - points[:-1]) ** 2, axis=1, keepdims=True))
    used = value * np.abs(q[1:] - q[:-1]) / lengths / v_max
    i, j = np.unravel_index(np.argmax(used), used.shape)
    where = f"joint {j + 1}, from point {i} to point {i + 1} (counted from 0)"
    if used[i, j] > 1:
        return f"at your speed a joint turns {used[i, j]:.3g} times as fast as it may: {where}"
    return f"at your speed no joint needs more than {100 * used[i, j]:.3g} % of its bound: most has {where}"


def _turned(beta: np.ndarray) -> np.ndarray:
    """The rotation of an angle-axis product."""
    theta = np.linalg.norm(beta)
    if theta == 0:
        return np.eye(3)
    K = np.cross(np.eye(3), beta / theta)
    return np.eye(3) + np.sin(theta) * K + (1 - np.cos(theta)) * K @ K


def _apart(A: np.ndarray, B: np.ndarray) -> float:
    """The angle between two attitudes, in degrees."""
    return 2 * np.degrees(np.arcsin(np.clip(np.linalg.norm(A - B) / np.sqrt(8), 0, 1)))


def turn_missed(args, value, right) -> str:
    """Turn the tool by your product: how far from R is it?"""
    if not np.isfinite(value).all():
        return ""
    away = _apart(_turned(value), np.asarray(args[0], float))
    mine, true = (np.degrees(np.linalg.norm(v)) for v in (value, right))
    if away < 1e-3:
        if mine > 181:
            return f"your turn leads to R by {mine:.0f} deg, the long way round; the short way is {true:.0f}"
        return ""
    told = f"turned by your product, the tool is {_degrees(away)} away from R"
    same = degrees_between(value, right)
    if same < 0.05:
        return f"your axis is right, your angle is {_degrees(mine)} instead of {_degrees(true)}: {told}"
    return told


def way_missed(args, value, right) -> str:
    """How far beside the way, and how far along it."""
    R_0, R_1, _ = (np.asarray(x, float) for x in args)
    if not np.isfinite(value).all():
        return ""
    off = np.abs(value.T @ value - np.eye(3)).max()
    if off > 1e-6:
        return f"R^T R of your answer differs from the identity by {off:.2g}: it is no rotation"
    told = f"your attitude is {_degrees(_apart(value, right))} away from the right one"
    ends = [_degrees(round(_apart(A, B), 3)) for A, B in ((R_0, value), (value, R_1), (R_0, R_1))]
    return f"{told}: {ends[0]} from R_0 and {ends[1]} from R_1, which are {ends[2]} apart"
