"""Typical mistakes of notebook 03."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.classroom.mistakes._nb03_all import ALL_SOLUTIONS
from coursekit.kinematics import lie

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


def centre_as_a_direction(T_sd, tool):
    return -tool * T_sd[:3, 0]


# -- subproblem1


def turn_swapped(k, x, y):  # TPK4170 report, eq. 4.3
    return np.pi / 2 - right.subproblem1(k, x, y)


def turn_with_the_part_along(k, x, y):
    return np.arctan2(k @ np.cross(x, y), x @ y)


def turn_with_whole_lengths(k, x, y):
    part = (x - k * (k @ x)) @ (y - k * (k @ y))
    angle = np.arccos(np.clip(part / np.linalg.norm(x) / np.linalg.norm(y), -1, 1))
    return np.copysign(angle, np.sin(right.subproblem1(k, x, y)))


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


def elbow_from_the_floor(r, z, lengths):
    a1, d1, *_ = lengths
    phi = np.arctan2(z - d1, r - a1) - np.arctan2(z, r)
    return right.elbow_solutions(r, z, lengths) + [phi, 0]


def elbow_without_psi(r, z, lengths):
    return _elbow(r, z, lengths, psi=0)


def elbow_plus_square(r, z, lengths):  # Robotics I exam, 17 June 2019, s_3
    return _elbow(r, z, lengths, sign=1)


def elbow_without_arccos(r, z, lengths):
    theta2, theta3 = right.elbow_solutions(r, z, lengths).T
    phi, psi = -theta2.mean(), theta3.mean()
    alpha, beta = np.cos(theta2[1] + phi), np.cos(np.pi + psi - theta3[0])
    return np.array([[-phi - alpha, np.pi - beta + psi], [-phi + alpha, beta - np.pi + psi]])


def elbow_one_only(r, z, lengths):
    return right.elbow_solutions(r, z, lengths)[:1]


def elbow_mixed(r, z, lengths):
    solutions = right.elbow_solutions(r, z, lengths)
    return np.column_stack([solutions[:, 0], solutions[::-1, 1]])


def elbow_with_beta(r, z, lengths):
    psi = np.arctan2(lengths[3], lengths[4])
    theta2, theta3 = right.elbow_solutions(r, z, lengths).T
    return np.column_stack([theta2, np.sign(theta3 - psi) * np.pi - theta3 + 2 * psi])


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


def wrist_without_minus(R):
    return right.wrist_angles(R) + [np.pi, 0, 0]


def _wrist_of(R, change):
    """Both solutions, after a change of the first one's angles."""
    t4, t5, t6 = change(right.wrist_angles(R)[0])
    return np.array([[t4, t5, t6], [t4 + np.pi, -t5, t6 + np.pi]])


def wrist_half_flipped(R):
    t4, t5, t6 = right.wrist_angles(R)[0]
    return np.array([[t4, t5, t6], [t4, -t5, t6]])


def wrist_with_180(R):
    t4, t5, t6 = right.wrist_angles(R)[0]
    return np.array([[t4, t5, t6], [t4 + 180, -t5, t6 + 180]])


# -- subproblem2 and subproblem3


def _across(k, x):
    return x - k * (k @ x)


def _swing(k, x, y, squares):
    """Both angles of a triangle whose sides at the axis have these squares, and the third one."""
    a2, b2, d2 = squares
    bend = np.arccos(np.clip((a2 + b2 - d2) / (2 * np.sqrt(a2 * b2)), -1, 1))
    return right.subproblem1(k, x, y) + np.array([-bend, bend])


def distance_in_space(k, x, y, distance):
    return _swing(k, x, y, (x @ x, y @ y, distance**2))


def distance_without_height(k, x, y, distance):
    x1, y1 = _across(k, x), _across(k, y)
    return _swing(k, x, y, (x1 @ x1, y1 @ y1, distance**2))


def distance_around_zero(k, x, y, distance):
    return right.subproblem3(k, x, y, distance) - right.subproblem1(k, _across(k, x), _across(k, y))


def distance_from_y(k, x, y, distance):
    return -right.subproblem3(k, x, y, distance)


def distance_one_only(k, x, y, distance):
    return right.subproblem3(k, x, y, distance)[:1]


def _turns(k1, k2, x, y, a, b, c, least=0.0):
    """Both rows where z = a k1 + b k2 + g n, and no root of less than `least` is taken."""
    n = np.cross(k1, k2)
    g = np.sqrt(np.fmax(x @ x - a * a - b * b - 2 * a * b * c, least) / (n @ n))
    places = [a * k1 + b * k2 + side * n for side in (g, -g)]
    return np.array([[right.subproblem1(k1, z, y), right.subproblem1(k2, x, z)] for z in places])


def turns_at_right_angles(k1, k2, x, y):
    return _turns(k1, k2, x, y, k1 @ y, k2 @ x, k1 @ k2)


def turns_without_c(k1, k2, x, y):
    return _turns(k1, k2, x, y, k1 @ y, k2 @ x, 0)


def turns_exchanged(k1, k2, x, y):
    return right.subproblem2(k1, k2, x, y)[:, ::-1]


def turns_backwards(k1, k2, x, y):
    return -right.subproblem2(k1, k2, x, y)


