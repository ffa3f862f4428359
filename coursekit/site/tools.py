"""Where the packages lie that only the site is built with.

They have a folder of their own, beside those of the course: one of them brings an extension that every
JupyterLab of the environment would load, and which works in a browser's JupyterLab alone.
"""

from __future__ import annotations

import sys
from pathlib import Path

FOLDER = Path(sys.prefix) / "site"
REQUIREMENTS = Path(__file__).with_name("requirements.txt")
INSTALL = f"python -m pip install --no-deps --target {FOLDER} -r {REQUIREMENTS}"

if str(FOLDER) not in sys.path:
    sys.path.append(str(FOLDER))


def extension(name: str) -> Path:
    """The folder of one of JupyterLab's extensions, from there or from the course's own environment."""
    places = [prefix / "share" / "jupyter" / "labextensions" / name for prefix in (FOLDER, Path(sys.prefix))]
    return next((place for place in places if place.is_dir()), places[0])
