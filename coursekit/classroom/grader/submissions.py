"""What is handed in: SUBMISSIONS/<student>/<notebook>.ipynb, copied before any student's code runs."""

from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path

from .cells import LARGEST


class Submissions:
    """Copies of all notebooks in a private folder.

    names : {unit: name of its notebook}
    """

    def __init__(self, folder: Path, copies: Path, names: dict[str, str]) -> None:
        self._copies = copies
        self._numbers: dict[str, int] = {}  # a student's name need not be fit for a path
        self._notes: dict[tuple[str, str], str] = {}
        for number, student in enumerate(sorted(p for p in folder.iterdir() if p.is_dir() or p.is_symlink())):
            self._numbers[student.name] = number
            for unit, name in names.items():
                note = _copy(student, name, self._path(student.name, unit), set(names.values()))
                self._notes[student.name, unit] = note

    @property
    def students(self) -> list[str]:
        """Everybody who has a folder, in alphabetical order."""
        return list(self._numbers)

    def data(self, student: str, unit: str) -> bytes | None:
        """The notebook's bytes, None if there is nothing to grade; then `note` says why."""
        return None if self._notes[student, unit] else self._path(student, unit).read_bytes()

    def note(self, student: str, unit: str) -> str:
        """Why there is nothing to grade, '' if there is."""
        return self._notes[student, unit]

    def _path(self, student: str, unit: str) -> Path:
        return self._copies / f"{self._numbers[student]}-{unit}"


def digest(data: bytes | None) -> str:
    """What tells one version of a submission from another."""
    return "" if data is None else hashlib.sha256(data).hexdigest()


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
        others = sorted(path.name for path in student.glob("*.ipynb") if path.name not in expected)
        found = f" under the name {name} (found: {', '.join(others[:5])})" if others else ""
        return "nothing handed in" + found
    except OSError:
        return "not a file that can be read, or a link (not followed)"
    if len(data) > LARGEST:
        return "the notebook is larger than 20 MB"
    target.write_bytes(data)
    return ""


def _without_following(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