def turns_with_heights_exchanged(k1, k2, x, y, least=0.0):
    c = k1 @ k2
    a, b = np.linalg.solve([[1, c], [c, 1]], [k1 @ x, k2 @ y])
    return _turns(k1, k2, x, y, a, b, c, least)


def turns_with_heights_exchanged_and_nan(k1, k2, x, y):
    return turns_with_heights_exchanged(k1, k2, x, y, -np.inf)


def turns_mixed(k1, k2, x, y):
    rows = right.subproblem2(k1, k2, x, y)
    return np.column_stack([rows[:, 0], rows[::-1, 1]])


def turns_one_only(k1, k2, x, y):
    return right.subproblem2(k1, k2, x, y)[:1]


# -- jacobian_column


def column_not_turned(kind, w, q, T):
    R = np.eye(4)
    R[:3, 3] = T[:3, 3]
    return right.jacobian_column(kind, w, q, R)


def column_turned_back(kind, w, q, T):
    R = T.copy()
    R[:3, :3] = T[:3, :3].T
    return right.jacobian_column(kind, w, q, R)


def column_reversed(kind, w, q, T):
    column = right.jacobian_column(kind, w, q, T)
    return column if kind == "prismatic" else column * [1, 1, 1, -1, -1, -1]


def column_at_the_origin(kind, w, q, T):
    R = T.copy()
    R[:3, 3] = 0
    return right.jacobian_column(kind, w, q, R)


def column_of_a_hinge(kind, w, q, T):
    return right.jacobian_column("revolute", w, q, T)


def column_that_turns(kind, w, q, T):
    column = right.jacobian_column(kind, w, q, T)
    return np.roll(column, 3) if kind == "prismatic" else column


def column_v_first(kind, w, q, T):
    return np.roll(right.jacobian_column(kind, w, q, T), 3)


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


def _step_by_positions(J_b, T_sb, T_sd, seen):
    """The lower half of e is the way between the two origins, along other axes."""
    turn = lie.log3(T_sb[:3, :3].T @ T_sd[:3, :3])
    return np.linalg.pinv(J_b) @ np.concatenate([turn, seen @ (T_sd[:3, 3] - T_sb[:3, 3])])


WRONG = {
    "wrist_centre": {
        "inverse": centre_by_inverse,
        "added": centre_added,
        "along_z": centre_along_z,
        "space_x": centre_along_space_x,
        "row": centre_along_a_row,
        "direction": centre_as_a_direction,
    },
    "subproblem1": {
        "swapped": turn_swapped,
        "not_removed": turn_with_the_part_along,
        "whole_lengths": turn_with_whole_lengths,
        "sign": turn_backwards,
        "arccos": turn_by_arccos,
        "arctan": turn_by_arctan,
        "arcsin": lambda k, x, y: np.arcsin(np.sin(right.subproblem1(k, x, y))),
    },
    "elbow_solutions": {
        "height": elbow_without_height,
        "from_floor": elbow_from_the_floor,
        "no_psi": elbow_without_psi,
        "plus_square": elbow_plus_square,
        "no_arccos": elbow_without_arccos,
        "one_only": elbow_one_only,
        "mixed": elbow_mixed,
        "beta": elbow_with_beta,
    },
    "wrist_angles": {
        "sqrt": wrist_by_wrong_root,
        "xyz": wrist_xyz,
        "signs": wrist_without_signs,
        "no_minus": wrist_without_minus,
        "arctan": lambda R: _wrist_of(R, lambda t: np.arctan(np.tan(t))),
        "arcsin": lambda R: _wrist_of(R, lambda t: np.where([1, 0, 1], np.arcsin(np.sin(t)), t)),
        "one_only": lambda R: right.wrist_angles(R)[:1],
        "half_flip": wrist_half_flipped,
        "degrees": wrist_with_180,
    },
    "all_solutions": ALL_SOLUTIONS,
    "newton_step": {
        "space": step_in_space,
        "difference": step_of_difference,
        "transpose": step_by_transpose,
        "backwards": step_backwards,
        "positions": lambda J, here, there: _step_by_positions(J, here, there, np.eye(3)),
        "positions_in_tool": lambda J, here, there: _step_by_positions(J, here, there, here[:3, :3].T),
        "two_logs": lambda J, here, there: np.linalg.pinv(J) @ (lie.log6(there) - lie.log6(here)),
    },
    "subproblem3": {
        "not_removed": distance_in_space,
        "no_height": distance_without_height,
        "around_zero": distance_around_zero,
        "from_y": distance_from_y,
        "one_only": distance_one_only,
    },
    "subproblem2": {
        "right_angles": turns_at_right_angles,
        "exchanged": turns_exchanged,
        "backwards": turns_backwards,
        "heights": turns_with_heights_exchanged,
        "heights_nan": turns_with_heights_exchanged_and_nan,
        "without_c": turns_without_c,
        "mixed": turns_mixed,
        "one_only": turns_one_only,
    },
    "jacobian_column": {
        "not_turned": column_not_turned,
        "turned_back": column_turned_back,
        "reversed": column_reversed,
        "at_the_origin": column_at_the_origin,
        "slide_as_hinge": column_of_a_hinge,
        "slide_turns": column_that_turns,
        "v_first": column_v_first,
    },
}
