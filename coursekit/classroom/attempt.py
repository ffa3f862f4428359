"""One call of a student's function: what it answers, or what went wrong, in which line, with which values.

The function runs under Python's own trace hook, which counts its lines: an endless loop ends after a fixed
number of them, on every machine the same, and with the line it was in. Nothing is interrupted by a signal or
left running in a thread, so that it works the same on Windows and in a browser.
"""

from __future__ import annotations

import contextlib
import copy
import inspect
import io
import linecache
import re
import sys
import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from textwrap import shorten
from types import CodeType, FrameType
from typing import Any

import numpy as np

from .course import PACKAGE
from .exercise import Exercise, Misfit, answer, misshapen, thaw
from .library import GENERATED, library_call
from .plain import in_plain_words
from .source import catches_everything

LINES = 200_000  # of the student's, in one call
COST = 3_000_000  # of lines and calls together, where a loop of the student's has run for MANY lines
MANY = 2_000
SECONDS = 20.0  # a backstop, for lines that take very long
CALL = 8  # a call of a library costs as much as so many lines
NUMPY = 5  # one within numpy, whose functions call each other and do little
SHOWN = 4  # variables told beside an error
LIBRARIES = tuple(str(Path(p).resolve()) for p in (sys.prefix, sys.base_prefix, str(PACKAGE), np.__path__[0]))


@dataclass(frozen=True)
class Attempt:
    """What one call gave: an answer (then `fault` is ''), or a fault.

    fault : "" or a kind of verdict: unwritten, error, misfit; `text` says it in a sentence.
    """

    parts: tuple[np.ndarray, ...] = ()
    fault: str = ""
    text: str = ""
    changed: str = ""  # an argument that is not what it was before
    calls: tuple[str, ...] = ()  # functions of coursekit.kinematics that it called
    printed: str = ""
    endless: bool = False
    cost: int = 0  # lines that were executed, and what calls of libraries in them cost


class Endless(BaseException):
    """More lines than any right answer needs. Not an Exception: nobody handles it by mistake."""


def attempt(exercise: Exercise, function: Callable, arguments: list) -> Attempt:
    """Call a student's function once, with fresh arguments made from plain data."""
    given = thaw(arguments)
    kept = copy.deepcopy([x for x in given if isinstance(x, np.ndarray | list)])
    watch, printed = _Watch(), io.StringIO()
    try:
        with _quietly(printed), watch:
            value = function(*given)
        found = _read(exercise, value, printed.getvalue())
    except NotImplementedError:
        found = Attempt(fault="unwritten", text="not written yet")
    except Endless:
        found = _endless(watch)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # sys.exit() as well: it would end more than the call
        found = _explain(exercise, function, error, arguments)
    now = [x for x in given if isinstance(x, np.ndarray | list)]
    names = [n for n, x in zip(exercise.arguments, given, strict=False) if isinstance(x, np.ndarray | list)]
    changed = next((n for n, a, b in zip(names, kept, now, strict=False) if not _equal(a, b)), "")
    return replace(
        found, changed=changed, calls=tuple(watch.calls), printed=printed.getvalue(), cost=watch.cost
    )


def line_of_nan(function: Callable, arguments: list) -> tuple[int, str]:
    """(line, what numpy says) where NaN or infinity first arises, (0, '') if that cannot be found.

    In a browser numpy cannot say it, nor anywhere of a NaN that is written down: then it is the line after
    which a variable holds one, without words.
    """
    try:
        with _quietly(io.StringIO()), np.errstate(divide="raise", invalid="raise"):
            function(*thaw(arguments))
    except FloatingPointError as error:
        frame, line = _place(error)
        if frame is None:
            return 0, str(error)
        text, said = linecache.getline(frame.f_code.co_filename, line), str(error)
        if "**" in text and "sqrt" not in text:  # to numpy x ** 0.5 is a root
            said = said.replace("in sqrt", "in power")
        return line - frame.f_code.co_firstlineno + 1, said
    except Exception:
        return 0, ""
    watch = _FirstNan()
    with contextlib.suppress(Exception, Endless), _quietly(io.StringIO()), watch:
        function(*thaw(arguments))
    return (watch.line - watch.frame.f_code.co_firstlineno + 1 if watch.frame else 0), ""


