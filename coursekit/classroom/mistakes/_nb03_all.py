"""Typical mistakes of notebook 03 where the parts are put together: all eight solutions."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.kinematics import rotations

right = Solved("nb03")


def _joined(T_sd, lengths, tool, reaches, wrist=lambda R_123, R_sd: R_123.T @ R_sd):
    """Rows of every branch for reaches = [(theta1, r), ...]."""
    rows = []
    z = right.wrist_centre(T_sd, tool)[2]
    with np.errstate(invalid="ignore"):
        for t1, r in reaches:
            for t2, t3 in right.elbow_solutions(r, z, lengths):
                R_123 = rotations.rotz(-t1) @ rotations.roty(t2 + t3)
                rows += [[t1, t2, t3, *w] for w in right.wrist_angles(wrist(R_123, T_sd[:3, :3]))]
    return np.array(rows)


def _reach(T_sd, tool):
    x, y, _ = right.wrist_centre(T_sd, tool)
    return -np.arctan2(y, x), np.hypot(x, y)


def all_to_the_front(T_sd, lengths, tool):  # TPK4170 report, section 4.2
    return _joined(T_sd, lengths, tool, [_reach(T_sd, tool)])


def all_with_axis_1_up(T_sd, lengths, tool):
    return right.all_solutions(T_sd, lengths, tool) * [-1, 1, 1, 1, 1, 1]


def all_turned_up(T_sd, lengths, tool):
    rows = right.all_solutions(T_sd, lengths, tool)
    for row in rows:  # what is left for the wrist, with axis 1 taken to point up
        R_123 = rotations.rotz(row[0]) @ rotations.roty(row[1] + row[2])
        row[3:] = right.wrist_angles(R_123.T @ T_sd[:3, :3])[int(row[4] < 0)]
    return rows


def all_not_undone(T_sd, lengths, tool):
    t1, r = _reach(T_sd, tool)
    return _joined(T_sd, lengths, tool, [(t1, r), (t1 + np.pi, -r)], lambda R_123, R_sd: R_123 @ R_sd)


def all_with_the_same_r(T_sd, lengths, tool):
    t1, r = _reach(T_sd, tool)
    return _joined(T_sd, lengths, tool, [(t1, r), (t1 + np.pi, r)])


def all_without_flip(T_sd, lengths, tool):
    return right.all_solutions(T_sd, lengths, tool)[::2]


def all_with_duplicates(T_sd, lengths, tool):
    return np.repeat(right.all_solutions(T_sd, lengths, tool)[::2], 2, axis=0)


def all_with_R_reversed(T_sd, lengths, tool):
    t1, r = _reach(T_sd, tool)
    return _joined(T_sd, lengths, tool, [(t1, r), (t1 + np.pi, -r)], lambda R_123, R_sd: R_sd @ R_123.T)


def all_with_axis_1_up_throughout(T_sd, lengths, tool):
    """As before, but the rest is computed from that angle."""
    t1, r = _reach(T_sd, tool)
    return _joined(T_sd, lengths, tool, [(-t1, r), (-t1 + np.pi, -r)])


def all_with_r_exchanged(T_sd, lengths, tool):
    t1, r = _reach(T_sd, tool)
    return _joined(T_sd, lengths, tool, [(t1, -r), (t1 + np.pi, r)])


def all_with_theta3_taken_off(T_sd, lengths, tool):
    t1, r = _reach(T_sd, tool)
    rows = _joined(T_sd, lengths, tool, [(t1, r), (t1 + np.pi, -r)])
    for k, (t1, t2, t3) in enumerate(rows[:, :3]):
        R_123 = rotations.rotz(-t1) @ rotations.roty(t2 - t3)
        rows[k, 3:] = right.wrist_angles(R_123.T @ T_sd[:3, :3])[k % 2]
    return rows


ALL_SOLUTIONS = {
    "front_only": all_to_the_front,
    "axis_1": all_with_axis_1_up,
    "axis_1_throughout": all_with_axis_1_up_throughout,
    "turned_up": all_turned_up,
    "not_undone": all_not_undone,
    "same_r": all_with_the_same_r,
    "r_exchanged": all_with_r_exchanged,
    "theta3_taken_off": all_with_theta3_taken_off,
    "no_flip": all_without_flip,
    "duplicates": all_with_duplicates,
    "R_reversed": all_with_R_reversed,
}
