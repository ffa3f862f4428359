"""The grader's memory: one line for each graded submission, on disk before the next one is begun."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Collection
from pathlib import Path


class Journal:
    """OUT/journal.jsonl. In memory is only where each line stands, so that a class of any size fits.

    Its first line says which run it belongs to: the seed, the box, and what decides a grade. ValueError if
    that is another one, if somebody else grades into this folder, or if a line is no record.

    anew : units that are graded anew: what decides their grades may have changed, old records do not count
    aside : keep what is there under another name, and begin a new journal
    """

    def __init__(self, path: Path, run: dict, anew: Collection[str] = (), aside: bool = False) -> None:
        self._path = path
        self._file = open(path, "a+b")  # noqa: SIM115 - close() closes it
        self.proved: set[str] = set()  # set-ups that passed their canaries in this run
        self._graded: set[tuple[str, str]] = set()
        self._lines: dict[tuple[str, str, str], dict[str, str]] = {}  # {(student, unit, digest): advice}
        self._where: dict[tuple[str, str], tuple[int, str | None]] = {}
        try:
            self._lock()
            if aside:
                self._set_aside()
            self._file.seek(0)
            head = self._file.readline()
            if head.endswith(b"\n"):
                self._head = self._parsed(head, 1)
                self._read()
                self._same_run(self._head, run, anew)
            else:
                self._file.truncate(0)
                self._append(run)
        except BaseException:
            self._file.close()
            raise

    def _lock(self) -> None:
        try:
            import fcntl
        except ImportError:  # Windows has none
            return
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise ValueError(
                f"another grader is at work in {self._path.parent}: wait, or name another folder"
            ) from None

    def _same_run(self, before: dict, now: dict, anew: Collection[str]) -> None:
        """What decides a grade may not change under grades that are there, unless those are given anew."""
        changed = [what for what in sorted({*before, *now}) if before.get(what) != now.get(what)]
        if set(changed) <= {*(f"course {unit}" for unit in anew), *(["points"] if anew else [])}:
            if anew:
                self._append({"run": now, "anew": sorted(anew)})
                self.forget(units=anew)
        else:
            changed = [what if what != "points" else _points(before, now) for what in changed]
            raise ValueError(
                f"{self._path.parent} holds another run: {', '.join(changed)} changed since. "
                "Name an empty folder, grade everybody anew with --regrade, or one notebook with "
                "--regrade NOTEBOOK if only its course changed"
            )

    def _parsed(self, line: bytes, number: int) -> dict:
        try:
            record = json.loads(line)
        except ValueError:
            record = None
        if not isinstance(record, dict):
            raise ValueError(
                f"{self._path}, line {number} is no record of the grader's. Remove that line, and the "
                "submission is graded again"
            )
        return record

    @property
    def students(self) -> set[str]:
        """Everybody who was ever graded here."""
        return {student for student, _ in self._where}

    def holds(self, student: str, unit: str, digest: str) -> bool:
        """Is this very submission graded?"""
        return self._where.get((student, unit), (0, None))[1] == digest

    def has_grade(self, student: str, unit: str) -> bool:
        """Was anything that a student handed in graded?"""
        return (student, unit) in self._graded

    def is_forgotten(self, student: str, unit: str) -> bool:
        """Does a grade wait to be given anew?"""
        return self._where.get((student, unit), (0, ""))[1] is None

    def forget(self, students: Collection[str] = (), units: Collection[str] = ()) -> None:
        """Let these be graded anew; until then the old record counts."""
        for key, (position, _) in self._where.items():
            if key[0] in students or key[1] in units:
                self._where[key] = (position, None)
        for one in [one for one in self._lines if one[1] in units]:
            del self._lines[one]

    def add(self, record: dict) -> None:
        self._note(record, self._append(record))

    def is_searched(self, student: str, unit: str, digest: str) -> bool:
        """Is this very submission searched for the lines that are wrong?"""
        return (student, unit, digest) in self._lines

    def add_lines(self, record: dict) -> None:
        """Note which lines are wrong; grades do not depend on it."""
        self._append(record)
        self._note_lines(record)

    def _note_lines(self, record: dict) -> None:
        lines = record["lines"] if isinstance(record["lines"], dict) else {}
        self._lines[record["student"], record["unit"], record.get("digest", "")] = lines

    def prove(self, set_up: str) -> None:
        """Note that right was right and nothing was nothing with this set-up."""
        self._append({"proved": set_up})
        self.proved.add(set_up)

    def record(self, student: str, unit: str) -> dict | None:
        """The last record of a student's unit, None if there is none yet."""
        if (student, unit) not in self._where:
            return None
        position, _ = self._where[student, unit]
        self._file.seek(position)
        record = self._parsed(self._file.readline(), 0)
        for name, line in self._lines.get((student, unit, record.get("digest", "")), {}).items():
            if name in record.get("exercises", {}):
                record["exercises"][name]["line"] = line
        if (record.get("student"), record.get("unit")) != (student, unit):
            raise ValueError(
                f"{self._path} was changed by somebody else: no record of {student}, {unit} is there"
            )
        return record

    def close(self) -> None:
        self._file.close()

    def _read(self) -> None:
        position = self._file.tell()
        for number, line in enumerate(iter(self._file.readline, b""), 2):
            if not line.endswith(b"\n"):  # the grader was killed while it wrote
                self._file.truncate(position)
                break
            record = self._parsed(line, number)
            if isinstance(record.get("proved"), str):
                self.proved.add(record["proved"])
            elif isinstance(record.get("run"), dict) and isinstance(record.get("anew"), list):
                self._head = record["run"]
                self.forget(units=record["anew"])
            elif {"student", "unit", "lines"} <= record.keys():
                self._note_lines(record)
            elif {"student", "unit", "exercises"} <= record.keys():
                self._note(record, position)
            else:
                self._parsed(b"", number)
            position = self._file.tell()

    def _note(self, record: dict, position: int) -> None:
        digest = (
            None if record.get("failed") else record.get("digest")
        )  # what failed is tried again next time
        self._where[record["student"], record["unit"]] = (position, digest)
        if digest:
            self._graded.add((record["student"], record["unit"]))

    def _append(self, record: dict) -> int:
        position = self._file.seek(0, os.SEEK_END)
        data, number = json.dumps(record).encode() + b"\n", self._file.fileno()
        try:
            while data:
                data = data[os.write(number, data) :]
            os.fsync(number)
        except OSError as error:  # the disk is full, say: no half line stays
            os.ftruncate(number, position)
            raise OSError(
                error.errno, f"{error.strerror}; what was graded before is kept", str(self._path)
            ) from None
        return position

    def _set_aside(self) -> None:
        """Under the lock: whoever else grades here keeps the journal."""
        if os.path.getsize(self._path):
            names = (self._path.with_suffix(f".{n}.jsonl") for n in range(1, 10_000))
            shutil.copyfile(self._path, next(name for name in names if not name.exists()))
            self._file.truncate(0)


def _points(before: dict, now: dict) -> str:
    """ "points (tip counts 5, 2 before)": which of them are others now."""
    old, new = before.get("points") or {}, now.get("points") or {}
    names = [name for name in {**old, **new} if old.get(name) != new.get(name)]
    told = (f"{name} counts {new.get(name, 0):g}, {old.get(name, 0):g} before" for name in names)
    return f"points ({'; '.join(told)})"


def seed_of(path: Path) -> int | None:
    """The seed of a journal that is there, None if there is none that can be read."""
    try:
        with open(path, "rb") as file:
            return json.loads(file.readline()).get("seed")
    except (OSError, ValueError, AttributeError):
        return None
