"""Denavit-Hartenberg tables, standard and modified: link transforms, screws, and each written as the other.

The two conventions hold the same four numbers per joint axis and put the frames in different places:

    standard   A_i = Rot_z(theta_i) Trans_z(d_i) Trans_x(a_i) Rot_x(alpha_i)            frame i on axis i + 1
    modified   A_i = Rot_x(alpha_{i-1}) Trans_x(a_{i-1}) Trans_z(d_i) Rot_z(theta_i)    frame i on axis i

A modified row i therefore holds the a and alpha of row i - 1 of the standard table: the two columns move one
row down. Sources: Siciliano et al. (2010), eqs. 2.51-2.52; Lynch & Park (2017), appendix C.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from . import checks, lie
from .normals import Normal, common_normal, procedure

__all__ = ["CONVENTIONS", "Normal", "Table", "common_normal", "from_axes", "joint_types", "steps"]

CONVENTIONS = ("standard", "modified")
_JOINTS = {"r": "revolute", "revolute": "revolute", "p": "prismatic", "prismatic": "prismatic"}

# the twists of a revolute and of a prismatic joint, in the frame whose z is its axis
TURN_ABOUT_Z = np.array([0.0, 0, 1, 0, 0, 0])
SLIDE_ALONG_Z = np.array([0.0, 0, 0, 0, 0, 1])


@dataclass(frozen=True, eq=False)
class Table:
    """A robot arm as a DH table. T(q) = base A_1(q_1) ... A_n(q_n) tool.

    a, alpha, d, theta   (n,) each; metres and radians. For "modified", row i holds a_{i-1}, alpha_{i-1}, d_i,
                         theta_i. For a revolute joint theta is the offset added to q, else d is.
    convention           "standard" or "modified"
    joint_types          n words "revolute" / "prismatic" (or letters "R" / "P"); all revolute where not given
    base, tool           (4, 4) poses: frame 0 in the space frame, the tool in frame n

    Raises ValueError for a missing column, columns of different length, an unknown convention or joint type,
    or a base or tool that is not in SE(3).

    >>> table = Table(a=[0.5, 0.25], alpha=[0, 0], d=[0, 0], theta=[0, 0])
    >>> table.fk([0, np.pi / 2])[:2, 3].round(12).tolist()
    [0.5, 0.25]
    """

    a: np.ndarray = checks.NOT_GIVEN
    alpha: np.ndarray = checks.NOT_GIVEN
    d: np.ndarray = checks.NOT_GIVEN
    theta: np.ndarray = checks.NOT_GIVEN
    convention: str = "standard"
    joint_types: tuple[str, ...] = checks.NOT_GIVEN
    base: np.ndarray = checks.NOT_GIVEN
    tool: np.ndarray = checks.NOT_GIVEN

    if TYPE_CHECKING:  # what the constructor takes; fields say what __post_init__ makes of it

        def __init__(
            self,
            a: ArrayLike,
            alpha: ArrayLike,
            d: ArrayLike,
            theta: ArrayLike,
            convention: str = "standard",
            joint_types: Iterable[str] | None = None,
            base: ArrayLike | None = None,
            tool: ArrayLike | None = None,
        ) -> None: ...

    def __post_init__(self):
        columns = {name: getattr(self, name) for name in ("a", "alpha", "d", "theta")}
        missing = [name for name, column in columns.items() if column is None]
        if missing:
            raise ValueError(
                f"a DH table needs the columns a, alpha, d, theta; missing: {', '.join(missing)}"
            )
        columns = {name: checks.frozen(column, name) for name, column in columns.items()}
        shapes = {name: column.shape for name, column in columns.items()}
        if len(set(shapes.values())) > 1 or columns["a"].ndim != 1 or not columns["a"].size:
            raise ValueError(
                f"the columns of a DH table must have one number per joint each; got shapes {shapes}"
            )
        if self.convention not in CONVENTIONS:
            raise ValueError(f"convention must be one of {CONVENTIONS}, got {self.convention!r}")
        for name, column in columns.items():
            object.__setattr__(self, name, column)
        object.__setattr__(self, "joint_types", joint_types(self.joint_types, self.n))
        for name in ("base", "tool"):
            value = np.eye(4) if getattr(self, name) is None else checks.pose(getattr(self, name), name)
            object.__setattr__(self, name, checks.frozen(value, name, (4, 4)))

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.a)

    def link_transforms(self, q: ArrayLike) -> np.ndarray:
        """A_1 ... A_n. q (..., n) rad or m -> (..., n, 4, 4), pose of frame i in frame i - 1.

        Standard: eq. 2.52 of Siciliano et al.; modified: appendix C of Lynch & Park.
        """
        q = checks.joint_angles(q, self.n, f"the {self.convention} DH table")
        turns = np.array([kind == "revolute" for kind in self.joint_types])
        theta = self.theta + np.where(turns, q, 0.0)
        d = self.d + np.where(turns, 0.0, q)
        along_z, along_x = _screw_z(theta, d), _screw_x(self.alpha, self.a)
        return along_z @ along_x if self.convention == "standard" else along_x @ along_z

    def fk(self, q: ArrayLike) -> np.ndarray:
        """Tool pose in the space frame. q (..., n) -> T (..., 4, 4). Eq. 2.5 of the TPK4170 report."""
        A = self.link_transforms(q)
        T = self.base
        for i in range(self.n):
            T = T @ A[..., i, :, :]
        return T @ self.tool

    def frames(self, q: ArrayLike) -> np.ndarray:
        """The DH frames themselves: base A_1 ... A_i. q (..., n) -> (..., n, 4, 4), in the space frame."""
        A = self.link_transforms(q)
        frames, T = np.empty_like(A), self.base
        for i in range(self.n):
            T = frames[..., i, :, :] = T @ A[..., i, :, :]
        return frames

    def screws(self) -> tuple[np.ndarray, np.ndarray]:
        """The same arm as a product of exponentials: S (6, n) with columns (omega; v), and M (4, 4).

        With q split off each link transform, A_i(q) = M_i e^[A]q, the screws are
        [S_i] = (M_1 .. M_i) [A] (M_1 .. M_i)^-1 (TPK4170 report, eq. 2.18; A is about or along z). A standard
        frame i sits behind its joint, A_i(q) = e^[A]q M_i, so there the product ends at M_{i-1}.

        >>> S, M = Table(a=[0.5, 0.25], alpha=[0, 0], d=[0, 0], theta=[0, 0]).screws()
        >>> S[:, 1].tolist()
        [0.0, 0.0, 1.0, 0.0, -0.5, 0.0]
        """
        frames = self.frames(np.zeros(self.n))
        if self.convention == "standard":
            frames = np.concatenate([self.base[None], frames[:-1]])
        A = np.array([TURN_ABOUT_Z if kind == "revolute" else SLIDE_ALONG_Z for kind in self.joint_types])
        S = (lie.adjoint(frames) @ A[..., None])[..., 0].T
        return S, self.fk(np.zeros(self.n))

    def disagreement(self, S: np.ndarray, M: np.ndarray) -> str:
        """Where the table first leaves the arm with screws S (6, n) and home pose M; "" if nowhere.

        >>> table = Table(a=[0.5, 0.25], alpha=[0, 0], d=[0, 0], theta=[0, 0])
        >>> S, M = table.screws()
        >>> Table(a=[0.6, 0.25], alpha=[0, 0], d=[0, 0], theta=[0, 0]).disagreement(S, M)
        'after row 1 of the standard DH table axis 2 is 0 rad and 0.1 m off'
        """
        if S.shape[1] != self.n:
            return f"the {self.convention} DH table has {self.n} rows for {S.shape[1]} joints"
        own_S, own_M = self.screws()
        slides = np.array([kind == "prismatic" for kind in self.joint_types])
        own_S, S = (np.where(slides, np.roll(screws, 3, axis=0), screws) for screws in (own_S, S))
        rows_before = 0 if self.convention == "standard" else 1
        found = [(own_S[:, i], S[:, i], i + rows_before, f"axis {i + 1}") for i in range(self.n)]
        own_tool, tool = (np.append(T[:3, :3], T[:3, 3]) for T in (own_M, M))
        found.append((own_tool, tool, self.n, "the tool"))
        for own, given, row, what in found:
            apart = np.abs(own - given)
            if apart.max() > checks.POSE_TOLERANCE:
                where = f"row {row} of the {self.convention} DH table" if row else "the base of the DH table"
                return f"after {where} {what} is {apart[:-3].max():.3g} rad and {apart[-3:].max():.3g} m off"
        return ""

    def to_modified(self) -> Table:
        """The modified table of the same arm: same joints, same base, same T(q).

        a and alpha move one row down; those of the last row move into the tool.
        """
        if self.convention == "modified":
            return self
        tool = _screw_x(self.alpha[-1], self.a[-1]) @ self.tool
        a, alpha = np.append(0.0, self.a[:-1]), np.append(0.0, self.alpha[:-1])
        return Table(a, alpha, self.d, self.theta, "modified", self.joint_types, self.base, tool)

    def to_standard(self) -> Table:
        """The standard table of the same arm: same joints, same tool, same T(q).

        a and alpha move one row up; those of the first row move into the base.
        """
        if self.convention == "standard":
            return self
        base = self.base @ _screw_x(self.alpha[0], self.a[0])
        a, alpha = np.append(self.a[1:], 0.0), np.append(self.alpha[1:], 0.0)
        return Table(a, alpha, self.d, self.theta, "standard", self.joint_types, base, self.tool)


def joint_types(types: Iterable[str] | None, n: int) -> tuple[str, ...]:
    """n words "revolute" / "prismatic" from `types`: words, letters, or None, which means all revolute.

    Raises ValueError for another number of joints or an unknown word.

    >>> joint_types("RP", 2)
    ('revolute', 'prismatic')
    """
    types = ("revolute",) * n if types is None else tuple(types)
    unknown = [kind for kind in types if str(kind).lower() not in _JOINTS]
    if unknown:
        raise ValueError(f"joint_types must be 'revolute' (R) or 'prismatic' (P), got {unknown[0]!r}")
    if len(types) != n:
        raise ValueError(f"joint_types must name {n} joints, got {len(types)}: {types}")
    return tuple(_JOINTS[str(kind).lower()] for kind in types)


def from_axes(
    w: ArrayLike,
    q: ArrayLike,
    M: ArrayLike,
    joint_types: Iterable[str] | None = None,
    convention: str = "standard",
) -> Table:
    """The DH table of an arm that is given by its axes, made by common normals.

    Every arm without screws of a pitch has such a table, and many: what the procedure leaves free, and how it
    is chosen here, `steps` tells row by row. Raises ValueError as Robot.from_axes.

    Parameters
    ----------
    w : (n, 3), directions of the axes
    q : (n, 3), points on the axes, metres; for a slide: where it is to stand
    M : (4, 4), pose of the tool at q = 0
    joint_types : n words, "revolute" or "prismatic"; None: all revolute
    convention : "standard" or "modified"

    Examples
    --------
    >>> w, q = [[0, 0, 1], [0, 1, 0]], [[0, 0, 0], [0.1, 0, 0.4]]
    >>> table = from_axes(w, q, np.eye(4), convention="modified")
    >>> table.a.tolist(), table.alpha.round(4).tolist(), table.d.tolist()
    ([0.0, 0.1], [0.0, -1.5708], [0.4, 0.0])
    """
    w, q, M, types = axes_of_arm(w, q, M, joint_types, "dh.from_axes")
    base, rows = procedure(w, q, M)
    a, alpha, d, theta = np.array([(row.a, row.alpha, row.d, row.theta) for row in rows]).T
    to_last_frame = Table(a, alpha, d, theta, "standard", types, base).fk(np.zeros(len(rows)))
    table = Table(a, alpha, d, theta, "standard", types, base, tool=lie.inverse(to_last_frame) @ M)
    if convention not in CONVENTIONS:
        raise ValueError(f"convention must be one of {CONVENTIONS}, got {convention!r}")
    return table if convention == "standard" else table.to_modified()


def steps(w: ArrayLike, q: ArrayLike, M: ArrayLike) -> list[Normal]:
    """How `from_axes` went from axis to axis, as data to show.

    Parameters
    ----------
    w, q, M : as in `from_axes`

    Returns
    -------
    list of n `Normal`, one per row of the standard table

    Examples
    --------
    >>> [(row.case, row.free) for row in steps([[0, 0, 1], [0, 0, 1]], [[0, 0, 0], [1, 0, 0]], np.eye(4))]
    [('parallel', 'the place along the axes: that of the frame before'),
     ('parallel', 'the place along the axes: that of the tool')]
    """
    w, q, M, _ = axes_of_arm(w, q, M, None, "dh.steps")
    return procedure(w, q, M)[1]


def axes_of_arm(
    w: ArrayLike, q: ArrayLike, M: ArrayLike, types: Iterable[str] | None, name: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[str, ...]]:
    """Unit directions (n, 3), points (n, 3), M and joint types, or a ValueError that begins with `name`."""
    w, q = checks.array(w, (3,), f"{name}: w"), checks.array(q, (3,), f"{name}: q")
    if w.ndim != 2 or w.shape != q.shape:
        raise ValueError(
            f"{name}: w and q must both be (n, 3), one row per joint, got {w.shape} and {q.shape}"
        )
    length = np.linalg.norm(w, axis=1, keepdims=True)
    if not np.all(length > 0):
        raise ValueError(f"{name}: the axis of joint {np.argmin(length) + 1} has direction zero")
    return w / length, q, checks.pose(M, f"{name}: M"), joint_types(types, len(w))


def _screw_z(theta, d):
    """Rot_z(theta) Trans_z(d): the half-step about and along a joint axis. (...) -> (..., 4, 4)."""
    T = np.zeros((*np.shape(theta), 4, 4))
    T[..., 0, 0] = T[..., 1, 1] = np.cos(theta)
    T[..., 1, 0] = np.sin(theta)
    T[..., 0, 1] = -T[..., 1, 0]
    T[..., 2, 3] = d
    T[..., 2, 2] = T[..., 3, 3] = 1
    return T


def _screw_x(alpha, a):
    """Rot_x(alpha) Trans_x(a): the half-step about and along a common normal. (...) -> (..., 4, 4)."""
    T = np.zeros((*np.shape(alpha), 4, 4))
    T[..., 1, 1] = T[..., 2, 2] = np.cos(alpha)
    T[..., 2, 1] = np.sin(alpha)
    T[..., 1, 2] = -T[..., 2, 1]
    T[..., 0, 3] = a
    T[..., 0, 0] = T[..., 3, 3] = 1
    return T
