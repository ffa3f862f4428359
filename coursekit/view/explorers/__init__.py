"""The explorers of the six notebooks, and the idiom that they share."""

from collections.abc import Sequence
from typing import Any, ClassVar

import ipywidgets

from coursekit.kinematics.robot import Robot
from coursekit.view.controls import Control, JointSliders, Slider, Sliders
from coursekit.view.panel import Panel
from coursekit.view.scene import Scene


class Explorer:
    """One open explorer: what it remembers from one change to the next are its attributes, and nothing else.

    A subclass draws what stays in its constructor, and answers every change of a control twice: `update`
    moves what is drawn, `words` says the numbers of the same `values`. `open` makes the panel.
    """

    name: ClassVar[str]  # of the panel
    title: ClassVar[str]  # what the stored line of text calls it
    computed: ClassVar[tuple[str, ...]] = ()  # paths of what only `update` can place for another theta

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
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

    def update(self, values: dict[str, Any]) -> None:
        """Make the scene show these values of the controls, in radians and metres."""
        raise NotImplementedError

    def drivers(self, values: dict[str, Any]) -> Sequence[Slider | None]:
        """The slider of each joint, where the page can move the arm by them before the kernel answers."""
        return self.joints.used if self.joints else []

    def words(self, values: dict[str, Any]) -> str:
        """The numbers of the picture, for everyone."""
        raise NotImplementedError

    def open(self, height: int) -> Panel:
        """The panel, `height` pixels of picture."""
        controls, below = self.controls(), self.below()
        self.panel = Panel(
            self.name,
            self.scene,
            controls,
            self.update,
            self.words,
            below,
            self.title,
            height,
            drivers=self.drivers,
            computed=self.computed,
        )
        return self.panel
