"""Honest, odd, broken and hostile submissions in one class: every grade fair, nobody else's touched."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import socket
import tempfile
import threading

import psutil
import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.grader.box import bubblewrap
from coursekit.classroom.grader.worker import hidden_inputs
from tests.classroom.hostile import FULL, KINDS, TELLS
from tests.classroom.small import COURSE, ROOT, grade_small, hand_in, points, records

pytestmark = [
    pytest.mark.box,
    pytest.mark.skipif(not bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here"),
]


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """All kinds graded in one run, with a server that nobody may reach and a file that nobody may make."""
    folder = tmp_path_factory.mktemp("class")
    solved = notebook.read(COURSE.notebook("nb01"))
    listener = socket.create_server(("127.0.0.1", 0))
    calls = []
    threading.Thread(target=_listen, args=(listener, calls), daemon=True).start()
    places = {
        "PORT": listener.getsockname()[1],
        "SOLVED": str(COURSE.notebook("nb01")),
        "SAMPLES": str(COURSE.samples_path("nb01")),
        "ROOT": str(ROOT),
    }
    for student, kind in KINDS.items():
        document = kind.make(solved)
        if isinstance(document, dict):
            lines = "\n".join(f"{name} = {value!r}" for name, value in places.items())
            document = {**document, "cells": [code_cell(lines), *document["cells"]]}
        hand_in(folder / "in", student, document)
    before = fingerprints(folder / "in")
    scratch = tempfile.mkdtemp(prefix="class")  # short: names of sockets are made from it
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMPDIR", scratch)
        grade_small(folder / "in", folder / "out", jobs=2)
    listener.close()
    by_student = {record["student"]: record for record in records(folder / "out")}
    yield {"records": by_student, "calls": calls, "folder": folder, "before": before, "scratch": scratch}
    shutil.rmtree(scratch)


def code_cell(source: str) -> dict:
    return {"cell_type": "code", "metadata": {}, "source": source}


def _listen(listener, calls):
    while True:
        try:
            calls.append(listener.accept())
        except OSError:
            return


def fingerprints(folder) -> dict:
    return {str(p): (p.stat().st_mtime_ns, p.stat().st_size) for p in folder.rglob("*") if p.is_file()}


@pytest.mark.parametrize("name", KINDS)
def test_everybody_gets_what_they_deserve(graded, name):
    record, kind = graded["records"][name], KINDS[name]
    assert not record.get("failed"), record["notes"]
    assert points(record) == kind.points, record
    assert kind.feedback in record["exercises"]["fk"]["text"]
    assert kind.note in " ".join(record["notes"])


def test_there_are_at_least_forty_kinds_that_do_not_deserve_full_marks():
    assert sum(kind.points != FULL for kind in KINDS.values()) >= 40


def test_nobody_reached_the_network_or_touched_other_work(graded):
    assert graded["calls"] == []
    assert fingerprints(graded["folder"] / "in") == graded["before"]


def test_no_process_and_no_file_is_left(graded):
    commands = [" ".join(p.info["cmdline"] or []) for p in psutil.process_iter(["cmdline"])]
    assert not [command for command in commands if graded["scratch"] in command]
    assert os.listdir(graded["scratch"]) == []


def test_every_student_has_a_row_and_a_page(graded):
    out = graded["folder"] / "out"
    with open(out / "grades.csv", newline="", encoding="utf-8-sig") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert set(rows) == set(KINDS)
    for name, kind in KINDS.items():
        assert rows[name]["points"] == str(sum(kind.points))
        assert rows[name]["of"] == "12"
        assert rows[name]["box"].startswith("bubblewrap")
        assert (out / f"{name}.html").exists()


def test_no_cell_of_the_table_is_a_formula(graded):
    with open(graded["folder"] / "out" / "grades.csv", newline="", encoding="utf-8-sig") as file:
        cells = [cell for row in csv.reader(file) for cell in row]
    assert not [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]


def test_pages_escape_what_students_wrote(graded):
    page = (graded["folder"] / "out" / "marks_that_lie.html").read_text("utf-8")
    assert "&lt;b&gt;" in page
    assert "<b>" not in page
    page = (graded["folder"] / "out" / "class.html").read_text("utf-8")
    assert "&lt;script&gt;" in page
    assert "<script" not in page


@pytest.mark.parametrize("name", TELLS)
def test_a_page_tells_no_text_of_an_error(graded, name):
    name = f"tells_the_hidden_inputs_{name}"
    said = graded["records"][name]["exercises"]["fk"]["text"]
    page = (graded["folder"] / "out" / f"{name}.html").read_text("utf-8")
    longest = max(re.findall(r"\w+", said), key=len)  # the instructor can read it
    assert len(longest) > 15
    assert longest not in page
    assert "is not shown" in page or "something of coursekit" in page


def test_pages_hold_no_hidden_number(graded):
    pages = "".join(p.read_text("utf-8") for p in (graded["folder"] / "out").glob("*.html"))
    head = json.loads((graded["folder"] / "out" / "journal.jsonl").read_text().splitlines()[0])
    hidden = [hidden_inputs(e, head["seed"], "nb01") for e in COURSE.exercises("nb01")]
    numbers = {str(x)[:8] for x in _floats(json.loads(json.dumps(hidden)))}
    assert len(numbers) > 50
    assert not [number for number in numbers if number in pages]


def _floats(value):
    if isinstance(value, list):
        return [x for y in value for x in _floats(y)]
    return [value] if isinstance(value, float) else []
