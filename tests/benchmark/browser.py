"""How soon the first explorer of a page is there, how fast it follows a slider and a hand in the picture, how
its motion plays, and what 200 runs of its cell leave behind.

    python tests/benchmark/browser.py [--executions 200] [--moves 60] [--pages 5]

Starts a private JupyterLab and a headless Chromium (see tests/requirements-ci.txt) and prints one table. The
times are those of this machine: beside them stand an empty round trip of the same kind of widget, and the
same robot in meshcat's own server and page, measured in the same run. The test command does not read this.
"""

import argparse
import contextlib
import os
import platform
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np

from coursekit import robots, view
from tests.browser.lab import CHROMIUM_FLAGS, Lab, Notebook, chromium

SIZE = {"width": 1280, "height": 900}
SHOW = """\
import time
import numpy as np
from coursekit import robots, view
kr6 = robots.kuka_kr6()
panel = view.explore(kr6)
panel.viewer.quality = "{quality}"
panel"""
# the same slider in front of nothing: what the kernel answers is the value itself
ECHO = """\
import anywidget, ipywidgets, traitlets
from coursekit.view import Slider
class Echo(anywidget.AnyWidget):
    _esm = "export default { render({ model }) { model.on('change:answer', () => answered()); } };"
    answer = traitlets.Float().tag(sync=True)
slider, echo = Slider("echo", 0, -np.pi, np.pi, "deg"), Echo()
slider.observe(lambda change: setattr(echo, "answer", change.new), "value")
ipywidgets.VBox([slider, echo])"""
ONE_ECHO = """async (key) => {
    const range = [...document.querySelectorAll(".ck-range")].at(-1);
    const begun = performance.now();
    const done = new Promise((resolve) => (window.answered = resolve));
    range.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    await done;
    return performance.now() - begun;
}"""
# One key on a slider, until the pose is there and until it is drawn: [arrival, drawn] in ms.
ONE_KEY = """async (key) => {
    const range = document.querySelector(".ck-range");
    const { stage } = document.querySelector(".ck-viewer").coursekit;
    if (!stage.timed) {
      stage.timed = {};
      const moved = stage.moved;
      stage.moved = () => { stage.timed.arrived ??= performance.now(); moved(); };
      stage.afterFrame.push(() => stage.timed.arrived && stage.timed.drawn && stage.timed.drawn());
    }
    const begun = performance.now();
    stage.timed.arrived = undefined;
    const drawn = new Promise((resolve) => (stage.timed.drawn = resolve));
    range.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    await drawn;
    return [stage.timed.arrived - begun, performance.now() - begun];
}"""
# The time of the first frame after a pose came (ONE_KEY has prepared the stage).
DRAWN_AT = """() => {
    window.drawnAt = 0;
    const { stage } = document.querySelector(".ck-viewer").coursekit;
    stage.timed.arrived = undefined;
    stage.afterFrame.push(() => {
      if (stage.timed.arrived) window.drawnAt = performance.timeOrigin + performance.now();
      stage.timed.arrived = undefined;
    });
}"""
# meshcat's own page: when it has drawn the last transform
STOCK_DRAWN_AT = """() => {
    window.drawnAt = 0;
    const render = viewer.render;
    viewer.render = function () {
      render.call(viewer);
      window.drawnAt = performance.timeOrigin + performance.now();
    };
}"""
POSES_SEEN = """() => {
    window.poses = new Set();
    window.frames = 0;
    const { stage, viewer } = document.querySelector(".ck-viewer").coursekit;
    const link = viewer.scene_tree.find(["ck", "robot", "6"]).object;
    stage.afterFrame.push(() => { poses.add(link.matrixWorld.elements.join()); frames += 1; });
}"""

READS = (
    2000  # milliseconds, at least, in which one reads what stands between the imports and the first explorer
)
# When a cell is run, when its stored picture and its first frame are there, and the long tasks.
FIRST = """window.first = { tasks: [] };
new PerformanceObserver((list) => first.tasks.push(...list.getEntries()))
  .observe({ type: "longtask", buffered: true });
first.look = () => {
  const view = document.querySelector(".ck-viewer"), cover = document.querySelector(".ck-cover");
  if (cover?.naturalWidth || view?.coursekit?.stage.frames) first.picture ??= performance.now();
  if (view?.coursekit?.stage.frames) return (first.frame = performance.now());
  requestAnimationFrame(first.look);
};"""
RUN_LAST = """() => {
    const notebook = window.jupyterapp.shell.currentWidget.content;
    notebook.activeCellIndex = notebook.widgets.length - 1;
    first.begun = performance.now();
    first.look();
    window.jupyterapp.commands.execute("notebook:run-cell");
}"""
FIRST_TIMES = """() => {
    const tasks = first.tasks.filter((task) => task.startTime >= first.begun).map((task) => task.duration);
    return [first.picture - first.begun, first.frame - first.begun, Math.max(0, ...tasks)];
}"""
# When the pointer moved, and the first frame after it in which a translucent arm stands elsewhere.
GHOSTS = """() => {
    const { stage, viewer } = document.querySelector(".ck-viewer").coursekit;
    const { children } = viewer.scene_tree.find(["ck"]);
    const arms = Object.keys(children).filter((name) => name.startsWith("branch"));
    const hands = arms.map((name) => children[name].children[6]);
    const stands = () => hands.map(({ object }) => object.matrixWorld.elements.join()).join();
    let last = stands();
    window.ghosts = { times: [] };
    addEventListener("pointermove", (event) => { ghosts.moved = event.timeStamp; }, true);
    stage.afterFrame.push(() => {
      const now = stands();
      if (now !== last && ghosts.moved) ghosts.times.push(performance.now() - ghosts.moved);
      if (now !== last) ghosts.moved = 0;
      last = now;
    });
    const box = document.querySelector(".ck-handle.x").getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
}"""


