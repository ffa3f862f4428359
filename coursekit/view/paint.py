"""Paint: the palette, and `Part`, one painted shape. A drawing is a list of parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
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
    "trace": 0x0C8295,
    "accent": 0xC2307E,
    "bone": 0x3C4654,
    "ghost": 0x4F86C6,
    "plane": 0x8FA3BF,
    "grid": 0x8793A3,
}


def color(name: str | int) -> int:
    """A palette name or a number 0xRRGGBB as the number; ValueError for any other name.

    >>> hex(color("trace"))
    '0xc8295'
    """
    if isinstance(name, str):
        if name not in PALETTE:
            raise ValueError(f"a color is one of {', '.join(PALETTE)} or a number 0xRRGGBB, not {name!r}")
        return PALETTE[name]
    return int(name)


def channels(number: int) -> np.ndarray:
    """0xRRGGBB as three numbers in [0, 1]."""
    return np.array([number >> 16 & 255, number >> 8 & 255, number & 255]) / 255


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

    def __post_init__(self):
        color(self.color)  # a wrong name is told where it was written

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
