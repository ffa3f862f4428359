"""Controls and read-outs of an explorer: slider, choice, toggle, action, table, text line.

A control has a `name`, the key of its value in the dictionary an explorer's functions get. Sliders show
degrees and millimetres and give radians and metres (`.si`): the inside of coursekit knows nothing else.

A control sends its value only when a person changes it. (A stock FloatSlider also sends a rounded copy of
its value back when it is first drawn: 0.4 becomes 0.39999..., and in "Run All" that arrives late, over what a
later cell set.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, cast

import numpy as np
import traitlets
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot
from coursekit.view.chain import SHOWN_PER_SI, ends_of, hinges
from coursekit.view.script import Widget


class Control(Widget):
    """What all controls share: a name, a label and a stable one-line repr."""

    label = traitlets.Unicode().tag(sync=True)
    word = traitlets.Unicode().tag(sync=True)  # by which the picture knows what it means, see pointing.py
    touched = traitlets.Int(0).tag(sync=True)  # counts changes by a person
    value: Any
    initial: Any  # what `reset` puts

    def __init__(self, name: str, label: str | None = None, **traits: Any) -> None:
        self.name = name
        super().__init__(label=name if label is None else label, word=name, **traits)

    def get(self) -> Any:
        """The value as an explorer's functions see it."""
        return self.value

    def put(self, value: Any) -> None:
        """Set what `get` gives."""
        self.value = value

    def reset(self) -> None:
        self.put(self.initial)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name}: {self.value})"


class Slider(Control):
    """A slider with name, unit, marked limits and a box to type a number into.

    Parameters
    ----------
    name : str
    start, low, high : float
        First value and ends of the slider, in SI units (radians for unit "deg", metres for "mm").
    unit : str
        Shown unit: "deg" and "mm" convert, any other is only a label.
    step : float, optional
        Step of the arrow keys and of dragging, in the shown unit; Shift takes a tenth of it. Typing is free.
    limits : (low, high), optional
        Limits to mark inside the slider, in SI units; a value outside them is marked as such.

    >>> elbow = Slider("elbow", start=0.5, low=-1, high=1, unit="deg")
    >>> round(elbow.value, 3), elbow.si
    (28.648, 0.5)
    """

    kind = traitlets.Unicode("slider").tag(sync=True)
    value = traitlets.Float().tag(sync=True)
    live = traitlets.Bool(False).tag(sync=True)  # still being dragged: more values will come
    min = traitlets.Float().tag(sync=True)
    max = traitlets.Float().tag(sync=True)
    step = traitlets.Float().tag(sync=True)
    start = traitlets.Float().tag(sync=True)
    limits: traitlets.List = traitlets.List().tag(sync=True)
    unit = traitlets.Unicode().tag(sync=True)
    digits = traitlets.Int().tag(sync=True)
    shape = traitlets.Int(0).tag(sync=True)  # counts changes of everything but the value
    wide = traitlets.Int(0).tag(sync=True)  # letters for which the label leaves room
    bands: traitlets.List = traitlets.List().tag(sync=True)  # reachable runs [low, high]; those inside limits
    _beyond = False  # whether a value outside min and max is taken as it is

    def __init__(
        self,
        name: str,
        start: float = 0.0,
        low: float = -1.0,
        high: float = 1.0,
        unit: str = "",
        step: float | None = None,
        limits: tuple[float, float] | None = None,
        label: str | None = None,
    ) -> None:
        self.shown_per_si, self._exact = 1.0, (0.0, 0.0)
        super().__init__(name, label)
        self.fit(start, low, high, unit, step, limits)

    def fit(
        self,
        start: float,
        low: float,
        high: float,
        unit: str = "",
        step: float | None = None,
        limits: tuple[float, float] | None = None,
    ) -> None:
        """Give the slider another range and put it at its start.

        Parameters
        ----------
        start, low, high, unit, step, limits : as in the constructor
        """
        if not low < high:
            raise ValueError(f"slider {self.name!r}: low must be below high, got {low} and {high}")
        self.shown_per_si = SHOWN_PER_SI.get(unit, 1.0)  # every other unit is shown as it is
        low, high = min(low, start), max(high, start)
        step = step or {"deg": 1.0, "mm": 10.0}.get(unit, (high - low) / 100)
        with self.hold_sync():
            self.min, self.max = -np.inf, np.inf  # so that the old range does not clip the new value
            self.value = self.start = self._shown(start)
            self.min, self.max = self._shown(low), self._shown(high)
            self.step, self.unit = float(step), unit
            self.limits = [self._shown(x) for x in limits] if limits is not None else []
            self.digits = max(2, int(np.ceil(1 - np.log10(step))))
            self.shape += 1
        self.initial = float(start)
        self._exact = (self.value, float(start))

    @property
    def si(self) -> float:
        """The value in SI units; exactly what was `put`, as long as nobody moved the slider since."""
        shown, si = self._exact
        return si if self.value == shown else self.value / self.shown_per_si

    def get(self) -> float:
        return self.si

    def put(self, value: float) -> None:
        value = float(value)
        shown = self._shown(value)
        if not self.min - 1e-9 <= shown <= self.max + 1e-9:
            ends = f"[{self.min:g}, {self.max:g}] {self.unit}".rstrip()
            raise ValueError(f"slider {self.name!r} goes over {ends}, got {shown:g}")
        self.value = shown
        self._exact = (self.value, value)

    def show(self, value: float) -> None:
        """Put a value that may lie beyond the ends, where a motion leads there: it is marked as outside."""
        self._beyond = True
        try:
            self.value = self._shown(float(value))
        finally:
            self._beyond = False
        self._exact = (self.value, float(value))

    def start_at(self, value: float) -> None:
        """Show this value, and come back to it after `reset`."""
        self.initial = float(value)
        self.reset()

    def reset(self) -> None:
        self.show(self.initial)

    def _shown(self, si):
        return float(np.round(si * self.shown_per_si, 10)) + 0.0  # 170.00000000000003 degrees is 170

    @traitlets.validate("value")
    def _inside(self, proposal):
        clips = self.min < self.max and not self._beyond
        return float(np.clip(proposal["value"], self.min, self.max)) if clips else proposal["value"]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name}: {np.round(self.value, 3) + 0:g} {self.unit})"


