"""Follow-on credit: an exercise that is wrong only because an earlier one, which it calls, is wrong.

It is asked once more, in a box of its own, with the right earlier function in the place of the student's. By
then that earlier exercise is judged, so that its solution may be seen in the box: it can earn nothing there.
The solution of the exercise in question never enters. What is said in that box is not shown to anybody.
"""

from __future__ import annotations

import ast
from functools import cache

from ..author import notebook
from ..course import Course
from ..exercise import Exercise
from ..verdict import Example, verdict
from .box import BoxLost
from .student import Student


def candidates(
    course: Course, unit: str, result: dict[str, dict], names: dict[str, set[str]]
) -> list[tuple[Exercise, list[str]]]:
    """Wrong exercises that call wrong earlier ones, and which, in the order of the notebook.

    names : what each of the student's functions `uses`
    """
    found, wrong = [], list[str]()
    for exercise in course.exercises(unit):
        row = result[exercise.name]
        if row["points"]:
            continue
        if earlier := [name for name in wrong if name in reached(exercise.name, names)]:
            found.append((exercise, earlier))
        wrong.append(exercise.name)
    return found


def is_right(
    student: Student,
    course: Course,
    unit: str,
    exercise: Exercise,
    earlier: list[str],
    examples: list[Example],
    robots_can: tuple[str, list[str]] | None = None,
) -> bool:
    """Is the exercise right with right earlier ones?"""
    student.replace(solutions(course, unit, earlier, exercise.name), earlier)
    try:
        attempts = student.ask(exercise, [example.arguments for example in examples], robots_can)
    except (BoxLost, ValueError):
        return False
    finally:
        student.close()
    return verdict(exercise, examples, attempts).right


def solutions(course: Course, unit: str, names: list[str], but: str) -> list[str]:
    """The set-up and the solutions down to the last of these: solutions may call earlier ones."""
    sources, left = [], set(names)
    for cell in notebook.read(course.notebook(unit))["cells"]:
        solves = cell["metadata"].get("nbgrader", {}).get("grade_id") if notebook.is_solution(cell) else None
        if left and solves != but and (solves or _sets_up(cell)):
            sources.append(cell["source"])
            left.discard(solves)
    return sources


@cache
def set_up(course: Course, unit: str) -> str:
    """The imports that a notebook begins with."""
    return "\n".join(
        cell["source"] for cell in notebook.read(course.notebook(unit))["cells"] if _sets_up(cell)
    )


def _sets_up(cell: dict) -> bool:
    return cell["cell_type"] == "code" and "setup" in notebook.tags(cell)


def uses(sources: list[str]) -> dict[str, set[str]]:
    """{function: the names in its body}, of all cells; the last definition counts."""
    found: dict[str, set[str]] = {}
    for source in sources:
        try:
            tree = ast.parse(source)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                found[node.name] = {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}
    return found


def reached(name: str, names: dict[str, set[str]]) -> set[str]:
    """Everything that a function calls, and what that calls in turn."""
    found: set[str] = set()
    waiting = [name]
    while waiting:
        for inner in names.get(waiting.pop(), set()) - found:
            found.add(inner)
            waiting.append(inner)
    return found