class Raw:
    """A scene's command as meshcat's window wants it."""

    def __init__(self, command):
        self.command = command

    def lower(self):
        return self.command


def quantiles(times):
    return f"{np.percentile(times, 50):8.1f} {np.percentile(times, 95):8.1f}"


def slider_and_echo(notebook, moves):
    """Rows of one key on a slider, and of the same slider in front of nothing, turn by turn."""
    page, keys, echoes = notebook.page, [], []
    for k in range(moves + 5):
        keys.append(page.evaluate(ONE_KEY, "ArrowRight" if k % 2 else "ArrowLeft"))
        page.wait_for_timeout(50)
        echoes.append(page.evaluate(ONE_ECHO, "ArrowRight" if k % 2 else "ArrowLeft"))
        page.wait_for_timeout(50)
    arrived, drawn = np.array(keys[5:]).T
    yield "empty round trip of such a slider", quantiles(echoes[5:])
    yield "slider key -> pose is in the page", quantiles(arrived)
    yield "slider key -> pose is drawn", quantiles(drawn)


def first_explorer(lab, browser, name, pages):
    """Rows of the first explorer of a page, each in a page and a kernel of its own."""
    times = []
    for k in range(pages):
        context = browser.new_context(viewport=SIZE)
        notebook = Notebook(lab, context.new_page())
        notebook.page.add_init_script(FIRST)
        notebook.open(lab.write(f"{name}{k}.ipynb", "from coursekit import view", f"view.{name}()"))
        notebook.kernel("exec('from coursekit import view')")
        notebook.page.wait_for_timeout(READS)
        notebook.page.evaluate(RUN_LAST)
        notebook.wait_view()
        times.append(notebook.page.evaluate(FIRST_TIMES))
        context.close()
    for what, column in zip(("stored picture", "first frame"), np.array(times).T, strict=False):
        yield f"{name}: cell run -> {what}", quantiles(column)
    yield f"{name}: longest task until then", quantiles(np.array(times)[:, 2])


def drag_to_ghosts(lab, browser, moves):
    """Times from a move of the pointer that holds the target to the frame with all solutions there, ms."""
    notebook = Notebook(lab, browser.new_page(viewport=SIZE))
    notebook.open(lab.write("drag.ipynb", "from coursekit import view\nview.explore_inverse()"))
    notebook.run_all()
    notebook.wait_view()
    notebook.page.evaluate("() => document.querySelector('.ck-viewer').scrollIntoView()")
    at = np.array(notebook.page.evaluate(GHOSTS))
    mouse = notebook.page.mouse
    mouse.move(*at)
    mouse.down()
    for k in range(moves + 5):
        mouse.move(*(at + [3 * (k % 2) + 2, 2 * (k % 2)]))
        notebook.page.wait_for_function("k => ghosts.times.length > k", arg=k)
        notebook.page.wait_for_timeout(40)
    mouse.up()
    times = notebook.page.evaluate("ghosts.times")[5:]
    notebook.page.close()
    return times


def from_kernel(notebook, moves):
    """Times from six transforms in the kernel to the drawn frame, ms."""
    notebook.page.evaluate(DRAWN_AT)
    times = []
    for k in range(moves + 5):
        moved = f"kr6.displacements(kr6.home + {0.01 * (k % 2 + 1)})"
        begun = notebook.kernel(f"(time.time(), panel.viewer.set_pose({moved}))[0]")
        times.append(drawn_after(notebook.page, begun))
    return times[5:]


