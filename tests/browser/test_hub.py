"""The explorers behind a JupyterHub: a student who logs in through the proxy's one port sees the robot move.

The hub runs everyone as its own user, on one machine: enough to show that nothing in the viewer needs a
server, a port or an address of its own. It is no model for a real hub.
"""

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from coursekit import robots
from tests.browser.lab import Notebook, Server, free_port
from tests.needs import absent, needed

pytestmark = [pytest.mark.browser, pytest.mark.hub]

ROOT = Path(__file__).resolve().parents[2]
# where .ci/run puts it; else it is looked for on the PATH
PROXY = ROOT / ".venv" / "proxy" / "node_modules" / ".bin"
PASSWORD = "kinematics-2026"


class Hub(Server):
    """JupyterHub and its proxy on free ports, with everything they write inside `folder`."""

    def __init__(self, folder, proxy):
        port, hub_port, api_port = free_port(), free_port(), free_port()
        self.address = f"127.0.0.1:{port}"
        notebooks = shutil.copytree(ROOT / "notebooks", folder / "notebooks")
        (folder / "homes").mkdir()
        config = folder / "jupyterhub_config.py"
        config.write_text(
            f"""
c.JupyterHub.bind_url = "http://{self.address}"  # the only port that a browser gets to see
c.JupyterHub.hub_bind_url = "http://127.0.0.1:{hub_port}"
c.ConfigurableHTTPProxy.api_url = "http://127.0.0.1:{api_port}"
c.ConfigurableHTTPProxy.command = [{proxy!r}]
c.JupyterHub.authenticator_class = "shared-password"
c.SharedPasswordAuthenticator.user_password = "{PASSWORD}"
c.Authenticator.allow_all = True
c.JupyterHub.spawner_class = "simple"
c.SimpleLocalProcessSpawner.home_dir_template = {str(folder / "homes")!r} + "/{{username}}"
c.Spawner.cmd = [{sys.executable!r}, "-m", "jupyterhub.singleuser"]
c.Spawner.args = ["--allow-root", "--LabApp.expose_app_in_browser=True"]
c.Spawner.default_url = "/lab"
c.Spawner.notebook_dir = {str(notebooks)!r}
"""
        )
        # its data base, cookie secret and process numbers go to its folder
        command = [sys.executable, "-m", "jupyterhub", "-f", str(config)]
        super().__init__("hub", f"http://{self.address}/hub/login", command, folder)


class Account:
    """A user's own server behind the hub, as `Notebook` wants a server: an address and, here, no token."""

    token = ""

    def __init__(self, hub, user):
        self.url = f"http://{hub.address}/user/{user}"


@pytest.fixture(scope="module")
def hub(tmp_path_factory):
    needed("jupyterhub")
    proxy = shutil.which("configurable-http-proxy", path=os.pathsep.join([str(PROXY), os.environ["PATH"]]))
    if not proxy:
        absent("no configurable-http-proxy (npm install --prefix .venv/proxy configurable-http-proxy)")
    running = Hub(tmp_path_factory.mktemp("hub"), proxy)
    yield running
    running.close()


@pytest.fixture
def student(hub, browser):
    """A page logged in at the hub, which reaches the hub's one port and nothing else."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    elsewhere = []

    def inside(url):
        if not url.startswith((f"http://{hub.address}/", f"ws://{hub.address}/", "data:", "blob:")):
            elsewhere.append(url)
        return url not in elsewhere

    context.route("**/*", lambda route: route.continue_() if inside(route.request.url) else route.abort())
    page = context.new_page()
    page.on("websocket", lambda socket: inside(socket.url))
    page.goto(f"http://{hub.address}/hub/login")
    page.fill("#username_input", "anna")
    page.fill("#password_input", PASSWORD)
    page.click("#login_submit")
    page.wait_for_url("**/user/anna/lab**", timeout=60_000)
    notebook = Notebook(Account(hub, "anna"), page)
    notebook.elsewhere = elsewhere
    yield notebook
    context.close()


def test_slider_moves_the_robot_behind_a_hub(student):
    student.open("01_dh_vs_poe.ipynb")
    student.run_all()
    student.page.locator(".ck-viewer").first.scroll_into_view_if_needed()
    student.wait_view()
    before = student.pixels()

    handle = student.page.locator(".ck-range").first
    handle.focus()
    for _ in range(10):
        handle.press("ArrowRight")
    student.page.wait_for_function(
        "before => document.querySelector('.ck-viewer canvas').toDataURL() !== before", arg=before
    )
    student.rest()

    panels = "__import__('coursekit.view.cells', fromlist=['SHOWN']).SHOWN"
    theta = student.kernel(f"list(next(p for p in {panels} if 'theta' in p.values).values['theta'])")
    robot = robots.kuka_kr6()
    assert np.abs(np.array(theta) - robot.home).max() > 0.01, "the slider did not reach the kernel"
    seen = np.array(student.transform(f"/ck/robot/{robot.n}/tool"))
    np.testing.assert_allclose(seen, robot.fk(theta), rtol=0, atol=1e-12)
    assert student.errors == []
    assert student.elsewhere == [], "the page asked something other than the hub's own port"
