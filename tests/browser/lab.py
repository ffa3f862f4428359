"""A private JupyterLab and a headless Chromium, for tests that look at what a student sees."""

import contextlib
import json
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.request

import nbformat
import numpy as np

from coursekit.classroom.lab import private_folders

# Two pages of the address bar, which every new window would load (0.8 s of the processor each time); and what
# Playwright switches off, whose own list this one replaces.
_OFF = (
    *("WebUIOmniboxPopup", "WebUIOmniboxAimPopup", "WebUIOmniboxFullPopup"),
    *("AvoidUnnecessaryBeforeUnloadCheckSync", "DestroyProfileOnBrowserClose", "HttpsUpgrades"),
    *("HttpsFirstBalancedModeAutoEnable", "LensOverlay", "MediaRouter", "PaintHolding"),
    *("ThirdPartyStoragePartitioning", "AvoidCorsURLLoaderRestartOnRedirect", "OptimizationHints"),
    *("NetworkTimeServiceQuerying", "AimEnabled", "PreconnectToSearch"),
)
# WebGL without a graphics processor, and nothing that calls home.
CHROMIUM_FLAGS = (
    "--no-sandbox",
    f"--disable-features={','.join(_OFF)}",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
# What JupyterLab itself says in the console, whatever is open.
LABS_OWN = ("favicon", "the server responded with a status of 404", "WebGL: CONTEXT_LOST_WEBGL", "GPU stall")


def chromium():
    """Path of the Chromium to drive, or None."""
    names = ("chromium", "chromium-browser", "google-chrome")
    return os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, names)), None)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Server:
    """A process that answers at `url`, and all that it starts; what it says goes to a log in `folder`."""

    def __init__(self, name, url, command, folder, environment=None):
        self.path = folder / f"{name}.log"
        self.log = self.path.open("w")
        self.process = subprocess.Popen(
            command,
            cwd=folder,
            env={**os.environ, **(environment or {})},
            stdout=self.log,
            stderr=self.log,
            start_new_session=True,
        )
        try:
            self._wait(url, 60)
        except BaseException:
            self.close()
            raise

    def _wait(self, url, seconds):
        until = time.monotonic() + seconds
        while time.monotonic() < until and self.process.poll() is None:
            with contextlib.suppress(OSError):
                urllib.request.urlopen(url, timeout=2).close()
                return
            time.sleep(0.2)
        raise RuntimeError(f"no answer from {url} in {seconds} s:\n{self.path.read_text()[-2000:]}")

    def close(self):
        """End it, and what it started: with one signal, a second one cuts a hub's cleaning up short."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(20)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.log.close()


class Lab(Server):
    """JupyterLab on a free port, with every directory it writes to inside `folder`."""

    def __init__(self, folder):
        self.notebooks = folder / "notebooks"
        self.notebooks.mkdir()
        port, self.token = free_port(), secrets.token_hex(16)
        self.url = f"http://127.0.0.1:{port}"
        environment = {**private_folders(folder), "PYTHONDONTWRITEBYTECODE": "1"}
        for name in ("JUPYTERLAB_SETTINGS_DIR", "JUPYTERLAB_WORKSPACES_DIR"):
            environment[name] = str(folder / name.lower())
        command = [
            sys.executable,
            "-m",
            "jupyterlab",
            "--no-browser",
            "--allow-root",
            "--ServerApp.ip=127.0.0.1",
        ]
        command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
        command += [f"--ServerApp.root_dir={self.notebooks}", f"--IdentityProvider.token={self.token}"]
        command += [f"--{app}.expose_app_in_browser=True" for app in ("LabApp", "JupyterNotebookApp")]
        super().__init__("lab", f"{self.url}/api/status?token={self.token}", command, folder, environment)

    def write(self, name, *cells):
        """A notebook of code cells in the folder that JupyterLab shows."""
        notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in cells])
        notebook.metadata["kernelspec"] = {
            "name": "python3",
            "display_name": "Python 3",
            "language": "python",
        }
        nbformat.write(notebook, self.notebooks / name)
        return name


class Notebook:
    """A notebook open in the browser: what a person does to it, and what they would see."""

    def __init__(self, lab, page):
        self.lab, self.page, self.errors = lab, page, []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def _console(self, message):
        where = (message.location or {}).get("url", "")
        said = f"{message.text} {where}"
        if message.type == "error" and not any(own in said for own in LABS_OWN):
            self.errors.append(said)

    def open(self, name, where="lab/tree"):
        url = f"{self.lab.url}/{where}/{name}?token={self.lab.token}&reset"
        self.page.goto(url, wait_until="domcontentloaded")
        self._ready()
        return self

    def save(self):
        """Save the notebook and wait until it is on the disk."""
        self.command("docmanager:save")
        saved = "() => !window.jupyterapp.shell.currentWidget.context.model.dirty"
        self.page.wait_for_function(saved, timeout=30_000)
        self.page.wait_for_timeout(1000)

    def reload(self):
        self.page.reload(wait_until="domcontentloaded")
        self._ready()

    def _ready(self):
        # On a busy machine JupyterLab gives the focus to a notebook that WebKit has not laid out yet: it gets
        # none, and is nobody's current one. A person would click on it.
        self.page.wait_for_function(
            """() => {
                 const { shell } = window.jupyterapp || {};
                 if (!shell) return false;
                 const opened = [shell.currentWidget, ...shell.widgets("main")].find((one) => one?.context);
                 if (opened && opened !== shell.currentWidget) shell.activateById(opened.id);
                 return opened && opened === shell.currentWidget && opened.context.isReady;
               }""",
            timeout=60_000,
        )
        self.idle()

    def idle(self, seconds=60):
        """Wait until the kernel has nothing to do."""
        self.page.wait_for_function(
            """() => { const s = window.jupyterapp.shell.currentWidget.context.sessionContext;
                       return s.session && s.session.kernel && s.session.kernel.status === "idle"; }""",
            timeout=1000 * seconds,
        )

    def command(self, name, **arguments):
        self.page.evaluate(
            "([name, args]) => window.jupyterapp.commands.execute(name, args)", [name, arguments]
        )

    def run_all(self):
        # without waiting for its promise, which WebKit's driver may lose meanwhile
        self.page.evaluate("() => void window.jupyterapp.commands.execute('notebook:run-all-cells')")
        self.page.wait_for_function(
            """() => { const n = window.jupyterapp.shell.currentWidget.content;
                       return n.widgets.every((c) => c.model.type !== "code" || c.model.executionCount
                                                     || !c.model.sharedModel.getSource().trim()); }""",
            timeout=90_000,
        )
        self.idle()

    def run_cell(self, index):
        self.page.evaluate(
            """(index) => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = index;
                            return window.jupyterapp.commands.execute("notebook:run-cell"); }""",
            index,
        )

    def kernel(self, expression):
        """The value of a Python expression in the notebook's kernel (through JSON)."""
        code = f"import json as _json; print(_json.dumps({expression}))"
        printed = self.page.evaluate(
            """async (code) => {
                 const kernel = window.jupyterapp.shell.currentWidget.context.sessionContext.session.kernel;
                 const future = kernel.requestExecute({ code, store_history: false, silent: false });
                 let text = "", error = "";
                 future.onIOPub = (m) => {
                   if (m.header.msg_type === "stream") text += m.content.text;
                   if (m.header.msg_type === "error") error = m.content.evalue;
                 };
                 await future.done;
                 return error ? { error } : { text };
               }""",
            code,
        )
        if "error" in printed:
            raise RuntimeError(printed["error"])
        return json.loads(printed["text"])

    def wait_view(self, count=1):
        """Wait until `count` 3D views have drawn something and rest."""
        drawn = """(count) => {
            const v = [...document.querySelectorAll(".ck-viewer")].filter((b) => b.coursekit);
            return v.length >= count && v.every((b) => b.coursekit.stage.frames > 0);
        }"""
        try:
            self.page.wait_for_function(drawn, arg=count, timeout=90_000)
        except Exception as error:
            raise AssertionError(f"no 3D view after 90 s; {self.state()}") from error
        self.rest()

    def state(self):
        """What the page shows, for the message of a failure."""
        return (
            self.page.evaluate(
                """() => {
                 const views = [...document.querySelectorAll(".ck-viewer")].map((b) =>
                   [b.isConnected, b.clientWidth, b.clientHeight, b.coursekit?.stage.frames, b.innerText]);
                 const { asked, evaluated, busy } = globalThis[Symbol.for("coursekit.page.1")] || {};
                 const cells = window.jupyterapp?.shell.currentWidget?.content?.widgets || [];
                 const outputs = cells.flatMap((c) => (c.model.outputs ? c.model.outputs.toJSON() : []));
                 return JSON.stringify({ views, asked, evaluated, busy }) + "\\n"
                        + outputs.map((o) => o.evalue || JSON.stringify(o).slice(0, 300)).join("\\n");
               }"""
            )
            + f"\nconsole: {self.errors}"
        )

    def wait_transform(self, path, expected, view=0):
        """Wait until a path stands where it should, to 1e-9; give where it stands, for a sharper look."""
        for _ in range(100):
            found = np.array(self.transform(path, view))
            if np.allclose(found, expected, rtol=0, atol=1e-9):
                break
            self.page.wait_for_timeout(200)
        return found

    def settle(self):
        """Wait until the kernel has the last slider value and the page its pose."""
        self.page.wait_for_timeout(200)
        # A question that comes after what was sent, and one after what was held back until that was answered:
        # a kernel that has not begun yet says "idle", too.
        self.page.evaluate(
            """async () => {
                 const { kernel } = window.jupyterapp.shell.currentWidget.context.sessionContext.session;
                 for (let i = 0; i < 2; i += 1) await kernel.requestKernelInfo();
               }"""
        )
        self.idle()
        self.rest()

    def rest(self):
        """Wait until no view has drawn for half a second and ten frames of the page, which may be slow."""
        self.page.evaluate(
            """async () => {
                 const views = () => [...document.querySelectorAll(".ck-viewer")];
                 const frames = () => views().map((b) => b.coursekit?.stage.frames).join();
                 for (let last = null, i = 0; last !== frames() && i < 60; i += 1) {
                   last = frames();
                   const half = new Promise((done) => setTimeout(done, 500));
                   for (let k = 0; k < 10; k += 1) await new Promise(requestAnimationFrame);
                   await half;
                 }
               }"""
        )

    def frames(self, view=0):
        return self.page.evaluate(
            "(i) => document.querySelectorAll('.ck-viewer')[i].coursekit.stage.frames", view
        )

    def transform(self, path, view=0):
        """The 4 x 4 transform of a path of the scene graph in the page, in the world (z up), row by row."""
        return self.page.evaluate(
            """([i, path]) => {
                 const { viewer, page } = document.querySelectorAll(".ck-viewer")[i].coursekit;
                 const object = viewer.scene_tree.find(path.split("/").filter((s) => s)).object;
                 object.updateWorldMatrix(true, false);
                 const M = new page.MeshCat.THREE.Matrix4();
                 M.copy(viewer.scene.matrixWorld).invert().multiply(object.matrixWorld);
                 return [0, 1, 2, 3].map((r) => [0, 1, 2, 3].map((c) => M.elements[4 * c + r]));
               }""",
            [view, path],
        )

    def pixels(self, view=0):
        """The canvas of a view as a data URL."""
        return self.page.evaluate(
            "(i) => document.querySelectorAll('.ck-viewer canvas')[i].toDataURL()", view
        )

    def screenshot(self, path):
        self.page.screenshot(path=str(path))
