"""A matplotlib figure in numbers and in words: for a table beside it, and for those who do not see it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from coursekit.view.text import NOTHING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROWS = 12  # of a table, at most


def table(figure: Figure) -> list[list[str]]:
    """Title, header and rows of the curves that have a label, at twelve places or fewer; [] without any.

    The places are chosen evenly of all that the curves have; where one has no value stands "-".
    """
    found = list(_curves(figure))
    if not found:
        return []
    places = np.unique(np.concatenate([x for _, _, x, _ in found]))
    places = places[np.unique(np.linspace(0, len(places) - 1, ROWS).round().astype(int))]
    at = [dict(zip(x, y, strict=True)) for _, _, x, y in found]
    rows = [[f"{x:.4g}", *(_number(known.get(x, np.nan)) for known in at)] for x in places]
    ax = found[0][0]
    return [[ax.get_ylabel()], [ax.get_xlabel(), *(name for _, name, *_ in found)], *rows]


def words(figure: Figure) -> str:
    """What the axes are, and of each labelled curve its ends and extremes, else what is written there."""
    told = [line for ax in figure.axes for line in _axes(ax)]
    named = [
        f"{name}: from {_number(y[0])} to {_number(y[-1])}, lowest {_number(np.nanmin(y))}, "
        f"highest {_number(np.nanmax(y))}."
        for _, name, _, y in _curves(figure)
    ]
    written = [re.sub(r"[${}\\]", "", note.get_text()) for ax in figure.axes for note in ax.texts]
    noted = ", ".join(dict.fromkeys(filter(None, written)))
    return " ".join([*told, *(named or ([f"Written there: {noted}."] if noted else []))])


def _axes(ax: Axes) -> Iterator[str]:
    if ax.get_title():
        yield f"{ax.get_title()}."
    ranges = []
    for letter in "zyx" if hasattr(ax, "get_zlim") else "yx":
        low, high = getattr(ax, f"get_{letter}lim")()
        ranges.append(f"{getattr(ax, f'get_{letter}label')() or letter}, {low:.4g} to {high:.4g}")
    yield ", over ".join(ranges) + "."


def _curves(figure: Figure) -> Iterator[tuple[Axes, str, np.ndarray, np.ndarray]]:
    """(axes, name, x, y) of every curve that has a label, those in space apart."""
    for ax in figure.axes:
        for line in [] if hasattr(ax, "get_zlim") else ax.lines:
            name, (x, y) = str(line.get_label()), np.array(line.get_data(), float)
            if not name.startswith("_") and len(x) > 1:
                if ax.get_yscale() == "linear":  # what is 0 but for rounding
                    y = np.where(np.abs(y) < 1e-9 * np.abs(ax.get_ylim()).max(), 0, y)
                yield ax, name, x, y


def _number(value: float) -> str:
    return NOTHING if np.isnan(value) else f"{value:.4g}"
