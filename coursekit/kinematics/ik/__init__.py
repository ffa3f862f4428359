"""Inverse kinematics: every solution in closed form, and three numeric methods.

analytic, arm, wrist_centre                        every branch, with limits and reasons
newton, transpose, damped_least_squares            one solution from a guess, with a history
newton_step, transpose_step, dls_step              one step of each
"""

from .closed_form import Solutions, analytic, arm, wrist_centre
from .engine import Step
from .iteration import (
    Numeric,
    damped_least_squares,
    dls_step,
    newton,
    newton_step,
    transpose,
    transpose_step,
)

__all__ = [
    "Numeric",
    "Solutions",
    "Step",
    "analytic",
    "arm",
    "damped_least_squares",
    "dls_step",
    "newton",
    "newton_step",
    "transpose",
    "transpose_step",
    "wrist_centre",
]
