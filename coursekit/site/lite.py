"""JupyterLab with Python in the browser: JupyterLite, Pyodide's files and the students' notebooks."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from importlib import util
from pathlib import Path

from . import compiled, tools, wheels

# JupyterLab's parts that the explorers need, as this environment has them; by the course's own a saved
# explorer stays a picture here, as no server makes a page of it.
_EXTENSIONS = (
    "@jupyter-widgets/jupyterlab-manager",
    "@jupyterlite/pyodide-kernel-extension",
    "anywidget",
    "coursekit",
)
_KERNEL = "@jupyterlite/pyodide-kernel-extension"
# What is loaded before JupyterLab opens; the rest of it comes, and is kept, when it is used. The page's own
# scripts come before the worker stands: only a second visit would keep them, and it may have no network.
_FIRST = re.compile(
    r"^(static/pyodide|lab|files|api)/|^build/jlab_core\.|^extensions/.*remoteEntry|^[^/]*\.js(on)?$"
)
STATIC = Path(__file__).with_name("static")
# What JupyterLab's page has besides: what loads all of it and starts Python, the system's colours before
# there is a theme, and marks of waiting that stand still: one that turns takes the processor from Python, for
# which it waits.
_HEAD = """<script src="../early.js"></script>
<script src="../start.js"></script>
<style>@media (prefers-color-scheme: dark) { html body { background-color: #111; color: #fff; } }
html .jp-KernelStatus-spinner, html #jupyterlab-splash [id^=moon] { animation: none !important; }</style>"""


# Where "Run it here" leads, with the name of a notebook.
ADDRESS = "run/lab/index.html?path={}.ipynb"
# Whose work is shipped with it, besides that of the pages.
SHIPPED = {
    "jupyterlite-core": "JupyterLab; the licences of its parts: run/build/third-party-licenses.json",
    "jupyterlite-pyodide-kernel": "what joins JupyterLab and Python in a browser",
    **dict.fromkeys(
        ("ipywidgets", "jupyterlab-widgets", "anywidget", "sympy", "mpmath", "psygnal"), "used by the course"
    ),
    **dict.fromkeys(("comm", "typing-extensions", "u-msgpack-python"), "used by the course"),
}

# No text of its licence comes with its files; it asks to be told where the source is.
PYODIDE = f"""pyodide {wheels.VERSION}: Python and its packages for a browser, some of their files compiled
  Mozilla Public License 2.0, https://www.mozilla.org/MPL/2.0/
  its source: https://github.com/pyodide/pyodide/tree/{wheels.VERSION}
  Python itself: PSF License 2, https://docs.python.org/3/license.html
  IPython: without its terminal
  numpy, matplotlib, pillow and others: each wheel in run/static/pyodide holds its own licence, and
  python_stdlib.zip there those of the packages in it
"""


def ready(pyodide: Path) -> None:
    """ValueError if a package or a file is missing that a build needs."""
    wheels.official(pyodide)
    if util.find_spec("jupyterlite_core") is None:
        raise ValueError(f"JupyterLab in the browser needs packages that are not installed: {tools.INSTALL}")


def write(course: Path, pyodide: Path, version: str, title: str, out: Path) -> None:
    """Write the application into a new folder.

    Parameters
    ----------
    course : Path
        A folder that `coursekit release` has written.
    pyodide : Path
        Pyodide's files, see `wheels`.
    version, title : str
        Of the course.
    """
    ready(pyodide)
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        pypi = tools.extension(_KERNEL) / "static" / "pypi"
        (work / "lite").mkdir()
        python = work / "pyodide"
        packages = wheels.write(pyodide, pypi, course, version, python)
        notebooks = sorted((course / "notebooks").glob("*.ipynb"))
        wheels.check_imports(packages, python / packages["coursekit"]["file_name"], notebooks)
        compiled.where_node_is(python, wheels.AT_ONCE)
        for name in _EXTENSIONS:
            leave = shutil.ignore_patterns("*.map", "pypi")
            shutil.copytree(tools.extension(name), work / "labextensions" / name, ignore=leave)
        shutil.copytree(STATIC / "lab", work / "labextensions" / "coursekit-site")
        _settings(work / "lite", title)
        _build(work, course / "notebooks")
        shutil.move(python, work / "built" / "static" / "pyodide")
        shutil.move(work / "built", out)
    _finish(out)


def _settings(lite: Path, title: str) -> None:
    kernel = {
        "pyodideUrl": "./static/pyodide/pyodide.js",
        "disablePyPIFallback": True,
        "loadPyodideOptions": {
            "packages": list(wheels.AT_ONCE),
            "env": {"MPLBACKEND": "module://matplotlib_inline.backend_inline"},
        },
    }
    config = {
        "appName": title,
        "exposeAppInBrowser": True,
        "faviconUrl": "./icon-120x120.png",
        "enableServiceWorkerCache": "false",  # ours keeps what is to be kept
        "disabledExtensions": [
            "@jupyterlab/apputils-extension:announcements",
            "@jupyterlite/application-extension:share-file",
        ],
        "litePluginSettings": {f"{_KERNEL}:kernel": kernel},
    }
    text = json.dumps({"jupyter-lite-schema-version": 0, "jupyter-config-data": config}, indent=1)
    (lite / "jupyter-lite.json").write_text(text, encoding="utf-8")
    quiet = {"fetchNews": "false", "checkForUpdates": False}
    overrides = {
        "@jupyterlab/apputils-extension:notification": quiet,
        "@jupyterlab/docmanager-extension:plugin": {"autosaveInterval": 5},  # seconds: a tab is soon closed
        "@jupyterlab/apputils-extension:themes": {"adaptive-theme": True},  # light or dark as the system
    }
    (lite / "overrides.json").write_text(json.dumps(overrides), encoding="utf-8")


def _build(work: Path, notebooks: Path) -> None:
    command = [sys.executable, "-m", "jupyterlite_core", "build", "--no-sourcemaps"]
    command += ["--apps", "lab", "--lite-dir", str(work / "lite"), "--contents", str(notebooks)]
    command += ["--output-dir", str(work / "built"), "--ignore-sys-prefix", "federated_extensions"]
    command += [f"--FederatedExtensionAddon.extra_labextensions_path={work / 'labextensions'}"]
    path = os.pathsep.join(filter(None, [os.environ.get("PYTHONPATH"), str(tools.FOLDER)]))
    environment = {**os.environ, "PYTHONWARNINGS": "ignore", "PYTHONPATH": path}
    done = subprocess.run(command, cwd=work / "lite", env=environment, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"JupyterLite could not be built:\n{(done.stdout + done.stderr)[-3000:]}")


def _finish(out: Path) -> None:
    """Add what loads everything and the list of what that is; take away what nobody reads."""
    for path in [*out.rglob("*.map"), out / "lab" / "favicon.ico"]:
        path.unlink()
    (out / "service-worker.js").rename(out / "jupyterlite-worker.js")
    for path in (STATIC / "run").glob("*.js"):
        shutil.copy(path, out / path.name)
    _wait(out / "lab" / "index.html")
    files = {}
    for path in sorted(path for path in out.rglob("*") if path.is_file()):
        data = path.read_bytes()
        name = path.relative_to(out).as_posix()
        files[name] = {"size": len(data), "sum": hashlib.sha256(data).hexdigest()[:16]}
    del files["service-worker.js"]  # a browser looks after this one itself
    first = [name for name in files if _FIRST.search(name)]
    version = hashlib.sha256(json.dumps(files).encode()).hexdigest()[:16]
    listed = {"version": version, "first": first, "files": files}
    (out / "files.json").write_text(json.dumps(listed), encoding="utf-8")


def _wait(page: Path) -> None:
    """Let JupyterLab's page wait until everything is loaded, and say meanwhile how far that is."""
    html = page.read_text(encoding="utf-8")
    start = (STATIC / "run" / "start.html").read_text(encoding="utf-8")
    for old, new in (
        ("<head>", f"<head>\n{_HEAD}"),
        ('      rel="preload"\n', ""),  # what comes before the worker stands would not be kept
        ("await import(", "await courseLoaded;\nawait import("),
        ('data-notebook="lab">', f'data-notebook="lab">\n{start}'),
    ):
        if html.count(old) != 1:
            raise ValueError(
                f"JupyterLite's page is another one than the course knows: {old!r} is not there once"
            )
        html = html.replace(old, new)
    page.write_text(html, encoding="utf-8")