def stock(browser, moves, area):
    """Times from six `set_transform` to the drawn frame with meshcat's own server and page, ms."""
    import meshcat

    with contextlib.redirect_stdout(None):  # it prints its address
        server = meshcat.Visualizer()
    try:
        kr6 = robots.kuka_kr6()
        scene = view.Scene()
        scene.robot(kr6)
        for command in view.meshcat.commands(scene).values():
            server.window.send(Raw(command))
        page = browser.new_page(viewport=area)
        page.goto(server.url())
        page.wait_for_timeout(4000)
        page.evaluate(STOCK_DRAWN_AT)
        times = []
        for k in range(moves + 5):
            moved = kr6.displacements(kr6.home + 0.01 * (k % 2 + 1))
            begun = time.time()
            for i, T in enumerate(moved):
                server[f"/ck/robot/{i + 1}"].set_transform(T)
            times.append(drawn_after(page, begun))
        page.close()
        return times[5:]
    finally:
        server.window.server_proc.kill()
        server.window.server_proc.wait()


def drawn_after(page, begun):
    """Milliseconds from `begun` (seconds since 1970) to the last frame of the pose set then."""
    page.wait_for_function("t => window.drawnAt > t", arg=1000 * begun)
    page.wait_for_timeout(120)
    return page.evaluate("window.drawnAt") - 1000 * begun


def motion(notebook, quality):
    """One row: a motion of 101 poses at 30 frames a second."""
    page = notebook.page
    page.evaluate(POSES_SEEN)
    notebook.kernel("panel.play(np.linspace(kr6.home, kr6.home + 0.8, 101))")
    page.wait_for_function(
        "() => document.querySelector('.ck-count').textContent === '101 / 101'", timeout=60_000
    )
    page.wait_for_timeout(500)
    last = np.array(notebook.transform("/ck/robot/6"))
    kr6 = robots.kuka_kr6()
    error = np.abs(last - kr6.displacements(kr6.home + 0.8)[-1]).max()
    distinct = page.evaluate("poses.size")
    return (
        f"101 poses at 30 a second, quality {quality}",
        f"{distinct:5d} distinct poses drawn; last pose off by {error:.0e}",
    )


def memory(notebook, executions):
    """Rows of what the kernel and the page hold before and after running the cell again and again."""

    def held():
        session.send("HeapProfiler.collectGarbage")
        heap = session.send("Runtime.getHeapUsage")["usedSize"] / 1e6
        resident = notebook.kernel(
            "(__import__('gc').collect(), __import__('psutil').Process().memory_info().rss / 1e6)[1]"
        )
        return resident, notebook.kernel("len(__import__('ipywidgets').widgets.widget._instances)"), heap

    session = notebook.page.context.new_cdp_session(notebook.page)
    for _ in range(5):  # what is kept for good is kept after the first few
        notebook.run_cell(0)
        notebook.idle()
    before = held()
    for _ in range(executions):
        notebook.run_cell(0)
        notebook.idle()
    notebook.wait_view()
    after = held()
    for name, old, new in zip(
        ("kernel memory [MB]", "live widget models", "page's heap [MB]"), before, after, strict=True
    ):
        yield f"{name}, {executions} runs of the cell", f"{old:8.0f} -> {new:.0f}"


def show(name, value):
    print(f"{name:<52} {value}", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--executions", type=int, default=200)
    options.add_argument("--moves", type=int, default=60)
    options.add_argument("--pages", type=int, default=5)
    options = options.parse_args()
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=list(CHROMIUM_FLAGS))
        lab = Lab(Path(folder))
        try:
            names = ("jupyterlab", "ipywidgets", "anywidget", "meshcat", "numpy")
            machine = f"Python {platform.python_version()}, {os.cpu_count()} cores, WebGL in software"
            print(f"Chromium {browser.version}, {machine}")
            print(", ".join(f"{name} {version(name)}" for name in names))
            print(f"load when it began {os.getloadavg()[0]:.1f}\n")
            show("milliseconds, KUKA KR6", f"{'p50':>8} {'p95':>8}")
            for name in ("explore", "explore_inverse"):
                for row in first_explorer(lab, browser, name, options.pages):
                    show(*row)
            dragged = drag_to_ghosts(lab, browser, options.moves)
            show("explore_inverse: target dragged -> all solutions drawn", quantiles(dragged))
            for quality in ("auto", "low"):
                notebook = Notebook(lab, browser.new_page(viewport=SIZE))
                notebook.open(lab.write(f"{quality}.ipynb", SHOW.format(quality=quality), ECHO))
                notebook.run_all()
                notebook.wait_view()
                if quality == "auto":
                    for row in slider_and_echo(notebook, options.moves):
                        show(*row)
                    show(
                        "this viewer: transforms set in the kernel -> drawn",
                        quantiles(from_kernel(notebook, options.moves)),
                    )
                    area = notebook.page.locator(".ck-pane").bounding_box()
                    area = {side: round(area[side]) for side in SIZE}
                    others = stock(browser, options.moves, area)
                    show("meshcat's own server: the same transforms -> drawn", quantiles(others))
                show(*motion(notebook, quality))
                if quality == "low" and options.executions:
                    for row in memory(notebook, options.executions):
                        show(*row)
                notebook.page.close()
        finally:
            lab.close()
            browser.close()


if __name__ == "__main__":
    main()
