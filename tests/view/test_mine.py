"""What the student wrote in the explorers, without a browser: right, wrong, unfinished, slow, impolite."""

import json
import sys
import time
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from coursekit import robots, view
from coursekit.classroom.course import the_course
from coursekit.classroom.mistakes import Solved
from coursekit.view import mine, reopened, sketch
from tests.unpacked import unpacked
from tests.view.test_picture import on_paper

KR6 = robots.kuka_kr6()
ABB = robots.abb_irb1200()
SHOWN = [(opener, name) for opener, names in mine.WANTED.items() for name in names]
FUNCTIONS = [(opener, name) for opener, name in SHOWN if mine.WANTED[opener][name].signature]
# for which arm a function is opened, where it is not the KR6
FOR = {"home_pose": ABB, "explore_path": ABB}
# the share of wrong answers that no pose of the explorer brings out; of every other function a third
RARE = {"rank": 0.4, "angle_axis": 0.4, "quaternion": 0.65, "inside": 0.7}
THETA = np.array([0.3, -1.0, 1.2, 0.4, 0.5, 0.6])


def unit_of(name):
    return the_course().find(name)[0]


def right(name):
    """The function of the solved notebook."""
    function = getattr(Solved(unit_of(name)), name)
    return lambda *arguments: function(*arguments)


@cache
def wrong(name):
    """Label -> function, of the wrong answers on which the course's feedback is proved."""
    path = Path(__file__).resolve().parents[1] / "classroom" / "wrong" / f"{unit_of(name)}.json"
    found, solved = {}, Solved(unit_of(name))
    written = {one.name: getattr(solved, one.name) for one in the_course().exercises(unit_of(name))}
    for row in json.loads(path.read_text(encoding="utf-8")):
        if row["exercise"] == name:
            space = {"np": np, "numpy": np, **written}
            exec(f"from coursekit import *\nimport math\n{row['code']}", space)  # as in the notebook
            found[row["label"]] = space[name]
    return found


@pytest.fixture(autouse=True)
def no_plots(monkeypatch):
    """They have nothing to do with what is tested here, and take most of the time."""
    monkeypatch.setattr(view.Plot, "refresh", lambda plot, values: None)


@pytest.fixture
def opened():
    """Open an explorer with functions of the student; closed after the test."""
    panels = []

    def open_one(opener, functions, **more):
        name = next(iter(functions)) if isinstance(functions, dict) else ""
        robot = FOR.get(opener) or FOR.get(name, KR6)
        panels.append(getattr(view, opener)(robot, mine=functions, **more))
        return panels[-1]

    yield open_one
    for panel in panels:
        panel.close()


def move(panel, k=0):
    """Some other values, as a person would set them; others for every k."""
    turned = np.array([0.4, 0.3, 0.6, 0.2, 0.3, -0.4]) + 0.003 * k
    values = {"theta": THETA + 0.003 * k, "turn": 0.7 + 0.003 * k, "pose": turned}
    values |= {"bounds": "the robot's own" if k % 2 else "2 rad/s each", "damping": 0.2 + 0.01 * k}
    panel.set(**{name: value for name, value in values.items() if name in panel.values})


def said(panel, name):
    """What the text says of a function."""
    begin = f"yours, {name}: "
    (line,) = [line for line in panel.line.value.splitlines() if line.startswith(begin)]
    return line.removeprefix(begin)


def offered(panel):
    """Whether the buttons that come with the student's functions are there, one bool each."""
    return [button.layout.display != "none" for button in panel._update.__self__._brought]


def agrees(words):
    good = ("below 1e-", "which is right", "judged rightly", "nothing is lost here")
    return "off" not in words and any(told in words for told in good)


def pink(panel):
    """How many pixels of the picture have the student's colour, solid or translucent."""
    r, g, b = np.moveaxis(on_paper(view.png(panel.scene, 480, 320)), -1, 0)
    return int(((r - g > 20) & (b - g > 10) & (r > b)).sum())


# -- what is taken


@pytest.mark.parametrize(("opener", "name"), FUNCTIONS)
def test_names_arguments_and_shapes_are_those_of_the_exercises(opener, name):
    exercise, wanted = the_course().find(name)[1], mine.WANTED[opener][name]
    assert exercise.arguments == wanted.signature.split(", ")
    assert exercise.shape == wanted.shape


