"""The grader itself: what is handed in, canaries, journal and resume, executors, memory."""

from __future__ import annotations

import concurrent.futures as futures
import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tracemalloc
from pathlib import Path

import psutil
import pytest

from coursekit.classroom.author import notebook
from coursekit.classroom.course import Course
from coursekit.classroom.grader import box, grade, viva
from coursekit.classroom.grader import student as students
from coursekit.classroom.grader.box import bubblewrap
from coursekit.classroom.grader.journal import Journal
from coursekit.classroom.grader.locked import INSIDE
from coursekit.classroom.grader.submissions import Submissions
from tests.classroom.small import COURSE, HERE, NAME, ROOT, grade_small, hand_in, points, records
from tests.needs import needed

needs_box = pytest.mark.skipif(
    not bubblewrap() and not os.environ.get("CI"), reason="bubblewrap does not work here"
)
pytestmark = pytest.mark.box
FULL, NOTHING = (2, 3, 3, 4), (0, 0, 0, 0)


@pytest.fixture
def solved():
    return notebook.read(COURSE.notebook("nb01"))


def wrong_fk(solved):
    return json.loads(json.dumps(solved).replace("np.cos(a) +", "np.sin(a) +"))


def rows(out):
    with open(out / "grades.csv", newline="", encoding="utf-8-sig") as file:
        return {row["student"]: row for row in csv.DictReader(file)}


@needs_box
def test_links_folders_and_pipes_are_not_followed_and_nobody_is_forgotten(tmp_path, solved):
    classmate = hand_in(tmp_path / "in", "ann", solved)
    for student in ("link", "folder", "pipe", "missing", "otherwise named", "=1+1"):
        (tmp_path / "in" / student).mkdir()
    (tmp_path / "in" / "link" / NAME).symlink_to(classmate)
    (tmp_path / "in" / "folder" / NAME).mkdir()
    os.mkfifo(tmp_path / "in" / "pipe" / NAME)
    shutil.copy(classmate, tmp_path / "in" / "otherwise named" / "arm (1)\u202e.ipynb")
    (tmp_path / "in" / "alias").symlink_to(tmp_path / "in" / "ann")
    (tmp_path / "in" / "notes.txt").write_text("not a student")
    summary = grade_small(tmp_path / "in", tmp_path / "out")
    assert "8 students" in summary
    table = rows(tmp_path / "out")
    assert table.pop("ann")["points"] == "12"
    assert set(table) == {"link", "folder", "pipe", "missing", "otherwise named", "'=1+1", "alias"}
    assert {row["points"] for row in table.values()} == {"0"}
    assert "link" in table["link"]["notes"] and "link" in table["alias"]["notes"]
    assert "nothing handed in" in table["missing"]["notes"]
    assert "under the name 01_arm.ipynb (found: arm (1)?.ipynb)" in table["otherwise named"]["notes"]


@needs_box
def test_odd_folders_and_files_neither_end_the_run_nor_count_as_students(tmp_path, solved):
    """What JupyterLab and macOS leave, grades among the submissions, zips, the longest of names."""
    long = "n" * 255
    for student in (
        long,
        "class",
        "zipped",
        "old/.ipynb_checkpoints",
        "__MACOSX",
        ".ipynb_checkpoints",
        "out",
    ):
        hand_in(tmp_path / "in", student, solved)
    (tmp_path / "in" / "zipped" / NAME).rename(tmp_path / "in" / "zipped" / "work.ZIP")
    (tmp_path / "in" / "ann_late_123_456_01_arm.ipynb").write_text("{}")
    summary = grade_small(tmp_path / "in", tmp_path / "in" / "out")
    table = rows(tmp_path / "in" / "out")
    assert {name: row["points"] for name, row in table.items()} == {
        long: "12",
        "class": "12",
        "zipped": "0",
        "old": "0",
    }
    assert "found: work.ZIP" in table["zipped"]["notes"]
    assert "1 files beside the students' folders" in summary and "coursekit collect" in summary
    names = {path.name for path in (tmp_path / "in" / "out").glob("*.html")}
    assert len(names) == 5
    page = (tmp_path / "in" / "out" / "class.html").read_text("utf-8")
    assert "The class at a glance" in page, "and not that of the student who is called class"
    assert (tmp_path / "in" / "out" / "grades.csv").read_bytes().startswith(b"\xef\xbb\xbf")


