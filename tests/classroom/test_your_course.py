"""A course of one's own: what it may hold, what is refused, and the solutions that live elsewhere."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from datetime import datetime

import pytest

from coursekit import classroom
from coursekit.__main__ import main
from coursekit.classroom import document, own, roster, your_course
from coursekit.classroom.author import new, release, tables
from coursekit.classroom.check import diagnose
from coursekit.classroom.course import course_at, course_here, the_course
from coursekit.classroom.your_course import read
from coursekit.commands import COMMANDS
from tests import needs
from tests.classroom.small import ROOT, records

STEM = "01_first_arm"
SOLUTION = "elbow = lengths[0] * np.array([np.cos(first), np.sin(first)])"  # a line of it


@pytest.fixture()
def folder(tmp_path):
    new.new(tmp_path / "mine")
    return tmp_path / "mine"


def toml(folder, **changes):
    """course.toml with these lines."""
    lines = {"title": '"Mine"', "version": '"1"', "notebooks": f'["{STEM}"]', **changes}
    tables_last = sorted(lines.items(), key=lambda item: item[0].startswith("["))
    text = "\n".join(
        f"{key}\n{value}" if key.startswith("[") else f"{key} = {value}" for key, value in tables_last
    )
    (folder / "course.toml").write_text(text)
    return read(folder)


def told(run, *arguments):
    """The sentence of a ValueError."""
    with pytest.raises(ValueError) as caught:
        run(*arguments)
    assert "\n" not in str(caught.value)
    return str(caught.value)


# ---- what it is


def test_a_new_course_runs(folder, monkeypatch, capsys):
    """Its solved notebook from top to bottom, its check with a right and with a wrong function."""
    assert main(["execute", "--course", str(folder)]) == 0
    outputs = document.read(folder / f"{STEM}.ipynb")["cells"][-1]["outputs"]
    assert "✓ tip: right" in "".join(outputs[0]["text"])
    monkeypatch.chdir(folder)
    assert not diagnose("tip", lambda theta, lengths: lengths * 0).right
    wrong = course_here().wrong(STEM)["tip"]["degrees"]
    assert "theta is in radians" in diagnose("tip", wrong).text
    capsys.readouterr()
    assert main(["new", str(folder)]) == 2
    assert "is not empty" in capsys.readouterr().err


def test_the_course_of_a_notebook_is_found_from_its_folder(folder, tmp_path):
    (folder / "deeper" / "still").mkdir(parents=True)
    assert course_here(folder / "deeper" / "still") == read(folder)
    assert course_here(tmp_path) == the_course()
    assert course_at(read(folder).place) == read(folder)
    assert course_at(the_course().place) == the_course()


def test_shipped_notebooks_in_another_order_with_weights_and_deadlines(folder):
    names = [e.name for unit in ("nb06", "nb04") for e in the_course().exercises(unit)]
    weights = "\n".join(f"{name} = {number + 0.5}" for number, name in enumerate([*names, "tip"]))
    course = toml(
        folder,
        notebooks=f'["06_path_speed", "{STEM}", "04_singularities"]',
        **{
            "[weights]": weights,
            "[deadlines]": f"{STEM} = 2027-02-01\n04_singularities = 2027-03-01T12:00:00",
        },
    )
    assert course.units == ["nb06", STEM, "nb04"]
    assert course.notebook("nb04") == the_course().notebook("nb04")
    assert course.weights["tip"] == len(names) + 0.5
    assert course.deadlines == {
        STEM: datetime(2027, 2, 1, 23, 59, 59),
        "04_singularities": datetime(2027, 3, 1, 12),
    }
    assert course.find("rank")[0] == "nb04" and not course.has("fk_dh")


def with_shipped_exercise(folder):
    """One's own notebook asks `screw_axis`, by its name: solution and check are copied there."""
    shipped = document.read(the_course().notebook("nb02"))
    cells = [c for c in shipped["cells"] if document.role(c).get("grade_id", "").endswith("screw_axis")]
    mine = document.read(folder / f"{STEM}.ipynb")
    mine["cells"] += cells
    document.write(folder / f"{STEM}.ipynb", mine)
    path = folder / f"{STEM}_exercises.py"
    path.write_text(path.read_text().replace("EXERCISES = [", 'EXERCISES = [\n    "screw_axis",'))


