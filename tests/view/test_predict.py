"""Predictions: the right guess is told to be right, and each mistake that has a name gets it."""

import numpy as np
import pytest

from coursekit import Robot, ik, robots, singularity, view
from coursekit.view import questions
from coursekit.view.camera import ASPECT
from coursekit.view.picture import _Eye

ARMS = robots.all()
every_arm = pytest.mark.parametrize("robot", ARMS.values(), ids=ARMS)
X, Y, Z = np.eye(3)


@pytest.fixture
def opened():
    panels = []

    def run(explore, robot):
        panels.append(explore(robot))
        return panels[-1]

    yield run
    for panel in panels:
        panel.close()


def press(panel, name):
    panel._controls[name].act()
    panel.refresh()


def answer(panel, guess):
    """What is told of a guess (3,)."""
    panel.set(prediction=guess)
    press(panel, "show_answer")
    return panel.line.value.splitlines()[1]


def in_the_picture(panel, *points):
    """Whether these points (3,) are seen from where the camera stands at first, with room for a handle."""
    eye = _Eye(panel.viewer.camera, 430 * ASPECT, 430)
    pixels = eye.project(np.array(points))[0]
    return np.all((pixels > 15) & (pixels < [430 * ASPECT - 15, 415]))


def tool(robot, theta):
    return robot.fk(theta)[:3, 3]


def by_one(robot, j, by):
    return by * np.eye(robot.n)[j]


@every_arm
def test_where_the_tool_will_be_and_what_wrong_guesses_look_like(robot):
    for number in range(6):
        theta = questions.a_pose(robot, robot.home, number)
        step = np.where([kind == "revolute" for kind in robot.joint_types], np.pi / 12, 0.05)
        np.testing.assert_allclose(theta / step, np.round(theta / step), atol=1e-9)
        j, by = questions.a_move(robot, theta, number)
        assert robot.within_limits(theta + by_one(robot, j, by))
        question = questions.where_after(robot, theta, j, by, "where?")
        right, start = tool(robot, theta + by_one(robot, j, by)), tool(robot, theta)
        np.testing.assert_allclose(question.start, start, atol=1e-12)
        told, at = question.judge(right)
        np.testing.assert_allclose(at, right, atol=1e-9)
        assert told == "Right: 0.0 mm off." or told == "Right: 0 mm off."
        near = min(0.05 * view.Scene().size, 0.25 * np.linalg.norm(right - start))
        meant = {"that is where the tool is before the move": start}
        meant["the other way"] = tool(robot, theta - by_one(robot, j, by))
        for k in (j - 1, j + 1):
            if 0 <= k < robot.n and robot.joint_types[k] == robot.joint_types[j]:
                moved = tool(robot, theta + by_one(robot, k, by))
                meant["axis" if robot.joint_types[j] == "revolute" else "slid"] = moved
        for name, guess in meant.items():
            others = [p for other, p in meant.items() if other != name]
            told = question.judge(guess)[0]
            assert alike(guess, [right, *others], near) or name in told or "no lever" in told
        told = question.judge(tool(robot, theta + by_one(robot, j, by / 2)))[0]
        assert any(
            words in told for words in ("but turned by", "along it", "as if", "no lever", "before the move")
        )


def alike(point, others, near):
    return min(np.linalg.norm(point - other) for other in others) < 3 * near


def test_plane_and_radius_of_a_guess():
    M = np.eye(4)
    M[:3, 3] = 0.6, 0, 0.4
    arm = Robot.from_axes([Z, Y], [(0, 0, 0), (0, 0, 0.4)], M, name="two hinges")
    question = questions.where_after(arm, np.zeros(2), 0, np.pi / 2, "where?")
    assert question.judge(np.array([0, 0.6, 0.4]))[0].startswith("Right")
    said = {
        (0, 0.4, 0.4): "200 mm off: right plane and right angle, but the radius is too small by 200 mm.",
        (
            0,
            0.6,
            0.7,
        ): "300 mm off: right radius and right angle, but 300 mm off the plane in which it moves.",
        (0, -0.6, 0.4): "1200 mm off: you turned the other way.",
        (0.6, 0, 0.4): "849 mm off: that is where the tool is before the move.",
        (
            0.3 * 3**0.5,
            0.3,
            0.4,
        ): "600 mm off: right plane and right radius, but turned by 30 deg, not 90 deg.",
    }
    for guess, words in said.items():
        assert question.judge(np.array(guess, float))[0] == words
    question = questions.where_after(arm, np.array([np.pi / 2, 0]), 1, np.pi / 4, "where?")
    assert "before joints 1 to 1 carry it" in question.judge(np.array([0, 0.6, 0.4]))[0]


