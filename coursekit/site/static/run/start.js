// Loads Python and JupyterLab into this browser's store and says how far it is; then JupyterLab's page, in which this
// stands, goes on. Python starts as soon as its own files are here.
globalThis.courseLoaded = new Promise((resolve) => {
  const CACHE = "coursekit-run";
  const here = new URL("../", location.href); // the folder of all this
  // What Python starts with, and its packages; the rest is JupyterLab's.
  const CORE = /^(jupyter-lite\.json|static\/pyodide\/(pyodide[^/]*\.(js|json|wasm)|python_stdlib\.zip))$/;
  const order = (name) => (CORE.test(name) ? 0 : name.startsWith("static/pyodide/") ? 1 : 2);
  const OFTEN = 250, SLOW = 3000; // ms: before the reader is told again how far it is; and when a line is a slow one
  const byId = (id) => document.getElementById(id);
  const say = (text) => { byId("said").textContent = text; };
  const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

  // The worker must stand between the page and the server before anything is loaded, so that all of it is kept.
  async function worker() {
    if (!("serviceWorker" in navigator)) return false; // a private window, or a page without https
    const script = new URL("service-worker.js?enableCache=false", here).href;
    const stands = () => navigator.serviceWorker.controller?.scriptURL === script; // and not the one that keeps pages
    const registered = navigator.serviceWorker.register(script);
    registered.catch(() => {}); // told below, where it is waited for
    if (stands()) return true; // to look for a newer one takes up to 2 s
    await registered;
    return new Promise((stood) => {
      const look = () => stands() && stood(true);
      navigator.serviceWorker.addEventListener("controllerchange", look);
      look();
      setTimeout(() => stood(stands()), 10_000);
    });
  }

  async function load({ first, files }) {
    const cache = await caches.open(CACHE);
    const key = (name) => new URL(`${name}?sum=${files[name].sum}`, here).href;
    const total = first.reduce((sum, name) => sum + files[name].size, 0);
    const begun = performance.now();
    let loaded = 0, shown = 0;
    const show = () => {
      shown = performance.now();
      byId("bar").value = loaded / total;
      say(`${megabytes(loaded)} of ${megabytes(total)} MB (${Math.round((100 * loaded) / total)} %) are here`);
    };
    const look = () => performance.now() - shown > OFTEN && show();
    const kept = new Set((await cache.keys()).map(({ url }) => url));
    const missing = new Set(first.filter((name) => !kept.has(key(name))));
    for (const name of first) if (!missing.has(name)) loaded += files[name].size;
    const tellPython = () => {
      const lacking = Math.min(2, ...[...missing].map(order));
      if (lacking > 0) self.startPython({ packages: lacking > 1 });
    };
    tellPython();
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
    const waiting = [...missing].sort((one, other) => order(one) - order(other));
    const one = async () => {
      for (let name = waiting.shift(); name; name = waiting.shift()) {
        const answer = await fetch(new URL(name, here), { cache: "no-cache", headers: { "Coursekit-Keeps": "page" } }); // and not the worker
        if (!answer.ok) throw new Error(`${name}: ${answer.status} ${answer.statusText}`);
        const isSlow = performance.now() - begun > SLOW; // if not, to look at each part would take as long as to load it
        await cache.put(key(name), isSlow ? counted(answer) : answer);
        if (!isSlow) loaded += files[name].size;
        missing.delete(name);
        tellPython();
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
        await load(await (await fetch(new URL("files.json", here), { cache: "no-cache" })).json());
      } else {
        self.startPython({ packages: true });
        say("This browser keeps nothing here (a private window?): the course runs, but is loaded anew each time, and what "
          + "you write may be gone when the window is closed");
        await new Promise((done) => setTimeout(done, 4000));
      }
      say("JupyterLab opens");
      resolve();
    } catch (error) {
      say(`Not everything could be loaded (${error.message}). What is here already stays here.`);
      byId("again").hidden = false;
    }
  }

  addEventListener("DOMContentLoaded", () => {
    byId("again").addEventListener("click", start);
    start();
  });
});
