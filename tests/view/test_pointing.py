"""What formulas point at, without a browser: rows of tables, levers, columns, and the small figures."""

import numpy as np
import pytest

from coursekit import ik, robots, view
from coursekit.view import camera, pointing
from coursekit.view.scene import Scene
from coursekit.view.silhouettes import silhouettes

KR6 = robots.kuka_kr6()


def arrow(scene, path):
    """Where an arrow begins and what it adds, (3,) each; nothing where it has no length."""
    if not scene.parts[path]:
        return None, np.zeros(3)
    (part,) = scene.parts[path]
    return part.pose[:3, 3], part.pose[:3, 2] * max(height for _, height in part.shape)


@pytest.mark.parametrize("name", ["standard", "modified"])
@pytest.mark.parametrize("robot", [KR6, robots.ur5(), robots.kawasaki_s030()], ids=lambda robot: robot.name)
def test_the_lines_of_a_row_lead_from_frame_to_frame(robot, name):
    scene = Scene()
    arm, table = scene.robot(robot), robot.standard_dh if name == "standard" else robot.modified_dh
    poses = np.array([table.base, *table.frames(np.zeros(robot.n))])
    pointing.rows(scene, arm, name, table, poses)
    for k in range(1, robot.n + 1):
        link = arm.link(k if name == "standard" else k - 1)
        first, second = ("d", "a") if name == "standard" else ("a", "d")
        at, way = arrow(scene, f"{link}/{name}{k}_{first}")
        then, on = arrow(scene, f"{link}/{name}{k}_{second}")
        np.testing.assert_allclose(way + on, poses[k, :3, 3] - poses[k - 1, :3, 3], atol=1e-12)
        for start, expected in ((at, poses[k - 1, :3, 3]), (then, poses[k - 1, :3, 3] + way)):
            assert start is None or np.allclose(start, expected, atol=1e-12)


def test_what_waits_has_labels_for_the_page_and_none_in_the_picture():
    scene = Scene()
    drawn = pointing.mean(scene.point("/ck/p", [0, 0, 1], "here"), "p", "place", "")
    assert pointing.words(scene) == {"p": ["/ck/p"], "place": ["/ck/p"]}
    assert "here" not in [label["text"] for label in scene.labels]
    assert [label["text"] for label in pointing.labels(scene)] == ["here"]
    drawn.remove()
    assert pointing.words(scene) == {} and pointing.labels(scene) == []


def test_a_screw_seen_from_the_flange_has_its_lever_there():
    panel = view.explore_screws()
    panel.set(joint="joint 3", frame="flange frame: B")
    M, S = KR6.M, KR6.S[:, 4]
    start, v = arrow(panel.scene, "/ck/screws/5/v")
    np.testing.assert_allclose(start, M[:3, 3], atol=1e-12)
    np.testing.assert_allclose(2 * v, S[3:] + np.cross(S[:3], M[:3, 3]), atol=1e-12)  # half of it is drawn
    assert f"column 5 of B = {view.text.row(KR6.B[:, 4])}" == panel.formula[0].says["S5"]
    panel.close()


def test_columns_of_the_jacobian_follow_a_motion():
    panda = robots.franka_panda()
    panel = view.explore_jacobians(panda)
    theta = panda.home + 0.1
    panel.set(theta=theta)
    T = panel.scene.moved["/ck/columns/2"]
    np.testing.assert_allclose(T[:3, 2], panda.jacobian_geometric(theta)[3:, 1], atol=1e-12)
    panel.close()


def test_small_figures_reach_the_target_and_differ():
    T = KR6.fk([0.6, -1.0, 1.2, 0.7, 0.8, 0.3])
    found = ik.analytic(KR6, T)
    figures = silhouettes(KR6, found.theta, T[:3, 3])
    read = [[np.array([p.split(",") for p in line.split()], float) for line in lines] for lines in figures]
    for _ground, mark, arm, *_fins in read:
        np.testing.assert_allclose(arm[-1], mark[:-1].mean(axis=0), atol=0.2)
        assert np.all((arm >= 0) & (arm <= [100, 76]))
    for i in range(8):
        for j in range(i):
            apart = max(np.abs(read[i][k] - read[j][k]).max() for k in (2, 3, 4))
            assert apart > 5, f"figures {i} and {j} look alike"


def test_of_a_solution_that_does_not_exist_there_is_no_arm():
    panel = view.explore_inverse()
    panel.set(pose=[1.1, 0, 0, 0, 0, 0])
    figures = panel._controls["solution"].figures
    assert [figure["note"] for figure in figures] == ["none"] * 8
    assert [len(figure["lines"]) for figure in figures] == [2] * 8
    panel.close()


@pytest.mark.parametrize("name", robots.all())
def test_the_tool_at_zero_is_in_the_picture_of_its_explorer(name):
    """M points there, and sliders at zero bring the tool there."""
    robot = robots.all()[name]
    panel = view.explore(robot)
    home, size = panel.scene.views["home"], panel.scene.size
    panel.close()
    ahead = np.subtract(home["target"], home["position"])
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    for end in [robot.M[:3, 3], *(robot.M[:3, 3] + 0.1 * size * robot.M[:3, :3].T)]:
        away = end - home["position"]
        half = np.tan(np.radians(camera.FOV / 2)) * (away @ ahead)
        assert abs(away @ np.cross(right, ahead)) < half and abs(away @ right) < 1.25 * half
