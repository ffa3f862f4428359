"""How long a student waits for the course in the browser, beside JupyterLab on the same computer.

    python tests/benchmark/site.py SITE [--runs 3] [--slow 4] [--no-memory]

SITE is a folder that `coursekit site SITE --pyodide FOLDER` wrote. The same notebook is opened by both, in
turn, each time in a fresh browser profile; seconds count from the address that is opened (JupyterLab's server
runs already), CPU seconds are those of all processes of browser, server and kernel until then. On a busy
machine the seconds say little. With --slow 4 all of them run a quarter of the time, Python's workers
included: what Chromium itself offers slows a page but not its workers. The test command does not read this.
"""

import argparse
import contextlib
import os
import platform
import shutil
import signal
import sys
import tempfile
import threading
import time
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import psutil

from coursekit.site import wheels  # and where the site's packages lie
from tests.browser.lab import CHROMIUM_FLAGS, Lab, chromium
from tests.site.server import Served, Visit

ROOT = Path(__file__).resolve().parents[2]
NAME = "01_dh_vs_poe.ipynb"
READY = """() => window.jupyterapp?.shell.currentWidget?.context?.sessionContext
               ?.session?.kernel?.status === "idle" """
RUN = """async (id) => {
  const notebook = window.jupyterapp.shell.currentWidget.content;
  notebook.activeCellIndex = notebook.widgets.findIndex((cell) => cell.model.id === id);
  notebook.deselectAll();
  await window.jupyterapp.commands.execute("notebook:run-cell");
}"""
SEEN = """() => [...document.querySelectorAll(".ck-viewer")].some((box) => box.coursekit?.stage.frames > 0)"""
OPEN = """async ([path, content]) => {
  const { serviceManager, commands } = window.jupyterapp;
  await serviceManager.contents.save(path, { type: "notebook", format: "json", content });
  await commands.execute("docmanager:open", { path });
}"""
RUN_ALL = """async () => { await window.jupyterapp.commands.execute("notebook:run-all-cells"); }"""
CLOSE = """async () => {
  await window.jupyterapp.shell.currentWidget.context.sessionContext.shutdown();
  await window.jupyterapp.commands.execute("docmanager:save");
  await window.jupyterapp.commands.execute("application:close");
}"""
LONG = 900_000  # ms


def family(kind=""):
    """The processes that this one has started, and theirs."""
    found = []
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.Error):
            line = " ".join(process.cmdline())
            if "playwright/driver" not in line and kind in line:
                found.append(process)
    return found


def cpu_seconds():
    total = 0.0
    for process in family():
        with contextlib.suppress(psutil.Error):
            total += sum(process.cpu_times()[:2])
    return total


def megabytes(collector=None):
    """What the pages and Python hold (memory that processes share is divided among them).

    With a collector once the browser has taken away what nobody needs any more: garbage, which goes after
    half a minute of rest, and pictures it has decoded, some 40 MB a notebook, which it keeps for five minutes
    or until memory is short.
    """
    if collector:
        collector.send("HeapProfiler.collectGarbage")
        collector.send("Memory.simulatePressureNotification", {"level": "critical"})
        time.sleep(2)
    total = 0
    for process in family("--type=renderer"):
        with contextlib.suppress(psutil.Error):
            total += process.memory_full_info().pss
    return total / 1e6


@contextlib.contextmanager
def slowed(times):
    """All processes started here run one of so many parts of the time."""
    ended = threading.Event()

    def beat():
        while not ended.wait(0.02):
            stopped = family()
            for signal_, seconds in ((signal.SIGSTOP, 0.02 * (times - 1)), (signal.SIGCONT, 0)):
                for process in stopped:
                    with contextlib.suppress(psutil.Error):
                        process.send_signal(signal_)
                time.sleep(seconds)

    thread = threading.Thread(target=beat)
    if times > 1:
        thread.start()
    try:
        yield
    finally:
        ended.set()
        if times > 1:
            thread.join()


def waits(visit, address, sent=lambda: 0):
    """{what: (seconds, CPU seconds, bytes)}: from the address to the first cell, the first explorer."""
    begun, cpu, told = time.monotonic(), cpu_seconds(), {}

    def now():
        return time.monotonic() - begun, cpu_seconds() - cpu, sent()

    visit.open(address, timeout=LONG)
    visit.page.wait_for_function(READY, timeout=LONG)
    told["Python is ready"] = now()
    visit.page.evaluate(RUN, "setup")
    told["first cell"] = now()
    visit.page.evaluate(RUN, "see-explorer")
    visit.page.wait_for_function(SEEN, timeout=LONG)
    told["first 3D explorer"] = now()
    return told


