"""A target of the tool: a frame that six sliders move, x, y, z and yaw, pitch, roll.

Where the solutions of an arm are known by a formula, each slider shows the values at which there is one while
the other five stay where they are, and those at which one keeps the joint limits.
"""

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import checks, rotations
from coursekit.kinematics.robot import Robot
from coursekit.view.chain import chain, hinges
from coursekit.view.controls import Slider, Sliders

TURNS = {"yaw": np.pi, "pitch": np.pi / 2, "roll": np.pi}  # how far each goes either way
PLACES = 4000  # of the tool that are looked at, to know how far it comes
SAMPLES = 121  # along a slider; what is narrower than the gap between two (a pixel or two) may be missed
FINER = 16, 2  # an end is looked for among so many values between two samples, and again so often
HELD = 0.2  # sizes of the arm: as far round a target its handles may stand
QUICK = 0.005  # seconds that may pass while a slider is dragged
LEGEND = """<div class="ck-control ck-legend">while the other five stay:
<span class="ck-band"></span> there is a solution,
<span class="ck-band ck-inside"></span> inside the joint limits</div>"""
Reach = Callable[[np.ndarray], np.ndarray]  # T (..., 4, 4) -> (2, ...): solved, solved inside the limits


class PoseSliders(Sliders):
    """Where a target is. In the picture its frame, at `path`, has handles that move these sliders.

    `reach` tells which poses can be reached; without it the sliders show no bands.
    """

    path, letter = "/ck/target", "{d}"
    held = True  # whether there are handles now
    reach: Reach | None = None
    _cost = np.inf  # seconds that bands took when they were quickest: the first time is no measure

    def refresh(self, values: dict) -> None:
        """Show along each slider what can be reached."""
        if self.reach is None:
            return
        begun, pose = time.monotonic(), values[self.name]
        ends = [(slider.min / slider.shown_per_si, slider.max / slider.shown_per_si) for slider in self.used]
        for slider, bands in zip(self.used, reachable(self.reach, pose, ends), strict=True):
            slider.bands = [[[slider.shown_per_si * x for x in run] for run in runs] for runs in bands]
        self._cost = min(self._cost, time.monotonic() - begun)

    def has_time(self, _values: dict) -> bool:
        """While a slider is dragged: are bands quick?"""
        return self._cost < QUICK


def reachable(reach: Reach, pose: ArrayLike, ends: ArrayLike) -> list[tuple[list, list]]:
    """Where along each of the six numbers of a pose it can be reached, the other five held.

    Parameters
    ----------
    reach : function
        Poses T (..., 4, 4) -> bool (2, ...): whether a solution exists, whether one is inside the limits.
    pose : (6,), m and rad
    ends : (6, 2), m and rad, between which is looked

    Returns
    -------
    For each number the runs (low, high) with a solution, and those with one inside the limits. An end belongs
    to its run: it can be reached, or is one of `ends`.
    """
    pose, ends = np.asarray(pose, float), np.asarray(ends, float)
    grid = np.linspace(ends[:, 0], ends[:, 1], SAMPLES, axis=-1)
    values = np.sort(np.column_stack([grid, pose]), axis=-1)  # what is shown is looked at itself

    def look(number, values):
        """(2, ...): of poses that have another value (...) for these numbers (...)."""
        asked = np.broadcast_to(pose, (*values.shape, 6)).copy()
        np.put_along_axis(asked, number[..., None], values[..., None], axis=-1)
        return reach(pose_of(asked))

    inside = look(np.broadcast_to(np.arange(6)[:, None], values.shape), values)
    kind, number, at = np.nonzero(inside[..., 1:] != inside[..., :-1])  # an end lies after this sample
    low, high, rises = values[number, at], values[number, at + 1], ~inside[kind, number, at]
    edge = np.arange(len(at))
    for _ in range(FINER[1] if len(at) else 0):
        between = np.linspace(low, high, FINER[0] + 1, axis=-1)
        found = look(np.broadcast_to(number[:, None], between.shape), between)[kind, edge]
        first = (found[:, 1:] == rises[:, None]).argmax(axis=-1)
        low, high = between[edge, first], between[edge, first + 1]
    reached = np.where(rises, high, low)
    runs = []
    for k in range(6):
        both = []
        for which in range(2):
            mine = (number == k) & (kind == which)
            starts = [*values[k, :1][inside[which, k, :1]], *reached[mine & rises]]
            stops = [*reached[mine & ~rises], *values[k, -1:][inside[which, k, -1:]]]
            both.append([(float(a), float(b)) for a, b in zip(starts, stops, strict=True)])
        runs.append((both[0], both[1]))
    return runs


def pose_sliders(T: ArrayLike, robot: Robot, reach: Reach | None = None) -> PoseSliders:
    """Sliders whose value is (x, y, z, yaw, pitch, roll) in metres and radians, at first those of T (4, 4).

    They go a little further than the arm, so that a target may be out of its reach. `reach`: see `reachable`.
    """
    T = checks.pose(checks.array(T, (4, 4), "T"), "T")
    span = np.where(hinges(robot), np.pi, 1.0)
    low, high = np.clip(robot.q_min, -span, None), np.clip(robot.q_max, None, span)
    share = np.random.default_rng(0).uniform(-0.3, 1.3, (PLACES, robot.n)).clip(0, 1)  # the ends among them
    reached = robot.fk(low + share * (high - low))[:, :3, 3]
    reached = np.vstack([reached, T[:3, 3]])
    far = np.array([-reached.min(axis=0), reached.max(axis=0)]) + 0.08 * chain(robot).size
    far = np.ceil(10 * far) / 10  # down and up
    far = np.where(np.ptp(far, axis=0) < 0.15, far.max(axis=0), far)  # a difference by chance
    x_y_z = (Slider(n, p, -down, up, "mm") for n, p, down, up in zip("xyz", T[:3, 3], *far, strict=True))
    turns = zip(TURNS.items(), rotations.zyx(T[:3, :3]), strict=True)
    sliders = PoseSliders("pose", [*x_y_z, *(Slider(n, t, -end, end, "deg") for (n, end), t in turns)])
    if reach is not None:
        sliders.reach, sliders.legend = reach, LEGEND
    return sliders


def pose_of(values: ArrayLike) -> np.ndarray:
    """The poses T (..., 4, 4) that (x, y, z, yaw, pitch, roll) (..., 6) describe.

    >>> pose_of([0, 0, 0.5, 0, 0, 0])[2].tolist()
    [0.0, 0.0, 1.0, 0.5]
    """
    values = checks.array(values, (6,), "values")
    T = np.tile(np.eye(4), (*values.shape[:-1], 1, 1))
    T[..., :3, :3], T[..., :3, 3] = rotations.from_zyx(values[..., 3:]), values[..., :3]
    return T
