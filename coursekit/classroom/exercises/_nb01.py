"""What the functions of notebook 01 are tried on: rows, screws and arms."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Edge


def angles(rng, n):
    """Angles that are not near a multiple of 90 degrees, where mistakes hide."""
    return np.pi / 2 * rng.integers(-2, 2, n) + rng.uniform(0.2, 1.3, n)


def dh_row(rng):
    alpha, theta = angles(rng, 2)
    return rng.uniform(0.1, 0.8), alpha, rng.uniform(-0.6, 0.6), theta


def row_with(**fixed):
    """A drawn row, some of whose numbers are given."""

    def draw(rng):
        row = dict(zip(("a", "alpha", "d", "theta"), dh_row(rng), strict=True))
        return tuple({**row, **fixed}.values())

    return draw


ROWS = (
    Edge("where alpha is zero", row_with(alpha=0.0)),
    Edge("where theta is zero", row_with(theta=0.0)),
    Edge("where a and d are zero", row_with(a=0.0, d=0.0)),
    Edge("where alpha is 90 deg", row_with(alpha=np.pi / 2)),
    Edge("where alpha is -90 deg", row_with(alpha=-np.pi / 2)),
    Edge("where alpha is 180 deg", row_with(alpha=np.pi)),
    Edge("where theta is 180 deg", row_with(theta=np.pi)),
    Edge("where a is negative", row_with(a=-0.3)),
    Edge("where alpha and d are tiny", row_with(alpha=2e-5, d=-3e-5)),
    Edge("where a and theta are tiny", row_with(a=3e-5, theta=-2e-5)),
    Edge("for whole numbers", lambda rng: (12, 2, -15, 3)),
    Edge("for angles of more than a turn", row_with(alpha=-7.0, theta=8.0)),
    Edge("for angles of more than half a turn", row_with(alpha=4.0, theta=-4.0)),
)


def rows(rng, n):
    """n rows a, alpha, d, theta offset."""
    lengths = rng.uniform(0.1, 0.8, (2, n))
    return np.column_stack([lengths[0], angles(rng, n), lengths[1], angles(rng, n)])


def pose(rng):
    """A rotation about a random axis and a shift."""
    x, y = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, y, np.cross(x, y)]), rng.uniform(-0.5, 0.5, 3)
    return T


def whole_pose(x, y, z):
    """A quarter turn about z and a shift, all in whole numbers."""
    return np.array([[0, -1, 0, x], [1, 0, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])


def dh_arm(rng, n=None):
    n = n or int(rng.integers(2, 6))
    return rows(rng, n), angles(rng, n), pose(rng), pose(rng)


def dh_arm_turned(rng):
    rows, theta, base, tool = dh_arm(rng)
    return rows, _turned(theta), base, tool


def _turned(theta):
    """A whole turn further, or back."""
    return theta + 2 * np.pi * (-1) ** np.arange(len(theta))


def dh_arm_partly_at_zero(rng):
    rows, theta, base, tool = dh_arm(rng, 4)
    return rows, theta * [1, 0, 1, 0], base, tool


def dh_arm_bare(rng):
    rows, theta, _, _ = dh_arm(rng)
    return rows, theta, np.eye(4), np.eye(4)


def dh_arm_without_base(rng):
    rows, theta, _, tool = dh_arm(rng)
    return rows, theta, np.eye(4), tool


def dh_arm_without_tool(rng):
    rows, theta, base, _ = dh_arm(rng)
    return rows, theta, base, np.eye(4)


def dh_arm_at_zero(rng):
    rows, theta, base, tool = dh_arm(rng)
    return rows, 0 * theta, base, tool


def dh_arm_without_offsets(rng):
    rows, theta, base, tool = dh_arm(rng)
    return rows * [1, 1, 1, 0], theta, base, tool


def whole_dh_arm(rng):
    rows = np.array([[1, 2, 0, 1], [2, 0, 1, -1], [0, 1, 3, 2]])
    return rows, np.array([1, -2, 3]), whole_pose(1, 2, 0), whole_pose(0, 0, 1)


def table(kind):
    """Rows, base and tool of the KR6 in this notebook."""
    from coursekit import robots

    table = getattr(robots.kuka_kr6(), kind)
    return np.column_stack([table.a, table.alpha, table.d, table.theta]), table.base, table.tool


def dh_kr6(rng):
    rows, base, tool = table("standard_dh")
    return rows, angles(rng, 6), base, tool


def direction(rng):
    w = rng.normal(size=3)
    return w / np.linalg.norm(w)


def hinge(rng, pitch=0.0):
    w, q = direction(rng), rng.uniform(-0.6, 0.6, 3)
    return np.concatenate([w, np.cross(q, w) + pitch * w])


def slide(rng):
    return np.concatenate([np.zeros(3), direction(rng)])


def screw(rng):
    """A hinge (with pitch or without) or, in one case out of three, a slide."""
    if rng.random() < 1 / 3:
        return slide(rng)
    return hinge(rng, rng.choice([0.0, rng.uniform(0.05, 0.2)]))


def screw_square_to_z(rng):
    """x and y of its axis add up to 0; it slides backwards."""
    w, q = np.array([1, -1, 0]) / np.sqrt(2), rng.uniform(-0.6, 0.6, 3)
    return np.concatenate([w, np.cross(q, w) - 0.15 * w])


def one_hinge(rng):
    return hinge(rng), angles(rng, 1)[0]


def by(make, angle=None):
    """A screw and how far it moves: a drawn angle or the given one."""
    return lambda rng: (make(rng), angles(rng, 1)[0] if angle is None else angle)


SCREWS = (
    Edge("for a slide", by(slide, 0.4)),
    Edge("for a slide", by(slide, -0.25)),
    Edge("for a screw with pitch", by(lambda rng: hinge(rng, 0.15)), 2),
    Edge("for an axis through the origin", by(lambda rng: np.concatenate([direction(rng), np.zeros(3)]))),
    Edge("where theta is zero", by(hinge, 0.0)),
    Edge("where theta is 180 deg", by(lambda rng: hinge(rng, 0.1), np.pi)),
    Edge("where theta is 360 deg", by(lambda rng: hinge(rng, 0.1), 2 * np.pi)),
    Edge("where theta is negative", by(hinge, -0.8)),
    Edge("for whole numbers", lambda rng: (np.array([0, 0, 1, 2, -1, 0]), 2)),
    Edge("where theta is more than a turn", by(lambda rng: hinge(rng, 0.1), 8.0)),
    Edge("where theta is less than minus a turn", by(lambda rng: hinge(rng, -0.1), -8.0)),
    Edge("for an axis square to z", by(screw_square_to_z)),
    Edge("where v is along omega", by(lambda rng: np.kron([1, 0.2], direction(rng)))),
    Edge("where theta is tiny", by(lambda rng: hinge(rng, 0.1), 5e-6)),
    Edge("where theta is small", by(lambda rng: hinge(rng, 0.1), -0.006)),
)


def poe_arm(rng, n=None, screw=screw):
    """Hinges and slides; a slide moves by less than a metre."""
    n = n or int(rng.integers(2, 6))
    S = np.column_stack([screw(rng) for _ in range(n)])
    return S, pose(rng), np.where(S[:3].any(axis=0), 1, 0.2) * angles(rng, n)


def poe_arm_turned(rng):
    S, M, theta = poe_arm(rng, 3, lambda rng: hinge(rng, 0.1))
    return S, M, _turned(theta)


def poe_arm_partly_at_zero(rng):
    S, M, theta = poe_arm(rng, 4)
    return S, M, theta * [1, 0, 1, 0]


def poe_arm_at_zero(rng):
    S, M, theta = poe_arm(rng)
    return S, M, 0 * theta


def poe_arm_without_M(rng):
    S, _, theta = poe_arm(rng)
    return S, np.eye(4), theta


def poe_kr6(rng):
    from coursekit import robots

    kr6 = robots.kuka_kr6()
    return kr6.S, kr6.M, angles(rng, 6)


def whole_poe_arm(rng):
    S = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, -2, 1], [0, 0, 0], [0, 1, 0]])
    return S, whole_pose(3, 0, 2), np.array([1, 2, -1])


def modified_arm(rng, n=None):
    return rows(rng, n or int(rng.integers(2, 6))), pose(rng)


def modified_arm_with(base=None, **columns):
    """A drawn arm, some columns of whose table are zero: a=0, alpha=0, d=0, offset=0."""

    def draw(rng):
        rows, drawn = modified_arm(rng)
        return rows * [
            columns.get(k, 1) for k in ("a", "alpha", "d", "offset")
        ], drawn if base is None else base

    return draw


def modified_kr6(rng):
    return table("modified_dh")[:2]


def whole_modified_arm(rng):
    return np.array([[0, 0, 1, 0], [1, 2, 0, 1], [2, -1, 3, 2]]), whole_pose(1, 2, 0)
