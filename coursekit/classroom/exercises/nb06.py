"""Exercises of notebook 06: attitudes along a path, and how fast an arm may follow it."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _attitudes as draws
from coursekit.classroom.exercises import _nb06 as residuals
from coursekit.classroom.exercises import looks

# What the student's functions may call from coursekit.kinematics: what earlier notebooks had them write, and
# the elementary turns.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.inverse",
    "lie.exp6",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
    "path.steps",
)


def _curve(rng, m=None):
    """A few points on a sphere, neighbours about a quarter radius apart, and its centre."""
    centre, radius = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.3, 0.7)
    first, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    angle = np.cumsum(rng.uniform(0.15, 0.35, m or int(rng.integers(3, 6))))
    sway = np.outer(np.sin(3 * angle + rng.uniform(0, 6)), 0.3 * np.cross(first, towards))
    points = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), towards) + sway
    return centre + radius * points / np.linalg.norm(points, axis=1, keepdims=True), centre


def _about_the_origin(rng):
    points, centre = _curve(rng, 3)
    return points - centre, np.zeros(3)


def _whole_points(rng):
    """On a sphere of radius 3 about (1, 0, -1)."""
    points = rng.permutation([[1, 2, 2], [2, 1, 2], [2, -2, 1], [-1, 2, -2]])
    return points + [1, 0, -1], [1, 0, -1]


def _configurations(rng):
    """Configurations up to one and a half turns away, and limits: some narrow, some beyond half a turn."""
    n = int(rng.integers(2, 5))
    lower, upper = -rng.uniform(1.5, 4.5, n), rng.uniform(1.5, 4.5, n)
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (24, n)), lower, upper


def _several_turns(rng):
    _, lower, upper = _configurations(rng)
    return rng.uniform(-6 * np.pi, 6 * np.pi, (12, len(lower))), lower, upper


def _one_joint(rng):
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (8, 1)), [-rng.uniform(0.5, 1)], [rng.uniform(1, 4)]


def _as_many_as_joints(rng):
    """A square theta, whose rows and columns are easily confused."""
    theta, lower, upper = _configurations(rng)
    return theta[: len(lower)], lower, upper


def _exactly_on_a_limit(rng):
    """Numbers that are exact in binary, so that no rounding decides."""
    theta = [[-1.5, 0.25], [2.25, 0.25], [0.5, -0.75], [0.5, 3.5], [-1.625, 0], [0, 3.625], [2.25, 3.5]]
    return rng.permutation(theta), [-1.5, -0.75], [2.25, 3.5]


def _both_positive(rng):
    """Limits on one side of 0, for which an angle of the other side has to turn."""
    side = rng.choice([-1, 1])
    limits = np.sort(side * rng.uniform([[0.6], [3.6]], [[1.2], [5.5]], (2, 2)), axis=0)
    return rng.uniform(-1.4 * np.pi, 1.4 * np.pi, (12, 2)), *limits


def _exam(rng):
    """Its theta_2, and limits of 35 to 325 degrees for joint 5 of the same arm."""
    theta = np.radians([[-174.72, 90], [-174.72, -20], [-174.72, -90], [10, 180], [-60, 180]])
    return theta, np.radians([-50, 35]), np.radians([195, 325])


def _more_than_a_turn(rng):
    lower, upper = np.radians([-350, -100]), np.radians([350, 100])
    return rng.uniform(-1.5 * np.pi, 1.5 * np.pi, (8, 2)), lower, upper


def _whole_angles(rng):
    return rng.integers(-9, 10, (12, 2)), [-3, -1], [2, 4]


def _motion(rng, m=8, n=None):
    """A joint path that crosses half a turn, uneven steps of the tool, another bound for every joint."""
    n = n or int(rng.integers(3, 7))
    q = np.cumsum(rng.uniform(-0.2, 0.2, (m, n)), axis=0) + rng.uniform(-0.5, 0.5, n)
    q[:, rng.integers(n)] = np.pi - 0.4 + np.cumsum(rng.uniform(0.08, 0.2, m))
    points = np.cumsum(_directions(rng, m) * rng.uniform(0.01, 0.04, (m, 1)), axis=0)
    return q, points, rng.uniform(1.5, 6.0, n)


def _directions(rng, m):
    return np.array([draws.direction(rng) for _ in range(m)])


def _one_that_hardly_moves(rng):
    q, points, v_max = _motion(rng, n=3)
    q[:, 1] = 0.7 + 1e-9 * np.arange(len(q))
    return q, points, v_max


def _equal_steps(rng):
    q, _, v_max = _motion(rng, n=3)
    return q, np.cumsum(0.02 * _directions(rng, len(q)), axis=0), v_max


def _moves_most_but_may(limit):
    """The joint that turns most is not the one that sets the speed; `limit` does, turning backwards."""

    def draw(rng):
        q, points, v_max = _motion(rng, n=3)
        most = (limit + 1) % 3
        q[:, limit] = -np.cumsum(rng.uniform(0.05, 0.1, len(q)))
        q[:, most] = np.cumsum(rng.uniform(0.2, 0.3, len(q)))
        v_max[:] = 4.0
        v_max[limit], v_max[most] = 0.5, 12.0
        return q, points, v_max

    return draw


def _whole_motion(rng):
    q = [[0, 1], [2, 0], [1, -2], [1, 1]]
    return q, [[0, 0, 0], [1, 2, 2], [1, 2, 3], [1, 5, 7]], rng.permutation([2, 3])


def _unit(f, args, q):
    return bool(abs(np.sum(q * q) - 1) < 1e-9)


def _half_as_fast(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q, points, v_max / 2), speed / 2))


def _turned_once(f, args, speed):
    q, points, v_max = args
    return bool(np.isclose(f(q + 2 * np.pi, points, v_max), speed))


EXERCISES = [
    Exercise(
        "tool_frames(points, centre)",
        look=looks.poses,
        points=3,
        draw=_curve,
        shape=(None, 4, 4),
        unit="m",
        compare="rotation",
        samples=3,
        usual="for an ordinary path",
        blocks=(
            Block("x", np.s_[:, :3, 0]),
            Block("y", np.s_[:, :3, 1]),
            Block("z", np.s_[:, :3, 2]),
            Block("the position", np.s_[:, :3, 3]),
            Block("the last row", np.s_[:, 3]),
        ),
        edges=(
            Edge("for two points", lambda rng: _curve(rng, 2)),
            Edge("for a sphere about the origin", _about_the_origin),
            Edge("for whole numbers", _whole_points),
        ),
        residual=residuals.frame_missed,
        hints=(
            Hint("inward", "x points to the centre of the sphere; the outward normal leads away from it"),
            Hint("left_handed", "these axes are left-handed: x cross y is z, y cross x is not"),
            Hint(
                "y_not_perpendicular",
                "y is not perpendicular to x: a step between two points of a sphere is no tangent",
            ),
            Hint("x_along", "x and y have changed places: x is the normal, y the direction of motion"),
            Hint("about_origin", "the normal is measured from the origin; the sphere has its own centre"),
            Hint("no_last", "a pose is missing: the last point has one, too, with the step before it"),
            Hint("backward", "the step at point i leads to point i + 1; yours comes from point i - 1"),
            Hint("central", "the step at point i leads from it to point i + 1; yours begins at point i - 1"),
            Hint(
                "last_copied",
                "the last y is a copy: take the step before it again, but the normal at the last point",
            ),
        ),
    ),
    Exercise(
        "quaternion(R)",
        look=looks.from_quaternion,
        points=3,
        draw=draws.attitude,
        shape=(4,),
        compare="up_to_sign",
        samples=3,
        n=24,
        blocks=tuple(Block(name, i) for i, name in enumerate("wxyz")),
        usual="for ordinary angles",
        edges=(
            Edge("for no turn at all", lambda rng: (np.eye(3, dtype=int),)),
            Edge("for a quarter turn", draws.quarter_turn),
            Edge("where w, x, y and z are equal", draws.right_angles),
            Edge("for a small turn", draws.small_turn),
            Edge("where x is the largest", draws.large(0)),
            Edge("where y is the largest", draws.large(1)),
            Edge("where z is the largest", draws.large(2)),
            Edge("where x is by far the largest", draws.nearly_about(0)),
            Edge("where y is by far the largest", draws.nearly_about(1)),
            Edge("where z is by far the largest", draws.nearly_about(2)),
            Edge("for a half turn about x", draws.half_turn_about(0)),
            Edge("for a half turn about y", draws.half_turn_about(1)),
            Edge("for a half turn about z", draws.half_turn_about(2)),
            Edge("for a half turn about any line", draws.half_turn),
            Edge("for a half turn about a line square to an axis", draws.half_turn_in_a_plane),
            Edge("for nearly half a turn", draws.nearly_half_a_turn),
        ),
        residual=residuals.attitude_missed,
        hints=(
            Hint(
                "wrong_entries",
                "the second component takes the wrong entries of R, in the sums and below the fraction line",
            ),
            Hint("vector_first", "the order here is (w, x, y, z): yours ends with the scalar"),
            Hint(
                "roots_only",
                "a root has no sign: the signs of x, y and z are in the differences of entries of R",
            ),
            Hint(
                "lost_at_half_turn",
                "at half a turn the differences that give the signs vanish, and your vector part with them",
            ),
            Hint(
                "divided_by_w",
                "you divide by w, which is 0 at half a turn: divide by the largest of the four, see its row",
            ),
            Hint(
                "turned_back", "this is the inverse rotation: the differences are taken the other way round"
            ),
        ),
        laws=(("a unit quaternion has length 1", _unit),),
    ),
    Exercise(
        "zyx(R)",
        look=looks.from_zyx,
        points=2,
        draw=draws.away_from_lock,
        shape=(3,),
        compare="angle",
        unit="rad",
        samples=3,
        usual="for ordinary angles",
        blocks=(Block("the yaw", 0), Block("the pitch", 1), Block("the roll", 2)),
        edges=(
            Edge("where yaw and roll lie between -90 and 0 deg", lambda rng: draws.away_from_lock(rng, [-1])),
            Edge("where R[0, 0] and R[2, 2] are negative", lambda rng: draws.away_from_lock(rng, (-2, 1))),
            Edge("for no turn at all", lambda rng: (np.eye(3, dtype=int),)),
            Edge("for a quarter turn about z", draws.quarter_turn),
            Edge("for a half turn about an axis", draws.half_turn_about(0)),
            Edge("for a half turn about an axis", draws.half_turn_about(1)),
            Edge("for a half turn about an axis", draws.half_turn_about(2)),
        ),
        residual=residuals.zyx_missed,
        hints=(
            Hint("signs_flipped", "every angle has the wrong sign: check which entry carries the minus"),
            Hint("pitch_sign", "the pitch has the wrong sign: a positive turn about y lowers the x axis"),
            Hint("reversed", "the order here is (yaw, pitch, roll): yours begins with the turn about x"),
            Hint("arcsin", "an arcsin never leaves the right half of the circle; yaw and roll go all round"),
            Hint(
                "xyz",
                "these angles belong to the product Rx Ry Rz: here the turn about z stands first",
            ),
            Hint(
                "of_the_inverse",
                "these are the angles of the inverse: rows and columns of R have changed places",
            ),
            Hint("arctan", "arctan of a quotient loses which of the two was negative: arctan2 takes both"),
            Hint(
                "zyz", "these are ZYZ angles, whose second turn is about y, but whose third is about z again"
            ),
            Hint("degrees", "the answer is in radians: yours looks like degrees"),
        ),
    ),
    Exercise(
        "inside(theta, lower, upper)",
        points=2,
        draw=_configurations,
        shape=(None,),
        samples=3,
        usual="for ordinary limits",
        edges=(
            Edge("for the limits of the exam", _exam),
            Edge("where an angle is exactly on a limit", _exactly_on_a_limit),
            Edge("several turns away", _several_turns),
            Edge("where 0 is outside the limits", _both_positive),
            Edge("where the limits are more than a turn apart", _more_than_a_turn),
            Edge("for one joint", _one_joint),
            Edge("for as many configurations as joints", _as_many_as_joints),
            Edge("for whole numbers", _whole_angles),
        ),
        residual=residuals.configuration_missed,
        hints=(
            Hint(
                "no_turns",
                "whole turns are not tried: -174.72 degrees and 185.28 degrees are one place of the joint",
            ),
            Hint("wrapped", "wrapping to half a turn is not enough: a limit may lie beyond half a turn"),
            Hint("turns_down_only", "turns go both ways: below the lower limit a turn has to be added"),
            Hint(
                "joints_together",
                "every joint may take its own number of turns; yours turns all joints alike",
            ),
            Hint("any_joint", "one joint inside is not enough: a configuration is inside if all joints are"),
            Hint("turns_up_only", "turns go both ways: above the upper limit a turn has to be taken off"),
        ),
    ),
    Exercise(
        "largest_speed(q, points, v_max)",
        points=3,
        draw=_motion,
        shape=(),
        unit="m/s",
        samples=3,
        usual="for an ordinary motion",
        edges=(
            Edge("for equal steps", _equal_steps),
            Edge("for a single step", lambda rng: _motion(rng, 2)),
            Edge("for one joint", lambda rng: _motion(rng, 5, 1)),
            Edge("where a joint hardly moves", _one_that_hardly_moves),
            Edge("where joint 1 sets the speed", _moves_most_but_may(0)),
            Edge("where the last joint sets the speed", _moves_most_but_may(2)),
            Edge("for whole numbers", _whole_motion),
        ),
        residual=residuals.speed_missed,
        hints=(
            Hint(
                "wrapped",
                "angles wrapped before their differences: one that passes half a turn seems to jump by 2 pi",
            ),
            Hint(
                "bound_of_the_fastest",
                "the joint that turns most need not be the worst: its bound may be large. Divide first, then"
                " look for the smallest",
            ),
            Hint("joints_added", "the joints have no common speed: each joint is held against its own bound"),
            Hint(
                "whole_length", "each step has its own length: `norm` without axis=1 makes one number of all"
            ),
            Hint("last_joint", "you look at the last joint alone: any joint may set the speed"),
            Hint("one_bound", "one bound for all joints: each joint has its own entry of v_max"),
            Hint(
                "mean",
                "a mean of the rates for their maximum: somewhere on the path a joint turns faster than that",
            ),
            Hint("one_step", "the steps of this path are not alike: divide each difference by its own step"),
            Hint("signed", "a joint that turns backwards counts, too: compare sizes"),
        ),
        laws=(
            ("with half the bounds the tool may go half as fast", _half_as_fast),
            ("a joint that begins a whole turn further on is no slower", _turned_once),
        ),
    ),
]
