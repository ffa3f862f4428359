"""`check("dh_transform", dh_transform)`: feedback at once, which names the mistake and no expected number.

It prints one or two lines and returns None. What is right it knows from `samples/`, a table of public inputs
with salted hashes of the right answers and of those which typical mistakes give.
"""

from __future__ import annotations

import inspect
import json
import linecache
import os
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from . import compare
from .course import Course, the_course
from .exercise import Exercise, Misfit, answer, misshapen, thaw
from .library import library_call, permitted

MARKS = {"right": "✓", "unwritten": "…"}  # any other outcome: ✗


class CheckFailed(AssertionError):
    """A check failed where none may: in CI, which runs the solved notebooks."""


@dataclass(frozen=True)
class Verdict:
    """outcome: right, unwritten, error, forbidden, misfit, law, common, different, or the key of a hint."""

    outcome: str
    text: str

    @property
    def right(self) -> bool:
        return self.outcome == "right"


def check(name: str, function: Callable) -> None:
    """Say whether a function you wrote is right and, if not, what kind of mistake it makes.

    Parameters
    ----------
    name : the exercise's name, a string, usually the function's own
    function : the function itself, not a call of it

    Prints one or two lines; returns None. ValueError if there is no such exercise. Where the environment
    variable CI is set, a failing check raises `CheckFailed`.
    """
    unit, exercise = _ours().find(name)
    verdict = judge(exercise, function, _ours().samples(unit).get(name, []), _ours().allowed(unit))
    print(f"{MARKS.get(verdict.outcome, '✗')} {name}: {verdict.text}")
    if os.environ.get("CI") and not verdict.right:
        raise CheckFailed(f"{name}: {verdict.text}")


def demand(name: str, function: Callable, table: str) -> None:
    """For graders that wait for an exception: CheckFailed unless the function is right on this table."""
    unit, exercise = _ours().find(name)
    verdict = judge(exercise, function, json.loads(table), _ours().allowed(unit))
    if not verdict.right:
        raise CheckFailed(f"{name}: {verdict.text}")


@cache
def _ours() -> Course:
    return the_course()


def judge(
    exercise: Exercise, function: Callable, table: list[dict], allowed: tuple[str, ...] = ()
) -> Verdict:
    """The verdict on a function, from a sample table."""
    if not callable(function):
        return Verdict("misfit", f'pass the function itself: check("{exercise.name}", {exercise.name})')
    if not table:
        return Verdict("error", "there are no examples of it (instructors: run `coursekit samples`)")
    answers: list[list[np.ndarray]] = []
    for row in table:
        arguments = row["args"]
        try:
            value, called = _call(function, thaw(arguments), watch=not answers)
        except NotImplementedError:
            return Verdict("unwritten", "not written yet")
        except Exception as error:
            return Verdict("error", _explain(exercise, function, error, arguments))
        forbidden = next((c for c in called if not permitted(c, allowed)), None)
        if forbidden:
            return Verdict(
                "forbidden", f"not done: your function calls coursekit's own {forbidden}; write it yourself"
            )
        try:
            answers.append(answer(exercise, value))
        except Misfit as misfit:
            return Verdict("misfit", f"{misfit}{_for_input(arguments)}")
    return _compare(exercise, function, table, answers)


def _compare(exercise: Exercise, function, table: list[dict], answers: list) -> Verdict:
    by_laws = exercise.compare == "any_solution"
    broken = [
        broken_law(exercise, function, row["args"], parts) for row, parts in zip(table, answers, strict=True)
    ]
    infinite = [not all(np.isfinite(part).all() for part in parts) for parts in answers]
    differs = [not same_as(exercise, k, parts, table[k]["right"]) for k, parts in enumerate(answers)]
    if not any(broken) and not any(infinite if by_laws else differs):
        return Verdict("right", f"right on {len(table)} examples (grading uses other inputs)")
    # a mistake is recognised by all examples at once: on some of them it may happen to give the right answer
    for hint in exercise.hints:
        if all(same_as(exercise, k, parts, table[k]["wrong"][hint.key]) for k, parts in enumerate(answers)):
            return Verdict(hint.key, hint.text)
    for row, parts, differ in zip(table, answers, differs, strict=True):
        if text := misshapen(exercise, parts):
            return Verdict("misfit", text + _for_input(row["args"]))
        if differ and not all(np.isfinite(part).all() for part in parts):
            return Verdict("misfit", f"the answer holds NaN or infinity{_for_input(row['args'])}")
    if not by_laws and (text := _common_mistake(exercise, table, answers)):
        return Verdict("common", text)
    for row, text in zip(table, broken, strict=True):
        if text:
            return Verdict("law", text + _for_input(row["args"]))
    first = differs.index(True)
    return Verdict("different", f"example {first + 1} differs{_for_input(table[first]['args'])}")


def same_as(exercise: Exercise, k: int, parts: list[np.ndarray], stored: list[dict]) -> bool:
    """Do these parts agree with the hashed answer to example k?"""
    return all(
        compare.matches(kind, part, exercise.tol, salt(exercise, k, i), one)
        for i, (kind, part, one) in enumerate(zip(exercise.kinds, parts, stored, strict=True))
    )


