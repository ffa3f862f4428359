"""The text of a student's function: its syntax tree, wherever the function was written."""

from __future__ import annotations

import ast
import itertools
import linecache
import re
import sys
from collections.abc import Callable
from functools import lru_cache, partial
from types import CodeType, FrameType, FunctionType, MethodType
from typing import Any

CACHED = type(lru_cache(lambda: None))


def own(function: Callable) -> tuple[Callable, tuple]:
    """The function whose text is the answer, and what it is given before the arguments.

    `functools.partial` of a function gives it what it holds; a method gives its object, and so does an object
    that is called, of a class written in the notebook.
    """
    if isinstance(function, partial):
        inner, before = own(function.func)
        return _with_defaults(inner, function.keywords), (*before, *function.args)
    if isinstance(function, CACHED):
        return own(function.__wrapped__)
    if isinstance(function, MethodType):
        return function.__func__, (function.__self__,)
    called = type(function).__call__ if callable(function) else None
    return (called, (function,)) if isinstance(called, FunctionType) else (function, ())


def _with_defaults(function: Callable, given: dict[str, Any]) -> Callable:
    """The function where what it is given by name is what it takes if nothing comes."""
    if not given or not isinstance(function, FunctionType):
        return function
    names = function.__code__.co_varnames[: function.__code__.co_argcount]
    defaults = function.__defaults__ or ()
    known = dict(zip(names[len(names) - len(defaults) :], defaults, strict=True)) | given
    last = itertools.takewhile(known.__contains__, reversed(names))
    values = tuple(known[name] for name in last)[::-1]
    return FunctionType(
        function.__code__, function.__globals__, function.__name__, values, function.__closure__
    )


def definition(function: Callable) -> ast.FunctionDef | None:
    """A fresh syntax tree of the function, with the lines of its file or cell; None where there is no text.

    A lambda that has a name, `f = lambda x: 2 * x`, is given as the `def` that it could have been.
    Jupyter keeps the text of every cell that was run; functions made by `exec` of a string have none.
    """
    code = getattr(function, "__code__", None)
    if not isinstance(code, CodeType) or code.co_name == "_lambdifygenerated":  # sympy's: nobody sees it
        return None
    text = "".join(linecache.getlines(code.co_filename))
    if code.co_name == "<lambda>":
        return _named_lambda(text, code.co_firstlineno)
    for node in ast.walk(_parsed(text) or ast.Module([], [])):
        if isinstance(node, ast.FunctionDef) and node.name == code.co_name:
            first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            if first == code.co_firstlineno:
                fresh = ast.parse(text)  # the caller may change it
                same = [
                    n for n in ast.walk(fresh) if isinstance(n, ast.FunctionDef) and n.lineno == node.lineno
                ]
                return same[0]
    return None


def _named_lambda(text: str, line: int) -> ast.FunctionDef | None:
    found = []
    for node in ast.walk(ast.parse(text) if _parsed(text) else ast.Module([], [])):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Lambda() as made) if made.lineno == line:
                made_anew: Any = ast.parse(f"def {name}(): pass").body[0]
                ast.increment_lineno(made_anew, line - 1)
                made_anew.args = made.args
                made_anew.body = [ast.copy_location(ast.Return(made.body), made.body)]
                found.append(made_anew)
    return found[0] if len(found) == 1 else None  # of two in a line nobody knows which is meant


def cells() -> list[str]:
    """The text of every cell that Jupyter was given, the newest last, also of those that are no Python."""
    shell = "IPython" in sys.modules and sys.modules["IPython"].get_ipython()
    return list(shell.user_ns.get("In", ())) if shell else []


def not_run(name: str) -> str:
    """Why the newest cell that writes this function did not run, so that an older one is there; or ''."""
    wrote = re.compile(rf"^def {re.escape(name)}\b", re.MULTILINE)
    newest = next((text for text in reversed(cells()) if wrote.search(text)), "")
    if not _unread(newest):
        return ""
    from IPython.core.inputtransformer2 import TransformerManager

    return _unread(TransformerManager().transform_cell(newest))  # %time and !ls are no errors


def _unread(text: str) -> str:
    """Why this is no Python, or ''."""
    try:
        ast.parse(text)
    except SyntaxError as error:
        return f"line {error.lineno}: {error.msg}"
    except (ValueError, RecursionError):
        pass
    return ""


@lru_cache(16)
def _parsed(text: str) -> ast.Module | None:
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return None


def catches_everything(frame: FrameType) -> bool:
    """Does this line stand where a bare `except` would swallow whatever is raised in it?"""
    return frame.f_lineno in _swallowed("".join(linecache.getlines(frame.f_code.co_filename)))


@lru_cache(16)
def _swallowed(text: str) -> frozenset[int]:
    tree = _parsed(text)
    lines: set[int] = set()
    for node in ast.walk(tree or ast.Module([], [])):
        if isinstance(node, ast.Try) and any(_is_bare(handler) for handler in node.handlers):
            for statement in node.body:
                lines.update(range(statement.lineno, (statement.end_lineno or statement.lineno) + 1))
    return frozenset(lines)


def _is_bare(handler: ast.ExceptHandler) -> bool:
    caught = ast.walk(handler.type) if handler.type else [ast.Name("BaseException")]
    return any(isinstance(node, ast.Name) and node.id == "BaseException" for node in caught)
