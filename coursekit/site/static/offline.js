// Keeps the pages for times without a network: what was read once can be read again, newest first where there is one.
// JupyterLab below run/ has a worker of its own.
const CACHE = "coursekit-pages-@version@";
const PAGES = @pages@;

self.addEventListener("install", (event) => {
  self.skipWaiting();
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(PAGES)));
});

self.addEventListener("activate", (event) => {
  const old = (names) => names.filter((name) => name.startsWith("coursekit-pages-") && name !== CACHE);
  event.waitUntil(caches.keys().then((names) => Promise.all(old(names).map((name) => caches.delete(name)))).then(() => clients.claim()));
});

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const here = request.url.startsWith(self.registration.scope) && !request.url.startsWith(`${self.registration.scope}run/`);
  if (request.method !== "GET" || !here) return;
  const keep = async (answer) => {
    if (answer.ok) await (await caches.open(CACHE)).put(request, answer.clone());
    return answer;
  };
  const kept = () => caches.match(request, { ignoreSearch: true });
  event.respondWith(fetch(request).then(keep, async () => (await kept()) || Response.error()));
});
