"""The grid a robot stands on, scaled to `size`, the length of the arm: for page and picture."""

from collections.abc import Iterator

import numpy as np


def spacing(size: float) -> tuple[float, float]:
    """Distances between fine and strong grid lines, metres: 1, 2 or 5 times a power of ten, about size / 12.

    >>> spacing(1.4)
    (0.1, 0.5)
    """
    goal = size / 12
    power = 10.0 ** np.floor(np.log10(goal))
    fine = next(float(f * power) for f in (1, 2, 5, 10) if f * power >= 0.75 * goal)
    return round(fine, 12), round(5 * fine, 12)


def ticks(size: float, floor: float) -> Iterator[dict]:
    """Labels that give the grid its scale."""
    strong = spacing(size)[1]
    text = f"{strong:g} m"
    yield {"pos": [strong, -0.03 * size, floor], "text": text, "cls": "tick"}
    yield {"pos": [-0.05 * size, strong, floor], "text": text, "cls": "tick"}


def grid_lines(size: float, floor: float) -> tuple[np.ndarray, np.ndarray]:
    """Pieces of grid lines (m, 2, 3) and how strongly each end shows, (m, 2) in [0, 1].

    Lines come in short pieces: each fades with its distance from the middle, and some software renderers drop
    a line that runs behind the camera.
    """
    fine, strong = spacing(size)
    reach = 0.9 * size
    count = int(reach / fine)
    along = np.linspace(-reach, reach, 25)
    pieces, alpha = [], []
    for k in range(-count, count + 1):
        u = np.full(24, k * fine)
        line = np.stack([np.stack([u, along[:-1]], 1), np.stack([u, along[1:]], 1)], 1)
        weight = 0.62 if abs(k * fine / strong - round(k * fine / strong)) < 1e-6 else 0.26
        for points in (line, line[..., ::-1]):
            fade = np.clip(1 - np.linalg.norm(points, axis=-1) / reach, 0, 1) ** 1.2
            shown = fade.max(axis=1) > 0
            pieces.append(points[shown])
            alpha.append(weight * fade[shown])
    flat = np.concatenate(pieces)
    return np.concatenate([flat, np.full((*flat.shape[:2], 1), floor)], axis=-1), np.concatenate(alpha)
