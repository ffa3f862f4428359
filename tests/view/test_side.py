"""Drawings with dimensions: what stands on the paper is enough to find the arm again, and says it rightly."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgba

from coursekit import Robot, robots
from coursekit.classroom import own
from coursekit.view.figures import palette
from coursekit.view.figures.side import draw_arm

SHAPES = {(own.sheet_of(seed).forward, own.sheet_of(seed).upright): seed for seed in range(1, 30)}


@pytest.fixture
def paper():
    figure, ax = plt.subplots()
    yield ax
    plt.close(figure)


def texts(ax):
    return [text.get_text() for text in ax.texts if text.get_text()]


def marks(ax, marker):
    """Where crosses ("x") or circles ("o") were drawn, (k, 2)."""
    lines = [line for line in ax.lines if line.get_marker() == marker and len(line.get_xdata()) == 1]
    return np.array([[line.get_xdata()[0], line.get_ydata()[0]] for line in lines]).reshape(-1, 2)


def test_all_four_shapes_of_an_own_arm_are_tried():
    assert len(SHAPES) == 4


@pytest.mark.parametrize("seed", SHAPES.values())
def test_every_length_of_an_own_arm_is_written_once(paper, seed):
    draw_arm(paper, own.arm_of(seed))
    written = sorted(float(text) for text in texts(paper) if text.isdigit() and len(text) > 1)
    assert written == sorted(round(1000 * length) for length in own.sheet_of(seed).lengths.values())


@pytest.mark.parametrize("seed", SHAPES.values())
def test_a_cross_points_into_the_page_and_a_dot_out_of_it(paper, seed):
    """The page shows forward to the right and up upwards: into it points up x forward."""
    robot, sheet = own.arm_of(seed), own.sheet_of(seed)
    draw_arm(paper, robot)
    forward = np.eye(3)["xy".index(sheet.forward)]
    into = [i for i in (1, 2, 4) if robot.S[:3, i] @ np.cross([0, 0, 1], forward) > 0]
    expected = [[1000 * robot.places[i] @ forward, 1000 * robot.places[i, 2]] for i in into]
    assert np.allclose(marks(paper, "x"), np.reshape(expected, (-1, 2)))
    assert len(marks(paper, "x")) == sum(sheet.signs[i] > 0 for i in (1, 2, 4))
    assert paper.get_xlabel() == f"{sheet.forward} [mm]"


@pytest.mark.parametrize("seed", SHAPES.values())
def test_arrows_point_where_the_joints_do(paper, seed):
    """Axes 1, 4 and 6 lie in the page: each arrow leads from its tail to its tip."""
    robot, sheet = own.arm_of(seed), own.sheet_of(seed)
    draw_arm(paper, robot)
    color = to_rgba(palette("axis"))
    arrows = [t for t in paper.texts if t.arrow_patch and t.arrow_patch.get_edgecolor() == color]
    ways = [np.sign(np.round(np.subtract(t.xy, t.xyann))) for t in arrows]
    signs = sheet.signs
    assert np.array_equal(ways, [[0, signs[0]], [signs[3], 0], [signs[5], 0]])


def test_the_kr6_can_be_read_off_its_drawing(paper):
    draw_arm(paper, robots.kuka_kr6())
    assert {"400", "25", "455", "35", "420", "80"} <= set(texts(paper))
    # what a student reads there, and no more
    w = [[0, 0, -1], [0, 1, 0], [0, 1, 0], [-1, 0, 0], [0, 1, 0], [-1, 0, 0]]
    q = [[0, 0, 0], [25, 0, 400], [480, 0, 400], [480, 0, 435], [900, 0, 435], [900, 0, 435]]
    assert np.allclose(Robot.from_axes(w, np.array(q) / 1000, np.eye(4)).S, robots.kuka_kr6().S)
