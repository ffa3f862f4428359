"""Two edits at once: the one that makes more of the answers right, and another that then makes all right.

All pairs would be far too many. But where two things are wrong, mending one of them often shows: entries of
the answer, or whole examples, become right that were not, and none becomes wrong. Such an edit stands while
the others are tried. Where pairs in several lines would do, nothing is told of them. Where none does, but one
edit makes a part of the answer right on all examples, that is told.
"""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..already import blocks_of, taken
from ..exercise import Block
from .lines import LineEdit
from .texts import sentence

if TYPE_CHECKING:
    from . import _Hit, _Search

BUDGET = 700_000  # executed lines, for each of the two steps
FIRST = 4  # edits that stand, one after the other: those that make most of the answers right


def two_edits(search: _Search) -> str:
    """ "look at line 4: a sign; and at line 6: an index", '' if there are no two such edits."""
    if search.counts:  # of a count nothing is right in part
        return ""
    if search.exercise.compare == "any_solution":  # entries of one right answer need not be those of another
        return ""
    if BUDGET // FIRST // search.cost < 2 * len(search.examples):  # too few trials to find anything
        return ""
    helpful = _that_help(search)
    pairs: dict[tuple, tuple[list[_Hit], list[_Hit]]] = {}
    for first in list({(hit.line, hit.gain): hit for hit in helpful[::-1]}.values())[::-1][:FIRST]:
        for second in _then(search, first):
            both = sorted([first, second], key=lambda hit: (hit.line, hit.kind, hit.what))
            ones, others = pairs.setdefault(tuple(hit.line for hit in both), ([], []))
            ones.append(both[0])
            others.append(both[1])
    if len(pairs) == 1:
        return _both(search, *pairs.popitem()[1])
    if pairs or None in search.exercise.shapes[0]:
        return ""
    return _of_a_part(search, [hit for hit in helpful if hit.rank == 0])


def _text(search: _Search, hits: list[_Hit]) -> str:
    line = hits[0].line and hits[0].line - search.first + 1
    return sentence(
        list(dict.fromkeys((hit.kind, hit.what) for hit in hits)), [line], search.body, search.owner()
    )


def _both(search: _Search, ones: list[_Hit], others: list[_Hit]) -> str:
    one, other = _text(search, ones), _text(search, others)
    if ones[0].line == others[0].line:
        (where, _, what), (_, _, more) = one.partition(": "), other.partition(": ")
        kinds = len({hit.kind for hit in ones + others})
        if kinds > 2:
            return f"{where}: two things in this line"
        return f"{where}: {what}, in two places" if kinds == 1 else f"{where}, two things: {what}, and {more}"
    return f"{one}; and at {other.removeprefix('look at ')}" if one and other else one or other


def _of_a_part(search: _Search, helpful: list[_Hit]) -> str:
    """The one line in which an edit makes a part of the answer right on all examples."""
    examples, search.left = search.examples, BUDGET // search.cost
    blocks = [block for block in blocks_of(search.exercise) if _varies(block, examples)]
    before = [_masks(search, search.box.compile(), example) for example in examples]
    found: dict[str, list[_Hit]] = {}
    for hit in helpful:
        if search._over():
            return ""  # another line might do as well
        with _standing(search, hit):
            function = _compiled(search)
            now = [_masks(search, function, example) for example in examples]
        if any(
            np.any(b & ~n)
            for was, is_ in zip(before, now, strict=True)
            for b, n in zip(was, is_, strict=True)
        ):
            continue
        for block in blocks:
            was, is_ = ([bool(taken(m[block.part], block).all()) for m in masks] for masks in (before, now))
            if all(is_) and was.count(False) > 1:
                found.setdefault(block.text, []).append(hit)
    for text, hits in found.items():
        if len({hit.line for hit in hits}) == 1 and (told := _text(search, hits)):
            be = "are" if next(b for b in blocks if b.text == text).plural else "is"
            return f"{told}; with that mended, {text} {be} right"
    return ""


def _varies(block: Block, examples: list) -> bool:
    """What is always zero becomes right by losing what it is made of: that would be no mending."""
    first, *others = [example.right[block.part][block.index] for example in examples]
    return bool(np.any(first)) and any(x.shape != first.shape or not np.allclose(x, first) for x in others)


def _that_help(search: _Search) -> list[_Hit]:
    """Edits with which more of the answers is right, and nothing of them wrong that was right; best first."""
    examples = search.examples[:6]
    search.left = BUDGET // search.cost
    function = search.box.compile()
    if any(search.answer(function, example) is None for example in examples):
        return []  # what makes an answer of none need not be what was meant
    before = [_mask(search, function, example) for example in examples]

    def gain(function: Callable) -> float:
        more = 0.0
        for example, old in zip(examples, before, strict=True):
            now = _mask(search, function, example)
            if np.any(old & ~now):
                return 0.0
            more += (np.count_nonzero(now) - np.count_nonzero(old)) / now.size
        return more

    search.judge = gain
    try:
        hits = [hit for _, hit in _likely(search, 2)]
    finally:
        search.judge = search._right
    best: dict[tuple, _Hit] = {}
    for hit in sorted(hits, key=lambda hit: (-hit.gain, hit.rank)):
        best.setdefault((hit.line, hit.kind, hit.gain), hit)
    return list(best.values())


def _then(search: _Search, first: _Hit) -> list[_Hit]:
    """The edits that make all of it right while the first one stands."""
    search.left = BUDGET // FIRST // search.cost
    found: list[_Hit] = []
    with _standing(search, first):
        for rank, hit in _likely(search, 3):
            if found and rank > min(hit.rank for hit in found):
                break
            found.append(hit)
    return [hit for hit in found if hit.rank == min(hit.rank for hit in found)]


@contextlib.contextmanager
def _standing(search: _Search, hit: _Hit) -> Iterator[None]:
    """This edit is made, whatever else is tried."""
    with contextlib.ExitStack() as after:
        if isinstance(hit.edit, LineEdit):
            after.callback(hit.edit.put())
            after.callback(search.known.clear)
            search.known.clear()
        else:
            group, k = hit.edit
            search.fixed = [(place, place.variants[k]) for place in group]
            after.callback(search.fixed.clear)
        yield


def _likely(search: _Search, ranks: int) -> Iterator[tuple[int, _Hit]]:
    """What the likely edits find, rank by rank, as long as there are lines left to execute."""
    for rank, trials in itertools.islice(search._in_order(), ranks):
        for hit in trials:
            if hit is not None:
                yield rank, hit
            if search._over():
                return


def _compiled(search: _Search) -> Callable:
    with search._probed([]):
        return search.box.compile()


def _masks(search: _Search, function: Callable, example) -> tuple[np.ndarray, ...]:
    """Which entries of its answer are right."""
    value = search.answer(function, example)
    if value is None:
        return tuple(np.zeros(part.shape, bool) for part in example.right)
    return example.masks(tuple(value))


def _mask(search: _Search, function: Callable, example) -> np.ndarray:
    return np.concatenate([mask.ravel() for mask in _masks(search, function, example)])
