"""In which line a wrong answer goes wrong: the student's own `check`, run after the grading.

It runs in a box that holds the students' release and no hidden input: their code and ours share a process
there, so that what comes out is advice, never points. A function is searched once, however many hand it in.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import json
import re
import shutil
import time
from pathlib import Path

from ..author import release
from ..course import Course
from . import cells
from .box import Box, BoxLost, Limits
from .locked import INSIDE
from .reply import clean

SEARCHED = ("placed", "different")  # verdicts that do not say what is wrong
CELLS = 10.0  # seconds for what the function needs
SECONDS = 20.0  # for one search; it ends by itself after some two


class Clinic:
    """Finds lines, for one worker's whole life."""

    def __init__(self, folder: Path, limits: Limits, program: str | None) -> None:
        self._folder, self._limits, self._program = folder, limits, program
        self._found: dict[str, str] = {}
        self.cpu = 0.0  # seconds of its boxes

    def lines(self, course: Course, sources: list[str], names: list[str]) -> dict[str, str]:
        """{exercise: "look at line 4: a sign"}, of those for which a line is found."""
        if sum(map(len, sources)) > cells.LONGEST:  # nobody writes that much
            return {}
        found = {name: self._line(course, cells.needed(sources, name), name) for name in names}
        return {name: text for name, text in found.items() if text}

    def _line(self, course: Course, sources: list[str], name: str) -> str:
        """What is run decides what is kept: nobody writes on the page of whoever has the same function."""
        trees = [ast.dump(cells.parsed(source)) for source in sources]  # without spaces and comments
        told = json.dumps([course.place, name, *(tree for tree in trees if tree != _NOTHING)])
        key = hashlib.sha256(told.encode()).hexdigest()
        if key not in self._found:
            self._found[key] = ""
            with contextlib.suppress(OSError, BoxLost):  # no advice then
                self._found[key] = self._search(course, sources, name)
        return self._found[key]

    def _search(self, course: Course, sources: list[str], name: str) -> str:
        box = Box(self._library(course), self._limits, self._program, released=True)
        end = time.monotonic() + CELLS
        try:
            for number, source in enumerate(sources):
                if source.strip("#\n"):
                    box.ask({"run": source, "name": f"<cell {number + 1}>"}, min(5.0, end - time.monotonic()))
                if time.monotonic() > end:
                    return ""
            said = box.ask({"diagnose": name}, SECONDS).get("said")
        finally:
            box.close()
            self.cpu += box.cpu
        return clean(said) if isinstance(said, str) and re.search(r"\bline \d+", said) else ""

    def _library(self, course: Course) -> Path:
        """The students' release, with the runner beside the package."""
        name = hashlib.sha256(json.dumps(course.place).encode()).hexdigest()[:8]
        folder = self._folder / f"students-{name}"
        if not folder.exists():
            release.release(folder, course)
            shutil.copy(INSIDE / "runner.py", folder / "runner.py")
        return folder


_NOTHING = ast.dump(cells.parsed(""))
