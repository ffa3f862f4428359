"""Pictures of notebook 06: a curve on its sphere, attitudes along it, wrapped and continuous angles, rates.

Every function shows one figure and returns None. s is the distance along the path in metres.
"""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import path
from coursekit.view.figures import palette

STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)))


def on_sphere(
    points: np.ndarray,
    T: np.ndarray,
    every: int = 10,
    center: Iterable[float] = path.SPHERE_CENTER,
    radius: float = path.SPHERE_RADIUS,
) -> None:
    """A curve on its sphere with every tenth tool frame: x outward, y along the curve."""
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(5.0, 4.1), layout="constrained")
    ax = figure.add_subplot(projection="3d")
    ax.set_proj_type("ortho")
    u, v = np.linspace(-np.pi / 2, np.pi / 2, 13), np.linspace(0, np.pi, 9)
    half = [np.outer(np.sin(v), np.cos(u)), np.outer(np.sin(v), np.sin(u)), np.outer(np.cos(v), np.ones(13))]
    half = [c + radius * h for c, h in zip(center, half, strict=True)]
    ax.plot_wireframe(*half, color="#D5DAE1", lw=0.6)
    ax.plot(*points.T, color=palette("bone"), lw=1.5)
    for pose in T[::every]:
        for k, letter in enumerate("xyz"):
            ends = np.array([pose[:3, 3], pose[:3, 3] + 0.08 * pose[:3, k]])
            ax.plot(*ends.T, color=palette(letter), lw=1.8)
    for k, letter in enumerate("xyz"):  # the letters once, at the first frame
        where = T[0, :3, 3] + 0.11 * T[0, :3, k]
        ax.text(*where, letter, color=palette(letter), ha="center", va="center", fontsize=10)
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", xticks=[0, 0.25, 0.5])
    ax.set(yticks=[-0.5, 0, 0.5], zticks=[0, 0.5, 1])
    ax.set_aspect("equal")
    ax.view_init(14, -32)
    plt.show()


def attitudes(s: ArrayLike, quaternions: np.ndarray, zyx: np.ndarray, rotation_vectors: np.ndarray) -> None:
    """Three ways to write one attitude along the path, one panel each."""
    import matplotlib.pyplot as plt

    _, axes = plt.subplots(1, 3, figsize=(8.6, 2.8), layout="constrained")
    panels = (
        ("unit quaternion", quaternions, ["w", "x", "y", "z"], "component"),
        ("ZYX angles", zyx, ["yaw", "pitch", "roll"], "angle [rad]"),
        ("angle-axis product", rotation_vectors, ["x", "y", "z"], "component [rad]"),
    )
    for ax, (title, values, names, unit) in zip(axes, panels, strict=True):
        _lines(ax, s, values, names)
        ax.set(title=title, xlabel="distance along the path [m]", ylabel=unit)
        ax.legend(frameon=False, fontsize=8)
    plt.show()


def wrapped_and_continuous(s: np.ndarray, wrapped: np.ndarray, continuous: np.ndarray, joint: int) -> None:
    """One joint of one branch: angles within half a turn beside the continuous ones, and where they jump."""
    import matplotlib.pyplot as plt

    _, axes = plt.subplots(1, 2, figsize=(7.4, 2.8), layout="constrained", sharey=True)
    jump = np.abs(np.diff(wrapped)) > np.pi
    for ax, q, title in ((axes[0], wrapped, "within half a turn"), (axes[1], continuous, "continuous")):
        ax.plot(s, q, "o-", ms=2.5, lw=1, color=palette("trace"))
        for height in (-np.pi, np.pi):
            ax.axhline(height, color=palette("bone"), ls=":", lw=1)
        ax.set(title=title, xlabel="distance along the path [m]")
    for i in np.flatnonzero(jump):
        axes[0].plot(s[i : i + 2], wrapped[i : i + 2], color=palette("accent"), lw=2.2)
    axes[0].set(ylabel=f"joint {joint} [rad]")
    axes[0].text(0.02, np.pi + 0.1, "π", transform=axes[0].get_yaxis_transform())
    plt.show()


def rates(points: ArrayLike, rate: Iterable[np.ndarray], bounds: Mapping[str, ArrayLike]) -> None:
    """Joint rates (m - 1, n) over the path, one panel per bound; dotted: that of the limiting joint."""
    import matplotlib.pyplot as plt

    count = len(bounds)
    _, axes = plt.subplots(1, count, figsize=(4.0 * count, 3.0), layout="constrained", squeeze=False)
    step = path.steps(points)
    middle = np.cumsum(step) - step / 2
    for ax, (title, bound), turned in zip(axes[0], bounds.items(), rate, strict=True):
        _lines(ax, middle, turned, [f"joint {j + 1}" for j in range(turned.shape[1])])
        use = np.abs(turned) / bound
        worst = np.argwhere(use > use.max() - 1e-6)[0]  # the first, where a symmetric path has two
        limit = np.broadcast_to(bound, turned.shape[1:])[worst[1]]
        for height in (-limit, limit):
            ax.axhline(height, color=palette("accent"), ls=":", lw=1.4)
        ax.plot(middle[worst[0]], turned[*worst], "o", ms=8, mfc="none", color=palette("accent"))
        ax.set(title=title, xlabel="distance along the path [m]", ylabel="joint rate [rad/s]")
    axes[0, 0].legend(frameon=False, fontsize=7, ncols=2, loc="lower left", bbox_to_anchor=(0, 0.06))
    plt.show()


# -- parts of the pictures -------------------------------------------------------------------------------


def _lines(ax, s, values, names):
    """One line per column: its own color of viridis and its own style."""
    from matplotlib import colormaps

    for j, (name, column) in enumerate(zip(names, values.T, strict=True)):
        ax.plot(s, column, ls=STYLES[j], color=colormaps["viridis"](0.9 * j / len(names)), lw=1.7, label=name)
    ax.grid(alpha=0.25)
