"""The commands, one entry each: what it is called with, what its help says, and the function that runs it.

A function takes the parsed options, imports what it needs only then, and prints what a person should know.
`options.course` is the course that is meant, `options.rest` what the command does not know itself.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


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


def _lab(options: Namespace) -> None:
    from .classroom import lab

    lab.start(options.rest)


def _study(options: Namespace) -> None:
    from .classroom.author import study

    study.start(options.rest)


def _release(options: Namespace) -> None:
    from .classroom.author import release

    release.release(options.out)
    print(f"wrote {options.out}: hand it out as it is")


def _grade(options: Namespace) -> None:
    from .classroom.grader import grade

    summary = grade.grade_class(
        options.submissions,
        options.out,
        jobs=options.jobs,
        seed=options.seed,
        box=not options.no_box,
        regrade=options.regrade,
    )
    print(summary)


def _export(options: Namespace) -> None:
    from .classroom.author import nbgrader

    nbgrader.export(options.out)
    print(f"wrote {options.out}\n{nbgrader.WARNING}")


def _samples(options: Namespace) -> None:
    from .classroom.author import tables

    print("wrote the tables of " + ", ".join(tables.write_samples()))


def _execute(options: Namespace) -> None:
    from nbclient.exceptions import CellExecutionError

    from .classroom.author import notebook

    for path in options.notebooks:
        try:
            notebook.execute(path)
        except CellExecutionError as error:
            raise ValueError(f"{path}, {error.ename}: {error.evalue}; nothing was stored") from None
        print(f"executed {path}")


COMMANDS = {
    "lab": Command(_lab, "open the notebooks in JupyterLab", passes_on=True),
    "study": Command(_study, "learn alone: open the exercises, kept in work/, in JupyterLab", passes_on=True),
    "release": Command(
        _release,
        "write what students get: no solutions, no outputs",
        (_argument("out", type=Path, help="a folder that does not exist yet"),),
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
            _argument("--regrade", action="store_true", help="set the journal aside, grade everybody anew"),
            _argument("--no-box", action="store_true", help="run students' code without a sandbox"),
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
    "samples": Command(_samples, "write the tables that `check` uses, from solved notebooks and mistakes"),
    "execute": Command(
        _execute,
        "run notebooks from top to bottom and store their outputs",
        (_argument("notebooks", type=Path, nargs="+", metavar="NOTEBOOK"),),
    ),
}
