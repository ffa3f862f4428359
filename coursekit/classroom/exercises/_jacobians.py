"""Arms, Jacobians and steps for the exercises of notebook 05: how their arguments are drawn."""

from __future__ import annotations

import numpy as np

KR10 = (  # its screws: w and a point of each axis
    ((0, 0, -1), (0, 1, 0), (0, 1, 0), (-1, 0, 0), (0, 1, 0), (-1, 0, 0)),
    ((0, 0, 0), (0.025, 0, 0.4), (0.585, 0, 0.4), (0, 0, 0.425), (1.1, 0, 0.425), (0, 0, 0.425)),
)
KR10_TOOL = np.array([1.19, 0, 0.425])


def angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.2, 1.3, n)


def axes(rng, n):
    """Unit vectors (n, 3)."""
    w = rng.normal(size=(n, 3))
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def screws(rng, n=None):
    n = n or int(rng.integers(4, 8))
    w, q = axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3))
    return np.column_stack([w, np.cross(q, w)]).T, angles(rng, n)


def screws_turned(rng):
    S, theta = screws_with_pitch(rng)
    return S, theta + 2 * np.pi * np.array([1, -1, 1, -1])


def screws_with_slide(rng):
    S, theta = screws(rng, 5)
    S[:, 2] = [0, 0, 0, *axes(rng, 1)[0]]
    return S, theta


def screws_with_pitch(rng):
    S, theta = screws(rng, 4)
    S[3:] += rng.uniform(0.05, 0.3, 4) * S[:3]
    return S, theta


def screws_of_the_kr10(angles):
    def draw(rng):
        w, q = map(np.array, KR10)
        return np.column_stack([w, np.cross(q, w)]).T, angles(rng)

    return draw


def whole_screws(rng):
    """A planar arm with links of 2 m and 1 m, and an axis that lies in its plane."""
    S = np.zeros((6, 4), int)
    S[2, :3], S[4, 1:3], S[0, 3], S[4, 3] = 1, (-2, -3), 1, 1
    return S, rng.permutation([1, 2, -1, -2])


def hinges(rng, n=None):
    n = n or int(rng.integers(4, 8))
    return axes(rng, n), rng.uniform(-0.6, 0.6, (n, 3)), rng.uniform(-1.0, 1.0, 3)


def tool_on_an_axis(rng):
    axes, origins, _ = hinges(rng, 4)
    return axes, origins, origins[2] + rng.uniform(0.2, 0.6) * axes[2]


def tool_at_the_origin(rng):
    axes, origins, _ = hinges(rng, 4)
    return axes, origins, np.zeros(3)


def hinges_of_the_kr10(rng):
    return np.array(KR10[0]), np.array(KR10[1]), KR10_TOOL


def arm_and_step(rng, name=None):
    """The forward kinematics of an arm, a configuration and a step of 0.0005 to 0.001 rad."""
    names = {"kuka_kr6": 6, "abb_irb1200": 6, "franka_panda": 7, "kawasaki_s030": 6, "planar_2r": 2}
    name = name or str(rng.choice(list(names)[:4]))
    return {"fk": name}, angles(rng, names[name]), rng.uniform(5e-4, 1e-3)


def turned_and_step(rng):
    fk, theta, step = arm_and_step(rng, "planar_2r")
    return fk, theta + 2 * np.pi, step


def coarse(rng):
    return {"fk": "kuka_kr6"}, angles(rng, 6), 0.1


# Central differences of positions are all alike, whatever the step. The turn between two poses may be taken
# as a logarithm, or from the entries of R_+ - R_-: that differs by step^2 / 6.
COARSE_TOL = np.repeat([[0.003], [1e-7]], 3, axis=0)


def rows(rng, n=None, lowest=(1.2, 0.6, 0.1), highest=(1.8, 0.9, 0.4)):
    """Three rows of a Jacobian whose singular values are well apart."""
    n = n or int(rng.integers(3, 8))
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (3, n))
    return (U @ np.diag(rng.uniform(lowest, highest)) @ V[:3],)


def flat_rows(rng):
    """Rank 2: rounding makes the least eigenvalue of J J^T a tiny number of either sign."""
    return rows(rng, 5, (1.2, 0.6, 0.0), (1.8, 0.9, 0.0))


def nearly_flat_rows(rng):
    return rows(rng, 5, (1.2, 0.6, 2e-4), (1.8, 0.9, 4e-4))


def panda_stretched(rng):
    """omega of the Panda at theta = 0."""
    return ([[0, 0, 0, 0, 0, 0, 0], [0, 1, 0, -1, 0, -1, 0], [1, 0, 1, 0, 1, 0, -1]],)


def step(rng, shape=None, least=None):
    """A Jacobian, nearly singular, an error and a damping."""
    m, n = shape or [(6, 7), (6, 6), (3, 7), (3, 3)][rng.integers(4)]
    U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (m, n))
    r = min(m, n)
    sigma = rng.uniform(0.3, 1.5, r)
    sigma[-1] = rng.uniform(0.02, 0.1) if least is None else least
    return U[:, :r] @ np.diag(sigma) @ V[:r], rng.uniform(-0.5, 0.5, m), rng.uniform(0.1, 0.4)


