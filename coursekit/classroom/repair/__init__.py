"""Where is the code wrong? The one edit of a student's function that makes it right on every example.

The function is tried with single edits, one after the other, the likely ones first, until a fixed number of
executed lines is used up: the same code gets the same sentence on every machine. What is told is the line and
the kind of the edit. The edit itself is never shown. Where one of two lines would do, both are told, or three
if the edit is the same; nothing is told of more of them. Then the student's own functions that it calls are
searched in the same way, and then two edits at once (`two`).
"""

from __future__ import annotations

import ast
import contextlib
import itertools
import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import compare
from ..course import course_here
from ..exercise import Exercise, Misfit, answer, misshapen, thaw
from . import places
from .lines import LineEdit, line_edits, name_edits
from .places import LOCALS, PROBE, Place, Variant
from .sandbox import TICKS, Sandbox, Stop, Unfit
from .texts import sentence
from .two import two_edits

BUDGET = 2_500_000  # executed lines, of the student's and of what they call
TRIAL = 100  # of them: what a trial costs beside its call
IN_A_HELPER = 600_000  # of them, for edits of each of the student's own functions that it calls
ONE = 10_000  # of them in a single trial, whose loop may not end any more
RANKS = 4  # of edits, the likely ones first
LIKELY = 2  # of them: many an edit of another rank gets a count right by chance
VAST = 100_000  # bits of a whole number, entries of a list or an array
SECONDS = 10.0  # of the processor: a backstop, where an edit makes work what did nothing before


@dataclass(frozen=True)
class _Hit:
    rank: int
    line: int
    kind: str
    what: str
    edit: LineEdit | tuple[list[Place], int]  # or places, and which of their variants
    gain: float = 1.0  # of `two`: how much more of the answers is right with it


def repair(exercise: Exercise, function: Callable, examples: list, cost: int, named: bool = False) -> str:
    """ "look at line 4: a sign": place and kind of the edit that makes the function right on all examples.

    '' if there is none.

    examples : of `verdict.Example`, those where the function is wrong first
    cost : lines that one call of the function executes
    named : the mistake has a name already: "look at line 4" is all that is asked for, of one edit
    """
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what an edit is warned of is not the student's matter
        try:
            search = _Search(exercise, function, examples, max(cost, 12))
        except Unfit:
            return ""
        if hits := search.hits():
            likelier = _in_a_helper(search, min(hit.rank for hit in hits))
            told = likelier or _told(search, hits, search.owner())
        else:
            told = _in_a_helper(search) or ("" if named else two_edits(search))
    if named:
        return told.partition(":")[0] if told.startswith("look at line") else ""
    return told


def _in_a_helper(search: _Search, below: int = RANKS) -> str:
    """The same of the student's own functions that it calls; exercises among them are known to be right.

    below : only edits of a smaller rank, which are likelier than what was found already
    """
    course, found = course_here(), []
    helpers = [name for name in search.box.trees if name != search.box.whole and not course.has(name)]
    for name in helpers if below else ():
        search.turn_to(name)
        search.left = IN_A_HELPER // search.cost
        if hits := search.hits(below):
            found.append(_told(search, hits, f" of `{search.tree.name}`"))
    search.turn_to(search.box.whole)
    return found[0] if len(found) == 1 else ""


def _told(search: _Search, hits: list[_Hit], owner: str = "") -> str:
    best = min(hit.rank for hit in hits)
    hits = [hit for hit in hits if hit.rank == best]
    below = [hit for hit in hits if not hit.line or hit.line - search.first + 1 >= search.body]
    hits = below or hits  # what is done to an argument is done wherever it is used: that place says more
    lines = sorted({hit.line - search.first + 1 if hit.line else 0 for hit in hits})
    alike = len({(hit.kind, hit.what) for hit in hits}) == 1
    if len(lines) > (3 if alike else 2) or (lines[-1] - lines[0] > 1 and lines[0] < search.body):
        return ""  # it could be here or there
    kinds = [(hit.kind, hit.what) for hit in sorted(hits, key=lambda hit: hit.line)]
    return sentence(kinds, lines, search.body, owner)


