"""What was done to the right answer: transposed, negated, in degrees, two rows exchanged, a constant factor.

Each transform is tried on the right answers of all examples at once; the first that gives the student's is
the mistake, whatever the code looks like.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np

from . import compare
from .exercise import Exercise

Parts = tuple[np.ndarray, ...]


def done_to_the_right_answer(exercise: Exercise, examples: list, answers: list[Parts]) -> str:
    """'' or the sentence that says what was done; it holds on every example."""
    if _all(exercise, examples, answers, _cut) and any(map(_has_decimals, examples)):
        return "your decimals are cut off: an array of whole numbers (dtype int) cannot hold them"
    if same := _all_alike(exercise, examples, answers):
        return same
    wrong = [k for k, (e, a) in enumerate(zip(examples, answers, strict=True)) if not e.agrees(a)]
    for text, transform in _transforms(exercise, examples, answers, wrong[0]):
        if _all(exercise, examples, answers, transform):
            return text
    return ""


def _all(exercise: Exercise, examples: list, answers: list[Parts], transform: Callable) -> bool:
    """Does it give the student's answer on every example?"""
    with np.errstate(all="ignore"):
        try:
            done = [transform(example.right) for example in examples]
        except (ValueError, IndexError, np.linalg.LinAlgError):
            return False
    return all(map(_same(exercise), examples, answers, done))


def _has_decimals(example) -> bool:
    return any(np.any(part != np.trunc(part)) for part in example.right)


def _same(exercise: Exercise) -> Callable:
    """Within the tolerance, which grows with the numbers: a degree is 57 times a radian."""

    def same(example, mine: Parts, done: Parts) -> bool:
        return len(mine) == len(done) and all(
            bool(np.isfinite(b).all())
            and compare.same(
                kind, a, b, np.asarray(example.tol) * max(1.0, float(np.max(np.abs(b), initial=0)))
            )
            for kind, a, b in zip(exercise.kinds, mine, done, strict=True)
        )

    return same


def _all_alike(exercise: Exercise, examples: list, answers: list[Parts]) -> str:
    """Answers that do not depend on the arguments."""
    if all(not np.any(part) for parts in answers for part in parts):
        return "your answer is zero, whatever the arguments"
    first = answers[0]
    alike = all(
        a.shape == b.shape and np.array_equal(a, b)
        for parts in answers
        for a, b in zip(first, parts, strict=True)
    )
    differ = any(
        a.shape != b.shape or not np.allclose(a, b)
        for example in examples
        for a, b in zip(examples[0].right, example.right, strict=True)
    )
    return "your answer is always the same, whatever the arguments" if alike and differ else ""


# ---- transforms of one array, and the shapes they can happen to


def _square(x):
    return x.ndim >= 2 and x.shape[-1] == x.shape[-2]


def _pose(x):
    return x.shape[-2:] == (4, 4)


def _twists(x):
    return x.shape[:1] == (6,)


def _of_position(change: Callable) -> Callable:
    def transform(T):
        T = T.copy()
        T[..., :3, 3] = change(T[..., :3, 3])
        return T

    return transform


def _of_rotation(change: Callable) -> Callable:
    def transform(T):
        T = T.copy()
        T[..., :3, :3] = change(T[..., :3, :3])
        return T

    return transform


def _of_rows(rows: slice, change: Callable) -> Callable:
    def transform(x):
        x = x.copy()
        x[rows] = change(x[rows])
        return x

    return transform


def _turned(T):
    return np.swapaxes(T, -1, -2)


