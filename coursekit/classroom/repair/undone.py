"""A product with one factor inverted or transposed, where the other one was meant."""

from __future__ import annotations

import ast
from collections.abc import Callable

import numpy as np


def one_undone(node: ast.BinOp) -> tuple[ast.expr, str, Callable] | None:
    """inv(A) @ B, where A @ inv(B) may be meant, or the other way round; and the same of a transpose.

    The matrix that is undone, what was done to it, and the value from those of [left, right, that matrix].
    """
    (inner, left), (other, right) = _undone(node.left), _undone(node.right)
    if bool(left) == bool(right):
        return None
    undo = np.linalg.inv if "inverse" in (left, right) else np.transpose
    if left:
        return inner, left, lambda p, _: p[2] @ undo(p[1])
    return other, right, lambda p, _: undo(p[0]) @ p[2]


def _undone(node: ast.expr) -> tuple[ast.expr, str]:
    match node:
        case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name), args=[inner]):
            return (inner, "inverse") if name in ("inv", "inverse") else (node, "")
        case ast.Attribute(attr="T", value=inner):
            return inner, "transposed"
    return node, ""
