"""An explorer is a Panel: a scene in 3D, controls beside it, the numbers in words below.

    import numpy as np
    from coursekit import robots
    from coursekit.view import Choice, Panel, Scene, Toggle, joint_sliders

    def explore_reach(robot):
        scene = Scene()
        arm = scene.robot(robot, robot.home)
        tool = scene.frame(arm.link(robot.n) + "/tool", robot.M, "tool")

        def update(values):                       # called at every change, before the picture is sent
            arm.theta = values["theta"]
            tool.show(values["tool"])

        def text(values):                         # the line below the picture: numbers for everyone
            x, y, z = robot.fk(values["theta"])[:3, 3]
            return f"{robot.name}: tool at ({x:.3f}, {y:.3f}, {z:.3f}) m"

        controls = [joint_sliders(robot), Toggle("tool", "tool frame", start=True)]
        return Panel("reach", scene, controls, update, text)

`values` maps the name of each control to its value: radians and metres, never degrees. All callbacks run
under one lock, because slider messages arrive in more than one thread. Nothing is printed.
"""

import contextlib
import threading
from collections.abc import Callable, Sequence
from typing import Any

import ipywidgets
import numpy as np
from numpy.typing import ArrayLike

from coursekit.view import cells, layout
from coursekit.view import controls as parts
from coursekit.view.motion import Motion
from coursekit.view.pointing import Formula
from coursekit.view.scene import Scene
from coursekit.view.target import PoseSliders
from coursekit.view.viewer import Viewer, mimebundle


