"""What the student wrote, in the explorers: called with care, and drawn beside the right one.

    view.explore(robots.kuka_kr6(), mine=fk_poe)      # the function's own name says which exercise it is
    view.explore_screws(kr6, mine=[screw_axis, body_screws])
    view.explore(kr6, mine={"fk_poe": another_try})

Whatever such a function does, the view goes on: what is the matter with it stands in the text. It may be not
written yet, raise, return the wrong shape or NaN, be slow, or change its arguments (it gets copies).
"""

from __future__ import annotations

import contextlib
import copy
import io
import time
import traceback
import warnings
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from coursekit.kinematics import lie
from coursekit.kinematics.robot import Robot

from . import text
from .scene import Scene

ROOT = "/ck/yours"  # everything that is drawn by the student's numbers
COLOR = "accent"  # and its one colour
ZERO = 1e-9  # metres, radians: what differs by less is the same
SLOW = 0.05  # seconds
FAR = 4.0  # sizes of the scene: what is farther away is told and not drawn


class Wanted(NamedTuple):
    """What an explorer shows of an exercise.

    signature and shape are those of the exercise (of several results: one shape for each; None: any length);
    sees completes "write it, and you see ...". Where the signature is "", it is no function but numbers.
    """

    signature: str
    shape: tuple
    sees: str


_ARM = "your arm, translucent, beside the right one, and which frame is the first that is off"
_AXES = "the axes of your screws on the arm, and what turns about them"

# opener of the explorer -> name of the exercise -> what is shown
WANTED: dict[str, dict[str, Wanted]] = {
    "explore": {
        "dh_transform": Wanted("a, alpha, d, theta", (4, 4), _ARM),
        "mdh_transform": Wanted("a_prev, alpha_prev, d, theta", (4, 4), _ARM),
        "fk_dh": Wanted("rows, theta, base, tool", (4, 4), _ARM),
        "screw_exp": Wanted("S, theta", (4, 4), _ARM),
        "fk_poe": Wanted("S, M, theta", (4, 4), _ARM),
        "screws_from_dh": Wanted("rows, base", (6, None), _ARM),
    },
    "explore_screws": {
        "screw_axis": Wanted("w, q", (6,), _AXES),
        "home_pose": Wanted("lengths", (4, 4), "your tool frame beside the arm's"),
        "axis_of": Wanted("S", ((3,), (3,), ()), _AXES),
        "body_screws": Wanted("S, M", (6, None), _AXES),
        "S": Wanted("", (6, None), _AXES),  # read off a drawing
    },
}


class Trouble(Exception):
    """Why there is nothing to see of a function; the text is for who wrote it."""


class Mine:
    """The student's functions of one explorer, and what the text says of each.

    given : a function, a list of functions, or a dict name of the exercise -> function.

    ValueError for a name that the explorer does not show, TypeError for what is no function.
    """

    def __init__(self, given: Any, opener: str) -> None:
        self.wanted = WANTED.get(opener, {})
        self.functions = _named(given, opener)
        self.said: dict[str, str] = {}
        self._took: dict[str, tuple[float, float]] = {}  # name -> seconds of the last look, when it ended
        self._changed = ""

    def ask(self, name: str, *arguments: Any, finite: bool = True) -> Any:
        """What the function returns for copies of these arguments: an array, or a tuple of them.

        Raises Trouble where that is no answer of the exercise's shape. Without `finite` NaN is an answer.
        """
        wanted, function = self.wanted[name], self.functions[name]
        if not wanted.signature:
            return _read(function, wanted.shape, finite)
        given = copy.deepcopy(arguments)
        try:
            with _quietly():
                value = function(*given)
        except NotImplementedError:
            raise Trouble(f"not written yet. Write it, and you see {wanted.sees}") from None
        except Exception as error:
            raise Trouble(_where(error, function)) from None
        names = wanted.signature.split(", ")
        for argument, before, after in zip(names, arguments, given, strict=False):
            if not _equal(before, after):
                self._changed = f"; it changes its argument {argument} (here it gets copies)"
        return _read(value, wanted.shape, finite)

    def look(self, show: Callable[[str], str], scene: Scene, hurry: bool) -> bool:
        """Draw what every function says: show(name) draws and gives its words. Whether one has to wait.

        hurry : more values follow at once, so that a slow function is left out now and then.
        """
        waits = False
        for name in self.functions:
            cost, ended = self._took.get(name, (0.0, 0.0))
            if hurry and cost > SLOW and time.monotonic() - ended < 4 * cost:
                scene.remove(f"{ROOT}/{name}")
                self.said[name] = "slow, more than 50 ms: shown when the slider rests"
                waits = True
                continue
            begun, self._changed = time.monotonic(), ""
            try:
                with np.errstate(all="ignore"):
                    said = show(name)
            except Trouble as trouble:
                scene.remove(f"{ROOT}/{name}")
                said = str(trouble)
            except (ValueError, ArithmeticError, np.linalg.LinAlgError):
                scene.remove(f"{ROOT}/{name}")
                said = "what it returns cannot be drawn"
            self._took[name] = time.monotonic() - begun, time.monotonic()
            late = "; slow: more than 50 ms" if self._took[name][0] > SLOW else ""
            self.said[name] = said + self._changed + late
        return waits

    def words(self) -> list[str]:
        """One line for each function."""
        return [f"yours, {name}: {said}" for name, said in self.said.items()]


