"""What students get: exercises without solutions, the package without anything that gives an answer away."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from .. import own, roster, update
from ..course import CLASSROOM, PACKAGE, ROOT, TOML, Course, the_course
from ..document import stamp
from ..your_course import YourCourse
from . import notebook, tables
from .verify import verify

# Rooms of the classroom that hold or use solutions. Everything else in it goes to students.
INSTRUCTORS = ("author", "grader", "mistakes")
OF_THE_COURSE = ("exercises", "samples")
SET_UP = ("environment.txt", "pyproject.toml", "LICENSE")
HIDDEN = shutil.ignore_patterns("__pycache__", ".*")


def release(out: Path, course: Course | None = None, students: Path | None = None) -> str:
    """Write the students' version of the course; says what was done.

    Parameters
    ----------
    out : a new folder, or one that holds a release: that one is brought up to date, and what somebody wrote
        in it stays (`update`)
    course : the one that ships, unless told otherwise
    students : roster.csv; everybody in it gets a folder `out`/<id> with an arm of their own

    ValueError, and nothing is written, if the course is not whole or `out` is something else.
    """
    course, out = course or the_course(), Path(out)
    verify(course)
    people = roster.read(students) if students else []
    _distinct(students, people)
    out.absolute().parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".release", dir=out.absolute().parent) as scratch:
        master = Path(scratch) / "master"
        _build(master, course)
        if not people:
            update.write_list(master, course.title, course.version)
            return _put(master, out)
        _refuse_other(out, {student.id for student in people})
        theirs = {student.id: Path(scratch) / "theirs" / student.id for student in people}
        for student in people:
            shutil.copytree(master, theirs[student.id])
            _personal(theirs[student.id], course, student)
            update.write_list(theirs[student.id], course.title, course.version)
            if (out / student.id).exists():  # if one of them cannot be updated, none is
                update.plan(theirs[student.id], out / student.id)
        told = [_put(new, out / student) for student, new in theirs.items()]
    changes = [line for text in told for line in text.splitlines()[1:] if ": kept: " not in line]
    heads = [text.splitlines()[0] for text in told]
    return "\n".join(
        [*heads, *dict.fromkeys(changes), f"{len(people)} students: hand each the folder of their id"]
    )


def _put(new: Path, out: Path) -> str:
    if (out / update.RELEASE).is_file():
        return update.update(new, out)
    if out.exists():
        raise ValueError(f"{out} exists already and is no release: name a new folder")
    out.parent.mkdir(parents=True, exist_ok=True)
    shutil.move(new, out)
    return f"wrote {out}: hand it out as it is"


def _refuse_other(out: Path, ids: set[str]) -> None:
    """Before the first student's folder is written, none of the others may stand in the way."""
    if (out / update.RELEASE).exists():
        raise ValueError(f"{out} is a release for everybody; name another folder for one folder a student")
    for name in sorted(ids):
        there = (out / name).exists() and not (out / name / update.RELEASE).is_file()
        if there or (out / name).is_symlink():
            raise ValueError(f"{out / name} exists already and is no release: name a new folder")


def _distinct(path: Path | None, people: list[roster.Student]) -> None:
    arms: dict[tuple, str] = {}
    for student in people:
        sheet = own.sheet_of(own.seed_of(student.id))
        arm = (*sheet.lengths.values(), sheet.forward, sheet.upright, sheet.signs)
        if arm in arms:
            raise ValueError(f"{path}, id: {arms[arm]} and {student.id} would get the same arm")
        arms[arm] = student.id


def _build(out: Path, course: Course) -> None:
    """Everything but what differs from one student to the next."""
    out.mkdir(parents=True)
    (out / "README.md").write_text(_readme(course), encoding="utf-8", newline="\n")
    for name in SET_UP:
        shutil.copy(ROOT / name, out / name)
    students = out / "coursekit" / "classroom"
    students.mkdir(parents=True)
    for name in ("__init__.py", "__main__.py", "commands.py"):
        shutil.copy(PACKAGE / name, out / "coursekit" / name)
    for room in ("kinematics", "view"):
        shutil.copytree(PACKAGE / room, out / "coursekit" / room, ignore=HIDDEN)
    for source in CLASSROOM.iterdir():
        if source.suffix == ".py":
            shutil.copy(source, students / source.name)
        elif source.is_dir() and source.name not in (*INSTRUCTORS, *OF_THE_COURSE, "__pycache__"):
            shutil.copytree(source, students / source.name, ignore=HIDDEN)
    rooms = CLASSROOM if isinstance(course, YourCourse) else course.classroom
    for name in OF_THE_COURSE:
        shutil.copytree(rooms / name, students / name, ignore=HIDDEN)
    write_notebooks(course, out / "notebooks")


