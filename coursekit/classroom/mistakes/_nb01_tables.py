"""Typical mistakes of notebook 01 with tables: making one, joints of both kinds, joint ranges."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb01")


def table_with_a_for_d(lengths):
    return right.dh_table(lengths)[:, [2, 1, 0, 3]]


def table_without_angles(lengths):
    return right.dh_table(lengths) * [1, 1, 1, 0]


def table_without_flange(lengths):
    return right.dh_table(lengths * [1, 1, 1, 1, 0])


def table_modified(lengths):
    rows = right.dh_table(lengths)
    rows[1:, :2], rows[0, :2] = rows[:-1, :2].copy(), 0
    return rows


def table_in_degrees(lengths):
    return right.dh_table(lengths) * [1, 180 / np.pi, 1, 180 / np.pi]


def table_with_d4_twice(lengths):  # exam of 17 June 2019, solution, table 1: row 6 is called d_4
    rows = right.dh_table(lengths)
    rows[5, 2] = rows[3, 2]
    return rows


def table_with_forearm_as_a(lengths):
    rows = right.dh_table(lengths)
    rows[3, [0, 2]] = rows[3, [2, 0]]
    return rows


def joint_always_turns(row, q, kind):
    return right.joint_transform(row, q, "revolute")


def joint_always_slides(row, q, kind):
    return right.joint_transform(row, q, "prismatic")


def joint_kinds_exchanged(row, q, kind):
    return right.joint_transform(row, q, {"revolute": "prismatic", "prismatic": "revolute"}[kind])


def joint_without_offset(row, q, kind):
    a, alpha, d, theta = row
    return (
        right.dh_transform(a, alpha, d, q) if kind == "revolute" else right.dh_transform(a, alpha, q, theta)
    )


def joint_along_x(row, q, kind):
    a, alpha, d, theta = row
    return (
        right.joint_transform(row, q, kind)
        if kind == "revolute"
        else right.dh_transform(a + q, alpha, d, theta)
    )


def joint_both(row, q, kind):
    a, alpha, d, theta = row
    return right.dh_transform(a, alpha, d + q, theta + q)


def joint_modified(row, q, kind):
    a, alpha, d, theta = row
    turns = kind == "revolute"
    return right.mdh_transform(a, alpha, d + (not turns) * q, theta + turns * q)


def joint_slide_without_theta(row, q, kind):
    return right.joint_transform(np.asarray(row) * [1, 1, 1, kind == "revolute"], q, kind)


def ranges_not_swapped(limits, sense, at_zero):
    return at_zero[:, None] + sense[:, None] * limits


def ranges_without_sense(limits, sense, at_zero):
    return at_zero[:, None] + limits


def ranges_without_shift(limits, sense, at_zero):
    return right.ranges_to_dh(limits, sense, 0 * at_zero)


def ranges_minus_shift(limits, sense, at_zero):
    return right.ranges_to_dh(limits, sense, -at_zero)


def ranges_with_shift_turned(limits, sense, at_zero):
    return right.ranges_to_dh(limits, sense, sense * at_zero)


def ranges_in_degrees(limits, sense, at_zero):
    return np.degrees(right.ranges_to_dh(limits, sense, at_zero))


def ranges_wrapped(limits, sense, at_zero):
    return (right.ranges_to_dh(limits, sense, at_zero) + np.pi) % (2 * np.pi) - np.pi


WRONG = {
    "dh_table": {
        "a_for_d": table_with_a_for_d,
        "all_angles_zero": table_without_angles,
        "without_flange": table_without_flange,
        "modified": table_modified,
        "degrees": table_in_degrees,
        "d4_twice": table_with_d4_twice,
        "forearm_as_a": table_with_forearm_as_a,
    },
    "joint_transform": {
        "always_turns": joint_always_turns,
        "always_slides": joint_always_slides,
        "kinds_exchanged": joint_kinds_exchanged,
        "without_offset": joint_without_offset,
        "along_x": joint_along_x,
        "both": joint_both,
        "modified": joint_modified,
        "slide_without_theta": joint_slide_without_theta,
    },
    "ranges_to_dh": {
        "not_swapped": ranges_not_swapped,
        "no_sense": ranges_without_sense,
        "no_shift": ranges_without_shift,
        "minus_shift": ranges_minus_shift,
        "shift_turned": ranges_with_shift_turned,
        "degrees": ranges_in_degrees,
        "wrapped": ranges_wrapped,
    },
}
