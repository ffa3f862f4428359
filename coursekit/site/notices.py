"""The licences of everything that a site ships and that was not written for this course."""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

# What the pages hold: package -> what of it is in them.
OF_PAGES = {
    "meshcat": "the 3D viewer of the explorers, with three.js and the rest that it is built from",
    "jupyter-server-mathjax": "MathJax with STIX fonts, which sets the formulas",
    "pygments": "the colours of the code",
}
_LICENCE = re.compile(r"(?i)licen[cs]e|copying|notice")


def write(out: Path, packages: dict[str, str]) -> None:
    """Copy the licences of installed packages into `out`/licences and list them in its README.txt.

    Raises
    ------
    ValueError
        If one of them is not installed, or comes without the text of its licence.
    """
    folder = out / "licences"
    folder.mkdir(exist_ok=True)
    lines = ["What this site ships of other people's work, and under which terms.", ""]
    for name, what in packages.items():
        texts = {file: text for file, text in of_package(name).items() if text.strip()}
        for file, text in texts.items():
            (folder / file).write_text(text, encoding="utf-8")
        lines += [f"{name}: {what}", *(f"    {file}" for file in sorted(texts)), ""]
    say(out, "\n".join(lines))


def say(out: Path, text: str) -> None:
    """Add to the list what comes from no installed package."""
    with (out / "licences" / "README.txt").open("a", encoding="utf-8") as readme:
        readme.write(text + "\n")


def of_package(name: str) -> dict[str, str]:
    """The texts of a package's licences, by names of their own; ValueError if there is none."""
    try:
        found = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        raise ValueError(f"{name} is shipped with the site, but is not installed") from None
    texts = {}
    for file in found.files or ():
        path = Path(str(found.locate_file(file)))
        if _LICENCE.search(file.name) and path.is_file():
            place = "" if ".dist-info" in str(file) else f"{path.parent.name}-"
            texts[f"{name}-{place}{file.name}"] = path.read_text(encoding="utf-8", errors="replace")
    if not texts:
        raise ValueError(f"{name} comes without the text of its licence")
    return texts
