"""A course of one's own: a folder with a `course.toml`, notebooks, and beside each its exercises.

    mine/
      course.toml                 title, version, which notebooks in which order, weights, deadlines
      01_gripper.ipynb            solved, unless `solutions` names another folder that holds the solved one
      01_gripper_exercises.py     EXERCISES: Exercise(...) of one's own, or the name of one that ships
      01_gripper_mistakes.py      WRONG: the typical mistakes; lies beside the solved notebook
      01_gripper_questions.py     QUESTIONS and GOALS, if it has some
      01_gripper_samples.json     written by `coursekit samples`

A notebook that ships is used by its name, with its exercises; a file of the same name here replaces it.
Where the solutions live in a folder of their own, its `course.toml` says where the course is: `public`.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from datetime import date, datetime, time
from functools import cache
from pathlib import Path
from typing import Any

from .course import TOML, Course
from .course import the_course as _shipped
from .exercise import Exercise, nearest

KEYS = ("title", "version", "notebooks", "solutions", "files", "weights", "deadlines")
PUBLIC = "public"  # the one key of the course.toml that stands beside solutions kept elsewhere


@dataclass(frozen=True)
class YourCourse(Course):
    """What a `course.toml` says. `notebooks` is its folder, `solved` the one that holds the solutions."""

    solved: Path
    stems: tuple[str, ...]
    told: dict[str, Any] = field(compare=False, hash=False)

    @property
    def toml(self) -> Path:
        """The file that describes the course."""
        return self.notebooks / TOML

    @property
    def units(self) -> list[str]:
        return [self.unit_of(stem) for stem in self.stems]

    @property
    def title(self) -> str:
        return self.told["title"]

    @property
    def version(self) -> str:
        return self.told["version"]

    @property
    def weights(self) -> dict[str, float]:
        return self.told["weights"]

    @property
    def deadlines(self) -> dict[str, datetime]:
        return self.told["deadlines"]

    @property
    def files(self) -> tuple[str, ...]:
        """What notebooks read beside: files and folders of the course that go to students as they are."""
        return self.told["files"]

    @property
    def place(self) -> list[str]:
        return [str(self.notebooks)]

    @property
    def is_split(self) -> bool:
        """Do the solutions live in a folder of their own?"""
        return self.solved != self.notebooks

    def is_at_home(self, unit: str) -> bool:
        return unit in self.stems

    def unit_of(self, stem: str) -> str:
        """ "01_gripper" is its own unit; "04_singularities" is "nb04", unless its exercises stand here."""
        if (self.notebooks / f"{stem}_exercises.py").exists():
            return stem
        return shipped_unit(stem) or stem

    def stem_of(self, unit: str) -> str:
        """The name of the unit's notebook, without its ending."""
        return next(stem for stem in self.stems if self.unit_of(stem) == unit)

    def notebook(self, unit: str) -> Path:
        name = f"{self.stem_of(unit)}.ipynb"
        mine = self.solved / name
        if not self.solved.is_dir():
            raise ValueError(f"{self.toml}, solutions: there is no folder {self.solved}")
        if mine.exists() or self.is_at_home(unit):
            return mine
        return _shipped().notebook(unit)

    def exercises_path(self, unit: str) -> Path:
        mine = self.notebooks / f"{unit}_exercises.py"
        return mine if self.is_at_home(unit) else _shipped().exercises_path(unit)

    def mistakes_path(self, unit: str) -> Path:
        mine = self.solved / f"{unit}_mistakes.py"
        return mine if self.is_at_home(unit) else _shipped().mistakes_path(unit)

    def samples_path(self, unit: str) -> Path:
        mine = self.notebooks / f"{unit}_samples.json"
        return mine if self.is_at_home(unit) else _shipped().samples_path(unit)

    def questions_path(self, unit: str) -> Path:
        mine = self.notebooks / f"{unit}_questions.py"
        return mine if self.is_at_home(unit) else _shipped().questions_path(unit)

    def exercises(self, unit: str) -> list[Exercise]:
        path = self.exercises_path(unit)
        return [self._one(path, exercise) for exercise in super().exercises(unit)] if path.exists() else []

    def allowed(self, unit: str) -> tuple[str, ...]:
        return super().allowed(unit) if self.exercises_path(unit).exists() else ()

    def wrong(self, unit: str) -> dict[str, dict]:
        theirs = {e: _shipped().wrong(_shipped().find(e)[0]).get(e, {}) for e in self.by_name(unit)}
        return {**theirs, **super().wrong(unit)}

    def by_name(self, unit: str) -> list[str]:
        """Exercises of the unit that ship with the package, and stand in its list by their names."""
        path = self.exercises_path(unit)
        return [e for e in super().exercises(unit) if isinstance(e, str)] if path.exists() else []

    def sources(self, unit: str) -> list[Path]:
        if not self.is_at_home(unit):
            return _shipped().sources(unit)
        theirs = {_shipped().find(name)[0] for name in self.by_name(unit)}
        found = [self.exercises_path(unit), self.mistakes_path(unit)]
        found += [path for one in theirs for path in _shipped().sources(one)]
        return sorted({path for path in found if path.exists()})

    def _one(self, path: Path, exercise: Exercise | str) -> Exercise:
        if isinstance(exercise, Exercise):
            return exercise
        if not isinstance(exercise, str):
            raise ValueError(
                f"{path}, EXERCISES: an Exercise or the name of one that ships, not {exercise!r}"
            )
        try:
            return _shipped().find(exercise)[1]
        except ValueError as error:
            raise ValueError(f"{path}, EXERCISES: {error}") from None


