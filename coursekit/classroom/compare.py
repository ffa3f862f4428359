"""Is this answer that answer? One definition behind the student's check and the grader.

An answer is compared entry by entry, after what is free has been taken out of it: whole turns of an angle,
the sign of a vector, the order of the rows of a set. What remains is a mask, an array of the answer's shape
that is True where it is right; an answer is right where its mask is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

TURN = 2 * np.pi


def mask(kind: str, answer: np.ndarray, right: np.ndarray, tol: ArrayLike) -> np.ndarray:
    """Which entries of an answer are right.

    Parameters
    ----------
    kind : one of `exercise.KINDS`; "any_solution" is compared like "close"
    answer, right : arrays of the same shape; NaN agrees with NaN
    tol : the largest difference that counts as none, a number or an array that broadcasts to the shape

    ValueError if the shapes differ.

    >>> import numpy as np
    >>> mask("angle", np.array([0.1, 0.2]), np.array([0.1 + 2 * np.pi, 0.3]), 1e-6).tolist()
    [True, False]
    >>> mask("set", np.array([0.2, 0.1]), np.array([0.1, 0.3]), 1e-6).tolist()
    [False, True]
    """
    if answer.shape != right.shape:
        raise ValueError(f"shapes {answer.shape} and {right.shape} cannot be compared")
    if kind == "turn" and abs(np.linalg.norm(right) - np.pi) <= np.max(tol):
        kind = "up_to_sign"
    if kind == "up_to_sign":
        return max((_near(sign * answer, right, tol) for sign in (1, -1)), key=np.count_nonzero)
    if kind == "columns_up_to_sign":
        signs = np.where(np.sum(answer * right, axis=0) < 0, -1.0, 1.0)
        return _near(signs * answer, right, tol)
    if kind == "set":
        return _rows_in_any_order(answer, right, tol)
    return _near(answer, right, tol, cyclic=kind == "angle")


def same(kind: str, answer: np.ndarray, right: np.ndarray, tol: ArrayLike) -> bool:
    """Is the whole answer right?"""
    if answer.shape != right.shape:
        return False
    if kind == "set":  # no row has to be seated that agrees in part only
        agree = _rows_agree(answer, right, tol).all(axis=-1)
        return bool(agree.any(axis=1).all()) and len(_pair_up(agree)) == len(agree)
    return bool(mask(kind, answer, right, tol).all())


def _near(answer, right, tol, cyclic=False):
    with np.errstate(invalid="ignore"):
        gap = answer - right
        if cyclic:
            gap = (gap + np.pi) % TURN - np.pi
        return (np.abs(gap) <= tol) | (np.isnan(answer) & np.isnan(right)) | (answer == right)


def _rows_agree(answer, right, tol):
    """Entry by entry, every row with every other: (mine, theirs, entries). A number is a row of one."""
    rows = (len(answer), answer.shape[1] if answer.ndim > 1 else 1)
    return _near(answer.reshape(rows)[:, None], right.reshape(rows)[None], tol, cyclic=True)


def _rows_in_any_order(answer, right, tol):
    """Every row takes the free row of `right` that it agrees with best: whole rows first, then parts."""
    agree = _rows_agree(answer, right, tol)
    found = np.zeros((len(answer), agree.shape[2]), bool)
    score = agree.sum(axis=-1)
    partner = _pair_up(agree.all(axis=-1))
    free = set(range(len(right))) - set(partner.values())
    for row in np.argsort(-score.max(axis=1, initial=0), kind="stable"):
        if row not in partner:
            partner[row] = max(sorted(free), key=lambda other: score[row, other])
            free.discard(partner[row])
        found[row] = agree[row, partner[row]]
    return found.reshape(answer.shape)


def _pair_up(agree: np.ndarray) -> dict[int, int]:
    """{row: its partner}, for as many rows as can have one of their own. agree : (mine, theirs), truths"""
    candidates = [np.flatnonzero(row).tolist() for row in agree]
    taken: dict[int, int] = {}

    def seat(row: int, seen: set) -> bool:
        for partner in candidates[row]:
            if partner not in seen:
                seen.add(partner)
                if partner not in taken or seat(taken[partner], seen):
                    taken[partner] = row
                    return True
        return False

    for row in range(len(candidates)):
        seat(row, set())
    return {row: partner for partner, row in taken.items()}
