"""What a student wrote, used by the cells below it: `yours` for one value, `use` for a loop.

A notebook goes on with the student's own function wherever it can. Where it cannot (not written yet, raises,
another shape, NaN), it goes on with the course's value and says so in one sentence: nobody is stuck in
section 3 because of section 2, and no cell ends in forty lines of traceback.
"""

from __future__ import annotations

import copy
import traceback
from collections.abc import Callable
from typing import Any

import numpy as np

from .attempt import call_from
from .compare import mask
from .course import course_here
from .exercise import Exercise, Misfit, answer

AGREE = 1e-9  # where there is no exercise of the function's name, which has its own tolerance


class _Unusable(Exception):
    """There is no value to go on with; the text says why, as the second half of a sentence."""


def yours(function: Callable, *arguments: Any, course: Any) -> Any:
    """Call a function you wrote, print one sentence beside the course's value, return a value to go on with.

    Parameters
    ----------
    function : callable
        What you wrote. It gets copies of the arguments, so that it cannot change them.
    *arguments
        What it is called with.
    course : value or callable
        The right value; a callable is called with the same arguments.

    Returns
    -------
    Your value, right or wrong; the course's, where there is none: the function is not written yet, raises,
    or returns another shape or NaN.

    Examples
    --------
    >>> from coursekit.classroom import yours
    >>> def double(x):
    ...     return 2 * x
    >>> yours(double, 1.5, course=3.0)
    double: yours and the course's agree.
    3.0
    >>> def triple(x):
    ...     raise NotImplementedError
    >>> yours(triple, 1.5, course=4.5)
    triple is not written yet: the course's value is used here.
    4.5
    """
    name, exercise = _name(function), _exercise(function)
    right = course(*_copies(arguments)) if callable(course) else course
    try:
        value = _called(function, exercise, arguments, right)
    except _Unusable as reason:
        print(f"{name} {reason}: the course's value is used here.")
        return right
    if unlike := _unlike(function, exercise, arguments, value, right):
        print(f"{name}: yours {unlike}; yours is used here.")
    else:
        print(f"{name}: yours and the course's agree.")
    return value


def use(function: Callable, course: Callable) -> Callable:
    """The function you wrote, for a loop; the course's takes its place where yours gives nothing usable.

    Parameters
    ----------
    function : callable
        What you wrote.
    course : callable
        The course's own, of the same arguments and results.

    Returns
    -------
    callable
        Takes the same arguments. When it takes the course's value for the first time, it says so once.

    Examples
    --------
    >>> from coursekit.classroom import use
    >>> def half(x):
    ...     raise NotImplementedError
    >>> step = use(half, course=lambda x: x / 2)
    >>> step(8.0), step(2.0)
    half is not written yet: the course's is used here.
    (4.0, 1.0)
    """
    name, exercise = _name(function), _exercise(function)
    said: list[str] = []

    def either(*arguments):
        right = course(*_copies(arguments))
        try:
            return _called(function, exercise, arguments, right)
        except _Unusable as reason:
            if not said:
                print(f"{name} {reason}: the course's is used here.")
                said.append(name)
            return right

    return either


def _called(function: Callable, exercise: Exercise | None, arguments: tuple, right: Any) -> Any:
    """The function's value on copies of the arguments; _Unusable if one cannot go on with it."""
    try:
        with np.errstate(all="ignore"):
            value = function(*_copies(arguments))
    except NotImplementedError as error:
        missing = traceback.extract_tb(error.__traceback__)[-1].name
        if missing in ("<lambda>", _name(function)):
            raise _Unusable("is not written yet") from None
        raise _Unusable(f"needs `{missing}`, which is not written yet") from None
    except Exception as error:
        raise _Unusable(f"raises {type(error).__name__}{_line(function, error)} ({_short(error)})") from None
    try:
        found = _parts(exercise, value)
    except Misfit as misfit:
        raise _Unusable(f"gives nothing to go on with ({misfit})") from None
    expected = _parts(exercise, right)
    if not _same_shapes(exercise, found, expected):
        came, wanted = (", ".join(str(part.shape) for part in parts) for parts in (found, expected))
        raise _Unusable(f"returns shape {came} instead of {wanted}")
    if any(np.isnan(f).any() and not np.isnan(e).any() for f, e in zip(found, expected, strict=True)):
        raise _Unusable("returns NaN")
    if exercise and exercise.several:
        return tuple(map(_array, value))
    return _array(value) if exercise else value


