"""Downloads shaped as the learning platforms document their names, sorted into folders of students."""

from __future__ import annotations

import csv
import io
import json
import os
import warnings
import zipfile
from pathlib import Path

import pytest

from coursekit.classroom import roster
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import collect, naming

NAMES = [the_course().notebook(unit).name for unit in the_course().units]
DH, MSB = NAMES[:2]
ROSTER = """id,name,email,aliases
s001,"Lee, Ann",ann.lee@uni.edu,
s002,José Müller,jose@uni.edu,bitdiddle
s003,Ann Marie Curie,curie@uni.edu,
s004,Zoë Nobody,zoe@uni.edu,
"""


@pytest.fixture
def people(tmp_path):
    (tmp_path / "roster.csv").write_text(ROSTER, encoding="utf-8")
    return tmp_path / "roster.csv"


def notebook(text):
    return f'{{"cells": [], "text": "{text}"}}'.encode()


def tree(folder, files):
    for number, (path, data) in enumerate(files.items()):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
        os.utime(folder / path, (1_700_000_000 + number, 1_700_000_000 + number))
    return folder


def zipped(files):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path, content in files.items():
            archive.writestr(path, content)
    return data.getvalue()


def collected(out):
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*.ipynb")}


CANVAS = {
    f"leeann_4711_88001_{DH}": notebook("first"),
    "leeann_4711_88093_01_dh_vs_poe-1.ipynb": notebook("second"),
    "leeann_LATE_4711_88094_02_msb_derivation (1).ipynb": notebook("late"),
    f"müllerjosé_4712_88002_{DH}": notebook("jose"),
    "curieannmarie_4713_88003_homework.zip": zipped({f"homework/{DH}": notebook("zipped")}),
    f"strangersome_4714_88004_{DH}": notebook("who?"),
    "leeann_4711_88095_essay.ipynb": notebook("no notebook of ours"),
}


@pytest.mark.parametrize("form", ["folder", "zip"])
def test_canvas(tmp_path, people, form):
    source = tree(tmp_path / "in", CANVAS)
    if form == "zip":
        (tmp_path / "submissions.zip").write_bytes(zipped(CANVAS))
        source = tmp_path / "submissions.zip"
    said = collect.collect(source, tmp_path / "out", people)
    assert collected(tmp_path / "out") == {
        f"s001/{DH}": notebook("second"),
        f"s001/{MSB}": notebook("late"),
        f"s002/{DH}": notebook("jose"),
        f"s003/{DH}": notebook("zipped"),
    }
    assert "4 notebooks of 3 students" in said
    assert "NOT COLLECTED, nobody has these (2)" in said
    assert "nobody in the roster is called strangersome or 4714" in said
    assert "none of the course's notebooks is called essay.ipynb" in said
    assert f"leeann_4711_88001_{DH}: leeann_4711_88093_01_dh_vs_poe-1.ipynb is later" in said
    assert "handed in nothing (1):\n    s004" in said
    table = collect.read_table(tmp_path / "out")
    assert [(row["student"], row["canvas"], row["late"]) for row in table][:2] == [
        ("s001", "4711", ""),
        ("s001", "4711", "late"),
    ]


def test_an_underscore_in_a_name(tmp_path):
    source = tree(tmp_path / "in", {"lee_ann_LATE_12345_67890_01_dh_vs_poe-1.ipynb": notebook("x")})
    collect.collect(source, tmp_path / "out")
    assert collected(tmp_path / "out") == {f"lee_ann/{DH}": notebook("x")}


MOODLE = {
    f"Ann Lee_123456_assignsubmission_file_/{DH}": notebook("ann"),
    "José Müller_123457_assignsubmission_file_/work.zip": zipped(
        {DH: notebook("jose"), f"__MACOSX/._{DH}": b"?", f".ipynb_checkpoints/{DH}": notebook("old")}
    ),
    f"Ann Marie Curie_123458_assignsubmission_file_{MSB}": notebook("flat"),
}


@pytest.mark.parametrize("inside", ["", "Robotics-Task 1-2041/"])
def test_moodle(tmp_path, people, inside):
    (tmp_path / "in.zip").write_bytes(zipped({inside + path: data for path, data in MOODLE.items()}))
    said = collect.collect(tmp_path / "in.zip", tmp_path / "out", people)
    assert collected(tmp_path / "out") == {
        f"s001/{DH}": notebook("ann"),
        f"s002/{DH}": notebook("jose"),
        f"s003/{MSB}": notebook("flat"),
    }
    assert "NOT COLLECTED" not in said
    assert {row["moodle"] for row in collect.read_table(tmp_path / "out")} == {"123456", "123457", "123458"}


