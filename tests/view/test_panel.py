"""Panels and their controls without a browser."""

import gc
import weakref

import ipywidgets
import numpy as np
import pytest

from coursekit import robots, view
from coursekit.view import Action, Choice, Panel, Plot, Scene, Slider, Sliders, Table, Toggle, joint_sliders
from coursekit.view.script import Script


@pytest.fixture
def made():
    """Close what a test made."""
    panels = []
    yield lambda panel: panels.append(panel) or panel
    for panel in panels:
        panel.close()


def small_panel(**more):
    kr6 = robots.kuka_kr6()
    scene = Scene()
    scene.robot(kr6)
    calls = []

    def update(values):
        calls.append(values)
        scene.robots["robot"].theta = values["theta"]

    panel = Panel(
        "test", scene, [joint_sliders(kr6), Toggle("on")], update, lambda values: str(values["on"]), **more
    )
    panel.calls = calls
    return panel


def as_the_browser(widget, **state):
    """A message from the page: a person has changed this control."""
    widget.set_state(state)


def open_models():
    return len(ipywidgets.widgets.widget._instances)


def test_a_slider_moved_in_the_page_moves_the_robot(made):
    panel = made(small_panel())
    as_the_browser(panel._controls["theta"].sliders[0], value=30.0, live=True)
    theta = panel.values["theta"]
    assert theta[0] == pytest.approx(np.pi / 6, abs=1e-15)
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, theta)
    poses = np.frombuffer(panel.viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
    np.testing.assert_array_equal(poses, robots.kuka_kr6().displacements(theta))


def test_set_is_exact_and_updates_once(made):
    panel = made(small_panel())
    panel.calls.clear()
    theta = [0.4, -0.3, 1 / 3, 0.1, -0.7, 1.1]
    panel.set(theta=theta, on=True)
    assert len(panel.calls) == 1
    assert panel.values["theta"].tolist() == theta and panel.values["on"] is True
    assert panel.line.value == "True"


def test_a_slider_never_answers_its_own_drawing():
    slider = Slider("x", 0.4, -1, 1)
    assert slider.value == 0.4
    as_the_browser(slider, value=0.4)
    assert slider.si == 0.4
    as_the_browser(slider, value=7.0)
    assert slider.value == 1.0, "a value beyond the ends is clipped"


def test_units():
    angle = Slider("a", np.pi / 3, -np.pi, np.pi, "deg")
    length = Slider("l", 0.25, 0, 1, "mm")
    assert (angle.value, angle.max, angle.si) == (60, 180, np.pi / 3)
    assert (length.value, length.max, length.si) == (250, 1000, 0.25)
    as_the_browser(length, value=125.0)
    assert length.si == 0.125


def test_joint_sliders_serve_another_robot():
    sliders = joint_sliders(robots.franka_panda())
    sliders.fit(robots.planar_2r())
    np.testing.assert_array_equal(sliders.get(), robots.planar_2r().home)
    assert [slider.layout.display for slider in sliders.sliders][1:3] == [None, "none"]
    with pytest.raises(ValueError, match="'theta' has 2 sliders, Franka Emika Panda needs 7"):
        joint_sliders(robots.planar_2r()).fit(robots.franka_panda())


def test_a_choice_gives_what_stands_behind_its_label(made):
    panel = made(Panel("choice", Scene(), [Choice("pick", {"one": 1, "two": 2})]))
    as_the_browser(panel._controls["pick"], value="two")
    assert panel.values == {"pick": 2}


def test_an_action_and_a_table_and_a_plot(made):
    drawn = []

    def draw(figure, values):
        drawn.append(values["x"])
        figure.subplots().set(xlim=(0, 10), ylim=(0, 10))

    plot = Plot(draw, "An empty plot.")
    table = Table("rows", lambda values: (["x"], [[f"{values['x']:.2f}"]]), selectable=True)
    go = Action("go", act=lambda: panel.set(x=0.5))
    panel = made(Panel("all", Scene(), [Slider("x"), go], below=[plot, table]))
    assert table.rows == [["0.00"]] and plot.svg.startswith("<svg")

    panel._message(go, {"type": "press"}, [])
    assert panel.values["x"] == 0.5 and table.rows == [["0.50"]] and drawn[-1] == 0.5

    as_the_browser(table, value=0)
    assert panel.values["rows"] == 0


def test_a_plot_waits_while_a_slider_is_dragged_and_is_right_at_rest(made):
    drawn = []
    plot = Plot(lambda figure, values: drawn.append(values["x"]), "Nothing.")
    panel = made(Panel("drag", Scene(), [Slider("x")], below=[plot]))
    plot.has_time = lambda _values: False
    drawn.clear()
    for value in (0.1, 0.2, 0.3):
        as_the_browser(panel._controls["x"], value=value, live=True)
    assert drawn == []
    as_the_browser(panel._controls["x"], value=0.3, live=False)
    assert drawn == [0.3]


def test_an_action_can_play_a_motion_and_reset_ends_it(made):
    kr6 = robots.kuka_kr6()
    scene = Scene()
    scene.robot(kr6)
    thetas = np.linspace(kr6.home, kr6.home + 0.5, 11)
    go = Action("go", act=lambda: panel.play(thetas))
    panel = made(Panel("motion", scene, [go, Toggle("on")]))
    panel._message(go, {"type": "press"}, [])
    assert panel.viewer.motion["frames"] == 11 and panel.viewer.frame == 0
    np.testing.assert_array_equal(scene.robots["robot"].theta, kr6.home)
    as_the_browser(panel._controls["on"], value=True)
    assert panel.viewer.frame == 0, "a switch does not end it"
    panel.reset()
    assert panel.viewer.frame == -1 and panel.viewer.motion == {}


def the_page_shows(panel, frame, playing=False):
    """What the page says while it plays, or where it rests."""
    panel.viewer.set_state({"frame": frame, "playing": playing})


def test_what_a_motion_shows_is_what_everything_shows(made):
    panel = made(small_panel())
    kr6, thetas = robots.kuka_kr6(), np.linspace([0, -1, 1, 0, 0, 0], [1, -1, 1, 0, 9, 0], 11)
    panel.play(thetas)
    for frame, playing in ((3, True), (10, False)):
        the_page_shows(panel, frame, playing)
        np.testing.assert_array_equal(panel.values["theta"], thetas[frame])  # beyond a limit, too
        np.testing.assert_array_equal(panel.scene.robots["robot"].theta, thetas[frame])
        np.testing.assert_array_equal(panel.calls[-1]["theta"], thetas[frame])
        assert panel.viewer.frame == frame
        pose = np.frombuffer(panel.viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
        np.testing.assert_array_equal(pose, kr6.displacements(thetas[frame]))
    as_the_browser(panel._controls["theta"].sliders[0], value=30.0)
    np.testing.assert_array_equal(panel.values["theta"], [np.pi / 6, *thetas[10, 1:]])
    assert panel.viewer.motion == {}
    the_page_shows(panel, 4)  # said before the page knew
    assert panel.viewer.frame == -1 and panel.values["theta"][0] == np.pi / 6


def test_an_error_of_the_explorer_is_shown(made):
    def update(values):
        if values["x"] > 0.5:
            raise ValueError("too far")

    panel = made(Panel("error", Scene(), [Slider("x")], update))
    with pytest.raises(ValueError, match="too far"):
        panel.set(x=0.9)
    assert panel.line.value == "ValueError: too far"


def test_running_a_cell_again_leaves_no_widget_models(made):
    made(view.explore(robots.kuka_kr6()))
    before = open_models()
    for _ in range(5):
        made(view.explore(robots.kuka_kr6()))
        assert open_models() == before


def test_close_leaves_nothing():
    small_panel().close()  # the first of all brings the page's script, which stays
    before = open_models()
    small_panel(below=[Plot(lambda figure, values: None, "Nothing.")]).close()
    assert open_models() == before


def test_scripts_and_style_sheets_come_once(made):
    small_panel().close()
    before = set(ipywidgets.widgets.widget._instances)
    made(view.explore_inverse(robots.kuka_kr6()))
    made(small_panel(below=[Plot(lambda figure, values: None, "Nothing.")]))
    models = [model for key, model in ipywidgets.widgets.widget._instances.items() if key not in before]
    states = [state for state in (model.get_state() for model in models) if "_esm" in state]
    assert len(states) > 25
    assert sum(len(state["_esm"]) + len(state.get("_css", "")) for state in states) < 1000 * len(states)


def test_the_script_comes_again_where_all_widgets_were_closed():
    first = Slider("x").script
    assert Toggle("y").script is first and isinstance(first, Script)
    first.close()
    again = Slider("x").script
    assert again is not first and len(again.get_state()["_esm"]) > 50_000


@pytest.mark.parametrize("name", [name for name in view.__all__ if name.startswith("explore")])
def test_a_closed_explorer_is_forgotten(name):
    panel = getattr(view, name)()
    kept = [weakref.ref(widget) for widget in (panel, panel.viewer, *panel._controls.values())]
    panel.close()
    del panel
    gc.collect()
    assert [one() for one in kept if one() is not None] == []


def test_reset_goes_back_and_keeps_the_chosen_robot(made):
    panel = made(view.explore())
    panel.set(robot=robots.franka_panda().name)
    chosen = panel.values["robot"]
    start = panel.values["theta"]
    panel.set(theta=start + 0.1, standard=True)
    panel.reset()
    np.testing.assert_array_equal(panel.values["theta"], start)
    assert panel.values["robot"] == chosen and not panel.values["standard"]


@pytest.mark.parametrize("name", robots.all())
def test_every_arm_can_be_explored_and_its_conventions_agree(made, name):
    robot = robots.all()[name]
    panel = made(view.explore(robot))
    panel.set(
        theta=np.clip(robot.home * 0.5, robot.q_min, robot.q_max),
        standard=True,
        modified=True,
        screws=True,
        skeleton=True,
    )
    if robot.standard_dh is None and robot.modified_dh is None:
        assert "no DH table" in panel.line.value
    else:
        assert float(panel.line.value.rsplit(": ", 1)[1]) < 1e-14
    assert repr(panel).startswith(f"Explorer of DH and PoE: {robot.name}: joints (") and "\n" not in repr(
        panel
    )


def test_what_the_notebook_stores_is_one_stable_line_and_a_picture(made):
    panel = made(view.explore(robots.kuka_kr6()))
    data, metadata = panel._repr_mimebundle_()
    assert data["text/plain"] == f"Explorer of DH and PoE: {panel.scene.text()}"
    assert "(0.0, -90.0, 90.0, 0.0, 0.0, 0.0) deg" in data["text/plain"] and "\n" not in data["text/plain"]
    assert data["image/png"].startswith(b"\x89PNG") and len(data["image/png"]) < 60_000
    assert metadata["image/png"]["alt"] == data["text/plain"]


def test_every_widget_has_a_stable_repr():
    shown = [Slider("x"), Toggle("t"), Choice("c", ["a"]), Action("go"), Sliders("v", [Slider("x")])]
    shown += [Plot(lambda figure, values: None, "Seen."), Table("r", lambda values: ([], []))]
    for widget in shown:
        assert " at 0x" not in repr(widget) and "\n" not in repr(widget)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: Slider("x", low=1, high=0), "slider 'x': low must be below high, got 1 and 0"),
        (lambda: Slider("x").put(3), r"slider 'x' goes over \[-1, 1\], got 3"),
        (lambda: Choice("c", ["a", "b"], start="z"), "choice 'c' has no 'z'; it has: a, b"),
        (lambda: joint_sliders(robots.kuka_kr6()).put([1, 2]), r"'theta' takes 6 numbers, got shape \(2,\)"),
        (
            lambda: Panel("p", Scene(), [Slider("x"), Slider("x")]),
            "panel 'p': two controls are called 'x'",
        ),
        (lambda: Panel("p", Scene(), [Slider("x")]).set(y=1), "panel 'p' has no control 'y'; it has: x"),
    ],
)
def test_mistakes_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_panel_that_another_replaced_says_so(made):
    first = made(small_panel())
    made(small_panel())
    with pytest.raises(ValueError, match=r"is closed, by close\(\) or by one of the same name"):
        first.set(on=True)


