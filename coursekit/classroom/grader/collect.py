"""`coursekit collect`: what a learning platform hands out becomes SUBMISSIONS/<student>/<notebook>.ipynb.

Nothing is lost: every notebook and archive that finds no place is listed, with the reason, and so is every
older attempt. What was found about a submission (where it came from, when, whether it was late) is kept in
SUBMISSIONS/collected.csv, from which the grader takes the time. The folder is there when it is whole, or not
at all: it is written beside, under another name.
"""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import re
import shutil
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from .. import roster
from ..course import Course, the_course
from ..document import mark_of
from .cells import LARGEST
from .naming import NOTEBOOK, TABLE, Register, Told, notebook_of, printable, told
from .report import harmless

ARCHIVES = (".zip", ".tar", ".gz", ".7z", ".rar")
PART = ".part"  # how the folder is called until it is whole
OTHERS = ("__MACOSX", ".ipynb_checkpoints", ".git", ".venv", ".coursekit")  # folders that programs keep
COLUMNS = ("student", "notebook", "submitted", "late", "canvas", "moodle", "from")
DEEPEST = 4  # zips in zips
LONGEST = 255  # letters of a file's name; to read longer ones takes hours
LARGEST_ARCHIVE = 500_000_000  # bytes of a zip in a zip
MOST = 200_000  # files
UNPACKED = 200_000_000  # bytes that somebody's zip may hold, all zips in it too, beside 20 times its own


@dataclass(frozen=True)
class Found:
    """A notebook somewhere in what was downloaded."""

    parts: tuple[str, ...]
    packed: bytes  # a class of a thousand is in memory at once
    time: datetime

    @property
    def data(self) -> bytes:
        """What is in the file."""
        return zlib.decompress(self.packed)

    @property
    def place(self) -> str:
        """Where it stands, for people."""
        return "/".join(self.parts)


def collect(source: Path, out: Path, roster_path: Path | None = None, course: Course | None = None) -> str:
    """Sort a download (a zip or a folder) into `out`; what a person should know of it.

    ValueError if there is nothing to read, `out` holds something already, or the roster does not fit.
    """
    course, source, out = course or the_course(), Path(source), Path(out)
    if not source.exists():
        raise ValueError(f"{source} does not exist: name the zip or the folder that was downloaded")
    if out.exists() and any(out.iterdir()):
        raise ValueError(f"{out} holds something already: name a new folder")
    part = out.resolve().with_name(f".{out.resolve().name}{PART}")
    shutil.rmtree(part, ignore_errors=True)  # of a run that was killed
    students = roster.read(roster_path) if roster_path else None
    expected = [course.notebook(unit).name for unit in course.units if course.exercises(unit)]
    problems: list[str] = []
    aside: list[str] = []
    chosen, older = _choose(source, Register(students), expected, problems, aside)
    if not chosen and not problems:
        raise ValueError(f"{source} holds no notebook (.ipynb) and no zip")
    missing = [one.id for one in students or () if one.id not in {student for student, _ in chosen}]
    try:
        _write(part, chosen, missing)
        if out.exists():
            shutil.copymode(out, part)
            out.rmdir()
        os.replace(part, out.resolve())
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return _summary(out, chosen, older, problems, aside, missing)


Chosen = dict[tuple[str, str], tuple[tuple, Found, Told]]


def _choose(
    source: Path, register: Register, expected: list[str], problems: list[str], aside: list[str]
) -> tuple[Chosen, list[str]]:
    """({(student, notebook): its latest attempt}, older attempts); what finds no place goes to `problems`."""
    chosen: Chosen = {}
    older: list[str] = []
    for found in _files(source, problems, aside):
        try:
            said = told(found.parts, register.knows)
            notebook = notebook_of(said.file, expected)
        except ValueError:  # the 31st of February
            problems.append(f"{found.place}: a number in this name cannot be")
            continue
        sure = bool(register.find(said.who)[0])
        student, why = register.find(said.who if sure else (*said.who, *_owner(found.data)))
        if notebook is None:
            why = why or f"none of the course's notebooks is called {said.file}"
        if why or notebook is None:
            problems.append(f"{found.place}: {why}")
            continue
        name, copy = notebook
        order = (sure, said.attempt, said.time or found.time, copy)
        best = chosen.get((student, name))
        same = best is not None and order == best[0]
        if best is None or order > best[0] or (same and found.parts == best[1].parts):  # as unzip does
            chosen[student, name] = (order, found, said)
        if best is not None:
            kept = chosen[student, name][1]
            loser = found if kept is best[1] else best[1]
            why = "has the same time, and counts" if same else "is later"
            if order[0] != best[0][0]:
                why = "says in its name whose it is"
            older.append(f"{loser.place}: {kept.place} {why}")
    return chosen, older


