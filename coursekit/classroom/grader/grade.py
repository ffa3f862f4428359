"""Grade a class: SUBMISSIONS/<student>/<notebook>.ipynb to grades.csv, a page for every student, a journal.

The grader itself runs no student code and reads nothing of theirs but bytes. Each submission is a job of
plain data for a worker; the jobs go through any `concurrent.futures.Executor`. Before the first
of them, solved notebooks must get full marks and untouched ones none: a fault of the set-up is never a grade.
"""

from __future__ import annotations

import base64
import concurrent.futures as futures
import contextlib
import hashlib
import json
import secrets
import shutil
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

import numpy as np

from .. import roster
from ..author import notebook
from ..course import ROOT, Course, the_course
from . import decisions, pool, worker
from .box import Limits, bubblewrap, seen
from .clinic import SEARCHED
from .desk import Desk
from .journal import Journal, seed_of
from .submissions import Submissions, digest

SPARE = 60  # seconds a worker may take beyond the limits of its submission


def grade_class(
    submissions: Path,
    out: Path,
    *,
    jobs: int = 2,
    seed: int | None = None,
    box: bool = True,
    regrade: bool | list[str] = False,
    roster_path: Path | None = None,
    follow_on: float = 1.0,
    lines: bool = True,
    late: float = 0.1,
    executor: futures.Executor | None = None,
    course: Course | None = None,
    limits: Limits | None = None,
    progress: bool = True,
) -> str:
    """Grade every submission that the journal in `out` does not hold yet; what sums it up.

    What was graded in an earlier run stays, also if its file is not in `submissions` any more: weeks can be
    graded one after the other into one `out`.

    Parameters
    ----------
    submissions : folder with one folder for each student
    out : gets grades.csv, class.html, <student>.html and journal.jsonl; a run that was here is resumed.
        overrides.csv and extensions.csv in it are read (`decisions`)
    jobs : submissions graded at the same time (with an executor: how many it can take)
    seed : draws the hidden inputs; same seed, same grades. Without one it is drawn once for each folder `out`
        and kept in its journal, so that nobody can work out the inputs beforehand
    box : False runs students' code without bubblewrap, and grades.csv says so
    regrade : True sets the journal that is there aside and grades everybody anew; a list of students and
        notebooks grades those anew, and of a notebook also what changed in its exercises
    roster_path : a CSV of id, name, email: everybody in it gets a row, Canvas and Moodle get their gradebooks
    follow_on, late : shares of the points, see `Decisions`
    lines : search wrong answers for the line that is wrong (`clinic`): some two seconds each
    executor : where the jobs run: threads by default, each of which starts processes

    ValueError if there is no box, if a canary fails, if the course changed since the last run into `out`, or
    if another grader is at work there.
    """
    course, submissions, out = course or the_course(), Path(submissions), Path(out)
    if not submissions.is_dir():
        raise ValueError(
            f"{submissions} is no folder of submissions: `coursekit collect DOWNLOAD NEW` makes one"
        )
    if out.resolve() == submissions.resolve():
        raise ValueError(f"grades cannot go into {out}, where the submissions are: name another folder")
    if jobs < 1 or (seed is not None and seed < 0):
        raise ValueError(f"--jobs is 1 or more, --seed 0 or more; {jobs if jobs < 1 else seed} came")
    if box and bubblewrap() is None:
        raise ValueError(
            "students' code runs in bubblewrap, which does not work here (Debian: apt install bubblewrap). "
            "--no-box grades without it: that code can then do whatever you can"
        )
    for place in (course.notebooks, submissions, out):
        if box and seen(place) and not place.resolve().is_relative_to(ROOT):  # the course itself is hidden
            raise ValueError(
                f"{place} lies where students' code can read: put it elsewhere, into your home, say"
            )
    units = [unit for unit in course.units if course.exercises(unit)]
    limits = limits or Limits()
    out.mkdir(
        mode=0o700, parents=True, exist_ok=True
    )  # students may have accounts here, and the seed is in it
    path = out / "journal.jsonl"
    people = {one.id: one for one in roster.read(roster_path)} if roster_path else {}
    anew = [] if isinstance(regrade, bool) else _units_of(regrade, course, units)
    if seed is None:
        seed = None if regrade is True else seed_of(path)
        seed = secrets.randbits(48) if seed is None else seed
    make = Jobs(course, units, seed=seed, box=box, limits=limits, roster=bool(people))
    run = {"seed": seed, "box": box, "limits": asdict(limits), **course_digests(course, units)}
    run["points"] = {e.name: e.points for unit in units for e in course.exercises(unit)}
    with contextlib.ExitStack() as stack:
        stack.callback(pool.close)
        if executor is None:
            executor = stack.enter_context(futures.ThreadPoolExecutor(jobs))
        journal = Journal(path, run, anew, aside=regrade is True)
        stack.enter_context(contextlib.closing(journal))
        copies = out / ".copies"  # not elsewhere: what a killed run left there, the next one finds
        shutil.rmtree(copies, ignore_errors=True)
        copies.mkdir()
        stack.callback(shutil.rmtree, copies, ignore_errors=True)
        names = {unit: course.notebook(unit).name for unit in units}
        handed_in = Submissions(submissions, copies, names, out, {*journal.students, *people})
        students = handed_in.students
        for student in regrade if isinstance(regrade, list) else ():
            if student in students:
                journal.forget(students=[student])
            elif student.removesuffix(".ipynb") not in _stems(course, units) and student not in units:
                raise ValueError(f"--regrade {student}: no student's name and no notebook's")
        decided = decisions.read(out, course, units, set(students), follow_on, late)
        ahead = 2 * jobs + 2
        if (
            set_up := f"{sys.executable}, Python {sys.version}, numpy {np.__version__}"
        ) not in journal.proved:
            _canaries(run_all(executor, make.canaries(), ahead))
            journal.prove(set_up)
        everything = [(student, unit) for student in students for unit in units]
        waiting = [x for x in everything if _is_due(x, journal, handed_in)]
        desk = Desk(out, course, units, people, decided, handed_in, journal, box)
        bar = _progress(len(everything), len(everything) - len(waiting), progress)
        with contextlib.closing(bar):
            for record in run_all(executor, (make.job(handed_in, *x) for x in waiting), ahead):
                journal.add(record)
                bar.update()
                desk.look()
        said = desk.write()  # the grades are there; advice may take as long again
        if lines and (unclear := [x for x in everything if _is_unclear(x, journal, handed_in)]):
            bar = _progress(len(unclear), 0, progress, "lines of wrong answers")
            with contextlib.closing(bar):
                searches = (make.search(handed_in, *x, journal.record(*x)) for x in unclear)
                for record in run_all(executor, searches, ahead):
                    if not record.get("failed"):
                        journal.add_lines(record)
                    bar.update()
            said = desk.write()
        return said