def test_an_exercise_that_ships_is_used_by_its_name(folder, monkeypatch):
    with_shipped_exercise(folder)
    assert tables.write_samples(read(folder)) == [STEM]
    monkeypatch.chdir(folder)
    assert [e.name for e in course_here().exercises(STEM)] == ["screw_axis", "tip"]
    wrong = the_course().wrong("nb02")["screw_axis"]["plus"]
    assert "the other sign" in diagnose("screw_axis", wrong).text
    right = tables.solutions(the_course(), "nb02").screw_axis
    assert diagnose("screw_axis", right).right
    nb02 = str(the_course().exercises_path("nb02"))
    assert nb02 in {str(path) for path in read(folder).sources(STEM)}  # a change there changes grades here


def test_a_file_of_the_same_name_replaces_a_notebook_that_ships(folder):
    shutil.copy(the_course().notebook("nb04"), folder)
    course = toml(folder, notebooks=f'["{STEM}", "04_singularities"]')
    assert course.notebook("nb04") == folder / "04_singularities.ipynb"
    assert course.exercises("nb04") == the_course().exercises("nb04")


def test_files_go_to_students_and_nothing_else_does(folder, tmp_path):
    for name in ("images", "submissions"):
        (folder / name).mkdir()
        (folder / name / "one.txt").write_text("text")
    (folder / "old_solution.ipynb").write_text((folder / f"{STEM}.ipynb").read_text())
    release.release(tmp_path / "out", toml(folder, files='["images"]'))
    assert sorted(p.name for p in (tmp_path / "out" / "notebooks").iterdir()) == [
        f"{STEM}.ipynb",
        f"{STEM}_exercises.py",
        f"{STEM}_samples.json",
        "course.toml",
        "images",
    ]


def test_questions_and_goals_of_ones_own(folder, tmp_path, monkeypatch, capsys):
    (folder / f"{STEM}_questions.py").write_text(
        "from coursekit.classroom.question import Question\n"
        "QUESTIONS = [Question('twice', lambda rng: {'x': 4}, 'Twice {x}?', lambda x: 2 * x)]\n"
        "GOALS = {'double': ['twice'], 'reach': ['tip']}\n"
    )
    release.release(tmp_path / "out", read(folder))
    monkeypatch.chdir(tmp_path / "out" / "notebooks")
    monkeypatch.setattr("coursekit.classroom.question._done", set())
    asked = classroom.ask("twice")
    asked.answer(2 * asked.numbers["x"])
    classroom.goals("01")
    assert "1 of 2 goals: ✓ double · ○ reach" in capsys.readouterr().out
    assert "no goals of a notebook '02'; there are: 01_first_arm" in told(classroom.goals, "02")


# ---- what is refused


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"titel": '"x"'}, "'titel' is no key. Did you mean 'title'?"),
        ({"title": "3"}, "title: a text in quotes is expected, not 3"),
        ({"version": '"one"'}, "version: numbers with dots"),
        ({"notebooks": "[]"}, "notebooks: a list of names"),
        ({"notebooks": '["04_singularity"]'}, "none of that name ships. Did you mean '04_singularities'?"),
        ({"notebooks": f'["{STEM}", "{STEM}"]'}, f"notebooks: '{STEM}' is there twice"),
        ({"files": '["nothing.png"]'}, "files: there is no 'nothing.png' in this folder"),
        ({"files": '["../mine/x"]'}, "files: there is no"),
        ({"[weights]": "tip = -1"}, "weights, tip: a number that is not negative"),
        ({"[weights]": "tip = true"}, "weights, tip: a number that is not negative"),
        ({"[deadlines]": "04_singularities = 2027-01-01"}, "deadlines: the course has no notebook"),
        ({"[deadlines]": f"{STEM} = 'soon'"}, f"deadlines, {STEM}: a day such as 2026-12-01"),
        ({"[weights]": "tip = = 1"}, "course.toml: Invalid value"),
    ],
)
def test_a_slip_in_course_toml_names_file_and_field(folder, changes, says):
    text = told(lambda: toml(folder, **changes))
    assert text.startswith(f"{folder.resolve() / 'course.toml'}"), text
    assert says in text


