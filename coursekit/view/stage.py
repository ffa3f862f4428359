"""The stage a robot stands on: a key light with a soft shadow, a sky, a floor for the shadow, a grid.

Everything is scaled to `size`, the length of the arm, so that a planar toy and a welding robot look alike.
"""

from collections.abc import Iterator

import numpy as np

from .paint import PALETTE, buffers, channels, columns, document, linear

STOCK = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX", "AmbientLight", "FillLight")


def commands(size: float, floor: float) -> Iterator[dict]:
    """Meshcat commands for the light, the floor at height `floor`, and the grid on it."""
    hide = ["/Grid", "/Axes", "/Background", *(f"/Lights/{name}" for name in STOCK)]
    for path in hide:
        yield {"type": "set_property", "path": path, "property": "visible", "value": False}
    for name, thing in {
        "key": _key_light(size, floor),
        "sky": _sky(),
        "floor": _floor(size, floor),
        "grid": _grid(size, floor),
    }.items():
        yield {"type": "set_object", "path": f"/ck/stage/{name}", "object": thing}


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


def _key_light(size, floor):
    reach = 0.95 * size
    camera = {"uuid": "shadow", "type": "OrthographicCamera", "left": -reach, "right": reach, "top": reach}
    camera |= {"bottom": -reach, "near": 0.3 * size, "far": 4.5 * size}
    shadow = {
        "bias": -0.0004,
        "normalBias": 0.008 * size,
        "radius": 5.0,
        "mapSize": [2048, 2048],
        "camera": camera,
    }
    light = {
        "type": "DirectionalLight",
        "color": 0xFFF4E8,
        "intensity": 0.75,
        "castShadow": True,
        "shadow": shadow,
    }
    return document({**light, "matrix": _at(0.8 * size, -0.95 * size, 1.9 * size + floor)})


def _sky():
    light = {"type": "HemisphereLight", "color": 0xF3F7FF, "groundColor": 0xB9B2A8, "intensity": 0.2}
    # its place is its direction; the default would be sideways
    return document({**light, "matrix": _at(0, 0, 1)})


def _floor(size, floor):
    s = 1.6 * size
    corners = np.array([[-s, -s, 0], [s, -s, 0], [s, s, 0], [-s, s, 0]])
    shape = buffers(corners, np.array([[0, 1, 2], [0, 2, 3]]), np.tile([0.0, 0.0, 1.0], (4, 1)))
    # a black shadow, because a colored one would shine on a dark page
    paint = {"type": "ShadowMaterial", "color": 0, "transparent": True, "opacity": 0.2, "depthWrite": False}
    mesh = {"receiveShadow": True, "renderOrder": -3, "matrix": _at(0, 0, floor - 0.001 * size)}
    return _one("Mesh", shape, paint, mesh)


def _grid(size, floor):
    pieces, alpha = grid_lines(size, floor)
    rgb = np.tile(channels(linear(PALETTE["grid"])), (alpha.size, 1))
    shape = buffers(pieces.reshape(-1, 3), rgba=np.column_stack([rgb, alpha.ravel()]))
    paint = {"type": "LineBasicMaterial", "color": 0xFFFFFF, "vertexColors": True, "transparent": True}
    return _one("LineSegments", shape, {**paint, "depthWrite": False}, {"renderOrder": -2})


def _one(kind, shape, paint, more):
    child = {"uuid": "part0", "type": kind, "geometry": "shape0", "material": "paint0", **more}
    child.setdefault("matrix", _at(0, 0, 0))
    group = {"type": "Group", "children": [child]}
    return document(group, [{"uuid": "shape0", **shape}], [{"uuid": "paint0", **paint}])


def _at(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return columns(T)