def test_a_folder_that_may_not_be_listed_ends_no_run(tmp_path, monkeypatch):
    """In a shared folder students say who may look into theirs."""
    for student in ("ann", "bob"):
        (tmp_path / "in" / student).mkdir(parents=True)
    listed = Path.iterdir

    def refuse(path):
        if path.name == "bob":
            raise PermissionError(13, "Permission denied")
        return listed(path)

    monkeypatch.setattr(Path, "iterdir", refuse)  # root may list everything
    handed_in = Submissions(tmp_path / "in", tmp_path, {"nb01": NAME}, tmp_path / "out")
    assert handed_in.note("ann", "nb01") == handed_in.note("bob", "nb01") == "nothing handed in"


def test_what_cannot_be_graded_is_refused_with_what_to_do(tmp_path, monkeypatch):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "ann_123_456_01_arm.ipynb").write_text("{}")
    with pytest.raises(ValueError, match="coursekit collect"):
        grade_small(tmp_path / "in", tmp_path / "out", box=False)
    for wrong in ({"jobs": 0}, {"seed": -1}):
        with pytest.raises(ValueError, match=r"--jobs is 1 or more, --seed 0 or more; (0|-1) came"):
            grade_small(tmp_path / "in", tmp_path / "out", box=False, **wrong)
    monkeypatch.setattr(grade, "bubblewrap", lambda: "bwrap")
    monkeypatch.setattr(box, "_visible", lambda: ["/usr", str(tmp_path.parent.resolve())])
    with pytest.raises(ValueError, match=f"{tmp_path / 'in'} lies where students' code can read"):
        grade_small(tmp_path / "in", tmp_path / "out")
    with pytest.raises(ValueError, match="where the submissions are"):
        grade_small(tmp_path / "in", tmp_path / "in", box=False)


@needs_box
@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
def test_grades_and_the_seed_of_hidden_inputs_are_nobody_elses(tmp_path, solved):
    """On a hub students have accounts on the instructor's machine."""
    hand_in(tmp_path / "in", "ann", solved)
    before = os.umask(0o022)
    try:
        grade_small(tmp_path / "in", tmp_path / "new" / "out", lines=False)
        viva.viva("ann", tmp_path / "in", tmp_path / "viva", COURSE)
    finally:
        os.umask(before)
    assert (tmp_path / "new" / "out").stat().st_mode & 0o077 == 0
    assert (tmp_path / "viva").stat().st_mode & 0o077 == 0
    (tmp_path / "out").mkdir(mode=0o755)
    grade_small(tmp_path / "in", tmp_path / "out", lines=False)
    assert (tmp_path / "out").stat().st_mode & 0o077 == 0o055, "who opened it meant to"


def test_notebooks_that_lie_deeper_are_told(tmp_path, solved):
    """The folders that a class works in, on a hub: students/<id>/notebooks/<notebook>."""
    (tmp_path / "in" / "bob").mkdir(parents=True)
    hand_in(tmp_path / "in" / "ann", "notebooks", solved)
    with pytest.raises(ValueError, match=r"in/ann/notebooks/01_arm.ipynb.*`coursekit collect "):
        grade_small(tmp_path / "in", tmp_path / "out", box=False)
    hand_in(tmp_path / "in", "bob", solved)
    handed_in = Submissions(tmp_path / "in", tmp_path, {"nb01": NAME}, tmp_path / "out")
    assert handed_in.note("ann", "nb01").endswith("(found: notebooks/01_arm.ipynb)")
    with pytest.raises(ValueError, match="is no folder of submissions: `coursekit collect "):
        grade_small(tmp_path / "in" / "bob" / NAME, tmp_path / "out", box=False)


