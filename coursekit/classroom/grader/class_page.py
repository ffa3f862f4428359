"""OUT/class.html: the class at a glance, on one page that needs nothing else."""

from __future__ import annotations

import html
import os
from datetime import date
from pathlib import Path
from urllib.parse import quote

from .marks import Mark, Notebook, Standing, whole
from .overview import NOT_WRITTEN, Item, Mistake, help_wanted, is_right, items, middle, needs_your_eye
from .report import page_name, text

STYLE = """
:root { color-scheme: light dark; --line: #8886; --ok: #c9ecd1; --no: #f8cfcf; --part: #fbe7b2; --off: #eee;
        --bar: #2f6fb5; --ink: #111; --soft: #555; }
@media (prefers-color-scheme: dark) { :root { --ok: #1d4d2b; --no: #642424; --part: #5b4a12; --off: #2a2a2a;
        --bar: #6ea8e8; --ink: #eee; --soft: #aaa; } }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 75rem; margin: 1.5rem auto; padding: 0 1rem;
       color: var(--ink); }
h2 { margin: 2rem 0 .3rem; } p { margin: .3rem 0; } .soft { color: var(--soft); }
.wide { overflow-x: auto; margin-right: calc(50% - 50vw + 1rem); } /* to the edge of the window */
table { border-collapse: collapse; } td, th { padding: .2rem .5rem; text-align: left; vertical-align: top; }
tbody tr { border-top: 1px solid var(--line); } code { font-size: .95em; }
td.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.bar { display: block; width: 8rem; height: .7rem; border: 1px solid var(--line); margin: .35rem 0 0; }
.bar i { display: block; height: 100%; background: var(--bar); print-color-adjust: exact; }
ul { margin: 0; padding-left: 1.1rem; } details summary { cursor: pointer; }
.map td { text-align: center; padding: .1rem 0; min-width: 1.6rem; border-left: 1px solid var(--line); }
.map th[scope=row] { position: sticky; left: 0; background: Canvas; white-space: nowrap; font-weight: 400;
                     max-width: 14rem; overflow: hidden; text-overflow: ellipsis; }
.map thead th.x { height: 12rem; vertical-align: bottom; padding: .2rem .1rem; }
.map thead th.x span { writing-mode: vertical-rl; transform: rotate(180deg); font-weight: 400;
                        white-space: nowrap; }
.ok, .no, .part, .off { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.ok { background: var(--ok); } .no { background: var(--no); } .part { background: var(--part); }
.off { background: var(--off); }
a { color: inherit; }
@media (max-width: 45rem) { .list thead { display: none; } .list tr, .list td { display: block; }
  .list tr { padding: .5rem 0; } .list td, .list td.n { padding: .05rem 0; text-align: left; }
  .list td:not(:last-child) { display: inline; padding-right: .6rem; }
  .list br { display: none; } .list td.n { white-space: normal; }
  .list .soft span { margin-right: .6rem; white-space: nowrap; } .map th[scope=row] { max-width: 8rem; } }
@media print { body { max-width: none; font-size: 11px; } tr { break-inside: avoid; }
  .wide { overflow: visible; } details::details-content { display: block; content-visibility: visible; } }
"""
PARTS = {
    "mistakes": "exercises and mistakes",
    "help": "who needs help with what",
    "map": "students and exercises",
}
SHOWN = 4  # mistakes of an exercise, before one asks for more
MEANING = (
    ("ok", "✓", "right"),
    ("no", "✗", "wrong"),
    ("part", "≈", "points by follow-on credit or by your override"),
    ("off", "–", "not written"),
    ("", "·", "not handed in"),
    ("part", "?", "could not be graded"),
)


def write_class_page(path: Path, class_: list[Standing]) -> None:
    """Write the page; everything in it is of the records and of the instructor's decisions."""
    found = items(class_)
    names = {one.student: one.name or one.student for one in class_}
    parts = [_head(class_), _eye(class_, names), _exercises(found, names)]
    parts += [_help(class_, found, names), _map(class_, found)]
    page = (
        "<!doctype html><html lang='en'><head><meta charset='utf-8'>"
        "<meta name='viewport' content='width=device-width'>"
        f"<title>The class at a glance</title><style>{STYLE}</style></head><body>"
        f"<h1>The class at a glance</h1>{''.join(parts)}</body></html>\n"
    )
    part = path.with_name(f".{path.name}.part")
    part.write_text(page, encoding="utf-8", errors="replace")
    os.replace(part, path)


def _head(class_: list[Standing]) -> str:
    there = sum(any(nb.there for nb in one.notebooks.values()) for one in class_)
    of = whole(max((one.of for one in class_), default=0))
    half = middle(class_)
    told = f"median {whole(half)} of {of} points, " if half is not None else ""
    links = "".join(f" · <a href='#{name}'>{word}</a>" for name, word in PARTS.items())
    return (
        f"<p>{len(class_)} students, {there} handed something in, {told}{date.today().isoformat()}{links}</p>"
    )


def _eye(class_: list[Standing], names: dict[str, str]) -> str:
    rows = "".join(
        f"<li>{_link(student, names)}: {text(why)}</li>" for student, why in needs_your_eye(class_)
    )
    return f"<h2>Needs your eye</h2><ul>{rows}</ul>" if rows else ""


