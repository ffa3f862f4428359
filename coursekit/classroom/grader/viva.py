"""`coursekit viva STUDENT SUBMISSIONS OUT`: ten minutes about one of a student's own functions.

Two pages: the function with line numbers and three questions, to lay on the table; and the answers, for the
instructor alone. Nothing of the student's is run. Numbers come from the course: examples that no check has
shown, what a typical mistake makes of them, and the student's own arm in another frame.
"""

from __future__ import annotations

import ast
import html
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import own
from ..author import notebook, tables
from ..course import Course, the_course
from ..exercise import Exercise, nearest, thaw
from . import cells
from .frames import frame_question
from .handed_out import handed_out
from .report import STYLE, page_name

READING = 20.0  # seconds for a notebook
WRITTEN = 3  # lines that a function has at least, if there are longer ones


@dataclass(frozen=True)
class Written:
    """A function as its student wrote it."""

    unit: str
    exercise: Exercise
    source: str
    first: int  # the line of its cell that it begins in


@dataclass(frozen=True)
class Question:
    """What is asked, and what only the instructor reads: HTML."""

    text: str
    answer: str


def viva(
    student: str,
    submissions: Path,
    out: Path,
    course: Course | None = None,
    exercise: str | None = None,
    seed: int = 0,
) -> tuple[Path, Path]:
    """Write the sheet and the instructor's page; (sheet, answers).

    Parameters
    ----------
    student : the name of a folder in `submissions`
    exercise : the function that is talked about; drawn from those the student wrote unless told otherwise
    seed : another number, other questions

    ValueError, and nothing is written, for an unknown student, for one who wrote nothing, and for an exercise
    that there is not.
    """
    course, submissions, out = course or the_course(), Path(submissions), Path(out)
    known = sorted(p.name for p in submissions.iterdir() if p.is_dir()) if submissions.is_dir() else []
    if student not in known:
        raise ValueError(f"{submissions}: there is no student {student!r}.{nearest(student, known)}")
    if exercise is not None:
        course.find(exercise)
    functions, arm, notes = _handed_in(submissions / student, student, course)
    rng = np.random.default_rng([seed, zlib.crc32(student.encode())])
    one = _chosen(functions, exercise, rng)
    if one is None:
        what = f"a function {exercise!r}" if exercise else "any function of an exercise"
        raise ValueError(f"{submissions / student}: the student did not write {what}{_because(notes)}")
    with own.using(arm):
        asked = [_numbers(course, one, rng), _mistake(course, one, rng), Question(*frame_question(arm, rng))]
    out.mkdir(mode=0o700, parents=True, exist_ok=True)  # students may have accounts here
    name = page_name(student)
    sheet, answers = out / f"viva-{name}", out / f"viva-answers-instructor-only-{name}"
    sheet.write_text(_page(student, one, asked, course, answers=False), encoding="utf-8", errors="replace")
    answers.write_text(_page(student, one, asked, course, answers=True), encoding="utf-8", errors="replace")
    return sheet, answers


# ---- what the student wrote


def _handed_in(folder: Path, student: str, course: Course) -> tuple[list[Written], int, list[str]]:
    found: list[Written] = []
    arm, notes = 0, []
    for unit in course.units:
        path = folder / course.notebook(unit).name
        if folder.is_symlink() or path.is_symlink() or not path.is_file():
            continue
        try:
            with open(path, "rb") as file, cells.in_time(READING):
                data = file.read(cells.LARGEST + 1)
                sources, _ = cells.sources(data)
        except ValueError as error:
            notes.append(f"{path.name}: {error}")
            continue
        arm = max(arm, handed_out(data, student, course)[0])
        stubs = _stubs(course, unit)
        for exercise in course.exercises(unit):
            last = None
            for source in sources:
                last = _definition(source, exercise.name) or last
            if last and ast.dump(ast.parse(last[0])) != stubs.get(exercise.name):
                found.append(Written(unit, exercise, *last))
    return found, arm, notes


def _stubs(course: Course, unit: str) -> dict[str, str]:
    """{exercise: syntax tree of what was handed out}, to tell what nobody wrote in."""
    released = notebook.student_version(notebook.read(course.notebook(unit)))
    stubs = {}
    for cell in released["cells"]:
        if notebook.is_solution(cell):
            name = cell["metadata"]["nbgrader"].get("grade_id", "")
            if found := _definition(cell["source"], name):
                stubs[name] = ast.dump(ast.parse(found[0]))
    return stubs


