"""Ways to a singular pose: by one joint to the nearest, and others to ask about."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import singularity
from coursekit.kinematics.robot import Robot
from coursekit.view import questions
from coursekit.view.chain import ends_of, hinges


def weakest(robot: Robot, theta: ArrayLike) -> np.ndarray:
    """The configuration with the smallest sigma_min that one joint alone leads to, inside the limits.

    >>> from coursekit import robots
    >>> panda = robots.franka_panda()
    >>> end = weakest(panda, panda.home)
    >>> int(np.flatnonzero(end != panda.home)[0]) + 1, bool(singularity.sigma_min(panda, end) < 0.01)
    (4, True)
    """
    theta, (low, high) = np.asarray(theta, float), ends_of(robot)
    best = theta
    for joint in range(robot.n):
        a, b = low[joint], high[joint]
        for _ in range(6):  # finer and finer about the lowest of 81
            turned = np.tile(theta, (81, 1))
            turned[:, joint] = np.linspace(a, b, 81)
            sigma = singularity.sigma_min(robot, turned)
            end = turned[sigma.argmin()]
            step = (b - a) / 80
            a, b = max(low[joint], end[joint] - step), min(high[joint], end[joint] + step)
        if sigma.min() < 0.99 * singularity.sigma_min(robot, best) - 1e-9:
            best = end
    return best


def nearest(robot: Robot, theta: ArrayLike, name: str) -> np.ndarray | None:
    """The configuration nearest to theta, by one joint and inside the limits, where a factor is 0; or None.

    A factor is A + B cos + C sin of any one joint angle, so its values at three angles tell its zeros.

    >>> from coursekit import robots
    >>> kr6 = robots.kuka_kr6()
    >>> float(nearest(kr6, [0, -0.7, 0.9, 0.5, 0.8, 0.2], "elbow")[2].round(6))
    0.083141
    """
    theta = np.asarray(theta, float)
    low, high = ends_of(robot)
    found = []
    for joint in range(1, 5):
        turned = np.array([theta] * 3)
        turned[:, joint] = 0, np.pi / 2, np.pi
        at_0, at_90, at_180 = singularity.factors(robot, turned)[name]
        A, B = (at_0 + at_180) / 2, (at_0 - at_180) / 2
        size = np.hypot(B, at_90 - A)
        if size < 1e-9 or abs(A) > size:
            continue
        middle, half = np.arctan2(at_90 - A, B), np.arccos(-A / size)
        roots = middle + np.outer([half, -half], np.ones(5)) + 2 * np.pi * np.arange(-2, 3)
        inside = roots[(roots >= low[joint]) & (roots <= high[joint])]
        found += [np.where(np.arange(robot.n) == joint, root, theta) for root in inside]
    return min(found, key=lambda end: np.abs(end - theta).max(), default=None)


def singular_poses(robot: Robot, split: bool, number: int) -> Iterator[np.ndarray]:
    """Some, `split`: where a factor of det J is 0; each of another kind or from another start."""
    for k in range(number, number + 9):
        start = start_of(robot)
        near = questions.a_pose(robot, start, k // 3 if split else k)
        start = np.where(hinges(robot), near, start)
        end = nearest(robot, start, singularity.NAMES[k % 3]) if split else weakest(robot, start)
        if end is not None:
            yield end


def start_of(robot: Robot) -> np.ndarray:
    """A regular configuration near home, (n,); slides in the middle of their way."""
    low, high = ends_of(robot)
    turned = robot.home + np.resize(np.radians([0, 10, 20, 25, 45, 0]), robot.n)
    return np.clip(np.where(hinges(robot), turned, (low + high) / 2), low, high)
