"""What a student reads of an edit: its kind and its line, never the edit."""

from __future__ import annotations

# kind -> what to look at; {} is a name of the student's own code
TEXTS = {
    "sign": "a sign",
    "operator": "an operator between two things",
    "products": "an operator between two things",
    "order": "the order of two factors or terms",
    "brackets": "the brackets: what is divided by what",
    "sum": "brackets around a sum are missing",
    "grows": "`{}` adds up what should be new in each round",
    "extra": "a factor or a term too many",
    "arguments": "the order of the arguments of `{}`",
    "function": "`{}`: another function is needed there",
    "call": "`{}`: a call too many",
    "modulo": "whole turns, or whatever `%` takes off, should stay",
    "keyword": "the keyword `{}`",
    "comparison": "the comparison",
    "number": "a number",
    "name": "`{}`: another variable belongs there",
    "index": "an index or a slice",
    "entries": "the order of the entries",
    "transposed": "something that is transposed or should be",
    "inverse": "an inverse that is missing",
    "other_inverse": "which of the two is inverted",
    "other_transposed": "which of the two is transposed",
    "reversed": "an order from last to first",
    "half": "a factor 2",
    "turn": "half a turn or a whole one, pi or 2 pi",
    "root": "a root or a square that is missing",
    "unit_length": "a vector that should have length 1",
    "degrees": "degrees and radians",
    "absolute": "a size without its sign",
    "copy": "an array that is changed after it was stored: a copy is missing",
    "sign_of_zero": "`sign` of 0 is 0, neither 1 nor -1",
    "one_minus": "a value and what it lacks to 1",
    "upside_down": "a fraction that stands upside down",
    "millimetres": "metres and millimetres",
    "whole_numbers": "an array of whole numbers: decimals are cut off in it",
    "halves": "the order of the two halves",
    "negative_root": "a root of a number that may be negative",
    "flipped": "the order of the columns",
    "missing": "`{}` is missing there",
    "stray": "`{}` does not belong there",
    "line": "one line too many",
    "lines": "the order of this line and the next one",
    "return": "`return` stands inside the loop",
    "indented": "a line stands inside the loop that belongs below it, or the other way round",
    "unpacked": "the order of the names on the left",
    "mixed_up": "`{}` have changed places",
    "places": "two terms or factors that have changed places",
    "in_place": "an assignment that changes an array in place",
    "somewhere": "something in this line",
}
EVERY = {
    "arguments": "the order of the arguments in every `{}`",
    "function": "every `{}`: another function is needed",
    "operator": "every `{}`: another operator is needed",
    "products": "every `{}` between two arrays: another operator is needed",
    "order": "the order of the factors at every `{}`",
    "index": "every `{}`: another index or slice is needed",
    "brackets": "the brackets in every fraction: what is divided by what",
    "call": "every `{}`: a call too many",
    "number": "every {}: another number is needed",
    "name": "every `{}`: another variable belongs there",
    "missing": "`{}` is missing at several places",
}
# kind -> what does the same in other words: without the line it does not matter which one stands behind it
LESSER = {"line": ("lines", "modulo"), "call": ("number", "degrees"), "modulo": ("number",)}
LESSER["every_call"] = LESSER["call"]
WHOLE = {"+": "sum", "-": "difference", "*": "product", "@": "product", "/": "fraction", "**": "power"}


def sentence(kinds: list[tuple[str, str]], lines: list[int], body: int = 2, owner: str = "") -> str:
    """ "look at line 4: a sign", from the kinds of all edits that would do, and their lines.

    body: the line in which it begins.
    owner: " of `skew`", where it is not the function of the exercise.
    '' where neither a line nor a kind can be told.
    """
    where, what = _lines(lines, body), _what(kinds)
    if not where and what == TEXTS["somewhere"]:
        return ""
    if what == TEXTS["somewhere"] and lines[-1] - lines[0] > 1:
        return ""
    if not where and not lines[-1] and not owner and what.startswith("every "):
        return f"look at {what}"
    elsewhere = "the arguments" if lines[-1] else "several lines at once"
    return f"look at {where or elsewhere}{owner}: {what}"


def _lines(lines: list[int], body: int) -> str:
    """Line 0 is several places at once; the line of the `def` the arguments, unless the body is in it."""
    lines = [line for line in lines if line >= min(body, 2)]
    if not lines:
        return ""
    *others, last = map(str, lines)
    return f"line {', '.join(others)} or {last}" if others else f"line {last}"


def _what(kinds: list[tuple[str, str]]) -> str:
    """One kind, or two of which either may be meant; three kinds say nothing."""
    plain = [f"other_{kind}" for kind, _ in kinds]  # x.T @ y for x @ y, or for x @ y.T: one thing
    kinds = [one for one in kinds if one[0] not in plain]
    if len({kind for kind, _ in kinds}) > 2:  # of a rotation the inverse is the transpose: once is enough
        kinds = [one for one in kinds if one[0] != "inverse" or ("transposed", one[1]) not in kinds]
    found = {kind for kind, _ in kinds}
    for kind, lesser in LESSER.items():
        if kind in found:
            kinds = [one for one in kinds if one[0] not in lesser]
    kinds = [one for one in kinds if one[0] == "whole_numbers"] or kinds  # most edits make decimals of them
    texts = list(dict.fromkeys(_one(kind, what) for kind, what in kinds))
    if len(texts) > 2:
        return TEXTS["somewhere"]
    return ("; or " if any(" or " in text for text in texts) else " or ").join(texts)


def _one(kind: str, what: str) -> str:
    if kind.startswith("every_"):
        kind = kind.removeprefix("every_")
        if kind in EVERY:
            return EVERY[kind].format(what)
        where = f"in every {WHOLE[what]}" if what in WHOLE else f"wherever `{what}` stands"
        return f"{TEXTS[kind].format(what)}, {where}"
    return TEXTS[kind].format(what)
