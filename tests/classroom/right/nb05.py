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


def transform_rate__by_hat6(T_left, S, theta, T_right):
    """All in one chain of four by four matrices, as the notebook writes it."""
    H = lie.exp6(S * theta)
    T = T_left @ H @ T_right
    T_o = np.eye(4)
    T_o[:3, :3] = T[:3, :3].T
    T_dot = T_left @ H @ lie.hat6(S) @ T_right  # [S] and its exponential may change places
    return T_dot, lie.vee6(T_dot @ T_o)


def transform_rate__by_adjoint(T_left, S, theta, T_right):
    """The column first: the screw carried to the base, its v moved to the tool; then T-dot from it."""
    w, v = np.split(lie.adjoint(T_left) @ np.asarray(S, float), 2)
    T = T_left @ lie.exp6(np.multiply(S, theta)) @ T_right
    p = T[:3, 3]
    return lie.hat6(np.concatenate([w, v])) @ T, [*w, *(v + np.cross(w, p))]


def transform_rate__blocks(T_left, S, theta, T_right):
    H = lie.exp6(S * float(theta))
    H_dot = np.zeros((4, 4))
    H_dot[:3, :3] = lie.hat3(S[:3]) @ H[:3, :3]
    H_dot[:3, 3] = np.cross(S[:3], H[:3, 3]) + S[3:]
    T_dot = np.linalg.multi_dot([T_left, H_dot, T_right])
    R = np.linalg.multi_dot([T_left, H, T_right])[:3, :3]
    W = np.einsum("ij,kj->ik", T_dot[:3, :3], R)
    return T_dot, np.r_[
        (W[2, 1] - W[1, 2]) / 2, (W[0, 2] - W[2, 0]) / 2, (W[1, 0] - W[0, 1]) / 2, T_dot[:3, 3]
    ]


def torques__base_jacobian(J_b, T, moment, force):
    """Turn the Jacobian instead of the force."""
    R = T[:3, :3]
    return (R @ J_b[:3]).T @ moment + (R @ J_b[3:]).T @ force


def torques__joint_by_joint(J_b, T, moment, force):
    answer = []
    for column in np.transpose(J_b):
        w, v = T[:3, :3] @ column[:3], T[:3, :3] @ column[3:]
        answer.append(float(w @ moment + v @ force))
    return answer


def torques__by_adjoint(J_b, T, moment, force):
    turn = np.eye(4)
    turn[:3, :3] = T[:3, :3]
    return np.concatenate([moment, force]) @ lie.adjoint(turn) @ J_b


def dls_loop__filled(robot, T_sd, theta, k, steps):
    q = np.empty((steps + 1, robot.n))
    q[0] = theta
    for i in range(1, steps + 1):
        e = lie.log6(np.linalg.inv(robot.fk(q[i - 1])) @ T_sd)
        J = robot.jacobian_body(q[i - 1])
        q[i] = q[i - 1] + J.T @ np.linalg.solve(J @ J.T + k**2 * np.eye(6), e)
    return q


def dls_loop__array(robot, T_sd, theta, k, steps):
    q = np.zeros((steps + 1, len(theta)))
    q[0] = theta
    for i in range(steps):
        e = lie.log6(np.linalg.inv(robot.fk(q[i])) @ T_sd)
        J = robot.jacobian_body(q[i])
        q[i + 1] = q[i] + J.T @ np.linalg.inv(J @ J.T + k * k * np.eye(6)) @ e
    return q


def dls_loop__narrow(robot, T_sd, theta, k, steps):
    """The other formula, which damping makes regular."""
    rows = [np.array(theta, dtype=float)]
    while len(rows) <= steps:
        J, e = robot.jacobian_body(rows[-1]), lie.log6(lie.inverse(robot.fk(rows[-1])) @ T_sd)
        rows.append(rows[-1] + np.linalg.solve(J.T @ J + k**2 * np.eye(len(theta)), J.T @ e))
    return rows


def dls_loop__recursive(robot, T_sd, theta, k, steps):
    theta = np.asarray(theta, float)
    if steps == 0:
        return theta[None]
    U, sigma, Vt = np.linalg.svd(robot.jacobian_body(theta), full_matrices=False)
    e = lie.log6(lie.inverse(robot.fk(theta)) @ T_sd)
    following = theta + Vt.T @ (sigma / (sigma**2 + k**2) * (U.T @ e))
    return np.vstack([theta, dls_loop__recursive(robot, T_sd, following, k, steps - 1)])
