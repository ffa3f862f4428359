"""Notebook 06: right answers as other people write them."""

from __future__ import annotations

import math

import numpy as np

from coursekit.kinematics import lie


def tool_frames__loop(points, centre):
    frames = []
    for i in range(len(points)):
        x = (points[i] - centre) / np.linalg.norm(points[i] - centre)
        j = min(i, len(points) - 2)
        d = points[j + 1] - points[j]
        y = d - (d @ x) * x
        y = y / np.linalg.norm(y)
        T = np.eye(4)
        T[:3, :3] = np.column_stack([x, y, np.cross(x, y)])
        T[:3, 3] = points[i]
        frames.append(T)
    return np.array(frames)


def tool_frames__cross(points, centre):
    """z first: it is square to the normal and to the step."""
    normal = points - centre
    step = np.vstack([points[1:] - points[:-1], points[-1:] - points[-2:-1]])
    z = np.cross(normal, step)
    axes = [a / np.linalg.norm(a, axis=1)[:, None] for a in (normal, np.cross(z, normal), z)]
    T = np.zeros((len(points), 4, 4))
    for k, axis in enumerate(axes):
        T[:, :3, k] = axis
    T[:, :3, 3], T[:, 3, 3] = points, 1
    return T


def tool_frames__lists(points, centre):
    points, centre = points.tolist(), list(centre)
    frames = []
    for i, p in enumerate(points):
        a, b = (points[i], points[i + 1]) if i + 1 < len(points) else (points[i - 1], p)
        x = _unit([u - v for u, v in zip(p, centre, strict=True)])
        d = [v - u for u, v in zip(a, b, strict=True)]
        along = sum(u * v for u, v in zip(d, x, strict=True))
        y = _unit([u - along * v for u, v in zip(d, x, strict=True)])
        z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
        frames.append([[x[k], y[k], z[k], p[k]] for k in range(3)] + [[0, 0, 0, 1]])
    return frames


def _unit(v):
    return [x / math.sqrt(sum(y * y for y in v)) for x in v]


def quaternion__four_cases(R):
    squares = [
        1 + R[0, 0] + R[1, 1] + R[2, 2],
        1 + R[0, 0] - R[1, 1] - R[2, 2],
        1 - R[0, 0] + R[1, 1] - R[2, 2],
        1 - R[0, 0] - R[1, 1] + R[2, 2],
    ]
    k = squares.index(max(squares))
    s = 2 * math.sqrt(squares[k])  # 4 times the largest component
    if k == 0:
        return [s / 4, (R[2, 1] - R[1, 2]) / s, (R[0, 2] - R[2, 0]) / s, (R[1, 0] - R[0, 1]) / s]
    if k == 1:
        return [(R[2, 1] - R[1, 2]) / s, s / 4, (R[0, 1] + R[1, 0]) / s, (R[0, 2] + R[2, 0]) / s]
    if k == 2:
        return [(R[0, 2] - R[2, 0]) / s, (R[0, 1] + R[1, 0]) / s, s / 4, (R[1, 2] + R[2, 1]) / s]
    return [(R[1, 0] - R[0, 1]) / s, (R[0, 2] + R[2, 0]) / s, (R[1, 2] + R[2, 1]) / s, s / 4]


def quaternion__eigenvector(R):
    """4 q q' - 1 has the eigenvector q, and 3 is its largest eigenvalue."""
    (a, b, c), (d, e, f), (g, h, i) = R.astype(float)
    K = np.array(
        [
            [a + e + i, h - f, c - g, d - b],
            [h - f, a - e - i, b + d, c + g],
            [c - g, b + d, e - a - i, f + h],
            [d - b, c + g, f + h, i - a - e],
        ]
    )
    return np.linalg.eigh(K)[1][:, -1]


