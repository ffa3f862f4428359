"""Which cell of the notebook shows which panel: running a cell again closes what it showed before."""

import asyncio
import contextlib
import sys
from collections.abc import Callable
from typing import Any

SHOWN: dict[Any, tuple] = {}  # panel -> (name, cell, run of the cell)


def running() -> tuple[str | None, str | None]:
    """The notebook cell that runs now, and which of its runs this is; None where no notebook runs.

    Voila and nbconvert do not name the cell: then it is known by its code.
    """
    with contextlib.suppress(Exception):
        from IPython import get_ipython

        parent = get_ipython().kernel.get_parent()
        return parent["metadata"].get("cellId", parent["content"]["code"]), parent["header"]["msg_id"]
    return None, None


def afterwards(act: Callable[[], None]) -> None:
    """Do this once the cell that runs now has shown what it gives; at once where no cell runs."""
    from IPython import get_ipython

    shell = get_ipython() if running()[0] else None
    if shell is None:
        return act()

    def once(_result):
        shell.events.unregister("post_run_cell", once)
        act()

    shell.events.register("post_run_cell", once)


def when_idle(*acts: Callable[[], Any]) -> None:
    """Do these, one by one, once the cell that runs now is answered; never, where no kernel runs."""
    if "IPython" in sys.modules and sys.modules["IPython"].get_ipython():
        with contextlib.suppress(RuntimeError):  # a shell without an event loop
            for k, act in enumerate(acts, 1):  # what is asked of the kernel meanwhile comes in between
                asyncio.get_running_loop().call_later(0.1 * k, act)


def take_place(panel: Any) -> None:
    """Close the panels of this name that earlier runs of the cell have shown; this run may show several."""
    cell, run = running()
    for other, (name, its_cell, its_run) in list(SHOWN.items()):
        if (name, its_cell) == (panel.name, cell) and (cell is None or its_run != run):
            other.close()
    SHOWN[panel] = panel.name, cell, run
