"""What the exercises of notebook 03 are asked with, and the laws their answers keep."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises._arm import (
    KR6,
    forward,
    random_pose,
    turn,
    whole_pose,
    wrist,
    wrist_in_plane,
)

REPORT = (2, -1, -1, 2.5, 0.6, 0)  # the report's target is where these angles lead
TOOL = 0.08


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.25, 1.3, n)


def turned(k, x, t):
    """x turned by t about k."""
    return x * np.cos(t) + np.cross(k, x) * np.sin(t) + k * (k @ x) * (1 - np.cos(t))


# ---- wrist_centre


def target(rng):
    return random_pose(rng), rng.uniform(0.05, 0.2)


def target_not_turned(rng):
    T, tool = target(rng)
    T[:3, :3] = np.eye(3)
    return T, tool


def behind_the_flange(rng):
    T, tool = target(rng)
    return T, -tool


def the_report(rng):
    return forward(REPORT, KR6, TOOL), TOOL


def whole_target(rng):
    return whole_pose(turn(2, np.pi / 2) @ turn(0, np.pi / 2), rng.integers(1, 9, 3)), 2


# ---- subproblem1


def turn_by(rng, low, high, upright=False):
    k, x = rng.normal(size=(2, 3))
    k = k / np.linalg.norm(k)
    if upright:
        x = x - k * (k @ x)
    t = rng.uniform(low, high)
    return k, x, turned(k, x, t)


def half_turn(rng):
    """Numbers without rounding: an arccos is not NaN here, but has no sign."""
    x, y, z = rng.choice([-1, 1]) * np.array([1.5, 2.0, 0.5])
    return [0.0, 0.0, 1.0], [x, y, z], [-x, -y, z]


def whole_turn_numbers(rng):
    a, b, c = (int(i) for i in rng.integers(1, 5, 3))
    return [0, 1, 0], [a, b, c], [c, b, -a]


# ---- elbow_solutions


def _lengths(rng):
    """a1, d1, a2, a3, d4 of an arm built like the KR6."""
    return rng.uniform([0.02, 0.3, 0.4, 0.03, 0.4], [0.1, 0.6, 0.6, 0.08, 0.6])


def triangle(rng, out=1, up=1):
    """P in front of the shoulder or behind it, above it or below.

    It is so near that a wrong sign of the forearm's square has an answer, too.
    """
    lengths = _lengths(rng)
    a1, d1, a2, a3, d4 = lengths
    fore = np.hypot(a3, d4)
    farthest = np.sqrt(a2**2 - fore**2 + 1.99 * a2 * fore)
    b, phi = rng.uniform(abs(a2 - fore) + 0.1, farthest - 0.02), rng.uniform(0.2, 1.3)
    return a1 + out * b * np.cos(phi), d1 + up * b * np.sin(phi), lengths


def level_or_upright(rng, out, up):
    """P at the height of the shoulder, or straight above it, without rounding."""
    r, z, lengths = triangle(rng)
    b = np.hypot(r - lengths[0], z - lengths[1])
    return lengths[0] + out * b, lengths[1] + up * b, lengths


def triangle_without(rng, which, sign=0):
    """A length is 0, or negative."""
    r, z, lengths = triangle(rng)
    lengths[which] *= sign
    return r, z, lengths


def folded(rng):
    """P so near the shoulder that the angle there is more than 90 degrees."""
    lengths = rng.uniform([0.02, 0.3, 0.4, 0.03, 0.55], [0.1, 0.6, 0.45, 0.08, 0.6])
    b, phi = rng.uniform(0.25, 0.31), rng.uniform(0.2, 1.3)
    return lengths[0] + b * np.cos(phi), lengths[1] + b * np.sin(phi), lengths


def the_report_in_plane(rng):
    T = forward(REPORT, KR6, TOOL)
    P = T[:3, 3] - TOOL * T[:3, 0]
    return np.hypot(P[0], P[1]), P[2], KR6


# ---- wrist_angles


def bent(rng, t5, out4=1, out6=1):
    """R with theta_5 in a range; out4 and out6: the signs of the cosines of theta_4 and theta_6."""
    t4, t6 = rng.choice([-1, 1], 2) * rng.uniform(0.25, 1.3, 2)
    flip4, flip6 = np.pi * (out4 < 0), np.pi * (out6 < 0)
    return (wrist((t4 + flip4, rng.uniform(*t5), t6 + flip6)),)


def whole_wrist(*quarters):
    """Of quarter turns, without rounding."""
    return lambda rng: (whole_pose(wrist(np.pi / 2 * np.array(quarters)), 0)[:3, :3],)


# ---- all_solutions


def _arm(rng):
    """Joint angles with a bent elbow and a bent wrist, the lengths and the tool: eight solutions exist."""
    while True:
        theta, lengths = _angles(rng, 6), _lengths(rng)
        theta[4] = rng.choice([-1, 1]) * rng.uniform(0.3, 2.8)
        a1, _, a2, a3, d4 = lengths
        out, up = wrist_in_plane(theta[1], theta[2], lengths)
        nearest, farthest = abs(a2 - np.hypot(a3, d4)) + 0.05, a2 + np.hypot(a3, d4) - 0.05
        reach = np.hypot(-abs(out) - a1, up), np.hypot(abs(out) - a1, up)  # over the back, to the front
        if abs(out) > 0.1 and nearest < min(reach) and max(reach) < farthest:
            return theta, lengths, rng.uniform(0.05, 0.2)


def reachable(rng, side=1):
    """A target whose wrist centre has an x of this sign."""
    while True:
        theta, lengths, tool = _arm(rng)
        T = forward(theta, lengths, tool)
        if side * (T[0, 3] - tool * T[0, 0]) > 0.05:
            return T, lengths, tool


def the_report_in_reach(rng):
    return forward(REPORT, KR6, TOOL), KR6, TOOL


def whole_reachable(rng, there=(3, -4)):
    R = turn(1, np.pi / 2) @ turn(0, np.pi / 2)  # the tool points down
    return whole_pose(R, np.array([*there, 5]) + R[:, 0]), [1, 2, 5, 3, 4], 1


# ---- subproblem2 and subproblem3


def _unit(rng):
    k = rng.normal(size=3)
    return k / np.linalg.norm(k)


def two_turns(rng, upright=False, along=False):
    """Two axes, a point and where two turns bring it, far from where both solutions are one.

    upright: the axes are at right angles; along: the point lies on the first axis.
    """
    while True:
        k1, k2, x = _unit(rng), _unit(rng), rng.uniform(-1, 1, 3)
        if upright:
            k2 = np.cross(k1, k2) / np.linalg.norm(np.cross(k1, k2))
        if along:
            x = k1 * rng.uniform(0.5, 1.5)
        between = turned(k2, x, rng.uniform(-3, 3))
        y, n = turned(k1, between, rng.uniform(-3, 3)), np.cross(k1, k2)
        if n @ n > 0.3 and abs(between @ n) > 0.3:
            return k1, k2, x, y


def whole_two_turns(rng):
    a = int(rng.integers(1, 5))
    return [0, 0, 1], [0, 1, 0], [0, 0, a], [0, a, 0]


def distance(rng, flat=False):
    """An axis, two points, and a distance between them that two turns give.

    flat: both points lie in the plane across the axis.
    """
    while True:
        k, x, y = _unit(rng), rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)
        if flat:
            x, y = (p - (p @ k) * k for p in (x, y))
        a, b, high = np.linalg.norm(np.cross(k, x)), np.linalg.norm(np.cross(k, y)), k @ (y - x)
        if min(a, b) > 0.3 and (flat or min(abs(high), abs(k @ x), abs(k @ y)) > 0.2):
            bend = rng.uniform(0.4, 2.7)  # the angle of the triangle, at the axis
            return k, x, y, np.sqrt(a * a + b * b - 2 * a * b * np.cos(bend) + high**2)


def far_apart(rng):
    """Points far from each other in height: the distance is mostly along the axis."""
    k, x, y, d = distance(rng, flat=True)
    return k, x, y + 2 * k, np.hypot(d, 2)


def opposite(rng):
    """x and y in one plane with the axis, one on either side of it, without rounding."""
    return [0, 0, 1], [3, 0, 1], [-4, 0, 1], 6


def whole_distance(rng):
    a = int(rng.integers(1, 4))
    return [0, 0, 1], [3, 0, a], [0, 4, a], 5


# ---- jacobian_column


def column(rng, kind="revolute", R=None):
    w, q, T = _unit(rng), rng.uniform(-0.5, 0.5, 3), random_pose(rng)
    if R is not None:
        T[:3, :3] = R
    return kind, w, q, T


def through_the_tool(rng):
    """The axis passes through the tool point: it cannot move it."""
    kind, w, _, T = column(rng)
    return kind, w, T[:3, 3] + rng.uniform(0.2, 0.5) * w, T


def along_an_axis(rng):
    """An axis along one of the room's: w alone holds whole numbers."""
    kind, _, q, T = column(rng)
    return kind, rng.permutation([0, 0, 1]), q, T


