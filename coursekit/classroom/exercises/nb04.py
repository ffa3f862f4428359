"""Exercises of notebook 04: singularities, and the exam about the S030."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb04 as _exam
from coursekit.classroom.exercises import _nb04_rank as _rank
from coursekit.classroom.exercises import looks
from coursekit.classroom.exercises._arm import KR6, deg, mm, wrist_in_plane

# What the student's functions may call from coursekit.kinematics: what they wrote before. numpy is enough.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.exp3",
    "lie.inverse",
    "lie.adjoint",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
    "subproblems.subproblem1",
)

NONE = 1e-6  # metres, radians, lengths of twists: less is rounding


# ---- det_from_blocks


def _wrist_jacobian(rng):
    """J with its reference point at a wrist centre: the lower right block is 0."""
    J = rng.uniform(-1, 1, (6, 6))
    J[3:, 3:] = 0
    return (J,)


def _singular_arm(rng):
    (J,) = _wrist_jacobian(rng)
    J[3:, 2] = J[3:, 0] - J[3:, 1]
    return (J,)


def _nothing_upper_left(rng):
    (J,) = _wrist_jacobian(rng)
    J[:3, :3] = 0
    return (J,)


def _whole_wrist_jacobian(rng):
    """Triangular blocks: neither determinant is 0."""
    J = np.zeros((6, 6), dtype=int)
    J[:3, :3] = rng.integers(-3, 4, (3, 3))
    J[:3, 3:] = np.triu(rng.integers(1, 4, (3, 3)))
    J[3:, :3] = np.tril(rng.integers(1, 4, (3, 3))) * [[1], [-1], [1]]
    return (J,)


def _something_lower_right(rng):
    """The block that counts as 0 holds numbers: only a function that does not look there is right."""
    (J,) = _wrist_jacobian(rng)
    J[3:, 3:] = rng.uniform(-1, 1, (3, 3))
    return (J,)


def _by_numpy(args, value, right):
    if not np.isfinite(value):
        return ""
    whole = "with 0 in that block, numpy's det of" if np.any(args[0][3:, 3:]) else "numpy's det of the whole"
    return f"{whole} J is {right:.4g} in one example, yours is {value + 0.0:.4g}"


# ---- elbow_angle and shoulder_theta3


def _forearm(rng, side=1):
    return side * rng.uniform(0.03, 0.2), rng.uniform(0.3, 0.7)


def _out_of_line(args, value, right):
    a3, d4 = args
    gap = abs(a3 * np.cos(value) - d4 * np.sin(value))
    if not np.isfinite(gap):
        return ""
    if gap < NONE and np.cos(value - right) < 0:
        return "the wrist is in line with axes 2 and 3, but between them: the arm is folded, not stretched"
    return f"at your angle the wrist centre is {mm(gap)} away from the line through axes 2 and 3"


def _lengths(rng):
    """a1, a2, a3, d4, d6."""
    return rng.uniform([0.02, 0.4, 0.02, 0.4, 0.05], [0.1, 0.6, 0.1, 0.6, 0.15])


def _arm(rng, sign=-1):
    """theta_2 and the lengths of an arm whose wrist centre can come to axis 1.

    sign : of theta_2; the upper arm points up where it is negative.
    """
    a1, a2, a3, d4, d6 = _lengths(rng)
    outwards = rng.uniform(-0.5, 0.5) * np.hypot(a3, d4)
    theta2 = sign * np.arccos(np.clip((outwards - a1) / a2, -0.95, 0.95))
    return theta2, [a1, a2, a3, d4, d6]


def _arm_without(rng, which, sign=0.0):
    theta2, lengths = _arm(rng)
    lengths[which] *= sign
    return theta2, lengths


def _arm_turned(rng):
    theta2, lengths = _arm(rng)
    return theta2 + 2 * np.pi, lengths


def _kr6(rng):
    a1, _, a2, a3, d4 = KR6
    return -2.2, [a1, a2, a3, d4, 0.08]


def _off_axis_1(args, value, right):
    theta2, (a1, a2, a3, d4, _) = args
    if not np.isfinite(value):
        return ""
    lengths = (a1, 0, a2, a3, d4)
    out, up = wrist_in_plane(theta2, value, lengths)
    _, highest = wrist_in_plane(theta2, right, lengths)
    if abs(out) < NONE:
        if highest - up < NONE:
            return ""
        return f"the wrist centre is on axis 1, but {mm(highest - up)} lower than it can be"
    where = "in front of" if out > 0 else "behind"
    return f"put back into the arm, your angle leaves the wrist centre {mm(abs(out))} {where} axis 1"


# ---- lost_motion


def _singular(rng):
    return (_rank.matrix(rng, np.append(rng.uniform(0.3, 2, 5), 0)),)


def _one_row_zero(rng):
    """The motion of this row is lost. The other rows are no longer at right angles to each other."""
    J = _rank.orthogonal(rng) + 0.2 * _rank.orthogonal(rng)
    J[rng.integers(6)] = 0
    return (J,)


def _stretched(theta4):
    """The KR6 with its elbow stretched, as in the notebook."""

    def draw(rng):
        from coursekit import robots

        elbow = np.arctan2(KR6[3], KR6[4])
        return (robots.kuka_kr6().jacobian_body([0.3, -0.7, elbow, theta4, 0.8, 0.2]),)

    return draw


def _whole_singular(rng):
    J = 2 * np.eye(6, dtype=int) + np.eye(6, k=1, dtype=int) * rng.integers(1, 3)
    J[:, 5] = J[:, 0] + J[:, 1] - J[:, 4]
    return (J,)


def _not_lost(args, value, right):
    J, size = args[0], np.linalg.norm(value)
    if not np.isfinite(size) or size < NONE:
        return ""
    given = J.T @ (value / size)
    off = np.degrees(np.arccos(min(abs(value @ right) / size, 1.0)))
    if np.abs(given).max() < NONE:
        return f"your twist has the right direction; its length should be 1 and is {size:.4g}"
    k = int(np.abs(given).argmax())
    return (
        f"your motion is {deg(off)} away from the lost one: it is not at right angles to what joint {k + 1} "
        f"gives (their product is {given[k] * size:.2g}, not 0)"
    )


EXERCISES = [
    Exercise(
        "det_from_blocks(J)",
        points=2,
        draw=_wrist_jacobian,
        shape=(),
        tol=1e-9,
        samples=3,
        edges=(
            Edge("where J[:3, :3] is zero", _nothing_upper_left),
            Edge("where the lower left block is singular", _singular_arm),
            Edge("where the block that counts as 0 holds other numbers", _something_lower_right, 3),
            Edge("for whole numbers", _whole_wrist_jacobian, tol=1e-6),
        ),
        residual=_by_numpy,
        hints=(
            Hint("no_sign", "the size is right: count how often two rows change places"),
            Hint("diagonal", "these are the blocks on the diagonal; one of them is 0, so look at the others"),
            Hint("diagonal_sign", "right sign, but the blocks are those on the diagonal: take the others"),
            Hint("sizes", "a block can be singular without being 0: take its determinant, not its size"),
            Hint("arm_only", "this is the arm's block alone: the wrist has its share in det J"),
            Hint("two_products", "the lower right block counts as 0: leave out its product"),
            Hint("whole", "that is the determinant of the whole J: use the two 3 x 3 blocks"),
            Hint(
                "two_rows",
                "your blocks are 2 x 2: numpy counts from 0, and a slice ends before its second number",
            ),
        ),
    ),
    Exercise(
        "elbow_angle(a3, d4)",
        look=looks.stretched,
        points=1,
        draw=_forearm,
        shape=(),
        compare="angle",
        tol=1e-7,
        unit="rad",
        samples=3,
        edges=(
            Edge("for the KR6", lambda rng: (0.035, 0.42)),
            Edge("where a3 is negative", lambda rng: _forearm(rng, -1), 2),
            Edge("for whole numbers", lambda rng: (35, 420)),
        ),
        usual="where a3 is positive",
        residual=_out_of_line,
        hints=(
            Hint("inverted", "you exchanged the lengths: for a small offset a3 the angle must be small"),
            Hint("ratio", "this is the ratio of the lengths, not yet an angle"),
            Hint("swapped", "arctan2 takes the leg opposite the angle first: that is a3"),
            Hint("sine", "a3 and d4 are the legs of the triangle; you took d4 for its longest side"),
            Hint("rounded", "rounded to three digits: at that angle the arm is not singular yet"),
            Hint("sign", "the forearm must turn the other way to bring the wrist into line"),
        ),
    ),
    Exercise(
        "shoulder_theta3(theta2, lengths)",
        look=looks.shoulder,
        points=3,
        draw=_arm,
        shape=(),
        compare="angle",
        tol=1e-7,
        unit="rad",
        edges=(
            Edge("for the KR6", _kr6),
            Edge("where theta_2 is positive", lambda rng: _arm(rng, 1), 2),
            Edge("for an upper arm that points straight up", lambda rng: (-np.pi / 2, _arm(rng)[1])),
            Edge("where a1 is 0", lambda rng: _arm_without(rng, 0)),
            Edge("where a3 is 0", lambda rng: _arm_without(rng, 2)),
            Edge("for whole numbers", lambda rng: (-2, [1, 5, 3, 4, 2])),
            Edge("where theta_2 is beyond half a turn", _arm_turned),
            Edge("where a3 is negative", lambda rng: _arm_without(rng, 2, -1)),
        ),
        usual="where theta_2 is negative",
        residual=_off_axis_1,
        hints=(
            Hint("order", "here the lengths are a1, a2, a3, d4, d6: another order than in notebook 03"),
            Hint("flange", "you brought the flange to axis 1; it is the wrist centre that must lie there"),
            Hint("rounded", "rounded to three digits, as in a printed table: return the full number"),
            Hint("no_a1", "axis 1 is not above axis 2: the length a1 between them is missing"),
            Hint("no_a3", "the forearm is not straight: its offset a3 is missing"),
            Hint("lower", "that is the other solution, with the wrist lower"),
            Hint("forth", "the forearm must lead back: c is minus the distance of axis 3 from axis 1"),
            Hint("upwards", "a positive angle turns downwards here; you let it turn upwards"),
            Hint("swapped_legs", "delta = atan2(b, a): b, the factor of the sine, is a3; a is d4"),
            Hint("sum", "this is theta2 + theta3, the angle of the forearm in the room"),
        ),
    ),
    Exercise(
        "theta2_system(p, theta1, theta3, lengths)",
        look=looks.exam_arm,
        points=2,
        draw=_exam.reached,
        shape=(),
        compare="angle",
        unit="rad",
        edges=(
            Edge("for the exam's p_n", _exam.the_exam),
            Edge("where the arm bends backwards over axis 1", lambda rng: _exam.reached(rng, front=False), 2),
            Edge("where P lies beside axis 1, p_x = 0", _exam.beside, 2),
            Edge("where cos(theta_3) is negative", lambda rng: _exam.reached(rng, folded=True), 2),
            Edge("for whole numbers", _exam.whole_exam),
            Edge("where the joints have turned more than once", _exam.turned),
        ),
        usual="where the arm reaches to the front",
        residual=_exam.misses_p,
        hints=(
            Hint("swapped", "the first unknown of the system is the cosine; arctan2 takes the sine first"),
            Hint("no_a1", "the upper arm begins at a1, not at axis 1"),
            Hint("no_d1", "the shoulder stands at the height d1: subtract it from p_z"),
            Hint("one_sign", "look at the signs of d4 cos(theta_3): they differ in the two rows"),
            Hint(
                "transposed",
                "the part with d4 cos(theta_3) turns the wrong way: in the matrix its minus stands lower"
                " left; or you multiplied, A @ b, where A x = b is to be solved",
            ),
            Hint("a1_twice", "a1 is taken off twice: r begins at axis 1, r - a1 at the shoulder"),
            Hint(
                "front_only",
                "bent backwards over axis 1 the arm reaches to a negative distance: use theta1, not a length",
            ),
            Hint("divided", "p_x / cos(theta_1) is 0 / 0 where p_x is 0: p_x cos + p_y sin is r everywhere"),
            Hint(
                "one_quadrant",
                "an arccos or arcsin of one unknown knows half of the circle: use both unknowns",
            ),
            Hint("arcsin", "an arcsin of one unknown knows half of the circle: use both unknowns"),
            Hint("arctan", "arctan of a quotient loses which of the two was negative: arctan2 takes both"),
        ),
    ),
    Exercise(
        "rank(J, tol)",
        points=2,
        draw=_rank.nearly_singular,
        shape=(),
        tol=0.1,
        samples=1,
        edges=(
            Edge("where two motions are lost", lambda rng: _rank.nearly_singular(rng, lost=2)),
            Edge("where one singular value is small", lambda rng: _rank.nearly_singular(rng, small=True)),
            Edge("for a J that is 1000 times larger", lambda rng: _rank.nearly_singular(rng, 1000, 1)),
            Edge("for a J that is 1000 times smaller", lambda rng: _rank.nearly_singular(rng, 1e-3, 1, True)),
            Edge("for seven joints", lambda rng: _rank.nearly_singular(rng, columns=7)),
            Edge("for two joints", lambda rng: _rank.nearly_singular(rng, lost=0, columns=2)),
            Edge("for tol = 1", _rank.limit_met),
            Edge("for tol = 0.2", _rank.coarse, 2),
            Edge("for tol = 1e-10", _rank.fine),
            Edge("for singular values close to tol = 1e-10", _rank.finest, 2),
            Edge("where all eigenvalues of J are 0", _rank.nilpotent),
            Edge("for whole numbers", _rank.whole),
            Edge("where pivots tell nothing", _rank.pivots_of_one),
            Edge("where a joint moves nothing", lambda rng: _rank.pivots_of_one(rng, 1)),
        ),
        usual="for six joints and tol = 1e-6",
        residual=_rank.counted,
        hints=(
            Hint("determinant", "a determinant tells 6 from less, but not 5 from 4, and it has a unit"),
            Hint(
                "absolute", "a fixed limit is too low for a large J: compare with the largest singular value"
            ),
            Hint("squares", "you compare squares of singular values with tol"),
            Hint(
                "frobenius",
                "np.linalg.norm(J) is the root of all squares added, more than the largest singular value",
            ),
            Hint("lost", "you counted the motions that are lost"),
            Hint("added", "you added singular values: a rank is a number of them"),
        ),
    ),
    Exercise(
        "lost_motion(J)",
        look=looks.twist,
        points=2,
        draw=_singular,
        shape=(6,),
        compare="up_to_sign",
        samples=3,
        edges=(
            Edge("for the KR6 with its elbow stretched", _stretched(0.5)),
            Edge("for the KR6 stretched, with axis 5 parallel to axes 2 and 3", _stretched(0.0)),
            Edge("where a row of J is zero", _one_row_zero, 2),
            Edge("for whole numbers", _whole_singular),
        ),
        usual="where no row of J is zero",
        blocks=(
            Block("the upper half (omega)", np.s_[:3]),
            Block("the lower half (v)", np.s_[3:]),
        ),
        residual=_not_lost,
        hints=(
            Hint("joint_rates", "that is the joint motion that moves nothing; the lost motion is a twist"),
            Hint("v_first", "(omega; v): you exchanged the two halves"),
            Hint("row_of_u", "a row of U: the vectors you want are its columns"),
            Hint("easiest", "that is the motion which comes most easily: look at the other end of the list"),
        ),
    ),
]
