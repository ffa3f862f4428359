"""The viewer where things are not as usual: a motion, no WebGL, strict policies, a page without a kernel."""

import base64

import numpy as np
import pytest

from coursekit import ik, robots, view
from tests.browser.test_kinematics import link

pytestmark = pytest.mark.browser

IMPORT = "import numpy as np\nfrom coursekit import robots, view"
SHOW = "kr6 = robots.kuka_kr6()\npanel = view.explore(kr6)\npanel"
TOOL = "/ck/robot/6/tool"
NO_WEBGL = """const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return /webgl/.test(kind) ? null : original.call(this, kind, ...rest);
    };"""
DRAWN = "() => document.querySelector('.ck-viewer')?.coursekit?.stage.frames > 0"


def test_a_motion_plays_to_its_last_pose_and_can_be_scrubbed(notebook, lab):
    motion = "q = np.linspace(kr6.home, kr6.home + 0.5, 101)\n"
    motion += "panel.play(q, texts=[f'pose {k}' for k in range(101)])"
    notebook.open(lab.write("motion.ipynb", IMPORT, SHOW, motion))
    notebook.run_all()
    notebook.wait_view()
    kr6, page = robots.kuka_kr6(), notebook.page
    page.wait_for_function(
        "() => document.querySelector('.ck-count').textContent === '101 / 101'", timeout=60_000
    )
    last = kr6.fk(kr6.home + 0.5)
    np.testing.assert_allclose(notebook.wait_transform(TOOL, last), last, rtol=0, atol=1e-12)
    assert page.inner_text(".ck-viewer ~ .ck-text") == "pose 100"
    notebook.idle()
    assert notebook.kernel("panel.viewer.frame") == 100

    page.locator(".ck-scrub").focus()
    page.keyboard.press("Home")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    fourth = kr6.fk(kr6.home + 0.5 * 3 / 100)
    np.testing.assert_allclose(notebook.wait_transform(TOOL, fourth), fourth, rtol=0, atol=1e-12)

    notebook.idle()
    notebook.rest()
    page.locator("[role=slider]").first.press("PageUp")  # a slider ends the motion, where it rests
    notebook.idle()
    theta = notebook.kernel("panel.values['theta'].tolist()")
    np.testing.assert_allclose(theta, kr6.home + 0.5 * 3 / 100 + np.radians([10, 0, 0, 0, 0, 0]), atol=1e-9)
    expected = kr6.fk(theta)
    np.testing.assert_allclose(notebook.wait_transform(TOOL, expected), expected, rtol=0, atol=1e-12)
    assert notebook.errors == []


def test_keys_and_drags_in_a_hurry_end_at_the_last_value(notebook, lab):
    notebook.open(lab.write("hurry.ipynb", IMPORT, SHOW))
    notebook.run_all()
    notebook.wait_view()
    rng, page = np.random.default_rng(7), notebook.page
    tracks = page.locator("[role=slider]")
    for _ in range(5):
        first, second = rng.choice(6, 2, replace=False)
        tracks.nth(first).focus()
        for key in rng.choice(["ArrowRight", "PageUp", "ArrowLeft", "PageDown"], 4):
            page.keyboard.press(key)
        area = tracks.nth(second).bounding_box()
        y = area["y"] + area["height"] / 2
        page.mouse.move(area["x"] + area["width"] / 2, y)
        page.mouse.down()
        page.mouse.move(area["x"] + rng.uniform(0.1, 0.9) * area["width"], y, steps=12)
        page.mouse.up()
        page.wait_for_timeout(1000)
        notebook.idle()
        shown = [float(tracks.nth(k).get_attribute("aria-valuenow")) for k in range(6)]
        theta = notebook.kernel("panel.values['theta'].tolist()")
        np.testing.assert_allclose(np.degrees(theta), shown, atol=0.006)
        expected = robots.kuka_kr6().fk(theta)
        np.testing.assert_allclose(notebook.wait_transform(TOOL, expected), expected, rtol=0, atol=1e-12)
    assert notebook.errors == []


