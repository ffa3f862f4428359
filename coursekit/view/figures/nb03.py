"""Pictures of notebook 03: the triangle of the elbow, subproblems, columns of a Jacobian, Newton's steps.

Every function shows one figure and returns None.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.kinematics import lie, subproblems
from coursekit.view.figures import INK, blank, palette, show

STYLES = (("accent", "o-"), ("trace", "s--"), ("body", "^-."), ("axis", "D:"))


def triangle() -> None:
    """Shoulder, elbow and P from the side, elbow up and down, with alpha, beta, phi and psi. No scale."""
    axes = blank((8.4, 3.7), 2, sharey=True)
    for ax, side, title in zip(axes, (1, -1), ("elbow up", "elbow down"), strict=True):
        _one_triangle(ax, side)
        ax.set_title(title, fontsize=10)
        ax.set(aspect="equal", xlim=(-0.75, 4.6), ylim=(-1.25, 2.75), xticks=[], yticks=[], xlabel="r")
    axes[0].set_ylabel("z")
    show()


def _one_triangle(ax, side):
    a2, a3, d4, P = 2.2, 0.5, 2.0, np.array([3.5, 0.8])
    a, b = np.hypot(a3, d4), np.hypot(*P)
    phi, psi = np.arctan2(P[1], P[0]), np.arctan2(a3, d4)
    alpha, beta = (
        np.arccos((b * b + a2 * a2 - a * a) / (2 * b * a2)),
        np.arccos((a * a + a2 * a2 - b * b) / (2 * a * a2)),
    )
    upper = phi + side * alpha  # directions, counted upwards from the horizontal
    reach = upper - side * (np.pi - beta)  # of the line from the elbow to P
    fore = reach - psi  # of the forearm
    E = a2 * _to(upper)
    kink = E + a3 * _to(fore + np.pi / 2)
    arm = np.array([[0, 0], E, kink, P])
    ax.plot([0, 1.5], [0, 0], "--", lw=0.8, color=INK)
    ax.plot(*np.array([E, E + 1.1 * _to(upper)]).T, "--", lw=0.8, color=INK)
    ax.plot(*arm.T, lw=4, color=palette("accent"), solid_joinstyle="round")
    ax.plot(*np.array([E, P]).T, ":", lw=1.6, color=palette("trace"))
    ax.plot([0, P[0]], [0, P[1]], "-.", lw=1.4, color=INK)
    for point, name, shift in (([0, 0], "shoulder", (-0.1, -0.32)), (P, "P", (0.14, 0.0))):
        ax.plot(*point, "o", ms=7, color=INK)
        ax.text(
            *(np.array(point) + shift), name, color=INK, fontsize=10, ha="center" if name != "P" else "left"
        )
    ax.plot(*E, "o", ms=7, color=palette("accent"))
    ax.text(*(E + (-0.14, 0.12 if side > 0 else -0.3)), "elbow", color=INK, fontsize=10, ha="right")
    for start, end, name, off in (
        ([0, 0], E, "$a_2$", 0.22 * side),
        (kink, P, "$d_4$", 0.24),
        (E, kink, "$a_3$", 0.2 * side),
        ([0, 0], P, "$b$", -0.2 * side),
        (E, P, "$a$", -0.22),
    ):
        middle, along = (np.array(start) + end) / 2, np.array(end) - start
        across = np.array([-along[1], along[0]]) / np.hypot(*along)
        ax.text(*(middle + off * across), name, color=INK, fontsize=11, ha="center", va="center")
    for at, size, low, high, name in (
        ((0, 0), 1.2, 0, phi, r"$\phi$"),
        ((0, 0), 0.75, phi, upper, r"$\alpha$"),
        (E, 0.55, upper + np.pi, reach + 2 * np.pi * (side < 0), r"$\beta$"),
        (P, 1.15, fore + np.pi, reach + np.pi, r"$\psi$"),
    ):
        _arc(ax, np.array(at), size, low, high, name)


def _to(angle):
    return np.array([np.cos(angle), np.sin(angle)])


def _arc(ax, centre, size, low, high, name):
    """An arc from one direction to another, the shorter way, with its name outside."""
    high = low + (high - low + np.pi) % (2 * np.pi) - np.pi
    t = np.linspace(low, high, 30)
    ax.plot(*(centre[:, None] + size * np.array([np.cos(t), np.sin(t)])), lw=1.2, color=palette("z"))
    x, y = centre + (size + 0.17) * _to((low + high) / 2)
    ax.text(x, y, name, color=palette("z"), fontsize=12, ha="center", va="center")


def elbows(lengths: ArrayLike, solutions: Iterable[Sequence[float] | np.ndarray]) -> None:
    """The arm in its own plane for both (theta2, theta3): the upper elbow solid, the lower one dashed."""
    a1, d1, a2, a3, d4 = 1000 * np.asarray(lengths)
    ax = blank((6.4, 4.6))
    for (t2, t3), color, style, side in zip(
        solutions, ("accent", "trace"), ("-", "--"), (-1, 1), strict=True
    ):
        elbow = np.array([a1 + a2 * np.cos(t2), d1 - a2 * np.sin(t2)])
        bent = t2 + t3
        knee = elbow + a3 * np.array([np.sin(bent), np.cos(bent)])
        P = knee + d4 * np.array([np.cos(bent), -np.sin(bent)])
        arm = np.array([[0, 0], [0, d1], [a1, d1], elbow, knee, P])
        ax.plot(*arm.T, style, lw=4, color=palette(color), solid_joinstyle="round")
        ax.plot(*np.array([elbow, P]).T, ":", lw=1.2, color=palette(color))
        ax.plot(*elbow, "o", ms=9, color=palette(color))
        ax.text(elbow[0] + 40 * side, elbow[1], f"elbow {elbow[1]:.1f} mm", color=palette(color), va="center",
                ha="right" if side < 0 else "left")  # fmt: skip
    ax.plot([a1, P[0]], [d1, P[1]], "-.", lw=1, color=INK)
    ax.text((a1 + P[0]) / 2 + 12, (d1 + P[1]) / 2, "b", color=INK, fontsize=12, style="italic")
    ax.plot(*P, "D", ms=8, color=INK)
    ax.text(P[0] + 22, P[1] + 12, "P", color=INK, fontsize=12, style="italic")
    ax.set(xlabel="r: distance from axis 1 [mm]", ylabel="z [mm]", aspect="equal", xlim=(-620, 760))
    show()


def meetings() -> None:
    """Subproblem 3 in the plane across the axis, and subproblem 2 on its sphere."""
    import matplotlib.pyplot as plt

    both = plt.figure(figsize=(8.4, 3.8), layout="constrained")
    _triangle_across(both.add_subplot(1, 2, 1))
    _two_circles(both.add_subplot(1, 2, 2, projection="3d"))
    show()


def _triangle_across(ax):
    """x' on its circle about the axis, y', and the two places at the wanted distance from y'."""
    x, y, d = 1.0 * _to(-0.5), 1.5 * _to(0.9), 1.15
    bend = np.arccos((1 + 1.5**2 - d * d) / (2 * 1.5))
    t = np.linspace(0, 2 * np.pi, 121)
    ax.plot(np.cos(t), np.sin(t), "--", lw=1, color=INK)
    ax.plot(y[0] + d * np.cos(t), y[1] + d * np.sin(t), ":", lw=1, color=palette("trace"))
    for side, style in ((-1, "-"), (1, "--")):
        place = _to(0.9 + side * bend)
        ax.plot(*np.array([[0, 0], place, y]).T, style, lw=1.8, color=palette("accent"))
        ax.plot(*place, "o", ms=8, color=palette("accent"))
    ax.plot([0, x[0]], [0, x[1]], lw=1.2, color=INK)
    ax.plot([0, y[0]], [0, y[1]], "-.", lw=1.2, color=INK)
    for point, name, shift in (
        ((0, 0), "k", (-0.16, -0.12)),
        (x, "x'", (0.12, -0.1)),
        (y, "y'", (0.08, 0.12)),
    ):
        ax.plot(*point, "o", ms=6, color=INK)
        ax.text(*(np.array(point) + shift), name, color=INK, fontsize=11)
    ax.text(
        *(0.5 * (_to(0.9 - bend) + y) + (0.1, -0.06)), r"$\delta\,'$", color=palette("accent"), fontsize=12
    )
    _arc(ax, np.zeros(2), 0.45, -0.5, 0.9, r"$t_0$")
    _arc(ax, np.zeros(2), 0.7, 0.9, 0.9 + bend, r"$\gamma$")
    ax.set(aspect="equal", xlim=(-1.3, 2.2), ylim=(-1.2, 2.4), xticks=[], yticks=[])
    ax.set_title("subproblem 3, seen along k", fontsize=10)


