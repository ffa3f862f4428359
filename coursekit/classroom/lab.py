"""`coursekit lab`: JupyterLab on the course's notebooks, with everything it writes kept inside the folder.

Settings, kernels' connection files, IPython's history, matplotlib's font cache and the like go to
`.venv/lab/`, so that deleting the course's folder leaves nothing behind and a read-only home is no obstacle.

>>> from coursekit.classroom import lab
>>> [name for name in lab.private_folders("/tmp/course") if name.startswith("JUPYTER")]
['JUPYTER_CONFIG_DIR', 'JUPYTER_DATA_DIR', 'JUPYTER_RUNTIME_DIR']
"""

import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from .course import ROOT, solved
from .question import progress


def private_folders(folder: str | Path) -> dict[str, str]:
    """The environment variables that make Jupyter, IPython and matplotlib write into one folder only.

    Parameters
    ----------
    folder : str or Path
        Where everything goes; it need not exist yet.

    Returns
    -------
    dict of str to str
        Names of environment variables -> absolute paths below `folder`.

    Examples
    --------
    >>> from pathlib import Path
    >>> from coursekit.classroom import lab
    >>> Path(lab.private_folders("/tmp/course")["IPYTHONDIR"]).relative_to("/tmp/course").as_posix()
    'ipython'
    """
    folder = Path(folder).absolute()
    return {
        "JUPYTER_CONFIG_DIR": str(folder / "config"),
        "JUPYTER_DATA_DIR": str(folder / "data"),
        "JUPYTER_RUNTIME_DIR": str(folder / "runtime"),
        "IPYTHONDIR": str(folder / "ipython"),
        "MPLCONFIGDIR": str(folder / "matplotlib"),
        "XDG_CACHE_HOME": str(folder / "cache"),
    }


def left_off(notebooks: Path) -> str | None:
    """The notebook a student worked in last: the last saved one in which a cell was run, or None.

    >>> from pathlib import Path
    >>> left_off(Path("a folder with nothing in it")) is None
    True
    """
    if solved(notebooks):
        return None
    by_time = sorted(notebooks.glob("*.ipynb"), key=lambda path: path.stat().st_mtime, reverse=True)
    return next((path.name for path in by_time if re.search(r'"execution_count": \d', _text(path))), None)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")


def start(
    arguments: Sequence[str] = (), notebooks: str | Path | None = None, folder: str | Path | None = None
) -> None:
    """Open the course in JupyterLab; returns when the server is stopped.

    Parameters
    ----------
    arguments : sequence of str
        Passed on to `jupyter lab`, for example ["--no-browser", "--port=8899"].
    notebooks : str or Path, optional
        The folder to open; the course's notebooks/ unless told otherwise.
    folder : str or Path, optional
        Where JupyterLab keeps what it writes; `.venv/lab` in the course's folder unless told otherwise.

    Raises
    ------
    ValueError
        If there is no such folder, for instance because the package was installed without its course.

    Examples
    --------
    >>> from coursekit.classroom import lab
    >>> lab.start(["--no-browser"])             # doctest: +SKIP
    """
    notebooks = Path(notebooks or ROOT / "notebooks").absolute()
    if not notebooks.is_dir():
        raise ValueError(
            f"JupyterLab was to open the folder {notebooks}, which does not exist; the course's notebooks "
            "stand beside its package: start it from the .venv in the course's folder"
        )
    folder = Path(folder) if folder else ROOT / ".venv" / "lab"
    opened = left_off(notebooks)
    if opened is None and not folder.exists():  # later JupyterLab itself opens what was open
        opened = min((path.name for path in notebooks.glob("0*.ipynb")), default=None)
    for variable, path in private_folders(folder).items():
        Path(path).mkdir(parents=True, exist_ok=True)
        os.environ[variable] = path
    # Terminals and `!` commands inside JupyterLab then find this environment's programs.
    os.environ["PATH"] = os.pathsep.join(
        [str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)]
    )

    from jupyterlab.labapp import LabApp  # only now: it reads the variables above when it is imported

    own = [f"--ServerApp.root_dir={notebooks}"]
    if opened:
        own.append(f"--LabApp.default_url=/lab/tree/{opened}")
    if line := progress(notebooks):
        print(line)
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        # Root is who one is in many containers; the server listens on this machine only and wants a token.
        own.append("--allow-root")
    LabApp.launch_instance(argv=[*own, *arguments])
