"""Code cells of somebody else's notebook, read without trusting a byte of it."""

from __future__ import annotations

import ast
import contextlib
import json
import re
import signal
import threading
from collections.abc import Iterator

LARGEST = 20_000_000  # bytes of a notebook
LONGEST = 200_000  # characters of a cell: more takes Python's own reader minutes
EFFORT = 2_000_000  # characters read of all cells; IPython reads a cell anew for each magic in it
_MAGIC = re.compile(r"^[ \t]*[%!?/,;]|\?[ \t]*$|=[ \t]*[%!]", re.MULTILINE)
_HELP, _LONG_WORD = re.compile(r"\?\s*$", re.MULTILINE), re.compile(r"[\w*.\[\]-]{1000}")
_RUNS_ITS_BODY = ("time", "timeit", "capture", "prun")  # of the magics that stand above a whole cell

# A module that a cell writes, for others to import: the import system has to look into the folder again.
_MODULE = re.compile(r"%%(?:writefile|file)\s+(-a\s+|--append\s+)?(\w+\.py)\s*")
_WRITE = "open({!r}, {!r}, encoding='utf-8').write({!r})\n__import__('importlib').invalidate_caches()"


class Unreadable(ValueError):
    """No notebook of the kind that JupyterLab writes; the text says what it is."""


class _Late(BaseException):
    """The time to read a notebook is over. Not an Exception: IPython's reader catches those."""


@contextlib.contextmanager
def in_time(seconds: float) -> Iterator[None]:
    """ValueError if it takes longer: there are texts that Python's own tokenizer would read for hours."""

    def ring(*_: object) -> None:
        raise _Late

    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    except _Late:
        text = f"not a readable notebook (to read its code takes more than {seconds:g} s): mind long lines"
        raise ValueError(text) from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def sources(data: bytes) -> tuple[list[str], list[str]]:
    """Texts of the code cells, and of cells whose text is not run; ValueError if this is no notebook.

    Metadata are not even looked at. UTF-16 is read, too: some editors of Windows save it.
    """
    if len(data) > LARGEST:
        raise ValueError("the notebook is larger than 20 MB")
    try:
        notebook = json.loads(data)
        if isinstance(notebook, dict) and "worksheets" in notebook and "cells" not in notebook:
            raise Unreadable("a notebook of an old format (nbformat 3): open it in JupyterLab and save it")
        cells = notebook["cells"]
        code = [_text(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        others = [_text(cell["source"]) for cell in cells if cell["cell_type"] != "code"]
    except Unreadable:
        raise
    except UnicodeDecodeError:
        raise ValueError(
            "not a readable notebook (its letters are not UTF-8): save it in JupyterLab"
        ) from None
    except (ValueError, KeyError, TypeError, RecursionError, AttributeError) as error:
        why = "damaged, or cut off" if isinstance(error, ValueError) else "JupyterLab writes others"
        raise ValueError(f"not a readable notebook ({why}): save it in JupyterLab") from None
    plain, left = [], EFFORT
    for text in filter(str.strip, code):
        if len(text) <= LONGEST:
            left -= (500 + len(text)) * (1 + len(_MAGIC.findall(text)))
        plain.append(plain_python(text) if left > 0 else "")
    return plain, [*others, *(text for text in code if text.startswith("%%"))]


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
        if file := _MODULE.fullmatch(first):
            return _WRITE.format(file[2], "a" if file[1] else "w", body)
        return plain_python(f"#\n{body}") if name in _RUNS_ITS_BODY else ""
    if _parses(text) or (_HELP.search(text) and _LONG_WORD.search(text)):
        return text  # where `?` asks for help, IPython would read such a word for hours
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


def why_missing(code: list[str], others: list[str], name: str) -> str:
    """Why a notebook defines no function of this name, by its texts. code, others: its `sources`."""
    begins = re.compile(rf"^[^\S\n]*(async\s+)?def\s+{re.escape(name)}\b", re.MULTILINE)
    for source in filter(begins.search, code):
        try:
            ast.parse(source)
        except SyntaxError as error:
            line = f"line {error.lineno}, " if error.lineno else ""
            return f"the cell with `def {name}` is no Python: {line}{error.msg}"
        except (ValueError, RecursionError, MemoryError):
            continue
    idle = next(filter(begins.search, others), "")
    if idle.startswith("%%"):
        magic = idle.split()[0]
        return f"the cell with `def {name}` begins with {magic}: take that line out, nothing below it was run"
    if idle:
        return f"the cell with `def {name}` is no code cell (Esc, then Y makes it one): nothing in it was run"
    takes = re.compile(rf"^({name}\s*=[^=]|del\b.*\b{name}\b)", re.MULTILINE)
    if taken := next((found for source in code for found in takes.finditer(source)), None):
        line = taken.string[taken.start() :].partition("\n")[0]
        return f"in the end `{name}` is no function: the line `{line[:60]}` takes the name from it"
    return "the notebook defines no such function"


def definitions(source: str, after: int, names: set[str] | None = None) -> str:
    """Functions, classes, imports and assignments of a cell below a line, every one still on its own line.

    names : only those that define one of these.

    '' if the cell is not plain Python (a magic, a syntax error): then it runs whole or not at all.
    """
    statements = parsed(source).body
    if not statements:
        return ""
    lines = source.split("\n")
    kept = ["#"] * len(lines)  # so that a line that is left out still counts
    wanted = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Assign)
    for node in statements:
        decorators = getattr(node, "decorator_list", [])
        first = min([node.lineno, *(d.lineno for d in decorators)])
        asked = names is None or names & defined(node)
        if first > after and asked and isinstance(node, (*wanted, ast.AnnAssign)):
            kept[first - 1 : node.end_lineno] = lines[first - 1 : node.end_lineno]
    return "\n".join(kept)


def parsed(source: str) -> ast.Module:
    """Its tree; that of nothing, if it is not plain Python."""
    try:
        return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


def defined(node: ast.stmt) -> set[str]:
    """The names that a statement at the top of a cell gives a value."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return {node.name}
    if isinstance(node, ast.Import | ast.ImportFrom):
        return {alias.asname or alias.name.partition(".")[0] for alias in node.names}
    names = (inner for inner in ast.walk(node) if isinstance(inner, ast.Name))
    return {name.id for name in names if isinstance(name.ctx, ast.Store)}


def needed(sources: list[str], name: str) -> list[str]:
    """Of every cell what defines a function, and what that uses in turn; nothing else of them is in it."""
    made: dict[str, list[set[str]]] = {}  # {name: what each statement that makes it uses}
    for node in (node for source in sources for node in parsed(source).body):
        used = _used(node)
        for one in defined(node):
            made.setdefault(one, []).append(used)
    names, waiting = set[str](), [name, "*"]
    while waiting:
        if (one := waiting.pop()) not in names:
            names.add(one)
            for used in made.get(one, ()):
                waiting += used
                used.clear()  # read once, however many names a statement makes
    return [definitions(source, 0, names) for source in sources]


def _used(node: ast.stmt) -> set[str]:
    """The names that a statement takes from elsewhere: not what is a function's own."""
    names = [inner for inner in ast.walk(node) if isinstance(inner, ast.Name)]
    own = {inner.arg for inner in ast.walk(node) if isinstance(inner, ast.arg)}
    if isinstance(node, ast.FunctionDef):
        own |= {name.id for name in names if isinstance(name.ctx, ast.Store)}
    return {name.id for name in names if isinstance(name.ctx, ast.Load)} - own
