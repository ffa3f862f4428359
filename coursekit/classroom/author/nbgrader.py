"""`coursekit export nbgrader OUT`: the course for an instructor who grades with nbgrader.

The notebooks carry nbgrader's metadata already. What is added are hidden tests: other inputs than the public
ones, with the right answers as numbers.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np

from ..course import TOML, Course, the_course
from ..your_course import YourCourse
from . import notebook, release, tables

WARNING = (
    "Warning: nbgrader runs its tests in the same process as the students' code. A notebook that patches\n"
    "numpy, the tests, or what they print can talk it into credit, and can read what the grading account\n"
    "can. `coursekit grade` withstands that; use this export where you trust everybody who hands in."
)

CONFIG = f"""# {WARNING.replace(chr(10), chr(10) + "# ")}
c = get_config()  # noqa: F821
c.CourseDirectory.course_id = "robot-kinematics"
c.ClearSolutions.code_stub = {{"python": {notebook.STUB!r}}}
c.ExecutePreprocessor.timeout = 60
"""

HIDDEN = """
### BEGIN HIDDEN TESTS
import json

from coursekit.classroom.check import demand

demand({name!r}, {name}, json.loads({table!r}))
### END HIDDEN TESTS"""


def export(out: Path, course: Course | None = None, seed: int = 0) -> None:
    """Write a course folder for nbgrader; ValueError if it exists. Students need coursekit installed."""
    course, out = course or the_course(), Path(out)
    if out.exists():
        raise ValueError(f"{out} exists already: name a new folder")
    out.mkdir(parents=True)
    (out / "nbgrader_config.py").write_text(CONFIG, encoding="utf-8")
    for unit in course.units:
        if not course.exercises(unit):
            continue
        path = course.notebook(unit)
        folder = out / "source" / path.stem
        folder.mkdir(parents=True)
        notebook.write(folder / path.name, _with_hidden_tests(course, unit, seed))
        if isinstance(course, YourCourse):
            _beside(course, unit, folder)


def _beside(course: YourCourse, unit: str, folder: Path) -> None:
    """What `check` reads in a course of one's own: nbgrader hands out the files of an assignment's folder."""
    paths = [course.exercises_path(unit), course.samples_path(unit), course.questions_path(unit)]
    mine = [path for path in paths if course.is_at_home(unit) and path.exists()]
    for path in [*mine, *(course.notebooks / name for name in course.files)]:
        copy = shutil.copytree if path.is_dir() else shutil.copy
        copy(path, folder / path.name)
    text = release.public_toml(course, [course.stem_of(unit)])
    (folder / TOML).write_text(text, encoding="utf-8", newline="\n")


def _with_hidden_tests(course: Course, unit: str, seed: int) -> dict:
    document = notebook.read(course.notebook(unit))
    exercises = {e.name: e for e in course.exercises(unit)}
    document["cells"] = [cell for cell in document["cells"] if "instructor" not in notebook.tags(cell)]
    for cell in document["cells"]:
        if cell["cell_type"] == "code":
            cell["outputs"], cell["execution_count"] = [], None
        if notebook.is_check(cell):
            name = cell["metadata"]["nbgrader"]["grade_id"].removeprefix("check-")
            exercise = exercises[name]
            rng = np.random.default_rng([seed, len(name), *name.encode()])
            rows = tables.rows(course, unit, exercise, max(exercise.n, exercise.least), rng)
            cell["source"] += HIDDEN.format(name=name, table=json.dumps(rows))
    return document
