"""The exercise of notebook 05 about a whole run of damped steps."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _jacobians as draws
from coursekit.classroom.exercises import _nb05 as residuals
from coursekit.classroom.exercises import looks


def _starts_at_theta(f, args, rows):
    """The first row is where the run begins."""
    return bool(np.allclose(rows[0], args[2], atol=1e-12))


DLS_LOOP = Exercise(
    "dls_loop(robot, T_sd, theta, k, steps)",
    look=looks.end_of_run,
    points=3,
    draw=draws.run,
    shape=(None, None),
    unit="rad",
    laws=(("the first row is the start", _starts_at_theta),),
    samples=3,
    n=12,
    timeout=20.0,
    usual="for an ordinary start",
    blocks=(Block("the start", np.s_[0]), Block("the first step", np.s_[1]), Block("the end", np.s_[-1])),
    edges=(
        Edge("for one step", lambda rng: draws.run(rng, steps=1)),
        Edge("for an arm with seven joints", lambda rng: draws.run(rng, "franka_panda")),
        Edge("where the arm is there already", lambda rng: draws.run(rng, off=0.0, steps=2)),
        Edge("where the arm is nearly there", lambda rng: draws.run(rng, off=2e-4, steps=3)),
        Edge("for a k of 1", lambda rng: draws.run(rng, k=1.0)),
        Edge("from a singular start", draws.run_from_a_singular_start),
        Edge("where a joint passes half a turn", draws.run_past_half_a_turn),
        Edge("for whole numbers", draws.run_of_whole_numbers),
        Edge("where joints have turned more than once", draws.run_of_turned_joints),
    ),
    residual=residuals.target_missed,
    hints=(
        Hint("space_error", "e must lie along the tool, as J_b does: log(T_sb^-1 T_sd)"),
        Hint(
            "backwards",
            "your steps lead away from the target: look at the sign, and at which pose e inverts",
        ),
        Hint("frozen", "J_b has to be computed anew in every step: it changes with theta"),
        Hint("one_error", "e has to be computed anew in every step: the arm has moved"),
        Hint("from_the_start", "every step must begin where the last one ended"),
        Hint(
            "space_jacobian",
            "e is seen from the tool, so it wants J_b: J_s gives twists of another point",
        ),
        Hint("other_jacobian", "e is a body twist: it wants J_b, not the Jacobian along the base"),
        Hint("undamped", "k makes no difference to your run: these are Newton's steps"),
        Hint("inverse_of_both", "inverse(A @ B) inverts the product: in e only T_sb is inverted"),
        Hint("steps_stored", "from the second row on these are steps: add each to theta, and store theta"),
        Hint("one_step_stored", "the arm does not move: add each step to theta, and store theta"),
        Hint("from_zero", "the run begins at zero: its first row is theta, and the first step starts there"),
    ),
)
