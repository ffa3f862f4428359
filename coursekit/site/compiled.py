"""Python's files compiled for the browser, where node is there to do it: half the work to the first cell.

Only what a session imports is compiled (compiled files are larger), of Python's own library too; `coursekit`
stays as it is, so that its lines can be read. node runs the browser's own Python: what another version
compiles is of no use to it.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import marshal
import pkgutil
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterable
from importlib import util
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
    used = imported()
    site = Path(str(sys.modules[COURSE].__file__)).parents[1]
    _compile(Path(folder) / "python_stdlib.zip", Path(str(json.__file__)).parents[1], used)
    lock = json.loads((Path(folder) / "pyodide-lock.json").read_text(encoding="utf-8"))
    for name, entry in lock["packages"].items():
        path = Path(folder) / entry["file_name"]
        if name != COURSE:
            _compile(path, site, used)
        entry["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    (Path(folder) / "pyodide-lock.json").write_text(json.dumps(lock), encoding="utf-8")


def imported() -> set[str]:
    """The files of what is imported once the course is."""
    course = importlib.import_module(COURSE)
    for module in pkgutil.walk_packages(course.__path__, f"{COURSE}."):
        importlib.import_module(module.name)
    for name in ALSO:
        importlib.import_module(name)
    return {str(getattr(module, "__file__", None)) for module in list(sys.modules.values())}


def _compile(path: Path, root: Path, used: set[str]) -> None:
    """Compile, in an archive that is unpacked or read at `root`, the files that are used."""
    with zipfile.ZipFile(path) as archive:
        files = {file: archive.read(file) for file in archive.namelist() if not file.endswith("/")}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for file, data in sorted(files.items()):
            place = f"{root}/{file}"
            if place in used and file.endswith(".py"):
                file, data = f"{file}c", compiled(data, place, file.partition("/")[0] in TERSE)
            about = zipfile.ZipInfo(file, (1980, 1, 1, 0, 0, 0))
            about.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(about, data)


def compiled(source: bytes, place: str, terse: bool = False) -> bytes:
    """The compiled file of a file, which Python takes without looking for the file itself."""
    code = compile(source, place, "exec", dont_inherit=True, optimize=2 if terse else 0)
    unchecked = (1).to_bytes(4, "little")  # PEP 552
    return util.MAGIC_NUMBER + unchecked + util.source_hash(source) + marshal.dumps(code)
