"""What is drawn beside the right thing by the student's numbers, and how far apart the two are, in words."""

from __future__ import annotations

from typing import Any

import numpy as np

from coursekit.kinematics import lie
from coursekit.kinematics.robot import Robot

from . import text
from .scene import Scene

ROOT = "/ck/yours"  # everything that is drawn by the student's numbers
COLOR = "accent"  # and its one colour
ZERO = 1e-9  # metres, radians: what differs by less is the same
MARKS = 20  # points at most that are marked at once
FAR = 4.0  # sizes of the scene: what is farther away is told and not drawn


class Trouble(Exception):
    """Why there is nothing to see of a function; the text is for who wrote it."""


def apart(T: np.ndarray, right: np.ndarray) -> tuple[Any, Any]:
    """Metres and radians between poses (..., 4, 4), each (...); the angle is NaN where T is no pose."""
    R = np.swapaxes(right[..., :3, :3], -1, -2) @ T[..., :3, :3]
    near = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max(axis=(-1, -2)) < 1e-6
    near &= np.abs(T[..., 3, :] - [0, 0, 0, 1]).max(axis=-1) < 1e-6
    is_pose = near & (np.linalg.det(np.where(np.isfinite(R), R, 0)) > 0)
    angle = np.linalg.norm(lie.log3(np.where(is_pose[..., None, None], R, np.eye(3))), axis=-1)
    return np.linalg.norm(T[..., :3, 3] - right[..., :3, 3], axis=-1), np.where(is_pose, angle, np.nan)


def gap(distance: float, angle: float = 0.0) -> str:
    """A gap in words: "12.3 mm and 4.5 deg", "below 1e-9".

    >>> gap(0.0123, 0), gap(0, 1e-12), gap(0.0123, np.nan)
    ('12.3 mm', 'below 1e-9', '12.3 mm and columns of R or a last row that no pose has')
    """
    parts = [f"{size(1000 * distance)} mm"] if distance > ZERO else []
    parts += [f"{size(float(np.degrees(angle)))} deg"] if angle > ZERO else []
    parts += ["columns of R or a last row that no pose has"] if np.isnan(angle) else []
    return " and ".join(parts) or "below 1e-9"


def size(x: float) -> str:
    """A gap's number: one decimal, or its power of ten where that would be 0.0 or a row of digits."""
    return text.number(x, 1) if 0.05 <= abs(x) < 1e7 else text.scientific(x)


def chain(mine: np.ndarray, right: np.ndarray) -> tuple[int | None, str]:
    """Which of the frames (n, 4, 4), the tool's last, is the first that is off, and the words for it."""
    distance, angle = apart(mine, right)
    off = np.flatnonzero(~((distance <= ZERO) & (angle <= ZERO)))
    if not off.size:
        return None, "every frame and the tool agree with the arm's, below 1e-9"
    first, n = int(off[0]), len(mine)
    if first == n - 1:
        return (
            first,
            f"all frames before the tool are right; the tool is off by {gap(distance[-1], angle[-1])}",
        )
    told = f"frame {first + 1} is the first that is off, by {gap(distance[first], angle[first])}"
    more = f"; the tool is off by {gap(distance[-1], angle[-1])}" if off[-1] == n - 1 else ""
    return first, told + more


def like_the_kr6(robot: Robot) -> tuple[np.ndarray, float]:
    """Lengths a1, d1, a2, a3, d4 and the tool's of an arm built like the KR6; Trouble for any other."""
    if robot.n == 6 and "prismatic" not in robot.joint_types:
        points = np.cross(robot.S[:3].T, robot.S[3:].T)
        (a1, _, d1), elbow, up, wrist = points[1], points[2, 0], points[3, 2], points[4, 0]
        w = [[0, 0, -1], [0, 1, 0], [0, 1, 0], [-1, 0, 0], [0, 1, 0], [-1, 0, 0]]
        q = [[0, 0, 0], [a1, 0, d1], [elbow, 0, d1], *[[wrist, 0, up]] * 3]
        M = np.eye(4)
        M[:3, 3] = robot.M[0, 3], 0, up
        like = Robot.from_axes(w, q, M)
        if np.allclose(like.S, robot.S, atol=1e-12) and np.allclose(M, robot.M, atol=1e-12):
            return np.array([a1, d1, elbow - a1, up - d1, wrist - elbow]), float(robot.M[0, 3] - wrist)
    raise Trouble(f"it is for an arm built like the KR6, and {robot.name} is not")


# ---- drawing


