"""Stands in the box for what is absent there, so that an honest student reads which rule was broken.

Nothing lies behind it: there is no code of the library's that one could reach by taking this apart.
"""

from __future__ import annotations

import sys
from collections.abc import Callable


class LibraryLocked(Exception):
    """A student's function calls the library for what it should work out itself."""


class Absent:
    """Has every name and can be called: that raises `LibraryLocked`, which names the function."""

    def __init__(self, name: str) -> None:
        self.__dict__["name"] = name

    def __getattr__(self, name: str) -> Absent:
        return _absent(self.__dict__["name"], name)

    def __call__(self, *args: object, **kwargs: object) -> None:
        refuse(self.__dict__["name"])


def names_of(owner: str, *modules: str) -> Callable[[str], Absent]:
    """The `__getattr__` of a module, or of a robot: whatever is not there is Absent, but for modules in it.

    >>> names_of("lie")("log6").name
    'lie.log6'
    """
    return lambda name: _absent(owner, name, modules)


def _absent(owner: str, name: str, modules: tuple[str, ...] = ()) -> Absent:
    if name.startswith("__") or name in modules:
        raise AttributeError(name)
    return Absent(f"{owner}.{name}")


def refuse(name: str) -> None:
    """Raise what the student reads."""
    raise LibraryLocked("your function calls coursekit's own " + name + "; write it yourself")


def only_inside(name: str) -> None:
    """Refuse, unless the library itself is calling: for what allowed functions need in turn.

    A courtesy that says what `check` would say, and no lock: none of these functions answers an exercise.
    """
    frame = sys._getframe(2)
    if not str(frame.f_globals.get("__name__", "")).startswith("coursekit."):
        refuse(name)