def _owner(data: bytes) -> tuple[str, ...]:
    """Whom a release noted in the notebook: asked last, because students can write there."""
    try:
        whose = mark_of(json.loads(data)).get("student", "")
    except (ValueError, AttributeError, RecursionError):
        return ()
    return (whose,) if isinstance(whose, str) else ()


def _write(out: Path, chosen: Chosen, missing: list[str]) -> None:
    out.mkdir(parents=True)
    with open(out / TABLE, "w", newline="", encoding="utf-8-sig", errors="replace") as file:
        table = csv.writer(file, quoting=csv.QUOTE_ALL)  # where `;` separates, too
        table.writerow(COLUMNS)
        for (student, name), (_, found, said) in sorted(chosen.items(), key=lambda one: one[0]):
            (out / student).mkdir(exist_ok=True)
            (out / student / name).write_bytes(found.data)
            time = said.time or found.time
            with contextlib.suppress(OSError, OverflowError, ValueError):
                os.utime(out / student / name, (time.timestamp(), time.timestamp()))
            late = "late" if said.late else ""
            row = [student, name, time.isoformat(" ", "seconds"), late, said.canvas, said.moodle]
            table.writerow([*row, harmless(found.place)])
    for student in missing:  # a row in grades.csv, too
        (out / student).mkdir()


def _summary(
    out: Path, chosen: Chosen, older: list[str], problems: list[str], aside: list[str], missing: list[str]
) -> str:
    students = {student for student, _ in chosen}
    by_mark = [
        f"{found.place}: taken for {one}'s" for (one, _), (order, found, _) in chosen.items() if not order[0]
    ]
    lines = [f"{len(chosen)} notebooks of {len(students)} students: {out}"]
    for title, rows in (
        ("NOT COLLECTED, nobody has these", problems),
        ("no notebook, left aside", aside),
        ("handed in nothing", missing),
        ("whose they are, only the notebook says, where students can write", by_mark),
        ("older, left out", older),
    ):
        if rows:
            lines += [f"{title} ({len(rows)}):", *(f"    {printable(row)}" for row in sorted(rows))]
    return "\n".join(lines)


# ---- files, in folders and in zips


def _files(source: Path, problems: list[str], aside: list[str]) -> list[Found]:
    """Every notebook; archives that cannot be read go to `problems`, who handed in neither to `aside`."""
    if source.is_file():
        if not zipfile.is_zipfile(source):
            raise ValueError(f"{source} is no zip: name the zip, or the folder it was unpacked to")
        everything = list(_in_zip((), source.read_bytes(), problems))
    else:
        everything = list(_in_folder(source, problems))
    whole = [one for one in everything if _is_notebook(one.parts[-1])]
    found = _shortened(whole)
    folders = len(whole[0].parts) - len(found[0].parts) if whole else 0
    homes = {one.parts[0] for one in found}
    others: dict[str, list[str]] = {}
    for one in everything:
        if not _is_notebook(one.parts[-1]) and (parts := one.parts[folders:]) and parts[0] not in homes:
            others.setdefault(parts[0], []).append(parts[-1])
    aside += [
        home if names == [home] else f"{home}: {', '.join(names[:5])}" for home, names in others.items()
    ]
    return found


def _shortened(found: list[Found]) -> list[Found]:
    """Without the one folder that everything lies in, if folders follow."""
    while found and all(len(one.parts) > 2 and one.parts[0] == found[0].parts[0] for one in found):
        if len({one.parts[1] for one in found}) == 1 and len(found[0].parts) < 4:
            break
        found = [Found(one.parts[1:], one.packed, one.time) for one in found]
    return found


def _in_folder(folder: Path, problems: list[str]) -> Iterator[Found]:
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if not _is_nobodys(parts):
            try:
                yield from _at(path, parts, problems)
            except OSError as error:  # in a shared folder students say who may read theirs
                problems.append(f"{'/'.join(parts)}: cannot be read ({error.strerror})")


def _at(path: Path, parts: tuple[str, ...], problems: list[str]) -> Iterator[Found]:
    place = "/".join(parts)
    if path.is_dir() and not _is_wanted(parts[-1]):
        if not path.is_symlink() and not os.access(path, os.R_OK | os.X_OK):
            problems.append(f"{place}: a folder that may not be listed")
    elif not _is_wanted(parts[-1]):
        yield Found(parts, b"", datetime.min)
    elif path.is_symlink() or not path.is_file():
        problems.append(f"{place}: a link or no file, not followed")
    elif path.stat().st_size > (LARGEST_ARCHIVE if parts[-1].lower().endswith(".zip") else LARGEST):
        problems.append(f"{place}: too large")
    else:
        time = datetime.fromtimestamp(path.stat().st_mtime)
        yield from _one(parts, path.read_bytes(), time, problems)


