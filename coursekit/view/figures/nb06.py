"""Pictures of notebook 06: a curve on its sphere, attitudes along it, wrapped and continuous angles, rates.

Every function shows one figure and returns None. s is the distance along the path in metres.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import path
from coursekit.view.figures import blank, in_space, palette, show

STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1, 1, 1)))


def on_sphere(points: np.ndarray, T: np.ndarray) -> None:
    """A curve on its sphere with every tenth tool frame: x outward, y along the curve."""
    ax = in_space((5.0, 4.1))
    _globe(ax, path.SPHERE_CENTER, path.SPHERE_RADIUS, np.pi)
    ax.plot(*points.T, color=palette("bone"), lw=1.5)
    for pose in T[::10]:
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
    show()


def attitudes(s: ArrayLike, quaternions: np.ndarray, zyx: np.ndarray, rotation_vectors: np.ndarray) -> None:
    """Three ways to write one attitude along the path, one panel each."""
    axes = blank((8.6, 2.8), 3, grid=0.25)
    panels = (
        ("unit quaternion", quaternions, ["w", "x", "y", "z"], "component"),
        ("ZYX angles", zyx, ["yaw", "pitch", "roll"], "angle [rad]"),
        ("angle-axis product", rotation_vectors, ["x", "y", "z"], "component [rad]"),
    )
    for ax, (title, values, names, unit) in zip(axes, panels, strict=True):
        _lines(ax, s, values, names)
        ax.set(title=title, xlabel="distance along the path [m]", ylabel=unit)
        place = {"loc": "lower left", "bbox_to_anchor": (0.1, -0.04)} if len(names) > 3 else {}
        ax.legend(frameon=False, fontsize=8, labelspacing=0.2, **place)
    show()


def wrapped_and_continuous(s: np.ndarray, wrapped: np.ndarray, continuous: np.ndarray, joint: int) -> None:
    """One joint of one branch: angles within half a turn beside the continuous ones, and where they jump."""
    axes = blank((7.4, 2.8), 2, grid=0, sharey=True)
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
    show()


def rates(points: ArrayLike, rate: Iterable[np.ndarray], bounds: Mapping[str, ArrayLike]) -> None:
    """Joint rates (m - 1, n) over the path, one panel per bound; dotted: that of the limiting joint."""
    axes = np.ravel(blank((4.0 * len(bounds), 3.0), len(bounds), grid=0.25))
    step = path.steps(points)
    middle = np.cumsum(step) - step / 2
    for ax, (title, bound), turned in zip(axes, bounds.items(), rate, strict=True):
        _lines(ax, middle, turned, [f"joint {j + 1}" for j in range(turned.shape[1])])
        use = np.abs(turned) / bound
        worst = np.argwhere(use > use.max() - 1e-6)[0]  # the first, where a symmetric path has two
        limit = np.broadcast_to(bound, turned.shape[1:])[worst[1]]
        for height in (-limit, limit):
            ax.axhline(height, color=palette("accent"), ls=":", lw=1.4)
        ax.plot(middle[worst[0]], turned[*worst], "o", ms=8, mfc="none", color=palette("accent"))
        ax.set(title=title, xlabel="distance along the path [m]", ylabel="joint rate [rad/s]")
    axes[0].legend(frameon=False, fontsize=7, ncols=2, loc="lower left", bbox_to_anchor=(0, 0.06))
    show()


def projection(letter: np.ndarray, points: np.ndarray, which: int) -> None:
    """The sphere, the plane that touches it, and the line from the pole through one point of the letter.

    letter (m, 2): Y, Z of the plane; points (m, 3) on the sphere; which: the one whose line is drawn.
    """
    ax = in_space((5.2, 4.2))
    _globe(ax, path.SPHERE_CENTER, path.SPHERE_RADIUS, 2 * np.pi)
    pole = np.array(path.SPHERE_CENTER) - [path.SPHERE_RADIUS, 0, 0]
    flat = np.column_stack([np.full(len(letter), path.SPHERE_RADIUS), letter[:, 0], 0.5 + letter[:, 1]])
    ax.plot(*flat.T, color=palette("trace"), lw=1.6, label="in the plane")
    ax.plot(*points.T, color=palette("bone"), lw=1.8, label="on the sphere")
    ax.plot(*np.array([pole, flat[which]]).T, color=palette("accent"), lw=1.2, marker="o", ms=4)
    ax.plot(*points[which], "o", color=palette("accent"), ms=4)
    ax.text(*(pole - [0.09, 0, 0]), "pole", color=palette("accent"), ha="center")
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", xticks=[-0.5, 0, 0.5])
    ax.set(yticks=[-0.5, 0, 0.5], zticks=[0, 0.5, 1])
    ax.set_aspect("equal")
    ax.legend(frameon=False, fontsize=9)
    ax.view_init(16, -58)
    show()


def angle_axis_errors(gap: ArrayLike, angle: np.ndarray, product: np.ndarray) -> None:
    """Error of theta near 0 and of k theta near pi, over the distance from there.

    angle, product (2, m): from the trace and 2 sin theta, and from the quaternion; drawn up to 10 rad.
    """
    axes = blank((7.2, 2.8), 2, sharey=True)
    for ax, both in zip(axes, (angle, product), strict=True):
        for error, line, color, name in zip(
            both, ("o-", "s--"), ("accent", "trace"), ("textbook", "from the quaternion"), strict=True
        ):
            ax.loglog(gap, np.clip(error, 1e-17, 10), line, ms=3, color=palette(color), label=name)
        ax.set(ylim=(3e-18, 30))
    axes[0].set(title="near no turn", xlabel="θ [rad]", ylabel="error of θ [rad]")
    axes[1].set(title="near half a turn", xlabel="π - θ [rad]", ylabel="error of β [rad]")
    axes[0].legend(frameon=False, fontsize=8)
    show()


def interpolations(t: ArrayLike, ways: Mapping[str, np.ndarray]) -> None:
    """Left: where the tool's x axis points along each way, on the unit sphere. Right: how fast it turns.

    ways: name -> attitudes (m, 3, 3) at the places t (m,).
    """
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(7.6, 3.3), layout="constrained")
    ax, right = figure.add_subplot(1, 2, 1, projection="3d"), figure.add_subplot(1, 2, 2)
    ax.set_proj_type("ortho")
    _globe(ax, (0, 0, 0), 1.0, 2 * np.pi)
    for (name, R), color, line in zip(ways.items(), ("trace", "accent", "axis"), STYLES, strict=False):
        ax.plot(*R[:, :, 0].T, ls=line, color=palette(color), lw=2)
        ax.plot(*R[[0, -1], :, 0].T, "o", color=palette("bone"), ms=4)
        turned = 2 * np.arcsin(np.clip(np.linalg.norm(np.diff(R, axis=0), axis=(1, 2)) / np.sqrt(8), 0, 1))
        middle = (np.asarray(t)[1:] + np.asarray(t)[:-1]) / 2
        right.plot(middle, turned / np.diff(t), ls=line, color=palette(color), lw=1.8, label=name)
    ax.set(xlabel="x", ylabel="y", zlabel="z", xticks=[-1, 0, 1], yticks=[-1, 0, 1], zticks=[-1, 0, 1])
    ax.set_aspect("equal")
    ax.view_init(34, -20)
    right.set(xlabel="t", ylabel="turning, rad per unit of t", ylim=(0, None))
    right.grid(alpha=0.25)
    right.legend(frameon=False, fontsize=9)
    show()


def walk(axes: Sequence[np.ndarray], steps: Sequence[np.ndarray]) -> None:
    """An arm at zero from the side: the step to each joint and to the tool, and the axis at each joint.

    axes (n, 3): unit vectors along x, y or z; steps (n + 1, 3) in metres, in the plane of x and z.
    """
    ax = blank((5.6, 4.2), grid=0.25)
    ends = np.cumsum(steps, axis=0)[:, [0, 2]]
    names = ["01", *(f"{i}{i + 1}" for i in range(1, len(axes))), f"{len(axes)}T"]
    for step, end, name in zip(steps, ends, names, strict=True):
        if not np.any(step):
            continue
        start = end - step[[0, 2]]
        ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "lw": 3, "color": palette("trace")})
        parts = [f"{1000 * length:g} {letter}" for length, letter in zip(step, "xyz", strict=True) if length]
        label = f"$P_{{{name}}}$ = {' + '.join(parts)}"
        upright, short = abs(step[2]) > abs(step[0]), np.linalg.norm(step) < 0.2
        place = end + [0.03, 0.05] if short else (start + end) / 2 + ([0.03, 0] if upright else [0, 0.06])
        side = "left" if short or upright else "center"
        ax.text(place[0], place[1], label, color=palette("trace"), ha=side, va="center")
    at: dict[tuple, list[str]] = {}
    for i, (axis, end) in enumerate(zip(axes, ends[:-1], strict=True), 1):
        at.setdefault(tuple(end.round(6)), []).append(f"$h_{i}$ = {'xyz'[int(np.argmax(np.abs(axis)))]}")
    for (x, z), here in at.items():
        ax.plot(x, z, "o", ms=9, mfc="w", mec=palette("bone"), mew=2, zorder=3)
        if x > 0.01:
            ax.text(x, z - 0.06, "\n".join(here), ha="center", va="top")
        else:
            ax.text(x - 0.03, z, "\n".join(here), ha="right", va="center")
    x, z = ends[-1]
    ax.plot(x, z, "s", ms=7, color=palette("accent"))
    ax.text(x + 0.02, z, "T", color=palette("accent"), va="center")
    ax.set(xlabel="x [m]", ylabel="z [m]", aspect="equal", xlim=(-0.25, 0.9), ylim=(-0.05, 1.02))
    show()


def errors(s: ArrayLike, curves: Mapping[str, ArrayLike]) -> None:
    """Distance from the tool to its point of the path, in metres, for several forward kinematics."""
    ax = blank((6.4, 3.0), grid=0.25)
    for (name, error), line, color in zip(
        curves.items(), STYLES, ("bone", "trace", "axis", "accent", "x"), strict=False
    ):
        ax.semilogy(s, np.maximum(error, 1e-18), ls=line, lw=1.5, color=palette(color), label=name)
    ax.set(xlabel="distance along the path λ [m]", ylabel="error of the tool [m]", ylim=(1e-18, 10))
    ax.legend(frameon=False, fontsize=8, ncols=2, loc="center", bbox_to_anchor=(0.5, 0.62))
    show()


def constancy(points: np.ndarray, speeds: Mapping[str, ArrayLike], third: np.ndarray) -> None:
    """Steps of the path, its speed, and joint 3 of every branch, over the distance along it.

    speeds: name -> (m - 1,) tool speed in each step, m/s; third (k, m): joint 3 of k branches, rad.
    """
    axes = blank((9.0, 2.8), 3, grid=0.25)
    step = path.steps(points)
    s = np.append(0.0, np.cumsum(step))
    axes[0].plot(s[:-1] + step / 2, 1e9 * (step - step.mean()), color=palette("trace"), lw=1.4)
    axes[0].set(title="step minus mean step", ylabel="difference [nm]")
    for (name, speed), line, color in zip(speeds.items(), STYLES, ("trace", "accent"), strict=False):
        axes[1].semilogy(s[:-1] + step / 2, speed, ls=line, lw=1.8, color=palette(color), label=name)
    axes[1].set(title="tool speed", ylabel="speed [m/s]", ylim=(1e-3, 2))
    axes[1].legend(frameon=False, fontsize=8)
    for k, q in enumerate(third):
        axes[2].plot(s, q - q[0], ls=STYLES[k % 6], lw=1.2, color=palette("bone" if k % 2 else "accent"))
    axes[2].set(title="joint 3, from where it begins", ylabel="angle [rad]")
    for ax in axes:
        ax.set(xlabel="distance along the path λ [m]")
    show()


# -- parts of the pictures -------------------------------------------------------------------------------


def _globe(ax, center, radius, width):
    """Meridians and parallels of a sphere, over an angle of `width` about the x direction."""
    u, v = np.linspace(-width / 2, width / 2, 13), np.linspace(0, np.pi, 9)
    shape = [np.outer(np.sin(v), np.cos(u)), np.outer(np.sin(v), np.sin(u)), np.outer(np.cos(v), np.ones(13))]
    shape = [c + radius * h for c, h in zip(center, shape, strict=True)]
    ax.plot_wireframe(*shape, color="#D5DAE1", lw=0.6)


def _lines(ax, s, values, names):
    """One line per column: its own color of viridis and its own style."""
    from matplotlib import colormaps

    for j, (name, column) in enumerate(zip(names, values.T, strict=True)):
        ax.plot(s, column, ls=STYLES[j], color=colormaps["viridis"](0.9 * j / len(names)), lw=1.7, label=name)