def quaternion__axis_and_angle(R):
    """The angle from both the sine and the cosine; at more than a right angle the axis from R + R^T."""
    skew = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    cosine = (np.trace(R) - 1) / 2
    angle = math.atan2(np.linalg.norm(skew), cosine)
    if angle < 1e-12:
        return np.array([1.0, 0, 0, 0])
    if cosine > 0:
        axis = skew / np.linalg.norm(skew)
    else:
        K = (R + R.T) / 2 - cosine * np.eye(3)  # (1 - cos) k k'
        axis = K[:, np.argmax(np.diag(K))]
        axis = axis / np.linalg.norm(axis)
        axis = axis if axis @ skew >= 0 else -axis
    return np.append(math.cos(angle / 2), math.sin(angle / 2) * axis)


def zyx__arcsin(R):
    pitch = -np.arcsin(np.clip(R[2, 0], -1, 1))
    return np.arctan2(R[1, 0], R[0, 0]), pitch, np.arctan2(R[2, 1], R[2, 2])


def zyx__one_by_one(R):
    """Undo the yaw, then read the pitch and the roll of what is left."""
    yaw = math.atan2(R[1][0], R[0][0])
    c, s = math.cos(yaw), math.sin(yaw)
    rest = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ R
    return [yaw, math.atan2(-rest[2, 0], rest[0, 0]), math.atan2(-rest[1, 2], rest[1, 1])]


def zyx__complex(R):
    yaw, roll = np.angle(R[0, 0] + 1j * R[1, 0]), np.angle(R[2, 2] + 1j * R[2, 1])
    return np.array([yaw, np.angle(np.linalg.norm(R[2, 1:]) - 1j * R[2, 0]), roll])


def inside__loop(theta, lower, upper):
    answers = []
    for row in theta:
        fine = True
        for angle, low, high in zip(row, lower, upper, strict=True):
            while angle > high:
                angle = angle - 2 * math.pi
            while angle < low:
                angle = angle + 2 * math.pi
            fine = fine and angle <= high
        answers.append(fine)
    return answers


def inside__counted(theta, lower, upper):
    """Is there a whole number between the turns to the lower and to the upper limit?"""
    fewest = np.ceil((lower - theta) / (2 * np.pi))
    most = np.floor((upper - theta) / (2 * np.pi))
    return (fewest <= most).all(axis=1)


def inside__all_turns(theta, lower, upper):
    turned = theta[:, :, None] + 2 * np.pi * np.arange(-10, 11)
    fits = (lower[:, None] <= turned) & (turned <= upper[:, None])
    return np.array([all(any(joint) for joint in row) for row in fits])


def next_on_branch__unwrap(last, solutions):
    """np.unwrap carries each joint on from where it was."""
    best, least = None, math.inf
    for row in solutions:
        turned = np.unwrap(np.array([last, row]), axis=0)[1]
        if np.abs(turned - last).max() < least:
            best, least = turned, np.abs(turned - last).max()
    return best


def next_on_branch__remainder(last, solutions):
    ways = [[math.remainder(b - a, 2 * math.pi) for a, b in zip(last, row, strict=True)] for row in solutions]
    way = min(ways, key=lambda way: sum(abs(x) for x in way))
    return [a + x for a, x in zip(last, way, strict=True)]


def next_on_branch__complex(last, solutions):
    """The way to each solution is the angle of a quotient."""
    way = np.angle(np.exp(1j * solutions) / np.exp(1j * last))
    return last + way[np.argmin(np.sum(way**2, axis=1))]


def largest_speed__loop(q, points, v_max):
    best = math.inf
    for i in range(len(points) - 1):
        step = math.dist(points[i], points[i + 1])
        for j in range(len(v_max)):
            turn = abs(q[i + 1, j] - q[i, j])
            if turn > 0:
                best = min(best, v_max[j] * step / turn)
    return best


def largest_speed__times(q, points, v_max):
    """Each step takes as long as its slowest joint needs."""
    needed = (np.abs(q[1:] - q[:-1]) / v_max).max(axis=1)
    step = np.sqrt(((points[1:] - points[:-1]) ** 2).sum(axis=1))
    return (step / needed).min()


