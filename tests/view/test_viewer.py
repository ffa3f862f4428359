"""The viewer without a browser: what it puts into its state and into its messages."""

import gzip
import subprocess
import sys
import types

import numpy as np
import pytest
import umsgpack

from coursekit import robots, view
from coursekit.view import meshcat
from coursekit.view.meshcat import bundle, column_major
from coursekit.view.page import to_html
from coursekit.view.scene import Scene
from coursekit.view.viewer import Viewer
from tests.unpacked import unpacked


@pytest.fixture
def scene():
    scene = Scene()
    scene.robot(robots.kuka_kr6())
    return scene


@pytest.fixture
def viewer(scene):
    made = Viewer(scene)
    made.sent = []
    made.send = lambda content, buffers=None: made.sent.append((content, buffers))
    yield made
    made.layout.close()
    made.close()


def keys_sent(viewer):
    return [key for content, _ in viewer.sent for key in content["keys"]]


def test_the_state_holds_every_command_of_the_scene(viewer, scene):
    state = viewer.get_state()
    assert list(state["commands"]) == list(meshcat.commands(scene))
    for key, command in meshcat.commands(scene).items():
        assert umsgpack.unpackb(state["commands"][key])["path"] == command["path"]


def test_the_bundle_is_never_part_of_the_state(viewer):
    state = viewer.get_state()
    assert len(bundle()) > 100_000
    assert all(bundle()[:64] not in data for data in state["commands"].values())
    assert sum(len(data) for data in state["commands"].values()) < 600_000