def whole_column(rng):
    T = whole_pose(turn(2, np.pi / 2) @ turn(0, np.pi / 2), rng.integers(1, 5, 3))
    return "revolute", [0, 1, 0], rng.integers(-4, 0, 3), T


# ---- newton_step


def search(rng, n=6, turned=True, shifted=True):
    """A Jacobian of n joints, a pose and a target near it."""
    J = rng.normal(size=(6, n)) + 3 * np.eye(6, n)
    here, change = random_pose(rng), np.eye(4)
    if turned:
        change[:3, :3] = turn(0, rng.uniform(0.2, 0.9)) @ turn(1, rng.uniform(0.2, 0.9))
    if shifted:
        change[:3, 3] = rng.uniform(0.1, 0.4, 3) * rng.choice([-1, 1], 3)
    return J, here, here @ change


def search_far_or_near(rng, angle, shift):
    """A target turned by this angle about any axis."""
    (J, here, _), k = search(rng), _unit(rng)
    change = np.eye(4)
    change[:3, :3] = np.column_stack([turned(k, axis, angle) for axis in np.eye(3)])
    change[:3, 3] = shift * _unit(rng)
    return J, here, here @ change


def singular_search(rng):
    """Axes 4 and 6 in one line, as at guess A."""
    J, here, there = search(rng)
    J[:, 5] = J[:, 3]
    return J, here, there