@pytest.mark.parametrize(
    ("file", "old", "new_", "says"),
    [
        (
            "mistakes.py",
            '"swapped":',
            '"swap":',
            "WRONG['tip']: no function makes the mistake of the hint swapped",
        ),
        (
            "exercises.py",
            '            Hint("swapped", "x and y are swapped"),\n',
            "",
            "no hint for the mistake swapped",
        ),
        ("exercises.py", '"swapped"', '"degrees"', "tip, hints: two have the same key"),
        (
            "exercises.py",
            "EXERCISES = [",
            'EXERCISES = ["fk_dhh",',
            "there is no exercise 'fk_dhh'. Did you mean",
        ),
        (
            "exercises.py",
            "EXERCISES = [",
            "EXERCISES = [3,",
            "an Exercise or the name of one that ships, not 3",
        ),
        ("exercises.py", "points=2", "points=", "SyntaxError"),
        ("exercises.py", "import numpy", "import nunpy", "ModuleNotFoundError"),
        (".ipynb", '"points": 2', '"points": 5', "check-tip, metadata.nbgrader.points: 5 there, 2 in"),
        (
            ".ipynb",
            '"grade_id": "tip"',
            '"grade_id": "top"',
            "one cell with grade_id 'tip' and solution: true",
        ),
        (".ipynb", '"grade_id": "check-tip"', '"grade_id": "chk"', "one cell with grade_id 'check-tip'"),
        (".ipynb", "### END SOLUTION", "### END", "cell tip: unbalanced solution marker"),
        (".ipynb", "    ### BEGIN SOLUTION\\n", "", "unbalanced"),
        (
            "samples.json",
            '"swapped"',
            '"swopped"',
            "tip: not written for this exercise; run `coursekit samples`",
        ),
        ("samples.json", '"tip"', '"top"', "tip: not written for this exercise"),
    ],
)
def test_a_course_that_is_not_whole_is_not_released(folder, tmp_path, file, old, new_, says):
    path = folder / (STEM + (file if file.startswith(".") else f"_{file}"))
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new_))
    text = told(release.release, tmp_path / "out", read(folder))
    assert says in text and path.name in text.replace("\\\\", "/"), text
    assert [p.name for p in tmp_path.iterdir()] == ["mine"]


def test_two_exercises_of_one_name_are_refused(folder, tmp_path):
    with_shipped_exercise(folder)
    course = toml(folder, notebooks=f'["{STEM}", "02_msb_derivation"]')
    text = told(release.release, tmp_path / "out", course)
    assert f"{STEM}_exercises.py and " in text and "two exercises are named 'screw_axis'" in text


def test_a_missing_weight_is_named(folder, tmp_path):
    course = toml(folder, notebooks=f'["{STEM}", "04_singularities"]', **{"[weights]": "tip = 2"})
    assert "weights: det_from_blocks of 04_singularities has none" in told(
        release.release, tmp_path / "out", course
    )
    course = toml(folder, **{"[weights]": "tip = 2\nrank = 1"})
    assert "weights: the course has no exercise 'rank'; it ships in nb04" in told(
        release.release, tmp_path / "out", course
    )


def test_a_solution_without_markers_is_not_handed_out(folder, tmp_path):
    path = folder / f"{STEM}.ipynb"
    solved = document.read(path)
    for cell in solved["cells"]:
        cell["source"] = "".join(s for s in cell["source"].splitlines(True) if "SOLUTION" not in s)
    document.write(path, solved)
    assert "so all of it would be handed out" in told(release.release, tmp_path / "out", read(folder))


def test_no_course_is_no_course(tmp_path):
    assert "`coursekit new" in told(read, tmp_path)


