"""What the instructor decides on top of the grades: overrides, deadlines, weights, follow-on credit."""

from __future__ import annotations

import csv
import json
import os
import shutil
from dataclasses import replace
from datetime import datetime

import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.course import Course
from coursekit.classroom.grader import box, decisions, gradebooks, marks, report
from coursekit.classroom.roster import Student
from tests.classroom.small import COURSE, HERE, NAME, grade_small, hand_in, records

needs_box = pytest.mark.skipif(
    not box.bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here"
)
FRIDAY = datetime(2026, 11, 27, 23, 59, 59)


class Dated(Course):
    """The small course with a deadline and a weight."""

    @property
    def deadlines(self):
        return {"01_arm": FRIDAY}

    @property
    def weights(self):
        return {"fk": 4.0}


DATED = Dated(COURSE.notebooks, COURSE.classroom)


def record(points=(2, 3, 0, 4), **more):
    rows = {
        e.name: {"points": p, "of": e.points, "text": "" if p else "wrong", "kind": "named"}
        for e, p in zip(COURSE.exercises("nb01"), points, strict=True)
    }
    head = {"student": "ann", "unit": "nb01", "name": NAME, "digest": "d", "notes": []}
    return {**head, "exercises": rows, **more}


def standing(one, course=COURSE, **decided):
    return marks.standing("ann", "", course, ["nb01"], lambda *_: one, decisions.Decisions(**decided))


def read(folder, text, name="overrides.csv", course=COURSE):
    (folder / name).write_text(text, encoding="utf-8")
    return decisions.read(folder, course, ["nb01"], {"ann", "bob"}, 1.0, 0.1)


def test_points_are_those_of_the_exercises():
    assert (standing(record()).points, standing(record()).of) == (9, 12)


def test_weights_count_instead_of_points():
    one = standing(record(), DATED)
    assert (one.marks["fk"].points, one.points, one.of) == (4, 11, 14)


def test_what_could_not_be_graded_is_no_zero():
    failed = standing({**record(), "failed": True, "exercises": {}})
    assert failed.points is None and failed.of == 12


def test_an_override_counts_and_says_why(tmp_path):
    found = read(tmp_path, "student;exercise;points;reason\nann;ik;2,5;x\n".replace("2,5", "2.5"))
    one = standing(record(), overrides=found.overrides)
    assert one.points == 11.5
    assert one.marks["ik"].note == "set by your instructor: x"
    failed = standing({**record(), "failed": True, "exercises": {}}, overrides=found.overrides)
    assert failed.marks["ik"].points == 2.5 and failed.points is None


@pytest.mark.parametrize(
    ("row", "text"),
    [
        ("an,ik,2,", r"overrides.csv, line 2, student: there is no 'an'. Did you mean 'ann'\?"),
        ("ann,ikk,2,", r"line 2, exercise: there is no 'ikk'. Did you mean 'ik'\?"),
        ("ann,ik,4,", "line 2, points: 0 to 3 are expected, not '4'"),
        ("ann,ik,many,", "line 2, points: 0 to 3 are expected, not 'many'"),
        ("ann,ik,nan,", "line 2, points: 0 to 3 are expected, not 'nan'"),
        ("ann,ik,1,\nann,ik,2,", "line 3: ik of ann stands in an earlier line"),
    ],
)
def test_a_row_that_fits_nobody_is_refused_with_file_and_line(tmp_path, row, text):
    with pytest.raises(ValueError, match=text):
        read(tmp_path, f"student,exercise,points,reason\n{row}\n")


def test_tables_without_their_columns_are_refused(tmp_path):
    with pytest.raises(
        ValueError, match="line 1: the columns student, exercise, points, reason are expected"
    ):
        read(tmp_path, "name,points\nann,3\n")
    with pytest.raises(ValueError, match=r"extensions.csv, line 2, until: a day such as .* not 'soon'"):
        (tmp_path / "overrides.csv").unlink()
        read(tmp_path, "student,notebook,until,reason\nann,01_arm,soon,\n", "extensions.csv")


@pytest.mark.parametrize(
    ("submitted", "days", "points"),
    [
        ("2026-11-27 23:59:59", 0, 11),
        ("2026-11-28 00:00:00", 1, 9.9),
        ("2026-11-29 12:00:00", 2, 8.8),
        ("2027-11-29 12:00:00", 367, 0),
    ],
)
def test_every_started_day_costs(submitted, days, points):
    decided = {"everybody": {"nb01": FRIDAY}}
    one = standing(record(submitted=submitted), DATED, **decided).notebooks["nb01"]
    assert (one.days_late, one.points) == (days, points)
    assert bool(days) == any("late" in note for note in one.notes)