def test_nbgraders_exchange_takes_the_latest(tmp_path, people):
    files = {
        f"inbound/bitdiddle+robotics+2026-11-02 15:58:23.948203 UTC/{DH}": notebook("early"),
        f"inbound/bitdiddle+robotics+2026-11-03 08:00:00.000000 UTC+3f2a/{DH}": notebook("late"),
        f"inbound/s001+robotics+2026-11-01 10:00:00.000000 UTC/{DH}": notebook("ann"),
    }
    collect.collect(tree(tmp_path / "in", files), tmp_path / "out", people)
    assert collected(tmp_path / "out") == {f"s001/{DH}": notebook("ann"), f"s002/{DH}": notebook("late")}
    times = {row["student"]: row["submitted"] for row in collect.read_table(tmp_path / "out")}
    assert times == {"s001": "2026-11-01 10:00:00", "s002": "2026-11-03 08:00:00"}


@pytest.mark.parametrize("top", ["submitted/", ""])
def test_nbgraders_own_folders_and_plain_ones(tmp_path, top):
    files = {f"{top}ann/robotics/{DH}": notebook("a"), f"{top}bob/robotics/{DH}": notebook("b")}
    collect.collect(tree(tmp_path / "in", files), tmp_path / "out")
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("a"), f"bob/{DH}": notebook("b")}


def test_a_zip_of_each_student_and_what_the_site_writes(tmp_path, people):
    """One zip a student, named by them; or a zip of another name with notebooks that know whose they are."""
    own = b'{"cells": [], "metadata": {"coursekit": {"student": "s003"}}}'
    files = {
        "ann.lee.zip": zipped({f"notebooks/{DH}": notebook("ann"), "notebooks/student.json": b"{}"}),
        "robot-kinematics-2026-11-26.zip": zipped({f"notebooks/{DH}": own}),
    }
    collect.collect(tree(tmp_path / "in", files), tmp_path / "out", people)
    assert collected(tmp_path / "out") == {f"s001/{DH}": notebook("ann"), f"s003/{DH}": own}


def test_of_one_name_twice_in_a_zip_the_last_counts_and_no_time_is_invented(tmp_path):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive, warnings.catch_warnings(action="ignore"):
        for place, text in ((DH, "first"), (DH, "last"), (f"old/{DH}", "beside")):
            archive.writestr(zipfile.ZipInfo(place), notebook(text))
    said = collect.collect(tree(tmp_path / "in", {"ann.zip": data.getvalue()}), tmp_path / "out")
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("last")}
    assert said.count("has the same time, and counts") == 2


def test_nobody_hands_in_for_a_classmate(tmp_path, people):
    """What lies in somebody's folder or zip is theirs, whatever names it bears."""
    forged = {
        f"ann.lee/jose_1_999999_{DH}": notebook("ann 1"),
        f"curie/s002+hw+2099-01-01 00:00:00 UTC/{MSB}": notebook("curie 1"),
        "zoe@uni.edu.zip": zipped({f"José Müller_7_assignsubmission_file_/{DH}": notebook("zoe")}),
        f"week 2/jose_1_2_{DH}": notebook("jose"),
    }
    collect.collect(tree(tmp_path / "in", forged), tmp_path / "out", people)
    assert collected(tmp_path / "out") == {
        f"s001/{DH}": notebook("ann 1"),
        f"s003/{MSB}": notebook("curie 1"),
        f"s004/{DH}": notebook("zoe"),
        f"s002/{DH}": notebook("jose"),
    }
    assert all("2099" not in row["submitted"] for row in collect.read_table(tmp_path / "out"))


