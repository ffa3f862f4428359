"""The 3D viewer: meshcat's own JavaScript in a notebook output, fed over the notebook's own connection.

There is no server, no port and no extra process, so it works wherever the notebook works: on a laptop, behind
a hub, in a container. What the page needs to draw is kept in the widget's state (traits), so that a second
view, a late view and a reloaded page come right by themselves:

    commands    meshcat's commands (set_object, set_transform, set_property), msgpack, by key
    pose        where everything that moves stands now: 16 numbers per path, one message per pose
    motion      many poses at once, stepped in the page
"""

import contextlib
import functools
import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import anywidget
import ipywidgets
import numpy as np
import traitlets
from numpy.typing import ArrayLike

from coursekit.view import meshcat, pointing
from coursekit.view.controls import Slider
from coursekit.view.meshcat import column_major
from coursekit.view.picture import png
from coursekit.view.scene import Scene
from coursekit.view.script import Widget
from coursekit.view.target import PoseSliders


class Viewer(Widget):
    """A scene in 3D.

    Parameters
    ----------
    scene : Scene
        What is drawn. After changing it call `sync`.
    height : int
        Pixels.
    quality : {"auto", "high", "low"}
        "auto" draws half the pixels while something moves, if frames are slow; "low" also leaves out shadows
        (for computers without a graphics processor).
    lock : context manager, optional
        Held while a picture is drawn that the page asks for: nothing may change the scene meanwhile.
    """

    kind = traitlets.Unicode("viewer").tag(sync=True)

    commands = traitlets.Dict().tag(sync=True, to_json=lambda _value, viewer: dict(viewer.messages.packed))
    labels: traitlets.List = traitlets.List().tag(sync=True)
    ghosts: traitlets.List = traitlets.List().tag(sync=True)
    moving: traitlets.List = traitlets.List().tag(sync=True)
    pose = traitlets.Bytes().tag(sync=True)
    camera = traitlets.Dict().tag(sync=True)
    views = traitlets.Dict().tag(sync=True)
    pointers = traitlets.Dict().tag(sync=True)  # word -> paths that show what it means
    description = traitlets.Unicode().tag(sync=True)
    motion = traitlets.Dict().tag(sync=True)
    motion_poses = traitlets.Bytes().tag(sync=True)
    motion_texts: traitlets.List = traitlets.List().tag(sync=True)
    frame = traitlets.Int(-1).tag(sync=True)  # pose of the motion that the page shows; -1: `pose` is shown
    playing = traitlets.Bool(False).tag(sync=True)  # more frames will follow
    drive = traitlets.Dict().tag(sync=True)  # how the page moves an arm by its sliders, see `driven_by`
    theta: traitlets.List = traitlets.List().tag(sync=True)  # where that arm is in `pose`
    reaching = traitlets.Dict().tag(sync=True)  # how it moves arms along with a target, see `Scene.reaching`
    handles: traitlets.List = traitlets.List().tag(sync=True)  # what can be dragged, see `held_by`
    # by a hand: {"what", "values", "live", "count"}; the page does not wait for its echo
    dragged = traitlets.Dict().tag(sync=True, echo_update=False)
    heard = traitlets.Int(0).tag(sync=True)  # the count of the last of them that the kernel has taken over
    controls: traitlets.List = traitlets.List().tag(sync=True)  # references to models
    answers = traitlets.Int(0).tag(sync=True)  # counts what the kernel has answered, for pages that wait
    height = traitlets.Int(420).tag(sync=True)
    quality = traitlets.Enum(["auto", "high", "low"], "auto").tag(sync=True)

    def __init__(
        self,
        scene: Scene,
        height: int = 420,
        quality: str = "auto",
        lock: contextlib.AbstractContextManager | None = None,
    ) -> None:
        self.scene = scene
        self._lock = lock or contextlib.nullcontext()
        self.messages = meshcat.Messages()
        self.messages.update(scene)
        self._arms = [arm.robot for arm in scene.robots.values() if arm.style != "ghost"]
        self._count = itertools.count(1)
        super().__init__(height=height, quality=quality, **self._state(scene))
        self.on_msg(self._answer)

    def sync(self, scene: Scene | None = None, frame: int | None = None) -> None:
        """Send what changed in the scene since the last call, and nothing else.

        frame : the pose of the motion that the scene shows; the motion goes on. Without it a scene that moved
        away from what the motion shows ends it; a label or a frame that is switched on does not.
        """
        self.scene = scene = self.scene if scene is None else scene
        changed, gone, deleted = self.messages.update(scene)
        if changed or gone:
            content = {"type": "commands", "keys": changed, "gone": gone, "delete": deleted}
            self.send(content, buffers=[self.messages.packed[key] for key in changed])
        state = self._state(scene)
        with self.hold_sync():
            arms = [arm.robot for arm in scene.robots.values() if arm.style != "ghost"]
            moved = state["pose"] != self.pose and not self._shows(scene)
            if arms != self._arms or (frame is None and moved):
                self.end()
            self._arms = arms
            for name, value in state.items():
                setattr(self, name, value)

    def end(self) -> None:
        """Take the motion and its buttons away: the scene's own pose is shown."""
        with self.hold_sync():
            self.motion, self.motion_poses, self.motion_texts = {}, b"", []
            self.frame, self.playing = -1, False

    def driven_by(self, sliders: Sequence[Slider | None]) -> None:
        """Let the page itself move the robot "robot" by these sliders, one or None for each joint.

        No slider at all: only the kernel moves it.
        """
        arm = self.scene.robots.get("robot")
        if arm is None or len(sliders) != arm.robot.n:
            self.drive = {}
            return
        self.drive = {
            "path": arm.path,
            "shapes": arm.shapes,
            "name": arm.robot.name,
            **arm.screws(),
            "sliders": [slider and f"IPY_MODEL_{slider.model_id}" for slider in sliders],
            "per": [slider.shown_per_si if slider else 1.0 for slider in sliders],
        }

    def held_by(self, targets: Iterable[PoseSliders]) -> None:
        """Let a person drag those that are `held`: frames and, with three sliders and no more, points."""
        self.handles = [
            {
                "path": one.path,
                "letter": one.letter,
                "sliders": [f"IPY_MODEL_{slider.model_id}" for slider in one.sliders],
                "per": [slider.shown_per_si for slider in one.sliders],
            }
            for one in targets
            if one.held
        ]

    def set_pose(self, transforms: ArrayLike) -> None:
        """Move what moves: transforms (k, 4, 4) in the order of `scene.moving`, in one message."""
        transforms = self._as_poses(transforms, 3)
        with self.hold_sync():
            self.pose = column_major(transforms)
            self.end()

    def play(
        self,
        transforms: ArrayLike,
        fps: float = 30.0,
        loop: bool = False,
        texts: Sequence[str] | None = None,
        autoplay: bool = True,
    ) -> None:
        """Send a motion once and let the page step through it, with play, pause, scrub and speed.

        Parameters
        ----------
        transforms : (N, k, 4, 4)
            For each of N frames the transforms of `scene.moving`.
        fps : float
            Frames a second at speed 1.
        loop, autoplay : bool
        texts : list of N str, optional
            One line per frame, shown under the picture.
        """
        transforms = self._as_poses(transforms, 4)
        count = len(transforms)
        if texts is not None and len(texts) != count:
            raise ValueError(f"texts must hold one line for each of the {count} frames, got {len(texts)}")
        varies = np.flatnonzero(np.ptp(transforms, axis=0).any(axis=(1, 2)))  # the rest stands in `pose`
        with self.hold_sync():
            self.motion_poses = column_major(transforms[:, varies])
            self.motion_texts = list(texts or [])
            self.frame, self.playing = 0, bool(autoplay)
            self.motion = {
                "id": next(self._count),  # the same motion played again is a change, too
                "frames": count,
                "moving": [self.moving[i] for i in varies],
                "fps": float(fps),
                "loop": bool(loop),
                "autoplay": bool(autoplay),
            }

    def rest_at(self, frame: int) -> None:
        """Show this frame of the motion; a page that plays it stops there, and then says so."""
        if self.playing:  # the page is ahead of what is known here
            self.send({"type": "rest", "frame": frame})
        else:
            self.frame = frame

    def forget(self) -> None:
        """Let go of what was drawn, once the viewer is closed."""
        self.messages = meshcat.Messages()
        self.scene = None  # type: ignore[assignment]  # closed: nothing may use it any more

    @functools.cached_property
    def meshcat(self) -> Any:
        """A `meshcat.Visualizer` that draws into this viewer, for those who know meshcat."""
        return meshcat.visualizer(self.send_command)

    def send_command(self, key: str, packed: bytes) -> None:
        """Send one raw meshcat command (msgpack) beside the scene's own; the same key replaces it later."""
        self.messages.packed.pop(key, None)  # to the end: a view that comes late gets them in this order
        self.messages.packed[key] = packed
        self.send({"type": "commands", "keys": [key], "gone": [], "delete": []}, [packed])

    def __repr__(self) -> str:
        return f"Viewer({'closed' if self.scene is None else self.scene.text()})"

    def _repr_mimebundle_(self, **_options):
        return mimebundle(self, self)

    # -- what goes to the page

    def _state(self, scene):
        return {
            "labels": [dict(label) for label in (*scene.labels, *pointing.labels(scene))],
            "pointers": pointing.words(scene),
            "ghosts": [dict(ghost) for ghost in scene.ghosts],
            "moving": list(scene.moving),
            "pose": column_major(scene.pose()) if len(scene.moving) else b"",
            "theta": scene.robots["robot"].theta.tolist() if "robot" in scene.robots else [],
            "reaching": scene.reaching(),
            "camera": dict(scene.camera),
            "views": dict(scene.views),
            "description": scene.text(),
        }

    def _shows(self, scene):
        """Whether the scene stands as in the frame of the motion that the page shows (but for rounding)."""
        paths = self.motion.get("moving", [])
        if self.frame < 0 or not set(paths) <= set(scene.moving):
            return False
        now = scene.pose()[[scene.moving.index(path) for path in paths]]
        begin = self.frame * now.nbytes
        shown = self.motion_poses[begin : begin + now.nbytes]
        return np.allclose(np.frombuffer(shown), np.frombuffer(column_major(now)), atol=1e-12)

    def _as_poses(self, transforms: ArrayLike, dimensions: int) -> np.ndarray:
        transforms = np.asarray(transforms, float)
        expected = (*(("N",) if dimensions == 4 else ()), len(self.moving), 4, 4)
        if transforms.ndim != dimensions or transforms.shape[-3:] != expected[-3:]:
            shape = ", ".join(map(str, expected))
            raise ValueError(
                f"transforms must have shape ({shape}), got {transforms.shape}: one per moving path"
            )
        return transforms

    def _answer(self, _widget, content, _buffers):
        if content.get("type") == "need_png":
            size = int(content.get("width", 640)), int(content.get("height", 420))
            with self._lock:
                if self.scene is not None:  # closed meanwhile
                    view = content.get("view")
                    seen = png(self.scene, *size, view if view in self.scene.views else "home")
                    self.send({"type": "png"}, buffers=[seen])


def mimebundle(widget: ipywidgets.Widget, viewer: Viewer) -> tuple[dict, dict]:
    """What a notebook stores for a widget: itself, a picture for readers without a kernel, and one line."""
    text, picture = repr(widget), png(viewer.scene, 640, viewer.height)
    viewer.send({"type": "png"}, buffers=[picture])  # before there is a view, which shows it at first
    data = {
        "text/plain": text,
        "image/png": picture,
        "application/vnd.jupyter.widget-view+json": {
            "version_major": 2,
            "version_minor": 0,
            "model_id": widget.model_id,
        },
    }
    # What anywidget would say besides: Google Colab asks in the metadata for its loader.
    _, metadata = anywidget.AnyWidget._repr_mimebundle_(widget) or ({}, {})
    return data, {**metadata, "image/png": {"alt": text}}
