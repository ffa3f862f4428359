"""Typical mistakes of notebook 02 with drawings: joints of both kinds, a whole arm, another space frame."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb02")


def joint_always_hinge(kind, w, q):
    return right.joint_screw("revolute", w, q)


def joint_v_first(kind, w, q):
    return np.roll(right.joint_screw(kind, w, q), 3)


def joint_slide_on_top(kind, w, q):
    S = right.joint_screw(kind, w, q)
    return np.roll(S, 3) if kind == "prismatic" else S


def joint_slide_not_unit(kind, w, q):
    S = right.joint_screw(kind, w, q)
    return S * np.linalg.norm(w) if kind == "prismatic" else S


def joint_slide_with_lever(kind, w, q):
    S = right.joint_screw("revolute", w, q)
    return np.concatenate([np.zeros(3), S[3:]]) if kind == "prismatic" else S


def joint_both_halves(kind, w, q):
    S = right.joint_screw(kind, w, q)
    return np.concatenate([S[3:], S[3:]]) if kind == "prismatic" else S


def joint_slide_of_q(kind, w, q):
    return right.joint_screw(kind, w, q) if kind == "revolute" else np.append(np.zeros(3), q)


def arm_not_turned(lengths):
    M, S = right.home_and_screws(lengths)
    M[:3, :3] = np.eye(3)
    return M, S


def arm_with_tool_above(lengths):
    M, S = right.home_and_screws(lengths)
    M[2, 3] += 2 * lengths[4]
    return M, S


def arm_at_the_wrist(lengths):
    return right.home_and_screws(lengths * [1, 1, 1, 1, 0])


def arm_into_the_page(lengths):
    M, S = right.home_and_screws(lengths)
    S[:, 1] *= -1
    return M, S


def arm_of_hinges(lengths):
    A, B, C, _, _ = lengths
    M, S = right.home_and_screws(lengths)
    S[:, 2] = right.screw_axis(np.array([1.0, 0, 0]), np.array([A, 0, B + C]))
    return M, S


def arm_without_C(lengths):
    return right.home_and_screws(lengths * [1, 1, 0, 1, 1])


def arm_with_plus(lengths):
    M, S = right.home_and_screws(lengths)
    S[3:, S[:3].any(axis=0)] *= -1
    return M, S


def frame_only_M(S, M, T):
    return S, T @ M


def frame_only_S(S, M, T):
    return right.from_another_frame(S, M, T)[0], M


def frame_inverse(S, M, T):
    return right.from_another_frame(S, M, np.linalg.inv(T))


def frame_M_right(S, M, T):
    return right.from_another_frame(S, M, T)[0], M @ T


def frame_moved_as_body(S, M, T):
    return right.from_another_frame(S, M, np.linalg.inv(T))[0], T @ M


def frame_body_screws(S, M, T):
    return right.body_screws(S, M), T @ M


def frame_only_turned(S, M, T):
    turned = np.array(T, float)
    turned[:3, 3] = 0
    return right.from_another_frame(S, M, turned)[0], T @ M


def frame_with_M_shifted(S, M, T):
    shifted = np.array(M, float)
    shifted[:3, 3] += T[:3, 3]
    return right.from_another_frame(S, M, T)[0], shifted


WRONG = {
    "joint_screw": {
        "always_hinge": joint_always_hinge,
        "v_first": joint_v_first,
        "slide_on_top": joint_slide_on_top,
        "slide_not_unit": joint_slide_not_unit,
        "slide_with_lever": joint_slide_with_lever,
        "both_halves": joint_both_halves,
        "slide_of_q": joint_slide_of_q,
    },
    "home_and_screws": {
        "not_turned": arm_not_turned,
        "tool_above": arm_with_tool_above,
        "at_the_wrist": arm_at_the_wrist,
        "into_the_page": arm_into_the_page,
        "all_hinges": arm_of_hinges,
        "without_C": arm_without_C,
        "plus": arm_with_plus,
    },
    "from_another_frame": {
        "only_M": frame_only_M,
        "only_S": frame_only_S,
        "inverse": frame_inverse,
        "M_right": frame_M_right,
        "moved_as_body": frame_moved_as_body,
        "body": frame_body_screws,
        "only_turned": frame_only_turned,
        "M_shifted": frame_with_M_shifted,
    },
}
