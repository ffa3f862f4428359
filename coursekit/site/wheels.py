"""The Python packages that a kernel in the browser loads, and the list of them that Pyodide calls its lock.

Compiled ones are Pyodide's own, each checked against the sum that Pyodide's lock has for it. The others are
those that the course runs with here, taken from this environment. A kernel that misses a package waits for
ever and says nothing, so whatever the course imports must be in the lock: `check_imports`.
"""

from __future__ import annotations

import ast
import hashlib
import io
import json
import re
import shutil
import sys
import zipfile
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path

VERSION = "0.27.7"  # of Pyodide; another one brings other packages, and was not tried
CORE = ("pyodide.js", "pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip")

# From Pyodide's archive, with all that they need in turn.
PYODIDES = ("numpy", "matplotlib", "pillow", "ipython", "jedi", "micropip", "packaging")
# What those name and a kernel does without: fonts for PDF, time zones, the lines of a terminal.
NOT_NEEDED = ("fonttools", "pytz", "prompt-toolkit", "wcwidth")
# Files with other contents: IPython imports its terminal, which a browser has not, and 130 modules with it.
_INSTEAD = {
    "IPython/terminal/embed.py": b'def embed(**_):\n    raise RuntimeError("a browser has no terminal")\n'
}

# From this environment: package -> (what it is imported as, what it needs in the browser).
FROM_HERE: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "comm": (("comm",), ("traitlets",)),
    "ipywidgets": (("ipywidgets",), ("ipython", "traitlets", "comm", "widgetsnbextension")),
    "anywidget": (("anywidget",), ("ipywidgets", "psygnal", "typing-extensions")),
    "psygnal": (("psygnal",), ()),
    "typing-extensions": (("typing_extensions",), ()),
    "sympy": (("sympy",), ("mpmath",)),
    "mpmath": (("mpmath",), ()),
    "meshcat": (("meshcat",), ()),
    "u-msgpack-python": (("umsgpack",), ()),
}
# From jupyterlite-pyodide-kernel, which stands in for what cannot run in a browser.
OF_THE_KERNEL: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "piplite": (("piplite",), ("micropip",)),
    "pyodide_kernel": (("pyodide_kernel",), ("ipython", "comm", "ipykernel", "jedi")),
    "ipykernel": (("ipykernel",), ()),
    "widgetsnbextension-4": (("widgetsnbextension",), ()),
}
COURSE = ("numpy", "sympy", "matplotlib", "pillow", "anywidget", "meshcat", "u-msgpack-python")
# What the kernel loads before the first cell: loading it later costs the student a wait in the middle.
# (The kernel asks for these by name; without one of them it waits for ever.)
AT_ONCE = (
    *("micropip", "piplite", "ssl", "sqlite3", "ipykernel", "comm", "pyodide_kernel", "jedi", "ipython"),
    "coursekit",
)

# Other packages of pure Python lie in Python's own library, an archive that is read where it is: to unpack
# them takes as long as to import them. Not these: they open files of their own.
_OPEN_FILES = ("meshcat", "parso")

# Parts of the course that need a server or a process of their own.
NOT_IN_A_BROWSER = re.compile(
    r"coursekit/(__main__|commands|view/reopened|classroom/lab)\.py|coursekit/view/static/(lab|server)/|__pycache__"
)
# What no kernel reads. (Bold letters that slant are drawn as bold ones.)
_SPARE = re.compile(
    r"(?x) (^|/)tests?/ | /benchmarks/ | ^(?!jedi/).*\.pyi$ | \.a$ | ^\.\./ | \.dist-info/RECORD$"
    r"| mpl-data/sample_data/ | mpl-data/fonts/(afm|pdfcorefonts)/ | DejaVuSerif"
    r"| DejaVuSans(Mono)?-(Mono-)?BoldOblique | DejaVuSansMono-(Bold|Oblique) | STIXGeneralBol"
    r"| ^numpy/(f2py|_core/include)/ | ^IPython/sphinxext/ | ^PIL/_webp\. | dateutil-zoneinfo\.tar\.gz$"
    r"| ^jedi/third_party/(django-stubs|typeshed/(third_party|stdlib/2))/"
    r"| ^pygments/lexers/(?!__init__|_mapping|python|special|diff)"
    r"| ^meshcat/(?!__init__\.py|viewer/dist/main\.min\.js|viewer/LICENSE) | ^anywidget/nbextension/"
    r"| __pycache__ | (^|/)labextension/"
)