@needs_box
def test_a_hard_link_to_a_classmates_file_earns_nothing(tmp_path, solved):
    for student in ("ann", "bob", "cem"):
        hand_in(tmp_path / "in", student, solved)
    os.link(tmp_path / "in" / "ann" / NAME, tmp_path / "kept elsewhere by a backup")
    (tmp_path / "in" / "bob" / NAME).unlink()
    os.link(tmp_path / "in" / "cem" / NAME, tmp_path / "in" / "bob" / NAME)
    if os.geteuid() == 0:  # then we can tell whose it is
        os.chown(tmp_path / "in" / "cem", 65534, 65534)
        os.chown(tmp_path / "in" / "cem" / NAME, 65534, 65534)
    grade_small(tmp_path / "in", tmp_path / "out")
    table = rows(tmp_path / "out")
    assert table["ann"]["points"] == "12"
    assert table["bob"]["points"] == "0" and "a hard link (cem)" in table["bob"]["notes"]
    assert table["cem"]["points"] == ("12" if os.geteuid() == 0 else "0")


@needs_box
@pytest.mark.skipif(not box.nobody(), reason="only for root, with a Python that others may read")
def test_an_ordinary_user_grades_from_any_folder(solved):
    folder = Path(tempfile.mkdtemp(prefix="anywhere"))  # pytest's own folders are closed to others
    try:
        hand_in(folder / "in", "ann", solved)
        os.chown(folder, 65534, 65534)
        environment = {**os.environ, "HOME": str(folder), "PYTHONPATH": str(ROOT), "TMPDIR": "/tmp"}
        command = [sys.executable, "-c", SCRIPT, str(folder / "in"), str(folder / "out")]
        user = {"user": 65534, "group": 65534, "extra_groups": []}
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, **user)
        assert done.returncode == 0, done.stderr
        assert rows(folder / "out")["ann"]["points"] == "12"
    finally:
        shutil.rmtree(folder)


def test_a_notebook_that_is_missing_or_doubled_is_refused(tmp_path):
    """JupyterLab's "Duplicate" once made the copy's name the one that everybody had to hand in."""
    (tmp_path / "exercises").mkdir()
    shutil.copy(HERE / "course" / "exercises" / "nb01.py", tmp_path / "exercises")
    with pytest.raises(ValueError, match=r"nb01 needs one notebook 01_\*.ipynb in .*; found: none"):
        grade.grade_class(tmp_path, tmp_path / "out", course=Course(tmp_path, tmp_path), box=False)
    for name in ("01_arm-Copy1.ipynb", "01_arm.ipynb"):
        (tmp_path / name).touch()
    with pytest.raises(ValueError, match=r"found: 01_arm-Copy1.ipynb and 01_arm.ipynb"):
        Course(tmp_path, tmp_path).notebook("nb01")


@needs_box
def test_in_the_box_a_course_below_tmp_is_seen(tmp_path, monkeypatch):
    """The box has a /tmp of its own, which must not hide a Python that lies in the real one."""
    (tmp_path / "python").write_text("is here")
    (tmp_path / "library").mkdir()
    (tmp_path / "course").mkdir()
    (tmp_path / "course" / "solution").write_text("is hidden")
    visible = box._visible()
    monkeypatch.setattr(
        box, "_visible", lambda: [*visible, *map(str, (tmp_path / "python", tmp_path / "course"))]
    )
    monkeypatch.setattr(box, "ROOT", tmp_path / "course")

    (tmp_path / "library" / "runner.py").write_text((INSIDE / "runner.py").read_text())
    one = box.Box(tmp_path / "library", box.Limits(), bubblewrap())
    try:
        cell = f"import os\n\ndef said():\n    assert not os.listdir({str(tmp_path / 'course')!r})\n"
        cell += f"    return len(open({str(tmp_path / 'python')!r}).read())"
        assert "error" not in one.ask({"run": cell, "name": "<cell>"}, 20)
        found = one.ask({"ask": "said", "calls": [[]], "several": 0, "arguments": []}, 20)
        before = box.used(box.family(one._process.pid))
        one.ask({"run": "for k in range(30_000):\n    open(f'/tmp/{k}', 'w').close()", "name": "<cell>"}, 20)
        assert box.used(box.family(one._process.pid)) - before > 30_000_000, "empty files take memory, too"
    finally:
        one.close()
    assert found["answers"][0]["parts"] == [{"shape": [], "values": ["7.0"]}]


