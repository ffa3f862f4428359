"""`coursekit update NEW`: a folder that somebody works in gets a corrected release; what they wrote stays.

A release lists its files in `release.json`. What is listed there is replaced, notebooks are merged (`merge`),
everything else in the folder belongs to the student and is not touched. What was there before is kept in
`.coursekit/before/` until the next update, so that `coursekit update --undo` can bring it back.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import stat
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

from . import document
from .course import ROOT
from .merge import merge
from .own import FILE as STUDENT

RELEASE = "release.json"
BEFORE = Path(".coursekit") / "before"
PLAN = "replaced.json"  # in BEFORE, written last: what is there can be brought back


def write_list(folder: Path, title: str, version: str) -> None:
    """Write release.json: what a finished release is, and which files belong to it."""
    files = [path.relative_to(folder).as_posix() for path in sorted(folder.rglob("*")) if path.is_file()]
    text = json.dumps({"title": title, "version": version, "files": files}, indent=1, ensure_ascii=False)
    (folder / RELEASE).write_text(text + "\n", encoding="utf-8", newline="\n")


def update(new: Path, folder: Path | None = None) -> str:
    """Bring a student's folder to another release of its course; says what changed.

    Parameters
    ----------
    new : the corrected release: its folder, a zip of it, or the folder of a whole class
    folder : the student's; the one this package lies in unless told otherwise

    ValueError where either is no release, where it belongs to another course or student, or is older than
    what the folder holds; then nothing is changed.
    """
    folder = Path(folder or ROOT)
    contents, told = plan(new, folder)
    if contents:
        _replace(folder, contents)
    return told


def plan(new: Path, folder: Path) -> tuple[dict[str, bytes | None], str]:
    """What an update would do, with nothing done: ({file: new bytes, or None where it goes}, its text)."""
    _follow_no_link(folder, [RELEASE, STUDENT, BEFORE.as_posix()])
    before = _list(folder, "nothing can be updated there")
    with _opened(Path(new), folder) as source:
        after = _list(source, "name the folder or the zip of a release")
        _same_course(folder, before, source, after)
        _follow_no_link(folder, [*before["files"], *after["files"]])
        contents, told = _planned(folder, before, source, after)
    if not contents:
        return {}, f"{folder} holds this release already: nothing changed"
    was = f"{before['version']} before" if before["version"] != after["version"] else "corrected"
    head = f"{folder}: version {after['version']} of {after['title']}, {was}"
    return contents, "\n".join([head, *told, "`coursekit update --undo` brings the old one back"])


def undo(folder: Path | None = None) -> str:
    """Bring back the release that the last update replaced; what was written since stays, too."""
    folder = Path(folder or ROOT)
    kept = folder / BEFORE
    try:
        replaced = json.loads((kept / PLAN).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise ValueError(f"{folder}: there is no update that could be undone") from None
    contents: dict[str, bytes | None] = {}
    for name, was_there in replaced.items():
        now = folder / name
        if was_there and name.endswith(".ipynb") and now.exists():
            merged, _ = merge(document.read(now), document.read(kept / name))
            contents[name] = document.text_of(merged).encode()
        elif was_there:
            contents[name] = (kept / name).read_bytes()
        elif not (name.endswith(".ipynb") and now.exists() and _worked_in(now)):
            contents[name] = None
    _write(folder, contents)
    shutil.rmtree(kept)
    return f"{folder}: version {_list(folder, '')['version']} is back; what you wrote stays"


def _list(folder: Path, otherwise: str) -> dict:
    path = folder / RELEASE
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        kinds = (("title", str), ("version", str), ("files", list))
        inside = all(".." not in Path(name).parts and not Path(name).is_absolute() for name in found["files"])
        if inside and all(isinstance(found[key], kind) for key, kind in kinds):
            return found
    except FileNotFoundError:
        raise ValueError(f"{folder} is no release: it holds no {RELEASE}; {otherwise}") from None
    except (ValueError, KeyError, TypeError):
        pass
    raise ValueError(f"{path} is damaged: title, version and files are expected in it; {otherwise}")


def _follow_no_link(folder: Path, names: list[str]) -> None:
    """ValueError if one of these files, or a folder it lies in, is a link, or is none.

    On a hub an instructor brings folders up to date in which students write: a link could show them a
    classmate's work, or lead to a file of the instructor's.
    """
    places = {folder / part for name in names for part in (Path(name), *Path(name).parents)}
    for place in sorted(places - {folder}):
        with contextlib.suppress(OSError):  # it is not there
            mode = place.lstat().st_mode
            if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
                raise ValueError(f"{place} is a link or no file: put a copy of what is meant in its place")


@contextlib.contextmanager
def _opened(new: Path, folder: Path) -> Iterator[Path]:
    """The folder of the release that is meant: unpacked if it is a zip, the student's own of a class."""
    if not new.exists():
        raise ValueError(f"{new} does not exist: name the folder or the zip of a release")
    with tempfile.TemporaryDirectory() as scratch:
        if new.is_file():
            try:
                with zipfile.ZipFile(new) as archive:
                    archive.extractall(scratch)
            except zipfile.BadZipFile:
                raise ValueError(f"{new} is no zip: name the folder or the zip of a release") from None
            new = Path(scratch)
        mine = _student(folder)
        places = [new, *(sub for sub in sorted(new.iterdir()) if sub.is_dir())]
        found = [place for place in places if (place / RELEASE).is_file()]
        found = [place for place in found if _student(place) == mine] or found
        if not mine and len(found) > 1:
            raise ValueError(f"{new} holds the releases of {len(found)} students: name the folder of your id")
        yield found[0] if found else new


