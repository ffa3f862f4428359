"""What could have been done to a value, or forgotten: a sign, a root, an inverse, a factor, a term."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator

import numpy as np

from .variants import Variant, variable


def _millimetres(x):
    """1000 x, but not of quarter turns: a thousand of them are the angle 0, and no length."""
    quarters = np.divide(x, np.pi / 2)
    return x if np.any(quarters) and np.all(quarters == np.rint(quarters)) else 1000 * x


def _halves_exchanged(x):
    if np.shape(x)[:1] != (6,):
        raise ValueError("no twist")
    return np.roll(x, 3, axis=0)


# (kind, what is done, what must not do as well). A copy mends what is shared, and then its transpose does so;
# decimals mend whole numbers, and then an inverse does so, which holds them;
# where any other length would do, neither a unit vector nor millimetres are the matter.
_DONE: tuple[tuple[str, Callable, Callable | None], ...] = (
    ("sign", lambda x: -x, None),
    ("transposed", lambda x: np.swapaxes(x, -1, -2), np.array),
    ("inverse", np.linalg.inv, lambda x: np.array(x, float)),
    ("reversed", lambda x: x[::-1], None),
    ("half", lambda x: x / 2, None),
    ("half", lambda x: 2 * x, None),
    ("turn", lambda x: x + np.pi, None),
    ("turn", lambda x: np.pi - x, None),
    ("root", np.sqrt, None),
    ("root", lambda x: x * x, None),
    ("unit_length", lambda x: x / np.linalg.norm(x), lambda x: 1.1 * x),
    ("unit_length", lambda x: x / np.linalg.norm(x, axis=-1, keepdims=True), lambda x: 1.1 * x),
    ("degrees", np.radians, None),
    ("degrees", np.degrees, None),
    ("absolute", np.abs, None),
    ("copy", np.array, None),
    ("one_minus", lambda x: 1 - x, None),
    ("upside_down", lambda x: 1 / x, None),
    ("millimetres", lambda x: x / 1000, lambda x: x / 1e5),
    ("millimetres", _millimetres, lambda x: 100_000 * x),
    ("whole_numbers", lambda x: np.asarray(x, float), None),
    ("turn", lambda x: (x + np.pi) % (2 * np.pi) - np.pi, None),
    ("halves", _halves_exchanged, None),
    ("entries", lambda x: np.roll(x, 1, axis=0), None),
    ("entries", lambda x: np.roll(x, -1, axis=0), None),
    ("negative_root", lambda x: np.maximum(x, 0), None),
    ("flipped", lambda x: x[:, ::-1], None),
)

_CALLS = ("arccos", "arcsin", "arctan", "cos", "sin")  # that may have been left out
_ENTRIES = 3  # the first entries of a vector may be what is missing
_JOINED: tuple[Callable, ...] = (
    lambda x, y: x + y,
    lambda x, y: x - y,
    lambda x, y: x * y,
    lambda x, y: x @ y,
    lambda x, y: y @ x,
    lambda x, y: x / y,
    np.hypot,
)


def wraps(ordinary: Callable, variables: list[str], node: ast.expr) -> Iterator[Variant]:
    """Something done to the value of a node, or a variable joined to it."""
    if isinstance(node, ast.List | ast.Tuple):  # -[1, 2] is none
        ordinary = _as_array(ordinary)
    for kind, do, control in _DONE:
        rank = 1 if kind in ("sign", "transposed", "inverse", "copy") else 2
        unless = _done(ordinary, control) if control else None
        yield Variant(kind, _done(ordinary, do), rank=rank, unless=unless)
    for name in _CALLS:
        yield Variant("missing", _done(ordinary, getattr(np, name)), what=name, rank=2)
    inside = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
    for name in variables:
        itself = isinstance(node, ast.Name) and node.id == name  # x - x and x / x are numbers, no repair
        for join in _JOINED if not itself else _JOINED[2:5]:
            rank = 3 if name in inside else 2
            yield Variant("missing", _joined(ordinary, join, variable(name)), what=name, rank=rank)
    for name in variables:
        for k in range(_ENTRIES):
            for join in _JOINED[:3]:
                yield Variant("missing", _joined(ordinary, join, _entry(name, k)), what=name, rank=3)


def _as_array(ordinary: Callable) -> Callable:
    return lambda p, v: np.array(ordinary(p, v))


def _done(ordinary: Callable, do: Callable) -> Callable:
    return lambda p, v: do(ordinary(p, v))


def _joined(ordinary: Callable, join: Callable, other: Callable) -> Callable:
    def value(p, v):
        y = other(p, v)
        if isinstance(y, bool | np.bool_):
            raise TypeError("a truth is no factor and no term")
        return join(ordinary(p, v), y)

    return value


def _entry(name: str, k: int) -> Callable:
    def value(p, v):
        if np.ndim(v[name]) != 1:
            raise TypeError("no vector")
        return v[name][k]

    return value
