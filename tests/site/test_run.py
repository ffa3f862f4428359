"""The course in a browser that reaches one plain server and nothing else, as a student has it."""

import contextlib
import csv
import json
import shutil
import zipfile

import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import collect, grade
from tests.browser.drivers import Firefox
from tests.classroom import leaks
from tests.site.server import Served, Visit

pytestmark = pytest.mark.browser

NAME = "01_dh_vs_poe.ipynb"
OPEN = """() => window.jupyterapp?.shell.currentWidget?.context?.isReady
              && window.jupyterapp.shell.currentWidget.context.sessionContext.session?.kernel"""
READY = """() => window.jupyterapp.shell.currentWidget
               .context.sessionContext.session?.kernel?.status === "idle" """
FILES = """async () => {
  const { content } = await window.jupyterapp.serviceManager.contents.get("", { content: true });
  return content.map((entry) => entry.name);
}"""
KEPT = """async () => {
  const cache = await caches.open("coursekit-run");
  return (await cache.keys()).map((request) => decodeURIComponent(request.url));
}"""
WATCH = """addEventListener("DOMContentLoaded", () => {
  const node = document.getElementById("said");
  if (node) new MutationObserver(() => heard(node.textContent)).observe(node, { childList: true });
})"""
BEGUN = """() => { // Python's worker, and when the last of JupyterLab was here
  const loaded = performance.getEntriesByType("resource");
  const all = (part) => loaded.filter(({ name }) => name.includes(part));
  return [all("/early.js").at(-1).startTime, all("/jlab_core")[0].responseEnd];
}"""
RUN = """async ([id, source]) => {
  const notebook = window.jupyterapp.shell.currentWidget.content;
  const index = notebook.widgets.findIndex((cell) => cell.model.id === id);
  if (source !== null) notebook.widgets[index].model.sharedModel.setSource(source);
  notebook.activeCellIndex = index;
  notebook.deselectAll();
  const late = new Promise((done) => setTimeout(done, 120_000, "late"));
  const running = window.jupyterapp.commands.execute("notebook:run-cell");
  if ((await Promise.race([running, late])) === "late") return "no end";
  const outputs = notebook.widgets[index].model.outputs.toJSON();
  return outputs.map((one) => one.text || one.evalue || "").join("");
}"""
SCROLL = """(id) => { // what is out of sight is made when it comes into sight
  const { content } = window.jupyterapp.shell.currentWidget;
  return content.scrollToCell(content.widgets.find((cell) => cell.model.id === id));
}"""
SOURCE = """(id) => window.jupyterapp.shell.currentWidget.content.widgets.find((cell) => cell.model.id === id)
                    ?.model.sharedModel.getSource()"""

WRONG = """def dh_transform(a, alpha, d, theta):
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    first = [[ct, -st, 0, a], [st * ca, ct * ca, -sa, -d * sa]]
    return np.array([*first, [st * sa, ct * sa, ca, d * ca], [0, 0, 0, 1]])"""
RIGHT = """def dh_transform(a, alpha, d, theta):
    ca, sa, ct, st = np.cos(alpha), np.sin(alpha), np.cos(theta), np.sin(theta)
    first = [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st]]
    return np.array([*first, [0, sa, ca, d], [0, 0, 0, 1]])"""
CHAIN = """def fk_dh(rows, theta, base, tool):
    T = base
    for (a, alpha, d, offset), q in zip(rows, theta):
        T = T @ dh_transform(a, alpha, d, offset + q)
    return T @ tool"""


AGAIN = """async (path) => {
  const { commands } = window.jupyterapp;
  const panel = await commands.execute("docmanager:open", { path });
  await panel.context.ready;
  await new Promise((done) => setTimeout(done, 2000)); // all its text is made, also what is out of sight
  await commands.execute("docmanager:save");
  await commands.execute("application:close");
}"""


