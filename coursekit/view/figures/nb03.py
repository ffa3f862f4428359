"""Pictures of notebook 03: the two elbows, the error of closed-form solutions, Newton's steps.

Every function shows one figure and returns None.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from coursekit.view.figures import INK, palette

STYLES = (("accent", "o-"), ("trace", "s--"), ("body", "^-."), ("axis", "D:"))


def elbows(lengths: ArrayLike, solutions: Iterable[Sequence[float] | np.ndarray]) -> None:
    """The arm in its own plane for both (theta2, theta3): the upper elbow solid, the lower one dashed."""
    a1, d1, a2, a3, d4 = 1000 * np.asarray(lengths)
    ax = _axes((6.4, 4.6))
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
        ax.text(elbow[0] + 25 * side, elbow[1], f"elbow {elbow[1]:.1f} mm", color=palette(color), va="center",
                ha="right" if side < 0 else "left")  # fmt: skip
    ax.plot([a1, P[0]], [d1, P[1]], "-.", lw=1, color=INK)
    ax.text((a1 + P[0]) / 2 + 12, (d1 + P[1]) / 2, "b", color=INK, fontsize=12, style="italic")
    ax.plot(*P, "D", ms=8, color=INK)
    ax.text(P[0] + 22, P[1] + 12, "P", color=INK, fontsize=12, style="italic")
    ax.set(xlabel="r: distance from axis 1 [mm]", ylabel="z [mm]", aspect="equal", xlim=(-620, 760))
    _show()


def error_along_path(error: ArrayLike) -> None:
    """FK(IK) - T, the largest entry, for every pose (rows) and branch (columns)."""
    ax = _axes((6.4, 3.4))
    shown = np.maximum(error, 1e-17)
    ax.semilogy(shown, ".", ms=4, color=palette("ghost"), alpha=0.5)
    ax.semilogy(shown.max(axis=1), "-", lw=1.2, color=palette("accent"), label="largest of the eight")
    ax.axhline(2e-15, ls="--", lw=1, color=INK, label="2e-15")
    ax.set(xlabel="pose on the S", ylabel="largest entry of FK(IK(T)) − T [m], [1]", ylim=(1e-17, 1e-14))
    ax.legend(frameon=False, loc="upper right")
    _show()


def newton(runs: Mapping[str, ArrayLike]) -> None:
    """Largest entry of FK - T_sd before each step. runs: label -> list of errors."""
    ax = _axes((6.4, 3.6))
    for (label, errors), (color, style) in zip(runs.items(), STYLES, strict=False):
        ax.semilogy(np.maximum(errors, 1e-16), style, ms=5, color=palette(color), label=label)
    ax.set(xlabel="step", ylabel="largest entry of FK − T [m], [1]")
    ax.legend(frameon=False)
    _show()


def rates(noise: Sequence[float] | np.ndarray, nearest: ArrayLike, converged: ArrayLike) -> None:
    """Shares in percent over the noise of the guess."""
    ax = _axes((6.4, 3.4))
    ax.semilogx(noise, nearest, "o-", color=palette("accent"), label="of these, at the nearest solution")
    ax.semilogx(noise, converged, "s--", color=palette("trace"), label="converged")
    ax.set(xlabel="noise of the guess [rad per joint]", ylabel="share [%]", ylim=(0, 105), xticks=noise)
    ax.set_xticks([], minor=True)
    ax.set_xticklabels([f"{x:g}" for x in noise])
    ax.legend(frameon=False, loc="lower left")
    _show()


def wandering(distance: ArrayLike, closest: float) -> None:
    """Distance to a target out of reach before each step, and the nearest that can be reached."""
    ax = _axes((6.4, 3.4))
    ax.plot(distance, "o-", ms=3, lw=1, color=palette("trace"), label="Newton")
    ax.axhline(closest, ls="--", color=palette("accent"), label="closest pose found by going downhill")
    ax.set(xlabel="step", ylabel="distance from the target [m]", ylim=(0, None))
    ax.legend(frameon=False)
    _show()


def _axes(size):
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=size, layout="constrained")
    ax.grid(alpha=0.3)
    return ax


def _show():
    import matplotlib.pyplot as plt

    plt.show()