def _named(given: Any, opener: str) -> dict[str, Any]:
    """Name of the exercise -> function."""
    wanted = WANTED.get(opener, {})
    if given is None:
        return {}
    if isinstance(given, Mapping):
        named = dict(given)
    else:
        several = list(given) if isinstance(given, list | tuple) else [given]
        named = {getattr(function, "__name__", "?"): function for function in several}
    for name, function in named.items():
        if name in wanted and not wanted[name].signature:
            continue
        if not callable(function):
            kind = type(function).__name__
            raise TypeError(f"mine takes functions, not what they return; {name!r} is of type {kind}")
        if name not in wanted:
            elsewhere = [other for other, names in WANTED.items() if name in names]
            where = f"; view.{elsewhere[0]} shows that one" if elsewhere else ""
            raise ValueError(
                f"view.{opener} shows no function {name!r}{where}. It shows: {', '.join(wanted)}."
                f' One of another name is given as mine={{"{next(iter(wanted), "")}": function}}'
            )
    return named


@contextlib.contextmanager
def _quietly():
    """What a function prints at every step of a slider helps nobody, nor do numpy's warnings."""
    with (
        contextlib.redirect_stdout(io.StringIO()),
        warnings.catch_warnings(),
        np.errstate(all="ignore"),
    ):
        warnings.simplefilter("ignore")
        yield


def _where(error: Exception, function: Any) -> str:
    """What was raised, and in which line of which function of the student's file or notebook."""
    said = f"{type(error).__name__}: {str(error).partition(chr(10))[0]}"
    home = getattr(getattr(function, "__code__", None), "co_filename", None)
    frames = [(f, line) for f, line in traceback.walk_tb(error.__traceback__)]
    ours = [(f.f_code, line) for f, line in frames if _same_place(f.f_code.co_filename, home)]
    if not ours:
        return said
    code, line = ours[-1]
    return f"line {line - code.co_firstlineno + 1} of {code.co_name} raises {said}"


def _same_place(filename: str, home: str | None) -> bool:
    """Whether code stands where the function stands; cells of a notebook are files of one folder."""
    return home is not None and (
        filename == home or ("ipykernel" in home and filename.rpartition("/")[0] == home.rpartition("/")[0])
    )


def _equal(before: Any, after: Any) -> bool:
    if isinstance(before, np.ndarray):
        return np.array_equal(before, after, equal_nan=before.dtype.kind == "f")
    return callable(before) or before == after


def _read(value: Any, shape: tuple, finite: bool) -> Any:
    """The value as float arrays of the shape that is wanted."""
    if value is None:
        raise Trouble("it returns None: is there a `return` at its end?")
    if shape and isinstance(shape[0], tuple):
        if not isinstance(value, list | tuple) or len(value) != len(shape):
            raise Trouble(f"it should return {len(shape)} things, as a tuple")
        return tuple(_read(one, its, finite) for one, its in zip(value, shape, strict=True))
    no_array = Trouble(f"it returns no array of real numbers ({type(value).__name__})")
    if not isinstance(value, list | tuple | int | float) and not hasattr(value, "__array__"):
        raise no_array  # whatever else can be indexed numpy would read to its end, which some have not
    try:
        array = np.array(value)
    except Exception:  # ragged lists, objects that refuse
        raise no_array from None
    if array.dtype.kind not in "biuf":
        raise no_array
    array = array.astype(float)
    if array.ndim != len(shape) or any(b not in (None, a) for a, b in zip(array.shape, shape, strict=True)):
        wanted = str(shape).replace("None", "any number")
        raise Trouble(f"it returns shape {array.shape}, expected {wanted}")
    if finite and not np.isfinite(array).all():
        raise Trouble("it returns numbers that are not finite (NaN or infinity)")
    return array


# ---- how far apart


def apart(T: np.ndarray, right: np.ndarray) -> tuple[float, float]:
    """Distance in metres and angle in radians between two poses (4, 4); the angle is NaN if T is no pose."""
    R = right[:3, :3].T @ T[:3, :3]
    is_pose = np.allclose(R @ R.T, np.eye(3), atol=1e-6) and np.linalg.det(R) > 0
    is_pose &= np.allclose(T[3], [0, 0, 0, 1], atol=1e-6)
    angle = float(np.linalg.norm(lie.log3(R))) if is_pose else np.nan
    return float(np.linalg.norm(T[:3, 3] - right[:3, 3])), angle