def _unlike(function: Callable, exercise: Exercise | None, arguments: tuple, value: Any, right: Any) -> str:
    """'' where two values agree (turns and free signs do not count), or how they differ."""
    found, expected = _parts(exercise, value), _parts(exercise, right)
    if exercise and "any_solution" in exercise.kinds:
        mine = exercise.value(found)  # arrays, where yours are lists
        keeps = all(law(function, list(arguments), mine) for _, law in exercise.laws)
        return "" if keeps else "breaks a law of it"
    kinds = exercise.kinds if exercise else ("close",) * len(found)
    tolerance = max(AGREE, exercise.tol if exercise else 0.0)
    largest = 0.0
    for kind, mine, theirs in zip(kinds, found, expected, strict=True):
        if mine.shape != theirs.shape:
            return f"has {len(mine)} rows, the course's {len(theirs)}"
        wrong = ~mask(kind, mine, theirs, tolerance)
        if wrong.any():
            largest = max(largest, float(np.abs(np.where(wrong, mine - theirs, 0.0)).max()))
    return f"differs from the course's by up to {largest:.3g}" if largest else ""


def _parts(exercise: Exercise | None, value: Any) -> list[np.ndarray]:
    """The arrays a value is made of."""
    if exercise is not None:
        return answer(exercise, value)
    if value is None:
        raise Misfit("it returns None: is there a `return` at its end?")
    try:
        return [np.asarray(part, dtype=float) for part in (value if isinstance(value, tuple) else (value,))]
    except (TypeError, ValueError):
        raise Misfit(f"{type(value).__name__} is not an array of numbers") from None


def _array(value: Any) -> Any:
    """A list as an array: the cells below multiply and slice what they get."""
    return np.array(value, float) if isinstance(value, list | tuple) else value


def _same_shapes(exercise: Exercise | None, found: list, expected: list) -> bool:
    """Equal, but for axes that the exercise leaves free: a set with too few rows is wrong, no more."""
    if len(found) != len(expected):
        return False
    free = exercise.shapes if exercise else [()] * len(found)
    for mine, theirs, shape in zip(found, expected, free, strict=True):
        if mine.ndim != theirs.ndim:
            return False
        loose = shape if len(shape) == mine.ndim else (0,) * mine.ndim
        if any(
            a != b and axis is not None for a, b, axis in zip(mine.shape, theirs.shape, loose, strict=True)
        ):
            return False
    return True


def _exercise(function: Callable) -> Exercise | None:
    """The exercise of the function's name; looking it up costs a hundred calls of one, so it is done once."""
    course, name = course_here(), _name(function)
    return course.find(name)[1] if course.has(name) else None


def _copies(arguments: tuple) -> list:
    return [copy.deepcopy(a) if isinstance(a, np.ndarray | list) else a for a in arguments]


def _name(function: Callable) -> str:
    return getattr(function, "__name__", type(function).__name__)


def _line(function: Callable, error: Exception) -> str:
    """' in its line 3', counted from its def; '' if it cannot be told."""
    found = call_from(function, error)
    return f" in its line {found[1] - found[0].f_code.co_firstlineno + 1}" if found else ""


def _short(error: Exception) -> str:
    text = str(error).splitlines()[0] if str(error) else "without a text"
    return text if len(text) <= 80 else text[:77] + "..."
