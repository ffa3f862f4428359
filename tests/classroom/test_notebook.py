"""Notebooks: executed, normalised, read from strangers; and the command line around them."""

from __future__ import annotations

import base64
import io
import json

import pytest
from PIL import Image

from coursekit.__main__ import main
from coursekit.classroom.author import notebook
from coursekit.classroom.grader import cells


def document(*sources):
    cells = [
        {"cell_type": "code", "id": f"c{i}", "metadata": {"collapsed": True}, "source": source, "outputs": []}
        for i, source in enumerate(sources)
    ]
    cells = [{**cell, "execution_count": 7} for cell in cells]
    return {"cells": cells, "metadata": {"editor": "x"}, "nbformat": 4, "nbformat_minor": 5}


def test_executing_twice_writes_the_same_bytes(tmp_path, capsys):
    path = tmp_path / "a.ipynb"
    notebook.write(path, document("x = 2\n", "print('one')\nprint('two')\nx", "import os\nos.environ['CI']"))
    runs = []
    for _ in range(2):
        assert main(["execute", str(path)]) == 0
        runs.append(path.read_bytes())
    assert runs[0] == runs[1]
    written = json.loads(runs[0])
    assert written["metadata"] == {"kernelspec": notebook.KERNEL, "language_info": {"name": "python"}}
    assert [c["execution_count"] for c in written["cells"]] == [1, 2, 3]
    assert [c["metadata"] for c in written["cells"]] == [{}, {}, {}]
    stream, result = written["cells"][1]["outputs"]
    assert "".join(stream["text"]) == "one\ntwo\n"
    assert result["data"]["text/plain"] in ("2", ["2"])
    assert "executed" in capsys.readouterr().out


def test_a_cell_that_fails_stops_the_execution_and_nothing_is_written(tmp_path, capsys):
    path = tmp_path / "a.ipynb"
    notebook.write(path, document("1 / 0"))
    before = path.read_bytes()
    with pytest.raises(Exception, match="ZeroDivisionError"):
        notebook.execute(path)
    assert main(["execute", str(path)]) == 2
    assert capsys.readouterr().err.strip() == (
        f"coursekit execute: {path}, ZeroDivisionError: division by zero; nothing was stored"
    )
    assert path.read_bytes() == before


def test_a_stored_figure_has_at_most_256_colours_and_looks_the_same(tmp_path):
    path = tmp_path / "figure.ipynb"
    notebook.write(path, document("import matplotlib.pyplot as plt\nplt.plot([1, 3, 2])\nplt.show()"))
    notebook.execute(path)
    (cell,) = notebook.read(path)["cells"]
    (png,) = [o["data"]["image/png"] for o in cell["outputs"] if "image/png" in o.get("data", {})]
    image = Image.open(io.BytesIO(base64.b64decode(png)))
    assert image.mode == "P" and len(image.getcolors()) <= 256
    assert image.size[0] > 300 and image.convert("RGB").getpixel((2, 2)) == (255, 255, 255)


def test_a_written_notebook_reads_the_same(tmp_path):
    made = document("a = 1\nb = 2", "")
    notebook.write(tmp_path / "a.ipynb", made)
    assert notebook.read(tmp_path / "a.ipynb") == made
    assert (tmp_path / "a.ipynb").read_bytes().endswith(b"}\n")


@pytest.mark.parametrize(
    "after, kept",
    [(0, {1, 4, 5, 6, 8}), (1, {4, 5, 6, 8}), (4, {8}), (8, set())],
)
def test_definitions_below_a_line_stand_where_they_stood(after, kept):
    source = "import os\nprint(1)\nos.x\n@deco\ndef f():\n    return 1\nf()\nx = 2\n"
    lines = cells.definitions(source, after).split("\n")
    assert {i + 1 for i, line in enumerate(lines) if line != "#"} == kept
    assert all(lines[i - 1] == source.split("\n")[i - 1] for i in kept)


def test_definitions_of_what_is_no_python_are_none():
    assert cells.definitions("%magic\ndef f():\n    pass", 0) == ""


def test_errors_of_the_command_line_are_one_line(tmp_path, capsys):
    assert main(["grade", str(tmp_path / "nowhere"), str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert error.startswith("coursekit grade: ") and error.count("\n") == 1
    assert main(["release", str(tmp_path)]) == 2
    assert "exists already" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["samples", "--unknown"])
    with pytest.raises(SystemExit):
        main([])


@pytest.mark.parametrize("command", ["lab", "study", "release", "grade", "export", "samples", "execute"])
def test_every_command_explains_itself(command, capsys):
    with pytest.raises(SystemExit) as stopped:
        main([command, "--help"])
    assert stopped.value.code == 0
    assert f"coursekit {command}" in capsys.readouterr().out


@pytest.mark.parametrize("word", ["a" * 190_000 + "!", "a." * 90_000 + "!", "x[0]" * 40_000 + "-"])
def test_no_question_for_help_is_read_for_hours(word):
    """IPython's own pattern tries every letter of a word as its beginning, up to its end."""
    assert cells.plain_python(f"{word}?") == f"{word}?"
    assert "getoutput" in cells.plain_python(f"# {word}\nx = !ls")
    assert "pinfo" in cells.plain_python("np.cos?\n!ls")


def test_what_a_function_needs_is_found_by_names_in_any_order():
    chain = [f"v{k} = v{k + 1}" for k in range(3000)]
    source = "\n".join([*chain[::-1], "w = 1", "def fk():", "    return v0"])
    (kept,) = cells.needed([source], "fk")
    assert kept.split("\n") == [*chain[::-1], "#", "def fk():", "    return v0"]
