"""`coursekit new DIR`: a course of one's own to begin with, which runs as it is."""

from __future__ import annotations

import shutil
from pathlib import Path

from ..your_course import read
from . import tables

TEMPLATE = Path(__file__).with_name("template")


def new(folder: Path) -> str:
    """Write a small course into a new folder; says what to do next. ValueError if something is there."""
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} exists already and is not empty: name a new folder")
    shutil.copytree(TEMPLATE, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    tables.write_samples(read(folder))
    return (
        f"wrote {folder}: a notebook, its exercise with three mistakes, and course.toml. Next:\n"
        f"  coursekit lab --course {folder}           look at it, and make it yours\n"
        f"  coursekit release OUT --course {folder}   what students get"
    )