@needs_box
def test_the_same_seed_gives_the_same_grades_and_feedback(tmp_path, solved):
    hand_in(tmp_path / "in", "ann", solved)
    hand_in(tmp_path / "in", "bob", wrong_fk(solved))
    tables = []
    for run in ("one", "two"):
        grade_small(tmp_path / "in", tmp_path / run, seed=5)
        tables.append((tmp_path / run / "grades.csv").read_text())
    assert tables[0] == tables[1]
    assert "wrong: entry [0]; the rest is right" in tables[0]
    with pytest.raises(ValueError, match="another run"):
        grade_small(tmp_path / "in", tmp_path / "one", seed=6)


@needs_box
def test_what_decides_a_grade_may_not_change_under_grades(tmp_path, solved):
    """Points or solutions that change would otherwise be mixed with grades by the old ones, in silence."""
    shutil.copytree(HERE / "course", tmp_path / "course")
    course = Course(tmp_path / "course" / "notebooks", tmp_path / "course")
    hand_in(tmp_path / "in", "ann", solved)
    grade_small(tmp_path / "in", tmp_path / "out", course=course)
    path = tmp_path / "course" / "exercises" / "nb01.py"
    path.write_text(path.read_text().replace("n=8", "n=9", 1))
    with pytest.raises(ValueError, match=r"course nb01 changed since.*--regrade"):
        grade_small(tmp_path / "in", tmp_path / "out", course=course)
    grade_small(tmp_path / "in", tmp_path / "out", course=course, regrade=True)
    assert (tmp_path / "out" / "journal.1.jsonl").exists(), "nothing is lost"
    assert len(records(tmp_path / "out")) == 1


def test_two_graders_do_not_write_into_one_journal(tmp_path):
    first = Journal(tmp_path / "journal.jsonl", {"seed": 1})
    with pytest.raises(ValueError, match="another grader is at work"):
        Journal(tmp_path / "journal.jsonl", {"seed": 1})
    first.close()
    Journal(tmp_path / "journal.jsonl", {"seed": 1}).close()


def test_a_journal_believes_only_records_of_whom_it_was_asked_for(tmp_path):
    path = tmp_path / "journal.jsonl"
    journal = Journal(path, {"seed": 1})
    for student in ("ann", "bob"):
        journal.add({"student": student, "unit": "nb01", "digest": student, "exercises": {}})
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([lines[0], lines[2], lines[1]]))
    with pytest.raises(ValueError, match="changed by somebody else: no record of ann"):
        journal.record("ann", "nb01")
    journal.close()
    path.write_bytes(lines[0] + b"garbage\n")
    with pytest.raises(ValueError, match=r"journal.jsonl, line 2 is no record"):
        Journal(path, {"seed": 1})


@needs_box
def test_without_a_seed_one_is_drawn_and_kept(tmp_path, solved):
    hand_in(tmp_path / "in", "ann", solved)
    for out in ("one", "two", "one"):
        grade_small(tmp_path / "in", tmp_path / out)
    heads = [
        json.loads((tmp_path / out / "journal.jsonl").read_text().splitlines()[0]) for out in ("one", "two")
    ]
    assert heads[0]["seed"] != heads[1]["seed"], "a table of hidden answers cannot be made beforehand"
    assert len(records(tmp_path / "one")) == 1, "the second run took the seed of the first"


