"""numpy for trials: LAPACK never gets what it does not come back from, or prints about.

Of an infinity `svd`, `pinv` and `lstsq` may not return at all, and of a NaN `lstsq` writes lines of its own
to the terminal. An edit makes such numbers easily (1 / 0, the root of less than 0); no right answer has them.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

NAMES = ("svd", "pinv", "lstsq")


def only_finite(function: Callable) -> Callable:
    """The same, but a LinAlgError for what is not finite."""

    @functools.wraps(function)
    def guarded(a: Any, *more: Any, **named: Any) -> Any:
        if not all(np.isfinite(x).all() for x in (a, *more[:1])):  # lstsq(A, b)
            raise np.linalg.LinAlgError("not finite")
        return function(a, *more, **named)

    return guarded


def _copy(module: ModuleType, **instead: Any) -> ModuleType:
    copy = ModuleType(module.__name__)
    vars(copy).update(vars(module) | instead)
    return copy


LINALG = _copy(np.linalg, **{name: only_finite(getattr(np.linalg, name)) for name in NAMES})
NUMPY = _copy(np, linalg=LINALG)
_INSTEAD = ((np, NUMPY), (np.linalg, LINALG), *((getattr(np.linalg, n), getattr(LINALG, n)) for n in NAMES))


def in_a_trial(value: Any) -> Any:
    """What a trial has of a student's name: numpy's copy in place of numpy, else the value itself."""
    return next((other for one, other in _INSTEAD if one is value), value)