def test_values_are_read_once_a_change(made, monkeypatch):
    panel, read = made(small_panel()), []
    original = Sliders.get
    monkeypatch.setattr(Sliders, "get", lambda self: read.append(self.name) or original(self))
    as_the_browser(panel._controls["theta"].sliders[0], value=30.0)
    assert read == ["theta"]


# -- what went wrong once


def test_a_set_that_is_refused_leaves_everything_where_it_was(made):
    kr6 = robots.kuka_kr6()
    panel = made(small_panel())
    panel.set(theta=[0.1, -1, 1, 0, 0.2, 0], on=True)
    before = panel.values["theta"]
    for wrong in ({"theta": [0.3, -1, 1, 0, 99, 0]}, {"on": False, "theta": [1, 2]}):
        with pytest.raises(ValueError, match=r"'theta5' goes over|takes 6 numbers"):
            panel.set(**wrong)
        np.testing.assert_array_equal(panel.values["theta"], before)
        np.testing.assert_array_equal(panel.scene.robots["robot"].theta, before)
        assert panel.values["on"] is True
    poses = np.frombuffer(panel.viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
    np.testing.assert_array_equal(poses, kr6.displacements(before))


def test_a_set_that_the_explorer_refuses_is_taken_back(made):
    def update(values):
        if values["x"] > 0.5:
            raise ValueError("too far")

    panel = made(Panel("error", Scene(), [Slider("x", 0.2)], update))
    with pytest.raises(ValueError, match="too far"):
        panel.set(x=0.9)
    assert panel.values["x"] == 0.2
    assert panel.line.value == "ValueError: too far"


def test_a_choice_takes_what_it_gives():
    arms = robots.all()
    choice = Choice("robot", arms)
    choice.put("ur5")
    choice.put(choice.get())
    assert choice.value == "ur5"
    choice.put(arms["puma560"])
    assert choice.get() is arms["puma560"]
    vectors = Choice("v", {"ones": np.ones(3), "zeros": np.zeros(3)})  # == of arrays is no truth value
    vectors.put(vectors.meaning["zeros"])
    assert vectors.value == "zeros"
    with pytest.raises(ValueError, match="choice 'v' has no 7; it has: ones, zeros"):
        vectors.put(7)


def test_a_table_named_like_a_control_is_refused():
    table = Table("x", lambda values: ([], []))
    with pytest.raises(ValueError, match="panel 'p': two controls are called 'x'"):
        Panel("p", Scene(), [Slider("x")], below=[table])


def test_a_stock_widget_stands_among_the_controls(made):
    button = ipywidgets.Button(description="mine")
    panel = made(Panel("p", Scene(), [Slider("x"), button], below=[ipywidgets.HTML("<b>below</b>")]))
    assert panel.values == {"x": 0.0}
    column = panel.children[0].children[0]
    assert button in column.children


def test_two_panels_of_one_cell_live_and_both_go_when_it_runs_again(made, monkeypatch):
    from coursekit.view import cells

    run = ["cell", "first run"]
    monkeypatch.setattr(cells, "running", lambda: tuple(run))
    one, other = made(small_panel()), made(small_panel())
    assert one.scene is not None and other.scene is not None
    run[1] = "second run"
    third = made(small_panel())
    assert (one.scene, other.scene) == (None, None) and third.scene is not None


def test_where_nobody_names_the_cell_another_cell_closes_nothing(tmp_path):
    """As in Voila and nbconvert: two cells, then the first once more."""
    import nbformat
    from nbclient import NotebookClient

    show = "from coursekit import view\nfirst = view.explore()"
    cells = [show, "second = view.explore()", "was = first", show]
    cells += ["print([panel.scene is not None for panel in (was, second, first)])"]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    NotebookClient(notebook, kernel_name="python3", timeout=120).execute(cwd=str(tmp_path))
    assert notebook.cells[-1].outputs[0]["text"].strip() == "[False, True, True]"


def test_a_picture_is_drawn_between_two_changes_and_never_during_one(made, monkeypatch):
    import threading

    from coursekit.view import viewer as module

    panel, drawn = made(small_panel()), threading.Event()
    monkeypatch.setattr(module, "png", lambda *_: drawn.set() or b"")
    with panel._lock:
        asking = threading.Thread(target=panel.viewer._answer, args=(panel.viewer, {"type": "need_png"}, []))
        asking.start()
        assert not drawn.wait(0.2)
    asking.join()
    assert drawn.is_set()


def test_every_change_is_answered(made):
    panel = made(small_panel())
    before = panel.viewer.answers
    as_the_browser(panel._controls["on"], value=False, touched=1)  # nothing changed, and yet somebody asked
    assert panel.viewer.answers > before


def test_what_a_hand_drags_in_the_picture_goes_to_its_sliders_at_once():
    """One message moves all six sliders of a target, or the joints, and is answered."""
    panel = view.explore_jacobians()
    try:
        (handle,) = panel.viewer.handles
        assert (handle["path"], handle["letter"]) == ("/ck/target", "{d}")
        assert len(handle["sliders"]) == len(handle["per"]) == 6
        shown = [300.0, 100.0, 500.0, 10.0, 20.0, 30.0]
        panel.viewer.set_state({"dragged": {"what": "/ck/target", "values": shown, "live": True, "count": 1}})
        np.testing.assert_allclose(
            panel.values["pose"], [0.3, 0.1, 0.5, *np.radians([10, 20, 30])], rtol=0, atol=1e-12
        )
        assert panel.viewer.heard == 1
        degrees = [0, 10, 0, -90, 0, 90, None]
        before = panel.values["theta"]
        panel.viewer.set_state({"dragged": {"what": "theta", "values": degrees, "live": False, "count": 2}})
        np.testing.assert_allclose(np.degrees(panel.values["theta"][:6]), degrees[:6], atol=1e-9)
        assert panel.values["theta"][6] == before[6] and panel.viewer.heard == 2
        np.testing.assert_array_equal(panel.scene.robots["robot"].theta, panel.values["theta"])
    finally:
        panel.close()
