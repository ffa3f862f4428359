"""Pictures of notebook 04: where det J vanishes, the lines that meet six axes, what grows near a singularity.

Every public function but `draw_map` shows one figure and returns None.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import singularity
from coursekit.kinematics.robot import Robot
from coursekit.view.chain import ends_of, shown_per_si
from coursekit.view.figures import INK, axes_3d, blank, limits_3d, palette, show

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STYLES = {"wrist": ":", "elbow": "--", "shoulder": "-"}
CELLS = 81


def draw_map(ax: Axes, robot: Robot, theta: ArrayLike, i: int, j: int) -> None:
    """How far det J is from 0 over joints i and j (from 0), the others held at theta; lines where it is 0.

    Brightness: the root of |det| relative to what the arm could have. Every line belongs to one factor. Of an
    arm without the three factors: its smallest singular value, relative to the largest on the map, no lines.
    """
    held = np.array(theta, float)
    held[[i, j]] = 0
    split = has_factors(robot)
    x, y, values = (_factors_over if split else _sigma_over)(robot, i, j, tuple(held.round(9)))
    per = shown_per_si(robot)[[i, j]]
    ends = [per[0] * x[0], per[0] * x[-1], per[1] * y[0], per[1] * y[-1]]
    bright = np.sqrt(np.abs(np.prod(list(values.values()), axis=0)))
    ax.imshow(bright, extent=tuple(ends), origin="lower", aspect="auto", cmap="viridis", vmin=0, vmax=1)
    everywhere = []
    for name, value in values.items() if split else ():
        if np.abs(value).max() < 1e-9:
            everywhere.append(name)
        elif value.min() < 0 < value.max():
            ax.contour(per[0] * x, per[1] * y, value, [0], colors="w", linestyles=STYLES[name])
            ax.plot([], [], "w", ls=STYLES[name], label=f"{name} = 0")
    if everywhere:
        ax.set_title(f"{' and '.join(everywhere)}: det J = 0 everywhere on this map", fontsize=9)
    ax.set(xlim=ends[:2], ylim=ends[2:], xlabel=_axis_name(robot, i), ylabel=_axis_name(robot, j))
    if ax.get_legend_handles_labels()[0]:
        ax.legend(facecolor=INK, labelcolor="w", framealpha=0.9, fontsize=8, loc="lower left")


def has_factors(robot: Robot) -> bool:
    """Whether det J of this arm splits into wrist, elbow and shoulder."""
    try:
        singularity.factors(robot, robot.home)
    except ValueError:
        return False
    return True


def _axis_name(robot, joint):
    return f"θ{joint + 1} [{'deg' if robot.joint_types[joint] == 'revolute' else 'mm'}]"


def _grid(robot, i, j, held, cells):
    """Grid values of two joints inside their limits, and theta (cells, cells, n) over them."""
    low, high = ends_of(robot)
    x, y = (np.linspace(low[k], high[k], cells) for k in (i, j))
    theta = np.broadcast_to(held, (cells, cells, robot.n)).copy()
    theta[..., i], theta[..., j] = np.meshgrid(x, y)
    return x, y, theta


@lru_cache(maxsize=16)
def _factors_over(robot, i, j, held):
    """Grid values of two joints, and the relative factors (y, x) over them."""
    x, y, theta = _grid(robot, i, j, held, CELLS)
    shape = np.zeros((CELLS, CELLS))  # a factor may depend on neither joint
    return x, y, {name: f + shape for name, f in singularity.relative_factors(robot, theta).items()}


@lru_cache(maxsize=16)
def _sigma_over(robot, i, j, held):
    """Grid values of two joints, and the smallest singular value (y, x), relative to the largest of them."""
    x, y, theta = _grid(robot, i, j, held, CELLS // 2)
    sigma = singularity.sigma_min(robot, theta)
    return x, y, {"sigma": sigma / max(sigma.max(), 1e-12)}


def singular_map(robot: Robot, theta: ArrayLike, i: int, j: int, marks: Mapping[str, ArrayLike]) -> None:
    """`draw_map` with marked configurations. marks: text -> (theta_i, theta_j) in radians."""
    ax = blank((6.4, 4.2), grid=0)
    ax.figure.set_facecolor(
        "#EEEEEE"
    )  # white paper is turned over on dark pages, where dark means small, too
    draw_map(ax, robot, theta, i, j)
    for (name, place), marker in zip(marks.items(), "XosD", strict=False):
        ax.plot(*np.degrees(place), marker, color="#F07A2B", mec="w", ms=9)
        ax.annotate(name, tuple(np.degrees(place)), (9, 6), textcoords="offset points", color="w", fontsize=9)
    show()


def on_axis_1() -> None:
    """The arm from the side with its wrist centre on axis 1: the higher solution solid, the lower dashed.

    Not to scale, so that every length can be seen.
    """
    a1, d1, a2, a3, d4, theta2 = 130, 330, 450, 110, 420, -1.05
    ax = blank((5.6, 4.6))
    elbow = np.array([a1 + a2 * np.cos(theta2), d1 - a2 * np.sin(theta2)])
    delta, rho = np.arctan2(a3, d4), np.hypot(a3, d4)
    bend = np.arccos(-elbow[0] / rho)
    for t, style, color, where in (
        (delta - bend, "-", "accent", "higher"),
        (delta + bend, "--", "trace", "lower"),
    ):
        knee = elbow + a3 * np.array([np.sin(t), np.cos(t)])
        P = knee + d4 * np.array([np.cos(t), -np.sin(t)])
        ax.plot(*np.array([elbow, knee, P]).T, style, lw=4, color=palette(color), solid_joinstyle="round")
        ax.plot(*np.array([elbow, P]).T, ":", lw=1.4, color=palette(color))
        ax.plot(*P, "D", ms=8, color=palette(color))
        ax.text(P[0] - 22, P[1], f"P, {where}", color=palette(color), va="center", ha="right")
        along, across = np.array([np.cos(t), -np.sin(t)]), np.array([np.sin(t), np.cos(t)])
        for (x, y), name in (
            ((knee + P) / 2 + 28 * across, "$d_4$"),
            ((elbow + P) / 2 - 26 * across, r"$\rho$"),
            ((elbow + knee) / 2 + (34 if where == "higher" else -30) * along, "$a_3$"),
        ):
            ax.text(x, y, name, color=palette(color), ha="center", va="center")
    ax.plot(*np.array([[0, 0], [0, d1], [a1, d1], elbow]).T, lw=4, color="#8A929C", solid_joinstyle="round")
    for joint, name in (((a1, d1), "axis 2"), (elbow, "axis 3")):
        ax.plot(*joint, "o", ms=8, color=INK)
        ax.text(joint[0] + 24, joint[1] - 8, name, color=INK, va="center")
    ax.axvline(0, ls="-.", lw=1, color=INK)
    ax.text(14, 8, "axis 1", color=INK)
    ax.text(a1 / 2, d1 - 34, "$a_1$", color=INK, ha="center")
    ax.text((a1 + elbow[0]) / 2 + 28, (d1 + elbow[1]) / 2 - 10, "$a_2$", color=INK)
    ax.set(xlabel="r", ylabel="z", aspect="equal", xlim=(-190, 560), ylim=(-20, 1000), xticks=[], yticks=[])
    show()


def lost_lines(robot: Robot, poses: Mapping[str, ArrayLike]) -> None:
    """The arm, its six axes (dashed) and the screw of the lost wrench. poses: title -> theta (6,)."""

    axes = axes_3d(len(poses), (9.6, 4.2))
    for ax, (title, theta) in zip(axes, poses.items(), strict=True):
        wrench = singularity.lost_wrench(robot, theta)
        joints = robot.link_frames(theta)
        points = np.concatenate([np.zeros((1, 3)), joints[:, :3, 3]])
        ax.plot(*points.T, lw=7, color="#D5DAE1", solid_capstyle="round", solid_joinstyle="round")
        for k, J in enumerate(robot.jacobian_space(theta).T):
            foot = np.cross(J[:3], J[3:]) + J[:3] * (J[:3] @ joints[k, :3, 3])
            ax.plot(*(foot + np.outer([-0.4, 0.4], J[:3])).T, ls=(0, (4, 2)), lw=1.1, color=palette("axis"))
        pure = abs(wrench.pitch) < 1e-6
        between = (points[2] + points[5]) / 2  # shoulder and wrist
        middle = wrench.point + wrench.direction * (wrench.direction @ (between - wrench.point))
        ends = middle + np.outer([-0.7, 0.7], wrench.direction)
        ax.plot(*ends.T, lw=2.4, ls="-" if pure else "-.", color=palette("accent"))
        limits_3d(ax, [(-0.5, 0.8), (-0.5, 0.6), (0.0, 1.1)], ticks=(-0.5, 0, 0.5, 1), unit="m")
        ax.set_title(f"{title}, pitch {abs(wrench.pitch):.3f} m", fontsize=10)
        ax.view_init(18, -38)
    show()


def two_smallest(angles: ArrayLike, values: np.ndarray) -> None:
    """The two smallest singular values over an angle. angles (k,) in radians, values (k, 2)."""
    ax = blank((6.4, 3.2))
    ax.plot(np.degrees(angles), values[:, 0], color=palette("trace"), label="second smallest")
    ax.plot(np.degrees(angles), values[:, 1], "--", color=palette("accent"), label="smallest")
    ax.set(xlabel="θ4 [deg]", ylabel="singular value of J", xticks=range(-180, 181, 60))
    ax.legend(frameon=False)
    show()


def rates_near(
    distance: ArrayLike, rates: np.ndarray, limits: np.ndarray, joints: tuple[int, ...], what: str
) -> None:
    """Joint rates over the distance from a singular pose, log axes. distance (k,), rates (k, n), limits (n,).

    joints: which to show, from 1, at most four; what: the distance in words, with its unit.
    """
    ax = blank((6.4, 3.6))
    for k, marker, color in zip(joints, "so^D", ("z", "accent", "trace", "axis"), strict=False):
        rate = np.abs(rates[:, k - 1])
        ax.loglog(distance, rate, color=palette(color), marker=marker, ms=5, label=f"joint {k}")
        ax.axhline(limits[k - 1], color=palette(color), lw=0.8, ls=":")
    ax.set(xlabel=what, ylabel="joint rate [rad/s]")
    ax.legend(frameon=False)
    show()
