"""A copy of coursekit in which the answers are missing: what the grading box has in place of the library.

Of coursekit.kinematics only the functions that the exercises allow are there, and what those need in turn.
Everything else is cut out of the files, not hidden: every other name is an `Absent` that says so. Robots are
tables of numbers. `view` and `check` are stand-ins of the runner.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path

import numpy as np

from coursekit import robots
from coursekit.kinematics import dh

from ..course import PACKAGE
from ..library import permitted

INSIDE = Path(__file__).with_name("inside")
REPLACED = ("robot", "robots", "absent")  # modules of coursekit.kinematics that the box has others for
_IMPORT = "from coursekit.kinematics import absent as _absent"
_Node = tuple[str, str]  # a module and the name of something at its top: ("lie", "hat3")


def locked_files(allowed: tuple[str, ...]) -> dict[str, str]:
    """{path: text} of a package coursekit in which only the allowed names of coursekit.kinematics work."""
    files = {name: (PACKAGE / name).read_text("utf-8") for name in ("__init__.py", "view/text.py")}
    files["kinematics/robots.json"] = json.dumps({name: _sheet(one) for name, one in robots.all().items()})
    for name, source in locked_sources(allowed).items():
        files[f"kinematics/{name}"] = source
    return {
        **{f"coursekit/{name}": text for name, text in files.items()},
        "runner.py": (INSIDE / "runner.py").read_text("utf-8"),
    }


def methods(allowed: tuple[str, ...]) -> tuple[str, list[str]]:
    """(source, names) of what a robot can do when it is handed over, beside its fk."""
    source = (INSIDE / "methods.py").read_text("utf-8")
    known = [node.name for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    return source, [name for name in known if permitted(f"robot.Robot.{name}", allowed)]


def write_files(files: dict[str, str], folder: Path) -> None:
    """Write {path: text} below a folder."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, "utf-8")


def locked_sources(allowed: tuple[str, ...]) -> dict[str, str]:
    """{file name: source} of the locked coursekit.kinematics, folders in it too."""
    room = PACKAGE / "kinematics"
    paths = {path.relative_to(room).as_posix(): path for path in room.rglob("*.py")}
    paths |= {f"{name}.py": INSIDE / f"{name}.py" for name in REPLACED}
    modules = {_module(name): _Module(path, allowed, _module(name)) for name, path in paths.items()}
    reached = _reached(modules, allowed)
    return {
        name: modules[_module(name)].cut(
            {what for module, what in reached if module == _module(name)}, modules
        )
        for name in paths
    }


