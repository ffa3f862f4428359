"""Typical mistakes of notebook 06 with turns: angle and axis, and the way between two attitudes."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.kinematics import lie, rotations

right = Solved("nb06")


def _differences(R):
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def axis_by_the_textbook(R):  # RPI mini project 3, problem 1
    theta = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    if np.sin(theta) < 1e-9:
        return _differences(R) / 2
    return _differences(R) / (2 * np.sin(theta)) * theta


def axis_alone(R):
    beta = right.angle_axis(R)
    return beta / max(np.linalg.norm(beta), 1e-300)


def axis_by_half_the_angle(R):
    return right.angle_axis(R) / 2


def axis_turned_back(R):
    return -right.angle_axis(R)


def axis_not_flipped(R):
    """From the quaternion whose largest component is positive, whatever its w."""
    q = right.quaternion(R)
    q = q * np.sign(q[np.argmax(np.abs(q))])
    size = np.linalg.norm(q[1:])
    return 2 * np.arctan2(size, q[0]) * q[1:] / size if size else np.zeros(3)


def _from_the_quaternion(R, angle):
    """angle(w, size): of the quaternion with w >= 0 and the size of its (x, y, z)."""
    q = right.quaternion(R)
    q = -q if q[0] < 0 else q
    size = np.linalg.norm(q[1:])
    return 2 * angle(q[0], size) * q[1:] / size if size else np.zeros(3)


def axis_by_arcsine(R):
    return _from_the_quaternion(R, lambda w, size: np.arcsin(min(size, 1)))


def axis_by_arccosine(R):
    return _from_the_quaternion(R, lambda w, size: np.arccos(min(w, 1)))


def axis_with_w_alone(R):
    q = right.quaternion(R)
    size = np.linalg.norm(q[1:])
    return 2 * np.arctan2(size, abs(q[0])) * q[1:] / size if size else np.zeros(3)


def axis_not_divided(R):
    beta = right.angle_axis(R)
    return np.sin(np.linalg.norm(beta) / 2) * beta


def slerp_of_entries(R_0, R_1, t):
    return (1 - t) * R_0 + t * R_1


def slerp_of_angles(R_0, R_1, t):
    return rotations.from_zyx((1 - t) * right.zyx(R_0) + t * right.zyx(R_1))


def _quaternions(R_0, R_1):
    a, b = (rotations.quaternion(R) for R in (R_0, R_1))
    return a, b if a @ b >= 0 else -b


def slerp_on_the_chord(R_0, R_1, t):
    a, b = _quaternions(R_0, R_1)
    return rotations.from_quaternion((1 - t) * a + t * b)


def slerp_on_the_far_chord(R_0, R_1, t):
    a, b = rotations.quaternion(R_0), rotations.quaternion(R_1)
    return rotations.from_quaternion((1 - t) * a + t * b)


def slerp_on_the_wrong_side(R_0, R_1, t):
    return lie.exp3(t * right.angle_axis(R_0.T @ R_1)) @ R_0


def slerp_from_identity(R_0, R_1, t):
    return lie.exp3(t * right.angle_axis(R_1))


def slerp_away(R_0, R_1, t):
    return R_0 @ lie.exp3(t * right.angle_axis(R_1.T @ R_0))


def slerp_backwards(R_0, R_1, t):
    return right.slerp(R_1, R_0, t)


def slerp_of_vectors(R_0, R_1, t):
    return lie.exp3((1 - t) * right.angle_axis(R_0) + t * right.angle_axis(R_1))


def slerp_scaled(R_0, R_1, t):
    return t * R_1


def slerp_the_long_way(R_0, R_1, t, quaternion=rotations.quaternion):
    """Between quaternions with w >= 0, or with the largest component > 0, whichever way they lie."""
    a, b = quaternion(R_0), quaternion(R_1)
    angle = np.arccos(np.clip(a @ b, -1, 1))
    if np.sin(angle) < 1e-9:
        return R_0
    return rotations.from_quaternion((np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle))


WRONG = {
    "angle_axis": {
        "textbook": axis_by_the_textbook,
        "axis_alone": axis_alone,
        "half_angle": axis_by_half_the_angle,
        "turned_back": axis_turned_back,
        "not_flipped": axis_not_flipped,
        "w_alone": axis_with_w_alone,
        "arcsine": axis_by_arcsine,
        "arccosine": axis_by_arccosine,
        "not_divided": axis_not_divided,
    },
    "slerp": {
        "entries": slerp_of_entries,
        "angles": slerp_of_angles,
        "chord": slerp_on_the_chord,
        "far_chord": slerp_on_the_far_chord,
        "wrong_side": slerp_on_the_wrong_side,
        "from_identity": slerp_from_identity,
        "away": slerp_away,
        "backwards": slerp_backwards,
        "vectors": slerp_of_vectors,
        "long_way": slerp_the_long_way,
        "long_way_too": lambda R_0, R_1, t: slerp_the_long_way(R_0, R_1, t, right.quaternion),
        "scaled": slerp_scaled,
    },
}
