"""Typical mistakes of notebook 01."""

from __future__ import annotations

from functools import reduce

import numpy as np

from coursekit.classroom.mistakes import Solved, _nb01_tables

right = Solved("nb01")


def dh_with_alpha_for_a(a, alpha, d, theta):  # TPK4170 report, eq. 2.4
    T = right.dh_transform(a, alpha, d, theta)
    T[:2, 3] = alpha * T[:2, 0]
    return T


def dh_with_wrong_entry(a, alpha, d, theta):  # RPI mini project 3
    T = right.dh_transform(a, alpha, d, theta)
    T[1, 1] = np.cos(alpha) * np.sin(theta)
    return T


def dh_with_a_on_old_x(a, alpha, d, theta):
    T = right.dh_transform(a, alpha, d, theta)
    T[:2, 3] = a, 0
    return T


def dh_modified(a, alpha, d, theta):
    turn = right.dh_transform(0, 0, d, theta)
    return right.dh_transform(a, alpha, 0, 0) @ turn


def dh_degrees(a, alpha, d, theta):
    return right.dh_transform(a, np.radians(alpha), d, np.radians(theta))


def dh_transposed(a, alpha, d, theta):
    return right.dh_transform(a, alpha, d, theta).T


def mdh_plus_sin(a_prev, alpha_prev, d, theta):  # RPI mini project 3
    T = right.mdh_transform(a_prev, alpha_prev, d, theta)
    T[0, 1] = np.sin(theta)
    return T


def mdh_without_a(a_prev, alpha_prev, d, theta):  # RPI mini project 3
    return right.mdh_transform(0, alpha_prev, d, theta)


def mdh_standard(a_prev, alpha_prev, d, theta):
    return right.dh_transform(a_prev, alpha_prev, d, theta)


def mdh_shift_along_old_z(a_prev, alpha_prev, d, theta):
    T = right.mdh_transform(a_prev, alpha_prev, 0, theta)
    T[2, 3] = d
    return T


def mdh_degrees(a_prev, alpha_prev, d, theta):
    return right.mdh_transform(a_prev, np.radians(alpha_prev), d, np.radians(theta))


def fk_without_offset(rows, theta, base, tool):
    return right.fk_dh(rows * [1, 1, 1, 0], theta, base, tool)


def fk_without_tool(rows, theta, base, tool):
    return right.fk_dh(rows, theta, base, np.eye(4))


def fk_without_base(rows, theta, base, tool):
    return right.fk_dh(rows, theta, np.eye(4), tool)


def fk_reversed(rows, theta, base, tool):
    return right.fk_dh(rows[::-1], theta[::-1], base, tool)


def fk_read_as_modified(
    rows, theta, base, tool
):  # TPK4170 report, section 2.2: "the parameters stay the same"
    links = [right.mdh_transform(a, alpha, d, o + t) for (a, alpha, d, o), t in zip(rows, theta, strict=True)]
    return reduce(np.matmul, [base, *links, tool])


def fk_other_order(rows, theta, base, tool):
    return right.fk_dh(rows[:, [0, 2, 1, 3]], theta, base, tool)


def fk_with_tool_each_time(rows, theta, base, tool):
    links = [right.dh_transform(a, alpha, d, o + t) for (a, alpha, d, o), t in zip(rows, theta, strict=True)]
    return reduce(np.matmul, [base, *(A @ tool for A in links)])


def fk_with_theta_first(rows, theta, base, tool):
    links = [right.dh_transform(o + t, d, a, alpha) for (a, alpha, d, o), t in zip(rows, theta, strict=True)]
    return reduce(np.matmul, [base, *links, tool])


def exp_v_first(S, theta):
    return right.screw_exp(np.roll(S, 3), theta)


def exp_theta_v(S, theta):
    T = right.screw_exp(S, theta)
    T[:3, 3] = theta * S[3:]
    return T


