"""The Python of the site: what lies in it, and that the course says the same there as in a kernel here."""

import hashlib
import json
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from coursekit.classroom.course import the_course
from coursekit.site import wheels
from tests.classroom import leaks
from tests.needs import absent

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


def in_node(script, *arguments, seconds=1800):
    node = shutil.which("node")
    if not node:
        absent("node is not installed")
    command = [node, str(HERE / script), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=seconds)


# -- what lies in it


def test_no_answer_lies_in_a_wheel_or_a_notebook(run):
    texts = {path.name: path.read_text("utf-8") for path in (run / "files").rglob("*") if path.is_file()}
    (wheel,) = (run / "static" / "pyodide").glob("coursekit*.whl")
    with zipfile.ZipFile(wheel) as files:
        texts |= {name: files.read(name).decode() for name in files.namelist()}
    rooms = {name.split("/")[2] for name in texts if name.startswith("coursekit/classroom/")}
    assert {"check.py", "exercises", "samples"} <= rooms
    assert not rooms & {"author", "grader", "mistakes"}
    assert not any(name.startswith("coursekit/site") for name in texts)
    assert leaks.found(the_course(), {n: t for n, t in texts.items() if "kinematics" not in n}) == {}


def test_the_lock_names_what_is_there(run):
    folder = run / "static" / "pyodide"
    lock = json.loads((folder / "pyodide-lock.json").read_text())["packages"]
    for entry in lock.values():
        data = (folder / entry["file_name"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == entry["sha256"]
        assert set(entry["depends"]) <= set(lock)
    settings = json.loads((run / "jupyter-lite.json").read_text())["jupyter-config-data"]
    (kernel,) = settings["litePluginSettings"].values()
    assert {wheels.canonical(name) for name in kernel["loadPyodideOptions"]["packages"]} <= set(lock)


def test_it_is_light(run):
    listed = json.loads((run / "files.json").read_text())
    first = sum(listed["files"][name]["size"] for name in listed["first"])
    assert 30e6 < first < 39e6  # 38.0: Python and its library 22, matplotlib 5, numpy 3; 5 of Lab follow
    assert "scipy" not in json.dumps(listed)


def test_what_a_session_imports_is_compiled_and_the_course_can_be_read(run):
    if not shutil.which("node"):
        absent("node is not installed")
    folder = run / "static" / "pyodide"
    for archive, file in (
        ("python_stdlib.zip", "json/decoder"),
        ("python_stdlib.zip", "sympy/core/expr"),
        ("ipython-*.whl", "IPython/core/interactiveshell"),
        ("numpy-*.whl", "numpy/matrixlib/defmatrix"),
    ):
        (path,) = folder.glob(archive)
        names = zipfile.ZipFile(path).namelist()
        assert f"{file}.pyc" in names
        assert f"{file}.py" not in names
    (wheel,) = folder.glob("coursekit-*.whl")
    assert "coursekit/view/viewer.py" in zipfile.ZipFile(wheel).namelist()


def test_an_import_that_the_browser_lacks_stops_the_build(run, tmp_path):
    lock = json.loads((run / "static" / "pyodide" / "pyodide-lock.json").read_text())["packages"]
    (wheel,) = (run / "static" / "pyodide").glob("coursekit*.whl")
    notebook = tmp_path / "01_new.ipynb"
    cells = [{"cell_type": "code", "source": ["%matplotlib inline\n", "import scipy.linalg"]}]
    notebook.write_text(json.dumps({"cells": cells}))
    with pytest.raises(ValueError, match=r"scipy \(01_new.ipynb\)"):
        wheels.check_imports(lock, wheel, [notebook])


@pytest.mark.parametrize(
    ("harm", "told"),
    [
        (lambda folder: (folder / "pyodide-lock.json").unlink(), "holds no pyodide-lock.json"),
        (lambda folder: (folder / "pyodide.asm.wasm").unlink(), r"lacks pyodide.asm.wasm"),
        (lambda folder: next(folder.glob("numpy*")).write_bytes(b"other"), "its sum differs"),
        (lambda folder: older(folder / "pyodide-lock.json"), r"is Pyodide 0.26.0; .* 0.27.7"),
    ],
)
def test_files_that_are_not_pyodides_are_refused(pyodide, tmp_path, harm, told):
    shutil.copytree(pyodide, tmp_path / "pyodide")
    harm(tmp_path / "pyodide")
    with pytest.raises(ValueError, match=told):
        wheels.official(tmp_path / "pyodide")


def older(lock):
    lock.write_text(
        lock.read_text()
        .replace('"version": "0.27.7"', '"version": "0.26.0"')
        .replace('"version":"0.27.7"', '"version":"0.26.0"')
    )


# -- what it says


def test_the_notebooks_print_what_is_stored(run):
    paths = [the_course().notebook(unit) for unit in the_course().units]
    done = in_node("notebooks.mjs", run / "static" / "pyodide", *paths)
    assert done.returncode == 0, done.stderr[-3000:]
    cells = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"notebook"')]
    assert len(cells) > 150
    assert [(cell["notebook"], cell["id"], cell["error"]) for cell in cells if cell["error"]] == []
    different = [cell for cell in cells if cell["got"].strip() != cell["wanted"].strip()]
    assert different == []


# pytest and what it needs, all of them Python alone
PYTEST = ("pytest", "iniconfig", "pluggy", "sortedcontainers", "attrs", "tqdm")


def test_the_mathematics_passes_its_tests(run, pyodide, tmp_path):
    for name in PYTEST:
        file, data = wheels.from_here(name)
        (tmp_path / file).write_bytes(data)
    for path in (pyodide / "tests").glob("*.whl"):  # the installed hypothesis is not Python alone
        shutil.copy(path, tmp_path / path.name)
    paths = sorted((ROOT / "tests" / "kinematics").glob("test_*.py"))
    here = [path for path in paths if "scipy" not in path.read_text(encoding="utf-8")]  # which is not there
    names = [path.relative_to(ROOT).as_posix() for path in here]
    done = in_node("pytest.mjs", run / "static" / "pyodide", tmp_path, ROOT, *names)
    assert done.returncode == 0, (done.stdout + done.stderr)[-5000:]
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) > 900
