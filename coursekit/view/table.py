"""A table below the picture; a row is chosen by its button or, where there are some, by a figure."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import traitlets

from coursekit.view.controls import Control


class Table(Control):
    """A table of text below the picture; with `selectable` a row can be chosen, and its index is the value.

    `fill(values)` returns (header, rows): lists of text; format numbers by `coursekit.view.text`.
    `draw(values)` gives a small figure for each row, to choose by.
    """

    kind = traitlets.Unicode("table").tag(sync=True)
    value = traitlets.Int(-1).tag(sync=True)
    header: traitlets.List = traitlets.List().tag(sync=True)
    rows: traitlets.List = traitlets.List().tag(sync=True)
    selectable = traitlets.Bool(False).tag(sync=True)
    figures: traitlets.List = traitlets.List().tag(sync=True)  # {"lines", "name", "note", "word"} of each row

    def __init__(
        self,
        name: str,
        fill: Callable[[dict], tuple[Sequence, Sequence[Sequence]]],
        label: str | None = None,
        selectable: bool = False,
        start: int = -1,
        draw: Callable[[dict], list[dict]] | None = None,
    ) -> None:
        self.fill, self.draw = fill, draw
        self.initial = start
        super().__init__(name, label, selectable=selectable, value=start)

    def refresh(self, values: dict) -> None:
        header, rows = self.fill(values)
        with self.hold_sync():
            self.header = [str(cell) for cell in header]
            self.rows = [[str(cell) for cell in row] for row in rows]
            self.figures = self.draw(values) if self.draw else []

    def __repr__(self) -> str:
        return f"Table({self.name}: {len(self.rows)} rows)"
