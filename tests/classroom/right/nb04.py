"""Notebook 04 in other styles: each of these is right and must pass."""

from __future__ import annotations

import math

import numpy as np

# -- det_from_blocks


def det_from_blocks__exchanged(J):
    """The last three rows first: nine exchanges, then the blocks stand on the diagonal."""
    turned = np.vstack([J[3:], J[:3]])
    return (-1) ** 9 * np.linalg.det(turned[:3, :3]) * np.linalg.det(turned[3:, 3:])


def det_from_blocks__triple_products(J):
    J12, J21 = J[:3, 3:], J[3:, :3]
    return -(J12[0] @ np.cross(J12[1], J12[2])) * np.dot(np.cross(J21[:, 0], J21[:, 1]), J21[:, 2])


def det_from_blocks__lists(J):
    def det3(m):
        (a, b, c), (d, e, f), (g, h, i) = m
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    rows = J.tolist()
    upper = [row[3:] for row in rows[:3]]
    lower = [row[:3] for row in rows[3:]]
    return -det3(upper) * det3(lower)


# -- elbow_angle


def elbow_angle__math(a3, d4):
    return math.atan(a3 / d4)


def elbow_angle__longest_side(a3, d4):
    return np.arcsin(a3 / np.sqrt(a3**2 + d4**2))


def elbow_angle__complex(a3, d4):
    return np.angle(d4 + 1j * a3)


# -- shoulder_theta3


def shoulder_theta3__the_higher_one(theta2, lengths):
    a1, a2, a3, d4, _ = lengths
    k = -(a1 + a2 * math.cos(theta2)) / math.hypot(a3, d4)
    best, top = None, -math.inf
    for sign in (1, -1):
        slope = math.atan2(a3, d4) + sign * math.acos(k)
        height = a3 * math.cos(slope) - d4 * math.sin(slope)
        if height > top:
            best, top = slope - theta2, height
    return best


def shoulder_theta3__half_angle(theta2, lengths):
    """d4 cos t + a3 sin t = c with u = tan(t / 2): a quadratic equation."""
    a1, a2, a3, d4, _ = lengths
    c = -(a1 + a2 * np.cos(theta2))
    root = np.sqrt(a3**2 + d4**2 - c**2)
    both = 2 * np.arctan2([a3 + root, a3 - root], c + d4)
    height = a3 * np.cos(both) - d4 * np.sin(both)
    return both[height.argmax()] - theta2


def shoulder_theta3__where_the_forearm_ends(theta2, lengths):
    """The wrist centre is on axis 1, above the elbow's height by the third side of a triangle."""
    a1, a2, a3, d4, _ = np.asarray(lengths, dtype=float)
    back = a1 + a2 * np.cos(theta2)
    up = np.sqrt(a3**2 + d4**2 - back**2)
    return -np.arctan2(up, -back) + np.arctan2(a3, d4) - theta2


# -- rank


def rank__loop(J, tol):
    sigma = np.linalg.svd(J, compute_uv=False)
    count = 0
    for s in sigma:
        if s > tol * max(sigma):
            count += 1
    return count


def rank__numpy(J, tol):
    return np.linalg.matrix_rank(J, tol=tol * np.linalg.norm(J, 2))


def rank__norm(J, tol):
    _, S, _ = np.linalg.svd(J, full_matrices=False)
    limit = tol * np.linalg.norm(J, ord=2)
    return len([s for s in S if s > limit])


def rank__lost(J, tol):
    _, sigma, _ = np.linalg.svd(np.asarray(J, dtype=float))
    return len(sigma) - np.count_nonzero(sigma / sigma[0] <= tol)


# -- lost_motion


def lost_motion__eigh(J):
    return np.linalg.eigh(J @ J.T)[1][:, 0]


def lost_motion__rows_of_the_transpose(J):
    *_, Vt = np.linalg.svd(J.T)
    return -Vt[5]


def lost_motion__qr(J):
    """What is left of a twist when its part within the columns of J is taken away."""
    U, sigma, _ = np.linalg.svd(J)
    given = U[:, sigma > 1e-9 * sigma[0]]
    rest = np.eye(6) - given @ given.T
    k = np.argmax(np.linalg.norm(rest, axis=0))
    return rest[:, k] / np.linalg.norm(rest[:, k])


# -- theta2_system


def theta2_system__cramer(p, theta1, theta3, lengths):
    a1, d1, a2, d4 = lengths
    m, n = a2 + d4 * math.sin(theta3), d4 * math.cos(theta3)
    out = p[0] * math.cos(theta1) + p[1] * math.sin(theta1) - a1
    up = p[2] - d1
    return math.atan2(m * up + n * out, m * out - n * up)


def theta2_system__two_angles(p, theta1, theta3, lengths):
    """The direction of P from the shoulder, less the angle between it and the upper arm."""
    a1, d1, a2, d4 = lengths
    out = np.array([np.cos(theta1), np.sin(theta1), 0]) @ p - a1
    inside = np.arctan2(-d4 * np.cos(theta3), a2 + d4 * np.sin(theta3))
    return np.arctan2(p[2] - d1, out) - inside


def theta2_system__complex(p, theta1, theta3, lengths):
    a1, d1, a2, d4 = lengths
    target = complex(p[0] * np.cos(theta1) + p[1] * np.sin(theta1) - a1, p[2] - d1)
    return np.angle(target / (a2 - 1j * d4 * np.exp(1j * theta3)))
