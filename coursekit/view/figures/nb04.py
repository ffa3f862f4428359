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
from coursekit.view.figures import INK, axes_3d, limits_3d, palette

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STYLES = {"wrist": ":", "elbow": "--", "shoulder": "-"}
CELLS = 81


def draw_map(ax: Axes, robot: Robot, theta: ArrayLike, i: int, j: int) -> None:
    """How far det J is from 0 over joints i and j (from 0), the others held at theta; lines where it is 0.

    Brightness: the root of |det| relative to what the arm could have. Every line belongs to one factor.
    """
    held = np.array(theta, float)
    held[[i, j]] = 0
    x, y, relative = _factors_over(robot, i, j, tuple(held.round(9)))
    ends = np.degrees([x[0], x[-1], y[0], y[-1]])
    bright = np.sqrt(np.abs(np.prod(list(relative.values()), axis=0)))
    ax.imshow(bright, extent=tuple(ends), origin="lower", aspect="auto", cmap="viridis", vmin=0, vmax=1)
    everywhere = []
    for name, value in relative.items():
        if np.abs(value).max() < 1e-9:
            everywhere.append(name)
        elif value.min() < 0 < value.max():
            ax.contour(np.degrees(x), np.degrees(y), value, [0], colors="w", linestyles=STYLES[name])
            ax.plot([], [], "w", ls=STYLES[name], label=f"{name} = 0")
    if everywhere:
        ax.set_title(f"{' and '.join(everywhere)}: det J = 0 everywhere on this map", fontsize=9)
    ax.set(xlim=ends[:2], ylim=ends[2:], xlabel=f"θ{i + 1} [deg]", ylabel=f"θ{j + 1} [deg]")
    if ax.get_legend_handles_labels()[0]:
        ax.legend(facecolor=INK, labelcolor="w", framealpha=0.9, fontsize=8, loc="lower left")


@lru_cache(maxsize=16)
def _factors_over(robot, i, j, held):
    """Grid values of two joints inside their limits, and the relative factors (y, x) over them."""
    low, high = (np.nan_to_num(q, posinf=np.pi, neginf=-np.pi) for q in (robot.q_min, robot.q_max))
    x, y = (np.linspace(low[k], high[k], CELLS) for k in (i, j))
    theta = np.broadcast_to(held, (CELLS, CELLS, robot.n)).copy()
    theta[..., i], theta[..., j] = np.meshgrid(x, y)
    shape = np.zeros((CELLS, CELLS))  # a factor may depend on neither joint
    return x, y, {name: f + shape for name, f in singularity.relative_factors(robot, theta).items()}


def singular_map(robot: Robot, theta: ArrayLike, i: int, j: int, marks: Mapping[str, ArrayLike]) -> None:
    """`draw_map` with marked configurations. marks: text -> (theta_i, theta_j) in radians."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    draw_map(ax, robot, theta, i, j)
    for (name, place), marker in zip(marks.items(), "XosD", strict=False):
        ax.plot(*np.degrees(place), marker, color="#F07A2B", mec="w", ms=9)
        ax.annotate(name, tuple(np.degrees(place)), (9, 6), textcoords="offset points", color="w", fontsize=9)
    plt.show()


def lost_lines(robot: Robot, poses: Mapping[str, ArrayLike]) -> None:
    """The arm, its six axes (dashed) and the screw of the lost wrench. poses: title -> theta (6,)."""
    import matplotlib.pyplot as plt

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
    plt.show()


def two_smallest(angles: ArrayLike, values: np.ndarray) -> None:
    """The two smallest singular values over an angle. angles (k,) in radians, values (k, 2)."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(6.4, 3.2), layout="constrained")
    ax.plot(np.degrees(angles), values[:, 0], color=palette("trace"), label="second smallest")
    ax.plot(np.degrees(angles), values[:, 1], "--", color=palette("accent"), label="smallest")
    ax.set(xlabel="θ4 [deg]", ylabel="singular value of J", xticks=range(-180, 181, 60))
    ax.grid(alpha=0.3)
    ax.legend(frameon=False)
    plt.show()


def rates_near(eps: ArrayLike, rates: np.ndarray, limits: np.ndarray) -> None:
    """Joint rates over the distance from a singular pose. eps (k,), rates (k, n), limits (n,): log axes."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    for k, marker, color in ((1, "s", "z"), (2, "o", "accent"), (4, "^", "trace")):
        ax.loglog(eps, np.abs(rates[:, k]), color=palette(color), marker=marker, ms=5, label=f"joint {k + 1}")
        ax.axhline(limits[k], color=palette(color), lw=0.8, ls=":")
    ax.set(xlabel="ε = θ3 − stretched angle [rad]", ylabel="joint rate [rad/s]")
    ax.grid(alpha=0.3)
    ax.legend(frameon=False)
    plt.show()
