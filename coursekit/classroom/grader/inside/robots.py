"""The catalogue in the box: data sheets read from a table, and not a formula."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from .absent import Absent, names_of, refuse
from .robot import Robot

_missing = names_of("robots")
_sheets: dict[str, dict] = {}
if (_path := Path(__file__).with_name("robots.json")).exists():
    _sheets = json.loads(_path.read_text("utf-8"))


def all() -> dict[str, Robot]:
    """{name: robot} of the catalogue."""
    return {name: _robot(sheet) for name, sheet in _sheets.items()}


def __getattr__(name: str) -> Callable[..., Robot] | Absent:
    if name not in _sheets:
        return _missing(name)

    def make(*lengths: float, **more: float) -> Robot:
        if lengths or more:  # other lengths than those of the sheet would have to be computed
            refuse(f"robots.{name}")
        return _robot(_sheets[name])

    return make


def _robot(sheet: dict) -> Robot:
    robot = object.__new__(Robot)
    robot.__dict__.update({key: _thaw(value) for key, value in sheet.items()})
    return robot


def _thaw(value: Any) -> Any:
    if isinstance(value, dict):
        return SimpleNamespace(**{key: _thaw(one) for key, one in value.items()})
    if isinstance(value, list) and not any(isinstance(one, str) for one in value):
        array = np.array(value, dtype=float)
        array.setflags(write=False)
        return array
    return tuple(value) if isinstance(value, list) else value