class Student(Visit):
    """Somebody with a browser profile of their own."""

    def go(self, name=NAME):
        """By the button on the notebook's page, until Python is ready."""
        self.open(name.replace(".ipynb", ".html"))
        self.page.evaluate("document.querySelector('header a.run').click()")
        self.page.wait_for_function("() => location.pathname.includes('/run/lab/')", timeout=300_000)
        self.wait()

    def wait(self):
        self.page.wait_for_function(OPEN, timeout=300_000)
        self.page.wait_for_function(READY, timeout=300_000)

    def run(self, cell, source=None):
        return self.page.evaluate(RUN, [cell, source])

    def source(self, cell):
        return self.page.evaluate(SOURCE, cell)

    def kernels(self):
        """The addresses of the workers in which Python runs."""
        return [worker.url.rsplit("/", 1)[1] for worker in self.page.workers if "blob:" not in worker.url]

    def save(self, folder, number="4711"):
        self.page.once("dialog", lambda dialog: dialog.accept(number))
        with self.page.expect_download(timeout=60_000) as download:
            self.page.click("#ck-bar [data-do=save]")
        path = folder / download.value.suggested_filename
        download.value.save_as(path)
        return path


@pytest.fixture(scope="module")
def work(browser, run, served, tmp_path_factory):
    """What one student does: a wrong answer, the right one, a reload, a copy. Later tests look at it."""
    told = {}
    with Student(browser, served.url) as student:
        student.go()
        student.run("setup")
        told["asked last"] = student.run("ex-dh-transform", "import sys; print(sys.path[-1:])")
        told["wrong"] = (student.run("ex-dh-transform", WRONG), student.run("check-dh-transform"))[1]
        told["right"] = (student.run("ex-dh-transform", RIGHT), student.run("check-dh-transform"))[1]
        told["kernels"] = student.kernels()
        told["second"] = (student.run("ex-fk-dh", CHAIN), student.run("check-fk-dh"))[1]
        student.run("see-explorer")
        student.page.evaluate("() => window.jupyterapp.commands.execute('docmanager:save')")
        student.page.wait_for_function(
            "() => !window.jupyterapp.shell.currentWidget.context.model.dirty", timeout=60_000
        )
        told["bar"] = student.page.inner_text("#ck-bar")
        student.page.reload(wait_until="domcontentloaded")
        student.wait()
        told["after reload"] = student.source("ex-dh-transform")
        student.page.evaluate(SCROLL, "see-explorer")
        picture = student.page.wait_for_selector(".ck-saved img", timeout=60_000)
        told["picture"] = picture.get_attribute("alt")
        told["zip"] = student.save(tmp_path_factory.mktemp("work"))
        told["bar after"] = student.page.inner_text("#ck-bar")
        told["asked"], told["errors"] = student.asked, student.errors
        student.context.set_offline(True)
        student.page.reload(wait_until="domcontentloaded")
        student.wait()
        told["offline"] = student.source("ex-dh-transform")
        student.run("setup")
        student.run("ex-dh-transform")
        told["right offline"] = student.run("check-dh-transform")
    return told


def test_in_firefox_too(served, tmp_path):
    with contextlib.closing(Firefox(tmp_path)) as page:
        page.goto(f"{served.url}/{NAME.replace('.ipynb', '.html')}")
        page.evaluate("() => document.querySelector('header a.run').click()")
        for ready in ("() => location.pathname.includes('/run/lab/')", OPEN, READY):
            page.wait_for_function(f"() => Boolean(({ready})())", timeout=300_000)
        assert page.evaluate(RUN, ["setup", None]) == ""
        for answer, told in ((WRONG, "✗ dh_transform"), (RIGHT, "✓ dh_transform: right on")):
            page.evaluate(RUN, ["ex-dh-transform", answer])
            assert page.evaluate(RUN, ["check-dh-transform", None]).startswith(told)


def test_a_check_fails_and_passes_there(work):
    assert work["wrong"].startswith("✗ dh_transform")
    assert "modified" in work["wrong"]
    assert work["right"].startswith("✓ dh_transform: right on")
    assert work["second"].startswith("✓ fk_dh: right on")  # its tick goes to a file that is there by now


def test_python_starts_while_jupyterlab_loads_and_only_once(work):
    assert work["kernels"] == ["early.js"]
    assert work["asked last"].strip() == "['']"  # first, each import would ask the page for it


def test_python_starts_again_when_it_is_told_to(browser, run, served):
    with Student(browser, served.url) as student:
        student.go()
        student.page.evaluate(
            "() => window.jupyterapp.shell.currentWidget.context.sessionContext.session.kernel.restart()"
        )
        student.wait()
        assert student.run("setup") == ""
        assert len(student.kernels()) == 1 and student.kernels() != ["early.js"]
        _closed_notebooks_go(student.page)


