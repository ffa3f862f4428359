"""Typical mistakes of notebook 02."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved, _nb02_drawing

right = Solved("nb02")


def home_of_the_wrist(lengths):  # TPK4170 report: 900 for 980
    return right.home_pose(lengths * [1, 1, 1, 1, 0])


def home_with_flange_along_z(lengths):  # RPI mini project 3: P_6T = L5 e_z
    T = right.home_pose(lengths)
    T[:3, 3] += lengths[4] * np.array([-1, 0, 1])
    return T


def home_with_column_along_x(lengths):  # RPI mini project 3: first row of the PoE table
    T = right.home_pose(lengths)
    T[:3, 3] += lengths[0] * np.array([1, 0, -1])
    return T


def home_without_elbow(lengths):
    return right.home_pose(lengths * [1, 1, 0, 1, 1])


def screw_with_plus(w, q):
    return right.screw_axis(w, q) * [1, 1, 1, -1, -1, -1]


def screw_v_first(w, q):
    return np.roll(right.screw_axis(w, q), 3)


def screw_not_unit(w, q):
    return right.screw_axis(w, q) * np.linalg.norm(w)


def screw_all_scaled(w, q):
    S = np.concatenate([w, -np.cross(w, q)])
    return S / np.linalg.norm(S)


def screw_with_v_not_scaled(w, q):
    return np.concatenate([right.screw_axis(w, q)[:3], -np.cross(w, q)])


def screw_with_q(w, q):
    return np.concatenate([right.screw_axis(w, q)[:3], q])


def screw_with_q_scaled(w, q):
    return right.screw_axis(w, q / np.linalg.norm(q))


def screw_entry_by_entry(w, q):
    w = right.screw_axis(w, q)[:3]
    return np.concatenate([w, -w * q])


def axis_v_cross_w(S):
    w, q, pitch = right.axis_of(S)
    return w, -q, pitch


def axis_without_pitch(S):
    w, q, _ = right.axis_of(S)
    return w, q, 0.0


def axis_through_v(S):
    w, _, pitch = right.axis_of(S)
    return w, S[3:], pitch


def axis_with_length_of_v(S):
    w, q, _ = right.axis_of(S)
    return w, q, np.linalg.norm(S[3:])


def adjoint_v_first(T):
    return np.roll(right.adjoint(T), (3, 3), axis=(0, 1))


def adjoint_R_hat_p(T):
    Ad, R = right.adjoint(T), T[:3, :3]
    Ad[3:, :3] = R @ Ad[3:, :3] @ R.T
    return Ad


def adjoint_of_inverse(T):
    return np.linalg.inv(right.adjoint(T))


def adjoint_minus_p(T):
    Ad = right.adjoint(T)
    Ad[3:, :3] *= -1
    return Ad


def adjoint_with_rows_crossed(T):
    Ad = right.adjoint(T)
    Ad[3:, :3] = np.cross(T[:3, 3], T[:3, :3])
    return Ad


def adjoint_without_p(T):
    Ad = right.adjoint(T)
    Ad[3:, :3] = 0
    return Ad


def adjoint_with_p_alone(T):
    Ad = right.adjoint(T)
    Ad[3:, :3] = Ad[3:, :3] @ T[:3, :3].T
    return Ad


def adjoint_with_R_transposed(T):
    turned = np.array(T, float)
    turned[:3, :3] = T[:3, :3].T
    return right.adjoint(turned)


def adjoint_with_identity_below(T):
    Ad = right.adjoint(T)
    Ad[3:, 3:] = np.eye(3)
    return Ad


def body_by_ad_of_M(S, M):
    return right.adjoint(M) @ S


def body_by_transpose(S, M):
    return right.adjoint(M).T @ S


def body_with_minus_p(S, M):
    inverse = np.linalg.inv(M)
    inverse[:3, 3] = -M[:3, 3]
    return right.adjoint(inverse) @ S


def body_only_turned(S, M):
    turn = np.eye(4)
    turn[:3, :3] = M[:3, :3].T
    return right.adjoint(turn) @ S


def body_only_shifted(S, M):
    shift = np.eye(4)
    shift[:3, 3] = -M[:3, 3]
    return right.adjoint(shift) @ S


WRONG = {
    "home_pose": {
        "wrist": home_of_the_wrist,
        "flange_along_z": home_with_flange_along_z,
        "column_along_x": home_with_column_along_x,
        "without_elbow": home_without_elbow,
    },
    "screw_axis": {
        "plus": screw_with_plus,
        "v_first": screw_v_first,
        "not_unit": screw_not_unit,
        "all_scaled": screw_all_scaled,
        "v_not_scaled": screw_with_v_not_scaled,
        "q_itself": screw_with_q,
        "q_scaled": screw_with_q_scaled,
        "entrywise": screw_entry_by_entry,
    },
    "axis_of": {
        "v_cross_w": axis_v_cross_w,
        "no_pitch": axis_without_pitch,
        "v_for_q": axis_through_v,
        "whole_v": axis_with_length_of_v,
    },
    "adjoint": {
        "v_first": adjoint_v_first,
        "R_hat_p": adjoint_R_hat_p,
        "inverse": adjoint_of_inverse,
        "minus_p": adjoint_minus_p,
        "rows_crossed": adjoint_with_rows_crossed,
        "no_p": adjoint_without_p,
        "no_R": adjoint_with_p_alone,
        "R_transposed": adjoint_with_R_transposed,
        "I_below": adjoint_with_identity_below,
    },
    "body_screws": {
        "ad_of_M": body_by_ad_of_M,
        "transposed": body_by_transpose,
        "minus_p": body_with_minus_p,
        "only_turned": body_only_turned,
        "only_shifted": body_only_shifted,
    },
    **_nb02_drawing.WRONG,
}
