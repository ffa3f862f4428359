"""Plots beside the 3D view: a matplotlib figure as SVG, in the ink of the page, and marks that move over it.

A figure is drawn again when what it shows has changed; where only the arm has gone on, the kernel sends where
the marks stand. The figure's labelled curves are also its numbers: a table for everybody, and in words for
those who do not see it.
"""

from __future__ import annotations

import io
import re
import time
from collections.abc import Callable, Hashable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import traitlets
from numpy.typing import ArrayLike

from coursekit.view import curves
from coursekit.view.script import Widget

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure  # else only where it is used: its import is slow

# Colours of curves: a contrast of 3 or more on white and on the paper of a dark page.
CURVES = ("#0C8295", "#C2307E", "#C75B12", "#3A7DE0", "#5F8A1E", "#8F6BD4", "#A07A12", "#7B8794")
LOW = 2.8  # inches: a figure that has to be narrow is not drawn lower
_INK = "#010203"  # where matplotlib writes it, the page's own ink comes
STYLE: Any = {
    **dict.fromkeys(("figure.facecolor", "axes.facecolor", "savefig.facecolor", "legend.facecolor"), "none"),
    **dict.fromkeys(("text.color", "axes.labelcolor", "xtick.color", "ytick.color", "axes.edgecolor"), _INK),
    "axes.prop_cycle": f"cycler(color={list(CURVES)})",
    "image.interpolation": "none",  # the values as they are: fewer bytes, and the page makes them larger
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "coursekit",
}


