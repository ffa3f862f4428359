"""Held in the picture: the target, the tool and the links follow the mouse, a finger and the keys."""

import numpy as np
import pytest

from coursekit import ik, robots, rotations, view
from tests.browser.explorer import centre, finger, handle
from tests.browser.test_kinematics import BUSY
from tests.browser.test_reopened import SHUT_DOWN

pytestmark = pytest.mark.browser

# Where a point of the space frame is on the page, in pixels.
ON_PAGE = """(p) => {
    const { viewer, page } = document.querySelector(".ck-viewer").coursekit;
    const point = new page.MeshCat.THREE.Vector3(...p);
    viewer.scene_tree.find(["ck"]).object.localToWorld(point).project(viewer.camera);
    const area = document.querySelector(".ck-pane").getBoundingClientRect();
    return [area.left + ((point.x + 1) / 2) * area.width, area.top + ((1 - point.y) / 2) * area.height];
}"""


def drag(explorer, start, way, steps=10):
    """Drag with the mouse from a place of the page by `way` pixels, and let go."""
    mouse = explorer.page.mouse
    mouse.move(*start)
    mouse.down()
    for k in range(1, steps + 1):
        mouse.move(*(np.array(start) + np.array(way) * k / steps))
        explorer.page.wait_for_timeout(40)
    mouse.up()
    explorer.settle()


def target(explorer):
    pose, T = explorer.values("pose"), np.eye(4)
    T[:3, :3], T[:3, 3] = rotations.from_zyx(pose[3:]), pose[:3]
    return T


def assert_all_solutions_are_at(explorer, T):
    """The target's frame, the solid arm and every ghost of the page stand where the kinematics puts them."""
    kr6 = explorer.robot
    right = ik.analytic(kr6, T)
    found = explorer.notebook.wait_transform("/ck/target", T)
    np.testing.assert_allclose(found, T, rtol=0, atol=1e-9)
    explorer.assert_arm_stands_at(np.array(explorer.kernel("scene.robots['robot'].theta.tolist()")))
    ghosts = explorer.kernel("scene.robots.keys().__len__()") - 1
    assert ghosts == right.exists.sum() - 1 == 7
    for k in np.flatnonzero(right.exists):
        if explorer.kernel(f"scene.robots.__contains__('branch{k}')"):
            last = explorer.notebook.transform(f"/ck/branch{k}/6")
            np.testing.assert_allclose(np.array(last) @ kr6.M, T, rtol=0, atol=1e-9)


