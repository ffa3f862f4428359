"""A verdict as a student reads it: the shortest true sentence first, then where to look, then an example."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from typing import Any

import numpy as np

from . import seen
from .attempt import Attempt
from .exercise import Exercise, thaw
from .verdict import Example, Verdict

LEVELS = (None, "more", "example", "all")
WIDTH = 100


def told(
    found: Verdict,
    exercise: Exercise,
    function: Callable,
    examples: list[Example],
    attempts: list[Attempt],
    place: str,
    show: str | None,
) -> str:
    """The text of one level; "all" holds the texts of all of them."""
    if found.right or found.kind == "unwritten":
        return found.say + (" (grading uses other inputs)" if found.right else "")
    name = getattr(function, "__name__", exercise.name)
    ask = f'check("{exercise.name}", {name if name.isidentifier() else exercise.name}, show={{!r}})'
    lines = [_wrapped(found.say)]
    if show is None:
        lines.append(f"  More: {ask.format('more')}")
        return "\n".join([*lines, *_in_3d(found, exercise, name, show)])
    if show in ("more", "all"):
        further = found.more if show == "all" else found.more[:1]  # no wall of words
        lines += [_wrapped(f"{text[0].upper()}{text[1:]}", "  ") for text in further]
        if place:
            lines.append(_wrapped(f"Look again at “{place}” in this notebook.", "  "))
        if show == "more":
            return "\n".join([*lines, f"  One example: {ask.format('example')}"])
    if show in ("example", "all") and 0 <= found.example < len(examples):
        lines += _example(exercise, found.example, examples, attempts)
    return "\n".join([*lines, *_in_3d(found, exercise, name, show)])


def _in_3d(found: Verdict, exercise: Exercise, name: str, show: str | None) -> list[str]:
    """Where something is returned that can be seen: what opens it beside the right one."""
    if found.kind not in ("named", "placed", "different") or not name.isidentifier():
        return []
    if show is not None and found.example >= 0:
        pasted = seen.lines(exercise, name, found.example)
        return ["  See it in 3D:", *(f"    {line}" for line in pasted)] if pasted else []
    line = seen.line(exercise, name)
    return [f"  See it in 3D: {line}"] if line else []


def _wrapped(text: str, indent: str = "") -> str:
    """No line so long that a notebook has to break it; lines that follow are indented."""
    first, *rest = text.split("\n")
    whole = textwrap.fill(first, WIDTH, initial_indent=indent, subsequent_indent="  ", break_long_words=False)
    return "\n".join([whole, *(f"  {line.strip()}" for line in rest)])


# ---- one example


def _example(exercise: Exercise, k: int, examples: list[Example], attempts: list[Attempt]) -> list[str]:
    one = examples[k]
    lines = [f"  Example {k}, {one.case}:", textwrap.indent(call_of(exercise, one.arguments, k), "    ")]
    parts = attempts[k].parts if k < len(attempts) else ()
    names = [f"result {i + 1}: " for i in range(len(one.right))] if exercise.several else [""]
    if exercise.compare == "any_solution":
        return lines + [textwrap.indent(_alone(part), "    ") for part in parts]
    for i, (name, right) in enumerate(zip(names, one.right, strict=True)):
        mine = parts[i] if i < len(parts) else None
        if mine is None:
            lines.append(textwrap.indent(f"{name}expected\n{_numbers(right)}", "    "))
        elif mine.shape != right.shape:
            lines.append(f"    {name}yours has shape {mine.shape}, expected {right.shape}")
        else:
            lines.append(textwrap.indent(_side_by_side(name, mine, right, one.masks(parts)[i]), "    "))
    return lines


def call_of(exercise: Exercise, arguments: list, number: int) -> str:
    """A call that can be pasted: with the numbers themselves where they are few."""
    text = f"{exercise.name}({', '.join(_literal(x) for x in arguments)})"
    if len(text) <= 2 * WIDTH:
        return textwrap.fill(text, WIDTH, subsequent_indent="    ", break_long_words=False)
    return f"from coursekit.classroom import example\n{exercise.name}(*example({exercise.name!r}, {number}))"


def _literal(x: Any) -> str:
    if isinstance(x, dict):
        ((what, name),) = x.items()
        return f"robots.{name}()" + (".fk" if what == "fk" else "")
    (value,) = thaw([x])
    return f"np.array({_digits(x)})" if isinstance(value, np.ndarray) else _digits(x)


def _digits(x: Any) -> str:
    """Numbers with six digits: enough for the four that are shown of an answer."""
    if isinstance(x, list):
        return f"[{', '.join(map(_digits, x))}]"
    return f"{x:.6g}" if isinstance(x, float) and x != int(x) else repr(x)


def _side_by_side(name: str, mine: np.ndarray, right: np.ndarray, mask: np.ndarray) -> str:
    """Yours, with a mark after each wrong number, beside what is expected."""
    if mine.ndim == 0:
        return f"{name}yours {_number(mine)}, expected {_number(right)}"
    if mine.ndim > 2:
        k = int(np.argmin(mask.reshape(len(mask), -1).all(axis=1)))
        return _side_by_side(f"{name}[{k}]: ", mine[k], right[k], mask[k])
    rows = [np.atleast_2d(x) for x in (mine, right, mask)]
    left = [
        " ".join(f"{_number(x):>9}{' ' if fine else '*'}" for x, fine in zip(a, m, strict=True))
        for a, m in zip(rows[0], rows[2], strict=True)
    ]
    other = [" ".join(f"{_number(x):>9}" for x in b) for b in rows[1]]
    width = max(len(left[0]), 16)
    head = f"{name}{'yours (* is wrong)':<{width}}   expected"
    if width + len(other[0]) > WIDTH:  # too wide for a page: one below the other
        return "\n".join([f"{name}yours (* is wrong)", *left, "expected", *other])
    return "\n".join([head, *(f"{a:<{width}}   {b}" for a, b in zip(left, other, strict=True))])


def _alone(mine: np.ndarray) -> str:
    """Yours with nothing beside it; a matrix begins in a new line, so that its columns stand straight."""
    return f"yours{chr(10) if mine.ndim > 1 else ' '}{_numbers(mine)}"


def _numbers(x: np.ndarray) -> str:
    if x.ndim < 2:
        return " ".join(map(_number, np.atleast_1d(x)))
    return "\n".join(" ".join(f"{_number(v):>9}" for v in row) for row in x.reshape(-1, x.shape[-1])[:12])


def _number(x: Any) -> str:
    x = float(x)
    if not np.isfinite(x):
        return str(x)
    if x == int(x) and abs(x) < 1e6:
        return str(int(x))
    return f"{x:.4f}" if 1e-3 < abs(x) < 1e5 else f"{x:.3g}"
