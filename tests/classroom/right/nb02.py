"""Notebook 02 in other styles: products of poses, plain lists, least squares, brackets."""

from __future__ import annotations

import math

import numpy as np

from coursekit.classroom.mistakes import Solved

right = Solved("nb02")


def _shift(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def home_pose__steps(lengths):
    up, arm, elbow, forearm, flange = lengths
    steps = [(0, 0, up), (0, 0, arm), (0, 0, elbow), (forearm, 0, 0), (flange, 0, 0)]
    M = np.identity(4)
    for step in steps:
        M = M @ _shift(*step)
    return M


def home_pose__lists(lengths):
    forward, height = lengths[3] + lengths[4], lengths[0] + lengths[1] + lengths[2]
    return [[1, 0, 0, forward], [0, 1, 0, 0], [0, 0, 1, height], [0, 0, 0, 1]]


def home_pose__sums(lengths):
    return np.block([[np.eye(3), np.array([[sum(lengths[3:])], [0], [sum(lengths[:3])]])], [np.zeros(3), 1]])


def screw_axis__lists(w, q):
    size = math.sqrt(sum(x * x for x in w))
    x, y, z = (value / size for value in w)
    return [x, y, z, q[1] * z - q[2] * y, q[2] * x - q[0] * z, q[0] * y - q[1] * x]


def screw_axis__q_cross_w(w, q):
    w = np.array(w, dtype=float)
    w /= np.sqrt(w @ w)
    return np.hstack([w, np.cross(q, w)])


def screw_axis__matrix(w, q):
    a, b, c = q
    S = np.zeros(6)
    S[:3] = w / np.sum(w**2) ** 0.5
    S[3:] = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]]) @ S[:3]
    return S


def axis_of__least_squares(S):
    w, v = S[:3], S[3:]
    pitch = np.dot(w, v)
    bracket = np.cross(w, np.eye(3)).T
    return w, np.linalg.lstsq(-bracket, v - pitch * w, rcond=None)[0], pitch


def axis_of__lists(S):
    a, b, c, x, y, z = S
    return [a, b, c], [b * z - c * y, c * x - a * z, a * y - b * x], a * x + b * y + c * z


def axis_of__any_length(S):
    length = np.linalg.norm(S[:3])
    w, v = np.split(S / length, 2)
    return w, np.cross(w, v), float(np.sum(w * v))


def adjoint__columns(T):
    R, p = T[:3, :3], T[:3, 3]
    turning = [np.concatenate([axis, np.cross(p, axis)]) for axis in R.T]
    sliding = [np.concatenate([np.zeros(3), axis]) for axis in R.T]
    return np.column_stack(turning + sliding)


def adjoint__kron(T):
    R, p = T[:3, :3], T[:3, 3]
    A = np.kron(np.eye(2), R)
    A[3:, :3] = np.cross(p, R, axisb=0, axisc=0)
    return A


def adjoint__brackets(T):
    """Column k: T [e_k] T^-1, read back."""
    A = np.empty((6, 6))
    inverse = np.linalg.inv(T)
    for k in range(6):
        X = np.zeros((4, 4))
        if k < 3:
            X[:3, :3] = np.cross(np.eye(3)[k], np.eye(3)).T
        else:
            X[k - 3, 3] = 1
        X = T @ X @ inverse
        A[:, k] = X[2, 1], X[0, 2], X[1, 0], X[0, 3], X[1, 3], X[2, 3]
    return A


def body_screws__inverse_of_adjoint(S, M):
    return np.linalg.solve(right.adjoint(M), S)


def body_screws__lines(S, M):
    R, p = M[:3, :3], M[:3, 3]
    w, v = S[:3], S[3:]
    return np.vstack([R.T @ w, R.T @ (v + np.cross(w.T, p).T)])


def body_screws__one_by_one(S, M):
    inverse = np.eye(4)
    inverse[:3, :3] = M[:3, :3].T
    inverse[:3, 3] = -M[:3, :3].T @ M[:3, 3]
    B = np.zeros(S.shape)
    for i in range(S.shape[1]):
        B[:, i] = right.adjoint(inverse) @ S[:, i]
    return B


# ---- joints of both kinds, a whole arm, another space frame


def joint_screw__lists(kind, w, q):
    size = math.sqrt(sum(x * x for x in w))
    x, y, z = (value / size for value in w)
    if kind == "prismatic":
        return [0, 0, 0, x, y, z]
    return [x, y, z, q[1] * z - q[2] * y, q[2] * x - q[0] * z, q[0] * y - q[1] * x]


def joint_screw__by_letter(kind, w, q):
    unit = np.array(w, float) / np.linalg.norm(w)
    turns = kind[0] == "r"
    return np.hstack([turns * unit, turns * np.cross(q, unit) + (not turns) * unit])


def joint_screw__filled(kind, w, q):
    S, w = np.zeros(6), w / (w @ w) ** 0.5
    if kind == "revolute":
        S[:3], S[3:] = w, np.cross(q, w)
    else:
        S[3:] = w
    return S


def home_and_screws__columns(lengths):
    A, B, C, D, E = lengths
    H = B + C
    M = [[1, 0, 0, A + D], [0, -1, 0, 0], [0, 0, -1, H - E], [0, 0, 0, 1]]
    S = [
        [0, 0, 1, 0, 0, 0],
        [0, -1, 0, B, 0, -A],
        [0, 0, 0, 1, 0, 0],
        [1, 0, 0, 0, H, 0],
        [0, 1, 0, -H, 0, A + D],
    ]
    return np.array(M), np.array(S).T


def home_and_screws__other_points(lengths):
    A, B, C, D, E = lengths
    up, back, out = np.eye(3)[2], np.array([0, -1, 0]), np.array([1, 0, 0])
    hinges = [(up, [0, 0, -1]), (back, [A, 2, B]), (out, [9, 0, B + C]), (-back, [A + D, -3, B + C])]
    S = [np.concatenate([w, -np.cross(w, q)]) for w, q in hinges]
    S.insert(2, np.concatenate([np.zeros(3), out]))
    M = np.eye(4)
    M[1, 1] = M[2, 2] = -1
    M[:3, 3] = out * (A + D) + up * (B + C - E)
    return M, np.column_stack(S)


def home_and_screws__steps(lengths):
    A, B, C, D, E = lengths
    turn = np.diag([1, -1, -1, 1])
    M = _shift(0, 0, B) @ _shift(A, 0, C) @ _shift(D, 0, 0) @ turn @ _shift(0, 0, E)
    x, y, z, o = *np.eye(3), np.zeros(3)
    w = np.array([z, -y, o, x, y])
    q = np.array([o, [A, 0, B], o, [0, 0, B + C], [A + D, 0, B + C]])
    v = np.cross(q, w)
    v[2] = x
    return M, np.vstack([w.T, v.T])


def from_another_frame__inline(S, M, T):
    R, p = T[:3, :3], T[:3, 3]
    w = R @ S[:3]
    return np.vstack([w, R @ S[3:] + np.cross(p, w, axisb=0).T]), T.dot(M)


def from_another_frame__one_by_one(S, M, T):
    moved = np.zeros(S.shape)
    for k, column in enumerate(S.T):
        moved[:, k] = right.adjoint(T) @ column
    return moved, np.einsum("ij,jk->ik", T, M)


def from_another_frame__solved(S, M, T):
    back = np.linalg.inv(T)
    return np.linalg.solve(right.adjoint(back), S), np.linalg.solve(back, M)
