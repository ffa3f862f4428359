"""Runs inside the box, and nowhere else: a student's cells, and the questions to their functions.

It is a script of its own that imports nothing of coursekit: `runner.py locked|released [PACKAGES]`, beside
the library of that kind, with the folder of numpy and its like. Requests come as JSON lines on stdin, one
reply goes back for each. Whatever happens in here, the grader believes none of it: replies are read field by
field, and an answer is right only if its numbers are. Students' code runs in names of its own, with small
stand-ins for what only a notebook has; what it prints goes nowhere.
"""

import ast
import builtins
import copy
import importlib
import importlib.machinery
import json
import linecache
import os
import signal
import sys
import traceback
import types
from collections.abc import Callable
from typing import Any

LARGEST = 2000  # numbers in one answer
LIBRARY = os.path.dirname(os.path.abspath(__file__))
IMPORTED: dict[str, types.ModuleType] = {}  # by the cells so far; a last `del np` takes it from no function


class Nothing:
    """Takes every call and every name, and does nothing: what `get_ipython()` gives, or a widget."""

    def __call__(self, *args, **kwargs):
        return Nothing()

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return Nothing()

    def __iter__(self):
        return iter(())

    def __len__(self):
        return 0

    def __str__(self):
        return ""


class StandIns:
    """Finds modules, of which every name is Nothing, for what only a notebook has or a person looks at."""

    views = ("coursekit.view", "IPython", "ipywidgets", "anywidget", "meshcat")
    names: tuple[str, ...] = ("coursekit.classroom", *views)
    real = ("coursekit.view.text",)  # prints numbers: notebooks use it everywhere

    def find_spec(
        self, name: str, path: object = None, target: object = None
    ) -> importlib.machinery.ModuleSpec | None:
        """The import system asks every finder for every module."""
        ours = name.startswith(tuple(f"{one}." for one in self.names)) or name in self.names
        if not ours or name in self.real:
            return None
        return importlib.machinery.ModuleSpec(name, self, is_package=True)  # type: ignore[arg-type]

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> types.ModuleType:
        """The module itself."""
        module = types.ModuleType(spec.name)
        nothing = Nothing()
        answer = lambda key: None if key == "get_ipython" else getattr(nothing, key)  # noqa: E731
        folder = os.path.join(LIBRARY, *spec.name.split("."))
        module.__dict__.update(__path__=[folder], __getattr__=answer)
        if spec.name == "coursekit.classroom":
            module.__dict__.update(drawn())
        return module

    def exec_module(self, module: types.ModuleType) -> None:
        """There is nothing to run."""


def drawn() -> dict[str, Callable]:
    """What a drawing of the student's own arm shows, where an exercise asks for it: lengths and signs."""
    try:
        with open(os.path.join(LIBRARY, "own.json"), encoding="utf-8") as file:
            sheet = json.load(file)
    except OSError:
        return {}
    return {"own_sheet": lambda: types.SimpleNamespace(**sheet), "own_seed": lambda: sheet["seed"]}


def open_the_classroom() -> None:
    """Where the released library is, `diagnose` works, and the notebook's own checks do nothing."""
    StandIns.names = StandIns.views
    os.chdir(os.path.join(LIBRARY, "notebooks"))
    classroom = importlib.import_module("coursekit.classroom")
    classroom.__dict__["check"] = Nothing()


def diagnose(request: dict, space: dict) -> dict:
    """What `check` says of a function, in one sentence; only where the library is the released one."""
    classroom = importlib.import_module("coursekit.classroom")
    name = request["diagnose"]
    return {"said": classroom.diagnose(name, space[name]).say}


class Late(BaseException):
    """The time for this request is over."""


def ring(*_: object) -> None:
    """What the alarm does."""
    raise Late


