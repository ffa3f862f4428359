"""The course as a folder that any web server shows. Instructors only, never in a release.

`write(out)` makes pages to read, with explorers that move:

    shown.py     what the students' notebooks show before anything is written in them
    pages.py     these notebooks as pages, and the index
    notices.py   the licences of what is shipped

It needs the packages of requirements.txt in this folder, on top of environment.txt.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from ..classroom.author import release
from ..classroom.course import Course, the_course


def write(out: Path, course: Course | None = None) -> str:
    """Write the site into a new folder and say what it holds.

    Raises
    ------
    ValueError
        If the folder exists, if a package for it is missing, or if a notebook fails for another reason than
        an exercise that is not solved.
    """
    from . import pages

    out, course = Path(out), course or the_course()
    if out.exists():
        raise ValueError(f"{out} exists already: name a new folder")
    pages.formulas()  # is all there that the pages need? Nothing is begun otherwise
    with tempfile.TemporaryDirectory() as folder:
        students = Path(folder) / "course"
        release.release(students, course)
        made = Path(folder) / "site"
        pages.write(students, made, course.title)
        shutil.move(made, out)
    return f"wrote {out}: pages to read, for any web server or from the folder itself (index.html)"
