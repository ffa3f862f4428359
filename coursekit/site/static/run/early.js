// Python starts while the rest is still loading. In the page this makes a worker, as soon as start.js says that the files are
// here, and hands it over when the kernel asks for its own; in that worker it loads Pyodide as the kernel would, so that the
// kernel finds it loaded.
(() => {
  // What the kernel and nearly every first cell import; between two of them the kernel is heard.
  const FIRST = ["piplite.piplite", "pyodide_kernel", "numpy", "coursekit.classroom", "coursekit.view", "anywidget"];
  const LATER = "sympy", QUIET = 5_000; // what cells further down import, once nothing more was asked for so many ms
  const IDLE = 120_000; // ms until a worker that nobody asked for goes

  // What Python need not do: read its own library's directory anew after packages are unpacked, once for each folder of it;
  // load compiled parts that nobody imports; ask the page, which is busy, for the student's folder before each import.
  const LESS = `import sys, zipimport
from pyodide import _package_loader
zipimport.zipimporter.invalidate_caches = lambda _: None
_package_loader.get_dynlibs = lambda *_: []
sys.path.append(sys.path.pop(sys.path.index("")))`;

  async function inWorker() {
    let load, started, heard = Infinity;
    const packagesAreHere = new Promise((resolve) => {
      addEventListener("message", ({ data }) => {
        if (data?.packagesAreHere) return resolve();
        heard = performance.now();
        if (data?.kernel) importScripts(data.kernel);
      });
    });
    const start = async ({ packages, ...options }) => {
      const python = await load(options);
      python.runPython(LESS);
      await packagesAreHere;
      await python.loadPackage(packages, { messageCallback() {} });
      return python;
    };
    // The kernel runs Pyodide's script again, and then finds what runs already. (The script sets the name to other things, too.)
    Object.defineProperty(self, "loadPyodide", {
      get: () => (options) => (started ||= start(options)),
      set(real) { if (typeof real === "function") load = real; },
    });
    const { litePluginSettings } = (await (await fetch("jupyter-lite.json")).json())["jupyter-config-data"];
    const [{ pyodideUrl, loadPyodideOptions }] = Object.values(litePluginSettings);
    const url = new URL(pyodideUrl, location);
    importScripts(url);
    const python = await self.loadPyodide({ indexURL: new URL(".", url).href, ...loadPyodideOptions });
    for (const name of FIRST) {
      python.runPython(`import ${name}`);
      await new Promise((on) => setTimeout(on));
    }
    while (!(performance.now() - heard > QUIET)) await new Promise((on) => setTimeout(on, QUIET));
    python.runPython(`import ${LATER}`);
  }

  function inPage(script) {
    const known = Object.keys(localStorage).some((name) => name.startsWith("coursekit.open."));
    const isWanted = !crossOriginIsolated && (known || new URLSearchParams(location.search).has("path"));
    const Plain = self.Worker;
    let early, late;
    const begin = () => {
      early = new Plain(script);
      self.Worker = new Proxy(Plain, {
        construct(_, [url, ...options]) {
          if (!/pyodide-kernel/.test(url)) return new Plain(url, ...options);
          clearTimeout(late);
          self.Worker = Plain;
          early.postMessage({ kernel: String(url) });
          return early;
        },
      });
    };
    self.startPython = ({ packages }) => {
      if (!isWanted || late) return;
      if (!early) begin();
      if (!packages) return;
      early.postMessage({ packagesAreHere: true });
      late = setTimeout(() => { early.terminate(); self.Worker = Plain; }, IDLE);
    };
  }

  if (self.document) inPage(document.currentScript.src);
  else inWorker();
})();
