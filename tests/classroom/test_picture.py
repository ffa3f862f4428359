"""What a failing check shows beside its words."""

from __future__ import annotations

import dataclasses
import io

import nbformat
import numpy as np
import pytest
from nbclient import NotebookClient
from PIL import Image

from coursekit.classroom.check import examples_of, judged
from coursekit.classroom.course import the_course
from coursekit.classroom.exercises import looks
from coursekit.classroom.mistakes import Solved
from coursekit.classroom.picture import MARGIN, YOURS, picture
from coursekit.view.paint import PALETTE

COURSE = the_course()
SEEN = [(u, e) for u in COURSE.units for e in COURSE.exercises(u) if e.look]


def pictured(unit, exercise, function) -> bytes:
    examples = examples_of(exercise, COURSE.samples(unit)[exercise.name])
    found, attempts = judged(exercise, function, examples)
    return picture(exercise, found, examples, attempts)


def near(png: bytes, color: int, slack: int = 40) -> int:
    """Pixels of about this colour."""
    pixels = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), int)
    wanted = [color >> 16 & 255, color >> 8 & 255, color & 255]
    return int((np.abs(pixels - wanted).max(axis=-1) < slack).sum())


@pytest.mark.parametrize("unit, exercise", SEEN, ids=[e.name for _, e in SEEN])
def test_every_typical_mistake_can_be_drawn(unit, exercise, monkeypatch):
    monkeypatch.setattr("coursekit.classroom.verdict.repair", lambda *_: "")  # which is nothing to see
    pictures = [pictured(unit, exercise, f) for f in COURSE.wrong(unit)[exercise.name].values()]
    drawn = [png for png in pictures if png]
    assert len(drawn) >= len(pictures) / 2
    blends = PALETTE[YOURS], 0xDE8AB8  # opaque where lines cross, translucent elsewhere
    assert any(near(png, color) > 20 for png in drawn for color in blends)


def test_most_exercises_have_something_to_see():
    assert len(SEEN) >= 20


@pytest.mark.parametrize("name", ["elbow_angle", "lost_motion", "fk_poe"])
def test_what_the_colours_mean_stands_close_under_the_picture(name, monkeypatch):
    monkeypatch.setattr("coursekit.classroom.verdict.repair", lambda *_: "")
    unit, exercise = COURSE.find(name)
    for function in COURSE.wrong(unit)[name].values():
        if png := pictured(unit, exercise, function):
            inked = np.asarray(Image.open(io.BytesIO(png)).convert("L")).min(axis=1) < 250
            gaps = np.diff(np.flatnonzero(inked))
            assert gaps[gaps > 1][-1] <= 2 * MARGIN + 1


def test_what_cannot_be_drawn_is_left_out():
    unit, exercise = COURSE.find("home_pose")
    assert pictured(unit, exercise, lambda lengths: np.full((4, 4), np.nan)) == b""
    assert pictured(unit, exercise, lambda lengths: None) == b""
    assert pictured(unit, dataclasses.replace(exercise, look=None), lambda lengths: -np.eye(4)) == b""
    far = pictured(unit, exercise, lambda lengths: 1000 * Solved(unit).home_pose(lengths))
    assert near(far, PALETTE["x"]) > 20, "the right one is drawn at its own size"


def test_looks_put_things_where_they_are():
    T = Solved("nb02").home_pose([0.4, 0.45, 0.04, 0.45, 0.08])
    assert np.allclose(looks.pose((), T)["frames"][0], T)
    (line,) = looks.screws((), np.array([0, 0, 1, 0, -0.5, 0]))["lines"]
    assert np.allclose(line[0], [0.5, 0, 0]) and np.allclose(line[1], [0, 0, 1])
    q = Solved("nb06").quaternion(T[:3, :3])
    assert np.allclose(looks.from_quaternion((), q)["frames"][0][:3, :3], T[:3, :3])
    angles = Solved("nb06").zyx(T[:3, :3])
    assert np.allclose(looks.from_zyx((), np.array(angles))["frames"][0][:3, :3], T[:3, :3])


CELLS = """
import numpy as np
from coursekit import check
---
def home_pose(lengths):
    L1, L2, L3, L4, L5 = lengths
    M = np.eye(4)
    M[:3, 3] = [L4 + L5, 0, L1 + L2 - L3]
    return M
---
check("home_pose", home_pose)
---
check("home_pose", home_pose, show="more")
"""


def test_in_a_notebook_the_line_the_picture_and_the_buttons_are_there():
    cells = [nbformat.v4.new_code_cell(source.strip()) for source in CELLS.split("---")]
    document = nbformat.v4.new_notebook(cells=cells)
    NotebookClient(document, timeout=60, kernel_name="python3").execute(env=_environment())
    shown = document.cells[2].outputs
    assert "look at line 4: a sign" in shown[0]["text"], (
        "a cell keeps its text, and so line and edit are known"
    )
    kinds = {kind for output in shown[1:] for kind in output["data"]}
    assert {"image/png", "application/vnd.jupyter.widget-view+json"} <= kinds
    assert [output["output_type"] for output in document.cells[3].outputs] == ["stream"]


def _environment() -> dict:
    import os

    return {name: value for name, value in os.environ.items() if name != "CI"}
