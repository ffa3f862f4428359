"""A scene says exactly what the page must draw, and every drawing hangs where the mathematics puts it."""

import numpy as np
import pytest
import umsgpack

from coursekit import Robot, robots
from coursekit.view import meshcat, paint, shapes, stage
from coursekit.view.scene import Scene

CATALOGUE = robots.all()
every_robot = pytest.mark.parametrize("robot", CATALOGUE.values(), ids=CATALOGUE.keys())


def scene_of(robot, **more):
    scene = Scene()
    scene.robot(robot, **more)
    return scene


def size_of(scene):
    return sum(len(umsgpack.packb(command)) for command in meshcat.commands(scene).values())


# --- robots ---


@every_robot
def test_the_tool_hangs_at_the_end_of_the_chain(robot):
    scene = scene_of(robot)
    for seed in range(3):
        theta = np.random.default_rng(seed).uniform(-1, 1, robot.n)
        scene.robots["robot"].theta = theta
        last = scene.worlds([f"/ck/robot/{robot.n}/tool"]).popitem()[1]
        np.testing.assert_allclose(last @ robot.M, robot.fk(theta), atol=1e-12)
        np.testing.assert_array_equal(scene.pose(), robot.displacements(theta))
    assert scene.moving == [f"/ck/robot/{k}" for k in range(1, robot.n + 1)]


def test_a_robot_stands_at_home_unless_told_otherwise():
    robot = robots.kuka_kr6()
    np.testing.assert_array_equal(scene_of(robot).robots["robot"].theta, robot.home)
    np.testing.assert_array_equal(scene_of(robot, theta=np.ones(6)).robots["robot"].theta, np.ones(6))


@every_robot
def test_what_is_sent_is_plain_and_small(robot):
    scene = scene_of(robot)
    scene.robots["robot"].show_axes()
    for key, command in meshcat.commands(scene).items():
        assert umsgpack.unpackb(umsgpack.packb(command)) == command, key  # refuses numpy scalars
        assert key.split("#")[0] == command["path"]
    assert size_of(scene) < 400_000


def test_only_what_changed_is_a_new_command():
    scene = scene_of(robots.ur5())
    scene.frame("/ck/target", np.eye(4), "t")
    before = dict(meshcat.commands(scene))
    T = np.eye(4)
    T[0, 3] = 0.5
    scene.frame("/ck/target", T, "t")
    scene.robots["robot"].theta = np.ones(6)
    scene.arrow("/ck/arrow", [0, 0, 0], [1, 0, 0])
    changed = {key for key, command in meshcat.commands(scene).items() if before.get(key) != command}
    assert changed == {"/ck/target#transform", "/ck/arrow"}


def test_solids_cast_shadows_and_signs_do_not():
    scene = scene_of(robots.kuka_kr6())
    scene.frame("/ck/world", letter="0")
    solid = meshcat.commands(scene)["/ck/robot/2/solid"]["object"]["object"]
    assert solid["type"] == "Group"
    assert all(child["castShadow"] and child["receiveShadow"] for child in solid["children"])
    sign = meshcat.commands(scene)["/ck/world"]["object"]["object"]["children"]
    assert not any(child["castShadow"] for child in sign)
    assert {child["renderOrder"] for child in sign} == {0, 30}  # the arrows, and how they shine through


@pytest.mark.parametrize("style", ["solid", "skeleton", "ghost"])
def test_the_skeleton_is_one_toggle_away(style):
    scene = scene_of(robots.kuka_kr6(), style=style)
    shown = {kind: scene.visible(f"/ck/robot/3/{kind}") for kind in ("solid", "skeleton")}
    assert shown == {"solid": style == "solid", "skeleton": style == "skeleton"}
    assert scene.parts["/ck/robot/3/skeleton"]
    scene.robots["robot"].look(solid=False, skeleton=True)
    assert scene.visible("/ck/robot/3/skeleton")
    assert not scene.visible("/ck/robot/3/solid")


def test_ghosts_share_shapes_and_go_with_their_robot():
    robot = robots.abb_irb1200()
    scene = scene_of(robot)
    alone = size_of(scene)
    for k in range(8):
        scene.robot(robot, np.full(6, 0.1 * k), name=f"ghost{k}", style="ghost")
    assert size_of(scene) == alone
    assert len(scene.moving) == 9 * 6
    assert [ghost["path"] for ghost in scene.ghosts] == [f"/ck/ghost{k}" for k in range(8)]
    assert {ghost["src"] for ghost in scene.ghosts} == {"/ck/robot"}
    scene.remove("/ck/ghost3")
    assert len(scene.ghosts) == 7
    scene.robot(robots.ur5())
    assert not scene.ghosts
    assert scene.moving == [f"/ck/robot/{k}" for k in range(1, 7)]


