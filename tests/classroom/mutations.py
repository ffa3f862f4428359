"""Single edits of every reference solution, and those that still pass on the public samples: the survivors.

    python -m tests.classroom.mutations nb01 nb02        # lists what survives without a reason, and where

A survivor is either equivalent to the solution, and `survivors/nb01.json` says why, under the exercise and
the words before the parenthesis, or it is a wrong function that `check` would accept, and the exercise needs
an edge.
"""

from __future__ import annotations

import ast
import inspect
import json
import sys
from pathlib import Path

import numpy as np

from coursekit.classroom.author import tables
from coursekit.classroom.check import examples_of
from coursekit.classroom.course import Course, the_course
from coursekit.classroom.exercise import Exercise
from coursekit.classroom.repair import _Search, places
from coursekit.classroom.repair.lines import line_edits, name_edits

REASONS = Path(__file__).resolve().parent / "survivors"
# Kinds that are not asked for: they change nothing where nothing is wrong.
HARMLESS = {"copy", "whole_numbers", "in_place", "negative_root", "somewhere", "products"}
DEEPEST = 1  # rank of the edits: what stands there is replaced, or gets a sign, is transposed or inverted


def survivors(course: Course, unit: str, exercise: Exercise) -> dict[str, str]:
    """{"what stands there | kind of the edit": in which lines}: every edit that passes on all public samples.

    Lines are told by their text and their number, counted from the `def`.
    """
    examples = examples_of(exercise, course.samples(unit)[exercise.name])
    solution = getattr(tables.solutions(course, unit), exercise.name)
    search = _Search(exercise, solution, examples, 1)
    search.left = search.end = 10**9  # all of them
    search.sure = False
    lines = inspect.getsource(solution).splitlines()

    def where(hit):
        number = hit.line - search.first
        return f"line {number + 1}: {lines[number].strip()}"

    found: dict[str, list[str]] = {}
    with np.errstate(all="ignore"):
        for place in list(places.places(search.tree)):
            here = ast.unparse(place.node)
            variants = [v for v in place.variants if v.rank <= DEEPEST and v.kind not in HARMLESS]
            hits = [hit for hit in search._try([place], variants, 0, place.node.lineno) if hit]
            for hit in hits:
                found.setdefault(f"{here} | {hit.kind}", []).append(where(hit))
        for edits in (line_edits, name_edits):
            for hit in search._edited(edits):
                if hit and hit.kind not in HARMLESS:
                    text = f"{_line(search.tree, hit.line)} | {hit.kind} {hit.what}".strip()
                    found.setdefault(text, []).append(where(hit))
    return {text: "; ".join(dict.fromkeys(lines_of)) for text, lines_of in found.items()}


def _line(tree: ast.FunctionDef, line: int) -> str:
    """The statement that stands in a line, without what hangs below it."""
    found = [n for n in ast.walk(tree) if isinstance(n, ast.stmt) and n.lineno == line and n is not tree]
    return ast.unparse(found[-1]).split("\n")[0] if found else "all of it"


def reasons(unit: str) -> dict[str, dict[str, str]]:
    """{exercise: {survivor: why it is equivalent}}."""
    path = REASONS / f"{unit}.json"
    return json.loads(path.read_text("utf-8")) if path.exists() else {}


if __name__ == "__main__":
    course = the_course()
    for unit in sys.argv[1:] or course.units:
        for exercise in course.exercises(unit):
            known = reasons(unit).get(exercise.name, {})
            for survivor, where in survivors(course, unit, exercise).items():
                if survivor not in known:
                    print(f"{unit} {exercise.name}: {survivor} ({where})")
