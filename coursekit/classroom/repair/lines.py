"""Edits of whole lines: one too many, two that are swapped, a return inside the loop."""

from __future__ import annotations

import ast
import copy
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from .places import is_docstring, is_tick, located
from .variants import INSTEAD


@dataclass(frozen=True)
class LineEdit:
    """An edit of the tree itself: `put()` makes it and returns what takes it back."""

    kind: str
    line: int
    put: Callable[[], Callable[[], None]]
    what: str = ""


def line_edits(function: ast.FunctionDef) -> Iterator[LineEdit]:
    """A line too much, two lines swapped, a return inside the loop, names unpacked in another order."""
    for parent in ast.walk(function):
        for name in ("body", "orelse"):
            body = getattr(parent, name, None)
            if isinstance(body, list):
                yield from _edits_of_body(body)
    for node in ast.walk(function):
        if isinstance(node, ast.AugAssign):
            yield from _edits_of_update(node, function)
        if isinstance(node, ast.Tuple) and isinstance(node.ctx, ast.Store):
            for i, j in itertools.combinations(range(len(node.elts)), 2):
                yield LineEdit("unpacked", node.lineno, _exchange(node.elts, i, j))


def name_edits(function: ast.FunctionDef) -> Iterator[LineEdit]:
    """Two names that were taken for each other, in all of the function; two products that were, in a line."""
    used: dict[str, list[ast.Name]] = {}
    for node in ast.walk(function):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            used.setdefault(node.id, []).append(node)
    own = {a.arg for a in function.args.args}
    own |= {n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    for a, b in itertools.combinations([name for name in used if name in own], 2):
        lines = {node.lineno for node in (*used[a], *used[b])}
        line = lines.pop() if len(lines) == 1 else 0
        yield LineEdit("mixed_up", line, _rename(used[a], used[b], a, b), f"{a}` and `{b}")
    for statement in ast.walk(function):
        if isinstance(statement, ast.Assign | ast.Return):
            yield from _exchanges_in(statement)


def _exchanges_in(statement: ast.stmt) -> Iterator[LineEdit]:
    """Two sums or products of one line that stand in each other's place."""
    hung = [
        (parent, name, child)
        for parent in ast.walk(statement)
        for name, child in ast.iter_fields(parent)
        if isinstance(child, ast.BinOp)
    ]
    for one, other in itertools.combinations(hung[:10], 2):
        inside = {id(n) for n in ast.walk(one[2])} & {id(n) for n in ast.walk(other[2])}
        if not inside:
            yield LineEdit("places", one[2].lineno, _change_places(one, other))


def _edits_of_body(body: list) -> Iterator[LineEdit]:
    real = [i for i, s in enumerate(body) if not is_tick(s) and not is_docstring(s)]
    for i, j in itertools.pairwise(real):
        if not isinstance(body[j], ast.Return):  # behind it a line would only be left out, as below
            yield LineEdit("lines", body[i].lineno, _exchange(body, i, j))
    for i in real:
        if len(real) > 1 and not isinstance(body[i], ast.FunctionDef):
            yield LineEdit("line", body[i].lineno, _replace(body, i, []))
        elif isinstance(body[i], ast.Assign | ast.AugAssign):  # all that an `if` does
            nothing = ast.copy_location(ast.Pass(), body[i])
            yield LineEdit("line", body[i].lineno, _replace(body, i, [nothing]))
        inner: list = getattr(body[i], "body", [])
        if isinstance(body[i], ast.For | ast.While) and len(inner) > 2:
            last = inner[-1]
            if isinstance(last, ast.Return):
                yield LineEdit("return", last.lineno, _move_out(body, i, inner))
            else:
                yield LineEdit("indented", last.lineno, _move_out(body, i, inner))
        follows = isinstance(body[i], ast.For | ast.While) and i + 1 < len(body)
        if follows and not isinstance(body[i + 1], ast.Return):
            yield LineEdit("indented", body[i + 1].lineno, _move_in(body, i, inner))


def _edits_of_update(node: ast.AugAssign, function: ast.FunctionDef) -> Iterator[LineEdit]:
    for new in INSTEAD.get(type(node.op), ()):
        kind = "sign" if {type(node.op), new} == {ast.Add, ast.Sub} else "operator"
        yield LineEdit(kind, node.lineno, _set(node, "op", new()))
    anew = located(ast.Assign([node.target], node.value), node)
    target = copy.deepcopy(node.target)
    target.ctx = ast.Load()
    for parent in ast.walk(function):
        body = getattr(parent, "body", None)
        if isinstance(body, list) and node in body:
            i = body.index(node)
            yield LineEdit("grows", node.lineno, _replace(body, i, [anew]), ast.unparse(node.target))
            commutes = isinstance(node.op, ast.Add | ast.Mult)  # then the other order only makes a new array
            orders = [] if commutes else [("order", node.value, target)]
            for kind, left, right in (*orders, ("in_place", target, node.value)):
                value = ast.BinOp(left, node.op, right)
                new = located(ast.Assign([node.target], value), node)
                yield LineEdit(kind, node.lineno, _replace(body, i, [new]))


def _exchange(items: list, i: int, j: int) -> Callable:
    def put():
        items[i], items[j] = items[j], items[i]
        return put

    return put


def _replace(items: list, i: int, new: list) -> Callable:
    def put():
        old = items[:]
        items[i : i + 1] = new
        return lambda: items.__setitem__(slice(None), old)

    return put


def _move_out(body: list, i: int, inner: list) -> Callable:
    def put():
        body.insert(i + 1, inner.pop())
        return lambda: inner.append(body.pop(i + 1))

    return put


def _move_in(body: list, i: int, inner: list) -> Callable:
    def put():
        inner.append(body.pop(i + 1))
        return lambda: body.insert(i + 1, inner.pop())

    return put


def _set(node: ast.AST, name: str, new: Any) -> Callable:
    def put():
        old = getattr(node, name)
        setattr(node, name, new)
        return lambda: setattr(node, name, old)

    return put


def _rename(first: list[ast.Name], second: list[ast.Name], a: str, b: str) -> Callable:
    def put():
        for node in first:
            node.id = b if node.id == a else a
        for node in second:
            node.id = a if node.id == b else b
        return put

    return put


def _change_places(one: tuple, other: tuple) -> Callable:
    def put():
        setattr(one[0], one[1], other[2])
        setattr(other[0], other[1], one[2])

        def back():
            setattr(one[0], one[1], one[2])
            setattr(other[0], other[1], other[2])

        return back

    return put
