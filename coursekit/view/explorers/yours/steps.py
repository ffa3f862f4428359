"""What the explorers share: the wrist centre, equal configurations, and the run of a student's steps."""

from collections.abc import Callable
from typing import Any

import numpy as np

from coursekit.kinematics import lie
from coursekit.kinematics.robot import Robot
from coursekit.view import text
from coursekit.view.sketch import ZERO, Trouble, apart, gap, size

STEPS = 50
THERE = 1e-8  # metres and radians: a run has come to its target


def wrist(T: np.ndarray, tool: float) -> np.ndarray:
    """The wrist centre behind tool poses (..., 4, 4), for a tool along its own x axis."""
    return T[..., :3, 3] - tool * T[..., :3, 0]


def alike(thetas: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Which of thetas (k, n) is theta (n,), but for whole turns: (k,) bool."""
    return (np.abs(np.angle(np.exp(1j * (thetas - theta)))) < 1e-6).all(axis=-1)


def ahead(robot: Robot, theta: np.ndarray, target: np.ndarray) -> np.ndarray:
    """The twist (6,) that leads from the tool at theta (n,) to the target (4, 4), in the tool's frame."""
    return lie.log6(lie.inverse(robot.fk(theta)) @ target)


def iterate(
    robot: Robot,
    theta: np.ndarray,
    target: np.ndarray,
    step: Callable[[np.ndarray], Any],
    tol: float = 1e-9,
    rows: slice = slice(0, 6),
) -> tuple[np.ndarray, tuple[float, float] | None]:
    """Configurations (N, n) by the student's steps, and what is left: (angle, distance); None: run away."""
    thetas = [np.array(theta, float)]
    for _ in range(STEPS):
        distance, angle = apart(robot.fk(thetas[-1]), target)
        if distance < tol and (angle < tol or rows.start == 3):
            break
        change = step(thetas[-1])
        if change.shape != thetas[0].shape:
            raise Trouble(f"it returns shape {change.shape}, expected {thetas[0].shape}")
        if np.abs(change).max() > 1e4:
            return np.array(thetas), None
        thetas.append(thetas[-1] + change)
    distance, angle = apart(robot.fk(thetas[-1]), target)
    return np.array(thetas), (0.0 if rows.start == 3 else float(angle), float(distance))


def run(thetas: np.ndarray, left: tuple[float, float] | None, first: np.ndarray) -> str:
    """What became of the student's steps, in words. first: what the first of them should be."""
    count = len(thetas) - 1
    if left is None and not count:
        return "the first step runs away"
    off = np.abs(thetas[1] - thetas[0] - first).max() if count else 0.0
    told = f"the first step is {'right, below 1e-9' if off <= ZERO else f'off by {size(off)} rad'}"
    if left is None:
        return f"{told}; step {count + 1} runs away"
    longest = np.linalg.norm(np.diff(thetas, axis=0), axis=-1).max(initial=0.0)
    if max(left) < THERE:
        return f"{told}; {count} steps to the target, the longest {text.number(longest, 2)} rad"
    return f"{told}; after {count} steps still {gap(left[1], left[0])} away"