def canonical(name: str) -> str:
    """A package's name as locks compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def write(pyodide: Path, kernel: Path, course: Path, version: str, out: Path) -> dict[str, dict]:
    """Write Pyodide's core, with what lies in its library, the wheels and their lock into a new folder.

    Parameters
    ----------
    pyodide : Path
        Pyodide's own files: the unpacked archive of its release.
    kernel : Path
        The folder of wheels that jupyterlite-pyodide-kernel brings.
    course : Path
        A folder that `coursekit release` has written.
    version : str
        Of the course.

    Returns
    -------
    dict
        The packages, as a lock names them.
    """
    theirs = official(pyodide)
    out.mkdir(parents=True)
    for name in CORE:
        shutil.copy(pyodide / name, out / name)
    packages: dict[str, dict] = {}
    made: dict[str, bytes] = {}

    def keep(entry: dict, data: bytes) -> None:
        name = canonical(entry["name"])
        packages[name], made[name] = {**entry, "sha256": hashlib.sha256(data).hexdigest()}, data

    def add(name: str) -> None:
        name = canonical(name)
        if name in packages or name in NOT_NEEDED:
            return
        entry = dict(theirs["packages"][name])
        entry["depends"] = [canonical(n) for n in entry["depends"] if canonical(n) not in NOT_NEEDED]
        keep(entry, _slim((pyodide / entry["file_name"]).read_bytes()))
        for need in entry["depends"]:
            add(need)

    for name in PYODIDES:
        add(name)
    for name, (imports, needs) in FROM_HERE.items():
        file, data = from_here(name)
        keep(_entry(name, file, imports, needs), data)
    for start, (imports, needs) in OF_THE_KERNEL.items():
        (wheel,) = kernel.glob(f"{start}*.whl")
        keep(_entry(canonical(wheel.name.split("-")[0]), wheel.name, imports, needs), wheel.read_bytes())
    # The kernel wants "ssl". Nothing here speaks to a server, so 2 MB of OpenSSL can stay away.
    stub = _zip({"ssl-1.0.0.dist-info/METADATA": _about("ssl", "1.0.0")})
    keep(_entry("ssl", "ssl-1.0.0-py3-none-any.whl", (), ()), stub)
    file = f"coursekit-{version}-py3-none-any.whl"
    keep(_entry("coursekit", file, ("coursekit",), COURSE), of_course(course, version))
    wanted = {*map(canonical, AT_ONCE), *(need for entry in packages.values() for need in entry["depends"])}
    missing = wanted - set(packages)
    if missing:
        raise ValueError(f"packages of the lock need what is not in it: {', '.join(sorted(missing))}")
    _lay_out(out, theirs["info"], packages, made)
    return packages


def _lay_out(out: Path, info: dict, packages: dict[str, dict], made: dict[str, bytes]) -> None:
    """Write the wheels and their lock; pure ones that nobody loads by name into Python's library."""
    apart = {*map(canonical, AT_ONCE), *_OPEN_FILES}
    apart |= {name for name, entry in packages.items() if not entry["file_name"].endswith("-none-any.whl")}
    library = _unzip((out / "python_stdlib.zip").read_bytes())
    locked = {}
    for name, entry in sorted(packages.items()):
        if name in apart:
            (out / entry["file_name"]).write_bytes(made[name])
            locked[name] = {**entry, "depends": [need for need in entry["depends"] if need in apart]}
        else:
            library |= _unzip(made[name])
    (out / "python_stdlib.zip").write_bytes(_zip(library))
    lock = {"info": info, "packages": locked}
    (out / "pyodide-lock.json").write_text(json.dumps(lock), encoding="utf-8")


