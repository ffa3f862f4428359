"""A scene as one HTML file: it turns, plays and follows its sliders without a kernel or the network."""

import base64
import gzip
import html
import json

from coursekit.view import meshcat, script
from coursekit.view.panel import Panel
from coursekit.view.picture import png
from coursekit.view.viewer import Viewer

_OF_A_SLIDER = ["kind", "label", "word", "unit", "value", "min", "max", "step", "start", "limits", "digits"]
_OF_A_SLIDER += ["wide", "shape", "touched"]
_OF_A_VIEWER = ["labels", "ghosts", "moving", "camera", "views", "description", "quality", "height", "drive"]
_OF_A_VIEWER += ["pointers", "theta", "motion", "motion_texts", "frame", "reaching"]
_OF_A_FORMULA = ["kind", "label", "word", "value", "says"]


def to_html(shown: Panel | Viewer, common: str = "") -> str:
    """A Panel or a Viewer as it stands now (pose, motion, sliders that move arms, formula): a page, 0.6 MB.

    What only a kernel can compute is not shown for a pose that the sliders of the page have changed. Without
    WebGL the page shows a picture.

    common : address of a file with `view.page.common_script()`, seen from the page: many pages that share it
        weigh 0.2 MB each. By default the page holds it.

    >>> from coursekit import robots, view
    >>> panel = view.explore(robots.planar_2r())
    >>> view.to_html(panel)[:15]
    '<!DOCTYPE html>'
    >>> panel.close()
    """
    viewer = shown.viewer if isinstance(shown, Panel) else shown
    state = _of(viewer, _OF_A_VIEWER)
    state |= {name: _base64(getattr(viewer, name)) for name in ("pose", "motion_poses")}
    state["handles"] = [one for one in viewer.handles if one["path"] == viewer.reaching.get("goal")]
    state["commands"] = {key: _base64(data) for key, data in viewer.messages.packed.items()}
    sliders: dict[str, dict] = {}
    formula: dict | None = None
    if isinstance(shown, Panel):
        sliders = {s.model_id: _of(s, _OF_A_SLIDER) for s in shown.drivers() if s is not None}
        state["computed"] = shown.computed
        for shown_formula in shown.formula:
            formula = _of(shown_formula, _OF_A_FORMULA)
        state["motion_theta"] = shown.motion.thetas.tolist() if shown.motion and sliders else None
    line = viewer.scene.text()
    parts = {
        "title": html.escape(line.split(":")[0]),
        "description": html.escape(line),
        "style": script.Script._css,
        "common": f'<script src="{common}"></script>' if common else f"<script>{common_script()}</script>",
        "state": _packed({"viewer": state, "sliders": sliders, "formula": formula}),
        "picture": _base64(png(viewer.scene, 640, viewer.height)),
    }
    page = script.read("page.html")
    for name, text in parts.items():
        page = page.replace(f"@{name}@", text)
    return page


def common_script() -> str:
    """What is the same in all pages: the script that moves them, and meshcat's bundle with its licences."""
    notices = meshcat.notices().replace("*/", "* /")  # inside a comment
    plain = script.read(*(f"{name}.js" for name in script.OF_A_PAGE))
    plain = plain.replace("\nexport function", "\nfunction")  # a page in a folder may load no module
    return f"""/* This script contains meshcat and the libraries in its bundle:

{notices}
*/
{plain}
const BUNDLE = "{_base64(meshcat.bundle())}";
"""


def _packed(state):
    return _base64(gzip.compress(json.dumps(state).encode(), mtime=0))


def _of(widget, names):
    return {name: getattr(widget, name) for name in names}


def _base64(data):
    return base64.b64encode(data).decode("ascii")
