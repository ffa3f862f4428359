"""The grader's memory: one line for each graded submission, on disk before the next one is begun."""

from __future__ import annotations

import json
import os
from pathlib import Path


class Journal:
    """OUT/journal.jsonl. In memory is only where each line stands, so that a class of any size fits.

    Its first line says which run it belongs to (seed, box); ValueError if that is another one.
    """

    def __init__(self, path: Path, run: dict) -> None:
        self._file = open(path, "a+b")  # noqa: SIM115 - close() closes it
        self._where: dict[tuple[str, str], tuple[int, str | None]] = {}
        self._file.seek(0)
        head = self._file.readline()
        if not head.endswith(b"\n"):
            self._file.truncate(0)
            self._append(run)
        elif json.loads(head) != run:
            self._file.close()
            raise ValueError(
                f"{path.parent} holds another run, {head.decode().strip()}: give an empty folder"
            )
        else:
            self._read()

    def holds(self, student: str, unit: str, digest: str) -> bool:
        """Is this very submission graded?"""
        return self._where.get((student, unit), (0, None))[1] == digest

    def add(self, record: dict) -> None:
        self._note(record, self._append(record))

    def record(self, student: str, unit: str) -> dict:
        """The last record of a student's unit."""
        self._file.seek(self._where[student, unit][0])
        return json.loads(self._file.readline())

    def close(self) -> None:
        self._file.close()

    def _read(self) -> None:
        position = self._file.tell()
        for line in iter(self._file.readline, b""):
            if not line.endswith(b"\n"):  # the grader was killed while it wrote
                self._file.truncate(position)
                break
            self._note(json.loads(line), position)
            position = self._file.tell()

    def _note(self, record: dict, position: int) -> None:
        digest = None if record.get("failed") else record["digest"]  # what failed is tried again next time
        self._where[record["student"], record["unit"]] = (position, digest)

    def _append(self, record: dict) -> int:
        self._file.seek(0, os.SEEK_END)
        position = self._file.tell()
        self._file.write(json.dumps(record).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())
        return position
