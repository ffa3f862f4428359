"""What a part of a formula means in the picture: drawn there, and hidden until a reader points at the part.

A word is a name that formula and picture share: "theta3", "S2", "standard4". `mean` gives a drawing its
words; the page alone shows it while a reader points at one (static/point.js), so no kernel need answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import traitlets
from numpy.typing import ArrayLike

from coursekit.kinematics import dh, lie
from coursekit.view import text
from coursekit.view.controls import Control
from coursekit.view.drawing import Arm, Drawing
from coursekit.view.scene import Scene

# A part of a formula: text, or (text, word, what it says now). "^" raises what follows it.
Piece = str | tuple[str, str, str]
Lines = list[list[Piece]]

COLOR = "accent"
_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


class Formula(Control):
    """Lines of a formula; its parts are pointed at by mouse, Tab or tap. `fill(values)` gives the lines."""

    kind = traitlets.Unicode("formula").tag(sync=True)
    value: traitlets.List = traitlets.List().tag(sync=True)  # lines of [text, word]
    says = traitlets.Dict().tag(sync=True)  # word -> what it means now

    def __init__(self, fill: Callable[[dict], Lines]) -> None:
        self.fill = fill
        super().__init__("formula")

    def refresh(self, values: dict) -> None:
        lines = self.fill(values)
        parts = [(piece, "", "") if isinstance(piece, str) else piece for line in lines for piece in line]
        with self.hold_sync():
            self.value = [
                [[piece, ""] if isinstance(piece, str) else list(piece[:2]) for piece in line]
                for line in lines
            ]
            self.says = {word: says for _, word, says in parts if word}

    def __repr__(self) -> str:
        return f"Formula({len(self.says)} parts)"


def numbered(letter: str, k: int) -> str:
    """A letter with its number set low.

    >>> numbered("S", 12)
    'S₁₂'
    """
    return letter + str(k).translate(_BELOW)


def series(letter: str, says: Iterable[str], word: str = "") -> list[Piece]:
    """A part for each of `says`: the letter numbered, the word (else the letter) numbered, and what it says.

    >>> series("v", ["the first"], "theta")
    [('v₁', 'theta1', 'the first')]
    """
    return [(numbered(letter, k), f"{word or letter}{k}", said) for k, said in enumerate(says, 1)]


# --- words of a scene ---


def mean(drawing: Drawing, *words: str, hidden: bool = True) -> Drawing:
    """Let a drawing show what these words mean; `hidden` as long as nobody points at one."""
    drawing.scene.pointers[drawing.path] = tuple(word for word in words if word)
    drawing.show(not hidden)
    return drawing


def words(scene: Scene) -> dict[str, list[str]]:
    """Word -> the paths that show what it means."""
    found: dict[str, list[str]] = {}
    for path, named in scene.pointers.items():
        for word in named:
            found.setdefault(word, []).append(path)
    return found


def labels(scene: Scene) -> list[dict]:
    """Labels of what is hidden until somebody points at it."""
    hidden = [path for path in scene.pointers if not scene.visible(path)]
    return [{"path": path, **label} for path in hidden for label in scene.lettering.get(path, ())]


# --- what many explorers point at ---


def axes(scene: Scene, arm: Arm, *more: Callable[[int], str]) -> None:
    """The axis of each joint k, at its link: theta1, theta2, ..., and what `more` call them."""
    for k, drawing in enumerate(arm.axes("theta", "axis ", color=COLOR, radius=0.009 * scene.size), 1):
        mean(drawing, f"theta{k}", *(name(k) for name in more))


def rows(scene: Scene, arm: Arm, name: str, table: dh.Table, poses: ArrayLike) -> None:
    """The rows of a DH table, each with a and d as lines and alpha as an arc: standard1, standard2, ...

    poses: (n + 1, 4, 4), the frames at zero, the base first. Row k lies on the link that keeps its a and
    alpha: k in the standard convention, k - 1 in the modified one.
    """
    frames, first = np.asarray(poses), name == "modified"  # there a and alpha come before d
    for k in range(1, table.n + 1):
        before, after = frames[k - 1], frames[k]
        path = f"{arm.link(k - 1 if first else k)}/{name}{k}"
        a, alpha, d = table.a[k - 1], table.alpha[k - 1], table.d[k - 1]
        x, z = (before[:3, 0], after[:3, 2]) if first else (after[:3, 0], before[:3, 2])
        start, corner = before[:3, 3], before[:3, 3] + (a * x if first else d * z)
        drawn = [
            scene.arrow(f"{path}_a", start if first else corner, a * x, COLOR, f"a {text.millimetres(a)}")
        ]
        if table.joint_types[k - 1] == "revolute":  # of a slide, d is what moves
            foot = corner if first else start
            drawn.append(scene.arrow(f"{path}_d", foot, d * z, "trace", f"d {text.millimetres(d)}"))
        if abs(alpha) > 1e-9:
            turns = lie.exp3(np.linspace(0, alpha, 25)[:, None] * x) @ before[:3, 2]
            arc = (corner if first else after[:3, 3]) + 0.07 * scene.size * turns
            drawn.append(scene.curve(f"{path}_alpha", arc, COLOR, 0.005 * scene.size))
            drawn.append(scene.point(f"{path}_turn", arc[12], f"alpha {text.degrees(alpha)}", COLOR))
        for drawing in drawn:
            mean(drawing, f"{name}{k}")


def row_says(table: dh.Table, k: int, q: float, name: str) -> str:
    """Row k of a DH table at the joint value q, in words."""
    slides = table.joint_types[k - 1] == "prismatic"
    d, theta = table.d[k - 1] + (q if slides else 0), table.theta[k - 1] + (0 if slides else q)
    lengths = f"a = {text.millimetres(table.a[k - 1])}, d = {text.millimetres(d)}"
    turns = f"alpha = {text.degrees(table.alpha[k - 1])}, theta = {text.degrees(theta)}"
    return f"row {k} of the {name} table, from frame {k - 1} to frame {k}: {lengths}, {turns}"
