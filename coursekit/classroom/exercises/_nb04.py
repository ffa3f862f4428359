"""The arm of the exam, exercise 1: what `theta2_system` is asked with, and by how much an answer misses."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercises._arm import mm

NONE = 1e-6  # metres: less is rounding
S030 = (0.15, 0.68, 0.87, 1.08)  # a1, d1, a2, d4


def _wrist_centre(theta, lengths):
    a1, d1, a2, d4 = lengths
    t1, t2, t3 = theta
    out = a1 + a2 * np.cos(t2) + d4 * np.sin(t2 + t3)
    up = d1 + a2 * np.sin(t2) - d4 * np.cos(t2 + t3)
    return np.array([np.cos(t1) * out, np.sin(t1) * out, up])


def reached(rng, front=True, folded=False):
    """P, theta_1, theta_3 and the lengths of an arm built like the S030; behind: it bends backwards."""
    while True:
        lengths = rng.uniform([0.1, 0.4, 0.6, 0.8], [0.3, 0.8, 0.9, 1.2])
        t1, t2 = rng.uniform(-3, 3), rng.uniform(-3, 3)
        t3 = rng.uniform(1.8, 2.8) if folded else rng.choice([-1, 1]) * rng.uniform(0.2, 1.2)
        p = _wrist_centre((t1, t2, t3), lengths)
        out = p[0] * np.cos(t1) + p[1] * np.sin(t1)
        if (out > 0.2) == front and abs(out) > 0.2 and abs(p[2] - lengths[1]) > 0.1:
            return p, t1, t3, lengths


def beside(rng):
    """P straight beside axis 1: p_x is 0, and theta_1 a right angle."""
    p, t1, t3, lengths = reached(rng)
    side = rng.choice([-1, 1])
    out = p[0] * np.cos(t1) + p[1] * np.sin(t1)
    return [0.0, side * out, p[2]], side * np.pi / 2, t3, lengths


def turned(rng):
    p, t1, t3, lengths = reached(rng)
    return p, t1 + 2 * np.pi, t3 - 2 * np.pi, lengths


def the_exam(rng):
    return [1.23, 0.0, 1.55], 0.0, 0.0, S030


def whole_exam(rng):
    a1, d1, a2, more = (int(n) for n in rng.integers(1, 5, 4))
    return [a1 + a2 + more, 0, d1 + a2], 0, 0, [a1, d1, a2, a2 + more]


def misses_p(args, value, right):
    p, theta1, theta3, lengths = args
    if not np.isfinite(value):
        return ""
    gap = np.linalg.norm(_wrist_centre((theta1, value, theta3), lengths) - p)
    return f"put back into p = f(theta), your angle misses P by {mm(gap)}" if gap > NONE else ""