def run(request: dict, space: dict) -> dict:
    """Execute a cell; its error, and in which line of it, if there is one."""
    name, source = request["name"], request["run"]
    linecache.cache[name] = (len(source), None, source.splitlines(True), name)
    try:
        code = compile(source, name, "exec", flags=ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
        waits = eval(code, space)
        if isinstance(waits, types.CoroutineType):  # the cell itself awaits something
            importlib.import_module("asyncio").run(waits)
    except Late:
        return {"late": True}
    except BaseException as error:
        lines = [
            line for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == name
        ]
        return {"error": type(error).__name__, "line": lines[0] if lines else 0}
    finally:
        IMPORTED.update({name: x for name, x in [*space.items()] if type(x) is types.ModuleType})
    return {}


def replace(request: dict, space: dict) -> dict:
    """Put right functions in the place of a student's, so that what calls them can be judged alone."""
    own: dict = {"__name__": "solved"}
    for number, source in enumerate(request["replace"]):
        exec(compile(source, f"<solution {number}>", "exec"), own)
    space.update({name: own[name] for name in request["names"]})
    return {}


def ask(request: dict, space: dict) -> dict:
    """Call a function of the student's on every input."""
    for module in IMPORTED:
        space.setdefault(module, IMPORTED[module])
    function = space.get(request["ask"])
    if request.get("methods"):
        teach(*request["methods"])
    if not callable(function):
        return {"missing": True}
    return {"answers": [one(function, call, request) for call in request["calls"]]}


def teach(source: str, names: list[str]) -> None:
    """Give robots what the exercise in question may call, now that all others have been asked."""
    from coursekit.kinematics import robot

    space: dict = {"__name__": "coursekit.kinematics.robot"}
    exec(compile(source, "<robot>", "exec"), space)
    for name in names:
        setattr(robot.Robot, name, space[name])


def one(function: Callable, call: list, request: dict) -> dict:
    """What one call gives: numbers, or what it raised."""
    import numpy as np

    try:
        given = [thaw(x) for x in call]
        value = function(*given)
        several = request["several"]
        if several and (not isinstance(value, (tuple, list)) or len(value) != several):
            raise TypeError(f"{several} things are expected")
        parts = [numbers(x) for x in (value if several else [value])]
        changed = (
            name
            for name, x, was in zip(request["arguments"], given, call, strict=False)
            if isinstance(was, list) and (x.tolist() if isinstance(x, np.ndarray) else x) != was
        )
        return {"parts": parts, "changed": next(changed, "")}
    except Late:
        raise
    except BaseException as error:
        return {"error": type(error).__name__, "text": str(error)[:200]}


def thaw(x: Any) -> Any:
    """Plain data as the student's function gets it."""
    import numpy as np

    if isinstance(x, dict):
        from coursekit import robots

        ((what, which),) = x.items()
        robot = getattr(robots, which)()
        return robot if what == "robot" else robot.fk
    if isinstance(x, list):
        array = np.array(x)
        return array if array.dtype.kind in "if" else copy.deepcopy(x)
    return x


def numbers(value: Any) -> dict:
    """An answer as text that JSON can carry, NaN and all."""
    import numpy as np

    if value is None:
        raise TypeError("the function returns None")
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"the answer has dtype {array.dtype}; real numbers are expected")
    if array.size > LARGEST:
        raise TypeError(f"the answer has {array.size} numbers")
    return {"shape": list(array.shape), "values": [repr(float(x)) for x in array.ravel()]}


DOES = {"run": run, "replace": replace, "ask": ask, "diagnose": diagnose}


def main() -> None:
    """Answer requests until there are no more."""
    requests, replies = os.fdopen(os.dup(0), "rb"), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nowhere, descriptor)
    sys.path[:0] = [LIBRARY, *sys.argv[2:]]
    sys.path.append(os.environ["HOME"])  # last: modules that cells write
    released = sys.argv[1] == "released"
    kernel = os.path.join(os.environ["HOME"], "kernel")
    os.makedirs(kernel, exist_ok=True)
    sys.argv = ["ipykernel_launcher.py", "-f", f"{kernel}/kernel.json"]  # as in a notebook
    sys.meta_path.insert(0, StandIns())
    if released:
        open_the_classroom()
    for name in ("get_ipython", "display", "help", "exit", "quit"):
        builtins.__dict__[name] = Nothing()
    main_module = types.ModuleType("__main__")
    sys.modules["__main__"] = main_module
    space = main_module.__dict__
    signal.signal(signal.SIGALRM, ring)
    # taken now: students' code may replace what it likes
    dumps, loads, write, timer, REAL = json.dumps, json.loads, os.write, signal.setitimer, signal.ITIMER_REAL
    for line in requests:
        request = loads(line)
        try:
            timer(REAL, request["seconds"])
            try:
                reply = next(do for word, do in DOES.items() if word in request)(request, space)
            finally:
                timer(REAL, 0)
        except Late:
            reply = {"late": True}
        except BaseException as error:
            reply = {"error": type(error).__name__, "line": 0}
        data = dumps({**reply, "nonce": request["nonce"]}).encode() + b"\n"
        while data:
            data = data[write(replies, data) :]


if __name__ == "__main__":
    main()