def _closed_notebooks_go(page):
    """Here, because a page of its own would take longer than all of this."""
    chrome, held = page.context.new_cdp_session(page), []
    for _ in range(3):
        page.evaluate(AGAIN, NAME)
        chrome.send("HeapProfiler.collectGarbage")
        held.append(chrome.send("Memory.getDOMCounters")["nodes"])
    assert held[2] - held[1] < 5_000  # JupyterLab alone: 20,000


@pytest.mark.parametrize("width", [412, 1366])
def test_what_does_not_work_can_be_read(browser, run, served, width):
    seen = """() => [...document.querySelectorAll("#ck-bar details p")].every((line) => {
      const { left, top, right } = line.getBoundingClientRect();
      return left > 0 && right < innerWidth && line.contains(document.elementFromPoint(left + 5, top + 9));
    })"""
    with Student(browser, served.url, viewport={"width": width, "height": 768}) as student:
        student.open("run/lab/index.html")
        student.page.locator("#jp-top-panel .lm-MenuBar").wait_for(timeout=120_000)
        student.page.click("#ck-bar summary")
        assert student.page.evaluate(seen)


def test_what_was_written_is_there_after_a_reload(work):
    assert work["after reload"] == RIGHT


def test_an_explorer_is_a_picture_with_its_words_until_its_cell_is_run_again(work):
    assert work["picture"].startswith("Explorer of DH and PoE: KUKA KR6 R900 sixx: joints (0.0, -90.0")


def test_nothing_is_asked_of_another_host(work):
    assert (work["asked"], work["errors"]) == ([], [])


def test_from_the_second_time_on_no_network_is_needed(work):
    assert work["offline"] == RIGHT
    assert work["right offline"].startswith("✓ dh_transform: right on")


def test_the_bar_says_where_the_work_is(work):
    assert "stays in this browser only" in work["bar"]
    assert "Last saved outside the browser: never" in work["bar"]
    assert "never" not in work["bar after"]


def test_the_copy_holds_what_was_written_and_a_list(work):
    assert work["zip"].name == "coursekit-work-4711.zip"
    with zipfile.ZipFile(work["zip"]) as files:
        assert files.testzip() is None
        assert sorted(files.namelist()) == [NAME, "coursekit-work.json"]
        about = json.loads(files.read("coursekit-work.json"))
        document = json.loads(files.read(NAME))
    assert (about["name"], about["notebooks"]) == ("4711", [NAME])
    sources = {cell["id"]: "".join(cell["source"]) for cell in document["cells"]}
    assert sources["ex-dh-transform"] == RIGHT
    given = notebook.student_version(notebook.read(the_course().notebook("nb01")))
    assert [cell["id"] for cell in given["cells"]] == list(sources)


def test_the_copy_comes_back_in_another_browser(browser, run, served, work, tmp_path):
    with Student(browser, served.url) as other:
        other.go()
        assert "NotImplementedError" in other.source("ex-dh-transform")
        other.page.set_input_files("#ck-bar input[type=file]", str(work["zip"]))
        other.page.get_by_text(f"Brought back: {NAME}").wait_for(timeout=60_000)
        other.wait()
        assert other.source("ex-dh-transform") == RIGHT
        # packed anew by another program, with other work there meanwhile: that one is put aside
        again = tmp_path / "again.zip"
        with zipfile.ZipFile(work["zip"]) as files, zipfile.ZipFile(again, "w", zipfile.ZIP_DEFLATED) as out:
            for name in files.namelist():
                out.writestr(name, files.read(name))
        other.run("ex-dh-transform", "# something else")
        with other.page.expect_event("domcontentloaded", timeout=60_000):
            other.page.set_input_files("#ck-bar input[type=file]", str(again))
        other.wait()
        assert other.source("ex-dh-transform") == RIGHT
        names = other.page.evaluate(FILES)
        assert any(name.startswith("earlier ") for name in names)


