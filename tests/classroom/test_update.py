"""A corrected release in the middle of a term: everything is replaced but what the student wrote."""

from __future__ import annotations

import copy
import json
import os
import re
import shutil
import zipfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coursekit.__main__ import main
from coursekit.classroom import document, update
from coursekit.classroom.author import new, release
from coursekit.classroom.merge import merge
from coursekit.classroom.your_course import read

NAME = "notebooks/01_first_arm.ipynb"
MINE = "def tip(theta, lengths):\n    return np.zeros(2)  # I was here"
OUTPUT = [{"name": "stdout", "output_type": "stream", "text": ["my output\n"]}]


@pytest.fixture()
def course(tmp_path):
    new.new(tmp_path / "course")
    return tmp_path / "course"


@pytest.fixture()
def mine(tmp_path, course):
    """A student's folder, with an answer, a cell of their own, an output and a file of their own."""
    folder = tmp_path / "mine"
    release.release(folder, read(course))
    work = document.read(folder / NAME)
    cell(work, "tip")["source"] = MINE
    cell(work, "check-tip")["outputs"] = copy.deepcopy(OUTPUT)
    cell(work, "explorer")["outputs"] = copy.deepcopy(OUTPUT)
    own = {"cell_type": "code", "id": "1f2e", "metadata": {}, "source": "2 + 2", "outputs": OUTPUT}
    work["cells"].insert(place(work, "explorer") + 1, {**own, "execution_count": 7})
    document.write(folder / NAME, work)
    (folder / "notebooks" / "diary.txt").write_text("dear diary")
    return folder


def cell(notebook, name):
    return notebook["cells"][place(notebook, name)]


def place(notebook, name):
    return next(i for i, c in enumerate(notebook["cells"]) if c["id"] == name)


def corrected(course, tmp_path, change, version="2", out="new"):
    """A release of the course after `change(solved notebook)`."""
    path = course / "01_first_arm.ipynb"
    solved = document.read(path)
    change(solved)
    document.write(path, solved)
    if change is correct:  # the points stand in the exercise, too
        asked = course / "01_first_arm_exercises.py"
        asked.write_text(asked.read_text().replace("points=2", "points=5"))
    toml = (course / "course.toml").read_text().replace('version = "1"', f'version = "{version}"')
    (course / "course.toml").write_text(toml)
    release.release(tmp_path / out, read(course))
    return tmp_path / out


def correct(solved):
    cell(solved, "see")["source"] = "## See\n\nNow without the misprint."
    cell(solved, "explorer")["source"] = "view.explore(robots.planar_2r(0.5, 0.3))"
    cell(solved, "check-tip")["metadata"]["nbgrader"]["points"] = 5
    more = {"cell_type": "markdown", "id": "more", "metadata": {}, "source": "## And one more thing"}
    solved["cells"].append(more)
    del solved["cells"][place(solved, "your-turn")]


def test_it_replaces_everything_but_what_the_student_wrote(course, mine, tmp_path):
    told = update.update(corrected(course, tmp_path, correct), mine)
    after = document.read(mine / NAME)
    assert [c["id"] for c in after["cells"]] == [
        "title",
        "setup",
        "see",
        "explorer",
        "1f2e",
        "tip",
        "check-tip",
        "more",
    ]
    assert cell(after, "tip")["source"] == MINE
    assert cell(after, "1f2e")["source"] == "2 + 2" and cell(after, "1f2e")["outputs"] == OUTPUT
    assert cell(after, "1f2e")["execution_count"] == 7
    assert "misprint" in cell(after, "see")["source"]
    assert cell(after, "check-tip")["outputs"] == OUTPUT  # its code is the same
    assert cell(after, "explorer")["outputs"] == []  # that of another explorer
    assert (mine / "notebooks" / "diary.txt").read_text() == "dear diary"
    for line in (
        "version 2 of My course, 1 before",
        "changed: See, view.explore(robots.planar_2r(0.5, 0.3))",
        "new: And one more thing",
        "no longer there: Where is the tip?",
        "tip counts 5 points, 2 before",
        "kept: 1 cell you wrote in, 1 cell of your own",
    ):
        assert line in told, told


