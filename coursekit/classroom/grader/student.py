"""A student's notebook in its box, and how it is asked for answers.

This runs in the worker, which is trusted. Nothing the box says is: replies are read by `reply`.
"""

from __future__ import annotations

import time
from pathlib import Path

from ..attempt import Attempt
from ..exercise import Exercise
from . import cells
from .box import Box, BoxLost, Limits
from .reply import decode, failed_line


class Student:
    """The student's notebook, run in a box; in another one if that is lost, without what lost it."""

    def __init__(
        self,
        sources: list[str],
        library: Path,
        limits: Limits,
        program: str | None,
        exercises: int,
        set_up: str = "",
    ) -> None:
        self.set_up = set_up  # the course's own: a student who deleted the imports passed all checks before
        self.sources, self.library, self.limits, self.program = sources, library, limits, program
        self.left = exercises + 2  # boxes
        self.end = time.monotonic() + limits.submission
        self.starts = 0
        self.cpu = 0.0  # seconds of all its boxes
        self.deadly: dict[int, int] = {}  # cell -> 1: only its definitions are run, 2: nothing of it
        self.late = False  # the notebook's time was over before its last cell
        self.box: Box | None = None
        self.replaced: tuple[list[str], list[str]] = [], []

    @property
    def notes(self) -> list[str]:
        """What an instructor should know of the run."""
        lost = [f"code cell {i + 1} hangs or ends the kernel; it was left out" for i in sorted(self.deadly)]
        slow = f"the cells took more than {self.limits.notebook:g} s; below that only definitions were run"
        return [*lost, *([slow] if self.late else [])]

    def replace(self, sources: list[str], names: list[str]) -> None:
        """In a new box, put what these sources define in the place of the student's functions."""
        self.close()
        self.left = max(self.left, 1)
        self.replaced = sources, names

    def ask(
        self, exercise: Exercise, inputs: list[list], methods: tuple[str, list[str]] | None = None
    ) -> list[Attempt]:
        """What the student's function answers to each call; BoxLost, or ValueError if that is malformed.

        methods : what robots can do for this question: source, and the names of the functions in it
        """
        while self.box is None:
            self._run_notebook()
        if time.monotonic() > self.end:
            raise BoxLost(f"the notebook took more than {self.limits.submission:g} s")
        request = {
            "ask": exercise.name,
            "calls": inputs,
            "several": len(exercise.shapes) if exercise.several else 0,
            "arguments": exercise.arguments,
            "methods": methods,
        }
        try:
            reply = self.box.ask(request, exercise.timeout)
        except BoxLost:
            self.close()
            raise
        if reply.get("late"):
            raise ValueError(f"took more than {exercise.timeout:g} s for {len(inputs)} inputs")
        return decode(reply, exercise, len(inputs))

    def _run_notebook(self) -> None:
        if self.left == 0 or time.monotonic() > self.end:
            raise BoxLost("the notebook loses every kernel, or took too long")
        self.left -= 1
        self.starts += 1
        self.box = Box(self.library, self.limits, self.program)
        self.box.ask({"run": self.set_up, "name": "<set-up>"}, self.limits.cell)
        end = min(time.monotonic() + self.limits.notebook, self.end)
        for number, source in enumerate(self.sources):
            if time.monotonic() > self.end:  # slow definitions, say
                self.close()
                raise BoxLost(f"the notebook took more than {self.limits.submission:g} s")
            left = end - time.monotonic()
            self.late = self.late or left < 0
            harm = self.deadly.get(number, 1 if left < 0 else 0)
            # what stands below slow demonstrations is still defined
            seconds = min(self.limits.cell, max(left, 2.0))
            try:
                if harm < 2:
                    self._run_cell(
                        self.box, number, cells.definitions(source, 0) if harm else source, seconds
                    )
            except BoxLost:
                self.deadly[number] = self.deadly.get(number, 0) + 1
                self.close()
                return  # the caller tries again
        if self.replaced[1]:
            self.box.ask({"replace": self.replaced[0], "names": self.replaced[1]}, self.limits.cell)

    def _run_cell(self, box: Box, number: int, source: str, seconds: float) -> None:
        """After an error, definitions further down still run: demonstrations fail without the library."""
        line, end = 0, time.monotonic() + seconds
        while True:
            left = max(end - time.monotonic(), 1.0)
            failed = failed_line(box.ask({"run": source, "name": f"<cell {number + 1}>"}, left))
            if failed <= line or time.monotonic() > end + 5:
                return
            line = failed
            source = cells.definitions(source, line)

    def close(self) -> None:
        """End the box."""
        if self.box is not None:
            self.box.close()
            self.cpu += self.box.cpu
        self.box = None
