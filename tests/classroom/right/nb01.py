"""Notebook 01 in other styles: half steps, plain lists and math, closed forms."""

from __future__ import annotations

import math
from functools import reduce

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb01")


# ---- one row


def _step(axis, angle, length):
    """A turn about an axis and a shift along it."""
    T = np.eye(4)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    T[j, j] = T[k, k] = np.cos(angle)
    T[j, k], T[k, j] = -np.sin(angle), np.sin(angle)
    T[axis, 3] = length
    return T


def dh_transform__half_steps(a, alpha, d, theta):
    return _step(2, theta, d) @ _step(0, alpha, a)


def dh_transform__lists(a, alpha, d, theta):
    c, s = math.cos(theta), math.sin(theta)
    T = [[0] * 4 for _ in range(4)]
    T[0] = [c, -s * math.cos(alpha), s * math.sin(alpha), c * a]
    T[1] = [s, c * math.cos(alpha), -c * math.sin(alpha), s * a]
    T[2][1:] = [math.sin(alpha), math.cos(alpha), d]
    T[3][3] = 1
    return T


def dh_transform__axes(a, alpha, d, theta):
    x = np.array([np.cos(theta), np.sin(theta), 0])
    side = np.cross([0, 0, 1], x)
    z = np.cos(alpha) * np.array([0, 0, 1]) - np.sin(alpha) * side
    T = np.identity(4)
    T[:3] = np.stack([x, np.cross(z, x), z, a * x + d * np.array([0, 0, 1])], axis=1)
    return T


def mdh_transform__half_steps(a_prev, alpha_prev, d, theta):
    return _step(0, alpha_prev, a_prev) @ _step(2, theta, d)


def mdh_transform__lists(a_prev, alpha_prev, d, theta):
    c, s, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha_prev), math.sin(alpha_prev)
    return [[c, -s, 0, a_prev], [s * ca, c * ca, -sa, -sa * d], [s * sa, c * sa, ca, ca * d], [0, 0, 0, 1]]


def mdh_transform__complex(a_prev, alpha_prev, d, theta):
    t, al = np.exp(1j * theta), np.exp(1j * alpha_prev)
    T = np.zeros((4, 4))
    T[:3, 0] = t.real, t.imag * al.real, t.imag * al.imag
    T[:3, 2] = 0, -al.imag, al.real
    T[:3, 1] = np.cross(T[:3, 2], T[:3, 0])
    T[:3, 3] = a_prev * np.eye(3)[0] + d * T[:3, 2]
    T[3, 3] = 1
    return T


# ---- the whole arm


def fk_dh__reduced(rows, theta, base, tool):
    links = [right.dh_transform(a, alpha, d, o + t) for (a, alpha, d, o), t in zip(rows, theta, strict=True)]
    return reduce(np.matmul, [base, *links, tool])


def fk_dh__tool_inwards(rows, theta, base, tool):
    T = np.array(tool, dtype=float)
    for i in reversed(range(len(rows))):
        a, alpha, d, offset = rows[i]
        T = right.dh_transform(a, alpha, d, theta[i] + offset).dot(T)
    return base.dot(T)


def fk_dh__new_table(rows, theta, base, tool):
    table = np.array(rows, dtype=float)
    table[:, 3] += theta
    T = base.copy()
    for row in table:
        T = np.einsum("ij,jk->ik", T, right.dh_transform(*row))
    return np.linalg.multi_dot([T, tool])


def _bracket(w):
    return np.cross(w, np.eye(3)).T


def screw_exp__cases(S, theta):
    w, v = np.asarray(S, float)[:3], np.asarray(S, float)[3:]
    T = np.eye(4)
    if not w.any():
        T[:3, 3] = theta * v
        return T
    R = np.cos(theta) * np.eye(3) + np.sin(theta) * _bracket(w) + (1 - np.cos(theta)) * np.outer(w, w)
    q = np.cross(w, v)
    T[:3, :3], T[:3, 3] = R, q - R @ q + theta * np.dot(w, v) * w
    return T


def screw_exp__series(S, theta):
    x, y, z, *v = S
    X = theta * np.array([[0, -z, y, v[0]], [z, 0, -x, v[1]], [-y, x, 0, v[2]], [0, 0, 0, 0]])
    X = X / 64
    term = total = np.eye(4)
    for k in range(1, 16):
        term = term @ X / k
        total = total + term
    return np.linalg.matrix_power(total, 64)


def screw_exp__crosses(S, theta):
    w, v = S[:3], S[3:]
    s, c = math.sin(theta), 1 - math.cos(theta)
    columns = [e + s * np.cross(w, e) + c * np.cross(w, np.cross(w, e)) for e in np.eye(3)]
    p = theta * v + c * np.cross(w, v) + (theta - s) * np.cross(w, np.cross(w, v))
    return np.vstack([np.column_stack([*columns, p]), [0, 0, 0, 1]])


