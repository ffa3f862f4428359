"""Figures in numbers and words: what a picture of a notebook says to those who do not see it."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from coursekit.view import curves, figures


def test_a_drawing_without_curves_says_what_is_written_there():
    ax = Figure().subplots()
    ax.plot([0, 1], [0, 1])
    for note in ("$a_2$", "400", "400", ""):
        ax.annotate(note, (0.5, 0.5))
    ax.set(xlim=(0, 700), ylim=(-100, 900), xlabel="x [mm]", ylabel="z [mm]")
    assert curves.words(ax.figure) == "z [mm], -100 to 900, over x [mm], 0 to 700. Written there: a_2, 400."
    assert curves.table(ax.figure) == []


def test_a_picture_in_space_says_its_three_axes():
    figure = Figure()
    ax = figure.add_subplot(projection="3d")
    ax.plot([0, 1], [0, 1], [0, 1], label="not a curve over x")
    ax.set(xlim=(0, 1), ylim=(0, 2), zlim=(0, 3), zlabel="z [m]")
    assert curves.words(figure) == "z [m], 0 to 3, over y, 0 to 2, over x, 0 to 1."
    assert curves.table(figure) == []


def test_what_rounding_leaves_of_zero_is_zero_but_on_a_log_axis():
    ax = Figure().subplots()
    ax.plot([0, 1], [1e-17, 5], label="rate")
    assert "rate: from 0 to 5, lowest 0" in curves.words(ax.figure)
    ax.set_yscale("log")
    assert "rate: from 1e-17 to 5" in curves.words(ax.figure)


def test_a_figure_of_a_notebook_is_stored_with_its_words(monkeypatch):
    import matplotlib.pyplot as plt

    stored = []
    monkeypatch.setattr(
        "IPython.display.display", lambda data, metadata, raw: stored.append((data, metadata))
    )
    _, ax = plt.subplots()
    x = np.linspace(0, 2, 5)
    ax.plot(x, x**2, label="square")
    ax.set(xlabel="s", ylabel="area", xlim=(0, 2), ylim=(0, 4))
    figures.show()
    ((data, metadata),) = stored
    assert set(data) == {"image/png", "text/plain"}
    told = "area, 0 to 4, over s, 0 to 2. square: from 0 to 4, lowest 0, highest 4."
    assert metadata == {"image/png": {"alt": told}}


@pytest.mark.parametrize("name", ["nb01", "nb02", "nb03", "nb04", "nb05", "nb06"])
def test_every_figure_is_shown_by_the_house(name):
    module = __import__(f"coursekit.view.figures.{name}", fromlist=["show"])
    with open(module.__file__, encoding="utf-8") as file:
        assert "plt.show" not in file.read()
    assert module.show is figures.show
