"""The box: one Python process that sees neither network, course, classmates nor the grader's files.

Bubblewrap gives it its own processes, network and file system: Python read-only, a small home in memory, and
nothing of the host that can be written. It is talked to over two pipes, in JSON lines; `runner` answers.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import secrets
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ..course import ROOT
from ..library import PRESENT
from .syscalls import refused
from .usage import IN_MEMORY, busy, cpu, family, used

GRACE = 2.0  # seconds for the box to say itself that its time is over
LOOK = 0.2  # seconds between two looks at what the box uses
AT_ONCE = 4  # threads that may want a processor at the same time: more make classmates late
PATIENCE = 5  # looks that find more than that before the box is ended


@dataclass(frozen=True)
class Limits:
    """What a submission may use: bytes (of all its processes together), seconds, numbers of processes."""

    memory: int = 3 << 30
    home: int = 200_000_000
    message: int = 4_000_000
    processes: int = 64
    cpu: int = 150
    cell: float = 20.0
    notebook: float = 90.0
    submission: float = 240.0


class BoxLost(Exception):
    """What runs in the box died, hung, or had to be killed."""


def bubblewrap() -> str | None:
    """The path of a bubblewrap that works here, or None."""
    program = shutil.which("bwrap")
    if program is None or shutil.which("prlimit") is None:
        return None
    attempt = [program, "--unshare-all", "--ro-bind", "/", "/", "true"]
    return program if subprocess.run(attempt, capture_output=True).returncode == 0 else None


@cache
def no_boxes_inside(program: str) -> list[str]:
    """Who can make namespaces of their own in the box has file systems there without a size."""
    more = ["--unshare-user", "--disable-userns"]  # bubblewrap knows it from 0.8 on
    attempt = [program, "--unshare-all", *more, "--ro-bind", "/", "/", "true"]
    return more if subprocess.run(attempt, capture_output=True, **nobody()).returncode == 0 else []


@cache
def nobody() -> dict:
    """What makes a root's box nobody's (process limits do nothing for root), {} where that cannot be."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or (program := bubblewrap()) is None:
        return {}
    user: dict[str, Any] = {"user": 65534, "group": 65534, "extra_groups": []}
    command = [program, "--unshare-all", "--ro-bind", "/", "/", os.path.realpath(sys.executable), "-I", "-S"]
    try:  # a Python in root's own folder is closed to others
        worked = subprocess.run([*command, "-c", ""], capture_output=True, cwd="/", **user).returncode == 0
    except OSError:
        worked = False
    return user if worked else {}


def _open_to_all(folder: Path) -> bool:
    return all(path.stat().st_mode & 0o001 for path in [folder, *folder.resolve().parents])


def as_root() -> bool:
    """Would a box run as root?"""
    return hasattr(os, "geteuid") and os.geteuid() == 0 and not nobody()


