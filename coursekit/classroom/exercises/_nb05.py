"""Notebook 05: by how much a wrong answer misses, in words of the notebook."""

from __future__ import annotations

import numpy as np

SMALL = 1e-6
WORDS = ("longest", "middle", "shortest")


def degrees_between(a: np.ndarray, b: np.ndarray) -> float:
    """The angle between two vectors, 0 to 180; NaN if one of them is zero."""
    lengths = np.linalg.norm(a) * np.linalg.norm(b)
    return float(np.degrees(np.arccos(np.clip(a @ b / lengths, -1, 1)))) if lengths > 0 else np.nan


def _first_wrong_column(value: np.ndarray, right: np.ndarray) -> int:
    """The first column that is wrong by more than a thousandth, or the one that is wrong most."""
    gap = np.abs(value - right).max(axis=0)
    return int(np.argmax(gap > 1e-3)) if np.any(gap > 1e-3) else int(np.argmax(gap))


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def axis_missed(args, value, right) -> str:
    """A column of J_s is a screw: where does its axis lie?"""
    if value.shape != right.shape:
        return (
            f"your Jacobian has {_counted(value.shape[1], 'column')} for {_counted(right.shape[1], 'joint')}"
        )
    if not np.isfinite(value).all():
        return ""
    i = _first_wrong_column(value, right)
    (w, v), (w_right, v_right) = np.split(value[:, i], 2), np.split(right[:, i], 2)
    if not np.any(w_right):
        if np.linalg.norm(w) > SMALL:
            return f"joint {i + 1} is a slide: its omega is 0, yours is not"
        return f"joint {i + 1} is a slide: its direction is off by {degrees_between(v, v_right):.0f} deg"
    if abs(np.linalg.norm(w) - 1) > SMALL:
        return (
            f"omega of joint {i + 1} has length {np.linalg.norm(w):.2g} in your column; a hinge has length 1"
        )
    turned = degrees_between(w, w_right)
    if turned > 0.05:
        return f"your axis of joint {i + 1} is turned by {turned:.0f} deg against the right one"
    beside = np.linalg.norm(np.cross(np.cross(w_right, v_right) - np.cross(w, v), w))
    if beside > 1e-4:
        return (
            f"your axis of joint {i + 1} has the right direction, but lies {1000 * beside:.0f} mm beside"
            " the right one"
        )
    gap = np.linalg.norm(v - v_right)
    return f"v of joint {i + 1} is off by {gap:.2g} m/s in your column; its axis is right"


def velocity_missed(args, value, right) -> str:
    """A column of J is what the tool does when one joint turns at 1 rad/s."""
    if value.shape != right.shape:
        return (
            f"your Jacobian has {_counted(value.shape[1], 'column')} for {_counted(right.shape[1], 'joint')}"
        )
    if not np.isfinite(value).all():
        return ""
    if value.shape[1] > 1 and np.allclose(value, value[:, :1]) and not np.allclose(right, right[:, :1]):
        return "all your columns are alike: each joint has a column of its own, move one joint at a time"
    i = _first_wrong_column(value, right)
    (w, v), (w_right, v_right) = np.split(value[:, i], 2), np.split(right[:, i], 2)
    told = _vector_missed(w, w_right, "omega", "rad/s") or _vector_missed(
        v, v_right, "the tool's velocity", "m/s"
    )
    return f"when joint {i + 1} turns at 1 rad/s, {told}" if told else ""


def _vector_missed(mine: np.ndarray, right: np.ndarray, name: str, unit: str) -> str:
    gap = np.linalg.norm(mine - right)
    if gap <= SMALL:
        return ""
    lengths = np.linalg.norm(mine), np.linalg.norm(right)
    turned = degrees_between(mine, right)
    if not np.isclose(*lengths, rtol=0.02, atol=1e-9):
        told = f"{name} is {lengths[0]:.3g} {unit} by your Jacobian; right is {lengths[1]:.3g} {unit}"
        return f"{told}, and its direction is off by {turned:.0f} deg" if turned > 1 else told
    if turned > 1:
        return f"{name} has the right size in your Jacobian, but its direction is off by {turned:.0f} deg"
    return f"{name} is off by {gap:.1g} {unit} in your Jacobian"


def planar_velocity_missed(args, value, right) -> str:
    theta, _, _ = args
    (v_B, v_E), (right_B, right_E) = value, right
    if not all(np.isfinite(v).all() for v in value):
        return ""
    if np.allclose(v_B, right_B, atol=SMALL):
        if not np.isclose(np.linalg.norm(v_E), np.linalg.norm(v_B), rtol=1e-4):
            return (
                f"the tool has one speed, {np.linalg.norm(v_B):.3g} m/s, from wherever it is seen; "
                f"your v_E says {np.linalg.norm(v_E):.3g} m/s"
            )
        turned = degrees_between(v_E, right_E)
        return f"your v_E has the right size, but its direction is off by {turned:.0f} deg"
    c, s = np.cos(np.sum(theta)), np.sin(np.sum(theta))
    fits = np.allclose(v_E, np.array([[c, s], [-s, c]]) @ v_B, atol=SMALL)
    told = "your v_E fits your v_B, so look at v_B: "
    told = (told if fits else "") + f"your tool moves at {np.linalg.norm(v_B):.3g} m/s"
    turned = degrees_between(v_B, right_B)
    if np.isclose(np.linalg.norm(v_B), np.linalg.norm(right_B), rtol=1e-3):
        if turned < 1:
            return f"your v_B is off by {np.linalg.norm(v_B - right_B):.1g} m/s: are its numbers rounded?"
        return f"{told}, which is right, but {turned:.0f} deg away from the right direction"
    return f"{told}; right is {np.linalg.norm(right_B):.3g} m/s"


