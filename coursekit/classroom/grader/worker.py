"""Grades ONE submission, in a process of its own: a job comes as JSON on stdin, its result leaves on stdout.

The student's notebook runs in a boxed kernel; here are the hidden inputs, the solutions and the comparison.
The kernel's replies are JSON numbers, read defensively: nothing of them is unpickled, evaluated or believed.
To forge an answer one has to know it.
"""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import os
import shutil
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

from ..author import tables
from ..check import examples_of
from ..course import Course, the_course
from ..exercise import Exercise
from ..verdict import Example, Verdict, verdict
from . import cells
from .box import KernelLost, Limits, bubblewrap
from .locked import locked_files, write_files
from .student import Student


def main() -> None:
    """Read the job, grade it, write the result."""
    job = json.load(sys.stdin)
    result = os.dup(1)
    os.dup2(2, 1)  # whatever else is printed here must not look like the result
    with contextlib.suppress(ImportError, ValueError):  # Windows has none; a lower limit may be set already
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    text = json.dumps(asyncio.run(grade(job)))
    os.write(result, text.encode())


async def grade(job: dict) -> dict:
    """The result of a job: points and a text for every exercise of the unit."""
    course = Course(*map(Path, job["course"])) if job["course"] else the_course()
    limits = Limits(**job["limits"])
    exercises = course.exercises(job["unit"])
    questions = {e.name: hidden_examples(course, e, job["seed"], job["unit"]) for e in exercises}
    result = {e.name: {"points": 0, "of": e.points, "text": ""} for e in exercises}
    try:
        sources = cells.sources(base64.b64decode(job["notebook"]))
    except ValueError as error:
        unreadable = {name: {**row, "text": str(error)} for name, row in result.items()}
        return {"exercises": unreadable, "notes": [str(error)]}

    folder = Path(tempfile.mkdtemp(prefix="library"))
    watch = asyncio.create_task(_end_with_parent())
    student = Student(sources, folder, limits, bubblewrap() if job["box"] else None, len(exercises))
    try:
        write_files(job["library"], folder)
        for exercise in exercises:
            row, examples = result[exercise.name], questions[exercise.name]
            try:
                attempts = await student.ask(exercise, [example.arguments for example in examples])
            except (KernelLost, ValueError) as error:
                row["text"] = f"no answer: {error}"
                continue
            found = verdict(exercise, examples, attempts)
            row["text"], row["points"] = _told(found), exercise.points if found.right else 0
    finally:
        watch.cancel()
        await student.stop()
        shutil.rmtree(folder, ignore_errors=True)
    return {"exercises": result, "notes": student.notes, "kernels": student.starts}


def _told(found: Verdict) -> str:
    """What the page says, in one line: what `check` would say of answers to these inputs."""
    return "" if found.right else " ".join([found.say, *(f"({text})" for text in found.more)])


def hidden_examples(course: Course, exercise: Exercise, seed: int, unit: str) -> list[Example]:
    """Inputs and right answers that are the same for every student: what differs is what they wrote."""
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
    """The locked library for a unit: its list, and what passing a robot or its fk as an argument needs."""
    questions = [hidden_inputs(exercise, seed, unit) for exercise in course.exercises(unit)]
    passed = {k for calls in questions for call in calls for x in call if isinstance(x, dict) for k in x}
    needed = (["robots"] if passed else []) + (["robot.Robot.fk"] if "fk" in passed else [])
    return locked_files((*course.allowed(unit), *needed))


async def _end_with_parent() -> None:
    """If the grader is killed, its workers go too; bubblewrap takes the kernel along."""
    parent = os.getppid()
    while os.getppid() == parent:
        await asyncio.sleep(0.5)
    os._exit(1)


if __name__ == "__main__":
    main()