def read(folder: Path) -> YourCourse:
    """The course of a folder; ValueError that names file and field where `course.toml` does not fit."""
    path = Path(folder).absolute() / TOML
    if not path.is_file():
        raise ValueError(f"{path} does not exist: `coursekit new {folder}` writes a course to begin with")
    return _read(path, path.stat().st_mtime_ns)


@cache
def _read(path: Path, changed: int) -> YourCourse:
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: {error}") from None
    folder = path.parent.resolve()
    if PUBLIC in told:
        return _of_solutions(path, told)
    for key in told:
        if key not in KEYS:
            raise ValueError(f"{path}: {key!r} is no key.{nearest(key, KEYS)} There are: {', '.join(KEYS)}")
    solved = (folder / _text(path, told, "solutions", ".")).resolve()
    stems = _stems(path, told, solved)
    version = _text(path, told, "version", "1")
    if not all(part.isdigit() for part in version.split(".")):
        raise ValueError(f"{path}, version: numbers with dots between them are expected, not {version!r}")
    told = {
        "title": _text(path, told, "title", folder.name),
        "version": version,
        "files": _files(path, told),
        "weights": _weights(path, told),
        "deadlines": _deadlines(path, told, stems),
    }
    return YourCourse(folder, folder, solved, stems, told)


def _of_solutions(path: Path, told: dict) -> YourCourse:
    """The course that a folder of solutions belongs to; each names the other."""
    course = read(path.parent / _text(path, told, PUBLIC, ""))
    if list(told) != [PUBLIC] or course.solved != path.parent.resolve():
        raise ValueError(
            f"{path}, {PUBLIC}: it stands alone, and {course.toml} names this folder as its solutions"
        )
    return course


def shipped_unit(stem: str) -> str:
    """ "nb04" for "04_singularities" of the course that ships, '' for any other notebook."""
    unit = f"nb{stem.split('_')[0]}"
    try:
        return unit if unit in _shipped().units and _shipped().notebook(unit).stem == stem else ""
    except ValueError:
        return ""


def _text(path: Path, told: dict, key: str, default: str) -> str:
    value = told.get(key, default)
    if not isinstance(value, str) or not value:
        raise ValueError(f"{path}, {key}: a text in quotes is expected, not {value!r}")
    return value


def _files(path: Path, told: dict) -> tuple[str, ...]:
    names = told.get("files", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"{path}, files: a list of names in quotes is expected, not {names!r}")
    for name in names:
        one = path.parent / name
        if not one.exists() or not one.resolve().is_relative_to(path.parent.resolve()) or one == path.parent:
            raise ValueError(f"{path}, files: there is no {name!r} in this folder")
    return tuple(names)


def _stems(path: Path, told: dict, solved: Path) -> tuple[str, ...]:
    """The notebooks in their order; without a list, all that lie in the folder."""
    here = {p.stem for folder in (path.parent, solved) if folder.is_dir() for p in folder.glob("*.ipynb")}
    listed = told.get("notebooks", sorted(here))
    if not isinstance(listed, list) or not listed or not all(isinstance(name, str) for name in listed):
        raise ValueError(f"{path}, notebooks: a list of names in quotes is expected, not {listed!r}")
    stems = tuple(name.removesuffix(".ipynb") for name in listed)
    for stem in stems:
        if stems.count(stem) > 1:
            raise ValueError(f"{path}, notebooks: {stem!r} is there twice")
        if stem not in here and not shipped_unit(stem):
            known = sorted({*here, *(_shipped().notebook(unit).stem for unit in _shipped().units)})
            raise ValueError(
                f"{path}, notebooks: there is no {stem}.ipynb here, and none of that name ships."
                f"{nearest(stem, known)}"
            )
    return stems


def _weights(path: Path, told: dict) -> dict[str, float]:
    table = _table(path, told, "weights")
    for name, weight in table.items():
        if isinstance(weight, bool) or not isinstance(weight, int | float) or not 0 <= weight < float("inf"):
            raise ValueError(
                f"{path}, weights, {name}: a number that is not negative is expected, not {weight!r}"
            )
    return {name: float(weight) for name, weight in table.items()}


def _deadlines(path: Path, told: dict, stems: tuple[str, ...]) -> dict[str, datetime]:
    """A day alone means its end. Without a time zone it is the time of the machine that grades."""
    table = _table(path, told, "deadlines")
    for stem, when in table.items():
        if stem not in stems:
            raise ValueError(f"{path}, deadlines: the course has no notebook {stem!r}.{nearest(stem, stems)}")
        if not isinstance(when, date):
            raise ValueError(f"{path}, deadlines, {stem}: a day such as 2026-12-01 is expected, not {when!r}")
    end = time(23, 59, 59)
    return {
        stem: when if isinstance(when, datetime) else datetime.combine(when, end)
        for stem, when in table.items()
    }


def _table(path: Path, told: dict, key: str) -> dict[str, Any]:
    table = told.get(key, {})
    if not isinstance(table, dict):
        raise ValueError(f"{path}, {key}: a table is expected: [{key}] and below it name = value")
    return table
