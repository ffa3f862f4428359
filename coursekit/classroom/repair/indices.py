"""What could stand in an index instead: another row, the two turned round, a slice one longer or shorter."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator


def changes(node: ast.expr) -> Iterator[Callable]:
    """Functions of the value of an index, each of which gives another index."""
    count = len(node.elts) if isinstance(node, ast.Tuple) else 1
    yield from (_changed_index(k, change) for k in range(count) for change in _CHANGES)
    if isinstance(node, ast.Tuple) and count == 2:
        yield _turned_index
        yield _counted_from_1


def fixed(node: ast.expr) -> list[int | None]:
    """Where a number stands in an index: at which places of a tuple, or [None] if it is the index itself."""
    if isinstance(node, ast.Tuple):
        return [k for k, part in enumerate(node.elts) if _is_number(part)]
    return [None] if _is_number(node) else []


def indexed_by(k: int | None, name: str) -> Callable:
    """A variable that counts, where a fixed index stands: x[i] for x[0]."""

    def value(p, v):
        i = operator.index(v[name])
        return p[0][i if k is None else (*p[1][:k], i, *p[1][k + 1 :])]

    return value


def _is_number(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, int)


def index_value(node: ast.expr) -> ast.expr:
    """An index as an expression: `:3, i` becomes (slice(None, 3, None), i)."""
    if isinstance(node, ast.Slice):
        bounds = [part or ast.Constant(None) for part in (node.lower, node.upper, node.step)]
        return ast.Call(ast.Name("slice", ast.Load()), bounds, [])
    if isinstance(node, ast.Tuple):
        return ast.Tuple([index_value(e) for e in node.elts], ast.Load())
    return node


def _changed_index(k: int, change: Callable) -> Callable:
    def value(index):
        if not isinstance(index, tuple):
            return change(index)
        return (*index[:k], change(index[k]), *index[k + 1 :])

    return value


def _turned_index(index):
    return index[::-1]


def _counted_from_1(index):
    return tuple(map(_shifted(-1), index))


def _shifted(by: int) -> Callable:
    def change(index):
        if isinstance(index, slice):
            return slice((index.start or 0) + by, None if index.stop is None else index.stop + by, index.step)
        return index + by

    return change


_CHANGES: tuple[Callable, ...] = (
    _shifted(1),
    _shifted(-1),
    _shifted(2),
    _shifted(-2),
    lambda s: slice(s.stop, s.start, s.step),
    lambda s: slice(s.start, s.stop, -1 if s.step is None else None),
    lambda s: slice(None),
    lambda s: slice(s.start, s.stop - 1),
    lambda s: slice(s.start, s.stop + 1),
    lambda s: slice((s.start or 0) + 1, s.stop),
    lambda s: slice(s.start - 1, s.stop),
    lambda i: slice(None, i),
    lambda i: slice(i, None),
)
