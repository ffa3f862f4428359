"""What there is to see of an answer: frames, lines, arms, arrows, for the picture of a failing check.

Every function is the `look` of an exercise: look(args, value) -> dict, see `Exercise`.
"""

from __future__ import annotations

import numpy as np

from ._arm import turn, wrist_in_plane


def pose(args, T):
    """One frame."""
    return {"frames": [np.reshape(T, (4, 4))]}


def poses(args, T):
    """Many frames, and the path of their origins."""
    return {"frames": list(T), "chains": [np.asarray(T)[:, :3, 3]]}


def rotation(R):
    """A frame at the origin."""
    T = np.eye(4)
    T[:3, :3] = R
    return {"frames": [T]}


def from_quaternion(args, q):
    """The rotation of a quaternion (w, x, y, z) that need not have length 1."""
    w, x, y, z = q / np.linalg.norm(q)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return rotation(np.eye(3) + 2 * w * K + 2 * K @ K)


def from_zyx(args, angles):
    """Turns about z, y and x, one after the other."""
    yaw, pitch, roll = angles
    return rotation(turn(2, yaw) @ turn(1, pitch) @ turn(0, roll))


def turn_about(args, beta):
    """The rotation of an angle-axis product, and its axis."""
    theta = np.linalg.norm(beta)
    k = beta / theta if theta else np.array([0.0, 0, 1])
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    R = np.eye(3) + np.sin(theta) * K + (1 - np.cos(theta)) * K @ K
    return {**rotation(R), "lines": [(np.zeros(3), k)]}


def attitude(args, R):
    """An attitude."""
    return rotation(R)


def from_wrist(args, rows):
    """Where the first row turns the tool."""
    t4, t5, t6 = rows[0]
    return rotation(turn(0, -t4) @ turn(1, t5) @ turn(0, -t6))


def point(args, p):
    """One point."""
    return {"points": [np.asarray(p)]}


def screws(args, S):
    """The axis of each column: its direction, through its point nearest to the origin."""
    S = np.reshape(S, (6, -1)).T
    return {"lines": [(np.cross(s[:3], s[3:]), s[:3] if np.any(s[:3]) else s[3:]) for s in S]}


def axis(args, value):
    """An axis by direction and point."""
    return {"lines": [(value[1], value[0])], "points": [value[1]]}


def turned(args, angle):
    """The vector x of subproblem 1 after the turn; y is where it should be."""
    k, x, _ = args
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    y = x + np.sin(angle) * K @ x + (1 - np.cos(angle)) * K @ K @ x
    return {"arrows": [(np.zeros(3), y)], "lines": [(np.zeros(3), k)]}


def at_a_distance(args, angles):
    """Subproblem 3: the vector x after each turn; y is the point it should be at the distance from."""
    k, x, y, _ = args
    ends = [y_ for t in angles for _, y_ in turned((k, x, y), t)["arrows"]]
    return {"arrows": [(np.zeros(3), end) for end in ends], "lines": [(np.zeros(3), k)], "points": [y]}


def turned_twice(args, rows):
    """Subproblem 2: the vector x after both turns, for each solution."""
    k1, k2, x, y = args
    arrows = []
    for t1, t2 in rows:
        ((_, between),) = turned((k2, x, y), t2)["arrows"]
        arrows += turned((k1, between, y), t1)["arrows"]
    return {"arrows": arrows, "lines": [(np.zeros(3), k1), (np.zeros(3), k2)]}


def exam_arm(args, theta2):
    """The arm of the exam with this theta_2; its end should be at p."""
    _, t1, t3, (a1, d1, a2, d4) = args
    t23 = theta2 + t3
    r = np.cumsum([0, 0, a1, a2 * np.cos(theta2), d4 * np.sin(t23)])
    z = np.cumsum([0, d1, 0, a2 * np.sin(theta2), -d4 * np.cos(t23)])
    return {"chains": [np.column_stack([r * np.cos(t1), r * np.sin(t1), z])]}


def plane_arm(t2, t3, lengths):
    """Shoulder, elbow, kink and wrist centre in the plane of an arm like the KR6, as points in space."""
    a1, d1, a2, a3, _ = lengths
    elbow = np.array([a1 + a2 * np.cos(t2), d1 - a2 * np.sin(t2)])
    kink = elbow + a3 * np.array([np.sin(t2 + t3), np.cos(t2 + t3)])
    out, up = wrist_in_plane(t2, t3, lengths)
    flat = [[0, 0], [0, d1], [a1, d1], elbow, kink, [out, d1 + up]]
    return np.array([[x, 0, z] for x, z in flat])


def elbows(args, rows):
    """The arm in both solutions."""
    return {"chains": [plane_arm(*row, args[2]) for row in rows]}


def arm(args, rows):
    """The arm in the first solution, with its tool."""
    t1, t2, t3, t4, t5, t6 = rows[0]
    _, lengths, tool = args
    chain = plane_arm(t2, t3, lengths) @ turn(2, -t1).T
    x = turn(2, -t1) @ turn(1, t2 + t3) @ turn(0, -t4) @ turn(1, t5) @ turn(0, -t6)
    return {"chains": [np.vstack([chain, chain[-1] + tool * x[:, 0]])]}


def shoulder(args, theta3):
    """The arm at theta_2 and the angle that was found: its wrist centre should lie on axis 1."""
    theta2, (a1, a2, a3, d4, _) = args
    return {"chains": [plane_arm(theta2, theta3, (a1, 0.4, a2, a3, d4))]}


def stretched(args, theta3):
    """The upper arm along x and the forearm at the angle that was found."""
    a3, d4 = args
    return {"chains": [plane_arm(0.0, theta3, (0, 0, 0.5, a3, d4))]}


def ellipsoid(args, value):
    """Half axes as columns."""
    lengths, directions = value
    return {"ellipsoid": np.asarray(directions) * lengths}


def twist(args, s):
    """A twist: its angular velocity as an arrow, and the velocity of the origin beside it."""
    return {"arrows": [(np.zeros(3), s[:3]), (np.array([1.5, 0, 0]), s[3:])]}


def column(args, value):
    """A column of J, beside the matrix it was read from: omega, and the velocity of the tool."""
    return twist(args, value[1])


def end_of_run(args, rows):
    """The arm at the last configuration, and its tool."""
    robot, theta = args[0], np.asarray(rows)[-1]
    tool = robot.fk(theta)
    joints = robot.link_frames(theta)[:, :3, 3]
    return {"chains": [np.vstack([np.zeros(3), joints, tool[:3, 3]])], "frames": [tool]}


def velocity(args, value):
    """The planar arm, and the velocity of its tip seen from the base."""
    (t1, t2), _, (l1, l2) = args
    joint = l1 * np.array([np.cos(t1), np.sin(t1), 0])
    tip = joint + l2 * np.array([np.cos(t1 + t2), np.sin(t1 + t2), 0])
    return {"chains": [[np.zeros(3), joint, tip]], "arrows": [(tip, 0.3 * np.append(value[0], 0))]}
