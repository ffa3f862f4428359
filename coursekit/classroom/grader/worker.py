"""Grades submissions, one after the other: jobs come as JSON lines on stdin, results leave on stdout.

The student's notebook runs in a box; here are the hidden inputs, the solutions and the comparison. What the
box replies is JSON, read defensively: nothing of it is evaluated or believed. To forge an answer one has to
know it. No code of a student's runs in this process, so that it can stay for a whole class.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import shutil
import tempfile
import threading
import time
import zlib
from dataclasses import asdict
from functools import cache
from pathlib import Path

import numpy as np

from .. import own
from ..author import tables
from ..check import examples_of
from ..course import Course, course_at, the_course
from ..exercise import Exercise
from ..verdict import Example, Verdict, verdict
from . import cells, follow_on, locked
from .box import BoxLost, Limits, bubblewrap
from .clinic import Clinic
from .handed_out import handed_out
from .locked import locked_files, write_files
from .reply import clean, for_students
from .student import Student

NAMELESS = (
    "the notebook does not say whom it was handed out to: exercises about one's own arm were asked about "
    "the practice arm"
)


def main() -> None:
    """Grade every job that comes, until there are no more."""
    jobs, results = os.fdopen(os.dup(0), "rb"), os.dup(1)
    os.dup2(2, 1)  # whatever else is printed here must not look like a result
    with contextlib.suppress(ImportError, ValueError):  # Windows has none; a lower limit may be set already
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    with tempfile.TemporaryDirectory(prefix="library") as folder:
        os.chmod(folder, 0o755)  # the box may be somebody else's
        threading.Thread(target=_end_with_parent, args=[folder], daemon=True).start()
        libraries = _Libraries(Path(folder))
        for line in jobs:
            data = json.dumps(grade(json.loads(line), libraries)).encode() + b"\n"
            while data:
                data = data[os.write(results, data) :]


class _Libraries:
    """Locked copies of the library, written once each, and the clinic's."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._known = folder, dict[str, Path]()
        self._clinics: dict[str, Clinic] = {}

    def clinic(self, limits: Limits, program: str | None) -> Clinic:
        """Where the lines are found that are wrong."""
        key = f"{limits} {program}"
        if key not in self._clinics:
            self._clinics[key] = Clinic(self._folder, limits, program)
        return self._clinics[key]

    def of(self, files: dict[str, str]) -> Path:
        key = f"{zlib.crc32(json.dumps(files, sort_keys=True).encode()):08x}"
        if key not in self._known:
            self._known[key] = self._folder / key
            write_files(files, self._known[key])
        return self._known[key]


def grade(job: dict, libraries: _Libraries) -> dict:
    """The result of a job: points and a text for every exercise of the unit."""
    course = course_at(job["course"]) if job["course"] else the_course()
    limits = Limits(**job["limits"])
    exercises = course.exercises(job["unit"])
    result = {e.name: {"points": 0, "of": e.points, "text": ""} for e in exercises}
    data = base64.b64decode(job["notebook"])
    try:
        with cells.in_time(limits.cell):
            sources, others = cells.sources(data)
            names = follow_on.uses(sources)
    except ValueError as error:
        unreadable = {name: {**row, "text": str(error)} for name, row in result.items()}
        return {"exercises": unreadable, "notes": [str(error)]}
    if job.get("search"):
        return _searched(job, course, limits, sources, libraries)
    arm, notes = handed_out(data, job["student"], course)
    if job.get("roster") and arm == own.NOBODY and any(exercise.own for exercise in exercises):
        notes.append(NAMELESS)
    before = time.process_time()
    library = libraries.of({**job["library"], **_drawn(exercises, arm)})
    program, set_up = bubblewrap() if job["box"] else None, follow_on.set_up(course, job["unit"])
    student = Student(sources, library, limits, program, len(exercises), set_up)
    try:
        for exercise in _order(exercises):
            row = result[exercise.name]
            examples = _examples(course, exercise, job["seed"], job["unit"], arm)
            try:
                attempts = student.ask(
                    exercise, [x.arguments for x in examples], robots_can(course, job["unit"], examples)
                )
            except (BoxLost, ValueError) as error:
                missing = "no such function" in str(error)
                why = clean(cells.why_missing(sources, others, exercise.name)) if missing else error
                row |= {"text": f"no answer: {why}", "kind": "missing" if missing else "lost"}
                continue
            found = verdict(exercise, examples, attempts)
            row |= {"text": _told(found), "points": exercise.points if found.right else 0}
            row |= {"kind": found.kind, "step": found.step, "said": found.say}
            if found.kind == "error":
                row["page"] = for_students(_told(found), sources)
        for exercise, earlier in follow_on.candidates(course, job["unit"], result, names):
            examples = _examples(course, exercise, job["seed"], job["unit"], arm)
            can = robots_can(course, job["unit"], examples)
            if follow_on.is_right(student, course, job["unit"], exercise, earlier, examples, can):
                result[exercise.name]["follow_on"] = " and ".join(earlier)
    finally:
        student.close()
    cpu = time.process_time() - before + student.cpu
    return {
        "exercises": result,
        "notes": notes + student.notes,
        "boxes": student.starts,
        "cpu": round(cpu, 2),
    }