def exp_sin_sin(S, theta):  # Panda programming assignment
    T = right.screw_exp(S, theta)
    w, v = S[:3], S[3:]
    T[:3, 3] += (np.sin(theta) - np.sin(np.sin(theta))) * np.cross(w, np.cross(w, v))
    return T


def exp_without_pitch(S, theta):
    w, v = S[:3], S[3:]
    return right.screw_exp(np.concatenate([w, v - w * (w @ v)]), theta)


def exp_slide_turns(S, theta):
    return right.screw_exp(np.roll(S, 3) if not S[:3].any() else S, theta)


def exp_turned_back(S, theta):
    return right.screw_exp(np.concatenate([-S[:3], S[3:]]), theta)


def _with_terms(S, theta, first, second, third):
    """The translation (first I + second [omega] + third [omega]^2) v."""
    T = right.screw_exp(S, theta)
    w, v = S[:3], S[3:]
    T[:3, 3] = first * v + second * np.cross(w, v) + third * np.cross(w, np.cross(w, v))
    return T


def exp_theta_everywhere(S, theta):
    T = _with_terms(S, theta, 0, 1 - np.cos(theta), theta - np.sin(theta))
    T[:3, 3] += theta * S[3:].sum()
    return T


def exp_with_v_for_q(S, theta):
    T = right.screw_exp(S, theta)
    T[:3, 3] = S[3:] - T[:3, :3] @ S[3:]
    return T


def exp_of_each_entry(S, theta):
    (x, y, z), v = S[:3], S[3:]
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]], v
    return np.exp(X * theta)


def exp_without_last_term(S, theta):
    return _with_terms(S, theta, theta, 1 - np.cos(theta), 0)


def exp_terms_exchanged(S, theta):
    return _with_terms(S, theta, theta, theta - np.sin(theta), 1 - np.cos(theta))


def exp_about_q(S, theta):
    T = right.screw_exp(S, theta)
    q = np.cross(S[:3], S[3:])
    T[:3, 3] = q - T[:3, :3] @ q
    return T


def exp_with_two_terms(S, theta):
    T = right.screw_exp(S, theta)
    T[:3, :3] = np.eye(3) + np.sin(theta) * np.cross(S[:3], np.eye(3)).T
    return T


def poe_without_M(S, M, theta):
    return right.fk_poe(S, np.eye(4), theta)


def poe_with_M_left(S, M, theta):
    return M @ right.fk_poe(S, np.eye(4), theta)


def poe_reversed(S, M, theta):
    return right.fk_poe(S[:, ::-1], M, theta[::-1])


def poe_with_M_each_time(S, M, theta):
    return reduce(np.matmul, [right.screw_exp(s, t) @ M for s, t in zip(S.T, theta, strict=True)])


def poe_with_body_screws(S, M, theta):
    inverse = np.linalg.inv(M)
    moved = [inverse @ right.screw_exp(s, t) @ M for s, t in zip(S.T, theta, strict=True)]
    return reduce(np.matmul, [*moved, M])


def poe_with_M_twice(S, M, theta):
    return M @ right.fk_poe(S, M, theta)


def poe_of_the_sum(S, M, theta):
    return right.screw_exp(S @ theta, 1) @ M


def poe_degrees(S, M, theta):
    return right.fk_poe(S, M, np.radians(theta))


def _frames(rows, base):
    """Where the frames of the rows stand at theta = 0, frame 0 first."""
    frames = [base]
    for a, alpha, d, offset in rows:
        frames.append(frames[-1] @ right.mdh_transform(a, alpha, d, offset))
    return frames


