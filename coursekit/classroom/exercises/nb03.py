"""Exercises of notebook 03: every solution of a six-axis arm with a spherical wrist, and Newton's method."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb03 as _say
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._arm import (
    KR6,
    forward,
    random_pose,
    turn,
    whole_pose,
    wrist,
    wrist_in_plane,
)

# What the student's functions may call from coursekit.kinematics.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.hat6",
    "lie.vee6",
    "lie.exp3",
    "lie.exp6",
    "lie.log3",
    "lie.log6",
    "lie.inverse",
    "lie.adjoint",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
)

REPORT = (2, -1, -1, 2.5, 0.6, 0)  # the report's target is where these angles lead
TOOL = 0.08


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.25, 1.3, n)


# ---- wrist_centre


def _target(rng):
    return random_pose(rng), rng.uniform(0.05, 0.2)


def _target_not_turned(rng):
    T, tool = _target(rng)
    T[:3, :3] = np.eye(3)
    return T, tool


def _the_report(rng):
    return forward(REPORT, KR6, TOOL), TOOL


def _whole_target(rng):
    return whole_pose(turn(2, np.pi / 2) @ turn(0, np.pi / 2), rng.integers(1, 9, 3)), 2


# ---- subproblem1


def _turn_by(rng, low, high, upright=False):
    k, x = rng.normal(size=(2, 3))
    k = k / np.linalg.norm(k)
    if upright:
        x = x - k * (k @ x)
    t = rng.uniform(low, high)
    return k, x, x * np.cos(t) + np.cross(k, x) * np.sin(t) + k * (k @ x) * (1 - np.cos(t))


def _half_turn(rng):
    """Numbers without rounding: an arccos is not NaN here, but has no sign."""
    x, y, z = rng.choice([-1, 1]) * np.array([1.5, 2.0, 0.5])
    return [0.0, 0.0, 1.0], [x, y, z], [-x, -y, z]


def _whole_turn_numbers(rng):
    a, b, c = (int(i) for i in rng.integers(1, 5, 3))
    return [0, 1, 0], [a, b, c], [c, b, -a]


# ---- elbow_solutions


def _lengths(rng):
    """a1, d1, a2, a3, d4 of an arm built like the KR6."""
    return rng.uniform([0.02, 0.3, 0.4, 0.03, 0.4], [0.1, 0.6, 0.6, 0.08, 0.6])


def _triangle(rng, out=1, up=1):
    """P in front of the shoulder or behind it, above it or below.

    It is so near that a wrong sign of the forearm's square has an answer, too.
    """
    lengths = _lengths(rng)
    a1, d1, a2, a3, d4 = lengths
    fore = np.hypot(a3, d4)
    farthest = np.sqrt(a2**2 - fore**2 + 1.99 * a2 * fore)
    b, phi = rng.uniform(abs(a2 - fore) + 0.1, farthest - 0.02), rng.uniform(0.2, 1.3)
    return a1 + out * b * np.cos(phi), d1 + up * b * np.sin(phi), lengths


def _folded(rng):
    """P so near the shoulder that the angle there is more than 90 degrees."""
    lengths = rng.uniform([0.02, 0.3, 0.4, 0.03, 0.55], [0.1, 0.6, 0.45, 0.08, 0.6])
    b, phi = rng.uniform(0.25, 0.31), rng.uniform(0.2, 1.3)
    return lengths[0] + b * np.cos(phi), lengths[1] + b * np.sin(phi), lengths


def _the_report_in_plane(rng):
    T = forward(REPORT, KR6, TOOL)
    P = T[:3, 3] - TOOL * T[:3, 0]
    return np.hypot(P[0], P[1]), P[2], KR6


# ---- wrist_angles


def _bent(rng, t5, out4=1, out6=1):
    """R with theta_5 in a range; out4 and out6: the signs of the cosines of theta_4 and theta_6."""
    t4, t6 = rng.choice([-1, 1], 2) * rng.uniform(0.25, 1.3, 2)
    flip4, flip6 = np.pi * (out4 < 0), np.pi * (out6 < 0)
    return (wrist((t4 + flip4, rng.uniform(*t5), t6 + flip6)),)


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


def _reachable(rng, side=1):
    """A target whose wrist centre has an x of this sign."""
    while True:
        theta, lengths, tool = _arm(rng)
        T = forward(theta, lengths, tool)
        if side * (T[0, 3] - tool * T[0, 0]) > 0.05:
            return T, lengths, tool


def _the_report_in_reach(rng):
    return forward(REPORT, KR6, TOOL), KR6, TOOL


def _whole_reachable(rng):
    R = turn(1, np.pi / 2) @ turn(0, np.pi / 2)  # the tool points down
    return whole_pose(R, np.array([3, -4, 5]) + R[:, 0]), [1, 2, 5, 3, 4], 1


# ---- newton_step


def _search(rng, n=6, turned=True, shifted=True):
    """A Jacobian of n joints, a pose and a target near it."""
    J = rng.normal(size=(6, n)) + 3 * np.eye(6, n)
    here, change = random_pose(rng), np.eye(4)
    if turned:
        change[:3, :3] = turn(0, rng.uniform(0.2, 0.9)) @ turn(1, rng.uniform(0.2, 0.9))
    if shifted:
        change[:3, 3] = rng.uniform(0.1, 0.4, 3) * rng.choice([-1, 1], 3)
    return J, here, here @ change


def _singular_search(rng):
    """Axes 4 and 6 in one line, as at guess A."""
    J, here, there = _search(rng)
    J[:, 5] = J[:, 3]
    return J, here, there


def _whole_search(rng):
    J = np.diag(rng.integers(1, 4, 6)) + np.eye(6, k=1, dtype=int)
    here = whole_pose(turn(0, np.pi / 2), rng.integers(1, 5, 3))
    return J, here, whole_pose(turn(0, np.pi / 2) @ turn(2, np.pi / 2), rng.integers(1, 5, 3))


# ---- laws


def _turns_x_to_y(_f, args, t):
    k, x, y = args
    turned = x * np.cos(t) + np.cross(k, x) * np.sin(t) + k * (k @ x) * (1 - np.cos(t))
    return bool(np.allclose(turned, y, atol=1e-6))


def _reaches(_f, args, solutions):
    r, z, lengths = args
    out, up = wrist_in_plane(*solutions.T, lengths)
    return bool(np.allclose(out, r, atol=1e-5) and np.allclose(lengths[1] + up, z, atol=1e-5))


def _gives_R(_f, args, solutions):
    return bool(np.allclose([wrist(row) for row in solutions], args[0], atol=1e-5))


def _gives_T(_f, args, solutions):
    T, lengths, tool = args
    return bool(np.allclose([forward(theta, lengths, tool) for theta in solutions], T, atol=1e-5))


EXERCISES = [
    Exercise(
        "wrist_centre(T_sd, tool)",
        look=looks.point,
        points=1,
        draw=_target,
        shape=(3,),
        unit="m",
        samples=3,
        edges=(
            Edge("for the report's target", _the_report),
            Edge("for a tool frame that is not turned", _target_not_turned),
            Edge("for whole numbers", _whole_target),
        ),
        usual="for a tool frame that is turned",
        blocks=(Block("x of P", 0), Block("y of P", 1), Block("z of P", 2)),
        residual=_say.seen_from_the_tool,
        hints=(
            Hint("inverse", "the inverse of T_sd maps space to tool; P is known in the tool frame"),
            Hint("added", "from the tool back to the wrist: the step goes against x of the tool"),
            Hint("along_z", "this tool lies along the x axis of its own frame, not along z"),
            Hint("space_x", "you stepped along x of the space frame; the tool turns with the target"),
            Hint("row", "you took the first row of R; the x axis of the tool is a column"),
        ),
    ),
    Exercise(
        "subproblem1(k, x, y)",
        look=looks.turned,
        points=2,
        draw=lambda rng: _turn_by(rng, 0.25, 1.3),
        shape=(),
        compare="angle",
        unit="rad",
        samples=3,
        edges=(
            Edge("for a turn of more than 90 degrees", lambda rng: _turn_by(rng, 1.8, 2.9), 2),
            Edge("for a negative turn", lambda rng: _turn_by(rng, -1.3, -0.25), 2),
            Edge("for a negative turn of more than 90 degrees", lambda rng: _turn_by(rng, -2.9, -1.8), 2),
            Edge("where x and y are at right angles to k", lambda rng: _turn_by(rng, 0.25, 1.3, True), 2),
            Edge("for half a turn", _half_turn),
            Edge("for whole numbers", _whole_turn_numbers),
        ),
        usual="for turns between 0 and 90 degrees",
        residual=_say.turned_too_far,
        laws=(("turning x by your angle about k must give y", _turns_x_to_y),),
        hints=(
            Hint("swapped", "numpy's arctan2 takes the sine first, then the cosine"),
            Hint("not_removed", "only the parts of x and y across k turn: take the part along k away first"),
            Hint("sign", "it turns the other way: the sine is measured about k, from x to y"),
            Hint(
                "arccos", "an arccos, or a norm as the sine, is never negative: the sense of the turn is lost"
            ),
            Hint("arctan", "arctan of a quotient knows two quadrants only: use arctan2"),
        ),
    ),
    Exercise(
        "elbow_solutions(r, z, lengths)",
        look=looks.elbows,
        points=3,
        draw=_triangle,
        shape=(2, 2),
        compare="set",
        unit="rad",
        samples=4,
        edges=(
            Edge("for the report's target", _the_report_in_plane),
            Edge("where P is behind the shoulder", lambda rng: _triangle(rng, out=-1), 2),
            Edge("where P is below the shoulder", lambda rng: _triangle(rng, up=-1), 2),
            Edge("where P is near the shoulder and the arm folded", _folded, 2),
            Edge("for whole numbers", lambda rng: (5, 7, [1, 2, 5, 3, 4])),
        ),
        usual="where P is in front of the shoulder and above it",
        blocks=(Block("theta_2", np.s_[:, 0]), Block("theta_3", np.s_[:, 1])),
        residual=_say.misses_the_wrist_centre,
        laws=(("each row, put back into the arm, must put the wrist centre at (r, z)", _reaches),),
        hints=(
            Hint(
                "height",
                "the angle of the line shoulder to P starts at the shoulder: P is d1 lower from there",
            ),
            Hint("no_psi", "the forearm is not straight: a3 turns theta3 by a constant angle"),
            Hint("plus_square", "the square of the forearm has the wrong sign in the law of cosines"),
            Hint(
                "one_only", "that is one of the two solutions: the elbow can lie on either side of the line"
            ),
            Hint("mixed", "theta2 of one solution stands beside theta3 of the other"),
        ),
    ),
    Exercise(
        "wrist_angles(R)",
        look=looks.from_wrist,
        points=2,
        draw=lambda rng: _bent(rng, (0.3, 1.3)),
        shape=(2, 3),
        compare="set",
        unit="rad",
        edges=(
            Edge("where R[0, 0] is negative", lambda rng: _bent(rng, (1.8, 2.8)), 2),
            Edge("where R[2, 0] is positive", lambda rng: _bent(rng, (0.3, 1.3), out4=-1), 2),
            Edge("where R[0, 2] is negative", lambda rng: _bent(rng, (0.3, 1.3), out6=-1), 2),
            Edge(
                "for whole numbers",
                lambda rng: (whole_pose(wrist(np.pi / 2 * np.array([0, 1, 1])), 0)[:3, :3],),
            ),
        ),
        usual="where R[0, 0] > 0, R[2, 0] < 0 and R[0, 2] > 0",
        blocks=(
            Block("theta_4", np.s_[:, 0]),
            Block("theta_5", np.s_[:, 1]),
            Block("theta_6", np.s_[:, 2]),
        ),
        residual=_say.misses_the_rotation,
        laws=(("each row, put back into Rx(-t4) Ry(t5) Rx(-t6), must give R", _gives_R),),
        hints=(
            Hint("sqrt", "R11 is a cosine; its sine is the root of 1 - R11 squared, not of 1 - R11"),
            Hint("xyz", "you solved for x-y-z angles; axes 4 and 6 are both along x, so it is x-y-x"),
            Hint("signs", "axes 4 and 6 point to -x: both angles change their sign"),
            Hint("one_only", "that is one of the two solutions: the wrist can bend to the other side"),
            Hint("half_flip", "with theta5 negative, joints 4 and 6 have to turn by half a turn as well"),
        ),
    ),
    Exercise(
        "all_solutions(T_sd, lengths, tool)",
        look=looks.arm,
        points=4,
        draw=_reachable,
        shape=(8, 6),
        compare="set",
        unit="rad",
        samples=2,
        n=14,
        edges=(
            Edge("for the report's target", _the_report_in_reach),
            Edge("where P has a negative x", lambda rng: _reachable(rng, -1), 2),
            Edge("for whole numbers", _whole_reachable),
        ),
        usual="where P has a positive x",
        blocks=tuple(Block(f"theta_{i + 1}", np.s_[:, i]) for i in range(6)),
        residual=_say.joints_that_miss,
        laws=(("each row, put through the arm, must give T_sd back", _gives_T),),
        hints=(
            Hint(
                "front_only",
                "these reach to the front; joint 1 can turn round, the arm then reaches over its back",
            ),
            Hint("axis_1", "axis 1 points down: a positive theta1 turns from y to x"),
            Hint("same_r", "over its back the arm reaches to -r, not to r"),
            Hint(
                "no_flip", "joints 4 to 6 have two solutions for each of the four arms: four rows are missing"
            ),
            Hint("duplicates", "some rows stand twice, and others are missing"),
            Hint("R_reversed", "what is left for the wrist is R_123 transposed times R_sd, in this order"),
        ),
    ),
    Exercise(
        "newton_step(J_b, T_sb, T_sd)",
        points=2,
        draw=_search,
        shape=(None,),
        unit="rad",
        samples=3,
        edges=(
            Edge("for seven joints", lambda rng: _search(rng, 7), 2),
            Edge("for two joints", lambda rng: _search(rng, 2)),
            Edge("where J_b is singular", _singular_search),
            Edge("where the target is only shifted", lambda rng: _search(rng, turned=False)),
            Edge("where the target is only turned", lambda rng: _search(rng, shifted=False)),
            Edge("for whole numbers", _whole_search),
        ),
        usual="for six joints",
        residual=_say.moves_the_tool_otherwise,
        hints=(
            Hint("space", "J_b wants the error seen from the tool; yours is seen from the space frame"),
            Hint("difference", "the difference of two matrices is not a twist: take the logarithm"),
            Hint("transpose", "that is J_b transposed; Newton's step needs the pseudo-inverse"),
            Hint("backwards", "the step leads away from the target: the error goes from here to there"),
        ),
    ),
]