SCRIPT = """
import sys
from tests.classroom.small import grade_small
from pathlib import Path
grade_small(Path(sys.argv[1]), Path(sys.argv[2]), jobs=1)
"""


@needs_box
def test_nothing_is_lost_after_a_kill_in_the_middle(tmp_path, solved):
    for student in ("ann", "bob", "cem", "dan"):
        hand_in(tmp_path / "in", student, solved)
    journal = tmp_path / "out" / "journal.jsonl"
    command = [sys.executable, "-c", SCRIPT, str(tmp_path / "in"), str(tmp_path / "out")]
    grader = subprocess.Popen(command, cwd=ROOT)
    while not journal.exists() or len(journal.read_bytes().splitlines()) < 3:
        assert grader.poll() is None
        time.sleep(0.05)
    children = psutil.Process(grader.pid).children(recursive=True)
    os.kill(grader.pid, signal.SIGKILL)
    grader.wait()
    psutil.wait_procs(children, timeout=20)
    assert not [p for p in children if p.is_running() and p.status() != psutil.STATUS_ZOMBIE]

    with open(journal, "ab") as file:
        file.write(b'{"student": "bob", "uni')  # it may be killed while it writes
    before = records_that_are_whole(journal)
    assert 1 <= len(before) < 4
    grade_small(tmp_path / "in", tmp_path / "out")
    assert not (tmp_path / "out" / ".copies").exists(), "what the killed run left is gone"
    after = records(tmp_path / "out")
    assert after[: len(before)] == before
    assert sorted(r["student"] for r in after) == ["ann", "bob", "cem", "dan"]
    assert {row["points"] for row in rows(tmp_path / "out").values()} == {"12"}


def records_that_are_whole(journal):
    return [json.loads(line) for line in journal.read_bytes().split(b"\n")[2:-1]]


@needs_box
def test_a_resubmission_is_graded_again_and_nothing_else(tmp_path, solved, monkeypatch):
    hand_in(tmp_path / "in", "ann", solved)
    hand_in(tmp_path / "in", "bob", wrong_fk(solved))
    grade_small(tmp_path / "in", tmp_path / "out")
    assert rows(tmp_path / "out")["bob"]["points"] == "10"
    hand_in(tmp_path / "in", "bob", solved)
    monkeypatch.setattr(grade, "_canaries", None)  # the first run proved the set-up
    grade_small(tmp_path / "in", tmp_path / "out")
    assert rows(tmp_path / "out")["bob"]["points"] == "12"
    assert sorted(r["student"] for r in records(tmp_path / "out")) == ["ann", "bob", "bob"]


@needs_box
@pytest.mark.parametrize("fault", ["solution wrong", "stub right"])
def test_canaries_stop_the_grading(tmp_path, solved, fault):
    """A set-up in which right is not right, or in which nothing suffices, gives no grades at all."""
    shutil.copytree(HERE / "course", tmp_path / "course")
    path = tmp_path / "course" / "notebooks" / NAME
    if fault == "solution wrong":
        solved["cells"].append(hidden_harm("def fk(theta, l1, l2):\n    return np.zeros(2)"))
    else:
        text = json.dumps(solved).replace("### BEGIN SOLUTION", "# ...").replace("### END SOLUTION", "# .")
        solved = json.loads(text)
    notebook.write(path, solved)
    hand_in(tmp_path / "in", "ann", solved)
    course = Course(tmp_path / "course" / "notebooks", tmp_path / "course")
    with pytest.raises(ValueError, match="nobody is graded"):
        grade_small(tmp_path / "in", tmp_path / "out", course=course)
    assert not (tmp_path / "out" / "grades.csv").exists()


def hidden_harm(source):
    cell = {"cell_type": "code", "id": "harm", "metadata": {}, "source": source}
    return {**cell, "outputs": [], "execution_count": None}


