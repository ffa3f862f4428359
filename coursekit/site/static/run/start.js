// Loads Python and JupyterLab into this browser's store, says how far it is, and opens the notebook.
(() => {
  const CACHE = "coursekit-run";
  const byId = (id) => document.getElementById(id);
  const say = (text) => { byId("said").textContent = text; };
  const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

  // The worker must stand between the page and the server before anything is loaded, so that all of it is kept.
  async function worker() {
    if (!("serviceWorker" in navigator)) return false; // a private window, or a page without https
    const registered = navigator.serviceWorker.register("service-worker.js?enableCache=false");
    registered.catch(() => {}); // told below, where it is waited for
    if (navigator.serviceWorker.controller) return true; // to look for a newer one takes up to 2 s
    await registered;
    await navigator.serviceWorker.ready;
    if (navigator.serviceWorker.controller) return true;
    return new Promise((resolve) => {
      navigator.serviceWorker.addEventListener("controllerchange", () => resolve(true), { once: true });
      setTimeout(() => resolve(Boolean(navigator.serviceWorker.controller)), 10_000);
    });
  }

  async function load({ first, files }) {
    const cache = await caches.open(CACHE);
    const here = new URL(".", location.href);
    const total = first.reduce((sum, name) => sum + files[name].size, 0);
    const missing = [];
    let loaded = 0;
    const show = () => {
      byId("bar").value = loaded / total;
      say(`${megabytes(loaded)} of ${megabytes(total)} MB (${Math.round((100 * loaded) / total)} %) are here`);
    };
    for (const name of first) {
      const kept = await cache.match(`${here}${name}?sum=${files[name].sum}`);
      if (kept) loaded += files[name].size;
      else missing.push(name);
    }
    show();
    const one = async () => {
      for (let name = missing.shift(); name; name = missing.shift()) {
        const answer = await fetch(name);
        if (!answer.ok) throw new Error(`${name}: ${answer.status} ${answer.statusText}`);
        const reader = answer.body.getReader();
        for (let part = await reader.read(); !part.done; part = await reader.read()) {
          loaded += part.value.length;
          show();
        }
      }
    };
    await Promise.all([one(), one(), one(), one()]);
  }

  async function start() {
    byId("again").hidden = true;
    if (location.protocol === "file:") {
      say("A folder is not enough for this: a browser starts Python only from a web server. In the folder of this site, "
        + "python3 -m http.server  is one; then open http://localhost:8000");
      return;
    }
    try {
      const kept = await worker();
      if (kept) {
        await load(await (await fetch("files.json", { cache: "no-cache" })).json());
      } else {
        say("This browser keeps nothing here (a private window?): the course runs, but is loaded anew each time, and what "
          + "you write may be gone when the window is closed");
        await new Promise((done) => setTimeout(done, 4000));
      }
      say("JupyterLab opens");
      const path = new URLSearchParams(location.search).get("path");
      location.replace(`lab/index.html${path ? `?path=${encodeURIComponent(path)}` : ""}`);
    } catch (error) {
      say(`Not everything could be loaded (${error.message}). What is here already stays here.`);
      byId("again").hidden = false;
    }
  }

  byId("again").addEventListener("click", start);
  start();
})();