class _Search:
    sure = (
        True  # an edit is no finding where what it must not be mistaken for (`Variant.unless`) does as well
    )

    def __init__(self, exercise: Exercise, function: Callable, examples: list, cost: int) -> None:
        self.exercise, self.examples, self.cost = exercise, examples, cost + TRIAL
        self.left = max(1, BUDGET // self.cost)
        self.end = time.process_time() + SECONDS
        self.box = Sandbox(function)
        rounds = [self._rounds(self.box.compile(), example) for example in examples]
        self.box.most = min(TICKS, max(2 * max(rounds), ONE * max(rounds[0], 1) // cost))
        self.turn_to(self.box.whole)
        self.known: dict[str, list[Place]] = {}  # places of a function, until a line of it is edited
        self.judge: Callable[[Callable], float] = self._right
        self.fixed: list[tuple[Place, Variant]] = []  # edits that stand while others are tried
        self.chosen: dict[int, Variant] = {}
        self.ordinary: dict[int, Callable] = {}
        # the answer is one whole number
        self.counts = all(len(e.right) == 1 and not e.right[0].ndim and e.right[0] % 1 == 0 for e in examples)
        self.box.names[PROBE], self.box.names[LOCALS] = self._probe, locals

    def turn_to(self, name: str) -> None:
        """Edits are tried in this function from now on: the student's own, or one that it calls."""
        self.tree = self.box.turn_to(name)
        self.first = self.tree.lineno
        self.body = self.tree.body[0].lineno - self.first + 1  # 1 where all stands in the line of the `def`

    def owner(self) -> str:
        """Whose lines are counted, where it is not the function that was asked for: a method, say."""
        return "" if self.tree.name == self.exercise.name else f" of `{self.tree.name}`"

    def _rounds(self, function: Callable, example) -> int:
        """How many rounds of loops the function itself takes."""
        self.box.ticks = 0
        with contextlib.suppress(Exception, Stop):
            function(*thaw(example.arguments))
        return self.box.ticks

    def _probe(self, key: int, pieces: tuple, variables: dict) -> Any:
        variant = self.chosen.get(key)
        value = (self.ordinary[key] if variant is None else variant.value)(pieces, variables)
        if _is_vast(value):  # an edit that squares a whole number in each round never comes back
            raise Stop
        return value

    def hits(self, below: int = RANKS) -> list[_Hit]:
        found: list[_Hit] = []
        for rank, trials in itertools.islice(self._in_order(), min(below, LIKELY if self.counts else RANKS)):
            for hit in trials:
                if hit is not None:
                    found.append(hit)
                if self._over():
                    break
            if self._over() or (found and rank >= min(hit.rank for hit in found)):
                break
        return found

    def _over(self) -> bool:
        return self.left <= 0 or time.process_time() > self.end

    def _in_order(self) -> Iterator[tuple[int, Iterable[_Hit | None]]]:
        if self.box.name not in self.known:
            self.known[self.box.name] = list(places.places(self.tree))
        every = self.known[self.box.name]
        yield 0, itertools.chain(self._edited(line_edits), self._places(every, 0))
        yield (
            1,
            itertools.chain(
                self._edited(name_edits),
                self._groups(every, 0),
                self._places(every, 1),
                self._groups(every, 1),
            ),
        )
        yield 2, itertools.chain(self._arguments(), self._places(every, 2))
        yield 3, itertools.chain(self._groups(every, 2), self._places(every, 3))

    # ---- the edits

    def _edited(self, edits: Callable) -> Iterator[_Hit | None]:
        for edit in list(edits(self.tree)):
            back = edit.put()
            try:
                with self._probed([]):
                    good = self.judge(self.box.compile())
            except (SyntaxError, ValueError, TypeError):
                good = False
            finally:
                back()
            rank = 0 if edits is line_edits else 1
            yield _Hit(rank, edit.line, edit.kind, edit.what, edit, good) if good else None

    def _places(self, every: list[Place], rank: int) -> Iterator[_Hit | None]:
        for place in every:
            variants = [v for v in place.variants if v.rank == rank]
            if variants:
                yield from self._try([place], variants, rank, place.node.lineno)

    def _groups(self, every: list[Place], rank: int) -> Iterator[_Hit | None]:
        """The same edit at all places that look alike, or at those of a line: every arctan2, every name."""
        groups: dict[str, list[Place]] = {}
        for place in every:
            if key := places.likeness(place.node):
                groups.setdefault(key, []).append(place)
        for group in groups.values():
            lines = {place.node.lineno for place in group}
            alike = len({len(place.variants) for place in group}) == 1
            if len(group) < 2 or not alike:
                continue
            in_lines = [[place for place in group if place.node.lineno == line] for line in sorted(lines)]
            for some in [group, *in_lines] if len(lines) > 1 else [group]:
                if len(some) > 1:
                    variants = [v for v in some[0].variants if v.rank == rank]
                    line = 0 if some is group and len(lines) > 1 else some[0].node.lineno
                    yield from self._try(some, variants, rank + 1, line)

    def _arguments(self) -> Iterator[_Hit | None]:
        """An argument that comes in another form than the code thinks."""
        for name in self.exercise.arguments if self.box.name == self.box.whole else ():
            used = {n.lineno for n in ast.walk(self.tree) if isinstance(n, ast.Name) and n.id == name}
            line = ast.Assign([ast.Name(name, ast.Store())], ast.Name(name, ast.Load()))
            places.located(line, self.tree)
            self.tree.body.insert(0, line)
            place = places.argument(line)
            try:
                yield from self._try([place], place.variants, 2, used.pop() if len(used) == 1 else self.first)
            finally:
                self.tree.body.remove(line)

    def _try(
        self, group: list[Place], variants: Iterable[Variant], rank: int, line: int
    ) -> Iterator[_Hit | None]:
        """Compile once with probes in these places; then every variant, at all of them."""
        if any(place is other for place in group for other, _ in self.fixed):
            return
        try:
            with self._probed(group) as mine:
                function = self.box.compile()
        except (SyntaxError, ValueError, TypeError):
            return
        index, before = {id(v): k for k, v in enumerate(group[0].variants)}, self.chosen
        for variant in variants:
            k = index[id(variant)]
            self.chosen = before | {key: place.variants[k] for key, place in mine}
            kind = variant.kind if len(group) == 1 else f"every_{variant.kind}"
            what = variant.what or (places.likeness(group[0].node) if len(group) > 1 else "")
            good = self.judge(function)
            if good and self.sure and variant.unless is not None:
                self.chosen |= {key: v._replace(value=v.unless or v.value) for key, v in self.chosen.items()}
                good = good if self.judge(function) < good else False
            yield _Hit(rank, line, kind, what, (group, k), good) if good else None
            if self._over():
                break

    @contextlib.contextmanager
    def _probed(self, group: list[Place]) -> Iterator[list[tuple[int, Place]]]:
        """Probes in these places and in those of the edits that stand; yields keys of the former."""
        standing = {id(place): variant for place, variant in self.fixed}
        every = sorted([*group, *(place for place, _ in self.fixed)], key=lambda place: place.number)
        self.ordinary = {key: place.ordinary for key, place in enumerate(every)}
        self.chosen = {key: standing[id(p)] for key, p in enumerate(every) if id(p) in standing}
        back = [place.put(key) for key, place in list(enumerate(every))[::-1]]  # one may stand inside another
        try:
            yield [(key, place) for key, place in enumerate(every) if id(place) not in standing]
        finally:
            for undo in reversed(back):
                undo()

    # ---- is it right now?

    def answer(self, function: Callable, example) -> list | None:
        """What an edited function answers, None where that is no answer."""
        self.left -= 1
        self.box.ticks = 0
        given = thaw(example.arguments)
        try:
            value = answer(self.exercise, function(*given))
        except (Misfit, Exception, Stop):
            return None
        if misshapen(self.exercise, value) or not _untouched(given, example.arguments):
            return None
        return value

    def _right(self, function: Callable) -> bool:
        for example in self.examples:
            value = self.answer(function, example)
            if value is None or not example.agrees(value):
                return False
        return True


def _is_vast(value: Any) -> bool:
    if type(value) is int:
        return value.bit_length() > VAST
    size = value.size if isinstance(value, np.ndarray) else len(value) if isinstance(value, list | str) else 0
    return size > VAST


def _untouched(given: list, arguments: list) -> bool:
    """Do arrays that the function was given hold what they held? Nearly always bit for bit."""
    pairs = [(a, np.array(b)) for a, b in zip(given, arguments, strict=True) if isinstance(a, np.ndarray)]
    return all(
        (a.shape == b.shape and a.tobytes() == b.tobytes()) or compare.same("close", a, b, 0)
        for a, b in pairs
    )
