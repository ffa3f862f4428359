"""Where the parts of a panel stand: controls beside the picture, plots and tables under it.

How much room there is decides static/controls.css: where it is narrow, the picture stands above its controls,
which then scroll by themselves, so that both are in sight.
"""

from collections.abc import Sequence

import ipywidgets

from coursekit.view.controls import Action, Choice, Control, Slider, Sliders, Toggle
from coursekit.view.viewer import Viewer


def column(controls: Sequence[Control | Sliders], reset: Action) -> ipywidgets.Widget:
    """The controls, one under the other; switches and buttons in rows, at the end."""
    rows: list[ipywidgets.Widget] = []
    switches: list[ipywidgets.Widget] = []
    for control in controls:
        if isinstance(control, Sliders):
            if control.in_picture:
                continue
            if control.folded:  # under a title that unfolds them
                rows.append(ipywidgets.Accordion([ipywidgets.VBox(control.sliders)], titles=[control.folded]))
            else:
                rows += control.sliders
            rows += [ipywidgets.HTML(control.legend)] if control.legend else []
        else:
            (switches if isinstance(control, Toggle | Action) else rows).append(control)
    for switch in (*switches, reset):
        switch.layout.width = "auto"
    for kind in (Slider, Choice):  # what stands beside their labels begins and ends below each other
        alike = [row for row in _all(rows) if isinstance(row, kind)]
        for row in alike:
            row.wide = max(len(other.label) for other in alike)
    flow = _flow("2px 14px", width="100%", align_items="stretch")
    return ipywidgets.VBox([*rows, ipywidgets.Box([*switches, reset], layout=flow)]).add_class("ck-column")


def around(
    column: ipywidgets.Widget | None,
    viewer: Viewer,
    words: Sequence[ipywidgets.Widget],
    outputs: Sequence[ipywidgets.Widget],
) -> list[ipywidgets.Widget]:
    """Controls and, where they leave room, words beside the picture; one plot under it, several in a row."""
    for output in outputs:
        output.layout.width = "auto"
    row = [ipywidgets.Box(list(outputs), layout=_flow("18px")).add_class("ck-under")] if outputs else []
    near, far = (row, []) if len(outputs) == 1 else ([], row)
    seen = viewer.add_class("ck-scene")
    top = ipywidgets.Box([*([column] if column else []), seen, *near, *words]).add_class("ck-top")
    return [top, *far]


def close(widget: ipywidgets.Widget) -> None:
    """Close a widget and all that stands in it, with their layouts and styles."""
    for child in getattr(widget, "children", ()):
        close(child)
    for attribute in ("layout", "style"):
        if widget.has_trait(attribute):
            getattr(widget, attribute).close()
    ipywidgets.Widget.close(widget)


def _all(widgets):
    """Widgets and those that stand in them."""
    for widget in widgets:
        yield widget
        yield from _all(getattr(widget, "children", ()))


def _flow(gap, **more):
    return ipywidgets.Layout(
        **{"display": "flex", "flex_flow": "row wrap", "align_items": "flex-start", "grid_gap": gap, **more}
    )
