"""Typical mistakes of notebook 06."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved, _nb06_branch, _nb06_turns

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


def frames_with_last_pose_copied(points, centre):
    T = right.tool_frames(points, centre)
    return np.concatenate([T[:-1], T[-2:-1]])


def frames_round_the_end(points, centre):
    return right.tool_frames(np.vstack([points, points[:1]]), centre)[:-1]


def frames_swapped(points, centre):
    T = right.tool_frames(points, centre)
    T[:, :3, :3] = T[:, :3, [1, 0, 2]] * [1, 1, -1]
    return T


def frames_about_origin(points, centre):
    return right.tool_frames(points, np.zeros(3))


def frames_without_last(points, centre):
    return right.tool_frames(points, centre)[:-1]


def _frames_along(points, centre, d):
    """The right frames but for their motion d (m, 3)."""
    x = right.tool_frames(points, centre)[:, :3, 0]
    y = d - np.sum(d * x, axis=1, keepdims=True) * x
    y = y / np.linalg.norm(y, axis=1, keepdims=True)
    T = right.tool_frames(points, centre)
    T[:, :3, :3] = np.stack([x, y, np.cross(x, y)], axis=-1)
    return T


def frames_backward(points, centre):
    step = np.diff(points, axis=0)
    return _frames_along(points, centre, np.concatenate([step[:1], step]))


def frames_central(points, centre):
    return _frames_along(points, centre, np.gradient(points, axis=0))


def frames_not_unit(points, centre):
    T, step = right.tool_frames(points, centre), np.diff(points, axis=0)
    d = np.concatenate([step, step[-1:]])
    T[:, :3, 1:3] *= np.sum(d * T[:, :3, 1], axis=1)[:, None, None]
    return T


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


def quaternion_with_y_turned(R):
    diagonal = _roots(R)
    (x, y, z), k = _signs(R) * [1, -1, 1], int(np.argmax(diagonal))
    a, b, c = R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1]
    line = np.array([[0, x, y, z], [x, 0, a, b], [y, a, 0, c], [z, b, c, 0]])[k]
    line[k] = 4 * diagonal[k] ** 2
    return line / np.linalg.norm(line)


def quaternion_of_half_the_table(R):
    q = right.quaternion(R)
    k = int(np.argmax(np.abs(q)))
    q = np.where(np.arange(4) < k, 0, q)
    return q / np.linalg.norm(q)


def quaternion_vector_first(R):
    return np.roll(right.quaternion(R), -1)


def quaternion_roots_only(R):  # RPI mini project 3, problem 1: no signs
    return _roots(R)


def quaternion_signs_of_differences(R):
    q = _roots(R)
    q[1:] *= np.sign(_signs(R))
    return q


def quaternion_divided_by_w(R):
    w = np.sqrt(1 + np.trace(R)) / 2
    return np.concatenate([[w], _signs(R) / (4 * w)])


def quaternion_quarter_of_the_line(R):
    q = right.quaternion(R)
    return q * np.abs(q).max()


def quaternion_without_the_one(R):
    q = right.quaternion(R)
    k = int(np.argmax(np.abs(q)))
    line = 4 * q[k] * q - np.eye(4)[k]
    return line / np.linalg.norm(line)


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


def zyx_by_arccos(R):
    pitch = right.zyx(R)[1]
    yaw, roll = np.arccos(np.clip(np.array([R[0, 0], R[2, 2]]) / np.cos(pitch), -1, 1))
    return np.array([yaw, pitch, roll])


def zyx_of_the_other_product(R):
    return -right.zyx(R.T)


def zyx_of_the_inverse(R):
    return right.zyx(R.T)


def zyx_by_arctan(R):
    return np.array([np.arctan(R[1, 0] / R[0, 0]), right.zyx(R)[1], np.arctan(R[2, 1] / R[2, 2])])


def zyx_with_z_twice(R):
    return np.array([np.arctan2(R[1, 2], R[0, 2]), np.arccos(R[2, 2]), np.arctan2(R[2, 1], -R[2, 0])])


def zyx_degrees(R):
    return np.degrees(right.zyx(R))


# ---- limits


def inside_without_turns(theta, lower, upper):  # Robotics I exam, 17 June 2019
    return np.all((theta >= lower) & (theta <= upper), axis=-1)


def inside_wrapped(theta, lower, upper):
    return inside_without_turns(np.angle(np.exp(1j * theta)), lower, upper)


def inside_wrapped_by_mod(theta, lower, upper):
    """As above, but for the last digit, which decides exactly on a limit."""
    return inside_without_turns((theta + np.pi) % (2 * np.pi) - np.pi, lower, upper)


def inside_wrapped_upwards(theta, lower, upper):
    return inside_without_turns(theta % (2 * np.pi), lower, upper)


def inside_one_turn(theta, lower, upper):
    turned = (theta[..., None] + 2 * np.pi * np.array([-1, 0, 1])).swapaxes(0, -1)  # (3, n, m)
    return ((turned >= lower[:, None]) & (turned <= upper[:, None])).any(axis=0).all(axis=0)


def inside_any(theta, lower, upper):
    return np.any(lower + np.mod(theta - lower, 2 * np.pi) <= upper, axis=-1)


def inside_turns_up_only(theta, lower, upper):
    return inside_without_turns(np.where(theta < lower, theta + 2 * np.pi, theta), lower, upper)


def inside_turns_down_only(theta, lower, upper):
    return inside_without_turns(np.where(theta > upper, theta - 2 * np.pi, theta), lower, upper)


def inside_all_joints_alike(theta, lower, upper):
    turns = 2 * np.pi * np.arange(-9, 10)[:, None, None]
    return inside_without_turns(theta + turns, lower, upper).any(axis=0)


# ---- speed


def _use(q, points, v_max):
    """Seconds per metre that each joint needs at its bound, in each step."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.abs(np.diff(q, axis=0)) / step[:, None] / v_max