def _read(exercise: Exercise, value: Any, printed: str) -> Attempt:
    try:
        parts = answer(exercise, value)
    except Misfit as misfit:
        text = str(misfit)
        if value is None and printed:
            text = "it prints the answer and returns None: put `return` in place of `print`"
        return Attempt(fault="misfit", text=text)
    text = misshapen(exercise, parts)
    return Attempt(tuple(parts), "misfit" if text else "", text)


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray):
        return (
            a.shape == b.shape and a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
        )
    return bool(a == b)


@contextlib.contextmanager
def _quietly(printed: io.StringIO):
    """What a function prints is kept; numpy's warnings come back as sentences of ours."""
    with (
        contextlib.redirect_stdout(printed),
        warnings.catch_warnings(),
        np.errstate(all="ignore"),
    ):
        warnings.simplefilter("ignore")
        yield


# ---- counting lines


class _Watch:
    """Counts the student's lines, and notes which functions of the library they call."""

    def __init__(self) -> None:
        self.lines = self.cost = 0
        self.calls: list[str] = []
        self.frame: FrameType | None = None
        self.line, self.within = 0, False  # in a library that it called

    def __enter__(self) -> _Watch:
        self.end = time.monotonic() + SECONDS
        self.before = sys.gettrace()
        sys.settrace(self._call)
        return self

    def __exit__(self, *_: object) -> None:
        sys.settrace(self.before)

    def _call(self, frame: FrameType, event: str, _: Any):
        if name := library_call(frame):
            self.calls.append(name)
        if _is_library(file := frame.f_code.co_filename):
            self.cost += NUMPY if "numpy" in file else CALL
            return None
        return self._line

    def _line(self, frame: FrameType, event: str, _: Any):
        self.lines += event == "line"
        self.cost += event == "line"
        late = self.lines % 1000 == 0 and time.monotonic() > self.end
        dear = self.lines > MANY and self.cost > COST
        if (self.lines > LINES or dear or late) and not catches_everything(frame):
            while frame.f_back and _is_library(frame.f_code.co_filename, GENERATED):
                frame, self.within = frame.f_back, True  # of sympy, say, which computes with code it made
            self.frame, self.line = frame, frame.f_lineno
            raise Endless
        return self._line


class _FirstNan(_Watch):
    """Ends the call after the line that first leaves NaN or infinity in a variable, or in the answer."""

    def __init__(self) -> None:
        super().__init__()
        self.last: dict[FrameType, int] = {}

    def _line(self, frame: FrameType, event: str, value: Any):
        held = [*frame.f_locals.values(), *([value] if event == "return" else [])]
        if frame in self.last and not all(map(_is_finite, held)):
            self.frame, self.line = frame, self.last[frame]
            raise Endless
        self.last[frame] = frame.f_lineno
        return super()._line(frame, event, value) and self._line


def _is_finite(value: Any) -> bool:
    if not isinstance(value, float | np.floating | np.ndarray | list | tuple):
        return True
    try:
        return bool(np.isfinite(np.asarray(value, float)).all())
    except (TypeError, ValueError):  # robots, words; results of different shapes
        return not isinstance(value, tuple) or all(map(_is_finite, value))


@cache
def _is_library(filename: str, *made: str) -> bool:
    return filename.startswith(("<frozen", "<__array_function__", *made)) or (
        not filename.startswith("<") and str(Path(filename).resolve()).startswith(LIBRARIES)
    )


def _endless(watch: _Watch) -> Attempt:
    if watch.frame is None:
        return Attempt(fault="error", text="it does not end", endless=True)
    code, line = watch.frame.f_code, watch.line - watch.frame.f_code.co_firstlineno + 1
    lines = f"does not end: after {min(watch.lines, LINES):,} lines it"
    text = f"it {'takes too long: it' if watch.within else lines} is still in line {line} of {code.co_name}"
    return Attempt(fault="error", text=text + _source_line(code, watch.line), endless=True)


# ---- what was raised