def test_arrows_and_rings_move_the_target_and_all_solutions(opened):
    explorer = opened("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    before, label = target(explorer), "move {d} along its x"
    assert handle(explorer, label).is_visible(), "the first paint shows a handle with a label"
    start = centre(explorer, label)
    tip = before[:3, 3] + 0.1 * before[:3, 0]
    along = np.array(explorer.page.evaluate(ON_PAGE, tip.tolist()))
    along = along - explorer.page.evaluate(ON_PAGE, before[:3, 3].tolist())
    way = -40 * along / np.linalg.norm(along)
    drag(explorer, start, way)
    T = target(explorer)
    moved = before[:3, :3].T @ (T[:3, 3] - before[:3, 3])
    assert moved[0] < -0.03, "it went along its own x"
    np.testing.assert_allclose(moved[1:], 0, atol=1e-6)
    np.testing.assert_allclose(T[:3, :3], before[:3, :3], atol=1e-6)
    np.testing.assert_allclose(centre(explorer, label), start + way, atol=5)
    assert_all_solutions_are_at(explorer, T)

    drag(explorer, centre(explorer, "turn {d} about its z"), (18, 10))
    turned = target(explorer)
    w = T[:3, :3].T @ np.array(rotations_between(T, turned))
    assert abs(w[2]) > 0.05 and np.abs(w[:2]).max() < 1e-6, "it turned about its own z"
    np.testing.assert_allclose(turned[:3, 3], T[:3, 3], atol=1e-6)
    assert_all_solutions_are_at(explorer, turned)


def test_all_solutions_follow_the_target_while_the_kernel_is_busy(opened):
    explorer = opened("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    before = target(explorer)
    explorer.page.evaluate(BUSY)

    def assert_all_have_followed():
        T = np.array(explorer.notebook.transform("/ck/target"))
        right = ik.analytic(explorer.robot, T)
        assert right.exists.all()
        for k, theta in enumerate(right.theta):
            name = f"branch{k}" if k else "robot"
            found = [explorer.notebook.transform(f"/ck/{name}/{link}") for link in (3, 6)]
            np.testing.assert_allclose(found, explorer.robot.displacements(theta)[[2, 5]], atol=1e-4)
        return T[:3, 3]

    explorer.page.get_by_role("slider", name="x", exact=True).press("ArrowLeft")
    before[0, 3] -= 0.01
    np.testing.assert_allclose(explorer.notebook.wait_transform("/ck/target", before), before, atol=1e-9)
    slid = assert_all_have_followed()
    start = centre(explorer, "move {d} along its x")
    explorer.page.mouse.move(*start)
    explorer.page.mouse.down()
    for k in range(1, 7):
        explorer.page.mouse.move(*(start + [0, 6 * k]))
        explorer.page.wait_for_timeout(60)
    explorer.page.wait_for_timeout(500)  # on a busy machine the last frame may be still to come
    assert np.linalg.norm(assert_all_have_followed() - slid) > 0.02
    explorer.page.mouse.up()
    explorer.settle()
    assert_all_solutions_are_at(explorer, target(explorer))


def rotations_between(A, B):
    """The rotation vector that turns A to B, in the space frame."""
    R = B[:3, :3] @ A[:3, :3].T
    return 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def test_the_arrows_of_the_target_are_in_the_picture_at_first(opened):
    explorer = opened("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    for height in (430, 330):
        explorer.kernel(f"viewer.set_trait('height', {height})")
        explorer.settle()
        pane = explorer.page.locator(".ck-pane").bounding_box()
        for name in "xyz":
            at, arrow = centre(explorer, f"move {{d}} along its {name}"), f"arrow {name} at {height}"
            assert handle(explorer, f"move {{d}} along its {name}").is_visible(), arrow
            inside = at - [pane["x"], pane["y"]]
            assert (inside >= 12).all() and (inside <= [pane["width"] - 12, pane["height"] - 12]).all(), arrow


# How many triangles a frame draws at a part of the pixels, and the layers of the meshes of a ghost's link.
DRAWN = """(coarseness) => {
    const { stage, viewer, page } = document.querySelector(".ck-viewer").coursekit;
    stage.renderer.coarseness = coarseness;
    stage.renderer.render(viewer.scene, viewer.camera);
    const { triangles } = page.renderer.info.render, layers = [];
    const names = Object.keys(viewer.scene_tree.find(["ck"]).children);
    const ghost = names.find((name) => name.startsWith("branch"));
    viewer.scene_tree.find(["ck", ghost, "2"]).object.traverse((part) => {
      if (part.isMesh && part.layers.test(viewer.camera.layers)) layers.push(part.layers.mask);
    });
    return [triangles, layers];
}"""


# How many pixels are painted while a full frame follows quick ones, each time before it is there.
PAINTED = """async () => {
    const { stage } = document.querySelector(".ck-viewer").coursekit;
    const { drawn, domElement } = stage.renderer, seen = [];
    stage.renderer.drawn = () => {
      const { data } = domElement.getContext("2d").getImageData(0, 0, domElement.width, domElement.height);
      seen.push(data.filter((value, i) => i % 4 === 3 && value > 0).length);
      return drawn();
    };
    for (let k = 0; k < 3; k += 1) {
      stage.moved();
      await new Promise(requestAnimationFrame);
    }
    await new Promise((done) => setTimeout(done, 1500));
    stage.renderer.drawn = drawn;
    return seen;
}"""


def test_ghosts_have_fewer_parts_and_triangles_in_quick_frames(opened):
    explorer = opened("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    assert all(explorer.page.evaluate(PAINTED)), "the picture does not vanish when it is drawn sharply again"
    quick, quick_layers = explorer.page.evaluate(DRAWN, 0.35)
    full, full_layers = explorer.page.evaluate(DRAWN, 1)
    assert quick < full / 2
    assert len(quick_layers) == 1 < len(full_layers) and len(set(full_layers)) == 1
    assert quick_layers[0] not in full_layers


def test_a_handle_takes_keys(opened):
    explorer = opened("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    before = target(explorer)
    handle(explorer, "move {d} along its y").focus()
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft", "Shift+ArrowRight"):
        explorer.page.keyboard.press(key)
    explorer.settle()
    moved = before[:3, :3].T @ (target(explorer)[:3, 3] - before[:3, 3])
    np.testing.assert_allclose(moved, [0, 0.011, 0], atol=1e-8)
    assert explorer.page.evaluate("document.activeElement.className") == "ck-handle y"
    handle(explorer, "turn {d} about its y").press("ArrowLeft")
    explorer.settle()
    turned = before[:3, :3].T @ target(explorer)[:3, :3]
    np.testing.assert_allclose(turned, rotations.roty(np.radians(-1)), atol=1e-8)
    assert explorer.notebook.page.locator(".jp-Cell").count() == 2, "no key went to the notebook"


def test_links_turn_their_joints_and_the_tool_can_be_pulled(opened):
    kr6 = robots.kuka_kr6()
    explorer = opened("conventions", kr6, "view.explore(robots.kuka_kr6())")
    theta = explorer.values()
    on_forearm = kr6.link_frames(theta)[3, :3, 3] * 0.5 + kr6.link_frames(theta)[2, :3, 3] * 0.5
    handle(explorer, "move the tool").wait_for()  # the page knows the sliders then
    drag(explorer, explorer.page.evaluate(ON_PAGE, on_forearm.tolist()), (0, 40))
    turned = explorer.values()
    changed = np.flatnonzero(np.abs(turned - theta) > 1e-9)
    assert len(changed) == 1 and changed[0] in (2, 3), "one joint, and that of the link"
    assert abs(turned - theta).max() > 0.05
    explorer.assert_arm_stands_at(turned)

    explorer.page.get_by_role("button", name="reset", exact=True).click()
    explorer.settle()
    theta, start = explorer.values(), centre(explorer, "move the tool")
    drag(explorer, start, (-30, 25))
    np.testing.assert_allclose(centre(explorer, "move the tool"), start + [-30, 25], atol=4)
    assert kr6.within_limits(explorer.values())
    explorer.assert_arm_stands_at(explorer.values())

    before = kr6.fk(explorer.values())[:3, 3]
    handle(explorer, "move the tool").press("PageDown")
    explorer.settle()
    np.testing.assert_allclose(kr6.fk(explorer.values())[:3, 3] - before, [0, 0, -0.01], atol=1e-4)


SLOW = "__setattr__('_update', (lambda act: lambda v: (__import__('time').sleep(0.3), act(v)))(p._update))"


def test_a_slow_kernel_does_not_pull_back_what_a_hand_holds(opened):
    """What it says of an earlier moment comes while the hand has gone on, and after that nothing more."""
    explorer = opened("conventions", robots.kuka_kr6(), "view.explore(robots.kuka_kr6())")
    handle(explorer, "move the tool").wait_for()
    explorer.kernel(SLOW)
    for way in ((-30, 25), (25, -20)):
        start = centre(explorer, "move the tool")
        drag(explorer, start, way, steps=15)
        np.testing.assert_allclose(centre(explorer, "move the tool"), start + way, atol=4)
        explorer.assert_arm_stands_at(explorer.values())

    explorer.page.evaluate(
        SHUT_DOWN
    )  # a hand that nobody will ever answer does not hold the sliders for good
    start, mouse = centre(explorer, "move the tool"), explorer.page.mouse
    mouse.move(*start)
    mouse.down()
    mouse.move(*(start + [20, 20]))
    explorer.page.wait_for_timeout(300)
    mouse.up()
    slider = explorer.page.locator("[role=slider]").first
    before = float(slider.get_attribute("aria-valuenow"))
    slider.press("PageUp")
    explorer.page.wait_for_timeout(1000)
    assert float(slider.get_attribute("aria-valuenow")) == pytest.approx(before + 10, abs=0.01)
    assert all("Cannot send" in error for error in explorer.notebook.errors)
    explorer.notebook.errors.clear()


def test_a_drag_beside_the_arm_turns_the_picture(opened):
    explorer = opened("conventions", robots.kuka_kr6(), "view.explore(robots.kuka_kr6())")
    box = explorer.page.locator(".ck-pane").bounding_box()
    where = "() => document.querySelector('.ck-viewer').coursekit.viewer.camera.position.toArray()"
    theta, before = explorer.values(), np.array(explorer.page.evaluate(where))
    drag(explorer, (box["x"] + 20, box["y"] + box["height"] - 30), (60, 0))
    assert np.abs(np.array(explorer.page.evaluate(where)) - before).max() > 0.05
    np.testing.assert_array_equal(explorer.values(), theta)


@pytest.fixture
def touched(browser, tmp_path):
    """A page by itself under fingers, with more below it than the window holds."""
    panel = view.explore(robots.kuka_kr6())
    (tmp_path / "page.html").write_text(
        view.to_html(panel).replace("</main>", f"{'<br>' * 99}</main>"), "utf-8"
    )
    panel.close()
    context = browser.new_context(has_touch=True, viewport={"width": 412, "height": 800})
    page = context.new_page()
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function("() => document.querySelector('.ck-viewer')?.coursekit?.stage.frames > 0")
    page.locator(".ck-pane").scroll_into_view_if_needed()
    yield page
    context.close()


EYE = """() => {
    const { camera, controls } = document.querySelector(".ck-viewer").coursekit.viewer;
    return [...camera.position.toArray(), ...controls.target.toArray()];
}"""


def swipe(page, fingers, way, steps=12):
    """Fingers that start at these points of the picture (from its lower left corner) and go the same way."""
    box, session = page.locator(".ck-pane").bounding_box(), page.context.new_cdp_session(page)
    eye, scrolled = np.array(page.evaluate(EYE)), page.evaluate("scrollY")
    corner = np.array([box["x"], box["y"] + box["height"]])
    ways = way if isinstance(way, list) else [way] * len(fingers)
    for k in range(steps + 1):
        points = [
            corner + np.array(start) * [1, -1] + np.array(one) * k / steps
            for start, one in zip(fingers, ways, strict=True)
        ]
        told = [{"x": float(x), "y": float(y), "id": i} for i, (x, y) in enumerate(points)]
        session.send(
            "Input.dispatchTouchEvent", {"type": "touchMove" if k else "touchStart", "touchPoints": told}
        )
        page.wait_for_timeout(30)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_timeout(500)
    return np.array(page.evaluate(EYE)) - eye, page.evaluate("scrollY") - scrolled


def test_a_finger_scrolls_the_page_and_turns_the_picture(touched):
    moved, scrolled = swipe(touched, [(30, 60)], (0, -150))
    assert scrolled > 80 and np.abs(moved).max() < 0.05
    swipe(touched, [(30, 30)], (0, 150))
    moved, scrolled = swipe(touched, [(30, 60)], (150, 5))
    assert scrolled == 0 and np.abs(moved[:3]).max() > 0.3


def test_a_finger_on_a_link_turns_its_joint(touched):
    box, shown = (
        touched.locator(".ck-pane").bounding_box(),
        "() => document.getElementById('words').textContent",
    )
    x, y = touched.evaluate(ON_PAGE, [0.025, 0, 0.63])  # in the upper arm
    before = touched.evaluate(shown)
    moved, scrolled = swipe(touched, [(x - box["x"], box["y"] + box["height"] - y)], (0, -100))
    assert scrolled == 0 and np.abs(moved).max() < 1e-9
    assert touched.evaluate(shown) != before


def test_two_fingers_move_the_picture_and_zoom(touched):
    moved, scrolled = swipe(touched, [(40, 60), (90, 60)], (0, -80))
    assert scrolled == 0 and np.abs(moved[3:]).max() > 0.05

    def distance():
        eye = np.array(touched.evaluate(EYE))
        return np.linalg.norm(eye[:3] - eye[3:])

    before = distance()
    swipe(touched, [(60, 60), (90, 60)], [(-40, 0), (150, 0)])
    assert distance() < 0.8 * before


def test_a_finger_moves_the_target_and_a_guess(opened_by_touch):
    explorer = opened_by_touch("inverse", robots.kuka_kr6(), "view.explore_inverse()")
    before, start = target(explorer), centre(explorer, "move {d} along its x")  # which points downwards
    finger(explorer, start, (0, 45))
    moved = before[:3, :3].T @ (target(explorer)[:3, 3] - before[:3, 3])
    assert moved[0] > 0.02 and np.abs(moved[1:]).max() < 1e-6
    assert_all_solutions_are_at(explorer, target(explorer))

    explorer.page.get_by_role("checkbox", name="predict first").check()
    explorer.settle()
    guess, start = explorer.values("prediction"), centre(explorer, "move your guess")
    finger(explorer, start, (30, -45))
    assert np.linalg.norm(explorer.values("prediction") - guess) > 0.02
    np.testing.assert_allclose(centre(explorer, "move your guess"), start + [30, -45], atol=4)
    assert explorer.notebook.errors == []
