"""A copy of coursekit in which the answers are missing: what the grading box has in place of the library.

Functions of coursekit.kinematics that the exercises do not allow lose their bodies. What allowed functions
need in turn stays, but answers to callers inside the library only. `view` and `check` do nothing.
"""

from __future__ import annotations

import ast
from pathlib import Path

from ..course import PACKAGE
from ..library import permitted

# Added to every module of the copy. A frame of "<string>" is the __init__ that a dataclass generates.
GUARD = """
class LibraryLocked(Exception):
    pass


def _locked(name):
    raise LibraryLocked("your function calls coursekit's own " + name + "; write it yourself")


def _inside(name):
    import sys

    frame = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename == "<string>":
        frame = frame.f_back
    if frame is None or not frame.f_globals.get("__name__", "").startswith("coursekit.kinematics"):
        _locked(name)
"""

NOTHING = '''
class Nothing:
    """Takes every call and every name, and does nothing."""

    def __call__(self, *args, **kwargs):
        return Nothing()

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return Nothing()

    def __iter__(self):
        return iter(())

    def __str__(self):
        return ""

    __repr__ = __str__


def __getattr__(name):
    if name.startswith("__"):
        raise AttributeError(name)
    return Nothing()
'''


def locked_files(allowed: tuple[str, ...]) -> dict[str, str]:
    """{path: text} of a package coursekit in which only the allowed names of coursekit.kinematics work."""
    files = {
        "coursekit/__init__.py": (PACKAGE / "__init__.py").read_text("utf-8"),
        "coursekit/classroom/__init__.py": "def check(*args, **kwargs):\n    pass\n",
        "coursekit/view/__init__.py": NOTHING,
    }
    text = PACKAGE / "view" / "text.py"  # prints numbers: notebooks use it everywhere, and it knows nothing
    files["coursekit/view/text.py"] = text.read_text("utf-8")
    sources = locked_sources(allowed)
    return files | {f"coursekit/kinematics/{name}": source for name, source in sources.items()}


def write_files(files: dict[str, str], folder: Path) -> None:
    """Write {path: text} below a folder."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, "utf-8")


def locked_sources(allowed: tuple[str, ...]) -> dict[str, str]:
    """{file name: source} of the locked coursekit.kinematics, folders in it too."""
    room = PACKAGE / "kinematics"
    paths = {path.relative_to(room).as_posix(): path for path in room.rglob("*.py")}
    trees = {name: ast.parse(path.read_text("utf-8")) for name, path in paths.items()}
    functions = [f for name, tree in trees.items() for f in _functions(_module(name), tree)]
    needed = _needed(trees, functions, allowed)
    for name, function in functions:
        if permitted(name, allowed):
            continue
        kept = function.name in needed
        call = f"_inside({name!r})" if kept else f"_locked({name!r})"
        body = _without_docstring(function.body) if kept else []
        function.body = ast.parse(call).body + body
    for tree in trees.values():
        first = 1 if ast.get_docstring(tree) is not None else 0
        while first < len(tree.body) and _is_future(tree.body[first]):
            first += 1
        tree.body[first:first] = ast.parse(GUARD).body
    return {name: ast.unparse(tree) for name, tree in trees.items()}


def _module(name: str) -> str:
    """ "ik/engine.py" -> "ik.engine", the name that `library_call` gives its functions."""
    return name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _functions(module: str, tree: ast.Module) -> list[tuple[str, ast.FunctionDef]]:
    """("robot.Robot.fk", its definition) for all functions of a module and methods of its classes."""
    found = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found.append((f"{module}.{node.name}", node))
        if isinstance(node, ast.ClassDef):
            methods = [m for m in node.body if isinstance(m, ast.FunctionDef)]
            found += [(f"{module}.{node.name}.{m.name}", m) for m in methods]
    return found


def _needed(trees: dict, functions: list, allowed: tuple[str, ...]) -> set[str]:
    """Names of functions that allowed ones, or an import, may reach: found by name, so rather too many."""
    bodies = {id(function) for _, function in functions}
    names = set().union(*(_names(tree, bodies) for tree in trees.values()))  # what importing runs
    waiting = [f for name, f in functions if permitted(name, allowed)]
    waiting += [f for _, f in functions if f.name in ("__init__", "__post_init__")]
    reached = set()
    while waiting:
        function = waiting.pop()
        if id(function) not in reached:
            reached.add(id(function))
            names |= _names(function, set())
            waiting += [f for _, f in functions if f.name in names and id(f) not in reached]
    return names | {"__init__", "__post_init__"}


def _names(node: ast.AST, skip: set[int]) -> set[str]:
    """All identifiers below a node, leaving out the bodies of the functions in `skip`."""
    found = set()
    waiting = [node]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.Attribute):
            found.add(node.attr)
        if isinstance(node, ast.FunctionDef) and id(node) in skip:
            waiting += [*node.decorator_list, node.args]
        else:
            waiting += ast.iter_child_nodes(node)
    return found


def _without_docstring(body: list) -> list:
    first = body[0]
    is_text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return body[1:] if is_text and isinstance(first.value.value, str) else body


def _is_future(node: ast.AST) -> bool:
    return isinstance(node, ast.ImportFrom) and node.module == "__future__"