def test_a_ghost_without_a_solid_brings_its_own_hidden_shapes():
    scene = scene_of(robots.ur5(), name="goal", style="ghost")
    (ghost,) = scene.ghosts
    assert ghost["src"] == ghost["path"] == "/ck/goal"
    assert not scene.visible("/ck/goal/2/solid")


# --- what is said when something is wrong ---


def test_errors_name_what_was_expected():
    scene = scene_of(robots.kuka_kr6())
    with pytest.raises(ValueError, match=r"KUKA KR6 R900 sixx has 6 joints.*\(5,\)"):
        scene.robots["robot"].theta = np.zeros(5)
    with pytest.raises(ValueError, match="nothing is drawn at '/ck/arm'; there are: /ck/robot/0/solid, "):
        scene["/ck/arm"].show(False)
    with pytest.raises(IndexError, match="KUKA KR6 R900 sixx has links 0 to 6, got 7"):
        scene.robots["robot"].link(7)
    with pytest.raises(ValueError, match="one of solid, ghost, skeleton, not 'glass'"):
        scene.robot(robots.ur5(), style="glass")
    with pytest.raises(ValueError, match='starts with "/ck/"'):
        scene.line("robot/x", [0, 0, 0], [1, 0, 0])
    with pytest.raises(ValueError, match=r"one of body, dark, .* not 'pink'"):
        scene.line("/ck/x", [0, 0, 0], [1, 0, 0], color="pink")
    with pytest.raises(ValueError, match=r"points \(k, 3\)"):
        scene.curve("/ck/c", [[0, 0, 0]])


# --- drawings ---


def placed(scene, path):
    T = scene.worlds([path])[path]
    return np.concatenate([part.mesh().moved(T).vertices for part in scene.parts[path]])


def test_screw_axes_lie_on_the_screws_and_move_with_the_links():
    robot = robots.kuka_kr6()
    scene = scene_of(robot, theta=np.linspace(-0.7, 0.8, 6))
    scene.robots["robot"].show_axes()
    now = robot.jacobian_space(scene.robots["robot"].theta)  # the screws where they are now
    for k, S in enumerate(now.T, 1):
        path = f"/ck/robot/{k}/axis"
        arrow = scene.parts[path][0]
        T = scene.worlds([path])[path] @ arrow.pose
        np.testing.assert_allclose(T[:3, 2], S[:3], atol=1e-12)
        np.testing.assert_allclose(-np.cross(S[:3], T[:3, 3]), S[3:], atol=1e-12)
    assert [label["text"] for label in scene.labels if label["cls"] == "axis"] == [
        f"S{k}" for k in range(1, 7)
    ]
    scene.robots["robot"].show_axes(shown=False)
    assert not [label for label in scene.labels if label["cls"] == "axis"]


@pytest.mark.parametrize("theta", [1.0, -1.0])
def test_the_arc_of_a_screw_turns_the_right_way(theta):
    scene = Scene()
    scene.screw_axis("/ck/s", [0, 0, 1, 0, 0, 0], theta=theta)
    cone = scene.parts["/ck/s"][2]
    tip, way = cone.pose[:3, 3], cone.pose[:3, 2]
    assert np.sign(np.cross(tip, way)[2]) == np.sign(theta)


def test_a_sliding_screw_is_an_arrow_without_an_arc():
    scene = Scene()
    scene.screw_axis("/ck/s", [0, 0, 0, 0, 1, 0], at=[1, 0, 0])
    (arrow,) = scene.parts["/ck/s"]
    np.testing.assert_allclose(arrow.pose[:3, [2, 3]].T, [[0, 1, 0], [1, 0, 0]], atol=1e-12)


def test_an_ellipsoid_has_its_axes_and_may_be_flat():
    scene = Scene()
    axes = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    lengths, at = np.array([0.3, 0.2, 0.0]), np.array([0.1, 0.2, 0.3])
    scene.ellipsoid("/ck/e", axes, lengths, at)
    surface = scene.parts["/ck/e/body"][0].mesh().moved(scene.worlds(["/ck/e/body"])["/ck/e/body"])
    local = (surface.vertices - at) @ axes
    np.testing.assert_allclose(np.abs(local).max(axis=0)[:2], lengths[:2], rtol=0.01)
    assert np.abs(local[:, 2]).max() < 1e-3
    assert np.isfinite(surface.normals).all()
    for k in range(2):
        rod = (placed(scene, f"/ck/e/axis{k + 1}") - at) @ axes
        assert np.abs(rod[:, k]).max() == pytest.approx(lengths[k])
        assert np.abs(np.delete(rod, k, axis=1)).max() < 0.01, "a rod is stretched along itself only"


