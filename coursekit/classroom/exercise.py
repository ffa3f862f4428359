"""The public half of an exercise: how its inputs are drawn and what a right answer is made of.

An `Exercise` ships to students. It holds no solution: that stands in the solved notebook alone, functions
that commit its typical mistakes in `mistakes/`, which students do not get.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from coursekit.kinematics.robot import Robot

KINDS = ("close", "angle", "rotation", "up_to_sign", "columns_up_to_sign", "turn", "set", "any_solution")
USUAL = "for ordinary numbers"
NONE = "it returns None"


@dataclass(frozen=True)
class Hint:
    """A typical mistake: `key` names its wrong function in `mistakes/`, `text` is what the student reads."""

    key: str
    text: str


@dataclass(frozen=True)
class Edge:
    """A case that every set of examples contains, public or hidden.

    text  : completes "right ..." and "wrong ...": "for a slide", "where R[0, 0] is negative".
    draw  : draw(rng) -> tuple of arguments.
    count : how many of them a set contains.
    tol   : in place of the exercise's, where right answers of several kinds differ by more; a number or an
            array that broadcasts to the shape of the answer.
    """

    text: str
    draw: Callable[[np.random.Generator], tuple]
    count: int = 1
    tol: ArrayLike | None = None


@dataclass(frozen=True)
class Block:
    """A part of the answer in the exercise's words: "the rotation", entries [..., :3, :3] of result 0.

    text : reads well in "... is right, ... is not" (or "are", with plural=True).
    index: as numpy takes it; for several results, that of result `part`.
    """

    text: str
    index: Any = ...
    part: int = 0
    plural: bool = False


# The blocks of answers that look alike everywhere.
POSE = (
    Block("the rotation", np.s_[..., :3, :3]),
    Block("the position", np.s_[..., :3, 3]),
    Block("the last row", np.s_[..., 3, :]),
)
JACOBIAN = (
    Block("the upper rows (omega)", np.s_[:3], plural=True),
    Block("the lower rows (v)", np.s_[3:], plural=True),
)


@dataclass(frozen=True)
class Exercise:
    """One function the student writes.

    signature : "dh_transform(a, alpha, d, theta)"; the name is what stands before the parenthesis.
    draw      : draw(rng) -> tuple of arguments: numbers, strings, lists, arrays (lists of numbers
                reach the student as arrays), {"robot": "kuka_kr6"} for a robot, {"fk": "kuka_kr6"} its fk.
    shape     : shape of the answer, () for a number, None for a free axis: (None, 6); a function that returns
                several things has one shape for each: ((3,), (3,), ()).
    compare   : how an answer is compared (one word, or one for each returned thing):
                "close"               number by number
                "angle"               modulo 2 pi
                "rotation"            close; and it is said if R is not a rotation, or T not a pose
                "up_to_sign"          a vector whose sign is free
                "columns_up_to_sign"  a matrix, each column of free sign
                "turn"                an axis times an angle: at half a turn its sign is free
                "set"                 rows (or numbers) in any order, each once, angles modulo 2 pi
                "any_solution"        right if all laws hold (they must then not call the function)
    tol       : absolute: an entry farther than this from the right one is wrong.
    edges     : cases that every set of examples contains, beside the drawn ones, which `usual` names.
    blocks    : parts of the answer in the exercise's words, for what is right already.
    laws      : (text, law(function, args, value) -> bool): what must hold whatever the inputs.
    residual  : residual(args, value, right) -> how far a wrong answer misses, in the course's own terms: "put
                back into the arm, your angles miss the wrist centre by 83 mm"; "" if it cannot be said. value
                and right are arrays, or tuples of them.
    own       : its examples are drawn with `own_arm()`, and so differ from student to student.
    look      : look(args, value) -> what there is to see of an answer, for `picture`: a dict with any of
                frames (k, 4, 4), chains (lists of points (m, 3)), lines and arrows (pairs of point and
                direction), points (k, 3), ellipsoid (3, 3) with half axes as columns. Lengths in metres.
    """

    signature: str
    points: int
    draw: Callable[[np.random.Generator], tuple]
    shape: tuple
    hints: tuple[Hint, ...] = ()
    laws: tuple[tuple[str, Callable], ...] = ()
    compare: str | tuple[str, ...] = "close"
    tol: float = 1e-6
    unit: str = ""
    samples: int = 4  # public inputs beside the edges: what the student's check uses
    n: int = 20  # hidden inputs, edges included: what grading uses
    timeout: float = 10.0  # seconds for all n
    edges: tuple[Edge, ...] = ()
    usual: str = USUAL
    blocks: tuple[Block, ...] = ()
    residual: Callable[[list, Any, Any], str] | None = None
    look: Callable[[list, Any], dict] | None = None
    own: bool = False
    name: str = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "name", self.signature.partition("(")[0].strip())
        for kind in self.kinds:
            if kind not in KINDS:
                raise ValueError(f"exercise {self.name}: compare={kind!r}, valid are {', '.join(KINDS)}")
        if len(self.kinds) != len(self.shapes):
            raise ValueError(
                f"exercise {self.name}: {len(self.shapes)} shapes, {len(self.kinds)} ways to compare"
            )

    @property
    def several(self) -> bool:
        """The function returns several things."""
        return bool(self.shape) and isinstance(self.shape[0], tuple)

    @property
    def shapes(self) -> tuple[tuple, ...]:
        return self.shape if self.several else (self.shape,)

    @property
    def kinds(self) -> tuple[str, ...]:
        return (self.compare,) * len(self.shapes) if isinstance(self.compare, str) else self.compare

    @property
    def arguments(self) -> list[str]:
        """The names of the arguments, from the signature."""
        inside = self.signature.partition("(")[2].rpartition(")")[0]
        return [name.strip() for name in inside.split(",") if name.strip()]

    def value(self, parts: list[np.ndarray]) -> Any:
        """Parts of an answer as the function returns them: one array, or a tuple."""
        return tuple(parts) if self.several else parts[0]

    def draws(self, rng: np.random.Generator, count: int) -> list[tuple[str, list, ArrayLike]]:
        """(case, arguments as plain JSON data, tolerance): every edge, then drawn ones up to `count`."""
        rows = [
            (edge.text, edge.draw(rng), self.tol if edge.tol is None else edge.tol)
            for edge in self.edges
            for _ in range(edge.count)
        ]
        rows += [(self.usual, self.draw(rng), self.tol) for _ in range(count - len(rows))]
        return [(case, [plain(x) for x in arguments], plain(tol)) for case, arguments, tol in rows]

    @property
    def least(self) -> int:
        """How many examples the edges are."""
        return sum(edge.count for edge in self.edges)


def plain(value: Any) -> Any:
    """Numpy to JSON data; the inverse is `thaw`."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [plain(x) for x in value]
    return value


