"""A copy of the notebook's names in which a student's function can be tried a thousand times without a trace.

The function and those of the student's that it calls are compiled again, into names of their own, with a
counter in every loop. What could leave a trace (files, plots, random numbers, prints) is not tried at all.
"""

from __future__ import annotations

import ast
import builtins
import copy
from collections.abc import Callable
from functools import partial
from types import CodeType, FunctionType, ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from ..source import CACHED, definition, own
from .finite import in_a_trial

TICK = "__tick"
TICKS = 3_000  # rounds of loops in one trial, at most
MODULES = ("numpy", "math", "cmath", "itertools", "functools", "copy", "scipy.linalg")
# What could leave a trace, or never come back.
REFUSED = (
    *("open", "input", "breakpoint", "exit", "quit"),
    *("exec", "eval", "compile", "globals", "vars", "setattr"),
)
TRACES = (
    *("save", "savez", "savez_compressed", "savetxt", "tofile", "dump", "show", "plot", "figure", "system"),
    *("load", "loadtxt", "genfromtxt", "fromfile", "memmap"),
    *("random", "seterr", "setflags", "set_printoptions"),
)


class Stop(BaseException):
    """More rounds of loops than any right answer needs."""


class Unfit(Exception):
    """This function cannot be tried safely."""


class Sandbox:
    """Names for trials of one function. `tree` may be edited; `compile()` then gives the edited function.

    Unfit if the function has no text, or does what must not be tried.
    """

    def __init__(self, function: Callable) -> None:
        self.ticks, self.most = 0, TICKS
        self.names: dict[str, Any] = {TICK: self._tick, "print": lambda *a, **k: None, "__name__": "trial"}
        self.trees: dict[str, tuple[ast.FunctionDef, Callable]] = {}  # and of those that it calls
        function, before = own(function)
        tree = self._copy(function)
        self.before = tuple(self._given(x) for x in before)
        self.whole = self.name = tree.name
        self.trees[self.whole] = tree, function
        self.names["__builtins__"] = builtins  # numpy imports parts of its own when they are first used
        self.compile()

    def turn_to(self, name: str) -> ast.FunctionDef:
        """The tree of the function, or of one that it calls: that one may be edited from now on."""
        self.compile()  # of the last one, as it was
        self.name = name
        return self.trees[name][0]

    def compile(self) -> Callable:
        """The function as the tree stands now that may be edited."""
        self.names[self.name] = self._made(self.name, *self.trees[self.name])  # it may call itself
        whole = self.names[self.whole]
        return partial(whole, *self.before) if self.before else whole

    def _given(self, value: Any) -> Any:
        """A copy of what comes before the arguments: of an object, of what it holds."""
        if hasattr(value, "__dict__") and not callable(getattr(value, "__array__", None)):
            copy = SimpleNamespace(**{name: self._copied(name, held) for name, held in vars(value).items()})
            for owner in type(value).__mro__[-2::-1]:
                for name, method in vars(owner).items():
                    if isinstance(method, FunctionType) and not name.startswith("__"):
                        self._give_method(copy, name, method)
            return copy
        return self._copied("what it is given", value)

    def _give_method(self, owner: SimpleNamespace, name: str, method: FunctionType) -> None:
        """One of an object's methods, for those that call it by `self`; what cannot be tried is not there."""
        key = f"self.{name}"
        try:
            self.names[key] = self._helper(key, method)
        except Unfit:
            return
        setattr(owner, name, lambda *given, **named: self.names[key](owner, *given, **named))

    def _made(self, name: str, tree: ast.FunctionDef, function: Callable) -> FunctionType:
        """The function of this tree, with the defaults that it was given."""
        code = compile(ast.Module([tree], []), "<trial>", "exec")
        inner = next(c for c in code.co_consts if isinstance(c, CodeType) and c.co_name == tree.name)
        made = FunctionType(inner, self.names, name, getattr(function, "__defaults__", None))
        made.__kwdefaults__ = getattr(function, "__kwdefaults__", None)
        return made

    def _tick(self) -> None:
        self.ticks += 1
        if self.ticks > self.most:
            raise Stop

    def _copy(self, function: Callable) -> ast.FunctionDef:
        """The function's tree, with a counter in its loops; all that it refers to goes into the names."""
        tree = definition(function)
        if tree is None:
            raise Unfit("no text of it")
        tree.lineno = min([tree.lineno, *(node.lineno for node in tree.decorator_list)])  # as Python counts
        tree.decorator_list = []  # what they made of it is another function: this one stands within it
        tree.returns = None
        none = ast.Constant(None)  # in place of what is computed at the `def`: `_made` gives its value
        tree.args.defaults = [none for _ in tree.args.defaults]
        tree.args.kw_defaults = [default and none for default in tree.args.kw_defaults]
        for argument in ast.walk(tree.args):
            if isinstance(argument, ast.arg):
                argument.annotation = None
        ast.fix_missing_locations(tree)
        _refuse_traces(tree)
        for loop in [n for n in ast.walk(tree) if isinstance(n, ast.For | ast.While)]:
            tick = ast.Expr(ast.Call(ast.Name(TICK, ast.Load()), [], []))
            loop.body.insert(0, ast.fix_missing_locations(ast.copy_location(tick, loop)))
        own = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        own |= {a.arg for a in ast.walk(tree) if isinstance(a, ast.arg)} | {tree.name, TICK}
        own |= {(a.asname or a.name).split(".")[0] for n in _imports(tree) for a in n.names}
        cells = dict(zip(function.__code__.co_freevars, function.__closure__ or (), strict=True))
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id not in own and node.id not in self.names:
                self._bring(node.id, function, cells)
        return tree

    def _bring(self, name: str, function: Callable, cells: dict) -> None:
        if name in cells:
            try:
                value = cells[name].cell_contents
            except ValueError:
                return  # nothing was put into it yet
        elif name in function.__globals__:
            value = function.__globals__[name]
        elif name in REFUSED:
            raise Unfit(f"it uses {name}")
        else:
            return  # a builtin, or a NameError as in the notebook
        self.names[name] = self._copied(name, value)

    def _copied(self, name: str, value: Any) -> Any:
        if isinstance(value, CACHED):
            value = value.__wrapped__
        if isinstance(value, ModuleType):
            if value.__name__.split(".")[0] == "coursekit" and "view" not in value.__name__:
                return value
            if value.__name__ in MODULES or value.__name__.startswith("numpy"):
                return in_a_trial(value)
            raise Unfit(f"it uses {value.__name__}")
        if isinstance(value, np.ndarray | list | dict | set):
            try:
                return copy.deepcopy(value)
            except Exception:
                raise Unfit(f"{name} cannot be copied") from None
        module = str(getattr(value, "__module__", ""))
        if isinstance(value, FunctionType) and not module.startswith(("numpy", "coursekit.kinematics")):
            return self._helper(name, value)
        if callable(value) and not module.startswith(
            ("numpy", "math", "coursekit.kinematics", "builtins", "scipy.linalg")
        ):
            raise Unfit(f"it calls {name}")
        return in_a_trial(value)

    def _helper(self, name: str, function: FunctionType) -> FunctionType:
        """One of the student's own functions, with counted loops and without a way into the notebook."""
        self.names[name] = None  # so that functions that call each other come to an end
        tree = self._copy(function)
        self.trees[name] = tree, function
        return self._made(name, tree, function)


def _is_errstate(item: ast.withitem) -> bool:
    """`with np.errstate(...)`, which only keeps numpy quiet, and ends with the line below it."""
    match item.context_expr:
        case ast.Call(func=ast.Attribute(attr="errstate")):
            return True
    return False


def _imports(tree: ast.AST):
    return [n for n in ast.walk(tree) if isinstance(n, ast.Import | ast.ImportFrom)]


def _refuse_traces(tree: ast.FunctionDef) -> None:
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in TRACES:
            raise Unfit(f"it uses {node.attr}")
        if isinstance(node, ast.Global | ast.Nonlocal | ast.Yield | ast.YieldFrom | ast.Await):
            raise Unfit("it reaches outside of itself")
        if isinstance(node, ast.With) and not all(map(_is_errstate, node.items)):
            raise Unfit("it reaches outside of itself")
    for node in _imports(tree):
        names = [node.module or ""] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
        if not all(n.startswith(("numpy", "coursekit", *MODULES)) for n in names):
            raise Unfit(f"it imports {', '.join(names)}")
