"""The line that opens a function of the student in 3D, for the end of a failing check's text.

Only words: `view` is not imported here. Whatever such a line opens takes the function as `mine=...`.
"""

from __future__ import annotations

from .exercise import Exercise

# name of the exercise -> what opens it, on an arm of the course
OPENERS = {
    **dict.fromkeys(
        ("dh_transform", "mdh_transform", "fk_dh", "screw_exp", "fk_poe", "screws_from_dh"),
        "explore(robots.kuka_kr6(), {mine})",
    ),
    **dict.fromkeys(("screw_axis", "axis_of", "body_screws"), "explore_screws(robots.kuka_kr6(), {mine})"),
    "home_pose": "explore_screws(robots.abb_irb1200(), {mine})",
    **dict.fromkeys(
        ("wrist_centre", "elbow_solutions", "wrist_angles", "all_solutions", "newton_step"),
        "explore_inverse(robots.kuka_kr6(), {mine})",
    ),
    **dict.fromkeys(
        ("det_from_blocks", "elbow_angle", "shoulder_theta3", "rank", "lost_motion"),
        "explore_singularities(robots.kuka_kr6(), {mine})",
    ),
    **dict.fromkeys(
        (
            *("jacobian_space", "jacobian_geometric", "jacobian_by_differences", "jacobian_column"),
            *("transform_rate", "torques", "ellipsoid", "dls_step", "dls_loop"),
        ),
        "explore_jacobians(robots.franka_panda(), {mine})",
    ),
    **dict.fromkeys(
        (
            *("tool_frames", "quaternion", "zyx", "angle_axis", "slerp"),
            *("next_on_branch", "inside", "largest_speed"),
        ),
        "explore_path(robots.abb_irb1200(), {mine})",
    ),
}
# where the arguments of an example are an arm: the one that it describes
ARMS = {
    "dh_transform": "explore(Robot.from_dh(dh.Table([a], [alpha], [d], [0])), theta=[theta], {mine})",
    "mdh_transform": (
        'explore(Robot.from_dh(dh.Table([a_prev], [alpha_prev], [d], [0], "modified")), '
        "theta=[theta], {mine})"
    ),
    "fk_dh": "explore(Robot.from_dh(dh.Table(*rows.T, base=base, tool=tool)), theta=theta, {mine})",
    "screws_from_dh": 'explore(Robot.from_dh(dh.Table(*rows.T, "modified", base=base)), {mine})',
    "screw_axis": "explore_screws(Robot.from_axes([w], [q], np.eye(4)), {mine})",
}


def line(exercise: Exercise, written: str) -> str:
    """What opens the function called `written`, '' where there is nothing to see of the exercise.

    >>> from coursekit.classroom.exercises.nb06 import EXERCISES
    >>> line(EXERCISES[2], "zyx")
    'view.explore_path(robots.abb_irb1200(), mine=zyx)'
    """
    if exercise.name not in OPENERS:
        return ""
    return f"view.{OPENERS[exercise.name].format(mine=_mine(exercise, written))}"


def lines(exercise: Exercise, written: str, number: int) -> list[str]:
    """The same on the arm of an example, to paste; where an example is no arm, the line alone."""
    if exercise.name not in ARMS:
        return [found] if (found := line(exercise, written)) else []
    return [
        "from coursekit import Robot, classroom, dh, view",
        f"{', '.join(exercise.arguments)} = classroom.example({exercise.name!r}, {number})",
        f"view.{ARMS[exercise.name].format(mine=_mine(exercise, written))}",
    ]


def _mine(exercise, written):
    return f"mine={written}" if written == exercise.name else f"mine={{{exercise.name!r}: {written}}}"
