"""Where the camera stands: far enough for the whole robot, whatever its size."""

import numpy as np

FOV = 32.0  # vertical angle of view, degrees
STANDS = {
    "home": (-58, 17),
    "top": (-90, 89.9),
    "side": (-90, 4),
    "front": (0, 4),
}  # azimuth, elevation, degrees


def views(low, high, size):
    """Stands from which the box low..high is seen: name -> {"position", "target"}, metres, z up.

    A box much smaller than the arm (a folded pose) does not bring the camera closer: arms unfold.

    >>> views(np.zeros(3), np.ones(3), 1.0)["front"]["target"]
    [0.5, 0.5, 0.5]
    """
    center = (low + high) / 2
    radius = max(np.linalg.norm(high - low) / 2, 0.46 * size)
    distance = 0.88 * radius / np.sin(np.radians(FOV / 2))
    stands = {}
    for name, (azimuth, elevation) in STANDS.items():
        a, e = np.radians([azimuth, elevation])
        way = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        stands[name] = {"position": (center + distance * way).tolist(), "target": center.tolist()}
    return stands


def extent(robot, theta, painted, chain):
    """Corners low (3,), high (3,) of what a robot's painted parts fill at theta, with some room to move."""
    corners = []
    for T, parts in zip([np.eye(4), *robot.displacements(theta)], painted, strict=True):
        for part in parts:
            p = part.mesh(coarse=True).vertices
            corners += [q @ T[:3, :3].T + T[:3, 3] for q in (p.min(axis=0), p.max(axis=0))]
    stays_at_its_height = np.allclose(np.abs(robot.S[:3].T @ robot.S[:3, 0]), 1)  # all axes are parallel
    if not stays_at_its_height:
        shoulder = chain.joints[min(1, robot.n - 1)].enter
        corners.append(shoulder + [0, 0, 0.4 * chain.size])
    margin = 0.06 * chain.size
    return np.min(corners, axis=0) - margin, np.max(corners, axis=0) + margin