# ---- solutions elsewhere


@pytest.fixture()
def split(folder, tmp_path):
    """The solutions in a folder of their own; the public one got its notebook from `coursekit samples`."""
    private = tmp_path / "private"
    private.mkdir()
    for name in (f"{STEM}.ipynb", f"{STEM}_mistakes.py"):
        shutil.move(folder / name, private / name)
    (folder / f"{STEM}_samples.json").unlink()
    course = toml(folder, solutions='"../private"')
    assert main(["samples", "--course", str(folder)]) == 0
    return course


def leaks(folder):
    """Where a line of the solution stands, in files of any kind and depth."""
    line = json.dumps(SOLUTION)[1:-1].encode()
    found = [
        p
        for p in folder.rglob("*")
        if p.is_file() and (SOLUTION.encode() in p.read_bytes() or line in p.read_bytes())
    ]
    return [p.relative_to(folder) for p in found]


def test_the_test_of_leaks_finds_one(folder):
    assert [p.name for p in leaks(folder)] == [f"{STEM}.ipynb"]


def test_the_public_folder_holds_no_solution(split, tmp_path):
    public = split.notebooks
    assert not leaks(public) and not list(public.glob("*mistakes*"))
    assert "raise NotImplementedError" in (public / f"{STEM}.ipynb").read_text()
    assert course_here(tmp_path / "private") == split  # a notebook that runs there finds its course
    release.release(tmp_path / "out", split)
    assert not leaks(tmp_path / "out")
    assert "private" not in (tmp_path / "out" / "notebooks" / "course.toml").read_text()


def test_its_history_holds_none(split, tmp_path):
    def git(*words):
        run = ["git", "-c", "user.name=a", "-c", "user.email=a@b", "-C", str(split.notebooks), *words]
        return subprocess.run(run, check=True, capture_output=True).stdout

    if not shutil.which("git"):
        pytest.skip("no git here")
    git("init", "-q")
    for round in range(2):  # the second one after a correction of the solution
        git("add", "-A")
        git("commit", "-qm", f"round {round}", "--allow-empty")
        path = split.solved / f"{STEM}.ipynb"
        path.write_text(path.read_text().replace("elbow", "knee"))
        tables.write_samples(split)
    everything = git("log", "--all", "-p", "--format=%H")
    assert b"NotImplementedError" in everything
    assert b"np.cos(first)" not in everything and b"WRONG" not in everything


def test_the_wheel_of_a_release_holds_none(split, tmp_path):
    release.release(tmp_path / "out", split)
    wheel = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(tmp_path / "wheel"), "."]
    done = subprocess.run(wheel, cwd=tmp_path / "out", capture_output=True, text=True)
    if done.returncode and "hatchling" in done.stderr and not os.environ.get("CI"):
        pytest.skip("the builder of wheels cannot be fetched here")
    assert done.returncode == 0, done.stderr
    (built,) = (tmp_path / "wheel").glob("*.whl")
    shutil.unpack_archive(built, tmp_path / "unpacked", "zip")
    assert not leaks(tmp_path / "unpacked")
    names = [p.as_posix() for p in (tmp_path / "unpacked").rglob("*")]
    assert [n for n in names if n.endswith("classroom/check.py")]
    assert not [n for n in names if re.search("mistakes|/author|/grader", n)]


def test_without_the_private_folder_students_can_check_and_nobody_can_release(split, tmp_path, monkeypatch):
    shutil.rmtree(split.solved)
    monkeypatch.chdir(split.notebooks)
    assert diagnose("tip", lambda theta, lengths: None).kind == "misfit"
    text = told(release.release, tmp_path / "out", read(split.notebooks))
    assert "course.toml, solutions: there is no folder" in text


def test_the_pointer_of_the_private_folder_must_fit(split):
    toml(split.notebooks, solutions='"."')
    assert "public: it stands alone, and" in told(read, split.solved)


# ---- a class in which no two students are alike

