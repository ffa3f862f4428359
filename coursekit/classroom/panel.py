"""Below a failing check, in a notebook: the picture, and a button for each further level."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable


def offer(png: bytes, levels: dict[str, Callable[[], str]]) -> None:
    """Show a picture (b'' for none) and buttons that print a level's text; nothing outside of a notebook.

    levels : {what stands on the button: what makes the text}
    """
    shell = sys.modules.get("IPython") and sys.modules["IPython"].get_ipython()
    if shell is None or getattr(shell, "kernel", None) is None:
        return
    from IPython.display import Image, display

    if png:
        display(Image(png, alt="the right answer, solid, and yours, translucent"))
    with contextlib.suppress(ImportError):  # where there are no widgets, the text says what to call
        display(_buttons(levels))


def _buttons(levels: dict[str, Callable[[], str]]):
    from ipywidgets import Button, HBox, Output, VBox

    below = Output()

    def button(label: str, make: Callable[[], str]) -> Button:
        one = Button(description=label, tooltip=f"tell {label} about this check")

        def tell(_) -> None:
            below.clear_output(wait=True)
            with below:
                print(make())

        one.on_click(tell)
        return one

    return VBox([HBox([button(label, make) for label, make in levels.items()]), below])