def test_an_ellipsoid_moves_with_the_pose_and_is_sent_once():
    scene = Scene()
    scene.robot(robots.planar_2r())
    scene.ellipsoid("/ck/e", np.eye(3), np.array([0.3, 0.2, 0.1]), np.zeros(3))
    sent, first = dict(meshcat.commands(scene)), scene.pose()
    scene.ellipsoid("/ck/e", np.eye(3), np.array([0.1, 0.2, 0.3]), np.ones(3))
    assert meshcat.commands(scene) == sent
    assert scene.moving[2:] == ["/ck/e/body", "/ck/e/axis1", "/ck/e/axis2", "/ck/e/axis3"]
    np.testing.assert_array_equal(scene.pose()[:2], first[:2])
    body = [[0.1, 0, 0, 1], [0, 0.2, 0, 1], [0, 0, 0.3, 1], [0, 0, 0, 1]]
    np.testing.assert_allclose(scene.pose()[2], body)
    scene.remove("/ck/e")
    assert scene.moving == ["/ck/robot/1", "/ck/robot/2"]


@pytest.mark.parametrize("vector", [[0, 0, 0], [np.nan, 0, 0]])
def test_an_arrow_of_no_length_draws_nothing(vector):
    scene = Scene()
    scene.arrow("/ck/a", [0, 0, 0], vector, label="lost")
    assert scene.parts["/ck/a"] == []
    assert not [label for label in scene.labels if label["text"] == "lost"]


def test_lines_curves_normals_and_points_are_where_they_belong():
    scene = Scene()
    points = np.column_stack([np.linspace(0, 1, 1001), np.zeros(1001), np.full(1001, 0.5)])
    scene.curve("/ck/c", points, radius=0.01)
    scene.line("/ck/l", [0, 0, 0], [0, 2, 0], radius=0.01)
    scene.normals("/ck/n", points[::250], np.tile([0, 0, 0.1], (5, 1)))
    scene.point("/ck/p", [1, 2, 3], "here", radius=0.1)
    scene.plane("/ck/f", [0, 0, 1], [0, 0, 1], size=2)
    low, high = placed(scene, "/ck/c").min(axis=0), placed(scene, "/ck/c").max(axis=0)
    np.testing.assert_allclose([low, high], [[0, -0.01, 0.49], [1, 0.01, 0.51]], atol=1e-9)
    np.testing.assert_allclose(np.ptp(placed(scene, "/ck/l"), axis=0), [0.02, 2, 0.02], atol=2e-3)
    assert len(scene.parts["/ck/n"]) == 5
    assert placed(scene, "/ck/n")[:, 2].max() == pytest.approx(0.6)
    np.testing.assert_allclose(placed(scene, "/ck/p").mean(axis=0), [1, 2, 3], atol=1e-9)
    np.testing.assert_allclose(placed(scene, "/ck/f")[:, 2], 1, atol=0.01)
    assert len(umsgpack.packb(meshcat.commands(scene)["/ck/c"])) < 120_000  # a very fine curve is thinned out


def test_hidden_drawings_have_no_labels():
    scene = Scene()
    scene.point("/ck/group/p", [0, 0, 0], "p")
    assert "p" in [label["text"] for label in scene.labels]
    scene["/ck/group"].show(False)
    assert "p" not in [label["text"] for label in scene.labels]
    scene["/ck/group"].show(True)
    assert "p" in [label["text"] for label in scene.labels]


def test_removing_takes_everything_below_and_nothing_beside():
    scene = Scene()
    scene.point("/ck/a", [0, 0, 0], "a")
    scene.point("/ck/a/b", [0, 0, 0], "b")
    scene.point("/ck/ab", [0, 0, 0], "ab")
    scene["/ck/a/b"].show(False)
    scene.remove("/ck/a")
    paths = {key.split("#")[0] for key in meshcat.commands(scene)}
    assert not [path for path in paths if path == "/ck/a" or path.startswith("/ck/a/")]
    assert [label["text"] for label in scene.labels if label["cls"] == "note"] == ["ab"]


# --- stage and camera ---


