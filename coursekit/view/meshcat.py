"""Everything meshcat: its script for the page, a scene as its commands, and its own Visualizer on our viewer.

A drawing is a list of `Part`. Each becomes one child of a three.js Group, because only there the flags that
decide about shadows and drawing order are ours (meshcat's own Python properties are lower-cased on the way).
The page renders in sRGB, so every colour is sent as its linear value.
"""

import functools
import gzip
import importlib.util
import json
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import umsgpack
from numpy.typing import ArrayLike

from .paint import PALETTE, Part, channels, color
from .scene import Scene
from .shapes import Mesh, plate
from .stage import grid_lines

STOCK = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX", "AmbientLight", "FillLight")
# roughness, metalness, and a glow without which dark paint is lost on a dark page
_FINISH = {"body": (0.4, 0.0, 0.0), "dark": (0.5, 0.0, 0.6), "metal": (0.35, 0.2, 0.0)}


@functools.cache
def bundle() -> bytes:
    """meshcat's JavaScript bundle, gzipped (853 KB become 217 KB).

    Found without importing meshcat, whose import costs half a second and warns about a library it uses.
    """
    return gzip.compress((_package() / "viewer" / "dist" / "main.min.js").read_bytes(), 6, mtime=0)


@functools.cache
def notices() -> str:
    """The licences of meshcat and of the libraries in its bundle: they go wherever the bundle goes."""
    viewer = _package() / "viewer"
    libraries = json.loads((viewer / "dist" / "main.min.js.THIRD_PARTY_LICENSES.json").read_text("utf-8"))
    own = f"meshcat\n\n{(viewer / 'LICENSE').read_text('utf-8')}"
    theirs = [
        f"{one['name']} {one['version']} ({one['license']})\n\n{one['licenseText']}" for one in libraries
    ]
    return "\n\n----\n\n".join([own, *theirs])


def _package() -> Path:
    found = importlib.util.find_spec("meshcat")
    if found is None or found.origin is None:
        raise ModuleNotFoundError("the viewer needs meshcat, which is not installed", name="meshcat")
    return Path(found.origin).parent


def column_major(T: ArrayLike) -> bytes:
    """Bytes of transforms (..., 4, 4) as three.js reads them: float64, column by column."""
    T = np.asarray(T, float)
    if T.shape[-2:] != (4, 4):
        raise ValueError(f"transforms must have shape (..., 4, 4), got {T.shape}")
    return np.ascontiguousarray(np.swapaxes(T, -1, -2)).tobytes()


# --- a scene as commands ---


def commands(scene: Scene, known: dict[str, tuple[list[Part], dict]] | None = None) -> dict[str, dict]:
    """What meshcat must be told to draw a scene, in this order. Keys: path, path#transform, path#visible.

    known: path -> (parts, command) of earlier calls, kept up to date; what did not change is not built again.

    >>> list(commands(Scene()))[-2:]
    ['/ck/stage/floor', '/ck/stage/grid']
    """
    known = {} if known is None else known
    told = dict(_stage(scene.size, scene.floor))
    for path, parts in scene.parts.items():
        if path not in known or known[path][0] is not parts:
            known[path] = parts, {"type": "set_object", "path": path, "object": group(parts)}
        told[path] = known[path][1]
    for path, T in scene.placed.items():
        told[f"{path}#transform"] = {"type": "set_transform", "path": path, "matrix": columns(T)}
    for path, shown in scene.shown.items():
        told[f"{path}#visible"] = _visible(path, shown)
    return told


class Messages:
    """The commands of a scene as they go to the page: `packed`, key -> bytes, is what a new view needs."""

    def __init__(self) -> None:
        self.packed: dict[str, bytes] = {}
        self._told: dict[str, dict] = {}
        self._known: dict[str, tuple[list[Part], dict]] = {}

    def update(self, scene: Scene) -> tuple[list[str], list[str], list[str]]:
        """Take over what a scene shows now: the keys that changed, those gone, and the paths to delete."""
        new = commands(scene, self._known)
        self._known = {path: self._known[path] for path in scene.parts}
        gone = [key for key in self._told if key not in new]
        deleted = [self._told[key]["path"] for key in gone if self._told[key]["type"] == "set_object"]
        for key in gone:
            self.packed.pop(key, None)
        # deleting a path takes everything below it along: what is still there is sent again
        beneath = tuple(path.rstrip("/") + "/" for path in deleted)
        changed = [
            key
            for key, command in new.items()
            if self._told.get(key) != command or (command["path"] + "/").startswith(beneath)
        ]
        for key in changed:
            self.packed[key] = umsgpack.packb(new[key])
        self._told = new
        return changed, gone, deleted


