"""coursekit: the kinematics of real robot arms, to learn, to look at and to grade.

Three rooms, imports only downwards: `kinematics` (mathematics on arrays, numpy alone), `view` (what a person
looks at) and `classroom` (exercises, check, release, grade). This face re-exports their names; each module is
imported when it is first used, so that `import coursekit` costs little more than numpy.

>>> from coursekit import robots
>>> kr6 = robots.kuka_kr6()
>>> kr6.fk([0, 0, 0, 0, 0, 0])[:3, 3].tolist()      # metres
[0.98, 0.0, 0.435]
"""

import importlib
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # for editors and mypy; at run time `__getattr__` imports what is asked for
    from . import classroom as classroom
    from . import view as view
    from .classroom import check as check
    from .kinematics import dh as dh
    from .kinematics import ik as ik
    from .kinematics import jacobians as jacobians
    from .kinematics import lie as lie
    from .kinematics import path as path
    from .kinematics import robots as robots
    from .kinematics import rotations as rotations
    from .kinematics import singularity as singularity
    from .kinematics import subproblems as subproblems
    from .kinematics import symbolic as symbolic
    from .kinematics.robot import Robot as Robot

__version__ = "1.0.0"

_WHERE = {
    **{
        name: f"coursekit.kinematics.{name}"
        for name in (
            "lie",
            "rotations",
            "dh",
            "robots",
            "jacobians",
            "subproblems",
            "ik",
            "singularity",
            "path",
            "symbolic",
        )
    },
    "view": "coursekit.view",
    "classroom": "coursekit.classroom",
}
_NAMES = {"Robot": "coursekit.kinematics.robot", "check": "coursekit.classroom"}

__all__ = sorted([*_WHERE, *_NAMES])


def __getattr__(name: str) -> Any:
    if name in _WHERE:
        return _module(_WHERE[name], extra="classroom")
    if name in _NAMES:
        return getattr(_module(_NAMES[name], extra="classroom"), name)
    raise AttributeError(f"coursekit has no {name!r}; it has: {', '.join(__all__)}")


def _module(name: str, extra: str) -> ModuleType:
    """A module of the package; where a library of others is missing, the error says how it is installed."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        missing = error.name or ""
        if missing.startswith("coursekit"):
            raise
        text = f'{name} needs {missing}, which is not installed: pip install "coursekit[{extra}]"'
        raise ModuleNotFoundError(text, name=missing) from None


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
