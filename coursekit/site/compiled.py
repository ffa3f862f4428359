"""Python's files compiled for the browser, where node is there to do it: a third less work to the first cell.

Only what a session imports is compiled, since compiled files are larger; `coursekit` stays as it is, so that
its lines can be read. node runs the browser's own Python: what another version compiles is of no use to it.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import pkgutil
import py_compile
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterable
from pathlib import Path

COURSE = "coursekit"
TERSE = ("sympy", "mpmath")  # without docstrings, which are most of what is to be loaded of them
# What the course imports later than at its own import, and the kernel at its start.
ALSO = (
    *("pyodide_kernel", "piplite", "sympy", "matplotlib.pyplot", "mpl_toolkits.mplot3d"),
    *("matplotlib_inline.backend_inline", "matplotlib.backends.backend_agg", "PIL.PngImagePlugin"),
)


def where_node_is(folder: Path, packages: Iterable[str]) -> bool:
    """Compile in the wheels of a folder that `wheels.write` has written; False if node is not installed.

    ValueError if it fails.
    """
    node = shutil.which("node")
    if not node:
        return False
    script = Path(__file__).with_name("static") / "compile.mjs"
    command = [node, str(script), str(Path(folder).absolute()), __file__, *packages]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"Python's files could not be compiled:\n{(done.stdout + done.stderr)[-3000:]}")
    return True


def rewrite(folder: str) -> None:
    """Run there, by that Python: compile what a session imports, and mend the sums of the lock."""
    lock = json.loads((Path(folder) / "pyodide-lock.json").read_text(encoding="utf-8"))
    used = imported()
    for entry in lock["packages"].values():
        path = Path(folder) / entry["file_name"]
        with zipfile.ZipFile(path) as wheel:
            files = {file: wheel.read(file) for file in wheel.namelist()}
        if not used.keys() & files.keys():
            continue
        for file in used.keys() & files.keys():
            files[f"{file}c"] = compiled(used[file], file.partition("/")[0] in TERSE)
            del files[file]
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
            for file, data in sorted(files.items()):
                about = zipfile.ZipInfo(file, (1980, 1, 1, 0, 0, 0))
                about.compress_type = zipfile.ZIP_DEFLATED
                wheel.writestr(about, data)
        entry["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    (Path(folder) / "pyodide-lock.json").write_text(json.dumps(lock), encoding="utf-8")


def imported() -> dict[str, Path]:
    """{name in a wheel: file} of what is imported once the course is, without the course."""
    course = importlib.import_module(COURSE)
    for module in pkgutil.walk_packages(course.__path__, f"{COURSE}."):
        importlib.import_module(module.name)
    for name in ALSO:
        importlib.import_module(name)
    site = Path(str(course.__file__)).parents[1]
    named = [getattr(module, "__file__", None) for module in list(sys.modules.values())]
    files = [Path(file) for file in named if file]
    return {
        file.relative_to(site).as_posix(): file
        for file in files
        if file.suffix == ".py" and file.is_relative_to(site) and COURSE not in file.parts
    }


def compiled(path: Path, terse: bool = False) -> bytes:
    """The compiled file of a file, which Python takes without looking for the file itself."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "one.pyc"
        unchecked = py_compile.PycInvalidationMode.UNCHECKED_HASH
        level = 2 if terse else 0
        py_compile.compile(str(path), str(out), doraise=True, optimize=level, invalidation_mode=unchecked)
        return out.read_bytes()
