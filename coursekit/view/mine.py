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

from ..kinematics.robot import Robot
from .scene import Scene
from .sketch import ROOT, Trouble

SLOW = 0.05  # seconds
MEMORY = 100  # calls
Given = Callable | list | dict | None  # what is given as `mine`


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
_GHOSTS = "your solutions as translucent arms, and how far each misses the target"
_STAND = "the arm at your angle, how far its wrist is from where it should be, and a button that drives there"
_COLUMN = "the velocity of the tool by your first column that is off, beside the right one"
_WAY = "the way of the tool by your steps, and a button that plays it"
_ATTITUDE = "the attitude that you get back from your numbers, beside that of the path"

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
    "explore_inverse": {
        "wrist_centre": Wanted("T_sd, tool", (3,), "your wrist centre beside the right one"),
        "elbow_solutions": Wanted("r, z, lengths", (2, 2), _GHOSTS),
        "wrist_angles": Wanted("R", (2, 3), _GHOSTS),
        "all_solutions": Wanted("T_sd, lengths, tool", (8, 6), _GHOSTS),
        "newton_step": Wanted("J_b, T_sb, T_sd", (None,), "the way of the tool by your steps from the guess"),
    },
    "explore_singularities": {
        "det_from_blocks": Wanted("J", (), "your det J beside the right one"),
        "elbow_angle": Wanted("a3, d4", (), _STAND),
        "shoulder_theta3": Wanted("theta2, lengths", (), _STAND),
        "rank": Wanted("J, tol", (), "your rank beside the right one, as the arm moves"),
        "lost_motion": Wanted(
            "J", (6,), "your lost motion as arrows, and how much of it the joints can give"
        ),
    },
    "explore_jacobians": {
        "jacobian_space": Wanted("S, theta", (6, None), _COLUMN),
        "jacobian_geometric": Wanted("axes, origins, tool", (6, None), _COLUMN),
        "jacobian_by_differences": Wanted("fk, theta, step", (6, None), _COLUMN),
        "ellipsoid": Wanted("J", ((3,), (3, 3)), "your ellipsoids over the right ones"),
        "jacobian_column": Wanted("kind, w, q, T", (6,), _COLUMN),
        "transform_rate": Wanted("T_left, S, theta, T_right", ((4, 4), (6,)), _COLUMN),
        "torques": Wanted("J_b, T, moment, force", (None,), "a load at the tool, and your joint torques"),
        "dls_step": Wanted("J, e, k", (None,), _WAY),
        "dls_loop": Wanted("robot, T_sd, theta, k, steps", (None, None), _WAY),
    },
    "explore_path": {
        "tool_frames": Wanted("points, centre", (None, 4, 4), "your frames along the path"),
        "quaternion": Wanted("R", (4,), _ATTITUDE),
        "zyx": Wanted("R", (3,), _ATTITUDE),
        "angle_axis": Wanted("R", (3,), _ATTITUDE),
        "slerp": Wanted("R_0, R_1, t", (3, 3), "your attitude between those of the path's two ends"),
        "next_on_branch": Wanted("last, solutions", (None,), "where your way leaves the branch"),
        "inside": Wanted("theta, lower, upper", (None,), "where your function judges the path differently"),
        "largest_speed": Wanted(
            "q, points, v_max", (), "the motion at your speed, and the joint that breaks its bound"
        ),
    },
    "explore_screws": {
        "screw_axis": Wanted("w, q", (6,), _AXES),
        "home_pose": Wanted("lengths", (4, 4), "your tool frame beside the arm's"),
        "axis_of": Wanted("S", ((3,), (3,), ()), _AXES),
        "body_screws": Wanted("S, M", (6, None), _AXES),
        "S": Wanted("", (6, None), _AXES),  # read off a drawing
    },
}