def _readme(course: Course) -> str:
    dates = "".join(f"\n* {stem}: {when:%Y-%m-%d %H:%M}" for stem, when in course.deadlines.items())
    text = Path(__file__).with_name("students.md").read_text(encoding="utf-8")
    return text.format(title=course.title, deadlines=f" They are due:\n{dates}" if dates else "")


def _personal(folder: Path, course: Course, student: roster.Student) -> None:
    """Whose folder it is, and the public examples of exercises that ask for one's own arm."""
    seed = own.seed_of(student.id)
    about = json.dumps({"id": student.id, "name": student.name, "seed": seed}, ensure_ascii=False, indent=1)
    (folder / own.FILE).write_text(about + "\n", encoding="utf-8", newline="\n")
    for path in (folder / "notebooks").glob("*.ipynb"):
        document = notebook.read(path)
        stamp(document, course.version, student.id)
        notebook.write(path, document)
    rooms = CLASSROOM if isinstance(course, YourCourse) else course.classroom
    for unit in course.units:
        if any(exercise.own for exercise in course.exercises(unit)):
            path = course.samples_path(unit)
            inside = path.is_relative_to(rooms)
            target = (
                folder / "coursekit" / "classroom" / path.relative_to(rooms)
                if inside
                else folder / "notebooks" / path.name
            )
            with own.using(seed):
                mine = tables.table(course, unit, only_own=True)
            target.write_text(tables.dump({**course.samples(unit), **mine}), encoding="utf-8", newline="\n")


def write_notebooks(course: Course, out: Path, beside: bool = True) -> tuple[list[str], list[str]]:
    """Write the students' version of every notebook that is not in `out` yet: (names written, names kept).

    beside : in a course of one's own, the files that `check` reads, too
    """
    out.mkdir(parents=True, exist_ok=True)
    written, kept = [], []
    for source in _files(course, beside):
        target = out / source.name
        if target.exists():
            kept.append(source.name)
            continue
        written.append(source.name)
        if source.suffix == ".ipynb":
            document = notebook.student_version(notebook.read(source))
            stamp(document, course.version)
            notebook.write(target, document)
        elif source.is_dir():
            shutil.copytree(source, target, ignore=HIDDEN)
        else:  # data a notebook reads
            shutil.copy(source, target)
    if isinstance(course, YourCourse) and beside:
        (out / TOML).write_text(public_toml(course), encoding="utf-8", newline="\n")
    return written, kept


def _files(course: Course, beside: bool) -> list[Path]:
    """The notebooks, and what lies beside them for students."""
    if not isinstance(course, YourCourse):
        return sorted(p for p in course.notebooks.iterdir() if p.is_file() and not p.name.startswith("."))
    found = [course.notebook(unit) for unit in course.units]
    found += [course.notebooks / name for name in course.files]
    if beside:
        mine = [unit for unit in course.units if course.is_at_home(unit)]
        for path_of in (course.exercises_path, course.samples_path, course.questions_path):
            found += [path for unit in mine if (path := path_of(unit)).exists()]
    return found


def public_toml(course: YourCourse, stems: list[str] | None = None) -> str:
    """course.toml as students get it, without the place of the solutions; stems: of these notebooks only."""
    stems = list(course.stems) if stems is None else stems
    names = {e.name for unit in course.units if course.stem_of(unit) in stems for e in course.exercises(unit)}
    weights = {name: weight for name, weight in course.weights.items() if name in names}
    deadlines = {stem: when for stem, when in course.deadlines.items() if stem in stems}
    lines = [
        f"title = {json.dumps(course.title, ensure_ascii=False)}",
        f"version = {json.dumps(course.version)}",
        f"notebooks = {json.dumps(stems)}",
    ]
    if weights:
        lines += ["", "[weights]", *(f"{name} = {weight!r}" for name, weight in weights.items())]
    if deadlines:
        lines += ["", "[deadlines]"]
        lines += [f"{json.dumps(stem)} = {when.isoformat()}" for stem, when in deadlines.items()]
    return "\n".join(lines) + "\n"
