"""The explorers of the six notebooks, and the idiom that they share."""

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar

import ipywidgets
import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot
from coursekit.view import mine, pointing, sketch
from coursekit.view.controls import Choice, Control, JointSliders, Slider, Sliders
from coursekit.view.panel import Panel
from coursekit.view.prediction import ROOT, Prediction
from coursekit.view.questions import Question
from coursekit.view.scene import Scene
from coursekit.view.target import HELD


class Explorer:
    """One open explorer: what it remembers from one change to the next are its attributes, and nothing else.

    A subclass draws what stays in its constructor, and answers every change of a control twice: `update`
    moves what is drawn, `words` says the numbers of the same `values`. Where it may be opened for several
    arms, `show` draws another one. What the student's function `f` says is drawn by `_f(sketch, values)`,
    after `update`, which gives the words for it. `open` makes the panel.
    """

    name: ClassVar[str]  # of the panel
    title: ClassVar[str]  # what the stored line of text calls it
    opener: ClassVar[str]  # the function of `view` that opens it
    in_space: ClassVar[bool] = True  # the space frame is drawn
    around: ClassVar[float] = HELD  # sizes of the arm that are seen round the tool at first
    computed: ClassVar[tuple[str, ...]] = ()  # paths of what only `update` can place for another theta
    prediction: Prediction  # made with the panel: an explorer that is refused leaves no widgets behind

    def __init__(self, student: Any, robot: Robot, *others: Robot) -> None:
        self.robot = robot
        self.arms = {arm.name: arm for arm in (robot, *others)}
        self.mine = mine.Mine(student, self.opener)
        self.scene = Scene()
        self.joints: JointSliders | None = None  # those of theta, where there are some
        self.panel: Panel | None = None

    @property
    def frame(self) -> int | None:
        """Which configuration of a motion is shown; None where no motion is."""
        motion = self.panel and self.panel.motion
        return motion.frame if motion else None

    def controls(self) -> Sequence[Control | Sliders]:
        """What stands beside the picture."""
        raise NotImplementedError

    def below(self) -> Sequence[ipywidgets.Widget]:
        """What stands under the picture: plots and tables."""
        return []

    def show(self, robot: Robot) -> None:
        """Draw this one of the arms in place of the other."""
        raise NotImplementedError

    def update(self, values: dict[str, Any]) -> None:
        """Make the scene show these values of the controls, in radians and metres."""
        raise NotImplementedError

    def drivers(self, values: dict[str, Any]) -> Sequence[Slider | None]:
        """The slider of each joint, where the page can move the arm by them before the kernel answers."""
        return self.joints.used if self.joints else []

    def start_at(self, theta: np.ndarray) -> None:
        """Begin, after `reset` too, at theta (n,), also outside the limits. ValueError for other shapes."""
        n = self.robot.n
        if theta.shape != (n,) or self.joints is None:
            raise ValueError(f"{self.robot.name} has {n} joints: theta must be ({n},), got {theta.shape}")
        self.joints.start_at(theta)

    def words(self, values: dict[str, Any]) -> Iterable[str]:
        """Lines: the numbers of the picture, for everyone."""
        raise NotImplementedError

    def formula(self, values: dict[str, Any]) -> pointing.Lines:
        """The formula that the picture is about: its parts show there what they mean."""
        return []

    def begin(self, number: int) -> None:
        """Put the controls where question `number` begins."""

    def question(self, values: dict[str, Any]) -> Question | str:
        """What is asked at these values; in words why nothing is."""
        raise NotImplementedError

    def secret(self) -> None:
        """Hide what would tell the answer: called after `update` as long as a question is open."""

    @property
    def number(self) -> int:
        """Of the question that is asked."""
        return self.prediction.number

    @property
    def asking(self) -> bool:
        """Whether a question is open."""
        return self.prediction.is_open

    def _show(self, values):
        if values.get("robot", self.robot) is not self.robot:
            self.scene.remove(sketch.ROOT)
            self.show(values["robot"])
        self.update(values)
        if self.panel:
            self._ask(values["predict"])
        live = self.panel is not None and self.panel.live
        waits = self.mine.look(lambda name: self._yours(name, values), self.scene, live)
        for button in self._brought:
            button.offer(self._is_ready(button.name))
        self.scene.said = self.mine.words(timed=False)
        if waits and self.panel:
            self.panel.late = True

    def _ask(self, on):
        if self.prediction.begins(on, self.robot):
            self.panel.end_motion()
            self.begin(self.number)
            self.update(self.panel.values)
        self.prediction.ask(self.question(self.panel.values) if on else None, self.frame is None)
        if self.asking:
            self.secret()

    def _more(self):
        """The buttons that the student's functions bring along."""
        return []

    def _is_ready(self, name):
        """Whether this button of theirs has something to do now."""
        return True

    def _yours(self, name, values):
        label = f"yours: {name}" if len(self.mine.functions) > 1 else "yours"
        return getattr(self, f"_{name}")(sketch.Sketch(self.scene, name, label), values)

    def _say(self, values):
        return "\n".join([*self.prediction.words(), *self.words(values), *self.mine.words()])

    def _drive_to(self, theta, follow=None):
        """A motion to theta (n,), also beyond the limits, where a slider would stop."""
        self.panel.play(np.linspace(self.panel.values["theta"], theta, 31), follow=follow)

    def open(self, height: int, theta: ArrayLike | None = None) -> Panel:
        """The panel, `height` pixels of picture, the arm at theta (n,) where that is given."""
        self.prediction = Prediction(self.scene)
        picker = [Choice("robot", self.arms)] if len(self.arms) > 1 else []
        self._brought = self._more()
        controls = [*picker, *self.controls(), *self._brought, *self.prediction.controls()]
        below = self.below()
        if theta is not None:
            self.start_at(np.asarray(theta, float))
            self.scene.make_room(self.robot.fk(theta)[:3, 3], self.around * self.scene.size)
        if self.in_space:
            self.scene.frame("/ck/space", np.eye(4), "s", 0.12 * self.scene.size)
        self.panel = Panel(
            self.name,
            self.scene,
            controls,
            self._show,
            self._say,
            below,
            self.title,
            height,
            drivers=self.drivers,
            computed=[*self.computed, ROOT, *([sketch.ROOT] if self.mine.functions else [])],
            formula=pointing.Formula(self.formula),
        )
        return self.panel
