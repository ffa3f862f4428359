"""The places of a function where an edit may be made, and how a probe is put there.

A probe is a call that gets the values of the pieces of a node, and the function's variables. So one
compilation serves all variants of a place.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from .brackets import fraction
from .sandbox import TICK
from .variants import INDEXERS, MAKERS, SIZES, Variant, called, whole
from .wraps import wraps

PROBE, LOCALS = "__probe", "__locals"


@dataclass(frozen=True)
class Place:
    """A node, where it hangs in the tree, and what it is made of."""

    node: ast.expr
    parent: ast.AST
    field: str
    at: int | None  # in a list of nodes
    pieces: Callable[[], list[ast.expr]]
    ordinary: Callable[[tuple, dict], Any]
    variants: tuple[Variant, ...]
    number: int = 0  # in source order, what is outside before what is inside

    def put(self, key: int) -> Callable[[], None]:
        """Put probe number `key` in the node's place; returns what takes it back."""
        arguments: list[ast.expr] = [
            ast.Constant(key),
            ast.Tuple(self.pieces(), ast.Load()),
            ast.Call(ast.Name(LOCALS, ast.Load()), [], []),
        ]
        probe: ast.expr = ast.Call(ast.Name(PROBE, ast.Load()), arguments, [])
        if isinstance(self.node, ast.Subscript) and isinstance(self.node.ctx, ast.Store):
            probe = ast.Subscript(self.node.value, probe, self.node.ctx)
        self._hang(located(probe, self.node))
        return lambda: self._hang(self.node)

    def _hang(self, node: ast.expr) -> None:
        if self.at is None:
            setattr(self.parent, self.field, node)
        else:
            getattr(self.parent, self.field)[self.at] = node


def places(function: ast.FunctionDef) -> Iterator[Place]:
    """Every expression of the function's body that something else could stand for, in source order."""
    variables = list(dict.fromkeys(_variables(function)))
    used = {n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}
    for number, (parent, field, at, node) in enumerate(list(_expressions(function))):
        place = replace(_place(parent, field, at, node, variables, used), number=number)
        if place.variants:
            yield place


def argument(line: ast.Assign) -> Place:
    """The value of a line `name = name` at the function's top: the argument in another form."""
    pieces, ordinary, _ = whole(line.value, [])
    variants = tuple(wraps(ordinary, [], line.value))
    return Place(line.value, line, "value", None, pieces, ordinary, variants)


_SIGNS = {ast.Mult: "*", ast.MatMult: "@", ast.Add: "+", ast.Sub: "-", ast.Div: "/", ast.Pow: "**"}


def likeness(node: ast.expr) -> str:
    """Places of one likeness may all have the same mistake; '' if the node is like no other."""
    match node:
        case ast.Call() if called(node):
            return f"{called(node)}"
        case ast.Name():
            return node.id
        case ast.BinOp() if len(fraction(node)) > 2:
            return "/ *"
        case ast.BinOp():
            return _SIGNS.get(type(node.op), "")
        case ast.Attribute(attr="T"):
            return ".T"
        case ast.Attribute(attr="pi"):
            return "pi"
        case ast.Constant(value=int() | float()):
            return repr(node.value)
        case ast.Subscript():
            text = ast.unparse(node.slice)
            return f"[{text[1:-1] if isinstance(node.slice, ast.Tuple) else text}]"
        case ast.UnaryOp(op=ast.USub()):
            return "minus"
    return ""


def located(new: ast.AST, like: ast.AST) -> Any:
    """Give new nodes the line of the one they replace."""
    for node in ast.walk(new):
        if isinstance(node, ast.expr | ast.stmt) and not hasattr(node, "lineno"):
            ast.copy_location(node, like)
    return new


def is_tick(node: ast.AST) -> bool:
    """The counter that the sandbox puts into loops: no line of the student's."""
    match node:
        case ast.Expr(value=ast.Call(func=ast.Name(id=name))):
            return name == TICK
    return False


def is_docstring(node: ast.AST) -> bool:
    """A text that stands alone: no line to edit."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _variables(function: ast.FunctionDef) -> Iterator[str]:
    yield from (a.arg for a in function.args.args)
    for node in ast.walk(function):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


def _expressions(function: ast.FunctionDef) -> Iterator[tuple[ast.AST, str, int | None, ast.expr]]:
    waiting: list = [(function, "body", k, s) for k, s in enumerate(function.body)]
    while waiting:
        parent, field, at, node = waiting.pop(0)
        if is_tick(node) or is_docstring(node):
            continue
        if _is_value(node):
            yield parent, field, at, node
        children: list[tuple] = []
        for name, value in ast.iter_fields(node):
            if isinstance(value, ast.AST):
                children.append((node, name, None, value))
            elif isinstance(value, list):
                children += [(node, name, k, v) for k, v in enumerate(value) if isinstance(v, ast.AST)]
        waiting[0:0] = children


def _is_value(node: ast.AST) -> bool:
    if isinstance(node, ast.Subscript):
        return not isinstance(node.ctx, ast.Del)  # where it is written to, its index may be wrong
    if isinstance(node, ast.Attribute) and node.attr in INDEXERS:
        return False
    if isinstance(node, ast.Slice | ast.Starred | ast.JoinedStr | ast.FormattedValue | ast.Lambda):
        return False
    return isinstance(node, ast.expr) and not isinstance(getattr(node, "ctx", None), ast.Store | ast.Del)


def _place(
    parent: ast.AST, field: str, at: int | None, node: ast.expr, variables: list[str], used: set[str]
) -> Place:
    pieces, ordinary, variants = MAKERS.get(type(node), whole)(node, variables)
    if isinstance(node, ast.Name):  # a variable that is used nowhere is likely to be what belongs there
        unused = [name not in used for name in variables if name != node.id]
        named = [v._replace(rank=0) if new else v for v, new in zip(variants, unused, strict=False)]
        variants = [*named, *variants[len(named) :]]
    if _may_wrap(parent, field, node):
        variants = [*variants, *wraps(ordinary, variables, node)]
    return Place(node, parent, field, at, pieces, ordinary, tuple(variants))


def _may_wrap(parent: ast.AST, field: str, node: ast.expr) -> bool:
    """Modules, functions and truths are no values; sizes stay as they are; an index changes as a whole."""
    if isinstance(node, ast.Constant | ast.Compare) or isinstance(getattr(node, "ctx", None), ast.Store):
        return False
    match parent:
        case ast.Attribute():
            return parent.attr == "T"
        case ast.Call():
            return field != "func" and called(parent) not in SIZES
        case ast.Subscript():
            return field == "value"
        case ast.Slice() | ast.keyword() | ast.Starred():
            return False
        case ast.Tuple() if isinstance(node, ast.Slice):
            return False
    return True
