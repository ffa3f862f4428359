"""Exercises of notebook 03: every solution of a six-axis arm with a spherical wrist, and Newton's method."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Exercise, Hint

# What the student's functions may call from coursekit.kinematics.
ALLOW = (
    "lie.inverse",
    "lie.log6",
    "lie.hat3",
    "lie.vee3",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
)


def _angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.25, 1.3, n)


def _rotation(rng):
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    return np.column_stack([x, y, np.cross(x, y)])


def _pose(rng):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = _rotation(rng), rng.uniform(-0.5, 0.5, 3)
    return T


def _lengths(rng):
    """a1, d1, a2, a3, d4 of an arm built like the KR6."""
    return rng.uniform([0.02, 0.3, 0.4, 0.03, 0.4], [0.1, 0.6, 0.6, 0.08, 0.6])


def _turn(axis, angle):
    """A turn about x (0), y (1) or z (2), (3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[[i, j], [i, j]], R[i, j], R[j, i] = np.cos(angle), -np.sin(angle), np.sin(angle)
    return R


def _wrist_in_plane(t2, t3, lengths):
    """Where the wrist centre is in the plane of the arm: out from axis 1, up from the shoulder."""
    a1, _, a2, a3, d4 = lengths
    out = a1 + a2 * np.cos(t2) + d4 * np.cos(t2 + t3) + a3 * np.sin(t2 + t3)
    return out, -a2 * np.sin(t2) - d4 * np.sin(t2 + t3) + a3 * np.cos(t2 + t3)


def _forward(theta, lengths, tool):
    """Tool pose of an arm built like the KR6."""
    t1, t2, t3, t4, t5, t6 = theta
    out, up = _wrist_in_plane(t2, t3, lengths)
    T = np.eye(4)
    T[:3, :3] = _turn(2, -t1) @ _turn(1, t2 + t3) @ _turn(0, -t4) @ _turn(1, t5) @ _turn(0, -t6)
    T[:3, 3] = _turn(2, -t1) @ [out, 0, lengths[1] + up] + tool * T[:3, 0]
    return T


def _arm(rng):
    """Joint angles with a bent elbow and a bent wrist, the lengths and the tool: eight solutions exist."""
    while True:
        theta, lengths = _angles(rng, 6), _lengths(rng)
        theta[4] = rng.choice([-1, 1]) * rng.uniform(0.3, 2.8)
        a1, _, a2, a3, d4 = lengths
        out, up = _wrist_in_plane(theta[1], theta[2], lengths)
        nearest, farthest = abs(a2 - np.hypot(a3, d4)) + 0.05, a2 + np.hypot(a3, d4) - 0.05
        reach = np.hypot(-abs(out) - a1, up), np.hypot(abs(out) - a1, up)  # over the back, to the front
        if abs(out) > 0.1 and nearest < min(reach) and max(reach) < farthest:
            return theta, lengths, rng.uniform(0.05, 0.2)


def _target(rng):
    return _pose(rng), rng.uniform(0.05, 0.2)


def _turn_about(rng):
    k, x = rng.normal(size=(2, 3))
    k, t = k / np.linalg.norm(k), _angles(rng, 1)[0]
    y = x * np.cos(t) + np.cross(k, x) * np.sin(t) + k * (k @ x) * (1 - np.cos(t))
    return k, x, y


def _planar_target(rng):
    """A wrist centre in front, so near that a wrong sign of the forearm's square has an answer, too."""
    while True:
        theta, lengths, _ = _arm(rng)
        out, up = _wrist_in_plane(theta[1], theta[2], lengths)
        a1, d1, a2, a3, d4 = lengths
        fore = np.hypot(a3, d4)
        if (abs(out) - a1) ** 2 + up**2 < a2**2 - fore**2 + 1.99 * a2 * fore:
            return abs(out), d1 + up, lengths


def _wrist(rng):
    t4, t6 = _angles(rng, 2)
    return (_turn(0, -t4) @ _turn(1, rng.uniform(0.3, 1.3)) @ _turn(0, -t6),)


def _reachable(rng):
    theta, lengths, tool = _arm(rng)
    return _forward(theta, lengths, tool), lengths, tool


def _search(rng):
    """A Jacobian of six or seven joints, a pose and a target near it."""
    J = rng.normal(size=(6, int(rng.integers(6, 8))))
    J[:, :6] += 3 * np.eye(6)
    here, change = _pose(rng), np.eye(4)
    change[:3, :3] = _turn(0, rng.uniform(0.2, 0.9)) @ _turn(1, rng.uniform(0.2, 0.9))
    change[:3, 3] = rng.uniform(-0.4, 0.4, 3)
    return J, here, here @ change


def _turns_x_to_y(_f, args, t):
    k, x, y = args
    turned = x * np.cos(t) + np.cross(k, x) * np.sin(t) + k * (k @ x) * (1 - np.cos(t))
    return bool(np.allclose(turned, y, atol=1e-6))


def _reaches(_f, args, solutions):
    r, z, lengths = args
    out, up = _wrist_in_plane(*solutions.T, lengths)
    return bool(np.allclose(out, r, atol=1e-5) and np.allclose(lengths[1] + up, z, atol=1e-5))


def _gives_R(_f, args, solutions):
    turned = [_turn(0, -t4) @ _turn(1, t5) @ _turn(0, -t6) for t4, t5, t6 in solutions]
    return bool(np.allclose(turned, args[0], atol=1e-5))


def _gives_T(_f, args, solutions):
    T, lengths, tool = args
    return bool(np.allclose([_forward(theta, lengths, tool) for theta in solutions], T, atol=1e-5))


EXERCISES = [
    Exercise(
        "wrist_centre(T_sd, tool)",
        points=1,
        draw=_target,
        shape=(3,),
        unit="m",
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
        points=2,
        draw=_turn_about,
        shape=(),
        compare="angle",
        unit="rad",
        samples=6,
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
        points=3,
        draw=_planar_target,
        shape=(2, 2),
        compare="set",
        unit="rad",
        samples=6,
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
        points=2,
        draw=_wrist,
        shape=(2, 3),
        compare="set",
        unit="rad",
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
        points=4,
        draw=_reachable,
        shape=(8, 6),
        compare="set",
        unit="rad",
        samples=3,
        n=10,
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
        hints=(
            Hint("space", "J_b wants the error seen from the tool; yours is seen from the space frame"),
            Hint("difference", "the difference of two matrices is not a twist: take the logarithm"),
            Hint("transpose", "that is J_b transposed; Newton's step needs the pseudo-inverse"),
            Hint("backwards", "the step leads away from the target: the error goes from here to there"),
        ),
    ),
]
