"""Notebook 03 in other styles: each of these is right and must pass."""

from __future__ import annotations

import math

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.kinematics import lie, rotations

right = Solved("nb03")


# -- wrist_centre


def wrist_centre__homogeneous(T_sd, tool):
    return (T_sd @ np.array([-tool, 0, 0, 1]))[:3]


def wrist_centre__lists(T_sd, tool):
    return [row[3] - tool * row[0] for row in T_sd.tolist()[:3]]


def wrist_centre__pose_of_the_wrist(T_sd, tool):
    back = np.eye(4)
    back[0, 3] = tool
    return (T_sd @ lie.inverse(back))[:3, -1]


# -- subproblem1


def subproblem1__project(k, x, y):
    across = np.eye(3) - np.outer(k, k)
    x, y = across @ x, across @ y
    return np.arctan2(np.dot(np.cross(x, y), k), np.dot(x, y))


def subproblem1__lists(k, x, y):
    k, x, y = list(k), list(x), list(y)
    kx, ky = sum(a * b for a, b in zip(k, x, strict=True)), sum(a * b for a, b in zip(k, y, strict=True))
    c = sum(a * b for a, b in zip(x, y, strict=True)) - kx * ky
    s = (
        k[0] * (x[1] * y[2] - x[2] * y[1])
        + k[1] * (x[2] * y[0] - x[0] * y[2])
        + k[2] * (x[0] * y[1] - x[1] * y[0])
    )
    return math.atan2(s, c)


def subproblem1__two_angles(k, x, y):
    """Both angles in a plane across k, measured from any direction in it."""
    e = np.eye(3)[np.argmin(np.abs(k))]
    u = np.cross(k, e) / np.linalg.norm(np.cross(k, e))
    v = np.cross(k, u)
    return np.arctan2(y @ v, y @ u) - np.arctan2(x @ v, x @ u)


# -- elbow_solutions


def elbow_solutions__reversed_loop(r, z, lengths):
    a1, d1, a2, a3, d4 = (float(x) for x in lengths)
    a, b = math.sqrt(a3**2 + d4**2), math.hypot(r - a1, z - d1)
    rows = []
    for sign in (-1, 1):
        alpha = math.acos((a2**2 + b**2 - a**2) / (2 * a2 * b))
        beta = math.acos((a2**2 + a**2 - b**2) / (2 * a2 * a))
        theta2 = -(math.atan2(z - d1, r - a1) + sign * alpha)
        rows.append((theta2, sign * (math.pi - beta) + math.atan(a3 / d4)))
    return rows


def elbow_solutions__half_angles(r, z, lengths):
    """The bend of the elbow from the tangent of its half, theta2 from where the forearm leads."""
    a1, d1, a2, a3, d4 = lengths
    x, y, a = r - a1, z - d1, np.hypot(a3, d4)
    far, near = (a2 + a) ** 2 - x**2 - y**2, x**2 + y**2 - (a2 - a) ** 2
    bend = 2 * np.arctan(np.sqrt(far / near)) * np.array([1, -1])
    theta2 = -np.arctan2(y, x) - np.arctan2(a * np.sin(bend), a2 + a * np.cos(bend))
    return np.stack([theta2, bend + np.arctan2(a3, d4)], axis=1)


def elbow_solutions__circles(r, z, lengths):
    """Where two circles meet: the elbow itself, then the angles of both links."""
    a1, d1, a2, a3, d4 = lengths
    P = np.array([r - a1, z - d1], dtype=float)
    b, a = np.linalg.norm(P), np.linalg.norm([a3, d4])
    along = (a2**2 - a**2 + b**2) / (2 * b)
    across = np.sqrt(a2**2 - along**2)
    out = []
    for side in (across, -across):
        E = along * P / b + side * np.array([-P[1], P[0]]) / b
        theta2 = -np.arctan2(E[1], E[0])
        fore = -np.arctan2(P[1] - E[1], P[0] - E[0])
        out += [theta2, fore - theta2 + np.arctan2(a3, d4)]
    return np.reshape(out, (2, 2))


# -- wrist_angles


def wrist_angles__arccos(R):
    t5 = np.arccos(R[0, 0])
    rows = []
    for bend in (t5, -t5):
        s = np.sin(bend)
        rows.append([np.arctan2(-R[1, 0] / s, -R[2, 0] / s), bend, np.arctan2(-R[0, 1] / s, R[0, 2] / s)])
    return np.array(rows)


def wrist_angles__lists(R):
    R = [list(row) for row in R]
    s = math.sqrt(R[1][0] ** 2 + R[2][0] ** 2)
    return [
        [
            math.atan2(-k * R[1][0], -k * R[2][0]),
            math.atan2(k * s, R[0][0]),
            math.atan2(-k * R[0][1], k * R[0][2]),
        ]
        for k in (1, -1)
    ]


