"""Pictures of notebook 05: error of finite differences, velocity ellipsoids, steps near a singularity.

Every function shows one figure and returns None.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import ik, jacobians
from coursekit.kinematics.robot import Robot
from coursekit.view.figures import palette

PARTS = {"linear": ("trace", "m/s"), "angular": ("accent", "rad/s")}
LINES = (("o", "-", "accent"), ("s", "--", "trace"), ("^", "-.", "axis"), ("D", ":", "bone"))


def differences(step: ArrayLike, central: ArrayLike, forward: ArrayLike) -> None:
    """Largest error of two difference quotients over the step size, both axes logarithmic."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    for error, name, (marker, line, color) in zip(
        (forward, central), ("forward", "central"), LINES, strict=False
    ):
        ax.loglog(step, error, line, marker=marker, ms=4, color=palette(color), label=name)
    ax.set(xlabel="step [rad]", ylabel="largest error of J [1], [m]")
    ax.grid(alpha=0.3)
    ax.legend(frameon=False)
    plt.show()


def ellipsoids(robot: Robot, **thetas: ArrayLike) -> None:
    """Linear (above) and angular (below) velocity ellipsoid, one column per named configuration."""
    import matplotlib.pyplot as plt

    shape: dict = {"subplot_kw": {"projection": "3d"}, "squeeze": False, "layout": "constrained"}
    _, axes = plt.subplots(2, len(thetas), figsize=(7.0, 6.6), **shape)
    for row, (part, (color, unit)) in zip(axes, PARTS.items(), strict=True):
        found = {
            name: jacobians.ellipsoid(robot.jacobian_geometric(theta), part) for name, theta in thetas.items()
        }
        room = 1.1 * max(e.lengths[0] for e in found.values())
        for ax, (name, e) in zip(row, found.items(), strict=True):
            _ellipsoid(ax, e, palette(color))
            _box(ax, room, unit)
            ax.set_title(f"{part}, {name}", fontsize=11, y=0.94)
    plt.show()


def steps(runs: Mapping[str, Sequence[ik.Step]]) -> None:
    """How long each step of several iterations is. runs: name -> history of coursekit.ik."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    for (name, history), (marker, line, color) in zip(runs.items(), LINES, strict=False):
        length = [step.step for step in history[1:]]
        ax.semilogy(
            range(1, len(length) + 1), length, line, marker=marker, ms=4, color=palette(color), label=name
        )
    ax.set(xlabel="step", ylabel="length of the step [rad]", ylim=(1e-11, 30))
    ax.grid(alpha=0.3)
    ax.legend(frameon=False)
    plt.show()


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


def _box(ax, room, unit):
    """Equal axes from -room to room, with few ticks."""
    ax.set_proj_type("ortho")
    tick = 0.5 if room < 1 else 1
    for letter in "xyz":
        ax.set(**{f"{letter}lim": (-room, room), f"{letter}label": f"{letter} [{unit}]"})
        ax.set(**{f"{letter}ticks": tick * np.arange(-int(room / tick), int(room / tick) + 1)})
    ax.set_box_aspect([1, 1, 1], zoom=0.88)
    ax.tick_params(labelsize=8, pad=-2)
    ax.view_init(16, -72)
