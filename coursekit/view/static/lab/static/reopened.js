// JupyterLab, a notebook of yesterday: where no kernel has the model of an explorer, its stored picture is shown, and soon
// a page that moves (coursekit/view/reopened.py). Any picture gets its words, and is dark on a dark page. No build.
(() => {
  const LINE = /^Explorer of [^:]+: [^:]+: joints \(/;
  const SENTENCE = "Saved without its kernel: the picture can be turned, and its sliders and buttons move the arm. Run the cell for the rest.";
  const STILL = "The picture that was saved. Run the cell to make this explorer move.";
  // Turned over in lightness, each color in its hue: white becomes the page's own ground.
  const DARK = "@media screen { [data-jp-theme-light=false] .ck-light { filter: invert(0.93) hue-rotate(180deg); } }";

  const theme = () => (document.body.dataset.jpThemeLight === "false" ? "dark" : "light");
  const textOf = (value) => (Array.isArray(value) ? value.join("") : value || "");

  function* outputs(app) {
    for (const panel of app.shell.widgets("main")) {
      for (const { outputArea: area } of panel.content?.widgets || []) {
        const count = area ? Math.min(area.widgets.length, area.model.length) : 0;
        for (let i = 0; i < count; i += 1) yield [area.widgets[i].node, area.model.get(i)];
      }
    }
  }

  function tell(picture, words) {
    picture.alt = words;
    picture.decode().then(() => { // one that begins dark, or with nothing, was made for where it is
      const corner = new OffscreenCanvas(1, 1).getContext("2d");
      corner.drawImage(picture, 0, 0);
      picture.classList.toggle("ck-light", corner.getImageData(0, 0, 1, 1).data.every((part) => part > 240));
    }).catch(() => {});
  }

  // Neither a live view nor anything else that is right: the error of a missing model, or (not trusted) the picture alone; or
  // what it may say for ever, where a kernel came late.
  const PATIENCE = 5000, since = new WeakMap(); // milliseconds; node -> when it was first seen to load
  const loads = (node) => /Loading widget\.\.\./.test(node.textContent) && since.set(node, since.get(node) || Date.now());
  const isLost = (node) => (loads(node) ? Date.now() - since.get(node) >= PATIENCE : /Error displaying widget: model not found/.test(node.textContent)
    || (node.querySelector("img") && !node.querySelector(".ck-root, .ck-control, .ck-saved")));
  const frames = () => [...document.querySelectorAll(".ck-saved iframe")];

  function revive(node, data, { baseUrl, token }) {
    const line = textOf(data["text/plain"]);
    const place = Object.assign(document.createElement("div"), { className: "ck-saved" });
    const picture = Object.assign(new Image(), { src: `data:image/png;base64,${textOf(data["image/png"])}` });
    tell(picture, line);
    const said = Object.assign(document.createElement("p"), { role: "status", textContent: STILL });
    place.append(picture, said);
    node.style.display = "none";
    node.after(place);
    // As JupyterLab asks its server: behind a hub a page of the server's knows nobody by a cookie alone.
    const headers = token ? { Authorization: `token ${token}` } : {};
    fetch(`${baseUrl}coursekit/explorer?line=${encodeURIComponent(line)}`, { headers, redirect: "manual" }).then(async (answer) => {
      if (!answer.ok) return; // an arm of one's own, or a server without the course: the picture stays
      const page = URL.createObjectURL(new Blob([await answer.text()], { type: "text/html" }));
      const frame = Object.assign(document.createElement("iframe"), { src: `${page}#${theme()}`, title: line });
      frame.style.cssText = "width: 100%; height: 580px; border: 0; position: absolute; visibility: hidden";
      frame.onload = () => {
        Object.assign(frame.style, { position: "static", visibility: "visible" });
        picture.remove();
        URL.revokeObjectURL(page);
        said.textContent = SENTENCE;
      };
      place.prepend(frame);
    }).catch(() => {});
  }

  function activate(app) {
    const server = JSON.parse(document.getElementById("jupyter-config-data").textContent);
    document.head.append(Object.assign(document.createElement("style"), { textContent: DARK }));
    let due = null;
    const look = () => {
      due = null;
      for (const place of document.querySelectorAll(".ck-saved")) { // the cell was run again: a live view is there
        const node = place.previousElementSibling;
        if (node && isLost(node)) continue;
        if (node) node.style.display = "";
        place.remove();
      }
      for (const [node, { data, metadata }] of outputs(app)) {
        const line = textOf(data["text/plain"]), words = metadata["image/png"]?.alt || (/^<Figure/.test(line) && line);
        const picture = words && node.querySelector(".jp-RenderedImage > img:not([alt])");
        if (picture) tell(picture, words);
        if (!data["image/png"] || !LINE.test(line) || node.nextElementSibling?.matches(".ck-saved")) continue;
        if (isLost(node)) revive(node, data, server);
        else if (loads(node)) due = due || setTimeout(look, PATIENCE);
      }
    };
    new MutationObserver(() => frames().forEach((frame) => frame.contentWindow.postMessage({ coursekit: "theme", theme: theme() }, "*")))
      .observe(document.body, { attributeFilter: ["data-jp-theme-light"] });
    addEventListener("message", ({ data, source }) => { // a page says how high it is
      const frame = data?.coursekit === "height" && frames().find((one) => one.contentWindow === source);
      if (frame) frame.style.height = `${data.height}px`;
    });
    new MutationObserver(() => (due = due || setTimeout(look, 150))).observe(document.body, { childList: true, subtree: true });
  }

  const plugin = { id: "coursekit:reopened", autoStart: true, activate };
  window._JUPYTERLAB = window._JUPYTERLAB || {};
  window._JUPYTERLAB.coursekit = { init() {}, get: async () => () => ({ __esModule: true, default: plugin }) };
})();
