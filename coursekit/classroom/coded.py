"""What only the student's function itself can tell: called once more, or read without being called."""

from __future__ import annotations

import dis
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import CodeType, MethodType
from typing import Any

import numpy as np

from .attempt import Attempt
from .attempt import attempt as call
from .exercise import Exercise, misshapen


def remembers(exercise: Exercise, function: Callable, examples: list, attempts: list[Attempt]) -> str:
    """'' or that a second call with the same arguments gives another answer than the first."""
    first = next((k for k, tried in enumerate(attempts) if tried.parts), None)
    if first is None:
        return ""
    if _alike(call(exercise, function, examples[first].arguments), attempts[first]):
        return ""
    if "empty" in getattr(getattr(function, "__code__", None), "co_names", ()):
        return (
            "called twice with the same arguments, it gives two answers: np.empty holds what happened to be"
            " in memory, and not all of it is filled (does `return` stand inside the loop?)"
        )
    return (
        "called twice with the same arguments, it gives two answers: it draws random numbers, or something"
        " outlives the call, such as a list or an array made outside the function, or in its `def` line"
    )


def ignored(exercise: Exercise, function: Callable) -> str:
    """'' or which argument the code does not use."""
    code = getattr(function, "__code__", None)
    if not isinstance(code, CodeType):
        return ""
    first = isinstance(function, MethodType)  # behind `self`
    for name, wanted in zip(code.co_varnames[first : code.co_argcount], exercise.arguments, strict=False):
        uses = [i.opname for i in dis.get_instructions(code) if name == i.argval or _holds(i.argval, name)]
        uses = [use for use in uses if not use.startswith(("MAKE_CELL", "COPY_FREE"))]
        if not uses:
            return f"it does not use its argument `{wanted}`"
        if uses[0].startswith("STORE"):
            return f"it gives `{wanted}` a value of its own before it looks at the one that comes"
    return ""


def another_word(exercise: Exercise, function: Callable, examples: list, attempts: list[Attempt]) -> str:
    """ "kind is "revolute" or "prismatic", ...": the code asks for words that never come, as "R" and "P".

    Told only of a word with which an answer that is wrong becomes right.
    """
    code = getattr(function, "__code__", None)
    if not isinstance(code, CodeType):
        return ""
    mine = [c for c in code.co_consts if isinstance(c, str) and c and c != function.__doc__]
    wrong = [e for e, before in zip(examples, attempts, strict=True) if not _is_right(exercise, e, before)]
    for k, name in enumerate(exercise.arguments):
        words = list(dict.fromkeys(str(e.arguments[k]) for e in examples if isinstance(e.arguments[k], str)))
        for word in [m for m in mine if words and not any(m in w for w in words)]:
            for example in wrong:
                given = [*example.arguments[:k], word, *example.arguments[k + 1 :]]
                if _is_right(exercise, example, call(exercise, function, given)):
                    known = " or ".join(f'"{w}"' for w in words)
                    return f'`{name}` is {known}, letter for letter: "{word}" in your code is neither'
    return ""


def with_decimals(
    exercise: Exercise, function: Callable, examples: list, attempts: list[Attempt]
) -> tuple[list, list[Attempt], str]:
    """Examples and attempts with decimals wherever it is the whole numbers that change the answer, and whose.

    A copy of an array of whole numbers cuts off decimals that are stored in it. That is one mistake, which
    must not hide another.
    """
    examples, attempts, whose = examples[:], attempts[:], ""
    for k, (example, before) in enumerate(zip(examples, attempts, strict=True)):
        whole = [isinstance(x, list) and np.array(x).dtype.kind == "i" for x in example.arguments]
        if not any(whole) or _is_right(exercise, example, before):
            continue
        given = [_decimal(x) if w else x for x, w in zip(example.arguments, whole, strict=True)]
        tried = call(exercise, function, given)
        if tried.parts and not tried.fault and not _alike(tried, before):
            examples[k], attempts[k] = replace(example, arguments=given), tried
            whose = exercise.arguments[whole.index(True)]
    return examples, attempts, whose


def _decimal(x: Any) -> Any:
    return [_decimal(y) for y in x] if isinstance(x, list) else float(x)


def _alike(one: Attempt, other: Attempt) -> bool:
    return len(one.parts) == len(other.parts) and all(
        map(partial(np.array_equal, equal_nan=True), one.parts, other.parts)
    )


def _is_right(exercise: Exercise, example: Any, tried: Attempt) -> bool:
    whole = tried.parts and not tried.fault and not misshapen(exercise, list(tried.parts))
    return bool(whole) and example.agrees(tried.parts)


def _holds(value: object, name: str) -> bool:
    return isinstance(value, tuple) and name in value
