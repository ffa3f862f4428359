"""A student's notebook in a boxed kernel, and how it is asked for answers.

This runs in the worker, which is trusted. Nothing the kernel says is: replies are read by `reply.decode`.
"""

from __future__ import annotations

import json
import secrets
import time
from pathlib import Path

from ..attempt import Attempt
from ..exercise import Exercise
from . import cells
from .box import Box, KernelLost, Limits
from .reply import LARGEST, decode, expression

# Runs in the student's kernel. Anything there may have been tampered with: that makes wrong answers, no more.
ASK = """
def _answers(name, calls, several, arguments):
    import base64
    import copy
    import json

    import numpy as np

    def thaw(x):
        if isinstance(x, dict):
            from coursekit import robots

            ((what, which),) = x.items()
            robot = getattr(robots, which)()
            return robot if what == "robot" else robot.fk
        if isinstance(x, list):
            array = np.array(x)
            return array if array.dtype.kind in "if" else x
        return x

    def numbers(value):
        if value is None:
            raise TypeError("the function returns None")
        array = np.asarray(value)
        if array.dtype.kind not in "biuf":
            raise TypeError("the answer has dtype " + str(array.dtype) + "; real numbers are expected")
        if array.size > {largest}:
            raise TypeError("the answer has " + str(array.size) + " numbers")
        return dict(shape=list(array.shape), values=[repr(float(x)) for x in array.ravel()])

    if not callable(globals().get(name)):
        raise NameError(name)
    answers = []
    for call in json.loads(calls):
        try:
            given = [thaw(x) for x in call]
            before = [copy.deepcopy(x) if isinstance(x, (np.ndarray, list)) else None for x in given]
            value = globals()[name](*given)
            changed = [
                n for n, a, b in zip(arguments, before, given) if a is not None and not np.array_equal(a, b)
            ]
            if several and (not isinstance(value, (tuple, list)) or len(value) != several):
                raise TypeError(str(several) + " things are expected")
            parts = [numbers(x) for x in (value if several else [value])]
            answers.append(dict(parts=parts, changed=(changed or [""])[0]))
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            answers.append(dict(error=type(error).__name__, text=str(error)[:200]))
    return base64.b64encode(json.dumps(answers).encode()).decode()
""".replace("{largest}", str(LARGEST))


class Student:
    """The student's notebook, run in a kernel; in another one if that is lost, without what lost it."""

    def __init__(
        self, sources: list[str], library: Path, limits: Limits, program: str | None, exercises: int
    ) -> None:
        self.sources, self.library, self.limits, self.program = sources, library, limits, program
        self.left = exercises + 2  # kernels
        self.end = time.monotonic() + limits.submission
        self.starts = 0
        self.deadly: dict[int, int] = {}  # cell -> 1: only its definitions are run, 2: nothing of it
        self.box: Box | None = None

    @property
    def notes(self) -> list[str]:
        return [f"code cell {i + 1} hangs or ends the kernel; it was left out" for i in sorted(self.deadly)]

    async def ask(self, exercise: Exercise, inputs: list[list]) -> list[Attempt]:
        """What the kernel answers to each call; KernelLost, or ValueError if that is malformed."""
        while self.box is None:
            await self._run_notebook()
        if time.monotonic() > self.end:
            raise KernelLost(f"the notebook took more than {self.limits.submission:g} s")
        nonce = secrets.token_hex(8)
        several = len(exercise.shapes) if exercise.several else 0
        call = f"_answers({exercise.name!r}, {json.dumps(inputs)!r}, {several}, {exercise.arguments!r})"
        try:
            reply = await self.box.run(ASK, exercise.timeout, f"{nonce!r} + {call}")
        except KernelLost:
            await self.stop()
            raise
        if reply.get("interrupted"):
            raise ValueError(f"took more than {exercise.timeout:g} s for {len(inputs)} inputs")
        return decode(reply, nonce, exercise, len(inputs))

    async def _run_notebook(self) -> None:
        if self.left == 0 or time.monotonic() > self.end:
            raise KernelLost("the notebook loses every kernel, or took too long")
        self.left -= 1
        self.starts += 1
        self.box = Box(self.library, self.limits, self.program)
        try:
            await self.box.start()
        except (KernelLost, TimeoutError) as error:
            raise RuntimeError("no kernel could be started") from error  # nothing of the student's ran yet
        end = min(time.monotonic() + self.limits.notebook, self.end)
        for number, source in enumerate(self.sources):
            seconds = min(self.limits.cell, end - time.monotonic())
            if seconds < 0:
                return  # what the cells so far define is what there is
            harm = self.deadly.get(number, 0)
            try:
                if harm < 2:
                    await self._run_cell(self.box, cells.definitions(source, 0) if harm else source, seconds)
            except KernelLost:
                self.deadly[number] = harm + 1
                await self.stop()
                return  # the caller tries again

    async def _run_cell(self, box: Box, source: str, seconds: float) -> None:
        """After an error, definitions further down still run: demonstrations fail without the library."""
        line = 0
        while (await box.run(source, seconds)).get("status") == "error":
            failed = _number(expression(await box.run("", 2, cells.FAILED_LINE)))
            if failed <= line:
                return
            line = failed
            source = cells.definitions(source, line)

    async def stop(self) -> None:
        if self.box is not None:
            await self.box.stop()
        self.box = None


def _number(text: str) -> int:
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else 0