def memory(visit):
    """Rows of what the solved notebooks hold, opened and run one after another."""
    import nbformat

    page = visit.page
    collector = visit.context.new_cdp_session(page)
    page.evaluate(CLOSE)  # of the one that is open: one at a time
    most = []
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        name = f"solved_{path.name}"
        page.evaluate(OPEN, [name, nbformat.read(path, as_version=4)])
        page.wait_for_function(READY, timeout=LONG)
        page.evaluate(RUN_ALL)
        page.wait_for_timeout(3000)
        page.wait_for_function(READY, timeout=LONG)
        most.append((megabytes(), megabytes(collector)))
        page.evaluate(CLOSE)
        page.wait_for_timeout(5000)
        now, held = most[-1]
        yield (
            f"{path.stem}, all cells run",
            f"{now:6.0f} MB, held {held:.0f}; closed, {megabytes(collector):.0f}",
        )
    now, held = map(max, zip(*most, strict=True))
    yield "largest", f"{now:6.0f} MB, held {held:.0f}"


def spread(numbers):
    numbers = sorted(numbers)
    return f"{numbers[len(numbers) // 2]:6.1f} ({numbers[0]:.1f} to {numbers[-1]:.1f})"


def show(name, value):
    print(f"{name:<44} {value}", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("site", type=Path)
    options.add_argument("--runs", type=int, default=3)
    options.add_argument("--slow", type=int, default=1)
    options.add_argument("--no-memory", action="store_true")
    options = options.parse_args()
    from playwright.sync_api import sync_playwright

    os.environ["PYTHONPATH"] = str(ROOT)  # the course that JupyterLab's kernel imports
    notebook = options.site / "run" / "files" / NAME
    if not notebook.is_file():
        raise SystemExit(f"{notebook} is not there: build the site with --pyodide")
    with (
        tempfile.TemporaryDirectory() as folder,
        sync_playwright() as playwright,
        contextlib.closing(Lab(Path(folder))) as lab,
    ):
        shutil.copy(notebook, lab.notebooks / NAME)

        def browser():
            return playwright.chromium.launch(executable_path=chromium(), args=list(CHROMIUM_FLAGS))

        def native():
            with contextlib.closing(browser()) as running, Visit(running, lab.url) as visit:
                return waits(visit, f"lab/tree/{NAME}?token={lab.token}&reset")

        def here():
            with (
                Served(options.site) as server,
                contextlib.closing(browser()) as running,
                Visit(running, server.url) as visit,
            ):
                first = waits(visit, f"run/lab/index.html?path={NAME}", lambda: server.server.sent)
                before = server.server.sent
                again = waits(visit, f"run/lab/index.html?path={NAME}", lambda: server.server.sent - before)
                return first, again

        names = ("jupyterlab", "jupyterlite-core", "jupyterlite-pyodide-kernel")
        print(f"Pyodide {wheels.VERSION}, Python {platform.python_version()}")
        print(f"{os.cpu_count()} cores, WebGL in software")
        print(", ".join(f"{name} {version(name)}" for name in names))
        print(f"load when it began {os.getloadavg()[0]:.1f}, slowed {options.slow} times\n")
        told = {"JupyterLab": [], "in the browser, first visit": [], "in the browser, second visit": []}
        with slowed(options.slow):
            for _ in range(options.runs):
                told["JupyterLab"].append(native())
                for kind, one in zip(list(told)[1:], here(), strict=True):
                    told[kind].append(one)
        for kind, runs in told.items():
            for what in runs[0]:
                seconds, cpu, sent = zip(*(one[what] for one in runs), strict=True)
                loaded = f"  {max(sent) / 1e6:.1f} MB" if max(sent) else ""
                show(f"{kind}: {what}", f"{spread(seconds)} s  {spread(cpu)} CPU s{loaded}")
        if not options.no_memory:
            with (
                Served(options.site) as server,
                contextlib.closing(browser()) as running,
                Visit(running, server.url) as visit,
            ):
                waits(visit, f"run/lab/index.html?path={NAME}")
                for row in memory(visit):
                    show(*row)
        print(f"load when it ended {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