UPPER, LOWER = np.s_[:3], np.s_[3:]
ONE = (  # (what was done, to which arrays it can be done, how)
    ("your answer is the inverse of the right one", _pose, np.linalg.inv),
    ("your answer is the transpose of the right one", lambda x: x.ndim >= 2, _turned),
    ("your rotation is the transpose of the right one; the position is right", _pose, _of_rotation(_turned)),
    ("your position has the opposite sign; the rotation is right", _pose, _of_position(np.negative)),
    ("every sign is the opposite of what it should be", lambda x: True, np.negative),
    ("rows are (omega; v): your two halves are swapped", _twists, lambda x: np.roll(x, 3, axis=0)),
    ("the upper rows have the opposite sign; the lower are right", _twists, _of_rows(UPPER, np.negative)),
    ("the lower rows have the opposite sign; the upper are right", _twists, _of_rows(LOWER, np.negative)),
    ("the columns are in reverse order", lambda x: x.ndim == 2, np.fliplr),
    ("the rows are in reverse order", lambda x: x.ndim >= 2, lambda x: x[::-1]),
    ("your numbers are in reverse order", lambda x: x.ndim == 1, lambda x: x[::-1]),
    ("right numbers in a wrong order: the array was reshaped where it should be transposed",
     lambda x: x.ndim == 2, lambda x: np.ascontiguousarray(x.T).reshape(x.shape)),
    ("lengths are in metres: yours are in millimetres", _pose, _of_position(lambda p: 1000 * p)),
    ("lengths are in metres: your lower rows are in millimetres",
     _twists, _of_rows(LOWER, lambda v: 1000 * v)),
    ("your answer is 1000 times too large: lengths are in metres", lambda x: True, lambda x: 1000 * x),
    ("your answer is 1000 times too small", lambda x: True, lambda x: x / 1000),
    ("your answer is in degrees; radians are expected", lambda x: True, np.degrees),
    ("your answer is pi / 180 times the right one: degrees and radians are mixed up",
     lambda x: True, np.radians),
    ("your answer is the square of the right one: a root is missing", lambda x: True, np.square),
    ("your answer is the root of the right one", lambda x: True, np.sqrt),
    ("your answer is 1 over the right one: it stands upside down", lambda x: True, lambda x: 1 / x),
    ("your answer is the opposite: True where False belongs", lambda x: set(np.unique(x)) <= {0.0, 1.0},
     lambda x: 1 - x),
    ("your answer has lost its sign: it is never negative", lambda x: True, np.abs),
    ("your answer is off by half a turn (pi)", lambda x: True, lambda x: x + np.pi),
    ("your answer is off by half a turn (pi)", lambda x: True, lambda x: x - np.pi),
    ("your answer is off by a quarter turn (pi / 2)", lambda x: True, lambda x: x + np.pi / 2),
    ("your answer is off by a quarter turn (pi / 2)", lambda x: True, lambda x: x - np.pi / 2),
    ("your answer and the right one add up to pi", lambda x: True, lambda x: np.pi - x),
    ("your answer and the right one add up to pi / 2", lambda x: True, lambda x: np.pi / 2 - x),
)  # fmt: skip
WHOLE_TURN = tuple(
    ("your answer is off by a whole turn (2 pi)", lambda x: True, change)
    for change in (lambda x: x + 2 * np.pi, lambda x: x - 2 * np.pi)
)


def _of_one(kind: str) -> tuple:
    """What may have been done to an array that is compared so: among angles a whole turn is no difference."""
    return ONE if kind in ("angle", "set") else ONE + WHOLE_TURN


def _transforms(exercise: Exercise, examples: list, answers: list, k: int) -> Iterator[tuple[str, Callable]]:
    """(text, transform of all parts), the likely ones first; k is an example that is wrong."""
    right, mine = examples[k].right, answers[k]
    for text, applies, change in _of_one(exercise.kinds[0]):
        fits = [applies(part) for part in right]
        if any(fits):
            yield text, _on(fits, change)
    if exercise.several:
        names = _names(exercise)
        plural = {block.text for block in exercise.blocks if block.plural}
        for i, j in itertools.combinations(range(len(right)), 2):
            yield f"{names[i]} and {names[j]} have changed places", _exchange_parts(i, j)
        for i, name in enumerate(names):
            for text, applies, change in _of_one(exercise.kinds[i]):
                if applies(right[i]) and not text.startswith("your answer is the opposite"):
                    said = text.replace("your answer", name).replace(
                        "every sign is", f"{name} has a sign that is"
                    )
                    said = said.replace(" is ", " are ", 1) if name in plural else said
                    yield f"{said}; the rest is right", _on([p == i for p in range(len(right))], change)
        return
    yield from _rearranged(exercise, right[0], mine[0])
    yield from _scaled(exercise, examples, answers)
    yield from _of_entries(exercise, right[0], mine[0])
    if (digits := _digits(mine)) is not None:
        yield "your numbers are rounded: give them as they are", _rounded(digits)


def _on(fits: list[bool], change: Callable) -> Callable:
    return lambda parts: tuple(change(p) if fit else p for p, fit in zip(parts, fits, strict=True))


def _names(exercise: Exercise) -> list[str]:
    named = {block.part: block.text for block in reversed(exercise.blocks) if block.index is ...}
    return [named.get(i, f"result {i + 1}") for i in range(len(exercise.shapes))]


def _exchange_parts(i: int, j: int) -> Callable:
    def transform(parts):
        parts = list(parts)
        parts[i], parts[j] = parts[j], parts[i]
        return tuple(parts)

    return transform


def _cut(parts):
    return tuple(np.trunc(part) for part in parts)


def _digits(mine: Parts) -> int | None:
    """How many digits behind the point the student's own numbers have, None if they have many."""
    return next(
        (d for d in range(9) if all(np.allclose(p, np.round(p, d), rtol=0, atol=1e-12) for p in mine)), None
    )