def inside_picture(scene, points, wide=4 / 3):
    """Whether points are seen by the home camera, with the projection written out once more."""
    stand = scene.camera
    eye, target = np.array(stand["position"]), np.array(stand["target"])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    away = (points - eye) @ forward
    half = np.tan(np.radians(16))
    return (np.abs((points - eye) @ up) < half * away) & (np.abs((points - eye) @ right) < wide * half * away)


@every_robot
@pytest.mark.parametrize("scale", [1, 50])
def test_the_camera_sees_the_whole_robot_at_any_size(robot, scale):
    S, M = robot.S.copy(), robot.M.copy()
    S[3:, np.any(S[:3], axis=0)] *= scale  # a slide's v is a direction
    M[:3, 3] *= scale
    robot = Robot.from_screws(S, M, home=robot.home)
    scene = scene_of(robot)
    points = np.concatenate([placed(scene, path) for path in scene.parts if path.endswith("/solid")])
    assert inside_picture(scene, points).all()
    stand = scene.camera
    away = np.linalg.norm(np.subtract(stand["position"], stand["target"]))
    assert np.ptp(points, axis=0).max() > 0.25 * away  # and the robot is not lost in it


def test_views_look_where_their_names_say():
    views = scene_of(robots.kuka_kr6()).views
    way = {name: np.subtract(v["position"], v["target"]) for name, v in views.items()}
    way = {name: v / np.linalg.norm(v) for name, v in way.items()}
    assert way["top"][2] > 0.999
    assert way["side"][1] < -0.99
    assert way["front"][0] > 0.99


def test_the_stage_hides_what_meshcat_brings_and_lights_from_above():
    commands = meshcat.commands(Scene())
    hidden = [c["path"] for c in commands.values() if c["type"] == "set_property"]
    assert {"/Grid", "/Axes", "/Background", "/Lights/SpotLight", "/Lights/AmbientLight"} <= set(hidden)
    for name in ("key", "sky"):
        assert commands[f"/ck/stage/{name}"]["object"]["object"]["matrix"][14] > 0


@pytest.mark.parametrize("size", [0.03, 0.75, 1.4, 2.9, 70, 1234])
def test_grid_lines_are_round_numbers(size):
    fine, strong = stage.spacing(size)
    assert f"{fine:e}"[0] in "125"
    assert strong == pytest.approx(5 * fine)
    assert 6 < size / fine < 30


def test_colors_are_sent_as_linear_light():
    assert meshcat.linear(0x000000) == 0
    assert meshcat.linear(0xFFFFFF) == 0xFFFFFF
    assert meshcat.linear(0xF07A2B) == 0xDE3206  # ((c + 0.055) / 1.055)^2.4 by hand


def test_a_turned_part_is_the_same_in_three_js():
    """three.js turns a profile about y: (r sin phi, h, r cos phi); our matrix must bring it to z."""
    part = paint.Part(
        shapes.bevelled(0.3, -0.1, 0.5, 0.05), "body", shapes.frame_along([1, 2, 3], [0.4, 0.5, 0.6])
    )
    sent = meshcat.group([part])
    (geometry,), (child,) = sent["geometries"], sent["object"]["children"]
    phi = np.linspace(0, 2 * np.pi, geometry["segments"] + 1)
    points = [
        (p["x"] * np.sin(phi), np.full(len(phi), p["y"]), p["x"] * np.cos(phi)) for p in geometry["points"]
    ]
    local = np.array(points).transpose(0, 2, 1).reshape(-1, 3)
    T = np.reshape(child["matrix"], (4, 4)).T
    theirs, ours = local @ T[:3, :3].T + T[:3, 3], part.mesh().vertices
    for one, other in ((theirs, ours), (ours, theirs)):
        distance = np.sqrt(((one[:, None] - other) ** 2).sum(-1).min(axis=1))
        assert distance.max() < 1e-5  # profiles are sent rounded to a micrometre
    assert np.linalg.det(T[:3, :3]) > 0


def test_the_text_is_one_line_and_names_units():
    scene = scene_of(robots.kuka_kr6())
    assert scene.text() == (
        "KUKA KR6 R900 sixx: joints (0.0, -90.0, 90.0, 0.0, 0.0, 0.0) deg; tool at (525.0, 0.0, 890.0) mm"
    )
    assert Scene().text() == "an empty scene"


def test_the_text_says_each_unit_where_joints_turn_and_slide():
    arm = Robot.from_axes([[0, 0, 1]] * 2, [[0, 0, 0], [0.5, 0, 0]], np.eye(4), "RP", name="arm")
    scene = Scene()
    scene.robot(arm, [np.pi / 4, 0.1])
    assert scene.text().startswith("arm: joints (45.0 deg, 100.0 mm); tool at ")
