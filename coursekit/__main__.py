"""The command line: `coursekit COMMAND ...`; what there is stands in `commands`."""

from __future__ import annotations

import argparse
import io
import sys

from . import __version__
from .commands import COMMANDS

EXAMPLES = """examples:
  coursekit study                              learn alone: exercises in work/, where you left off
  coursekit release OUT                        what students get
  coursekit grade SUBMISSIONS OUT --jobs 2     grades.csv and a page for each student
  coursekit COMMAND --help                     what a command takes

exit codes: 0 done; 1 stopped by an error of ours; 2 not done: the sentence says what is missing or wrong;
130 stopped with Ctrl-C
"""


def main(argv: list[str] | None = None) -> int:
    """Run one command; 0 if it did what it should."""
    for stream in (sys.stdout, sys.stderr):  # names of files may hold letters that a terminal has not
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    parser = _parser()
    options, rest = parser.parse_known_args(argv)
    command = COMMANDS[options.command]
    if rest and not command.passes_on:
        parser.error(f"unrecognized arguments: {' '.join(rest)}")
    options.rest = rest
    try:
        command.run(options)
        return 0
    except ImportError as error:
        if not (error.name or "").startswith(("coursekit.classroom", "coursekit.site")):
            raise
        print(f"coursekit {options.command} is not part of the students' version", file=sys.stderr)
    except KeyboardInterrupt as stopped:
        print(f"coursekit {options.command}: stopped{stopped}", file=sys.stderr)
        return 130  # as shells say it
    except OSError as error:  # without its number
        why = f"{error.filename}: {error.strerror}" if error.filename and error.strerror else error
        print(f"coursekit {options.command}: {why}", file=sys.stderr)
    except ValueError as error:
        print(f"coursekit {options.command}: {error}", file=sys.stderr)
    return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="coursekit",
        description="A robot kinematics course in six notebooks.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"coursekit {__version__}")
    words = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        one = words.add_parser(name, help=command.text, description=command.text)
        one.add_argument(
            "--course", metavar="DIR", help="a course of your own: the folder of its course.toml"
        )
        for names, settings in command.arguments:
            one.add_argument(*names, **settings)
    return parser


if __name__ == "__main__":
    sys.exit(main())
