"""Both commands of the README on a fresh machine: as pasted, with an empty environment and no home.

A copy of the course is put into a folder whose name has spaces and letters that are not English. There is no
home directory, and none can be made: what a program wants to leave there fails or shows. It takes minutes and
asks the package index for everything, so it runs with CI=true or `-m fresh` only.
"""

import contextlib
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import time
import urllib.request
import uuid
from pathlib import Path

import pytest

from coursekit.classroom.grader.box import bubblewrap

ROOT = Path(__file__).resolve().parents[2]
# how this machine reaches the package index; everything else of its environment is left behind
NETWORK = re.compile(r"(?i)^(pip_.*|.*_proxy|ssl_cert_.*|requests_ca_bundle)$")

pytestmark = [
    pytest.mark.fresh,
    pytest.mark.skipif(os.name == "nt", reason="the Linux and macOS form of the commands"),
]


@pytest.fixture(scope="module")
def machine(request, tmp_path_factory):
    if os.environ.get("CI") != "true" and "fresh" not in request.config.option.markexpr:
        pytest.skip("sets the course up anew, which takes minutes: runs with CI=true or -m fresh")
    return Machine(tmp_path_factory.mktemp("machine"))


class Machine:
    """A folder for the course, an empty environment, and places where something might be left behind."""

    def __init__(self, folder):
        self.course = folder / "Robótica, für Anfänger (1)"
        leave = shutil.ignore_patterns(".*", "__pycache__", "work")
        shutil.copytree(ROOT, self.course, ignore=leave)
        nothing = folder / "nothing"
        nothing.touch()
        self.temporary = folder / "tmp"
        self.temporary.mkdir()
        self.environment = {name: value for name, value in os.environ.items() if NETWORK.match(name)}
        self.environment |= {
            "PATH": os.environ["PATH"],
            "HOME": str(nothing / "home"),  # not even root can make a folder inside a file
            "TMPDIR": str(self.temporary),
            "LANG": "C.UTF-8",
        }

    def command(self, ending, *arguments):
        """The README's command with this ending, as pasted, followed by arguments."""
        readme = (self.course / "README.md").read_text(encoding="utf-8")
        (line,) = re.findall(rf"^python3 .*{re.escape(ending)}$", readme, flags=re.MULTILINE)
        return ["bash", "-c", " ".join([line, *arguments])]


class Server:
    """The running JupyterLab, talked to as its page does: REST for sessions, a websocket for the kernel."""

    def __init__(self, runtime):
        facts = json.loads(next(runtime.glob("jpserver-*.json")).read_text())
        self.url, self.token = facts["url"].rstrip("/"), facts["token"]

    def ask(self, path, /, **body):
        request = urllib.request.Request(
            f"{self.url}{path}",
            headers={"Authorization": f"token {self.token}"},
            data=json.dumps(body).encode() if body else None,
        )
        with urllib.request.urlopen(request, timeout=60) as answer:
            content = answer.read()
        return json.loads(content) if content.startswith((b"{", b"[")) else content

    def execute(self, notebook):
        """Run all code cells of a notebook; the errors that the kernel reported."""
        import websocket

        cells = self.ask(f"/api/contents/{notebook}?content=1")["content"]["cells"]
        session = self.ask(
            "/api/sessions", path=notebook, type="notebook", name=notebook, kernel={"name": "python3"}
        )
        address = f"{self.url.replace('http', 'ws', 1)}/api/kernels/{session['kernel']['id']}/channels"
        channel = websocket.create_connection(
            address, header=[f"Authorization: token {self.token}"], timeout=120
        )
        errors = []
        for cell in cells:
            if cell["cell_type"] == "code" and "raises-exception" not in cell["metadata"].get("tags", []):
                errors += self._cell(channel, cell["source"])
        channel.close()
        return errors

    def _cell(self, channel, source):
        header = {"msg_id": uuid.uuid4().hex, "msg_type": "execute_request", "version": "5.3"}
        header |= {"username": "", "session": uuid.uuid4().hex, "date": ""}
        content = {"code": source, "silent": False, "store_history": True, "user_expressions": {}}
        content |= {"allow_stdin": False, "stop_on_error": False}
        message = {
            "header": header,
            "parent_header": {},
            "metadata": {},
            "content": content,
            "channel": "shell",
        }
        channel.send(json.dumps(message))
        errors = []
        while True:
            received = channel.recv()
            if isinstance(received, bytes):
                continue  # what a widget sends to its view
            answer = json.loads(received)
            if answer["parent_header"].get("msg_id") != header["msg_id"]:
                continue
            if answer["msg_type"] == "error":
                errors.append(f"{source}\n{answer['content']['ename']}: {answer['content']['evalue']}")
            if answer["msg_type"] == "status" and answer["content"]["execution_state"] == "idle":
                return errors


def answers(runtime):
    """Whether a server runs: it writes its file a moment before it listens."""
    with contextlib.suppress(OSError, ValueError, StopIteration):
        facts = json.loads(next(runtime.glob("jpserver-*.json")).read_text())
        socket.create_connection(("localhost", facts["port"]), timeout=5).close()
        return True
    return False


