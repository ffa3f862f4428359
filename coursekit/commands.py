"""The commands, one entry each: what it is called with, what its help says, and the function that runs it.

A function takes the parsed options, imports what it needs only then, and prints what a person should know.
`_course(options)` is the course that is meant, `options.rest` what the command does not know itself.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .classroom.course import Course


@dataclass(frozen=True)
class Command:
    """One word of the command line.

    arguments   : as `argparse` takes them: (names or flags, settings)
    passes_on   : what it does not know goes on to JupyterLab, in `options.rest`
    """

    run: Callable[[Namespace], None]
    text: str
    arguments: tuple[tuple[tuple[str, ...], dict[str, Any]], ...] = ()
    passes_on: bool = False


def _argument(*names: str, **settings: Any) -> tuple[tuple[str, ...], dict[str, Any]]:
    return names, settings


def _course(options: Namespace) -> Course:
    """What --course names, or else the course of the folder one is in."""
    from .classroom.course import course_at, course_here

    return course_at([str(options.course)]) if options.course else course_here()


def _course_of(options: Namespace, handed_in: Path) -> Course:
    """The same for commands that read what students hand in: a course.toml among it is not believed."""
    course = _course(options)
    toml = course.notebooks / "course.toml"
    if not options.course and toml.exists() and toml.resolve().is_relative_to(handed_in.resolve()):
        raise ValueError(
            f"{toml} lies among what was handed in, and is not used: run this "
            "from another folder, or name your course with --course"
        )
    return course


def _lab(options: Namespace) -> None:
    from .classroom import lab

    course = _course(options)
    lab.start(options.rest, notebooks=getattr(course, "solved", None))


def _study(options: Namespace) -> None:
    from .classroom.author import study

    study.start(options.rest, _course(options))


def _release(options: Namespace) -> None:
    from .classroom.author import release

    print(release.release(options.out, _course(options), options.roster))


def _update(options: Namespace) -> None:
    from .classroom import update

    if options.undo == (options.new is not None):
        raise ValueError("name the corrected release (its folder or zip), or --undo")
    print(update.undo(options.folder) if options.undo else update.update(options.new, options.folder))


def _new(options: Namespace) -> None:
    from .classroom.author import new

    print(new.new(options.folder))


def _collect(options: Namespace) -> None:
    from .classroom.grader import collect

    print(collect.collect(options.source, options.out, options.roster, _course_of(options, options.source)))


def _grade(options: Namespace) -> None:
    from .classroom.author.verify import verify
    from .classroom.grader import grade

    course = _course_of(options, options.submissions)
    verify(course)
    try:
        summary = grade.grade_class(
            options.submissions,
            options.out,
            jobs=options.jobs,
            seed=options.seed,
            box=not options.no_box,
            regrade=False if options.regrade is None else options.regrade or True,
            roster_path=options.roster,
            follow_on=options.follow_on,
            lines=not options.no_lines,
            late=options.late,
            course=course,
        )
    except KeyboardInterrupt:
        raise KeyboardInterrupt("; what is graded is kept: run it again, and it goes on") from None
    print(summary)


def _viva(options: Namespace) -> None:
    from .classroom.grader.viva import viva

    course = _course_of(options, options.submissions)
    sheet, answers = viva(
        options.student, options.submissions, options.out, course, options.exercise, options.seed
    )
    print(f"wrote {sheet}, to lay on the table, and {answers}, for you alone")


def _export(options: Namespace) -> None:
    from .classroom.author import nbgrader
    from .classroom.author.verify import verify

    course = _course(options)
    verify(course)
    nbgrader.export(options.out, course)
    print(f"wrote {options.out}\n{nbgrader.WARNING}")


def _site(options: Namespace) -> None:
    from .site import write  # named, so that it is missed where students' version has none

    print(write(options.out, _course(options), options.pyodide))


def _samples(options: Namespace) -> None:
    from .classroom.author import tables

    print("wrote the tables of " + ", ".join(tables.write_samples(_course(options))))


def _execute(options: Namespace) -> None:
    from nbclient.exceptions import CellExecutionError

    from .classroom.author import notebook

    for path in options.notebooks or _at_home(_course(options)):
        try:
            notebook.execute(path)
        except CellExecutionError as error:
            raise ValueError(f"{path}, {error.ename}: {error.evalue}; nothing was stored") from None
        print(f"executed {path}")


def _at_home(course: Course) -> list[Path]:
    """The solved notebooks that lie in the course's own folder."""
    found = [course.notebook(unit) for unit in course.units]
    return [path for path in found if path.parent in (course.notebooks, getattr(course, "solved", None))]