def half_axis_missed(args, value, right) -> str:
    """How far the unit ball of rates really reaches, along your axes."""
    (J,), (lengths, axes), (right_lengths, right_axes) = args, value, right
    if not (np.isfinite(lengths).all() and np.isfinite(axes).all()):
        return ""
    if np.allclose(lengths, 2 * right_lengths, atol=SMALL):
        return "your lengths are twice too large: a half axis ends at the middle of the ellipsoid"
    if not np.allclose(lengths, right_lengths, atol=SMALL):
        i = int(np.argmax(np.abs(lengths - right_lengths) > SMALL))
        return f"your {WORDS[i]} half axis is {lengths[i]:.3g}; it should be {right_lengths[i]:.3g}"
    for word, mine, true in zip(WORDS, axes.T, right_axes.T, strict=True):
        if abs(np.linalg.norm(mine) - 1) > SMALL:
            return f"the direction of your {word} half axis has length {np.linalg.norm(mine):.3g}, not 1"
        turned = degrees_between(mine, true)
        turned = min(turned, 180 - turned)
        if turned > 0.1:
            return (
                f"the direction of your {word} half axis is off by {turned:.0f} deg: along it J reaches "
                f"{np.linalg.norm(J.T @ mine):.3g}, not {np.linalg.norm(J.T @ true):.3g}"
            )
    return ""


def factor_missed(args, value, right) -> str:
    """What the step makes of the error along the singular directions: sigma / (sigma^2 + k^2)."""
    J, e, k = args
    if value.shape != right.shape:
        return f"your step has {len(value)} entries for {len(right)} joints"
    if not np.isfinite(value).all():
        return ""
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    along = U.T @ e
    seen = np.abs(along) > 1e-6
    mine = np.divide(Vt @ value, along, out=np.zeros_like(along), where=seen)
    wanted = sigma / (sigma**2 + k**2)
    gap = np.where(seen, np.abs(mine - wanted), 0)
    i = int(np.argmax(gap))
    if gap[i] > 1e-5:
        return (
            f"along the singular direction with sigma = {sigma[i]:.2g} your step is {mine[i]:.3g} times the"
            f" error; sigma / (sigma^2 + k^2) is {wanted[i]:.3g}"
        )
    idle = np.linalg.norm(value - Vt.T @ (Vt @ value))
    return f"a part of your step, {idle:.2g} rad, moves nothing: J times it is 0" if idle > SMALL else ""


def rate_missed(args, value, right) -> str:
    """What T-dot says of the tool point, then what the column says."""
    (T_dot, column), (T_dot_right, column_right) = value, right
    if not (np.isfinite(T_dot).all() and np.isfinite(column).all()):
        return ""
    if np.abs(T_dot[3]).max() > SMALL:
        return "the last row of your T-dot is not 0 0 0 0: the 1 of a pose does not change"
    gap = np.abs(T_dot - T_dot_right).max()
    if 0 < gap < 1e-3:
        return f"your T-dot is off by {gap:.0e}: rounded, or a difference over a small step? [S] H is exact"
    told = _vector_missed(T_dot[:3, 3], T_dot_right[:3, 3], "the tool's velocity", "m/s")
    if told:
        return f"in your T-dot, {told.replace(' by your Jacobian', '').replace(' in your Jacobian', '')}"
    if np.abs(T_dot - T_dot_right).max() > SMALL:
        return "the last column of your T-dot is right, the change of the rotation is not"
    told = _vector_missed(column[:3], column_right[:3], "omega", "rad/s") or _vector_missed(
        column[3:], column_right[3:], "the tool's velocity", "m/s"
    )
    return told.replace("Jacobian", "column")


def power_missed(args, value, right) -> str:
    """The power of one joint that turns at 1 rad/s, against what the tool takes meanwhile."""
    if value.shape != right.shape:
        return f"your answer has {_counted(len(value), 'torque')} for {_counted(len(right), 'joint')}"
    if not np.isfinite(value).all():
        return ""
    i = int(np.argmax(np.abs(value - right)))
    if abs(value[i] - right[i]) <= SMALL:
        return ""
    return (
        f"when joint {i + 1} turns at 1 rad/s, the tool gives {right[i]:.3g} W against the load; "
        f"your torque puts in {value[i]:.3g} W"
    )


def target_missed(args, value, right) -> str:
    """How far from the target the run ends, beside how far the right one is by then."""
    robot, T_sd = args[:2]
    if value.shape != right.shape:
        return f"your answer has shape {value.shape}; {len(right)} rows are expected: start and steps"
    if not np.isfinite(value).all():
        return ""
    mine, there = (robot.fk(rows[-1])[:3, 3] for rows in (value, right))
    mine, there = (1000 * np.linalg.norm(p - T_sd[:3, 3]) for p in (mine, there))
    return f"your run ends with the tool {mine:.3g} mm from the target; the right one with {there:.3g} mm"
