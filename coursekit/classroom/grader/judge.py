"""Is what a student's kernel says right? Read without trust, compared here, told without a hidden number."""

from __future__ import annotations

import base64
import contextlib
import json
import math
import re
from collections.abc import Callable

import numpy as np

from .. import compare
from ..check import broken_law
from ..exercise import Exercise, Misfit, answer, misshapen, thaw

LARGEST = 2000  # numbers in one answer


def expression(reply: dict) -> str:
    """The text/plain of the evaluated expression, '' if there is none."""
    with contextlib.suppress(KeyError, TypeError):
        text = reply["user_expressions"]["value"]["data"]["text/plain"]
        return text if isinstance(text, str) else ""
    return ""


def decode(reply: dict, nonce: str, count: int) -> list:
    """Parts of every answer as arrays, or a text that says what went wrong; ValueError if malformed."""
    text = expression(reply).strip("'")
    if not text.startswith(nonce):
        raise ValueError("the notebook defines no such function, or its kernel does not reply")
    try:
        answers = json.loads(base64.b64decode(text[len(nonce) :], validate=True))
    except (ValueError, RecursionError):
        raise ValueError("the reply is malformed") from None
    if not isinstance(answers, list) or len(answers) != count:
        raise ValueError("the reply is malformed")
    return [_decode_one(one) for one in answers]


def _decode_one(one) -> list[np.ndarray] | str:
    try:
        if "error" in one:
            return _failure(str(one["error"])[:80], str(one["text"]))
        return [_array(part) for part in one["parts"]]
    except (TypeError, KeyError, ValueError, OverflowError, AttributeError, RecursionError):
        return "the reply is malformed"


def _array(part: dict) -> np.ndarray:
    shape, values = part["shape"], part["values"]
    if len(shape) > 4 or not all(type(k) is int and 0 <= k <= LARGEST for k in shape):
        raise ValueError("shape")
    if math.prod(shape) > LARGEST or not all(type(x) is str and len(x) < 40 for x in values):
        raise ValueError("values")
    return np.array([float(x) for x in values]).reshape(shape)


def _failure(kind: str, text: str) -> str:
    if kind == "NotImplementedError":
        return "not written yet"
    if kind == "LibraryLocked":
        return clean(f"not done: {text}")
    return clean(f"raised {kind}: {text}")


def clean(text: str) -> str:
    """One printable line, in which no number with a decimal point is left: it might be a hidden input."""
    text = re.sub(r"[-+]?\d+\.\d*(e[-+]?\d+)?", "…", text)
    return "".join(c if c.isprintable() else " " for c in text)[:240]


def judge(exercise: Exercise, inputs: list, answers: list, right: Callable, wrong: dict) -> str:
    """'' if all answers are right, else what is wrong with them, without a number of either."""
    for one in answers:
        if isinstance(one, str):
            return one
    if any(len(parts) != len(exercise.shapes) for parts in answers):
        return "the reply is malformed"

    def agree(k: int, function) -> bool:
        try:
            with np.errstate(all="ignore"):
                wanted = answer(exercise, function(*thaw(inputs[k])))
        except Misfit:
            return False
        pairs = zip(exercise.kinds, answers[k], wanted, strict=True)
        return all(compare.same(kind, got, want, exercise.tol) for kind, got, want in pairs)

    def lawful(k: int) -> bool:
        shapely = not misshapen(exercise, answers[k]) and _finite(answers[k])
        return shapely and not broken_law(exercise, None, inputs[k], answers[k])

    numbers = range(len(inputs))
    good = [lawful(k) if exercise.compare == "any_solution" else agree(k, right) for k in numbers]
    if all(good):
        return ""
    for hint in exercise.hints:
        if hint.key in wrong and all(agree(k, wrong[hint.key]) for k in numbers):
            return hint.text
    for parts in answers:
        if text := misshapen(exercise, parts):
            return text
        if not _finite(parts):
            return "an answer holds NaN or infinity"
    return f"wrong on {good.count(False)} of {len(inputs)} hidden inputs"


def _finite(parts: list[np.ndarray]) -> bool:
    return all(np.isfinite(part).all() for part in parts)
