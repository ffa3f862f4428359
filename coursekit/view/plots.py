"""Plots beside the 3D view: a matplotlib figure drawn to a picture, with a caption that says what to see."""

from __future__ import annotations

import io
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import anywidget
import numpy as np
import traitlets

from coursekit.view import controls

INK, PAPER = "#d6dce4", "#1d2025"
DARK: Any = {  # of a page with a dark theme
    **dict.fromkeys(("figure.facecolor", "axes.facecolor", "savefig.facecolor", "legend.facecolor"), PAPER),
    **dict.fromkeys(("text.color", "axes.labelcolor", "xtick.color", "ytick.color", "axes.edgecolor"), INK),
}

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # else only where it is used: its import is slow


class Plot(anywidget.AnyWidget):
    """A matplotlib picture below the 3D view, drawn again when the values changed.

    Parameters
    ----------
    draw : function(figure, values) -> None
        Draws into an empty matplotlib Figure (`ax = figure.subplots()`).
    caption : str
        What to see, as a sentence; also the alternative text of the picture.
    size : (float, float)
        Inches.
    on_step : function(dx, dy), optional
        Called for the arrow keys, with whole steps or, with Shift, fifths of them: for those without a mouse.
    on_click : function(x, y), optional
        Called with the point of a click, in the data coordinates of the figure's first axes; clicks outside
        them do not count. What it sets with `Panel.set` draws the panel again.
    """

    _esm = controls.SCRIPT
    _css = controls.STATIC / "controls.css"
    kind = traitlets.Unicode("picture").tag(sync=True)
    png = traitlets.Bytes().tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    caption = traitlets.Unicode().tag(sync=True)
    width = traitlets.Int().tag(sync=True)
    clickable = traitlets.Bool(False).tag(sync=True)
    dark = traitlets.Bool(False).tag(sync=True)  # the page says it

    def __init__(
        self,
        draw: Callable[[Figure, dict], None],
        caption: str,
        size: tuple[float, float] = (5.2, 3.2),
        on_click: Callable[[float, float], None] | None = None,
        on_step: Callable[[float, float], None] | None = None,
    ) -> None:
        self.draw = draw
        self.on_click, self.on_step = on_click, on_step
        self._size = size
        self._figure: Figure | None = None
        self._cost = 0.0  # seconds of the last drawing
        self._drawn_at = 0.0
        super().__init__(
            alt=caption, caption=caption, width=round(96 * size[0]), clickable=on_click is not None
        )

    def refresh(self, values: dict) -> None:
        """Draw the figure for these values and send the picture."""
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        begun, picture = time.monotonic(), io.BytesIO()
        with rc_context(DARK if self.dark else {}):
            self._figure = Figure(figsize=self._size, dpi=144, layout="constrained")
            FigureCanvasAgg(self._figure)
            self.draw(self._figure, values)
            self._figure.savefig(picture, format="png", dpi=144)
        self.png = picture.getvalue()
        self._drawn_at = time.monotonic()
        self._cost = self._drawn_at - begun

    def has_time(self) -> bool:
        """While a slider is dragged: would drawing now leave most of the time to the robot?"""
        return time.monotonic() - self._drawn_at > 4 * self._cost

    def act_on(self, content: dict) -> None:
        """A click or an arrow key in the page."""
        if content["type"] == "step" and self.on_step is not None:
            self.on_step(content["dx"], content["dy"])
        elif content["type"] == "click" and self.on_click is not None:
            point = self.point(content["x"], content["y"])
            if point is not None:
                self.on_click(*point)

    def point(self, x: float, y: float) -> tuple[float, float] | None:
        """Data coordinates of a click at fractions (x, y) of the picture, or None outside the first axes."""
        if self._figure is None or not self._figure.axes:
            return None
        axes = self._figure.axes[0]
        pixel = np.array([x, y]) * self._figure.get_size_inches() * self._figure.dpi
        inside = axes.transAxes.inverted().transform(pixel)
        if not np.all((inside >= 0) & (inside <= 1)):
            return None
        at = axes.transData.inverted().transform(pixel)
        return float(at[0]), float(at[1])

    def __repr__(self) -> str:
        return f"Plot({self.caption})"
