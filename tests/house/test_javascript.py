"""The JavaScript of the pages: lint by biome, types from its JSDoc by TypeScript; nothing is built."""

import json
import re
import shutil
import subprocess

import pytest

from coursekit.view import script
from tests.house.test_docs import ROOT
from tests.needs import absent

PAGE, TOOLS = ROOT / "tests" / "page", ROOT / ".venv" / "proxy" / "node_modules" / ".bin"
VIEW = ROOT / "coursekit" / "view" / "static"
SITE = ROOT / "coursekit" / "site" / "static"
# The view's files are read together, as pages read them.
JOINED = {"widgets.js": script.SCRIPTS, "stub.js": ["stub"]}
FILLED = {"@version@": "1", "@pages@": "[]"}  # what the site writes into its files


def run(tool, *arguments, folder):
    program = shutil.which(tool, path=TOOLS) or shutil.which(tool)
    if not program or not shutil.which("node"):
        absent(f"{tool} or node is not installed (.ci/run says how)")
    done = subprocess.run([program, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def scripts(folder, also=""):
    """The modules as pages get them, and all other scripts, in this folder; `also` ends each of them."""
    for name, parts in JOINED.items():
        joined = "\n".join((VIEW / f"{part}.js").read_text("utf-8") for part in parts)
        (folder / name).write_text(joined + also, "utf-8")
    others = [*(VIEW / "lab").rglob("*.js"), *SITE.rglob("*.js"), *(ROOT / "tests").rglob("*.mjs")]
    for path in others:
        text = path.read_text("utf-8")
        for mark, value in FILLED.items():
            text = text.replace(mark, value)
        (folder / path.name).write_text(text + also, "utf-8")
    return folder


def placed(text):
    """What a tool said, with the file and line of this repository in place of those of a joined module."""

    def place(found):
        line = int(found["line"])
        for part in JOINED[found["name"]]:
            lines = (VIEW / f"{part}.js").read_text("utf-8").count("\n") + 1
            if line <= lines:
                break
            line -= lines
        return f"coursekit/view/static/{part}.js, line {line} "

    names = "|".join(map(re.escape, JOINED))
    return re.sub(rf"\b(?P<name>{names})(?:,line=|\(|:)(?P<line>\d+)", place, text)


def lint(folder):
    return run("biome", "lint", f"--config-path={PAGE}", "--reporter=github", ".", folder=folder)


def types(folder):
    settings = {"extends": f"{PAGE}/tsconfig.json", "files": list(JOINED)}
    (folder / "tsconfig.json").write_text(json.dumps(settings))
    return run("tsc", "-p", ".", folder=folder)


@pytest.mark.parametrize("check", [lint, types])
def test_nothing_is_said_of_the_javascript(check, tmp_path):
    failed, said = check(scripts(tmp_path))
    assert not failed, placed(said)


@pytest.mark.parametrize(
    ("check", "wrong", "told"),
    [
        (lint, "\nundeclared();", "noUndeclaredVariables"),
        (types, "\nself.name = document.misprint;", "TS2339"),
    ],
)
def test_a_mistake_is_found(check, wrong, told, tmp_path):
    failed, said = check(scripts(tmp_path, also=wrong))
    assert failed and told in said, said
