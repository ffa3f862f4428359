"""`ask("lever").answer(-0.4)`: questions with numbers that change, and the ticks of a notebook's goals.

The questions of notebook 0X and its goals stand in `questions/nb0X.py`. A question draws its numbers from a
seed: in a folder that was released to a student, that student's own; everywhere else the same for all, so
that stored outputs can be compared. What was answered or checked rightly is remembered beside the notebooks
in one small file, which stays there: it is never sent anywhere.
"""

from __future__ import annotations

import contextlib
import json
import numbers
import sys
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .course import course_here, module_at, solved
from .exercise import nearest
from .own import own_seed

PROGRESS = ".coursekit-progress.json"
_done: set[str] = set()  # names of exercises and questions that were right in this kernel


@dataclass(frozen=True)
class Question:
    """A question with numbers that change.

    draw      : draw(rng) -> the numbers (or words) of one draw, by name.
    text      : the question, with {name} for each of them; it says the unit of the answer.
    answer    : answer(**numbers) -> a number, a list of numbers or the letter of a choice.
    slips     : sentence -> wrong answer(**numbers) that it explains.
    tolerance : the largest difference that counts as none.
    """

    name: str
    draw: Callable[[np.random.Generator], Mapping[str, Any]]
    text: str
    answer: Callable[..., Any]
    slips: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    tolerance: float = 1e-3


@dataclass(frozen=True)
class Asked:
    """A question with its numbers, as `ask` returns it."""

    question: Question
    numbers: Mapping[str, Any]

    @property
    def text(self) -> str:
        """The question in words, numbers in their places."""
        return self.question.text.format(**self.numbers)

    def __repr__(self) -> str:
        return self.text

    def answer(self, value: Any, *more: Any) -> None:
        """Print the question and whether `value` is its answer; `...` means: not answered yet.

        A list may come without its brackets. An empty line parts it from the next question.

        >>> from coursekit.classroom import ask
        >>> ask("read_t_ab").answer(...)                                                # doctest: +SKIP
        """
        print(self.text)
        print(self._verdict([value, *more] if more else value), end="\n\n")

    def _verdict(self, value: Any) -> str:
        if value is ...:
            return "… put your answer in place of the dots and run the cell again"
        right, tolerance = self.question.answer(**self.numbers), self.question.tolerance
        if text := _unlike(value, right):
            return f"✗ {text}"
        if _agree(value, right, tolerance):
            remember(self.question.name)
            return "✓ right"
        slips = self.question.slips.items()
        found = (slip for slip, wrong in slips if _agree(value, wrong(**self.numbers), tolerance))
        return f"✗ not yet. {next(found, '') or _slip(value, right, self.text, tolerance)}".rstrip()


def ask(name: str, draw: int = 1) -> Asked:
    """A question of the course by its name.

    Parameters
    ----------
    name : str
        The question's name: `questions/nb01.py` and so on.
    draw : int
        1, 2, 3 ...: other numbers each.

    Raises
    ------
    ValueError
        If there is no such question.

    Examples
    --------
    >>> from coursekit.classroom import ask
    >>> ask("no_such_question")
    Traceback (most recent call last):
        ...
    ValueError: there is no question 'no_such_question'.
    """
    known = {question.name: question for question in _questions()}
    if name not in known:
        raise ValueError(f"there is no question {name!r}.{nearest(name, known)}")
    question = known[name]
    rng = np.random.default_rng([own_seed(), zlib.crc32(name.encode()), int(draw)])
    return Asked(question, dict(question.draw(rng)))


def goals(notebook: str) -> None:
    """Print the goals of a notebook in one line, with a tick for each that is reached.

    A goal is reached when its exercises were right in a check, and its questions were answered rightly, now
    or on another day in this folder.

    Parameters
    ----------
    notebook : str
        "01" to "06"; in a course of one's own the name of the notebook, or what stands before its first _.
    """
    units = (unit for unit in _units() if unit == f"nb{notebook}" or f"{unit}_".startswith(f"{notebook}_"))
    if (unit := next(units, None)) is None:
        raise ValueError(f"there are no goals of a notebook {notebook!r}; there are: {', '.join(_units())}")
    wanted = getattr(_module(unit), "GOALS", {})
    done = _done | _remembered()
    ticks = {goal: all(name in done for name in names) for goal, names in wanted.items()}
    line = " · ".join(f"{'✓' if ticked else '○'} {goal}" for goal, ticked in ticks.items())
    print(f"{sum(ticks.values())} of {len(ticks)} goals: {line}")
    for goal, names in wanted.items():
        lacking = [name for name in names if name not in done]
        if 0 < len(lacking) < len(names):
            print(f"  {goal}: still to do {', '.join(lacking)}")


