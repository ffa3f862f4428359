"""Where a course keeps its parts: solved notebooks, exercises, mistakes, sample tables.

A unit is "nb01", "nb02", ...: `exercises/nb01.py` belongs to `notebooks/01_*.ipynb`, `mistakes/nb01.py` and
`samples/nb01.json`.
"""

from __future__ import annotations

import importlib.util
import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType

from .exercise import Exercise, nearest

# The folders, for everybody: this room, the package, and the course that it stands in.
CLASSROOM = Path(__file__).resolve().parent
PACKAGE = CLASSROOM.parent
ROOT = PACKAGE.parent


@dataclass(frozen=True)
class Course:
    notebooks: Path
    classroom: Path  # the folder of exercises/, mistakes/ and samples/

    @property
    def units(self) -> list[str]:
        return sorted(path.stem for path in (self.classroom / "exercises").glob("nb*.py"))

    def notebook(self, unit: str) -> Path:
        """The unit's solved notebook; ValueError if there is none, or a second one (somebody's copy)."""
        found = sorted(self.notebooks.glob(f"{unit[2:]}_*.ipynb"))
        if len(found) != 1:
            names = " and ".join(path.name for path in found) or "none"
            raise ValueError(
                f"{unit} needs one notebook {unit[2:]}_*.ipynb in {self.notebooks}; found: {names}"
            )
        return found[0]

    def exercises(self, unit: str) -> list[Exercise]:
        return list(getattr(_module(self.classroom / "exercises" / f"{unit}.py"), "EXERCISES", ()))

    def allowed(self, unit: str) -> tuple[str, ...]:
        """Names in coursekit.kinematics the student may call: "lie.hat3", "rotations", "robot.Robot.fk"."""
        return tuple(getattr(_module(self.classroom / "exercises" / f"{unit}.py"), "ALLOW", ()))

    def wrong(self, unit: str) -> dict[str, dict]:
        """{exercise: {hint key: function}}; instructors only."""
        path = self.classroom / "mistakes" / f"{unit}.py"
        return getattr(_module(path), "WRONG", {}) if path.exists() else {}

    def samples(self, unit: str) -> dict:
        path = self.samples_path(unit)
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    def samples_path(self, unit: str) -> Path:
        return self.classroom / "samples" / f"{unit}.json"

    def has(self, name: str) -> bool:
        """Is there an exercise of this name?"""
        return any(name == e.name for unit in self.units for e in self.exercises(unit))

    def find(self, name: str) -> tuple[str, Exercise]:
        """(unit, exercise) of a name; ValueError if there is none."""
        known = {e.name: (unit, e) for unit in self.units for e in self.exercises(unit)}
        if name not in known:
            raise ValueError(f"there is no exercise {name!r}.{nearest(name, known)}")
        return known[name]


def solved(folder: Path) -> bool:
    """Is this the folder of the course's own notebooks, with their solutions, and not a student's?"""
    return (CLASSROOM / "mistakes").exists() and folder.absolute() == ROOT / "notebooks"


def the_course() -> Course:
    """The course this package belongs to."""
    return Course(ROOT / "notebooks", CLASSROOM)


@cache
def _module(path: Path) -> ModuleType:
    """A module by its path: courses other than ours (in tests, say) need not be importable packages."""
    spec = importlib.util.spec_from_file_location(f"coursekit.classroom.{path.parent.name}.{path.stem}", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no Python module")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
