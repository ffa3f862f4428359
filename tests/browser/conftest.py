"""Fixtures of the browser tests: one JupyterLab and one Chromium for all of them, one page for each.

Where there is no browser the tests are skipped with the reason; with CI=true they fail instead.
"""

import secrets

import pytest

from tests.browser.explorer import IMPORT, SHOW, Explorer
from tests.browser.lab import Lab, Notebook


@pytest.fixture(scope="session")
def lab(browser, tmp_path_factory):
    server = Lab(tmp_path_factory.mktemp("lab"))
    yield server
    server.close()


@pytest.fixture(scope="module")
def open_page(lab, browser):
    """Function that opens a fresh browser page: `open_page().open(lab.write("name.ipynb", "cell", ...))`.

    It is closed at the end of the file: a page that stays asks its server, and draws, to the end of the run.
    """
    contexts = []

    def new(**options):
        contexts.append(browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **options}))
        return Notebook(lab, contexts[-1].new_page())

    yield new
    for context in contexts:
        context.close()


@pytest.fixture
def notebook(lab, browser):
    """A fresh page for one test."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    yield Notebook(lab, context.new_page())
    context.close()


def explorer_in(notebook, request, name, robot, line):
    code = "import numpy as np\nfrom coursekit import robots, view"
    # another name for another try: JupyterLab gives a notebook of the same name the kernel that it had
    file = f"{request.node.name}_{secrets.token_hex(3)}.ipynb"
    written = notebook.lab.write(file, code, f"panel = {line}\npanel")
    notebook.open(written)
    notebook.run_all()
    notebook.wait_view()
    return Explorer(notebook, name, robot)


@pytest.fixture
def opened(notebook, request):
    """Function: the explorer that this line of code opens, run and at rest."""
    yield lambda name, robot, line: explorer_in(notebook, request, name, robot, line)
    assert notebook.errors == []


@pytest.fixture
def opened_by_touch(open_page, request):
    """The same on a screen that is touched."""
    return lambda name, robot, line: explorer_in(open_page(has_touch=True), request, name, robot, line)


@pytest.fixture(scope="module")
def kr6_opened(lab, open_page, request):
    """The explorer of a KUKA KR6, run and at rest; opening JupyterLab is what takes the time."""
    notebook = open_page()
    notebook.open(lab.write(f"{request.path.stem}.ipynb", IMPORT, SHOW, "1 + 1"))
    notebook.run_all()
    notebook.wait_view()
    return notebook


@pytest.fixture
def explorer(kr6_opened):
    """The same for each test of a file, as it was at first."""
    kr6_opened.kernel("panel.reset()")
    kr6_opened.settle()
    kr6_opened.errors.clear()
    yield kr6_opened
    assert kr6_opened.errors == []
