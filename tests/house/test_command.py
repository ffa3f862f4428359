"""The command line as one meets it: help, version, exit codes; and the package by its parts."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import coursekit
from coursekit.__main__ import main
from coursekit.commands import COMMANDS

ROOT = Path(__file__).resolve().parents[2]


def test_version_is_said_and_stands_in_one_place(capsys):
    with pytest.raises(SystemExit) as done:
        main(["--version"])
    assert (done.value.code, capsys.readouterr().out) == (0, f"coursekit {coursekit.__version__}\n")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert "version" in project["dynamic"] and "version" not in project


def test_help_names_every_command_and_shows_examples(capsys):
    with pytest.raises(SystemExit) as done:
        main(["--help"])
    said = capsys.readouterr().out
    assert done.value.code == 0
    assert all(name in said for name in COMMANDS)
    assert "coursekit study" in said and "exit codes" in said


@pytest.mark.parametrize("words", [[], ["gradee"], ["release"]])
def test_a_wrong_line_ends_with_2(words, capsys):
    with pytest.raises(SystemExit) as done:
        main(words)
    assert done.value.code == 2
    assert "usage: coursekit" in capsys.readouterr().err


def test_what_stops_a_command_is_one_sentence(monkeypatch, tmp_path, capsys):
    """A Ctrl-C while a class is graded, a path that is wrong: no traceback, no number of an error."""

    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("coursekit.classroom.grader.grade.grade_class", stopped)
    assert main(["grade", str(tmp_path), str(tmp_path / "out")]) == 130
    said = "coursekit grade: stopped; what is graded is kept: run it again, and it goes on\n"
    assert capsys.readouterr().err == said
    assert main(["collect", str(tmp_path), str(tmp_path / "out"), "--roster", "nowhere.csv"]) == 2
    assert capsys.readouterr().err == "coursekit collect: nowhere.csv: No such file or directory\n"
    with open(tmp_path / "said", "w", encoding="cp1252") as window:
        monkeypatch.setattr("sys.stderr", window)
        assert main(["collect", "\u5c0f\u660e", "out"]) == 2
    assert (tmp_path / "said").read_text("cp1252").startswith("coursekit collect: ?? does not exist")


def test_the_mathematics_needs_numpy_alone_and_the_rest_says_what_to_install():
    """In a process where only numpy and the standard library can be imported."""
    script = """
import sys
class Nothing:
    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        known = {*sys.stdlib_module_names, "numpy", "coursekit"}
        if top not in known and not top.startswith("_"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Nothing())
import coursekit
from coursekit import robots, ik, path, singularity, jacobians, subproblems
kr6 = robots.kuka_kr6()
print(ik.analytic(kr6, kr6.fk(kr6.home)).exists.sum() > 0)
try:
    coursekit.view.explore(kr6)
except ModuleNotFoundError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT)
    assert done.stdout.startswith("True\ncoursekit.view.explorers.conventions needs "), done.stderr
    assert 'pip install "coursekit[view]"' in done.stdout