def test_nobody_hands_in_for_a_classmate_by_what_the_notebook_says(tmp_path, people):
    """A classmate's id in the notebook of somebody who is not in the roster does not take her place."""
    hers, forged, alone = (
        json.dumps({"cells": [], "n": n, "metadata": {"coursekit": {"student": whose}}}).encode()
        for n, whose in enumerate(("s001", "s001", "s002"))
    )
    files = {
        f"leeann_1_2_{DH}": hers,
        f"guest_7_999_{DH}": forged,
        f"guest_7_998_{MSB}": alone,
    }
    said = collect.collect(tree(tmp_path / "in", files), tmp_path / "out", people)
    assert collected(tmp_path / "out") == {f"s001/{DH}": hers, f"s002/{MSB}": alone}
    assert f"guest_7_999_{DH}: leeann_1_2_{DH} says in its name whose it is" in said
    assert f"guest_7_998_{MSB}: taken for s002's" in said, "a person has to look"


def test_what_an_update_kept_is_no_attempt(tmp_path):
    """In a zip both may have the same time: it counts in steps of two seconds."""
    both = {f".coursekit/before/notebooks/{DH}": notebook("old"), f"notebooks/{DH}": notebook("new")}
    said = collect.collect(tree(tmp_path / "in", {"ann.zip": zipped(both)}), tmp_path / "out")
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("new")} and "older" not in said


def test_names_of_two_platforms_in_one_folder_can_be_compared(tmp_path):
    files = {
        f"ann/ann+hw+2026-01-01 10:00:00 UTC/{DH}": notebook("1"),
        f"ann/ann_12_34_{DH}": notebook("2"),
        f"bob/{DH}": notebook("3"),
    }
    said = collect.collect(tree(tmp_path / "in", files), tmp_path / "out")
    assert sorted(collected(tmp_path / "out")) == [f"ann/{DH}", f"bob/{DH}"]
    assert "older, left out (1)" in said


def test_a_name_too_long_for_a_folder_is_shortened(tmp_path):
    """A folder's name has 255 bytes, and a letter of an old script takes four of them."""
    (tmp_path / "in.zip").write_bytes(
        zipped({f"{chr(0x10330) * 70}/{DH}": notebook("1"), f"bob/{DH}": notebook("2")})
    )
    collect.collect(tmp_path / "in.zip", tmp_path / "out")
    assert len(collected(tmp_path / "out")) == 2


def test_vowels_of_other_scripts_tell_names_apart_and_accents_do_not(tmp_path):
    names = {"s1": "\u0915", "s2": "\u0915\u093f", "s3": "\u0e19\u0e32", "s4": "\u0e19\u0e49\u0e33"}
    names |= {"s5": "\u0643\u064e\u062a\u064e\u0628", "s6": "Zo\u00eb"}
    rows = "".join(f"{number},{name},\n" for number, name in names.items())
    (tmp_path / "roster.csv").write_text(f"id,name,email\n{rows}", encoding="utf-8")
    written = {**names, "s5": "\u0643\u062a\u0628", "s6": "zoe"}
    files = {f"{name}_{k}_{k}_{DH}": notebook(str(k)) for k, name in enumerate(written.values())}
    collect.collect(tree(tmp_path / "in", files), tmp_path / "out", tmp_path / "roster.csv")
    assert collected(tmp_path / "out") == {f"s{k + 1}/{DH}": notebook(str(k)) for k in range(6)}


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
@pytest.mark.parametrize("what", ["read_bytes", "is_dir"])
def test_a_file_that_may_not_be_read_is_listed_and_the_rest_is_collected(tmp_path, monkeypatch, what):
    source = tree(tmp_path / "in", {f"ann/{DH}": notebook("a"), f"bob/{DH}": notebook("b")})
    does = getattr(Path, what)

    def refuse(path):
        if "bob" in path.parts and path.suffix:
            raise PermissionError(13, "Permission denied")
        return does(path)

    monkeypatch.setattr(Path, what, refuse)  # root may read everything
    said = collect.collect(source, tmp_path / "out")
    monkeypatch.undo()
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("a")}
    assert f"bob/{DH}: cannot be read (Permission denied)" in said


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
def test_a_folder_that_may_not_be_listed_is_told(tmp_path, monkeypatch):
    source = tree(tmp_path / "in", {f"ann/{DH}": notebook("a"), f"bob/{DH}": notebook("b")})
    monkeypatch.setattr(os, "access", lambda path, how: Path(path).name != "bob")  # root may list everything
    assert "bob: a folder that may not be listed" in collect.collect(source, tmp_path / "out")


