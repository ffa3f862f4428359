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


def __getattr__(name):
    if name in _WHERE:
        return importlib.import_module(_WHERE[name])
    if name in _NAMES:
        return getattr(importlib.import_module(_NAMES[name]), name)
    raise AttributeError(f"coursekit has no {name!r}; it has: {', '.join(__all__)}")


def __dir__():
    return [*__all__, "__version__"]