class JointSlider(Slider):
    """The slider of one joint of a robot: its limits are the ends, degrees or millimetres its unit."""

    def __init__(self, robot: Robot, joint: int, start: float | None = None) -> None:
        Control.__init__(self, f"theta{joint + 1}", f"\N{GREEK SMALL LETTER THETA}{joint + 1}")
        self.fit_joint(robot, joint, start)

    def fit_joint(self, robot: Robot, joint: int, start: float | None = None) -> None:
        low, high = (float(end[joint]) for end in ends_of(robot))
        start = float(robot.home[joint] if start is None else start)
        self.fit(start, low, high, "deg" if hinges(robot)[joint] else "mm", limits=(low, high))


class Sliders:
    """Several sliders whose values are one vector.

    folded   the title under which they are folded away;  legend   HTML under them: what is drawn in them
    """

    folded = legend = ""
    in_picture = False  # they stand in no column: handles in the picture alone move them

    def __init__(self, name: str, sliders: Iterable[Slider]) -> None:
        self.name = name
        self.sliders: Sequence[Slider] = list(sliders)
        self.count = len(self.sliders)  # those in use

    @property
    def used(self) -> Sequence[Slider]:
        return self.sliders[: self.count]

    def get(self) -> np.ndarray:
        return np.array([slider.get() for slider in self.used])

    def put(self, values: ArrayLike) -> None:
        values = np.asarray(values, float)
        if values.shape != (self.count,):
            raise ValueError(f"{self.name!r} takes {self.count} numbers, got shape {values.shape}")
        for slider, value in zip(self.used, values, strict=True):
            slider.put(value)

    def reset(self) -> None:
        for slider in self.used:
            slider.reset()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name}: {self.count})"


