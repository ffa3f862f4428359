"""Screws of a chain: what kind of joint each is, its exponential, and where the arm carries it.

`Robot` keeps what is computed here, once per arm: constants of exponentials, steps between axes, slides.
"""

from collections.abc import Iterable

import numpy as np

from . import dh, lie

UNIT = 1e-9  # how far from 1 the direction of a screw may be


def joint_types(S: np.ndarray, given: Iterable[str] | None, name: str) -> tuple[str, ...]:
    """Joint types that the screws S (6, n) themselves say, n words; `given` (or None) must agree.

    Raises ValueError, which names the robot, for a screw without a direction, one that is not of unit length,
    and for types that contradict the screws.
    """
    length, speed = np.linalg.norm(S[:3], axis=0), np.linalg.norm(S[3:], axis=0)
    for i in range(S.shape[1]):
        if length[i] == 0 and speed[i] == 0:
            raise ValueError(f"{name}: screw {i + 1} has direction zero: (omega; v) = 0 moves nothing")
        size, part = (speed[i], "|v|") if length[i] == 0 else (length[i], "|omega|")
        if abs(size - 1) > UNIT:
            raise ValueError(f"{name}: screw {i + 1} must have {part} = 1, got {size:.6g}")
    said = tuple("prismatic" if w == 0 else "revolute" for w in length)
    given = dh.joint_types(given, S.shape[1]) if given is not None else said
    if given != said:
        raise ValueError(f"{name}: joint_types say {given}, but the screws in S are {said}")
    return said


def exponential_constants(s: np.ndarray) -> np.ndarray:
    """K (4, 4, 4) with e^[s]t = K[0] + sin t K[1] + cos t K[2] + t K[3], for any unit screw s.

    Rodrigues' formula e^[s]t = I + sin t [s] + (1 - cos t) [s]^2 + (t - sin t) ([s] + [s]^3), ordered by what
    changes with t. The last bracket is what a screw slides along: 0 for a hinge, [s] for a prismatic joint.
    """
    X = lie.hat6(s)
    along = X + X @ X @ X
    return np.array([np.eye(4) + X @ X, X - along, -X @ X, along])


def frames_on(S: np.ndarray) -> np.ndarray:
    """A frame on every axis at zero: z along it, its origin nearest the one before. (6, n) -> (n, 4, 4)."""
    frames, origin = np.tile(np.eye(4), (S.shape[1], 1, 1)), np.zeros(3)
    for frame, s in zip(frames, S.T, strict=True):
        w, v = s[:3], s[3:]
        if np.any(w):
            on_axis = np.cross(w, v)
            origin = on_axis + w * (w @ (origin - on_axis))
        frame[:3, :3], frame[:3, 3] = frame_along(w if np.any(w) else v), origin
    return frames


def steps_along(S: np.ndarray) -> np.ndarray:
    """Pose of a frame on each axis (z along it) in the frame on the axis before, at theta = 0. (n, 4, 4)."""
    frames = np.tile(np.eye(4), (S.shape[1] + 1, 1, 1))  # the first is the space frame
    for frame, s in zip(frames[1:], S.T, strict=True):
        w, v = s[:3], s[3:]
        frame[:3, :3], frame[:3, 3] = frame_along(w if np.any(w) else v), np.cross(w, v)
    return lie.inverse(frames[:-1]) @ frames[1:]


def slide(s: np.ndarray) -> float:
    """How far a joint slides along its axis per radian or metre: 0 for a hinge, 1 for a prismatic joint."""
    pitch = s[:3] @ s[3:] if np.any(s[:3]) else 1.0
    return pitch if abs(pitch) > UNIT else 0.0


def frame_along(w: np.ndarray) -> np.ndarray:
    """A rotation whose z is w, x as near to the x (or, failing that, the y) of the space frame as can be."""
    x = np.array([1.0, 0, 0]) if abs(w[0]) < 0.9 else np.array([0, 1.0, 0])
    x = x - w * (w @ x)
    x = x / np.linalg.norm(x)
    return np.stack([x, np.cross(w, x), w], axis=-1)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b over the first axis: np.cross with less ceremony (it costs 15 us a call)."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def moved(theta: np.ndarray, kinds: tuple[str, ...], steps: np.ndarray, slides: np.ndarray) -> np.ndarray:
    """Every screw where the arm has carried it. theta (n, N) -> (6, n, N): batch last is fast.

    kinds: the joint types; steps: `steps_along(S)`; slides: `slide` of every screw.

    A frame (x, y, z, o) rides on every axis, z along it. A hinge turns x towards y, a slide moves o along
    z, and a constant step leads to the frame on the next axis. The screw of a hinge is (z; o x z).
    """
    cos, sin = np.cos(theta), np.sin(theta)
    J, o = np.empty((6, *theta.shape)), np.empty((3, *theta.shape))
    z = J[:3]
    frame = np.eye(4)[:, :3, None] + np.zeros_like(theta[0])  # (4, 3, N): columns, components, batch
    for i, step in enumerate(steps):
        frame = (step.T @ frame.reshape(4, -1)).reshape(frame.shape)
        x, y, z[:, i], o[:, i] = frame
        if kinds[i] == "revolute":
            frame[0], frame[1] = cos[i] * x + sin[i] * y, cos[i] * y - sin[i] * x
        if slides[i]:
            frame[3] += slides[i] * theta[i] * z[:, i]
    J[3:] = cross(o, z)
    for j in np.flatnonzero(slides):  # a slide: (0; z); a screw of pitch h: (z; o x z + h z)
        along = slides[j] * z[:, j]
        if kinds[j] == "revolute":
            J[3:, j] += along
        else:
            J[3:, j], J[:3, j] = along, 0
    return J
