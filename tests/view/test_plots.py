"""Plots of a panel: ink and colours, marks that move without the figure, hands on them, their numbers."""

import re

import numpy as np
import pytest

from coursekit import path, view
from coursekit.view import Action, Panel, Plot, Scene, Slider
from coursekit.view.plots import CURVES
from tests.view.test_panel import as_the_browser

OPENERS = ("explore_inverse", "explore_singularities", "explore_jacobians", "explore_path")
PAPERS = ("#FFFFFF", "#212121")  # the lightest paper of JupyterLab and, of its dark theme, the lighter one


@pytest.fixture
def opened():
    """Function: the panel that this opener opens, and its plot, drawn."""
    panels = []

    def open_it(opener):
        panels.append(getattr(view, opener)())
        panels[-1].refresh()
        return panels[-1], next(widget for widget in panels[-1].below if isinstance(widget, Plot))

    yield open_it
    for panel in panels:
        panel.close()


def drawn(draw, **more):
    plot = Plot(draw, "What to see.", **more)
    plot.refresh({})
    return plot


def square(figure, _values=None):
    figure.subplots().set(xlim=(0, 10), ylim=(0, 10))


def light(color):
    parts = np.array([int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)])
    parts = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(parts @ [0.2126, 0.7152, 0.0722])


def contrast(color, paper):
    low, high = sorted((light(color), light(paper)))
    return (high + 0.05) / (low + 0.05)


# -- what is drawn


@pytest.mark.parametrize("opener", OPENERS)
def test_ink_and_letters_are_the_pages_and_curves_can_be_seen_on_both_papers(opened, opener):
    _, plot = opened(opener)
    assert plot.svg.startswith("<svg") and plot.svg.endswith("</svg>\n")
    assert "currentColor" in plot.svg and "<text" in plot.svg
    for word in ("font-family", "<style", "<metadata", "#000000"):
        assert word not in plot.svg
    colors = [line.get_color() for line in plot._figure.axes[0].lines if len(line.get_xdata()) > 1]
    for color in {color for color in colors if color != "#010203"}:
        assert min(contrast(color, paper) for paper in PAPERS) >= 3, color


def test_every_color_of_a_curve_can_be_seen_on_both_papers():
    assert min(contrast(color, paper) for color in CURVES for paper in PAPERS) >= 3


def test_where_there_is_less_room_the_figure_is_smaller_and_its_letters_are_not(opened):
    _, plot = opened("explore_inverse")
    sizes = []
    for room in (plot.width, 290):
        plot.room = room
        points = float(re.search(r'viewBox="0 0 ([\d.]+)', plot.svg).group(1))
        assert 72 / 96 * room == pytest.approx(points), "drawn as wide as it is shown"
        sizes.append(set(re.findall(r"font[^;]*?([\d.]+)px", plot.svg)))
    assert sizes[0] == sizes[1] != set()


def test_the_same_figure_is_the_same_text():
    def draw(figure, _values):
        figure.subplots().plot([1, 2], [3, 4], "o", clip_on=True, label="a")

    assert drawn(draw).svg == drawn(draw).svg


# -- what is drawn again, and what only moves


@pytest.mark.parametrize(
    ("opener", "changes"),
    [
        ("explore_inverse", [{"guess": [0.5] * 6}, {"solution": 2}, {"pose": [0.4, 0.1, 0.6, 0, 1, 0]}]),
        (
            "explore_singularities",
            [{"theta": [0, -1, 1.2, 0, 0.5, 0]}, {"across": "θ3"}, {"theta": [0, -1, 1, 0, 1, 0]}],
        ),
        ("explore_jacobians", [{"damping": 0.3}, {"theta": [0.2, 0.5, 0.2, -1, 0, 1, 0]}, {"linear": False}]),
        ("explore_path", [{"wrapped": True}, {"points": 201}, {"bounds": "the robot's own"}]),
    ],
)
def test_what_is_not_drawn_again_would_be_the_same(opened, opener, changes):
    panel, plot = opened(opener)
    for change in changes:
        panel.set(**change)
        kept, numbers = plot.svg, plot.numbers
        plot._draw(panel.values)
        assert (plot.svg, plot.numbers) == (kept, numbers), change


