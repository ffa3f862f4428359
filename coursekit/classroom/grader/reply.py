"""What comes out of a student's box, read without trust: numbers, or a fault told without a hidden number."""

from __future__ import annotations

import builtins
import math
import pkgutil
import re

import numpy as np

from ..attempt import Attempt
from ..exercise import Exercise, misshapen
from ..plain import in_plain_words

LARGEST = 2000  # numbers in one answer
UNTOLD = "(its message could tell a hidden input, and is not shown: try inputs of your own)"
OURS = "not done: your function calls something of coursekit's own; write it yourself"

# What `_failure` writes, and what errors say that can be told: next to nothing of an input fits into it.
_FAILED = re.compile(r"((?:.*?: )??)(raised|not done:) (.*)", re.DOTALL)
_LOCKED = re.compile(r"your function calls coursekit's own ([\w.]+); write it yourself")
_TOLD = re.compile(
    r"the function returns None|\d things are expected|the answer has \d{1,7} numbers|"
    r"the answer has dtype (?:object|complex\d+|<U\d{1,3}); real numbers are expected|"
    r"(?:float )?division by zero|math domain error|maximum recursion depth exceeded|"
    r"name '(\w+)' is not defined|No module named '([\w.]+)'|"
    r"cannot access local variable '(\w+)' where it is not associated with a value|"
    r"(\w+)\(\) takes \d\d? positional arguments? but \d\d? (?:was|were) given"
)


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
        raise ValueError("what came back cannot be read")
    return [_decode_one(one, exercise) for one in answers]


def _decode_one(one, exercise: Exercise) -> Attempt:
    try:
        if "error" in one:
            return _failure(str(one["error"])[:80], str(one["text"]))
        parts = tuple(_array(part) for part in one["parts"])
        changed = one["changed"] if one["changed"] in exercise.arguments else ""
    except (TypeError, KeyError, ValueError, OverflowError, AttributeError, RecursionError):
        return Attempt(fault="error", text="what came back cannot be read")
    if len(parts) != len(exercise.shapes):
        return Attempt(fault="error", text="what came back cannot be read")
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


def for_students(text: str, sources: list[str]) -> str:
    """A verdict as its student reads it: of an error's own text nothing that could carry hidden inputs out.

    Its kind, if it is one of Python's; what it means, in words of ours; a name, if it stands in the notebook.

    >>> for_students("raised NameError: name 'lenght' is not defined", ["return lenght * 2"])
    "raised NameError: name 'lenght' is not defined"
    >>> for_students("where q is 0: raised ValueError: 3ff0a1", ["def fk(q): ..."]).partition(" (")[0]
    'where q is 0: raised ValueError'
    """
    found = _FAILED.fullmatch(text)
    if found is None:
        return text
    where, what, rest = found.groups()
    if what != "raised":
        locked = _LOCKED.fullmatch(rest)
        return text if locked and _is_ours(locked[1]) else f"{where}{OURS}"
    kind, _, said = rest.partition(": ")
    if kind != "LinAlgError" and not isinstance(getattr(builtins, kind, None), type):
        return f"{where}raised an error of its own {UNTOLD}"
    told = _TOLD.fullmatch(said)
    if told and all(any(name in x for x in sources) for name in filter(None, told.groups())):
        return text
    plain = in_plain_words(said)
    return f"{where}raised {kind}: {plain}" if plain else f"{where}raised {kind} {UNTOLD}"


def _is_ours(name: str) -> bool:
    try:
        return bool(pkgutil.resolve_name(f"coursekit.kinematics.{name}"))
    except (ImportError, AttributeError, ValueError):
        return False
