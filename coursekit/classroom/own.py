"""An arm of one's own: no two students have the same lengths, directions and signs.

A release for a roster puts `student.json` into every student's folder; what is drawn, tabulated and asked
there follows from the seed in it. Without one (the shipped course, a browser, the tests) everybody has the
same practice arm. Functions that students write stay general: an arm's numbers reach them as arguments.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Iterator
from contextvars import ContextVar
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from coursekit.kinematics import singularity
from coursekit.kinematics.robot import Robot

FILE = "student.json"
NOBODY = 0  # the seed where no student is known

# What is drawn for an arm, in millimetres: least, most, step.
LENGTHS_MM = {
    "column": (300, 500, 5),  # floor to axis 2
    "shoulder": (20, 80, 5),  # axis 1 to axis 2, forwards
    "upper_arm": (380, 600, 5),  # axis 2 to axis 3
    "elbow": (20, 60, 5),  # axis 3 to axis 4, across the forearm
    "forearm": (380, 600, 5),  # axis 3 to the wrist centre, along the forearm
    "flange": (70, 120, 5),  # wrist centre to the tool frame
}
LIMITS_DEG = np.array([(-170, 170), (-130, 130), (-150, 150), (-185, 185), (-120, 120), (-350, 350)])
X, Y, Z = np.eye(3)
_using: ContextVar[int | None] = ContextVar("seed of the student whose arm is used", default=None)


@dataclass(frozen=True)
class Sheet:
    """What a drawing of the arm shows.

    lengths : {"column", "shoulder", "upper_arm", "elbow", "forearm", "flange"} in metres
    forward : "x" or "y", where the arm points to at zero
    upright : whether the upper arm stands upright at zero; else it lies forward, as the forearm does
    signs   : +1 or -1 for each joint: whether it turns about the axis of the drawing or the opposite one.
              The axes of the drawing: up; left (joints 2, 3 and 5); forward (joints 4 and 6)
    """

    seed: int
    lengths: dict[str, float]
    forward: str
    upright: bool
    signs: tuple[int, ...]

    @property
    def robot(self) -> Robot:
        """The arm: six hinges, spherical wrist, axes 2 and 3 parallel. Its home pose is regular."""
        size = self.lengths
        out = X if self.forward == "x" else Y
        left = np.cross(Z, out)
        axis2 = size["column"] * Z + size["shoulder"] * out
        axis3 = axis2 + size["upper_arm"] * (Z if self.upright else out)
        axis4 = axis3 + size["elbow"] * Z
        centre = axis4 + size["forearm"] * out
        M = np.eye(4)
        M[:3, :3] = np.column_stack([out, left, Z])  # its x leads out of the flange
        M[:3, 3] = centre + size["flange"] * out
        signs = np.array(self.signs)
        lower, upper = np.radians(np.sort(signs[:, None] * LIMITS_DEG, axis=1).T)
        bent = np.array([0, 0, 40, 0, 50, 0] if self.upright else [0, -60, 70, 0, 50, 0])
        return Robot.from_axes(
            signs[:, None] * np.array([Z, left, left, out, left, out]),
            [size["column"] * Z, axis2, axis3, axis4, centre, centre],
            M,
            name="practice arm" if self.seed == NOBODY else "your own arm",
            q_min=lower,
            q_max=upper,
            home=np.radians(signs * bent),
            source="drawn at random for one student" if self.seed else "made up for this course",
        )


def own_seed() -> int:
    """The number that a student's arm and own numbers follow from; 0 where no student is known.

    It stands in `student.json`, in the folder of the notebook or one above it. ValueError if that file is
    there and holds no seed.

    >>> from coursekit import classroom
    >>> classroom.own_seed()
    0
    """
    seed = _using.get()
    if seed is not None:
        return seed
    path = _file(Path.cwd())
    if path is None:
        return NOBODY
    try:
        seed = json.loads(path.read_text(encoding="utf-8"))["seed"]
    except (ValueError, KeyError, TypeError):
        seed = None
    if not isinstance(seed, int) or isinstance(seed, bool) or seed < 0:
        raise ValueError(f'{path} holds no "seed", a whole number: take the file from your release again')
    return seed


def own_arm() -> Robot:
    """The arm of the student in whose folder the notebook runs; elsewhere the practice arm, always the same.

    A 6R arm with a spherical wrist: every explorer and `ik.analytic` take it.

    >>> from coursekit import classroom
    >>> classroom.own_arm().name
    'practice arm'
    """
    return arm_of(own_seed())


def own_sheet() -> Sheet:
    """The same arm as a drawing would show it: lengths by name, directions, signs.

    >>> from coursekit import classroom
    >>> classroom.own_sheet().lengths["upper_arm"]
    0.535
    """
    return sheet_of(own_seed())


def seed_of(student: str) -> int:
    """The seed of a student's id: the same on every machine, and whoever else is in the class.

    >>> seed_of("s1001") == seed_of(" s1001"), seed_of("s1001") == seed_of("s1002")
    (True, False)
    """
    return int.from_bytes(hashlib.blake2b(student.strip().encode(), digest_size=5).digest(), "big") + 1


@contextlib.contextmanager
def using(seed: int | None) -> Iterator[None]:
    """Inside, `own_arm` and `own_seed` are those of this seed, wherever it runs; None changes nothing."""
    before = _using.set(_using.get() if seed is None else seed)
    try:
        yield
    finally:
        _using.reset(before)


def sheet_of(seed: int) -> Sheet:
    """What is drawn for a seed."""
    rng = np.random.default_rng([seed, 20261126])
    lengths = {
        name: int(rng.integers(0, (most - least) // step + 1)) * step / 1000 + least / 1000
        for name, (least, most, step) in LENGTHS_MM.items()
    }
    forward = "xy"[rng.integers(2)]
    upright = bool(rng.integers(2))
    signs = tuple(int(sign) for sign in rng.choice([-1, 1], 6))
    return Sheet(seed, {k: round(v, 3) for k, v in lengths.items()}, forward, upright, signs)


@lru_cache(maxsize=64)
def arm_of(seed: int) -> Robot:
    """The arm of a seed; ValueError if it were unfit: singular at home, or home outside its limits."""
    robot = sheet_of(seed).robot
    if singularity.classify(robot, robot.home, tol=0.05) or not robot.within_limits(robot.home):
        raise ValueError(f"the arm of seed {seed} is unfit to work with: report it, with the seed")
    return robot


def _file(folder: Path) -> Path | None:
    return next((path for up in (folder, *folder.parents) if (path := up / FILE).is_file()), None)