class Box:
    """One Python in its box: `ask(request, seconds)` as often as you like, then `close()`.

    released : the library is the one that students have, and not a locked one
    """

    def __init__(self, library: Path, limits: Limits, program: str | None, released: bool = False) -> None:
        self.limits = limits
        self._home = None if program else tempfile.mkdtemp(prefix="home")
        with _filters(program) as filters:
            self._process = subprocess.Popen(
                _command(library, limits, program, self._home or "/tmp/home", released, filters),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,  # what is printed below Python's level goes nowhere
                env={"PATH": os.environ.get("PATH", os.defpath)},
                cwd=self._home or "/",
                start_new_session=True,
                pass_fds=filters,
                **(nobody() if program and _open_to_all(library) else {}),
            )
        self._read = b""
        self._next_look = time.monotonic() + LOOK
        self._crowded = 0
        self.cpu = 0.0  # seconds it used, known when it is closed
        for pipe in (self._process.stdin, self._process.stdout):
            os.set_blocking(pipe.fileno(), False)  # type: ignore[union-attr]

    def ask(self, request: dict, seconds: float) -> dict:
        """The reply to a request, untrusted: {"late": True} if it says itself that its time was over.

        BoxLost if there is none in time.
        """
        end = time.monotonic() + seconds + GRACE
        nonce = secrets.token_hex(8)
        self._send(json.dumps({**request, "seconds": seconds, "nonce": nonce}).encode() + b"\n", end)
        while True:  # a line without the nonce was written by the student's code, and is no reply
            with contextlib.suppress(ValueError, RecursionError):
                reply = json.loads(self._line(end, seconds))
                if isinstance(reply, dict) and reply.get("nonce") == nonce:
                    return reply

    def close(self) -> None:
        """End it, and all that it started."""
        self.cpu = cpu(family(self._process.pid))
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        for pid in family(self._process.pid):  # without bubblewrap nothing else ends them
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                pipe.close()  # type: ignore[union-attr]
        if self._home:
            shutil.rmtree(self._home, ignore_errors=True)

    def _send(self, data: bytes, end: float) -> None:
        pipe = self._process.stdin.fileno()  # type: ignore[union-attr]
        while data:
            _, ready, _ = select.select([], [pipe], [], max(0, min(LOOK, end - time.monotonic())))
            try:
                data = data[os.write(pipe, data) :] if ready else data
            except OSError:
                raise BoxLost("the kernel died") from None
            if data and time.monotonic() > end:
                raise BoxLost("the box does not listen")

    def _line(self, end: float, seconds: float) -> bytes:
        pipe = self._process.stdout.fileno()  # type: ignore[union-attr]
        while True:
            if (now := time.monotonic()) > self._next_look:  # also while it talks without end
                self._next_look = now + LOOK
                self._look()
            if b"\n" in self._read:
                break
            if now > end:
                raise BoxLost(f"took more than {seconds:g} s")
            ready, _, _ = select.select([pipe], [], [], min(end - now, LOOK))
            if ready:
                part = os.read(pipe, 1 << 16)
                if not part:
                    raise BoxLost("the kernel died")
                self._read += part
                if len(self._read) > self.limits.message:
                    raise BoxLost("the reply is too long")
        line, _, self._read = self._read.partition(b"\n")
        return line

    def _look(self) -> None:
        """BoxLost if it takes more of the machine than it may."""
        all_of_it = family(self._process.pid)
        if used(all_of_it) > self.limits.memory:
            raise BoxLost(f"used more than {self.limits.memory >> 20} MB of memory")
        self._crowded = max(0, self._crowded + (1 if busy(all_of_it) > AT_ONCE else -1))
        if self._crowded >= PATIENCE:
            raise BoxLost(f"keeps more than {AT_ONCE} processes or threads at work")


# ---- the command


@contextlib.contextmanager
def _filters(program: str | None) -> Iterator[list[int]]:
    """Where bubblewrap can read, once, what the kernel is to refuse."""
    rules = refused() if program else b""
    if not rules:
        yield []
        return
    there, here = os.pipe()
    with open(here, "wb") as file:
        file.write(rules)
    try:
        yield [there]
    finally:
        os.close(there)