class Panel(ipywidgets.VBox):
    """A 3D scene with controls.

    Parameters
    ----------
    name : str
        Running the same cell again closes the panel of this name that it showed before.
    scene : Scene
    controls : list
        Slider, Sliders (`joint_sliders(robot)`), Choice, Toggle, Action: the column beside the picture.
    update : function(values), optional
        Changes the scene. An Action, a Table and other controls may be set from it with `put`.
    text : function(values) -> str, optional
        The text below the picture; the first line should say the pose.
    below : list, optional
        Plot and Table, under the picture.
    title : str, optional
        What the stored one-line text calls this explorer (default: name).
    height : int
        Of the picture, pixels.
    drivers : function(values), optional
        The slider of each joint of the robot "robot" (or None), by which the page moves it before the kernel
        answers. By default those of a control called "theta", where there is one for each joint.
    computed : list of str
        Paths of what `update` alone can place for another theta: a page without a kernel hides it.
    formula : Formula, optional
        Between picture and text; its parts show in the picture what they mean.
    """

    def __init__(
        self,
        name: str,
        scene: Scene,
        controls: Sequence[parts.Control | parts.Sliders] = (),
        update: Callable[[dict], None] | None = None,
        text: Callable[[dict], str] | None = None,
        below: Sequence[ipywidgets.Widget] = (),
        title: str | None = None,
        height: int = 430,
        quality: str = "auto",
        drivers: Callable[[dict], Sequence[parts.Slider | None]] | None = None,
        computed: Sequence[str] = (),
        formula: Formula | None = None,
    ) -> None:
        self.name = name
        self.title = name if title is None else title
        self.scene = scene
        self.below = list(below)
        self.computed = list(computed)
        self._update = update
        self._drivers = drivers or self._theta_sliders
        self._text = text
        self._lock = threading.RLock()
        self._quiet, self._was_put = False, False
        self.motion: Motion | None = None
        self._played = False  # whether it ran when the page last said so
        self._stale: list = []  # plots that wait until a drag ends
        self.live, self.late = False, False  # more values follow at once; and the scene waits for the last
        named = [c for c in (*controls, *below) if hasattr(c, "name")]  # stock widgets are not
        self._controls = {control.name: control for control in named}
        for control in named:
            if self._controls[control.name] is not control:
                raise ValueError(f"panel {name!r}: two controls are called {control.name!r}")

        values = self._updated()
        self.viewer = Viewer(scene, height=height, quality=quality, lock=self._lock)
        self.line = parts.TextLine("text")
        self.line.value = self._words(values)
        super().__init__(layout=ipywidgets.Layout(width="100%"))
        self.add_class("ck-panel")
        self._reset_button = parts.Action("reset", act=self.reset)
        column = layout.column(controls, self._reset_button) if controls else None
        self.formula = [formula] if formula else []
        self.children = layout.around(column, self.viewer, [*self.formula, self.line], self.below)
        self._draw_below(values, lambda _plot: False)
        for control in self._widgets():
            self._listen(control)
        touchable = [widget for widget in self._widgets() if widget.has_trait("touched")]
        self.viewer.controls = [f"IPY_MODEL_{widget.model_id}" for widget in touchable]
        self.viewer.driven_by(self._drivers(values))
        self.viewer.observe(self._frame_changed, ["frame", "playing"])
        self.viewer.held_by(self._targets())
        self.viewer.observe(self._dragged, "dragged")
        cells.take_place(self)
        cells.afterwards(self._catch_up)

    # -- values
    @property
    def values(self) -> dict[str, Any]:
        """Name -> value of every control, in radians and metres."""
        found = {name: control.get() for name, control in self._controls.items()}
        return {name: value for name, value in found.items() if value is not None}

    def set(self, **values: Any) -> None:
        """Set controls from the program: one update for all of them, exactly these values.

        `panel.set(theta=[0, 0, 0, 0, 0, 0], tool=False)`. ValueError for a control that it does not have, for
        a value that a control refuses, and where the panel is closed.
        """
        if self.scene is None:
            raise ValueError(
                f"panel {self.name!r} is closed, by close() or by one of the same name opened after it"
            )
        for name in values:
            if name not in self._controls:
                known = ", ".join(self._controls)
                raise ValueError(f"panel {self.name!r} has no control {name!r}; it has: {known}")
        with self._lock:
            before = {name: value for name, value in self.values.items() if name in values}
            try:
                self._put(values)
                if not all(isinstance(self._controls[name], parts.Toggle) for name in values):
                    self.end_motion()
                self.refresh(live=any(getattr(plot, "held", False) for plot in self.below))
            except Exception as error:  # a value that is refused moves nothing
                self._put(before)
                self.refresh()
                self.line.value = f"{type(error).__name__}: {error}"
                raise

    def reset(self) -> None:
        """Every control back to where it started, and the end of a motion."""
        with self._lock:
            with self._silence():
                for control in self._controls.values():
                    control.reset()
            self.end_motion()
            self.refresh()

    def refresh(self, live: bool = False) -> None:
        """Update scene, text and plots from the controls; `live`: more values will follow at once."""
        with self._lock:
            self.live, self.late = live, False
            try:
                values = self._updated()
                self.viewer.driven_by(self._drivers(values))
                self.viewer.held_by(self._targets())
                self.viewer.sync(self.scene, self.motion.frame if self.motion else None)
                self.line.value = self._words(values)
                self._draw_below(values, lambda plot: not live or plot.has_time(values))
            except Exception as error:
                self.line.value = f"{type(error).__name__}: {error}"
                raise

    def play(
        self,
        thetas: ArrayLike,
        name: str = "robot",
        fps: float = 30.0,
        loop: bool = False,
        texts: Sequence[str] | None = None,
        autoplay: bool = True,
        follow: Callable[[np.ndarray], None] | None = None,
    ) -> None:
        """Play joint values (N, n) of the robot `name` in the page, with buttons to pause and scrub.

        What the motion shows is what the panel shows: scene, sliders called "theta", text and plots go along,
        and stand where it rests. The motion ends with the next change of a control that is no switch.

        Parameters
        ----------
        thetas : (N, n)
        fps, loop, texts, autoplay
            As of `Viewer.play`.
        follow : function(theta), optional
            Moves what goes with the arm (by its handle), so that the page has it for every frame.
        """
        with self._lock:
            self.motion = None
            motion = Motion(self.scene.robots[name], np.array(thetas, float))
            poses = motion.poses(self.scene, follow)
            with self._silence():
                self.viewer.sync(self.scene)  # the paths that move, before what moves them
                self.viewer.play(poses, fps, loop, texts, autoplay)
            self.motion = motion
            if not self._quiet:
                self.refresh()

    def rest_at(self, frame: int) -> None:
        """Show this pose of the motion, and play no further. ValueError where there is no motion."""
        with self._lock:
            if self.motion is None:
                raise ValueError(f"panel {self.name!r} has no motion")
            with self._silence():
                self.viewer.rest_at(min(max(int(frame), 0), len(self.motion.thetas) - 1))
            self.motion.frame = self.viewer.frame
            self.refresh()

    # -- what a notebook stores
    def __repr__(self) -> str:
        return f"{self.title}: {'closed' if self.scene is None else self.scene.text()}"

    def _repr_mimebundle_(self, **_options):
        return mimebundle(self, self.viewer)

    def close(self) -> None:
        """Close every widget of the panel: nothing of it stays in the kernel or the page."""
        cells.SHOWN.pop(self, None)
        layout.close(self)
        for widget in self._widgets():  # those of a target in the picture stand in no column
            layout.close(widget)
        # The notebook's Out[...] keeps the panel for ever: what it drew must not stay with it.
        if hasattr(self, "viewer"):  # a panel that was refused half-way has none
            self.viewer.forget()
        self.below, self.formula, self._controls, self._stale, self.motion = [], [], {}, [], None
        self.scene = None  # type: ignore[assignment]  # closed: nothing may use it any more
        self.children = []
        self._update, self._text, self._drivers = None, None, self._theta_sliders

    # -- inside
    def _put(self, values):
        with self._silence():
            for name, value in values.items():
                self._controls[name].put(value)

    def _updated(self):
        """The values, once the scene shows them; read again where `update` put something into a control."""
        with self._silence():
            sliders = self._controls.get("theta")
            if self.motion and isinstance(sliders, parts.JointSliders):
                sliders.show(self.motion.theta)
            values, self._was_put = self.values, False
            if self._update is not None:
                self._update(values)
        if self.motion:
            self.motion.arm.theta = self.motion.theta
        return self.values if self._was_put else values

    def drivers(self) -> list[parts.Slider | None]:
        """The sliders by which the page itself moves arms: of joints, and of a target that arms follow."""
        joints = self._drivers(self.values) if self.viewer.drive else []
        goal = self.viewer.reaching.get("goal")
        return [*joints, *(slider for one in self._targets() if one.path == goal for slider in one.sliders)]

    def _theta_sliders(self, _values):
        sliders = self._controls.get("theta")
        return sliders.used if isinstance(sliders, parts.JointSliders) else []

    def _targets(self):
        return [control for control in self._controls.values() if isinstance(control, PoseSliders)]

    def _words(self, values):
        return self._text(values) if self._text is not None else self.scene.text()

    def _widgets(self):
        for control in self._controls.values():
            yield from control.sliders if isinstance(control, parts.Sliders) else [control]
        yield from (output for output in self.below if not hasattr(output, "name"))
        if hasattr(self, "_reset_button"):
            yield self._reset_button

    def _listen(self, widget):
        if widget.has_trait("value"):
            widget.observe(self._value_changed, "value")
        if widget.has_trait("touched"):
            widget.observe(self._answer, "touched")
        if widget.has_trait("live"):
            widget.observe(lambda change: change.new or self._catch_up(), "live")
        if widget.has_trait("pointed"):
            widget.observe(self._pointed, "pointed")
            widget.observe(lambda _change: self.refresh(), "room")
        if isinstance(widget, parts.Action) or getattr(widget, "walkable", False):
            widget.on_msg(self._message)

    def _value_changed(self, change):
        with self._lock:
            self._was_put = True
            if not self._quiet:
                if not isinstance(change.owner, parts.Toggle):
                    self.end_motion()
                self.refresh(live=getattr(change.owner, "live", False))

    def _answer(self, _change):
        """Tell the page that its change has arrived, whatever came of it."""
        with self._lock:
            self.viewer.answers += 1

    def _frame_changed(self, _change):
        """The page shows another frame of the motion, or rests at one."""
        with self._lock:
            if self._quiet:
                return
            if self.motion is None or self.viewer.frame < 0:
                self.end_motion()  # the page may not know yet that it has ended
            elif (self.motion.frame, self._played) != (self.viewer.frame, self.viewer.playing):
                last = len(self.motion.thetas) - 1
                self.motion.frame, self._played = min(max(self.viewer.frame, 0), last), self.viewer.playing
                self.refresh(live=self._played)

    def _dragged(self, change):
        """A hand in the picture moved a target or the joints: their sliders say so, all at once."""
        with self._lock:
            told = change.new
            target = {one.path: one for one in self._targets()}.get(told["what"])
            sliders = target.sliders if target else self._drivers(self.values)
            try:
                with contextlib.ExitStack() as later:  # the picture goes first
                    with self._silence():
                        for slider, value in zip(sliders, told["values"], strict=False):
                            if slider is not None and value is not None:
                                later.enter_context(slider.hold_sync())
                                slider.value, slider.live = value, told["live"]
                    if target is None or not target.in_picture:
                        self.end_motion()
                    self.refresh(live=told["live"])
            finally:  # once the page has all of it
                self.viewer.heard = told["count"]
                self.viewer.answers += 1

    def _pointed(self, change):
        """A click on a plot, or a hand that drags there."""
        with self._lock:
            change.owner.point_at(**change.new)
            if not change.new["live"]:
                self._catch_up()

    def end_motion(self) -> None:
        """Take a motion away: what it shows last stays."""
        self.motion = None
        with self._silence():
            self.viewer.end()

    def _draw_below(self, values, has_time):
        """Bands, plots and tables, once the arm is sent; a plot takes longest and may have to wait."""
        banded = [target for target in self._targets() if target.reach is not None]
        for output in (*self.formula, *banded, *self.below):
            if hasattr(output, "refresh"):
                self._stale = [other for other in self._stale if other is not output]
                if hasattr(output, "has_time") and not has_time(output):
                    self._stale.append(output)
                else:
                    output.refresh(values)

    def _catch_up(self):
        """Draw what had to wait."""
        with self._lock:
            if self._stale or self.late:
                self.refresh()

    def _message(self, widget, content, _buffers):
        with self._lock:
            if content.get("type") == "press" and widget.act is not None:
                with self._silence():
                    widget.act()
                self.refresh()
            elif content.get("type") == "step":
                widget.on_step(content["dx"], content["dy"])

    @contextlib.contextmanager
    def _silence(self):
        before, self._quiet = self._quiet, True
        try:
            yield
        finally:
            self._quiet = before