class Window:
    """Stands in for the window of a `meshcat.Visualizer`: what that draws goes to `send(key, packed)`."""

    def __init__(self, send: Callable[[str, bytes], None]) -> None:
        self._send = send

    def send(self, command: Any) -> None:
        """One of meshcat's own commands; the same path and kind replaces it later."""
        told = command.lower()
        kind = told.get("property", "") if told["type"] == "set_property" else ""
        self._send(f"meshcat:{told['path']}:{told['type']}:{kind}", umsgpack.packb(told))

    @property
    def web_url(self) -> str:
        raise RuntimeError("this viewer has no address of its own: show the panel in a cell, or view.to_html")

    def get_scene(self) -> str:
        raise RuntimeError("use view.to_html(panel): it gives this scene as a page")

    def get_image(self) -> Any:
        raise RuntimeError("use view.png(scene): it draws the picture without a browser")

    def wait(self) -> None:
        """Nothing to wait for: what is sent before a page looks on is kept for it."""

    def open(self) -> None:
        raise RuntimeError("show the panel in a cell: it has no window of its own")

    close = wait


def visualizer(send: Callable[[str, bytes], None]) -> Any:
    """A `meshcat.Visualizer` that draws by `send(key, packed bytes)`.

    set_object, set_transform, set_property and delete work as ever; a call that needs meshcat's server
    (url, open, jupyter_cell, static_html, get_image) raises a RuntimeError that says what to use.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # meshcat imports a part of zmq that will go
        import meshcat
    return meshcat.Visualizer(window=Window(send))


# --- painted parts ---


def linear(number: int) -> int:
    """The linear-light value of an sRGB color, as three.js wants it in its materials."""
    c = channels(number)
    c = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    r, g, b = (int(v) for v in np.round(c * 255))
    return r << 16 | g << 8 | b


_THREE_TURNS_ABOUT_Y = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


def group(parts: Iterable[Part]) -> dict:
    """The parts as one three.js object, a Group of Meshes; equal shapes and materials are sent once."""
    geometries: list[dict] = []
    materials: list[dict] = []
    children: list[dict] = []
    shape_ids: dict[int, str] = {}
    for part in parts:
        if id(part.shape) not in shape_ids:
            shape_ids[id(part.shape)] = f"shape{len(geometries)}"
            geometries.append({"uuid": shape_ids[id(part.shape)], **_geometry(part)})
        turned = not isinstance(part.shape, Mesh)
        matrix = columns(part.pose @ _THREE_TURNS_ABOUT_Y if turned else part.pose)
        looks = [(_material(part), part.order, part.casts and part.opacity == 1)]
        if part.xray:
            looks.append((_xray(part), part.order + 30, False))
        for material, order, casts in looks:
            if material not in materials:
                materials.append(material)
            children.append(
                {
                    "uuid": f"part{len(children)}",
                    "type": "Mesh",
                    "geometry": shape_ids[id(part.shape)],
                    "material": f"paint{materials.index(material)}",
                    "matrix": matrix,
                    "castShadow": casts,
                    "receiveShadow": casts,
                    "renderOrder": order,
                }
            )
    materials = [{"uuid": f"paint{i}", **material} for i, material in enumerate(materials)]
    return document({"type": "Group", "children": children}, geometries, materials)


def document(obj: dict, geometries: Iterable[dict] = (), materials: Iterable[dict] = ()) -> dict:
    """What three.js' ObjectLoader reads: one object with what it refers to."""
    return {
        "metadata": {"version": 4.5, "type": "Object"},
        "geometries": list(geometries),
        "materials": list(materials),
        "object": {"uuid": "object", "matrix": columns(np.eye(4)), **obj},
    }