def _two_circles(ax):
    """The circle of x about k2 and the circle of y about k1; z is where they meet."""
    k1, k2, x = np.array([0, 0, 1.0]), np.array([0.8, 0, 0.6]), np.array([0.75, -0.6, -0.2])
    x = x / np.linalg.norm(x)
    y = np.array([-0.3, 0.75, 0.0])
    y[2] = np.sqrt(1 - y @ y)
    near, far = (lie.exp3(turn * k2) @ x for _, turn in subproblems.subproblem2(k1, k2, x, y))
    u, v = np.mgrid[0 : 2 * np.pi : 13j, 0 : np.pi : 25j]
    ax.plot_wireframe(
        np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v), lw=0.5, color="#DDE1E6", ccount=0
    )
    t = np.linspace(0, 2 * np.pi, 121)[:, None]
    for k, start, style in ((k2, x, "--"), (k1, y, "-")):
        circle = start * np.cos(t) + np.cross(k, start) * np.sin(t) + k * (k @ start) * (1 - np.cos(t))
        ax.plot(*circle.T, style, lw=1.8, color=palette("trace" if style == "--" else "accent"))
        ax.plot(*np.array([-1.35 * k, 1.35 * k]).T, lw=1, color=INK)
    for meeting in (far, near):
        ax.plot(*meeting, "o", ms=8, color=palette("z"))
    for point, name in (
        (1.5 * k1, "k1"),
        (2 * k2, "k2"),
        (1.3 * x, "x"),
        (1.15 * y, "y"),
        (1.2 * near - [0, 0, 0.25], "z"),
    ):
        ax.text(*point, name, color=INK, fontsize=11)
    ax.plot(*np.array([x, y]).T, ".", ms=9, color=INK, lw=0)
    ax.set_box_aspect([1, 1, 1], zoom=1.25)
    ax.set_axis_off()
    ax.view_init(22, -35)
    ax.set_title("subproblem 2, on a sphere", fontsize=10)