def fk_poe__reduced(S, M, theta):
    return reduce(np.dot, [right.screw_exp(S[:, i], theta[i]) for i in range(S.shape[1])] + [M])


def fk_poe__from_the_tool(S, M, theta):
    T = M
    for i in range(len(theta) - 1, -1, -1):
        T = right.screw_exp(S[:, i], theta[i]) @ T
    return T


def fk_poe__transposed(S, M, theta):
    T = np.array(M, float).T
    for screw, angle in reversed(list(zip(np.transpose(S), theta, strict=True))):
        T = T @ right.screw_exp(screw, angle).T
    return T.T


# ---- screws of a table


def screws_from_dh__lines(rows, base):
    T, S = np.array(base, float), np.empty((6, len(rows)))
    for i, row in enumerate(rows):
        T = T @ right.mdh_transform(*row)
        S[:3, i], S[3:, i] = T[:3, 2], np.cross(T[:3, 3], T[:3, 2])
    return S


def screws_from_dh__adjoint(rows, base):
    columns = []
    for i in range(len(rows)):
        T = reduce(np.matmul, [right.mdh_transform(*row) for row in rows[: i + 1]], base)
        R, p = T[:3, :3], T[:3, 3]
        Ad = np.block([[R, np.zeros((3, 3))], [_bracket(p) @ R, R]])
        columns.append(Ad @ [0, 0, 1, 0, 0, 0])
    return np.stack(columns, axis=-1)


def screws_from_dh__brackets(rows, base):
    A = np.zeros((4, 4))
    A[:2, :2] = [[0, -1], [1, 0]]
    frames = [base]
    for a, alpha, d, offset in rows:
        frames.append(frames[-1] @ right.mdh_transform(a, alpha, d, offset))
    X = np.array([T @ A @ np.linalg.inv(T) for T in frames[1:]])
    return np.array([X[:, 2, 1], X[:, 0, 2], X[:, 1, 0], X[:, 0, 3], X[:, 1, 3], X[:, 2, 3]])


# ---- tables: making one, joints of both kinds, ranges


def dh_table__other_elbow(lengths):
    """z_3 points back along the forearm: d_4 is negative, and the wrist turns the other way."""
    height, offset, upper, forearm, flange = lengths
    q = math.pi / 2
    return [
        [offset, q, height, 0],
        [upper, 0, 0, q],
        [0, q, 0, math.pi],
        [0, q, -forearm, 0],
        [0, q, 0, 0],
        [0, 0, flange, 0],
    ]


def dh_table__wrist_forward(lengths):
    """x_4 up, x_5 down; x_6 in any direction."""
    h, o, u, f, t = lengths
    rows = np.zeros((6, 4))
    rows[:, 0] = o, u, 0, 0, 0, 0
    rows[:, 1] = np.array([1, 0, 1, 1, 1, 0]) * np.pi / 2
    rows[:, 2] = h, 0, 0, f, 0, t
    rows[:, 3] = 0, np.pi / 2, 0, 0, np.pi, 0.3
    return rows


def dh_table__columns(lengths):
    h, o, u, f, t = lengths
    a, d = [o, u, 0, 0, 0, 0], [h, 0, 0, f, 0, t]
    alpha, theta = np.radians([90, 0, 90, 90, 90, 0]), np.radians([0, 90, 0, 180, -180, 90])
    return np.column_stack([a, alpha, d, theta])


def joint_transform__added(row, q, kind):
    step = [0, 0, q, 0] if kind == "prismatic" else [0, 0, 0, q]
    return right.dh_transform(*(x + y for x, y in zip(row, step, strict=True)))


def joint_transform__half_steps(row, q, kind):
    slides = kind == "prismatic"
    return _step(2, row[3] + q * (not slides), row[2] + q * slides) @ _step(0, row[1], row[0])


def joint_transform__moved_first(row, q, kind):
    """The joint moves about or along the old z, before the row as it is at zero."""
    first = _step(2, 0, q) if kind.startswith("p") else _step(2, q, 0)
    return first @ right.dh_transform(*row)


def ranges_to_dh__loop(limits, sense, at_zero):
    rows = []
    for (low, high), s, zero in zip(limits, sense, at_zero, strict=True):
        rows.append((zero + low, zero + high) if s > 0 else (zero - high, zero - low))
    return rows


def ranges_to_dh__where(limits, sense, at_zero):
    turned = np.where(sense[:, None] > 0, limits, -limits[:, ::-1])
    return turned + at_zero[:, None]


def ranges_to_dh__lists(limits, sense, at_zero):
    ends = [[z + s * x for x in pair] for pair, s, z in zip(limits, sense, at_zero, strict=True)]
    return [[min(pair), max(pair)] for pair in ends]
