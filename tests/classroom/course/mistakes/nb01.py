from __future__ import annotations

from pathlib import Path

import numpy as np

from coursekit.classroom.course import Course
from coursekit.classroom.mistakes import Solved

HERE = Path(__file__).resolve().parents[1]
right = Solved("nb01", Course(HERE / "notebooks", HERE))


def ik_swapped(p, l1, l2):
    return right.ik(p[::-1], l1, l2)


def ik_double(p, l1, l2):
    both = right.ik_all(p, l1, l2)
    return np.vstack([both, both[:1]])


WRONG = {
    "fk": {
        "degrees": lambda theta, l1, l2: right.fk(np.radians(theta), l1, l2),
        "absolute": lambda theta, l1, l2: right.fk([theta[0], theta[1] - theta[0]], l1, l2),
        "swapped": lambda theta, l1, l2: right.fk(theta, l1, l2)[::-1],
    },
    "jacobian": {"first_row": lambda theta, l1, l2: right.jacobian(theta, l1, l2) * [[-1], [1]]},
    "ik": {"atan_swapped": ik_swapped},
    "ik_all": {"one_only": lambda p, l1, l2: right.ik_all(p, l1, l2)[:1], "double": ik_double},
}
