"""Scene: what there is to see, as data. It knows nothing of Jupyter, of browsers or of sliders.

Every drawing has a path below "/ck"; a path drawn again is replaced. A robot called `name` has one moving
path per link, "/ck/name/1" to "/ck/name/n" ("/ck/name/0" is its base): whatever is drawn below a link's path
is given where it stands at theta = 0, in the space frame, and moves with the link.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics.robot import Robot

from . import arm, camera, draw, stage, text
from .chain import chain
from .paint import Part, color, columns, group

STYLES = ("solid", "ghost", "skeleton")


@dataclass
class _Actor:
    """A robot in the scene; `source` is the actor whose painted parts it shows."""

    robot: Robot
    theta: np.ndarray
    style: str
    source: str


class Scene:
    """A picture of robots, frames, arrows and surfaces.

    commands   dict key -> raw meshcat command in the order to send; key: path, path#transform, path#visible
    parts      dict path -> what is drawn there, a list of paint.Part
    moving     paths that move, those of robots first;  pose() their transforms (k, 4, 4) now

    >>> from coursekit import robots
    >>> scene = Scene()
    >>> scene.robot(robots.planar_2r())
    >>> scene.moving
    ['/ck/robot/1', '/ck/robot/2']
    """

    def __init__(self, size: float = 1.0, floor: float = 0.0) -> None:
        self.commands: dict[str, dict] = {}
        self.parts: dict[str, list[Part]] = {}
        self._labels: dict[str, list[dict]] = {}
        self._transforms: dict[str, np.ndarray] = {}
        self._hidden: set[str] = set()
        self._actors: dict[str, _Actor] = {}
        self._floating: dict[str, np.ndarray] = {}
        self._low, self._high = np.array([-0.4, -0.4, 0]) * size, np.array([0.4, 0.4, 0.8]) * size
        self._set_stage(size, floor)

    # --- robots ---

    def robot(
        self, robot: Robot, theta: ArrayLike | None = None, name: str = "robot", style: str = "solid"
    ) -> None:
        """Draw a Robot at theta (n,), else at its home pose. style: "solid", "ghost" or "skeleton".

        The first robot decides how large the stage is and where the camera stands. A ghost shares the shapes
        of the same arm that is drawn already, and goes when that goes.
        """
        if style not in STYLES:
            raise ValueError(f"the style of a robot is one of {', '.join(STYLES)}, not {style!r}")
        root = f"/ck/{name}"
        self.remove(root)
        alike = [
            k for k, a in self._actors.items() if style == "ghost" and a.source == k and a.robot is robot
        ]
        actor = _Actor(
            robot, _angles(robot, robot.home if theta is None else theta), style, (alike or [name])[0]
        )
        if not alike:
            painted = arm.solid(robot)
            if not self._actors:
                self._fit(robot, actor.theta, painted)
            for k, (solid, lines) in enumerate(zip(painted, arm.skeleton(robot), strict=True)):
                self._draw(f"{root}/{k}/solid", solid)
                self._draw(f"{root}/{k}/skeleton", lines)
        self._actors[name] = actor
        if not alike:
            self.look(name, solid=style == "solid", skeleton=style == "skeleton")

    def look(self, name: str = "robot", solid: bool = True, skeleton: bool = False) -> None:
        """Show or hide the paint and the skeleton of a robot."""
        for k in range(self._actor(name).robot.n + 1):
            self.show(f"/ck/{name}/{k}/solid", solid)
            self.show(f"/ck/{name}/{k}/skeleton", skeleton)

    def set_theta(self, name: str, theta: ArrayLike) -> None:
        """Move a robot to theta (n,)."""
        actor = self._actor(name)
        actor.theta = _angles(actor.robot, theta)

    def theta(self, name: str = "robot") -> np.ndarray:
        """Where a robot is, (n,)."""
        return self._actor(name).theta

    @property
    def ghosts(self) -> list[dict]:
        """Copies of src/k/solid at path/k/ghost, k = 1..n: {"src", "path", "n", "color", "opacity"}."""
        look = {"color": color("ghost"), "opacity": 0.3}
        return [
            {"src": f"/ck/{actor.source}", "path": f"/ck/{name}", "n": actor.robot.n, **look}
            for name, actor in self._actors.items()
            if actor.style == "ghost"
        ]

    @property
    def moving(self) -> list[str]:
        """Paths that move: the links of every robot, and what `move` has moved."""
        joints = {name: range(1, actor.robot.n + 1) for name, actor in self._actors.items()}
        return [*(f"/ck/{name}/{k}" for name in joints for k in joints[name]), *self._floating]

    def pose(self) -> np.ndarray:
        """Transforms (k, 4, 4) of the paths in `moving`, now."""
        links = [actor.robot.displacements(actor.theta) for actor in self._actors.values()]
        return np.concatenate([np.empty((0, 4, 4)), *links, *(T[None] for T in self._floating.values())])

    def worlds(self, paths: Iterable[str]) -> dict[str, np.ndarray]:
        """Transforms (4, 4) from what is drawn at each path to the space frame, now: dict path -> T."""
        moved = dict(zip(self.moving, self.pose(), strict=True))
        worlds = {}
        for path in paths:
            steps, T = path.split("/"), np.eye(4)
            for k in range(2, len(steps) + 1):
                at = "/".join(steps[:k])
                T = T @ moved.get(at, np.eye(4)) @ self._transforms.get(at, np.eye(4))
            worlds[path] = T
        return worlds

    # --- lines and surfaces ---

    def frame(
        self, path: str, T: ArrayLike | None = None, letter: str = "", size: float | None = None
    ) -> None:
        """A lettered frame, size metres long, at T (4, 4) in the frame of the path's parent."""
        on_robot = any(_below(path, at) for at in self.moving)
        size = (0.1 if on_robot else 0.18) * self.size if size is None else size
        self._draw(path, *draw.frame(size, letter))
        self.place(path, np.eye(4) if T is None else T)

    def screw_axis(
        self,
        path: str,
        S: ArrayLike,
        theta: float | None = None,
        label: str = "",
        at: ArrayLike | None = None,
        length: float | None = None,
        color: str | int = "axis",
    ) -> None:
        """The line of a space screw S (6,) as an arrow, with an arc for the sense of turning, theta rad long.

        `at` is a point (3,) near which it is drawn; a screw that only slides goes through it and has no arc.
        """
        length = 0.3 * self.size if length is None else length
        self._draw(path, *draw.screw_axis(S, theta, label, at, length, 0.005 * self.size, color))

    def axes(self, name: str = "robot", shown: bool = True) -> None:
        """Show or hide the screw axes of a robot at its links, labelled S1 to Sn."""
        robot = self._actor(name).robot
        paths = [f"/ck/{name}/{k}/axis" for k in range(1, robot.n + 1)]
        if shown and paths[0] not in self.parts:
            for path, S, joint in zip(paths, robot.S.T, chain(robot).joints, strict=True):
                out, way = 2.5 * joint.radius * joint.along, S[:3] if np.any(S[:3]) else S[3:]
                low = joint.enter if path == paths[0] else joint.enter - out  # the first begins at the floor
                ends = low, joint.leave + out
                start, end = ends if way @ joint.along > 0 else ends[::-1]
                self.screw_axis(
                    path, S, label="S" + path.split("/")[-2], at=start, length=(end - start) @ way
                )
        for path in paths:
            self.show(path, shown)

    def arrow(
        self,
        path: str,
        start: ArrayLike,
        vector: ArrayLike,
        color: str | int = "accent",
        label: str = "",
        radius: float | None = None,
    ) -> None:
        """An arrow from start (3,) along vector (3,), metres; a vector of length zero draws nothing."""
        self._draw(path, *draw.arrow(start, vector, color, label, radius or 0.006 * self.size))

    def line(
        self,
        path: str,
        a: ArrayLike,
        b: ArrayLike,
        color: str | int = "bone",
        label: str = "",
        radius: float | None = None,
    ) -> None:
        """A straight line from a (3,) to b (3,)."""
        self._draw(path, *draw.line(a, b, color, label, radius or 0.003 * self.size))

    def curve(
        self, path: str, points: ArrayLike, color: str | int = "trace", radius: float | None = None
    ) -> None:
        """A smooth wire through points (k, 3)."""
        self._draw(path, draw.curve(points, color, radius or 0.0025 * self.size))

    def point(
        self,
        path: str,
        p: ArrayLike,
        label: str = "",
        color: str | int = "trace",
        radius: float | None = None,
    ) -> None:
        """A ball at p (3,)."""
        self._draw(path, *draw.point(p, label, color, radius or 0.008 * self.size))

    def normals(
        self, path: str, points: Iterable[ArrayLike], vectors: Iterable[ArrayLike], color: str | int = "axis"
    ) -> None:
        """Thin arrows from points (k, 3) along vectors (k, 3)."""
        self._draw(path, draw.normals(points, vectors, color, 0.002 * self.size))

    def plane(
        self,
        path: str,
        point: ArrayLike,
        normal: ArrayLike,
        size: float | None = None,
        color: str | int = "plane",
    ) -> None:
        """A translucent square through point (3,)."""
        self._draw(path, draw.plane(point, normal, size or 0.6 * self.size, color))

    def sphere(
        self, path: str, center: ArrayLike, radius: float, color: str | int = "plane", opacity: float = 0.18
    ) -> None:
        """A translucent sphere."""
        self._draw(path, draw.ball_about(center, radius, color, opacity))

    def ellipsoid(
        self,
        path: str,
        axes: ArrayLike,
        lengths: ArrayLike,
        at: ArrayLike,
        color: str | int = "trace",
        opacity: float = 0.3,
    ) -> None:
        """A translucent ellipsoid at (3,): columns of axes (3, 3), half lengths (3,) in metres.

        Drawn again with other numbers it only moves, and it may take part in a motion.
        """
        self._draw(path, [])
        for name, (parts, T) in draw.ellipsoid(axes, lengths, at, color, opacity, 0.0025 * self.size).items():
            self._draw(f"{path}/{name}", parts)
            self.move(f"{path}/{name}", T)

    # --- the tree ---

    def place(self, path: str, T: ArrayLike) -> None:
        """Move what is drawn at and below `path` to T (4, 4), in the frame of its parent."""
        self._transforms[path] = T = np.array(T, float)
        self._put(f"{path}#transform", {"type": "set_transform", "path": path, "matrix": columns(T)})

    def move(self, path: str, T: ArrayLike) -> None:
        """Move what is drawn at `path` to T (4, 4), as a part of the pose: a motion moves it along."""
        self._floating[path] = np.array(T, float)

    def show(self, path: str, shown: bool = True) -> None:
        """Show or hide what is drawn at and below `path`."""
        (self._hidden.discard if shown else self._hidden.add)(path)
        command = {"type": "set_property", "path": path, "property": "visible", "value": bool(shown)}
        self._put(f"{path}#visible", command)

    def visible(self, path: str) -> bool:
        """Whether neither `path` nor anything above it is hidden."""
        steps = path.split("/")
        return not any("/".join(steps[:k]) in self._hidden for k in range(2, len(steps) + 1))

    def remove(self, path: str) -> None:
        """Take away what is drawn at and below `path`; a robot takes its ghosts along."""
        name = path.removeprefix("/ck/")
        if name in self._actors:
            del self._actors[name]
            for ghost in [k for k, actor in self._actors.items() if actor.source == name]:
                self.remove(f"/ck/{ghost}")
        for table in (self.commands, self.parts, self._labels, self._transforms, self._floating):
            for key in [key for key in table if _below(key.split("#")[0], path)]:
                del table[key]
        self._hidden = {at for at in self._hidden if not _below(at, path)}

    @property
    def labels(self) -> list[dict]:
        """Texts that are shown, facing the reader: {"path", "pos" (in the frame of path), "text", "cls"}."""
        return [
            {"path": path, **label}
            for path in self._labels
            if self.visible(path)
            for label in self._labels[path]
        ]

    # --- looking at it ---

    @property
    def camera(self) -> dict:
        """Where the camera stands at first: {"position", "target", "size"} in metres, z up."""
        return {**self.views["home"], "size": float(self.size)}

    @property
    def views(self) -> dict[str, dict[str, list[float]]]:
        """Named camera stands: {"home", "top", "side", "front"} -> {"position", "target"}."""
        return camera.views(self._low, self._high, self.size)

    def png(self, width: int = 720, height: int = 440) -> bytes:
        """The scene as a PNG (bytes), drawn without a browser."""
        from .picture import draw as picture

        return picture(self, width, height)

    def text(self) -> str:
        """One line for those who cannot see the picture.

        >>> from coursekit import robots
        >>> scene = Scene()
        >>> scene.robot(robots.planar_2r(), [0, 0])
        >>> scene.text()
        'planar 2R: joints (0.0, 0.0) deg; tool at (750.0, 0.0, 0.0) mm'
        """
        lines = []
        ghosts = sum(actor.style == "ghost" for actor in self._actors.values())
        for name, actor in self._actors.items():
            if actor.style == "ghost":
                continue
            joints = _joints(actor.robot, actor.theta)
            tool = text.millimetres(actor.robot.fk(actor.theta)[:3, 3])
            who = actor.robot.name + ("" if name == "robot" else f" ({name})")
            lines.append(f"{who}: joints {joints}; tool at {tool}")
        if ghosts:
            lines.append(f"{ghosts} translucent arm" + ("s" if ghosts > 1 else ""))
        return "; ".join(lines) or "an empty scene"

    # --- inside ---

    def _draw(self, path, parts, labels=()):
        if not path.startswith("/ck/"):
            raise ValueError(f'a path starts with "/ck/", got {path!r}')
        self.parts[path], self._labels[path] = list(parts), list(labels)
        self._put(path, {"type": "set_object", "path": path, "object": group(parts)})

    def _put(self, key, command):
        if self.commands.get(key) != command:
            self.commands[key] = command

    def _actor(self, name):
        if name not in self._actors:
            raise ValueError(f"no robot is called {name!r}; there are: {', '.join(self._actors) or 'none'}")
        return self._actors[name]

    def _set_stage(self, size, floor):
        self.size, self.floor = float(size), float(floor)
        for command in stage.commands(self.size, self.floor):
            self._put(command["path"] + ("#visible" if command["type"] == "set_property" else ""), command)
        self._labels["/ck/stage"] = list(stage.ticks(self.size, self.floor))

    def _fit(self, robot, theta, painted):
        """Stage and camera for a robot: what it fills at theta, and where its tool can be seen to go."""
        arms = chain(robot)
        self._low, self._high = camera.extent(robot, theta, painted, arms)
        upright = abs(arms.up[2]) > 0.9
        self._set_stage(arms.size, arms.foot[2] if upright else min(0.0, self._low[2]))


def _angles(robot, theta):
    theta = np.array(theta, float)
    if theta.shape != (robot.n,):
        raise ValueError(f"{robot.name} has {robot.n} joints: theta must be ({robot.n},), got {theta.shape}")
    return theta


def _joints(robot, theta):
    """Joint values in words: one unit for all, or each with its own."""
    if "prismatic" not in robot.joint_types:
        return text.degrees(theta)
    say = {"revolute": text.degrees, "prismatic": text.millimetres}
    return "(" + ", ".join(say[kind](q) for kind, q in zip(robot.joint_types, theta, strict=True)) + ")"


def _below(path, root):
    return path == root or path.startswith(root + "/")
