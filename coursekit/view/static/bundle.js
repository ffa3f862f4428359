// meshcat's own viewer (its main.min.js), evaluated once per page and shared by every view on it.
// It arrives gzipped in a custom message, never in widget state.

// What all views of this browser page share. A symbol on globalThis, since two versions of this script may be in it.
function page() {
  const key = Symbol.for("coursekit.page.1");
  if (!globalThis[key]) {
    const shared = { views: new Set(), evaluated: 0, asked: 0, busy: false };
    shared.meshcat = new Promise((resolve, reject) => Object.assign(shared, { resolve, reject }));
    globalThis[key] = shared;
  }
  return globalThis[key];
}

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

// Bytes of a message, whatever the transport made of them (a DataView may start in the middle of its buffer).
const bytesOf = (data) => (data instanceof Uint8Array ? data : new Uint8Array(data.buffer, data.byteOffset, data.byteLength));

// Float64Array needs an offset that is a multiple of 8: copy.
const floatsOf = (data) => new Float64Array(bytesOf(data).slice().buffer);

const gunzip = async (data) => new Response(new Blob([bytesOf(data)]).stream().pipeThrough(new DecompressionStream("gzip"))).text();

// Three ways to run the bundle; a content security policy may forbid any of them. Each hides `define` and gives the
// bundle a `module` of its own, so that it can neither register with a loader of the host page nor become a global.
const waysToEvaluate = [
  async function asModule(source) {
    const text = `const module = {exports: {}}, exports = module.exports, define = undefined;\n${source}\nexport default module.exports;`;
    const url = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    try {
      return (await import(/* webpackIgnore: true */ url)).default;
    } finally {
      URL.revokeObjectURL(url);
    }
  },
  async function asFunction(source) {
    const module = { exports: {} };
    new Function("module", "exports", "define", source)(module, module.exports, undefined);
    return module.exports;
  },
  async function asInlineScript(source) {
    const script = document.createElement("script");
    script.textContent =
      `(function (module, exports, define) {${source}\n;window.__coursekit_meshcat = module.exports;})({exports: {}}, {}, undefined)`;
    document.head.append(script);
    script.remove();
    const result = window["__coursekit_meshcat"];
    delete window["__coursekit_meshcat"];
    return result;
  },
];

async function receiveBundle(data) {
  const shared = page();
  if (shared.MeshCat || shared.busy) return;
  shared.busy = true;
  const reasons = [];
  const source = await gunzip(data).catch((error) => reasons.push(`gunzip: ${error.message}`) && null);
  for (const evaluate of source === null ? [] : waysToEvaluate) {
    try {
      const MeshCat = await evaluate(source);
      if (!MeshCat || !MeshCat.Viewer) throw new Error("no Viewer in it");
      shared.MeshCat = MeshCat;
      shared.evaluated += 1;
      shared.resolve(MeshCat);
      return;
    } catch (error) {
      reasons.push(`${evaluate.name}: ${error.message}`);
    }
  }
  shared.busy = false;
  console.warn("[coursekit] the 3D viewer cannot run here:", reasons.join("; "));
  const policy = "this page's security policy stops the 3D viewer (an administrator can add blob: to script-src)";
  shared.reject(new Error(source === null ? "its script came damaged; reload the page" : policy));
}

// A reloaded page or a second browser was not there when the bundle was pushed: ask, once per page at a time. And ask
// again, more and more rarely: an answer may get lost (a server drops messages where too many come at once).
function askForBundle(model) {
  const shared = page();
  const ask = () => {
    if (shared.MeshCat || shared.asked > 20) return;
    const patience = 4000 * 1.5 ** shared.asked; // milliseconds
    setTimeout(ask, patience);
    if (shared.busy || (shared.askedAt && performance.now() - shared.askedAt < 0.9 * patience)) return;
    shared.askedAt = performance.now();
    shared.asked += 1;
    model.send({ type: "need_bundle" });
  };
  if (!shared.MeshCat) setTimeout(ask, 400);
}
