"""What a person looks at: explorers, the 3D viewer and the pictures that stand in for it.

One line of a notebook opens an explorer:

    from coursekit import robots, view
    view.explore(robots.kuka_kr6())

The way of theta from slider to pixel. A hand moves a slider, and in the next frame the page moves the arm, by
the screws it has (static/follow.js), or all arms that are at a target (static/handles.js). The slider's value
goes to the kernel, where the Panel reads all values once and hands them to the explorer. The explorer moves
the handles of its Scene, which is data and knows of no browser. The Viewer sends what has changed: commands
made by meshcat.py, and the pose of all that moves. The page draws the kernel's pose as soon as that speaks of
the same sliders; and in a motion, where the page says which configuration it shows, the Panel puts the
sliders there, and all goes the same way.

Everything here is imported when it is first used: `from coursekit import view` alone loads no widget code. In
a notebook that comes ahead of its use, while one reads on.
"""

import contextlib
import functools
import logging
from typing import Any

from .. import _module
from . import cells

# On its first day on a machine matplotlib warns that it builds a font cache: nothing for a student to read.
logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)

_WHERE = {
    "explore": "explorers.conventions",
    "explore_screws": "explorers.screws",
    "explore_inverse": "explorers.inverse",
    "explore_singularities": "explorers.singularities",
    "explore_jacobians": "explorers.jacobians",
    "explore_path": "explorers.path",
    "Panel": "panel",
    "Viewer": "viewer",
    "Scene": "scene",
    "Slider": "controls",
    "Sliders": "controls",
    "JointSlider": "controls",
    "joint_sliders": "controls",
    "Choice": "controls",
    "Toggle": "controls",
    "Action": "controls",
    "Plot": "plots",
    "png": "picture",
    "to_html": "page",
    "Table": "table",
}
_MODULES = ("controls", "meshcat", "page", "panel", "picture", "plots", "reopened", "scene", "text", "viewer")

__all__ = sorted([*_WHERE, *_MODULES])


def __getattr__(name: str) -> Any:
    if name in _WHERE:
        return getattr(_module(f"coursekit.view.{_WHERE[name]}", extra="view"), name)
    if name in _MODULES:
        return _module(f"coursekit.view.{name}", extra="view")
    raise AttributeError(f"coursekit.view has no {name!r}; it has: {', '.join(__all__)}")


def __dir__() -> list[str]:
    return __all__


def _load_ahead(name: str) -> None:
    with contextlib.suppress(ImportError):  # told where it is used
        _module(name, extra="view")


# Half of what a first explorer would wait for its kernel: widgets, and what plots are drawn with.
_SLOW = "coursekit.view.explorers", "matplotlib.figure", "matplotlib.backends.backend_svg"
cells.when_idle(*(functools.partial(_load_ahead, name) for name in _SLOW))
