"""Brackets that may be missing: a product below a line, a sum in front of a product."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

DEEP = 4  # terms of a sum: of one sum in another, every piece is computed twice


def fraction(node: ast.expr) -> list[ast.expr]:
    """[x, a, b, c] of x / a * b * c, [] of anything else."""
    factors: list[ast.expr] = []
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        factors.insert(0, node.right)
        node = node.left
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        return [node.left, node.right, *factors]
    return []


def sum_without_brackets(
    node: ast.BinOp, operators: dict[type, Callable]
) -> tuple[Callable, Callable] | None:
    """x + 1 - c * A @ B, where x + (1 - c) * A @ B may be meant: pieces and value, None of anything else."""
    product: ast.expr = node.right
    factors: list[tuple[Callable, ast.expr]] = []
    while isinstance(product, ast.BinOp) and isinstance(product.op, ast.Mult | ast.MatMult):
        factors.insert(0, (operators[type(product.op)], product.right))
        product = product.left
    if not factors or _terms(node) > DEEP:
        return None
    add, left = operators[type(node.op)], node.left
    outer = left if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add | ast.Sub) else None
    parts = [product, *(factor for _, factor in factors), *([outer.left, outer.right] if outer else [])]

    def value(p: tuple, _: dict) -> Any:
        first, *others = p[2 : 3 + len(factors)]
        made = add(p[-1] if outer else p[0], first)
        for (times, _factor), other in zip(factors, others, strict=True):
            made = times(made, other)
        return operators[type(outer.op)](p[-2], made) if outer else made

    return lambda: [node.left, node.right, *parts], value


def _terms(node: ast.expr) -> int:
    return 1 + _terms(node.left) if isinstance(node, ast.BinOp) else 1