def progress(folder: Path) -> str:
    """How far one is in a folder of notebooks, in one line; '' where nothing is reached yet.

    >>> from pathlib import Path
    >>> progress(Path("a folder with nothing in it"))
    ''
    """
    done = _remembered(folder)
    counts = []
    for unit in _units():
        wanted = getattr(_module(unit), "GOALS", {})
        reached = sum(all(name in done for name in names) for names in wanted.values())
        counts.append((unit.removeprefix("nb"), reached, len(wanted)))
    if not any(reached for _, reached, _ in counts):
        return ""
    return "goals reached: " + ", ".join(f"{unit}: {reached} of {count}" for unit, reached, count in counts)


def remember(name: str) -> None:
    """An exercise or question was right; kept beside the notebooks, if this folder is a student's."""
    if name in _done:
        return
    _done.add(name)
    if (path := _file()) is None:
        return
    text = json.dumps(sorted(_done | _remembered())) + "\n"
    with contextlib.suppress(
        OSError
    ):  # a folder that cannot be written to: the tick lasts as the kernel does
        if sys.platform == "emscripten":
            path.unlink(missing_ok=True)  # JupyterLite waits for ever where a JSON file is made shorter
        path.write_text(text, encoding="utf-8")


def _file(folder: Path | None = None) -> Path | None:
    """Where ticks are kept: beside a student's notebooks, nowhere else."""
    folder = folder or Path.cwd()
    return None if solved(folder) or not any(folder.glob("*.ipynb")) else folder / PROGRESS


def _remembered(folder: Path | None = None) -> set[str]:
    path = _file(folder)
    try:
        return set(json.loads(path.read_text(encoding="utf-8"))) if path else set()
    except (OSError, ValueError, TypeError):
        return set()


def _pages() -> dict[str, Path]:
    """{unit: the file of its questions} of the course that this notebook belongs to."""
    course = course_here()
    return {unit: path for unit in course.units if (path := course.questions_path(unit)).exists()}


def _units() -> list[str]:
    return list(_pages())


def _questions() -> list[Question]:
    return [question for unit in _units() for question in getattr(_module(unit), "QUESTIONS", ())]


def _module(unit: str) -> Any:
    return module_at(_pages()[unit])


def _unlike(value: Any, right: Any) -> str:
    """'' or why this is no answer at all: another kind of thing, another length."""
    if isinstance(right, str):
        fine = isinstance(value, str) and len(_letter(value)) == 1
        return "" if fine else 'the answer is a letter in quotes, like "a"'
    if isinstance(right, numbers.Real):
        fine = isinstance(value, numbers.Real) or getattr(value, "shape", None) == ()
        return "" if fine else "the answer is one number"
    try:
        shape = np.shape(np.asarray(value, dtype=float))
    except (TypeError, ValueError):
        return "the answer is a list of numbers"
    wanted = np.shape(right)
    if shape == wanted:
        return ""
    if len(wanted) == 1 and len(shape) < 2:
        yours = f"yours has {shape[0]}" if shape else "yours is one number"
        return f"the answer is a list of {wanted[0]} numbers; {yours}"
    return f"the answer has shape {wanted}; yours has {shape}"


def _letter(value: Any) -> str:
    """The letter of a choice, also where it was copied with its brackets."""
    return str(value).strip(" ().\"'").lower()


def _slip(value: Any, right: Any, text: str, tolerance: float) -> str:
    """What is known of a number that no slip of the question explains: '' or a sentence."""
    if isinstance(right, str):
        return ""
    right, value = np.asarray(right, dtype=float), np.asarray(value, dtype=float)

    def near(other: Any) -> bool:
        return bool(np.all(np.abs(value - other) <= np.maximum(0.005 * np.abs(other), 1e-9)))

    if _agree(value, -right, tolerance):
        return "It is right but for the sign" + ("s of all numbers." if right.ndim else ".")
    if "degrees" in text and near(np.radians(right)):
        return "That is in radians; degrees are asked for."
    if " rad" in text and near(np.degrees(right)):
        return "That is in degrees; radians are asked for."
    if near(1000 * right) or near(right / 1000):
        return "It is off by a factor of 1000: look at the units."
    if value.all() and any(np.all(np.round(right, digits) == value) for digits in range(7)):
        return "It is rounded too far: more digits are asked for."
    return ""


def _agree(value: Any, right: Any, tolerance: float) -> bool:
    if isinstance(right, str) or isinstance(value, str):
        return _letter(value) == _letter(right)
    a, b = np.asarray(value, dtype=float), np.asarray(right, dtype=float)
    return a.shape == b.shape and bool(np.all(np.abs(a - b) <= tolerance))