def _student(folder: Path) -> str:
    try:
        return str(json.loads((folder / STUDENT).read_text(encoding="utf-8"))["id"])
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def _same_course(folder: Path, before: dict, source: Path, after: dict) -> None:
    if before["title"] != after["title"]:
        raise ValueError(
            f"{source / RELEASE}, title: that is a release of {after['title']!r}; {folder} holds "
            f"{before['title']!r}"
        )
    if document.newer(before["version"], after["version"]):
        raise ValueError(
            f"{source / RELEASE}, version: {after['version']} is older than the {before['version']} that "
            f"{folder} holds"
        )
    mine, theirs = _student(folder), _student(source)
    if mine and theirs != mine:
        whose = f"the release of {theirs}" if theirs else "a release for everybody, without anybody's arm"
        raise ValueError(f"{source / STUDENT}, id: that is {whose}; {folder} is {mine}'s")


def _planned(
    folder: Path, before: dict, source: Path, after: dict
) -> tuple[dict[str, bytes | None], list[str]]:
    """({file: its new bytes, or None where it goes}, what to tell)."""
    contents: dict[str, bytes | None] = {}
    told: list[str] = []
    for name in [*after["files"], RELEASE]:
        target, data = folder / name, (source / name).read_bytes()
        if name.endswith(".ipynb") and target.exists():
            mine = document.read(target)
            new = document.read(source / name)
            if document.newer(document.mark_of(mine).get("version", ""), after["version"]):
                raise ValueError(
                    f"{target}, metadata.coursekit.version: this notebook is of version "
                    f"{document.mark_of(mine)['version']}, newer than the {after['version']} of {source}"
                )
            merged, changes = merge(mine, new)
            lines = changes.lines
            told += [f"{Path(name).name}: {line}" for line in lines]
            if not lines and document.mark_of(mine) == document.mark_of(new):
                continue
            data = document.text_of(merged).encode()
        elif name.endswith(".ipynb"):
            told.append(f"{Path(name).name}: new")
        if not target.exists() or target.read_bytes() != data:
            contents[name] = data
    for name in sorted(set(before["files"]) - set(after["files"])):
        if name == STUDENT or not (folder / name).exists():
            continue
        if name.endswith(".ipynb"):
            told.append(f"{Path(name).name}: no longer part of the course; yours is kept")
        else:
            contents[name] = None
    others = [name for name in contents if not name.endswith(".ipynb") and name != RELEASE]
    if others:
        files = "1 other file" if len(others) == 1 else f"{len(others)} other files"
        told.append(f"{files} replaced: exercises, checks, the library")
    if "environment.txt" in contents:
        told.append("other versions of the libraries are needed: paste the first command of README.md again")
    return contents, told


def _worked_in(path: Path) -> bool:
    notebook = document.read(path)
    base = document.mark_of(notebook).get("cells", {})
    return any(base.get(document.key(c)) != document.digest(c["source"]) for c in notebook["cells"])


def _replace(folder: Path, contents: dict[str, bytes | None]) -> None:
    """First keep what is there, then write: a run that is cut off in between can be undone."""
    kept = folder / BEFORE
    shutil.rmtree(kept, ignore_errors=True)
    for name in contents:
        if (folder / name).exists():
            (kept / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(folder / name, kept / name)
    kept.mkdir(parents=True, exist_ok=True)
    (kept / PLAN).write_text(json.dumps({name: (kept / name).exists() for name in contents}), "utf-8")
    _write(folder, contents)


def _write(folder: Path, contents: dict[str, bytes | None]) -> None:
    for name, data in contents.items():
        target = folder / name
        if data is None:
            target.unlink(missing_ok=True)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        beside = target.with_name(f".{target.name}.new")  # whole or not at all
        beside.unlink(missing_ok=True)
        with open(beside, "xb") as file:  # nothing that stands there is followed
            file.write(data)
        os.replace(beside, target)
