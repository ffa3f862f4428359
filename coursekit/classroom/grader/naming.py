"""What the name of a downloaded file says: whose it is, of which notebook, which attempt, whether it is late.

The forms, as the systems document them:

    Canvas     lastnamefirstname_LATE_12345_67890_file-1.ipynb    (user, attachment; -1: a second attempt)
    Moodle     Name_123456_assignsubmission_file_/file.ipynb      (participant); without folders file follows
    nbgrader   submitted/STUDENT/ASSIGNMENT/file.ipynb, or in the exchange STUDENT+ASSIGNMENT+TIME+.../
    the site   coursekit-work-STUDENT.zip
    others     STUDENT/.../file.ipynb, or STUDENT.zip
"""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime

from ..roster import Student

_CANVAS = re.compile(r"(?P<who>[^/]+?)_(?:(?P<late>LATE)_)?(?P<user>\d+)_(?P<attempt>\d+)_(?P<file>.+)")
_MOODLE = re.compile(r"(?P<who>.+?)_(?P<user>\d+)_assignsubmission_(?:file|onlinetext)_?(?P<file>.*)")
_EXCHANGE = re.compile(r"(?P<who>[^+]+)\+[^+]+\+(?P<time>\d{4}-\d\d-\d\d \d\d.\d\d.\d\d)[^+]*(\+.*)?")
_COPY = re.compile(r"(?:-|_|\s*\(|-?\s*copy\s*)(?P<number>\d*)\)?$", re.I)
NOTEBOOK = re.compile(r"\.ipynb(\.txt|\.json)?$", re.I)  # browsers name text as they like
TABLE = "collected.csv"  # lies beside the students' folders
WRAPPERS = ("submitted", "submissions", "inbound", "collected", "notebooks", "work")  # nobody's names


@dataclass(frozen=True)
class Told:
    """What a path tells.

    who     : names that the student may go by, the surest first
    file    : the notebook's name as it was handed in
    attempt : numbers that tell a later attempt from an earlier one of the same student
    """

    who: tuple[str, ...]
    file: str
    attempt: tuple = ()
    late: bool = False
    time: datetime | None = None
    canvas: str = ""
    moodle: str = ""


def told(parts: tuple[str, ...], knows: Callable[[str], bool] = lambda name: False) -> Told:
    """What the path of a file says, from the folder that was downloaded down to the file.

    knows : is this somebody's name? What stands in their folder or zip, they have named themselves: whoever
        calls a file there as a learning platform would does not speak for a classmate.

    >>> told(("leeann_LATE_12_345_01_dh_vs_poe-1.ipynb",)).who
    ('leeann', '12')
    """
    *folders, last = parts
    names = tuple(re.sub(r"^coursekit-work-|( \(\d+\))?\.zip$", "", part, flags=re.I) for part in folders)
    for part, name in zip(parts, (*names, ""), strict=True):
        if knows(name):
            break
        if found := _EXCHANGE.fullmatch(part):
            digits = re.sub(r"\D", " ", found["time"])
            time = datetime.strptime(digits, "%Y %m %d %H %M %S")
            return Told((found["who"],), last, (int(digits.replace(" ", "")),), time=time)
        if found := _MOODLE.fullmatch(part):
            file = (found["file"] or last) if part == last else last
            return Told((found["who"], found["user"]), file, moodle=found["user"])
        if found := _CANVAS.fullmatch(part):
            file, late = found["file"] if part == last else last, bool(found["late"])
            attempt = (int(found["attempt"]),)
            return Told((found["who"], found["user"]), file, attempt, late, canvas=found["user"])
    return Told(tuple(name for name in names if name.lower() not in WRAPPERS), last)


def notebook_of(file: str, expected: list[str]) -> tuple[str, int] | None:
    """(the course's notebook that a file is, number of the copy), or None.

    >>> notebook_of("01_dh_vs_poe (2).ipynb", ["01_dh_vs_poe.ipynb"])
    ('01_dh_vs_poe.ipynb', 2)
    """
    stem, number = NOTEBOOK.sub("", file), 0
    known = {_plain(name.removesuffix(".ipynb")): name for name in expected}
    for _ in range(4):  # "01_dh_vs_poe-Copy1 (2)-1"
        if _plain(stem) in known:
            return known[_plain(stem)], number
        found = _COPY.search(stem)
        if not found or not stem[: found.start()]:
            break
        number, stem = max(number, int(found["number"] or 1)), stem[: found.start()]
    inside = [name for plain, name in known.items() if plain in _plain(stem)]  # "ann_01_dh_vs_poe_final"
    return (inside[0], number) if len(inside) == 1 else None


@dataclass
class Register:
    """Finds students of a roster by whatever a file calls them; without one everybody is who they say."""

    students: list[Student] | None = None
    _known: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))

    def __post_init__(self) -> None:
        for student in self.students or ():
            for name in (student.id, student.email, student.email.partition("@")[0], *student.aliases):
                self._known[_plain(name)].add(student.id)
            words = student.name.replace(",", " ").split()
            for k in range(len(words)):  # "Ann Mary Lee" is "leeannmary" in Canvas
                self._known[_plain("".join(words[k:] + words[:k]))].add(student.id)
        self._known.pop("", None)

    def knows(self, name: str) -> bool:
        """Is somebody of the roster called so?"""
        return _plain(name) in self._known

    def find(self, names: tuple[str, ...]) -> tuple[str, str]:
        """(the student's id, ""), or ("", why there is none)."""
        names = tuple(name for name in names if _plain(name))
        if not names:
            return "", "nothing in its path names a student"
        if self.students is None:
            return safe(names[0]), ""
        for name in names:
            found = self._known.get(_plain(name), set())
            if len(found) > 1:
                return "", f"{name} may be {' or '.join(sorted(found))}: give them aliases in the roster"
            if found:
                return next(iter(found)), ""
        return "", f"nobody in the roster is called {' or '.join(names)}"


def safe(name: str) -> str:
    """A name for a folder, on every system."""
    name = unicodedata.normalize("NFC", name)  # as macOS writes "ü" it is two letters
    name = "".join(c if c.isprintable() and c not in '/\\:*?"<>|' else "_" for c in name).strip(" .")
    if name[:1] in ("", "=", "+", "-", "@") or name.lower() == TABLE:  # no formula in a table, nor the table
        name = f"_{name}"
    return name[:80].encode()[:240].decode(errors="ignore")  # a folder's name has 255 bytes, not letters


def printable(text: str) -> str:
    """On one line: a name may otherwise wipe what is on a terminal, or turn the letters of a page around."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _plain(name: str) -> str:
    """Letters and digits only, without case and accents: 'Müller, Ann' is 'mullerann'.

    In the scripts of India and its neighbours vowels are signs, too. They are no accents (nor are they the
    points of Hebrew and Arabic, which are mostly left out), and Unicode's classes of signs tell them apart.
    """
    letters = unicodedata.normalize("NFKD", name.casefold())
    return "".join(c for c in letters if c.isalnum() or _is_a_vowel(c))


def _is_a_vowel(c: str) -> bool:
    place = unicodedata.combining(c)
    return unicodedata.category(c) in ("Mn", "Mc") and (place < 10 or 100 <= place < 200)