def official(pyodide: Path) -> dict:
    """Pyodide's own lock, once all files that are needed are there and are what it says they are.

    Raises
    ------
    ValueError
        If a file is missing or has another sum, or the version is another one.
    """
    where = f"download pyodide-{VERSION}.tar.bz2 from the releases of Pyodide and unpack it"
    if not (pyodide / "pyodide-lock.json").is_file():
        raise ValueError(f"{pyodide} holds no pyodide-lock.json: {where}")
    lock = json.loads((pyodide / "pyodide-lock.json").read_text(encoding="utf-8"))
    if lock["info"]["version"] != VERSION:
        raise ValueError(
            f"{pyodide} is Pyodide {lock['info']['version']}; the course was tried with {VERSION}"
        )
    needed, waiting = set(), list(PYODIDES)
    while waiting:
        name = canonical(waiting.pop())
        if name not in needed and name not in NOT_NEEDED:
            needed.add(name)
            waiting += lock["packages"][name]["depends"]
    files = [*CORE, *(lock["packages"][name]["file_name"] for name in sorted(needed))]
    missing = [name for name in files if not (pyodide / name).is_file()]
    if missing:
        raise ValueError(f"{pyodide} lacks {', '.join(missing)}: {where}")
    for name in needed:
        entry = lock["packages"][name]
        if hashlib.sha256((pyodide / entry["file_name"]).read_bytes()).hexdigest() != entry["sha256"]:
            raise ValueError(
                f"{entry['file_name']} is not the file that Pyodide's lock names: its sum differs"
            )
    return lock


def _entry(name: str, file: str, imports: Iterable[str], needs: Iterable[str]) -> dict:
    version = file.split("-")[1]
    about = {
        "name": name,
        "version": version,
        "file_name": file,
        "install_dir": "site",
        "package_type": "package",
    }
    return {**about, "imports": list(imports), "depends": list(needs), "unvendored_tests": False}


# -- wheels


def _about(name: str, version: str) -> bytes:
    return f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n".encode()


def _zip(files: dict[str, bytes]) -> bytes:
    """A wheel, the same bytes for the same files."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for name, data in sorted(files.items()):
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(info, data)
    return out.getvalue()


def _unzip(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as wheel:
        return {name: wheel.read(name) for name in wheel.namelist() if not name.endswith("/")}


def _slim(data: bytes) -> bytes:
    return _zip(
        {name: _INSTEAD.get(name, part) for name, part in _unzip(data).items() if not _SPARE.search(name)}
    )


def from_here(name: str) -> tuple[str, bytes]:
    """(file name, bytes) of a wheel of an installed package, without what is compiled.

    Raises
    ------
    ValueError
        If it is not installed here, or has no Python files.
    """
    try:
        found = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        raise ValueError(f"{name} is not installed here, and the site needs it") from None
    files = {}
    for file in found.files or ():
        path = Path(str(found.locate_file(file)))
        if (
            not _SPARE.search(file.as_posix())
            and path.is_file()
            and path.suffix not in (".pyc", ".so", ".pyd")
        ):
            files[file.as_posix()] = path.read_bytes()
    if not any(file.endswith(".py") for file in files):
        raise ValueError(f"the installed {name} holds no Python files")
    return f"{canonical(name).replace('-', '_')}-{found.version}-py3-none-any.whl", _zip(files)


def of_course(course: Path, version: str) -> bytes:
    """The wheel of the students' coursekit, without what needs a server."""
    files = {}
    for path in sorted((course / "coursekit").rglob("*")):
        name = path.relative_to(course).as_posix()
        if path.is_file() and not NOT_IN_A_BROWSER.search(name):
            files[name] = path.read_bytes()
    files[f"coursekit-{version}.dist-info/METADATA"] = _about("coursekit", version)
    files[f"coursekit-{version}.dist-info/LICENSE"] = (course / "LICENSE").read_bytes()
    return _zip(files)


# -- imports


def check_imports(packages: dict[str, dict], wheel: Path, notebooks: Iterable[Path]) -> None:
    """ValueError if the course's wheel or a notebook imports what is neither Python's own nor in the lock."""
    there = {name for entry in packages.values() for name in entry["imports"]}
    there |= {name.replace("-", "_") for name in packages} | set(sys.stdlib_module_names) | {"PIL"}
    missing: dict[str, list[str]] = {}
    for place, source in _sources(wheel, notebooks):
        for name in sorted(_imported(source) - there):
            missing.setdefault(name, []).append(place)
    if missing:
        told = "; ".join(f"{name} ({', '.join(places[:3])})" for name, places in missing.items())
        raise ValueError(f"imported by the course, but not in the lock of the browser's Python: {told}")


def _sources(wheel: Path, notebooks: Iterable[Path]) -> Iterable[tuple[str, str]]:
    with zipfile.ZipFile(wheel) as files:
        yield from ((n, files.read(n).decode()) for n in files.namelist() if n.endswith(".py"))
    for path in notebooks:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        yield path.name, "\n".join(re.sub(r"(?m)^\s*[%!].*$", "", source) for source in code)


def _imported(source: str) -> set[str]:
    """The packages that a text imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            found.add(node.module.split(".")[0])
    return found