class JointSliders(Sliders):
    """One slider per joint; the value is theta (n,), in radians and metres."""

    sliders: Sequence[JointSlider]

    def show(self, theta: ArrayLike) -> None:
        """Put theta (n,), also where a motion leads beyond the limits."""
        for slider, value in zip(self.used, np.asarray(theta, float), strict=True):
            slider.show(value)

    def start_at(self, theta: ArrayLike) -> None:
        """Show theta (n,), and come back to it after `reset`."""
        for slider, value in zip(self.used, np.asarray(theta, float), strict=True):
            slider.start_at(value)

    def fit(self, robot: Robot) -> None:
        """Serve another robot, from its home pose. At most as many joints as sliders were made."""
        if robot.n > len(self.sliders):
            raise ValueError(f"{self.name!r} has {len(self.sliders)} sliders, {robot.name} needs {robot.n}")
        self.count = robot.n
        for i, slider in enumerate(self.sliders):
            slider.layout.display = None if i < robot.n else "none"
            if i < robot.n:
                slider.fit_joint(robot, i)


def joint_sliders(
    robot: Robot, start: Sequence[float] | np.ndarray | None = None, name: str = "theta"
) -> JointSliders:
    """One slider per joint of a robot; the value is theta (n,), in radians and metres.

    Parameters
    ----------
    robot : Robot
    start : (n,), rad or m; None: the robot's home
    name : what `panel.set` and `panel.values` call them
    """
    start = robot.home if start is None else start
    return JointSliders(name, [JointSlider(robot, i, start[i]) for i in range(robot.n)])


class Choice(Control):
    """A list to choose from.

    Parameters
    ----------
    options : list of str, or mapping of label -> object
        With a mapping the value is the object behind the chosen label.
    start : str, optional
        The label chosen first (default: the first).
    """

    kind = traitlets.Unicode("choice").tag(sync=True)
    value = traitlets.Unicode().tag(sync=True)
    wide = traitlets.Int(0).tag(sync=True)  # as of a Slider
    options: traitlets.List = traitlets.List().tag(sync=True)

    def __init__(
        self,
        name: str,
        options: Iterable[str] | Mapping[str, Any],
        start: str | None = None,
        label: str | None = None,
    ) -> None:
        named = isinstance(options, Mapping)
        self.meaning = cast("Mapping[str, Any]", options if named else {text: text for text in options})
        labels = list(self.meaning)
        self.initial = labels[0] if start is None else start
        if self.initial not in self.meaning:
            raise ValueError(f"choice {name!r} has no {start!r}; it has: {', '.join(labels)}")
        super().__init__(name, label, options=labels, value=self.initial)

    def get(self) -> Any:
        return self.meaning[self.value]

    def put(self, value: Any) -> None:
        """Choose a label, or what stands behind one."""
        if not isinstance(value, str) or value not in self.meaning:
            same = (label for label, meaning in self.meaning.items() if np.array_equal(meaning, value))
            behind = next(same, None)
            if behind is None:
                raise ValueError(f"choice {self.name!r} has no {value!r}; it has: {', '.join(self.meaning)}")
            value = behind
        self.value = value

    def reset(self) -> None:
        pass  # what was chosen stays chosen: reset moves the arm back, it does not change the arm


class Toggle(Control):
    """A box to tick; the value is a bool."""

    kind = traitlets.Unicode("toggle").tag(sync=True)
    value = traitlets.Bool().tag(sync=True)

    def __init__(self, name: str, label: str | None = None, start: bool = False) -> None:
        self.initial = bool(start)
        super().__init__(name, label, value=self.initial)


class Action(Control):
    """A button; `act()` is called under the panel's lock, then the panel is drawn again."""

    kind = traitlets.Unicode("action").tag(sync=True)

    def __init__(self, name: str, label: str | None = None, act: Callable[[], None] | None = None) -> None:
        self.act = act
        super().__init__(name, label)

    def get(self) -> None:
        return None

    def put(self, value: Any) -> None:
        raise ValueError(f"action {self.name!r} holds no value")

    def reset(self) -> None:
        pass

    def offer(self, there: bool) -> None:
        """Show the button only where it has something to do."""
        self.layout.display = None if there else "none"

    def __repr__(self) -> str:
        return f"Action({self.name})"


class TextLine(Control):
    """The numbers beside the picture, in words; read aloud when they come to rest."""

    kind = traitlets.Unicode("text").tag(sync=True)
    value = traitlets.Unicode().tag(sync=True)

    def __repr__(self) -> str:
        return f"TextLine({self.value.splitlines()[0] if self.value else ''})"