def test_a_direction():
    others = {"that is the axis": Z}
    for signed in (True, False):
        question = questions.which_way(np.zeros(3), 3 * X, others, "which way?", (), 1.0, signed)
        assert abs(question.start @ X) < 1e-12, "where it starts tells nothing"
        assert question.judge(X + 0.05 * Y)[0] == "Right: 3 deg off."
        assert question.judge(0.5 * Z)[0] == "90 deg off: that is the axis."
        assert question.judge(X + Y)[0] == "45 deg off."
        assert question.judge(np.zeros(3))[0] == "Your arrow has no direction."
    assert question.judge(-X)[0] == "Right: 0 deg off."
    signed = questions.which_way(np.zeros(3), 3 * X, others, "which way?", (), 1.0)
    assert signed.judge(-X)[0] == "180 deg off: you point the other way."


@every_arm
@pytest.mark.parametrize("explore", [view.explore, view.explore_screws], ids=["conventions", "screws"])
def test_the_explorer_of_a_move(robot, explore, opened):
    panel = opened(explore, robot)
    begun = panel.viewer.camera
    panel.set(predict=True)
    arm = panel.scene.robots["robot"]
    for _ in range(3):
        first = panel.line.value.splitlines()[0]
        assert first.startswith("Predict: ") and "Where will the tool be?" in first
        before = arm.theta
        np.testing.assert_allclose(panel.values["prediction"], tool(robot, before), atol=1e-9)
        panel.set(prediction=[0.1, 0.2, 0.3])
        assert panel.line.value.splitlines()[1] == "Your guess: (100, 200, 300) mm."
        np.testing.assert_array_equal(arm.theta, before)
        explorer = panel._update.__self__
        right = explorer.prediction.question.judge(np.zeros(3))[1]
        assert in_the_picture(panel, tool(robot, before), right)
        assert "Right: 0 mm off." in answer(panel, right)
        np.testing.assert_allclose(tool(robot, panel.motion.thetas[-1]), right, atol=1e-9)
        assert not panel.viewer.handles, "what is answered is not moved"
        press(panel, "next_question")
        assert panel.motion is None
    panel.set(predict=False)
    assert panel.viewer.camera == begun
    assert not panel.line.value.startswith("Predict") and "/ck/predict/guess" not in panel.scene.parts


def test_a_moved_joint_ends_the_question(opened):
    panel = opened(view.explore, robots.kuka_kr6())
    panel.set(predict=True)
    assert [held["path"] for held in panel.viewer.handles] == ["/ck/predict/guess"]
    panel.set(theta=panel.values["theta"] + 0.1)
    assert panel.line.value.startswith(questions.MOVED)
    assert not panel.viewer.handles
    press(panel, "show_answer")
    assert panel.line.value.startswith(questions.MOVED)
    press(panel, "next_question")
    assert panel.line.value.startswith("Predict: ")


def test_another_robot_gets_a_question_of_its_own(opened):
    panel = opened(lambda _: view.explore(), None)
    panel.set(predict=True)
    for robot in ARMS.values():
        if robot.standard_dh is not None:
            panel.set(robot=robot.name)
            assert panel.line.value.startswith("Predict: ")
            np.testing.assert_allclose(
                panel.values["prediction"], tool(robot, panel.scene.robots["robot"].theta), atol=1e-9
            )


@every_arm
def test_the_elbow(robot, opened):
    panel = opened(view.explore_inverse, robot)
    panel.set(predict=True)
    explorer = panel._update.__self__
    if not explorer.asking:
        assert "endlessly many" in panel.line.value or "no elbow" in panel.line.value
        assert robot.name in ("Franka Emika Panda", "Stanford arm") or robot.n == 7
        return
    np.testing.assert_array_equal(panel.scene.robots["robot"].theta, robot.home)
    assert list(panel.scene.robots) == ["robot"] and not panel._controls["solution"].figures
    assert panel._controls["solution"].rows == [], "they would tell the joint angles"
    right = explorer.prediction.question.judge(np.array([0.2, 0.3, 0.4]))[1]
    assert in_the_picture(panel, explorer.prediction.question.start, right)
    told = answer(panel, right)
    assert "You hit " in told and ": 0 mm off." in told
    assert panel._controls["solution"].rows
    theta = panel.scene.robots["robot"].theta
    np.testing.assert_allclose(tool(robot, theta), panel.values["pose"][:3], atol=1e-8)
    pose = panel.values["pose"]
    press(panel, "next_question")
    assert not np.array_equal(panel.values["pose"], pose)


