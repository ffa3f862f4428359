"""The box: a Jupyter kernel that sees neither network, course, classmates nor the grader's files.

Bubblewrap gives it its own processes, network and file system: Python read-only, a small home in memory. The
kernel is reached over unix sockets in one folder, the only thing it shares with the outside.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import zmq
import zmq.asyncio
from jupyter_client.asynchronous import AsyncKernelClient
from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager

from ..course import PACKAGE

SHARED = 1_000_000  # bytes that the folder of the sockets may hold


@dataclass(frozen=True)
class Limits:
    """What a submission may use: bytes, seconds, numbers of processes."""

    memory: int = 3 << 30
    home: int = 200_000_000
    message: int = 4_000_000
    processes: int = 200
    cpu: int = 150
    start: float = 40.0
    cell: float = 20.0
    notebook: float = 90.0
    submission: float = 240.0


class KernelLost(Exception):
    """The kernel died, hung, or had to be killed."""


def bubblewrap() -> str | None:
    """The path of a bubblewrap that works here, or None."""
    program = shutil.which("bwrap")
    if program is None or shutil.which("prlimit") is None:
        return None
    attempt = [program, "--unshare-all", "--ro-bind", "/", "/", "true"]
    return program if subprocess.run(attempt, capture_output=True).returncode == 0 else None


class Box:
    """One kernel. `await start()`, `await run(...)`, `await stop()`, and nothing of it remains."""

    def __init__(self, library: Path, limits: Limits, program: str | None) -> None:
        self.limits = limits
        self.folder = tempfile.mkdtemp(prefix="box")
        self.manager = AsyncKernelManager(transport="ipc", connection_file=f"{self.folder}/kernel.json")
        self.manager.ip = f"{self.folder}/s"  # the names of the sockets begin with it
        self.manager._kernel_spec = KernelSpec(
            argv=_command(self.folder, Path(library), limits, program),
            display_name="student",
            language="python",
            interrupt_mode="message",
        )
        self.client: AsyncKernelClient | None = None

    async def start(self) -> None:
        environment = {"PATH": os.environ.get("PATH", os.defpath), "HOME": self.folder}
        quiet = subprocess.DEVNULL  # what is printed below Python's level goes nowhere
        await self.manager.start_kernel(env=environment, cwd=self.folder, stdout=quiet, stderr=quiet)
        # A message above the limit cuts the sender off. Printed output is never subscribed to: no flood of it
        # can reach this process, replies come over the shell channel.
        context = zmq.asyncio.Context()
        context.sockopts[zmq.MAXMSGSIZE] = self.limits.message
        context.sockopts[zmq.LINGER] = 0
        self.client = AsyncKernelClient(**self.manager.get_connection_info(session=True), context=context)
        self.client.start_channels(iopub=False, stdin=False, hb=False)
        await self._reply(self.client, self.client.kernel_info(), self.limits.start)

    async def run(self, code: str, seconds: float, expression: str = "None") -> dict:
        """Execute code, then evaluate an expression; the content of the reply. Whatever it says is untrusted.

        Code that takes too long is interrupted ("interrupted" is then True); KernelLost if it goes on.
        """
        client = self.client
        if client is None:
            raise KernelLost("the kernel was not started")
        request = client.execute(code, allow_stdin=False, user_expressions={"value": expression})
        try:
            return await self._reply(client, request, seconds)
        except TimeoutError:
            await self.manager.interrupt_kernel()
        try:
            return {**await self._reply(client, request, 2), "interrupted": True}
        except TimeoutError:
            raise KernelLost(f"took more than {seconds:g} s") from None

    async def _reply(self, client: AsyncKernelClient, request: str, seconds: float) -> dict:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                message = await client.get_shell_msg(timeout=min(left, 0.3))
            except queue.Empty:
                if not await self.manager.is_alive():
                    raise KernelLost("the kernel died") from None
                if self._flooded():
                    raise KernelLost("the kernel wrote too many files") from None
                continue
            except Exception:  # not a message of the protocol
                raise KernelLost("the kernel sent something malformed") from None
            if message["parent_header"].get("msg_id") == request:
                return message["content"]
        raise TimeoutError

    def _flooded(self) -> bool:
        try:
            sizes = [entry.stat(follow_symlinks=False).st_size for entry in os.scandir(self.folder)]
        except OSError:
            return True
        return len(sizes) > 50 or sum(sizes) > SHARED

    async def stop(self) -> None:
        if self.client is not None:
            self.client.stop_channels()
            self.client.context.destroy(linger=0)
        process = getattr(self.manager.provisioner, "process", None)
        if process is not None:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            with contextlib.suppress(Exception):  # it is dead, and its folder goes next
                await asyncio.wait_for(self.manager.shutdown_kernel(now=True), 5)
        subprocess.run(["rm", "-rf", self.folder], capture_output=True)  # at any depth, whatever is in it


def _command(folder: str, library: Path, limits: Limits, program: str | None) -> list[str]:
    home = "/tmp/home" if program else f"{folder}/home"
    environment = {
        "HOME": home,
        "PATH": f"{Path(sys.executable).parent}:/usr/bin:/bin",
        "PYTHONPATH": str(library),
        "PYTHONDONTWRITEBYTECODE": "1",
        "IPYTHONDIR": f"{home}/.ipython",
        "MPLCONFIGDIR": f"{home}/.matplotlib",
        "MPLBACKEND": "agg",
        "LANG": "C.UTF-8",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "PYDEVD_DISABLE_FILE_VALIDATION": "1",
    }
    kernel = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    kernel += ["--HistoryManager.enabled=False", "--InteractiveShell.xmode=Minimal"]
    if shutil.which("prlimit"):
        asked = {
            "as": limits.memory,
            "fsize": limits.home,
            "cpu": limits.cpu,
            "nproc": limits.processes,
            "core": 0,
        }
        kernel = ["prlimit", *(f"--{name}={value}" for name, value in asked.items()), *kernel]
    if program is None:
        Path(home).mkdir()
        return ["env", "-i", *(f"{name}={value}" for name, value in environment.items()), *kernel]
    box = [program, "--unshare-all", "--die-with-parent", "--new-session", "--cap-drop", "ALL"]
    box += ["--hostname", "box", "--clearenv", "--proc", "/proc", "--dev", "/dev"]
    # first, because the course itself may lie in /tmp
    box += ["--size", str(limits.home), "--tmpfs", "/tmp", "--size", str(limits.home), "--tmpfs", "/dev/shm"]
    for path in _visible():
        box += ["--ro-bind", path, path]
    if "site-packages" in PACKAGE.parts:  # installed, not beside its notebooks: hide the real library
        box += ["--tmpfs", str(PACKAGE)]
    for name, value in environment.items():
        box += ["--setenv", name, value]
    for fonts in _font_lists():  # finding all fonts anew would cost every kernel seconds
        box += ["--ro-bind", str(fonts), f"{home}/.matplotlib/{fonts.name}"]
    box += ["--ro-bind", str(library), str(library), "--bind", folder, folder, "--dir", home, "--chdir", home]
    return [*box, "--remount-ro", "/", "--remount-ro", "/dev", *kernel]


def _visible() -> list[str]:
    """What a Python needs, and nothing of the course (whose environment may keep JupyterLab's tokens)."""
    system = ["/usr", "/bin", "/lib", "/lib64", "/etc/ld.so.cache", "/etc/fonts"]
    parts = ("bin", "lib", "lib64", "pyvenv.cfg")
    python = sorted(f"{prefix}/{part}" for prefix in {sys.prefix, sys.base_prefix} for part in parts)
    return [path for path in [*system, *python] if os.path.exists(path)]


def _font_lists() -> list[Path]:
    """matplotlib's list of fonts, if it was ever imported here."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folders = [Path(os.environ.get("MPLCONFIGDIR") or cache / "matplotlib"), cache / "matplotlib"]
    return next((found for folder in folders if (found := list(folder.glob("fontlist-*.json")))), [])
