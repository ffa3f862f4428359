"""The DH procedure: from axis to axis along common normals, and what it leaves free.

Frame i - 1 has its z on axis i; x_i runs along the common normal from axis i to axis i + 1, which frame i
sits on. Four numbers lead from one frame to the next: turn theta about z and go d along it until x and the
normal agree, then go a along the normal and turn alpha about it. Behind the last axis stands one more line,
the z of the tool. Source: Siciliano et al. (2010), section 2.8.2; TPK4170 report 2021, section 2.1.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import checks
from .axes import NEARLY, SAME, feet, foot, parallel, rotation_to, sine


@dataclass(frozen=True, eq=False)
class Normal:
    """One step of the procedure: row i of the standard table, from axis i to the next line.

    case              how the two lines lie: "skew", "nearly parallel", "meeting", "parallel" or "same line"
    free              what that leaves open and what was taken, in words; "" where nothing is open. Nearly
                      parallel lines have one common normal, and it may be kilometres away: that is said, too
    foot_1, foot_2    (3,) ends of the common normal, on axis i and on the next line; frame i sits at foot_2
    x                 (3,) direction of x_i
    a, alpha, d, theta  the row: metres and radians, at q = 0
    """

    case: str
    free: str
    foot_1: np.ndarray
    foot_2: np.ndarray
    x: np.ndarray
    a: float
    alpha: float
    d: float
    theta: float


def procedure(w: np.ndarray, q: np.ndarray, M: np.ndarray) -> tuple[np.ndarray, list[Normal]]:
    """Unit directions w (n, 3), points q (n, 3), home pose M -> frame 0 (4, 4) and n Normals.

    Frame 0 is free, too: its origin is the point of axis 1 nearest the space frame's, its x as near to the
    space frame's x as can be.

    >>> base, (first, second) = procedure(np.eye(3)[[2, 1]], np.array([[0, 0, 0], [0.5, 0, 0.3]]), np.eye(4))
    >>> first.case, first.a, first.d, second.case
    ('skew', 0.5, 0.3, 'skew')
    """
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = rotation_to(w[0]), foot(np.zeros(3), q[0], w[0])
    x, origin, found = base[:3, 0], base[:3, 3], []
    lines = [*zip(w, q, strict=True), (M[:3, 2], M[:3, 3])]
    for i, (z, _) in enumerate(lines[:-1]):
        last = i + 1 == len(w)
        normal = _normal(origin, z, x, *lines[i + 1], M if last else None)
        found.append(normal)
        x, origin = normal.x, normal.foot_2
    return base, found


def _normal(origin, z, x_before, z_next, q_next, tool):
    """The step from the frame (x_before, z) at origin to the line through q_next along z_next."""
    if parallel(z, z_next):
        x, stop, whose = (
            (x_before, origin, "frame before") if tool is None else (tool[:3, 0], tool[:3, 3], "tool")
        )
        foot_1 = foot(stop, origin, z)
        foot_2 = foot(foot_1, q_next, z_next)
        a = float(np.linalg.norm(foot_2 - foot_1))
        if a < SAME:
            case, free = "same line", f"x, and the place along the line: those of the {whose}"
            foot_2, a = foot_1, 0.0
        else:
            case, free = "parallel", f"the place along the axes: that of the {whose}"
            x = (foot_2 - foot_1) / a
    else:
        foot_1, foot_2 = feet(origin, z, q_next, z_next)
        x = np.cross(z, z_next) / sine(z, z_next)
        a = float((foot_2 - foot_1) @ x)
        if abs(a) < SAME:
            case, free = "meeting", "the sign of x: the one nearer to the x before"
            x, foot_2, a = x if x @ x_before > -SAME else -x, foot_1, 0.0
        else:
            case, free = "skew", ""
            x, a = x * np.sign(a), abs(a)
        if parallel(z, z_next, NEARLY):
            case, away = "nearly parallel", f"{np.linalg.norm(foot_1 - origin):.3g} m away"
            free = f"nothing: {sine(z, z_next):.1e} rad from parallel, the common normal is {away}"
    alpha = np.arctan2(np.cross(z, z_next) @ x, z @ z_next)
    theta = np.arctan2(np.cross(x_before, x) @ z, x_before @ x)
    d = (foot_1 - origin) @ z
    return Normal(
        case, free, foot_1, foot_2, x + 0.0, a, *(float(value) + 0.0 for value in (alpha, d, theta))
    )


def common_normal(S_1: ArrayLike, S_2: ArrayLike) -> tuple[np.floating, np.floating, np.ndarray, np.ndarray]:
    """DH parameters between two revolute axes: length, angle and feet of their common normal.

    S_1, S_2: unit screws (6,) = (omega; v) without pitch. Returns (a, alpha, foot_1, foot_2): metres, radians
    in [0, pi], two points (3,) in the space frame. Parallel axes have infinitely many common normals: the
    foot on axis 1 is then its point nearest the origin. Nearly parallel axes have exactly one, and it may be
    far away: that is the singularity of the DH parameters.

    >>> a, alpha, foot_1, foot_2 = common_normal([0, 0, 1, 0, 0, 0], [0, -1, 0, 0, 0, -0.5])
    >>> float(a), round(float(alpha), 6), foot_2.tolist()
    (0.5, 1.570796, [0.5, 0.0, 0.0])
    """
    S_1, S_2 = checks.array(S_1, (6,), "S_1"), checks.array(S_2, (6,), "S_2")
    w_1, w_2 = S_1[:3], S_2[:3]
    for name, w in (("S_1", w_1), ("S_2", w_2)):
        if abs(np.linalg.norm(w) - 1) > checks.UNIT:
            raise ValueError(
                f"{name} must be a revolute screw: |omega| must be 1, got {np.linalg.norm(w):.3g}"
            )
    foot_1, foot_2 = feet(np.cross(w_1, S_1[3:]), w_1, np.cross(w_2, S_2[3:]), w_2)
    return np.linalg.norm(foot_2 - foot_1), np.arctan2(sine(w_1, w_2), w_1 @ w_2), foot_1, foot_2
