"""Typical mistakes of notebook 06."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb06")


# ---- tool frames


def frames_inward(points, centre):
    T = right.tool_frames(points, centre)
    T[:, :3, 0] *= -1
    T[:, :3, 2] *= -1
    return T


def frames_left_handed(points, centre):
    T = right.tool_frames(points, centre)
    T[:, :3, 2] *= -1
    return T


def frames_with_chord(points, centre):
    T = right.tool_frames(points, centre)
    step = np.diff(points, axis=0)
    step = np.concatenate([step, step[-1:]])
    T[:, :3, 1] = step / np.linalg.norm(step, axis=1, keepdims=True)
    T[:, :3, 2] = np.cross(T[:, :3, 0], T[:, :3, 1])
    return T


def frames_swapped(points, centre):
    T = right.tool_frames(points, centre)
    T[:, :3, :3] = T[:, :3, [1, 0, 2]] * [1, 1, -1]
    return T


def frames_about_origin(points, centre):
    return right.tool_frames(points, np.zeros(3))


def frames_without_last(points, centre):
    return right.tool_frames(points, centre)[:-1]


def frames_with_last_copied(points, centre):
    T = right.tool_frames(points, centre)
    T[-1, :3, 1] = T[-2, :3, 1]
    T[-1, :3, 2] = np.cross(T[-1, :3, 0], T[-1, :3, 1])
    return T


# ---- quaternion


def _roots(R):
    """Sizes of the four components, each under its own root."""
    a, b, c = np.diag(R)
    squares = np.array([1 + a + b + c, 1 + a - b - c, 1 - a + b - c, 1 - a - b + c])
    return 0.5 * np.sqrt(np.maximum(squares, 0))


def _signs(R):
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def quaternion_as_printed(R):  # RPI mini project 3, problem 1: q2 of the report, and no signs
    a, b = R[0, 1] + R[1, 0], R[1, 2] + R[2, 1]
    q = _roots(R)
    q[1] = 0.5 * np.sqrt((_signs(R)[0] ** 2 + a * a + b * b) / (3 + np.trace(R)))
    return q


def quaternion_vector_first(R):
    return np.roll(right.quaternion(R), -1)


def quaternion_roots_only(R):  # RPI mini project 3, problem 1: no signs
    return _roots(R)


def quaternion_signs_of_differences(R):
    q = _roots(R)
    q[1:] *= np.sign(_signs(R))
    return q


def quaternion_turned_back(R):
    return right.quaternion(R) * [1, -1, -1, -1]


# ---- ZYX angles


def zyx_flipped(R):  # RPI mini project 3, its code
    return -right.zyx(R)


def zyx_pitch_flipped(R):
    return right.zyx(R) * [1, -1, 1]


def zyx_reversed(R):
    return right.zyx(R)[::-1]


def zyx_by_arcsin(R):
    pitch = -np.arcsin(R[2, 0])
    return np.array([np.arcsin(R[1, 0] / np.cos(pitch)), pitch, np.arcsin(R[2, 1] / np.cos(pitch))])


def zyx_of_the_other_product(R):
    return -right.zyx(R.T)


def zyx_degrees(R):
    return np.degrees(right.zyx(R))


# ---- limits


def inside_without_turns(theta, lower, upper):  # Robotics I exam, 17 June 2019
    return np.all((theta >= lower) & (theta <= upper), axis=-1)


def inside_wrapped(theta, lower, upper):
    return inside_without_turns(np.angle(np.exp(1j * theta)), lower, upper)


def inside_any(theta, lower, upper):
    return np.any(lower + np.mod(theta - lower, 2 * np.pi) <= upper, axis=-1)


def inside_turns_up_only(theta, lower, upper):
    return inside_without_turns(np.where(theta < lower, theta + 2 * np.pi, theta), lower, upper)


# ---- speed


def _use(q, points, v_max):
    """Seconds per metre that each joint needs at its bound, in each step."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.abs(np.diff(q, axis=0)) / step[:, None] / v_max


def speed_wrapped(q, points, v_max):  # RPI mini project 3, problem 3
    return right.largest_speed(np.angle(np.exp(1j * q)), points, v_max)


def speed_one_bound(q, points, v_max):
    return right.largest_speed(q, points, np.full(len(v_max), v_max.min()))


def speed_mean(q, points, v_max):
    return 1 / _use(q, points, v_max).mean(axis=0).max()


def speed_one_step(q, points, v_max):  # RPI mini project 3, problem 3
    step = np.linalg.norm(np.diff(points, axis=0), axis=1).mean()
    return step / (np.abs(np.diff(q, axis=0)) / v_max).max()


def speed_signed(q, points, v_max):
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return 1 / (np.diff(q, axis=0) / step[:, None] / v_max).max()


WRONG = {
    "tool_frames": {
        "inward": frames_inward,
        "left_handed": frames_left_handed,
        "y_not_perpendicular": frames_with_chord,
        "x_along": frames_swapped,
        "about_origin": frames_about_origin,
        "no_last": frames_without_last,
        "last_copied": frames_with_last_copied,
    },
    "quaternion": {
        "wrong_entries": quaternion_as_printed,
        "vector_first": quaternion_vector_first,
        "roots_only": quaternion_roots_only,
        "lost_at_half_turn": quaternion_signs_of_differences,
        "turned_back": quaternion_turned_back,
    },
    "zyx": {
        "signs_flipped": zyx_flipped,
        "pitch_sign": zyx_pitch_flipped,
        "reversed": zyx_reversed,
        "arcsin": zyx_by_arcsin,
        "xyz": zyx_of_the_other_product,
        "degrees": zyx_degrees,
    },
    "inside": {
        "no_turns": inside_without_turns,
        "wrapped": inside_wrapped,
        "any_joint": inside_any,
        "turns_up_only": inside_turns_up_only,
    },
    "largest_speed": {
        "wrapped": speed_wrapped,
        "one_bound": speed_one_bound,
        "mean": speed_mean,
        "one_step": speed_one_step,
        "signed": speed_signed,
    },
}
