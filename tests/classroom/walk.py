"""A cell for the box: goes through all that can be reached there, and asks it the exercises' questions.

It does what a student could at most do: imports every module, follows every reference, takes nested code out
of functions, and calls what it finds as if the library itself were calling.
"""

import gc
import importlib
import json
import os
import pkgutil
import sys
import types

import numpy as np

# [[exercise, [[arguments, parts of the right answer], ...]], ...]; a test puts them here
QUESTIONS = json.loads("[]")


def walk():
    """Letters (as numbers) of the exercises' names that something in the box answers, and of what answers."""
    import coursekit

    for found in pkgutil.walk_packages(coursekit.__path__, "coursekit."):
        importlib.import_module(found.name)
    solved = set()
    for function in functions(objects([sys.modules, sys._getframe(), *gc.get_objects()])):
        for name, calls in QUESTIONS:
            if calls and all(answers(function, *call) for call in calls):
                solved.add(f"{name} by {function.__module__}.{function.__qualname__}")
    return np.array([ord(letter) for letter in "; ".join(sorted(solved))[:1900]], dtype=float)


def files():
    """How many files of a course lie about that do not belong to the box."""
    here = os.path.dirname(os.path.abspath(sys.modules["coursekit"].__file__))
    strange = 0
    for folder, _, names in os.walk("/"):
        if not folder.startswith(("/proc", "/sys", here)):
            strange += any(name.endswith(".ipynb") for name in names)
            strange += os.path.basename(folder) in ("coursekit", "meshcat", "scipy")
    return strange


def objects(waiting):
    """Everything that is referred to from here, code in constants included."""
    seen = {}
    while waiting:
        one = waiting.pop()
        if id(one) in seen:
            continue
        seen[id(one)] = one
        waiting += one.co_consts if isinstance(one, types.CodeType) else gc.get_referents(one)
        if isinstance(one, types.FunctionType):
            waiting.append(one.__code__)
    return list(seen.values())


def functions(found):
    """Functions that are nobody else's: not Python's, not numpy's, not those of this cell."""
    foreign = (os.path.dirname(os.__file__), "/packages/")
    made = {one.__code__: one for one in found if isinstance(one, types.FunctionType)}
    everything = vars(sys.modules["coursekit"]) | {"np": np}
    for one in found:
        if isinstance(one, types.CodeType) and one not in made and not one.co_freevars:
            made[one] = types.FunctionType(one, dict(everything))
    return [made[code] for code in made if _can_be_called(code) and not code.co_filename.startswith(foreign)]


def _can_be_called(code):
    """Neither what only looks like code (Cython's) nor the inside of a comprehension: they end Python."""
    return code.co_filename.startswith("/") and code.co_varnames[:1] != (".0",)


def answers(function, arguments, right):
    given = [np.array(x) if isinstance(x, list) else x for x in arguments]
    space = {"__name__": "coursekit.kinematics.lie", "f": function, "given": given}
    try:
        exec("value = f(*given)", space)
        value = space["value"]
        parts = value if isinstance(value, tuple) else (value,)
        return all(alike(np.array(a), np.array(b)) for a, b in zip(parts, right, strict=True))
    except BaseException:
        return False


def alike(a, b):
    return a.shape == b.shape and np.allclose(np.abs(a), np.abs(b), atol=1e-6)
