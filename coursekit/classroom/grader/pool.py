"""Workers that stay for a whole class: one process for every thread that grades.

Making one costs a second, and the inputs and right answers that it works out serve every submission.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading


def grade(job: dict, seconds: float) -> dict:
    """The result of a job, from this thread's worker; WorkerLost if there is none in time."""
    mine = getattr(_mine, "worker", None)
    if mine is None or not mine.alive:
        mine = _mine.worker = Worker()
        _all.add(mine)
    try:
        return mine.grade(job, seconds)
    except WorkerLost:
        mine.close()
        raise


def close() -> None:
    """End the workers of all threads of this process."""
    for one in list(_all):
        one.close()
        _all.discard(one)


class WorkerLost(Exception):
    """The worker died, or gave no result in time."""


class Worker:
    """A process that grades one job after the other, and never runs a line of a student's."""

    def __init__(self) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - no pipe: nobody would read it
        self._process = subprocess.Popen(
            [sys.executable, "-m", "coursekit.classroom.grader.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            start_new_session=True,
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        )

    @property
    def alive(self) -> bool:
        """Can it take a job?"""
        return self._process.poll() is None

    def grade(self, job: dict, seconds: float) -> dict:
        """The result of a job; WorkerLost if there is none in time."""
        alarm = threading.Timer(seconds, self._process.kill)
        alarm.start()
        try:
            self._process.stdin.write(json.dumps(job).encode() + b"\n")  # type: ignore[union-attr]
            self._process.stdin.flush()  # type: ignore[union-attr]
            return json.loads(self._process.stdout.readline())  # type: ignore[union-attr]
        except (ValueError, OSError):
            late = not alarm.is_alive()
            raise WorkerLost(f"no result within {seconds:g} s" if late else self._last_words()) from None
        finally:
            alarm.cancel()

    def _last_words(self) -> str:
        code = self._process.wait()
        self._errors.seek(0)
        lines = self._errors.read()[-2000:].decode(errors="replace").strip().splitlines()
        return f"exit code {code}: {lines[-1] if lines else ''}"

    def close(self) -> None:
        """End it, and its box."""
        with contextlib.suppress(OSError):
            self._process.stdin.close()  # type: ignore[union-attr]
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(2)  # it removes its folder and goes
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._process.stdout.close()  # type: ignore[union-attr]
        self._errors.close()


_mine = threading.local()
_all: set[Worker] = set()
