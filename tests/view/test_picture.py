"""The picture without a browser shows what the scene says: what, where and in which color, always alike."""

import io
import tracemalloc

import numpy as np
import pytest
from PIL import Image

from coursekit import robots
from coursekit.view import picture
from coursekit.view.camera import FOV
from coursekit.view.paint import PALETTE, channels
from coursekit.view.picture import png
from coursekit.view.scene import Scene

CATALOGUE = robots.all()
LIGHT = [0.2126, 0.7152, 0.0722]  # of red, green, blue


def linear(part):
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def on_paper(drawn, paper="white"):
    """PNG bytes as the page shows them that has this ground."""
    image = Image.open(io.BytesIO(drawn)).convert("RGBA")
    page = Image.new("RGBA", image.size, paper)
    page.alpha_composite(image)
    return np.asarray(page.convert("RGB"), int)


def pixels(scene, width=480, height=320, paper="white", **more):
    return on_paper(png(scene, width, height, **more), paper)


def orange(picture):
    r, g, b = np.moveaxis(picture, -1, 0)
    return (r > 150) & (r - b > 80) & (g < r)


def project(scene, p, width, height):
    """Where a point must appear: a pinhole camera written out once more."""
    eye, target = (np.array(scene.camera[key]) for key in ("position", "target"))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    d = np.asarray(p) - eye
    scale = height / 2 / np.tan(np.radians(FOV) / 2) / (d @ forward)
    return width / 2 + scale * (d @ right), height / 2 - scale * (d @ np.cross(right, forward))


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_robot_is_in_its_picture(name):
    scene = Scene()
    scene.robot(CATALOGUE[name])
    drawn = png(scene, 640, 430)
    assert drawn.startswith(b"\x89PNG")
    assert 5_000 < len(drawn) < 40_000
    assert Image.open(io.BytesIO(drawn)).size == (640, 430)
    body = orange(on_paper(drawn))
    assert 0.004 < body.mean() < 0.3  # the Stanford arm is a thin one
    border = np.concatenate([body[0], body[-1], body[:, 0], body[:, -1]])
    assert not border.any()


def test_the_same_scene_gives_the_same_bytes():
    pictures = []
    for _ in range(2):
        scene = Scene()
        scene.robot(robots.planar_2r())
        scene.frame("/ck/world", letter="0")
        pictures.append(png(scene, 320, 200))
    assert pictures[0] == pictures[1]
    scene.robots["robot"].theta = [0.1, 0.2]
    assert png(scene, 320, 200) != pictures[0]


def test_it_stands_on_a_dark_page_as_on_a_white_one():
    scene = Scene()
    scene.robot(robots.kuka_kr6())
    white, dark = (pixels(scene, paper=paper) for paper in ("white", "#111111"))
    np.testing.assert_array_equal(dark[0, 0], 0x11)  # the ground is the page's own
    assert (orange(dark) & orange(white)).sum() > 0.98 * orange(white).sum()
    foot = tuple(reversed(np.array(project(scene, [0, -0.1, 0.05], 480, 320)).astype(int)))
    np.testing.assert_allclose(dark[foot], white[foot], atol=4)
    assert white[foot].max() < 90
    floor = np.abs(white - 255).max(axis=-1) > 2
    assert np.median(white[floor & (dark < 60).all(axis=-1)].min(axis=-1)) > 180  # grid and shadow are faint


LETTERED = [PALETTE[name] for name in ("bone", "z", "axis", "trace", "accent")]  # in figures, too


@pytest.mark.parametrize("ink", [*picture.INK.values(), *LETTERED], ids=hex)
def test_letters_can_be_read(ink):
    assert np.dot(LIGHT, linear(channels(ink))) + 0.05 <= 1.05 / 4.5