def test_an_extension_moves_a_students_deadline(tmp_path):
    text = "student,notebook,until,reason\nann,01_arm.ipynb,2026-11-29,ill\n"
    found = read(tmp_path, text, "extensions.csv", DATED)
    assert found.deadline("ann", "nb01") == datetime(2026, 11, 29, 23, 59, 59)
    assert found.deadline("bob", "nb01") == FRIDAY
    assert found.days_late("ann", "nb01", datetime(2026, 11, 29, 12), True) == 0
    assert found.days_late("bob", "nb01", datetime(2026, 11, 29, 12), False) == 2
    assert found.days_late("bob", "nb01", datetime(2026, 11, 20), True) == 1, "the platform says it is late"


def test_follow_on_credit_counts_as_configured():
    rows = record()
    rows["exercises"]["ik"]["follow_on"] = "fk"
    assert standing(rows).points == 12
    assert standing(rows, follow_on=0.5).points == 10.5
    assert standing(rows, follow_on=0).points == 9
    assert "right with a right fk, which it calls" in standing(rows).marks["ik"].note
    rows["exercises"]["ik"] |= {"text": "not written yet", "kind": "unwritten"}
    assert standing(rows).marks["ik"].text == "it calls fk, and something there is not written yet"
    with pytest.raises(ValueError, match="--late is a share of the points, from 0 to 1; 10 came"):
        decisions.Decisions(late=10)


def test_gradebooks_are_what_canvas_and_moodle_import(tmp_path):
    people = {"ann": Student("ann", "Lee, Ann", "ann@uni.edu", section="A")}
    class_ = [standing(record())]
    gradebooks.write_canvas(tmp_path / "canvas.csv", class_, people, {"ann": "4711"})
    gradebooks.write_moodle(tmp_path / "moodle.csv", class_, people, {"ann": "123"})
    with open(tmp_path / "canvas.csv", newline="", encoding="utf-8") as file:
        assert list(csv.reader(file)) == [
            ["Student", "ID", "SIS Login ID", "Section", "01_arm"],
            ["    Points Possible", "", "", "", "12"],
            ["Lee, Ann", "4711", "ann", "A", "9"],
        ]
    with open(tmp_path / "moodle.csv", newline="", encoding="utf-8") as file:
        assert list(csv.reader(file)) == [
            ["Identifier", "Full name", "ID number", "Email address", "01_arm"],
            ["Participant 123", "Lee, Ann", "ann", "ann@uni.edu", "9"],
        ]


