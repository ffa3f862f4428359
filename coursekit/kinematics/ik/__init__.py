"""Inverse kinematics: every solution in closed form, and three numeric methods.

analytic, arm, wrist_centre                        every branch, with limits and reasons
newton, transpose, damped_least_squares            one solution from a guess, with a history
newton_step, transpose_step, dls_step              one step of each
by_the_book  trail                                 the loop around such a step, in its plainest form
search                                             distinct solutions of any arm, from random starts
"""

from .closed_form import Solutions, analytic, arm, wrist_centre
from .engine import Step
from .iteration import (
    Numeric,
    by_the_book,
    damped_least_squares,
    dls_step,
    newton,
    newton_step,
    trail,
    transpose,
    transpose_step,
)
from .search import Found, search

__all__ = [
    "Found",
    "Numeric",
    "Solutions",
    "Step",
    "analytic",
    "arm",
    "by_the_book",
    "damped_least_squares",
    "dls_step",
    "newton",
    "newton_step",
    "search",
    "trail",
    "transpose",
    "transpose_step",
    "wrist_centre",
]