def _command(
    library: Path, limits: Limits, program: str | None, home: str, released: bool, filters: list[int]
) -> list[str]:
    environment = {
        "HOME": home,
        "PATH": f"{Path(sys.executable).parent}:/usr/bin:/bin",
        "PYTHONDONTWRITEBYTECODE": "1",
        "MPLCONFIGDIR": f"{home}/.matplotlib",
        "MPLBACKEND": "agg",
        "LANG": "C.UTF-8",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    python = [sys.executable, "-s"] if program is None else [os.path.realpath(sys.executable), "-I", "-S"]
    python += ["-B", str(library / "runner.py"), "released" if released else "locked"]
    python += [] if program is None else [PACKAGES]
    if shutil.which("prlimit"):
        asked = {"as": limits.memory, "fsize": limits.home, "cpu": limits.cpu, "core": 0}
        asked |= {"nproc": limits.processes, "nofile": 256}
        python = ["prlimit", *(f"--{name}={value}" for name, value in asked.items()), *python]
    if program is None:
        return ["env", "-i", *(f"{name}={value}" for name, value in environment.items()), *python]
    box = [program, "--unshare-all", *no_boxes_inside(program), "--die-with-parent", "--new-session"]
    box += ["--cap-drop", "ALL", "--hostname", "box", "--clearenv", "--proc", "/proc", "--dev", "/dev"]
    for pipe in filters:
        box += ["--seccomp", str(pipe)]
    box += ["--ro-bind", "/dev/null", "/dev/zero"]  # mapped and shared, it is memory that is not counted
    for path in _OF_THE_HOST:  # a root's box could otherwise write there: it has the host's user number
        if os.path.exists(path):
            box += ["--ro-bind", path, path]
    for folder in IN_MEMORY:  # first, because the course itself may lie in /tmp
        box += ["--size", str(limits.home), "--tmpfs", folder]
    for path in _visible():
        box += ["--ro-bind", path, path]
    hidden = [*_other_packages(), *([str(ROOT)] if seen(ROOT) else [])]
    for path in hidden:  # packages of another Python, or installed beside the course; a course below /usr
        box += ["--tmpfs", path]
    for path in (f"{sys.prefix}/bin", f"{sys.prefix}/pyvenv.cfg"):
        box += ["--ro-bind-try", path, path]
    for package in _packages():
        box += ["--ro-bind", str(package), f"{PACKAGES}/{package.name}"]
    for name, value in environment.items():
        box += ["--setenv", name, value]
    for fonts in _font_lists():  # finding all fonts anew would cost every box seconds
        if nobody() and not _open_to_all(fonts.parent):
            break
        box += ["--ro-bind", str(fonts), f"{home}/.matplotlib/{fonts.name}"]
    box += ["--ro-bind", str(library), str(library), "--dir", home, "--chdir", home]
    for path in (*hidden, "/dev", "/"):
        box += ["--remount-ro", path]
    return [*box, *python]


_OF_THE_HOST = ("/proc/sys", "/proc/sysrq-trigger", "/proc/irq", "/proc/bus", "/proc/fs", "/proc/acpi")


# All of Python's libraries that the box has. The course's own, and robotics by others, would give answers.
LIBRARIES = PRESENT
NEEDED = ("dateutil", "six", "fontTools", "kiwisolver", "packaging", "PIL", "pyparsing")  # by those
PACKAGES = "/packages"  # where they lie in the box


def _visible() -> list[str]:
    """What a Python needs, and nothing of the course (whose environment may keep JupyterLab's tokens)."""
    system = ["/usr", "/bin", "/lib", "/lib64", "/etc/ld.so.cache", "/etc/fonts"]
    python = [f"{sys.base_prefix}/{part}" for part in ("bin", "lib", "lib64")]
    return [path for path in dict.fromkeys([*system, *python]) if os.path.exists(path)]


@cache
def _packages() -> list[Path]:
    """Their folders and files, wherever they are installed, and the shared objects they bring."""
    found = []
    for name in (*LIBRARIES, *NEEDED):
        spec = importlib.util.find_spec(name)
        if spec is not None and (places := spec.submodule_search_locations or [spec.origin or ""]):
            path = Path(next(iter(places)))
            found += [path, *path.parent.glob(f"{'pillow' if name == 'PIL' else name}.libs")]
    return found


@cache
def _other_packages() -> list[str]:
    """Folders of installed packages that lie in what is visible."""
    roots = {f"{prefix}/lib" for prefix in (sys.base_prefix, "/usr", "/usr/local")}
    found = [path for root in roots for path in Path(root).glob("python3*/*-packages")]
    return sorted(map(str, found))


def seen(path: Path) -> bool:
    """Does this lie where students' code can read, and not among the installed packages?"""
    path = path.resolve()
    return any(map(path.is_relative_to, _visible())) and not any(map(path.is_relative_to, _other_packages()))


def _font_lists() -> list[Path]:
    """matplotlib's list of fonts, if it was ever imported here."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folders = [Path(os.environ.get("MPLCONFIGDIR") or cache / "matplotlib"), cache / "matplotlib"]
    return next((found for folder in folders if (found := list(folder.glob("fontlist-*.json")))), [])