def test_without_a_box_grading_refuses(tmp_path, solved, monkeypatch):
    hand_in(tmp_path / "in", "ann", solved)
    monkeypatch.setattr(grade, "bubblewrap", lambda: None)
    with pytest.raises(ValueError, match="--no-box"):
        grade_small(tmp_path / "in", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_grading_without_a_box_works_and_the_table_says_so(tmp_path, solved):
    hand_in(tmp_path / "in", "ann", solved)
    grade_small(tmp_path / "in", tmp_path / "out", box=False)
    row = rows(tmp_path / "out")["ann"]
    assert (row["points"], row["box"]) == ("12", "NO BOX")


@needs_box
def test_a_failure_of_the_grader_is_no_grade(tmp_path, solved, monkeypatch):
    hand_in(tmp_path / "in", "ann", solved)
    hand_in(tmp_path / "in", "bob", solved)
    real = grade._worker

    def failing(job):
        return (None, "the disk is full") if job["student"] == "bob" else real(job)

    monkeypatch.setattr(grade, "_worker", failing)
    assert "1 COULD NOT BE GRADED" in grade_small(tmp_path / "in", tmp_path / "out")
    table = rows(tmp_path / "out")
    assert table["ann"]["points"] == "12"
    assert table["bob"]["points"] == ""
    assert "the disk is full" in table["bob"]["notes"]
    monkeypatch.undo()
    grade_small(tmp_path / "in", tmp_path / "out")
    assert rows(tmp_path / "out")["bob"]["points"] == "12"


@needs_box
def test_a_dask_cluster_takes_the_jobs_unchanged(tmp_path, solved):
    distributed = needed("distributed")
    hand_in(tmp_path / "in", "ann", solved)
    hand_in(tmp_path / "in", "bob", wrong_fk(solved))
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": ":0"}
    with (
        distributed.LocalCluster(**options, local_directory=str(tmp_path / "dask")) as cluster,
        distributed.Client(cluster) as client,
    ):
        grade_small(tmp_path / "in", tmp_path / "out", executor=client.get_executor(pure=False))
    assert {r["student"]: points(r) for r in records(tmp_path / "out")} == {"ann": FULL, "bob": (0, 3, 3, 4)}


def test_slow_definitions_end_with_the_time_of_the_submission(monkeypatch):
    """Else the worker's own time would be over first, and nobody could ever grade them."""
    clock = [0.0]

    class SlowBox:
        cpu = 0.0

        def __init__(self, *_):
            pass

        def ask(self, request, seconds):
            clock[0] += 1.9
            return {}

        def close(self):
            pass

    monkeypatch.setattr(students, "Box", SlowBox)
    monkeypatch.setattr(students.time, "monotonic", lambda: clock[0])
    limits = box.Limits(notebook=30, submission=90)
    slow = students.Student(["x = time.sleep(1.8)"] * 1000, Path(), limits, None, 4)
    with pytest.raises(box.BoxLost, match="the notebook took more than 90 s"):
        slow.ask(COURSE.exercises("nb01")[0], [])
    assert clock[0] < 95


def test_a_large_class_is_never_in_memory_at_once(monkeypatch):
    """1,200 submissions of 1 MB, of which a handful are alive at any time."""
    alive = []

    def instantly(job):
        alive.append(tracemalloc.get_traced_memory()[0])
        return {k: job[k] for k in ("student", "unit", "digest")}

    def jobs():
        for number in range(1200):
            job = {"student": str(number), "unit": "nb01", "digest": "", "name": NAME}
            yield {**job, "notebook": "x" * 1_000_000 + str(number)}

    monkeypatch.setattr(grade, "grade_one", instantly)
    tracemalloc.start()
    with futures.ThreadPoolExecutor(2) as executor:
        students = [record["student"] for record in grade.run_all(executor, jobs(), 6)]
    tracemalloc.stop()
    assert sorted(students, key=int) == [str(number) for number in range(1200)]
    assert max(alive) < 20_000_000