def test_it_can_be_undone_and_what_was_written_since_stays(course, mine, tmp_path):
    before = document.read(mine / NAME)
    files = {p: p.read_bytes() for p in mine.rglob("*") if p.is_file() and p.suffix != ".ipynb"}
    update.update(corrected(course, tmp_path, correct), mine)
    later = document.read(mine / NAME)
    cell(later, "tip")["source"] = MINE + "\n# and on Tuesday again"
    document.write(mine / NAME, later)
    assert "version 1 is back" in update.undo(mine)
    after = document.read(mine / NAME)
    assert [c["id"] for c in after["cells"]] == [c["id"] for c in before["cells"]]
    assert cell(after, "tip")["source"].endswith("on Tuesday again")
    assert cell(after, "see")["source"] == cell(before, "see")["source"]
    assert {p: p.read_bytes() for p in mine.rglob("*") if p.is_file() and p.suffix != ".ipynb"} == files
    with pytest.raises(ValueError, match="no update that could be undone"):
        update.undo(mine)


def test_a_second_run_changes_nothing(course, mine, tmp_path):
    fresh = corrected(course, tmp_path, correct)
    update.update(fresh, mine)
    before = (mine / NAME).read_bytes()
    assert "nothing changed" in update.update(fresh, mine)
    assert (mine / NAME).read_bytes() == before
    assert "version 1 is back" in update.undo(mine)  # the first one can still be undone


def test_a_release_over_a_folder_brings_it_up_to_date(course, mine, tmp_path):
    def change(solved):
        cell(solved, "see")["source"] = "## See, corrected"

    corrected(course, tmp_path, change, out="mine")
    after = document.read(mine / NAME)
    assert cell(after, "see")["source"] == "## See, corrected" and cell(after, "tip")["source"] == MINE


def test_where_both_changed_a_cell_both_stand_there(course, mine, tmp_path):
    work = document.read(mine / NAME)
    cell(work, "explorer")["source"] = "view.explore(robots.ur5())"
    document.write(mine / NAME, work)
    told = update.update(corrected(course, tmp_path, correct), mine)
    after = document.read(mine / NAME)
    where = place(after, "explorer")
    assert after["cells"][where]["source"] == "view.explore(robots.planar_2r(0.5, 0.3))"
    assert after["cells"][where + 1]["source"].endswith("view.explore(robots.ur5())")
    assert "both stand there now: view.explore" in told
    assert len({c["id"] for c in after["cells"]}) == len(after["cells"])


def test_what_the_student_changed_and_the_release_did_not_stays(course, mine, tmp_path):
    """The answer to a question stands in a cell that is nobody's solution."""
    work = document.read(mine / NAME)
    cell(work, "setup")["source"] += "\nimport math"
    document.write(mine / NAME, work)
    update.update(corrected(course, tmp_path, correct), mine)
    assert cell(document.read(mine / NAME), "setup")["source"].endswith("import math")


def test_an_exercise_that_is_asked_otherwise_is_told(course, mine, tmp_path):
    def change(solved):
        source = cell(solved, "tip")["source"]
        cell(solved, "tip")["source"] = source.replace("theta, lengths", "theta, lengths, base")

    told = update.update(corrected(course, tmp_path, change), mine)
    assert "asked otherwise now, what you wrote is kept: look whether it fits: tip" in told
    assert cell(document.read(mine / NAME), "tip")["source"] == MINE


def test_a_stub_that_nobody_wrote_in_is_replaced(course, mine, tmp_path):
    work = document.read(mine / NAME)
    fresh = document.read(course / "01_first_arm.ipynb")
    cell(work, "tip")["source"] = "def tip(theta, lengths):\n    pass"
    work["metadata"]["coursekit"]["cells"]["tip"] = document.digest(cell(work, "tip")["source"])
    document.write(mine / NAME, work)

    def change(solved):
        cell(solved, "tip")["source"] = cell(fresh, "tip")["source"].replace("x and y", "X and Y")

    update.update(corrected(course, tmp_path, change), mine)
    assert "X and Y" in cell(document.read(mine / NAME), "tip")["source"]