class Mine:
    """The student's functions of one explorer, and what the text says of each.

    given : a function, a list of functions, or a dict name of the exercise -> function.

    ValueError for a name that the explorer does not show, TypeError for what is no function.
    """

    def __init__(self, given: Any, opener: str) -> None:
        self.wanted = WANTED[opener]
        self.functions = _named(given, opener)
        self.said: dict[str, str] = {}
        self._took: dict[str, tuple[float, float]] = {}  # name -> seconds of the last look, when it ended
        self._slow: set[str] = set()
        self._changed, self._seconds = "", 0.0  # during a look
        self._known: dict[tuple, tuple] = {}  # the last calls: what came of them need not be asked again

    def ask(self, name: str, *arguments: Any) -> Any:
        """What the function returns for copies of these arguments: an array, or a tuple of them.

        Raises Trouble where that is no answer of the exercise's shape.
        """
        if not self.wanted[name].signature:
            return _read(self.functions[name], self.wanted[name].shape)
        key = name, *map(_key, arguments)
        if key not in self._known:
            if len(self._known) >= MEMORY:
                self._known.clear()
            try:
                self._known[key] = *self._call(name, arguments), None
            except Trouble as told:
                self._known[key] = None, "", told
        value, changed, trouble = self._known[key]
        self._changed = changed or self._changed
        if trouble is not None:
            raise trouble
        return copy.deepcopy(value)

    def _call(self, name, arguments):
        """The answer, and what is to be said of changed arguments."""
        wanted, function = self.wanted[name], self.functions[name]
        given, changed, begun = copy.deepcopy(arguments), "", time.monotonic()
        try:
            with _quietly():
                value = function(*given)
        except NotImplementedError:
            raise Trouble(f"not written yet. Write it, and you see {wanted.sees}") from None
        except (Exception, SystemExit) as error:
            raise Trouble(_where(error, function)) from None
        finally:
            self._seconds += time.monotonic() - begun
        names = wanted.signature.split(", ")
        for argument, before, after in zip(names, arguments, given, strict=False):
            if not _equal(before, after):
                changed = f"; it changes its argument {argument} (here it gets copies)"
        return _read(value, wanted.shape), changed

    def look(self, show: Callable[[str], str], scene: Scene, hurry: bool) -> bool:
        """Draw what every function says: show(name) draws and gives its words. Whether one has to wait.

        hurry : more values follow at once, so that a slow function is left out now and then.
        """
        waits = False
        for name in self.functions:
            cost, ended = self._took.get(name, (0.0, 0.0))
            if hurry and cost > SLOW and time.monotonic() - ended < 4 * cost:
                scene.remove(f"{ROOT}/{name}")
                self.said[name] = "shown when the slider rests"
                waits = True
                continue
            self._changed, self._seconds = "", 0.0
            try:
                with np.errstate(all="ignore"):
                    said = show(name)
            except (Trouble, ValueError, ArithmeticError) as error:
                scene.remove(f"{ROOT}/{name}")
                said = str(error) if isinstance(error, Trouble) else "what it returns cannot be drawn"
            self.said[name] = said + self._changed
            if self._seconds:  # it was called; what is known costs nothing
                self._took[name] = self._seconds, time.monotonic()
                (self._slow.add if self._seconds > SLOW else self._slow.discard)(name)
        return waits

    def words(self, timed: bool = True) -> list[str]:
        """One line for each function; not `timed`: the same on every machine."""
        late = self._slow if timed else ()
        note = "; slow: more than 50 ms, so it is called less often while a slider moves"
        return [f"yours, {name}: {said}{note if name in late else ''}" for name, said in self.said.items()]


def _named(given: Any, opener: str) -> dict[str, Any]:
    """Name of the exercise -> function."""
    wanted = WANTED[opener]
    if given is None:
        return {}
    several = given if isinstance(given, list | tuple) else [given]
    named = dict(given) if isinstance(given, Mapping) else {getattr(f, "__name__", "?"): f for f in several}
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
                f' One of another name is given as mine={{"{next(iter(wanted))}": function}}'
            )
    return named


@contextlib.contextmanager
def _quietly():
    """What a function prints at every step of a slider helps nobody, nor do numpy's warnings."""
    with contextlib.redirect_stdout(io.StringIO()), np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def _where(error: BaseException, function: Any) -> str:
    """What was raised, and in which line of which function of the student's file or notebook."""
    said = f"{type(error).__name__}: {str(error).partition(chr(10))[0]}"
    home = getattr(getattr(function, "__code__", None), "co_filename", None)
    walked = traceback.walk_tb(error.__traceback__)
    ours = [(f.f_code, line) for f, line in walked if _same_place(f.f_code.co_filename, home)]
    if not ours:
        return said
    code, line = ours[-1]
    return f"line {line - code.co_firstlineno + 1} of {code.co_name} raises {said}"


def _same_place(filename: str, home: str | None) -> bool:
    """Whether code stands where the function stands; cells of a notebook are files of one folder."""
    return home is not None and (
        filename == home or ("ipykernel" in home and filename.rpartition("/")[0] == home.rpartition("/")[0])
    )


def _key(argument: Any) -> Any:
    """What tells one argument from another."""
    if isinstance(argument, np.ndarray):
        return argument.shape, argument.dtype.str, argument.tobytes()
    return repr(argument)


def _equal(before: Any, after: Any) -> bool:
    if isinstance(before, np.ndarray):
        return np.array_equal(before, after, equal_nan=before.dtype.kind == "f")
    return callable(before) or isinstance(before, Robot) or before == after


def _read(value: Any, shape: tuple) -> Any:
    """The value as float arrays of the shape that is wanted."""
    if value is None:
        raise Trouble("it returns None: is there a `return` at its end?")
    if shape and isinstance(shape[0], tuple):
        if not isinstance(value, list | tuple) or len(value) != len(shape):
            raise Trouble(f"it should return {len(shape)} things, as a tuple")
        return tuple(_read(one, its) for one, its in zip(value, shape, strict=True))
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
    if not np.isfinite(array).all():
        raise Trouble("it returns numbers that are not finite (NaN or infinity)")
    return array