def test_the_elbow_has_the_name_of_its_branch(opened):
    kr6 = robots.kuka_kr6()
    panel = opened(view.explore_inverse, kr6)
    panel.set(predict=True)
    explorer = panel._update.__self__
    T = explorer.T
    for theta, name in zip(ik.analytic(kr6, T).theta, ik.analytic(kr6, T).branches, strict=True):
        elbow = kr6.link_frames(theta)[2, :3, 3]
        told, _ = explorer.prediction.question.judge(elbow)
        assert told == f"You hit {name.rsplit(' ', 1)[0]}: 0 mm off."
    far = explorer.prediction.question.judge(np.array([2.0, 2.0, 2.0]))[0]
    assert (
        "off the nearest" in far and "mm too far from joint 2, " in far and "mm too far from joint 4." in far
    )


@every_arm
def test_the_lost_direction(robot, opened):
    panel = opened(view.explore_singularities, robot)
    panel.set(predict=True)
    explorer = panel._update.__self__
    for _ in range(3):
        if robot.n < 6:
            assert "fewer than six joints" in panel.line.value
            return
        theta = panel.values["theta"]
        assert singularity.rank(robot, theta, 1e-6) == 5
        assert "\nlost: force" not in panel.line.value, "it would tell the answer"
        origin, lost = explorer.prediction.question.origin, singularity.weakest_motion(robot, theta)
        turns = "cannot turn" in panel.line.value
        right = lost[:3] - np.cross(origin, lost[3:]) if turns else lost[3:]
        assert "Right: 0 deg off." in answer(panel, origin - right)
        press(panel, "next_question")


def test_a_regular_pose_loses_nothing(opened):
    kr6 = robots.kuka_kr6()
    panel = opened(view.explore_singularities, kr6)
    panel.set(predict=True)
    panel.set(theta=[0, -1, 1, 0.4, 0.7, 0])
    assert "not just one motion is lost" in panel.line.value and not panel.viewer.handles
    press(panel, "next_question")
    assert "Point along it" in panel.line.value


@every_arm
def test_the_velocity_of_the_tool(robot, opened):
    panel = opened(view.explore_jacobians, robot)
    panel.set(predict=True)
    for _ in range(2):
        j = int(panel.line.value.split("joint ")[1].split()[0]) - 1
        v, at = robot.jacobian_geometric(panel.values["theta"])[3:, j], tool(robot, panel.values["theta"])
        assert not panel.formula[0].value, "its columns are the answers"
        assert "Right: 0 deg off." in answer(panel, at + v / np.linalg.norm(v))
        assert panel.formula[0].value
        press(panel, "next_question")
    panel.set(theta=panel.values["theta"] + 0.01)
    assert panel.line.value.startswith(questions.MOVED)


@pytest.mark.parametrize("name", ["abb_irb1200", "planar_2r"])
def test_the_bound_and_the_elbow_on_a_path(name, opened):
    robot = ARMS[name]
    panel = opened(view.explore_path, robot)
    told, explorer = panel.line.value, panel._update.__self__
    panel.set(predict=True)
    asked = panel.line.value.splitlines()[0]
    limit = explorer.limit
    assert f"joint {limit.joint[explorer.branch] + 1} sets the largest speed. Where" in asked
    assert "after point" in told and "after point" not in panel.line.value
    assert "Hidden until" in panel.below[0].svg and not panel.below[0].cursor
    steps = (explorer.points[1:] + explorer.points[:-1]) / 2
    right = steps[limit.index[explorer.branch]]
    assert in_the_picture(panel, right, explorer.points[0])
    assert explorer.prediction.question.judge(np.array([5.0, 0, 0]))[0].endswith(" mm off.")
    assert "Right: 0 mm off." in answer(panel, right)
    assert limit.index[explorer.branch] == panel.motion.frame and "Hidden" not in panel.below[0].svg
    panel.set(branch=panel.values["branch"], predict=False)
    panel.set(predict=True)
    panel.rest_at(30)
    assert questions.MOVED in panel.line.value
    press(panel, "next_question")
    assert not any("predict" in path for path in panel.viewer.motion["moving"]), "it stays with the hand"
    assert panel.motion.frame == 0 and "to its middle, point 51. Where will joint" in panel.line.value
    elbow = explorer.prediction.question.judge(np.zeros(3))[1]
    assert "You hit the place half-way: 0 mm off." in answer(panel, elbow)
    assert panel.motion.frame == 50
