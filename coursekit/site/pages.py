"""Notebooks as pages, with explorers that move without a kernel; and the index."""

from __future__ import annotations

import base64
import hashlib
import html
import importlib.util
import io
import json
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path

import nbformat
from nbconvert.filters import Highlight2HTML, ansi2html, markdown2html
from nbformat import NotebookNode
from PIL import Image
from pygments.formatters import HtmlFormatter

from ..classroom.author.notebook import is_check, is_solution
from ..view import reopened
from ..view.page import common_script
from . import notices, reference, shown, tools
from .frame import STATIC, framed

# What MathJax needs for TeX in these pages; the rest of it (other input, other languages) stays away.
_OF_MATHJAX = (
    "LICENSE",
    "MathJax.js",
    "config/TeX-AMS-MML_HTMLorMML-full.js",
    "extensions/AssistiveMML.js",
    "extensions/MathEvents.js",
    "extensions/MathMenu.js",
    "extensions/MathZoom.js",
    "extensions/HTML-CSS",
    "extensions/TeX",
    "jax/element",
    "jax/output/HTML-CSS",
    "fonts/HTML-CSS/STIX-Web/woff",
)
_EXPLORER = "static/explorer.js"  # what the pages of all explorers have in common
_COLUMNS = re.compile(r"\S {2,}\S")  # a line of a table or a matrix
_WAITS = "This cell uses what you write above it: its result appears when the exercises are solved."


@dataclass
class Page:
    """One notebook, as the index and its neighbours speak of it."""

    name: str
    title: str = ""
    about: str = ""
    minutes: str = ""
    goals: list[str] = field(default_factory=list)
    exercises: list[str] = field(default_factory=list)

    @property
    def number(self) -> str:
        """Its number in the course, such as "01"."""
        return self.name[:2]


def formulas() -> Path:
    """The folder of MathJax's files; ValueError if the package that brings them is not installed."""
    found = importlib.util.find_spec("jupyter_server_mathjax")
    if found is None or not found.origin:
        raise ValueError(f"the pages need MathJax's files, which are not installed: {tools.INSTALL}")
    return Path(found.origin).parent / "static"


def write(course: Path, out: Path, title: str, run: str | None = None) -> list[Page]:
    """Write a page for each notebook of a released course, the index, and what they need.

    Parameters
    ----------
    course : Path
        A folder that `coursekit release` has written.
    out : Path
        The folder of the site.
    title : str
        Of the course.
    run : str, optional
        Where "Run it here" leads, from `out`, with `{}` for the notebook's name; without it there is no such
        button.
    """
    for folder in ("static", "pictures", "explorers"):
        (out / folder).mkdir(parents=True)
    _static(out / "static")
    paths = sorted((course / "notebooks").glob("*.ipynb"))
    pages = [described(nbformat.read(path, as_version=4), path.stem) for path in paths]
    for page, path in zip(pages, paths, strict=True):
        body = _Body(page.name, out).of(shown.run(path, course))
        text = framed(page.title, body, _bar(page, pages, run), page.name)
        (out / f"{page.name}.html").write_text(text, encoding="utf-8")
    for path in sorted((course / "notebooks").glob("*.md")):  # what notebooks link to
        body = f'<section class="words">{markdown(path.read_text(encoding="utf-8"))}</section>'
        up = '<a href="index.html">All notebooks</a>'
        text = framed(path.stem.capitalize(), body, up, path.stem)
        (out / f"{path.stem}.html").write_text(text, encoding="utf-8")
    cards = "\n".join(_card(page, run) for page in pages)
    template = (STATIC / "index.html").read_text(encoding="utf-8")
    how = "run" if run else "read"
    body = template.replace("@cards@", cards).replace("@how@", how).replace("@title@", html.escape(title))
    (out / "index.html").write_text(framed(title, body, "", "index"), encoding="utf-8")
    reference.write(out)
    notices.write(out, notices.OF_PAGES)
    _worker(out)
    return pages


def described(notebook: NotebookNode, name: str) -> Page:
    """Title, minutes, goals and exercises, read off a notebook."""
    text = "\n\n".join(cell.source for cell in notebook.cells[:2])
    exercises = [c.metadata.nbgrader.grade_id for c in notebook.cells if is_solution(c)]
    title = re.search(r"^# (.+)$", text, re.M)
    about = re.search(r"^# .+\n+(.+)$", text, re.M)
    minutes = re.search(r"\*\*Time\*\* (\d+) minutes", text)
    goals = re.search(r"^## What you will be able to do\n+((?:- .+\n)+)", text, re.M)
    return Page(
        name,
        title[1] if title else name,
        about[1] if about else "",
        minutes[1] if minutes else "",
        [line.removeprefix("- ") for line in goals[1].splitlines()] if goals else [],
        exercises,
    )


# -- one page


