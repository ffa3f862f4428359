"""`coursekit study`: exercises in work/, never overwritten; tracked files untouched."""

from __future__ import annotations

from coursekit.classroom import lab
from coursekit.classroom.author import notebook, release, study
from coursekit.classroom.course import the_course
from tests.classroom.small import COURSE, NAME, ROOT


def test_a_second_run_keeps_what_you_wrote_and_adds_what_is_missing(tmp_path):
    work = tmp_path / "work"
    assert f"new: {NAME}" in study.prepare(work, COURSE)
    assert "raise NotImplementedError" in (work / NAME).read_text("utf-8")
    mine = notebook.read(work / NAME)
    mine["cells"][2]["source"] = "my own work"
    notebook.write(work / NAME, mine)
    before = (work / NAME).read_bytes()
    text = study.prepare(work, COURSE)
    assert f"kept as you left them: {NAME}" in text and "new:" not in text
    assert (work / NAME).read_bytes() == before
    (work / NAME).rename(work / "mine.ipynb")
    assert f"new: {NAME}" in study.prepare(work, COURSE)
    assert (work / "mine.ipynb").read_bytes() == before


def test_it_opens_the_exercises_and_leaves_the_course_alone(tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr(study, "ROOT", tmp_path)
    monkeypatch.setattr(lab, "start", lambda *told, **more: opened.append((told, more)))
    solved = {p: p.read_bytes() for p in the_course().notebooks.glob("*.ipynb")}
    study.start(["--no-browser"])
    private = tmp_path / ".venv" / "study"  # not the one of the solved notebooks
    assert opened == [((["--no-browser"],), {"notebooks": tmp_path / "work", "folder": private})]
    assert {p.name for p in (tmp_path / "work").glob("*.ipynb")} == {p.name for p in solved}
    assert {p: p.read_bytes() for p in solved} == solved


def test_git_ignores_the_work():
    assert "/work/" in (ROOT / ".gitignore").read_text("utf-8").splitlines()
    assert release.ROOT == ROOT
