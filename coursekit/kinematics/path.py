"""Paths for the tool: points on a curve, frames along it, the arm that follows it, and how fast it may.

The example is a letter S on a sphere of radius 0.5 m about (0, 0, 0.5), drawn with the tool upright on the
sphere (RPI mini project 3, 2021, problem 3). Points are (m, 3), poses (m, 4, 4), joint paths (..., m, n).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from . import checks
from .robot import Robot
from .spline import not_a_knot

SPHERE_RADIUS = 0.5  # m
SPHERE_CENTER = (0.0, 0.0, 0.5)  # m
ARC_RADIUS = 0.25  # of the two arcs of the S, in the letter plane
ARC_END = np.radians(-150)  # where the lower arc begins; it ends at +90 deg, in the middle of the letter
ARC_SAMPLES = 401  # per arc, before resampling
JUMP = np.pi / 2  # rad between neighbouring points: more is another branch, not a motion


# -- curves ------------------------------------------------------------------------------------------------


def s_curve(n: int = 101) -> np.ndarray:
    """The letter S on the sphere: n points at equal arc length. -> (n, 3), metres.

    The flat letter (`letter_s`), laid on the sphere.

    >>> s_curve(5).round(3).tolist()[2]      # the middle of the letter touches the plane x = 0.5
    [0.5, 0.0, 0.5]
    """
    return resample(on_sphere(letter_s()), n)


def letter_s() -> np.ndarray:
    """The letter S in the letter plane, finely sampled. -> (m, 2), metres, half a metre up and down.

    An arc of radius 0.25 about (0, -0.25) from -150 to 90 degrees, and the same arc turned by half a turn
    about the origin, where the two meet with one tangent.

    >>> letter_s()[400].round(12).tolist()
    [0.0, 0.0]
    """
    angle = np.linspace(ARC_END, np.pi / 2, ARC_SAMPLES)
    lower = ARC_RADIUS * np.stack([np.cos(angle), np.sin(angle) - 1], axis=-1)
    upper = -lower[-2::-1]  # on from the origin, which is not repeated
    return np.concatenate([lower, upper])


def on_sphere(letter: ArrayLike) -> np.ndarray:
    """Lays the letter plane on the sphere. letter (..., 2) = (Y, Z) -> (..., 3), metres.

    The inverse stereographic projection from the pole (-0.5, 0, 0.5): t = 1 / (1 + Y^2 + Z^2),
    p = (t - 0.5, t Y, t Z + 0.5).

    >>> on_sphere([[0, 0], [1, 0]]).tolist()
    [[0.5, 0.0, 0.5], [0.0, 0.5, 0.5]]
    """
    Y, Z = np.moveaxis(checks.array(letter, (2,), "letter"), -1, 0)
    t = 1 / (1 + Y * Y + Z * Z)
    return np.stack([t - SPHERE_RADIUS, t * Y, t * Z + SPHERE_RADIUS], axis=-1)


def load_points(source: str | Path) -> np.ndarray:
    """A curve of your own, from a file or from text. -> (m, 3) points, or (m, 2) in the letter plane.

    source: the name of a CSV file, or the text itself (anything with more than one line). Columns x, y, z in
    metres, or Y, Z of the letter plane (then use `on_sphere`), separated by commas, semicolons or blanks.
    Names of columns at the top, empty lines and lines that begin with # are skipped.
    Raises ValueError that names the line which cannot be read.

    >>> load_points("x, y, z\\n0.5, 0, 0.5\\n0.4, 0.1, 0.5").tolist()
    [[0.5, 0.0, 0.5], [0.4, 0.1, 0.5]]
    """
    is_text = isinstance(source, str) and "\n" in source
    text = str(source) if is_text else Path(source).read_text(encoding="utf-8-sig")
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.replace(",", " ").replace(";", " ").split()
        if not words or words[0].startswith("#"):
            continue
        if not rows and all(word[0].isalpha() for word in words):  # the names of the columns
            continue
        rows.append(
            _row(words, len(rows[0]) if rows else None, f"line {number} of the curve ({line.strip()!r})")
        )
    if len(rows) < 2:
        raise ValueError(f"a curve needs at least 2 points, got {len(rows)}")
    return np.array(rows)


def _row(words, width, line):
    """The numbers of one line of a curve: `width` of them, or 2 or 3 in the first line."""
    try:
        row = [float(word) for word in words]
    except ValueError:
        raise ValueError(f"{line} must hold numbers only") from None
    if not np.isfinite(row).all():
        raise ValueError(f"{line} must hold finite numbers")
    if len(row) not in ((2, 3) if width is None else (width,)):
        expected = "2 or 3 numbers" if width is None else f"{width} numbers, as the lines above"
        raise ValueError(f"{line} must hold {expected}, got {len(row)}")
    return row


def resample(points: ArrayLike, n: int) -> np.ndarray:
    """n points at equal arc length on a smooth curve through the given ones. points (m, d) -> (n, d).

    A cubic spline (not-a-knot) through the points, over the summed distances between them: the denser the
    given points, the nearer that sum is to the arc length. The first and the last point stay.
    Raises ValueError where neighbouring points coincide.

    >>> resample([[0, 0, 0], [1, 0, 0], [4, 0, 0]], 5).round(12)[:, 0].tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0]
    """
    if n < 2:
        raise ValueError(f"n must be at least 2 points, got {n}")
    points = _points(points)
    length = np.append(0.0, np.cumsum(steps(points)))
    return not_a_knot(length, points, np.linspace(0.0, length[-1], n))


def steps(points: ArrayLike) -> np.ndarray:
    """Distances between neighbouring points, all alike on a resampled curve. (m, d) -> (m - 1,), metres.

    Raises ValueError where neighbouring points coincide: a path has no direction there.

    >>> steps([[0, 0, 0], [0, 0, 2], [0, 3, 2]]).tolist()
    [2.0, 3.0]
    """
    length = np.linalg.norm(np.diff(_points(points), axis=0), axis=-1)
    if np.any(length == 0):
        where = int(np.argmin(length))
        raise ValueError(f"points {where} and {where + 1} coincide: a path needs neighbours that differ")
    return length


def frames(points: ArrayLike, center: ArrayLike = SPHERE_CENTER) -> np.ndarray:
    """Tool poses along a curve on a sphere. points (m, 3), center (3,), metres -> (m, 4, 4).

    x is the outward normal, y the direction of motion made perpendicular to x (from each point to the next;
    the last point keeps the y before it), z = x cross y. Raises ValueError where a point is the centre or
    where the curve runs along the normal.

    >>> T = frames([[0.5, 0, 0.5], [0.4, 0.3, 0.5], [0.3, 0.4, 0.5]])
    >>> T[0, :3, 0].tolist(), T[0, :3, 1].tolist()
    ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    """
    points, center = checks.array(_points(points), (3,), "points"), checks.array(center, (3,), "center")
    x = _unit(points - center, "lies at the centre: there is no normal")
    forward = np.diff(points, axis=0)
    y = forward - np.sum(forward * x[:-1], axis=-1, keepdims=True) * x[:-1]
    y = _unit(y, "and the next one lie on one normal: the curve has no direction along the sphere")
    y_last = y[-1:] - (y[-1] @ x[-1]) * x[-1]
    y = np.concatenate([y, y_last / np.linalg.norm(y_last)])
    T = np.zeros((len(points), 4, 4))
    T[:, :3, 0], T[:, :3, 1], T[:, :3, 2], T[:, :3, 3] = x, y, np.cross(x, y), points
    T[:, 3, 3] = 1
    return T


# -- the arm on the path -----------------------------------------------------------------------------------


def follow(robot: Robot, T: ArrayLike) -> np.ndarray:
    """Every way the arm can follow the poses T, as continuous joint paths. T (m, 4, 4) -> (k, m, n), rad.

    The k solutions of `ik.analytic` at neighbouring poses are paired by nearness, angles compared modulo
    whole turns, and then unwrapped: no joint jumps by 2 pi where its angle passes pi. Branch j begins with
    solution j of the first pose. Where a branch cannot go on (out of reach, or the nearest solution is more
    than a quarter turn away in some joint) it is NaN from there to the end: `points_reached` counts.

    Raises ValueError for a robot that `ik.analytic` does not cover.

    >>> from coursekit import robots
    >>> q = follow(robots.abb_irb1200(), frames(s_curve(21)))
    >>> q.shape, bool(np.abs(np.diff(q, axis=1)).max() < 1)
    ((8, 21, 6), True)
    """
    from . import ik

    T = checks.pose(T, f"{robot.name}: the path T")
    if T.ndim != 3 or len(T) == 0:
        raise ValueError(f"{robot.name}: the path T must be (m, 4, 4), one pose per point, got {T.shape}")
    theta = ik.analytic(robot, T).theta  # (m, k, n)
    turns = np.array([kind == "revolute" for kind in robot.joint_types])
    difference = theta[1:, None] - theta[:-1, :, None]  # (m - 1, k from, k to, n)
    difference = np.where(turns, _wrap(difference), difference)
    partner = _pair(np.abs(difference))

    q = np.full_like(theta, np.nan)
    q[0] = theta[0]
    branch = np.arange(theta.shape[1])  # which solution of pose i each branch is at; -1 where it ended
    for i, to in enumerate(partner):
        branch = np.where(branch < 0, -1, to[branch])
        q[i + 1, branch >= 0] = theta[i + 1, branch[branch >= 0]]
    q[..., turns] = np.unwrap(q[..., turns], axis=0)
    return np.swapaxes(q, 0, 1)


def next_on_branch(last: ArrayLike, solutions: ArrayLike) -> np.ndarray:
    """Where a branch goes on: last (n,), solutions (k, n) of the next pose, rad -> (n,), rad; hinges only.

    The solution nearest to last, angles compared modulo whole turns, with the turns that continue last. Rows
    of NaN do not exist; ValueError where no row does.

    >>> next_on_branch([3.1], [[1.6], [-3.1]]).round(2).tolist()
    [3.18]
    """
    last = checks.array(last, (), "last")
    solutions = np.atleast_2d(checks.array(solutions, last.shape, "solutions"))
    way = _wrap(solutions - last)
    far = np.linalg.norm(way, axis=-1)
    if np.isnan(far).all():
        raise ValueError(f"solutions must be (k, n) with a row that exists, got {len(far)} without one")
    return last + way[np.nanargmin(far)]


def trace(robot: Robot, T: ArrayLike, theta0: ArrayLike, rows: str = "all") -> np.ndarray:
    """Follows poses by numeric inverse kinematics, from pose to pose, for any arm.

    Each pose is solved from the solution before, so the path is continuous. A redundant arm that comes back
    to a pose need not come back to the configuration.

    Parameters
    ----------
    robot : Robot
    T : (m, 4, 4), the poses
    theta0 : (..., n), rad or m, where each path starts, near a solution of the first pose
        for all that are found: `ik.search(robot, T[0]).theta`
    rows : "all", or "linear": only the positions count

    Returns
    -------
    q : (..., m, n), NaN from where a pose is not reached or a joint turns by more than a quarter

    Examples
    --------
    >>> from coursekit import robots
    >>> panda = robots.franka_panda()
    >>> trace(panda, [panda.M, panda.M], np.full((3, 7), 0.1)).shape
    (3, 2, 7)
    """
    from . import ik

    T = checks.pose(T, f"{robot.name}: the path T")
    theta = checks.joint_angles(theta0, robot.n, robot.name)
    q = np.full((*theta.shape[:-1], len(T), robot.n), np.nan)
    for i, pose in enumerate(T):
        found = ik.damped_least_squares(robot, pose, theta, rows=rows)
        good = found.converged & ((i == 0) | (np.abs(found.theta - theta) < JUMP).all(axis=-1))
        theta = q[..., i, :] = np.where(good[..., None], found.theta, np.nan)
    return q


def points_reached(q: ArrayLike) -> np.ndarray:
    """How many points of the path each branch reaches before it breaks. q (..., m, n) -> whole numbers (...).

    >>> points_reached([[[0.0], [1.0]], [[0.0], [np.nan]]]).tolist()
    [2, 1]
    """
    present = ~np.isnan(np.asarray(q, dtype=float)).any(axis=-1)
    return np.logical_and.accumulate(present, axis=-1).sum(axis=-1)


def joint_rates(q: ArrayLike, points: ArrayLike, speed: float) -> np.ndarray:
    """Joint rates when the tool runs along the points at constant speed.

    Between two points the joints turn by dq in the time that the tool takes: rate = dq / (step / speed).

    Parameters
    ----------
    q : (..., m, n), rad or m, a continuous joint path
    points : (m, d), metres
    speed : m/s

    Returns
    -------
    rates : (..., m - 1, n), rad/s or m/s

    Examples
    --------
    >>> joint_rates([[0.0], [0.2]], [[0, 0, 0], [0, 0, 0.1]], speed=0.5).round(12).tolist()
    [[1.0]]
    """
    q, step = np.asarray(q, dtype=float), steps(points)
    if q.ndim < 2 or q.shape[-2] != len(step) + 1:
        raise ValueError(f"q must be (..., m, n) with m = {len(step) + 1}, one row per point, got {q.shape}")
    return np.diff(q, axis=-2) * (speed / step)[:, None]


@dataclass(frozen=True, eq=False)
class SpeedLimit:
    """The largest constant speed of the tool along a path, and what forbids more.

    speed   (...) m/s; NaN for a branch that breaks, infinite where no joint moves
    joint   (...) the limiting joint as an index into q[..., joint]: 0 is the first (-1 where there is none)
    index   (...) the limiting place: the step from point `index` to the next (-1 where there is none)
    """

    speed: np.ndarray
    joint: np.ndarray
    index: np.ndarray


def speed_limit(q: ArrayLike, points: ArrayLike, v_max: ArrayLike) -> SpeedLimit:
    """How fast the tool may go along the points at constant speed.

    At 1 m/s the joints turn at the rates dq/ds; the speed that brings the worst |dq/ds| / v_max to 1 is the
    limit. NaN in q or v_max gives NaN. Raises ValueError for a bound that is not positive.

    Parameters
    ----------
    q : (..., m, n), rad or m, a continuous joint path
        `follow` unwraps it: an angle that jumps by 2 pi would look like a very fast joint
    points : (m, d), metres
    v_max : () or (n,), rad/s or m/s, one bound for every joint or one for each

    Returns
    -------
    SpeedLimit

    Examples
    --------
    >>> limit = speed_limit([[0.0, 0.0], [0.1, -0.4]], [[0, 0, 0], [0, 0, 0.1]], v_max=2)
    >>> float(limit.speed), int(limit.joint), int(limit.index)
    (0.5, 1, 0)
    """
    per_metre = np.abs(joint_rates(q, points, speed=1.0))
    v_max = np.asarray(v_max, dtype=float)
    if v_max.shape not in ((), per_metre.shape[-1:]):
        raise ValueError(
            f"v_max must be one bound or {per_metre.shape[-1]}, one per joint; got {v_max.shape}"
        )
    if np.any(v_max <= 0):
        raise ValueError(f"v_max must be positive, got {v_max.tolist()}")
    use = per_metre / v_max  # seconds per metre: what share of its bound each joint uses at 1 m/s
    n = use.shape[-1]
    use = use.reshape(*use.shape[:-2], -1)
    worst, place = use.max(axis=-1), use.argmax(axis=-1)
    limited = worst > 0  # neither NaN nor a path on which no joint moves
    with np.errstate(divide="ignore"):
        speed = 1 / worst
    return SpeedLimit(speed, np.where(limited, place % n, -1)[()], np.where(limited, place // n, -1)[()])


# -- small steps -------------------------------------------------------------------------------------------


def _points(points: ArrayLike) -> np.ndarray:
    """points as a float array (m, d) with at least two rows."""
    points = checks.array(points, (), "points")
    if points.ndim != 2 or len(points) < 2:
        raise ValueError(f"points must be (m, 3), at least 2 rows, got {points.shape}")
    return points


def _unit(vectors, complaint):
    """Rows scaled to length 1; a ValueError names the first row that has no direction."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if np.any(length == 0):
        raise ValueError(f"point {int(np.argmin(length))} {complaint}")
    return vectors / length


def _wrap(angle):
    """The same angle within half a turn of zero."""
    return angle - 2 * np.pi * np.round(angle / (2 * np.pi))


def _pair(difference):
    """The solution of the next pose that carries each one on. |difference| (m, k, k, n) -> (m, k), -1: none.

    The nearest pair first, then the nearest of what is left: two branches never share one solution.
    """
    m, k = difference.shape[:2]
    distance = np.where((difference < JUMP).all(axis=-1), np.square(difference).sum(axis=-1), np.inf)
    partner, row = np.full((m, k), -1), np.arange(m)
    for _ in range(k):
        a, b = np.divmod(distance.reshape(m, k * k).argmin(axis=-1), k)
        found = np.isfinite(distance[row, a, b])
        partner[row[found], a[found]] = b[found]
        distance[row, a, :] = distance[row, :, b] = np.inf
    return partner
