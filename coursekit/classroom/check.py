"""`check("dh_transform", dh_transform)`: what is wrong with your function, as exactly as can be said.

A student's function goes a short way: `check` finds the exercise and its public examples, `attempt` calls the
function on each, `verdict` climbs one ladder of questions until it has an answer, and `told` writes it down,
short first: more is told to who asks.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np

from .attempt import Attempt, attempt
from .course import Course, course_here
from .exercise import Exercise, thaw
from .panel import offer
from .question import remember
from .source import not_run, own
from .told import LEVELS, told
from .verdict import Example, Verdict, verdict

MARKS = {"right": "✓", "unwritten": "…"}  # any other kind: ✗
_mended: dict[str, str] = {}  # exercise -> what was last said to be wrong with it


class CheckFailed(AssertionError):
    """A check failed where none may: in CI, which runs the solved notebooks."""


@dataclass(frozen=True)
class Diagnosis:
    """What `diagnose` returns: `.right`, `.kind` and everything that can be said in `.text`.

    kind : right; unwritten, error, misfit (it cannot be judged); library (right, but it calls what it should
           write); named (the mistake has a name, or a line); placed (what is right already, or by how much
           the rest misses); different (no more than that it is wrong)
    say  : the shortest true sentence, the first of the text
    """

    kind: str
    text: str
    say: str = ""

    @property
    def right(self) -> bool:
        return self.kind == "right"


def check(name: str, function: Callable, show: str | None = None) -> None:
    """Say whether a function you wrote is right and, if not, what is wrong with it.

    Parameters
    ----------
    name : the exercise's name, a string, usually the function's own
    function : the function itself, not a call of it
    show : how much is told: None the shortest true sentence, "more" where to look again, "example" one
           example with your answer and the right one, "all" everything

    Prints a few lines; returns None. ValueError if there is no such exercise or level. Where the environment
    variable CI is set, a failing check raises `CheckFailed`.

    >>> from coursekit import check
    >>> check("home_pose", lambda lengths: None)                                        # doctest: +SKIP
    ✗ home_pose: it returns None: is there a `return` at its end?
    """
    if show not in LEVELS:
        raise ValueError(f"show={show!r} is no level; there are: {', '.join(repr(k) for k in LEVELS if k)}")
    work = _Work(name, function)
    found = work.verdict
    if printed := next((a.printed for a in work.attempts if a.printed), ""):
        print(printed[:2000].rstrip("\n"))
    text = work.text(function, show)
    if found.right:
        remember(name)
        if before := _mended.pop(name, ""):
            text += f"; it was {before}"
    if not found.right:
        _mended[name] = found.mended
    if why := not_run(name):
        print(
            f"✗ {name}: your newest cell with it has a syntax error and did not run: {why}. The one before:"
        )
    print(f"{MARKS.get(found.kind, '✗')} {name}: {text}")
    if os.environ.get("CI") and not found.right:
        raise CheckFailed(f"{name}: {text}")
    if not found.right and found.kind != "unwritten" and show is None:
        further = {"more": "more", "an example": "example"}
        offer(work.png(), {label: partial(work.text, function, level) for label, level in further.items()})


def diagnose(name: str, function: Callable) -> Diagnosis:
    """The same as data, with everything that can be said; prints nothing and remembers nothing.

    name and function as in `check`.

    >>> from coursekit import classroom
    >>> classroom.diagnose("home_pose", lambda lengths: None).kind
    'misfit'
    """
    work = _Work(name, function)
    return Diagnosis(work.verdict.kind, work.text(function, "all"), work.verdict.say)


def example(name: str, number: int) -> list:
    """The arguments of a public example, for a call of your own: `fk_dh(*example("fk_dh", 0))`.

    name of the exercise, number of the example from 0.

    >>> from coursekit import classroom
    >>> len(classroom.example("dh_transform", 0))
    4
    """
    unit, exercise = _ours().find(name)
    rows = examples_of(exercise, _ours().samples(unit).get(name, {}))
    if not 0 <= number < len(rows):
        raise ValueError(f"{name} has examples 0 to {len(rows) - 1}; example {number} was asked for")
    return thaw(rows[number].arguments)


def demand(name: str, function: Callable, table: list[dict]) -> None:
    """For graders that wait for an exception: CheckFailed unless the function is right on this table."""
    work = _Work(name, function, table)
    if not work.verdict.right:
        raise CheckFailed(f"{name}: {work.verdict.say}")


def examples_of(exercise: Exercise, table: dict) -> list[Example]:
    """The examples of a sample table, as `author.tables` writes them."""

    def arrays(parts: list) -> tuple[np.ndarray, ...]:
        return tuple(np.array(part, dtype=float) for part in parts)

    return [
        Example(
            exercise,
            row["case"],
            row["args"],
            arrays(row["right"]),
            {key: arrays(parts) for key, parts in row["wrong"].items()},
            row.get("tol", exercise.tol),
        )
        for row in table.get("examples", ())
    ]


def _ours() -> Course:
    return _course_of(Path.cwd())


@cache
def _course_of(folder: Path) -> Course:
    return course_here(folder)


class _Work:
    """A function, called on the public examples of its exercise, and what is to be said of it."""

    def __init__(
        self, name: str, function: Callable, table: list[dict] | None = None, above: tuple[str, ...] = ()
    ) -> None:
        unit, self.exercise = _ours().find(name)
        stored = _ours().samples(unit).get(name, {})
        self.place = stored.get("place", "")
        self.examples = examples_of(self.exercise, stored if table is None else {"examples": table})
        self._above = (*above, name)
        self.verdict, self.attempts = judged(
            self.exercise, function, self.examples, _ours().allowed(unit), self._wrong_part
        )

    def text(self, function: Callable, show: str | None) -> str:
        """What is told at a level."""
        return told(self.verdict, self.exercise, function, self.examples, self.attempts, self.place, show)

    def png(self) -> bytes:
        """What there is to see, b'' if there is nothing."""
        if self.exercise.look is None:
            return b""
        from .picture import picture  # matplotlib, only now

        return picture(self.exercise, self.verdict, self.examples, self.attempts)

    def _wrong_part(self, function: Callable) -> Verdict | None:
        """Parts before wholes: a fault in a function that this one calls is told as that one's."""
        function = own(function)[0]
        for part in getattr(getattr(function, "__code__", None), "co_names", ()):
            theirs = getattr(function, "__globals__", {}).get(part)
            module = str(getattr(theirs, "__module__", ""))  # a student may have called anything so
            if part in self._above or not callable(theirs) or module.startswith("coursekit"):
                continue
            if not _ours().has(part):
                continue
            found = _Work(part, theirs, above=self._above).verdict
            if found.kind == "unwritten":
                return Verdict("unwritten", f"write `{part}` first: it calls that")
            if not found.right and found.kind != "library":
                text = f"`{part}`, which it calls, is not right yet: {found.say}"
                return Verdict(found.kind, text, found.more, "part")
        return None


def judged(
    exercise: Exercise,
    function: Callable,
    examples: list[Example],
    allowed: tuple[str, ...] = (),
    wrong_part: Callable[[Callable], Verdict | None] = lambda function: None,
) -> tuple[Verdict, list[Attempt]]:
    """Call a function on all examples; the verdict, and what the calls gave.

    wrong_part : asked first where the function is not right: is it a function that it calls?
    """
    name, attempts = exercise.name, []
    if not callable(function):
        return Verdict("misfit", f'pass the function itself: check("{name}", {name})'), []
    if not examples:
        return Verdict("error", "there are no examples of it (instructors: run `coursekit samples`)"), []
    for example in examples:
        attempts.append(attempt(exercise, function, example.arguments))
        if attempts[-1].endless:  # the others would take as long
            return Verdict("error", attempts[-1].text, step="endless", example=len(attempts) - 1), attempts
    pairs = zip(examples, attempts, strict=True)
    fine = all(not tried.fault and example.agrees(tried.parts) for example, tried in pairs)
    if not fine and (part := wrong_part(function)):
        return part, attempts
    return verdict(exercise, examples, attempts, function, allowed), attempts