def test_a_notebook_that_nobody_handed_in_yet_is_no_column_of_zeros(tmp_path):
    """The first week's grades would fill all weeks to come."""
    one = standing(record())
    later = replace(standing(record((0, 0, 0, 0))).notebooks["nb01"], name="02_later.ipynb", there=False)
    one = replace(one, notebooks={**one.notebooks, "nb02": later})
    for write in (gradebooks.write_canvas, gradebooks.write_moodle):
        write(tmp_path / "book.csv", [one, one], {}, {})
        with open(tmp_path / "book.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        assert rows[0][-1] == "01_arm" and rows[-1][-1] == rows[-2][-1] == "9"


def test_the_table_has_a_column_for_each_exercise(tmp_path):
    report.write_grades(tmp_path / "grades.csv", COURSE, ["nb01"], [standing(record())], "bubblewrap")
    with open(tmp_path / "grades.csv", newline="", encoding="utf-8-sig") as file:
        (row,) = csv.DictReader(file)
    assert [row[e] for e in ("fk", "jacobian", "ik", "ik_all", "nb01", "of")] == [
        "2",
        "3",
        "0",
        "4",
        "9",
        "12",
    ]


# ---- with the grader itself


@pytest.fixture
def solved():
    return notebook.read(COURSE.notebook("nb01"))


def with_jacobian_from_fk(document, spoil_fk=True, spoil_jacobian=False):
    """A Jacobian by differences of the student's own fk."""
    text = """

def jacobian(theta, l1, l2):
    h = 1e-6
    steps = h * np.eye(2)
    columns = [(fk(theta + s, l1, l2) - fk(theta - s, l1, l2)) / (2 * h) for s in steps]
    return np.stack(columns, axis=-1)SIGN
""".replace("SIGN", " * 2" if spoil_jacobian else "")
    document = json.loads(json.dumps(document))
    for cell in document["cells"]:
        if spoil_fk and cell["source"].startswith("def fk"):
            cell["source"] += (
                "\n\nright_fk = fk\n\ndef fk(theta, l1, l2):\n    return right_fk(theta, l1, l2)[::-1]\n"
            )
        if cell["source"].startswith("def jacobian"):
            cell["source"] += text
    return document


@pytest.mark.box
@needs_box
def test_what_fails_only_through_an_earlier_exercise_gets_its_points(tmp_path, solved):
    hand_in(tmp_path / "in", "ann", with_jacobian_from_fk(solved))
    hand_in(tmp_path / "in", "bob", with_jacobian_from_fk(solved, spoil_jacobian=True))
    hand_in(tmp_path / "in", "cem", with_jacobian_from_fk(solved, spoil_fk=False))
    grade_small(tmp_path / "in", tmp_path / "out")
    with open(tmp_path / "out" / "grades.csv", newline="", encoding="utf-8-sig") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert {s: (row["fk"], row["jacobian"]) for s, row in rows.items()} == {
        "ann": ("0", "3"),
        "bob": ("0", "0"),
        "cem": ("2", "3"),
    }
    assert "right with a right fk, which it calls" in rows["ann"]["notes"]
    page = (tmp_path / "out" / "ann.html").read_text("utf-8")
    assert "right with a right fk" in page and "10 of 12 points" in page


@pytest.mark.box
@needs_box
def test_decisions_outlive_a_regrade_and_weeks_add_up(tmp_path, solved):
    """One OUT for weekly hand-ins; an override stays; who is not here keeps what was graded."""
    hand_in(tmp_path / "week 1", "ann", with_jacobian_from_fk(solved, spoil_jacobian=True))
    grade_small(tmp_path / "week 1", tmp_path / "out")
    (tmp_path / "out" / "overrides.csv").write_text("student,exercise,points,reason\nann,fk,1,nice try\n")
    hand_in(tmp_path / "week 2", "bob", solved)
    (tmp_path / "roster.csv").write_text("id,name,email\nann,Ann Lee,a@x\nbob,Bob Ray,b@x\ncem,Cem Su,c@x\n")
    for regrade in (False, ["bob"], ["01_arm"], ["nb01", "ann"]):
        said = grade_small(
            tmp_path / "week 2", tmp_path / "out", regrade=regrade, roster_path=tmp_path / "roster.csv"
        )
        with open(tmp_path / "out" / "grades.csv", newline="", encoding="utf-8-sig") as file:
            rows = {row["student"]: row for row in csv.DictReader(file)}
        assert {s: row["points"] for s, row in rows.items()} == {"ann": "8", "bob": "12", "cem": "0"}
        assert "set by your instructor: nice try" in rows["ann"]["notes"]
    assert "graded earlier and not here to be graded anew: ann nb01 (1 notebooks)" in said
    assert "Ann Lee" in (tmp_path / "out" / "canvas.csv").read_text("utf-8")
    assert [r["student"] for r in records(tmp_path / "out")].count("bob") == 4
    with pytest.raises(ValueError, match="--regrade bobb: no student's name and no notebook's"):
        grade_small(tmp_path / "week 2", tmp_path / "out", regrade=["bobb"])


@pytest.mark.box
@needs_box
def test_the_line_that_is_wrong_is_searched_after_the_grades(tmp_path, solved):
    """Advice only: it changes no points, and a second run does not search again."""
    document = json.loads(json.dumps(solved))
    wrong = """
def fk(theta, l1, l2):
    a, b = theta
    x = l1 * np.cos(a) + l2 * np.cos(a + b)
    y = l1 * np.sin(a) + l2 * np.sin(a + a)
    return np.array([x, y])
"""
    document["cells"].append({"cell_type": "code", "metadata": {}, "source": wrong})
    hand_in(tmp_path / "in", "ann", document)
    grade_small(tmp_path / "in", tmp_path / "without", lines=False)
    for _ in range(2):
        grade_small(tmp_path / "in", tmp_path / "out")
    lines = (tmp_path / "out" / "journal.jsonl").read_text("utf-8").splitlines()
    (searched,) = [one for one in map(json.loads, lines) if "lines" in one]
    assert "line 4" in searched["lines"]["fk"]
    page = (tmp_path / "out" / "ann.html").read_text("utf-8")
    assert "In your code: look at line 4" in page
    assert "look at line 4" in (tmp_path / "out" / "class.html").read_text("utf-8")
    tables = [
        (tmp_path / out / "grades.csv").read_text("utf-8-sig").splitlines()[0] for out in ("out", "without")
    ]
    assert tables[0] == tables[1]


@pytest.mark.box
@needs_box
def test_a_notebook_whose_exercises_changed_is_graded_anew_alone(tmp_path, solved):
    shutil.copytree(HERE / "course", tmp_path / "course")
    course = Course(tmp_path / "course" / "notebooks", tmp_path / "course")
    hand_in(tmp_path / "in", "ann", solved)
    grade_small(tmp_path / "in", tmp_path / "out", course=course)
    path = tmp_path / "course" / "exercises" / "nb01.py"
    path.write_text(path.read_text().replace("n=8", "n=9", 1))
    with pytest.raises(ValueError, match="course nb01 changed since"):
        grade_small(tmp_path / "in", tmp_path / "out", course=course)
    for _ in range(2):  # the second run finds that it is done
        grade_small(tmp_path / "in", tmp_path / "out", course=course, regrade=["nb01"] if not _ else False)
        assert len(records(tmp_path / "out")) == 2
