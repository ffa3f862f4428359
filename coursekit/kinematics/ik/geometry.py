"""What the analytic inverse kinematics must know of an arm, read off its screws S and its home pose M.

Two families of six hinges are covered, and the planar arm with two:

    spherical   axis 1 perpendicular to 2, axes 2 and 3 parallel, axes 4, 5 and 6 meet in the wrist centre
    parallel    axis 1 perpendicular to 2, axes 2, 3 and 4 parallel, axes 5 and 6 meet (Universal Robots)

In both, axis 5 is perpendicular to axes 4 and 6. Everything is measured in the frame of the arm, fixed to the
base: axis 1 points up, axes 2 and 3 to the side, and the arm reaches forward at theta = 0.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .. import lie
from ..axes import SAME, across, directions_of, parallel, perpendicular, points_on, sine, wrist
from ..robot import Robot


@dataclass(frozen=True, eq=False)
class TwoHinges:
    """Two parallel hinges, seen along them: coordinates (forward, left) from axis 1."""

    frame: np.ndarray  # (4, 4) pose of the arm's frame in the space frame
    signs: tuple[float, ...]  # +1 where a joint turns from forward to left, -1 where it turns the other way
    upper: tuple[float, float]  # axis 1 -> axis 2 at theta = 0
    fore: tuple[float, float]  # axis 2 -> tool point at theta = 0
    height: float  # of the tool point along the axes

    branches = ("elbow-up", "elbow-down")


class NoClosedForm(ValueError):
    """An arm that the formulas do not cover; `condition` says what it lacks."""

    def __init__(self, robot: Robot, condition: object) -> None:
        self.condition = str(condition)
        super().__init__(f"{robot.name}: no analytic inverse kinematics: {condition}; use the numeric ones")


@dataclass(frozen=True, eq=False)
class SixHinges:
    """Six hinges: coordinates (forward, up, side) in the frame of the arm, side = forward cross up.

    The origin is the point of axis 1 that is as high as axis 2. The point P is the wrist centre for
    "spherical" and where axes 5 and 6 meet for "parallel".
    """

    family: str
    frame: np.ndarray  # (4, 4) pose of the arm's frame in the space frame
    signs: tuple[float, ...]  # +1, or -1 for a joint that turns against the axis its angle is measured about
    axis4: float  # "parallel": +1 if axis 4 points to the side, -1 if against it
    shoulder: float  # forward coordinate of axis 2
    side: float  # side coordinate of P, which joints 2 and 3 (and 4) do not change
    upper: tuple[float, float]  # axis 2 -> axis 3 at theta = 0, (forward, up)
    fore: tuple[float, float]  # axis 3 -> P ("parallel": axis 3 -> axis 4), (forward, up)
    hand: tuple[float, float]  # "parallel": axis 4 -> P, (forward, up)
    wrist: np.ndarray  # (3, 3) rows: directions of axis 4, axis 5 and their cross product
    bend: tuple[float, float]  # (cos, sin) of the angle from axis 4 to axis 6 about axis 5 at theta = 0
    of_pose: np.ndarray  # (9, 16) what the solver needs of a pose T is linear in T: of_pose @ T.ravel()
    point: np.ndarray  # (3,) P in the tool frame

    branches = tuple(
        f"{reach} {elbow} {wrist}"
        for reach in ("front", "back")
        for elbow in ("elbow-up", "elbow-down")
        for wrist in ("no-flip", "flip")
    )


@lru_cache(maxsize=64)  # of a frozen Robot, by identity
def geometry(robot: Robot) -> TwoHinges | SixHinges:
    """TwoHinges or SixHinges of a robot; NoClosedForm names the first condition that fails."""
    for i, (kind, slide) in enumerate(zip(robot.joint_types, robot.links.slides, strict=True)):
        if slide:
            what = "a screw with a pitch" if kind == "revolute" else kind
            _refuse(robot, f"joint {i + 1} is {what}, and only hinges are covered")
    if robot.n == 2:
        return _two_hinges(robot)
    if robot.n > 6:
        _refuse(robot, f"it has {robot.n} joints: redundant, so a pose leaves {robot.n - 6} of them free")
    if robot.n != 6:
        _refuse(robot, f"it has {robot.n} joints, not 6 (or 2, planar)")
    return _six_hinges(robot)


def _two_hinges(robot):
    w, q = directions_of(robot.S), points_on(robot.S)
    _parallel(robot, w, 1, 2)
    side, out = w[0], across(w[0], q[1] - q[0])
    length = np.linalg.norm(out)
    if length < SAME:
        _refuse(robot, "axes 1 and 2 coincide")
    frame = _frame(q[0], out / length, side)
    tool = _coordinates(frame, robot.M[:3, 3])
    fore = tool[0] - length, tool[1]
    if np.hypot(*fore) < SAME:
        _refuse(robot, "the tool point lies on axis 2")
    return TwoHinges(frame, (1.0, _sign(w[1] @ side)), (length, 0.0), tuple(map(float, fore)), float(tool[2]))


def _six_hinges(robot):
    w, q = directions_of(robot.S), points_on(robot.S)
    _parallel(robot, w, 2, 3)
    _perpendicular(robot, w, 1, 2)
    try:
        family, point = wrist(q, w)
    except ValueError as reason:
        _refuse(robot, reason)
    _perpendicular(robot, w, 4, 5)
    _perpendicular(robot, w, 5, 6)

    frame = _arm_frame(w, q, point)
    local = frame[:3, :3].T  # space directions -> directions in the frame of the arm
    shoulder, elbow, wrist4 = (_coordinates(frame, q[i])[:2] for i in (1, 2, 3))
    P = _coordinates(frame, point)
    end = P[:2] if family == "spherical" else wrist4
    for name, segment in (("2 and 3", elbow - shoulder), ("3 and 4", end - elbow)):
        if np.linalg.norm(segment) < SAME:
            what = "the wrist centre lies on axis 3" if (family, name) == ("spherical", "3 and 4") else None
            _refuse(robot, what or f"axes {name} coincide")
    basis = np.array([w[3], w[4], np.cross(w[3], w[4])]) @ local.T
    up, side = frame[:3, 1], frame[:3, 2]
    axis4 = _sign(w[3] @ side)
    signs = (
        _sign(w[0] @ up),
        _sign(w[1] @ side),
        _sign(w[2] @ side),
        axis4 if family == "parallel" else 1.0,
        1.0,
        1.0,
    )
    tool = lie.inverse(robot.M)
    needed = np.zeros((4, 3))  # in the tool frame: the point P and the directions of axes 6 and 5
    needed[:, 0] = tool @ [*point, 1]
    needed[:3, 1:] = tool[:3, :3] @ w[[5, 4]].T
    return SixHinges(
        family=family,
        frame=frame,
        signs=signs,
        axis4=axis4,
        shoulder=float(shoulder[0]),
        side=float(P[2]),
        upper=tuple(map(float, elbow - shoulder)),
        fore=tuple(map(float, end - elbow)),
        hand=tuple(map(float, P[:2] - end)),
        wrist=basis,
        bend=(float(w[5] @ w[3]), float(-w[5] @ np.cross(w[3], w[4]))),
        of_pose=np.kron(lie.inverse(frame)[:3], needed.T),
        point=needed[:3, 0],
    )


def _arm_frame(w, q, point):
    """Up: along axis 1, whichever way is nearer to the z of the space frame. Forward: where P is at zero."""
    up = w[0] if w[0, 2] > -SAME else -w[0]
    side = across(up, w[1])
    side = side / np.linalg.norm(side)
    forward = np.cross(up, side)
    ahead = [forward @ (x - q[0]) for x in (point, q[1])]
    ahead = next((x for x in ahead if abs(x) > SAME), 1.0)  # P above axis 1: the side of axis 2 decides
    side = side * _sign(ahead)
    return _frame(q[0] + up * (up @ (q[1] - q[0])), np.cross(up, side), side)


def _frame(origin, forward, side):
    frame = np.eye(4)
    frame[:3] = np.stack([forward, np.cross(side, forward), side, origin], axis=-1)
    return frame + 0.0


def _coordinates(frame, x):
    return frame[:3, :3].T @ (x - frame[:3, 3])


def _sign(x):
    return -1.0 if x < 0 else 1.0


def _parallel(robot, w, i, j):
    if not parallel(w[i - 1], w[j - 1]):
        apart = np.degrees(np.arcsin(min(sine(w[i - 1], w[j - 1]), 1)))
        _refuse(robot, f"axes {i} and {j} are not parallel ({apart:.3g} deg apart)")


def _perpendicular(robot, w, i, j):
    if not perpendicular(w[i - 1], w[j - 1]):
        between = np.degrees(np.arccos(np.clip(w[i - 1] @ w[j - 1], -1, 1)))
        _refuse(robot, f"axes {i} and {j} are not perpendicular ({between:.6g} deg between them)")


def _refuse(robot, condition):
    raise NoClosedForm(robot, condition)
