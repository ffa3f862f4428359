"""The Jacobian by the methods the course compares, and what one reads from it: ellipsoids, manipulability.

Three roads to the same matrix, rows (omega; v): angular velocity and velocity of the tool point, along the
base axes. All equal `robot.jacobian_geometric`. Sources: Innopolis assignment 3 (2020), sections 2 and 3;
Siciliano et al. (2010), section 3.1; for the ellipsoids the Panda programming assignment and Lynch & Park,
section 5.4.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import checks, lie
from .robot import Robot

PARTS = {"angular": slice(0, 3), "linear": slice(3, 6)}
ROUNDING = 8 * np.finfo(float).eps  # a singular value below this times the largest is rounding: it is 0

__all__ = [
    "Ellipsoid",
    "by_differences",
    "by_matrix_derivative",
    "column",
    "ellipsoid",
    "manipulability",
    "of_hinges",
    "planar",
    "skew_theory",
    "transform_rate",
]


def column(kind: str, w: ArrayLike, q: ArrayLike, T: ArrayLike) -> np.ndarray:
    """One column of J_b: the tool's twist, seen from it, while one joint alone moves at 1 rad/s or 1 m/s.

    Lynch & Park, section 5.1.

    Parameters
    ----------
    kind : "revolute" or "prismatic"
    w : (3,), the joint's axis where it is now, of length 1, space frame
    q : (3,), a point on it, metres; a slide needs none
    T : (4, 4), the tool in the space frame

    Returns
    -------
    V_b : (6,), rows (omega; v)

    Examples
    --------
    >>> column("revolute", [0, 0, 1], [0, 0, 0], np.eye(4) + np.eye(4, k=3)).tolist()
    [0.0, 0.0, 1.0, 0.0, 1.0, 0.0]
    """
    if kind not in ("revolute", "prismatic"):
        raise ValueError(f"kind must be 'revolute' or 'prismatic', got {kind!r}")
    w, q, T = checks.array(w, (3,), "w"), checks.array(q, (3,), "q"), checks.pose(T, "T")
    omega, v = (w, np.cross(w, T[:3, 3] - q)) if kind == "revolute" else (np.zeros(3), w)
    return np.concatenate([omega @ T[:3, :3], v @ T[:3, :3]])


def skew_theory(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """Column i is (w_i; w_i x (p_n - o_i)): the axis, and the lever from a point of it to the tool.

    theta (..., n) rad or m -> J (..., 6, n), rows (omega; v) along the base axes. Where joint i slides, w_i
    = 0 and v is the direction of the slide. Innopolis assignment 3 (2020), section 2.

    >>> from coursekit import robots
    >>> skew_theory(robots.planar_2r(1, 1), [0, 0])[[2, 3, 4]].round(12).tolist()
    [[1.0, 1.0], [0.0, 0.0], [2.0, 1.0]]
    """
    before = _transforms_before(robot, theta)
    w, v = robot.S[:3].T, robot.S[3:].T
    point = np.cross(w, v)  # of the axis, at theta = 0; the zero vector for a slide
    along = v + np.cross(w, point)  # what the joint slides along its axis: 0 for a hinge
    R, p = before[..., :3, :3], before[..., :3, 3]
    w_i, along_i = _apply(R, w), _apply(R, along)
    o_i = _apply(R, point) + p
    J = of_hinges(w_i, o_i, robot.fk(theta)[..., :3, 3])
    J[..., 3:, :] += np.swapaxes(along_i, -1, -2)
    return J


def of_hinges(axes: ArrayLike, origins: ArrayLike, tool: ArrayLike) -> np.ndarray:
    """Column i is (w_i; w_i x (p - o_i)): a hinge about the direction w_i through the point o_i moves p.

    Parameters
    ----------
    axes : (..., n, 3), unit vectors along the base
    origins : (..., n, 3), metres, along the base
    tool : (..., 3), the point p, metres; any that all n joints carry, such as the weight of a link

    Returns
    -------
    J : (..., 6, n), rows (omega; v)

    Examples
    --------
    >>> of_hinges([[0, 0, 1], [0, 0, 1]], [[0, 0, 0], [0.5, 0, 0]], [0.75, 0, 0])[4].tolist()
    [0.75, 0.25]
    """
    axes, origins = checks.array(axes, (3,), "axes"), checks.array(origins, (3,), "origins")
    lever = checks.array(tool, (3,), "tool")[..., None, :] - origins
    v = np.cross(axes, lever)
    return np.swapaxes(np.concatenate([np.broadcast_to(axes, v.shape), v], axis=-1), -1, -2)


def by_matrix_derivative(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """Differentiate T = H_1 ... H_n M by one joint at a time, and read velocities off the matrix.

    dT/dtheta_i = T_left Hdot_i T_right. Behind it T_o takes the rotation of T back, so that
    dT/dtheta_i T_o = [[ [w], v ], [0, 0]]: w stands in the entries (3,2), (1,3), (2,1), v in the last column.
    theta (..., n) -> J (..., 6, n), rows (omega; v). Innopolis assignment 3 (2020), section 3.

    >>> from coursekit import robots
    >>> by_matrix_derivative(robots.planar_2r(1, 1), [0, 0])[[2, 3, 4]].round(12).tolist()
    [[1.0, 1.0], [0.0, 0.0], [2.0, 1.0]]
    """
    theta = checks.joint_angles(theta, robot.n, robot.name)
    T_left = _transforms_before(robot, theta)
    before_and_own = T_left @ lie.exp6(robot.S.T * theta[..., None])
    T_right = lie.inverse(before_and_own) @ robot.fk(theta)[..., None, :, :]
    return np.swapaxes(transform_rate(T_left, robot.S.T, theta, T_right)[1], -1, -2)


def transform_rate(
    T_left: ArrayLike, S: ArrayLike, theta: ArrayLike, T_right: ArrayLike
) -> tuple[np.ndarray, np.ndarray]:
    """Differentiate T = T_left H T_right, H = e^[S]theta, by theta.

    Only H depends on theta, and H_dot = [S] H. Behind T_dot, T_o takes the rotation of T back: then [omega]
    stands above left and v of the tool point in the last column, both along the base axes.
    Innopolis assignment 3 (2020), section 3.

    Parameters
    ----------
    T_left, T_right : (..., 4, 4)
    S : (..., 6), screw of the joint in the frame that T_left leads to
    theta : (...), rad or m

    Returns
    -------
    T_dot : (..., 4, 4)
    column : (..., 6), rows (omega; v)

    Examples
    --------
    >>> tool = lie.exp6([0, 0, 0, 0.5, 0, 0])
    >>> transform_rate(np.eye(4), [0, 0, 1, 0, 0, 0], 0.0, tool)[1].tolist()
    [0.0, 0.0, 1.0, 0.0, 0.5, 0.0]
    """
    S, theta = checks.array(S, (6,), "S"), checks.array(theta, (), "theta")
    T_left, T_right = checks.pose(T_left, "T_left"), checks.pose(T_right, "T_right")
    H = lie.exp6(S * theta[..., None])
    T_dot = T_left @ lie.hat6(S) @ H @ T_right
    R = (T_left @ H @ T_right)[..., :3, :3]
    w = lie.vee3(T_dot[..., :3, :3] @ np.swapaxes(R, -1, -2))
    return T_dot, np.concatenate([w, T_dot[..., :3, 3]], axis=-1)


def by_differences(robot: Robot, theta: ArrayLike, step: float = 1e-5) -> np.ndarray:
    """Move each joint a step forwards and a step back, and divide by what lies between.

    Good to 1e-10 with the default step. The difference of two rotations is the rotation vector between them,
    log(R_+ R_-^T). Raises ValueError for a step that is not positive.

    Parameters
    ----------
    robot : Robot
    theta : (..., n), rad or m
    step : rad or m

    Returns
    -------
    J : (..., 6, n), rows (omega; v)

    Examples
    --------
    >>> from coursekit import robots
    >>> by_differences(robots.planar_2r(1, 1), [0, 0])[[2, 3, 4]].round(6).tolist()
    [[1.0, 1.0], [0.0, 0.0], [2.0, 1.0]]
    """
    if not step > 0:
        raise ValueError(f"step must be a positive number (rad or m), got {step}")
    theta = checks.joint_angles(theta, robot.n, robot.name)[..., None, :]
    moves = step * np.eye(robot.n)
    T_plus, T_minus = robot.fk(theta + moves), robot.fk(theta - moves)  # (..., n, 4, 4), one joint moved
    R_plus, R_minus = T_plus[..., :3, :3], T_minus[..., :3, :3]
    w = lie.log3(R_plus @ np.swapaxes(R_minus, -1, -2))
    v = T_plus[..., :3, 3] - T_minus[..., :3, 3]
    return np.swapaxes(np.concatenate([w, v], axis=-1), -1, -2) / (2 * step)


def planar(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """Velocity of the tool point of a planar arm. theta (..., n) -> (..., 2, n), rows (x, y) of the base.

    Raises ValueError where a joint leaves the x-y plane. Robotics I exam, 17 June 2019, exercise 2.

    >>> from coursekit import robots
    >>> planar(robots.planar_2r(), [np.pi / 4, -np.pi / 2]).round(4).tolist()
    [[-0.1768, 0.1768], [0.5303, 0.1768]]
    """
    out_of_plane = np.any(np.abs(robot.S[[0, 1, 5]]) > 1e-12, axis=0)
    if np.any(out_of_plane):
        joint = np.argmax(out_of_plane) + 1
        raise ValueError(f"{robot.name} is not a planar arm: joint {joint} moves out of the x-y plane")
    return robot.jacobian_geometric(theta)[..., 3:5, :]


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """What unit joint rates reach: half axes `lengths` (..., 3), longest first, along the columns of `axes`.

    lengths are the square roots of the eigenvalues of A A^T, 0 where a direction is lost; axes (..., 3, 3)
    is a rotation, so column 3 completes the other two. Units: rad/s ("angular") or m/s ("linear") per unit
    rate.
    """

    axes: np.ndarray
    lengths: np.ndarray

    @property
    def product(self) -> np.ndarray:
        """sqrt(lambda_1 lambda_2 lambda_3), the product of the half axes: what the sources call volume V."""
        return np.prod(self.lengths, axis=-1)

    @property
    def volume(self) -> np.ndarray:
        """The volume of the ellipsoid, 4/3 pi times the product of its half axes."""
        return 4 / 3 * np.pi * self.product

    @property
    def isotropy(self) -> np.ndarray:
        """mu_1 = sqrt(lambda_max / lambda_min): 1 for a sphere, infinite where a direction is lost."""
        longest, shortest = self.lengths[..., 0], self.lengths[..., -1]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(shortest == 0, np.inf, longest / shortest)

    @property
    def condition(self) -> np.ndarray:
        """mu_2 = lambda_max / lambda_min, the square of the isotropy."""
        return self.isotropy**2


def ellipsoid(J: ArrayLike, part: str = "angular") -> Ellipsoid:
    """The velocity ellipsoid of the angular or the linear rows of a Jacobian. J (..., 6, n) -> Ellipsoid.

    By singular values of the rows A, never by eigenvalues of A A^T: squaring would lose half of the digits,
    and a flat ellipsoid its exact zero. Raises ValueError for another part. NaN in, NaN out.

    >>> from coursekit import robots
    >>> flat = ellipsoid(robots.franka_panda().jacobian_body([0, 0, 0, 0, 0, 0, 0]), "angular")
    >>> (flat.lengths**2).round(12).tolist(), float(flat.volume), float(flat.isotropy)
    ([4.0, 3.0, 0.0], 0.0, inf)
    """
    if part not in PARTS:
        raise ValueError(f"part must be 'angular' or 'linear', got {part!r}")
    A = _jacobian(J)[..., PARTS[part], :]
    axes, found = left_singular(A)
    lengths = np.zeros((*found.shape[:-1], 3))
    lengths[..., : found.shape[-1]] = np.where(found < ROUNDING * found[..., :1], 0.0, found)
    axes[..., 2] = np.cross(axes[..., 0], axes[..., 1])
    return Ellipsoid(axes, lengths)


def manipulability(J: ArrayLike) -> np.ndarray:
    """Product of the singular values: sqrt(det(J J^T)) for n >= rows (Yoshikawa), |det J| for a square J.

    J (..., rows, n) -> (...). With fewer joints than rows it is sqrt(det(J^T J)).

    >>> from coursekit import robots
    >>> round(float(manipulability(planar(robots.planar_2r(), [0, np.pi / 2]))), 6)
    0.125
    """
    J = checks.array(J, (), "J")
    if J.ndim < 2:
        raise ValueError(f"J must have shape (..., rows, n), got {J.shape}")
    if J.shape[-1] == J.shape[-2]:
        with np.errstate(invalid="ignore"):  # NaN in, NaN out, silently
            return np.abs(np.linalg.det(J))
    return np.prod(left_singular(J)[1], axis=-1)


def left_singular(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Left singular vectors (..., m, m), as columns, and singular values (..., min(m, n)), largest first.

    A (..., m, n). The sign of each vector is fixed: its largest component is positive. NaN in, NaN out.
    """
    missing = np.isnan(A).any(axis=(-2, -1))
    U, sigma, _ = np.linalg.svd(np.where(missing[..., None, None], 0.0, A))
    largest = np.take_along_axis(U, np.abs(U).round(9).argmax(axis=-2, keepdims=True), axis=-2)
    U = U * np.where(largest < 0, -1.0, 1.0)
    U[missing], sigma[missing] = np.nan, np.nan
    return U, sigma


def _jacobian(J):
    """J as a float array (..., 6, n), or a ValueError."""
    J = checks.array(J, (), "J")
    if J.ndim < 2 or J.shape[-2] != 6:
        raise ValueError(f"J must have shape (..., 6, n), rows (omega; v), got {J.shape}")
    return J


def _transforms_before(robot, theta):
    """e^[S_1]theta_1 ... e^[S_{i-1}]theta_{i-1} for every joint i. (..., n, 4, 4)."""
    D = robot.displacements(theta)
    first = np.broadcast_to(np.eye(4), (*D.shape[:-3], 1, 4, 4))
    return np.concatenate([first, D[..., :-1, :, :]], axis=-3)


def _apply(R, x):
    """R_i x_i for every joint. R (..., n, 3, 3), x (n, 3) -> (..., n, 3)."""
    return (R @ x[..., None])[..., 0]
