"""A scene as one HTML file: it turns and plays offline, without a kernel, a server or the network."""

import base64
import html
import json

from coursekit.view import meshcat
from coursekit.view.panel import Panel
from coursekit.view.viewer import STATIC, Viewer, script

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
html, body {{ margin: 0; height: 100%; }}
body {{ font-family: system-ui, sans-serif; background: #fff; color: #3c4654; }}
[data-jp-theme-light="false"] {{ background: #16181c; color: #d6dce4; }}
main {{ max-width: 1200px; margin: 0 auto; padding: 12px; }}
h1 {{ font-size: 17px; font-weight: 600; margin: 4px 0 10px; }}
{css}
</style>
</head>
<body>
<main><h1>{title}</h1><div id="view"></div><p>{description}</p></main>
<script type="module">
{script}

// --- stands in for the notebook's widget: the state is all here and nothing answers
const unpack = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const state = {state};
for (const name of {binary}) state[name] = unpack(state[name]);
for (const [key, text] of Object.entries(state.commands)) state.commands[key] = unpack(text);
const model = {{
  get: (name) => state[name], set: (name, value) => {{ state[name] = value; }},
  on() {{}}, off() {{}}, send() {{}}, save_changes() {{}},
}};
const dark = matchMedia("(prefers-color-scheme: dark)");
const follow = () => document.body.setAttribute("data-jp-theme-light", String(!dark.matches));
dark.addEventListener("change", follow);
follow();
state.height = Math.max(320, innerHeight - 190);
const widget = makeWidget();
widget.initialize({{ model }});
widget.render({{ model, el: document.getElementById("view") }});
receiveBundle(unpack("{bundle}"));
</script>
</body>
</html>
"""


def to_html(shown: Panel | Viewer) -> str:
    """A Panel or a Viewer as it stands now (its pose, its motion) as one page of about 400 KB: its text.

    >>> from coursekit import robots, view
    >>> panel = view.explore(robots.planar_2r())
    >>> view.to_html(panel)[:15]
    '<!DOCTYPE html>'
    >>> panel.close()
    """
    viewer = shown.viewer if isinstance(shown, Panel) else shown
    names = ("labels", "ghosts", "moving", "camera", "views", "description")
    state = {name: getattr(viewer, name) for name in names}
    state |= {"motion": viewer.motion, "motion_texts": viewer.motion_texts, "frame": viewer.frame}
    state |= {"quality": viewer.quality, "height": viewer.height}
    binary = {"pose": viewer.pose, "motion_poses": viewer.motion_poses}
    state |= {name: _base64(data) for name, data in binary.items()}
    state["commands"] = {key: _base64(data) for key, data in viewer.messages.packed.items()}
    return _PAGE.format(
        title=html.escape(viewer.scene.text().split(":")[0]),
        description=html.escape(viewer.scene.text()),
        css=(STATIC / "viewer.css").read_text(encoding="utf-8"),
        script=script().replace("export default function", "function makeWidget"),
        state=json.dumps(state).replace("</", "<\\/"),
        binary=json.dumps(list(binary)),
        bundle=_base64(meshcat.bundle()),
    )


def _base64(data):
    return base64.b64encode(data).decode("ascii")
