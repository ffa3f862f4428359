"""Where a course keeps its parts: solved notebooks, exercises, mistakes, sample tables.

A unit is "nb01", "nb02", ...: `exercises/nb01.py` belongs to `notebooks/01_*.ipynb`, `mistakes/nb01.py` and
`samples/nb01.json`. A course of one's own is a folder with a `course.toml`: `your_course`.
"""

from __future__ import annotations

import importlib.util
import json
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from pathlib import Path
from types import ModuleType

from .exercise import Exercise, nearest

# The folders, for everybody: this room, the package, and the course that it stands in.
CLASSROOM = Path(__file__).resolve().parent
PACKAGE = CLASSROOM.parent
ROOT = PACKAGE.parent
TOML = "course.toml"


@dataclass(frozen=True)
class Course:
    """The course of this package, or one that keeps its parts in the same rooms."""

    notebooks: Path
    classroom: Path  # the folder of exercises/, mistakes/ and samples/

    @property
    def units(self) -> list[str]:
        """The units, in their order."""
        return sorted(path.stem for path in (self.classroom / "exercises").glob("nb*.py"))

    @property
    def title(self) -> str:
        """What people call it."""
        return "Robot kinematics in six notebooks"

    @property
    def version(self) -> str:
        """Numbers with dots between them: a corrected course has a higher one."""
        from .. import __version__

        return __version__

    @property
    def weights(self) -> dict[str, float]:
        """{exercise: what it counts}, of those that do not count their points."""
        return {}

    @property
    def deadlines(self) -> dict[str, datetime]:
        """{stem of a notebook's name: when it is to be handed in}, of those that have a deadline."""
        return {}

    @property
    def place(self) -> list[str]:
        """The course as plain data, for another process: `course_at` makes it one again."""
        return [str(self.notebooks), str(self.classroom)]

    def notebook(self, unit: str) -> Path:
        """The unit's solved notebook; ValueError if there is none, or a second one (somebody's copy)."""
        found = sorted(self.notebooks.glob(f"{unit[2:]}_*.ipynb"))
        if len(found) != 1:
            names = " and ".join(path.name for path in found) or "none"
            raise ValueError(
                f"{unit} needs one notebook {unit[2:]}_*.ipynb in {self.notebooks}; found: {names}"
            )
        return found[0]

    def is_at_home(self, unit: str) -> bool:
        """Do the unit's exercises and tables belong to this course? Else they ship with the package."""
        return True

    def exercises_path(self, unit: str) -> Path:
        """The module that holds the unit's exercises."""
        return self.classroom / "exercises" / f"{unit}.py"

    def mistakes_path(self, unit: str) -> Path:
        """The module of functions that commit the typical mistakes; instructors only."""
        return self.classroom / "mistakes" / f"{unit}.py"

    def samples_path(self, unit: str) -> Path:
        """The table of public examples."""
        return self.classroom / "samples" / f"{unit}.json"

    def questions_path(self, unit: str) -> Path:
        """The module of the unit's questions and goals, if it has some."""
        return self.classroom / "questions" / f"{unit}.py"

    def exercises(self, unit: str) -> list[Exercise]:
        """The unit's exercises, in their order."""
        return list(getattr(module_at(self.exercises_path(unit)), "EXERCISES", ()))

    def allowed(self, unit: str) -> tuple[str, ...]:
        """Names in coursekit.kinematics the student may call: "lie.hat3", "rotations", "robot.Robot.fk"."""
        return tuple(getattr(module_at(self.exercises_path(unit)), "ALLOW", ()))

    def wrong(self, unit: str) -> dict[str, dict]:
        """{exercise: {hint key: function}}; instructors only."""
        path = self.mistakes_path(unit)
        return getattr(module_at(path), "WRONG", {}) if path.exists() else {}

    def samples(self, unit: str) -> dict:
        """{exercise: {place, examples}}."""
        path = self.samples_path(unit)
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    def sources(self, unit: str) -> list[Path]:
        """The files that say what is asked and which mistakes are known: with the solutions, all that decides
        a grade."""
        found = [self.exercises_path(unit), self.mistakes_path(unit)]
        found += [path for folder in {p.parent for p in found} for path in folder.glob("_*.py")]
        return sorted(path for path in found if path.exists())

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


def course_here(folder: Path | None = None) -> Course:
    """The course of a notebook that runs in this folder: that of the `course.toml` there or above it, else
    the one this package belongs to. ValueError if that file is damaged."""
    folder = Path(folder or Path.cwd())
    found = next((up for up in (folder, *folder.parents) if (up / TOML).is_file()), None)
    return the_course() if found is None else course_at([str(found)])


def course_at(place: list[str]) -> Course:
    """The course at a place: [its folder], or [notebooks, classroom] of one that is kept in rooms."""
    if len(place) == 2:
        return Course(*map(Path, place))
    from .your_course import read

    return read(Path(place[0]))


def module_at(path: Path) -> ModuleType:
    """A module by its path: courses other than ours (in tests, say) need not be importable packages."""
    return _loaded(path, path.stat().st_mtime_ns)


@cache
def _loaded(path: Path, changed: int) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"coursekit.classroom.{path.parent.name}.{path.stem}", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no Python module")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(f"{path}: {type(error).__name__}: {error}") from error
    return module
