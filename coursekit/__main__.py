"""The command line: `coursekit COMMAND ...`; what there is stands in `commands`."""

from __future__ import annotations

import argparse
import sys

from .commands import COMMANDS


def main(argv: list[str] | None = None) -> int:
    """Run one command; 0 if it did what it should."""
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
    words = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        one = words.add_parser(name, help=command.text, description=command.text)
        for names, settings in command.arguments:
            one.add_argument(*names, **settings)
    return parser


if __name__ == "__main__":
    sys.exit(main())
