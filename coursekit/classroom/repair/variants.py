"""What could stand at one place of a function instead: another operator, order, index, name, number, call.

For every kind of node: the pieces it is made of, how they are ordinarily put together, and the variants.
`value(pieces, variables)` computes a variant from the values of the pieces and of the function's variables.
"""

from __future__ import annotations

import ast
import itertools
import math
import operator
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .brackets import fraction, sum_without_brackets
from .finite import LINALG
from .indices import changes, fixed, index_value, indexed_by
from .undone import one_undone


class Variant(NamedTuple):  # there are thousands, and nothing else that cannot change is made so quickly
    """One edit of a place. The smaller its rank, the earlier it is tried."""

    kind: str  # of texts.py
    value: Callable[[tuple, dict], Any]
    what: str = ""  # the name in the sentence
    rank: int = 1
    unless: Callable[[tuple, dict], Any] | None = None  # no finding where this would do as well


def variable(name: str) -> Callable:
    """The value of a variable in place of the node's."""
    return lambda p, v: _number_like(v[name])


def _number_like(value: Any) -> Any:
    """A list put into itself would let numpy search for its end without one."""
    if isinstance(value, list | dict | set):
        raise TypeError("no number")
    return value


Made = tuple[Callable[[], list], Callable, list[Variant]]  # pieces, ordinary value, variants


def _matrix_product(x: Any, y: Any) -> Any:
    """x @ y; for a number still *: where every * is tried at once, some are between numbers."""
    return x @ y if np.ndim(x) and np.ndim(y) else x * y


_OPERATORS: dict[type, Callable] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.MatMult: operator.matmul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Mod: operator.mod,
    ast.FloorDiv: operator.floordiv,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
}
INSTEAD: dict[type, tuple[type, ...]] = {
    ast.Add: (ast.Sub, ast.Mult),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.MatMult, ast.Div),
    ast.MatMult: (ast.Mult,),
    ast.Div: (ast.Mult,),
    ast.Pow: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
}
_COMPARE: dict[type, Callable] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_ALIKE = (
    ("sin", "cos", "tan"),
    ("tan", "arctan"),
    ("arcsin", "arccos", "arctan"),
    ("asin", "acos", "atan"),
    ("any", "all"),
    ("min", "max", "mean", "sum"),
    ("argmin", "argmax"),
    ("amin", "amax"),
    ("floor", "ceil", "round"),
    ("mod", "fmod"),
    ("inv", "pinv"),
    ("eig", "eigh"),
    ("vstack", "hstack", "column_stack"),
    ("ones", "eye"),
    ("zeros", "eye"),
    ("dot", "cross", "outer"),
    ("radians", "degrees"),
    ("hypot", "add"),
    ("diff", "gradient"),
)
# Never wrapped or changed: what makes arrays could be told to make enormous ones.
# Things to be indexed and nothing else: numpy would look for their end, which they have not.
INDEXERS = {"r_", "c_", "s_", "mgrid", "ogrid", "index_exp"}
SIZES = {"zeros", "ones", "empty", "full", "eye", "identity", "arange", "linspace", "range", "tile", "repeat"}


