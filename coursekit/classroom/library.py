"""Which functions of coursekit.kinematics a student's code may call: those on the notebook's list."""

from __future__ import annotations

from types import FrameType

LIBRARY = "coursekit.kinematics."
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