def wrist_angles__peeled(R):
    """Undo theta4, then read the rest off what is left."""
    t4 = np.arctan2(-R[1, 0], -R[2, 0])
    rest = rotations.rotx(t4) @ R
    one = np.array([t4, np.arctan2(-rest[2, 0], rest[0, 0]), np.arctan2(rest[1, 2], rest[1, 1])])
    return np.vstack([one, one * [1, -1, 1] + [np.pi, 0, np.pi]])


# -- all_solutions


def all_solutions__loops(T_sd, lengths, tool):
    P = right.wrist_centre(T_sd, tool)
    out = np.zeros((8, 6))
    row = 0
    for i in range(2):
        theta1 = -math.atan2(P[1], P[0]) + i * math.pi
        r = (-1) ** i * math.sqrt(P[0] ** 2 + P[1] ** 2)
        elbows = right.elbow_solutions(r, P[2], lengths)
        for j in range(2):
            R123 = rotations.rotz(-theta1) @ rotations.roty(elbows[j, 0] + elbows[j, 1])
            wrists = right.wrist_angles(np.linalg.inv(R123) @ T_sd[:3, :3])
            for k in range(2):
                out[row, 0] = theta1
                out[row, 1:3] = elbows[j]
                out[row, 3:] = wrists[k]
                row += 1
    return out


def all_solutions__comprehension(T_sd, lengths, tool):
    x, y, z = right.wrist_centre(T_sd, tool)
    rest = lambda t1, t23: (rotations.rotz(-t1) @ rotations.roty(t23)).T @ T_sd[:3, :3]  # noqa: E731
    return [
        [t1, t2, t3, *angles]
        for side in (-1, 1)
        for t1 in [math.atan2(-side * y, side * x)]
        for t2, t3 in right.elbow_solutions(side * math.hypot(x, y), z, lengths)
        for angles in right.wrist_angles(rest(t1, t2 + t3))
    ]


def all_solutions__stacked(T_sd, lengths, tool):
    P = right.wrist_centre(T_sd, tool)
    t1 = -right.subproblem1(np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), P)
    arms = [np.r_[t1 + turn, e] for turn, s in ((0, 1), (np.pi, -1)) for e in elbows(P, s, lengths)]
    blocks = []
    for arm in arms:
        R = lie.exp3([0, arm[1:].sum(), 0]).T @ lie.exp3([0, 0, -arm[0]]).T @ T_sd[:3, :3]
        blocks.append(np.column_stack([np.tile(arm, (2, 1)), right.wrist_angles(R)]))
    return np.concatenate(blocks)


def elbows(P, side, lengths):
    return right.elbow_solutions(side * np.linalg.norm(P[:2]), P[2], lengths)


# -- newton_step


def newton_step__lstsq(J_b, T_sb, T_sd):
    e = lie.log6(np.linalg.inv(T_sb) @ T_sd)
    return np.linalg.lstsq(J_b, e, rcond=None)[0]


def newton_step__svd(J_b, T_sb, T_sd):
    U, s, Vt = np.linalg.svd(J_b, full_matrices=False)
    e = lie.log6(np.linalg.solve(T_sb, T_sd))
    return sum(Vt[i] * (U[:, i] @ e) / s[i] for i in range(len(s)) if s[i] > 1e-10 * s[0])


def newton_step__blocks(J_b, T_sb, T_sd):
    R, p = T_sb[:3, :3], T_sb[:3, 3]
    T = np.eye(4)
    T[:3, :3] = np.einsum("ji,jk->ik", R, T_sd[:3, :3])
    T[:3, 3] = R.T @ (T_sd[:3, 3] - p)
    return np.einsum("ij,j->i", np.linalg.pinv(J_b), lie.log6(T))


# -- subproblem3


def subproblem3__plane_wave(k, x, y, distance):
    """y . rot(k, t) x is what the distance says: a cos t + b sin t = c."""
    fixed = (k @ x) * (k @ y)
    a, b = x @ y - fixed, y @ np.cross(k, x)
    c = (x @ x + y @ y - distance**2) / 2 - fixed
    return [np.arctan2(b, a) + side * np.arccos(c / np.hypot(a, b)) for side in (1, -1)]


def subproblem3__triangle(k, x, y, distance):
    shadow = lambda v: v - np.dot(k, v) * k  # noqa: E731
    x1, y1 = shadow(x), shadow(y)
    a, b = np.linalg.norm(x1), np.linalg.norm(y1)
    d2 = distance**2 - (k @ y - k @ x) ** 2
    bend = math.acos((a**2 + b**2 - d2) / (2 * a * b))
    middle = math.atan2(k @ np.cross(x, y), x1 @ y1)
    return np.array([middle + bend, middle - bend])


