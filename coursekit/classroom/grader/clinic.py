"""In which line a wrong answer goes wrong: the student's own `check`, run after the grading.

It runs in a box that holds the students' release and no hidden input: their code and ours share a process
there, so that what comes out is advice, never points. A function is searched once, however many hand it in.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
import shutil
from pathlib import Path

from ..author import release
from ..course import Course
from . import cells, follow_on
from .box import Box, BoxLost, Limits
from .locked import INSIDE
from .reply import clean

SEARCHED = ("placed", "different")  # verdicts that do not say what is wrong
SECONDS = 20.0  # for one search; it ends by itself after some two


class Clinic:
    """Finds lines, for one worker's whole life."""

    def __init__(self, folder: Path, limits: Limits, program: str | None) -> None:
        self._folder, self._limits, self._program = folder, limits, program
        self._found: dict[str, str] = {}
        self.cpu = 0.0  # seconds of its boxes

    def lines(self, course: Course, sources: list[str], names: list[str]) -> dict[str, str]:
        """{exercise: "look at line 4: a sign"}, of those for which a line is found."""
        keys = {name: self._key(course, sources, name) for name in names}
        if unknown := [name for name, key in keys.items() if key not in self._found]:
            self._search(course, sources, {name: keys[name] for name in unknown})
        return {name: text for name, key in keys.items() if (text := self._found[key])}

    def _key(self, course: Course, sources: list[str], name: str) -> str:
        """What tells a function and all that it calls from another: spaces and comments do not."""
        text = hashlib.sha256(json.dumps([course.place, name]).encode())
        reached = {name, *follow_on.reached(name, follow_on.uses(sources))}
        for source in sources:
            for node in ast.walk(_parsed(source)):
                if isinstance(node, ast.FunctionDef) and node.name in reached:
                    text.update(ast.dump(node).encode())
        return text.hexdigest()

    def _search(self, course: Course, sources: list[str], keys: dict[str, str]) -> None:
        self._found |= dict.fromkeys(keys.values(), "")
        try:
            box = Box(self._library(course), self._limits, self._program, released=True)
        except OSError:
            return
        try:
            for number, source in enumerate(sources):
                defined = cells.definitions(source, 0)
                box.ask({"run": defined, "name": f"<cell {number + 1}>"}, 5.0)
            for name, key in keys.items():
                said = box.ask({"diagnose": name}, SECONDS).get("said")
                if isinstance(said, str) and re.search(r"\bline \d+", said):
                    self._found[key] = clean(said)
        except BoxLost:
            pass  # no advice then
        finally:
            box.close()
            self.cpu += box.cpu

    def _library(self, course: Course) -> Path:
        """The students' release, with the runner beside the package."""
        name = hashlib.sha256(json.dumps(course.place).encode()).hexdigest()[:8]
        folder = self._folder / f"students-{name}"
        if not folder.exists():
            release.release(folder, course)
            shutil.copy(INSIDE / "runner.py", folder / "runner.py")
        return folder


def _parsed(source: str) -> ast.AST:
    try:
        return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])
