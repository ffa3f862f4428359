"""A scene as one HTML file: it turns, plays and follows its sliders without a kernel or the network."""

import base64
import html
import json

from coursekit.view import controls, meshcat
from coursekit.view.panel import Panel
from coursekit.view.picture import png
from coursekit.view.viewer import STATIC, Viewer, script

_PAGE = (STATIC / "page.html").read_text(encoding="utf-8")
_OF_A_SLIDER = ("label", "word", "unit", "value", "min", "max", "step", "start", "limits", "digits", "wide")
_OF_A_VIEWER = (
    "labels",
    "ghosts",
    "moving",
    "camera",
    "views",
    "description",
    "quality",
    "height",
    "drive",
    "pointers",
)
_OF_A_FORMULA = ("kind", "label", "word", "value", "says")
_AND_ITS_MOTION = ("theta", "motion", "motion_texts", "frame")


def to_html(shown: Panel | Viewer) -> str:
    """A Panel or a Viewer as it stands now (pose, motion, joint sliders, formula) as one page of about 1 MB.

    What only a kernel can compute is not shown for a pose that the sliders of the page have changed. Without
    WebGL the page shows a picture.

    >>> from coursekit import robots, view
    >>> panel = view.explore(robots.planar_2r())
    >>> view.to_html(panel)[:15]
    '<!DOCTYPE html>'
    >>> panel.close()
    """
    viewer = shown.viewer if isinstance(shown, Panel) else shown
    state = {name: getattr(viewer, name) for name in (*_OF_A_VIEWER, *_AND_ITS_MOTION)}
    binary = {"pose": viewer.pose, "motion_poses": viewer.motion_poses}
    state |= {name: _base64(data) for name, data in binary.items()}
    state["commands"] = {key: _base64(data) for key, data in viewer.messages.packed.items()}
    sliders: dict[str, dict] = {}
    formula: dict | None = None
    if isinstance(shown, Panel):
        sliders = {s.model_id: _state(s) for s in shown.drivers() if s is not None}
        state["computed"] = shown.computed
        for shown_formula in shown.formula:
            formula = {name: getattr(shown_formula, name) for name in _OF_A_FORMULA}
        state["motion_theta"] = shown.motion.thetas.tolist() if shown.motion and sliders else None
    style = [(STATIC / name).read_text(encoding="utf-8") for name in ("viewer.css", "controls.css")]
    line = viewer.scene.text()
    parts = {
        "title": html.escape(line.split(":")[0]),
        "description": html.escape(line),
        "style": "\n".join(style),
        "viewer": script().replace("export default function", "function makeWidget"),
        "controls": controls.SCRIPT.replace("export default", "globalThis.coursekitControls ="),
        "state": json.dumps({"viewer": state, "sliders": sliders, "formula": formula}).replace("</", "<\\/"),
        "picture": _base64(png(viewer.scene, 640, viewer.height)),
        "bundle": _base64(meshcat.bundle()),
        "notices": meshcat.notices().replace("--", "- -"),  # inside a comment
    }
    page = _PAGE
    for name, text in parts.items():
        page = page.replace(f"@{name}@", text)
    return page


def _state(slider):
    untouched = {"kind": "slider", "shape": 0, "touched": 0}
    return untouched | {name: getattr(slider, name) for name in _OF_A_SLIDER}


def _base64(data):
    return base64.b64encode(data).decode("ascii")
