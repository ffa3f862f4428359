"""`coursekit study`, for somebody who learns alone: the exercises in work/, the solutions one folder away."""

from __future__ import annotations

from pathlib import Path

from ..course import ROOT, Course, the_course
from .release import write_notebooks


def prepare(work: Path | None = None, course: Course | None = None) -> str:
    """Put the exercise version of every notebook that is missing there into `work`; says what was done.

    A notebook that is there already is yours: it is never overwritten.
    """
    course = course or the_course()
    work = work or _work(course)
    written, kept = write_notebooks(course, work, beside=False)
    solved = course.notebook(course.units[0]).parent
    lines = [f"{work}: your exercises, which git ignores; the solved notebooks are in {solved.name}/"]
    if written:
        lines.append(f"new: {', '.join(written)}")
    if kept:
        lines.append(f"kept as you left them: {', '.join(kept)} (delete or rename one to start it afresh)")
    return "\n".join(lines)


def start(arguments: list[str], course: Course | None = None) -> None:
    """Prepare work/ and open it in JupyterLab."""
    from .. import lab

    course = course or the_course()
    work = _work(course)
    print(prepare(work, course))
    # a folder of its own: what was open among the solved notebooks is not what was open here
    lab.start(arguments, notebooks=work, folder=ROOT / ".venv" / "study")


def _work(course: Course) -> Path:
    return ROOT / "work" if course == the_course() else course.notebooks / "work"