def _stems(course: Course, units: list[str]) -> dict[str, str]:
    return {course.notebook(unit).stem: unit for unit in units}


def _units_of(names: list[str], course: Course, units: list[str]) -> list[str]:
    """Those of the names that are a notebook's, as units."""
    stems = _stems(course, units) | {unit: unit for unit in units}
    return sorted({stems[stem] for name in names if (stem := name.removesuffix(".ipynb")) in stems})


def _is_due(which: tuple[str, str], journal: Journal, handed_in: Submissions) -> bool:
    data = handed_in.data(*which)
    if data is None and journal.has_grade(*which):
        return False  # it was handed in and graded earlier
    return not journal.holds(*which, digest(data))


def _is_unclear(which: tuple[str, str], journal: Journal, handed_in: Submissions) -> bool:
    """Is there a wrong answer of which only a search can say what is wrong?"""
    data, record = handed_in.data(*which), journal.record(*which)
    if data is None or record is None or journal.is_searched(*which, digest(data)):
        return False
    return any(row.get("kind") in SEARCHED for row in record["exercises"].values())


def course_digests(course: Course, units: list[str]) -> dict[str, str]:
    """{"course nb01": digest, ...} of all that decides a grade: exercises, mistakes and solutions."""

    def digest_of(unit: str) -> str:
        text = hashlib.sha256()
        for path in course.sources(unit):
            text.update(path.read_bytes())
        for cell in notebook.read(course.notebook(unit))["cells"]:
            if notebook.is_solution(cell) or "setup" in notebook.tags(cell):
                text.update(cell["source"].encode())
        return text.hexdigest()[:16]

    return {f"course {unit}": digest_of(unit) for unit in units}


