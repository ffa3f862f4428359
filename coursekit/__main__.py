"""The command line: `coursekit lab`, `study`, `release`, `grade`, `export`, `samples`, `execute`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path


def main(argv: list[str] | None = None) -> int:
    """Run one command; 0 if it did what it should."""
    options, rest = _parser().parse_known_args(argv)
    if rest and options.command not in ("lab", "study"):  # these two pass them on to JupyterLab
        _parser().error(f"unrecognized arguments: {' '.join(rest)}")
    try:
        return options.run(options, rest) or 0
    except ImportError as error:
        if not (error.name or "").startswith("coursekit.classroom"):
            raise
        print(f"coursekit {options.command} is not part of the students' version", file=sys.stderr)
    except (ValueError, OSError) as error:
        print(f"coursekit {options.command}: {error}", file=sys.stderr)
    return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="coursekit", description="A robot kinematics course in six notebooks."
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(name: str, run: Callable, text: str) -> argparse.ArgumentParser:
        one = commands.add_parser(name, help=text, description=text)
        one.set_defaults(run=run)
        return one

    command("lab", _lab, "open the notebooks in JupyterLab")
    command("study", _study, "learn alone: open the exercises, kept in work/, in JupyterLab")

    one = command("release", _release, "write what students get: no solutions, no outputs")
    one.add_argument("out", type=Path, help="a folder that does not exist yet")

    one = command("grade", _grade, "grade SUBMISSIONS/<student>/<notebook>.ipynb")
    one.add_argument("submissions", type=Path)
    one.add_argument(
        "out", type=Path, help="gets grades.csv, <student>.html and journal.jsonl; resumes if there"
    )
    one.add_argument("--jobs", type=int, default=2, help="submissions graded at the same time (2)")
    one.add_argument(
        "--seed", type=int, help="draws the hidden inputs: same seed, same grades (kept in the journal)"
    )
    one.add_argument("--regrade", action="store_true", help="set the journal aside, grade everybody anew")
    one.add_argument("--no-box", action="store_true", help="run students' code without a sandbox")

    one = command("export", _export, "write the course for another grader")
    one.add_argument("target", choices=["nbgrader"])
    one.add_argument("out", type=Path, help="a folder that does not exist yet")

    command("samples", _samples, "write the tables that `check` uses, from solved notebooks and mistakes")

    one = command("execute", _execute, "run notebooks from top to bottom and store their outputs")
    one.add_argument("notebooks", type=Path, nargs="+", metavar="NOTEBOOK")
    return parser


def _lab(options: argparse.Namespace, rest: list[str]) -> None:
    from .classroom import lab

    lab.start(rest)


def _study(options: argparse.Namespace, rest: list[str]) -> None:
    from .classroom.author import study

    study.start(rest)


def _release(options: argparse.Namespace, rest: list[str]) -> None:
    from .classroom.author import release

    release.release(options.out)
    print(f"wrote {options.out}: hand it out as it is")


def _grade(options: argparse.Namespace, rest: list[str]) -> None:
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


def _export(options: argparse.Namespace, rest: list[str]) -> None:
    from .classroom.author import nbgrader

    nbgrader.export(options.out)
    print(f"wrote {options.out}\n{nbgrader.WARNING}")


def _samples(options: argparse.Namespace, rest: list[str]) -> None:
    from .classroom.author import tables

    print("wrote the tables of " + ", ".join(tables.write_samples()))


def _execute(options: argparse.Namespace, rest: list[str]) -> None:
    from nbclient.exceptions import CellExecutionError

    from .classroom.author import notebook

    for path in options.notebooks:
        try:
            notebook.execute(path)
        except CellExecutionError as error:
            raise ValueError(f"{path}, {error.ename}: {error.evalue}; nothing was stored") from None
        print(f"executed {path}")


if __name__ == "__main__":
    sys.exit(main())
