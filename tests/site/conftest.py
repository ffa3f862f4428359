"""The site, built once for the tests that look at it.

They need the packages of coursekit/site/requirements.txt: where these are missing they are skipped with the
reason; with CI=true they fail instead.
"""

import os
from importlib.util import find_spec

import pytest

from coursekit import site
from tests.browser.conftest import browser, pytest_collection_modifyitems  # noqa: F401
from tests.site.server import Served


def missing(reason):
    (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)(reason)


@pytest.fixture(scope="session")
def pages(tmp_path_factory):
    """The folder of a site without Pyodide."""
    if not find_spec("jupyter_server_mathjax"):
        missing("the site's packages are not installed (pip install -r coursekit/site/requirements.txt)")
    out = tmp_path_factory.mktemp("site") / "out"
    assert "pages to read" in site.write(out)
    return out


@pytest.fixture(scope="session")
def served(pages):
    """Such a site on a plain server."""
    with Served(pages) as server:
        yield server