def test_a_pose_is_sixteen_float64_per_path_column_by_column(viewer, scene):
    poses = np.frombuffer(viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
    np.testing.assert_array_equal(poses, scene.pose())
    assert viewer.moving == scene.moving


def test_moving_the_robot_sends_a_pose_and_no_command(viewer, scene):
    theta = np.array([0.1, -0.2, 0.3, -0.4, 0.5, -0.6])
    scene.robots["robot"].theta = theta
    viewer.sync()
    assert viewer.sent == []
    poses = np.frombuffer(viewer.pose).reshape(-1, 4, 4).transpose(0, 2, 1)
    np.testing.assert_array_equal(poses, robots.kuka_kr6().displacements(theta))


def test_sync_sends_only_what_changed(viewer, scene):
    scene.point("/ck/here", [0.1, 0.2, 0.3])
    viewer.sync()
    assert keys_sent(viewer) == ["/ck/here"]
    viewer.sent.clear()
    viewer.sync()
    assert viewer.sent == []
    scene["/ck/here"].show(False)
    viewer.sync()
    assert [umsgpack.unpackb(data)["value"] for _, buffers in viewer.sent for data in buffers] == [False]


def test_removing_a_drawing_deletes_its_path_and_sends_again_what_stays_below(viewer, scene):
    scene.point("/ck/a", [0, 0, 0])
    scene.point("/ck/a/b", [0, 0, 0])
    scene.point("/ck/ab", [0, 0, 0])
    viewer.sync()
    viewer.sent.clear()
    del scene.parts["/ck/a"]
    viewer.sync()
    ((content, _),) = viewer.sent
    assert content["gone"] == ["/ck/a"] and content["delete"] == ["/ck/a"]
    assert content["keys"] == ["/ck/a/b"]
    assert "/ck/a" not in viewer.get_state()["commands"]


def test_a_motion_ends_exactly_and_a_new_pose_ends_the_motion(viewer, scene):
    thetas = np.linspace(np.zeros(6), np.full(6, 0.5), 101)
    poses = robots.kuka_kr6().displacements(thetas)
    viewer.play(poses, fps=30, texts=[f"pose {k}" for k in range(101)])
    assert viewer.motion["frames"] == 101 and viewer.frame == 0
    sent = np.frombuffer(viewer.motion_poses).reshape(101, 6, 4, 4).transpose(0, 1, 3, 2)
    np.testing.assert_array_equal(sent, poses)
    first = viewer.motion
    viewer.play(poses)
    assert viewer.motion != first, "the same motion again must play again"
    scene.point("/ck/here", [0, 0, 0])
    viewer.sync()
    assert viewer.frame == 0, "something drawn beside it does not stop the motion"
    scene.robots["robot"].theta = thetas[7]
    viewer.sync(frame=7)
    assert viewer.motion, "the scene shows what the motion does"
    scene.robots["robot"].theta = thetas[8]
    viewer.sync()
    assert (viewer.frame, viewer.motion, viewer.motion_poses) == (-1, {}, b"")


def test_another_robot_ends_the_motion(viewer, scene):
    viewer.play(robots.kuka_kr6().displacements(np.linspace(np.zeros(6), np.ones(6), 11)))
    scene.robot(robots.puma560())  # as many links, but others
    viewer.sync()
    assert (viewer.frame, viewer.motion) == (-1, {})


@pytest.mark.parametrize(
    "call, message",
    [
        (
            lambda v: v.set_pose(np.zeros((5, 4, 4))),
            r"transforms must have shape \(6, 4, 4\), got \(5, 4, 4\)",
        ),
        (
            lambda v: v.play(np.zeros((6, 4, 4))),
            r"transforms must have shape \(N, 6, 4, 4\), got \(6, 4, 4\)",
        ),
        (lambda v: v.play(np.zeros((3, 6, 4, 4)), texts=["one"]), "one line for each of the 3 frames, got 1"),
        (lambda v: column_major(np.zeros((2, 3))), r"shape \(..., 4, 4\), got \(2, 3\)"),
    ],
)
def test_wrong_shapes_are_named(viewer, call, message):
    with pytest.raises(ValueError, match=message):
        call(viewer)


def test_someone_who_knows_meshcat_can_draw_too(viewer):
    box = viewer.meshcat["mine"]
    import meshcat.geometry  # after the viewer has imported meshcat, and its warning with it

    box.set_object(meshcat.geometry.Box([0.1, 0.2, 0.3]))
    packed = [data for key, data in viewer.get_state()["commands"].items() if key.startswith("meshcat:")]
    assert [umsgpack.unpackb(data)["path"] for data in packed] == ["/meshcat/mine"]
    box.set_transform(np.diag([1.0, 1, 1, 1]))
    box.set_property("visible", False)
    box.delete()
    box.set_object(meshcat.geometry.Box([0.1, 0.2, 0.3]))  # a late view gets them in this order
    kinds = [key.split(":")[2] for key in viewer.get_state()["commands"] if key.startswith("meshcat:")]
    assert kinds == ["set_transform", "set_property", "delete", "set_object"]
    for refused in (box.url, box.jupyter_cell, box.static_html, box.get_image, box.open):
        with pytest.raises(RuntimeError, match=r"show the panel|view\.to_html|view\.png"):
            refused()


def test_the_line_of_text_is_stable(viewer):
    line = f"Viewer({viewer.scene.text()})"
    assert repr(viewer) == line and "KUKA KR6 R900 sixx" in line and "\n" not in line
    data, metadata = viewer._repr_mimebundle_()
    assert data["text/plain"] == line and metadata["image/png"]["alt"] == line
    assert data["image/png"].startswith(b"\x89PNG")


def test_a_page_of_its_own_needs_no_network(viewer):
    page = to_html(viewer)
    assert "Copyright (c) 2018 Robin Deits" in page and "three 0.132.2 (MIT)" in page  # whose bundle it holds
    begin, end = page.index("/* This script contains"), page.index("\n*/\n")
    assert begin < page.index("three 0.132.2") < end and "*/" not in page[begin:end]
    assert page.count("</script>") == page.count("<script") == 2  # nor a script
    assert len(page) < 700_000
    page = unpacked(page[:begin] + page[end:])
    assert "http://" not in page.replace("http://www.w3.org", "") and "https://" not in page
    assert "src=" not in page and "KUKA KR6 R900 sixx" in page


def test_pages_share_what_is_the_same_in_all(viewer):
    page = to_html(viewer, common="../common.js")
    assert '<script src="../common.js"></script>' in page and len(page) < 250_000


def test_neither_meshcat_nor_its_warnings_are_imported():
    code = "import sys; from coursekit import robots, view; view.explore(robots.planar_2r())"
    code += "; print('meshcat' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_a_pose_in_one_message(viewer, scene):
    moved = robots.kuka_kr6().displacements(np.full(6, 0.2))
    viewer.play(np.array([scene.pose(), moved]))
    viewer.set_pose(moved)
    np.testing.assert_array_equal(np.frombuffer(viewer.pose).reshape(6, 4, 4).transpose(0, 2, 1), moved)
    assert viewer.frame == -1
    with pytest.raises(ValueError, match=r"transforms must have shape \(6, 4, 4\), got \(5, 4, 4\)"):
        viewer.set_pose(moved[:5])


def test_the_page_may_ask_for_the_script_and_for_a_picture(viewer, monkeypatch):
    viewer.sent.clear()
    viewer._answer(viewer, {"type": "need_png", "width": 320, "height": 200}, [])
    ((content, (picture,)),) = viewer.sent
    assert content["type"] == "png"
    monkeypatch.setattr(
        viewer.script, "send", lambda content, buffers: viewer.sent.append((content, buffers))
    )
    viewer.script._handle_custom_msg({"type": "need_bundle"}, [])
    content, (script,) = viewer.sent[-1]
    assert content["type"] == "bundle"
    assert b"MeshCat" in gzip.decompress(script)
    assert picture.startswith(b"\x89PNG")


def test_colab_is_told_where_its_loader_of_widgets_is(monkeypatch):
    colab = types.SimpleNamespace(
        enable_custom_widget_manager=lambda: None,
        _widgets=types.SimpleNamespace(_installed_url="https://colab/loader.js"),
    )
    monkeypatch.setitem(sys.modules, "google.colab.output", colab)
    panel = view.explore(robots.planar_2r())
    try:
        for shown in (panel, panel.viewer):
            _, metadata = shown._repr_mimebundle_()
            told = metadata["application/vnd.jupyter.widget-view+json"]["colab"]
            assert told == {"custom_widget_manager": {"url": "https://colab/loader.js"}}
            assert metadata["image/png"]["alt"]
    finally:
        panel.close()
