"""Inverse kinematics: every solution in closed form, and three numeric methods.

analytic, first_joints, wrist_centre               every branch, with limits and reasons
newton, transpose, damped_least_squares            one solution from a guess, with a history
newton_step, transpose_step, dls_step              one step of each
by_the_book  trail                                 the loop around such a step, in its plainest form
search                                             distinct solutions of any arm, from random starts
"""

from .book import by_the_book, dls_step, newton_step, trail, transpose_step
from .closed_form import Solutions, analytic, first_joints, why_outside, wrist_centre
from .engine import Step
from .geometry import NoClosedForm
from .iteration import Numeric, damped_least_squares, newton, transpose
from .search import Found, search

__all__ = [
    "Found",
    "NoClosedForm",
    "Numeric",
    "Solutions",
    "Step",
    "analytic",
    "by_the_book",
    "damped_least_squares",
    "dls_step",
    "first_joints",
    "newton",
    "newton_step",
    "search",
    "trail",
    "transpose",
    "transpose_step",
    "why_outside",
    "wrist_centre",
]