def thaw(arguments: list) -> list:
    """What the student's function receives: lists of numbers as arrays, new ones for every call."""
    return [_thaw(x) for x in arguments]


def _thaw(value):
    if isinstance(value, dict):
        ((what, name),) = value.items()
        robot = _robot(name)
        return robot if what == "robot" else (lambda theta: robot.fk(theta))
    if isinstance(value, list):
        array = np.array(value)
        return array if array.dtype.kind in "if" else value
    return value


@cache
def _robot(name: str) -> Robot:
    """Made once, as it cannot be changed: a search for a line asks for it a thousand times."""
    from coursekit import robots

    return getattr(robots, name)()


class Misfit(Exception):
    """The value can not be an answer to this exercise; the text says why."""


def answer(exercise: Exercise, value: object) -> list[np.ndarray]:
    """The returned value as float arrays, one for each returned thing; Misfit if it is none."""
    if value is None:
        raise Misfit(f"{NONE}: is there a `return` at its end?")
    if not exercise.several:
        return [_numbers(value)]
    if not isinstance(value, list | tuple) or len(value) != len(exercise.shapes):
        came = f"{len(value)} things" if isinstance(value, list | tuple) else f"one {type(value).__name__}"
        raise Misfit(f"{len(exercise.shapes)} things are expected, as a tuple; {came} came")
    return [_numbers(x) for x in value]


def _numbers(value) -> np.ndarray:
    if not isinstance(value, list | tuple | str | bool | int | float | complex) and not hasattr(
        value, "__array__"
    ):
        # whatever else can be indexed, numpy would read to its end, which some things have not (np.r_)
        made_once = ", but something that makes them one by one: return list(...) of it"
        text = made_once if isinstance(value, Iterator) else ""
        if hasattr(value, "__float__"):  # of sympy, say
            text = ": float(answer) is one"
        raise Misfit(f"the answer ({type(value).__name__}) is not a number or an array of numbers{text}")
    try:
        array = np.asarray(value)
    except Exception:  # ragged lists, objects that refuse
        things = f": it holds {len(value)} things of different shapes" if isinstance(value, tuple) else ""
        raise Misfit(f"the answer ({type(value).__name__}) is not an array of numbers{things}") from None
    if array.dtype.kind == "c":
        raise Misfit(
            "the answer is complex, real numbers are expected: a root of a negative number, or np.linalg.eig?"
        )
    if array.dtype.kind not in "biuf":
        loose = array.dtype == object and array.size and all(hasattr(x, "__float__") for x in array.flat)
        how = ": np.array(answer, float) makes them of fractions and of sympy's numbers" if loose else ""
        raise Misfit(f"the answer has dtype {array.dtype}; numbers are expected{how}")
    return array.astype(float)


def fits(part: np.ndarray, shape: tuple) -> bool:
    """Has it this shape? None is any number."""
    return part.ndim == len(shape) and all(b in (None, a) for a, b in zip(part.shape, shape, strict=True))


def misshapen(exercise: Exercise, parts: list[np.ndarray]) -> str:
    """'' or what is wrong with the shapes."""
    for number, (part, shape) in enumerate(zip(parts, exercise.shapes, strict=True), 1):
        if not fits(part, shape):
            which = f"result {number} has shape" if exercise.several else "the shape is"
            return f"{which} {part.shape}, expected {_show_shape(shape)}"
    return ""


def _show_shape(shape: tuple) -> str:
    if shape == (None,):
        return "one row of numbers, however long"
    return str(shape).replace("None", "any number")


def nearest(name: str, names: Iterable[str]) -> str:
    """' Did you mean ...?' or ''."""
    found = difflib.get_close_matches(name, names, 1)
    return f" Did you mean {found[0]!r}?" if found else ""