@pytest.mark.parametrize(
    ("opener", "button"),
    [
        ("explore_inverse", "steps"),
        ("explore_singularities", "to_elbow"),
        ("explore_jacobians", "newton"),
        ("explore_path", None),
    ],
)
def test_in_a_motion_only_the_mark_moves(opened, opener, button):
    panel, plot = opened(opener)
    if button:
        panel._message(panel._controls[button], {"type": "press"}, [])
    as_the_browser(panel.viewer, frame=1, playing=False)
    svg, seen = plot.svg, []
    plot.draw = lambda *_: pytest.fail("it is drawn again")
    for frame in (2, 3, 4):
        as_the_browser(panel.viewer, frame=frame, playing=True)
        (mark,) = plot.cursor
        seen.append(mark)
    assert (
        plot.svg == svg and not np.isclose(seen[0], seen[1]).all() and not np.isclose(seen[1], seen[2]).all()
    )


def test_marks_stand_where_their_points_are():
    marks = [[0, 0], [5, 5], [10, np.nan], [11, 5], [5, -1], [11, np.nan]]
    plot = drawn(square, cursor=lambda _values: marks)
    axes = plot._figure.axes[0].get_position()
    assert len(plot.cursor) == 3, "what lies outside the axes is not shown"
    np.testing.assert_allclose(plot.cursor[0], [axes.x0, axes.y0, axes.y0], atol=1e-12)
    middle = (axes.y0 + axes.y1) / 2
    np.testing.assert_allclose(plot.cursor[1], [(axes.x0 + axes.x1) / 2, middle, middle], atol=1e-12)
    np.testing.assert_allclose(plot.cursor[2], [axes.x1, axes.y0, axes.y1], atol=1e-12)
    assert drawn(square).cursor == drawn(square, cursor=lambda _values: []).cursor == []


def test_while_a_slider_is_dragged_the_figure_waits_and_its_mark_does_not():
    shown = {"draws": 0, "key": 0}

    def draw(figure, _values):
        shown["draws"] += 1
        square(figure)

    plot = Plot(draw, "Seen.", cursor=lambda values: [values["x"], 5], key=lambda _values: shown["key"])
    panel = Panel("drag", Scene(), [Slider("x", high=10)], below=[plot])
    plot._cost = 1e9
    as_the_browser(panel._controls["x"], value=3.0, live=True)
    (before,) = plot.cursor
    as_the_browser(panel._controls["x"], value=4.0, live=True)
    assert plot.cursor[0][0] > before[0] and shown["draws"] == 1
    shown["key"] = 1
    as_the_browser(panel._controls["x"], value=5.0, live=True)
    assert shown["draws"] == 1
    as_the_browser(panel._controls["x"], value=5.0, live=False)
    assert shown["draws"] == 2
    panel.close()


def test_a_figure_that_fails_is_not_taken_for_drawn():
    def draw(figure, values):
        figure.subplots().plot([0, values["x"]], [0, 1 / (values["x"] - 2)])

    plot = Plot(draw, "Seen.", key=lambda values: values["x"])
    plot.refresh({"x": 1})
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            plot.refresh({"x": 2})


# -- hands


def at(plot, x, y):
    """A point of the data as fractions of the picture."""
    place = plot._figure.axes[0].transData.transform((x, y)) / plot._figure.bbox.size
    return dict(zip("xy", place.tolist(), strict=True))


def point(plot, x, y, live=False):
    told = {**at(plot, x, y), "live": live, "count": plot.touched}
    as_the_browser(plot, pointed=told, touched=plot.touched + 1)


def test_a_click_gives_the_point_and_a_drag_stays_on_the_axes():
    clicked = []
    plot = Plot(square, "Seen.", on_click=lambda x, y: clicked.append((x, y)))
    panel = Panel("clicks", Scene(), [Action("go")], below=[plot])
    panel.refresh()
    answers = panel.viewer.answers
    point(plot, 3, 7)
    point(plot, -1, 5)  # beside the axes
    point(plot, 3, 7)  # the same again counts
    np.testing.assert_allclose(clicked, [(3, 7), (3, 7)], atol=1e-9)
    assert panel.viewer.answers == answers + 3
    clicked.clear()
    point(plot, 3, 7, live=True)
    point(plot, 14, 7, live=True)
    point(plot, 14, -2)  # the end of the drag, and only then the axes count again
    point(plot, 14, 5)
    np.testing.assert_allclose(clicked, [(3, 7), (10, 7), (10, 0)], atol=1e-9)
    panel.close()


def test_the_map_is_dragged_and_its_figure_stays(opened):
    panel, plot = opened("explore_singularities")
    svg = plot.svg
    for live in (True, True, False):
        point(plot, -100, 40 + live, live)
        np.testing.assert_allclose(np.degrees(panel.values["theta"][1:3]), [-100, 40 + live], atol=1e-9)
        np.testing.assert_allclose(plot.cursor[0][:2], [*at(plot, -100, 40 + live).values()], atol=1e-9)
    assert plot.svg == svg