def salt(exercise: Exercise, k: int, part: int) -> str:
    """So that equal numbers have different hashes in different places."""
    return f"{exercise.name}/{k}/{part}"


# ---- laws, and mistakes that anybody makes anywhere


def broken_law(
    exercise: Exercise, function: Callable | None, arguments: list, parts: list[np.ndarray]
) -> str:
    """'' or the text of the first law that does not hold."""
    if misshapen(exercise, parts):
        return ""
    value = tuple(parts) if exercise.several else parts[0]
    with np.errstate(all="ignore"):
        for kind, part in zip(exercise.kinds, parts, strict=True):
            if kind == "rotation" and (text := _not_a_pose(part)):
                return text
        for text, law in exercise.laws:
            try:
                holds = law(function, thaw(arguments), value)
            except Exception:
                holds = False
            if not holds:
                return text
    return ""


def _not_a_pose(matrix: np.ndarray) -> str:
    R = matrix[:3, :3]
    if not np.allclose(R.T @ R, np.eye(3), atol=1e-6):
        return "the 3 x 3 block is not a rotation: its columns are not orthogonal unit vectors"
    if np.linalg.det(R) < 0:
        return "the 3 x 3 block is left-handed: its determinant is -1"
    if matrix.shape == (4, 4) and not np.allclose(matrix[3], [0, 0, 0, 1], atol=1e-9):
        return "the last row of a pose is 0 0 0 1"
    return ""


def _swap_halves(x):
    return np.roll(x, 3, axis=0)


def _in_metres(x):
    x = x.copy()
    x[:3, 3] /= 1000
    return x


def _square(shape):
    return len(shape) == 2 and shape[0] == shape[1]


COMMON = (  # (what was done to the right answer, which shapes it can happen to, how to undo it)
    ("your answer is the inverse of the right one", lambda s: s == (4, 4), np.linalg.inv),
    ("your answer is the transpose of the right one", _square, np.transpose),
    ("every sign is the opposite of what it should be", lambda s: True, np.negative),
    ("rows are (omega; v): your two halves are swapped", lambda s: s[:1] == (6,), _swap_halves),
    ("the columns are in reverse order", lambda s: len(s) == 2, np.fliplr),
    ("lengths are in metres: yours are in millimetres", lambda s: s == (4, 4), _in_metres),
    ("your answer is 1000 times too large: lengths are in metres", lambda s: True, lambda x: x / 1000),
    ("your answer is in degrees; radians are expected", lambda s: True, np.radians),
    ("your answer is in radians where degrees are expected", lambda s: True, np.degrees),
)


def _common_mistake(exercise: Exercise, table: list[dict], answers: list) -> str:
    """'' or the name of what was done to every answer."""
    for text, applies, undo in COMMON:
        if not any(applies(part.shape) for part in answers[0]):
            continue
        try:
            undone = [[undo(p) if applies(p.shape) else p for p in parts] for parts in answers]
        except np.linalg.LinAlgError:
            continue
        if all(same_as(exercise, k, parts, table[k]["right"]) for k, parts in enumerate(undone)):
            return text
    return ""


# ---- calling the function


def _call(function, arguments: list, watch: bool):
    """(value, names of coursekit.kinematics functions it called); watching slows a function down."""
    called: list[str] = []

    def hook(frame, event, _):
        if event == "call" and (name := library_call(frame)):
            called.append(name)

    if not watch:
        return function(*arguments), called
    before = sys.getprofile()
    sys.setprofile(hook)
    try:
        value = function(*arguments)
    finally:
        sys.setprofile(before)
    return value, called


def _explain(exercise: Exercise, function, error: Exception, arguments: list) -> str:
    """What was raised, and in which line of the student's code."""
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError:
        return f"it does not take the arguments of {exercise.signature}"
    except ValueError:  # a function without a signature
        pass
    text = f"raised {type(error).__name__}: {str(error).partition(chr(10))[0]}"[:200]
    code = getattr(function, "__code__", None)
    frames = [
        f
        for f in traceback.walk_tb(error.__traceback__)
        if code and f[0].f_code.co_filename == code.co_filename
    ]
    if not frames:
        return text + _for_input(arguments)
    frame, line = frames[-1]
    source = linecache.getline(frame.f_code.co_filename, line).strip()
    return f"{text}\n  in line {line - frame.f_code.co_firstlineno + 1} of {frame.f_code.co_name}: {source}"


# ---- arguments, printed compactly


def _for_input(arguments: list) -> str:
    return f"\n  for the arguments {show(arguments)}"


def show(arguments: list, room: int = 160) -> str:
    """Arguments in few characters: numbers to four digits, nothing longer than one line."""
    text = ", ".join(_show(x) for x in arguments)
    return text if len(text) <= room else text[: room - 3] + "..."


def _show(x) -> str:
    if isinstance(x, dict):
        ((what, name),) = x.items()
        return name if what == "robot" else f"fk of {name}"
    if isinstance(x, list):
        return "[" + ", ".join(_show(y) for y in x) + "]"
    return f"{x:.4g}" if isinstance(x, float) else repr(x)
