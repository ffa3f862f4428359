"""Power cuts, full disks, two graders at once: nothing is lost, doubled or mixed, and the text says where."""

from __future__ import annotations

import csv
import json
import os
import random
import signal
import subprocess
import sys
import time

import psutil
import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.grader import box
from coursekit.classroom.grader.journal import Journal
from tests.classroom.small import COURSE, ROOT, grade_small, hand_in, records

needs_box = pytest.mark.skipif(
    not box.bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here"
)
SCRIPT = """
import sys
from pathlib import Path
from tests.classroom.small import grade_small
grade_small(Path(sys.argv[1]), Path(sys.argv[2]), jobs=2, lines=False)
"""
MOMENTS = 30


@pytest.fixture
def class_of_eight(tmp_path):
    """Everybody deserves other points, so that a record in the wrong place would show."""
    solved = notebook.read(COURSE.notebook("nb01"))
    deserve = {}
    for number in range(8):
        document = json.loads(json.dumps(solved))
        points = 0
        for bit, (name, worth) in enumerate([("fk", 2), ("jacobian", 3), ("ik_all", 4)]):
            if number >> bit & 1:
                points += worth
            else:
                document["cells"].append(
                    {"cell_type": "code", "metadata": {}, "source": f"def {name}(*a):\n    return 0.0"}
                )
        hand_in(tmp_path / "in", f"s{number}", document)
        deserve[f"s{number}"] = str(points + 3)
    return tmp_path, deserve


def grader(folder):
    command = [sys.executable, "-c", SCRIPT, str(folder / "in"), str(folder / "out")]
    return subprocess.Popen(command, cwd=ROOT, stderr=subprocess.DEVNULL)


def kill(process):
    children = psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []
    process.send_signal(signal.SIGKILL)
    process.wait()
    psutil.wait_procs(children, timeout=30)
    alive = [one for one in children if one.is_running() and one.status() != psutil.STATUS_ZOMBIE]
    assert not alive


def rows(out):
    with open(out / "grades.csv", newline="", encoding="utf-8-sig") as file:
        return {row["student"]: row["points"] for row in csv.DictReader(file)}


@pytest.mark.box
@needs_box
def test_thirty_kills_at_random_moments_lose_nothing(class_of_eight):
    folder, deserve = class_of_eight
    moments = random.Random(26)
    begun = time.monotonic()
    process = grader(folder)
    assert process.wait() == 0
    whole = time.monotonic() - begun  # how long it takes on this machine now
    done = records(folder / "out")
    (folder / "out" / "journal.jsonl").unlink()
    for _ in range(MOMENTS):
        process = grader(folder)
        try:
            process.wait(moments.uniform(0.2, 0.7) * whole)
        except subprocess.TimeoutExpired:
            kill(process)
        if len(records_so_far(folder / "out")) == len(done):  # all graded: from the beginning again
            check(folder, deserve)
            (folder / "out" / "journal.jsonl").unlink()
    grade_small(folder / "in", folder / "out", lines=False)
    check(folder, deserve)


def records_so_far(out):
    path = out / "journal.jsonl"
    lines = path.read_bytes().split(b"\n")[:-1] if path.exists() else []
    found = [json.loads(line) for line in lines]  # every line that ends is whole
    return [one for one in found if "student" in one]


def check(folder, deserve):
    grade_small(folder / "in", folder / "out", lines=False)
    assert rows(folder / "out") == deserve
    assert sorted(one["student"] for one in records(folder / "out")) == sorted(deserve), "none twice"


def test_a_disk_that_is_full_leaves_no_half_line_and_names_the_file(tmp_path):
    """A limit on the size of files takes the place of the disk: anybody can set it."""
    script = """
import resource, signal, sys
from pathlib import Path
from coursekit.classroom.grader.journal import Journal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
journal = Journal(Path(sys.argv[1]), {"seed": 1})
for number in range(100):
    journal.add({"student": str(number), "unit": "nb01", "digest": "d", "exercises": {}, "text": "x" * 200})
"""
    path = tmp_path / "journal.jsonl"
    done = subprocess.run([sys.executable, "-c", script, path], capture_output=True, text=True, cwd=ROOT)
    assert f"what was graded before is kept: '{path}'" in done.stderr
    journal = Journal(path, {"seed": 1})
    kept = journal.students
    assert 8 <= len(kept) < 100 and path.read_bytes().endswith(b"\n")
    assert all(journal.record(student, "nb01")["student"] == student for student in kept)
    journal.close()


@pytest.mark.box
@needs_box
@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small disk")
def test_a_full_disk_ends_the_run_and_the_next_goes_on(class_of_eight):
    folder, deserve = class_of_eight
    (folder / "out").mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(folder / "out")]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this root may not mount")
    try:
        with pytest.raises(OSError, match="No space left on device"):
            grade_small(folder / "in", folder / "out", lines=False)
        before = records_so_far(folder / "out")
        subprocess.run(["mount", "-o", "remount,size=64m", str(folder / "out")], check=True)
        grade_small(folder / "in", folder / "out", lines=False)
        assert records(folder / "out")[: len(before)] == before
        assert rows(folder / "out") == deserve
    finally:
        subprocess.run(["umount", str(folder / "out")], check=True)


@pytest.mark.box
@needs_box
def test_a_second_grader_is_refused_and_sets_nothing_aside(class_of_eight):
    folder, deserve = class_of_eight
    process = grader(folder)
    try:
        while not (folder / "out" / "journal.jsonl").exists():
            assert process.poll() is None
            time.sleep(0.02)
        for regrade in (False, True):
            with pytest.raises(ValueError, match="another grader is at work"):
                grade_small(folder / "in", folder / "out", regrade=regrade, seed=1)
        assert process.wait() == 0
    finally:
        kill(process)
    assert rows(folder / "out") == deserve
    assert not list((folder / "out").glob("journal.*.jsonl"))


@pytest.mark.parametrize(
    ("harm", "text"),
    [
        (b"\0\0\0\0\n", r"journal.jsonl, line 3 is no record"),
        (b'{"student": "ann"}\n', r"journal.jsonl, line 3 is no record"),
        (b"[1, 2]\n", r"journal.jsonl, line 3 is no record"),
        (b"\xff\xfe\n", r"journal.jsonl, line 3 is no record"),
        (b'{"student": "bob", "unit": "nb', None),
        (b"\0" * 5000, None),
    ],
)
def test_a_torn_journal_is_mended_or_told_with_file_and_line(tmp_path, harm, text):
    path = tmp_path / "journal.jsonl"
    journal = Journal(path, {"seed": 1})
    journal.add({"student": "ann", "unit": "nb01", "digest": "d", "exercises": {}})
    journal.close()
    with open(path, "ab") as file:
        file.write(harm)
    if text:
        with pytest.raises(ValueError, match=text):
            Journal(path, {"seed": 1})
    else:  # killed while it wrote: that submission is graded again
        again = Journal(path, {"seed": 1})
        assert again.students == {"ann"}
        again.close()
        assert len(path.read_bytes().splitlines()) == 2
