"""An arm built like the KR6, for the exercises of notebooks 03 and 04: what their answers do to it."""

from __future__ import annotations

import numpy as np

KR6 = np.array([0.025, 0.400, 0.455, 0.035, 0.420])  # a1, d1, a2, a3, d4


def turn(axis, angle):
    """A turn about x (0), y (1) or z (2), (3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[[i, j], [i, j]], R[i, j], R[j, i] = np.cos(angle), -np.sin(angle), np.sin(angle)
    return R


def wrist_in_plane(t2, t3, lengths):
    """Where the wrist centre is in the plane of the arm: out from axis 1, up from the shoulder."""
    a1, _, a2, a3, d4 = lengths
    out = a1 + a2 * np.cos(t2) + d4 * np.cos(t2 + t3) + a3 * np.sin(t2 + t3)
    return out, -a2 * np.sin(t2) - d4 * np.sin(t2 + t3) + a3 * np.cos(t2 + t3)


def hand(theta):
    """The rotation of the hand, (3, 3)."""
    t1, t2, t3, t4, t5, t6 = theta
    return turn(2, -t1) @ turn(1, t2 + t3) @ wrist((t4, t5, t6))


def wrist(angles):
    """The rotation that joints 4 to 6 add, (3, 3)."""
    t4, t5, t6 = angles
    return turn(0, -t4) @ turn(1, t5) @ turn(0, -t6)


def forward(theta, lengths, tool):
    """Tool pose of the arm, (4, 4)."""
    out, up = wrist_in_plane(theta[1], theta[2], lengths)
    T = np.eye(4)
    T[:3, :3] = hand(theta)
    T[:3, 3] = turn(2, -theta[0]) @ [out, 0, lengths[1] + up] + tool * T[:3, 0]
    return T


def degrees_between(A, B):
    """The angle of the turn from one rotation to another."""
    size = np.linalg.norm(A - B) / np.sqrt(8)
    return np.degrees(2 * np.arcsin(min(size, 1.0)))


def wrapped(angle):
    """An angle in [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def mm(distance):
    """ "83 mm", with a digit more where it is small."""
    return f"{1000 * distance:.3g} mm" if 1000 * distance < 100 else f"{1000 * distance:.0f} mm"


def deg(angle):
    """ "34 deg" of an angle in degrees."""
    return f"{angle:.3g} deg"


def random_rotation(rng):
    """Any rotation."""
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    return np.column_stack([x, y, np.cross(x, y)])


def random_pose(rng):
    """Any rotation, and a position within half a metre."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = random_rotation(rng), rng.uniform(-0.5, 0.5, 3)
    return T


def whole_pose(turned, position):
    """A pose in whole numbers; `turned` is a rotation by quarter turns."""
    T = np.eye(4, dtype=int)
    T[:3, :3], T[:3, 3] = np.round(turned), position
    return T