PEOPLE = "id,name,email\ns1,Ada,a@x\ns2,Bo,b@x\ns3,Cy,c@x\n"
OWN = """
    Exercise(
        "reach(lengths)",
        points=1,
        draw=lambda rng: (list(own_sheet().lengths.values()),),
        shape=(),
        unit="m",
        own=True,
        samples=1,
        n=1,
        hints=(Hint("shortest", "the longest reach, not the shortest link"),),
    ),
"""


@pytest.fixture()
def in_class(folder, tmp_path):
    """A course with an exercise on one's own arm, released to three; returns where."""
    path = folder / f"{STEM}_exercises.py"
    text = path.read_text().replace("EXERCISES = [", f"EXERCISES = [{OWN}")
    path.write_text(
        text.replace(
            "import numpy as np\n", "import numpy as np\n\nfrom coursekit.classroom import own_sheet\n"
        )
    )
    path = folder / f"{STEM}_mistakes.py"
    path.write_text(path.read_text().replace("WRONG = {", 'WRONG = {\n    "reach": {"shortest": min},'))
    solved = document.read(folder / f"{STEM}.ipynb")
    body = "def reach(lengths):\n    ### BEGIN SOLUTION\n    return sum(lengths)\n    ### END SOLUTION"
    for source, role in (
        (body, {"grade_id": "reach", "solution": True}),
        ('check("reach", reach)', {"grade_id": "check-reach", "grade": True, "points": 1}),
    ):
        cell = {"cell_type": "code", "source": source, "outputs": [], "execution_count": None}
        solved["cells"].append({**cell, "id": role["grade_id"], "metadata": {"nbgrader": role}})
    document.write(folder / f"{STEM}.ipynb", solved)
    tables.write_samples(read(folder))
    (tmp_path / "roster.csv").write_text(PEOPLE)
    release.release(tmp_path / "class", read(folder), tmp_path / "roster.csv")
    return tmp_path / "class"


def examples(folder, name):
    return json.loads((folder / "notebooks" / f"{STEM}_samples.json").read_text())[name]["examples"]


def test_everybody_gets_a_folder_and_an_arm(in_class, monkeypatch):
    assert sorted(p.name for p in in_class.iterdir()) == ["s1", "s2", "s3"]
    arms = set()
    for student in ("s1", "s2", "s3"):
        monkeypatch.chdir(in_class / student / "notebooks")
        sheet = classroom.own_sheet()
        assert sheet == own.sheet_of(own.seed_of(student))
        arms.add(tuple(sheet.lengths.values()))
        (asked,) = examples(in_class / student, "reach")
        assert asked["args"] == [list(sheet.lengths.values())]
        assert diagnose("reach", lambda lengths: sum(lengths)).right
        assert document.mark_of(document.read(f"{STEM}.ipynb"))["student"] == student
    assert len(arms) == 3
    assert examples(in_class / "s1", "tip") == examples(in_class / "s2", "tip")


def test_a_correction_reaches_the_whole_class(in_class, folder, tmp_path):
    work = in_class / "s2" / "notebooks" / f"{STEM}.ipynb"
    mine = document.read(work)
    next(c for c in mine["cells"] if c["id"] == "tip")["source"] = "my own work"
    document.write(work, mine)
    toml_ = folder / "course.toml"
    toml_.write_text(toml_.read_text().replace('version = "1"', 'version = "2"'))
    (tmp_path / "roster.csv").write_text(PEOPLE + "s4,Di,d@x\n")
    text = release.release(in_class, read(folder), tmp_path / "roster.csv")
    assert text.count("version 2 of My course") == 3 and f"wrote {in_class / 's4'}" in text
    assert "my own work" in work.read_text()
    assert json.loads((in_class / "s2" / "student.json").read_text())["id"] == "s2"


