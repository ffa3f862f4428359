"""Messages of Python and numpy that a beginner cannot read, in plain words."""

from __future__ import annotations

# a part of the message -> what it means, and the usual way out
WORDS = {
    "construct a dtype from": "np.array takes one list, np.array([a, b]); np.concatenate([u, v]) joins two",
    "inhomogeneous shape": "the pieces have different lengths; np.linalg.svd, for one, returns three things",
    "matmul: Input operand": "in A @ B, A must have as many columns as B has rows",
    "solve1: Input operand": "in solve(A, b), b must have as many entries as A has rows",
    "could not be broadcast together": "entry by entry, shapes must be equal; x[:, None] is a column",
    "could not broadcast input": "what is stored must fit the place it is stored in",
    "'NoneType'": "None is what a function without a `return` gives",
    "is out of bounds": "numpy counts from 0; examples differ in size",
    "values to unpack": "a, b = x takes the rows of x; x.T has its columns as rows",
    "Cannot cast ufunc": "whole numbers take no decimals: x = x / 2, not x /= 2",
    "truth value of an array": "an array answers for each entry: (a <= x) & (x <= b), and np.all joins them",
    "Singular matrix": "there is no inverse here; np.linalg.pinv does without",
    "encountered in power": "a root of a negative number; and ** works entry by entry, not on a matrix",
    "must be square": "an inverse or a determinant needs a square matrix; np.linalg.pinv takes any",
    "only integer": "an index must be a whole number",
    "not tuple": "a list has no [i, j]: make an array of it first, with np.array",
    "setting an array element with a sequence": "one entry of an array holds one number, not a vector",
    "encountered in sqrt": "the root of a negative number: if only rounding made it so, np.maximum(x, 0)",
    "encountered in arccos": "the arccosine of a number beyond 1",
    "encountered in arcsin": "the arcsine of a number beyond 1",
    "divide by zero": "a division by 0",
    "encountered in divide": "0 divided by 0",
    "encountered in scalar divide": "0 divided by 0",
    "bitwise_xor": "a power is written x ** 2; ^ does something else, with bits",
    "object is not callable": "round brackets call a function: a * is missing, or square ones are meant",
    "object is not subscriptable": "square brackets take a part of an array: round ones call a function",
}


def in_plain_words(message: str) -> str:
    """What an error's message means, '' if it is plain already.

    >>> in_plain_words("Last 2 dimensions of the array must be square")
    'an inverse or a determinant needs a square matrix; np.linalg.pinv takes any'
    """
    return next((words for part, words in WORDS.items() if part in message), "")
