// What the pages do: the reader's looks, explorers that load when they come near, formulas, "Run it here".
// Without this script a page still reads: explorers are pictures, formulas are TeX.
(() => {
  const root = document.documentElement;
  const READS = 5_000; // ms: whoever is still here then reads
  root.dataset.script = "";

  // Storage may be forbidden (a page from a folder, a private window): then nothing is remembered.
  const memory = {
    get(name) { try { return localStorage.getItem(`coursekit.${name}`); } catch { return null; } },
    set(name, value) { try { localStorage.setItem(`coursekit.${name}`, value); } catch { /* not remembered */ } },
  };

  // --- looks
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const looks = JSON.parse(memory.get("looks") || "{}");
  const theme = () => looks.theme || (dark.matches ? "dark" : "light");

  function dress() {
    root.dataset.theme = theme();
    root.dataset.font = looks.font || "";
    for (const name of ["size", "lines", "width"]) {
      if (looks[name]) root.style.setProperty(`--${name}`, looks[name]);
      else root.style.removeProperty(`--${name}`);
    }
    for (const frame of document.querySelectorAll(".explorer iframe[src]")) {
      frame.contentWindow.postMessage({ coursekit: "theme", theme: theme() }, "*");
    }
  }
  dress();
  dark.addEventListener("change", dress);

  function chooseLooks(form) {
    for (const choice of form.querySelectorAll("select")) if (looks[choice.name] !== undefined) choice.value = looks[choice.name];
    form.addEventListener("change", (event) => {
      looks[event.target.name] = event.target.value;
      memory.set("looks", JSON.stringify(looks));
      dress();
    });
    form.addEventListener("reset", () => {
      for (const name of Object.keys(looks)) delete looks[name];
      memory.set("looks", "{}");
      dress();
    });
  }

  // --- explorers: each loads when it comes near, and says how high it is
  function loadExplorers() {
    const frames = [...document.querySelectorAll(".explorer iframe")];
    const near = new IntersectionObserver((seen) => {
      for (const { target, isIntersecting } of seen) {
        if (!isIntersecting) continue;
        near.unobserve(target);
        target.src = `${target.dataset.src}#${theme()}`;
      }
    }, { rootMargin: "400px" });
    for (const frame of frames) near.observe(frame);
    addEventListener("message", ({ data, source }) => {
      const frame = frames.find((one) => one.contentWindow === source);
      if (frame && data && data.coursekit === "height") frame.style.height = `${Math.ceil(data.height)}px`;
    });
  }

  // --- "Run it here" needs a server
  function explainFolder() {
    if (location.protocol !== "file:") return;
    const why = "Run it here needs a web server: opened from a folder, a browser lets these pages move but does not let "
      + "them start Python. In this folder,  python3 -m http.server  is one; then open http://localhost:8000";
    for (const link of document.querySelectorAll("a.run")) {
      link.addEventListener("click", (event) => {
        event.preventDefault();
        let said = document.getElementById("folder");
        if (!said) {
          said = Object.assign(document.createElement("p"), { id: "folder", textContent: why });
          said.setAttribute("role", "alert");
        }
        link.closest("nav, p").after(said);
      });
    }
  }

  window.MathJax = {
    AuthorInit() {
      MathJax.Hub.Config({
        tex2jax: { inlineMath: [["$", "$"]], displayMath: [["$$", "$$"]], processEscapes: true, processEnvironments: true },
        "HTML-CSS": { availableFonts: [], webFont: "STIX-Web", imageFont: null, scale: 108, matchFontHeight: false, EqnChunk: 500 },
        "fast-preview": { disabled: true },
        jax: ["input/TeX", "output/HTML-CSS"],
        menuSettings: { zoom: "None" },
        messageStyle: "none",
        showMathMenu: false,
      });
    },
  };

  document.addEventListener("DOMContentLoaded", () => {
    chooseLooks(document.querySelector("#looks form"));
    loadExplorers();
    explainFolder();
  });
  if ("serviceWorker" in navigator && isSecureContext && location.protocol !== "file:") {
    const keep = () => navigator.serviceWorker.register("offline.js").catch(() => {}); // without it the pages need the network
    addEventListener("load", () => setTimeout(keep, READS)); // who runs a notebook at once does not wait for it
  }
})();