def test_without_webgl_there_is_a_picture_and_a_sentence(open_page, lab):
    notebook = open_page()
    notebook.page.add_init_script(NO_WEBGL)
    notebook.open(lab.write("nowebgl.ipynb", IMPORT, SHOW))
    notebook.run_all()
    picture = notebook.page.locator(".ck-picture")
    notebook.page.wait_for_function(
        "() => document.querySelector('.ck-picture')?.naturalWidth > 0", timeout=30_000
    )
    before = picture.get_attribute("src")
    assert "KUKA KR6 R900 sixx" in picture.get_attribute("alt")
    assert "no WebGL" in notebook.page.inner_text(".ck-wait")
    notebook.page.locator("[role=slider]").first.press("PageUp")
    notebook.page.wait_for_function("(old) => document.querySelector('.ck-picture').src !== old", arg=before)
    assert "10.0" in picture.get_attribute("alt")


PICTURE = """async (unlike) => { // as base64, once it is another one
    const read = async () => {
        const answer = await fetch(document.querySelector(".ck-picture").src);
        const bytes = new Uint8Array(await answer.arrayBuffer());
        return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ""));
    };
    for (let tries = 0; tries < 100; tries += 1) {
        const now = await read().catch(() => unlike);
        if (now !== unlike) return now;
        await new Promise((done) => setTimeout(done, 200));
    }
}"""


def test_without_webgl_there_are_views_and_a_player(open_page, lab):
    notebook = open_page()
    notebook.page.add_init_script(NO_WEBGL)
    motion = "q = np.linspace(kr6.home, kr6.home + 0.5, 11)\npanel.play(q, autoplay=False)"
    notebook.open(lab.write("views.ipynb", IMPORT + "\nimport base64", SHOW, motion))
    notebook.run_all()
    page = notebook.page
    page.wait_for_function("() => document.querySelector('.ck-picture')?.naturalWidth > 0", timeout=30_000)
    size = page.eval_on_selector(".ck-pane", "(pane) => [pane.clientWidth, pane.clientHeight]")
    drawn = f"base64.b64encode(view.png(panel.scene, *{size}, {{!r}})).decode()"

    home = page.evaluate(PICTURE, None)
    page.get_by_role("button", name="top", exact=True).click()
    top = page.evaluate(PICTURE, home)
    assert top == notebook.kernel(drawn.format("top"))

    page.locator(".ck-scrub").press("End")
    assert page.inner_text(".ck-count") == "11 / 11"
    assert page.evaluate(PICTURE, top) == notebook.kernel(
        drawn.format("top")
    )  # of the last pose, still from above
    np.testing.assert_allclose(
        notebook.kernel("panel.scene.robots['robot'].theta.tolist()"),
        robots.kuka_kr6().home + 0.5,
        atol=1e-12,
    )
    assert [said for said in notebook.errors if "creating WebGL" not in said] == []


def test_a_page_without_webgl_shows_the_picture_it_was_stored_with(browser, tmp_path):
    panel = view.explore(robots.kuka_kr6())
    panel.play(np.linspace(panel.values["theta"], panel.values["theta"] + 0.3, 5), autoplay=False)
    expected = base64.b64encode(view.png(panel.scene, 640, panel.viewer.height)).decode()
    (tmp_path / "page.html").write_text(view.to_html(panel), "utf-8")
    panel.close()
    context = browser.new_context(offline=True)
    page, errors = context.new_page(), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.add_init_script(NO_WEBGL)
    page.goto((tmp_path / "page.html").as_uri())
    assert page.evaluate(PICTURE, None) == expected
    assert "no WebGL" in page.inner_text(".ck-wait")
    assert page.locator(".ck-views button").count() == 0  # nothing here draws another view, or another pose
    assert not page.locator(".ck-player").is_visible()
    assert errors == []
    context.close()


