"""The package as pages: every public name with its signature, its docstring and its examples.

The names are those of the face, `coursekit.__all__`, and what each of them offers; the examples on these
pages are run by the tests (tests/house). Tools that make such pages read modules without running them and
miss names that are imported when they are first used, as all of ours are.
"""

from __future__ import annotations

import functools
import html
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from nbconvert.filters import Highlight2HTML

import coursekit

from .frame import framed

INDEX = "reference"
_VALUES = (property, functools.cached_property)
_coloured = Highlight2HTML(pygments_lexer="pycon")
_SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.M)
_ENTRY = re.compile(r"^(\S[^\n]*)\n((?:[ \t]+[^\n]*\n?|\n(?=[ \t]))*)", re.M)
_TERM = re.compile(r"^(\S.*?) +: (.*)$")


def write(out: Path) -> list[str]:
    """Write a page for each name of the face into a site, and an index of them; the files' names."""
    names = [name for name in coursekit.__all__ if not inspect.isfunction(getattr(coursekit, name))]
    files = []
    for name in names:
        thing = getattr(coursekit, name)
        body = _module(name, thing) if inspect.ismodule(thing) else _entry(name, thing, 1)
        files.append(_write(out, f"{INDEX}_{name}", f"coursekit.{name}", body))
    rows = "\n".join(
        f'<li><a href="{INDEX}_{name}.html"><code>{name}</code></a> {_first_line(name)}</li>'
        for name in names
    )
    body = f"<h1>The package, name by name</h1>{_prose(inspect.getdoc(coursekit) or '')}<ul>{rows}</ul>"
    return [_write(out, INDEX, "coursekit", body), *files]


def offered(module: ModuleType) -> Iterator[tuple[str, Any]]:
    """(name, function or class) of what a module offers: `__all__`, or what is public and at home there."""
    for name in getattr(module, "__all__", vars(module)):
        thing = getattr(module, name)
        at_home = getattr(thing, "__module__", "").startswith(module.__name__)
        if not name.startswith("_") and at_home and (inspect.isroutine(thing) or inspect.isclass(thing)):
            yield name, thing


def _module(name: str, module: ModuleType) -> str:
    entries = "\n".join(_entry(one, thing, 2) for one, thing in offered(module))
    return f"<h1><code>coursekit.{name}</code></h1>{_prose(inspect.getdoc(module) or '')}{entries}"


def _entry(name: str, thing: Any, level: int) -> str:
    """A function, or a class with its public methods."""
    methods = ""
    if inspect.isclass(thing):
        public = {key: value for key, value in vars(thing).items() if not key.startswith("_")}
        values = {key: value for key, value in public.items() if isinstance(value, _VALUES)}
        told = {key: values.get(key, getattr(thing, key)) for key in public}
        methods = "\n".join(
            _entry(f"{name}.{key}", value, level + 1)
            for key, value in told.items()
            if inspect.isroutine(value) or isinstance(value, _VALUES)
        )
    text = _prose(inspect.getdoc(thing) or "")
    head = f"<h{level}><code>{html.escape(name + _signature(thing))}</code></h{level}>"
    return f'<section class="words entry" id="{html.escape(name)}">{head}{text}</section>{methods}'


def _signature(thing: Any) -> str:
    if isinstance(thing, _VALUES) or (inspect.isclass(thing) and issubclass(thing, tuple)):
        return ""
    try:
        parameters = inspect.signature(thing).parameters.values()
    except (TypeError, ValueError):
        return "(...)"
    empty = inspect.Parameter.empty
    bare = [p.replace(annotation=empty) for p in parameters if p.name not in ("self", "cls")]
    named = [
        p.replace(default=_Name(p.default.__name__)) if inspect.isroutine(p.default) else p for p in bare
    ]
    return str(inspect.Signature(named))


class _Name(str):
    """A default that is a function, shown by its name."""

    __repr__ = str.__str__


def _prose(text: str) -> str:
    """A docstring as HTML: paragraphs, examples in colour, numpydoc's sections as lists."""
    parts = _SECTION.split(text)
    shown = [_paragraphs(parts[0])]
    for title, body in zip(parts[1::2], parts[2::2], strict=True):
        shown.append(f"<h4>{html.escape(title)}</h4>{_terms(body) or _paragraphs(body)}")
    return "".join(shown)


def _paragraphs(text: str) -> str:
    blocks = [block for block in re.split(r"\n\s*\n", inspect.cleandoc(text)) if block.strip()]
    return "".join(_paragraph(block) for block in blocks)


def _paragraph(block: str) -> str:
    if block.lstrip().startswith(">>>"):
        return _coloured(inspect.cleandoc(block), metadata=None)
    lines = block.splitlines()
    if any(re.search(r"^ |\S {2,}\S", line) or _TERM.match(line) for line in lines):  # a table: as it stands
        return f"<pre>{html.escape(block)}</pre>"
    return f"<p>{_inline(' '.join(lines))}</p>"


def _terms(body: str) -> str:
    """ "name : type" with its indented text, as a list; '' where a section is something else."""
    entries = _ENTRY.findall(inspect.cleandoc(body) + "\n")
    if not entries or body.strip().startswith(">>>"):
        return ""
    rows = (
        f"<dt><code>{html.escape(term)}</code></dt><dd>{_inline(' '.join(t.split()))}</dd>"
        for term, t in entries
    )
    return f"<dl>{''.join(rows)}</dl>"


def _inline(text: str) -> str:
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))


def _first_line(name: str) -> str:
    return _inline((inspect.getdoc(getattr(coursekit, name)) or "").partition("\n")[0])


def _write(out: Path, name: str, title: str, body: str) -> str:
    bar = f'<a href="index.html">All notebooks</a>\n<a href="{INDEX}.html">The package</a>'
    (out / f"{name}.html").write_text(framed(title, body, bar, name), encoding="utf-8")
    return f"{name}.html"
