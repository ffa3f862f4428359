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
from ..course import Course, the_course
from ..exercise import Exercise
from . import cells
from .box import KernelLost, Limits, bubblewrap
from .judge import judge
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
    solved, wrong = tables.solutions(course, job["unit"]), course.wrong(job["unit"])
    questions = {e.name: hidden_inputs(e, job["seed"], job["unit"]) for e in exercises}
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
            row, inputs = result[exercise.name], questions[exercise.name]
            try:
                answers = await student.ask(exercise, inputs)
            except (KernelLost, ValueError) as error:
                row["text"] = f"no answer: {error}"
                continue
            right = getattr(solved, exercise.name)
            row["text"] = judge(exercise, inputs, answers, right, wrong.get(exercise.name, {}))
            row["points"] = 0 if row["text"] else exercise.points
    finally:
        watch.cancel()
        await student.stop()
        shutil.rmtree(folder, ignore_errors=True)
    return {"exercises": result, "notes": student.notes, "kernels": student.starts}


def hidden_inputs(exercise: Exercise, seed: int, unit: str) -> list[list]:
    """The same for every student: what differs is only what they wrote."""
    name = zlib.crc32(f"{unit}/{exercise.name}".encode())  # hash() of a string differs from run to run
    rng = np.random.default_rng(np.random.SeedSequence([seed, name]))
    return [exercise.arguments(rng) for _ in range(exercise.n)]


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