def test_a_function_says_by_its_name_which_exercise_it_is(opened):
    def fk_poe(S, M, theta):
        return M

    for given in (fk_poe, [fk_poe], {"fk_poe": lambda S, M, theta: M}):
        assert "is the first that is off" in said(opened("explore", given), "fk_poe")


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (lambda S, M, theta: M, "shows no function '<lambda>'. It shows: dh_transform, mdh_transform"),
        ({"ellipsoid": len}, "shows no function 'ellipsoid'"),
        ({"screw_axis": len}, "view.explore_screws shows that one"),
    ],
)
def test_an_unknown_name_is_refused_with_the_valid_ones(given, told):
    with pytest.raises(ValueError, match=told):
        view.explore(KR6, mine=given)


def test_what_a_function_returned_is_no_function():
    with pytest.raises(TypeError, match=r"mine takes functions, not what they return; .* is of type ndarray"):
        view.explore(KR6, mine=np.eye(4))


# -- right and wrong


@pytest.mark.parametrize(("opener", "name"), FUNCTIONS)
def test_a_right_function_agrees_everywhere(opened, opener, name):
    panel = opened(opener, {name: right(name)})
    for _ in range(2):
        assert agrees(said(panel, name)) and all(offered(panel))
        move(panel)


@pytest.mark.parametrize(("opener", "name"), FUNCTIONS)
def test_no_wrong_function_agrees_and_none_stops_the_view(opened, opener, name):
    """Every wrong answer of the collection; what is off only in rare cases agrees where the arm stands."""
    agree = []
    current = [lambda *_: None]
    panel = opened(opener, {name: lambda *arguments: current[0](*arguments)})
    for k, (label, current[0]) in enumerate(wrong(name).items()):
        panel._update.__self__.mine._known.clear()  # another function
        move(panel, k)
        if name == "rank":  # elsewhere it is 6
            panel.set(theta=np.zeros(6))
        if agrees(said(panel, name)):
            agree.append(label)
    assert len(agree) <= len(wrong(name)) * RARE.get(name, 0.34), agree


@pytest.mark.parametrize(("opener", "name"), FUNCTIONS)
def test_a_function_that_is_not_written_yet_says_what_will_be_seen(opened, opener, name):
    def unwritten(*arguments):
        raise NotImplementedError

    panel = opened(opener, {name: unwritten})
    sees = mine.WANTED[opener][name].sees
    assert said(panel, name) == f"not written yet. Write it, and you see {sees}"
    assert sketch.ROOT not in "".join(panel.scene.parts)
    assert not any(offered(panel))  # a button that does nothing


def raises(*arguments):
    parts = list(arguments)
    return parts[len(parts)]


def prints(*arguments):
    print("here", arguments)


MISFITS = {
    "raises": (raises, "line 3 of raises raises IndexError: list index out of range"),
    "does not take the arguments": (lambda: 0, "TypeError"),
    "leaves Python": (lambda *_: sys.exit(3), "line 1 of <lambda> raises SystemExit: 3"),
    "returns nothing": (prints, "it returns None: is there a `return` at its end?"),
    "a word": (lambda *_: "T", "it returns no array of real numbers (str)"),
    "complex": (lambda *_: np.eye(4) * 1j, "it returns no array of real numbers (ndarray)"),
    "ragged": (lambda *_: [[1, 2], [3]], "it returns no array of real numbers (list)"),
    "shape": (lambda *_: np.eye(3), "it returns shape (3, 3), expected (4, 4)"),
    "NaN": (lambda *_: np.full((4, 4), np.nan), "it returns numbers that are not finite"),
    "infinity": (lambda *_: np.eye(4) / 0, "it returns numbers that are not finite"),
    "zeros": (
        lambda *_: np.zeros((4, 4)),
        "frame 1 is the first that is off, by 400.0 mm and columns of R or a last row that no pose has",
    ),
    "millimetres": (lambda S, M, theta: M * [1, 1, 1, 1000], "; too far away to be drawn (metres?)"),
    "huge": (
        lambda *_: np.eye(4) * 1e300,
        "frame 1 is the first that is off, by 400.0 mm and columns of R or a",
    ),
}