def _exercises(found: list[Item], names: dict[str, str]) -> str:
    rows = "".join(_exercise(item, names) for item in found if item.handed_in)
    head = "".join(
        f"<th scope='col'>{word}</th>" for word in ("", "exercise", "right", "", "what went wrong")
    )
    return (
        "<h2 id='mistakes'>Exercises and mistakes</h2>"
        "<p class='soft'>Of those who handed the notebook in; best and last third by all other exercises.</p>"
        f"<table class='list'><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
    )


def _exercise(item: Item, names: dict[str, str]) -> str:
    percent = round(100 * item.share)
    thirds = ""
    if item.upper is not None and item.lower is not None:
        best, last = (f"third {round(100 * share)} %" for share in (item.upper, item.lower))
        thirds = f"<span class='soft'><span>best {best}</span><br><span>last {last}</span></span>"
    doubt = f"<p><strong>{text(item.doubt)}</strong></p>" if item.doubt else ""
    lines = [
        f"<details><summary>{len(m.students)} × {_said(m)}</summary>{_people(m.students, names)}</details>"
        for m in item.mistakes
    ]
    rows = "".join(lines[:SHOWN])
    if rest := lines[SHOWN:]:
        rows += f"<details><summary class='soft'>{len(rest)} more</summary>{''.join(rest)}</details>"
    missing = item.handed_in - item.written
    rows += f"<p class='soft'>{missing} × not written</p>" if missing else ""
    return (
        f"<tr><td>{text(item.unit)}</td><td><code>{text(item.name)}</code></td>"
        f"<td class='n'>{item.right} of {item.handed_in}</td>"
        f"<td class='n'>{percent} %<span class='bar'><i style='width:{percent}%'></i></span>{thirds}</td>"
        f"<td>{doubt}{rows}</td></tr>"
    )


def _help(class_: list[Standing], found: list[Item], names: dict[str, str]) -> str:
    common = sorted(
        (mistake for item in found for mistake in item.mistakes if len(mistake.students) > 1),
        key=lambda mistake: -len(mistake.students),
    )
    groups = "".join(
        f"<li><code>{text(m.exercise)}</code>: {_said(m)}. {_people(m.students, names)}</li>"
        for m in common[:12]
    )
    single = "".join(
        f"<details><summary>{_link(student, names)}: {len(lacking)} exercises</summary>"
        f"{', '.join(map(text, lacking))}</details>"
        for student, lacking in help_wanted(class_, found)[:20]
    )
    told = "<h2 id='help'>Who needs help with what</h2>"
    told += f"<h3>The same mistake</h3><ul>{groups}</ul>" if groups else ""
    told += f"<h3>Much is missing or wrong</h3>{single}" if single else ""
    return told if groups or single else ""


def _map(class_: list[Standing], found: list[Item]) -> str:
    head = "".join(
        f"<th class='x' scope='col'><span>{text(i.unit)} {text(i.name)}</span></th>" for i in found
    )
    meaning = ", ".join(
        f"<span class='{kind}'>&nbsp;{sign}&nbsp;</span> {word}" for kind, sign, word in MEANING
    )
    order = sorted(class_, key=lambda one: (-(one.points or 0), one.student))
    rows = "".join(
        f"<tr><th scope='row'>{_link(one.student, {one.student: one.name or one.student})}</th>"
        f"<td class='n'>{'' if one.points is None else whole(one.points)}</td>{_cells(one, found)}</tr>"
        for one in order
    )
    return (
        f"<h2 id='map'>Students and exercises</h2><p class='soft'>{meaning}</p>"
        "<div class='wide'><table class='map'>"
        f"<thead><tr><th scope='col'>student</th><th scope='col'>points</th>{head}</tr></thead>"
        f"<tbody>{rows}</tbody></table></div>"
    )


def _cells(one: Standing, found: list[Item]) -> str:
    cells = []
    for item in found:
        nb = one.notebooks.get(item.unit)
        mark = one.marks.get(item.name)
        kind, sign, word = MEANING[4] if mark is None or nb is None else _meaning(mark, nb)
        title = f"{item.name}: {(mark.note or mark.text) if mark else ''}".removesuffix(": ")
        label = f"title='{html.escape(title)}' aria-label='{word}'"
        cells.append(f"<td class='{kind}' {label}>{sign}</td>")
    return "".join(cells)


def _meaning(mark: Mark, nb: Notebook) -> tuple[str, str, str]:
    if mark.note:
        return MEANING[2]
    if mark.points is None:
        return MEANING[5]
    if not nb.there:
        return MEANING[4]
    if is_right(mark):
        return MEANING[0]
    return MEANING[3] if mark.kind in NOT_WRITTEN else MEANING[1]


def _said(mistake: Mistake) -> str:
    return (
        f"{text(mistake.line)} <span class='soft'>({text(mistake.text)})</span>"
        if mistake.line
        else text(mistake.text)
    )


def _people(students: list[str], names: dict[str, str]) -> str:
    return ", ".join(_link(student, names) for student in students)


def _link(student: str, names: dict[str, str]) -> str:
    return f"<a href='{quote(os.fsencode(page_name(student)))}'>{text(names[student])}</a>"