def test_on_paper_the_robot_is_not_cut_off(browser, tmp_path):
    panel = view.explore(robots.kuka_kr6())
    (tmp_path / "page.html").write_text(view.to_html(panel), "utf-8")
    panel.close()
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    page = context.new_page()
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function(DRAWN, timeout=60_000)
    page.emulate_media(media="print")  # the window stays as wide as it is; a sheet has about 700 pixels
    box = """(one) => { const { left, right, top, bottom } = one.getBoundingClientRect();
                        return [left, right, top, bottom]; }"""
    left, right, top, bottom = page.eval_on_selector(".ck-viewer canvas", box)
    outer = page.eval_on_selector(".ck-viewer", box)
    assert 300 < right - left < 700
    assert left >= outer[0] and right <= outer[1] and top >= outer[2] and bottom <= outer[3]
    assert page.eval_on_selector("#sliders", box)[2] >= outer[3]
    assert not page.is_visible(".ck-views")
    context.close()


def test_in_a_page_without_a_kernel_every_solution_follows_the_target(browser, tmp_path):
    panel, kr6 = view.explore_inverse(), robots.kuka_kr6()
    T = panel.scene.moved["/ck/target"].copy()
    (tmp_path / "page.html").write_text(view.to_html(panel), "utf-8")
    panel.close()
    context = browser.new_context(offline=True)
    page, errors = context.new_page(), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function(DRAWN, timeout=60_000)
    x = page.get_by_role("slider", name="x", exact=True)
    x.press("PageDown")
    T[0, 3] -= 0.1
    right = ik.analytic(kr6, T)
    page.get_by_text("target reached by 8 of 8 saved solutions").wait_for()
    joints = ", ".join(f"{q:.1f}" for q in np.degrees(right.theta[0]))
    assert page.inner_text("#words").startswith(f"{kr6.name}: joints ({joints}) deg; tool at (486.0,")
    for k, theta in enumerate(right.theta):
        found = link(page, f"/ck/{f'branch{k}' if k else 'robot'}/6")
        np.testing.assert_allclose(found, kr6.displacements(theta)[-1], atol=1e-4)

    start = np.array(list(page.locator(".ck-handle.z").first.bounding_box().values())[:2]) + 9
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*(start + [-30, 0]), steps=4)
    page.mouse.up()
    page.wait_for_function("() => !document.querySelector('#words').textContent.includes('(486.0,')")
    assert "by 8 of 8" in page.inner_text("#words")
    x.press("Control+z")  # what the hand did, and no more
    page.wait_for_function("() => document.querySelector('#words').textContent.includes('(486.0,')")

    x.press("End")  # out of reach: what does not get there is not shown, but for the solid arm, which says so
    page.get_by_text("the solid arm cannot follow to this target; target reached by 0 of 8").wait_for()
    shown = (
        "(name) => document.querySelector('.ck-viewer').coursekit.viewer.scene_tree.find(name).object.visible"
    )
    assert not page.evaluate(shown, ["ck", "branch3", "2"])
    assert page.evaluate(shown, ["ck", "robot", "2"])
    assert errors == []
    context.close()


@pytest.mark.parametrize(
    "policy",
    [
        None,
        "script-src 'unsafe-inline' 'unsafe-eval'",  # no blob: the bundle runs by new Function
        "script-src 'unsafe-inline'",  # no eval either: by an inline script
    ],
)
def test_a_page_of_its_own_turns_offline_under_any_policy(browser, tmp_path, policy):
    kr6 = robots.kuka_kr6()
    panel = view.explore(kr6)
    panel.set(theta=kr6.home + 0.3)
    page_text = view.to_html(panel)
    panel.close()
    if policy:
        meta = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
        page_text = page_text.replace("<head>", f"<head>{meta}")
    file = tmp_path / "page.html"
    file.write_text(page_text, encoding="utf-8")

    context = browser.new_context(offline=True)
    page = context.new_page()
    errors, asked = [], []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(file.as_uri())
    page.wait_for_function(DRAWN, timeout=60_000)
    quaternion = page.evaluate(
        """() => document.querySelector(".ck-viewer").coursekit.viewer
                   .scene_tree.find(["ck", "robot", "1"]).object.quaternion.toArray()"""
    )
    turned = -0.3  # about -z, as axis 1 of this arm
    np.testing.assert_allclose(quaternion, [0, 0, np.sin(turned / 2), np.cos(turned / 2)], rtol=0, atol=1e-15)
    assert errors == []
    assert [url for url in asked if url.startswith("http")] == []
    context.close()