def test_work_is_kept_where_its_exercise_goes(course, mine, tmp_path):
    def change(solved):
        solved["cells"] = [c for c in solved["cells"] if "tip" not in c["id"]]

    (course / "01_first_arm_exercises.py").write_text("EXERCISES = []\n")
    (course / "01_first_arm_mistakes.py").write_text("WRONG = {}\n")
    told = update.update(corrected(course, tmp_path, change), mine)
    assert "tip (yours is kept)" in told
    assert MINE in [c["source"] for c in document.read(mine / NAME)["cells"]]


def test_a_copied_cell_is_the_students(course, mine, tmp_path):
    """JupyterLab copies the metadata along, and gives a new id."""
    work = document.read(mine / NAME)
    twin = {**copy.deepcopy(cell(work, "tip")), "id": "9a8b", "source": "def tip(theta, lengths): return 1"}
    work["cells"].insert(place(work, "tip"), twin)
    document.write(mine / NAME, work)
    update.update(corrected(course, tmp_path, correct), mine)
    sources = [c["source"] for c in document.read(mine / NAME)["cells"]]
    assert MINE in sources and twin["source"] in sources


def test_an_editor_that_loses_ids_and_notes_loses_no_work(course, mine, tmp_path):
    work = document.read(mine / NAME)
    for one in work["cells"]:
        del one["id"]
    del work["metadata"]["coursekit"]
    (mine / NAME).write_text(json.dumps(work))
    update.update(corrected(course, tmp_path, correct), mine)
    after = document.read(mine / NAME)
    sources = [c["source"] for c in after["cells"]]
    assert MINE in sources and "2 + 2" in sources
    assert cell(after, "tip")["source"] == MINE


def test_a_zip_and_one_folder_of_a_class_will_do(course, mine, tmp_path):
    fresh = corrected(course, tmp_path, correct)
    shutil.make_archive(tmp_path / "new", "zip", tmp_path, fresh.name)
    assert "version 2" in update.update(tmp_path / "new.zip", mine)


def test_a_notebook_that_goes_is_kept(course, mine, tmp_path):
    (course / "02_second.ipynb").write_text((course / "01_first_arm.ipynb").read_text())
    for old in ("exercises", "mistakes", "samples"):
        (course / f"01_first_arm_{old}.{'json' if old == 'samples' else 'py'}").rename(
            course / f"02_second_{old}.{'json' if old == 'samples' else 'py'}"
        )
    toml = (course / "course.toml").read_text()
    (course / "course.toml").write_text(toml.replace("01_first_arm", "02_second"))
    before = (mine / NAME).read_bytes()
    release.release(tmp_path / "new", read(course))
    told = update.update(tmp_path / "new", mine)
    assert "02_second.ipynb: new" in told
    assert "01_first_arm.ipynb: no longer part of the course; yours is kept" in told
    assert (mine / NAME).read_bytes() == before
    assert not (mine / "notebooks" / "01_first_arm_exercises.py").exists()


# ---- what is refused, with nothing changed


def refused(mine, source, match):
    before = {p: p.read_bytes() for p in mine.rglob("*") if p.is_file()}
    with pytest.raises(ValueError, match=match) as caught:
        update.update(source, mine)
    assert "\n" not in str(caught.value)
    assert {p: p.read_bytes() for p in mine.rglob("*") if p.is_file()} == before


