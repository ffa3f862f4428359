"""Is this answer that answer? One definition behind the student's check (hashed) and the grader (numbers).

Each kind of comparison turns an answer into features, numbers that are equal exactly where two answers
count as the same: the entries themselves, angles on their circle, or v v^T for a vector whose sign is free.
Features are then either compared within a tolerance, or rounded to bins and hashed, so that a table of right
answers can ship without one readable number.
"""

from __future__ import annotations

import hashlib
import itertools

import numpy as np

TURN = 2 * np.pi


def features(kind: str, value: np.ndarray) -> tuple[np.ndarray, bool]:
    """(k,) or, for a set, (rows, k) numbers, and whether they are angles."""
    if kind == "set":
        return np.atleast_2d(value), True
    if kind in ("up_to_sign", "columns_up_to_sign"):
        columns = value[:, None] if value.ndim == 1 else value
        upper = np.triu_indices(len(columns))
        return np.einsum("ik,jk->ijk", columns, columns)[upper].ravel(), False
    return value.ravel(), kind == "angle"


def same(kind: str, a: np.ndarray, b: np.ndarray, tol: float) -> bool:
    """Do two answers agree within 2 tol, the most that the hashed comparison accepts?"""
    if a.shape != b.shape:
        return False
    x, cyclic = features(kind, a)
    y, _ = features(kind, b)
    if kind != "set":
        return bool(np.all(_near(x, y, cyclic, tol)))
    return _pair_up([np.flatnonzero(np.all(_near(row, y, cyclic, tol), axis=-1)) for row in x], len(y))


def _near(x, y, cyclic, tol):
    with np.errstate(invalid="ignore"):
        gap = x - y
        if cyclic:
            gap = (gap + np.pi) % TURN - np.pi
        return (np.abs(gap) <= 2 * tol) | (np.isnan(x) & np.isnan(y)) | (x == y)


def _pair_up(candidates: list, count: int) -> bool:
    """Can every row take a partner of its own?"""
    taken: dict[int, int] = {}

    def seat(row: int, seen: set) -> bool:
        for partner in candidates[row]:
            if partner not in seen:
                seen.add(partner)
                if partner not in taken or seat(taken[partner], seen):
                    taken[partner] = row
                    return True
        return False

    return len(candidates) == count and all(seat(row, set()) for row in range(count))


# ---- the same comparison with one side hashed


def fingerprint(kind: str, value: np.ndarray, tol: float, salt: str) -> dict:
    """What the sample table stores of an answer: shape, salted hashes of features (of rows for a set)."""
    x, cyclic = features(kind, value)
    if kind == "set":
        hashes = sorted(_hash(salt, " ".join(_bins(row, cyclic, tol))) for row in x)
    else:
        hashes = [_hash(f"{salt}/{i}", b) for i, b in enumerate(_bins(x, cyclic, tol))]
    return {"shape": list(value.shape), "hashes": " ".join(hashes)}


def matches(kind: str, value: np.ndarray, tol: float, salt: str, stored: dict) -> bool:
    """Does the value's fingerprint, or that of a neighbouring bin, stand in the table?

    A feature belongs to bin k = round(x / tol). Bins k - 1 and k + 1 are accepted too: two answers nearer
    than tol always agree, however the rounding falls; two that are farther apart than 2 tol never do.
    """
    if list(value.shape) != stored["shape"]:
        return False
    x, cyclic = features(kind, value)
    wanted = stored["hashes"].split()
    if kind != "set":
        return all(
            any(_hash(f"{salt}/{i}", b) == wanted[i] for b in _bins_around(number, cyclic, tol))
            for i, number in enumerate(x)
        )
    return _pair_up([_rows_around(row, cyclic, tol, salt, wanted) for row in x], len(wanted))


def _rows_around(row, cyclic, tol, salt, wanted):
    around = [_bins_around(number, cyclic, tol) for number in row]
    hashes = {_hash(salt, " ".join(bins)) for bins in itertools.product(*around)}
    return [i for i, h in enumerate(wanted) if h in hashes]


def _bins_around(number: float, cyclic: bool, tol: float) -> list[str]:
    if not np.isfinite(number):
        return _bins([number], cyclic, tol)
    width = _width(cyclic, tol)
    return list(dict.fromkeys(_bin(round(number / width) + step, cyclic, tol) for step in (0, -1, 1)))


def _bins(numbers, cyclic, tol) -> list[str]:
    width = _width(cyclic, tol)
    return [_bin(round(x / width), cyclic, tol) if np.isfinite(x) else str(float(x)) for x in numbers]


def _bin(k: int, cyclic: bool, tol: float) -> str:
    return str(k % round(TURN / tol) if cyclic else k)


def _width(cyclic: bool, tol: float) -> float:
    return TURN / round(TURN / tol) if cyclic else tol  # a whole number of bins on the circle


def _hash(salt: str, text: str) -> str:
    return hashlib.sha256(f"{salt}:{text}".encode()).hexdigest()[:10]
