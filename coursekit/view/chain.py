"""Where the joints of any robot sit: from screws to a stick figure with thicknesses.

Screws tell lines, not places. From base to tool, link i leaves axis i and reaches axis i + 1 at the ends of
their common normal, so the robot uses a stretch of each axis: from where it enters to where it leaves.
A stretch of no length is a joint that bends (an elbow), a long one a joint that twists (a forearm).
Everything is in the space frame at theta = 0, in metres.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from coursekit.kinematics import axes
from coursekit.kinematics.robot import Robot

# radius of the first and of the last joint, as parts of the robot's total length
THICKEST, THINNEST = 0.078, 0.02
SHOWN_PER_SI = {"deg": 180 / np.pi, "mm": 1000.0}


@dataclass
class Joint:
    """Joint i at theta = 0.

    enter, leave   (3,) where link i - 1 reaches the axis and where link i leaves it
    along          (3,) unit vector along the axis, pointing onwards
    split          (3,) where on the axis link i - 1 ends and link i begins
    radius         how thick the housing is
    bends          True for an elbow (one drum about the axis), False for a twist (a collar at `split`)
    travel         None, or for a sliding joint how far the rod must reach: (lowest, highest) in metres
    """

    enter: np.ndarray
    leave: np.ndarray
    along: np.ndarray
    radius: float = 0.0
    split: np.ndarray | None = None
    bends: bool = True
    travel: tuple[float, float] | None = None

    @property
    def length(self) -> float:
        return float(np.linalg.norm(self.leave - self.enter))

    def reach_of(self, S: np.ndarray, first: bool) -> tuple[np.ndarray, float]:
        """Where the arrow of its screw S (6,) begins, (3,), and its length; the `first` from the floor."""
        out, way = 2.5 * self.radius * self.along, S[:3] if np.any(S[:3]) else S[3:]
        ends = self.enter if first else self.enter - out, self.leave + out
        start, end = ends if way @ self.along > 0 else ends[::-1]
        return start, float((end - start) @ way)


@dataclass
class Chain:
    """All joints, the foot of the robot, and `size`: the length of the arm stretched out."""

    foot: np.ndarray
    up: np.ndarray
    joints: list[Joint]
    tool: np.ndarray
    size: float


def chain(robot: Robot) -> Chain:
    """The Chain of a Robot.

    >>> from coursekit import robots
    >>> [joint.bends for joint in chain(robots.kuka_kr6()).joints]
    [False, True, True, False, True, False]
    """
    joints = _stretches(robot)
    foot, tool = joints[0].enter, np.array(robot.M[:3, 3])
    size = _total_length(joints, tool) or 1.0
    _thicken(joints, tool, size)
    _orient(joints, tool, 1e-9 * size)
    first = joints[0]
    up = first.along
    if first.bends or first.travel is not None:  # the arm starts right at the foot: stand it on a pedestal
        level = first.travel is not None and abs(up[2]) < 0.7
        up = np.array([0.0, 0, 1]) if level else up if up[np.argmax(np.abs(up))] > 0 else -up
        foot = foot - 2.4 * first.radius * up
    _split(joints)
    return Chain(foot, up, joints, tool, size)


def hinges(robot: Robot) -> np.ndarray:
    """Which joints turn and do not slide: (n,) bool."""
    return np.array([kind == "revolute" for kind in robot.joint_types])


def shown_per_si(robot: Robot) -> np.ndarray:
    """What a radian or a metre of each joint is in degrees or millimetres, in which it is shown: (n,)."""
    return np.where(hinges(robot), SHOWN_PER_SI["deg"], SHOWN_PER_SI["mm"])


def ends_of(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Limits of the joints (n,), (n,); where there is none, half a turn or 1 m either way."""
    free = np.where(hinges(robot), np.pi, 1.0)
    low, high = np.isfinite(robot.q_min), np.isfinite(robot.q_max)
    return np.where(low, robot.q_min, -free), np.where(high, robot.q_max, free)