class _Body:
    """The cells of one notebook as HTML; its pictures and explorers go to files beside it."""

    def __init__(self, name: str, out: Path) -> None:
        self.name, self.out = name, out
        self.explorers: dict[str, str] = {}  # page -> its file: some stand in two cells
        self.colour = Highlight2HTML(pygments_lexer="python3")

    def of(self, notebook: NotebookNode) -> str:
        return "\n".join(self.cell(cell) for cell in notebook.cells)

    def cell(self, cell: NotebookNode) -> str:
        if cell.cell_type == "markdown":
            return f'<section class="words" id="{cell.id}">{markdown(cell.source)}</section>'
        if cell.cell_type != "code":
            return ""
        kind = "yours" if is_solution(cell) else "check" if is_check(cell) else "given"
        label = {"yours": '<p class="label">You write this</p>', "check": '<p class="label">The check</p>'}
        outputs = "".join(self.output(cell.id, n, one) for n, one in enumerate(cell.outputs))
        if "waits" in cell.metadata.get("tags", []):
            outputs = f'<p class="waits">{_WAITS}</p>'
        code = self.colour(cell.source, metadata=None)
        return f'<section class="code {kind}" id="{cell.id}">{label.get(kind, "")}{code}{outputs}</section>'

    def output(self, place: str, number: int, output: NotebookNode) -> str:
        if output.output_type == "stream":
            return f'<pre class="output">{_printed(output.text)}</pre>'
        data = output.get("data", {})
        line = data.get("text/plain", "")
        if "image/png" in data:
            alt = output.metadata.get("image/png", {}).get("alt", "")
            return self.picture(f"{self.name}-{place}-{number}", data["image/png"], alt, line)
        if "text/latex" in data:
            return f'<div class="formula">{html.escape(data["text/latex"], quote=False)}</div>'
        if "text/html" in data:
            return f'<div class="output">{data["text/html"]}</div>'
        return f'<pre class="output">{_printed(line)}</pre>'

    def picture(self, name: str, png: str, alt: str, line: str) -> str:
        """A figure, or in its place an explorer that moves; the picture of that one is for paper."""
        file = f"pictures/{name}.png"
        data = base64.b64decode(png)
        (self.out / file).write_bytes(data)
        picture = f'<img src="{file}" alt="{html.escape(alt or "figure; its caption follows")}">'
        page = reopened.page_of(line, common=f"../{_EXPLORER}")
        if page is None:
            corner = Image.open(io.BytesIO(data)).convert("RGB").tobytes()[:3]
            kind = "picture" if min(corner) > 240 else "picture kept"
            return f'<figure class="{kind}">{picture}</figure>'
        explorer = self.explorers.setdefault(page, f"explorers/{name}.html")
        (self.out / explorer).write_text(page, encoding="utf-8")
        frame = f'<iframe data-src="{explorer}" title="{html.escape(line.split(":")[0])}"></iframe>'
        hint = f"<figcaption>{reopened.HINT}</figcaption>"
        return f'<figure class="explorer">{frame}{picture}{hint}</figure>'


def _printed(text: str) -> str:
    """What a cell prints: words may be wrapped where the page is narrow, columns of numbers must not."""
    lines = text.split("\n")
    return "\n".join(
        f'<span class="columns">{ansi2html(line)}</span>' if _COLUMNS.search(line) else ansi2html(line)
        for line in lines
    )


def markdown(source: str) -> str:
    """A cell of text as HTML, formulas as they are."""
    text = re.sub(r'<a class="anchor-link".*?</a>', "", markdown2html(source))
    return re.sub(r'href="(\w+)\.md', r'href="\1.html', text)


def _bar(page: Page, pages: list[Page], run: str | None) -> str:
    """Where one can go from here."""
    at = pages.index(page)
    links = ['<a href="index.html">All notebooks</a>']
    if at:
        links.append(f'<a rel="prev" href="{pages[at - 1].name}.html">← {pages[at - 1].number}</a>')
    links.append(f"<span>{page.number}</span>")
    if at + 1 < len(pages):
        links.append(f'<a rel="next" href="{pages[at + 1].name}.html">{pages[at + 1].number} →</a>')
    return "\n".join([*links, _run(page, run)])


def _run(page: Page, run: str | None) -> str:
    return f'<a class="run" href="{run.format(page.name)}">Run it here</a>' if run else ""


def _card(page: Page, run: str | None) -> str:
    goals = (
        "".join(f"<li>{markdown(goal)}</li>" for goal in page.goals).replace("<p>", "").replace("</p>", "")
    )
    return f"""<article>
<h2><a href="{page.name}.html">{page.number} {html.escape(page.title)}</a></h2>
<p class="facts">{page.minutes} minutes, {len(page.exercises)} exercises</p>
{markdown(page.about)}
<ul>{goals}</ul>
<p class="go"><a href="{page.name}.html">Read it</a> {_run(page, run)}</p>
</article>"""


# -- what all pages share


def _static(folder: Path) -> None:
    """Style, script and MathJax."""
    light, dark = (HtmlFormatter(style=s).get_style_defs(p) for s, p in _CODE)
    style = (STATIC / "page.css").read_text(encoding="utf-8")
    (folder / "page.css").write_text(f"{light}\n{dark}\n{style}", encoding="utf-8")
    shutil.copy(STATIC / "page.js", folder / "page.js")
    (folder.parent / _EXPLORER).write_text(common_script(), encoding="utf-8")
    source = formulas()
    for name in _OF_MATHJAX:
        here, there = source / name, folder / "mathjax" / name
        there.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if here.is_dir() else shutil.copy)(here, there)


_CODE = (("default", ".highlight"), ("github-dark", '[data-theme="dark"] .highlight'))


def _worker(out: Path) -> None:
    """The script that keeps pages for times without a network; it fetches all anew when one has changed."""
    at_once = [path for path in out.rglob("*") if path.suffix in (".html", ".css", ".js", ".png")]
    at_once = sorted(path for path in at_once if "mathjax" not in path.parts)
    version = hashlib.sha256(b"".join(path.read_bytes() for path in at_once)).hexdigest()[:12]
    names = ["./", *(path.relative_to(out).as_posix() for path in at_once)]
    text = (STATIC / "offline.js").read_text(encoding="utf-8")
    text = text.replace("@version@", version).replace("@pages@", json.dumps(names))
    (out / "offline.js").write_text(text, encoding="utf-8")
