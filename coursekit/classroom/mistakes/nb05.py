"""Typical mistakes of notebook 05."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.mistakes import Solved
from coursekit.classroom.mistakes import _nb05 as more
from coursekit.kinematics import lie, rotations

right = Solved("nb05")


def _moved(S, products):
    """Column i is Ad(products[i]) S_i."""
    return np.column_stack([lie.adjoint(T) @ s for T, s in zip(products, S.T, strict=True)])


def _before(S, theta):
    """e^[S_1]theta_1 ... e^[S_{i-1}]theta_{i-1} for every i."""
    products = [np.eye(4)]
    for s, angle in zip(S.T[:-1], theta[:-1], strict=True):
        products.append(products[-1] @ lie.exp6(s * angle))
    return products


def space_at_zero(S, theta):
    return S.copy()


def space_moved_by_later_joints(S, theta):
    return right.jacobian_space(S[:, ::-1], -theta[::-1])[:, ::-1]


def space_reversed(S, theta):
    products = [np.eye(4)]
    for s, angle in zip(S.T[:-1], theta[:-1], strict=True):
        products.append(lie.exp6(s * angle) @ products[-1])
    return _moved(S, products)


def space_moved_back(S, theta):
    return _moved(S, [lie.inverse(T) for T in _before(S, theta)])


def space_by_the_joint_before(S, theta):
    before = [lie.exp6(s * angle) for s, angle in zip(S.T[:-1], theta[:-1], strict=True)]
    return _moved(S, [np.eye(4), *before])


def space_without_theta(S, theta):
    return right.jacobian_space(S, np.ones(len(theta)))


def space_one_short(S, theta):
    return _moved(S, [np.eye(4), *_before(S, theta)[:-1]])


def geometric_reversed(axes, origins, tool):
    return right.jacobian_geometric(axes, origins, tool) * np.repeat([[1], [-1]], 3, axis=0)


def geometric_rows_swapped(axes, origins, tool):  # Innopolis assignment 3
    return np.roll(right.jacobian_geometric(axes, origins, tool), 3, axis=0)


def geometric_next_axis(axes, origins, tool):
    after = [*range(1, len(axes)), len(axes) - 1]
    return right.jacobian_geometric(axes[after], origins[after], tool)


def geometric_from_base(axes, origins, tool):
    return right.jacobian_geometric(axes, 0 * origins, tool)


def geometric_space(axes, origins, tool):
    return right.jacobian_geometric(axes, origins, 0 * tool)


def geometric_entry_by_entry(axes, origins, tool):
    return np.vstack([np.transpose(axes), np.transpose(axes * (tool - origins))])


def _quotients(fk, theta, step):
    """The pose behind and the pose ahead of theta, one joint moved at a time."""
    moves = step * np.eye(len(theta))
    return fk(theta - moves), fk(theta + moves)


def _columns(w, v):
    return np.column_stack([w, v]).T


def differences_forward(fk, theta, step):
    here, ahead = fk(theta), fk(theta + step * np.eye(len(theta)))
    w = lie.log3(ahead[:, :3, :3] @ here[:3, :3].T)
    return _columns(w, ahead[:, :3, 3] - here[:3, 3]) / step


def differences_by_one_step(fk, theta, step):
    return 2 * right.jacobian_by_differences(fk, theta, step)


def differences_in_body(fk, theta, step):
    R = fk(theta)[:3, :3]
    J = right.jacobian_by_differences(fk, theta, step)
    return np.vstack([R.T @ J[:3], R.T @ J[3:]])


def differences_turn_in_tool(fk, theta, step):
    J = right.jacobian_by_differences(fk, theta, step)
    return np.vstack([fk(theta)[:3, :3].T @ J[:3], J[3:]])


def differences_in_space(fk, theta, step):
    J, p = right.jacobian_by_differences(fk, theta, step), fk(theta)[:3, 3]
    return np.vstack([J[:3], J[3:] - np.cross(J[:3].T, p).T])


def differences_of_poses(product):
    """Column i is log6(product(T_-, T_+)) / (2 step)."""

    def columns(fk, theta, step):
        return lie.log6(product(*_quotients(fk, theta, step))).T / (2 * step)

    return columns


def differences_all_at_once(fk, theta, step):
    behind, ahead = fk(theta - step), fk(theta + step)
    w = lie.log3(ahead[:3, :3] @ behind[:3, :3].T)
    column = np.concatenate([w, ahead[:3, 3] - behind[:3, 3]]) / (2 * step)
    return np.tile(column[:, None], len(theta))


def differences_of_euler_angles(fk, theta, step):
    behind, ahead = _quotients(fk, theta, step)
    turn = rotations.zyx(ahead[:, :3, :3]) - rotations.zyx(behind[:, :3, :3])
    turn = np.angle(np.exp(1j * turn))[:, ::-1]  # roll, pitch, yaw, read as turns about x, y, z
    return _columns(turn, ahead[:, :3, 3] - behind[:, :3, 3]) / (2 * step)


def differences_without_log(fk, theta, step):
    behind, ahead = _quotients(fk, theta, step)
    w = np.array([lie.vee3(R) for R in ahead[:, :3, :3] - behind[:, :3, :3]])
    return _columns(w, ahead[:, :3, 3] - behind[:, :3, 3]) / (2 * step)


def differences_of_logs(fk, theta, step):
    behind, ahead = _quotients(fk, theta, step)
    w = lie.log3(ahead[:, :3, :3]) - lie.log3(behind[:, :3, :3])
    return _columns(w, ahead[:, :3, 3] - behind[:, :3, 3]) / (2 * step)


def ellipsoid_without_root(J):
    lengths, axes = right.ellipsoid(J)
    return lengths**2, axes


def ellipsoid_in_rows(J):
    lengths, axes = right.ellipsoid(J)
    return lengths, axes.T


def ellipsoid_rows_reversed(J):
    lengths, axes = right.ellipsoid(J)
    return lengths, axes[::-1, ::-1]


def ellipsoid_ascending(J):
    lengths, axes = right.ellipsoid(J)
    return lengths[::-1], axes[:, ::-1]


def ellipsoid_half_sorted(J):
    lengths, axes = right.ellipsoid(J)
    return lengths[::-1], axes


def ellipsoid_in_joint_space(J):
    values, vectors = np.linalg.eigh(J.T @ J)
    return np.sqrt(values[::-1][:3]), vectors[:, ::-1][:, :3]


def dls_not_squared(J, e, k):
    return right.dls_step(J, e, np.sqrt(k))


def dls_everywhere(J, e, k):
    return J.T @ np.linalg.solve(J @ J.T + k**2, e)


def dls_undamped(J, e, k):
    return np.linalg.pinv(J) @ e


def dls_away(J, e, k):
    return -right.dls_step(J, e, k)


def dls_transpose(J, e, k):
    return J.T @ e


def _seen_from_tool(theta, v, turn):
    """R^T v for a matrix made of cos and sin of theta_1 + theta_2."""
    c, s = np.cos(theta.sum()), np.sin(theta.sum())
    return turn(c, s).T @ v


def velocity_with_the_exams_sign(theta, rate, lengths):  # Robotics I exam, 17 June 2019
    v_B, v_E = right.tool_velocity(theta, rate, lengths)
    return v_B * [1, -1], v_E


def velocity_by_no_rotation(theta, rate, lengths):  # Robotics I exam, 17 June 2019
    v_B, _ = right.tool_velocity(theta, rate, lengths)
    return v_B, _seen_from_tool(theta, v_B, lambda c, s: np.array([[c, -s], [-s, c]]))


def velocity_turned_wrong_way(theta, rate, lengths):
    v_B, _ = right.tool_velocity(theta, rate, lengths)
    return v_B, _seen_from_tool(theta, v_B, lambda c, s: np.array([[c, s], [-s, c]]))


def velocity_turned_by_theta2(theta, rate, lengths):
    v_B, _ = right.tool_velocity(theta, rate, lengths)
    return v_B, _seen_from_tool(theta * [0, 1], v_B, lambda c, s: np.array([[c, -s], [s, c]]))


def velocity_turned_by_theta1(theta, rate, lengths):
    v_B, _ = right.tool_velocity(theta, rate, lengths)
    return v_B, _seen_from_tool(theta * [1, 0], v_B, lambda c, s: np.array([[c, -s], [s, c]]))


def velocity_with_link2_alone(theta, rate, lengths):
    (t1, t2), (l1, l2), (r1, r2) = theta, lengths, rate
    v_B = l1 * r1 * np.array([-np.sin(t1), np.cos(t1)])
    v_B = v_B + l2 * (r1 + r2) * np.array([-np.sin(t2), np.cos(t2)])
    return v_B, _seen_from_tool(theta * [0, 1], v_B, lambda c, s: np.array([[c, -s], [s, c]]))


def velocity_with_rate2_alone(theta, rate, lengths):
    (t1, t12), (l1, l2) = np.cumsum(theta), lengths
    v_B = np.array([-l1 * np.sin(t1), l1 * np.cos(t1)]) * rate[0]
    v_B = v_B + np.array([-l2 * np.sin(t12), l2 * np.cos(t12)]) * rate[1]
    return v_B, _seen_from_tool(theta, v_B, lambda c, s: np.array([[c, -s], [s, c]]))


def velocity_by(combined):
    """With combined(that of theta_1, that of theta_2) for the sine and the cosine of the sum."""

    def velocity(theta, rate, lengths):
        (s1, s2), (c1, c2), (l1, l2) = np.sin(theta), np.cos(theta), lengths
        s12, c12 = combined(s1, s2), combined(c1, c2)
        v_B = np.array([[-l1 * s1 - l2 * s12, -l2 * s12], [l1 * c1 + l2 * c12, l2 * c12]]) @ rate
        return v_B, np.array([[c12, s12], [-s12, c12]]) @ v_B

    return velocity


def velocity_on_its_side(theta, rate, lengths):
    (t1, t12), (l1, l2) = np.cumsum(theta), lengths
    one, two = l1 * np.array([-np.sin(t1), np.cos(t1)]), l2 * np.array([-np.sin(t12), np.cos(t12)])
    v_B = np.array([one + two, two]) @ rate
    return v_B, _seen_from_tool(theta, v_B, lambda c, s: np.array([[c, -s], [s, c]]))


WRONG = {
    "jacobian_space": {
        "at_zero": space_at_zero,
        "later_joints": space_moved_by_later_joints,
        "reversed": space_reversed,
        "back": space_moved_back,
        "one_before": space_by_the_joint_before,
        "no_theta": space_without_theta,
        "one_short": space_one_short,
    },
    "jacobian_geometric": {
        "reversed": geometric_reversed,
        "rows_swapped": geometric_rows_swapped,
        "next_axis": geometric_next_axis,
        "from_base": geometric_from_base,
        "space": geometric_space,
        "entrywise": geometric_entry_by_entry,
    },
    "jacobian_by_differences": {
        "forward": differences_forward,
        "half": differences_by_one_step,
        "body_by_log6": differences_of_poses(lambda behind, ahead: lie.inverse(behind) @ ahead),
        "space_by_log6": differences_of_poses(lambda behind, ahead: ahead @ lie.inverse(behind)),
        "all_at_once": differences_all_at_once,
        "turn_in_tool": differences_turn_in_tool,
        "body": differences_in_body,
        "space": differences_in_space,
        "euler": differences_of_euler_angles,
        "no_log": differences_without_log,
        "two_logs": differences_of_logs,
    },
    "ellipsoid": {
        "no_root": ellipsoid_without_root,
        "in_rows": ellipsoid_in_rows,
        "rows_reversed": ellipsoid_rows_reversed,
        "ascending": ellipsoid_ascending,
        "half_sorted": ellipsoid_half_sorted,
        "joint_space": ellipsoid_in_joint_space,
    },
    "dls_step": {
        "not_squared": dls_not_squared,
        "everywhere": dls_everywhere,
        "undamped": dls_undamped,
        "away": dls_away,
        "transpose": dls_transpose,
    },
    "tool_velocity": {
        "sign": velocity_with_the_exams_sign,
        "not_a_turn": velocity_by_no_rotation,
        "turned_wrong_way": velocity_turned_wrong_way,
        "theta2_alone": velocity_turned_by_theta2,
        "turned_by_theta1": velocity_turned_by_theta1,
        "link2_alone": velocity_with_link2_alone,
        "rate2_alone": velocity_with_rate2_alone,
        "sines_added": velocity_by(np.add),
        "sines_multiplied": velocity_by(np.multiply),
        "on_its_side": velocity_on_its_side,
    },
    **more.WRONG,
}