def test_if_one_folder_cannot_be_updated_none_is(in_class, folder, tmp_path):
    (in_class / "s3" / "notebooks" / f"{STEM}.ipynb").write_text("{")
    before = {p: p.read_bytes() for p in in_class.rglob("*") if p.is_file()}
    toml_ = folder / "course.toml"
    toml_.write_text(toml_.read_text().replace('version = "1"', 'version = "2"'))
    text = told(release.release, in_class, read(folder), tmp_path / "roster.csv")
    assert str(in_class / "s3") in text and "is no notebook" in text
    assert {p: p.read_bytes() for p in in_class.rglob("*") if p.is_file()} == before
    assert sorted(p.name for p in in_class.iterdir()) == ["s1", "s2", "s3"]


def test_the_grader_knows_whose_arm_it_is(in_class, folder, tmp_path):
    """Ada's numbers are right for her, and wrong for Bo, who copied them, note and all."""
    ada = document.read(in_class / "s1" / "notebooks" / f"{STEM}.ipynb")
    total = sum(own.sheet_of(own.seed_of("s1")).lengths.values())
    next(c for c in ada["cells"] if c["id"] == "reach")["source"] = (
        f"def reach(lengths):\n    return {total!r}"
    )
    for student in ("s1", "s2"):
        (tmp_path / "in" / student).mkdir(parents=True)
        document.write(tmp_path / "in" / student / f"{STEM}.ipynb", ada)
    run = [
        "grade",
        "--course",
        str(folder),
        "--no-box",
        "--jobs",
        "1",
        str(tmp_path / "in"),
        str(tmp_path / "grades"),
    ]
    assert main(run) == 0
    s1, s2 = sorted(records(tmp_path / "grades"), key=lambda record: record["student"])
    assert s1["exercises"]["reach"]["points"] == 1 and not s1["notes"]
    assert s2["exercises"]["reach"]["points"] == 0
    assert s2["notes"] == ["the notebook was handed out to s1"]


def test_who_takes_the_name_out_of_a_notebook_is_named(in_class, folder, tmp_path):
    """Then nobody's arm is asked about, the same for all who do so."""
    work = document.read(in_class / "s1" / "notebooks" / f"{STEM}.ipynb")
    del work["metadata"]["coursekit"]["student"]
    (tmp_path / "in" / "s1").mkdir(parents=True)
    document.write(tmp_path / "in" / "s1" / f"{STEM}.ipynb", work)
    run = ["grade", "--course", str(folder), "--no-box", "--jobs", "1", str(tmp_path / "in")]
    roster = ["--roster", str(tmp_path / "roster.csv")]
    assert main([*run, str(tmp_path / "grades"), *roster]) == main([*run, str(tmp_path / "others")]) == 0
    notes = {one["student"]: one["notes"] for one in records(tmp_path / "grades")}
    assert notes["s1"][0].startswith("the notebook does not say whom it was handed out to")
    assert "nothing handed in" in notes["s2"]
    assert [one["notes"] for one in records(tmp_path / "others")] == [[]], (
        "a class without a roster has one arm"
    )


def test_who_reads_the_sheet_in_a_function_is_right_in_the_grades_too(in_class, folder, tmp_path):
    """`check` calls it right, so the box has the sheet, too: it shows what is asked, and no answer."""
    work = document.read(in_class / "s1" / "notebooks" / f"{STEM}.ipynb")
    source = "from coursekit.classroom import own_sheet\nL = own_sheet().lengths\n\n"
    source += "def reach(lengths):\n    return sum(L.values())"
    next(c for c in work["cells"] if c["id"] == "reach")["source"] = source
    (tmp_path / "in" / "s1").mkdir(parents=True)
    document.write(tmp_path / "in" / "s1" / f"{STEM}.ipynb", work)
    run = ["grade", "--course", str(folder), "--no-box", "--jobs", "1"]
    assert main([*run, str(tmp_path / "in"), str(tmp_path / "grades")]) == 0
    (record,) = records(tmp_path / "grades")
    assert record["exercises"]["reach"]["points"] == 1


