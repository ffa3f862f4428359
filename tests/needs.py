"""What some tests need and not every machine has: a reason to skip, a failure with CI=true."""

import importlib
import os
from importlib.util import find_spec
from types import ModuleType

import pytest


def needed(module: str) -> ModuleType:
    """The module; without it the test is skipped, or fails with CI=true."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError:
        absent(f"{module.partition('.')[0]} is not installed (pip install -r tests/requirements-ci.txt)")
        raise


def what_builds_the_site() -> None:
    """The packages of coursekit/site/requirements.txt are needed; without them as `needed`."""
    from coursekit.site import tools  # which finds them; the browser's Python reads this file and has no site

    if not all(map(find_spec, ("jupyter_server_mathjax", "jupyterlite_core"))):
        absent(f"the site's packages are not installed ({tools.INSTALL})")


def absent(what: str) -> None:
    """Something is not there."""
    (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)(what)