@pytest.mark.parametrize("kind", MISFITS)
def test_whatever_a_function_returns_the_view_goes_on(opened, capsys, kind):
    function, told = MISFITS[kind]
    panel = opened("explore", {"fk_poe": function})
    assert told in said(panel, "fk_poe")
    move(panel)
    assert told in said(panel, "fk_poe")
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, THETA)
    assert "product of exponentials  x =" in panel.line.value, "the arm's own numbers are there all the same"
    panel._repr_mimebundle_()
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(("opener", "name"), FUNCTIONS)
def test_no_answer_stops_any_explorer(opened, opener, name):
    shape = mine.WANTED[opener][name].shape
    shapes = shape if shape and isinstance(shape[0], tuple) else (shape,)
    answers = [None, np.nan, "T", (), [[]], np.zeros((2, 2))]
    for size in (0.0, 1e-8, 1e9):
        parts = tuple(np.full([n or 6 for n in one], size) for one in shapes)
        answers.append(parts if len(parts) > 1 else parts[0])
    queue = [None]
    panel = opened(opener, {name: lambda *_: queue[-1]})
    for k, answer in enumerate(answers):
        queue.append(answer)
        move(panel, k)
        assert said(panel, name) and not agrees(said(panel, name))
        view.png(panel.scene, 90, 60)


def test_a_function_that_works_again_is_seen_again(opened):
    def fk_poe(S, M, theta):
        return 1 / 0 if theta[0] > 1 else M

    panel = opened("explore", fk_poe)
    panel.set(theta=[2, 0, 0, 0, 0, 0])
    assert said(panel, "fk_poe") == "line 2 of fk_poe raises ZeroDivisionError: division by zero"
    assert not any(path.startswith(sketch.ROOT) for path in panel.scene.parts)
    panel.set(theta=[0.5, 0, 0, 0, 0, 0])
    assert "off" in said(panel, "fk_poe") and any(p.startswith(sketch.ROOT) for p in panel.scene.parts)


def test_a_function_that_changes_its_arguments_gets_copies(opened):
    def fk_poe(S, M, theta):
        theta *= 0
        return M

    panel = opened("explore", fk_poe, theta=THETA)
    assert said(panel, "fk_poe").endswith("; it changes its argument theta (here it gets copies)")
    np.testing.assert_array_equal(panel.values["theta"], THETA)
    panel.set(theta=THETA / 2)
    np.testing.assert_array_equal(panel.values["theta"], THETA / 2)


def test_a_slow_function_waits_while_a_slider_moves_and_comes_at_its_end(opened):
    asked = []

    def fk_poe(S, M, theta):
        asked.append(theta[0])
        time.sleep(0.02)
        return M

    panel = opened("explore", fk_poe)
    assert said(panel, "fk_poe").endswith("called less often while a slider moves")
    assert "slow" not in repr(panel), "that would be another line on another machine"
    slider, before = panel._controls["theta"].sliders[0], len(asked)
    for degrees in range(1, 21):
        slider.set_state({"value": float(degrees), "live": True})
    assert len(asked) - before < 20 * KR6.n / 2, "less often"
    assert said(panel, "fk_poe").startswith("shown when the slider rests; slow: more than 50 ms")
    assert sketch.ROOT not in "".join(panel.scene.parts), "nothing of another pose is left"
    slider.set_state({"live": False})
    assert asked[-1] == pytest.approx(np.radians(20)) and "off" in said(panel, "fk_poe")


# -- what is seen


def test_yours_is_seen_beside_the_right_one(opened):
    agrees = pink(opened("explore", {"fk_poe": right("fk_poe")}, theta=THETA))
    differs = pink(opened("explore", {"fk_poe": lambda S, M, theta: M}, theta=THETA))
    assert agrees < 300 and differs > 2000, "a small frame, and an arm"