def subproblem3__half_angle(k, x, y, distance):
    """A quadratic in the tangent of half the angle."""
    fixed = (k @ x) * (k @ y)
    a, b = x @ y - fixed, y @ np.cross(k, x)
    c = (x @ x + y @ y - distance**2) / 2 - fixed
    root = np.sqrt(a * a + b * b - c * c)
    return np.array([2 * np.arctan2(b + root, a + c), 2 * np.arctan2(b - root, a + c)])


# -- subproblem2


def subproblem2__cramer(k1, k2, x, y):
    c = float(np.dot(k1, k2))
    h1, h2 = float(np.dot(k1, y)), float(np.dot(k2, x))
    a, b = (h1 - c * h2) / (1 - c * c), (h2 - c * h1) / (1 - c * c)
    n = np.cross(k1, k2)
    g = math.sqrt((x @ x - a * a - b * b - 2 * a * b * c) / (1 - c * c))
    out = []
    for sign in (-1, 1):
        z = a * np.asarray(k1) + b * np.asarray(k2) + sign * g * n
        out.append((right.subproblem1(k1, z, y), -right.subproblem1(k2, z, x)))
    return out


def subproblem2__least_squares(k1, k2, x, y):
    """The point of the line of both heights that is nearest to the origin, then along the line."""
    rows = np.stack([k1, k2]).astype(float)
    foot = np.linalg.pinv(rows) @ [k1 @ y, k2 @ x]
    n = np.cross(k1, k2) / np.linalg.norm(np.cross(k1, k2))
    reach = np.sqrt(y @ y - foot @ foot)
    both = np.array([foot + reach * n, foot - reach * n])
    return np.array([[right.subproblem1(k1, z, y), right.subproblem1(k2, x, z)] for z in both])


def subproblem2__by_height(k1, k2, x, y):
    """k1 . rot(k2, t2) x = k1 . y has two roots t2; for each of them one turn is left."""
    fixed = (k1 @ k2) * (k2 @ x)
    a, b, c = k1 @ x - fixed, k1 @ np.cross(k2, x), k1 @ y - fixed
    rows = []
    for side in (-1, 1):
        t2 = np.arctan2(b, a) + side * np.arccos(c / np.hypot(a, b))
        z = lie.exp3(np.asarray(k2) * t2) @ x
        rows.append([right.subproblem1(k1, z, y), t2])
    return np.array(rows)


# -- jacobian_column


def jacobian_column__adjoint(kind, w, q, T):
    """The screw in the room, then the adjoint."""
    S = [0, 0, 0, *w] if kind == "prismatic" else [*w, *(-np.cross(w, q))]
    return lie.adjoint(lie.inverse(T)) @ S


def jacobian_column__all_in_the_tool(kind, w, q, T):
    back = lie.inverse(T)
    axis, point = back[:3, :3] @ w, (back @ [*q, 1])[:3]
    if kind != "revolute":
        return np.hstack([[0, 0, 0], axis])
    return np.hstack([axis, np.cross(point, axis)])


def jacobian_column__lists(kind, w, q, T):
    d = [T[i][3] - q[i] for i in range(3)]
    v = [w[1] * d[2] - w[2] * d[1], w[2] * d[0] - w[0] * d[2], w[0] * d[1] - w[1] * d[0]]
    omega, v = (w, v) if kind == "revolute" else ([0, 0, 0], w)
    turn = lambda x: [sum(T[i][j] * x[i] for i in range(3)) for j in range(3)]  # noqa: E731
    return turn(omega) + turn(v)


# -- other roads to the same


def subproblem1__half_angle(k, x, y):
    """Twice the angle between x' and the line half way."""
    a, b = (v - k * np.dot(k, v) for v in (x, y))
    sense = 1 if k @ np.cross(a, b) >= 0 else -1
    return 2 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)) * sense


def elbow_solutions__complex(r, z, lengths):
    a1, d1, a2, a3, d4 = lengths
    p, fore = complex(r - a1, z - d1), complex(d4, -a3)
    cosine = (a2**2 + abs(p) ** 2 - abs(fore) ** 2) / (2 * a2 * abs(p))
    out = np.zeros((2, 2))
    for i, sign in enumerate((1, -1)):
        up = p / abs(p) * np.exp(1j * sign * np.arccos(cosine))
        theta2 = -np.angle(up)
        out[i] = theta2, -np.angle((p - a2 * up) / fore.conjugate()) - theta2
    return out


def newton_step__space_first(J_b, T_sb, T_sd):
    """The twist seen from the room, then seen from the target, which it leaves where it is."""
    e = lie.adjoint(lie.inverse(T_sd)) @ lie.log6(T_sd @ lie.inverse(T_sb))
    return np.linalg.lstsq(J_b, e, rcond=1e-12)[0]


def jacobian_column__matrices(kind, w, q, T):
    screw = np.r_[w, np.cross(q, w)] if kind == "revolute" else np.r_[0, 0, 0, w]
    return lie.vee6(lie.inverse(T) @ lie.hat6(screw) @ T)
