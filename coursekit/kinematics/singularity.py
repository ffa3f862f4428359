"""Where an arm loses a motion: det J, the factors it splits into, their names, and what exactly is lost.

det J_b = det J_s (an adjoint has determinant 1), so it depends neither on the tool nor on the base. For
every 6R arm of the catalogue it is a product of three geometric quantities, each a sine and a cosine of few
angles:

    wrist      -w_4 . (w_5 x w_6)                 0 where the axes of the wrist lie in a plane   theta_5
    elbow      w_3 . ((q_4 - q_3) x (q_4 - q_2))  0 where upper arm and forearm lie in a line    theta_3
    shoulder   w_2 . (w_1 x (c - q_1))            how fast joint 1 carries c along axis 2        theta_2, 3, 4

q_i is a point on axis i, c the point where axes 5 and 6 meet. The signs of elbow and shoulder are both turned
where that makes shoulder positive in front of axis 1. Two things make it split. Axes 2 and 3 are parallel.
And axis 4 either passes through c (a spherical wrist: put the reference point there and one block of J
vanishes, det J = -det J_12 det J_21) or is parallel to axes 2 and 3 (the UR5: subtract the columns of
parallel joints, what remains are translations). Source of the decoupling: TPK4170 report 2021, section 5.2.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from . import checks
from .axes import SAME, directions_of, parallel, points_on, wrist
from .jacobians import left_singular
from .robot import Robot

NAMES = ("wrist", "elbow", "shoulder")


def determinant(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """det J_b, rows (omega; v), the same for J_s and for every tool. theta (..., 6) -> (...).

    In metres cubed. The order (v; omega) would change its sign. Raises ValueError where the arm has no square
    Jacobian.

    >>> from coursekit import robots
    >>> float(determinant(robots.kuka_kr6(), [0, 0, 0, 0, np.pi / 2, 0]).round(6))
    0.014332
    """
    theta = checks.joint_angles(theta, robot.n, robot.name)
    if robot.n != 6:
        raise ValueError(f"{robot.name} has {robot.n} joints: only a 6 x 6 Jacobian has a determinant")
    split = _split(robot)
    if isinstance(split, str):
        with np.errstate(invalid="ignore"):  # NaN in, NaN out, silently
            return np.linalg.det(robot.jacobian_space(theta))
    return math.prod(sinusoid.value(theta) for sinusoid in split.values())


def factors(robot: Robot, theta: ArrayLike) -> dict[str, np.ndarray]:
    """The three factors of det J_b. theta (..., 6) -> {"wrist": (...), "elbow": (...), "shoulder": (...)}.

    Their product is the determinant. wrist is a sine, elbow an area in m^2, shoulder a length in m; the signs
    follow the directions of the axes. Raises ValueError that names the condition which the arm does not meet.

    >>> from coursekit import robots
    >>> split = factors(robots.kuka_kr6(), [0, 0, 0, 0, 0.5, 0])
    >>> {name: round(float(value), 6) for name, value in split.items()}
    {'wrist': 0.479426, 'elbow': 0.015925, 'shoulder': 0.9}
    """
    theta = checks.joint_angles(theta, robot.n, robot.name)
    return {name: sinusoid.value(theta) for name, sinusoid in _split_or_error(robot).items()}


def relative_factors(robot: Robot, theta: ArrayLike) -> dict[str, np.ndarray]:
    """The factors, each over a bound on its size: free of scale, in -1 to 1. theta and shapes as factors.

    wrist and elbow become the sine of the angle to the singular pose; shoulder becomes the distance of c from
    the singular surface over the farthest it could be.

    >>> from coursekit import robots
    >>> elbow = relative_factors(robots.kuka_kr6(), [0, 0, 0.0831412, 0, 0.5, 0])["elbow"]
    >>> bool(abs(elbow) < 1e-6)
    True
    """
    theta = checks.joint_angles(theta, robot.n, robot.name)
    return {name: sinusoid.value(theta) / sinusoid.bound for name, sinusoid in _split_or_error(robot).items()}


def classify(robot: Robot, theta: ArrayLike, tol: float = 1e-6) -> tuple[str, ...]:
    """Names of the singularities at one configuration.

    A name is given where the size of its relative factor is at most tol. Raises ValueError as factors does.

    Parameters
    ----------
    robot : Robot
    theta : (6,), rad
    tol : about a millionth of a radian, or of the arm's reach

    Returns
    -------
    names : some of "wrist", "elbow", "shoulder"; an empty tuple means regular

    Examples
    --------
    >>> from coursekit import robots
    >>> classify(robots.kuka_kr10_report(), [0, 0, 0, 0, 0, 0])
    ('wrist', 'elbow')
    """
    theta = _one(robot, theta)
    return tuple(name for name, value in relative_factors(robot, theta).items() if abs(value) <= tol)


def aligned(robot: Robot, theta: ArrayLike, tol: float = 1e-6) -> np.ndarray:
    """Whether the first and the last axis are one line: "alignment", a special shoulder singularity.

    The two screws are then equal up to sign.

    Parameters
    ----------
    robot : Robot
    theta : (..., n), rad or m
    tol : bound on each component of their difference, rad and m

    Returns
    -------
    bool (...)

    Examples
    --------
    >>> from coursekit import robots
    >>> report = robots.kuka_kr10_report()
    >>> bool(aligned(report, [0, -np.pi / 6, -2.2829525304720546, 0, 1.2357549792754567, 0]))
    True
    """
    J = robot.jacobian_space(theta)
    first, last = J[..., 0], J[..., -1]
    apart = np.minimum(np.abs(first - last).max(axis=-1), np.abs(first + last).max(axis=-1))
    return apart <= tol


def sigma_min(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """Smallest singular value of J_b, metres and radians. theta (..., n) -> (...).

    0 at a singular pose. It mixes units: compare it along a path of one robot, not between robots.

    >>> from coursekit import robots
    >>> float(sigma_min(robots.kuka_kr6(), [0, 0, 0, 0, 0, 0]).round(12))
    0.0
    """
    return left_singular(robot.jacobian_body(theta))[1][..., -1]


def rank(robot: Robot, theta: ArrayLike, tol: float = 1e-9) -> np.ndarray:
    """How many independent motions there are: singular values of J_b above a bound.

    Parameters
    ----------
    robot : Robot
    theta : (..., n), rad or m
    tol : the bound, metres and radians

    Returns
    -------
    int (...)

    Examples
    --------
    >>> from coursekit import robots
    >>> int(rank(robots.kuka_kr10_report(), [0, 0, 0, 0, 0, 0]))
    4
    """
    return (left_singular(robot.jacobian_body(theta))[1] > tol).sum(axis=-1)


def lost_motion(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """The twist that joint rates give least, at a singular pose not at all. theta (..., n) -> (..., 6).

    (omega; v) in the space frame, of length 1, its largest component positive: the left singular vector of
    J_s that belongs to the smallest singular value. Raises ValueError for fewer than six joints: such an
    arm lacks several motions everywhere, see lost_motions.

    >>> from coursekit import robots
    >>> kr10 = robots.kuka_kr10_report()                                # stretched along x
    >>> lost = lost_motion(kr10, [0, 0, 0, 0, -np.pi / 12, 0])
    >>> bool(np.allclose(kr10.jacobian_space([0, 0, 0, 0, -np.pi / 12, 0]).T @ lost, 0))
    True
    """
    if robot.n < 6:
        raise ValueError(
            f"{robot.name} has {robot.n} joints and lacks several motions everywhere: use lost_motions"
        )
    return left_singular(robot.jacobian_space(theta))[0][..., :, -1]


def weakest_motion(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """Of the motions that an arm has, the twist that joint rates give least. theta (..., n) -> (..., 6).

    As lost_motion for six joints and more. An arm with n < 6 joints has n motions; the others it lacks
    everywhere.

    >>> from coursekit import robots
    >>> weakest_motion(robots.planar_2r(), [0, 0]).round(3).tolist()        # stretched: no motion along x
    [0.0, 0.0, 0.257, 0.0, 0.966, 0.0]
    """
    U = left_singular(robot.jacobian_space(theta))[0]
    return U[..., :, min(robot.n, 6) - 1]


def lost_motions(robot: Robot, theta: ArrayLike, tol: float = 1e-9) -> np.ndarray:
    """Every direction that is lost at one configuration.

    Parameters
    ----------
    robot : Robot
    theta : (n,), rad or m
    tol : as in `rank`

    Returns
    -------
    V : (6 - rank, 6), rows as in `lost_motion`

    Examples
    --------
    >>> from coursekit import robots
    >>> lost_motions(robots.kuka_kr10_report(), [0, 0, 0, 0, 0, 0]).shape
    (2, 6)
    """
    theta = _one(robot, theta)
    U = left_singular(robot.jacobian_space(theta))[0]
    return U[:, rank(robot, theta, tol) :].T


@dataclass(frozen=True, eq=False)
class Wrench:
    """A wrench as a screw: a force along a line through `point`, with `pitch` (m) times itself as a moment.

    point (..., 3) is the point of the line nearest the origin; direction (..., 3) has length 1.
    """

    point: np.ndarray
    direction: np.ndarray
    pitch: np.ndarray


def lost_wrench(robot: Robot, theta: ArrayLike) -> Wrench:
    """The load that no joint feels at a singular pose. theta (..., n) -> Wrench in the space frame.

    A twist V is lost when J_s^T V = 0. Read as a wrench (moment; force), the same six numbers press on no
    joint. For an arm with a spherical wrist, at an elbow or shoulder singularity, the pitch is 0: a pure
    force on a line that meets all six axes (or is parallel to them). At a wrist singularity it has a pitch,
    and no such line exists, unless theta_4 happens to allow one. A pure moment has an infinite pitch and no
    point (NaN).

    >>> from coursekit import robots
    >>> wrench = lost_wrench(robots.kuka_kr10_report(), [0, 0, 0, 0, -np.pi / 12, 0])
    >>> np.abs(wrench.direction).round(9).tolist(), float(abs(wrench.pitch).round(9))
    ([1.0, 0.0, 0.0], 0.0)
    """
    return wrench_of(lost_motion(robot, theta))


def wrench_of(twist: ArrayLike) -> Wrench:
    """A twist (..., 6) = (omega; v) read as a wrench: omega is the moment about the origin, v the force.

    >>> wrench_of([0, 0, 0.5, 1, 0, 0]).point.tolist()
    [0.0, -0.5, 0.0]
    """
    twist = checks.array(twist, (6,), "twist")
    moment, force = twist[..., :3], twist[..., 3:]
    size = np.sqrt((force * force).sum(axis=-1))
    size = np.where(size < SAME, np.nan, size)[..., None]
    direction = np.where(np.isnan(size), moment, force / size)
    pitch = np.where(np.isnan(size), np.inf, (force * moment / size**2).sum(axis=-1, keepdims=True))[..., 0]
    return Wrench(np.cross(force, moment) / size**2, direction, pitch)


# -- how det J splits ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Sinusoid:
    """constant + sum of n . R(angle) d, each angle a sum of joint angles: the form of every factor.

    R turns about a unit axis u perpendicular to n, so n . R(angle) d = cos(angle) n . d + sin(angle) n . (u
    x d).
    """

    constant: float
    terms: tuple  # of (weights (6,), cosine coefficient, sine coefficient); angle = weights . theta

    @classmethod
    def of(cls, n, u, *turned, constant=0.0):
        """turned: pairs (weights, d), the vector d and how the joint angles add up to its angle."""
        return cls(constant, tuple((weights, n @ d, n @ np.cross(u, d)) for weights, d in turned))

    def value(self, theta):
        angles = [theta @ weights for weights, _, _ in self.terms]
        waves = [a * np.cos(t) + b * np.sin(t) for t, (_, a, b) in zip(angles, self.terms, strict=True)]
        return self.constant + sum(waves)

    @property
    def bound(self):
        """No value is larger than this."""
        return abs(self.constant) + sum(np.hypot(a, b) for _, a, b in self.terms)

    @property
    def sign(self):
        """The sign of the first coefficient that is not zero."""
        coefficients = [self.constant, *(c for term in self.terms for c in term[1:])]
        return next((np.sign(c) for c in coefficients if abs(c) > SAME), 1.0)


@lru_cache(maxsize=64)
def _split(robot):
    """{"wrist", "elbow", "shoulder": _Sinusoid}, or in words why det J does not split like that."""
    if robot.n != 6:
        return f"the arm has {robot.n} joints, not 6"
    if robot.links.sliding:
        return "its joints are not all hinges"
    w, q = directions_of(robot.S), points_on(robot.S)
    if not parallel(w[1], w[2]):
        return "axes 2 and 3 are not parallel"
    try:
        family, c = wrist(q, w)
    except ValueError as reason:
        return str(reason)
    q_4 = c if family == "spherical" else q[3]

    upper_arm, forearm, hand = q[2] - q[1], q_4 - q[2], c - q_4
    e = np.eye(6)
    theta_2 = e[1]  # joints 3 and 4 may turn the other way round than joint 2
    theta_23 = theta_2 + e[2] * np.round(w[1] @ w[2])
    theta_234 = theta_23 + e[3] * np.round(w[1] @ w[3])
    turned = (theta_2, upper_arm), (theta_23, forearm), (theta_234, hand)

    n = np.cross(w[1], w[0])
    side = _Sinusoid.of(n, w[1], *turned, constant=n @ (q[1] - q[0])).sign
    return {
        "wrist": _Sinusoid.of(-np.cross(w[3], w[4]), w[4], (e[4], w[5])),
        "elbow": _Sinusoid.of(side * np.cross(w[2], upper_arm), w[2], (e[2], forearm)),
        "shoulder": _Sinusoid.of(side * n, w[1], *turned, constant=side * n @ (q[1] - q[0])),
    }


def _split_or_error(robot):
    split = _split(robot)
    if isinstance(split, str):
        raise ValueError(f"det J of {robot.name} has no factors wrist, elbow, shoulder: {split}")
    return split


def _one(robot, theta):
    """theta as one configuration (n,), or a ValueError."""
    theta = checks.joint_angles(theta, robot.n, robot.name)
    if theta.ndim != 1:
        raise ValueError(
            f"{robot.name}: theta must be one configuration ({robot.n},) here, got {theta.shape}"
        )
    return theta