class Sketch:
    """What is drawn of one function, at a path of its own."""

    def __init__(self, scene: Scene, name: str, label: str = "yours") -> None:
        self.scene, self.path, self.label = scene, f"{ROOT}/{name}", label

    def near(self, point: np.ndarray) -> bool:
        """Whether a point (3,) is near enough to be drawn."""
        return bool(np.abs(point).max(initial=0.0) < FAR * self.scene.size)

    def arm(self, robot: Robot, links: np.ndarray) -> None:
        """A translucent arm whose links stand at these displacements (n, 4, 4)."""
        name = f"{self.path.removeprefix('/ck/')}/arm"
        ghost = self.scene.robots.get(name)
        if ghost is None or ghost.robot is not robot:
            ghost = self.scene.robot(robot, np.zeros(robot.n), name, "ghost")
            ghost.color = COLOR
        ghost.links = links

    def arms(self, robot: Robot, thetas: np.ndarray) -> None:
        """Translucent arms at these configurations (k, n), and no others."""
        base = f"{self.path.removeprefix('/ck/')}/arm"
        for name in [name for name in self.scene.robots if name.startswith(base)]:
            if int(name.removeprefix(base)) >= len(thetas):
                self.scene.robots[name].remove()
        for k, theta in enumerate(thetas):
            if f"{base}{k}" not in self.scene.robots:
                self.scene.robot(robot, theta, f"{base}{k}", "ghost").color = COLOR
            self.scene.robots[f"{base}{k}"].theta = theta

    def frame(self, key: str, T: np.ndarray, label: str | None = None) -> None:
        """A frame at T (4, 4), all its axes in the student's colour."""
        long = 0.1 * self.scene.size
        path = f"{self.path}/{key}"
        if path not in self.scene.parts:
            self.scene.normals(path, np.zeros((3, 3)), long * np.eye(3), COLOR)
        self.scene.point(f"{path}/name", np.zeros(3), self.label if label is None else label, COLOR)
        self.scene[path].move(T)

    def gap(self, key: str, a: np.ndarray, b: np.ndarray, named: bool = True) -> None:
        """A line from the right point to the student's, with its length where it is `named`."""
        long = float(np.linalg.norm(b - a))
        label = f"{size(1000 * long)} mm" if named and long > ZERO else ""
        self.scene.line(f"{self.path}/{key}", a, b, COLOR, label)

    def poses(self, robot: Robot, mine: np.ndarray, right: np.ndarray, at_zero: np.ndarray) -> str:
        """The arm by the student's frames (n, 4, 4), the tool's last, beside the right ones; the words."""
        first, words = chain(mine, right)
        are_poses = not np.isnan(apart(mine, right)[1]).any()
        near = all(self.near(T[:3, 3]) for T in mine)
        if not (are_poses and near):
            self.scene.remove(self.path)
            return words if near else f"{words}; too far away to be drawn (metres?)"
        self.arm(robot, mine @ lie.inverse(at_zero))
        self.frame("tool", mine[-1], f"{self.label} \N{CHECK MARK}" if first is None else None)
        self.gap("gap", right[-1][:3, 3], mine[-1][:3, 3])
        if first is None or first == len(mine) - 1:
            self.scene.remove(f"{self.path}/first")
            self.scene.remove(f"{self.path}/first_gap")
        else:
            self.frame("first", mine[first], f"{self.label} {first + 1}")
            self.gap("first_gap", right[first][:3, 3], mine[first][:3, 3])
        return words

    def point(self, key: str, mine: np.ndarray, right: np.ndarray) -> str:
        """A point (3,) beside the right one; the words."""
        off = float(np.linalg.norm(mine - right))
        if not self.near(mine):
            self.scene.remove(self.path)
            return f"off by {gap(off)}; too far away to be drawn (metres?)"
        self.mark(key, mine, self.label + ("" if off > ZERO else " \N{CHECK MARK}"))
        self.gap("gap", right, mine)
        return f"off by {gap(off)}" if off > ZERO else "below 1e-9 from the right place"

    def mark(self, key: str, point: np.ndarray, label: str = "") -> None:
        """A ball at a point (3,)."""
        self.scene.point(f"{self.path}/{key}", point, label, COLOR, 0.012 * self.scene.size)

    def marks(self, key: str, points: np.ndarray) -> None:
        """Balls at the first of these points (k, 3), and no others."""
        for k in range(MARKS):
            if k < len(points):
                self.mark(f"{key}{k}", points[k])
            else:
                self.scene.remove(f"{self.path}/{key}{k}")

    def arrow(self, key: str, at: np.ndarray, way: np.ndarray, label: str, color: str = COLOR) -> None:
        """An arrow along `way` (3,); none where that is zero."""
        long = np.linalg.norm(way) > 1e-6 * self.scene.size
        self.scene.arrow(f"{self.path}/{key}", at, way if long else np.zeros(3), color, label)

    def way(self, points: np.ndarray) -> None:
        """The way of the tool through points (k, 3), as far as it stays in sight."""
        gone = np.flatnonzero([not self.near(point) for point in points])
        points = points[: gone[0]] if gone.size else points
        if len(points) > 1 and np.ptp(points, axis=0).max() > 1e-6:
            self.scene.curve(f"{self.path}/way", points, COLOR)
        else:
            self.scene.remove(f"{self.path}/way")
