"""What a box uses of the machine, seen from outside while it runs, in /proc."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path

IN_MEMORY = ("/tmp", "/dev/shm")  # where a box can write


def family(root: int) -> list[int]:
    """A process and its descendants, whatever they call themselves."""
    children: dict[int, list[int]] = {}
    for pid, parent in _parents():
        children.setdefault(parent, []).append(pid)
    found, waiting = [], [root]
    while waiting:
        pid = waiting.pop()
        found.append(pid)
        waiting += children.get(pid, ())
    return found


def used(pids: list[int]) -> int:
    """Bytes of memory of a box's processes, of its files in memory, and of what its sockets can hold."""
    total, sockets, files = 0, dict[int, str](), dict[int, int]()
    here = _network("self")
    for pid in pids:
        # thread by thread: the first of them may be gone
        total += max((_resident(task) for task in _tasks(pid)), default=0)
        if (network := _network(pid)) not in (here, 0):
            sockets[network] = f"/proc/{pid}/net/unix"
        for folder in IN_MEMORY:
            with contextlib.suppress(OSError):
                if (device := os.stat(place := f"/proc/{pid}/root{folder}").st_dev) != os.stat(folder).st_dev:
                    files[device] = _in_files(os.statvfs(place))
    return total + sum(files.values()) + sum(map(_lines, sockets.values())) * _of_a_socket()


def busy(pids: list[int]) -> int:
    """Threads that run, or wait for a processor."""
    return sum(_stat(task)[:1] == [b"R"] for pid in pids for task in _tasks(pid))


def cpu(pids: list[int]) -> float:
    """Seconds of processor time of those that are alive."""
    ticks = 0
    for pid in pids:
        with contextlib.suppress(ValueError, IndexError):
            fields = _stat(f"/proc/{pid}")
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def _parents() -> Iterator[tuple[int, int]]:
    with contextlib.suppress(OSError):
        for name in os.listdir("/proc"):
            if name.isdigit():
                with contextlib.suppress(ValueError, IndexError):
                    yield int(name), int(_stat(f"/proc/{name}")[1])


def _stat(place: str) -> list[bytes]:
    """What the kernel says of a process or thread, from its state on; [] if it is gone."""
    try:  # the name before that may be anything
        return Path(f"{place}/stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return []


def _tasks(pid: int) -> list[str]:
    try:
        return [f"/proc/{pid}/task/{task}" for task in os.listdir(f"/proc/{pid}/task")]
    except OSError:
        return []


def _resident(task: str) -> int:
    with contextlib.suppress(OSError, ValueError, IndexError):
        return int(Path(f"{task}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return 0


def _network(pid: int | str) -> int:
    """What tells its network from others, 0 if it is gone: each has a list of sockets of its own."""
    try:
        return os.stat(f"/proc/{pid}/net/unix").st_ino
    except OSError:
        return 0


def _lines(place: str) -> int:
    """The sockets of a network, also those that no process has open: below a line with titles."""
    with contextlib.suppress(OSError):
        return Path(place).read_bytes().count(b"\n") - 1
    return 0


def _in_files(system: os.statvfs_result) -> int:
    """Also an empty file takes about a kilobyte, and the system's size does not limit their number."""
    used = (system.f_blocks - system.f_bfree) * system.f_frsize
    return used + 1024 * (system.f_files - system.f_ffree)


@cache
def _of_a_socket() -> int:
    """Bytes that a socket can hold at most: nobody else counts them."""
    return 2 * int(Path("/proc/sys/net/core/wmem_max").read_text())
