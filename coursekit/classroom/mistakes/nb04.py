"""Typical mistakes of notebook 04."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb04")


def blocks_without_sign(J):  # TPK4170 report, eq. 5.6
    return np.linalg.det(J[:3, 3:]) * np.linalg.det(J[3:, :3])


def blocks_on_the_diagonal(J):
    return np.linalg.det(J[:3, :3]) * np.linalg.det(J[3:, 3:])


def sizes_of_the_blocks(J):  # TPK4170 report, eq. 5.7: a block is 0
    return -np.linalg.norm(J[:3, 3:]) * np.linalg.norm(J[3:, :3])


def shoulder(theta2, a1, a2, a3, d4, *, higher=-1):
    reach = np.clip(-(a1 + a2 * np.cos(theta2)) / np.hypot(a3, d4), -1, 1)
    return np.arctan2(a3, d4) + higher * np.arccos(reach) - theta2


def shoulder_of_the_flange(theta2, lengths):  # theta5 taken into account: TPK4170 report, table 5.1, case 3
    a1, a2, a3, d4, d6 = lengths
    return shoulder(theta2, a1, a2, a3, d4 + d6)


def shoulder_turning_upwards(theta2, lengths):
    _, _, a3, d4, _ = lengths
    bend = right.shoulder_theta3(theta2, lengths) + theta2 - np.arctan2(a3, d4)
    return -bend - np.arctan2(a3, d4) - theta2


def shoulder_without_a1(theta2, lengths):
    _, a2, a3, d4, _ = lengths
    return shoulder(theta2, 0, a2, a3, d4)


def shoulder_without_a3(theta2, lengths):
    a1, a2, _, d4, _ = lengths
    return shoulder(theta2, a1, a2, 0, d4)


def shoulder_leading_forth(theta2, lengths):
    a1, a2, a3, d4, _ = lengths
    reach = np.clip((a1 + a2 * np.cos(theta2)) / np.hypot(a3, d4), -1, 1)
    return np.arctan2(a3, d4) - np.arccos(reach) - theta2


def shoulder_with_swapped_legs(theta2, lengths):
    a1, a2, a3, d4, _ = lengths
    reach = np.clip(-(a1 + a2 * np.cos(theta2)) / np.hypot(a3, d4), -1, 1)
    return np.arctan2(d4, a3) - np.arccos(reach) - theta2


def _system(p, theta1, theta3, lengths, sign=1.0):
    """cos(theta_2) and sin(theta_2) of the exam's eq. 5; sign: of the lower left entry."""
    a1, d1, a2, d4 = lengths
    s, c = np.sin(theta3), np.cos(theta3)
    b = [p[0] * np.cos(theta1) + p[1] * np.sin(theta1) - a1, p[2] - d1]
    return np.linalg.solve([[a2 + d4 * s, d4 * c], [-sign * d4 * c, a2 + d4 * s]], b)


def theta2_swapped(p, theta1, theta3, lengths):
    return np.arctan2(*_system(p, theta1, theta3, lengths))


def theta2_without(p, theta1, theta3, lengths, which):
    lengths = np.array(lengths, float)
    lengths[which] = 0
    return right.theta2_system(p, theta1, theta3, lengths)


def theta2_transposed(p, theta1, theta3, lengths):  # the other sign of cos(theta_3) does just that
    return np.arctan2(*_system(p, theta1, np.pi - theta3, lengths)[::-1])


def theta2_with_one_sign(p, theta1, theta3, lengths):
    return np.arctan2(*_system(p, theta1, theta3, lengths, sign=-1.0)[::-1])


def theta2_to_the_front(p, theta1, theta3, lengths):
    return right.theta2_system([np.hypot(p[0], p[1]), 0, p[2]], 0, theta3, lengths)


def theta2_by_a_quotient(p, theta1, theta3, lengths):
    return right.theta2_system([p[0] / np.cos(theta1), 0, p[2]], 0, theta3, lengths)


def theta2_by_arccos(p, theta1, theta3, lengths):
    return np.arccos(np.clip(_system(p, theta1, theta3, lengths)[0], -1, 1))


def theta2_by_arcsin(p, theta1, theta3, lengths):
    return np.arcsin(np.clip(_system(p, theta1, theta3, lengths)[1], -1, 1))


