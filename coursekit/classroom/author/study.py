"""`coursekit study`, for somebody who learns alone: the exercises in work/, the solutions one folder away."""

from __future__ import annotations

from pathlib import Path

from ..course import ROOT, Course, the_course
from .release import write_notebooks


def prepare(work: Path | None = None, course: Course | None = None) -> str:
    """Put the exercise version of every notebook that is missing there into `work`; says what was done.

    A notebook that is there already is yours: it is never overwritten.
    """
    work = work or ROOT / "work"
    written, kept = write_notebooks(course or the_course(), work)
    lines = [f"{work}: your exercises, which git ignores; the solved notebooks are in notebooks/"]
    if written:
        lines.append(f"new: {', '.join(written)}")
    if kept:
        lines.append(f"kept as you left them: {', '.join(kept)} (delete or rename one to start it afresh)")
    return "\n".join(lines)


def start(arguments: list[str]) -> None:
    """Prepare work/ and open it in JupyterLab."""
    from .. import lab

    work = ROOT / "work"
    print(prepare(work))
    # a folder of its own: what was open among the solved notebooks is not what was open here
    lab.start(arguments, notebooks=work, folder=ROOT / ".venv" / "study")
