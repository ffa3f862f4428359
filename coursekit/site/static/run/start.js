// Loads Python and JupyterLab into this browser's store, says how far it is, and opens the notebook.
(() => {
  const CACHE = "coursekit-run";
  const OFTEN = 250, SLOW = 3000; // ms: before the reader is told again how far it is; and when a line is a slow one
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
    const key = (name) => `${here}${name}?sum=${files[name].sum}`;
    const total = first.reduce((sum, name) => sum + files[name].size, 0);
    const missing = [], begun = performance.now();
    let loaded = 0, shown = 0;
    const show = () => {
      shown = performance.now();
      byId("bar").value = loaded / total;
      say(`${megabytes(loaded)} of ${megabytes(total)} MB (${Math.round((100 * loaded) / total)} %) are here`);
    };
    const look = () => performance.now() - shown > OFTEN && show();
    for (const name of first) {
      const kept = await cache.match(key(name));
      if (kept) loaded += files[name].size;
      else missing.push(name);
    }
    show();
    const counted = (answer) => {
      const count = new TransformStream({
        transform(part, on) {
          loaded += part.length;
          look();
          on.enqueue(part);
        },
      });
      return new Response(answer.body.pipeThrough(count), answer);
    };
    const one = async () => {
      for (let name = missing.shift(); name; name = missing.shift()) {
        const answer = await fetch(name, { cache: "no-cache", headers: { "Coursekit-Keeps": "page" } }); // and not the worker
        if (!answer.ok) throw new Error(`${name}: ${answer.status} ${answer.statusText}`);
        const isSlow = performance.now() - begun > SLOW; // if not, to look at each part would take as long as to load it
        await cache.put(key(name), isSlow ? counted(answer) : answer);
        if (!isSlow) loaded += files[name].size;
        look();
      }
    };
    await Promise.all([one(), one(), one(), one()]);
    show();
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