class _Module:
    """One file of the library: its statements by the names that they define."""

    def __init__(self, path: Path, allowed: tuple[str, ...], name: str) -> None:
        self.name, self.allowed, self.whole = name, allowed, name in REPLACED
        self.folder = name.split(".")[: None if path.name == "__init__.py" else -1]
        self.tree = ast.parse(path.read_text("utf-8"))
        self.imported: dict[str, _Node] = {}
        self.defined: dict[str, ast.stmt] = {}
        for node in self.tree.body:
            if isinstance(node, ast.ImportFrom) and (owner := self._owner(node)):
                for alias in node.names:
                    self.imported[alias.asname or alias.name] = (owner.removeprefix("."), alias.name)
            for what in _defines(node):
                self.defined[what] = node
            if self.whole and isinstance(node, ast.ClassDef):
                node.body = [m for m in node.body if not self._is_cut(node, m)]

    def _owner(self, node: ast.ImportFrom) -> str:
        """ ".lie" if something is imported from the library's lie, "." if lie itself is, "" if neither."""
        if node.level == 0:
            inner = (node.module or "").removeprefix("coursekit.kinematics")
            return "" if inner == node.module else inner or "."
        folder = self.folder[: len(self.folder) - node.level + 1]
        return ".".join(["", *folder, *([node.module] if node.module else [])]) or "."

    def _is_cut(self, owner: ast.ClassDef, node: ast.stmt) -> bool:
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_"):
            return False
        return not permitted(f"{self.name}.{owner.name}.{node.name}", self.allowed)

    def needs(self, what: str, modules: dict[str, _Module]) -> set[_Node]:
        """What of the library a statement names."""
        found: set[_Node] = set()
        for node in ast.walk(self.defined[what]):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                owner, name = self.imported.get(node.value.id, ("", ""))
                module = f"{owner}.{name}".strip(".")
                if module in modules:
                    found.add((module, node.attr))
            if isinstance(node, ast.Name):
                found.add((self.name, node.id))
                found.add(self.imported.get(node.id, ("", "")))
        return {
            (module, name) for module, name in found if name in getattr(modules.get(module), "defined", ())
        }

    def cut(self, kept: set[str], modules: Iterable[str]) -> str:
        """The file with these definitions only; all other names are Absent."""
        if self.name == "absent":
            return ast.unparse(self.tree)
        body = []
        for node in self.tree.body:
            names = _defines(node)
            if self.whole or kept & set(names):
                body.append(self._guarded(node))
            elif isinstance(node, ast.ImportFrom | ast.Import):
                body.append(node)
        tree = ast.Module(body, [])
        used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        for node in [node for node in body if isinstance(node, ast.ImportFrom | ast.Import)]:
            future = isinstance(node, ast.ImportFrom) and node.module == "__future__"
            node.names = [a for a in node.names if future or (a.asname or a.name).split(".")[0] in used]
            if not node.names:
                body.remove(node)
        if "__getattr__" not in self.defined and self.name != "__init__":
            below = [
                name.removeprefix(f"{self.name}.") for name in modules if name.startswith(f"{self.name}.")
            ]
            arguments = ", ".join(map(repr, [self.name, *sorted(below)]))
            tree.body += ast.parse(f"{_IMPORT}\n__getattr__ = _absent.names_of({arguments})").body
        return ast.unparse(tree) + "\n"

    def _guarded(self, node: ast.stmt) -> ast.stmt:
        """A function that others need, but that is not on the list, says so to a student's function."""
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_") or self.whole:
            return node
        name = f"{self.name}.{node.name}"
        if not permitted(name, self.allowed):
            guard = ast.parse(f"{_IMPORT}\n_absent.only_inside({name!r})").body
            node.body = guard + _without_docstring(node.body)
        return node


def _reached(modules: dict[str, _Module], allowed: tuple[str, ...]) -> set[_Node]:
    """What is allowed, and everything that it needs in turn."""
    waiting = [
        (name, what)
        for name, module in modules.items()
        for what, node in module.defined.items()
        if module.whole or (isinstance(node, ast.FunctionDef) and permitted(f"{name}.{what}", allowed))
    ]
    reached: set[_Node] = set()
    while waiting:
        module, what = node = waiting.pop()
        if node not in reached:
            reached.add(node)
            waiting += modules[module].needs(what, modules)
    return reached


def _defines(node: ast.stmt) -> list[str]:
    """The names that a statement at the top of a file defines; none if it only imports."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return [node.name]
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return [one.id for one in targets if isinstance(one, ast.Name)]


def _module(name: str) -> str:
    """ "ik/engine.py" -> "ik.engine", the name that `library_call` gives its functions."""
    return name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _without_docstring(body: list) -> list:
    first = body[0]
    is_text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return body[1:] if is_text and isinstance(first.value.value, str) else body


def _sheet(robot: robots.Robot) -> dict:
    """What a robot was made from, as plain data; what follows from it is not among that."""
    given = {one.name: _plain(getattr(robot, one.name)) for one in fields(robot) if one.init}
    return {**given, "n": robot.n}


def _plain(value):
    if isinstance(value, dh.Table):
        return {one.name: _plain(getattr(value, one.name)) for one in fields(value) if one.init}
    return value.tolist() if isinstance(value, np.ndarray) else value
