"""What every test runs under: one thread per process, and nothing written outside the course's folder."""

import contextlib
import getpass
import os
import tempfile
from pathlib import Path

import hypothesis
import pytest

# No test is timed: a busy machine is no fault of the course.
hypothesis.settings.register_profile("course", deadline=None)
hypothesis.settings.load_profile("course")

# Several pytest workers and kernels share the machine; numpy reads these when it is first imported.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

from coursekit.classroom.lab import private_folders  # noqa: E402
from tests.needs import absent, needed  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
# One folder per worker: two IPython kernels starting at once fight over one history database.
PRIVATE = ROOT / ".pytest_cache" / "private" / os.environ.get("PYTEST_XDIST_WORKER", "main")

for variable, path in private_folders(PRIVATE).items():
    Path(path).mkdir(parents=True, exist_ok=True)
    os.environ[variable] = path

DRIVE_A_BROWSER = ("tests/browser/", "tests/site/")

# Notebooks among the tests are material (releases, submissions), not lessons to be run.
collect_ignore_glob = ["*.ipynb"]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """The tests of a file stay together, and so do all that drive a browser: two cores bear one of these."""
    from xdist.scheduler import LoadFileScheduling

    class Together(LoadFileScheduling):
        def _split_scope(self, nodeid):
            file = super()._split_scope(nodeid)
            # the browser's Python runs under node there: a worker of its own halves the longest wait
            alone = file == "tests/site/test_python.py"
            return "tests/browser" if file.startswith(DRIVE_A_BROWSER) and not alone else file

    return Together(config, log)


def pytest_collection_modifyitems(items):
    """A test that fails here is tried again: a browser on a busy machine can stall for a minute.

    What is wrong in the course fails every time. pytest's summary counts what was run again.
    """
    for item in items:
        if item.get_closest_marker("browser") or item.get_closest_marker("hub"):
            item.add_marker(pytest.mark.flaky(reruns=2, reruns_delay=5))


@pytest.fixture(scope="session")
def browser():
    """One Chromium for all tests of a worker: two of Playwright's loops do not go into one process."""
    # not at the top: the browser's Python reads this file, too, and has not what a lab needs
    from tests.browser.lab import CHROMIUM_FLAGS, chromium

    sync_playwright = needed("playwright.sync_api").sync_playwright
    if not chromium():
        absent("no Chromium on the PATH (set CHROMIUM to its path)")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=chromium(), args=list(CHROMIUM_FLAGS))
        yield running
        running.close()


def pytest_unconfigure():
    """Remove pytest's own temporary folder too, unless a failed test left something there to look at."""
    with contextlib.suppress(OSError, KeyError):
        Path(tempfile.gettempdir(), f"pytest-of-{getpass.getuser()}").rmdir()
