"""The 3D viewer: meshcat's own JavaScript in a notebook output, fed over the notebook's own connection.

There is no server, no port and no extra process, so it works wherever the notebook works: on a laptop, behind
a hub, in a container. What the page needs to draw is kept in the widget's state (traits), so that a second
view, a late view and a reloaded page come right by themselves:

    commands    meshcat's commands (set_object, set_transform, set_property), msgpack, by key
    pose        where everything that moves stands now: 16 numbers per path, one message per pose
    motion      many poses at once, stepped in the page

This is the one module that knows meshcat.
"""

import functools
import gzip
import importlib.util
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import anywidget
import ipywidgets
import numpy as np
import traitlets
import umsgpack
from numpy.typing import ArrayLike

from coursekit.view.scene import Scene

_STATIC = Path(__file__).parent / "static"
_SCRIPTS = ("bundle.js", "stage.js", "actors.js", "player.js", "viewer.js")


def script() -> str:
    """The page's side of the viewer: one JavaScript module, joined from the files in `static/`."""
    return "\n".join((_STATIC / name).read_text(encoding="utf-8") for name in _SCRIPTS)


@functools.cache
def bundle() -> bytes:
    """meshcat's JavaScript bundle, gzipped (853 KB become 217 KB).

    Found without importing meshcat, whose import costs half a second and warns about a library it uses.
    """
    found = importlib.util.find_spec("meshcat")
    if found is None or found.origin is None:
        raise ModuleNotFoundError("the viewer needs meshcat, which is not installed", name="meshcat")
    package = Path(found.origin).parent
    return gzip.compress((package / "viewer" / "dist" / "main.min.js").read_bytes(), 6, mtime=0)


def column_major(T: ArrayLike) -> bytes:
    """Bytes of transforms (..., 4, 4) as three.js reads them: float64, column by column."""
    T = np.asarray(T, float)
    if T.shape[-2:] != (4, 4):
        raise ValueError(f"transforms must have shape (..., 4, 4), got {T.shape}")
    return np.ascontiguousarray(np.swapaxes(T, -1, -2)).tobytes()


