"""The page's side of all widgets: one script, one style sheet and meshcat's bundle, which a page gets once.

A browser never lets go of a module, and anywidget makes one of each widget's own script: these are a few
lines (static/stub.js), which wait for what the widget `Script` brings.
"""

import hashlib
from pathlib import Path

import anywidget
import ipywidgets
import traitlets

from coursekit.view import meshcat

STATIC = Path(__file__).parent / "static"
OF_A_PAGE = ["html", "numbers", "parts", "controls", "bundle", "stage", "actors", "player"]
OF_A_PAGE += ["kinematics", "follow", "handles", "point", "viewer"]
SCRIPTS = [*OF_A_PAGE, "shared"]  # widgets of a notebook share it


def read(*names: str) -> str:
    """Files of `static/`, joined; as text, since anywidget would watch a path, and so hold every widget."""
    return "\n".join((STATIC / name).read_text("utf-8") for name in names)


SCRIPT = read(*(f"{name}.js" for name in SCRIPTS))
KEY = f"coursekit.{hashlib.sha256(SCRIPT.encode()).hexdigest()}"  # a page may have kernels of two versions


class Script(anywidget.AnyWidget):
    """What brings script, style sheet and bundle to the page: never as state, which is stored."""

    _esm = SCRIPT.replace("@key@", KEY)
    _css = read("viewer.css", "controls.css")

    def __init__(self) -> None:
        super().__init__()
        self.on_msg(self._send_bundle)
        self._send_bundle()  # at once: the page must not wait until a busy kernel answers

    def _send_bundle(self, *_asked):
        self.send({"type": "bundle"}, buffers=[meshcat.bundle()])


class Widget(anywidget.AnyWidget):
    """A widget of the course: its own script waits for the page's, and asks it for what is of its `kind`."""

    _esm = read("stub.js").replace("@key@", KEY)
    kind = traitlets.Unicode().tag(sync=True)
    script = traitlets.Instance(Script).tag(sync=True, **ipywidgets.widget_serialization)
    _brought: Script | None = None

    @traitlets.default("script")
    def _bring(self):
        if Widget._brought is None or Widget._brought.comm is None:  # the first; or all were closed
            Widget._brought = Script()
        return Widget._brought
