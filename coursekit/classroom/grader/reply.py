"""What comes out of a student's box, read without trust: numbers, or a fault told without a hidden number."""

from __future__ import annotations

import math
import re

import numpy as np

from ..attempt import Attempt
from ..exercise import Exercise, misshapen

LARGEST = 2000  # numbers in one answer


def failed_line(reply: dict) -> int:
    """In which line a cell failed, 0 if it did not, or if that cannot be told."""
    line = reply.get("line")
    return line if type(line) is int and 0 < line < 10**6 else 0


def decode(reply: dict, exercise: Exercise, count: int) -> list[Attempt]:
    """What each call gave; ValueError if the reply is malformed as a whole."""
    if reply.get("missing") is True:
        raise ValueError("the notebook defines no such function")
    answers = reply.get("answers")
    if not isinstance(answers, list) or len(answers) != count:
        raise ValueError("the reply is malformed")
    return [_decode_one(one, exercise) for one in answers]


def _decode_one(one, exercise: Exercise) -> Attempt:
    try:
        if "error" in one:
            return _failure(str(one["error"])[:80], str(one["text"]))
        parts = tuple(_array(part) for part in one["parts"])
        changed = one["changed"] if one["changed"] in exercise.arguments else ""
    except (TypeError, KeyError, ValueError, OverflowError, AttributeError, RecursionError):
        return Attempt(fault="error", text="the reply is malformed")
    if len(parts) != len(exercise.shapes):
        return Attempt(fault="error", text="the reply is malformed")
    text = misshapen(exercise, list(parts))
    return Attempt(parts, "misfit" if text else "", text, changed=changed)


def _array(part: dict) -> np.ndarray:
    shape, values = part["shape"], part["values"]
    if len(shape) > 4 or not all(type(k) is int and 0 <= k <= LARGEST for k in shape):
        raise ValueError("shape")
    if math.prod(shape) > LARGEST or not all(type(x) is str and len(x) < 40 for x in values):
        raise ValueError("values")
    return np.array([float(x) for x in values]).reshape(shape)


def _failure(kind: str, text: str) -> Attempt:
    if kind == "NotImplementedError":
        return Attempt(fault="unwritten", text="not written yet")
    if kind == "LibraryLocked":
        return Attempt(fault="error", text=clean(f"not done: {text}"))
    return Attempt(fault="error", text=clean(f"raised {kind}: {text}"))


def clean(text: str) -> str:
    """One printable line, in which no number with a decimal point is left: it might be a hidden input."""
    text = re.sub(r"[-+]?\d+\.\d*(e[-+]?\d+)?", "…", text[:1000])  # of a million digits it takes hours
    return "".join(c if c.isprintable() else " " for c in text)[:240]
