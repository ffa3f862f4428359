"""The cubic spline through given points: a cubic between any two, smooth up to the second derivative.

With h_i = x_(i+1) - x_i, slopes s_i = (y_(i+1) - y_i) / h_i and second derivatives c_i at the knots, equal
first derivatives on both sides of knot i mean

    h_(i-1) c_(i-1) + 2 (h_(i-1) + h_i) c_i + h_i c_(i+1) = 6 (s_i - s_(i-1))

and nothing is known about the ends. "Not a knot" takes the first two pieces as one cubic, and the last two:
(c_1 - c_0) / h_0 = (c_2 - c_1) / h_1. Source: de Boor, A Practical Guide to Splines (1978), chapter IV.
"""

import numpy as np


def not_a_knot(x: np.ndarray, y: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The spline through y (m, d) at the increasing knots x (m,), evaluated at (k,). -> (k, d)

    Two points give a straight line, three a parabola.

    >>> x = np.array([0, 1, 3, 4.0])
    >>> not_a_knot(x, (x**3)[:, None], np.array([2.0])).round(12).tolist()     # a cubic is its own spline
    [[8.0]]
    """
    h = np.diff(x)[:, None]
    s = np.diff(y, axis=0) / h
    c = second_derivatives(h, s)
    i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    t = (at - x[i])[:, None]
    slope = s[i] - h[i] * (2 * c[i] + c[i + 1]) / 6
    return y[i] + t * (slope + t * (c[i] / 2 + t * (c[i + 1] - c[i]) / (6 * h[i])))


def second_derivatives(h: np.ndarray, s: np.ndarray) -> np.ndarray:
    """c (m, d) of the spline with steps h (m - 1, 1) and slopes s (m - 1, d)."""
    c = np.zeros((len(h) + 1, s.shape[1]))
    if len(h) == 1:
        return c
    c[1:-1] = 6 * np.diff(s, axis=0)  # right-hand sides first, then the c_i themselves
    if len(h) == 2:
        return np.tile(c[1] / (3 * (h[0] + h[1])), (3, 1))
    below, on, above = h[:-1].copy(), 2 * (h[:-1] + h[1:]), h[1:].copy()
    # "not a knot": c_0 = c_1 - h_0 / h_1 (c_2 - c_1), and so for the last
    on[0] += h[0] * (1 + h[0] / h[1])
    above[0] -= h[0] ** 2 / h[1]
    on[-1] += h[-1] * (1 + h[-1] / h[-2])
    below[-1] -= h[-1] ** 2 / h[-2]
    for i in range(1, len(on)):  # elimination: row i loses its c_(i-1)
        factor = below[i] / on[i - 1]
        on[i] -= factor * above[i - 1]
        c[i + 1] -= factor * c[i]
    c[-2] /= on[-1]
    for i in range(len(on) - 2, -1, -1):
        c[i + 1] = (c[i + 1] - above[i] * c[i + 2]) / on[i]
    c[0] = c[1] - h[0] / h[1] * (c[2] - c[1])
    c[-1] = c[-2] + h[-1] / h[-2] * (c[-2] - c[-3])
    return c