COMMANDS = {
    "new": Command(
        _new,
        "begin a course of your own: a notebook, an exercise, its mistakes",
        (_argument("folder", type=Path, help="a folder that does not exist yet"),),
    ),
    "lab": Command(_lab, "open the notebooks in JupyterLab", passes_on=True),
    "study": Command(_study, "learn alone: open the exercises, kept in work/, in JupyterLab", passes_on=True),
    "release": Command(
        _release,
        "write what students get: no solutions, no outputs",
        (
            _argument("out", type=Path, help="a new folder, or a release to bring up to date"),
            _argument("--roster", type=Path, help="a CSV of id, name, email: OUT/<id> with an arm for each"),
        ),
    ),
    "update": Command(
        _update,
        "students: take in a corrected release; what you wrote stays",
        (
            _argument("new", type=Path, nargs="?", help="the corrected release, a folder or a zip"),
            _argument("--folder", type=Path, help="yours, if it is not the one coursekit lies in"),
            _argument("--undo", action="store_true", help="bring back what the last update replaced"),
        ),
    ),
    "collect": Command(
        _collect,
        "sort what Canvas, Moodle or nbgrader hands out into SUBMISSIONS/<student>/<notebook>.ipynb",
        (
            _argument("source", type=Path, help="the zip or the folder that was downloaded"),
            _argument("out", type=Path, metavar="submissions", help="a folder that does not exist yet"),
            _argument("--roster", type=Path, help="a CSV of id, name, email: folders are named by id"),
        ),
    ),
    "grade": Command(
        _grade,
        "grade SUBMISSIONS/<student>/<notebook>.ipynb",
        (
            _argument("submissions", type=Path),
            _argument(
                "out", type=Path, help="gets grades.csv, <student>.html and journal.jsonl; resumes if there"
            ),
            _argument("--jobs", type=int, default=2, help="submissions graded at the same time (2)"),
            _argument(
                "--seed",
                type=int,
                help="draws the hidden inputs: same seed, same grades (kept in the journal)",
            ),
            _argument("--roster", type=Path, help="a CSV of id, name, email: canvas.csv and moodle.csv, too"),
            _argument(
                "--regrade",
                nargs="*",
                metavar="NAME",
                help="grade these students or notebooks anew; without names everybody",
            ),
            _argument(
                "--late",
                type=float,
                default=0.1,
                metavar="SHARE",
                help="of the points, for every started day after the deadline (0.1)",
            ),
            _argument(
                "--follow-on",
                type=float,
                default=1.0,
                metavar="SHARE",
                help="of the points, where only an earlier exercise that is called is wrong (1)",
            ),
            _argument("--no-lines", action="store_true", help="do not search wrong answers for the line"),
            _argument("--no-box", action="store_true", help="run students' code without a sandbox"),
        ),
    ),
    "viva": Command(
        _viva,
        "ten minutes with a student: one of their functions, three questions, answers on another page",
        (
            _argument("student", help="the name of a folder in SUBMISSIONS"),
            _argument("submissions", type=Path),
            _argument("out", type=Path, help="gets the two pages"),
            _argument("--exercise", help="talk about this function; else one of theirs is drawn"),
            _argument("--seed", type=int, default=0, help="another number, other questions"),
        ),
    ),
    "export": Command(
        _export,
        "write the course for another grader",
        (
            _argument("target", choices=["nbgrader"]),
            _argument("out", type=Path, help="a folder that does not exist yet"),
        ),
    ),
    "site": Command(
        _site,
        "write the course as a folder for a web server: pages that move, and Python in the browser",
        (
            _argument("out", type=Path, help="a folder that does not exist yet"),
            _argument("--pyodide", type=Path, help="Pyodide's unpacked release, to run the course there"),
        ),
    ),
    "samples": Command(_samples, "write the tables that `check` uses, from solved notebooks and mistakes"),
    "execute": Command(
        _execute,
        "run notebooks from top to bottom and store their outputs",
        (
            _argument(
                "notebooks", type=Path, nargs="*", metavar="NOTEBOOK", help="all of the course unless named"
            ),
        ),
    ),
}