def speed_wrapped(q, points, v_max):  # RPI mini project 3, problem 3
    return right.largest_speed(np.angle(np.exp(1j * q)), points, v_max)


def speed_wrapped_differences(q, points, v_max):
    turns = np.angle(np.exp(1j * np.diff(q, axis=0)))
    return right.largest_speed(np.cumsum([q[0], *turns], axis=0), points, v_max)


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


def speed_largest_bound(q, points, v_max):
    return right.largest_speed(q, points, np.full(len(v_max), v_max.max()))


def speed_signed_at_the_end(q, points, v_max):
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return (v_max / (np.diff(q, axis=0) / step[:, None])).min()


def speed_with_bound_of_the_fastest(q, points, v_max):
    slope = (_use(q, points, v_max) * v_max).max(axis=0)
    return v_max[np.argmax(slope)] / slope.max()


def speed_of_all_joints_together(q, points, v_max):
    return v_max.min() / np.linalg.norm(_use(q, points, v_max) * v_max, axis=1).max()


def speed_by_whole_length(q, points, v_max):
    return np.linalg.norm(np.diff(points, axis=0)) / (np.abs(np.diff(q, axis=0)) / v_max).max()


def speed_of_the_last_joint(q, points, v_max):
    return 1 / _use(q, points, v_max)[:, -1].max()


WRONG = {
    "tool_frames": {
        "inward": frames_inward,
        "left_handed": frames_left_handed,
        "y_not_perpendicular": frames_with_chord,
        "not_unit": frames_not_unit,
        "x_along": frames_swapped,
        "about_origin": frames_about_origin,
        "no_last": frames_without_last,
        "backward": frames_backward,
        "central": frames_central,
        "last_copied": frames_with_last_copied,
        "pose_copied": frames_with_last_pose_copied,
        "round_the_end": frames_round_the_end,
    },
    "quaternion": {
        "wrong_entries": quaternion_as_printed,
        "y_sign": quaternion_with_y_turned,
        "vector_first": quaternion_vector_first,
        "no_mirror": quaternion_of_half_the_table,
        "roots_only": quaternion_roots_only,
        "lost_at_half_turn": quaternion_signs_of_differences,
        "divided_by_w": quaternion_divided_by_w,
        "turned_back": quaternion_turned_back,
        "quarter": quaternion_quarter_of_the_line,
        "no_one": quaternion_without_the_one,
    },
    "zyx": {
        "signs_flipped": zyx_flipped,
        "pitch_sign": zyx_pitch_flipped,
        "reversed": zyx_reversed,
        "arcsin": zyx_by_arcsin,
        "xyz": zyx_of_the_other_product,
        "of_the_inverse": zyx_of_the_inverse,
        "arctan": zyx_by_arctan,
        "zyz": zyx_with_z_twice,
        "degrees": zyx_degrees,
        "arccos": zyx_by_arccos,
    },
    "inside": {
        "no_turns": inside_without_turns,
        "one_turn": inside_one_turn,
        "wrapped": inside_wrapped,
        "wrapped_by_mod": inside_wrapped_by_mod,
        "wrapped_upwards": inside_wrapped_upwards,
        "any_joint": inside_any,
        "turns_up_only": inside_turns_up_only,
        "turns_down_only": inside_turns_down_only,
        "joints_together": inside_all_joints_alike,
    },
    "largest_speed": {
        "wrapped": speed_wrapped,
        "wrapped_differences": speed_wrapped_differences,
        "one_bound": speed_one_bound,
        "bound_of_the_fastest": speed_with_bound_of_the_fastest,
        "joints_added": speed_of_all_joints_together,
        "whole_length": speed_by_whole_length,
        "last_joint": speed_of_the_last_joint,
        "mean": speed_mean,
        "one_step": speed_one_step,
        "signed": speed_signed,
        "largest_bound": speed_largest_bound,
        "signed_speeds": speed_signed_at_the_end,
    },
    **_nb06_turns.WRONG,
    **_nb06_branch.WRONG,
}