def _one(
    parts: tuple[str, ...], data: bytes, time: datetime, problems: list[str], left: list[int] | None = None
) -> Iterator[Found]:
    name = parts[-1].lower()
    if _is_notebook(name):
        yield Found(parts, zlib.compress(data, 1), time)
    elif name.endswith(".zip") and sum(part.lower().endswith(".zip") for part in parts) <= DEEPEST:
        yield from _in_zip(parts, data, problems, left or [UNPACKED + 20 * len(data)])
    else:
        problems.append(f"{'/'.join(parts)}: no zip; unpack it into a folder of that name")


def _in_zip(
    parts: tuple[str, ...], data: bytes, problems: list[str], left: list[int] | None = None
) -> Iterator[Found]:
    """left: bytes that the zip, and all zips in it, may still hold; None where that is the whole class."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = archive.infolist()
            if len(infos) > MOST:
                raise ValueError(f"holds {len(infos)} files")
            for info in infos:
                inner = tuple(part for part in _name(info).split("/") if part not in ("", ".", ".."))
                if info.is_dir() or not inner or _is_nobodys(inner):
                    continue
                if len(max(inner, key=len)) > LONGEST:
                    problems.append(f"{'/'.join(parts + inner)[:LONGEST]}...: no folder could hold this name")
                    continue
                if not _is_wanted(inner[-1]):
                    yield Found(parts + inner, b"", datetime.min)
                    continue
                limit = LARGEST_ARCHIVE if inner[-1].lower().endswith(".zip") else LARGEST
                with archive.open(info) as file:
                    content = file.read((max(0, min(limit, left[0])) if left else limit) + 1)
                if left:
                    left[0] -= len(content) + 10_000
                    if left[0] < 0:
                        raise ValueError("too much in it: unpack it into a folder of that name")
                if len(content) > limit:
                    problems.append(f"{'/'.join(parts + inner)}: too large")
                    continue
                yield from _one(parts + inner, content, _time(info), problems, left)
    except (zipfile.BadZipFile, ValueError, RuntimeError, NotImplementedError, OSError, EOFError) as error:
        problems.append(f"{'/'.join(parts) or 'the zip'}: cannot be read ({error})")
    except Exception as error:  # zlib.error and the like: a damaged zip
        problems.append(f"{'/'.join(parts) or 'the zip'}: damaged ({type(error).__name__}: {error})")


def _name(info: zipfile.ZipInfo) -> str:
    """Programs that do not say which letters they use mostly use UTF-8."""
    if not info.flag_bits & 0x800:
        with contextlib.suppress(UnicodeError):
            return info.filename.encode("cp437").decode("utf-8").replace("\\", "/")
    return info.filename.replace("\\", "/")


def _time(info: zipfile.ZipInfo) -> datetime:
    try:
        return datetime(*info.date_time)
    except ValueError:
        return datetime(1980, 1, 1)


def _is_notebook(name: str) -> bool:
    return bool(re.search(NOTEBOOK, name))


def _is_wanted(name: str) -> bool:
    return _is_notebook(name) or name.lower().endswith(ARCHIVES)


def _is_nobodys(parts: tuple[str, ...]) -> bool:
    """What JupyterLab, macOS and an update of the course leave beside people's work."""
    hidden = parts[-1].startswith("._") or parts[-1] in (".DS_Store", "Thumbs.db", "desktop.ini", TABLE)
    ours = any(part.startswith(".") and part.endswith(PART) for part in parts)
    return hidden or ours or any(part in OTHERS for part in parts)


def read_table(folder: Path) -> list[dict[str, str]]:
    """The rows of SUBMISSIONS/collected.csv, [] if there is none; ValueError if it is damaged."""
    path = folder / TABLE
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8-sig", errors="replace") as file:
        table = csv.DictReader(file)
        if not set(COLUMNS) <= set(table.fieldnames or ()):
            raise ValueError(f"{path}, line 1: the columns {', '.join(COLUMNS)} are expected")
        rows = []
        for row in table:
            rows.append({column: row[column] or "" for column in COLUMNS})
            try:  # a spreadsheet may have written it its own way
                datetime.fromisoformat(rows[-1]["submitted"] or "2026-01-01")
            except ValueError:
                raise ValueError(
                    f"{path}, line {table.line_num}, submitted: a time such as 2026-11-27 18:00 is expected, "
                    f"not {row['submitted']!r}"
                ) from None
    return rows
