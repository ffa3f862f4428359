"""What students get: exercises without solutions, the package without anything that gives an answer away."""

from __future__ import annotations

import shutil
from pathlib import Path

from . import notebook
from .course import Course, the_course

ROOT = Path(__file__).resolve().parents[2]

# Of this room only these: no solutions, no mistakes, nothing that grades.
CLASSROOM = (
    "__init__.py",
    "check.py",
    "compare.py",
    "course.py",
    "exercise.py",
    "lab.py",
    "library.py",
    "exercises",
    "samples",
)
SET_UP = ("environment.txt", "pyproject.toml")


def release(out: Path, course: Course | None = None) -> None:
    """Write the students' version of the course into a new folder; ValueError if it exists."""
    course, out = course or the_course(), Path(out)
    if out.exists():
        raise ValueError(f"{out} exists already: name a new folder")
    hidden = shutil.ignore_patterns("__pycache__", ".*")
    package = Path(__file__).resolve().parents[1]
    out.mkdir(parents=True)
    shutil.copy(package / "classroom" / "students.md", out / "README.md")
    for name in SET_UP:
        shutil.copy(ROOT / name, out / name)
    (out / "coursekit" / "classroom").mkdir(parents=True)
    for name in ("__init__.py", "__main__.py"):
        shutil.copy(package / name, out / "coursekit" / name)
    for room in ("kinematics", "view"):
        shutil.copytree(package / room, out / "coursekit" / room, ignore=hidden)
    for name in CLASSROOM:
        source = (course.classroom if name in ("exercises", "samples") else package / "classroom") / name
        target = out / "coursekit" / "classroom" / name
        shutil.copytree(source, target, ignore=hidden) if source.is_dir() else shutil.copy(source, target)
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