@pytest.mark.parametrize("p", [[0.2, -0.1, 0.5], [-0.3, 0.2, 0.1], [0, 0, 0.8]])
def test_a_point_appears_where_the_camera_sees_it(p):
    scene = Scene()
    scene.point("/ck/p", p, color=0xFF0000, radius=0.03)
    picture = pixels(scene)
    r, g, b = np.moveaxis(picture, -1, 0)
    y, x = np.nonzero((r > 180) & (g < 100) & (b < 100))
    np.testing.assert_allclose([x.mean() + 0.5, y.mean() + 0.5], project(scene, p, 480, 320), atol=1)


@pytest.mark.parametrize("nearer", ["red", "blue"])
def test_what_is_nearer_hides_what_is_behind(nearer):
    scene = Scene()
    eye, middle = np.array(scene.camera["position"]), np.array(scene.camera["target"])
    toward = 0.3 * (eye - middle) / np.linalg.norm(eye - middle)
    front, back = (0xFF0000, 0x0000FF) if nearer == "red" else (0x0000FF, 0xFF0000)
    scene.point("/ck/back", middle - toward, color=back, radius=0.05)
    scene.point("/ck/front", middle + toward, color=front, radius=0.05)
    r, _, b = pixels(scene)[160, 240]
    assert (r > b) == (nearer == "red")


def test_hidden_things_are_not_drawn_and_ghosts_are_pale():
    scene = Scene()
    scene.robot(robots.kuka_kr6())
    assert orange(pixels(scene)).any()
    scene.robots["robot"].look(solid=False)
    assert not orange(pixels(scene)).any()
    empty = pixels(scene)
    scene.robot(robots.kuka_kr6(), [0.5, -1, 1, 0, 0, 0], name="goal", style="ghost")
    ghost = pixels(scene)
    changed = np.abs(ghost - empty).max(axis=-1) > 12
    assert changed.mean() > 0.01
    r, _, b = np.moveaxis(ghost[changed], -1, 0)
    assert np.median(b - r) > 15  # bluish
    assert np.median(b) > 180  # and pale


def test_a_surface_can_be_seen_through():
    scene = Scene()
    middle = np.array(scene.camera["target"])
    scene.point("/ck/p", middle, color=0xFF0000, radius=0.04)
    clear = pixels(scene)[160, 240]
    scene.sphere("/ck/s", middle, 0.3)
    veiled, beside = pixels(scene)[160, 240], pixels(scene)[160, 290]
    assert veiled[0] > veiled[2] + 60  # still red
    assert (veiled != clear).any()
    assert (beside < 245).any()  # the sphere itself shows


def test_labels_are_written():
    bare, lettered = Scene(), Scene()
    for scene, label in ((bare, ""), (lettered, "here")):
        scene.point("/ck/p", [0, 0, 0.5], label)
    difference = np.abs(pixels(bare) - pixels(lettered)).max(axis=-1) > 60
    y, x = np.nonzero(difference)
    at = project(lettered, [0, 0, 0.524], 480, 320)
    assert difference.sum() > 30
    assert abs(x.mean() - at[0]) < 4
    assert abs(y.mean() - at[1]) < 6


def test_a_robot_throws_a_shadow_on_the_floor():
    scene = Scene()
    scene.robot(robots.kuka_kr6())
    with_robot = pixels(scene)
    scene.remove("/ck/robot")
    empty = pixels(scene)
    darker = (empty - with_robot).min(axis=-1)
    assert ((darker > 8) & (darker < 70) & ~orange(with_robot)).sum() > 200


def test_the_view_can_be_chosen():
    scene = Scene()
    scene.robot(robots.kuka_kr6())
    views = {name: png(scene, 240, 160, name) for name in scene.views}
    assert len(set(views.values())) == 4


def test_it_needs_little_memory():
    """A kernel in a browser never gives back what it once took."""
    scene = Scene()
    scene.robot(CATALOGUE["kuka_kr6"])
    png(scene, 640, 470)  # what is made once
    tracemalloc.start()
    try:
        png(scene, 640, 470)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 50e6  # the whole canvas alone would be 29e6