class Plot(Widget):
    """A matplotlib figure below the 3D view.

    Parameters
    ----------
    draw : function(figure, values) -> None
        Draws into an empty matplotlib Figure (`ax = figure.subplots()`). Its colours are `CURVES`, its ink is
        the page's; the curves with a label also stand in the table of its numbers.
    caption : str
        What to see, as a sentence.
    size : (float, float)
        Inches.
    on_click : function(x, y), optional
        Called with the point of a click, in the data coordinates of the figure's first axes, and again and
        again while it is dragged; clicks outside the axes do not count. What it sets with `Panel.set` draws
        the panel again.
    on_step : function(dx, dy), optional
        Called for the arrow keys, with whole steps or, with Shift, fifths of them: for those without a mouse.
    cursor : function(values) -> (k, 2), optional
        Marks over the figure, in the data coordinates of its first axes: points or, where y is NaN, upright
        lines. One outside the axes is not shown. They move without the figure being drawn again.
    key : function(values), optional
        What the figure shows, as something to compare (a tuple): it is drawn again where this differs from
        the last time. Without it, always.
    """

    kind = traitlets.Unicode("plot").tag(sync=True)
    svg = traitlets.Unicode().tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    caption = traitlets.Unicode().tag(sync=True)
    numbers: traitlets.List = traitlets.List().tag(sync=True)  # rows of text: the title, the header, the rest
    cursor: traitlets.List = traitlets.List().tag(sync=True)  # [x, y low, y high] in fractions of the picture
    width = traitlets.Int().tag(sync=True)
    room = traitlets.Int().tag(sync=True)  # pixels that the page has for the figure: `width` or fewer
    clickable = traitlets.Bool(False).tag(sync=True)
    walkable = traitlets.Bool(False).tag(sync=True)
    pointed = traitlets.Dict().tag(sync=True)  # by a hand: {"x", "y"} in such fractions, "live", "count"
    touched = traitlets.Int(0).tag(sync=True)  # as of a Control

    def __init__(
        self,
        draw: Callable[[Figure, dict], None],
        caption: str,
        size: tuple[float, float] = (5.2, 3.2),
        on_click: Callable[[float, float], None] | None = None,
        on_step: Callable[[float, float], None] | None = None,
        cursor: Callable[[dict], ArrayLike] | None = None,
        key: Callable[[dict], Hashable] | None = None,
    ) -> None:
        self.draw, self.key, self.marks = draw, key, cursor
        self.on_click, self.on_step = on_click, on_step
        self._size = size
        self._figure: Figure | None = None
        self._shown: Hashable = None  # the key of what is drawn
        self.held = False  # by a hand that drags
        self._cost = 0.0  # seconds of the last drawing
        self._drawn_at = 0.0
        can = {"clickable": on_click is not None, "walkable": on_step is not None}
        width = round(96 * size[0])
        super().__init__(alt=caption, caption=caption, width=width, room=width, **can)

    def refresh(self, values: dict) -> None:
        """Draw the figure for these values where it shows something else, and place the marks."""
        with self.hold_sync():
            if self._is_old(values):
                begun = time.monotonic()
                self._draw(values)
                self._shown = self._key(values)
                self._drawn_at = time.monotonic()
                self._cost = self._drawn_at - begun
            self.cursor = self._placed(self.marks(values)) if self.marks else []

    def has_time(self, values: dict) -> bool:
        """While a slider is dragged: would a refresh leave most of the time to the robot?"""
        return not self._is_old(values) or time.monotonic() - self._drawn_at > 4 * self._cost

    def point_at(self, x: float, y: float, live: bool, count: int = 0) -> None:
        """A hand points at fractions (x, y) of the picture, from the lower left; `live`: it will go on."""
        inside = self._inside(np.array([x, y]) * self._extent())
        counts = self.held or np.all((inside >= 0) & (inside <= 1))
        self.held = bool(live and counts)
        if self.on_click and counts:
            axes = self._axes()
            on_edge = axes.transAxes.transform(np.clip(inside, 0, 1))  # where a drag has left the axes
            at = axes.transData.inverted().transform(on_edge)
            self.on_click(float(at[0]), float(at[1]))

    def __repr__(self) -> str:
        return f"Plot({self.alt})"

    # -- inside

    def _key(self, values):
        return (self.room, self.key(values)) if self.key else None

    def _is_old(self, values):
        return self._figure is None or self.key is None or self._key(values) != self._shown

    def _draw(self, values):
        from matplotlib import rc_context
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure

        wide, high = self.room / 96, self._size[1]
        lower = max(high * wide / self._size[0], min(high, LOW))  # letters take their share of the height
        written, nothing = io.StringIO(), dict.fromkeys(("Date", "Creator", "Format", "Type"))
        with rc_context(STYLE):
            self._figure = Figure(figsize=(wide, lower), layout="constrained")
            FigureCanvasSVG(self._figure)
            self.draw(self._figure, values)
            self._figure.savefig(written, format="svg", metadata=nothing)
        svg = re.sub(r"^.*?(?=<svg)|<style.*?</style>", "", written.getvalue(), flags=re.DOTALL)
        self.svg = re.sub(r" font-family: [^;\"]*;?", "", svg).replace(_INK, "currentColor")
        self.numbers = curves.table(self._figure)
        self.alt = curves.words(self._figure) or self.caption

    def _axes(self):
        return self._figure.axes[0]

    def _extent(self):
        return self._figure.bbox.size

    def _inside(self, pixels):
        """Pixels as fractions of the first axes; NaN where there are none."""
        found = self._figure and self._figure.axes
        return self._axes().transAxes.inverted().transform(pixels) if found else np.full(2, np.nan)

    def _placed(self, points):
        """[x, y low, y high] of each mark, in fractions of the picture."""
        placed = []
        for x, y in np.reshape(np.asarray(points, float), (-1, 2)):
            axes = self._axes()
            ends = axes.get_ylim() if np.isnan(y) else (y, y)
            pixels = axes.transData.transform([(x, end) for end in ends])
            if np.all(np.abs(self._inside(pixels) - 0.5) <= 0.5 + 1e-9):
                (left, low), (_, high) = pixels / self._extent()
                placed.append([float(left), float(low), float(high)])
        return placed


def decades(ax: Axes, powers: Sequence[int]) -> None:
    """Ticks of an upright log axis at these powers of ten, as text that any font sets, over whole steps."""
    raised = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
    ax.set_yticks([10.0**k for k in powers], [f"10{str(k).translate(raised)}" if k else "1" for k in powers])
    ax.minorticks_off()  # many ticks are slow to draw
    ax.locator_params(axis="x", integer=True)