def _rounded(digits: int) -> Callable:
    return lambda parts: tuple(np.round(part, digits) for part in parts)


def _rearranged(exercise: Exercise, right: np.ndarray, mine: np.ndarray) -> Iterator[tuple[str, Callable]]:
    """Rows, columns or entries that have changed places, as this example shows it."""
    if right.shape != mine.shape:
        return
    for axis, word in enumerate(
        ("rows", "columns") if right.ndim == 2 else ("entries",) if right.ndim == 1 else ()
    ):
        a, b = np.moveaxis(mine, axis, 0), np.moveaxis(right, axis, 0)
        order = _order(a, b)
        if order is not None:
            moved = [i for i, k in enumerate(order) if i != k]
            word = word if exercise.shapes[0][axis] is not None else f"{word} of the first examples"
            which = f"{word} {' and '.join(map(str, moved))}" if len(moved) == 2 else f"the {word}"
            yield (
                f"{which} have changed places (counted from 0)"
                if len(moved) == 2
                else f"{which} stand in another order",
                _permuted(order, axis),
            )


def _order(a: np.ndarray, b: np.ndarray) -> list[int] | None:
    """order with a[i] = b[order[i]], every row once; None if there is none but the plain one."""
    order: list[int] = []
    for row in a:
        near = [k for k in range(len(b)) if k not in order and np.allclose(row, b[k], rtol=0, atol=1e-6)]
        if not near:
            return None
        order.append(near[0])
    return None if order == sorted(order) else order


def _permuted(order: list[int], axis: int) -> Callable:
    return lambda parts: tuple(np.take(p, order, axis=axis) for p in parts)


def _scaled(exercise: Exercise, examples: list, answers: list) -> Iterator[tuple[str, Callable]]:
    """One factor, or one shift, that is the same in all examples."""
    sizes = [np.vdot(e.right[0], e.right[0]) for e in examples]
    k = int(np.argmax(sizes))
    right, mine = examples[k].right[0], answers[k][0]
    if right.shape != mine.shape or not np.isfinite(mine).all() or sizes[k] == 0:
        return
    factor = float(np.vdot(right, mine) / sizes[k])
    if abs(factor) > 1e-9 and f"{factor:.4g}" != "1":
        times = _times(factor)
        yield f"your answer is {times} the right one", lambda parts: tuple(factor * p for p in parts)
    shift = float(np.mean(mine - right))
    if abs(shift) > np.max(examples[k].tol):
        yield f"your answer is off by {shift:+.4g}, always", lambda parts: tuple(p + shift for p in parts)


def _times(factor: float) -> str:
    for number, word in (
        (2, "twice"),
        (0.5, "half"),
        (-1, "minus"),
        (-2, "minus twice"),
        (-0.5, "minus half"),
    ):
        if abs(factor - number) < 1e-6:
            return word
    return f"{factor:.4g} times"


def _of_entries(exercise: Exercise, right: np.ndarray, mine: np.ndarray) -> Iterator[tuple[str, Callable]]:
    """Signs of single entries, rows or columns; several angles off by half a turn."""
    if right.shape != mine.shape or None in exercise.shapes[0]:
        return
    for word, change in (
        ("the opposite sign", np.negative),
        ("half a turn (pi) too much", lambda x: x + np.pi),
    ):
        if exercise.kinds[0] not in ("angle", "set") and "turn" in word:
            continue
        wrong = ~compare.mask(exercise.kinds[0], mine, right, 1e-6)
        if exercise.kinds[0] == "set" or not 0 < np.count_nonzero(wrong) < max(right.size, 2):
            continue
        yield (
            f"{entries(wrong)} {'has' if np.count_nonzero(wrong) == 1 else 'have'} {word}; the rest is right",
            lambda parts, wrong=wrong, change=change: (np.where(wrong, change(parts[0]), parts[0]),),
        )


def entries(wrong: np.ndarray, most: int = 4) -> str:
    """ "entry [1, 2]", "row 2", "columns 0 and 3", "5 entries": where a mask is True, in few words."""
    if wrong.ndim == 2:
        for axis, word in ((1, "row"), (0, "column")):
            whole = np.flatnonzero(wrong.all(axis=axis))
            if len(whole) and np.count_nonzero(wrong) == len(whole) * wrong.shape[axis]:
                return _list(word, [str(k) for k in whole])
    found = [", ".join(map(str, index)) for index in np.argwhere(wrong)]
    if len(found) <= most:
        return _list("entry", [f"[{index}]" for index in found])
    return f"{len(found)} of {wrong.size} entries"


def _list(word: str, items: list[str]) -> str:
    if len(items) == 1:
        return f"{word} {items[0]}"
    plural = "entries" if word == "entry" else word + "s"
    return f"{plural} {', '.join(items[:-1])} and {items[-1]}"
