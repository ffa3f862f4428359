"""Pictures of the notebooks, one file each: what needs more lines than a cell should have."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coursekit.view import curves
from coursekit.view.paint import PALETTE

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

INK = "#2B3038"  # links, notes and thin lines
SHADES = 128  # colors of a stored figure


def palette(name: str) -> str:
    """A colour of the house as matplotlib writes it, so that a figure looks like its explorer."""
    return f"#{PALETTE[name]:06X}"


def show() -> None:
    """Show the figure that was drawn last, in few colors: a third of the bytes that `plt.show()` stores.

    Its numbers stand beside the picture, as the alternative text that pages made of the notebook have.
    """
    import matplotlib.pyplot as plt
    from IPython.display import display
    from PIL import Image

    figure, drawn, small = plt.gcf(), io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, format="png", dpi=100, bbox_inches="tight")
    image = Image.open(drawn).convert("RGB")
    image.quantize(SHADES, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(small, "PNG")
    wide, high = (100 * figure.get_size_inches()).round().astype(int)
    said = f"<Figure size {wide}x{high} with {len(figure.axes)} Axes>"
    plt.close(figure)
    data = {"image/png": base64.b64encode(small.getvalue()).decode(), "text/plain": said}
    display(data, metadata={"image/png": {"alt": curves.words(figure)}}, raw=True)


def blank(size: tuple[float, float], count: int = 1, grid: float = 0.3, **more: Any) -> Any:
    """Empty axes with a grid of this opacity; several stand side by side, in an array. size in inches."""
    import matplotlib.pyplot as plt

    _, axes = plt.subplots(ncols=count, figsize=size, layout="constrained", **more)
    for ax in np.ravel(axes if grid else []):
        ax.grid(alpha=grid)
    return axes


def in_space(size: tuple[float, float], count: int = 1, **more: Any) -> Any:
    """As `blank`: axes of three directions, seen without perspective."""
    axes = blank(size, count, subplot_kw={"projection": "3d"}, **more)
    for ax in np.ravel(axes):
        ax.set_proj_type("ortho")
    return axes


def axes_3d(count: int, size: tuple[float, float]) -> np.ndarray:
    """`count` axes in space on grey paper, in an array; size in inches."""
    axes = np.ravel(in_space(size, count))
    for ax in axes:
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
            axis.pane.set_facecolor("#F6F7F9")
            axis._axinfo["grid"].update(color="#E1E5EA", linewidth=0.6)
    return axes


def limits_3d(
    ax: Axes3D,
    limits: Sequence[tuple[float, float]],
    ticks: Iterable[float],
    unit: str,
    zoom: float = 0.95,
) -> None:
    """Equal axes over three pairs (low, high), with those of the ticks that lie inside."""
    for letter, (low, high) in zip("xyz", limits, strict=True):
        ax.set(**{f"{letter}lim": (low, high), f"{letter}label": f"{letter} [{unit}]"})
        inside = [t for t in ticks if low <= t <= high]
        ax.set(**{f"{letter}ticks": inside})
    ax.set_box_aspect([high - low for low, high in limits], zoom=zoom)
    ax.tick_params(labelsize=8, pad=-2)
    ax.tick_params(axis="z", pad=3)
