"""The house: what stands at the top, which room may import which, and that every import is pinned."""

import ast
import json
import re
import shutil
import subprocess
import sys
import tomllib
from functools import cache
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "coursekit"
SOURCES = sorted(PACKAGE.rglob("*.py"))
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))

TOP_LEVEL = {"notebooks", "coursekit", "tests", "environment.txt", "README.md", "LICENSE", "pyproject.toml"}
LONGEST_FILE = 400  # lines; most have 150 to 300

# room -> what it must not import from the package
ROOMS = {
    "kinematics": ("coursekit.view", "coursekit.classroom", "coursekit.site"),
    "view": ("coursekit.classroom", "coursekit.site"),
    "classroom": ("coursekit.view", "coursekit.site"),
}
# where the classroom shows what a wrong answer looks like
MAY_DRAW = {"coursekit/classroom/picture.py"}
# the mathematics needs numpy alone; the exception
MATHEMATICS = {"numpy"}
EXCEPTIONS = {("symbolic", "sympy")}


def relative(path):
    return path.relative_to(ROOT).as_posix()


def imports(tree, package=""):
    """(module, whether at the top of the file) for every import of a syntax tree, made absolute."""
    top = set(map(id, tree.body))
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, id(node) in top) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*parents, *([base] if base else [])])
            yield from ((f"{base}.{alias.name}", id(node) in top) for alias in node.names)


@cache
def imports_of(path):
    package = ".".join(path.parent.relative_to(ROOT).parts)
    return tuple(imports(ast.parse(path.read_text(encoding="utf-8")), package))


def code_of(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) + "\n" for cell in cells if cell["cell_type"] == "code")
    return "".join(
        line for line in code.splitlines(keepends=True) if not line.lstrip().startswith(("%", "!"))
    )


def third_party(modules):
    tops = {module.split(".")[0] for module, _ in modules}
    return tops - set(sys.stdlib_module_names) - {"coursekit", "tests", "conftest"}


