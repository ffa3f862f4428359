"""Matrices whose singular values are known, for the exercises of notebook 04 about them."""

from __future__ import annotations

import numpy as np


def orthogonal(rng, n=6):
    return np.linalg.qr(rng.normal(size=(n, n)))[0]


def matrix(rng, sigma, columns=6):
    """6 rows, these singular values."""
    U, V = orthogonal(rng), orthogonal(rng, columns)
    n = len(sigma)
    return U[:, :n] @ np.diag(sigma) @ V[:n]


def nearly_singular(rng, size=1, lost=None, small=None, columns=6):
    """Singular values of which `lost` are nothing but rounding; one may be small and still counts."""
    sigma = rng.uniform(0.3, 2, min(columns, 6))
    lost = rng.integers(0, 3) if lost is None else lost
    if small or (small is None and rng.integers(2)):
        sigma[-1] = 1e-4 * sigma[0]
    sigma[:lost] = 2e-8 * sigma.max()
    return size * matrix(rng, sigma, columns), 1e-6


def limit_met(rng):
    """Nothing is larger than 1 times the largest, which no rounding hides: each column has one entry."""
    sigma = rng.choice([-1, 1], 6) * [4, 2, 1, 1, 0.5, 0.25]
    return rng.permutation(np.diag(sigma)), 1.0


def coarse(rng):
    """The fourth, 0.5, is above 0.2 times the largest, but below 0.2 times the root of the sum of squares."""
    return matrix(rng, [2, 1.5, 1, 0.5, 0.1, 0.02]), 0.2


def fine(rng):
    return matrix(rng, [2, 1.5, 1, 0.3, 1e-7, 1e-14]), 1e-10


def finest(rng):
    """Two just above the limit, two below: squares of them are lost in the rounding of the largest's."""
    return matrix(rng, [2, 1.5, 1e-9, 8e-10, 1e-11, 5e-12]), 1e-10


def nilpotent(rng):
    """Nor does the diagonal of a QR of it, or of its transpose, tell its rank."""
    above, below = (np.diag([a, b], side) for side, (a, b) in ((1, rng.uniform(0.5, 2, 2)), (-1, (1.2, 0.7))))
    nothing = np.zeros((3, 3))
    return np.block([[above, nothing], [nothing, below]]), 1e-6


def pivots_of_one(rng, idle=0):
    """Every pivot is 1, and what is left of a column or a row no less: two motions are lost all the same."""
    J, nothing = np.eye(3) - np.triu(np.ones((3, 3)), 1), np.zeros((3, 3))
    rows, columns = rng.choice([-1, 1], (2, 6))
    J = rows[:, None] * np.block([[J, nothing], [nothing, J.T]]) * columns
    return np.hstack([np.zeros((6, idle)), J]), 0.3


def whole(rng):
    J = np.eye(6, 6, dtype=int) + np.eye(6, k=1, dtype=int) * rng.integers(1, 4)
    J[4:] = J[:2]
    return J, 1e-6


def counted(args, value, right):
    J, tol = args
    sigma = np.linalg.svd(J)[1]
    shown = ", ".join(f"{s / sigma[0]:.2g}" for s in sigma)
    return (
        f"divided by the largest, the singular values of one example are {shown}; "
        f"{right:.0f} of them are above tol = {tol:g}, you return {value:g}"
    )
