"""Robot: an open chain as screws and a home pose, with everything that follows from them.

T(theta) = e^[S_1]theta_1 ... e^[S_n]theta_n M      (Lynch & Park, eq. 4.14)
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike

from . import axes, checks, dh, lie
from .links import Links, joint_types_of, places_on

CHUNK = 2048  # configurations per block: keeps the working set of a large batch in the cache
AT_LIMIT = 1e-9  # rad or m beyond a limit that still count as inside: rounding of an angle that was computed


class About(TypedDict, total=False):
    """What a Robot may be told beyond its screws: `Robot` explains each."""

    name: str
    q_min: ArrayLike | None
    q_max: ArrayLike | None
    v_max: ArrayLike | None
    home: ArrayLike | None
    places: ArrayLike | None
    standard_dh: dh.Table | None
    modified_dh: dh.Table | None
    source: str
    discrepancies: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Robot:
    """An open-chain robot arm. Make one with `from_screws`, `from_axes`, `from_dh` or `from_urdf`.

    Arrays are read-only.

    S              (6, n) space screws, one per column, (omega; v), at theta = 0
    M              (4, 4) pose of the tool in the space frame at theta = 0
    name           for people and error texts
    joint_types    n words "revolute" / "prismatic"
    q_min, q_max   (n,) joint limits, rad or m; infinite where none are known
    v_max          (n,) speed limits, rad/s or m/s; NaN where none are known
    home           (n,) the pose the maker calls home (zero where it has none)
    places         (n, 3) where each joint stands on its axis at theta = 0, in metres: points given to
                   `from_axes`, origins of a given modified DH table, or else on each axis the point nearest
                   the place before
    standard_dh    dh.Table: the same arm, frame i on axis i + 1. The one given, or made from the axes (None
                   where a joint is a screw with a pitch)
    modified_dh    dh.Table: the same arm, frame i on axis i
    source         where the numbers come from
    discrepancies  what sources say otherwise, one sentence each
    B              (6, n) body screws, Ad(M^-1) S
    links          what is constant between the joints, see `links.Links`

    Raises ValueError for screws without direction or unit length, M not in SE(3), limits that exclude each
    other, places off their axes, and a DH table that describes another arm than S and M: the text names the
    joint or the row and says by how much.
    """

    S: np.ndarray
    M: np.ndarray
    name: str = "robot"
    joint_types: tuple[str, ...] = checks.NOT_GIVEN
    q_min: np.ndarray = checks.NOT_GIVEN
    q_max: np.ndarray = checks.NOT_GIVEN
    v_max: np.ndarray = checks.NOT_GIVEN
    home: np.ndarray = checks.NOT_GIVEN
    places: np.ndarray = checks.NOT_GIVEN
    standard_dh: dh.Table | None = None
    modified_dh: dh.Table | None = None
    source: str = ""
    discrepancies: tuple[str, ...] = ()
    B: np.ndarray = field(init=False, repr=False)
    links: Links = field(init=False, repr=False)

    if TYPE_CHECKING:  # the constructor takes lists, too; fields say what __post_init__ makes of them

        def __init__(
            self,
            S: ArrayLike,
            M: ArrayLike,
            *,
            joint_types: Iterable[str] | None = None,
            **more: Unpack[About],
        ) -> None: ...

    def __post_init__(self):
        S = checks.array(self.S, (), f"{self.name}: S")
        if S.ndim != 2 or S.shape[0] != 6 or S.shape[1] == 0:
            raise ValueError(f"{self.name}: S must be (6, n), one screw (omega; v) per column, got {S.shape}")
        n = S.shape[1]
        defaults = {"q_min": -np.inf, "q_max": np.inf, "v_max": np.nan, "home": 0.0}
        for key, default in defaults.items():
            value = np.full(n, default) if getattr(self, key) is None else getattr(self, key)
            self._store(key, value, (n,))
        if np.any(self.q_min > self.q_max):
            joint = np.argmax(self.q_min > self.q_max)
            limits = f"{self.q_min[joint]:.6g} and {self.q_max[joint]:.6g}"
            raise ValueError(f"{self.name}: q_min must not exceed q_max; joint {joint + 1} has {limits}")
        self._store("S", S, (6, n))
        self._store("M", checks.pose(self.M, f"{self.name}: M"), (4, 4))
        self._store("B", lie.adjoint(lie.inverse(self.M)) @ S, (6, n))
        object.__setattr__(self, "joint_types", joint_types_of(S, self.joint_types, self.name))
        self._place()

    def _place(self):
        """Tables and places follow from each other, where only one of them is given; links from both."""
        zero, w, q = np.zeros(self.n), axes.directions_of(self.S), axes.points_on(self.S)
        tables = [table for table in (self.standard_dh, self.modified_dh) if table is not None]
        for table in tables:
            complaint = table.disagreement(self.S, self.M)
            if complaint:
                raise ValueError(f"{self.name}: {complaint}")
        places = self.places
        if places is None:
            places = tables[-1].to_modified().frames(zero)[:, :3, 3] if tables else places_on(self.S)
        self._store("places", places, (self.n, 3))
        off = np.linalg.norm(np.cross(self.places - q, w), axis=1) * np.any(self.S[:3], axis=0)
        if off.max() > checks.POSE_TOLERANCE:
            raise ValueError(f"{self.name}: place {off.argmax() + 1} is {off.max():.3g} m beside its axis")
        if not tables and np.all(np.abs((self.S[:3] * self.S[3:]).sum(axis=0)) < axes.SAME):
            tables = [dh.from_axes(w, self.places, self.M, self.joint_types)]
        x = None
        if tables:
            object.__setattr__(self, "standard_dh", tables[0].to_standard())
            object.__setattr__(self, "modified_dh", tables[-1].to_modified())
            x = self.modified_dh.frames(zero)[:, :3, 0].round(15)  # a quarter turn is then exactly one
        object.__setattr__(self, "links", Links.between(self.S, self.M, self.places, x))

    def _store(self, key, value, shape):
        """Fields are set once, as read-only copies: a frozen dataclass allows no plain assignment."""
        object.__setattr__(self, key, checks.frozen(value, f"{self.name}: {key}", shape))

    # -- ways to make one ---------------------------------------------------------------------------------

    @classmethod
    def from_screws(
        cls, S: ArrayLike, M: ArrayLike, joint_types: Iterable[str] | None = None, **more: Unpack[About]
    ) -> Robot:
        """From space screws and the home pose. Errors as the class.

        Parameters
        ----------
        S : (6, n), rows (omega; v), metres
        M : (4, 4), pose of the tool at theta = 0
        joint_types : n words, "revolute" or "prismatic"; None: as the screws say
        **more : other fields of the class

        Examples
        --------
        >>> robot = Robot.from_screws([[0], [0], [1], [0], [0], [0]], np.eye(4), name="turntable")
        >>> robot.joint_types
        ('revolute',)
        """
        return cls(S, M, joint_types=joint_types, **more)

    @classmethod
    def from_axes(
        cls,
        w: ArrayLike,
        q: ArrayLike,
        M: ArrayLike,
        joint_types: Iterable[str] | None = None,
        **more: Unpack[About],
    ) -> Robot:
        """From what one reads off a drawing: directions of the axes and points on them.

        A revolute joint gets S = (w; -w x q), a prismatic one S = (0; w). Directions are scaled to length 1.
        The points are the joints' `places`: frames and pictures have them there, unless a DH table is given,
        which says it for itself. Raises ValueError where a direction has length zero.

        Parameters
        ----------
        w, q : (n, 3), directions, and points in metres
        M : (4, 4), pose of the tool at theta = 0
        joint_types : n words, "revolute" or "prismatic"; None: all revolute
        **more : other fields of the class

        Examples
        --------
        >>> robot = Robot.from_axes([[0, 0, 2]], [[1, 0, 0]], np.eye(4))
        >>> robot.S[:, 0].tolist()
        [0.0, 0.0, 1.0, 0.0, -1.0, 0.0]
        """
        w, q, M, types = dh.axes_of_arm(w, q, M, joint_types, more.get("name", "robot"))
        slides = np.array([kind == "prismatic" for kind in types])[:, None]
        S = np.hstack([np.where(slides, 0.0, w), np.where(slides, w, -np.cross(w, q))]).T + 0.0  # no -0
        if more.get("standard_dh") is None and more.get("modified_dh") is None:
            more.setdefault("places", q)
        return cls(S, M, joint_types=types, **more)

    @classmethod
    def from_dh(cls, table: dh.Table, **more: Unpack[About]) -> Robot:
        """From a `dh.Table` of either convention, which makes the other; `more` fields by name.

        >>> table = dh.Table(a=[0.5, 0.25], alpha=[0, 0], d=[0, 0], theta=[0, 0])
        >>> Robot.from_dh(table).M[:3, 3].tolist()
        [0.75, 0.0, 0.0]
        """
        if not isinstance(table, dh.Table):
            name = more.get("name", "robot")
            raise ValueError(f"{name}: from_dh needs a dh.Table, got {type(table).__name__}")
        S, M = table.screws()
        more.setdefault("standard_dh", table.to_standard())
        more.setdefault("modified_dh", table.to_modified())
        return cls(S, M, joint_types=table.joint_types, **more)

    @classmethod
    def from_urdf(cls, path: str | Path, tip: str | None = None, **more: Unpack[About]) -> Robot:
        """From a URDF: the chain from the root link to one link, whose frame is the tool frame.

        Revolute, continuous, prismatic and fixed joints; limits and speeds as given (a speed of 0 is
        unknown); joints beside the chain do not matter. Raises ValueError that names the element and its
        line: mimic, floating or planar joint, links without a chain, no numbers, a document type, no XML.

        Parameters
        ----------
        path : name of a file, or its text
        tip : name of a link; None where only one link carries no other
        **more : other fields of the class

        Examples
        --------
        >>> robot = Robot.from_urdf('''<robot name="turntable"> <link name="floor"/> <link name="plate"/>
        ...     <joint name="turn" type="continuous"> <parent link="floor"/> <child link="plate"/>
        ...         <origin xyz="0 0 0.3"/> <axis xyz="0 0 1"/> </joint> </robot>''')
        >>> robot.name, robot.n, robot.M[2, 3].tolist()
        ('turntable', 1, 0.3)
        """
        from . import urdf

        return cls.from_axes(**{**urdf.read(path, tip), **more})

    def with_tool(self, T: ArrayLike) -> Robot:
        """The same arm with a tool: T (4, 4) is the new tool frame in the old one. M becomes M T.

        >>> Robot.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4)).with_tool(np.eye(4)).n
        1
        """
        T = checks.pose(T, f"{self.name}: the tool")
        return replace(self, M=self.M @ T, **self._tables(lambda table: replace(table, tool=table.tool @ T)))

    def with_base(self, T: ArrayLike) -> Robot:
        """The same arm elsewhere: T (4, 4) is the old space frame in the new one. S -> Ad(T) S, M -> T M.

        >>> Robot.from_axes([[0, 0, 1]], [[0, 0, 0]], np.eye(4)).with_base(np.eye(4)).n
        1
        """
        T = checks.pose(T, f"{self.name}: the base")
        tables = self._tables(lambda table: replace(table, base=T @ table.base))
        places = self.places @ T[:3, :3].T + T[:3, 3]
        return replace(self, S=lie.adjoint(T) @ self.S, M=T @ self.M, places=places, **tables)

    def _tables(self, change):
        """The DH tables of the arm after `change`, where it has any."""
        tables = {"standard_dh": self.standard_dh, "modified_dh": self.modified_dh}
        return {key: table and change(table) for key, table in tables.items()}

    # -- forward kinematics --------------------------------------------------------------------------------

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.S.shape[1]

    def fk(self, theta: ArrayLike) -> np.ndarray:
        """Pose of the tool in the space frame. theta (..., n) rad or m -> T (..., 4, 4). Eq. 4.14.

        Raises ValueError if the last axis of theta is not n. NaN in, NaN out.

        >>> from coursekit import robots
        >>> robots.kuka_kr6().fk([0, 0, -np.pi / 2, np.pi / 2, 0, 0]).round(6)[:3, 3].tolist()
        [0.445, 0.0, 0.9]
        """
        theta = checks.joint_angles(theta, self.n, self.name)
        T = _identities((theta.size // self.n,))
        for block, angles in self._blocks(theta):
            tool = deque(self.links.along(angles), maxlen=1).pop()  # the others would only fill the cache
            T[block, :3] = tool.T
        return T.reshape(*theta.shape[:-1], 4, 4)

    def link_frames(self, theta: ArrayLike) -> np.ndarray:
        """Poses of the frames fixed to the links, in the space frame. theta (..., n) -> (..., n, 4, 4).

        Frame i has its z along joint axis i, its x along the common normal to axis i + 1 (as modified DH),
        and at theta = 0 its origin at `places[i]`. Link n carries the tool, so the last frame is the tool
        frame: link_frames(theta)[..., -1, :, :] is fk(theta).
        """
        theta = checks.joint_angles(theta, self.n, self.name)
        F = _identities((theta.size // self.n, self.n))
        for block, angles in self._blocks(theta):
            for i, frame in enumerate(self.links.along(angles)):
                F[block, min(i, self.n - 1), :3] = frame.T  # in the last place the tool follows joint n
        return F.reshape(*theta.shape[:-1], self.n, 4, 4)

    def displacements(self, theta: ArrayLike) -> np.ndarray:
        """How each link moved from where it stands at theta = 0: e^[S_1]theta_1 ... e^[S_i]theta_i.

        theta (..., n) -> (..., n, 4, 4). A point p of link i (space frame, theta = 0) is now at D_i p.
        """
        at_zero = self.links.at_zero[:-1].copy()
        at_zero[-1] = self.M
        return self.link_frames(theta) @ lie.inverse(at_zero)

    def _blocks(self, theta: np.ndarray) -> Iterator[tuple[slice, np.ndarray]]:
        """theta (..., n) in blocks that fit the cache: which configurations, and their angles (n, N)."""
        flat = theta.reshape(-1, self.n)
        for start in range(0, len(flat), CHUNK):
            block = slice(start, start + CHUNK)
            yield block, flat[block].T

    # -- Jacobians -------------------------------------------------------------------------------------------

    def jacobian_space(self, theta: ArrayLike) -> np.ndarray:
        """J_s: V_s = J_s thetadot, both in the space frame. theta (..., n) -> (..., 6, n), rows (omega; v).

        Column i is Ad(e^[S_1]theta_1 ... e^[S_{i-1}]theta_{i-1}) S_i (eq. 5.11): the screw of joint i where
        the joints before it have carried it.

        >>> from coursekit import robots
        >>> robot = robots.planar_2r()
        >>> bool(np.all(robot.jacobian_space([0, 0]) == robot.S))
        True
        """
        return self._jacobian(theta, about_tool=False)

    def jacobian_body(self, theta: ArrayLike) -> np.ndarray:
        """J_b: V_b = J_b thetadot, in the tool frame. theta (..., n) -> (..., 6, n), rows (omega; v).

        J_b = Ad(T^-1) J_s (eq. 5.22).
        """
        return lie.adjoint(lie.inverse(self.fk(theta))) @ self.jacobian_space(theta)

    def jacobian_geometric(self, theta: ArrayLike) -> np.ndarray:
        """Angular velocity and velocity of the tool point, both along the base axes.

        theta (..., n) -> (..., 6, n), rows (w; v): v = v_s + w x p moves the reference point of the space
        Jacobian to the tool point p.
        """
        return self._jacobian(theta, about_tool=True)

    def _jacobian(self, theta, about_tool):
        """The joints' screws where they are now, seen from the origin or from the tool point."""
        theta = checks.joint_angles(theta, self.n, self.name)
        J = np.empty((theta.size // self.n, 6, self.n))
        for block, angles in self._blocks(theta):
            screws, (_, _, _, p) = self.links.screws(angles)
            if about_tool:  # v = v_s + w x p
                screws[3:] += axes.cross(screws[:3], p[:, None])
            J[block] = screws.transpose(2, 0, 1)
        return J.reshape(*theta.shape[:-1], 6, self.n)

    # -- limits ----------------------------------------------------------------------------------------------

    def within_limits(self, theta: ArrayLike) -> np.ndarray:
        """Whether every joint can be brought inside its limits. theta (..., n) -> bool (...).

        A revolute joint may be turned by whole turns first: theta and theta +- 2 pi are the same attitude of
        the link, and a joint that can reach one of them can reach it. A limit missed by less than 1e-9 rad
        (or m) is kept: angles that come out of a computation are no better than that. NaN is outside.

        >>> from coursekit import robots
        >>> s030 = robots.kawasaki_s030()       # joint 2: -50 to 195 deg
        >>> bool(s030.within_limits(np.radians([180, -174.72, 23.12, 0, 180, 0])))
        True
        """
        return np.all(self.inside(theta), axis=-1)

    def inside(self, theta: ArrayLike) -> np.ndarray:
        """Whether each joint can be brought inside its limits. theta (..., n) -> bool (..., n)."""
        return self._between_limits(self.nearest_turn(theta))

    def nearest_turn(self, theta: ArrayLike) -> np.ndarray:
        """theta with revolute joints turned by whole turns into their limits where that is possible.

        theta (..., n) -> (..., n). A joint that no whole turn brings inside keeps its angle.
        """
        theta = checks.joint_angles(theta, self.n, self.name)
        below, above = self.q_min - AT_LIMIT - theta, theta - self.q_max - AT_LIMIT
        turns = np.ceil(np.maximum(below, 0) / (2 * np.pi)) - np.ceil(np.maximum(above, 0) / (2 * np.pi))
        turned = theta + 2 * np.pi * turns
        revolute = np.array([kind == "revolute" for kind in self.joint_types])
        return np.where(revolute & self._between_limits(turned), turned, theta)

    def _between_limits(self, theta):
        return (self.q_min - AT_LIMIT <= theta) & (theta <= self.q_max + AT_LIMIT)


def _identities(batch):
    T = np.empty((*batch, 4, 4))
    T[..., 3, :] = 0, 0, 0, 1
    return T
