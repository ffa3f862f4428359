"""`coursekit lab`: what it asks of JupyterLab, and where things get written (test_fresh.py starts it)."""

import os
from pathlib import Path

import pytest

from coursekit.classroom import lab


@pytest.fixture
def asked(monkeypatch):
    """The arguments that JupyterLab would have been started with; the environment is put back afterwards."""
    from jupyterlab.labapp import LabApp

    arguments = []
    monkeypatch.setattr(LabApp, "launch_instance", classmethod(lambda cls, argv: arguments.extend(argv)))
    for variable in (*lab.private_folders("."), "PATH"):
        monkeypatch.setenv(variable, os.environ.get(variable, ""))
    return arguments


@pytest.fixture
def notebooks(tmp_path):
    folder = tmp_path / "notebooks"
    folder.mkdir()
    for name in ("01_first.ipynb", "02_second.ipynb"):
        (folder / name).write_text("{}")
    return folder


def test_everything_is_written_inside_one_folder(asked, notebooks, tmp_path):
    private = tmp_path / "private"
    lab.start(notebooks=notebooks, folder=private)
    for variable in lab.private_folders(private):
        written = Path(os.environ[variable])
        assert written.is_dir() and written.is_relative_to(private)


def test_the_first_start_opens_the_first_notebook_and_later_ones_what_was_open(asked, notebooks, tmp_path):
    lab.start(notebooks=notebooks, folder=tmp_path / "private")
    assert "--LabApp.default_url=/lab/tree/01_first.ipynb" in asked
    asked.clear()
    lab.start(notebooks=notebooks, folder=tmp_path / "private")
    assert f"--ServerApp.root_dir={notebooks}" in asked
    assert not [argument for argument in asked if "default_url" in argument]


def test_a_student_comes_back_to_the_notebook_that_was_run_last(asked, notebooks, tmp_path, capsys):
    (notebooks / "02_second.ipynb").write_text('{"execution_count": 3}')
    os.utime(notebooks / "02_second.ipynb", (1, 1))  # the other one was written later, and never run
    lab.start(notebooks=notebooks, folder=tmp_path / "private")
    assert "--LabApp.default_url=/lab/tree/02_second.ipynb" in asked


def test_the_solved_notebooks_are_no_students(asked, tmp_path):
    lab.start(folder=tmp_path / "private")
    assert "--LabApp.default_url=/lab/tree/01_dh_vs_poe.ipynb" in asked


def test_progress_is_told_in_one_line(asked, notebooks, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(lab, "progress", lambda folder: f"goals reached in {folder.name}")
    lab.start(notebooks=notebooks, folder=tmp_path / "private")
    assert capsys.readouterr().out == "goals reached in notebooks\n"


def test_arguments_are_passed_on_after_its_own(asked, notebooks, tmp_path):
    lab.start(["--no-browser", "--port=8899"], notebooks=notebooks, folder=tmp_path / "private")
    assert asked[-2:] == ["--no-browser", "--port=8899"]


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="Windows has no root")
@pytest.mark.parametrize(("user", "allowed"), [(0, True), (1000, False)])
def test_root_is_let_in_and_nobody_else_needs_to_be(asked, notebooks, tmp_path, monkeypatch, user, allowed):
    monkeypatch.setattr(os, "geteuid", lambda: user)
    lab.start(notebooks=notebooks, folder=tmp_path / "private")
    assert ("--allow-root" in asked) == allowed


def test_a_missing_folder_is_named(asked, tmp_path):
    with pytest.raises(ValueError, match=r"folder .*lessons, which does not exist"):
        lab.start(notebooks=tmp_path / "lessons", folder=tmp_path / "private")
    assert not (tmp_path / "private").exists()
