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
EXTENSIONS = FOLDER / "share" / "jupyter" / "labextensions"

if str(FOLDER) not in sys.path:
    sys.path.append(str(FOLDER))
