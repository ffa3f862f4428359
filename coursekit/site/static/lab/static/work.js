// JupyterLab's part of the site: says where the work is, brings it out of the browser and back as one zip, takes in a
// new release, and says what does not work here. Written by hand as what JupyterLab loads: no build.
(() => {
  // --- zip: files stored as they are; read also where another program has packed them
  const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; k += 1) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
    return n;
  });
  const crc32 = (bytes) => {
    let c = 0xffffffff;
    for (const byte of bytes) c = CRC[(c ^ byte) & 255] ^ (c >>> 8);
    return (c ^ 0xffffffff) >>> 0;
  };

  function packed(fields) { // [number, bytes] little-endian, or bytes as they are
    const parts = fields.map((field) => (field instanceof Uint8Array
      ? field : Uint8Array.from({ length: field[1] }, (_, i) => Math.floor(field[0] / 256 ** i) & 255)));
    const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of parts) { whole.set(part, at); at += part.length; }
    return whole;
  }

  function zip(files, now = new Date()) { // {name: text} -> bytes
    const time = (now.getHours() << 11) | (now.getMinutes() << 5) | (now.getSeconds() >> 1);
    const date = ((now.getFullYear() - 1980) << 9) | ((now.getMonth() + 1) << 5) | now.getDate();
    const bodies = [], index = [];
    let at = 0;
    for (const [name, text] of Object.entries(files)) {
      const title = new TextEncoder().encode(name), data = new TextEncoder().encode(text);
      const common = [[20, 2], [0x800, 2], [0, 2], [time, 2], [date, 2], [crc32(data), 4], [data.length, 4], [data.length, 4], [title.length, 2], [0, 2]];
      bodies.push(packed([[0x04034b50, 4], ...common, title, data]));
      index.push(packed([[0x02014b50, 4], [20, 2], ...common, [0, 2], [0, 2], [0, 2], [0, 4], [at, 4], title]));
      at += bodies.at(-1).length;
    }
    const list = packed(index);
    const end = packed([[0x06054b50, 4], [0, 4], [index.length, 2], [index.length, 2], [list.length, 4], [at, 4], [0, 2]]);
    return packed([...bodies, list, end]);
  }

  async function unzip(bytes) { // bytes -> {name: text}
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    let end = bytes.length - 22;
    while (end >= 0 && view.getUint32(end, true) !== 0x06054b50) end -= 1;
    if (end < 0) throw new Error("this is no zip");
    const files = {};
    let at = view.getUint32(end + 16, true);
    for (let n = view.getUint16(end + 10, true); n > 0; n -= 1) {
      const [method, size, title, extra, note] = [10, 20, 28, 30, 32].map((k) => (k === 20 ? view.getUint32(at + k, true) : view.getUint16(at + k, true)));
      const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + title));
      const from = view.getUint32(at + 42, true);
      const start = from + 30 + view.getUint16(from + 26, true) + view.getUint16(from + 28, true);
      let data = new Blob([bytes.subarray(start, start + size)]);
      if (method === 8) data = await new Response(data.stream().pipeThrough(new DecompressionStream("deflate-raw"))).blob();
      if (!name.endsWith("/")) files[name] = await data.text();
      at += 46 + title + extra + note;
    }
    return files;
  }

  // --- what is in the browser, and what the site gave
  const LIST = "coursekit-work.json";
  const text = (content) => `${JSON.stringify(content, null, 1)}\n`;
  const sources = (notebook) => JSON.stringify(notebook.cells.map((cell) => [cell.cell_type, [].concat(cell.source).join("")]));
  const lines = (source) => [].concat(source).join("").split(/(?<=\n)/).filter((line) => line);

  function normalized(notebook) { // sources as lists of lines, as they are stored elsewhere
    return { ...notebook, cells: notebook.cells.map((cell) => ({ ...cell, source: lines(cell.source) })) };
  }

  async function released(root, path) {
    const answer = await fetch(`${root}files/${path.split("/").map(encodeURIComponent).join("/")}`).catch(() => null);
    return answer && answer.ok ? answer.json().catch(() => null) : null;
  }

  async function* notebooks(contents, folder = "") {
    const { content } = await contents.get(folder, { content: true });
    for (const entry of content) {
      if (entry.type === "directory") yield* notebooks(contents, entry.path);
      if (entry.type === "notebook") yield entry.path;
    }
  }

  async function written(contents, root) { // what differs from what the site gave
    const files = {};
    for await (const path of notebooks(contents)) {
      const { content } = await contents.get(path, { content: true, type: "notebook", format: "json" });
      const given = await released(root, path);
      if (!given || sources(given) !== sources(content)) files[path] = normalized(content);
    }
    return files;
  }

  function download(bytes, name) {
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(new Blob([bytes], { type: "application/zip" })), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  }

  // --- the bar at the top
  const STYLE = `#main { top: var(--ck-bar, 34px) !important; }
#ck-bar { position: absolute; inset: 0 0 auto 0; z-index: 9998; display: flex; flex-flow: row wrap; align-items: center; gap: 2px 10px; padding: 4px 10px;
  font: 13px/1.5 var(--jp-ui-font-family, system-ui, sans-serif); color: var(--jp-ui-font-color1); background: var(--jp-layout-color2);
  border-bottom: 1px solid var(--jp-border-color1); box-sizing: border-box; }
#ck-bar button, #ck-bar summary { font: inherit; color: var(--jp-ui-font-color1); background: var(--jp-layout-color1); border: 1px solid var(--jp-border-color1);
  border-radius: 4px; padding: 1px 8px; cursor: pointer; }
#ck-bar details { position: relative; }
#ck-bar details div { position: absolute; right: 0; top: 28px; width: min(30rem, 90vw); padding: 6px 14px; background: var(--jp-layout-color1);
  border: 1px solid var(--jp-border-color1); border-radius: 4px; box-shadow: 0 4px 18px #0004; max-height: 70vh; overflow: auto; }
@media (max-width: 700px) { #ck-bar details { position: static; } #ck-bar details div { inset: auto 10px; width: auto; } }
#ck-bar .ck-state { margin-left: auto; }
.jp-RenderedText pre { word-break: normal !important; overflow-wrap: anywhere; }
@media (max-width: 700px) { .jp-RenderedText pre.ck-columns { white-space: pre; overflow-x: auto; } }
#ck-bar :focus-visible { outline: 2px solid var(--jp-brand-color1); }`;

  const LIMITS = `<p><b>The stop button</b> cannot interrupt Python here. <code>check</code> ends an endless loop by itself. For any other:
<button data-do="again">Restart Python, run the other cells again</button></p>
<p><b>One notebook at a time.</b> Each running one needs several hundred MB; close the kernel of one before you start the next
(menu Kernel, Shut Down).</p>
<p><b>Safari</b> was not tried. Chromium and Firefox were.</p>
<p><b>Grading</b> is not here. Hand in the file that "Save a copy" gives you.</p>
<p><b>A browser may clear its store</b> when the disk is full or when it is told to. A copy outside is safe.</p>`;

  function make(tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    node.append(...children);
    return node;
  }

  function activate(app) {
    const config = JSON.parse(document.getElementById("jupyter-config-data").textContent);
    const root = new URL(config.baseUrl || "./", location.href).href;
    const named = new URLSearchParams(location.search).has("path");
    const contents = app.serviceManager.contents;
    const memory = { get: (name) => localStorage.getItem(`coursekit.${name}.${root}`), set: (name, value) => localStorage.setItem(`coursekit.${name}.${root}`, value) };

    const where = make("span", { class: "ck-where" });
    const state = make("span", { class: "ck-state", role: "status" });
    const news = make("span", { class: "ck-news" });
    const warn = make("b", { class: "ck-warn", role: "status" });
    const save = make("button", { "data-do": "save" }, "Save a copy of all my work");
    const bring = make("button", { "data-do": "bring" }, "Bring work back");
    const file = make("input", { type: "file", accept: ".zip", hidden: "", "aria-label": "a zip saved here before" });
    const limits = make("details", {}, make("summary", {}, "What does not work here"));
    limits.append(make("div"));
    limits.lastChild.innerHTML = LIMITS;
    const bar = make("div", { id: "ck-bar", role: "region", "aria-label": "Where your work is" }, where, save, bring, file, limits, news, warn, state);
    document.head.append(make("style", {}, STYLE));
    document.body.append(bar);
    new ResizeObserver(() => {
      document.documentElement.style.setProperty("--ck-bar", `${bar.offsetHeight}px`);
      dispatchEvent(new Event("resize"));
    }).observe(bar);

    const tell = () => {
      const last = memory.get("saved");
      const when = last ? new Date(last).toLocaleString() : "never";
      where.textContent = `Your work stays in this browser only. Last saved outside the browser: ${when}.`;
    };
    tell();

    const doing = {
      async save() {
        await app.commands.execute("docmanager:save-all");
        const files = await written(contents, root);
        if (!Object.keys(files).length) return say("There is nothing of yours to save yet.");
        const asked = prompt("Your name or student number, for the name of the file:", memory.get("name") || "");
        if (asked === null) return undefined;
        const name = asked.trim().replace(/[^\p{L}\p{N}._-]+/gu, "-") || "me";
        memory.set("name", asked.trim());
        const now = new Date();
        const about = { name: asked.trim(), saved: now.toISOString(), site: root, notebooks: Object.keys(files).sort() };
        const all = { [LIST]: text(about) };
        for (const [path, content] of Object.entries(files)) all[path] = text(content);
        download(zip(all, now), `coursekit-work-${name}.zip`);
        memory.set("saved", now.toISOString());
        tell();
        return say(`Saved: ${about.notebooks.join(", ")}`);
      },
      bring() { file.value = ""; file.click(); },
      async again() {
        limits.open = false;
        const ran = ended();
        round += 1;
        say("Python starts anew");
        await app.shell.currentWidget.context.sessionContext.restartKernel();
        await runAgain(ran);
      },
      resume: () => runAgain(ended()),
      update: () => takeIn(),
    };

    function say(words, name, label) { // and a button, if something can be done
      state.replaceChildren(words, ...(name ? [" ", make("button", { "data-do": name }, label)] : []));
    }

    // --- Python starts anew with each page, and when it is told to: what had run is run again, cell by cell, also after
    // one that fails. A cell that never came to its end has no number and is left out: it may be the endless loop.
    let begun = 0, round = 0; // when the cell that runs was first seen to; which of the rounds of cells goes on
    const session = () => app.shell.currentWidget?.context?.sessionContext?.session;
    const ended = () => [...(app.shell.currentWidget?.content?.widgets || [])].filter(({ model }) => model?.type === "code" && model.executionCount).map(({ model }) => model.id);

    async function runAgain(ids) {
      const { content } = app.shell.currentWidget, { activeCellIndex } = content;
      round += 1;
      const mine = round;
      for (const [k, id] of ids.entries()) {
        say(`Runs again what had run: ${k + 1} of ${ids.length}`);
        begun = 0;
        content.deselectAll();
        content.activeCellIndex = content.widgets.findIndex(({ model }) => model.id === id);
        await app.commands.execute("notebook:run-cell");
        if (round !== mine) return;
      }
      content.activeCellIndex = activeCellIndex;
      say("Python is ready; what had run before has run again.");
    }

    // A notebook that is opened with cells that ran in another Python; one that was closed meanwhile may have its own still.
    const opened = new WeakSet(), lately = new WeakSet(), knows = new Set();
    function meet(context) {
      if (!context || opened.has(context)) return;
      opened.add(context);
      context.ready.then(() => {
        if ([...(context.model.cells || [])].some(({ type, executionCount }) => type === "code" && executionCount)) lately.add(context);
        context.sessionContext.iopubMessage.connect(({ session: { kernel } }, { header }) => {
          if (header.msg_type !== "execute_input") return;
          knows.add(kernel.id);
          if (state.querySelector("[data-do=resume]")) say("");
        });
      });
    }
    function greet(context, kernel) {
      if (!lately.delete(context) || knows.has(kernel.id)) return;
      const before = /^Python/.test(state.textContent) || !state.textContent ? "" : `${state.textContent} `;
      say(`${before}Python knows nothing yet of what ran before.`, "resume", "Run it again");
    }

    const guarded = (act) => Promise.resolve().then(act).catch((error) => say(`That did not work: ${error.message}`));
    bar.addEventListener("click", ({ target }) => {
      const name = target.dataset && target.dataset.do;
      if (doing[name]) guarded(doing[name]);
    });

    async function folder(path) {
      if (!path) return;
      await contents.get(path, { content: false }).catch(async () => {
        const made = await contents.newUntitled({ path: path.split("/").slice(0, -1).join("/"), type: "directory" });
        await contents.rename(made.path, path);
      });
    }

    async function put(path, notebook) {
      await folder(path.split("/").slice(0, -1).join("/"));
      await contents.save(path, { type: "notebook", format: "json", content: notebook });
    }

    // Nothing that is here is lost: what differs goes to a folder named after this minute.
    async function aside(path, content) {
      const minute = new Date().toISOString().slice(0, 16).replace("T", " ").replace(":", ".");
      await put(`earlier ${minute}/${path.split("/").at(-1)}`, content);
    }

    file.addEventListener("change", () => guarded(async () => {
      const files = await unzip(new Uint8Array(await file.files[0].arrayBuffer()));
      const names = Object.keys(files).filter((name) => name.endsWith(".ipynb") && !name.split("/").includes(".."));
      if (!names.length) throw new Error("no notebook is in this file");
      await app.commands.execute("docmanager:save-all");
      const mine = await written(contents, root);
      const documents = names.map((name) => [name, JSON.parse(files[name])]); // all of them can be read, or nothing is done
      for (const [name, document] of documents) {
        if (mine[name] && sources(mine[name]) !== sources(document)) await aside(name, mine[name]);
        await put(name, document);
      }
      sessionStorage.setItem("coursekit.said", `Brought back: ${names.join(", ")}`);
      openAgain();
    }));
    say(sessionStorage.getItem("coursekit.said") || "");
    sessionStorage.removeItem("coursekit.said");

    // --- a new release: what is written stays, the corrected text comes in (coursekit.classroom.merge, in the kernel)
    const mark = (notebook) => ((notebook && notebook.metadata && notebook.metadata.coursekit) || {}).version;

    async function outdated() {
      const found = [];
      for await (const path of notebooks(contents)) {
        if (path.includes("/")) continue;
        const given = await released(root, path);
        const { content } = await contents.get(path, { content: true, type: "notebook", format: "json" });
        if (given && mark(given) && mark(content) !== mark(given)) found.push([path, content, given]);
      }
      return found;
    }

    async function lookForNews() {
      const found = await outdated();
      if (!found.length) return;
      news.replaceChildren(`The course was corrected (${found.map(([path]) => path.slice(0, 2)).join(", ")}); yours is as before. `,
        make("button", { "data-do": "update" }, "Take the corrections in, keep what I wrote"));
    }

    async function takeIn() {
      const { currentWidget } = app.shell;
      const session = currentWidget && currentWidget.context && currentWidget.context.sessionContext.session;
      if (!session || !session.kernel) throw new Error("open a notebook and wait until Python has started");
      await app.commands.execute("docmanager:save-all");
      for (const [path, mine, given] of await outdated()) {
        const code = `import json as _j\nfrom coursekit.classroom.merge import merge as _m\n`
          + `_d, _c = _m(*map(_j.loads, (${JSON.stringify(JSON.stringify(normal(mine)))}, ${JSON.stringify(JSON.stringify(normal(given)))})))\nprint(_j.dumps(_d))`;
        const future = session.kernel.requestExecute({ code, store_history: false });
        let out = "", failed = "";
        future.onIOPub = ({ header, content }) => {
          if (header.msg_type === "stream" && content.name === "stdout") out += content.text;
          if (header.msg_type === "error") failed = `${content.ename}: ${content.evalue}`;
        };
        await future.done;
        if (failed) throw new Error(`${path}: ${failed}`);
        await aside(path, normalized(mine));
        await put(path, normalized(JSON.parse(out)));
      }
      sessionStorage.setItem("coursekit.said", "The corrections are in; what you wrote is kept, and a copy of before lies in the folder \"earlier\".");
      openAgain();
    }
    const normal = (notebook) => ({ ...notebook, cells: notebook.cells.map((cell) => ({ ...cell, source: [].concat(cell.source).join("") })) });

    // --- Python's start, in words; a kernel that fails says it in a log that nobody opens
    function watchStart() {
      const begun = Date.now();
      const timer = setInterval(() => {
        const status = session()?.kernel?.status;
        const seconds = Math.round((Date.now() - begun) / 1000);
        if (status === "idle" || status === "busy") {
          clearInterval(timer);
          setTimeout(keepPages, READS);
          if (/^Python starts/.test(state.textContent)) say("Python is ready.");
          watchRuns();
        } else if (!state.textContent || /^Python starts/.test(state.textContent)) {
          const slow = seconds > 180 ? " This is longer than usual: reload the page, or try another browser." : "";
          say(`Python starts (${seconds} s; the first time about a minute).${slow}`);
        }
      }, 1000);
    }

    // --- a button that cannot do what it says, and a cell that does not end
    const LONG = 20_000, READS = 5_000; // ms
    function watchRuns() {
      const loop = (words) => say(`${words} The stop button cannot interrupt Python here.`, "again", "Restart it, run the other cells again");
      app.commands.commandExecuted.connect((_, { id }) => /interrupt/.test(id) && loop(begun ? "It still runs." : ""));
      setInterval(() => {
        const status = session()?.kernel?.status;
        if (status === "idle") greet(app.shell.currentWidget.context, session().kernel);
        if (status !== "busy") {
          if (begun && state.querySelector("[data-do=again]")) say("Python is ready.");
          begun = 0;
        } else if (!begun) begun = Date.now();
        else if (Date.now() - begun > LONG && !state.querySelector("[data-do=again]")) loop("Python has run for 20 s.");
      }, 1000);
    }

    // --- what is written is kept when the page goes out of sight: a telephone may never come back to it
    document.addEventListener("visibilitychange", () => {
      for (const { context } of document.hidden ? app.shell.widgets("main") : []) if (context?.model?.dirty) context.save();
    });

    // The pages to read are kept, too, for whoever came by them too quickly (page.js waits until they are read).
    function keepPages() {
      navigator.serviceWorker?.register(new URL("../offline.js", root)).catch(() => {}); // without it they need the network
    }

    // A toolbar that still measured its buttons beside the list of files would hide them for good.
    function measureToolbar() {
      const { toolbar } = app.shell.currentWidget || {};
      if (toolbar) toolbar.processMessage({ type: "resize", width: toolbar.node.clientWidth, height: toolbar.node.clientHeight });
    }

    // On a telephone words go on in the next line; columns do not, they would be columns no more.
    function keepColumns() {
      const look = (node) => {
        for (const pre of node.querySelectorAll?.(".jp-RenderedText pre") || []) {
          pre.classList.toggle("ck-columns", (pre.textContent.match(/^.*\S {2,}\S.* {2,}\S.*$/gm) || []).length > 1);
        }
      };
      new MutationObserver((seen) => { for (const { addedNodes } of seen) for (const node of addedNodes) look(node.parentElement || node); })
        .observe(document.getElementById("main") || document.body, { childList: true, subtree: true });
      look(document);
    }

    function onlyOne() { // the lock is held as long as this page lives
      const name = `coursekit ${root}`, forever = new Promise(() => {});
      navigator.locks?.request(name, { ifAvailable: true }, (lock) => {
        if (lock) return forever;
        warn.textContent = "The course is open in another tab, too: write in one of them only.";
        navigator.locks.request(name, () => { warn.textContent = ""; return forever; });
        return undefined;
      });
    }

    // --- a page that is loaded again opens the notebook that was open (JupyterLab takes its name out of the address)
    const path = () => app.shell.currentWidget && app.shell.currentWidget.context && app.shell.currentWidget.context.path;
    const remember = () => {
      if (!/\.ipynb$/.test(path() || "")) return;
      memory.set("open", path());
      meet(app.shell.currentWidget.context);
      app.shell.currentWidget.content.disposed.connect(empty);
    };
    // JupyterLab goes on holding a notebook that was closed, and forgets to dispose of the cells that were not in sight:
    // 7 MB. What is in its cells goes here.
    function empty({ widgets }) {
      for (const cell of widgets || []) {
        cell.dispose();
        for (const part of cell.node.querySelectorAll(".lm-Widget")) part.replaceChildren();
      }
    }
    function openAgain() {
      const last = memory.get("open");
      location.assign(`${root}lab/index.html${last ? `?path=${encodeURIComponent(last)}` : ""}`);
    }
    async function reopen() {
      const last = memory.get("open");
      if (named || !last || [...app.shell.widgets("main")].some((widget) => widget.context)) return;
      await app.commands.execute("docmanager:open", { path: last });
      for (const widget of app.shell.widgets("main")) if (widget.id.startsWith("launcher")) widget.close();
    }

    // Firefox asks the reader, who may not answer: nothing waits for it.
    if (navigator.storage && navigator.storage.persist) navigator.storage.persist().catch(() => {});

    app.restored.then(() => {
      app.shell.currentChanged.connect(remember);
      remember();
      onlyOne();
      watchStart();
      return guarded(reopen).then(() => guarded(lookForNews)).then(() => {
        if (innerWidth > 700) return;
        app.shell.collapseLeft(); // a phone has no room for the list of files
        setTimeout(measureToolbar, 1500);
        keepColumns();
      });
    });
    window.coursekitWork = { zip, unzip }; // for tests
  }

  const plugin = { id: "coursekit-site:work", autoStart: true, activate };
  window._JUPYTERLAB = window._JUPYTERLAB || {};
  window._JUPYTERLAB["coursekit-site"] = { init() {}, get: async () => () => ({ __esModule: true, default: plugin }) };
})();
