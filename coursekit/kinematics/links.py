"""The arm as links between joints, and one walk along them that serves whatever is asked of the arm.

    T(theta) = L_0 J_1(theta_1) L_1 J_2(theta_2) ... J_n(theta_n) L_n

Frame i rides on link i with its z along joint axis i. There a joint is as simple as a motion can be: a hinge
turns x towards y, a slide moves the origin along z. L_i leads from frame i to axis i + 1 and is constant.
The frames are the link frames, their z and their origins make the columns of the Jacobian, and behind the
last one is the tool. Modified DH is the same walk with four numbers for each L_i.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from . import checks, dh, lie
from .axes import SAME, cross, directions_of, foot, points_on, rotation_to

FEW = 100  # configurations; for fewer, numpy's calls cost more than the arithmetic


def joint_types_of(S: np.ndarray, given: Iterable[str] | None, name: str) -> tuple[str, ...]:
    """The joint types that the screws S (6, n) themselves say, n words; `given` (or None) must agree."""
    length, speed = np.linalg.norm(S[:3], axis=0), np.linalg.norm(S[3:], axis=0)
    for i in range(S.shape[1]):
        if length[i] == 0 and speed[i] == 0:
            raise ValueError(f"{name}: screw {i + 1} has direction zero: (omega; v) = 0 moves nothing")
        size, part = (speed[i], "|v|") if length[i] == 0 else (length[i], "|omega|")
        if abs(size - 1) > checks.UNIT:
            raise ValueError(f"{name}: screw {i + 1} must have {part} = 1, got {size:.6g}")
    said = tuple("prismatic" if w == 0 else "revolute" for w in length)
    given = dh.joint_types(given, S.shape[1]) if given is not None else said
    if given != said:
        raise ValueError(f"{name}: joint_types say {given}, but the screws in S are {said}")
    return said


def places_on(S: np.ndarray) -> np.ndarray:
    """On each axis of S (6, n) the point nearest the one before; a slide starts where it is. -> (n, 3), m."""
    places, here = [], np.zeros(3)
    for s, q in zip(S.T, points_on(S), strict=True):
        here = foot(here, q, s[:3]) if np.any(s[:3]) else here
        places.append(here)
    return np.array(places)


@dataclass(frozen=True, eq=False)
class Links:
    """What is constant about an arm.

    at_zero   (n + 1, 4, 4) the frames on the axes at theta = 0, then the tool frame, in the space frame
    turns     (n,) whether a joint turns about its axis
    slides    (n,) m per rad (or per m): how far it moves along its axis; 0 for a hinge, 1 for a slide
    sliding   the joints that do, numbered from 0
    L         (n + 1, 4, 4) L_0 ... L_n
    L_J       (n, 4, 16) L_(i-1) J_i(t) as constants of (1, sin t, cos t, t)
    """

    at_zero: np.ndarray
    turns: np.ndarray
    slides: np.ndarray
    sliding: tuple[int, ...]
    L: np.ndarray
    L_J: np.ndarray

    @classmethod
    def between(cls, S: np.ndarray, M: np.ndarray, places: np.ndarray, x: np.ndarray | None) -> Links:
        """Links of the arm with screws S (6, n) and home pose M, frames at places (n, 3).

        x (n, 3): where the x of each frame should point; None: along the x of the space frame. S alone says
        where the axes are: places are moved onto them, x is made perpendicular.
        """
        n, z = S.shape[1], directions_of(S)
        turns = np.any(S[:3], axis=0)
        at_zero = np.tile(np.eye(4), (n + 1, 1, 1))
        for i, q in enumerate(points_on(S)):
            at_zero[i, :3, :3] = rotation_to(z[i], None if x is None else x[i])
            at_zero[i, :3, 3] = foot(places[i], q, z[i]) if turns[i] else places[i]
        at_zero[n] = M
        L = np.array([at_zero[0], *(lie.inverse(at_zero[:-1]) @ at_zero[1:])])
        pitch = np.where(turns, (S[:3] * S[3:]).sum(axis=0), 1.0)
        slides = np.where(np.abs(pitch) < SAME, 0.0, pitch)
        J = [_joint(*how) for how in zip(turns, slides, strict=True)]
        L_J = [(a @ b).reshape(4, 16) for a, b in zip(L[:-1], J, strict=True)]
        sliding = tuple(np.flatnonzero(slides).tolist())
        return cls(at_zero, turns, slides, sliding, L, np.array(L_J))

    def along(self, theta: np.ndarray) -> Iterator[np.ndarray]:
        """Walk along the arm. theta (n, N) -> n + 1 frames (4, 3, N): their columns x, y, z and origin.

        Each is the frame of a link where the joints up to its own have carried it; the last is the tool's.
        """
        return self._along_few(theta) if theta.shape[1] < FEW else self._along_many(theta)

    def _along_many(self, theta):
        """Components first, configurations last: every step is a few operations on long rows."""
        cos, sin = np.cos(theta), np.sin(theta)
        frame = np.empty((4, 3, theta.shape[1]))
        frame[:] = self.L[0, :3].T[:, :, None]
        for i, link in enumerate(self.L[1:]):
            x, y, z, _ = frame
            if self.turns[i]:
                frame[0], frame[1] = cos[i] * x + sin[i] * y, cos[i] * y - sin[i] * x
            if self.slides[i]:
                frame[3] += self.slides[i] * theta[i] * z
            yield frame
            frame = (link.T @ frame.reshape(4, -1)).reshape(frame.shape)
        yield frame

    def _along_few(self, theta):
        """All link matrices L_(i-1) J_i at once, then one product per joint."""
        basis = np.empty((*theta.shape, 4))
        basis[..., 0], basis[..., 1], basis[..., 2], basis[..., 3] = 1, np.sin(theta), np.cos(theta), theta
        first, *others = (basis @ self.L_J).reshape(*theta.shape, 4, 4)
        T = first
        yield T[:, :3].T
        for step in (*others, self.L[-1]):
            T = T @ step
            yield T[:, :3].T

    def screws(self, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The joints' screws where they are now, (6, n, N), and the tool frame (4, 3, N). theta (n, N).

        A hinge has (z; o x z) with z and origin o of its frame; a slide (0; z), a screw of pitch h both:
        (z; o x z + h z).
        """
        J = np.empty((6, *theta.shape))
        for i, frame in enumerate(self.along(theta)):
            if i < len(theta):  # the last is the tool's
                _, _, z, o = frame
                J[:3, i], J[3:, i] = z, cross(o, z)
        for i in self.sliding:
            along = self.slides[i] * J[:3, i]
            J[3:, i], J[:3, i] = J[3:, i] * self.turns[i] + along, J[:3, i] * self.turns[i]
        return J, frame


def _joint(turns, slides):
    """K (4, 4, 4) with J(t) = K[0] + sin t K[1] + cos t K[2] + t K[3]: about and along z."""
    K = np.zeros((4, 4, 4))
    K[0], K[3, 2, 3] = np.eye(4), slides
    if turns:
        K[0, 0, 0] = K[0, 1, 1] = 0
        K[2, 0, 0] = K[2, 1, 1] = K[1, 1, 0] = 1
        K[1, 0, 1] = -1
    return K
