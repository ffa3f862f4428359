"""Typical mistakes of notebook 03."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.kinematics import lie, rotations

right = Solved("nb03")


# -- wrist_centre


def centre_by_inverse(T_sd, tool):  # TPK4170 report, eq. 4.1
    return (lie.inverse(T_sd) @ [-tool, 0, 0, 1])[:3]


def centre_added(T_sd, tool):
    return right.wrist_centre(T_sd, -tool)


def centre_along_z(T_sd, tool):
    return T_sd[:3, 3] - tool * T_sd[:3, 2]


def centre_along_space_x(T_sd, tool):
    return T_sd[:3, 3] - [tool, 0, 0]


def centre_along_a_row(T_sd, tool):
    return T_sd[:3, 3] - tool * T_sd[0, :3]


# -- subproblem1


def turn_swapped(k, x, y):  # TPK4170 report, eq. 4.3
    return np.pi / 2 - right.subproblem1(k, x, y)


def turn_with_the_part_along(k, x, y):
    return np.arctan2(k @ np.cross(x, y), x @ y)


def turn_backwards(k, x, y):
    return -right.subproblem1(k, x, y)


def turn_by_arccos(k, x, y):
    return abs(right.subproblem1(k, x, y))


def turn_by_arctan(k, x, y):
    return np.arctan(np.tan(right.subproblem1(k, x, y)))


# -- elbow_solutions


def _elbow(r, z, lengths, height=1.0, psi=1.0, sign=-1.0):
    """Both solutions, with the shoulder's height, psi and the sign of the forearm's square as given."""
    a1, d1, a2, a3, d4 = lengths
    x, y, fore = r - a1, z - d1, np.hypot(a3, d4)
    b = np.hypot(x, y)
    phi, psi = np.arctan2(y + (1 - height) * d1, x), psi * np.arctan2(a3, d4)
    bend = (b**2 - a2**2 + sign * fore**2) / (2 * a2 * fore)
    beta = np.pi - np.arccos(bend)
    alpha = np.arccos((b**2 + a2**2 - fore**2) / (2 * a2 * b))
    return np.array([[-phi - alpha, np.pi - beta + psi], [-phi + alpha, beta - np.pi + psi]])


def elbow_without_height(r, z, lengths):  # TPK4170 report, eq. 4.8
    return _elbow(r, z, lengths, height=0)


def elbow_without_psi(r, z, lengths):
    return _elbow(r, z, lengths, psi=0)


def elbow_plus_square(r, z, lengths):  # Robotics I exam, 17 June 2019, s_3
    return _elbow(r, z, lengths, sign=1)


def elbow_one_only(r, z, lengths):
    return right.elbow_solutions(r, z, lengths)[:1]


def elbow_mixed(r, z, lengths):
    solutions = right.elbow_solutions(r, z, lengths)
    return np.column_stack([solutions[:, 0], solutions[::-1, 1]])


# -- wrist_angles


def wrist_by_wrong_root(R):  # TPK4170 report, eq. 4.20
    solutions = right.wrist_angles(R)
    bend = np.arctan2(np.sqrt(1 - R[0, 0]), R[0, 0])
    solutions[:, 1] = np.copysign(bend, solutions[:, 1])
    return solutions


def wrist_xyz(R):  # TPK4170 report, text at eq. 4.17
    t4, t5, t6 = np.arctan2(R[1, 2], R[2, 2]), np.arcsin(R[0, 2]), np.arctan2(R[0, 1], R[0, 0])
    return np.array([[t4, t5, t6], [t4 + np.pi, np.pi - t5, t6 + np.pi]])


def wrist_without_signs(R):
    return right.wrist_angles(R) * [-1, 1, -1]


def wrist_one_only(R):
    return right.wrist_angles(R)[:1]


def wrist_half_flipped(R):
    t4, t5, t6 = right.wrist_angles(R)[0]
    return np.array([[t4, t5, t6], [t4, -t5, t6]])


# -- all_solutions


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


# -- newton_step


def step_in_space(J_b, T_sb, T_sd):
    return np.linalg.pinv(J_b) @ lie.log6(T_sd @ lie.inverse(T_sb))


def step_of_difference(J_b, T_sb, T_sd):
    D = lie.inverse(T_sb) @ T_sd - np.eye(4)
    return np.linalg.pinv(J_b) @ [D[2, 1], D[0, 2], D[1, 0], *D[:3, 3]]


def step_by_transpose(J_b, T_sb, T_sd):
    return J_b.T @ lie.log6(lie.inverse(T_sb) @ T_sd)


def step_backwards(J_b, T_sb, T_sd):
    return -right.newton_step(J_b, T_sb, T_sd)


WRONG = {
    "wrist_centre": {
        "inverse": centre_by_inverse,
        "added": centre_added,
        "along_z": centre_along_z,
        "space_x": centre_along_space_x,
        "row": centre_along_a_row,
    },
    "subproblem1": {
        "swapped": turn_swapped,
        "not_removed": turn_with_the_part_along,
        "sign": turn_backwards,
        "arccos": turn_by_arccos,
        "arctan": turn_by_arctan,
    },
    "elbow_solutions": {
        "height": elbow_without_height,
        "no_psi": elbow_without_psi,
        "plus_square": elbow_plus_square,
        "one_only": elbow_one_only,
        "mixed": elbow_mixed,
    },
    "wrist_angles": {
        "sqrt": wrist_by_wrong_root,
        "xyz": wrist_xyz,
        "signs": wrist_without_signs,
        "one_only": wrist_one_only,
        "half_flip": wrist_half_flipped,
    },
    "all_solutions": {
        "front_only": all_to_the_front,
        "axis_1": all_with_axis_1_up,
        "same_r": all_with_the_same_r,
        "no_flip": all_without_flip,
        "duplicates": all_with_duplicates,
        "R_reversed": all_with_R_reversed,
    },
    "newton_step": {
        "space": step_in_space,
        "difference": step_of_difference,
        "transpose": step_by_transpose,
        "backwards": step_backwards,
    },
}
