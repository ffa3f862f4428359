"""Explorers of a saved notebook, where no kernel has them: from the stored line of text to a page that moves.

A notebook stores a picture and one line of an explorer, and nothing else: "Explorer of screws: KUKA KR6 R900
sixx: joints (...) deg; tool at ...". The line names the explorer, the arm and its pose, so the page can be
made again: by the server for JupyterLab (its part there is static/lab), by nbconvert for

    jupyter nbconvert --to coursekit notebooks/01_dh_vs_poe.ipynb
"""

import asyncio
import functools
import html
import re
import threading
from typing import Any

import numpy as np
from jupyter_server.base.handlers import JupyterHandler
from jupyter_server.utils import url_path_join
from nbconvert.exporters import HTMLExporter
from nbformat import NotebookNode
from tornado import web

from coursekit.kinematics import rotations

EXPLORERS = {  # title -> function of coursekit.view
    "Explorer of DH and PoE": "explore",
    "Explorer of screws": "explore_screws",
    "Explorer of inverse kinematics": "explore_inverse",
    "Explorer of singularities": "explore_singularities",
    "Explorer of Jacobian methods": "explore_jacobians",
    "Explorer of the path": "explore_path",
}
_LINE = re.compile(r"(?P<title>Explorer of [^:]+): (?P<name>[^:]+): joints \((?P<joints>[^()]*)\)")
_FITS = """<script>{
  const frame = document.currentScript.previousElementSibling;
  addEventListener("message", ({ data, source }) => { // the page says how high it is
    if (source !== frame.contentWindow || data?.coursekit !== "height") return;
    frame.style.height = `${data.height}px`;
  });
}</script>"""
HINT = (
    "Sliders, or the buttons under the picture, move the arm here. The rest needs Python: run the notebook."
)
_ONE_AT_A_TIME = threading.Lock()  # a new explorer closes the one of its name, as when a cell is run again


@functools.lru_cache(maxsize=32)
def page_of(line: str, common: str = "") -> str | None:
    """The page of the explorer that stored this line; None for a line of anything else, or of an own arm.

    common : as of `view.to_html`

    >>> page_of("Explorer of screws: my arm: joints (0.0) deg; tool at (0.0, 0.0, 0.0) mm") is None
    True
    """
    from coursekit import robots, view
    from coursekit.view.chain import shown_per_si

    found = _LINE.match(line)
    if found is None or found["title"] not in EXPLORERS:
        return None
    robot = {arm.name: arm for arm in robots.all().values()}.get(found["name"])
    if robot is None:
        return None
    shown = np.array([float(number) for number in re.findall(r"-?\d+\.\d+", found["joints"])])
    with _ONE_AT_A_TIME:
        panel = getattr(view, EXPLORERS[found["title"]])(robot)
        try:
            if repr(panel) != line and shown.shape == (robot.n,):
                _put(panel, robot, shown / shown_per_si(robot))
            return view.to_html(panel, common)
        finally:
            panel.close()


def _put(panel, robot, theta):
    """The arm where it was, as nearly as the line says it: by its joints, its target or its motion."""
    if "theta" in panel.values:
        panel.set(theta=np.clip(theta, robot.q_min, robot.q_max))
    elif "pose" in panel.values:
        T = robot.fk(theta)
        panel.set(pose=[*T[:3, 3], *rotations.zyx(T[:3, :3])])
        ways = {name: arm.theta for name, arm in panel.scene.robots.items() if arm.goal}
        shown = min(ways, key=lambda name: np.abs(np.sin((ways[name] - theta) / 2)).max())
        if shown != "robot":  # another solution than the one that the explorer would choose
            panel.set(solution=int(shown.removeprefix("branch")))
    elif panel.motion is not None:
        away = np.abs(panel.motion.thetas - theta).max(axis=1)
        panel.rest_at(int(away.argmin()))


# -- for JupyterLab


class Page(JupyterHandler):
    """GET coursekit/explorer?line=...: the page of that line."""

    @web.authenticated
    async def get(self) -> None:
        page = await asyncio.to_thread(page_of, self.get_argument("line"))
        if page is None:
            raise web.HTTPError(404, "no explorer of the course stored this line")
        self.finish(page)


def _jupyter_server_extension_points() -> list[dict[str, str]]:
    return [{"module": "coursekit.view.reopened"}]


def _load_jupyter_server_extension(server: Any) -> None:
    address = url_path_join(server.web_app.settings["base_url"], "coursekit", "explorer")
    server.web_app.add_handlers(".*", [(address, Page)])


# -- for nbconvert


class Exporter(HTMLExporter):
    """HTML in which the explorers move."""

    export_from_notebook = "HTML with explorers that move"

    def from_notebook_node(
        self, nb: NotebookNode, resources: dict | None = None, **more: Any
    ) -> tuple[Any, dict]:
        """As every exporter: the page, and nbconvert's resources."""
        nb = NotebookNode(nb)
        for cell in nb.cells:
            for output in cell.get("outputs", []):
                page = page_of(output.get("data", {}).get("text/plain", ""))
                said = output.get("metadata", {}).get("image/png", {}).get("alt")
                if page is not None:
                    output.data["text/html"] = _frame(page)
                elif said:  # nbconvert's own template leaves it out
                    source = f"data:image/png;base64,{output.data['image/png']}"
                    output.data["text/html"] = f'<img alt="{html.escape(said)}" src="{source}">'
        return super().from_notebook_node(nb, resources, **more)


def _frame(page):
    style = "width: 100%; height: 600px; border: 0"
    return (
        f'<iframe srcdoc="{html.escape(page)}" style="{style}" loading="lazy"></iframe>{_FITS}<p>{HINT}</p>'
    )
