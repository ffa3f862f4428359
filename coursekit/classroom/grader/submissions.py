"""What is handed in: SUBMISSIONS/<student>/<notebook>.ipynb, copied before any student's code runs."""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from collections import defaultdict
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

from . import collect
from .cells import LARGEST
from .collect import ARCHIVES
from .naming import printable


class Submissions:
    """Copies of all notebooks in a private folder.

    names : {unit: name of its notebook}
    out : where grades go; if that is in `folder`, it is nobody's
    others : students without a folder: the roster's, and those of earlier runs

    ValueError if there is no student's folder, but something else that was handed in.
    """

    def __init__(
        self, folder: Path, copies: Path, names: dict[str, str], out: Path, others: Iterable[str] = ()
    ) -> None:
        self._copies = copies
        self._times: dict[tuple[str, str], tuple[str, bool]] = {}
        self._numbers: dict[str, int] = {}  # a student's name need not be fit for a path
        self._notes: dict[tuple[str, str], str] = {}
        students, self.strays = _students(folder, out)
        if self.strays and not students:
            raise ValueError(
                f"{folder} holds files ({self.strays[0]}, ...) and no folder for each student. "
                f"`coursekit collect {folder} NEW` makes one of what a learning platform hands out"
            )
        links = _linked(students, names.values())
        for number, student in enumerate(students):
            self._numbers[student.name] = number
            for unit, name in names.items():
                note = links.get(student / name) or _copy(
                    student, name, self._path(student.name, unit), set(names.values())
                )
                self._notes[student.name, unit] = printable(note)
                self._times[student.name, unit] = _time(student / name), False
        for student_name in sorted(set(others) - self._numbers.keys()):
            self._numbers[student_name] = len(self._numbers)
            for unit in names:
                self._notes[student_name, unit] = "nothing handed in"
        deeper = [path for student in students for path in _deeper(student, set(names.values()))]
        if deeper and all(self._notes.values()):
            raise ValueError(
                f"no student's folder in {folder} holds a notebook, but folders in them do ({deeper[0]}): "
                f"`coursekit collect {folder} NEW` makes a folder of submissions of that"
            )
        units = {name: unit for unit, name in names.items()}
        self._table = collect.read_table(folder)
        for row in self._table:
            key = row["student"], units.get(row["notebook"], "")
            if key in self._times:
                self._times[key] = row["submitted"] or self._times[key][0], bool(row["late"])

    @property
    def students(self) -> list[str]:
        """Everybody who has a folder, in alphabetical order."""
        return sorted(self._numbers)

    def platform(self, which: str) -> dict[str, str]:
        """{student: number that "canvas" or "moodle" has for them}, where collected files told it."""
        return {row["student"]: row[which] for row in self._table if row[which]}

    def time(self, student: str, unit: str) -> tuple[str, bool]:
        """(when it was handed in, does the learning platform call it late?).

        From collected.csv, else the time of the file; '' if that is not known.
        """
        return self._times.get((student, unit), ("", False))

    def data(self, student: str, unit: str) -> bytes | None:
        """The notebook's bytes, None if there is nothing to grade; then `note` says why."""
        return None if self._notes[student, unit] else self._path(student, unit).read_bytes()

    def note(self, student: str, unit: str) -> str:
        """Why there is nothing to grade, '' if there is."""
        return self._notes[student, unit]

    def _path(self, student: str, unit: str) -> Path:
        return self._copies / f"{self._numbers[student]}-{unit}"


def _time(path: Path) -> str:
    try:
        return datetime.fromtimestamp(os.lstat(path).st_mtime).isoformat(" ", "seconds")
    except (OSError, OverflowError, ValueError):
        return ""


def digest(data: bytes | None) -> str:
    """What tells one version of a submission from another."""
    return "" if data is None else hashlib.sha256(data).hexdigest()


def _students(folder: Path, out: Path) -> tuple[list[Path], list[str]]:
    """Folders of students, in alphabetical order, and names of notebooks and archives beside them."""
    students, strays = [], []
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or path.name == "__MACOSX" or path.resolve() == out.resolve():
            continue  # what JupyterLab, macOS and we leave
        if path.is_dir() or path.is_symlink():
            students.append(path)
        elif path.suffix.lower() in (".ipynb", *ARCHIVES):
            strays.append(path.name)
    return students, strays


def _linked(students: list[Path], names: Iterable[str]) -> dict[Path, str]:
    """{path: why not} of files that are somebody else's under a second name: hard links."""
    notes, owners = {}, defaultdict(list)
    for path in (student / name for student in students for name in names):
        try:
            file, folder = os.lstat(path), os.lstat(path.parent)
        except OSError:
            continue
        if file.st_nlink > 1 and stat.S_ISREG(file.st_mode):
            owners[file.st_dev, file.st_ino].append((path, file.st_uid == folder.st_uid))
    for found in owners.values():
        whose = [path for path, own in found if own]
        for path, own in found:
            if not own or len(whose) > 1:
                others = ", ".join(other.parent.name for other, _ in found if other != path)
                notes[path] = f"a hard link ({others or 'to a file elsewhere'}): not followed, hand in a copy"
    return notes


def _copy(student: Path, name: str, target: Path, expected: set[str]) -> str:
    """'' or why there is no copy. A link is never followed: it may point to somebody else's work."""
    if student.is_symlink():
        return "the student's folder is a link: not followed"
    try:
        with open(student / name, "rb", opener=_without_following) as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                return "not a regular file"
            data = file.read(LARGEST + 1)
    except FileNotFoundError:
        others = []
        with contextlib.suppress(OSError):  # a folder that its student lets nobody list, say
            others = sorted(
                path.name
                for path in student.iterdir()
                if path.suffix.lower() in (".ipynb", *ARCHIVES) and path.name not in expected
            )
            others += [str(path.relative_to(student)) for path in _deeper(student, {name})]
        found = f" under the name {name} (found: {', '.join(others[:5])})" if others else ""
        return "nothing handed in" + found
    except OSError:
        return "not a file that can be read, or a link (not followed)"
    if len(data) > LARGEST:
        return "the notebook is larger than 20 MB"
    target.write_bytes(data)
    return ""


def _deeper(student: Path, names: set[str]) -> list[Path]:
    """Notebooks of the course in a folder of the student's folder: where a release has them, say."""
    with contextlib.suppress(OSError):
        folders = [path for path in student.iterdir() if path.is_dir() and path.name[:1] not in "._"]
        return [path / name for path in sorted(folders) for name in sorted(names) if (path / name).exists()]
    return []


def _without_following(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
