"""What the kernel refuses to the box: memory that is held by no process, which nobody could count.

A segment of System V outlives who made it, a file without a name can be sent to oneself through a socket and
closed, a shared mapping's pages stay when the process lets go of them, and so does what was sent to a socket
that nobody has accepted. Notebooks need none of that: only pairs of sockets, with which asyncio wakes itself.
"""

from __future__ import annotations

import errno
import platform
import struct

# {machine: (its number, those of mmap and socketpair, those of what is refused)}: shmget, msgget, semget,
# memfd_create, memfd_secret, sendmsg, sendmmsg (open files travel with them), vmsplice, io_uring_setup,
# socket
_MACHINES = {
    "x86_64": (0xC000003E, 9, 53, (29, 68, 64, 319, 447, 46, 307, 278, 425, 41)),
    "aarch64": (0xC00000B7, 222, 199, (194, 186, 190, 279, 447, 211, 269, 75, 425, 198)),
}
_CALL, _MACHINE, _TYPE_OF_SOCKET, _FLAGS_OF_MMAP = 0, 4, 16 + 8, 16 + 3 * 8  # where the filter finds them
_SHARED_WITHOUT_FILE = 0x01 | 0x20
_KIND, _STREAM = 0x0F, 1  # others of a pair can be taken apart, and then get what anybody sends
_X32 = 0x40000000  # from here on x86 has all its calls a second time

_LOAD, _MASK, _EQUAL, _AT_LEAST, _RETURN = 0x20, 0x54, 0x15, 0x35, 0x06  # (what, operand, skip if so, if not)
_REFUSE, _ALLOW = (_RETURN, 0x00050000 | errno.ENOSYS, 0, 0), (_RETURN, 0x7FFF0000, 0, 0)


def refused() -> bytes:
    """The filter that `bwrap --seccomp` takes; b"" on a machine whose numbers are not known here."""
    if platform.machine() not in _MACHINES:
        return b""
    machine, mmap, socketpair, calls = _MACHINES[platform.machine()]
    steps = [(_LOAD, _MACHINE, 0, 0), (_EQUAL, machine, 1, 0), _REFUSE]
    steps += [(_LOAD, _CALL, 0, 0), (_AT_LEAST, _X32, 0, 1), _REFUSE]
    for call in calls:
        steps += [(_EQUAL, call, 0, 1), _REFUSE]
    steps += [(_EQUAL, socketpair, 0, 4), (_LOAD, _TYPE_OF_SOCKET, 0, 0), (_MASK, _KIND, 0, 0)]
    steps += [(_EQUAL, _STREAM, 1, 0), _REFUSE, (_LOAD, _CALL, 0, 0), (_EQUAL, mmap, 1, 0), _ALLOW]
    steps += [(_LOAD, _FLAGS_OF_MMAP, 0, 0), (_MASK, _SHARED_WITHOUT_FILE, 0, 0)]
    steps += [(_EQUAL, _SHARED_WITHOUT_FILE, 0, 1), _REFUSE, _ALLOW]
    return b"".join(struct.pack("HBBI", what, skip, skip_not, x) for what, x, skip, skip_not in steps)
