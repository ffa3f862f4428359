"""The first explorer of a page: a picture at once, and nothing that the page has to wait for."""

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


PAGE = 'globalThis[Symbol.for("coursekit.page.1")]'
# Whether something was drawn while no view was in the page.
UNSEEN = """
window.unseen = 0;
const { drawElements } = WebGL2RenderingContext.prototype;
WebGL2RenderingContext.prototype.drawElements = function (...args) {
  if (!document.querySelector(".ck-pane")) unseen += 1;
  return drawElements.apply(this, args);
};
"""


def test_the_first_stage_of_a_page_is_ready_before_its_view(notebook, lab):
    """It is thrown away where the view never comes, or where the scene has changed until then."""
    page = notebook.page
    page.add_init_script(UNSEEN)
    notebook.open(lab.write("early.ipynb", "from coursekit import view\nopened = []", "opened[-1]"))
    notebook.kernel("exec('import numpy as np; from coursekit import view; opened = [view.explore()]')")
    page.wait_for_function("unseen > 50")
    assert page.evaluate(f"{PAGE}.views.size") == 1
    notebook.kernel("opened.pop().close()")
    page.wait_for_function(f"{PAGE}.views.size === 0")

    notebook.kernel("opened.append(view.explore())")
    page.wait_for_function(f"{PAGE}.views.size === 1")
    notebook.kernel("(opened[-1].scene.frame('/ck/late', np.eye(4), 'late'), opened[-1].viewer.sync())[1]")
    page.wait_for_function(f"{PAGE}.views.size === 0")
    notebook.run_cell(1)
    notebook.wait_view()
    drawn = page.evaluate(
        """() => {
             const { viewer } = document.querySelector(".ck-viewer").coursekit;
             return Object.keys(viewer.scene_tree.find(["ck"]).children);
           }"""
    )
    assert {"robot", "late"} <= set(drawn)
    assert page.evaluate(f"{PAGE}.views.size") == 1
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