def test_nobodys_name_stops_the_others_or_opens_a_formula(tmp_path):
    files = {
        f"Collected.csv/{DH}": notebook("1"),
        f"collected.csv/{MSB}": notebook("2"),
        f"bob;=1+1;x/{DH}": notebook("3"),
        f"cem+hw+2026-02-31 00:00:00/{DH}": notebook("4"),
        "dan.zip": zipped({f"01_dh_vs_poe{' ' * 60_000}x.ipynb": notebook("5")}),
    }
    said = collect.collect(tree(tmp_path / "in", files), tmp_path / "out")
    assert said.count("a number in this name cannot be") == said.count("could hold this name") == 1
    assert {path.split("/")[0] for path in collected(tmp_path / "out")} == {
        "_Collected.csv",
        "_collected.csv",
        "bob;=1+1;x",
    }
    assert '"bob;=1+1;x"' in (tmp_path / "out" / collect.TABLE).read_text("utf-8-sig")


def test_what_cannot_be_read_is_listed_and_the_rest_is_collected(tmp_path):
    deep = notebook("deep")
    for _ in range(6):
        deep = zipped({"more.zip": deep})
    files = {
        f"ann/{DH}": notebook("a"),
        "bob/broken.zip": b"PK\x03\x04 no zip",
        "cem/work.rar": b"Rar!",
        "dan/deep.zip": deep,
        f"eve/{MSB}.zip": zipped({MSB: b" " * 21_000_000}),
    }
    source = tree(tmp_path / "in", files)
    (source / "fay").mkdir()
    (source / "fay" / DH).symlink_to(source / "ann" / DH)
    said = collect.collect(source, tmp_path / "out")
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("a")}
    for text in ("broken.zip", "work.rar", "deep.zip", f"{MSB}: too large", f"fay/{DH}: a link"):
        assert text in said


def test_somebodys_zip_holds_no_more_than_a_class_could_bear(tmp_path, monkeypatch):
    monkeypatch.setattr(collect, "UNPACKED", 100_000)
    inner = zipped({f"{k}.ipynb": notebook("x") for k in range(20)})
    files = {
        f"ann/{DH}": notebook("a"),
        "bob.zip": zipped({f"{k}.zip": inner for k in range(9)}),
        "cem.zip": zipped({DH: notebook("c")}),
    }
    said = collect.collect(tree(tmp_path / "in", files), tmp_path / "out")
    assert collected(tmp_path / "out") == {f"ann/{DH}": notebook("a"), f"cem/{DH}": notebook("c")}
    assert "bob.zip: cannot be read (too much in it" in said
    assert said.count("none of the course's notebooks") < 60


def test_what_is_no_notebook_is_listed_unless_a_notebook_lies_beside_it(tmp_path):
    """Browsers save a notebook as text; macOS writes an umlaut in two letters; a name may be a formula."""
    files = {
        f"ann/{DH}.txt": notebook("a"),
        "ann/README.md": b"of the release",
        "bob/essay.pdf": b"%PDF",
        "bob/home/photo.jpg": b"jpg",
        "cem/.DS_Store": b"",
        f"Mu\u0308ller/{DH}": notebook("1"),
        f"M\u00fcller/{MSB}.json": notebook("2"),
        f"=1+1/{DH}": notebook("3"),
        "eve/\x1b[2J.pdf": b"wipes a terminal",
        "M\udcfcller.txt": b"a name in other letters",
    }
    said = collect.collect(tree(tmp_path / "in", files), tmp_path / "out")
    assert collected(tmp_path / "out") == {
        f"ann/{DH}": notebook("a"),
        f"M\u00fcller/{DH}": notebook("1"),
        f"M\u00fcller/{MSB}": notebook("2"),
        f"_=1+1/{DH}": notebook("3"),
    }
    listed = ["    M?ller.txt", "    bob: essay.pdf, photo.jpg", "    eve: ?[2J.pdf"]
    assert said.endswith("\n".join(["no notebook, left aside (3):", *listed]))
    assert f"'=1+1/{DH}" in (tmp_path / "out" / collect.TABLE).read_text("utf-8-sig")


