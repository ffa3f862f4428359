"""Types: every public signature says what goes in and what comes out, and mypy believes it."""

import importlib
import inspect
import subprocess
import sys
from importlib.util import find_spec

import pytest

from tests.house.test_docs import MODULES, ROOT, methods

# Functions of mistakes are wrong on purpose, and those of exercises are nobody's to call.
FOR_PEOPLE = [name for name in MODULES if not name.startswith("coursekit.classroom.mistakes")]
FOR_PEOPLE = [name for name in FOR_PEOPLE if not name.startswith("coursekit.classroom.exercises")]


def signatures(module):
    """(name, signature) of every public function of a module and method of its classes, constructors too."""
    for name, thing in vars(module).items():
        if name.startswith("_") or getattr(thing, "__module__", None) != module.__name__:
            continue
        if inspect.isclass(thing):
            inner = dict(methods(thing))
            if "__init__" in vars(thing):
                inner["__init__"] = thing.__init__
            for method, code in inner.items():
                yield from ((f"{name}.{method}", inspect.signature(one)) for one in functions(code))
        elif inspect.isroutine(thing):
            yield name, inspect.signature(thing)


def functions(method):
    """The functions behind a method: those of a property, of a cached one, of a class method."""
    if isinstance(method, property):
        return [one for one in (method.fget, method.fset) if one]
    return [getattr(method, "func", None) or getattr(method, "__func__", method)]


def bare(signature):
    """The parameters of a signature that have no type, and "return" if what it returns has none."""
    untyped = [p.name for p in signature.parameters.values() if p.annotation is p.empty]
    if signature.return_annotation is signature.empty:
        untyped.append("return")
    return [name for name in untyped if name not in ("self", "cls")]


@pytest.mark.parametrize("name", ["coursekit", "coursekit.__main__", *FOR_PEOPLE])
def test_public_signatures_are_typed(name):
    module = importlib.import_module(name)
    untyped = {what: bare(signature) for what, signature in signatures(module) if bare(signature)}
    assert not untyped, f"without a type in {name}: " + "; ".join(
        f"{what}: {', '.join(names)}" for what, names in untyped.items()
    )


def test_mypy_finds_nothing():
    if not find_spec("mypy"):
        pytest.skip("mypy is not installed (pip install -r tests/requirements.txt)")
    cache = ROOT / ".pytest_cache" / "mypy"  # 20 s the first time, one second from then on
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", cache], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_finds_a_misprint_in_what_a_robot_is_told(tmp_path):
    if not find_spec("mypy"):
        pytest.skip("mypy is not installed (pip install -r tests/requirements.txt)")
    calls = ["Robot(S, M, {}=[0])", "Robot.from_screws(S, M, {}=[0])", "Robot.from_axes(S, S, M, {}=[0])"]
    right, wrong = ([call.format(keyword) for call in calls] for keyword in ("home", "hone"))
    code = tmp_path / "calls.py"
    code.write_text("\n".join(["from coursekit import Robot", "S = M = [[0.0]]", *right, *wrong, ""]))
    cache = ROOT / ".pytest_cache" / "mypy"
    command = [sys.executable, "-m", "mypy", "--cache-dir", cache, code]
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True).stdout
    lines = [int(line.split(":")[1]) for line in found.splitlines() if "error:" in line]
    assert lines == [6, 7, 8], found
