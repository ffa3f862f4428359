"""What students get: exercises without solutions, the package without anything that gives an answer away."""

from __future__ import annotations

import shutil
from pathlib import Path

from ..course import CLASSROOM, PACKAGE, ROOT, Course, the_course
from . import notebook

# Rooms of the classroom that hold or use solutions. Everything else in it goes to students.
INSTRUCTORS = ("author", "grader", "mistakes")
OF_THE_COURSE = ("exercises", "samples")
SET_UP = ("environment.txt", "pyproject.toml", "LICENSE")


def release(out: Path, course: Course | None = None) -> None:
    """Write the students' version of the course into a new folder; ValueError if it exists."""
    course, out = course or the_course(), Path(out)
    if out.exists():
        raise ValueError(f"{out} exists already: name a new folder")
    hidden = shutil.ignore_patterns("__pycache__", ".*")
    out.mkdir(parents=True)
    shutil.copy(Path(__file__).with_name("students.md"), out / "README.md")
    for name in SET_UP:
        shutil.copy(ROOT / name, out / name)
    students = out / "coursekit" / "classroom"
    students.mkdir(parents=True)
    for name in ("__init__.py", "__main__.py", "commands.py"):
        shutil.copy(PACKAGE / name, out / "coursekit" / name)
    for room in ("kinematics", "view"):
        shutil.copytree(PACKAGE / room, out / "coursekit" / room, ignore=hidden)
    for source in CLASSROOM.iterdir():
        if source.suffix == ".py":
            shutil.copy(source, students / source.name)
        elif source.is_dir() and source.name not in (*INSTRUCTORS, *OF_THE_COURSE, "__pycache__"):
            shutil.copytree(source, students / source.name, ignore=hidden)
    for name in OF_THE_COURSE:
        shutil.copytree(course.classroom / name, students / name, ignore=hidden)
    write_notebooks(course, out / "notebooks")


def write_notebooks(course: Course, out: Path) -> tuple[list[str], list[str]]:
    """Write the students' version of every notebook that is not in `out` yet: (names written, names kept)."""
    out.mkdir(parents=True, exist_ok=True)
    written, kept = [], []
    for source in sorted(p for p in course.notebooks.iterdir() if p.is_file() and not p.name.startswith(".")):
        target = out / source.name
        if target.exists():
            kept.append(source.name)
        elif source.suffix == ".ipynb":
            notebook.write(target, notebook.student_version(notebook.read(source)))
            written.append(source.name)
        else:  # data a notebook reads
            shutil.copy(source, target)
            written.append(source.name)
    return written, kept