def _drawn(exercises: list[Exercise], arm: int) -> dict[str, str]:
    """The sheet of the student's arm, for the box, where an exercise asks for it."""
    asked = any(exercise.own for exercise in exercises)
    return {"own.json": json.dumps(asdict(own.sheet_of(arm)))} if asked else {}


def _searched(job: dict, course: Course, limits: Limits, sources: list[str], libraries: _Libraries) -> dict:
    """The lines of some exercises: advice, and no points."""
    clinic = libraries.clinic(limits, bubblewrap() if job["box"] else None)
    names = [e.name for e in course.exercises(job["unit"]) if e.name in job["search"] and not e.own]
    before, clinic.cpu = time.process_time(), 0.0
    lines = clinic.lines(course, sources, names)
    return {"lines": lines, "cpu": round(time.process_time() - before + clinic.cpu, 2)}


def _order(exercises: list[Exercise]) -> list[Exercise]:
    """Exercises that are handed a robot come last: what robots can do would answer others."""
    return sorted(exercises, key=lambda exercise: "robot" in exercise.arguments)


def robots_can(course: Course, unit: str, examples: list[Example]) -> tuple[str, list[str]] | None:
    """What robots can do for a question, where one is handed over."""
    handed = any(isinstance(x, dict) and "robot" in x for e in examples for x in e.arguments)
    return locked.methods(course.allowed(unit)) if handed else None


@cache
def _known(course: Course, unit: str, name: str, seed: int) -> list[Example]:
    exercise = next(e for e in course.exercises(unit) if e.name == name)
    return hidden_examples(course, exercise, seed, unit)


def _examples(course: Course, exercise: Exercise, seed: int, unit: str, arm: int) -> list[Example]:
    if exercise.own:  # others for each student
        with own.using(arm):
            return hidden_examples(course, exercise, seed, unit)
    return _known(course, unit, exercise.name, seed)


def _told(found: Verdict) -> str:
    """What the page says, in one line: what `check` would say of answers to these inputs."""
    return "" if found.right else " ".join([found.say, *(f"({text})" for text in found.more)])


def hidden_examples(course: Course, exercise: Exercise, seed: int, unit: str) -> list[Example]:
    """Inputs and right answers: the same for every student, unless the exercise asks for their own arm."""
    rng = _hidden(exercise, seed, unit)
    rows = tables.rows(course, unit, exercise, max(exercise.n, exercise.least), rng)
    return examples_of(exercise, {"examples": rows})


def hidden_inputs(exercise: Exercise, seed: int, unit: str) -> list[list]:
    """The arguments alone."""
    rng = _hidden(exercise, seed, unit)
    return [arguments for _, arguments, _ in exercise.draws(rng, max(exercise.n, exercise.least))]


def _hidden(exercise: Exercise, seed: int, unit: str) -> np.random.Generator:
    name = zlib.crc32(f"{unit}/{exercise.name}".encode())  # hash() of a string differs from run to run
    return np.random.default_rng(np.random.SeedSequence([seed, name]))


def library(course: Course, unit: str, seed: int) -> dict[str, str]:
    """The locked library for a unit: its list, and what passing the fk of a robot as an argument needs."""
    questions = [hidden_inputs(exercise, seed, unit) for exercise in course.exercises(unit)]
    passed = {k for calls in questions for call in calls for x in call if isinstance(x, dict) for k in x}
    return locked_files((*course.allowed(unit), *(["robot.Robot.fk"] if "fk" in passed else [])))


def _end_with_parent(folder: str) -> None:
    """If the grader is killed, its workers go too; bubblewrap takes what is in the box along."""
    parent = os.getppid()
    while os.getppid() == parent:
        time.sleep(0.5)
    shutil.rmtree(folder, ignore_errors=True)
    os._exit(1)


if __name__ == "__main__":
    main()