def gap(distance: float, angle: float = 0.0) -> str:
    """A gap in words: "12.3 mm and 4.5 deg", "below 1e-9".

    >>> gap(0.0123, 0), gap(0, 1e-12), gap(0, np.nan)
    ('12.3 mm', 'below 1e-9', 'no pose: the columns of R or the last row are not those of one')
    """
    if np.isnan(angle):
        return "no pose: the columns of R or the last row are not those of one"
    parts = [(1000 * distance, "mm")] if distance > ZERO else []
    parts += [(float(np.degrees(angle)), "deg")] if angle > ZERO else []
    return " and ".join(f"{size(x)} {unit}" for x, unit in parts) or "below 1e-9"


def size(x: float) -> str:
    """A gap's number: one decimal, or its power of ten where that would be 0.0."""
    return text.number(x, 1) if abs(x) >= 0.05 else text.scientific(x)


def chain(mine: np.ndarray, right: np.ndarray) -> tuple[int | None, str]:
    """Which of the frames (n, 4, 4), the tool's last, is the first that is off, and the words for it."""
    apart_by = [apart(T, correct) for T, correct in zip(mine, right, strict=True)]
    off = [k for k, (distance, angle) in enumerate(apart_by) if not max(distance, angle) <= ZERO]
    if not off:
        return None, "every frame and the tool agree with the arm's, below 1e-9"
    first, n = off[0], len(mine)
    if first == n - 1:
        return first, f"all frames before the tool are right; the tool is off by {_off(*apart_by[-1])}"
    told = f"frame {first + 1} is the first that is off, by {_off(*apart_by[first])}"
    return first, f"{told}; the tool is off by {_off(*apart_by[-1])}" if n - 1 in off else told


def _off(distance, angle):
    return f"{gap(distance, angle)} and {gap(distance)}" if np.isnan(angle) else gap(distance, angle)


# ---- drawing


class Sketch:
    """What is drawn of one function, at a path of its own."""

    def __init__(self, scene: Scene, name: str, label: str = "yours") -> None:
        self.scene, self.path, self.label = scene, f"{ROOT}/{name}", label

    def near(self, point: np.ndarray) -> bool:
        """Whether a point (3,) is near enough to be drawn."""
        return bool(np.abs(point).max(initial=0.0) < FAR * self.scene.size)

    def arm(self, robot: Robot, links: np.ndarray) -> None:
        """A translucent arm whose links stand at these displacements (n, 4, 4)."""
        name = f"{self.path.removeprefix('/ck/')}/arm"
        ghost = self.scene.robots.get(name)
        if ghost is None or ghost.robot is not robot:
            ghost = self.scene.robot(robot, np.zeros(robot.n), name, "ghost")
            ghost.color = COLOR
        ghost.links = links

    def frame(self, key: str, T: np.ndarray, label: str | None = None) -> None:
        """A frame at T (4, 4), all its axes in the student's colour."""
        long = 0.1 * self.scene.size
        path = f"{self.path}/{key}"
        if path not in self.scene.parts:
            self.scene.normals(path, np.zeros((3, 3)), long * np.eye(3), COLOR)
        self.scene.point(f"{path}/name", np.zeros(3), self.label if label is None else label, COLOR)
        self.scene[path].move(T)

    def gap(self, key: str, a: np.ndarray, b: np.ndarray) -> None:
        """A line from the right point to the student's, with its length."""
        long = float(np.linalg.norm(b - a))
        label = f"{size(1000 * long)} mm" if long > ZERO else ""
        self.scene.line(f"{self.path}/{key}", a, b, COLOR, label)

    def poses(self, robot: Robot, mine: np.ndarray, right: np.ndarray, at_zero: np.ndarray) -> str:
        """The arm by the student's frames (n, 4, 4), the tool's last, beside the right ones; the words."""
        first, words = chain(mine, right)
        are_poses = not np.isnan([apart(*pair)[1] for pair in zip(mine, right, strict=True)]).any()
        near = all(self.near(T[:3, 3]) for T in mine)
        if not (are_poses and near):
            self.scene.remove(self.path)
            return words if near else f"{words}; too far away to be drawn (metres?)"
        self.arm(robot, mine @ lie.inverse(at_zero))
        self.frame("tool", mine[-1], f"{self.label} \N{CHECK MARK}" if first is None else None)
        self.gap("gap", right[-1][:3, 3], mine[-1][:3, 3])
        if first is None or first == len(mine) - 1:
            self.scene.remove(f"{self.path}/first")
            self.scene.remove(f"{self.path}/first_gap")
        else:
            self.frame("first", mine[first], f"{self.label} {first + 1}")
            self.gap("first_gap", right[first][:3, 3], mine[first][:3, 3])
        return words
