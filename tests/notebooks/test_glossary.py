"""The glossary: in the order of the alphabet, each word once, and every link of a notebook arrives."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from coursekit.classroom.author import notebook

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
TEXT = (FOLDER / "glossary.md").read_text(encoding="utf-8")
WORDS = re.findall(r"^## (.+)$", TEXT, flags=re.M)


def anchor(word):
    """As Markdown readers make it of a heading."""
    return re.sub(r"[^\w\- ]", "", word.lower()).replace(" ", "-")


def test_words_stand_in_the_order_of_the_alphabet_and_once():
    words = [word.lower() for word in WORDS]
    assert words == sorted(set(words))


@pytest.mark.parametrize("word", WORDS)
def test_every_word_says_where_it_is_used_first_and_what_it_is(word):
    entry = TEXT.split(f"\n## {word}\n")[1].split("\n## ")[0].strip()
    assert re.match(r"\(0[1-6]\) \S", entry), entry[:60]
    assert entry.endswith((".", ")"))


@pytest.mark.parametrize("word", WORDS)
def test_every_word_stands_in_the_notebook_it_names(word):
    """As it is written here, or as what a link to it shows."""
    number = re.search(rf"^## {re.escape(word)}\n\n\((\d\d)\)", TEXT, flags=re.M)[1]
    (path,) = FOLDER.glob(f"{number}_*.ipynb")
    text = " ".join(" ".join(cell["source"] for cell in notebook.read(path)["cells"]).split()).lower()
    written = any(re.search(rf"\b{re.escape(w)}", text) for w in word.lower().split(", "))
    assert written or f"glossary.md#{anchor(word)})" in text


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_links_arrive(path):
    prose = "\n".join(c["source"] for c in notebook.read(path)["cells"] if c["cell_type"] == "markdown")
    wanted = set(re.findall(r"\]\(glossary\.md#([^)]+)\)", prose))
    assert wanted <= {anchor(word) for word in WORDS}