def columns(T: ArrayLike) -> list[float]:
    """A matrix (4, 4) as three.js keeps it: 16 Python floats, column after column."""
    return [float(v) for v in np.asarray(T, float).T.ravel()]


def buffers(
    vertices: ArrayLike,
    faces: ArrayLike | None = None,
    normals: ArrayLike | None = None,
    rgba: ArrayLike | None = None,
) -> dict:
    """A three.js BufferGeometry."""
    attributes = {"position": _array(vertices)}
    if normals is not None:
        attributes["normal"] = _array(normals)
    if rgba is not None:
        attributes["color"] = _array(rgba)
    data = {"attributes": attributes}
    if faces is not None:
        data["index"] = {
            "itemSize": 1,
            "type": "Uint32Array",
            "array": umsgpack.Ext(0x16, np.ascontiguousarray(faces, np.uint32).tobytes()),
            "normalized": False,
        }
    return {"type": "BufferGeometry", "data": data}


def _array(values):
    values = np.ascontiguousarray(values, np.float32)
    ext = umsgpack.Ext(0x17, values.tobytes())
    return {"itemSize": values.shape[1], "type": "Float32Array", "array": ext, "normalized": False}


def _geometry(part):
    if isinstance(part.shape, Mesh):
        return buffers(*part.shape)
    points = [{"x": round(float(r), 6), "y": round(float(h), 6)} for r, h in part.shape]
    return {"type": "LatheGeometry", "points": points, "segments": part.segments}


def _material(part):
    value = linear(color(part.color))
    rough, metal, glow = _FINISH.get(part.color, (0.5, 0.0, 0.0))
    material = {"type": "MeshStandardMaterial", "color": value, "roughness": rough}
    material |= {"metalness": metal, "side": 0}
    if part.glow or glow:
        material |= {"emissive": value, "emissiveIntensity": max(part.glow, glow)}
    if part.opacity < 1:
        # seen from both sides, and never in the way of what is drawn later
        material |= {"transparent": True, "opacity": part.opacity, "depthWrite": False, "side": 2}
    return material


def _xray(part):
    material = {"type": "MeshBasicMaterial", "color": linear(color(part.color))}
    return material | {"transparent": True, "opacity": part.xray, "depthTest": False, "depthWrite": False}


# --- the stage: a key light with a soft shadow, a sky, a floor for the shadow, a grid ---


@functools.lru_cache(maxsize=8)
def _stage(size, floor):
    """Key and command of everything that is there before a robot comes."""
    hide = ["/Grid", "/Axes", "/Background", *(f"/Lights/{name}" for name in STOCK)]
    things = {"key": _key_light(size, floor), "sky": _sky(), "floor": _floor(size, floor)}
    things["grid"] = _grid(size, floor)
    hidden = [(f"{path}#visible", _visible(path, False)) for path in hide]
    drawn = [(f"/ck/stage/{name}", thing) for name, thing in things.items()]
    return [*hidden, *((path, {"type": "set_object", "path": path, "object": o}) for path, o in drawn)]


def _visible(path, shown):
    return {"type": "set_property", "path": path, "property": "visible", "value": bool(shown)}


def _key_light(size, floor):
    reach = 0.95 * size
    camera = {"uuid": "shadow", "type": "OrthographicCamera", "left": -reach, "right": reach, "top": reach}
    camera |= {"bottom": -reach, "near": 0.3 * size, "far": 4.5 * size}
    shadow = {"bias": -0.0004, "normalBias": 0.008 * size, "radius": 5.0, "mapSize": [2048, 2048]}
    shadow |= {"camera": camera}
    light = {"type": "DirectionalLight", "color": 0xFFF4E8, "intensity": 0.75}
    light |= {"castShadow": True, "shadow": shadow}
    return document({**light, "matrix": _at(0.8 * size, -0.95 * size, 1.9 * size + floor)})


def _sky():
    light = {"type": "HemisphereLight", "color": 0xF3F7FF, "groundColor": 0x8A8680, "intensity": 0.7}
    # its place is its direction; the default would be sideways
    return document({**light, "matrix": _at(0, 0, 1)})


def _floor(size, floor):
    shape = buffers(*plate(3.2 * size))
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