def test_a_click_on_a_step_of_newton_shows_it(opened):
    panel, plot = opened("explore_inverse")
    point(plot, 3.2, 1e-4)
    assert panel.motion.frame == 3 and "shown: Newton's step 3 of 11" in panel.line.value
    first = panel.viewer.motion["id"]
    point(plot, 4.8, 1e-4)
    assert panel.motion.frame == panel.viewer.frame == 5 and panel.viewer.motion["id"] == first
    point(plot, 11.5, 1e-4)
    assert panel.motion.frame == 11, "there are no more"


def test_a_click_on_a_step_of_the_damped_or_of_newton_shows_it(opened):
    panel, plot = opened("explore_jacobians")
    for name in ("damped", "newton"):
        steps = [step.theta for step in panel_found(panel)[name].history]
        length = panel_found(panel)[name].history[3].step
        point(plot, 2.9, length)
        np.testing.assert_allclose(panel.values["theta"], steps[3], atol=1e-12)
        np.testing.assert_allclose(plot.cursor[0][:2], [*at(plot, 3, length).values()], atol=1e-9)


def panel_found(panel):
    """The runs that the plot of this panel shows."""
    return panel.below[0].draw.__self__.found(panel.values)


def test_a_click_on_the_rates_puts_the_arm_there(opened):
    panel, plot = opened("explore_path")
    s = np.append(0, np.cumsum(path.steps(path.s_curve(101))))
    point(plot, s[40] + 1e-4, 10)
    assert panel.motion.frame == panel.viewer.frame == 40 and not panel.viewer.playing
    np.testing.assert_allclose(plot.cursor[0][0], at(plot, s[40], 0)["x"], atol=1e-9)


def test_only_a_motion_can_rest():
    panel = Panel("rest", Scene(), [Action("go")])
    with pytest.raises(ValueError, match="panel 'rest' has no motion"):
        panel.rest_at(1)
    panel.close()


# -- numbers


def test_the_numbers_are_those_of_the_labelled_curves():
    x = np.arange(40.0)

    def draw(figure, _values):
        ax = figure.subplots()
        ax.plot(x, 2 * x, label="twice")
        ax.plot(x[:20], -x[:20], label="less")
        ax.plot([], [], label="in the legend alone")
        ax.axhline(3)
        ax.set(xlabel="step", ylabel="size [mm]", title="A title", xlim=(0, 40), ylim=(-20, 80))

    plot = drawn(draw)
    title, header, *rows = plot.numbers
    assert title == ["size [mm]"] and header == ["step", "twice", "less"]
    assert len(rows) == 12 and rows[0] == ["0", "0", "0"] and rows[-1] == ["39", "78", "-"]
    assert [row[1] for row in rows] == [f"{2 * float(row[0]):g}" for row in rows]
    assert plot.alt == (
        "A title. size [mm], -20 to 80, over step, 0 to 40. twice: from 0 to 78, lowest 0, highest 78. "
        "less: from 0 to -19, lowest -19, highest 0."
    )
    assert repr(plot) == f"Plot({plot.alt})"


def test_a_map_has_no_table_and_says_its_axes(opened):
    _, plot = opened("explore_singularities")
    assert plot.numbers == []
    assert plot.alt == "θ3 [deg], -120 to 156, over θ2 [deg], -190 to 45."


def test_newtons_errors_are_told(opened):
    _, plot = opened("explore_inverse")
    assert plot.alt.startswith(
        "11 steps to back elbow-down flip. angle, distance left, 1e-17 to 10, over step"
    )
    assert re.search(
        r"angle \[rad\]: from 2\.6\d+ to [\d.]+e-1\d, lowest [\d.]+e-1\d, highest 2\.8\d+\.", plot.alt
    )
    assert [row[0] for row in plot.numbers[2:]] == [str(k) for k in range(12)]


def test_a_page_that_plays_is_asked_to_stop_where_a_click_is_and_says_when_it_has(opened, monkeypatch):
    panel, plot = opened("explore_path")
    sent = []
    monkeypatch.setattr(panel.viewer, "send", lambda content, buffers=None: sent.append(content))
    as_the_browser(panel.viewer, frame=5, playing=True)
    point(plot, 1.0, 10)
    as_the_browser(panel.viewer, frame=7)  # what was under way already
    (asked,) = [content for content in sent if content["type"] == "rest"]
    assert panel.viewer.playing and panel.motion.frame == 7
    as_the_browser(panel.viewer, frame=asked["frame"], playing=False)
    assert panel.motion.frame == asked["frame"] == 55