class Viewer(anywidget.AnyWidget):
    """A scene in 3D.

    Parameters
    ----------
    scene : Scene
        What is drawn. After changing it call `sync`.
    height : int
        Pixels.
    quality : {"auto", "high", "low"}
        "auto" draws half the pixels while something moves, if frames are slow; "low" also leaves out shadows
        and reflections (for computers without a graphics processor).
    """

    _esm = script()
    _css = _STATIC / "viewer.css"
    _bundle_was_sent = False  # by any Viewer of this kernel

    commands = traitlets.Dict().tag(sync=True, to_json=lambda _value, viewer: dict(viewer._packed))
    labels: traitlets.List = traitlets.List().tag(sync=True)
    ghosts: traitlets.List = traitlets.List().tag(sync=True)
    moving: traitlets.List = traitlets.List().tag(sync=True)
    pose = traitlets.Bytes().tag(sync=True)
    camera = traitlets.Dict().tag(sync=True)
    views = traitlets.Dict().tag(sync=True)
    description = traitlets.Unicode().tag(sync=True)
    motion = traitlets.Dict().tag(sync=True)
    motion_poses = traitlets.Bytes().tag(sync=True)
    motion_texts: traitlets.List = traitlets.List().tag(sync=True)
    frame = traitlets.Int(-1).tag(sync=True)  # pose of the motion that is shown; -1: `pose` is shown
    height = traitlets.Int(420).tag(sync=True)
    quality = traitlets.Enum(["auto", "high", "low"], "auto").tag(sync=True)

    def __init__(self, scene: Scene, height: int = 420, quality: str = "auto") -> None:
        self.scene = scene
        self._drawn: dict[str, dict] = {}  # key -> the scene's command, to see what changed
        self._packed: dict[str, bytes] = {}  # key -> its bytes
        self._take(scene)
        super().__init__(height=height, quality=quality, **self._state(scene))
        self.on_msg(self._answer)
        if not Viewer._bundle_was_sent:  # at once: the page must not wait until a busy kernel answers
            Viewer._bundle_was_sent = True
            self.send({"type": "bundle"}, buffers=[bundle()])

    def sync(self, scene: Scene | None = None) -> None:
        """Send what changed in the scene since the last call, and nothing else.

        A robot that moved away from the motion ends it; a label or a frame that is switched on does not.
        """
        self.scene = scene = self.scene if scene is None else scene
        changed, gone, deleted = self._take(scene)
        if changed or gone:
            content = {"type": "commands", "keys": changed, "gone": gone, "delete": deleted}
            self.send(content, buffers=[self._packed[key] for key in changed])
        state = self._state(scene)
        with self.hold_sync():
            if state["pose"] != self.pose and not self._shows(state["pose"]):
                self.frame = -1
            for name, value in state.items():
                setattr(self, name, value)

    def set_pose(self, transforms: ArrayLike) -> None:
        """Move what moves: transforms (k, 4, 4) in the order of `scene.moving`, in one message."""
        transforms = self._as_poses(transforms, 3)
        with self.hold_sync():
            self.pose = column_major(transforms)
            self.frame = -1

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
        with self.hold_sync():
            self.motion_poses = column_major(transforms)
            self.motion_texts = list(texts or [])
            self.frame = 0
            self.motion = {
                "id": self.motion.get("id", 0) + 1,  # the same motion played again is a change, too
                "frames": count,
                "fps": float(fps),
                "loop": bool(loop),
                "autoplay": bool(autoplay),
            }

    def stop(self) -> None:
        """Take the motion and its buttons away and show the scene's own pose."""
        with self.hold_sync():
            self.motion, self.motion_poses, self.motion_texts, self.frame = {}, b"", [], -1

    def forget(self) -> None:
        """Let go of what was drawn, once the viewer is closed."""
        self._drawn, self._packed = {}, {}
        self.scene = None  # type: ignore[assignment]  # closed: nothing may use it any more

    @functools.cached_property
    def meshcat(self) -> Any:
        """A `meshcat.Visualizer` that draws into this viewer, for those who know meshcat."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # meshcat imports a part of zmq that will go
            import meshcat
        return meshcat.Visualizer(window=self)

    def send_command(self, key: str, command: dict) -> None:
        """Send one raw meshcat command beside the scene's own; the same key replaces it later."""
        self._packed[key] = umsgpack.packb(command)
        self.send({"type": "commands", "keys": [key], "gone": [], "delete": []}, [self._packed[key]])

    def send(self, content: Any, buffers: Sequence[bytes] | None = None) -> None:
        """Send a custom message; a meshcat command object (from `meshcat.Visualizer`) is packed first."""
        if hasattr(content, "lower"):
            command = content.lower()
            kind = command.get("property", "") if command["type"] == "set_property" else ""
            return self.send_command(f"meshcat:{command['path']}:{command['type']}:{kind}", command)
        return super().send(content, buffers)

    def to_html(self) -> str:
        """A page with this scene in 3D that needs neither kernel nor network, as one string."""
        from coursekit.view.page import standalone

        return standalone(self)

    def __repr__(self) -> str:
        return f"Viewer({'closed' if self.scene is None else self.scene.text()})"

    def _repr_mimebundle_(self, **_options):
        return mimebundle(self, repr(self), self.scene, self.height)

    # -- what goes to the page

    def _take(self, scene):
        """Note the scene's commands: the keys that changed, those that are gone, and the paths to delete."""
        new = dict(scene.commands)
        gone = [key for key in self._drawn if key not in new]
        deleted = [self._drawn[key]["path"] for key in gone if self._drawn[key]["type"] == "set_object"]
        for key in gone:
            self._packed.pop(key, None)
        # deleting a path takes everything below it along: what is still there is sent again
        beneath = tuple(path.rstrip("/") + "/" for path in deleted)
        changed = [
            key
            for key, command in new.items()
            if self._drawn.get(key) is not command or (command["path"] + "/").startswith(beneath)
        ]
        for key in changed:
            self._packed[key] = umsgpack.packb(new[key])
        self._drawn = new
        return changed, gone, deleted

    def _state(self, scene):
        return {
            "labels": [dict(label) for label in scene.labels],
            "ghosts": [dict(ghost) for ghost in scene.ghosts],
            "moving": list(scene.moving),
            "pose": column_major(scene.pose()) if len(scene.moving) else b"",
            "camera": dict(scene.camera),
            "views": dict(scene.views),
            "description": scene.text(),
        }

    def _shows(self, pose):
        """Whether the frame of the motion at which the page rests is this pose (but for rounding)."""
        begin = self.frame * len(pose)
        shown = self.motion_poses[begin : begin + len(pose)] if self.frame >= 0 else b""
        return len(shown) == len(pose) and np.allclose(np.frombuffer(shown), np.frombuffer(pose), atol=1e-12)

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
        if content.get("type") == "need_bundle":
            self.send({"type": "bundle"}, buffers=[bundle()])
        elif content.get("type") == "need_png":
            size = int(content.get("width", 640)), int(content.get("height", 420))
            self.send({"type": "png"}, buffers=[self.scene.png(*size)])


def mimebundle(widget: ipywidgets.Widget, text: str, scene: Scene, height: int) -> tuple[dict, dict]:
    """What a notebook stores for a widget: itself, a picture for readers without a kernel, and one line."""
    data = {
        "text/plain": text,
        "image/png": scene.png(640, height),
        "application/vnd.jupyter.widget-view+json": {
            "version_major": 2,
            "version_minor": 0,
            "model_id": widget.model_id,
        },
    }
    return data, {"image/png": {"alt": text}}