def search_near_singular(rng):
    """One motion costs the joints 500 times as much as another: the step is long, but it leads there."""
    J, here, there = search(rng)
    U, s, Vt = np.linalg.svd(J)
    s[-1] = 2e-3 * s[0]
    return U * s @ Vt, here, there


def whole_search(rng):
    J = np.diag(rng.integers(1, 4, 6)) + np.eye(6, k=1, dtype=int)
    here = whole_pose(turn(0, np.pi / 2), rng.integers(1, 5, 3))
    return J, here, whole_pose(turn(0, np.pi / 2) @ turn(2, np.pi / 2), rng.integers(1, 5, 3))


# ---- laws


def turns_x_to_y(_f, args, t):
    k, x, y = args
    return bool(np.allclose(turned(k, x, t), y, atol=1e-6))


def reaches(_f, args, solutions):
    r, z, lengths = args
    out, up = wrist_in_plane(*solutions.T, lengths)
    return bool(np.allclose(out, r, atol=1e-5) and np.allclose(lengths[1] + up, z, atol=1e-5))


def gives_R(_f, args, solutions):
    return bool(np.allclose([wrist(row) for row in solutions], args[0], atol=1e-5))


def gives_T(_f, args, solutions):
    T, lengths, tool = args
    return bool(np.allclose([forward(theta, lengths, tool) for theta in solutions], T, atol=1e-5))


def turns_both(_f, args, rows):
    k1, k2, x, y = args
    return all(np.allclose(turned(k1, turned(k2, x, t2), t1), y, atol=1e-5) for t1, t2 in rows)


def keeps_the_distance(_f, args, angles):
    k, x, y, d = args
    return all(abs(np.linalg.norm(y - turned(k, x, t)) - d) < 1e-5 for t in angles)