@pytest.mark.parametrize("fault", [KeyboardInterrupt(), OSError(28, "No space left on device"), None])
def test_what_is_interrupted_leaves_nothing_and_can_be_run_again(tmp_path, people, monkeypatch, fault):
    """Half a class would be graded as if the other half had handed in nothing."""
    source, out = tree(tmp_path / "in", CANVAS), tmp_path / "in" / "out"
    told = collect.collect(source, tmp_path / "uninterrupted", people)
    real, written = Path.write_bytes, []

    def until_the_third(path, data):
        written.append(path)
        if len(written) == 3:
            real(path, data[:5])
            raise fault or SystemExit
        return real(path, data)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", until_the_third)
        if fault is None:  # killed: nothing tidies up
            patch.setattr(collect.shutil, "rmtree", lambda *_, **__: None)
        with pytest.raises(type(fault) if fault else SystemExit):
            collect.collect(source, out, people)
    assert not out.exists()
    assert fault is None or [path.name for path in source.iterdir() if path.name not in CANVAS] == []
    assert collect.collect(source, out, people) == told.replace(str(tmp_path / "uninterrupted"), str(out))
    assert collected(out) == collected(tmp_path / "uninterrupted")
    assert sorted(path.name for path in source.iterdir()) == sorted([*CANVAS, "out"])


def test_names_that_fit_two_students_are_nobodys(tmp_path):
    (tmp_path / "roster.csv").write_text("id,name,email\ns1,Ann Lee,\ns2,Lee Ann,\n")
    said = collect.collect(
        tree(tmp_path / "in", {f"leeann_1_2_{DH}": notebook("?")}), tmp_path / "out", tmp_path / "roster.csv"
    )
    assert "leeann may be s1 or s2: give them aliases in the roster" in said


@pytest.mark.parametrize(
    ("file", "number"),
    [
        ("01_dh_vs_poe.ipynb", 0),
        ("01_dh_vs_poe-1.ipynb", 1),
        ("01_dh_vs_poe (3).ipynb", 3),
        ("01_dh_vs_poe-Copy2.ipynb", 2),
        ("01_DH_vs_PoE.IPYNB", 0),
        ("01 dh vs poe - Copy.ipynb", 1),
        ("ann_01_dh_vs_poe_final.ipynb", 0),
        ("essay.ipynb", None),
        ("notes-1.ipynb", None),
    ],
)
def test_names_of_notebooks(file, number):
    assert naming.notebook_of(file, NAMES) == (None if number is None else (DH, number))


def test_bad_input_gets_a_sentence(tmp_path, people):
    with pytest.raises(ValueError, match="does not exist: name the zip"):
        collect.collect(tmp_path / "nothing", tmp_path / "out")
    (tmp_path / "empty").mkdir()
    with pytest.raises(ValueError, match="holds no notebook"):
        collect.collect(tmp_path / "empty", tmp_path / "out")
    (tmp_path / "text.zip").write_text("text")
    with pytest.raises(ValueError, match=r"text.zip is no zip"):
        collect.collect(tmp_path / "text.zip", tmp_path / "out")
    with pytest.raises(ValueError, match="holds something already"):
        collect.collect(tmp_path / "text.zip", tmp_path)
    people.write_text(ROSTER + "S001,Twice,t@uni.edu,\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"roster.csv, line 6, id: 'S001' is there already, in line 2"):
        roster.read(people)


def test_a_table_that_a_spreadsheet_wrote_anew_is_told_with_file_and_line(tmp_path):
    collect.collect(tree(tmp_path / "in", {f"ann/{DH}": notebook("a")}), tmp_path / "out")
    (row,) = collect.read_table(tmp_path / "out")
    path = tmp_path / "out" / collect.TABLE
    path.write_text(path.read_text("utf-8-sig").replace(row["submitted"], "27.11.2026 18:00"), "utf-8")
    with pytest.raises(ValueError, match=r"collected.csv, line 2, submitted: .* not '27.11.2026 18:00'"):
        collect.read_table(tmp_path / "out")
    path.write_text("student;notebook\nann;x\n")
    with pytest.raises(ValueError, match=r"collected.csv, line 1: the columns student, notebook"):
        collect.read_table(tmp_path / "out")


def test_the_table_says_where_everything_came_from(tmp_path, people):
    collect.collect(tree(tmp_path / "in", CANVAS), tmp_path / "out", people)
    with open(tmp_path / "out" / collect.TABLE, newline="", encoding="utf-8-sig") as file:
        places = [row["from"] for row in csv.DictReader(file)]
    assert "curieannmarie_4713_88003_homework.zip/homework/" + DH in places