def test_a_notebook_newer_than_the_course_is_told_in_the_grades(in_class, folder, tmp_path):
    work = document.read(in_class / "s1" / "notebooks" / f"{STEM}.ipynb")
    work["metadata"]["coursekit"]["version"] = "7"
    (tmp_path / "in" / "s1").mkdir(parents=True)
    document.write(tmp_path / "in" / "s1" / f"{STEM}.ipynb", work)
    run = [
        "grade",
        "--course",
        str(folder),
        "--no-box",
        "--jobs",
        "1",
        str(tmp_path / "in"),
        str(tmp_path / "grades"),
    ]
    assert main(run) == 0
    (record,) = records(tmp_path / "grades")
    assert record["notes"][0].startswith("the notebook is of version 7, newer than this course (1)")


def test_points_that_changed_are_told_and_nothing_is_mixed(in_class, folder, tmp_path, capsys):
    shutil.copytree(in_class / "s1" / "notebooks", tmp_path / "in" / "s1")
    run = ["grade", "--course", str(folder), "--no-box", "--jobs", "1"]
    run += [str(tmp_path / "in"), str(tmp_path / "grades")]
    assert main(run) == 0
    grades = (tmp_path / "grades" / "grades.csv").read_bytes()
    for name in ("_exercises.py", ".ipynb"):
        path = folder / f"{STEM}{name}"
        path.write_text(
            path.read_text().replace("points=2", "points=5").replace('"points": 2', '"points": 5')
        )
    assert main(run) == 2
    error = capsys.readouterr().err
    assert "points (tip counts 5, 2 before) changed since" in error and "--regrade" in error
    assert f"course {STEM}, " in error
    assert (tmp_path / "grades" / "grades.csv").read_bytes() == grades
    assert main([*run, "--regrade"]) == 0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("id,name\ns1,A\nS1,B\n", "line 3, id: 'S1' is there already, in line 2"),
        ("name,email\nA,a\n", "line 1: the columns id, name, email are expected"),
        ("id,name\n../x,A\n", "line 2, id: '../x' cannot name a folder"),
        ("id,name\n,A\n", "line 2, id: '' cannot name a folder"),
        ("id,name\n", "names no student"),
    ],
)
def test_a_roster_that_does_not_fit_writes_nothing(folder, tmp_path, text, says):
    (tmp_path / "roster.csv").write_text(text)
    sentence = told(release.release, tmp_path / "class", read(folder), tmp_path / "roster.csv")
    assert says in sentence and sentence.startswith(str(tmp_path / "roster.csv"))
    assert not (tmp_path / "class").exists()


def test_a_roster_from_a_spreadsheet_is_read(tmp_path):
    (tmp_path / "r.csv").write_bytes("\ufeffID;Name;Group;Email\r\ns1;Ada;3;a@x\r\n\r\n".encode())
    assert roster.read(tmp_path / "r.csv") == [roster.Student("s1", "Ada", "a@x")]


def test_an_update_is_not_somebody_elses(in_class, folder, tmp_path):
    from coursekit.classroom import update

    assert "is the release of s2" in told(update.update, in_class / "s2", in_class / "s1")
    assert "nothing changed" in update.update(in_class, in_class / "s1")  # the folder of the whole class
    release.release(tmp_path / "everybody", read(folder))
    assert "without anybody's arm" in told(update.update, tmp_path / "everybody", in_class / "s1")
    with pytest.raises(ValueError, match=r"holds the releases of \d students: name the folder of your id"):
        update.update(in_class, tmp_path / "everybody")  # it took the arm of the first in the alphabet
    assert "nothing changed" not in update.update(in_class / "s1", tmp_path / "everybody")
    assert (tmp_path / "everybody" / own.FILE).is_file()


def test_two_with_the_same_arm_are_refused(folder, tmp_path, monkeypatch):
    (tmp_path / "roster.csv").write_text(PEOPLE)
    monkeypatch.setattr(own, "seed_of", lambda student: 5)
    sentence = told(release.release, tmp_path / "class", read(folder), tmp_path / "roster.csv")
    assert "id: s1 and s2 would get the same arm" in sentence
    assert your_course.read(folder) and not (tmp_path / "class").exists()


# ---- the other commands