def _stretches(robot):
    """The joints with enter, leave and along, still without thickness."""
    slides, direction = [kind == "prismatic" for kind in robot.joint_types], axes.directions_of(robot.S)
    origin = robot.link_frames(np.zeros(robot.n))[:, :3, 3]
    known = robot.modified_dh is not None
    here = axes.foot(np.zeros(3), _point_on(robot, 0, np.zeros(3), direction), direction[0])
    joints = []
    for i in range(robot.n):
        enter, u = here, direction[i]
        if i + 1 < robot.n:
            v = direction[i + 1]
            point = _point_on(robot, i + 1, here, direction)
            if axes.parallel(u, v, axes.NEARLY):  # leave where the DH table puts the frame, else at once
                leave = axes.foot(origin[i], enter, u) if known else enter
                here = axes.foot(leave, point, v)
            else:
                leave, here = axes.feet(enter, u, point, v)
        else:
            leave = axes.foot(robot.M[:3, 3], enter, u)
        travel = None
        if slides[i]:
            low, high = robot.q_min[i], robot.q_max[i]
            travel = (low, high) if np.isfinite([low, high]).all() else (0.0, np.nan)
        joints.append(Joint(enter, leave, np.array(u), travel=travel))
    return joints


def _point_on(robot, i, here, direction):
    """A point of axis i. A sliding joint has no place of its own: it gets one that serves the next joint."""
    if robot.joint_types[i] == "revolute":
        return axes.points_on(robot.S)[i]
    if i + 1 == robot.n:
        return np.array(robot.M[:3, 3])
    if robot.joint_types[i + 1] == "prismatic":
        return here
    return axes.foot(here, axes.points_on(robot.S)[i + 1], direction[i + 1])


def _total_length(joints, tool):
    stops = [p for joint in joints for p in (joint.enter, joint.leave)] + [tool]
    return float(sum(np.linalg.norm(b - a) for a, b in pairwise(stops)))


def _thicken(joints, tool, size):
    """Radii: thick at the base, thin at the tool, in step with how much arm a joint carries, no crowding."""
    for i, joint in enumerate(joints):
        share = _total_length(joints[i:], tool) / size
        joint.radius = size * (THINNEST + (THICKEST - THINNEST) * share)
    first = joints[0]
    if first.length > 0.04 * size:  # a low base is slim rather than stood on a pedestal
        first.radius = min(first.radius, 0.9 * first.length)
    for joint in joints:
        joint.bends = joint.travel is None and joint.length < joint.radius
    for i, joint in enumerate(joints):
        neighbours = joints[max(i - 1, 0) : i] + joints[i + 1 : i + 2]
        room = [other.length for other in neighbours if not other.bends and other.travel is None]
        if joint.bends and room:
            joint.radius = min(joint.radius, 0.62 * min(room))
        if i:
            joint.radius = min(joint.radius, joints[i - 1].radius)
    if len(joints) > 1 and not first.bends and first.travel is None:
        first.radius = min(first.radius, 1.45 * joints[1].radius)


def _orient(joints, tool, tiny):
    """Point every axis onwards. A last joint with its tool right on it gets a short stub to show."""
    before = joints[0].enter
    for joint in joints:
        if joint.length > tiny:
            joint.along = (joint.leave - joint.enter) / joint.length
        elif (joint.enter - before) @ joint.along < -tiny:
            joint.along = -joint.along
        before = joint.enter if np.linalg.norm(joint.enter - before) > tiny else before
    last = joints[-1]
    if last.bends and len(joints) > 1 and np.linalg.norm(tool - last.enter) < 2 * last.radius:
        last.leave, last.bends = last.enter + 2.2 * last.radius * last.along, False


def _split(joints):
    """Where a twisting joint parts: clear of the drums at both ends, rather early than late."""
    for i, joint in enumerate(joints):
        before, after = (joints[j] if 0 <= j < len(joints) else None for j in (i - 1, i + 1))
        low = 1.15 * before.radius if before is not None and before.bends else 0.0
        high = joint.length - (1.15 * after.radius if after is not None and after.bends else 0.0)
        at = low + (0.5 if i in (0, len(joints) - 1) else 0.25) * (high - low)
        at = np.clip(at, 0.3 * joint.length, 0.8 * joint.length)
        joint.split = (joint.enter + joint.leave) / 2 if joint.bends else joint.enter + at * joint.along
