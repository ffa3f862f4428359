"""Code cells of somebody else's notebook, read without trusting a byte of it."""

from __future__ import annotations

import ast
import json
import re

LARGEST = 20_000_000  # bytes of a notebook
LONGEST = 200_000  # characters of a cell: more takes Python's own reader minutes
_RUNS_ITS_BODY = ("time", "timeit", "capture", "prun")  # of the magics that stand above a whole cell


class Unreadable(ValueError):
    """No notebook of the kind that JupyterLab writes; the text says what it is."""


def sources(data: bytes) -> list[str]:
    """The code cells' texts; ValueError if this is no notebook. Metadata are not even looked at."""
    if len(data) > LARGEST:
        raise ValueError("the notebook is larger than 20 MB")
    try:
        notebook = json.loads(data.decode("utf-8-sig"))
        if isinstance(notebook, dict) and "worksheets" in notebook and "cells" not in notebook:
            raise Unreadable("a notebook of an old format (nbformat 3): open it in JupyterLab and save it")
        cells = notebook["cells"]
        code = [_text(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    except Unreadable:
        raise
    except (ValueError, KeyError, TypeError, RecursionError, AttributeError) as error:
        raise ValueError(f"not a readable notebook ({type(error).__name__})") from None
    return [plain_python(text) for text in code if text.strip()]


def _text(source) -> str:
    text = source if isinstance(source, str) else "".join(source)
    text = text.replace("\r\n", "\n").encode("utf-8", "replace").decode("utf-8")  # no lone surrogates
    return re.sub(r"\A(\s*\n)+", "", text)


def plain_python(text: str) -> str:
    """A cell as Python: magics, questions and shell lines become calls of `get_ipython()`, line by line."""
    if len(text) > LONGEST:
        return ""
    first, _, body = text.partition("\n")
    if first.startswith("%%"):  # a magic for the whole cell
        name = first[2:].split(" ")[0].strip()
        return plain_python(f"#\n{body}") if name in _RUNS_ITS_BODY else ""
    if _parses(text):
        return text
    from IPython.core.inputtransformer2 import TransformerManager  # text to text: nothing is run

    try:
        return TransformerManager().transform_cell(text)
    except Exception:  # no Python, and no IPython either: the box will say so
        return text


def _parses(text: str) -> bool:
    try:
        ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


def why_missing(data: bytes, code: list[str], name: str) -> str:
    """Why a notebook defines no function of this name, as far as its text tells. code: its `sources`."""
    begins = re.compile(rf"^[^\S\n]*(async\s+)?def\s+{re.escape(name)}\b", re.MULTILINE)
    for source in filter(begins.search, code):
        try:
            ast.parse(source)
        except SyntaxError as error:
            return f"the cell with `def {name}` is no Python: line {error.lineno}, {error.msg}"
        except (ValueError, RecursionError, MemoryError):
            continue
    others = (c for c in json.loads(data.decode("utf-8-sig"))["cells"] if c["cell_type"] != "code")
    if any(begins.search(_text(cell["source"])) for cell in others):
        return f"the cell with `def {name}` is no code cell (Esc, then Y makes it one): nothing in it was run"
    return "the notebook defines no such function"


def definitions(source: str, after: int) -> str:
    """Functions, classes, imports and assignments of a cell below a line, every one still on its own line.

    '' if the cell is not plain Python (a magic, a syntax error): then it runs whole or not at all.
    """
    try:
        statements = ast.parse(source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ""
    lines = source.split("\n")
    kept = ["#"] * len(lines)  # so that a line that is left out still counts
    wanted = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Assign)
    for node in statements:
        decorators = getattr(node, "decorator_list", [])
        first = min([node.lineno, *(d.lineno for d in decorators)])
        if first > after and isinstance(node, (*wanted, ast.AnnAssign)):
            kept[first - 1 : node.end_lineno] = lines[first - 1 : node.end_lineno]
    return "\n".join(kept)
