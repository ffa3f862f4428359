"""What is right already, in the words of the exercise: "the position is right, the rotation is not"."""

from __future__ import annotations

import numpy as np

from .exercise import JACOBIAN, POSE, Block, Exercise
from .transforms import entries

SHORT = 30  # words of a sentence that is read at once


def what_is_right(exercise: Exercise, examples: list, answers: list, good: list[bool]) -> list[str]:
    """Sentences that hold on all examples. `good`: which of them are right as a whole."""
    masks = [e.masks(parts) for e, parts in zip(examples, answers, strict=True)]
    everywhere = _blocks(exercise, masks) or _lines(exercise, masks) or _entries(exercise, masks)
    cases = _cases(examples, good)
    if cases and not everywhere:
        wrong = [m for m, fine in zip(masks, good, strict=True) if not fine]
        there = _blocks(exercise, wrong) or _lines(exercise, wrong) or _entries(exercise, wrong)
        both = f"{cases}; there {there}"
        return [both] if there and len(both.split()) <= SHORT else [cases, there and f"there {there}"]
    both = f"{everywhere}. It is {cases}"
    if cases and len(both.split()) <= SHORT:
        return [both]
    return [everywhere, cases and f"it is {cases}"]


def not_a_pose(matrix: np.ndarray) -> str:
    """'' or why this is no rotation (3, 3), or no pose (..., 4, 4)."""
    if matrix.shape[-2:] not in ((3, 3), (4, 4)):
        return ""
    R = matrix[..., :3, :3]
    lengths = np.linalg.norm(R, axis=-2)
    if not np.allclose(lengths, 1, atol=1e-6):
        return "the columns of a rotation have length 1; yours have not"
    if not np.allclose(np.swapaxes(R, -1, -2) @ R, np.eye(3), atol=1e-6):
        return "the columns of a rotation are perpendicular to each other; yours are not"
    if np.any(np.linalg.det(R) < 0):
        return "your rotation is left-handed (its determinant is -1): the sign of one column is wrong"
    if matrix.shape[-1] == 4 and not np.allclose(matrix[..., 3, :], [0, 0, 0, 1], atol=1e-9):
        return "the last row of a pose is 0 0 0 1"
    return ""


# ---- parts of the answer that are right on all examples


def blocks_of(exercise: Exercise) -> tuple[Block, ...]:
    """The parts of its answer that have a name."""
    shape = exercise.shapes[0]
    if exercise.blocks:
        return exercise.blocks
    if exercise.several:
        return tuple(Block(f"result {i + 1}", ..., i) for i in range(len(exercise.shapes)))
    if shape[-2:] == (4, 4):
        return POSE
    return JACOBIAN if shape == (6, None) else ()


def _blocks(exercise: Exercise, masks: list) -> str:
    blocks = blocks_of(exercise)
    fine = [all(taken(m[b.part], b).all() for m in masks) for b in blocks]
    good = [b for b, f in zip(blocks, fine, strict=True) if f]
    bad = [b for b, f in zip(blocks, fine, strict=True) if not f]
    good = [b for b in good if b.text != "the last row"]  # nobody is proud of that
    if not good or not bad:
        return ""
    if len(bad) == 1:
        detail = _entries_of(bad[0], masks)
        if len(good) > 2:  # rather the one that is wrong than a list of all that are right
            be = "are" if bad[0].plural else "is"
            return f"{bad[0].text} {be} wrong{detail}; the other {len(good)} parts of the answer are right"
        return f"{_said(good)} right, {bad[0].text} {'are' if bad[0].plural else 'is'} not{detail}"
    return f"{_said(good)} right; not so {_joined([b.text for b in bad])}"


def taken(mask: np.ndarray, block: Block) -> np.ndarray:
    """What a mask says of a block; false where there is no such place."""
    try:
        return np.asarray(mask[block.index])
    except IndexError:
        return np.zeros((), bool)