def theta2_by_arctan(p, theta1, theta3, lengths):
    cosine, sine = _system(p, theta1, theta3, lengths)
    return np.arctan(sine / cosine) if abs(cosine) > 1e-9 else right.theta2_system(p, theta1, theta3, lengths)


def theta2_without_a1_twice(p, theta1, theta3, lengths):
    return right.theta2_system(p, theta1, theta3, np.array(lengths) * [2, 1, 1, 1])


def rank_by_determinant(J, tol):
    n = min(J.shape)
    square = J @ J.T if J.shape[0] == n else J.T @ J
    return n if np.sqrt(abs(np.linalg.det(square))) > tol else n - 1


def rank_by_squares(J, tol):
    squares = np.linalg.eigvalsh(J @ J.T)
    return int((squares > tol * squares.max()).sum())


def rank_of_the_sizes(J, tol):
    sigma = np.linalg.svd(J)[1]
    return sigma[sigma > tol * sigma[0]].sum()


def rank_of_the_lost(J, tol):
    sigma = np.linalg.svd(J)[1]
    return int((sigma < tol * sigma[0]).sum())


WRONG = {
    "det_from_blocks": {
        "no_sign": blocks_without_sign,
        "diagonal": blocks_on_the_diagonal,
        "diagonal_sign": lambda J: -blocks_on_the_diagonal(J),
        "sizes": sizes_of_the_blocks,
        "arm_only": lambda J: np.linalg.det(J[3:, :3]),
        "two_products": lambda J: blocks_on_the_diagonal(J) - blocks_without_sign(J),
        "whole": lambda J: np.linalg.det(J),
        "two_rows": lambda J: -np.linalg.det(J[1:3, 4:6]) * np.linalg.det(J[4:6, 1:3]),
    },
    "elbow_angle": {
        "inverted": lambda a3, d4: np.arctan(d4 / a3),
        "swapped": lambda a3, d4: np.arctan2(d4, a3),
        "ratio": lambda a3, d4: a3 / d4,
        "sine": lambda a3, d4: np.arcsin(a3 / d4),
        "rounded": lambda a3, d4: np.round(right.elbow_angle(a3, d4), 3),  # table 5.1: 0.083
        "sign": lambda a3, d4: -right.elbow_angle(a3, d4),
    },
    "shoulder_theta3": {
        "order": lambda theta2, lengths: shoulder(theta2, lengths[0], *lengths[2:]),
        "flange": shoulder_of_the_flange,
        "rounded": lambda theta2, lengths: np.round(right.shoulder_theta3(theta2, lengths), 3),
        "no_a1": shoulder_without_a1,
        "no_a3": shoulder_without_a3,
        "lower": lambda theta2, lengths: shoulder(theta2, *lengths[:4], higher=1),
        "forth": shoulder_leading_forth,
        "upwards": shoulder_turning_upwards,
        "swapped_legs": shoulder_with_swapped_legs,
        "sum": lambda theta2, lengths: theta2 + right.shoulder_theta3(theta2, lengths),
    },
    "theta2_system": {
        "swapped": theta2_swapped,
        "no_a1": lambda p, theta1, theta3, lengths: theta2_without(p, theta1, theta3, lengths, 0),
        "no_d1": lambda p, theta1, theta3, lengths: theta2_without(p, theta1, theta3, lengths, 1),
        "one_sign": theta2_with_one_sign,
        "transposed": theta2_transposed,
        "front_only": theta2_to_the_front,
        "divided": theta2_by_a_quotient,
        "one_quadrant": theta2_by_arccos,
        "arcsin": theta2_by_arcsin,
        "arctan": theta2_by_arctan,
        "a1_twice": theta2_without_a1_twice,
    },
    "rank": {
        "determinant": rank_by_determinant,
        "absolute": lambda J, tol: int((np.linalg.svd(J)[1] > tol).sum()),
        "squares": rank_by_squares,
        "frobenius": lambda J, tol: int((np.linalg.svd(J)[1] > tol * np.linalg.norm(J)).sum()),
        "lost": rank_of_the_lost,
        "added": rank_of_the_sizes,
    },
    "lost_motion": {
        "joint_rates": lambda J: np.linalg.svd(J)[2][-1],
        "v_first": lambda J: np.roll(right.lost_motion(J), 3),
        "row_of_u": lambda J: np.linalg.svd(J)[0][-1],
        "easiest": lambda J: np.linalg.svd(J)[0][:, 0],
    },
}
