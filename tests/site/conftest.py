"""The site, built once for the tests that look at it.

They need the packages of coursekit/site/requirements.txt: where these are missing they are skipped with the
reason; with CI=true they fail instead.
"""

import contextlib
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
    """The folder of a site; with what runs in the browser if Pyodide's files are here, or must be (in CI).

    The worker that comes first builds it for all: nobody may write into it.
    """
    needs.what_builds_the_site()
    try:
        files = request.getfixturevalue("pyodide")
    except pytest.skip.Exception:
        files = None
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    with one_at_a_time(folder / "site.lock"):
        if not (folder / "site").exists():
            site.write(folder / "site", pyodide=files)
    return folder / "site"


@contextlib.contextmanager
def one_at_a_time(path):
    """Only one process is inside, where the system knows such locks; the site is tested on Linux."""
    import fcntl

    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@pytest.fixture(scope="session")
def run(pyodide, pages):
    """What runs in the browser, in that folder."""
    return pages / "run"


@pytest.fixture(scope="session")
def served(pages):
    """That site on a plain server."""
    with Served(pages) as server:
        yield server
