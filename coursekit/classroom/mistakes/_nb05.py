"""Typical mistakes of notebook 05 in the second half: derivative of a transform, torques, a damped run."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.kinematics import lie

right = Solved("nb05")


def _differentiated(T_left, S, theta, T_right):
    """T and T-dot."""
    H = lie.exp6(S * theta)
    return T_left @ H @ T_right, T_left @ lie.hat6(S) @ H @ T_right


def _read(V):
    """(omega; v) of [[ [omega], v ], [0, 0]]."""
    return lie.vee6(np.asarray(V, float))


def rate_not_turned_back(T_left, S, theta, T_right):
    _, T_dot = _differentiated(T_left, S, theta, T_right)
    return T_dot, _read(T_dot)


def rate_by_whole_inverse(T_left, S, theta, T_right):
    T, T_dot = _differentiated(T_left, S, theta, T_right)
    return T_dot, _read(T_dot @ lie.inverse(T))


def rate_in_body(T_left, S, theta, T_right):
    T, T_dot = _differentiated(T_left, S, theta, T_right)
    return T_dot, _read(lie.inverse(T) @ T_dot)


def rate_left_and_right_swapped(T_left, S, theta, T_right):  # Innopolis assignment 3, its words
    return right.transform_rate(T_right, S, theta, T_left)


def rate_at_zero(T_left, S, theta, T_right):
    T = T_left @ lie.exp6(S * theta) @ T_right
    T_dot = T_left @ lie.hat6(S) @ T_right
    R_o = np.eye(4)
    R_o[:3, :3] = T[:3, :3].T
    return T_dot, _read(T_dot @ R_o)


def rate_seen_from_base(T_left, S, theta, T_right):
    T, _ = _differentiated(T_left, S, theta, T_right)
    T_dot, R_o = lie.hat6(S) @ T, np.eye(4)
    R_o[:3, :3] = T[:3, :3].T
    return T_dot, _read(T_dot @ R_o)


def rate_undifferentiated(T_left, S, theta, T_right):
    T, _ = _differentiated(T_left, S, theta, T_right)
    return T, np.array([T[2, 1], T[0, 2], T[1, 0], *T[:3, 3]])


def rate_rows_swapped(T_left, S, theta, T_right):  # Innopolis assignment 3
    T_dot, column = right.transform_rate(T_left, S, theta, T_right)
    return T_dot, np.roll(column, 3)


def rate_of_the_other_entries(T_left, S, theta, T_right):
    T_dot, column = right.transform_rate(T_left, S, theta, T_right)
    return T_dot, column * [-1, -1, -1, 1, 1, 1]


def _torques(J_b, R, moment, force):
    return J_b.T @ np.concatenate([R @ moment, R @ force])


def torques_not_turned(J_b, T, moment, force):
    return _torques(J_b, np.eye(3), moment, force)


def torques_turned_wrong_way(J_b, T, moment, force):
    return _torques(J_b, T[:3, :3], moment, force)


def torques_rows_swapped(J_b, T, moment, force):
    return _torques(J_b, T[:3, :3].T, force, moment)


def torques_by_inverse(J_b, T, moment, force):
    R = T[:3, :3].T
    return np.linalg.pinv(J_b) @ np.concatenate([R @ moment, R @ force])


def torques_without_moment(J_b, T, moment, force):
    return _torques(J_b, T[:3, :3].T, 0 * moment, force)


def torques_about_base(J_b, T, moment, force):
    return _torques(J_b, T[:3, :3].T, moment + np.cross(T[:3, 3], force), force)


def torques_with_the_point_moved(J_b, T, moment, force):
    return J_b.T @ lie.adjoint(T).T @ np.concatenate([moment, force])


def torques_against(J_b, T, moment, force):
    return -_torques(J_b, T[:3, :3].T, moment, force)


def _error(robot, T_sd, theta):
    return lie.log6(lie.inverse(robot.fk(theta)) @ T_sd)


def _loop(step):
    """A run whose next step is step(robot, T_sd, rows so far, k)."""

    def run(robot, T_sd, theta, k, steps):
        rows = [np.asarray(theta, float)]
        for _ in range(steps):
            rows.append(step(robot, T_sd, rows, k))
        return np.array(rows)

    return run


def _next(robot, e, rows, k):
    return rows[-1] + right.dls_step(robot.jacobian_body(rows[-1]), e, k)


def loop_space_error(robot, T_sd, rows, k):
    return _next(robot, lie.log6(T_sd @ lie.inverse(robot.fk(rows[-1]))), rows, k)


def loop_backwards(robot, T_sd, rows, k):
    return _next(robot, lie.log6(lie.inverse(T_sd) @ robot.fk(rows[-1])), rows, k)


def loop_frozen(robot, T_sd, rows, k):
    return rows[-1] + right.dls_step(robot.jacobian_body(rows[0]), _error(robot, T_sd, rows[-1]), k)


def loop_with_one_error(robot, T_sd, rows, k):
    return _next(robot, _error(robot, T_sd, rows[0]), rows, k)


def loop_from_the_start(robot, T_sd, rows, k):
    return rows[0] + right.dls_step(robot.jacobian_body(rows[-1]), _error(robot, T_sd, rows[-1]), k)


def loop_with_the_other_jacobian(robot, T_sd, rows, k):
    return rows[-1] + right.dls_step(robot.jacobian_geometric(rows[-1]), _error(robot, T_sd, rows[-1]), k)


def loop_with_the_space_jacobian(robot, T_sd, rows, k):
    return rows[-1] + right.dls_step(robot.jacobian_space(rows[-1]), _error(robot, T_sd, rows[-1]), k)


def loop_with_both_inverted(robot, T_sd, rows, k):
    return _next(robot, lie.log6(lie.inverse(robot.fk(rows[-1]) @ T_sd)), rows, k)


def loop_of_steps(robot, T_sd, theta, k, steps):
    rows = right.dls_loop(robot, T_sd, theta, k, steps)
    return np.vstack([rows[:1], np.diff(rows, axis=0)])


def loop_of_one_step(robot, T_sd, theta, k, steps):
    return loop_of_steps(robot, T_sd, theta, k, steps)[[0] + [1] * steps]


def loop_from_zero(robot, T_sd, theta, k, steps):
    return right.dls_loop(robot, T_sd, np.zeros(len(theta)), k, steps)


def loop_undamped(robot, T_sd, rows, k):
    return rows[-1] + np.linalg.pinv(robot.jacobian_body(rows[-1])) @ _error(robot, T_sd, rows[-1])


WRONG = {
    "transform_rate": {
        "no_turn_back": rate_not_turned_back,
        "space": rate_by_whole_inverse,
        "body": rate_in_body,
        "swapped": rate_left_and_right_swapped,
        "at_zero": rate_at_zero,
        "seen_from_base": rate_seen_from_base,
        "undifferentiated": rate_undifferentiated,
        "rows_swapped": rate_rows_swapped,
        "wrong_entries": rate_of_the_other_entries,
    },
    "torques": {
        "not_turned": torques_not_turned,
        "turned_wrong_way": torques_turned_wrong_way,
        "rows_swapped": torques_rows_swapped,
        "inverse": torques_by_inverse,
        "no_moment": torques_without_moment,
        "about_base": torques_about_base,
        "point_moved": torques_with_the_point_moved,
        "against": torques_against,
    },
    "dls_loop": {
        "space_error": _loop(loop_space_error),
        "backwards": _loop(loop_backwards),
        "frozen": _loop(loop_frozen),
        "one_error": _loop(loop_with_one_error),
        "from_the_start": _loop(loop_from_the_start),
        "space_jacobian": _loop(loop_with_the_space_jacobian),
        "other_jacobian": _loop(loop_with_the_other_jacobian),
        "undamped": _loop(loop_undamped),
        "inverse_of_both": _loop(loop_with_both_inverted),
        "steps_stored": loop_of_steps,
        "one_step_stored": loop_of_one_step,
        "from_zero": loop_from_zero,
    },
}
