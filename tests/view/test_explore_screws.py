"""The explorer of notebook 02 without a browser."""

import numpy as np
import pytest

from coursekit import Robot, robots, view
from coursekit.view import text

KR6 = robots.kuka_kr6()


@pytest.fixture
def panel():
    panel = view.explore_screws(KR6)
    yield panel
    panel.close()


@pytest.mark.parametrize("joint", range(6))
def test_the_text_holds_the_column_of_S(panel, joint):
    panel.set(joint=f"joint {joint + 1}")
    assert text.row(KR6.S[:, joint]) in panel.line.value


@pytest.mark.parametrize("label", ["flange frame: B", "wrist frame: B of the wrist"])
def test_the_text_holds_the_column_of_B_in_either_frame(panel, label):
    panel.set(joint="joint 5", frame=label)
    B_5 = KR6.B[:, 4] if label.startswith("flange") else [0, 1, 0, 0, 0, 0]
    assert text.row(B_5) in panel.line.value


def test_sliding_q_moves_the_point_and_not_the_screw(panel):
    panel.set(joint="joint 3")
    before = panel.line.value.splitlines()
    panel.set(slide=0.2)
    after = panel.line.value.splitlines()
    assert before[1] != after[1], "q has moved"
    assert before[2:] == after[2:], "v and the column have not"


def test_only_the_chosen_joint_turns(panel):
    panel.set(joint="joint 2", turn=-np.pi / 2)
    assert np.allclose(panel.scene.robots["robot"].theta, [0, -np.pi / 2, 0, 0, 0, 0])
    assert text.millimetres(KR6.fk([0, -np.pi / 2, 0, 0, 0, 0])[:3, 3]) in panel.line.value


@pytest.mark.parametrize("name", ["franka_panda", "planar_2r"])
def test_an_arm_whose_last_axes_do_not_meet_has_no_wrist_frame(name):
    panel = view.explore_screws(robots.all()[name])
    with pytest.raises(ValueError, match="it has: space frame: S, flange frame: B"):
        panel.set(frame="wrist frame: B of the wrist")
    panel.close()


def test_a_slide_turns_nothing_and_has_a_direction():
    """The SCARA's third joint: S = (0; v), whatever the point."""
    panel = view.explore_screws(robots.scara())
    try:
        panel.set(joint="joint 3")
        way = robots.scara().S[3:, 2]
        assert f"column 3 of S = {text.row([0, 0, 0, *way])}    (0; v)" in panel.line.value
        panel.set(slide=0.2, frame="flange frame: B")
        seen = robots.scara().M[:3, :3].T @ way
        assert f"column 3 of B = {text.row([0, 0, 0, *seen])}    (0; v)" in panel.line.value
        assert "w = 0" in panel.line.value and not panel.scene.parts["/ck/lever"]
        panel.set(turn=0.1, joint="joint 1")
        assert panel.values["turn"] == 0, "a length is no angle: the slider starts anew"
    finally:
        panel.close()


def test_a_screw_with_a_pitch_slides_as_it_turns():
    S = np.array([[0, 0, 1, 0, 0, 0.05], [0, 1, 0, -0.4, 0, 0]]).T
    panel = view.explore_screws(Robot.from_screws(S, np.eye(4), name="lead screw"))
    try:
        panel.set(joint="joint 1")
        assert "v = -w x q + h w, with a pitch h of 50.0 mm per rad" in panel.line.value
    finally:
        panel.close()


def test_it_has_a_picture_and_a_stable_line(panel):
    bundle = panel._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    assert data["text/plain"].startswith("Explorer of screws: KUKA KR6")
    assert "image/png" in data