def slight_step(rng):
    """Near the target, and with little damping."""
    J, e, _ = step(rng)
    return J, 5e-3 * e, 2e-3


def singular_step(rng):
    """A row of zeros: whatever the joints do, nothing moves along it."""
    J, e, k = step(rng, (3, 4))
    J[rng.integers(3)] = 0
    return J, e, k


def whole_step(rng):
    return rng.permutation([[1, 0, 2], [0, 1, -1]]), rng.permutation([1, -2]), 1.5


def planar(rng):
    return angles(rng, 2), rng.choice([-1, 1], 2) * rng.uniform(0.4, 2.0, 2), rng.uniform(0.2, 0.8, 2)


def planar_turned(rng):
    theta, rate, lengths = planar(rng)
    return theta + 2 * np.pi, rate, lengths


def straight(rng):
    theta, rate, lengths = planar(rng)
    return theta * [1, 0], rate, lengths


def whole_planar(rng):
    return rng.permutation([1, 2]), rng.permutation([1, -2]), rng.permutation([2, 1])


def rotation(rng):
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    return np.column_stack([x, y, np.cross(x, y)])


def pose(rng, R=None):
    T = np.eye(4)
    T[:3, :3] = rotation(rng) if R is None else R
    T[:3, 3] = rng.uniform(0.2, 0.8, 3) * rng.choice([-1, 1], 3)
    return T


WHOLE_POSES = (
    np.array([[0, -1, 0, 1], [1, 0, 0, -2], [0, 0, 1, 3], [0, 0, 0, 1]]),  # a quarter turn about z
    np.array([[1, 0, 0, 2], [0, 0, -1, 1], [0, 1, 0, -1], [0, 0, 0, 1]]),  # about x
)


def factor(S=None, angle=None, left=None):
    """T_left, the screw of a joint and its angle, T_right; what is None is drawn."""

    def draw(rng):
        screw, theta = screws(rng, 1)
        return (
            pose(rng) if left is None else left,
            screw[:, 0] if S is None else np.array(S),
            theta[0] if angle is None else angle,
            pose(rng),
        )

    return draw


def turn_about_y(rng):
    return factor([0, 1, 0, 0, 0, 0])(rng)


def slide(rng):
    return factor([0, 0, 0, *axes(rng, 1)[0]], rng.uniform(0.2, 0.6))(rng)


def screw_with_pitch(rng):
    screw, theta = screws_with_pitch(rng)
    return pose(rng), screw[:, 0], theta[0], pose(rng)


def whole_factor(rng):
    left, right = (WHOLE_POSES[i] for i in rng.permutation(2))
    return left, [0, 0, 1, 2, -1, 0], int(rng.choice([-1, 1, 2])), right


def wrench(rng, n=None, R=None, moment=None, force=None):
    """A body Jacobian, the pose of the tool, a moment [N m] and a force [N] along the base."""
    n = n or int(rng.integers(5, 8))
    w = axes(rng, n)
    J = np.column_stack([w, np.cross(rng.uniform(-0.9, 0.9, (n, 3)), w)]).T
    return (
        J,
        pose(rng, R),
        rng.uniform(-8, 8, 3) if moment is None else moment,
        rng.uniform(-40, 40, 3) if force is None else force,
    )


SLIGHT = np.array([0.02, -0.03, 0.05])  # a moment that is one all the same


def whole_wrench(rng):
    J = [[0, 0, 1], [1, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 1], [0, 3, -2]]
    return J, WHOLE_POSES[rng.integers(2)], [1, -2, 3], [4, 0, -5]


def run(rng, name=None, k=None, steps=None, off=0.15):
    """An arm, a target some tenths of a radian away from the start, a damping and a number of steps."""
    from coursekit import robots

    name = name or str(rng.choice(["kuka_kr6", "abb_irb1200", "kuka_kr10"]))
    robot = getattr(robots, name)()
    theta = angles(rng, robot.n)
    there = theta + off * rng.choice([-1, 1], robot.n) * rng.uniform(0.7, 1.3, robot.n)
    return (
        {"robot": name},
        robot.fk(there),
        theta,
        rng.uniform(0.08, 0.3) if k is None else k,
        int(rng.integers(2, 5)) if steps is None else steps,
    )


def run_from_a_singular_start(rng):
    robot, T_sd, _, k, _ = run(rng, "kuka_kr6", steps=3)
    return robot, T_sd, np.zeros(6), k, 3


def run_past_half_a_turn(rng):
    """Joint 4 ends beyond half a turn, and its angle says so."""
    from coursekit import robots

    robot, _, theta, *_ = run(rng, "kuka_kr6")
    theta[3] = np.pi - 0.05
    return robot, robots.kuka_kr6().fk(theta + 0.15), theta, 0.1, 4


def run_of_turned_joints(rng):
    robot, T_sd, theta, k, _ = run(rng, "kuka_kr6", steps=1)
    return robot, T_sd, theta + 2 * np.pi, k, 1


def run_of_whole_numbers(rng):
    robot, T_sd, *_ = run(rng, "kuka_kr6")
    return robot, T_sd, rng.permutation([0, 1, -1, 0, 1, -1]), 1, 2