def _definition(source: str, name: str) -> tuple[str, int] | None:
    """(text, first line) of a function that a cell defines, None if it does not."""
    try:
        body = ast.parse(source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    for node in reversed(body):
        if isinstance(node, ast.FunctionDef) and node.name == name:
            first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            return "\n".join(source.split("\n")[first - 1 : node.end_lineno]), first
    return None


def _chosen(functions: list[Written], name: str | None, rng: np.random.Generator) -> Written | None:
    if name is not None:
        return next((one for one in functions if one.exercise.name == name), None)
    long = [one for one in functions if one.source.count("\n") >= WRITTEN] or functions
    return long[rng.integers(len(long))] if long else None


def _because(notes: list[str]) -> str:
    return f" ({'; '.join(notes)})" if notes else ""


# ---- the questions


def _numbers(course: Course, one: Written, rng: np.random.Generator) -> Question:
    """A special case if the exercise has some, else other numbers."""
    exercise = one.exercise
    edges = [edge for edge in exercise.edges if edge.draw is not None]
    edge = edges[rng.integers(len(edges))] if edges else None
    (row,) = _rows(course, one, rng, exercise.usual if edge is None else edge.text)
    case = f" ({_text(edge.text)})" if edge else ""
    return Question(
        f"<p>Your function is called with these numbers{case}:</p>{_call(exercise, row['args'])}"
        "<p>What does it return: which entries can you tell without a calculator, and which of your lines "
        "makes each of them so?</p>",
        f"<p>The right answer:</p>{_values(exercise, row['right'])}",
    )


def _mistake(course: Course, one: Written, rng: np.random.Generator) -> Question:
    """Somebody else's answer to other numbers: what did they do?"""
    exercise = one.exercise
    (row,) = _rows(course, one, rng, exercise.usual)
    told = {hint.key: hint.text for hint in exercise.hints}
    differ = [key for key in sorted(row["wrong"]) if key in told and row["wrong"][key] != row["right"]]
    if not differ:
        return Question(
            f"<p>Which mistake is made most easily in <code>{_text(exercise.name)}</code>, and how would you "
            "notice it?</p>",
            "".join(f"<p>{_text(text)}</p>" for text in told.values()) or "<p>No mistake is known.</p>",
        )
    key = differ[rng.integers(len(differ))]
    return Question(
        f"<p>Somebody else's function is called with</p>{_call(exercise, row['args'])}"
        f"<p>and returns</p>{_values(exercise, row['wrong'][key])}"
        "<p>It is wrong. What did they do? Which of your lines would you have to change to get the same?</p>",
        f"<p>{_text(told[key])}</p><p>The right answer:</p>{_values(exercise, row['right'])}",
    )


def _rows(course: Course, one: Written, rng: np.random.Generator, case: str) -> list[dict]:
    exercise = one.exercise
    rows = tables.rows(course, one.unit, exercise, exercise.least + 1, rng)
    return [next(row for row in reversed(rows) if row["case"] == case)]


def _call(exercise: Exercise, arguments: list) -> str:
    pairs = zip(exercise.arguments, arguments, strict=False)
    lines = (f"{name} = {_shown(value, len(name) + 3)}" for name, value in pairs)
    return f"<pre>{_text(chr(10).join(lines))}</pre>"


def _values(exercise: Exercise, parts: list) -> str:
    unit = f"   [{exercise.unit}]" if exercise.unit else ""
    return f"<pre>{_text(chr(10).join(_shown(part) for part in parts) + unit)}</pre>"


def _shown(value: object, indent: int = 0) -> str:
    """Four digits of anything that is an argument or an answer; further lines are indented."""
    if isinstance(value, dict) and len(value) == 1:
        ((what, name),) = value.items()
        return f"the {'robot' if what == 'robot' else 'forward kinematics of'} {name}"
    if isinstance(value, str):
        return repr(value)
    try:
        array = np.asarray(thaw([value])[0], dtype=float)
    except (TypeError, ValueError):
        return str(value)
    if array.ndim == 0:
        return f"{float(array):.4g}"
    return np.array2string(
        array, precision=4, suppress_small=True, threshold=60, max_line_width=90, prefix=" " * indent
    )


# ---- the pages


def _page(student: str, one: Written, asked: list[Question], course: Course, answers: bool) -> str:
    what = "Answers, for the instructor only" if answers else "Ten minutes about your own function"
    numbered = "\n".join(
        f"{one.first + number:4d}  {line}" for number, line in enumerate(one.source.split("\n"))
    )
    questions = "".join(
        f"<h2>{number}</h2>{question.text}"
        + (f"<section><h3>Answer</h3>{question.answer}</section>" if answers else "")
        for number, question in enumerate(asked, 1)
    )
    return (
        "<!doctype html><html lang='en'><head><meta charset='utf-8'>"
        f"<title>{_text(what)}: {_text(student)}</title><style>{STYLE}"
        "pre { background: #8881; padding: .6rem; overflow-x: auto; } section { border-left: 3px solid #888; "
        "padding-left: 1rem; }</style></head>"
        f"<body><h1>{_text(what)}</h1><p>{_text(student)}, <code>{_text(one.exercise.signature)}</code> in "
        f"{_text(course.notebook(one.unit).name)}; lines are numbered as in its cell</p>"
        f"<pre>{_text(numbered)}</pre>{questions}</body></html>\n"
    )


def _text(value: object) -> str:
    return html.escape(str(value))
