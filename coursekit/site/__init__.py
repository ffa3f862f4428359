"""The course as a folder that any web server shows. Instructors only, never in a release.

`write(out)` makes pages to read, with explorers that move:

    shown.py     what the students' notebooks show before anything is written in them
    pages.py     these notebooks as pages, and the index
    lite.py      JupyterLab with Python in the browser, if Pyodide's files are given
    wheels.py    the packages of that Python, and the check that none is missing
    compiled.py  what of them is compiled, so that it starts sooner
    reference.py the package, name by name
    notices.py   the licences of what is shipped
    tools.py     where the packages of requirements.txt lie, which only the building needs
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from ..classroom.author import release
from ..classroom.course import Course, the_course
from . import notices
from . import tools as tools


def write(out: Path, course: Course | None = None, pyodide: Path | None = None) -> str:
    """Write the site into a new folder and say what it holds.

    Parameters
    ----------
    out : Path
        The folder; it must not exist yet.
    course : Course, optional
        The one that ships, unless told otherwise.
    pyodide : Path, optional
        The files of Pyodide's release: with them the course also runs in the browser.

    Raises
    ------
    ValueError
        If the folder exists, if a package or a file for it is missing, if a notebook fails for another reason
        than an exercise that is not solved, or if the course imports what a browser's Python would not find.
    """
    from . import lite, pages

    out, course = Path(out), course or the_course()
    if out.exists():
        raise ValueError(f"{out} exists already: name a new folder")
    pages.formulas()  # is all there that the pages need? Nothing is begun otherwise
    if pyodide:
        lite.ready(pyodide)
    with tempfile.TemporaryDirectory() as folder:
        students, made = Path(folder) / "course", Path(folder) / "site"
        release.release(students, course)
        pages.write(students, made, course.title, run=lite.ADDRESS if pyodide else None)
        if pyodide:
            lite.write(students, pyodide, course.version, course.title, made / "run")
            notices.write(made, lite.SHIPPED)
            notices.say(made, lite.PYODIDE)
        out.absolute().parent.mkdir(parents=True, exist_ok=True)
        shutil.move(made, out)
    return f"wrote {out}: {_RUNS if pyodide else _READS}"


_READS = """pages to read, for any web server, or from the folder itself (index.html).
To let students also run the course in the browser, name Pyodide's files: --pyodide FOLDER, the unpacked
archive of its release 0.27.7"""
_RUNS = """pages to read, and "Run it here". For any web server with https; on this computer:
python -m http.server --directory FOLDER"""