@pytest.mark.skipif(os.name == "nt", reason="links are made otherwise on Windows")
@pytest.mark.parametrize(
    "place", ["notebook", "folder of notebooks", "release.json", "kept", "listed", "pipe"]
)
def test_no_link_is_followed(course, mine, tmp_path, place):
    """On a hub an instructor brings folders up to date in which students write, with rights of their own."""
    new = corrected(course, tmp_path, correct)
    elsewhere = tmp_path / "classmate"
    shutil.copytree(mine, elsewhere)
    (elsewhere / "before").mkdir()
    (elsewhere / "before" / "x").write_text("hers")
    before = {path: path.read_bytes() for path in elsewhere.rglob("*") if path.is_file()}
    at = {
        "notebook": Path(NAME),
        "folder of notebooks": Path("notebooks"),
        "release.json": Path("release.json"),
        "kept": Path(".coursekit"),
        "listed": Path("away"),
        "pipe": Path(NAME),
    }[place]
    if (mine / at).is_dir():
        shutil.rmtree(mine / at)
    (mine / at).unlink(missing_ok=True)
    if place == "pipe":
        os.mkfifo(mine / at)
    else:
        (mine / at).symlink_to(elsewhere if place in ("kept", "listed") else elsewhere / at)
    if place == "listed":
        listed = json.loads((mine / "release.json").read_text())
        (mine / "release.json").write_text(
            json.dumps({**listed, "files": [*listed["files"], "away/before/x"]})
        )
    with pytest.raises(ValueError, match=f"{re.escape(str(mine / at))} is a link or no file"):
        update.update(new, mine)
    assert {path: path.read_bytes() for path in elsewhere.rglob("*") if path.is_file()} == before


@pytest.mark.skipif(os.name == "nt", reason="links are made otherwise on Windows")
def test_a_link_where_a_file_is_written_beside_is_removed(course, mine, tmp_path):
    (tmp_path / "hers").write_text("hers")
    (mine / NAME).with_name(f".{Path(NAME).name}.new").symlink_to(tmp_path / "hers")
    update.update(corrected(course, tmp_path, correct), mine)
    assert (tmp_path / "hers").read_text() == "hers"


def test_an_older_release_is_refused(course, mine, tmp_path):
    fresh = corrected(course, tmp_path, correct, version="1.10")
    old = tmp_path / "old"
    shutil.copytree(mine, old)
    update.update(fresh, mine)
    refused(mine, old, r"release\.json, version: 1 is older than the 1\.10 that")


def test_a_notebook_newer_than_the_release_is_refused(course, mine, tmp_path):
    fresh = corrected(course, tmp_path, correct, version="2")
    work = document.read(mine / NAME)
    work["metadata"]["coursekit"]["version"] = "3"
    document.write(mine / NAME, work)
    refused(
        mine, fresh, r"01_first_arm\.ipynb, metadata\.coursekit\.version: .* of version 3, newer than the 2"
    )


def test_another_course_is_refused(course, mine, tmp_path):
    toml = (course / "course.toml").read_text().replace("My course", "Another")
    (course / "course.toml").write_text(toml)
    release.release(tmp_path / "other", read(course))
    refused(mine, tmp_path / "other", r"release\.json, title: that is a release of 'Another'")


@pytest.mark.parametrize("text", ["", "[]", '{"title": "x"}'])
def test_what_is_no_release_is_refused(text, mine, tmp_path):
    refused(mine, tmp_path / "nowhere", "does not exist")
    (tmp_path / "some").mkdir()
    refused(mine, tmp_path / "some", "is no release")
    (tmp_path / "some" / "release.json").write_text(text)
    refused(mine, tmp_path / "some", "is damaged")
    (tmp_path / "some.zip").write_text("no zip")
    refused(mine, tmp_path / "some.zip", "is no zip")
    with zipfile.ZipFile(tmp_path / "empty.zip", "w"):
        pass
    refused(mine, tmp_path / "empty.zip", "is no release")


def test_a_damaged_notebook_stops_it_before_anything_is_written(course, mine, tmp_path):
    fresh = corrected(course, tmp_path, correct)
    (mine / NAME).write_text("{")
    refused(mine, fresh, r"01_first_arm\.ipynb is no notebook")


def test_a_run_that_is_cut_off_can_be_undone(course, mine, tmp_path, monkeypatch):
    before = document.read(mine / NAME)
    fresh = corrected(course, tmp_path, correct)
    replaced = []

    def three(source, target, really=update.os.replace):
        replaced.append(target)
        if len(replaced) == 3:
            raise OSError("disk full")
        really(source, target)

    monkeypatch.setattr(update.os, "replace", three)
    with pytest.raises(OSError, match="disk full"):
        update.update(fresh, mine)
    monkeypatch.undo()
    update.undo(mine)
    assert document.read(mine / NAME)["cells"] == before["cells"]
    assert json.loads((mine / "release.json").read_text())["version"] == "1"