def called(node: ast.Call) -> str:
    """The name of what is called, without its module."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def whole(node: ast.expr, variables: list[str]) -> Made:
    """A node that is taken as it is."""
    return (lambda: [node]), lambda p, _: p[0], []


def _binary(node: ast.BinOp, variables: list[str]) -> Made:
    kind = type(node.op)
    compute = _OPERATORS.get(kind)
    if compute is None:
        return whole(node, variables)
    variants = [
        Variant("sign" if {kind, new} == {ast.Add, ast.Sub} else "operator", _apply(_OPERATORS[new]), rank=0)
        for new in INSTEAD.get(kind, ())
    ]
    if kind is ast.Mult:
        variants.append(Variant("products", _apply(_matrix_product), rank=0))
    if kind is ast.Div and isinstance(node.left, ast.Constant) and node.left.value == 1:
        variants.append(Variant("inverse", lambda p, _: np.linalg.inv(p[1]), rank=0))
    if kind is ast.Mod:
        variants.append(Variant("modulo", lambda p, _: p[0], rank=0))
    if kind in (ast.MatMult, ast.Sub, ast.Div, ast.Pow):
        variants.append(Variant("order", lambda p, _: compute(p[1], p[0]), rank=0))
    if kind is ast.Sub:
        variants.append(Variant("sign", lambda p, _: -p[0] - p[1]))
    if kind is ast.Add:
        variants.append(Variant("operator", _apply(np.hypot)))
    if kind is ast.Pow:
        variants.append(Variant("operator", _apply(np.linalg.matrix_power), rank=0))
    variants.append(Variant("extra", lambda p, _: p[0]))
    variants.append(Variant("extra", lambda p, _: p[1]))
    if kind in (ast.Add, ast.Sub) and (sum_ := sum_without_brackets(node, _OPERATORS)):
        return sum_[0], lambda p, _: compute(p[0], p[1]), [*variants, Variant("sum", sum_[1], rank=0)]
    if kind is ast.MatMult and (inner := one_undone(node)):
        matrix, word, other = inner
        variants.append(Variant(f"other_{word}", other, rank=0))
        return (lambda: [node.left, node.right, matrix]), _apply(compute), variants
    parts = fraction(node)
    if len(parts) > 2:  # x / 2 * a: the whole product was meant to stand below the line
        variants = [v for v in variants if v.kind != "operator"]  # x / 2 / a is the same
        below = len(parts) - 1
        variants.append(Variant("brackets", lambda p, _: p[2] / math.prod(p[3:]), rank=0))
        return (lambda: [node.left, node.right, *parts[: below + 1]]), _apply(compute), variants
    return (lambda: [node.left, node.right]), _apply(compute), variants


def _apply(compute: Callable) -> Callable:
    return lambda p, _: compute(p[0], p[1])


def _unary(node: ast.UnaryOp, variables: list[str]) -> Made:
    if isinstance(node.op, ast.USub):
        return (lambda: [node.operand]), lambda p, _: -p[0], [Variant("sign", lambda p, _: p[0], rank=0)]
    if isinstance(node.op, ast.Not):
        return (
            (lambda: [node.operand]),
            lambda p, _: not p[0],
            [Variant("comparison", lambda p, _: p[0], rank=0)],
        )
    return whole(node, variables)


def _comparison(node: ast.Compare, variables: list[str]) -> Made:
    kind = type(node.ops[0])
    if len(node.ops) != 1 or kind not in _COMPARE:
        return whole(node, variables)
    variants = [Variant("comparison", _apply(new), rank=0) for op, new in _COMPARE.items() if op is not kind]
    return (lambda: [node.left, node.comparators[0]]), _apply(_COMPARE[kind]), variants


def _boolean(node: ast.BoolOp, variables: list[str]) -> Made:
    whole, other = (all, any) if isinstance(node.op, ast.And) else (any, all)
    return (
        lambda: list(node.values),
        lambda p, _: whole(p),
        [Variant("comparison", lambda p, _: other(p), rank=0)],
    )


def _constant(node: ast.Constant, variables: list[str]) -> Made:
    v = node.value
    if isinstance(v, bool) or not isinstance(v, int | float):
        return whole(node, variables)
    new = [v + 1, v - 1, -v, 2 * v, v / 2, 0, 1, 3, 6, v / 1000]
    if isinstance(v, int):  # it may be a size: no large ones
        new = [int(x) if float(x).is_integer() else x for x in new]
    else:
        new += [1000 * v, *([1e-12] if 0 < v < 0.1 else [])]  # a tolerance that was too large
    distinct = [x for k, x in enumerate(new) if x != v and x not in new[:k]]
    # a 0 takes something away altogether: that it is too much is the better word
    variants = [_number(v, x)._replace(rank=0 if x or abs(v) == 1 else 1) for x in distinct]
    return (lambda: [node]), lambda p, _: p[0], variants


def _number(old: float, new: float) -> Variant:
    kind = _kind_of_number(old, new)
    farther = _give(100 * new if abs(new) > abs(old) else new / 100)
    return Variant(kind, _give(new), rank=0, unless=farther if kind == "millimetres" else None)


def _kind_of_number(old: float, new: float) -> str:
    if new == -old:
        return "sign"
    lengths = old and new and {abs(old / new), abs(new / old)} == {1000.0, 0.001}
    return "millimetres" if lengths and max(abs(old), abs(new)) >= 1 else "number"  # 1e-4 is no length in mm


def _give(value: Any) -> Callable:
    return lambda p, _: value


def _name(node: ast.Name, variables: list[str]) -> Made:
    if node.id not in variables:
        return whole(node, variables)
    others = [Variant("name", variable(v), what=node.id) for v in variables if v != node.id]
    others.append(Variant("stray", _give(0), what=node.id, rank=2))  # a table's entry that is 0
    return (lambda: [node]), lambda p, _: p[0], others


def _attribute(node: ast.Attribute, variables: list[str]) -> Made:
    if node.attr == "T":
        variants = [
            Variant("transposed", lambda p, _: p[0], rank=0),
            Variant("inverse", lambda p, _: np.linalg.inv(p[0]), rank=0),
        ]
        return (lambda: [node.value]), lambda p, _: p[0].T, variants
    return whole(node, variables)


def _display(node: ast.Tuple | ast.List, variables: list[str]) -> Made:
    if any(isinstance(e, ast.Starred) for e in node.elts):
        return whole(node, variables)
    make = list if isinstance(node, ast.List) else tuple
    variants = [
        Variant("entries", _swap(i, j, make), rank=0)
        for i, j in itertools.combinations(range(min(len(node.elts), 7)), 2)
    ]
    if len(node.elts) > 2:
        variants.append(Variant("entries", lambda p, _: make(p[::-1])))
    return (lambda: list(node.elts)), lambda p, _: make(p), variants


def _swap(i: int, j: int, make: Callable) -> Callable:
    def value(p, _):
        entries = list(p)
        entries[i], entries[j] = entries[j], entries[i]
        return make(entries)

    return value


def _call(node: ast.Call, variables: list[str]) -> Made:
    if any(isinstance(a, ast.Starred) for a in node.args) or any(k.arg is None for k in node.keywords):
        return whole(node, variables)
    name, count, keys = called(node), len(node.args), [str(k.arg) for k in node.keywords]

    def with_change(change: Callable | None = None) -> Callable:
        """The call, after `change(function, arguments, keywords)`, which may return another function."""

        def value(p, _):
            function, arguments, given = (
                p[0],
                list(p[1 : count + 1]),
                dict(zip(keys, p[count + 1 :], strict=False)),
            )
            if change is not None:
                function = change(function, arguments, given) or function
            return function(*arguments, **given)

        return value

    def variant(kind: str, change: Callable, what: str = name) -> Variant:
        return Variant(kind, with_change(change), what, rank=0)

    variants = [variant("arguments", _exchange(i, j)) for i, j in itertools.combinations(range(count), 2)]
    for group in _ALIKE:
        if name in group:
            variants += [variant("function", _function(other)) for other in group if other != name]
    for key in keys:
        variants += [
            variant("keyword", _keyword(key, new), key) for new in (_AXES if key == "axis" else [None])
        ]
    if name in _ALONG_AXES and "axis" not in keys:
        variants += [variant("keyword", _keyword("axis", new), "axis") for new in _AXES]
    if count == 1 and name not in SIZES and name not in ("len", "zip", "enumerate"):
        variants.append(Variant("call", lambda p, _: p[1], name))
    if name in _LIMITING and count > 1:
        variants.append(Variant("call", lambda p, _: p[1], name, rank=0))
    if name == "norm" and count == 1 and not keys:  # of a position, its distance from an axis
        variants += [Variant("index", with_change(_part(slice(2))))]
    if name == "sign":
        variants.append(Variant("sign_of_zero", lambda p, _: np.where(p[1] < 0, -1.0, 1.0), rank=0))
    quotient = node.args[0] if count == 1 else None
    extra: list[ast.expr] = []
    if name in ("arctan", "atan") and isinstance(quotient, ast.BinOp) and isinstance(quotient.op, ast.Div):
        extra = [quotient.left, quotient.right]
        variants.append(Variant("function", lambda p, _: np.arctan2(p[-2], p[-1]), name, rank=0))
    return (
        (lambda: [node.func, *node.args, *(k.value for k in node.keywords), *extra]),
        with_change(),
        variants,
    )


_AXES = (0, 1, -1)
_ALONG_AXES = (
    *("norm", "sum", "max", "min", "mean", "argmax", "argmin"),
    *("all", "any", "diff", "cumsum", "flip"),
)


_LIMITING = ("clip", "minimum", "maximum", "min", "max", "mod", "fmod", "remainder", "round", "around")


def _exchange(i: int, j: int) -> Callable:
    def change(_, arguments, given):
        arguments[i], arguments[j] = arguments[j], arguments[i]

    return change


def _part(some: slice) -> Callable:
    def change(_, arguments, given):
        if np.shape(arguments[0]) != (3,):
            raise ValueError("no position")
        arguments[0] = arguments[0][some]

    return change


def _function(other: str) -> Callable:
    def change(function, arguments, *_):
        if other == "eye" and arguments and isinstance(arguments[0], tuple):  # zeros((4, 4))
            arguments[:1] = arguments[0]
        owner = getattr(function, "__self__", None)  # a method: lam.max() to lam.min()
        if isinstance(owner, np.ndarray):
            return getattr(owner, other)
        return getattr(np, other, None) or getattr(LINALG, other)

    return change


def _keyword(key: str, new: int | None) -> Callable:
    def change(_, arguments, given):
        if new is None:
            del given[key]
        else:
            given[key] = new

    return change


def _subscript(node: ast.Subscript, variables: list[str]) -> Made:
    if isinstance(node.ctx, ast.Store):  # `x[i] = ...`: only the index is a value
        variants = [Variant("index", _on_index(change), rank=0) for change in changes(node.slice)]
        return (lambda: [index_value(node.slice)]), lambda p, _: p[0], variants
    if isinstance(node.value, ast.Attribute) and node.value.attr in INDEXERS:
        return whole(node, variables)
    variants = [Variant("index", _indexed(change), rank=0) for change in changes(node.slice)]
    variants.append(Variant("index", lambda p, _: p[0]))
    variants += [Variant("index", indexed_by(k, name)) for k in fixed(node.slice) for name in variables]
    return (lambda: [node.value, index_value(node.slice)]), lambda p, _: p[0][p[1]], variants


def _on_index(change: Callable) -> Callable:
    return lambda p, _: change(p[0])


def _indexed(change: Callable) -> Callable:
    return lambda p, _: p[0][change(p[1])]


MAKERS: dict[type, Callable] = {
    ast.BinOp: _binary,
    ast.UnaryOp: _unary,
    ast.Compare: _comparison,
    ast.BoolOp: _boolean,
    ast.Constant: _constant,
    ast.Name: _name,
    ast.Attribute: _attribute,
    ast.Tuple: _display,
    ast.List: _display,
    ast.Call: _call,
    ast.Subscript: _subscript,
}