def columns(theta: Sequence[float], lengths: Sequence[float], J: np.ndarray) -> None:
    """A planar arm of two links, and the velocity of its tip while one joint alone turns at 1 rad/s."""
    ax = blank((6.4, 4.2))
    t1, t2 = theta
    elbow = lengths[0] * _to(t1)
    tip = elbow + lengths[1] * _to(t1 + t2)
    ax.plot(*np.array([[0, 0], elbow, tip]).T, "-", lw=5, color="#D5DAE1", solid_capstyle="round", zorder=1)
    for point, column, name, style in (
        ((0, 0), J[:, 0], "joint 1", "accent"),
        (elbow, J[:, 1], "joint 2", "trace"),
    ):
        ax.plot(*np.array([point, tip]).T, ":", lw=1.2, color=palette(style))
        ax.plot(*point, "o", ms=9, color=palette(style))
        ax.annotate("", tip + column, tip, arrowprops={"arrowstyle": "-|>", "lw": 2, "color": palette(style)})
        end = tip + column + 0.06 * column / np.hypot(*column)
        ax.text(*end, name, color=palette(style), ha="right", va="center")
    ax.plot(*tip, "D", ms=7, color=INK)
    ax.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", xlim=(-0.3, 0.8), ylim=(-0.1, 1.1))
    show()


def drift(change: np.ndarray) -> None:
    """How far each joint is from where it began, after every lap. change (laps, n) in radians."""
    ax = blank((6.4, 3.2))
    laps, n = change.shape
    for k, row in enumerate(np.degrees(change)):
        place = np.arange(1, n + 1) + 0.26 * (k - (laps - 1) / 2)
        label = f"after lap {k + 1}"
        ax.bar(place, row, 0.24, color=palette("accent"), alpha=0.3 + 0.7 * k / (laps - 1), label=label)
    ax.axhline(0, lw=0.8, color=INK)
    ax.set(xlabel="joint", ylabel="change of the joint [deg]", xticks=range(1, n + 1))
    ax.legend(frameon=False)
    show()


def error_along_path(error: ArrayLike) -> None:
    """FK(IK) - T, the largest entry, for every pose (rows) and branch (columns)."""
    ax = blank((6.4, 3.4))
    shown = np.maximum(error, 1e-17)
    ax.semilogy(shown, ".", ms=4, color=palette("ghost"), alpha=0.5)
    ax.semilogy(shown.max(axis=1), "-", lw=1.2, color=palette("accent"), label="largest of the eight")
    ax.axhline(2e-15, ls="--", lw=1, color=INK, label="2e-15")
    ax.set(xlabel="pose on the S", ylabel="largest entry of FK(IK(T)) − T [m], [1]", ylim=(1e-17, 1e-14))
    ax.legend(frameon=False, loc="upper right")
    show()


def newton(runs: Mapping[str, ArrayLike]) -> None:
    """Largest entry of FK - T_sd before each step. runs: label -> list of errors."""
    ax = blank((6.4, 3.6))
    for (label, errors), (color, style) in zip(runs.items(), STYLES, strict=False):
        ax.semilogy(np.maximum(errors, 1e-16), style, ms=5, color=palette(color), label=label)
    ax.set(xlabel="step", ylabel="largest entry of FK − T [m], [1]")
    ax.legend(frameon=False)
    show()


def rates(noise: Sequence[float] | np.ndarray, nearest: ArrayLike, converged: ArrayLike) -> None:
    """Shares in percent over the noise of the guess."""
    ax = blank((6.4, 3.4))
    ax.semilogx(noise, nearest, "o-", color=palette("accent"), label="of these, at the nearest solution")
    ax.semilogx(noise, converged, "s--", color=palette("trace"), label="converged")
    ax.set(xlabel="noise of the guess [rad per joint]", ylabel="share [%]", ylim=(0, 105), xticks=noise)
    ax.set_xticks([], minor=True)
    ax.set_xticklabels([f"{x:g}" for x in noise])
    ax.legend(frameon=False, loc="lower left")
    show()


def wandering(distance: ArrayLike, closest: float) -> None:
    """Distance to a target out of reach before each step, and the nearest that can be reached."""
    ax = blank((6.4, 3.4))
    ax.plot(distance, "o-", ms=3, lw=1, color=palette("trace"), label="Newton")
    ax.axhline(closest, ls="--", color=palette("accent"), label="closest pose found by going downhill")
    ax.set(xlabel="step", ylabel="distance from the target [m]", ylim=(0, None))
    ax.legend(frameon=False)
    show()
