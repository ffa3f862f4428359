"""One ladder for the student's check and for the grader: what is wrong, by the first step that can say it.

1. it cannot be judged: not written, raises, returns no such thing, changes its arguments
2. right
3. a mistake that has a name (the hints of the exercise), and its line if `repair` finds it
4. what was done to the right answer (`transforms`)
5. where the code is wrong (`repair`); only with the function itself
6. what is right already, in the words of the exercise (`already`)
7. by how much it misses, in the terms of the course; only with the function itself

The grader judges answers to hidden inputs and has no function: it tells nothing that depends on an input.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from . import compare
from .already import not_a_pose, what_is_right
from .attempt import Attempt, line_of_nan
from .coded import another_word, ignored, remembers, with_decimals
from .exercise import NONE, Exercise, fits, misshapen, thaw
from .library import not_there, permitted
from .plain import in_plain_words
from .repair import repair
from .transforms import done_to_the_right_answer

Parts = tuple[np.ndarray, ...]


@dataclass(frozen=True)
class Example:
    """Arguments, the right answer, and the answers of the typical mistakes."""

    exercise: Exercise
    case: str
    arguments: list
    right: Parts
    wrong: dict[str, Parts]
    tol: ArrayLike

    def agrees(self, parts: Parts, right: Parts | None = None) -> bool:
        """Is this answer the right one (or the one given)? A law decides where several answers are right."""
        if self.exercise.compare == "any_solution" and right is None:
            return bool(np.all([np.isfinite(p).all() for p in parts])) and not broken_law(self, parts)
        pairs = zip(self.exercise.kinds, parts, self.right if right is None else right, strict=True)
        return all(compare.same(kind, a, b, self.tol) for kind, a, b in pairs)

    def masks(self, parts: Parts) -> Parts:
        """Which entries are right."""
        return tuple(
            compare.mask(kind, a, b, self.tol) if a.shape == b.shape else np.zeros(b.shape, bool)
            for kind, a, b in zip(self.exercise.kinds, parts, self.right, strict=True)
        )


@dataclass(frozen=True)
class Verdict:
    """kind  : right, unwritten, error, misfit, library, named, placed or different.
    say   : the shortest true sentence.
    more  : what is right already, and by how much the rest misses.
    step  : what found it: a hint's key, "done", "repair", "ignored", "already", "residual", ...
    example: number of an example that shows it, -1 if none does.
    mended: what to say when it is right the next time: "line 4: a sign"; "" if there is nothing to say.
    """

    kind: str
    say: str
    more: tuple[str, ...] = field(default=())
    step: str = ""
    example: int = -1
    mended: str = ""

    @property
    def right(self) -> bool:
        return self.kind == "right"


def verdict(
    exercise: Exercise,
    examples: list[Example],
    attempts: list[Attempt],
    function: Callable | None = None,
    allowed: tuple[str, ...] = (),
) -> Verdict:
    """What is to be said of a student's answers to these examples.

    Parameters
    ----------
    examples, attempts : one attempt for each example
    function : the student's function, for what only the code can tell; None where the inputs are hidden
    allowed : names of the library that it may call, as in `ALLOW` of the unit
    """
    answers = [attempt.parts for attempt in attempts]
    found = _cannot_be_judged(exercise, examples, attempts)
    good = [not found and example.agrees(parts) for example, parts in zip(examples, answers, strict=True)]
    if function and not all(good) and (text := remembers(exercise, function, examples, attempts)):
        return Verdict("named", text, step="remembers", example=good.index(False))
    if function and not all(good) and (text := another_word(exercise, function, examples, attempts)):
        return Verdict("named", text, step="word", example=good.index(False))
    if found:
        hint = None if found.step == "changed" else _named(exercise, examples, answers)
        if hint:
            found = Verdict("named", hint.text, step=hint.key, example=found.example)
            return _and_its_line(found, exercise, function, examples, good, attempts)
        return _placed(found, exercise, function, examples, good, attempts)
    if all(good) and _rounded(exercise, examples, answers):
        return Verdict("named", "your numbers are rounded: give them as they are", step="rounded", example=0)
    if all(good):
        return _right(examples, attempts, allowed, function)
    first = good.index(False)
    hint = _named(exercise, examples, answers)
    if not hint and function:
        examples, attempts, whose = with_decimals(exercise, function, examples, attempts)
        if whose:
            answers = [attempt.parts for attempt in attempts]
            good = [example.agrees(parts) for example, parts in zip(examples, answers, strict=True)]
            hint = _named(exercise, examples, answers)
        if all(good):
            text = (
                f"`{whose}` may hold whole numbers, and then a copy of it does, too: decimals stored in it"
                f" are cut off. np.array({whose}, float) holds decimals"
            )
            return Verdict("named", text, step="whole", example=first)
    if hint:
        found = Verdict("named", hint.text, step=hint.key, example=first)
        return _and_its_line(found, exercise, function, examples, good, attempts)
    if text := _other_length(exercise, examples, answers):
        found = Verdict("misfit", text, step="misfit", example=first)
        return _placed(found, exercise, function, examples, good, attempts)
    if any(good) and (found := _not_finite(exercise, examples, answers, function, good)):
        return found
    also = _already_and_residual(exercise, examples, answers, good, function)
    if function and (text := ignored(exercise, function)):
        found = Verdict("named", text, also, "ignored", first)
        return _and_its_line(found, exercise, function, examples, good, attempts)
    if text := done_to_the_right_answer(exercise, examples, answers):
        found = Verdict("named", text, step="done", example=first)
        return _placed(found, exercise, function, examples, good, attempts)
    if function and (text := _repaired(exercise, function, examples, good, attempts)):
        return Verdict("named", text, also, "repair", first, text.removeprefix("look at "))
    if found := _not_finite(exercise, examples, answers, function):
        return found
    if also:
        return Verdict("placed", also[0], also[1:], "already", first)
    return Verdict(
        "different", f"wrong on {good.count(False)} of {len(good)} examples", (), "different", first
    )


# ---- 1: it cannot be judged

RESHAPED: tuple[tuple[str, Callable[[np.ndarray], np.ndarray]], ...] = (
    ("Rows and columns have changed places: x.T turns them", np.transpose),
    ("The numbers are right: x.ravel() has them in one row", np.ravel),
    ("The number is right, but in brackets: x.item() takes it out", lambda part: part.reshape(())),
)


def _cannot_be_judged(exercise: Exercise, examples: list[Example], attempts: list[Attempt]) -> Verdict | None:
    for k, attempt in enumerate(attempts):
        if attempt.changed and attempt.fault != "unwritten":
            text = (
                f"it changes its argument `{attempt.changed}`: whoever called it finds other numbers in it"
                " afterwards. Work on a copy; `x /= 2` and `x[i] = ...` change the array itself"
            )
            return Verdict("misfit", text, step="changed", example=k)
    for k, attempt in enumerate(attempts):
        if attempt.fault:
            text = attempt.text
            if text.startswith(NONE) and not all(a.fault for a in attempts):
                text = f"{NONE} in some cases and not in others: a branch has no `return`, or none is taken"
            text = (
                _only_there(examples, attempts, k) + text + _but_for_the_shape(exercise, examples, attempts)
            )
            return Verdict(attempt.fault, text, step=attempt.fault, example=k)
    return None


def _but_for_the_shape(exercise: Exercise, examples: list[Example], attempts: list[Attempt]) -> str:
    """'' or how the right numbers, which came in another shape on every example, get into theirs."""
    if not all(a.parts for a in attempts):
        return ""
    answers = [a.parts for a in attempts]
    if len(exercise.shapes) > 1 and all(map(Example.agrees, examples, [a[::-1] for a in answers])):
        return ". The results stand in another order"
    unfit = {k for parts in answers for k, shape in enumerate(exercise.shapes) if not fits(parts[k], shape)}
    for text, change in RESHAPED:
        try:
            changed = [tuple(change(p) if k in unfit else p for k, p in enumerate(a)) for a in answers]
        except ValueError:  # the shapes do not fit like this either
            continue
        fit = all(all(map(fits, parts, exercise.shapes)) for parts in changed)
        if fit and all(map(Example.agrees, examples, changed)):
            return f". {text}"
    return ""


def _only_there(examples: list[Example], attempts: list[Attempt], k: int) -> str:
    """ "for a slide, " if it happens in one case alone and goes well in others."""
    bad = {e.case for e, a in zip(examples, attempts, strict=True) if a.fault}
    well = {e.case for e, a in zip(examples, attempts, strict=True) if not a.fault}
    case = examples[k].case
    return f"{case}: " if len(bad) == 1 and well and case not in well else ""


def _other_length(exercise: Exercise, examples: list[Example], answers: list[Parts]) -> str:
    """'' or how many rows, columns or entries are expected where their number depends on the arguments."""
    for example, parts in zip(examples, answers, strict=True):
        for mine, right, shape in zip(parts, example.right, exercise.shapes, strict=True):
            for axis, size in enumerate(shape):
                if size is None and mine.shape[axis] != right.shape[axis]:
                    return f"the shape is {mine.shape}; for these arguments {right.shape} is expected"
    return ""


def _not_finite(exercise: Exercise, examples, answers, function, good=None) -> Verdict | None:
    """With `good`: only where nothing else is wrong, so that no edit is guessed which happens to hide it."""
    bad = [not all(np.isfinite(part).all() for part in parts) for parts in answers]
    if not any(bad) or (good is not None and any(g == b for g, b in zip(good, bad, strict=True))):
        return None
    k = bad.index(True)
    cases = list(dict.fromkeys(e.case for e, b in zip(examples, bad, strict=True) if b))
    where = f"{', '.join(cases)}: " if len(cases) < 4 and not all(bad) else ""
    line, what = line_of_nan(function, examples[k].arguments) if function else (0, "")
    text = f"{where}the answer holds NaN or infinity"
    if line:
        text += f"; it comes from line {line}" + (f" ({in_plain_words(what) or what})" if what else "")
    return Verdict("misfit", text, step="nan", example=k)


# ---- 2 and 3: right, or a mistake with a name


def _right(
    examples: list[Example], attempts: list[Attempt], allowed: tuple[str, ...], function: Callable | None
) -> Verdict:
    calls = dict.fromkeys(call for attempt in attempts for call in attempt.calls)
    forbidden = next((call for call in calls if not permitted(call, allowed)), None)
    if forbidden:
        name = forbidden.partition(".__")[0]  # making a Table is calling dh.Table
        text = f"the numbers are right, but it calls coursekit's own {name}: write that part yourself"
        return Verdict("library", text, step="library")
    if function and (package := not_there(function)):
        text = f"the numbers are right, but {package} is not there when it is graded: numpy is"
        return Verdict("library", text, step="library")
    return Verdict("right", f"right on {len(examples)} examples", step="right")


def _rounded(exercise: Exercise, examples: list[Example], answers: list[Parts]) -> bool:
    """Within the tolerance, but with at most eight digits behind the point, where right ones have more."""
    if "any_solution" in exercise.kinds:
        return False
    mine = np.concatenate([part.ravel() for parts in answers for part in parts])
    right = np.concatenate([part.ravel() for example in examples for part in example.right])
    return any(
        np.allclose(mine, np.round(mine, digits), rtol=0, atol=1e-13)
        and not np.allclose(right, np.round(right, digits), rtol=0, atol=1e-10)
        for digits in range(9)
    )


def _named(exercise: Exercise, examples: list[Example], answers: list[Parts]):
    """A mistake is recognised by all examples at once: on some of them it may happen to be right.

    Where the student's function raises or gives NaN, the others must do: at least three of them, and most;
    and one of them must be wrong, or the mistake is a guess.
    """
    known = [(e, _rows(exercise, parts)) for e, parts in zip(examples, answers, strict=True) if parts]
    finite = [(e, parts) for e, parts in known if all(np.isfinite(part).all() for part in parts)]
    for some in (known, finite):
        if len(some) < max(3, len(examples) / 2) and len(some) < len(examples):
            return None
        if all(e.agrees(parts) for e, parts in some):
            return None
        for hint in exercise.hints:
            if all(hint.key in e.wrong and e.agrees(parts, e.wrong[hint.key]) for e, parts in some):
                return hint
    return None


def _rows(exercise: Exercise, parts: Parts) -> Parts:
    """One solution that came without its brackets, (3,) for (1, 3), is a set of one."""
    return tuple(
        part[None] if kind == "set" and part.ndim == len(shape) - 1 else part
        for kind, part, shape in zip(exercise.kinds, parts, exercise.shapes, strict=True)
    )


# ---- 5: where the code is wrong


def _placed(found: Verdict, exercise: Exercise, function, examples, good, attempts) -> Verdict:
    """What is wrong with the answer, and the line of the code that made it so, where it can be found."""
    if function is None or found.step not in ("misfit", "done") or ". " in found.say:
        return found
    place = _repaired(exercise, function, examples, good, attempts)
    if not place:
        return found
    if found.say.startswith(("your decimals", "your numbers are rounded")):  # which says what, but not where
        place = place.partition(":")[0]
    return replace(found, say=f"{found.say}; {place}", mended=place.removeprefix("look at "))


def _and_its_line(found: Verdict, exercise: Exercise, function, examples, good, attempts) -> Verdict:
    """A mistake that has its name, and the line in which it was made, where that can be found."""
    place = function and _repaired(exercise, function, examples, good, attempts, named=True)
    if not place:
        return found
    text = f". L{place[1:]}" if ". " in found.say else f"; {place}"
    return replace(found, say=found.say + text, mended=place.removeprefix("look at "))


def _repaired(exercise: Exercise, function, examples, good, attempts, named=False) -> str:
    wrong_first = sorted(range(len(examples)), key=lambda k: (good[k], attempts[k].cost))
    costs = sorted(tried.cost for tried in attempts)
    cost = max(attempts[wrong_first[0]].cost, costs[len(costs) // 2] // 4)  # the first may return at once
    return repair(exercise, function, [examples[k] for k in wrong_first], cost, named)


# ---- 6 and 7: what is right already, and by how much the rest misses


def _already_and_residual(exercise, examples, answers, good, function) -> tuple[str, ...]:
    several = "any_solution" in exercise.kinds  # entries of one right answer need not be those of another
    first, *further = [""] if several else what_is_right(exercise, examples, answers, good)
    told = [first]
    if function is not None:
        told += [_residual(exercise, examples, answers, good)]
    told += [_law(exercise, examples, answers, good, function), *further]
    return tuple(text for text in told if text)


def _residual(exercise: Exercise, examples, answers, good) -> str:
    if exercise.residual is None:
        return ""
    for example, parts, fine in zip(examples, answers, good, strict=True):
        if not fine:
            try:
                with np.errstate(all="ignore"):
                    text = exercise.residual(
                        thaw(example.arguments),
                        exercise.value(list(parts)),
                        exercise.value(list(example.right)),
                    )
            except (ValueError, IndexError, ArithmeticError, np.linalg.LinAlgError):
                continue
            if text:
                return text
    return ""


def _law(exercise: Exercise, examples, answers, good, function) -> str:
    for example, parts, fine in zip(examples, answers, good, strict=True):
        if not fine and (text := broken_law(example, parts, function)):
            return text
    return ""


def broken_law(example: Example, parts: Parts, function: Callable | None = None) -> str:
    """'' or the text of the first law that does not hold."""
    exercise = example.exercise
    if misshapen(exercise, list(parts)):
        return ""
    with np.errstate(all="ignore"):
        for kind, part in zip(exercise.kinds, parts, strict=True):
            if kind == "rotation" and (text := not_a_pose(part)):
                return text
        for text, law in exercise.laws:
            try:
                holds = law(function, thaw(example.arguments), exercise.value(list(parts)))
            except Exception:
                holds = function is None and exercise.compare != "any_solution"
            if not holds:
                return text
    return ""
