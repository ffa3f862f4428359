"""The first explorer of a page: a picture at once, and nothing that the page has to wait for."""

import numpy as np
import pytest

pytestmark = pytest.mark.browser

# What comes before the first frame: the pictures over the pane, and the order of the kernel's messages.
WATCH = """
window.covers = [];
new MutationObserver(() => {
  const cover = document.querySelector(".ck-cover");
  if (!cover || covers.includes(cover.src)) return;
  covers.push(cover.src, fetch(cover.src).then((answer) => answer.blob()));
}).observe(document, { childList: true, subtree: true });
"""
LISTEN = """() => {
    window.told = [];
    const { context } = window.jupyterapp.shell.currentWidget;
    context.sessionContext.iopubMessage.connect((_, { header, content }) => {
      if (header.msg_type === "execute_result" && content.data["image/png"]) told.push("result");
      if (header.msg_type === "comm_msg" && content.data?.state?.svg) told.push("plot");
    });
}"""
STORED = """() => window.jupyterapp.shell.currentWidget.content.widgets.at(-1).model.outputs.toJSON()
    .map((output) => output.data?.["image/png"]).find((picture) => picture).replace(/\\s/g, "")"""
SHOWN = """async () => {
    const bytes = new Uint8Array(await (await covers[1]).arrayBuffer());
    return [covers.length / 2, btoa(String.fromCharCode(...bytes))];
}"""


def test_the_stored_picture_is_there_until_the_first_frame_and_before_the_plots(notebook, lab):
    notebook.page.add_init_script(WATCH)
    notebook.open(lab.write("first.ipynb", "from coursekit import view", "view.explore_inverse()"))
    notebook.page.evaluate(LISTEN)
    notebook.run_all()
    notebook.wait_view()
    shown, picture = notebook.page.evaluate(SHOWN)
    assert shown == 1 and picture == notebook.page.evaluate(STORED)
    assert notebook.page.locator(".ck-first").count() == 0
    assert notebook.page.evaluate("told") == ["result", "plot"]
    notebook.page.wait_for_selector(".ck-plot svg")
    assert notebook.errors == []


# What white rough metal reflects that faces each of these directions, in the light of the room alone.
REFLECTED = """(directions) => {
    const { MeshCat, renderer, studioLight } = document.querySelector(".ck-viewer").coursekit.page;
    const THREE = MeshCat.THREE, scene = new THREE.Scene();
    const camera = new THREE.PerspectiveCamera(5, 1, 0.1, 10);
    scene.environment = studioLight;
    const paint = new THREE.MeshStandardMaterial({ metalness: 1, roughness: 1, envMapIntensity: 0.15 });
    const sheet = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), paint);
    scene.add(sheet);
    const target = new THREE.WebGLRenderTarget(4, 4), pixel = new Uint8Array(4);
    const seen = directions.map((direction) => {
      sheet.lookAt(...direction);
      camera.position.set(...direction);
      camera.up.set(direction[1] ? 1 : 0, direction[1] ? 0 : 1, 0);
      camera.lookAt(0, 0, 0);
      renderer.setRenderTarget(target);
      renderer.render(scene, camera);
      renderer.readRenderTargetPixels(target, 1, 1, 1, 1, pixel);
      return [...pixel].slice(0, 3);
    });
    renderer.setRenderTarget(null);
    return seen;
}"""


def test_rough_metal_reflects_the_room(notebook, lab):
    """The light is computed in the layout that three reads: here from the room itself, with y up."""
    notebook.open(lab.write("room.ipynb", "from coursekit import view\nview.explore()"))
    notebook.run_all()
    notebook.wait_view()
    directions = np.concatenate([np.eye(3), -np.eye(3)])
    found = np.array(notebook.page.evaluate(REFLECTED, directions.tolist()), float)

    rng = np.random.default_rng(1)
    ways = rng.normal(size=(400_000, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    walls = np.array([0x8D, 0x92, 0x99]) / 255
    light = np.tile(walls, (len(ways), 1))
    for bright, axis, at, (u, low_u, high_u), (v, low_v, high_v) in (
        (9.0, 1, 2.9, (0, -2.5, 2.5), (2, -2.5, 2.5)),
        (5.0, 0, -4.9, (1, -0.5, 2.1), (2, -1, 3)),
        (3.5, 2, 4.9, (0, 1, 5), (1, -0.2, 2.2)),
        (0.25, 1, -2.95, (0, -4.5, 4.5), (2, -4.5, 4.5)),
    ):
        with np.errstate(divide="ignore"):
            hit = ways * (at / ways[:, axis])[:, None]
        inside = (at * ways[:, axis] > 0) & (hit[:, u] > low_u) & (hit[:, u] < high_u)
        light[inside & (hit[:, v] > low_v) & (hit[:, v] < high_v)] = bright
    weight = np.exp((directions @ ways.T - 1) / 0.583**2)
    expected = weight @ light / weight.sum(axis=1, keepdims=True)
    scale = (found * expected).sum() / (expected**2).sum()
    assert scale > 10 and found.max() < 255
    np.testing.assert_allclose(found / scale, expected, atol=0.05 * expected.max())
    assert notebook.errors == []


def test_a_full_frame_is_copied_once_it_is_drawn(notebook, lab):
    """To copy a frame that is not drawn yet stops the page, for seconds where there is no GPU."""
    notebook.page.add_init_script(
        """window.copied = [];
           let fence = null;
           const { drawImage } = CanvasRenderingContext2D.prototype;
           const { deleteSync } = WebGL2RenderingContext.prototype;
           WebGL2RenderingContext.prototype.deleteSync = function (sync) {
             fence = this.getSyncParameter(sync, this.SYNC_STATUS) === this.SIGNALED ? "drawn" : "early";
             return deleteSync.call(this, sync);
           };
           CanvasRenderingContext2D.prototype.drawImage = function (...args) {
             if (this.canvas.closest(".ck-pane")) copied.push(fence);
             fence = null;
             return drawImage.apply(this, args);
           };"""
    )
    notebook.open(lab.write("fence.ipynb", "from coursekit import view\nview.explore()"))
    notebook.run_all()
    notebook.wait_view()
    assert notebook.page.evaluate("copied[0]") == "drawn"
    assert notebook.errors == []