def test_the_commands(course, mine, tmp_path, capsys):
    fresh = corrected(course, tmp_path, correct)
    assert main(["update", str(fresh), "--folder", str(mine)]) == 0
    assert "version 2 of My course" in capsys.readouterr().out
    assert main(["update", "--undo", "--folder", str(mine)]) == 0
    assert main(["update", "--folder", str(mine)]) == 2
    assert main(["update", str(fresh), "--undo", "--folder", str(mine)]) == 2
    assert "name the corrected release" in capsys.readouterr().err


# ---- whatever both sides do


def released(names):
    """A released notebook: text, code, an exercise for each name that begins with e."""
    cells = []
    for name in names:
        role = {"nbgrader": {"grade_id": name, "solution": True}} if name.startswith("e") else {}
        kind = "markdown" if name.startswith("t") else "code"
        cells.append({"cell_type": kind, "id": name, "metadata": role, "source": f"released {name}"})
        if kind == "code":
            cells[-1] |= {"outputs": [], "execution_count": None}
    return {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


NAMES = [f"{kind}{number}" for kind in "tce" for number in range(4)]
EDITS = st.lists(st.tuples(st.sampled_from(["write", "add", "delete", "move", "copy"]), st.integers(0, 30)))


def edited(notebook, edits):
    """A student at work; returns what they wrote."""
    wrote = []
    for step, (what, where) in enumerate(edits):
        cells = notebook["cells"]
        if what == "add" or not cells:
            text = f"own {step}"
            cells.insert(
                where % (len(cells) + 1),
                {"cell_type": "raw", "id": f"x{step}", "metadata": {}, "source": text},
            )
            wrote.append(text)
            continue
        at = where % len(cells)
        if what == "write":
            if cells[at]["source"] in wrote:
                wrote.remove(cells[at]["source"])
            cells[at]["source"] = f"wrote {step}"
            wrote.append(f"wrote {step}")
        elif what == "delete":
            gone = cells.pop(at)["source"]
            if gone in wrote:
                wrote.remove(gone)
        elif what == "move":
            cells.append(cells.pop(at))
        else:
            twin = {**copy.deepcopy(cells[at]), "id": f"y{step}"}
            cells.insert(at, twin)
            if twin["source"] in wrote:
                wrote.append(twin["source"])
    return wrote


@settings(suppress_health_check=[HealthCheck.too_slow])  # the machine may be busy
@given(
    st.lists(st.sampled_from(NAMES), unique=True),
    st.lists(st.sampled_from(NAMES), unique=True),
    st.sets(st.sampled_from(NAMES)),
    EDITS,
    EDITS,
    st.booleans(),
)
def test_nothing_that_a_student_wrote_is_ever_lost(before, after, corrected_, edits, later, forgetful):
    """Not by an update, not by undoing it after more work; and what the release says is all there."""
    mine, new = released(before), released(after)
    for one in new["cells"]:
        one["source"] += " corrected" * (one["id"] in corrected_)
    document.stamp(mine, "1")
    document.stamp(new, "2")
    wrote = edited(mine, edits)
    if forgetful:  # some editors drop what they do not know
        del mine["metadata"]["coursekit"]
    merged, _ = merge(mine, new)
    sources = [c["source"] for c in merged["cells"]]
    assert all(any(text in source for source in sources) for text in wrote)
    ids = [c["id"] for c in merged["cells"]]
    assert len(set(ids)) == len(ids)
    for one in new["cells"]:
        assert one["id"] in ids
        if not document.is_solution(one) and one["id"] in corrected_:
            assert one["source"] in sources
    assert merge(merged, new)[0] == merged  # a second time changes nothing
    wrote = edited(merged, later)
    if forgetful:
        del merged["metadata"]["coursekit"]
    back, _ = merge(merged, mine)
    sources = [c["source"] for c in back["cells"]]
    assert all(any(text in source for source in sources) for text in wrote)
