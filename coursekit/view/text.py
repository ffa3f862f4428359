"""Numbers as text: every number that a notebook prints passes here, so that it prints the same everywhere.

Fixed digits, rounded, never "-0", NaN as "-", columns aligned. Every function returns a str; nothing prints.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import checks, rotations

NOTHING = "-"  # how a missing number (NaN, None) looks
GUARD = 6  # digits beyond the shown ones that are rounded first


def number(x: float | np.ndarray, digits: int = 3) -> str:
    """One number with `digits` decimals.

    Rounded twice: 0.0625 lies halfway between 0.062 and 0.063, and without the first rounding a rest of 1e-17
    would decide which of them is shown.

    >>> number(0.0625 - 1e-17), number(-1e-17), number(np.nan), number(12.4, digits=0)
    ('0.062', '0.000', '-', '12')
    """
    x = float(x)
    if np.isnan(x):
        return NOTHING
    if np.isinf(x):
        return "inf" if x > 0 else "-inf"
    rounded = round(round(x, digits + GUARD), digits)
    return f"{rounded + 0.0:.{digits}f}"  # -0.0 + 0.0 is 0.0


def scientific(x: float | np.ndarray, digits: int = 2) -> str:
    """One number with `digits` significant digits and a power of ten, for sizes that span many of them.

    >>> scientific(0.00001432), scientific(0), scientific(np.nan)
    ('1.4e-05', '0', '-')
    """
    x = float(x)
    if np.isnan(x):
        return NOTHING
    return "0" if x == 0 else f"{x:.{digits - 1}e}"


def below(x: ArrayLike, bound: float) -> str:
    """The verdict on a difference that should be nothing but rounding: x is one number or an array of them.

    Says the bound and not the difference itself, which is another one on every machine.

    >>> below(3e-16, 2e-15), below([0.1, -0.25], 1e-12)
    ('below 2e-15', 'NOT below 1e-12: 0.25')
    """
    x = np.asarray(x, dtype=float)
    if np.isnan(x).any():
        return f"NOT below {bound:.0e}: not a number"
    worst = np.abs(x).max(initial=0.0)
    return f"below {bound:.0e}" if worst <= bound else f"NOT below {bound:.0e}: {worst:.2g}"


def row(values: ArrayLike, digits: int = 3) -> str:
    """Numbers in one line. values (n,).

    >>> row([0.445, -0.0, 0.9])
    '(0.445, 0.000, 0.900)'
    """
    return "(" + ", ".join(number(x, digits) for x in np.ravel(values)) + ")"


def degrees(q: ArrayLike, digits: int = 1) -> str:
    """Angles given in radians, shown in degrees: one, or a row of them.

    >>> degrees(np.pi / 4), degrees([0, -np.pi / 2])
    ('45.0 deg', '(0.0, -90.0) deg')
    """
    return _with_unit(np.degrees(q), digits, "deg")


def millimetres(p: ArrayLike, digits: int = 1) -> str:
    """Lengths given in metres, shown in millimetres: one, or a row of them.

    >>> millimetres(0.98), millimetres([0.445, 0, 0.9])
    ('980.0 mm', '(445.0, 0.0, 900.0) mm')
    """
    return _with_unit(1000 * np.asarray(p, dtype=float), digits, "mm")


def joints(types: Sequence[str], theta: ArrayLike) -> str:
    """Joint values (n,) in radians and metres: one unit for all, or each with its own where some slide.

    >>> joints(["revolute", "prismatic"], [0.5, 0.1])
    '(28.6 deg, 100.0 mm)'
    """
    if "prismatic" not in types:
        return degrees(theta)
    say = {"revolute": degrees, "prismatic": millimetres}
    return "(" + ", ".join(say[kind](q) for kind, q in zip(types, np.asarray(theta), strict=True)) + ")"


def pose(T: ArrayLike) -> str:
    """Position and ZYX angles of a pose in one line. T (4, 4).

    >>> pose([[0, -1, 0, 0.4], [1, 0, 0, 0], [0, 0, 1, 0.9], [0, 0, 0, 1]])
    'position (400.0, 0.0, 900.0) mm, yaw pitch roll (90.0, 0.0, 0.0) deg'
    """
    T = checks.array(T, (4, 4), "T")
    R = T[:3, :3].round(12) + 0.0  # half a turn is 180 deg, whatever the sign of the zeros in R
    return f"position {millimetres(T[:3, 3])}, yaw pitch roll {degrees(rotations.zyx(R))}"


def matrix(A: ArrayLike, digits: int = 3) -> str:
    """A matrix, its columns aligned. A (m, n); a vector is one line.

    >>> print(matrix([[1, 0, 0.98], [0, -1, 0]]))
    1.000   0.000  0.980
    0.000  -1.000  0.000
    """
    cells = [[number(x, digits) for x in line] for line in np.atleast_2d(A)]
    return _aligned(cells, left=[False] * len(cells[0]))


def table(
    rows: Iterable[Iterable], header: Sequence[str] | None = None, digits: int | Sequence[int] = 3
) -> str:
    """A table. rows: lines of cells, each a number, a truth value, None or text; header: a name per column.

    digits: decimals of the numbers that are not whole, one for all columns or one per column. Columns of
    numbers are set to the right, columns with text to the left.

    >>> print(table([["elbow", 0.0831412, True], ["wrist", 0, False]], ["singularity", "angle", "inside"]))
    singularity  angle  inside
    -----------  -----  ------
    elbow        0.083  yes
    wrist            0  no
    """
    lines = [list(line) for line in rows]
    width = len(header) if header is not None else len(lines[0]) if lines else 0
    if any(len(line) != width for line in lines):
        raise ValueError(
            f"every row of the table must have {width} cells, got {[len(line) for line in lines]}"
        )
    digits = [digits] * width if isinstance(digits, int | np.integer) else list(digits)
    if len(digits) != width:
        raise ValueError(f"digits must be one number or one for each of {width} columns, got {len(digits)}")
    cells = [[_cell(value, d) for value, d in zip(line, digits, strict=True)] for line in lines]
    words = [any(isinstance(line[i], str | bool | np.bool_) for line in lines) for i in range(width)]
    if header is None:
        return _aligned(cells, words)
    rule = ["-" * max(len(line[i]) for line in [header, *cells]) for i in range(width)]
    return _aligned([header, rule, *cells], words)


def _aligned(cells, left):
    """Lines of text with aligned columns. cells: rows of text; left: which columns are set to the left."""
    widths = [max(len(line[i]) for line in cells) for i in range(len(left))]
    lines = []
    for line in cells:
        set_cells = [
            c.ljust(w) if to_left else c.rjust(w) for c, w, to_left in zip(line, widths, left, strict=True)
        ]
        lines.append("  ".join(set_cells).rstrip())
    return "\n".join(lines)


def _cell(value, digits):
    """One cell of a table as text."""
    if value is None:
        return NOTHING
    if isinstance(value, str):
        return value
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, int | np.integer):
        return str(value)
    return number(value, digits)


def _with_unit(values, digits, unit):
    """'45.0 deg' for one number, '(0.0, 45.0) deg' for several."""
    return f"{number(values, digits) if np.ndim(values) == 0 else row(values, digits)} {unit}"