class Jobs:
    """Jobs are plain data: all a worker needs beside an installed coursekit, on this machine or another."""

    def __init__(
        self, course: Course, units: list[str], *, seed: int, box: bool, limits: Limits, roster: bool = False
    ) -> None:
        place = None if course == the_course() else course.place
        self._common = {"course": place, "seed": seed, "box": box, "limits": asdict(limits), "roster": roster}
        self._course, self._units = course, units
        self._libraries = {unit: worker.library(course, unit, seed) for unit in units}

    def job(self, handed_in: Submissions, student: str, unit: str) -> dict:
        when = handed_in.time(student, unit)
        return self._job(student, unit, handed_in.data(student, unit), handed_in.note(student, unit), when)

    def from_bytes(self, student: str, unit: str, data: bytes) -> dict:
        """A job for a notebook that lies in no folder."""
        return self._job(student, unit, data, "")

    def search(self, handed_in: Submissions, student: str, unit: str, record: dict | None) -> dict:
        """A job that asks for no points, but for the lines of what is wrong and unclear."""
        rows = (record or {}).get("exercises", {}).items()
        names = [name for name, row in rows if row.get("kind") in SEARCHED]
        return {**self.job(handed_in, student, unit), "search": names}

    def canaries(self) -> Iterator[dict]:
        """The solved notebooks and the untouched ones, graded as if they were handed in."""
        for unit in self._units:
            solved = notebook.read(self._course.notebook(unit))
            for student, document in (("solved", solved), ("untouched", notebook.student_version(solved))):
                yield self.from_bytes(student, unit, json.dumps(document).encode())

    def _job(
        self, student: str, unit: str, data: bytes | None, note: str, when: tuple[str, bool] = ("", False)
    ) -> dict:
        return {
            **self._common,
            "library": self._libraries[unit],
            "student": student,
            "unit": unit,
            "name": self._course.notebook(unit).name,
            "notebook": None if data is None else base64.b64encode(data).decode(),
            "digest": digest(data),
            "note": note,
            "submitted": when[0],
            "late": when[1],
            "exercises": [(e.name, e.points) for e in self._course.exercises(unit)],
        }


def run_all(executor: futures.Executor, jobs: Iterator[dict], ahead: int) -> Iterator[dict]:
    """Records in the order they finish. Few jobs are sent ahead: a whole class may not fit into memory."""
    running: dict[futures.Future, dict] = {}
    for job in jobs:
        running[executor.submit(grade_one, job)] = {**job, "notebook": None}
        if len(running) >= ahead:
            yield from _finished(running)
    while running:
        yield from _finished(running)


def _finished(running: dict) -> Iterator[dict]:
    done, _ = futures.wait(running, return_when=futures.FIRST_COMPLETED)
    for future in done:
        job = running.pop(future)
        try:
            yield future.result()
        except Exception as error:  # the machine it ran on is gone, say
            yield _failed(job, f"{type(error).__name__}: {error}")


# ---- one submission


def grade_one(job: dict) -> dict:
    """The record of one submission. Plain data in and out, for any executor on any machine."""
    if job["notebook"] is None:
        exercises = {name: {"points": 0, "of": of, "text": job["note"]} for name, of in job["exercises"]}
        return {**_head(job), "exercises": exercises, "notes": [job["note"]]}
    why, start = "", time.monotonic()
    for _ in range(2):  # once more if the worker itself fails: that is nobody's grade
        result, why = _worker(job)
        if result is not None:
            return {**_head(job), **result, "seconds": round(time.monotonic() - start, 2)}
    return _failed(job, why)


def _head(job: dict) -> dict:
    return {key: job[key] for key in ("student", "unit", "name", "digest", "submitted", "late")}


def _failed(job: dict, why: str) -> dict:
    return {**_head(job), "failed": True, "exercises": {}, "notes": [f"could not be graded: {why}"]}


def _worker(job: dict) -> tuple[dict | None, str]:
    """(what the worker found, '') or (None, what befell the worker)."""
    try:
        return pool.grade(job, job["limits"]["submission"] + SPARE), ""
    except pool.WorkerLost as lost:
        return None, str(lost)


# ---- all of them


def _canaries(records: Iterator[dict]) -> None:
    """ValueError unless solved notebooks get full marks and untouched ones nothing."""
    for record in records:
        rows = record["exercises"].values()
        points, of = sum(row["points"] for row in rows), sum(row["of"] for row in rows)
        if record.get("failed") or points != (of if record["student"] == "solved" else 0):
            why = [f"{name}: {row['text']}" for name, row in record["exercises"].items() if row["text"]]
            raise ValueError(
                f"the {record['student']} {record['name']} gets {points} of {of} points, "
                f"so nobody is graded: {'; '.join(record['notes'] + why)}"
            )


def _progress(total: int, done: int, show: bool, what: str = ""):
    from tqdm import tqdm

    return tqdm(total=total, initial=done, unit="notebook", disable=not show, desc=what or None)