def test_first_command_opens_the_course(machine):
    log = machine.course.parent / "lab.log"
    with log.open("w") as output:
        process = subprocess.Popen(
            machine.command("coursekit study", "--no-browser", "--port=0"),
            cwd=machine.course,
            env=machine.environment,
            stdout=output,
            stderr=output,
            start_new_session=True,
        )
    try:
        runtime = machine.course / ".venv" / "study" / "runtime"
        until = time.monotonic() + 900
        while not answers(runtime):
            assert process.poll() is None, log.read_text()
            assert time.monotonic() < until, log.read_text()
            time.sleep(0.5)
        server = Server(runtime)
        shown = {entry["name"] for entry in server.ask("/api/contents")["content"]}
        assert {path.name for path in (ROOT / "notebooks").glob("*.ipynb")} <= shown
        assert b"JupyterLab" in server.ask("/lab")
        settings = server.ask("/lab/api/settings/@jupyterlab/apputils-extension:kernels-settings")
        assert settings["schema"]["properties"]["commsOverSubshells"]["default"] == "disabled"
        assert server.execute("01_dh_vs_poe.ipynb") == []
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        process.wait(30)
    said = log.read_text().split("ServerApp")[0]  # what came before JupyterLab's own log
    assert not re.search(r"(?i)error|deprecat|traceback", said), said


def test_second_command_on_top_of_the_first(machine):
    """Repeats the set-up where it was already done, adds what the tests need, and runs some of them."""
    done = subprocess.run(
        machine.command("-m pytest", "-q", *SOME_TESTS),
        cwd=machine.course,
        env=machine.environment,
        capture_output=True,
        text=True,
        timeout=900,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"\d+ passed", done.stdout)


# Run where there is no network but the machine's own: JupyterLab's page and its scripts come all the same.
ASK_THE_LAB = """
import pathlib, re, subprocess, sys, time, urllib.request
assert re.findall("^ *(.+?):", pathlib.Path("/proc/net/dev").read_text(), re.M) == ["lo"]
lab = subprocess.Popen(["coursekit", "lab", "--no-browser", "--port=8888", "--IdentityProvider.token=t"])
for _ in range(300):
    try:
        page = urllib.request.urlopen("http://127.0.0.1:8888/lab?token=t").read().decode()
        break
    except OSError:
        time.sleep(0.2)
for script in re.findall('src="(/[^"]*)"', page):
    assert urllib.request.urlopen("http://127.0.0.1:8888" + script).status == 200
lab.terminate()
lab.wait()
sys.exit("JupyterLab" not in page)
"""


SOME_TESTS = ["tests/house/test_import.py", "notebooks/01_dh_vs_poe.ipynb"]


@pytest.mark.parametrize("command", [["-m", "pytest", "-q", "-n0", *SOME_TESTS], ["-c", ASK_THE_LAB]])
def test_installed_it_needs_no_network(machine, command):
    if not bubblewrap():
        (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)("bubblewrap does not work here")
    cut_off = ["bwrap", "--dev-bind", "/", "/", "--unshare-net", "--die-with-parent"]
    programs = machine.course / ".venv" / "bin"
    done = subprocess.run(
        [*cut_off, str(programs / "python"), *command],
        cwd=machine.course,
        env={**machine.environment, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr


# Run outside the checkout, where nothing but the wheel and numpy is installed.
THE_WHEEL_ALONE = """
import importlib.metadata, coursekit
from coursekit import ik, robots, view
arm = robots.kuka_kr6()
assert ik.analytic(arm, arm.fk(arm.home)).exists.sum() == 8
names = {found.name for found in importlib.metadata.distributions()}
assert names <= {"coursekit", "numpy", "pip", "setuptools"}, names
try:
    view.explore(arm)
except ModuleNotFoundError as error:
    assert 'pip install "coursekit[view]"' in str(error), error
else:
    raise AssertionError("the 3D view needs more than numpy")
"""


PIP = ("-m", "pip", "-q", "--no-cache-dir")


def test_the_wheel_brings_numpy_alone(machine):
    folder = machine.course.parent / "wheel"
    python = folder / "venv" / "bin" / "python"
    steps = (
        ["python3", "-m", "venv", str(folder / "venv")],
        [str(python), *PIP, "wheel", "--no-deps", "-w", str(folder), str(machine.course)],
        ["bash", "-c", f"'{python}' {' '.join(PIP)} install coursekit-*.whl"],
        [str(python), "-c", THE_WHEEL_ALONE],
    )
    folder.mkdir()
    for step in steps:
        done = subprocess.run(
            step, cwd=folder, env=machine.environment, capture_output=True, text=True, timeout=600
        )
        assert done.returncode == 0, done.stdout + done.stderr


def test_nothing_is_left_outside_the_course(machine):
    assert list(machine.temporary.iterdir()) == []
    at_top = {path.name for path in machine.course.iterdir()}
    assert at_top - {path.name for path in ROOT.iterdir()} <= {
        "work",
        ".venv",
        ".pytest_cache",
        ".hypothesis",
    }
