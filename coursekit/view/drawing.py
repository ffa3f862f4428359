"""Drawing and Arm: the handles of what a Scene shows, to move it, to show or hide it, to take it away."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot

from .chain import chain

if TYPE_CHECKING:
    from .scene import Scene  # which makes them


class Drawing:
    """A handle to what is drawn at a path and below it."""

    def __init__(self, scene: Scene, path: str) -> None:
        self.scene, self.path = scene, path

    def show(self, shown: bool = True) -> None:
        """Show or hide it."""
        self.scene.shown[self.path] = bool(shown)

    def move(self, T: ArrayLike) -> None:
        """Move it to T (4, 4) in the space frame, as a part of the pose: a motion moves it along."""
        self.scene.placed.pop(self.path, None)
        self.scene.moved[self.path] = np.array(T, float)

    def remove(self) -> None:
        """Take it away."""
        self.scene.remove(self.path)


class Arm(Drawing):
    """The handle of a robot: where it stands (`theta`), its looks, the paths of its links."""

    color: str | int = "ghost"  # of a ghost
    goal: str = ""  # path of a frame that its tool is at: the page moves it along with that
    links: np.ndarray | None = None  # (n, 4, 4): where a ghost's links stand, if not where its joints say

    def __init__(self, scene: Scene, name: str, robot: Robot, style: str, source: str) -> None:
        super().__init__(scene, f"/ck/{name}")
        self.name, self.robot, self.style = name, robot, style
        # path -> half of the Jacobian: the page, too, places its arrows or, with a scale, its ellipsoid
        self.shapes: dict[str, tuple[str, float]] = {}
        self.source = source  # name of the robot whose painted parts it shows

    @property
    def theta(self) -> np.ndarray:
        """Joint values (n,), radians and metres."""
        return self._theta

    @theta.setter
    def theta(self, theta: ArrayLike) -> None:
        theta, robot = np.array(theta, float), self.robot
        if theta.shape != (robot.n,):
            raise ValueError(
                f"{robot.name} has {robot.n} joints: theta must be ({robot.n},), got {theta.shape}"
            )
        self._theta = theta

    def link(self, k: int) -> str:
        """The path of link k: 0 is the base, n carries the tool. IndexError for any other."""
        if not 0 <= k <= self.robot.n:
            raise IndexError(f"{self.robot.name} has links 0 to {self.robot.n}, got {k}")
        return f"{self.path}/{k}"

    def screws(self) -> dict:
        """What the page needs to move it: its screws, and the tool at zero, column by column."""
        return {"screws": self.robot.S.T.tolist(), "M": self.robot.M.T.ravel().tolist()}

    def look(self, solid: bool = True, skeleton: bool = False) -> None:
        """Show or hide the paint and the skeleton."""
        for k in range(self.robot.n + 1):
            self.scene.shown[f"{self.path}/{k}/solid"] = bool(solid)
            self.scene.shown[f"{self.path}/{k}/skeleton"] = bool(skeleton)

    def axes(self, name: str, label: str, **look: Any) -> list[Drawing]:
        """Draw the screw axes, each below its link's path as `name`; `look` as of `Scene.screw_axis`."""
        drawn = []
        for k, (S, joint) in enumerate(zip(self.robot.S.T, chain(self.robot).joints, strict=True), 1):
            at, length = joint.reach_of(S, first=k == 1)
            place: dict = {"label": f"{label}{k}", "at": at, "length": length}
            drawn.append(self.scene.screw_axis(f"{self.link(k)}/{name}", S, **place, **look))
        return drawn

    def show_axes(self, shown: bool = True) -> None:
        """Show or hide the screw axes at the links, labelled S1 to Sn."""
        paths = [f"{self.link(k)}/axis" for k in range(1, self.robot.n + 1)]
        if shown and paths[0] not in self.scene.parts:
            self.axes("axis", "S")
        for path in paths:
            self.scene.shown[path] = bool(shown)
