// Keeps the application in this browser, each file under the sum of its contents: what a new release did not change is
// not loaded again, and pages of two releases never mix. Behind it stands JupyterLite's own worker, which lets Python
// read and write the notebooks' files.
(() => {
  const CACHE = "coursekit-run";
  const LIST = "files.json";
  let known = null; // {version, files: {path: {size, sum}}}

  const address = (path) => `${self.registration.scope}${path}`;

  // The list of this release; without a network the last one.
  async function refresh() {
    const cache = await caches.open(CACHE);
    const answer = await fetch(address(LIST), { cache: "no-cache" }).catch(() => null);
    if (answer && answer.ok) {
      const list = await answer.clone().json();
      if (!known || known.version !== list.version) await forget(cache, list);
      await cache.put(address(LIST), answer);
      known = list;
    } else {
      const kept = await cache.match(address(LIST));
      if (kept) known = await kept.json();
    }
    return known;
  }

  async function forget(cache, list) {
    const wanted = new Set(Object.entries(list.files).map(([path, { sum }]) => `${address(path)}?sum=${sum}`));
    for (const request of await cache.keys()) if (request.url !== address(LIST) && !wanted.has(request.url)) await cache.delete(request);
  }

  async function answer(request, path) {
    const list = request.mode === "navigate" || path === LIST || !known ? await refresh() : known;
    const cache = await caches.open(CACHE);
    if (path === LIST) return (await cache.match(address(LIST))) || Response.error();
    const entry = list && list.files[path];
    if (!entry) return fetch(request);
    const key = `${address(path)}?sum=${entry.sum}`;
    const kept = await cache.match(key);
    if (kept) return kept;
    const fresh = await fetch(address(path), { cache: "no-cache" });
    if (fresh.ok) await cache.put(key, fresh.clone());
    return fresh;
  }

  self.addEventListener("fetch", (event) => {
    const { request } = event;
    if (request.method !== "GET" || !request.url.startsWith(self.registration.scope)) return;
    const path = decodeURIComponent(new URL(request.url).pathname.slice(new URL(self.registration.scope).pathname.length));
    if (/^api\/(drive|stdin|service-worker)/.test(path)) return; // JupyterLite's
    event.stopImmediatePropagation();
    if (request.headers.has("Coursekit-Keeps")) return; // the page does: two that read it take twice as long
    event.respondWith(answer(request, path));
  });
})();

importScripts("jupyterlite-worker.js");
