"""What every test runs under: one thread per process, and nothing written outside the course's folder."""

import contextlib
import getpass
import os
import tempfile
from pathlib import Path

import pytest

# Several pytest workers and kernels share the machine; numpy reads these when it is first imported.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

from coursekit.classroom.lab import private_folders  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
# One folder per worker: two IPython kernels starting at once fight over one history database.
PRIVATE = ROOT / ".pytest_cache" / "private" / os.environ.get("PYTEST_XDIST_WORKER", "main")

for variable, path in private_folders(PRIVATE).items():
    Path(path).mkdir(parents=True, exist_ok=True)
    os.environ[variable] = path

# Notebooks among the tests are material (releases, submissions), not lessons to be run.
collect_ignore_glob = ["*.ipynb"]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """The tests of a file stay together, and so do all that drive a browser: two cores bear one of these."""
    from xdist.scheduler import LoadFileScheduling

    class Together(LoadFileScheduling):
        def _split_scope(self, nodeid):
            file = super()._split_scope(nodeid)
            return "tests/browser" if file.startswith(("tests/browser/", "tests/site/")) else file

    return Together(config, log)


def pytest_unconfigure():
    """Remove pytest's own temporary folder too, unless a failed test left something there to look at."""
    with contextlib.suppress(OSError, KeyError):
        Path(tempfile.gettempdir(), f"pytest-of-{getpass.getuser()}").rmdir()
