"""What a student's code may call: of coursekit.kinematics what is on the notebook's list, and of what others
wrote what is there when it is graded, too."""

from __future__ import annotations

import dis
import sys
from collections.abc import Callable, Iterator
from types import CodeType, FrameType, FunctionType, ModuleType

LIBRARY = "coursekit.kinematics."
PRESENT = ("numpy", "sympy", "mpmath", "matplotlib", "mpl_toolkits", "contourpy", "cycler", "tqdm")
SHOWN = ("coursekit", "IPython", "ipywidgets", "anywidget", "meshcat")  # there as well, in their own way
GENERATED = "<string>"  # where the __init__ of a dataclass says it stands


def library_call(frame: FrameType) -> str:
    """ "lie.exp6" if this frame is coursekit.kinematics called from outside coursekit, else ''."""
    module, code = frame.f_globals.get("__name__", ""), frame.f_code
    if not module.startswith(LIBRARY) or code.co_name.startswith("<") or code.co_filename == GENERATED:
        return ""
    caller = frame.f_back
    while caller is not None and caller.f_code.co_filename == GENERATED:
        caller = caller.f_back
    if caller is None or caller.f_globals.get("__name__", "").startswith("coursekit"):
        return ""
    return f"{module[len(LIBRARY) :]}.{code.co_qualname}"


def permitted(called: str, allowed: tuple[str, ...]) -> bool:
    """Is "robot.Robot.fk" on a list such as ("lie", "robot.Robot.fk")? repr, == and the like always are."""
    owner, _, name = called.rpartition(".")
    if name in ("__init__", "__post_init__"):  # making a Robot is calling `robot.Robot`
        called = owner
    elif name.startswith("__"):
        return True
    return any(called == one or called.startswith(one + ".") for one in allowed)


def not_there(function: Callable) -> str:
    """ "scipy" if a function, or a function of the same notebook that it calls, takes something from an
    installed package that grading does not have; '' else."""
    waiting, seen = [function], set[CodeType]()
    while waiting:
        one = waiting.pop()
        if not isinstance(one, FunctionType) or one.__code__ in seen:
            continue
        seen.add(one.__code__)
        for name in _names(one.__code__):
            value = one.__globals__.get(name, sys.modules.get(name))
            if isinstance(value, FunctionType) and value.__globals__ is one.__globals__:
                waiting.append(value)
            if isinstance(value, ModuleType):
                owner = value.__name__
            else:
                owner = (value if isinstance(value, type | FunctionType) else type(value)).__module__
            package = str(owner).partition(".")[0]
            file = getattr(sys.modules.get(package), "__file__", "") or ""
            if "-packages" in file and package not in (*PRESENT, *SHOWN):
                return package
    return ""


def _names(code: CodeType) -> Iterator[str]:
    """What a function, and those within it, take from outside or import."""
    for step in dis.get_instructions(code):
        if step.opname in ("LOAD_GLOBAL", "LOAD_NAME", "IMPORT_NAME"):
            yield str(step.argval)
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _names(inner)
