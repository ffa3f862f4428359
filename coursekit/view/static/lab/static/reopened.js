// JupyterLab, a notebook of yesterday: where no kernel has the model of an explorer, its stored picture is shown, and in
// its place soon a page that moves (coursekit/view/reopened.py). Written by hand as what JupyterLab loads: no build.
(() => {
  const LINE = /^Explorer of [^:]+: [^:]+: joints \(/;
  const SENTENCE = "This explorer was saved without its kernel: its sliders move the arm all the same. "
    + "Run the cell for its switches, numbers and plots.";
  const STILL = "The picture that was saved. Run the cell to make this explorer move.";

  const textOf = (value) => (Array.isArray(value) ? value.join("") : value || "");

  function* outputs(app) {
    for (const panel of app.shell.widgets("main")) {
      for (const cell of (panel.content && panel.content.widgets) || []) {
        const area = cell.outputArea;
        for (let i = 0; area && i < Math.min(area.widgets.length, area.model.length); i += 1) {
          yield [area.widgets[i].node, area.model.get(i).data];
        }
      }
    }
  }

  // Neither a live view nor anything else that is right: the error of a missing model, or (not trusted) the picture alone.
  const isLost = (node) => /Error displaying widget: model not found/.test(node.textContent)
    || (node.querySelector("img") && !node.querySelector(".ck-root, .ck-control, .ck-saved"));

  function revive(node, data, { baseUrl, token }) {
    const line = textOf(data["text/plain"]);
    const place = node.ownerDocument.createElement("div");
    place.className = "ck-saved";
    const picture = Object.assign(new Image(), { src: `data:image/png;base64,${textOf(data["image/png"])}`, alt: line });
    const said = Object.assign(document.createElement("p"), { textContent: STILL });
    said.setAttribute("role", "status");
    place.append(picture, said);
    node.style.display = "none";
    node.after(place);
    const theme = document.body.dataset.jpThemeLight === "false" ? "dark" : "light";
    const address = `${baseUrl}coursekit/explorer?line=${encodeURIComponent(line)}`;
    // As JupyterLab asks its server: behind a hub a page of the server's knows nobody by a cookie alone.
    const headers = token ? { Authorization: `token ${token}` } : {};
    fetch(address, { headers, redirect: "manual" }).then(async (answer) => {
      if (!answer.ok) return; // an arm of one's own, or a server without the course: the picture stays
      const page = URL.createObjectURL(new Blob([await answer.text()], { type: "text/html" }));
      const frame = Object.assign(document.createElement("iframe"), { src: `${page}#${theme}`, title: line });
      frame.style.cssText = "width: 100%; height: 580px; border: 0; position: absolute; visibility: hidden";
      frame.onload = () => {
        frame.style.position = "static";
        frame.style.visibility = "visible";
        picture.remove();
        URL.revokeObjectURL(page);
        said.textContent = SENTENCE;
      };
      place.prepend(frame);
    }).catch(() => {});
    return place;
  }

  function activate(app) {
    const server = JSON.parse(document.getElementById("jupyter-config-data").textContent);
    const revived = new WeakMap(); // node of the output -> what stands in its place
    let due = null;
    const look = () => {
      due = null;
      for (const place of document.querySelectorAll(".ck-saved")) { // the cell was run again: a live view is there
        const node = place.previousElementSibling;
        if (node && isLost(node)) continue;
        if (node) node.style.display = "";
        place.remove();
      }
      for (const [node, data] of outputs(app)) {
        if (!data["image/png"] || !LINE.test(textOf(data["text/plain"]))) continue;
        const there = revived.get(node);
        if (there && there.isConnected) continue;
        if (isLost(node)) revived.set(node, revive(node, data, server));
      }
    };
    new MutationObserver(() => (due = due || setTimeout(look, 150))).observe(document.body, { childList: true, subtree: true });
  }

  const plugin = { id: "coursekit:reopened", autoStart: true, activate };
  window._JUPYTERLAB = window._JUPYTERLAB || {};
  window._JUPYTERLAB.coursekit = { init() {}, get: async () => () => ({ __esModule: true, default: plugin }) };
})();
