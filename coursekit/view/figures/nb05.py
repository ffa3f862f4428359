"""Pictures of notebook 05: error of finite differences, velocity ellipsoids, steps near a singularity.

Every function shows one figure and returns None.
"""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import jacobians
from coursekit.kinematics.robot import Robot
from coursekit.view.figures import blank, in_space, limits_3d, palette, show

PARTS = {"linear": ("trace", "m/s"), "angular": ("accent", "rad/s")}
SHORTEST = 1e-11  # rad
LINES = (("o", "-", "accent"), ("s", "--", "trace"), ("^", "-.", "axis"), ("D", ":", "bone"))


def differences(step: ArrayLike, central: ArrayLike, forward: ArrayLike) -> None:
    """Largest error of two difference quotients over the step size, both axes logarithmic."""
    ax = blank((5.8, 3.3))
    for error, name, (marker, line, color) in zip(
        (forward, central), ("forward", "central"), LINES, strict=False
    ):
        ax.loglog(step, error, line, marker=marker, ms=4, color=palette(color), label=name)
    ax.set(xlabel="step [rad]", ylabel="largest error of an entry of J\n(omega: 1; v: m)")
    ax.legend(frameon=False)
    show()


def ellipsoids(robot: Robot, **thetas: ArrayLike) -> None:
    """Linear (above) and angular (below) velocity ellipsoid, one column per named configuration."""
    axes = in_space((6.0, 5.6), len(thetas), nrows=2, squeeze=False)
    for row, (part, (color, unit)) in zip(axes, PARTS.items(), strict=True):
        found = {
            name: jacobians.ellipsoid(robot.jacobian_geometric(theta), part) for name, theta in thetas.items()
        }
        room = 1.1 * max(e.lengths[0] for e in found.values())
        for ax, (name, e) in zip(row, found.items(), strict=True):
            _ellipsoid(ax, e, palette(color))
            limits_3d(ax, 3 * [(-room, room)], (0.5 if room < 1 else 2) * np.arange(-9, 10), unit)
            ax.set_box_aspect([1, 1, 1], zoom=0.88)
            ax.view_init(16, -72)
            ax.set_title(f"{part}, {name}", fontsize=11, y=0.94)
    show()


def steps(runs: Mapping[str, ArrayLike]) -> None:
    """How long each step of several runs is. runs: name -> configurations (m, n), the start first."""
    ax = blank((5.8, 3.3))
    for (name, rows), (marker, line, color) in zip(runs.items(), LINES, strict=False):
        length = np.linalg.norm(np.diff(rows, axis=0), axis=1)
        count = np.arange(1, len(length) + 1)
        seen = length > SHORTEST  # below it, nothing but rounding
        ax.semilogy(count[seen], length[seen], line, marker=marker, ms=4, color=palette(color), label=name)
    ax.set(xlabel="step", ylabel="length of the step [rad]", ylim=(SHORTEST, 30))
    ax.legend(frameon=False)
    show()


def damping(dampings: Iterable[float]) -> None:
    """What one step makes of an error of length 1 along a singular direction, over its sigma."""
    ax = blank((5.6, 3.0))
    sigma = np.logspace(-3, 0.5, 200)
    ax.loglog(sigma, 1 / sigma, color=palette("bone"), label="Newton: 1/σ")
    ax.loglog(sigma, sigma, ":", color=palette("axis"), lw=1.8, label="transpose: gσ, g = 1")
    for k, (marker, line, color) in zip(dampings, LINES, strict=False):
        ax.loglog(sigma, sigma / (sigma**2 + k**2), line, color=palette(color), lw=1.8, label=f"k = {k:g}")
        ax.plot(k, 1 / (2 * k), marker, color=palette(color), ms=7)
    ax.set(xlabel="singular value σ", ylabel="step for an error of 1", ylim=(1e-2, 1e3))
    ax.legend(frameon=False, fontsize=9)
    show()


def planar_velocity(theta: ArrayLike, lengths: ArrayLike, v: ArrayLike) -> None:
    """A planar 2R, its base frame B and tool frame E, and the velocity v (2,) of its tool, m/s along B."""
    ax = blank((5.2, 3.9))
    angles = np.cumsum(theta)
    links = np.array(lengths)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    joints = np.vstack([[0, 0], np.cumsum(links, axis=0)])
    ax.plot(*joints.T, "-", color=palette("bone"), lw=5, alpha=0.35, solid_capstyle="round")
    ax.plot(*joints[:-1].T, "o", color=palette("bone"), ms=8, mfc="w")
    for name, place, turn in (("B", joints[0], 0.0), ("E", joints[-1], angles[-1])):
        for letter, more in (("x", 0.0), ("y", np.pi / 2)):
            end = place + 0.16 * np.array([np.cos(turn + more), np.sin(turn + more)])
            _arrow(ax, place, end, palette(letter))
            ax.annotate(f"${letter}_{name}$", end + 0.25 * (end - place), ha="center", va="center")
    _arrow(ax, joints[-1], joints[-1] + np.asarray(v, float), palette("accent"))
    ax.annotate("v", joints[-1] + 1.12 * np.asarray(v, float), color=palette("accent"), ha="center")
    ax.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    ax.margins(0.2)
    show()


# -- parts of the pictures -------------------------------------------------------------------------------


def _ellipsoid(ax, e, color):
    """Its surface, and its half axes as lines through the middle."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 41), np.linspace(0, np.pi, 21))
    ball = np.array([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    surface = np.tensordot(e.axes * e.lengths, ball, axes=1)
    ax.plot_surface(*surface, color=color, alpha=0.25, linewidth=0)
    ax.plot_wireframe(*surface, color=color, alpha=0.35, linewidth=0.5, rstride=5, cstride=5)
    for axis, length, line in zip(e.axes.T, e.lengths, ("-", "--", ":"), strict=True):
        ax.plot(*np.outer(axis, [-length, length]), line, lw=2, color=palette("bone"))


def _arrow(ax, start, end, color):
    """From start to end; the limits of the axes grow with it."""
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2, "shrinkA": 0})
    ax.plot(*np.transpose([start, end]), alpha=0)
