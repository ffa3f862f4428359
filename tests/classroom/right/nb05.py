"""Notebook 05: right answers as other people write them."""

from __future__ import annotations

import math

import numpy as np

from coursekit.kinematics import lie


def jacobian_space__loop(S, theta):
    n = len(theta)
    J = np.zeros((6, n))
    for i in range(n):
        T = np.eye(4)
        for j in range(i):
            T = T @ lie.exp6(S[:, j] * theta[j])
        J[:, i] = lie.adjoint(T) @ S[:, i]
    return J


def jacobian_space__backwards(S, theta):
    """The last axis first: every joint before carries all columns that are there already."""
    S = np.asarray(S, float)
    J = S[:, -1:]
    for i in reversed(range(S.shape[1] - 1)):
        J = np.hstack([S[:, i : i + 1], lie.adjoint(lie.exp6(S[:, i] * theta[i])) @ J])
    return J


def jacobian_space__by_axes(S, theta):
    """Without an adjoint: turn the axis and the moment, then add the lever."""
    columns, R, p = [], np.eye(3), np.zeros(3)
    for screw, angle in zip(S.T, theta, strict=True):
        w, v = R @ screw[:3], R @ screw[3:]
        columns.append([*w, *(v + np.cross(p, w))])
        T = lie.exp6(screw * angle)
        R, p = R @ T[:3, :3], R @ T[:3, 3] + p
    return np.array(columns).T


def jacobian_geometric__loop(axes, origins, tool):
    J = np.zeros((6, len(axes)))
    for i in range(len(axes)):
        J[:3, i] = axes[i]
        J[3:, i] = np.cross(axes[i], tool - origins[i])
    return J


def jacobian_geometric__matrices(axes, origins, tool):
    columns = [np.r_[w, lie.hat3(w) @ (tool - o)] for w, o in zip(axes, origins, strict=True)]
    return np.array(columns).T


def jacobian_geometric__lists(axes, origins, tool):
    rows = [[] for _ in range(6)]
    for (a, b, c), (ox, oy, oz) in zip(axes.tolist(), origins.tolist(), strict=True):
        x, y, z = tool[0] - ox, tool[1] - oy, tool[2] - oz
        for row, entry in zip(rows, (a, b, c, b * z - c * y, c * x - a * z, a * y - b * x), strict=True):
            row.append(entry)
    return rows


def jacobian_by_differences__loop(fk, theta, step):
    n = len(theta)
    J = np.zeros((6, n))
    for i in range(n):
        plus, minus = theta.astype(float), theta.astype(float)
        plus[i] += step
        minus[i] -= step
        A, B = fk(plus), fk(minus)
        J[:3, i] = lie.log3(A[:3, :3] @ B[:3, :3].T) / (2 * step)
        J[3:, i] = (A[:3, 3] - B[:3, 3]) / (2 * step)
    return J


def jacobian_by_differences__entries(fk, theta, step):
    """[omega] = R-dot R^T, with R-dot as a difference of entries."""
    R, columns = fk(theta)[:3, :3], []
    for i in range(len(theta)):
        d = np.array([step if j == i else 0.0 for j in range(len(theta))])
        change = (fk(theta + d) - fk(theta - d)) / (2 * step)
        W = change[:3, :3] @ R.T
        w = lie.vee3((W - W.T) / 2)
        columns.append(np.concatenate([w, change[:3, 3]]))
    return np.stack(columns, axis=1)


def jacobian_by_differences__einsum(fk, theta, step):
    moves = step * np.eye(len(theta))
    poses = fk(theta + np.stack([moves, -moves]))
    turns = np.einsum("nij,nkj->nik", poses[0, :, :3, :3], poses[1, :, :3, :3])
    v = poses[0, :, :3, 3] - poses[1, :, :3, 3]
    return np.concatenate([lie.log3(turns), v], axis=1).T / 2 / step


def ellipsoid__eigh(J):
    values, vectors = np.linalg.eigh(J @ J.T)
    return np.sqrt(np.clip(values, 0, None))[::-1], vectors[:, ::-1]


def ellipsoid__sorted(J):
    values, vectors = np.linalg.eig(J @ J.T)
    order = np.argsort(-values)
    return [math.sqrt(max(values[i], 0)) for i in order], np.stack([vectors[:, i] for i in order], axis=1)


def ellipsoid__transposed(J):
    _, lengths, rows = np.linalg.svd(J.T, full_matrices=False)
    return lengths, rows.T


def dls_step__inverse(J, e, k):
    n = J.shape[1]
    return np.linalg.inv(J.T @ J + k**2 * np.identity(n)) @ J.T @ e


def dls_step__singular(J, e, k):
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    return Vt.T @ (sigma / (sigma**2 + k**2) * (U.T @ e))


def dls_step__least_squares(J, e, k):
    """Least squares of J step = e and k step = 0 at once."""
    n = J.shape[1]
    A = np.vstack([J, k * np.eye(n)])
    return np.linalg.lstsq(A, np.append(e, np.zeros(n)), rcond=None)[0]


def tool_velocity__math(theta, rate, lengths):
    t1, t12 = theta[0], theta[0] + theta[1]
    r1, r12 = rate[0], rate[0] + rate[1]
    x = -lengths[0] * math.sin(t1) * r1 - lengths[1] * math.sin(t12) * r12
    y = lengths[0] * math.cos(t1) * r1 + lengths[1] * math.cos(t12) * r12
    c, s = math.cos(t12), math.sin(t12)
    return [x, y], [c * x + s * y, -s * x + c * y]


def tool_velocity__complex(theta, rate, lengths):
    turns = np.exp(1j * np.cumsum(theta))
    v = np.sum(1j * np.cumsum(rate) * lengths * turns)
    seen = v / turns[1]
    return np.array([v.real, v.imag]), np.array([seen.real, seen.imag])


def tool_velocity__from_the_tool(theta, rate, lengths):
    """v_E first: the tool goes with link 2 along its own y, and with the elbow."""
    a1, a2 = lengths
    v_E = np.array([a1 * np.sin(theta[1]) * rate[0], a1 * np.cos(theta[1]) * rate[0] + a2 * sum(rate)])
    c, s = np.cos(sum(theta)), np.sin(sum(theta))
    return np.array([[c, -s], [s, c]]) @ v_E, v_E