def test_students_read_title_and_deadlines(folder, tmp_path):
    release.release(tmp_path / "out", toml(folder, **{"[deadlines]": f"{STEM} = 2027-02-01"}))
    text = (tmp_path / "out" / "README.md").read_text()
    assert text.startswith("# Mine\n") and f"* {STEM}: 2027-02-01 23:59" in text and "{" not in text
    assert "coursekit update NEW" in text


def test_a_title_in_any_letters_comes_back(folder, tmp_path):
    title = 'Ärme "und" Gelenke: \\ 機械'
    course = toml(folder, title=json.dumps(title, ensure_ascii=False), **{"[weights]": "tip = 0.1"})
    release.release(tmp_path / "out", course)
    again = read(tmp_path / "out" / "notebooks")
    assert (again.title, again.weights, again.version) == (title, {"tip": 0.1}, "1")


def test_the_export_for_nbgrader_brings_along_what_check_reads(folder, tmp_path, monkeypatch):
    toml(folder, notebooks=f'["{STEM}", "04_singularities"]')
    assert main(["export", "nbgrader", str(tmp_path / "out"), "--course", str(folder)]) == 0
    assignment = tmp_path / "out" / "source" / STEM
    monkeypatch.chdir(assignment)
    assert diagnose("tip", lambda theta, lengths: None).kind == "misfit"
    cells = document.read(assignment / f"{STEM}.ipynb")["cells"]
    assert "### BEGIN HIDDEN TESTS" in cells[-1]["source"]
    assert course_here(tmp_path / "out" / "source" / "04_singularities").units == ["nb04"]


def test_study_and_lab_open_the_courses_own_folders(folder, split, monkeypatch):
    from coursekit.classroom import lab

    opened = []
    monkeypatch.setattr(lab, "start", lambda arguments, notebooks=None, **more: opened.append(notebooks))
    assert main(["lab", "--course", str(split.notebooks)]) == 0
    assert main(["study", "--course", str(split.notebooks)]) == 0
    assert opened == [split.solved, split.notebooks / "work"]
    assert [p.name for p in (split.notebooks / "work").iterdir()] == [f"{STEM}.ipynb"]
    assert course_here(split.notebooks / "work") == split


def test_the_pages_of_a_split_course_hold_no_solution(split, tmp_path):
    needs.what_builds_the_site()
    assert main(["site", str(tmp_path / "site"), "--course", str(split.notebooks)]) == 0
    pages = list((tmp_path / "site").rglob("*.html"))
    assert any("Where is the tip?" in page.read_text("utf-8") for page in pages)
    assert not leaks(tmp_path / "site")


def test_the_page_for_instructors_names_what_there_is(folder):
    page = (ROOT / ".github" / "INSTRUCTORS.md").read_text("utf-8")
    assert set(re.findall(r"bin/coursekit (\w+)", page)) <= set(COMMANDS)
    (text,) = re.findall(r"```toml\n(.*?)```", page, re.S)
    shutil.copy(folder / f"{STEM}.ipynb", folder / "01_gripper.ipynb")
    (folder / "images").mkdir()
    (folder / "course.toml").write_text(text)
    course = read(folder)
    assert course.units == ["nb02", "01_gripper", "nb04"] and course.weights == {"grip": 4}
    for options in re.findall(r"`?--(\w[\w-]*)", page):
        known = [flag for command in COMMANDS.values() for flags, _ in command.arguments for flag in flags]
        assert f"--{options}" in [*known, "--course", "--help"]


@pytest.mark.parametrize("words", [["grade"], ["collect"], ["viva", "s1"]])
def test_a_course_that_was_handed_in_is_not_believed(words, folder, tmp_path, monkeypatch, capsys):
    """Who stands in a student's folder would else run the student's exercises on their own machine."""
    bait = tmp_path / "in" / "s1"
    shutil.copytree(folder, bait)
    (bait / f"{STEM}_exercises.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    monkeypatch.chdir(bait)
    assert main([*words, str(tmp_path / "in"), str(tmp_path / "out")]) == 2
    assert "lies among what was handed in, and is not used" in capsys.readouterr().err
    assert not (tmp_path / "ran").exists() and not (tmp_path / "out").exists()
