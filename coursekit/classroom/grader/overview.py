"""The class at a glance, as numbers: what was right, common mistakes, exercises that told nothing."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from statistics import median

from .marks import Mark, Notebook, Standing

LONGEST = 220  # letters of a mistake's name
FEWEST = 9  # handed-in answers below which no exercise is called badly posed
NOT_WRITTEN = ("unwritten", "missing")


@dataclass
class Mistake:
    """What several students did: its name, where it is in their code, and whose it is."""

    exercise: str
    text: str
    line: str
    students: list[str] = field(default_factory=list)


@dataclass
class Item:
    """One exercise. upper, lower: share right in the best and in the last third of the class, by the rest."""

    unit: str
    name: str
    handed_in: int = 0
    right: int = 0
    written: int = 0
    upper: float | None = None
    lower: float | None = None
    mistakes: list[Mistake] = field(default_factory=list)

    @property
    def share(self) -> float:
        """Of those who handed the notebook in."""
        return self.right / self.handed_in if self.handed_in else 0.0

    @property
    def doubt(self) -> str:
        """Why the exercise may be badly posed, '' if nothing speaks for it."""
        if self.upper is None or self.lower is None or self.handed_in < FEWEST:
            return ""
        if self.upper - self.lower < 0.1 and 0.1 < self.share < 0.9:
            return "the best third does no better here than the last: does it ask what it should?"
        if self.upper < 0.25:
            return "hardly anybody, not even of the best third, has it right: is it posed clearly?"
        return ""


def is_right(mark: Mark) -> bool:
    """By itself: not through an override, nor because an earlier exercise was put right."""
    return mark.points is not None and not mark.text and not mark.kind.startswith("missing")


def items(class_: list[Standing]) -> list[Item]:
    """Every exercise, in the order of the course."""
    found: dict[tuple[str, str], Item] = {}
    for one in class_:
        for unit, nb in one.notebooks.items():
            for mark in nb.marks:
                item = found.setdefault((unit, mark.name), Item(unit, mark.name))
                if nb.there and mark.points is not None:
                    item.handed_in += 1
                    item.right += is_right(mark)
                    item.written += mark.kind not in NOT_WRITTEN
    for item in found.values():
        item.upper, item.lower = _thirds(class_, item)
        item.mistakes = _mistakes(class_, item)
    return list(found.values())


def _thirds(class_: list[Standing], item: Item) -> tuple[float | None, float | None]:
    """Ordered by all other exercises, so that an exercise does not speak for itself."""
    scores = []
    for one in class_:
        nb = one.notebooks.get(item.unit)
        marks = [mark for nb_ in one.notebooks.values() if nb_.there for mark in nb_.marks]
        others = [is_right(mark) for mark in marks if mark.name != item.name]
        mine = [mark for mark in marks if mark.name == item.name and mark.points is not None]
        if nb is not None and nb.there and mine and others:
            scores.append((sum(others) / len(others), is_right(mine[0])))
    if len(scores) < 3:
        return None, None
    scores.sort(key=lambda score: score[0])
    third = len(scores) // 3
    lower, upper = scores[:third], scores[-third:]
    return sum(right for _, right in upper) / third, sum(right for _, right in lower) / third


def _mistakes(class_: list[Standing], item: Item) -> list[Mistake]:
    found: dict[tuple[str, str], Mistake] = {}
    for one in class_:
        mark = one.marks.get(item.name)
        nb = one.notebooks.get(item.unit)
        if mark is None or nb is None or not nb.there or not mark.text or mark.kind in NOT_WRITTEN:
            continue
        text = named(mark)
        mistake = found.setdefault((text, mark.line), Mistake(item.name, text, mark.line))
        mistake.students.append(one.student)
    return sorted(found.values(), key=lambda one: (-len(one.students), one.text))


def named(mark: Mark) -> str:
    """The mistake without what differs from one student to the next."""
    text = re.sub(r"\d+ of \d+", "some", mark.said or mark.text)
    return text if len(text) <= LONGEST else text[: text.rfind(" ", 0, LONGEST)] + " …"


def needs_your_eye(class_: list[Standing]) -> Iterator[tuple[str, str]]:
    """(student, why): what no program should decide alone."""
    for one in class_:
        for nb in one.notebooks.values():
            if nb.points is None:
                yield one.student, f"{nb.name}: {'; '.join(nb.notes) or 'could not be graded'}"
                continue
            for note in nb.notes:
                if "found:" in note or "handed out to" in note or "link" in note or "not a readable" in note:
                    yield one.student, f"{nb.name}: {note}"
            yield from ((one.student, f"{nb.name}: {why}") for why in _all_zero(nb))


def _all_zero(nb: Notebook) -> Iterator[str]:
    texts = {mark.text for mark in nb.marks}
    if not nb.there or len(nb.marks) < 2 or len(texts) > 1 or any(mark.points for mark in nb.marks):
        return
    (text,) = texts
    if text and nb.marks[0].kind not in NOT_WRITTEN and text not in nb.notes:
        yield f"nothing for one reason: {text}"


def help_wanted(class_: list[Standing], found: list[Item]) -> list[tuple[str, list[str]]]:
    """(student, exercises), those with most that is wrong or not written first; only of what is handed in."""
    lacking: dict[str, list[str]] = defaultdict(list)
    for one in class_:
        for unit, nb in one.notebooks.items():
            if nb.there:
                lacking[one.student] += [m.name for m in nb.marks if not is_right(m) and m.points is not None]
            elif any(item.handed_in for item in found if item.unit == unit):
                lacking[one.student] += [mark.name for mark in nb.marks]
    order = sorted(lacking.items(), key=lambda one: (-len(one[1]), one[0]))
    return [(student, names) for student, names in order if len(names) >= max(2, len(found) / 3)]


def middle(class_: list[Standing]) -> float | None:
    """The median total, of those who handed anything in."""
    points = [one.points for one in class_ if any(nb.there for nb in one.notebooks.values())]
    known = [p for p in points if p is not None]
    return median(known) if known else None
