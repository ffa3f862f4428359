"""`coursekit export nbgrader`: nbgrader generates the assignment, and grades right, wrong and untouched."""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from coursekit.classroom.author import nbgrader, notebook
from coursekit.classroom.course import Course, the_course
from tests.classroom.small import COURSE
from tests.needs import needed


@pytest.fixture
def short_course(tmp_path):
    """The first exercise of the first notebook: enough to see nbgrader grade it."""
    whole = the_course()
    source = whole.notebook("nb01")
    document = notebook.read(source)
    setup = next(c for c in document["cells"] if "setup" in notebook.tags(c))
    setup["source"] = "import numpy as np\n\nfrom coursekit import check"  # all that this exercise needs
    solution = next(c for c in document["cells"] if notebook.is_solution(c))
    check = next(c for c in document["cells"] if notebook.is_check(c))
    document["cells"] = [setup, solution, check]
    (tmp_path / "notebooks").mkdir()
    notebook.write(tmp_path / "notebooks" / source.name, document)
    for folder in ("exercises", "mistakes"):
        (tmp_path / folder).mkdir()
        shutil.copy(whole.classroom / folder / "nb01.py", tmp_path / folder)
    return Course(tmp_path / "notebooks", tmp_path)


def run(folder, *command):
    environment = {k: v for k, v in os.environ.items() if k != "CI"} | {"HOME": str(folder)}
    environment["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])  # alembic
    command = [sys.executable, "-m", "nbgrader", *command]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_nbgrader_generates_and_grades_it(tmp_path, short_course):
    needed("nbgrader")
    course = tmp_path / "course"
    nbgrader.export(course, short_course)
    path = short_course.notebook("nb01")
    name = path.stem
    run(course, "generate_assignment", name)
    released = (course / "release" / name / path.name).read_text("utf-8")
    assert "SOLUTION" not in released and "HIDDEN" not in released and "demand" not in released
    assert "raise NotImplementedError" in released

    text = json.dumps(notebook.read(path))
    handed_in = {"ann": text, "bob": text.replace("return np.array(", "return -np.array("), "cem": released}
    assert handed_in["bob"] != text
    for student, document in handed_in.items():
        folder = course / "submitted" / student / name
        folder.mkdir(parents=True)
        (folder / path.name).write_text(document, encoding="utf-8")
    run(course, "autograde", name)
    run(course, "export")
    with open(course / "grades.csv", newline="", encoding="utf-8") as file:
        points = {
            row["student_id"]: (float(row["score"]), float(row["max_score"])) for row in csv.DictReader(file)
        }
    assert points == {"ann": (2.0, 2.0), "bob": (0.0, 2.0), "cem": (0.0, 2.0)}


def test_the_export_warns_and_never_overwrites(tmp_path):
    nbgrader.export(tmp_path / "out", COURSE)
    assert "talk it into credit" in (tmp_path / "out" / "nbgrader_config.py").read_text("utf-8")
    with pytest.raises(ValueError, match="exists already"):
        nbgrader.export(tmp_path / "out", COURSE)
    shutil.rmtree(tmp_path / "out")


def test_hidden_tests_differ_from_the_public_examples(tmp_path):
    nbgrader.export(tmp_path / "out", COURSE)
    exported = notebook.read(tmp_path / "out" / "source" / "01_arm" / "01_arm.ipynb")
    public = COURSE.samples("nb01")["fk"]["examples"][0]["args"]
    cell = next(c for c in exported["cells"] if c["id"] == "check-fk")
    assert "BEGIN HIDDEN TESTS" in cell["source"]
    assert str(public[1]) not in cell["source"]
