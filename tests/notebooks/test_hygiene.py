"""What every stored notebook keeps to: order, size, metadata, headings, captions, prompts, clean outputs."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from statistics import median

import pytest

from coursekit.classroom.author import notebook

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
NAMES = (
    "01_dh_vs_poe",
    "02_msb_derivation",
    "03_inverse_kinematics",
    "04_singularities",
    "05_jacobian_methods",
    "06_path_speed",
)
WIDGET = "application/vnd.jupyter.widget-view+json"
SHOWN = ("text/plain", "text/html", "text/latex", "text/markdown")
# nbval skips the output of a cell with one of these; none is needed, and none may creep in.
UNCOMPARED = re.compile(r"NBVAL_|nbval-|raises-exception")
EMOJI = re.compile("[\U0001f000-\U0001faff\u2600-\u26ff\u2705\u274c\u2728\u2b50\ufe0f]")
# Notes to oneself, and words that tell a reader who is stuck that it is his own fault.
FORBIDDEN = re.compile(
    r"\b(TODO|FIXME|XXX|lorem ipsum|obvious(ly)?|trivial(ly)?|of course|easy to see|needless to say|silly)\b",
    re.IGNORECASE,
)
MACHINE = re.compile(
    r"(/home/|/root/|/tmp/|/usr/|[A-Z]:\\Users|localhost|127\.0\.0\.1|https?://[^\s/]+:\d+| at 0x[0-9a-f]{6})"
)


def read(path):
    return notebook.read(path)


@pytest.fixture(params=sorted(FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def path(request):
    return request.param


@pytest.fixture
def cells(path):
    return read(path)["cells"]


def code(cells):
    return [cell for cell in cells if cell["cell_type"] == "code"]


def prose(cells):
    return [cell for cell in cells if cell["cell_type"] == "markdown"]


def lines_of(cell):
    """Lines of code: neither blank nor a comment."""
    lines = (line.strip() for line in cell["source"].splitlines())
    return [line for line in lines if line and not line.startswith("#")]


def words_of(source):
    """Words a student reads: no formulas, no code, no tags."""
    bare = re.sub(r"```.*?```|\$\$.*?\$\$|\$[^$]*\$|`[^`]*`|<[^>]+>", " ", source, flags=re.S)
    return [word for word in re.split(r"[\s|]+", bare) if re.search(r"[^\W\d_]{2}", word) or word in "aAI"]


def printed(cell):
    """Every text an output shows."""
    for output in cell["outputs"]:
        if output["output_type"] == "stream":
            yield "".join(output["text"])
        for mime, value in output.get("data", {}).items():
            if mime in SHOWN:
                yield "".join(value)


def is_explorer(cell):
    return cell["cell_type"] == "code" and "view.explore" in cell["source"]


def has_figure(cell):
    """A picture that is not the stand-in of an explorer."""
    pictures = any("image/png" in output.get("data", {}) for output in cell["outputs"])
    return pictures and not is_explorer(cell)


def test_all_six_are_there():
    assert [path.stem for path in sorted(FOLDER.glob("*.ipynb"))] == list(NAMES)


# -- stored as it was run ---------------------------------------------------------------------------------


def test_every_code_cell_was_run_in_order(cells):
    assert [cell["execution_count"] for cell in code(cells)] == list(range(1, len(code(cells)) + 1))


def test_metadata_is_the_same_on_every_machine(path):
    stored = read(path)
    assert stored["metadata"] == {"kernelspec": notebook.KERNEL, "language_info": {"name": "python"}}
    assert (stored["nbformat"], stored["nbformat_minor"]) == (4, 5)
    for cell in stored["cells"]:
        assert set(cell["metadata"]) <= {"nbgrader", "tags"}, cell["id"]
        assert set(cell["metadata"].get("tags", [])) <= {"setup", "instructor", "further"}, cell["id"]


def test_cell_ids_are_unique_and_can_be_read(cells):
    ids = [cell["id"] for cell in cells]
    assert len(set(ids)) == len(ids)
    odd = [i for i in ids if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", i) or len(i) > 64]
    drawn = [i for i in ids if re.fullmatch(r"[0-9a-f]{8}(-[0-9a-f-]+)?", i)]  # what an editor invents
    assert (odd, drawn) == ([], [])


def test_size(path):
    assert path.stat().st_size <= 400 * 1024


def test_the_file_is_written_as_the_course_writes_it(path, tmp_path):
    again = tmp_path / path.name
    notebook.write(again, read(path))
    assert again.read_bytes() == path.read_bytes()


# -- outputs that compare ------------------------------------------------------------------------------------


def test_nothing_was_written_to_stderr_and_no_cell_failed(cells):
    for cell in code(cells):
        for output in cell["outputs"]:
            assert output["output_type"] != "error", cell["id"]
            assert output.get("name") != "stderr", cell["id"]
            assert not any("Warning" in shown for shown in printed(cell)), cell["id"]


def test_outputs_name_no_place_on_a_machine(cells):
    found = {cell["id"]: MACHINE.findall("\n".join(printed(cell))) for cell in code(cells)}
    assert {i: f for i, f in found.items() if f} == {}


def test_numbers_are_printed_through_the_formatter(cells):
    """A rest of rounding differs from machine to machine, and -0 from run to run."""
    rest = re.compile(r"\d\.?\d*e-1[5-9]|(?<![\w.])-0(\.0*)?(?![\d.])")
    for cell in code(cells):
        for shown in printed(cell):
            allowed = re.sub(r"below \de-1\d", "", shown)
            assert not rest.search(allowed), (cell["id"], rest.search(allowed).group())


def test_no_widget_is_stored(path):
    """Its model lives in a kernel that is gone: a reader would see an error in place of the picture."""
    stored = read(path)
    assert "widgets" not in stored["metadata"]
    for cell in code(stored["cells"]):
        assert not any(WIDGET in output.get("data", {}) for output in cell["outputs"]), cell["id"]


def test_every_output_is_compared(cells):
    for cell in code(cells):
        assert not UNCOMPARED.search(cell["source"]), cell["id"]
        assert not UNCOMPARED.search(" ".join(cell["metadata"].get("tags", []))), cell["id"]


# -- a notebook that one likes to read -----------------------------------------------------------------------


def test_cells_words_and_lines(cells):
    """The core path has at most 2,200 words; what is tagged `further` stands beside it."""
    lengths = [len(lines_of(cell)) for cell in code(cells)]
    core = [cell for cell in prose(cells) if "further" not in notebook.tags(cell)]
    words = sum(len(words_of(cell["source"])) for cell in core)
    assert 25 <= len(cells) <= 70, "cells"
    assert 900 <= words <= 2200, "words of the core path"
    assert sum(lengths) <= 350, "lines of code"
    assert median(lengths) <= 6, "lines of code in a cell, as a rule"
    longest = max(code(cells), key=lambda cell: len(lines_of(cell)))
    assert max(lengths) <= 25, f"lines of code in {longest['id']}"


def test_headings_are_in_order(cells):
    text = "\n".join(cell["source"] for cell in prose(cells))
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    levels = [len(found) for found in re.findall(r"^(#+) ", text, flags=re.M)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_a_caption_stands_under_every_figure(cells):
    for cell, after in zip(cells, [*cells[1:], None], strict=True):
        if cell["cell_type"] == "code" and has_figure(cell):
            assert after is not None and after["cell_type"] == "markdown", cell["id"]
            assert re.match(r"\s*[*_]*Figure \d+", after["source"]), cell["id"]


def test_figures_are_numbered_in_order(cells):
    found = [re.match(r"\s*[*_]*Figure (\d+)", cell["source"]) for cell in prose(cells)]
    numbers = [int(match[1]) for match in found if match]
    assert numbers == list(range(1, len(numbers) + 1))


def test_prompts_come_with_choices_and_a_folded_answer(cells):
    prompts = [cell["source"] for cell in prose(cells) if "**Predict" in cell["source"]]
    assert sum(source.count("**Predict") for source in prompts) >= 4
    for source in prompts:
        question = source.partition("**Predict")[2]
        assert all(choice in question for choice in ("(a)", "(b)")), source[:60]
        assert re.search(r"<details>\s*<summary>Answer", question), source[:60]


def test_details_are_closed(cells):
    for cell in prose(cells):
        assert cell["source"].count("<details") == cell["source"].count("</details>"), cell["id"]


def test_exercises_and_their_checks(cells):
    solutions = [cell for cell in cells if notebook.is_solution(cell)]
    checks = [cell for cell in cells if notebook.is_check(cell)]
    assert 4 <= len(solutions) <= 9, "exercises of a notebook: one more may have to take the place of another"
    names = [cell["metadata"]["nbgrader"]["grade_id"] for cell in solutions]
    assert [cell["metadata"]["nbgrader"]["grade_id"] for cell in checks] == [f"check-{n}" for n in names]
    for cell, name in zip(checks, names, strict=True):
        assert "".join(printed(cell)).startswith(f"✓ {name}: right on"), cell["id"]


def test_the_readme_says_how_many_exercises_there_are(path, cells):
    readme = (FOLDER.parent / "README.md").read_text(encoding="utf-8")
    (said,) = re.findall(rf"^\|.*\(notebooks/{path.name}\).*\| (\d+) \|$", readme, flags=re.M)
    assert int(said) == sum(map(notebook.is_solution, cells)), "the last column of README.md's table"


def test_one_set_up_cell_one_bug_hunt_one_table_of_results(cells):
    (setup,) = [cell for cell in cells if "setup" in notebook.tags(cell)]
    assert setup is code(cells)[0]
    assert len(lines_of(setup)) <= 4
    text = "\n".join(cell["source"] for cell in prose(cells))
    assert len(re.findall(r"^#+ .*bug hunt", text, flags=re.M | re.I)) == 1
    summary = re.split(r"^## .*Summary.*$", text, flags=re.M)
    assert len(summary) == 2
    assert re.search(r"^\|\s*:?-+", summary[1], flags=re.M), "the summary has no table"
    assert re.search(r"^#+ .*(test yourself|self-test)", text, flags=re.M | re.I)


def test_the_explorer_is_one_line_and_leaves_a_picture(cells):
    explorers = [cell for cell in cells if is_explorer(cell)]
    assert explorers
    for cell in explorers:
        assert len(lines_of(cell)) == 1, cell["id"]
        (output,) = cell["outputs"]
        assert {"image/png", "text/plain"} <= set(output["data"]), cell["id"]
        assert "".join(output["data"]["text/plain"]).startswith("Explorer of "), cell["id"]


def test_words_that_have_no_place_here(cells):
    for cell in cells:
        text = "\n".join([cell["source"], *(printed(cell) if cell["cell_type"] == "code" else [])])
        assert not FORBIDDEN.search(text), (cell["id"], FORBIDDEN.search(text).group())
        assert not EMOJI.search(text), (cell["id"], EMOJI.search(text).group())