def test_the_arm_stands_where_the_function_says(opened):
    def fk_poe(S, M, theta):  # as if joint 3 stood still
        return (
            KR6.fk(np.pad(theta * (np.arange(len(theta)) != 2), (0, 6 - len(theta))))
            @ np.linalg.inv(KR6.M)
            @ M
        )

    panel = opened("explore", fk_poe, theta=THETA)
    assert said(panel, "fk_poe").startswith("frame 3 is the first that is off, by 68.8 deg; the tool is off")
    still = KR6.displacements(THETA * [1, 1, 0, 1, 1, 1])
    worlds = panel.scene.worlds([f"{sketch.ROOT}/fk_poe/arm/{k}" for k in range(1, 7)])
    np.testing.assert_allclose(list(worlds.values()), still, atol=1e-12)


def test_the_chosen_joint_turns_the_rest_of_the_arm_about_the_axis_of_the_student(opened):
    def screw_axis(w, q):
        return np.concatenate([w, np.cross(w, q)])  # the wrong sign

    panel = opened("explore_screws", screw_axis)
    panel.set(turn=np.pi)
    axis_is_at = np.array([-0.025, 0, -0.4])
    (moved,) = panel.scene.worlds([f"{sketch.ROOT}/screw_axis/arm/2"]).values()
    np.testing.assert_allclose(moved @ [*axis_is_at, 1], [*axis_is_at, 1], atol=1e-12)
    (still,) = panel.scene.worlds([f"{sketch.ROOT}/screw_axis/arm/1"]).values()
    np.testing.assert_array_equal(still, np.eye(4))


def test_axes_get_a_tick_where_they_are_right(opened):
    S = KR6.S.copy()
    S[3:, 4] = 0
    panel = opened("explore_screws", {"S": S})
    ticks = {label["text"] for label in panel.scene.labels if "\N{CHECK MARK}" in label["text"]}
    assert ticks == {"S1 ✓", "yours S2 ✓", "S3 ✓", "S4 ✓", "S6 ✓"}
    assert said(panel, "S") == "off: joint 5"
    panel.set(joint="joint 5")
    assert "off: joint 5. Joint 5: the axes are 999.6 mm apart; v is off by 999.6 mm per rad" in said(
        panel, "S"
    )


def test_attitudes_that_agree_lie_upon_each_other_and_have_one_name(opened):
    names = ["zyx", "quaternion", "angle_axis", "slerp"]
    panel = opened("explore_path", {name: right(name) for name in names})

    def shown():
        return [label["text"] for label in panel.scene.labels if label["text"].startswith("yours")]

    assert shown() == ["yours ✓"]
    panel.set(branch="front elbow-up no-flip")
    assert shown() == ["yours ✓"]
    panel = opened(
        "explore_path", {**{name: right(name) for name in names}, "zyx": lambda R: [0.1, 0.2, 0.3]}
    )
    assert sorted(shown()) == ["yours ✓", "yours: zyx"]


def test_an_arm_without_the_table_or_with_slides_is_told(opened):
    arm = robots.stanford()
    panel = view.explore(arm, mine={"fk_dh": right("fk_dh"), "fk_poe": right("fk_poe")})
    assert said(panel, "fk_dh") == f"it is for joints that turn, and one of {arm.name} slides"
    assert said(panel, "fk_poe").endswith("below 1e-9")
    panel.close()


# -- what a notebook stores


def test_the_stored_line_holds_the_verdict_and_still_gives_a_page(opened):
    panel = opened("explore", {"fk_poe": right("fk_poe")})
    line = repr(panel)
    assert line.endswith("; yours, fk_poe: every frame and the tool agree with the arm's, below 1e-9")
    assert "translucent" not in line
    assert f'"{sketch.ROOT}"' in unpacked(view.to_html(panel)), (
        "hidden where no kernel can compute it for another pose"
    )
    assert reopened.page_of(line).startswith("<!DOCTYPE html>")


def test_the_arm_begins_where_it_is_told_and_comes_back_there_also_beyond_its_limits(opened):
    beyond = [3.5, -1, 1, 0, 0, 0]
    panel = opened("explore", {"fk_poe": right("fk_poe")}, theta=beyond)
    np.testing.assert_array_equal(panel.values["theta"], beyond)
    panel.set(theta=np.zeros(6))
    panel.reset()
    np.testing.assert_array_equal(panel.values["theta"], beyond)
    with pytest.raises(ValueError, match=r"has 6 joints: theta must be \(6,\), got \(2,\)"):
        view.explore(KR6, theta=[0, 1])
