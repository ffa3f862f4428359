"""What some tests need and not every machine has: a reason to skip, a failure with CI=true."""

import importlib
import os
from types import ModuleType

import pytest


def needed(module: str) -> ModuleType:
    """The module; without it the test is skipped, or fails with CI=true."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError:
        absent(f"{module.partition('.')[0]} is not installed (pip install -r tests/requirements-ci.txt)")
        raise


def absent(what: str) -> None:
    """Something is not there."""
    (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)(what)
