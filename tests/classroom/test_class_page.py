"""The class at a glance: the numbers in it, and what it must not do."""

from __future__ import annotations

import json
import os
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.course import the_course
from coursekit.classroom.grader import box, class_page, clinic, overview, report
from coursekit.classroom.grader.marks import Mark, Notebook, Standing


def student(name, right, unit="nb01", texts=None, **more):
    """right: {exercise: True, False (wrong) or None (not written)}."""
    marks = []
    for exercise, good in right.items():
        text = "" if good else "not written yet" if good is None else (texts or {}).get(exercise, "a sign")
        kind = "right" if good else "unwritten" if good is None else "named"
        marks.append(Mark(exercise, 3 if good else 0, 3, text, kind=kind))
    return Standing(name, "", {unit: Notebook(unit, "01_arm.ipynb", marks, [], **more)})


def a_class(count=12):
    """`easy` separates nobody, `odd` is right for the weaker half alone, `hard` nobody has."""
    return [
        student(
            f"s{k:02}",
            {"a": k >= 4, "b": k >= 5, "c": k >= 6, "odd": k < 6, "hard": False, "last": None},
            texts={"hard": "transposed" if k % 3 else "inverted"},
        )
        for k in range(count)
    ]


def test_shares_mistakes_and_who_made_them():
    items = {item.name: item for item in overview.items(a_class())}
    assert (items["a"].right, items["a"].handed_in, items["a"].share) == (8, 12, 8 / 12)
    assert [(m.text, len(m.students)) for m in items["hard"].mistakes] == [("transposed", 8), ("inverted", 4)]
    assert items["last"].written == 0 and items["last"].mistakes == []


def test_an_exercise_that_tells_nothing_or_that_nobody_solves_is_doubted():
    doubts = {item.name: item.doubt for item in overview.items(a_class())}
    assert "no better here than the last" in doubts["odd"]
    assert "is it posed clearly?" in doubts["hard"]
    assert doubts["a"] == doubts["c"] == ""
    assert not any(item.doubt for item in overview.items(a_class(6))), "six say too little"


def test_placed_mistakes_are_counted_together_though_their_numbers_differ():
    marks = [Mark("a", 0, 1, f"wrong on {k} of 8 examples", kind="different") for k in (3, 5)]
    class_ = [
        Standing(str(k), "", {"nb01": Notebook("nb01", "x", [mark], [])}) for k, mark in enumerate(marks)
    ]
    (item,) = overview.items(class_)
    assert [(m.text, m.students) for m in item.mistakes] == [("wrong on some examples", ["0", "1"])]


def test_who_hands_nothing_in_counts_in_no_share():
    absent = student("absent", {"a": False}, there=False)
    (item,) = overview.items([student("ann", {"a": True}), absent])
    assert (item.handed_in, item.share) == (1, 1.0)


def test_what_needs_an_eye():
    failed = Standing("f", "", {"nb01": Notebook("nb01", "x.ipynb", [Mark("a", None, 1, "")], ["disk full"])})
    same = {"a": "no answer: the kernel died", "b": "no answer: the kernel died"}
    one_reason = student("r", {"a": False, "b": False}, texts=same)
    found = dict(overview.needs_your_eye([failed, one_reason, student("ok", {"a": True})]))
    assert found == {
        "f": "x.ipynb: disk full",
        "r": "01_arm.ipynb: nothing for one reason: no answer: the kernel died",
    }


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags, self.links = [], []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.links += [value for key, value in attributes if key in ("href", "src")]


def test_the_page_is_whole_escaped_and_needs_no_network(tmp_path):
    evil = "<script>alert(1)</script><img src=x onerror=alert(1)>"
    class_ = [*a_class(), student(evil, {"a": False}, texts={"a": evil}), student("class", {"a": True})]
    class_page.write_class_page(tmp_path / "class.html", class_)
    html = (tmp_path / "class.html").read_text("utf-8")
    page = Page()
    page.feed(html)
    assert not {"script", "img", "link", "iframe"} & set(page.tags)
    assert page.links and not [link for link in page.links if ":" in link or link.startswith("/")]
    assert "prefers-color-scheme: dark" in html and "@media print" in html and "width=device-width" in html
    assert re.search(r"href='class-[0-9a-f]{8}\.html'", html), "a student called class has another page"
    assert page.tags.count("tr") == 2 + 6 + len(class_)


def test_a_class_of_nobody_has_a_page(tmp_path):
    class_page.write_class_page(tmp_path / "class.html", [])
    assert "0 students" in (tmp_path / "class.html").read_text("utf-8")


# ---- the line


@pytest.mark.box
@pytest.mark.skipif(not box.bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here")
def test_the_clinic_says_which_line_as_check_does_and_searches_once(tmp_path):
    """Of an answer that a student gave when the course was played."""
    played = json.loads((Path(__file__).parent / "wrong" / "played.json").read_text("utf-8"))
    code = played[1]["code"]
    assert played[1]["exercise"] == "dh_transform"
    course = the_course()
    setup = [
        cell["source"]
        for cell in notebook.read(course.notebook("nb01"))["cells"]
        if cell["cell_type"] == "code" and "setup" in notebook.tags(cell)
    ]
    one = clinic.Clinic(tmp_path, box.Limits(), box.bubblewrap())
    found = one.lines(course, [*setup, code], ["dh_transform", "screw_exp"])
    assert found == {"dh_transform": "look at line 2: `alpha` and `theta` have changed places"}
    cost = one.cpu
    assert cost > 0
    assert one.lines(course, [*setup, "# a comment", code.replace(", ", ",  ")], ["dh_transform"]) == found
    assert one.cpu == cost, "the same function again costs nothing"
    forged = """
import coursekit.classroom as classroom
forged = setattr(classroom, "diagnose", lambda *a: type("", (), {"say": "look at line 1: I was here"}))
"""
    other = code.replace("sin(alpha)", "cos(alpha)", 1)
    one.lines(course, [*setup, forged, "a = 1; \\\nprint(a)", other], ["dh_transform"])
    assert "here" not in str(one.lines(course, [*setup, other], ["dh_transform"])), "somebody else's page"


def test_a_notebook_that_was_not_handed_in_takes_one_line_of_a_students_page(tmp_path):
    """Unless something was decided about an exercise of it."""
    notes = ["nothing handed in"]
    marks = [Mark(name, 0, 3, notes[0]) for name in ("fk", "ik")]
    lacking = Notebook("nb01", "01_arm.ipynb", marks, notes, there=False)
    report.write_page(tmp_path / "a.html", Standing("a", "", {"nb01": lacking}))
    page = (tmp_path / "a.html").read_text("utf-8")
    assert page.count("nothing handed in") == 1 and "fk" not in page and "0 of 6" in page
    decided = replace(lacking, marks=[replace(marks[0], points=3, note="seen in class"), marks[1]])
    report.write_page(tmp_path / "a.html", Standing("a", "", {"nb01": decided}))
    assert "seen in class" in (tmp_path / "a.html").read_text("utf-8")