def largest_speed__rates(q, points, v_max):
    """The rates at 1 m/s, and by how much the worst of them may grow."""
    dt = np.linalg.norm(np.diff(points, axis=0), axis=1)
    rates = np.einsum("ij,i->ij", np.abs(np.diff(q, axis=0)), 1 / dt)
    return 1 / np.max(rates / v_max)


def _quaternion(R):
    """Sizes from the diagonal, signs from the row of the largest; w >= 0."""
    (a, b, c), (d, e, f), (g, h, i) = np.asarray(R, float)
    rows = [
        [1 + a + e + i, h - f, c - g, d - b],
        [h - f, 1 + a - e - i, b + d, c + g],
        [c - g, b + d, 1 - a + e - i, f + h],
        [d - b, c + g, f + h, 1 - a - e + i],
    ]
    q = np.array(max(rows, key=lambda row: row @ np.array(row)))
    q = q / np.sqrt(q @ q)
    return q if q[0] >= 0 else -q


def angle_axis__math(R):
    w, x, y, z = map(float, _quaternion(R))
    length = math.sqrt(x * x + y * y + z * z)
    if length < 1e-300:
        return [0.0, 0.0, 0.0]
    theta = 2 * math.atan2(length, w)
    return [theta * x / length, theta * y / length, theta * z / length]


def angle_axis__by_cases(R):
    """The textbook in the middle, the column of R + 1 near half a turn."""
    R = np.asarray(R, float)
    v = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    s, c = np.linalg.norm(v), (np.trace(R) - 1) / 2
    theta = np.arctan2(s, c)
    if c > -0.9:
        return v if s == 0 else v / s * theta
    B = (R + R.T) / 2 - c * np.eye(3)
    k = B[:, np.argmax(np.diag(B))]
    k = k / np.linalg.norm(k)
    return theta * (k if k @ v >= 0 else -k)


def angle_axis__scaled(R):
    """No quotient but one: theta over its sine of the half."""
    q = _quaternion(R)
    half = np.arctan2(np.linalg.norm(q[1:]), q[0])
    return 2 * q[1:] / np.sinc(half / np.pi) if half else 0.0 * q[1:]


def slerp__from_the_left(R_0, R_1, t):
    """The same turn, seen from the space frame, stands in front."""
    return lie.exp3(t * np.array(angle_axis__math(R_1 @ R_0.T))) @ R_0


def slerp__quaternions(R_0, R_1, t):
    a, b = _quaternion(R_0), _quaternion(R_1)
    if a @ b < 0:
        b = -b
    angle = math.acos(min(1.0, float(a @ b)))
    share = (1 - t) * a + t * b if angle < 1e-7 else np.sin((1 - t) * angle) * a + np.sin(t * angle) * b
    w, *v = share / np.linalg.norm(share)
    K = lie.hat3(v)
    return np.eye(3) + 2 * w * K + 2 * K @ K


def slerp__rodrigues(R_0, R_1, t):
    beta = np.array(angle_axis__by_cases(np.transpose(R_0) @ R_1)) * t
    theta = float(np.linalg.norm(beta))
    if theta == 0:
        return np.array(R_0, float)
    K = lie.hat3(beta / theta)
    return R_0 @ (np.eye(3) + np.sin(theta) * K + (1 - np.cos(theta)) * K @ K)


def largest_speed__bisection(q, points, v_max):
    low, high = 0.0, 1e9

    def allowed(v):
        for a, b, p, r in zip(q[:-1], q[1:], points[:-1], points[1:], strict=True):
            if np.any(np.abs(b - a) * v > v_max * np.linalg.norm(r - p)):
                return False
        return True

    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if allowed(middle) else (low, middle)
    return low


def tool_frames__projector(points, centre):
    frames = np.zeros((len(points), 4, 4))
    for i, p in enumerate(points):
        n = (p - centre) / math.dist(p, centre)
        d = points[i + 1] - p if i + 1 < len(points) else p - points[i - 1]
        t = (np.eye(3) - np.outer(n, n)) @ d
        t = t / np.sqrt(t @ t)
        frames[i] = np.vstack([np.column_stack([n, t, np.cross(n, t), p]), [0, 0, 0, 1]])
    return frames
