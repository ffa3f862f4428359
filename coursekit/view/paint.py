"""Paint: the palette, and drawings as the three.js objects that meshcat loads.

A drawing is a list of `Part`. Each becomes one child of a three.js Group, because only there the flags that
decide about shadows and drawing order are ours (meshcat's own Python properties are lower-cased on the way).
The page renders in sRGB, so every colour is sent as its linear value.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import umsgpack
from numpy.typing import ArrayLike

from . import shapes

PALETTE = {
    "body": 0xF07A2B,
    "dark": 0x2B3038,
    "metal": 0xC9CED6,
    "x": 0xD9483B,
    "y": 0x3F9E5C,
    "z": 0x3A6FD6,
    "axis": 0x7A4FBF,
    "trace": 0x0E8FA3,
    "accent": 0xC2307E,
    "bone": 0x3C4654,
    "ghost": 0x4F86C6,
    "plane": 0x8FA3BF,
    "grid": 0x8793A3,
}
_FINISH = {"body": (0.45, 0.0), "dark": (0.55, 0.1), "metal": (0.35, 0.5)}  # roughness, metalness


def color(name: str | int) -> int:
    """A palette name or a number 0xRRGGBB as the number; ValueError for any other name.

    >>> hex(color("trace"))
    '0xe8fa3'
    """
    if isinstance(name, str):
        if name not in PALETTE:
            raise ValueError(f"a color is one of {', '.join(PALETTE)} or a number 0xRRGGBB, not {name!r}")
        return PALETTE[name]
    return int(name)


def channels(number: int) -> np.ndarray:
    """0xRRGGBB as three numbers in [0, 1]."""
    return np.array([number >> 16 & 255, number >> 8 & 255, number & 255]) / 255


def linear(number: int) -> int:
    """The linear-light value of an sRGB color, as three.js wants it in its materials."""
    c = channels(number)
    c = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    r, g, b = (int(v) for v in np.round(c * 255))
    return r << 16 | g << 8 | b


@dataclass(frozen=True)
class Part:
    """One painted shape: a profile to turn about z or a Mesh, placed at T (4, 4).

    glow lights it a little from inside (wires and arrows stay readable in shadow); xray is the opacity with
    which it shines through whatever stands in front; order is three.js' renderOrder.
    """

    shape: shapes.Mesh | Sequence[tuple[float, float]]
    color: str | int = "body"
    T: np.ndarray | None = None
    opacity: float = 1.0
    glow: float = 0.0
    xray: float = 0.0
    casts: bool = True
    segments: int = 32
    order: int = 0

    @property
    def pose(self) -> np.ndarray:
        return np.eye(4) if self.T is None else self.T

    def mesh(self, coarse: bool = False) -> shapes.Mesh:
        """Its Mesh where it stands."""
        shape = self.shape
        if not isinstance(shape, shapes.Mesh):
            shape = shapes.lathe(shape, min(self.segments, 20) if coarse else self.segments)
        return shape.moved(self.pose)

    def placed(self, T: ArrayLike) -> Part:
        """The same part moved by T (4, 4)."""
        return replace(self, T=np.asarray(T, float) @ self.pose)


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
        turned = not isinstance(part.shape, shapes.Mesh)
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
    if isinstance(part.shape, shapes.Mesh):
        return buffers(part.shape.vertices, part.shape.faces, part.shape.normals)
    points = [{"x": round(float(r), 6), "y": round(float(h), 6)} for r, h in part.shape]
    return {"type": "LatheGeometry", "points": points, "segments": part.segments}


def _material(part):
    value = linear(color(part.color))
    rough, metal = _FINISH.get(part.color, (0.5, 0.0))
    material = {"type": "MeshStandardMaterial", "color": value, "roughness": rough}
    material |= {"metalness": metal, "side": 0}
    if part.glow:
        material |= {"emissive": value, "emissiveIntensity": part.glow}
    if part.opacity < 1:
        # seen from both sides, and never in the way of what is drawn later
        material |= {"transparent": True, "opacity": part.opacity, "depthWrite": False, "side": 2}
    return material


def _xray(part):
    material = {"type": "MeshBasicMaterial", "color": linear(color(part.color))}
    return material | {"transparent": True, "opacity": part.xray, "depthTest": False, "depthWrite": False}
