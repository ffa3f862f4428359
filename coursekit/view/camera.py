"""Where the camera stands: far enough for the whole robot, whatever its size."""

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot

from .chain import Chain
from .paint import Part

FOV = 32.0  # vertical angle of view, degrees
ASPECT = 1.25  # width by height of a picture

# azimuth, elevation, degrees
STANDS = {"home": (-58, 17), "top": (-90, 89.9), "side": (-90, 4), "front": (0, 4)}


def views(low: np.ndarray, high: np.ndarray, size: float) -> dict[str, dict]:
    """Stands from which the box low..high is seen: name -> {"position", "target", "wide"}, metres, z up.

    In a picture whose width by height is less than "wide", the page steps back.
    A box much smaller than the arm (a folded pose) does not bring the camera closer: arms unfold.

    >>> views(np.zeros(3), np.ones(3), 1.0)["front"]["target"]
    [0.5, 0.5, 0.5]
    """
    center = (low + high) / 2
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T - center
    tangent, room = np.tan(np.radians(FOV / 2)), 0.4 * size
    stands = {}
    for name, (azimuth, elevation) in STANDS.items():
        a, e = np.radians([azimuth, elevation])
        way = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        ahead, across, up = corners @ way, np.abs(corners @ right), np.abs(corners @ np.cross(way, right))
        near = np.max(ahead + np.maximum(across / ASPECT, up) / tangent)  # every corner is in the picture
        distance = max(near, room / np.sin(np.radians(FOV / 2)))
        wide = float(max(room / distance, np.max(across / (distance - ahead))) / tangent)
        position, target = (center + distance * way).tolist(), center.tolist()
        stands[name] = {"position": position, "target": target, "wide": wide}
    return stands


def extent(
    robot: Robot, theta: ArrayLike, painted: list[list[Part]], chain: Chain
) -> tuple[np.ndarray, np.ndarray]:
    """Corners low (3,), high (3,) of what a robot's painted parts fill at theta, with some room to move."""
    corners = []
    for T, parts in zip([np.eye(4), *robot.displacements(theta)], painted, strict=True):
        for part in parts:
            p = part.mesh(coarse=True).vertices
            corners += [q @ T[:3, :3].T + T[:3, 3] for q in (p.min(axis=0), p.max(axis=0))]
    stays_at_its_height = np.allclose(np.abs(robot.S[:3].T @ robot.S[:3, 0]), 1)  # all axes are parallel
    if not stays_at_its_height:
        shoulder = chain.joints[min(1, robot.n - 1)].enter
        corners.append(shoulder + [0, 0, 0.36 * chain.size])
    margin = 0.06 * chain.size
    return np.min(corners, axis=0) - margin, np.max(corners, axis=0) + margin