def _entries_of(block: Block, masks: list) -> str:
    """Which entries of a block are wrong, if they are few and the same on all examples."""
    shapes = {m[block.part].shape for m in masks}
    if len(shapes) != 1 or len(next(iter(shapes))) != 2:
        return ""
    chosen = np.zeros(next(iter(shapes)), bool)
    chosen[block.index] = True
    wrong = chosen & ~np.all([m[block.part] for m in masks], axis=0)
    few = np.count_nonzero(wrong) <= np.count_nonzero(chosen) / 2
    return f": look at {entries(wrong)} (counted from 0)" if few and chosen.sum() > 1 else ""


def _said(blocks: list[Block]) -> str:
    plural = len(blocks) > 1 or blocks[0].plural
    return f"{_joined([b.text for b in blocks])} {'are' if plural else 'is'}"


def _joined(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _lines(exercise: Exercise, masks: list) -> str:
    """Rows or columns counted from the ends, where their number differs from example to example."""
    if exercise.several:
        return ""
    shape = exercise.shapes[0]
    if "set" in exercise.kinds:
        return _rows_of_a_set(masks)
    if None not in shape:
        return ""
    axis = shape.index(None)
    word = {0: "pose" if shape[-2:] == (4, 4) else "row" if len(shape) > 1 else "entry", 1: "column"}[axis]
    fine = [np.moveaxis(m[0], axis, 0).reshape(m[0].shape[axis], -1).all(axis=1) for m in masks]
    fine = [f for f in fine if len(f) > 1]
    if not fine:
        return ""
    if all(not f[-1] and f[:-1].all() for f in fine):
        return f"only the last {word} is wrong"
    if all(not f[0] and f[1:].all() for f in fine):
        return f"only the first {word} is wrong"
    if all(f[0] and not f[1:].any() for f in fine):
        return f"the first {word} is right, none after it"
    if all(f[-1] and not f[:-1].any() for f in fine):
        return f"the last {word} is right, none before it"
    if all(f[0] for f in fine):
        return f"the first {word} is right, not all that follow"
    if all(f[-1] for f in fine):
        return f"the last {word} is right, not all before it"
    return ""


def _rows_of_a_set(masks: list) -> str:
    counts = {(int(m[0].reshape(len(m[0]), -1).all(axis=1).sum()), len(m[0])) for m in masks}
    if len(counts) == 1 and 0 < next(iter(counts))[0] < next(iter(counts))[1]:
        fine, rows = next(iter(counts))
        what = "rows" if masks[0][0].ndim > 1 else "numbers"
        return f"{fine} of your {rows} {what} {'is' if fine == 1 else 'are'} right"
    return ""


def _entries(exercise: Exercise, masks: list) -> str:
    """Single entries, rows, columns of an answer of fixed shape."""
    if exercise.several or None in exercise.shapes[0] or not exercise.shapes[0] or "set" in exercise.kinds:
        return ""
    wrong = ~np.all([m[0] for m in masks], axis=0)
    if wrong.shape == (4, 4) and not wrong[3].any():
        wrong = wrong[:3]  # the last row of a pose is right in any case
    if wrong.shape == (4, 4) and wrong[:3].all():  # nor is a part of it worth a word
        return ""
    if not 0 < np.count_nonzero(wrong) < wrong.size:
        return ""
    if np.count_nonzero(wrong) <= wrong.size / 2:
        return f"wrong: {entries(wrong)}; the rest is right (counted from 0)"
    return f"right: {entries(~wrong)}; the rest is not (counted from 0)"


# ---- cases


def _cases(examples: list, good: list[bool]) -> str:
    """ "right for a hinge, wrong for a slide": cases that are right, and those that are not."""
    names = list(dict.fromkeys(e.case for e in examples))
    fine = {n: [g for e, g in zip(examples, good, strict=True) if e.case == n] for n in names}
    right = [n for n in names if all(fine[n])]
    wrong = [n for n in names if not all(fine[n])]
    if not right or not wrong:
        return ""
    both = (("right", right), ("wrong", wrong))
    (few, these), (most, others) = sorted(both, key=lambda told: len(told[1]))  # the shorter list is enough
    rest = _joined(others) if len(others) < 3 else f"in the {len(others)} other cases"
    return f"{few} {_some(these)}, {most} {rest}"


def _some(names: list[str]) -> str:
    """Two of them, and that there are more."""
    return _joined(names) if len(names) < 4 else f"{names[0]}, {names[1]} and in {len(names) - 2} more cases"
