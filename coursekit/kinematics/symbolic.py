"""The same arms in sympy: link matrices, M, S, B, Jacobians, and det J in factors, as expressions to look at.

Everything is exact: quarter turns are pi/2, lengths are symbols (a_2, d_4, ...) whose values an `Arm` knows.
Nothing here takes more than seconds, because nothing large is ever simplified: J is written at the wrist
centre and in the frame of link 3, where theta_2 + theta_3 stays one argument and half of the entries are 0.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .robot import Robot
from .symbolic_matrices import (
    Scalar,
    adjoint,
    dh_matrix,
    half_steps,
    hat3,
    inverse,
    pose,
    rotx,
    roty,
    rotz,
    screw_exp,
    turn,
    xyx,
)

if TYPE_CHECKING:
    import sympy as sp
else:
    from .symbolic_matrices import sp

__all__ = [
    "Arm",
    "adjoint",
    "arm",
    "determinant",
    "dh_matrix",
    "factors",
    "fk",
    "half_steps",
    "hat3",
    "inverse",
    "jacobian",
    "pose",
    "rotx",
    "roty",
    "rotz",
    "screw_exp",
    "turn",
    "wrist_center",
    "wrist_jacobian",
    "xyx",
]


@dataclass(frozen=True, eq=False)
class Arm:
    """A robot whose lengths are symbols. Made by `arm`.

    theta     n symbols theta_1 ... theta_n
    S, M, B   Matrices (6, n), (4, 4), (6, n): space screws, home pose, body screws
    A         n standard DH matrices, A_i(theta_i); empty for a robot without a DH table
    base, tool  what stands before and behind them: T = base A_1 ... A_n tool
    lengths   {symbol: metres}
    """

    name: str
    theta: tuple[sp.Symbol, ...]
    S: sp.Matrix
    M: sp.Matrix
    A: tuple[sp.Matrix, ...]
    base: sp.Matrix
    tool: sp.Matrix
    lengths: dict[sp.Symbol, sp.Rational]

    @property
    def B(self) -> sp.Matrix:
        """Body screws (6, n): Ad(M^-1) S."""
        return adjoint(inverse(self.M)) * self.S

    def numbers(
        self, expression: sp.Expr | sp.Matrix, theta: Iterable[Scalar] | None = None
    ) -> sp.Expr | sp.Matrix:
        """The expression with metres for the lengths, and with the joint angles where theta (n,) is given."""
        angles = {} if theta is None else dict(zip(self.theta, theta, strict=True))
        return expression.subs({**self.lengths, **angles})


def arm(robot: Robot) -> Arm:
    """A `Robot` in symbols: its standard DH table with a_i and d_i for every length that is not 0.

    Symbols are positive lengths, signs stand in front of them. A tool that is only moved along z continues
    the last link, so its length is d_n. A robot without a DH table keeps its numbers, as exact fractions.

    >>> from coursekit import robots
    >>> kr6 = arm(robots.kuka_kr6())
    >>> kr6.S[:, 1].T, kr6.M[:3, 3].T
    (Matrix([[0, 1, 0, -d_1, 0, a_1]]), Matrix([[a_1 + a_2 + d_4 + d_6, 0, a_3 + d_1]]))
    """
    n = robot.n
    lengths: dict[sp.Symbol, sp.Rational] = {}
    theta = sp.symbols(f"theta_1:{n + 1}", real=True)
    table = robot.standard_dh
    if table is None:
        S, M = sp.Matrix(robot.S).applyfunc(_fraction), sp.Matrix(robot.M).applyfunc(_fraction)
        return Arm(robot.name, theta, S, M, (), sp.eye(4), sp.eye(4), lengths)

    def length(letter, i, value):
        if value == 0:
            return sp.Integer(0)
        symbol = sp.Symbol(f"{letter}_{i}", positive=True)
        lengths[symbol] = _fraction(abs(value))
        return symbol * int(np.sign(value))

    base, tool = (sp.Matrix(T).applyfunc(_fraction) for T in (table.base, table.tool))
    if table.d[-1] == 0 and tool[0, 3] == tool[1, 3] == 0:
        tool[2, 3] = length("d", n, table.tool[2, 3])
    A, S, T = [], sp.zeros(6, n), base
    for i in range(n):
        a, d = length("a", i + 1, table.a[i]), length("d", i + 1, table.d[i])
        alpha, offset = _angle(table.alpha[i]), _angle(table.theta[i])
        w, q = T[:3, 2], T[:3, 3]
        slides = robot.joint_types[i] == "prismatic"
        S[:, i] = sp.Matrix([0, 0, 0, *w]) if slides else sp.Matrix([*w, *(-w.cross(q))])
        A.append(
            dh_matrix(a, alpha, d + theta[i], offset) if slides else dh_matrix(a, alpha, d, theta[i] + offset)
        )
        T = T * A[i].subs(theta[i], 0)
    return Arm(robot.name, theta, S, T * tool, tuple(A), base, tool, lengths)


def fk(arm: Arm) -> sp.Matrix:
    """T(theta) = e^[S_1]theta_1 ... e^[S_n]theta_n M, with the angles of parallel neighbours added.

    >>> from coursekit import robots
    >>> fk(arm(robots.planar_2r()))[0, 3]
    a_1*cos(theta_1) + a_2*cos(theta_1 + theta_2)
    """
    *_, (R, o, q) = _along(arm)
    return pose(R * arm.M[:3, :3], o + R * (arm.M[:3, 3] - q))


def jacobian(arm: Arm) -> sp.Matrix:
    """The space Jacobian (6, n): column i is (w_i; -w_i x o_i) of the moved axis, or (0; v_i) of a slide.

    >>> from coursekit import robots
    >>> jacobian(arm(robots.planar_2r()))[:, 1].T
    Matrix([[0, 0, 1, a_1*sin(theta_1), -a_1*cos(theta_1), 0]])
    """
    columns = []
    for S, (R, o, _) in zip(arm.S.T.tolist(), _along(arm), strict=False):
        w, v = R * sp.Matrix(S[:3]), R * sp.Matrix(S[3:])
        columns.append([*w, *(-w.cross(o) if any(S[:3]) else v)])
    return sp.Matrix(columns).T


def _along(arm):
    """Walk along the arm. Before each joint and once behind the last: (R, o, q).

    R is what the joints so far turn, o the place to which they carry the point q of the axis ahead. Parallel
    axes turn as one, by the sum of their angles: that keeps products of cosines out of every result.
    """
    R_outer, axis, angle = sp.eye(3), None, 0
    R, o, q = sp.eye(3), sp.zeros(3, 1), sp.zeros(3, 1)
    for S, theta in zip(arm.S.T.tolist(), arm.theta, strict=True):
        w, v = sp.Matrix(S[:3]), sp.Matrix(S[3:])
        if w.is_zero_matrix:
            yield R, o, q
            o = o + R * v * theta
            continue
        o, q = o + R * (w.cross(v) - q), w.cross(v)
        yield R, o, q
        if axis is not None and w.cross(axis).is_zero_matrix:
            angle = angle + w.dot(axis) * theta
        else:
            R_outer, axis, angle = R, w, theta
        R = R_outer * turn(axis, angle)
    yield R, o, q


# -- singularities -------------------------------------------------------------------------------------


def wrist_center(arm: Arm) -> sp.Matrix:
    """P(theta): where axes 4, 5 and 6 meet, in the space frame. A (3, 1) Matrix.

    Raises ValueError where they do not meet in one point or axes 2 and 3 are not parallel. Robotics I exam,
    17 June 2019, eq. 1.

    >>> from coursekit import robots
    >>> wrist_center(arm(robots.kawasaki_s030()))[2]
    a_2*sin(theta_2) + d_1 - d_4*cos(theta_2 + theta_3)
    """
    w, q, c = _spherical(arm)
    t1, t2, t23 = _arm_angles(arm)
    R1, R2, R23 = turn(w[0], t1), turn(w[1], t2), turn(w[1], t23)
    return q[0] + R1 * (q[1] - q[0] + R2 * (q[2] - q[1]) + R23 * (c - q[2]))


def wrist_jacobian(arm: Arm) -> sp.Matrix:
    """J with the wrist centre as reference point, along the axes of link 3. A (6, 6) Matrix, rows (omega; v).

    Nobody looks for singularities in the base frame twice: there det J is the same number in a thousand
    terms. Here joints 4 to 6 do not move the reference point, and link 3 sees only theta_2 + theta_3 and
    theta_3 of what lies below it. Raises ValueError as wrist_center does.

    >>> from coursekit import robots
    >>> wrist_jacobian(arm(robots.kuka_kr6()))[3:, 0].T
    Matrix([[0, -a_1 - a_2*cos(theta_2) - a_3*sin(theta_2 + theta_3) - d_4*cos(theta_2 + theta_3), 0]])
    """
    w, q, c = _spherical(arm)
    _, t2, t23 = _arm_angles(arm)
    _, _, t3, t4, t5, _ = arm.theta
    back_3, back_23 = turn(w[2], -t3), turn(w[1], -t23)
    reach = q[1] - q[0] + turn(w[1], t2) * (q[2] - q[1]) + turn(w[1], t23) * (c - q[2])
    v = [
        back_23 * w[0].cross(reach),
        w[1].cross(c - q[2] + back_3 * (q[2] - q[1])),
        w[2].cross(c - q[2]),
    ]
    omega = [
        back_23 * w[0],
        w[1],
        w[2],
        w[3],
        turn(w[3], t4) * w[4],
        turn(w[3], t4) * turn(w[4], t5) * w[5],
    ]
    return sp.Matrix.vstack(sp.Matrix.hstack(*omega), sp.Matrix.hstack(*v, *[sp.zeros(3, 1)] * 3))


def factors(arm: Arm) -> dict[str, sp.Expr]:
    """det J in its three factors, {"wrist", "elbow", "shoulder"}: the expressions behind singularity.factors.

    With J at the wrist centre, det J = -det J_12 det J_21 (3 x 3 blocks). wrist is -det J_12; elbow and
    shoulder are what joints 2 and 3, and joint 1, add to det J_21. TPK4170 report 2021, section 5.2.

    >>> from coursekit import robots
    >>> factors(arm(robots.kuka_kr6()))["wrist"], factors(arm(robots.kuka_kr6()))["elbow"]
    (sin(theta_5), a_2*(a_3*cos(theta_3) - d_4*sin(theta_3)))
    """
    w, q, _ = _spherical(arm)
    J = wrist_jacobian(arm)
    v_1, v_2, v_3 = (J[3:, i] for i in range(3))
    n = w[1].cross(w[0])
    upper_arm = q[2] - q[1]
    outwards = [n.dot(q[1] - q[0]), n.dot(upper_arm), n.dot(w[1].cross(upper_arm))]
    side = next(sp.sign(length) for length in outwards if length != 0)
    return {
        "wrist": sp.simplify(-J[:3, 3:].det()),
        "elbow": sp.factor(side * sp.expand(w[1].dot(v_2.cross(v_3)))),
        "shoulder": sp.expand(side * w[1].dot(v_1)),
    }


def determinant(arm: Arm) -> sp.Expr:
    """det J (of J_s and of J_b with any tool) as the product of its factors.

    >>> from coursekit import robots
    >>> kr6 = arm(robots.kuka_kr6())
    >>> sp.simplify(wrist_jacobian(kr6).det() - determinant(kr6))
    0
    """
    return sp.prod(factors(arm).values())


def _spherical(arm):
    """Axes w_i, points q_i and the wrist centre c at theta = 0, or a ValueError."""
    if arm.S.cols != 6:
        raise ValueError(
            f"{arm.name} has {arm.S.cols} joints: a wrist centre needs an arm of three and a wrist of three"
        )
    w = [arm.S[:3, i] for i in range(6)]
    q = [w[i].cross(arm.S[3:, i]) for i in range(6)]
    if not w[1].cross(w[2]).is_zero_matrix:
        raise ValueError(f"{arm.name}: axes 2 and 3 are not parallel")
    normal = w[3].cross(w[4])
    if normal.is_zero_matrix or sp.simplify(normal.dot(q[4] - q[3])) != 0:
        raise ValueError(f"{arm.name}: axes 4 and 5 do not meet in one point, so there is no wrist centre")
    c = q[3] + w[3] * ((q[4] - q[3]).cross(w[4]).dot(normal) / normal.dot(normal))
    if not w[5].cross(c - q[5]).applyfunc(sp.simplify).is_zero_matrix:
        raise ValueError(f"{arm.name}: axis 6 does not pass through the point where axes 4 and 5 meet")
    return w, q, c


def _arm_angles(arm):
    """theta_1, theta_2, and the angle about axis 2 that both parallel joints make together."""
    same = arm.S[:3, 1].dot(arm.S[:3, 2])
    return arm.theta[0], arm.theta[1], arm.theta[1] + same * arm.theta[2]


def _fraction(value):
    """The decimal number that is meant by a float: 0.435 is 87/200."""
    return sp.Rational(str(round(float(value), 12)))


def _angle(value):
    """A multiple of 15 degrees as a fraction of pi, anything else as a decimal fraction."""
    twelfths = value * 12 / np.pi
    if abs(twelfths - round(twelfths)) < 1e-9:
        return sp.pi * sp.Rational(round(twelfths), 12)
    return _fraction(value)
