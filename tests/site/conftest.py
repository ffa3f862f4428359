"""The site, built once for the tests that look at it.

They need the packages of coursekit/site/requirements.txt: where these are missing they are skipped with the
reason; with CI=true they fail instead.
"""

import os
from pathlib import Path

import pytest

from coursekit import site
from tests import needs
from tests.site.pyodide import Unavailable, take
from tests.site.server import Served

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def pyodide(pytestconfig):
    """Pyodide's files: taken from the registries in CI, elsewhere used if they are there."""
    folder = pytestconfig.rootpath / ".pytest_cache" / "pyodide"
    if os.environ.get("CI") != "true" and not (folder / "complete").exists():
        pytest.skip(f"Pyodide's files are not here: python tests/site/pyodide.py {folder.relative_to(ROOT)}")
    try:
        return take(folder)
    except Unavailable as reason:
        pytest.fail(f"Pyodide's files cannot be had: {reason}")


@pytest.fixture(scope="session")
def pages(request, tmp_path_factory):
    """The folder of a site; with what runs in the browser if Pyodide's files are here, or must be (in CI)."""
    needs.what_builds_the_site()
    out = tmp_path_factory.mktemp("site") / "out"
    try:
        files = request.getfixturevalue("pyodide")
    except pytest.skip.Exception:
        files = None
    site.write(out, pyodide=files)
    return out


@pytest.fixture(scope="session")
def run(pyodide, pages):
    """What runs in the browser, in that folder."""
    return pages / "run"


@pytest.fixture(scope="session")
def served(pages):
    """That site on a plain server."""
    with Served(pages) as server:
        yield server