def _turn(x, y, z):
    """[A] of a turn about an axis through the origin, (4, 4)."""
    A = np.zeros((4, 4))
    A[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    return A


def _columns(matrices):
    return np.column_stack([[X[2, 1], X[0, 2], X[1, 0], *X[:3, 3]] for X in matrices])


def screws_about_x(rows, base):  # TPK4170 report, eq. 2.10
    return _columns([T @ _turn(1, 0, 0) @ np.linalg.inv(T) for T in _frames(rows, base)[1:]])


def screws_of_frame_before(rows, base):
    return _columns([T @ _turn(0, 0, 1) @ np.linalg.inv(T) for T in _frames(rows, base)[:-1]])


def screws_of_row_alone(rows, base):
    single = [base @ right.mdh_transform(*row) for row in rows]
    return _columns([T @ _turn(0, 0, 1) @ np.linalg.inv(T) for T in single])


def screws_of_standard_rows(rows, base):
    columns, T = [], base
    for row in rows:
        T = T @ right.dh_transform(*row)
        columns.append(T @ _turn(0, 0, 1) @ np.linalg.inv(T))
    return _columns(columns)


def screws_with_the_point_as_v(rows, base):
    return np.column_stack([np.append(T[:3, 2], T[:3, 3]) for T in _frames(rows, base)[1:]])


def screws_from_one_side(rows, base):
    return _columns([T @ _turn(0, 0, 1) for T in _frames(rows, base)[1:]])


def screws_by_the_inverse(rows, base):
    return _columns([np.linalg.inv(T) @ _turn(0, 0, 1) @ T for T in _frames(rows, base)[1:]])


def screws_without_v(rows, base):
    return right.screws_from_dh(rows, base) * [[1], [1], [1], [0], [0], [0]]


def screws_without_base(rows, base):
    return right.screws_from_dh(rows, np.eye(4))


def screws_without_offset(rows, base):
    return right.screws_from_dh(rows * [1, 1, 1, 0], base)


WRONG = {
    "dh_transform": {
        "alpha_for_a": dh_with_alpha_for_a,
        "entry_22": dh_with_wrong_entry,
        "a_on_old_x": dh_with_a_on_old_x,
        "modified": dh_modified,
        "degrees": dh_degrees,
        "transposed": dh_transposed,
    },
    "mdh_transform": {
        "plus_sin": mdh_plus_sin,
        "no_a": mdh_without_a,
        "standard": mdh_standard,
        "d_on_old_z": mdh_shift_along_old_z,
        "degrees": mdh_degrees,
    },
    "fk_dh": {
        "no_offset": fk_without_offset,
        "no_tool": fk_without_tool,
        "no_base": fk_without_base,
        "reversed": fk_reversed,
        "other_order": fk_other_order,
        "read_as_modified": fk_read_as_modified,
        "tool_each_time": fk_with_tool_each_time,
        "theta_first": fk_with_theta_first,
    },
    "screw_exp": {
        "v_first": exp_v_first,
        "theta_v": exp_theta_v,
        "sin_sin": exp_sin_sin,
        "no_pitch": exp_without_pitch,
        "theta_everywhere": exp_theta_everywhere,
        "slide_turns": exp_slide_turns,
        "v_for_q": exp_with_v_for_q,
        "each_entry": exp_of_each_entry,
        "no_last_term": exp_without_last_term,
        "terms_exchanged": exp_terms_exchanged,
        "about_q": exp_about_q,
        "turned_back": exp_turned_back,
        "two_terms": exp_with_two_terms,
    },
    "fk_poe": {
        "no_M": poe_without_M,
        "M_left": poe_with_M_left,
        "reversed": poe_reversed,
        "M_each_time": poe_with_M_each_time,
        "body_screws": poe_with_body_screws,
        "degrees": poe_degrees,
        "M_twice": poe_with_M_twice,
        "exp_of_sum": poe_of_the_sum,
    },
    "screws_from_dh": {
        "about_x": screws_about_x,
        "frame_before": screws_of_frame_before,
        "row_alone": screws_of_row_alone,
        "standard": screws_of_standard_rows,
        "point_as_v": screws_with_the_point_as_v,
        "one_side": screws_from_one_side,
        "no_base": screws_without_base,
        "inverse_first": screws_by_the_inverse,
        "no_v": screws_without_v,
        "no_offset": screws_without_offset,
    },
    **_nb01_tables.WRONG,
}