def plain(name):
    """A package's name as PyPI compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def pins(path):
    lines = [line.strip() for line in (ROOT / path).read_text(encoding="utf-8").splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def test_top_level_is_what_it_is():
    if not shutil.which("git"):
        pytest.skip("without git nobody knows which files belong to the course")
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    if listed.returncode:
        pytest.skip("not a git clone: nobody knows which files belong to the course")
    top = {name.split("/")[0] for name in listed.stdout.splitlines()}
    assert {name for name in top if not name.startswith(".")} == TOP_LEVEL


@pytest.mark.parametrize("path", SOURCES, ids=relative)
def test_rooms_import_only_downwards(path):
    room = path.relative_to(PACKAGE).parts[0]
    forbidden = () if relative(path) in MAY_DRAW else ROOMS.get(room, ())
    upwards = [module for module, _ in imports_of(path) if module.startswith(forbidden)] if forbidden else []
    assert not upwards, f"{relative(path)} imports {upwards}, from a room that does not stand below it"


@pytest.mark.parametrize("path", sorted((PACKAGE / "kinematics").rglob("*.py")), ids=relative)
def test_mathematics_needs_numpy_alone(path):
    topic = path.stem.split("_")[0]
    for name in third_party(imports_of(path)) - MATHEMATICS:
        assert (topic, name) in EXCEPTIONS, f"{relative(path)} imports {name}"


@pytest.mark.parametrize("path", [path for path in SOURCES if path.name != "__main__.py"], ids=relative)
def test_library_neither_prints_nor_asserts(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        assert not isinstance(node, ast.Assert), f"{relative(path)}:{node.lineno}: raise an error instead"
        if path.parts[len(PACKAGE.parts)] == "kinematics" and isinstance(node, ast.Call):
            name = getattr(node.func, "id", None)
            assert name != "print", f"{relative(path)}:{node.lineno}: the mathematics prints nothing"


@pytest.mark.parametrize("path", SOURCES, ids=relative)
def test_files_can_be_read_in_one_sitting(path):
    if path.name != "robots.py":  # a catalogue: nobody reads it from end to end
        lines = len(path.read_text(encoding="utf-8").splitlines())
        assert lines <= LONGEST_FILE, f"{relative(path)}: a part of it may go into a file beside it"


def test_nothing_names_a_developers_machine_or_is_left_to_do():
    names = re.compile(r"/home/\w+/|/root/|[A-Z]:\\Users\\|\b(TODO|FIXME|XXX)\b")
    files = [*SOURCES, *PACKAGE.rglob("*.js"), *NOTEBOOKS, ROOT / "README.md"]
    picture = re.compile(r"[A-Za-z0-9+/]{70,}")  # any three letters are in one sooner or later
    texts = {relative(path): picture.sub("", path.read_text(encoding="utf-8")) for path in files}
    found = {path: names.findall(text) for path, text in texts.items()}
    assert not {path: hits for path, hits in found.items() if hits}


# -- the environment


@pytest.mark.parametrize("path", ["environment.txt", "tests/requirements.txt", "tests/requirements-ci.txt"])
def test_every_line_is_an_exact_pin(path):
    lines = pins(path)
    if path == "environment.txt":
        assert lines.pop() == "-e ."
    pinned = [Requirement(line) for line in lines]
    for requirement in pinned:
        assert re.fullmatch(r"==[^*]+", str(requirement.specifier)), f"{requirement} is no exact pin"
    names = [plain(requirement.name) for requirement in pinned]
    assert len(names) == len(set(names)), "a package is pinned twice"


def test_what_is_installed_is_what_is_pinned():
    wrong = []
    for line in pins("environment.txt")[:-1]:
        requirement = Requirement(line)
        if requirement.marker is None or requirement.marker.evaluate():
            installed = metadata.version(requirement.name)
            if not requirement.specifier.contains(installed, prereleases=True):
                wrong.append(f"{line}, but {installed} is installed")
    assert not wrong, "install again from environment.txt"


def test_everything_needed_in_turn_is_pinned():
    pinned = {plain(Requirement(line).name) for line in pins("environment.txt")[:-1]}
    missing = set()
    for name in sorted(pinned):
        try:
            needs = metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue  # for another system
        for need in map(Requirement, needs):
            applies = need.marker is None or need.marker.evaluate({"extra": ""})
            if applies and plain(need.name) not in pinned:
                missing.add(f"{need.name} (for {name})")
    assert not missing


def test_every_import_is_a_declared_dependency():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    lines = [*project["dependencies"], *extras["view"], *extras["classroom"], *extras["site"]]
    declared = {plain(Requirement(line).name) for line in lines} - {"coursekit"}
    pinned = {plain(Requirement(line).name) for line in pins("environment.txt")[:-1]}
    assert declared <= pinned
    used = set().union(*(third_party(imports_of(path)) for path in SOURCES))
    used |= set().union(*(third_party(imports(ast.parse(code_of(notebook)))) for notebook in NOTEBOOKS))
    provided = metadata.packages_distributions()
    undeclared = {name for name in used if not declared & {plain(d) for d in provided.get(name, ())}}
    assert not undeclared, f"imported but not among the dependencies in pyproject.toml: {undeclared}"


def test_jupyterlab_has_the_courses_settings():
    shipped = PACKAGE / "view" / "static" / "overrides.json"
    installed = Path(sys.prefix) / "share" / "jupyter" / "lab" / "settings" / "overrides.json"
    assert json.loads(installed.read_text()) == json.loads(shipped.read_text())


@pytest.mark.parametrize(
    ("room", "place"),
    [("lab", "share/jupyter/labextensions/coursekit"), ("server", "etc/jupyter/jupyter_server_config.d")],
)
def test_jupyterlab_has_what_moves_saved_explorers(room, place):
    shipped = PACKAGE / "view" / "static" / room
    for path in (path for path in shipped.rglob("*") if path.is_file()):
        installed = Path(sys.prefix) / place / path.relative_to(shipped)
        assert installed.read_bytes() == path.read_bytes(), "install again: pip install -e ."
