"""The habits of documentation: the public is explained, examples run, the README's commands are whole."""

import doctest
import importlib
import inspect
import pkgutil
import re
from pathlib import Path

import pytest

import coursekit
from coursekit import robots
from coursekit.site.reference import offered

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
MODULES = sorted(
    found.name
    for found in pkgutil.walk_packages(coursekit.__path__, "coursekit.")
    if not found.name.endswith("__main__")
)
# What `coursekit` itself offers of the mathematics: the part that people meet first.
FACE = [name for name in coursekit.__all__ if f"coursekit.kinematics.{name}" in MODULES]


def methods(thing):
    """(name, method or property) of a class, the public ones that it defines itself."""
    for name, method in vars(thing).items() if inspect.isclass(thing) else ():
        if not name.startswith("_") and (inspect.isroutine(method) or isinstance(method, property)):
            yield name, method


@pytest.mark.parametrize("name", MODULES)
def test_modules_functions_and_classes_are_explained(name):
    module = importlib.import_module(name)
    assert (module.__doc__ or "").strip(), f"{name} has no docstring"
    # a wrong function is explained by the hint it is there for, a draw by the words of its case
    if ".mistakes." not in name and ".exercises." not in name:
        assert not [thing for thing, what in offered(module) if not inspect.getdoc(what)]


@pytest.mark.parametrize("name", FACE)
def test_the_mathematics_is_explained_with_examples(name):
    module = getattr(coursekit, name)
    without = []
    for thing, what in offered(module):
        inner = [f"{thing}.{method}" for method, code in methods(what) if not inspect.getdoc(code)]
        own = inspect.getdoc(what) or ""
        without += inner + ([thing] if inspect.isfunction(what) and ">>>" not in own else [])
    assert not without, "no docstring, or no example that can be pasted"


def public_functions():
    """(name, function, what it is asked for) of all that `coursekit` offers but pictures."""
    for name in coursekit.__all__:
        thing = getattr(coursekit, name)
        for owner, code in offered(thing) if inspect.ismodule(thing) else [(name, thing)]:
            for said, one in [(owner, code), *((f"{owner}.{m}", getattr(code, m)) for m, _ in methods(code))]:
                if callable(one) and not inspect.isclass(one) and name != "view":
                    asked = [p for p in inspect.signature(one).parameters if p not in ("self", "robot")]
                    yield f"{name}.{said}", one, asked


PUBLIC = {name: (function, asked) for name, function, asked in public_functions()}


@pytest.mark.parametrize("name", PUBLIC)
def test_the_parameters_are_named(name):
    """Three or more in a list as numpydoc has it; fewer in the sentence itself, with shape and unit."""
    function, asked = PUBLIC[name]
    text = inspect.getdoc(function)
    if len(asked) > 2:
        _, _, listed = text.partition("Parameters\n----------\n")
        text = " ".join(re.findall(r"^(\S.*?)(?: : |$)", listed.partition("\n\n")[0], flags=re.M))
    assert set(asked) <= set(re.findall(r"\w+", text))


@pytest.mark.parametrize("name", ["coursekit", *MODULES])
def test_examples_print_what_they_say(name, capsys):
    result = doctest.testmod(
        importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    )
    assert result.failed == 0, capsys.readouterr().out


# -- the README


def commands(language):
    return re.findall(rf"^```{language}\n(.*?)\n```$", README, flags=re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("ending", ["coursekit study", "-m pytest"])
def test_readme_has_each_command_for_both_systems(ending):
    (unix,) = (command for command in commands("bash") if command.endswith(ending))
    (windows,) = (command for command in commands("bat") if command.endswith(f'{ending}"'))
    assert "\n" not in unix + windows, "one line to paste"
    translated = (
        unix.replace("python3 -m venv", "py -m venv").replace("/bin/", "/Scripts/").replace("/", "\\")
    )
    assert windows == f'cmd /c "{translated}"'  # PowerShell knows no "&&"


def test_readme_can_be_read_in_a_few_minutes():
    assert len(README.split()) <= 1500, "words in README.md: what not everybody needs belongs into .github"


def test_readme_names_every_robot_of_the_catalogue():
    (told,) = re.findall(r"^The robots: (.*)$", README, flags=re.MULTILINE)
    words = set(re.split(r"[ ,]+", told))
    names = {robot.name.split(" (")[0] for robot in robots.all().values()}  # a variant stands for itself
    missing = {name for name in names if not set(re.findall(r"\S*\d\S*|\S+$", name)) <= words}
    assert not missing, "in README's list of robots"


def test_readme_links_lead_somewhere():
    targets = re.findall(r"\]\(([^)#\s]+)", README) + re.findall(r'(?:src|href)="([^"#]+)"', README)
    inside = [target for target in targets if not re.match(r"[a-z]+:", target)]
    assert not [target for target in inside if not (ROOT / target).exists()]
