"""Configurations of one arm as small stick figures, all seen from one side, to be told apart at a glance."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import axes
from coursekit.kinematics.robot import Robot
from coursekit.view.chain import chain

WIDE, HIGH, MARGIN = 100.0, 76.0, 7.0  # of a figure, in its own units


def silhouettes(robot: Robot, thetas: ArrayLike, target: ArrayLike) -> list[list[str]]:
    """Lines of each configuration: ground, target, arm, and fins where shoulder and wrist turn.

    thetas (k, n), NaN for what does not exist: it has no arm. target (3,), metres. Each line is
    "x,y x,y ...", x to the right, y down, inside 100 by 76; all figures have one scale.

    >>> from coursekit import robots
    >>> figures = silhouettes(robots.planar_2r(), [[0, 1], [1, -1], [np.nan, np.nan]], [0.5, 0.5, 0])
    >>> [len(lines) for lines in figures]
    [3, 3, 2]
    """
    thetas, target, arm = np.asarray(thetas, float), np.asarray(target, float), chain(robot)
    half = 0.09 * arm.size
    arms = [_arm(robot, arm, theta, half) for theta in thetas]
    right, up = _camera(robot, arm, np.array([p for lines in arms for line in lines for p in line]))
    ground = arm.foot + half * np.outer([-1, 1], right)
    ring = np.linspace(0, 2 * np.pi, 13)
    mark = target + 0.35 * half * (np.outer(np.cos(ring), right) + np.outer(np.sin(ring), up))
    flat = [
        [np.column_stack([line @ right, -line @ up]) for line in (ground, mark, *lines)] for lines in arms
    ]
    every = np.concatenate([line for lines in flat for line in lines] or [np.zeros((1, 2))])
    low, high = every.min(axis=0), every.max(axis=0)
    scale = min((np.array([WIDE, HIGH]) - 2 * MARGIN) / np.maximum(high - low, 1e-9))
    shift = np.array([WIDE, HIGH]) / 2 - scale * (low + high) / 2
    return [[_points(scale * line + shift) for line in lines] for lines in flat]


def _camera(robot, arm, points):
    """Right and up (3,): upright, seen from where the arms spread most; an arm in a plane from above."""
    up, turning = arm.up, axes.directions_of(robot.S)
    level = np.eye(3) - np.outer(up, up)
    right = level[np.abs(up).argmin()]
    if all(axes.parallel(up, w, axes.NEARLY) for w in turning):
        up = np.cross(up, right)
    elif len(points):
        spread = (points - arm.foot) @ level
        right = np.linalg.eigh(spread.T @ spread)[1][:, -1]
        right *= 1 if right @ [1, 0.1, 0.01] > 0 else -1
    return right / np.linalg.norm(right), up / np.linalg.norm(up)


def _arm(robot, arm, theta, half):
    """The arm from its foot to its tool, and fins that say how its shoulder and its wrist are turned."""
    if np.isnan(theta).any():
        return []
    moved = np.concatenate([np.eye(4)[None], robot.displacements(theta)])
    stops: Iterable = [
        p
        for k, joint in enumerate(arm.joints)
        for p in (moved[k] @ [*joint.enter, 1], moved[k + 1] @ [*joint.leave, 1])
    ]
    points = np.array([[*arm.foot, 1], *stops, moved[-1] @ [*arm.tool, 1]])[:, :3]
    fins = []
    for k, way in _ways(robot, arm):
        start = (moved[k] @ [*arm.joints[k].enter, 1])[:3]
        fins.append(np.array([start, start + half * moved[k][:3, :3] @ way]))
    return [points, *fins]


def _ways(robot, arm):
    """Link and way at zero: solutions may differ in where the shoulder faces, or in their wrist alone."""
    turning = axes.directions_of(robot.S)
    if robot.n > 1 and not axes.parallel(turning[0], turning[1], axes.NEARLY):
        ahead = np.cross(turning[0], turning[1])
        yield 1, ahead * (1 if ahead @ (arm.tool - arm.foot) >= 0 else -1)
    if robot.n >= 6:
        yield robot.n - 2, 0.8 * (turning[-2] + np.cross(turning[-3], turning[-2]))


def _points(line):
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in line)