def _explain(exercise: Exercise, function: Callable, error: BaseException, arguments: list) -> Attempt:
    """What was raised, in which line of the student's code, and what the variables in it were."""
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError:
        return Attempt(fault="error", text=f"it does not take the arguments of {exercise.signature}")
    except ValueError:  # a function without a signature
        pass
    try:
        said = str(error)
    except Exception:  # of a class of the student's own
        said = ""
    said = re.sub(r", with gufunc signature \S+", "", said.partition("\n")[0].strip())
    plain = in_plain_words(said)
    if plain:  # which says the rest
        said = re.split(r"\. Use|, and the inputs", re.sub(r"Input operand .*\((.*)\)$", r"\1", said))[0]
    said = shorten(said, 80 if plain else 200, placeholder=" ...")
    text = f"{type(error).__name__}: {said}".removesuffix(": ")
    frame, at = _place(error)
    if frame is None:
        return Attempt(fault="error", text=f"it raises {text}")
    line = at - frame.f_code.co_firstlineno + 1
    if frame.f_code is not getattr(function, "__code__", None) and (call := call_from(function, error)):
        # a function that it calls raises: what it was called with is the matter
        inner = frame.f_code.co_name
        frame, at, text = *call, text if inner.startswith("<") else f"{text}, in {inner}"
        line = at - frame.f_code.co_firstlineno + 1
    text = f"line {line} of {frame.f_code.co_name} raises {text}{_source_line(frame.f_code, at)}"
    if told := _variables(frame, at):
        text += f"\n  there {told}"
    if plain := _a_row_for_a_column(exercise, frame, arguments, error) or plain:
        text += f"\n  {plain}"
    return Attempt(fault="error", text=text)


def _a_row_for_a_column(exercise: Exercise, frame: FrameType, arguments: list, error: BaseException) -> str:
    """ "`s` is a row of S, ...": of what holds six numbers in each column, a loop or an index takes a row."""
    for name, S in zip(exercise.arguments, thaw(arguments), strict=False):
        if name in ("S", "J", "J_b") and np.ndim(S) == 2:
            for own, value in frame.f_locals.items():
                if isinstance(value, np.ndarray) and any(np.array_equal(value, row) for row in S):
                    return f"`{own}` is a row of {name}; its columns come one by one from {name}.T"
            if "must have shape (..., 6)" in str(error):
                columns = f"{name}[:, i], or {name}.T in a loop"
                return f"six numbers are a column of {name}: {columns}; {name}[i] is a row"
    return ""


def _place(error: BaseException) -> tuple[FrameType | None, int]:
    """(frame, line) of the student's code that is nearest to the error."""
    ours = [f for f in traceback.walk_tb(error.__traceback__) if not _is_library(f[0].f_code.co_filename)]
    return ours[-1] if ours else (None, 0)


def call_from(function: Callable, error: BaseException) -> tuple[FrameType, int] | None:
    """(frame, line) of the student's function itself, from which the call went out that raised."""
    code = getattr(function, "__code__", None)
    ours = [f for f in traceback.walk_tb(error.__traceback__) if f[0].f_code is code]
    return ours[-1] if ours else None


def _source_line(code: CodeType, at: int) -> str:
    source = shorten(linecache.getline(code.co_filename, at).strip(), 90, placeholder=" ...")
    return f": `{source}`" if source else ""


def _variables(frame: FrameType, at: int) -> str:
    """ "i = 2, rows has shape (2, 4)": the variables of the line, or the first ones if it cannot be read."""
    here = {k: v for k, v in frame.f_locals.items() if not callable(v) and not inspect.ismodule(v)}
    line = linecache.getline(frame.f_code.co_filename, at)
    made_last = " ".join(reversed(re.split(r"(?<![=<>!])=(?!=)", line, maxsplit=1)))
    named = re.findall(r"[A-Za-z_]\w*", made_last)  # what the line uses tells more than what it was to make
    names = [n for n in dict.fromkeys(named) if n in here] if named else list(here)
    shown = {name: here[name] for name in names[:SHOWN]}
    arrays = [name for name, value in shown.items() if isinstance(value, np.ndarray) and value.ndim]
    told = [_brief(name, value) for name, value in shown.items() if name not in arrays]
    shapes = ", ".join(f"{name} {shown[name].shape}" for name in arrays)
    if len(arrays) == 1:
        told.append(f"{arrays[0]} has shape {shown[arrays[0]].shape}")
    elif arrays:
        told.append(f"shapes {shapes}" if told else f"the shapes are {shapes}")
    return ", ".join(told)


def _brief(name: str, value: Any) -> str:
    if isinstance(value, list | tuple):
        return f"{name} has {len(value)} entries"
    if isinstance(value, bool | np.bool_):
        return f"{name} is {value}"
    if isinstance(value, float | int | np.number):
        return f"{name} = {value:.4g}"
    shown = repr(value)
    return f"{name} is {shown}" if len(shown) <= 30 else f"{name} is a {type(value).__name__}"