def test_a_corrected_release_comes_in_and_the_work_stays(browser, run, pages, work, tmp_path):
    site = tmp_path / "site"
    shutil.copytree(pages, site)
    with Served(site) as server, Student(browser, server.url) as student:
        student.go()
        student.page.set_input_files("#ck-bar input[type=file]", str(work["zip"]))
        student.page.get_by_text(f"Brought back: {NAME}").wait_for(timeout=60_000)
        _correct(site / "run")
        student.go()
        assert student.source("ex-dh-transform") == RIGHT
        assert "corrected" not in student.source("title")
        student.page.click("#ck-bar [data-do=update]", timeout=60_000)
        student.page.get_by_text("The corrections are in").wait_for(timeout=120_000)
        student.wait()
        assert student.source("ex-dh-transform") == RIGHT
        assert "corrected" in student.source("title")


def _correct(run):
    """A release with a higher version, in which a sentence differs."""
    import hashlib

    path = run / "files" / NAME
    document = notebook.read(path)
    document["cells"][0]["source"] += "\n\nThis sentence is corrected."
    document["metadata"]["coursekit"]["version"] = "9.0.0"
    notebook.write(path, document)
    listed = json.loads((run / "files.json").read_text())
    data = path.read_bytes()
    sum_ = hashlib.sha256(data).hexdigest()[:16]
    listed["files"][f"files/{NAME}"] = {"size": len(data), "sum": sum_}
    listed["version"] = "another"
    (run / "files.json").write_text(json.dumps(listed))


def test_started_from_a_folder_it_says_what_is_missing(browser, run):
    context = browser.new_context()
    page = context.new_page()
    page.goto((run / "lab" / "index.html").as_uri())
    assert "python3 -m http.server" in page.inner_text("#said")
    page.goto((run.parent / NAME.replace(".ipynb", ".html")).as_uri())
    page.click("header a.run")
    assert "needs a web server" in page.inner_text("#folder")
    context.close()


@pytest.mark.parametrize("slow", [False, True])
def test_the_page_that_loads_says_how_far_it_is(browser, run, served, slow):
    with Student(browser, served.url) as visit:
        said, before = [], served.server.sent
        if slow:  # to a page whose clock runs faster the line is a slow one
            visit.page.add_init_script(
                "const now = performance.now.bind(performance);performance.now = () => 30 * now();"
            )
        visit.page.expose_function("heard", lambda text: said.append(text))  # Playwright takes no builtin
        visit.page.add_init_script(WATCH)
        # Firefox asks the reader whether to keep the store, and the reader may never answer
        visit.page.add_init_script("navigator.storage.persist = () => new Promise(() => {})")
        visit.open("run/lab/index.html?path=" + NAME)
        visit.page.wait_for_selector("#main", timeout=300_000)
        assert not visit.page.is_visible("#said")
        python, jupyterlab = visit.page.evaluate(BEGUN)
        assert python < jupyterlab
        shares = [float(text.split("(")[1].split(" %")[0]) for text in said if "%" in text]
        assert shares == sorted(shares)
        assert shares[0] < 50 and shares[-1] == 100
        listed = json.loads((run / "files.json").read_text(encoding="utf-8"))
        first = {f"{served.url}/run/{name}?sum={listed['files'][name]['sum']}" for name in listed["first"]}
        assert first <= set(visit.page.evaluate(KEPT))
        size = sum(listed["files"][name]["size"] for name in listed["first"])
        assert size < served.server.sent - before < 1.5 * size, "each file is loaded once"
        if slow:
            assert len(shares) > 30, "files are told part by part"


@pytest.fixture(scope="module")
def collected(work, tmp_path_factory):
    """A class's downloads, sorted: one student's copy, saved twice."""
    folder = tmp_path_factory.mktemp("class")
    (folder / "download").mkdir()
    for name in (work["zip"].name, work["zip"].name.replace(".zip", " (1).zip")):
        shutil.copy(work["zip"], folder / "download" / name)
    collect.collect(folder / "download", folder / "submissions")
    return folder / "submissions"


def test_the_copy_is_collected_and_graded(collected, tmp_path):
    assert [path.name for path in collected.iterdir() if path.is_dir()] == ["4711"]
    assert leaks.MARKER.search((collected / "4711" / NAME).read_text("utf-8")) is None
    grade.grade_class(collected, tmp_path / "out", jobs=1, box=False)
    with (tmp_path / "out" / "grades.csv").open(encoding="utf-8-sig") as table:
        (row,) = csv.DictReader(table)
    assert float(row["dh_transform"]) > 0
    assert float(row["mdh_transform"]) == 0
