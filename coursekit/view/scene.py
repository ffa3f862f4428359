"""Scene: what there is to see, as data. It knows nothing of Jupyter, of browsers or of sliders.

Every drawing has a path below "/ck"; a path drawn again is replaced. What is drawn gives a handle, and
`scene[path]` gives it again: a path at which nothing is drawn is an error. A robot called `name` has one
moving path per link, "/ck/name/1" to "/ck/name/n" ("/ck/name/0" is its base): whatever is drawn below a
link's path is given where it stands at theta = 0, in the space frame, and moves with the link.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot

from . import arm, camera, marks, stage, text
from .chain import chain
from .drawing import Arm, Drawing
from .paint import Part, color

STYLES = ("solid", "ghost", "skeleton")


class Scene:
    """A picture of robots, frames, arrows and surfaces.

    parts      dict path -> what is drawn there, a list of paint.Part
    robots     dict name -> Arm
    placed     dict path -> T (4, 4), in the frame of its parent, of what stands still
    moving     paths that move, those of robots first;  pose() their transforms (k, 4, 4) now
    shown      dict path -> bool, of what was shown or hidden by its handle

    What its methods draw has a path (its name; drawn again under the same path it is replaced) and may have a
    color (a name of `paint` or 0xRRGGBB), a label, and a size, length or radius in metres (None: as the stage
    asks) and an opacity from 0 to 1. Points, vectors and poses are given in the space frame, metres.

    >>> from coursekit import robots
    >>> scene = Scene()
    >>> arm = scene.robot(robots.planar_2r())
    >>> arm.theta = [0, 1]
    >>> scene.moving
    ['/ck/robot/1', '/ck/robot/2']
    """

    def __init__(self, size: float = 1.0, floor: float = 0.0) -> None:
        self.parts: dict[str, list[Part]] = {}
        self.robots: dict[str, Arm] = {}
        self.placed: dict[str, np.ndarray] = {}
        self.moved: dict[str, np.ndarray] = {}  # by `move`: path -> T in the space frame
        self.shown: dict[str, bool] = {}
        self.said: list[str] = []  # what `text` adds
        self.pointers: dict[str, tuple[str, ...]] = {}  # path -> words of a formula, see pointing.py
        self.lettering: dict[str, list[dict]] = {}
        self._low, self._high = np.array([-0.4, -0.4, 0]) * size, np.array([0.4, 0.4, 0.8]) * size
        self._seen = np.empty((0, 3))
        self.size, self.floor = float(size), float(floor)

    def __getitem__(self, path: str) -> Drawing:
        """The handle of what is drawn at `path` or below it; ValueError where there is nothing."""
        name = path.removeprefix("/ck/")
        if name in self.robots:
            return self.robots[name]
        if not any(_below(at, path) for at in (*self.parts, *self.moved)):
            raise ValueError(f"nothing is drawn at {path!r}; there are: {', '.join(self.parts) or 'none'}")
        return Drawing(self, path)

    # --- robots ---

    def robot(
        self, robot: Robot, theta: ArrayLike | None = None, name: str = "robot", style: str = "solid"
    ) -> Arm:
        """Draw a Robot at theta (n,), else at its home pose. style: "solid", "ghost" or "skeleton".

        The first robot decides how large the stage is and where the camera stands. A ghost shares the shapes
        of the same arm that is drawn already, and goes when that goes.
        """
        if style not in STYLES:
            raise ValueError(f"the style of a robot is one of {', '.join(STYLES)}, not {style!r}")
        self.remove(f"/ck/{name}")
        alike = [k for k, a in self.robots.items() if style == "ghost" and a.source == k and a.robot is robot]
        made = Arm(self, name, robot, style, (alike or [name])[0])
        made.theta = robot.home if theta is None else theta
        if not alike:
            painted = arm.solid(robot)
            if not self.robots:
                self._fit(robot, made.theta, painted)
            for k, (solid, lines) in enumerate(zip(painted, arm.skeleton(robot), strict=True)):
                self._draw(f"{made.path}/{k}/solid", solid)
                self._draw(f"{made.path}/{k}/skeleton", lines)
            made.look(solid=style == "solid", skeleton=style == "skeleton")
        self.robots[name] = made
        return made

    @property
    def ghosts(self) -> list[dict]:
        """Copies of src/k/solid at path/k/ghost, k = 1..n; one not shown is there for who points at it."""
        ghosts = [a for a in self.robots.values() if a.style == "ghost"]
        return [
            {"src": f"/ck/{a.source}", "path": a.path, "n": a.robot.n, "color": color(a.color)}
            | {"opacity": 0.3, "shown": self.visible(a.path)}
            for a in ghosts
        ]

    def reaching(self) -> dict:
        """The arms, all of one robot, whose tool is at their goal, with which the page moves them; or {}."""
        arms = [arm for arm in self.robots.values() if arm.goal in self.moved]
        if not arms:
            return {}
        goal, tools = arms[0].goal, arms[0].robot.fk(np.array([arm.theta for arm in arms]))
        there = np.isclose(tools, self.moved[goal], rtol=0, atol=1e-6).all(axis=(1, 2))
        told = {arm.path: arm.theta.tolist() for arm, is_there in zip(arms, there, strict=True) if is_there}
        return {"goal": goal, "name": arms[0].robot.name, **arms[0].screws(), "arms": told} if told else {}

    @property
    def moving(self) -> list[str]:
        """Paths that move: the links of every robot, and what was moved by its handle."""
        links = [a.link(k) for a in self.robots.values() for k in range(1, a.robot.n + 1)]
        return [*links, *self.moved]

    def pose(self) -> np.ndarray:
        """Transforms (k, 4, 4) of the paths in `moving`, now."""
        arms = self.robots.values()
        links = [a.robot.displacements(a.theta) if a.links is None else a.links for a in arms]
        return np.concatenate([np.empty((0, 4, 4)), *links, *(T[None] for T in self.moved.values())])

    def worlds(self, paths: Iterable[str]) -> dict[str, np.ndarray]:
        """Transforms (4, 4) from what is drawn at each path to the space frame, now: dict path -> T."""
        moved = dict(zip(self.moving, self.pose(), strict=True))
        worlds = {}
        for path in paths:
            steps, T = path.split("/"), np.eye(4)
            for k in range(2, len(steps) + 1):
                at = "/".join(steps[:k])
                T = T @ moved.get(at, np.eye(4)) @ self.placed.get(at, np.eye(4))
            worlds[path] = T
        return worlds

    # --- lines and surfaces ---

    def frame(
        self, path: str, T: ArrayLike | None = None, letter: str = "", size: float | None = None
    ) -> Drawing:
        """A lettered frame, size metres long, at T (4, 4) in the frame of its parent, else where it was."""
        on_robot = any(_below(path, at) for at in self.moving)
        size = (0.1 if on_robot else 0.18) * self.size if size is None else size
        drawing = self._draw(path, *marks.frame(size, letter))
        if T is not None:
            self.moved.pop(path, None)
            self.placed[path] = np.array(T, float)
        return drawing

    def screw_axis(
        self,
        path: str,
        S: ArrayLike,
        theta: float | None = None,
        label: str = "",
        at: ArrayLike | None = None,
        length: float | None = None,
        color: str | int = "axis",
        radius: float | None = None,
    ) -> Drawing:
        """The line of a space screw S (6,) as an arrow, with an arc for the sense of turning, theta rad long.

        `at` is a point (3,) near which it is drawn; a screw that only slides goes through it and has no arc.
        """
        length, radius = 0.3 * self.size if length is None else length, radius or 0.005 * self.size
        return self._draw(path, *marks.screw_axis(S, theta, label, at, length, radius, color))

    def arrow(
        self,
        path: str,
        start: ArrayLike,
        vector: ArrayLike,
        color: str | int = "accent",
        label: str = "",
        radius: float | None = None,
    ) -> Drawing:
        """An arrow from start (3,) along vector (3,), metres; a vector of length zero draws nothing."""
        return self._draw(path, *marks.arrow(start, vector, color, label, radius or 0.006 * self.size))

    def line(
        self,
        path: str,
        a: ArrayLike,
        b: ArrayLike,
        color: str | int = "bone",
        label: str = "",
        radius: float | None = None,
    ) -> Drawing:
        """A straight line from a (3,) to b (3,)."""
        return self._draw(path, *marks.line(a, b, color, label, radius or 0.003 * self.size))

    def curve(
        self, path: str, points: ArrayLike, color: str | int = "trace", radius: float | None = None
    ) -> Drawing:
        """A smooth wire through points (k, 3)."""
        return self._draw(path, marks.curve(points, color, radius or 0.0025 * self.size))

    def point(
        self,
        path: str,
        p: ArrayLike,
        label: str = "",
        color: str | int = "trace",
        radius: float | None = None,
    ) -> Drawing:
        """A ball at p (3,)."""
        return self._draw(path, *marks.point(p, label, color, radius or 0.008 * self.size))

    def normals(
        self, path: str, points: Iterable[ArrayLike], vectors: Iterable[ArrayLike], color: str | int = "axis"
    ) -> Drawing:
        """Thin arrows from points (k, 3) along vectors (k, 3)."""
        return self._draw(path, marks.normals(points, vectors, color, 0.002 * self.size))

    def plane(
        self,
        path: str,
        point: ArrayLike,
        normal: ArrayLike,
        size: float | None = None,
        color: str | int = "plane",
    ) -> Drawing:
        """A translucent square through point (3,)."""
        return self._draw(path, marks.plane(point, normal, size or 0.6 * self.size, color))

    def sphere(
        self, path: str, center: ArrayLike, radius: float, color: str | int = "plane", opacity: float = 0.18
    ) -> Drawing:
        """A translucent sphere."""
        return self._draw(path, marks.ball_about(center, radius, color, opacity))

    def ellipsoid(
        self,
        path: str,
        axes: ArrayLike,
        lengths: ArrayLike,
        at: ArrayLike,
        color: str | int = "trace",
        opacity: float = 0.3,
    ) -> Drawing:
        """A translucent ellipsoid at (3,): columns of axes (3, 3), half lengths (3,) in metres.

        Drawn again with other numbers it only moves, and it may take part in a motion.
        """
        whole = self._draw(path, [])
        for name, (parts, T) in marks.ellipsoid(
            axes, lengths, at, color, opacity, 0.0025 * self.size
        ).items():
            self._draw(f"{path}/{name}", parts).move(T)
        return whole

    # --- the tree ---

    def visible(self, path: str) -> bool:
        """Whether neither `path` nor anything above it is hidden."""
        steps = path.split("/")
        return all(self.shown.get("/".join(steps[:k]), True) for k in range(2, len(steps) + 1))

    def remove(self, path: str) -> None:
        """Take away what is drawn at and below `path`, if anything is; a robot takes its ghosts along."""
        gone = [self.robots.pop(name) for name in list(self.robots) if _below(f"/ck/{name}", path)]
        for ghost in [a for a in self.robots.values() if a.source in [g.name for g in gone]]:
            ghost.remove()
        tables: list[dict] = [self.parts, self.lettering, self.placed, self.moved, self.shown, self.pointers]
        for table in tables:
            for key in [key for key in table if _below(key, path)]:
                del table[key]

    @property
    def labels(self) -> list[dict]:
        """Texts that are shown, facing the reader: {"path", "pos" (in the frame of path), "text", "cls"}."""
        on_stage = [{"path": "/ck/stage", **tick} for tick in stage.ticks(self.size, self.floor)]
        lettered = [
            (path, labels) for path, labels in self.lettering.items() if labels and self.visible(path)
        ]
        return [*on_stage, *({"path": path, **label} for path, labels in lettered for label in labels)]

    # --- looking at it ---

    @property
    def camera(self) -> dict:
        """Where the camera stands at first, as a view, with {"size"} in metres and {"fov"} in degrees."""
        return {**self.views["home"], "size": float(self.size), "fov": camera.FOV}

    @property
    def views(self) -> dict[str, dict]:
        """Named camera stands: {"home", "top", "side", "front"} -> {"position", "target", "wide"}."""
        margin = 0.1 * self.size
        low, high = [self._low, *self._seen - margin], [self._high, *self._seen + margin]
        return camera.views(np.min(low, axis=0), np.max(high, axis=0), self.size)

    def make_room(self, points: np.ndarray, around: float = 0.0) -> None:
        """Stand so far away that these points (..., 3), and so many metres around them, are always seen."""
        points = points.reshape(-1, 3)
        self._low = np.minimum(self._low, points.min(axis=0) - around)
        self._high = np.maximum(self._high, points.max(axis=0) + around)

    def see(self, points: np.ndarray) -> None:
        """Step back until these points (k, 3) are in the picture, too; with none: to where the camera was."""
        seen = np.vstack([self._seen, points]) if len(points) else points
        self._seen = np.array([seen.min(axis=0), seen.max(axis=0)]) if len(seen) else seen

    def text(self) -> str:
        """One line for those who cannot see the picture.

        >>> from coursekit import robots
        >>> scene = Scene()
        >>> arm = scene.robot(robots.planar_2r(), [0, 0])
        >>> scene.text()
        'planar 2R: joints (0.0, 0.0) deg; tool at (750.0, 0.0, 0.0) mm'
        """
        lines = []
        for name, one in self.robots.items():
            if one.style != "ghost":
                joints, tool = text.joints(one.robot.joint_types, one.theta), one.robot.fk(one.theta)[:3, 3]
                who = one.robot.name + ("" if name == "robot" else f" ({name})")
                lines.append(f"{who}: joints {joints}; tool at {text.millimetres(tool)}")
        ghosts = sum(
            a.style == "ghost" and a.links is None and self.visible(a.path) for a in self.robots.values()
        )
        if ghosts:
            lines.append(f"{ghosts} translucent arm" + ("s" if ghosts > 1 else ""))
        return "; ".join([*lines, *self.said]) or "an empty scene"

    # --- inside ---

    def _draw(self, path, parts, labels=()):
        if not path.startswith("/ck/"):
            raise ValueError(f'a path starts with "/ck/", got {path!r}')
        self.parts[path], self.lettering[path] = list(parts), list(labels)
        return Drawing(self, path)

    def _fit(self, robot, theta, painted):
        """Stage and camera for a robot: what it fills at theta, and where its tool can be seen to go."""
        arms = chain(robot)
        self._low, self._high = camera.extent(robot, theta, painted, arms)
        upright = abs(arms.up[2]) > 0.9
        self.size, self.floor = arms.size, float(arms.foot[2] if upright else min(0.0, self._low[2]))


def _below(path, root):
    return path == root or path.startswith(root + "/")
