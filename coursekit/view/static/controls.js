// The controls and read-outs of an explorer, in plain HTML so that keyboard and screen reader work as everywhere. A value is
// sent only when a person changes it, never when a control is drawn, so drawing cannot disturb what the kernel has set.

// A name for the page's only element of this kind: a counter would not do where two versions of the course are in a page.
const unique = (kind) => `ck-${kind}-${Math.random().toString(36).slice(2)}`;

// What a person has changed in the page, and what it was before: Ctrl+Z puts it back, gesture by gesture.
const places = new WeakMap(); // control -> where it stands
let past = []; // the latest last
const remember = (control, place = places.get(control)) => (past = [...past.slice(-199), { control, place, value: control.get("value"), when: performance.now() }]);
document.addEventListener("keydown", (event) => {
  const node = /** @type {any} */ (event.target), panel = node.closest?.(".ck-panel, .ck-page");
  if (!panel || node.ckEdited || event.key !== "z" || !(event.ctrlKey || event.metaKey)) return;
  take(event);
  const here = past.filter(({ place }) => panel.contains(place)), last = here.at(-1)?.when;
  const gesture = here.filter(({ when }) => last - when < 50).reverse(); // all numbers of a vector are one
  past = past.filter((one) => !gesture.includes(one));
  for (const { control, value } of gesture) tell(control, { value }, false);
}, true);
// Ctrl+C on the slider of a joint: theta, as numpy has it.
document.addEventListener("copy", (event) => {
  const slider = document.activeElement?.closest(".ck-range"), panel = slider?.closest(".ck-panel, .ck-page");
  const joints = [...(panel?.querySelectorAll(".ck-slider") || [])].filter((row) => row.textContent?.startsWith("θ"));
  if (!joints.some((row) => row.contains(slider))) return;
  const values = joints.map((row) => ({ value: Number(row.querySelector("input")?.value), turns: row.querySelector(".ck-unit")?.textContent === "deg" }));
  const all = values.every(({ turns }) => turns) ? `np.radians([${values.map(({ value }) => value).join(", ")}])`
    : `np.array([${values.map(({ value, turns }) => (turns ? `np.radians(${value})` : value / 1000)).join(", ")}])`;
  event.clipboardData?.setData("text/plain", all);
  event.preventDefault();
  slider.closest(".ck-slider").querySelector(".ck-hint").textContent = `copied: ${all}`;
});

// A person has changed this control: the kernel is told, and whoever listens in the page.
function tell(model, changes = {}, isNew = true) {
  if (isNew && "value" in changes && !model.get("live")) remember(model);
  for (const [name, value] of Object.entries(changes)) model.set(name, value);
  model.set("touched", model.get("touched") + 1);
  model.save_changes();
}

const trim = (value, digits) => String(Number(value.toFixed(digits)) + 0); // "+ 0": never "-0"

// Labels of a column are equally wide, so that what stands beside them is, too.
const leaveRoom = (row, model) => row.style.setProperty("--ck-letters", model.get("wide") || 0);

function slider(model, el) {
  let draw = () => {};
  keepDrawn(model, ["shape"], () => (draw = buildSlider(model, el))); // another robot: other limits
  for (const name of ["value", "bands"]) model.on(`change:${name}`, () => draw());
}

function buildSlider(model, el) {
  const id = unique("slider");
  const [min, max, step] = ["min", "max", "step"].map((name) => model.get(name));
  const label = model.get("label"), unit = model.get("unit"), digits = model.get("digits");
  const spoken = { deg: "degrees", mm: "millimetres", m: "metres" }[unit] || unit;
  const range = operated("input", { id, type: "range", role: "slider", class: "ck-range", min, max, step: "any",
    "aria-valuemin": min, "aria-valuemax": max });
  // not of type "number": that would drop the comma of 12,5 without a word
  const box = operated("input", { type: "text", inputmode: "decimal", autocomplete: "off", class: "ck-number",
    "aria-label": `${label}, ${spoken}`, title: "a number, also pi/2 or 0.3 rad; a pasted vector fills the boxes from here on" });
  const hint = element("div", { class: "ck-hint", role: "alert" });
  const name = element("label", { class: "ck-name", for: id }, label);
  const ends = element("div", { class: "ck-ends", "aria-hidden": "true" });
  const bands = element("div", { class: "ck-bands", "aria-hidden": "true" });
  const says = element("span", { class: "ck-spoken", id: `${id}-says` });
  const track = element("div", { class: "ck-track" }, range, bands, ends, says);
  const row = element("div", { class: "ck-slider" }, name, track, box, element("span", { class: "ck-unit" }, unit), hint);
  leaveRoom(row, model);
  pointsAt(row, model.get("word"));
  el.replaceChildren(row);

  // The limits of the joint, marked where they are: at the ends, or inside when the slider goes beyond them.
  const limits = model.get("limits");
  const at = (value) => (100 * (value - min)) / (max - min || 1);
  for (const value of limits.length ? limits : [min, max]) {
    const mark = element("span", { class: limits.length ? "ck-mark ck-limit" : "ck-mark" }, trim(value, max - min < 10 ? 2 : 0));
    mark.style.left = `${at(value)}%`;
    if (limits.length) mark.title = "joint limit";
    ends.append(mark);
  }

  // Where the target can be reached while the other sliders stay: a line; inside the joint limits: a bar upon it.
  let banded = null;
  const drawBands = () => {
    banded = model.get("bands");
    const bar = ([low, high], i) => {
      const node = element("span", { class: `ck-band ${i ? "ck-inside" : ""}` });
      node.style.cssText = `left: ${at(low)}%; width: ${at(high) - at(low)}%`;
      return node;
    };
    const runs = (list) => list.map(([low, high]) => {
      const ends = [low, high].map((end) => trim(end, 0));
      return ends[0] === ends[1] ? `at ${ends[0]}` : `from ${ends[0]} to ${ends[1]}`;
    }).join(" and ") || "nowhere";
    bands.replaceChildren(...banded.flatMap((list, i) => list.map((run) => bar(run, i))));
    const [all, kept] = banded.map(runs);
    says.textContent = track.title = all === kept ? `reachable ${all} ${spoken}, inside the joint limits`
      : `reachable ${all} ${spoken}; inside the joint limits ${kept}`;
    range.setAttribute("aria-describedby", says.id);
  };

  let dragging = false;
  const draw = () => {
    const known = model.get("bands");
    if (known && known.length && known !== banded) drawBands();
    const value = model.get("value");
    if (!dragging) range.value = value;
    range.setAttribute("aria-valuenow", trim(value, digits));
    const outside = limits.length && (value < limits[0] - 1e-9 || value > limits[1] + 1e-9);
    range.setAttribute("aria-valuetext", `${trim(value, digits)} ${spoken}${outside ? ", outside the joint's limits" : ""}`);
    row.classList.toggle("ck-outside", Boolean(outside));
    if (!box.ckEdited) box.value = trim(value, digits);
  };
  const send = (value, live) => {
    const inside = Math.min(max, Math.max(min, value));
    hint.textContent = "";
    tell(model, { value: Number(inside.toPrecision(15)), live });
    draw();
  };

  const stepBy = (jump, event) => {
    event.preventDefault();
    send(Number((model.get("value") + jump * (event.shiftKey ? step / 10 : step)).toFixed(9)), event.repeat);
  };

  range.addEventListener("pointerdown", () => (dragging = true));
  range.addEventListener("input", () => {
    const value = Number(range.value);
    send(value - min < 1e-9 || max - value < 1e-9 ? value : Math.round(value / step) * step, true);
  });
  range.addEventListener("change", () => { dragging = false; send(model.get("value"), false); });
  range.addEventListener("keydown", (event) => {
    const jump = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (jump || event.key === "Home" || event.key === "End") stepBy(jump || (event.key === "Home" ? -Infinity : Infinity), event);
  });
  range.addEventListener("keyup", () => model.get("live") && send(model.get("value"), false));
  box.addEventListener("input", () => (box.ckEdited = true));
  const fill = (text) => { // a vector: this box and those after it take its numbers, as if each were typed there
    const vector = readVector(text), all = [...el.closest(".ck-panel").querySelectorAll(".ck-number")], boxes = all.slice(all.indexOf(box));
    if (!vector || vector.length > boxes.length) return false;
    vector.forEach((number, i) => Object.assign(boxes[i], { value: number, ckEdited: true }).dispatchEvent(new Event("change")));
    if (/\d$/.test(vector[0]) && !hint.textContent) hint.textContent = `${vector.length} numbers, in the units shown here`;
    return true;
  };
  box.addEventListener("paste", (event) => fill(event.clipboardData.getData("text")) && event.preventDefault());
  box.addEventListener("change", () => {
    if (!box.ckEdited || fill(box.value)) return; // taken back by Escape, or told to all
    const { value, error } = readNumber(box.value, unit);
    box.ckEdited = false;
    if (error) draw();
    else send(value, false);
    const end = value < min ? min : max;
    if (error || value < min || value > max) hint.textContent = error || `${trim(value, digits)} is beyond the ${limits.includes(end) ? "limit" : "end"}, ${trim(end, digits)} ${unit}`;
  });
  box.addEventListener("keydown", (event) => {
    const jump = { ArrowUp: 1, ArrowDown: -1, Escape: 0 }[event.key];
    if (jump === undefined) return;
    box.ckEdited = false;
    return jump ? stepBy(jump, event) : draw();
  });
  name.title = `double click: reset; Ctrl+Z: take back${label.startsWith("θ") ? "; Ctrl+C: copy theta as numpy" : ""}`;
  name.addEventListener("dblclick", () => send(model.get("start"), false));
  draw();
  return draw;
}

function choice(model, el) {
  const select = operated("select", { class: "ck-select" });
  const draw = () => {
    select.replaceChildren(...model.get("options").map((text) => element("option", { value: text }, text)));
    select.value = model.get("value");
  };
  select.addEventListener("change", () => tell(model, { value: select.value }));
  const row = element("label", { class: "ck-choice" }, element("span", { class: "ck-name" }, model.get("label")), select);
  leaveRoom(row, model);
  el.append(row);
  keepDrawn(model, ["value", "options"], draw);
}

function toggle(model, el) {
  const box = operated("input", { type: "checkbox" });
  box.addEventListener("change", () => tell(model, { value: box.checked }));
  el.append(element("label", { class: "ck-toggle" }, box, element("span", {}, model.get("label"))));
  keepDrawn(model, ["value"], () => (box.checked = model.get("value")));
}

function action(model, el) {
  const button = operated("button", { type: "button", class: "ck-button" }, model.get("label"));
  button.onclick = () => { model.send({ type: "press" }); tell(model); };
  el.append(button);
}

// Text that changes with the pose. Shown at once; read aloud only when it has come to rest.
function text(model, el) {
  const shown = element("div", { class: "ck-text", "aria-hidden": "true" }); // a screen reader gets the other copy, once
  const spoken = element("div", { class: "ck-spoken", role: "status", "aria-live": "polite" }, model.get("value"));
  let timer = null;
  const draw = () => {
    shown.style.minHeight = `${shown.offsetHeight}px`; // what is below goes up when they rest, not while a slider moves
    const parts = model.get("value").split(/(\([^()]*\)|\S+-\S+)/); // no line ends within a vector that fits on one, nor after a hyphen
    shown.replaceChildren(...parts.map((part, i) => (i % 2 ? element("span", { class: "ck-whole" }, part) : part)));
    clearTimeout(timer);
    timer = setTimeout(() => {
      spoken.textContent = model.get("value");
      shown.style.minHeight = "";
    }, 600);
  };
  el.append(shown, spoken);
  keepDrawn(model, ["value"], draw);
}

function table(model, el) {
  const body = element("tbody"), head = element("thead");
  const caption = element("caption", {}, model.get("label"));
  const group = unique("table"), figures = smallFigures((i) => tell(model, { value: i }));
  const draw = () => {
    const focused = document.activeElement && body.contains(document.activeElement);
    const selectable = model.get("selectable"), value = model.get("value");
    figures.draw(model.get("figures"), value);
    const titles = model.get("header").map((title) => element("th", { scope: "col" }, title));
    head.replaceChildren(element("tr", {}, ...(selectable ? [element("th", { scope: "col" }, element("span", { class: "ck-spoken" }, "choose"))] : []), ...titles));
    body.replaceChildren(...model.get("rows").map((row, i) => {
      const line = element("tr", i === value ? { class: "ck-chosen" } : {}, ...row.map((cell) => element("td", {}, cell)));
      if (selectable) {
        const radio = operated("input", { type: "radio", name: group, "aria-label": `choose ${row[0]}` });
        radio.checked = i === value;
        radio.addEventListener("change", () => tell(model, { value: i }));
        line.prepend(element("td", {}, radio));
        if (focused && i === value) setTimeout(() => radio.focus());
      }
      return line;
    }));
  };
  el.append(figures.node, element("div", { class: "ck-scroll" }, element("table", { class: "ck-table" }, caption, head, body)));
  keepDrawn(model, ["rows", "header", "value", "figures"], draw);
}

// A figure in the page's own ink, and marks over it, which move without it.
function plot(model, el) {
  const drawing = element("div", { role: "img" }), marks = element("div", { class: "ck-marks", "aria-hidden": "true" });
  const frame = element("div", { class: "ck-plot" }, drawing, marks);
  const numbers = element("table", { class: "ck-table" }), caption = element("figcaption");
  const fold = element("summary", own, "numbers of this plot");
  const details = element("details", {}, fold, element("div", { ...own, class: "ck-scroll", tabindex: 0 }, numbers));
  const draw = () => {
    drawing.innerHTML = model.get("svg").replace(/( id="|url\(#|href="#)/g, `$1${unique("plot")}-`); // every view has its own names
    drawing.setAttribute("aria-label", model.get("alt"));
    caption.textContent = model.get("caption");
    const [title, ...rows] = model.get("numbers");
    details.hidden = !title;
    numbers.replaceChildren(element("caption", {}, ...(title || [])), ...rows.map((row, i) => (
      element("tr", {}, ...row.map((cell) => (i ? element("td", {}, cell) : element("th", { scope: "col" }, cell)))))));
  };
  const place = () => {
    const cursor = model.get("cursor");
    marks.replaceChildren(...cursor.map(([x, low, high]) => element("span", { class: high > low ? "ck-across" : "ck-spot",
      style: `left: ${100 * x}%; bottom: ${100 * low}%; height: ${100 * (high - low)}%` })));
  };
  let timer = null;
  const fit = () => { // where there is less room the kernel draws a smaller figure, with letters as large
    const room = frame.clientWidth;
    if (room > 200 && room !== model.get("room")) tell(model, { room });
  };
  frame.style.width = `${model.get("width")}px`;
  if (model.get("clickable")) takeHands(model, frame);
  if (model.get("walkable")) takeArrows(model, frame);
  keepKeys(details);
  el.append(element("figure", { class: "ck-figure" }, frame, caption, details));
  keepDrawn(model, ["svg"], draw);
  keepDrawn(model, ["cursor"], place);
  return watchSize(frame, () => {
    clearTimeout(timer);
    timer = setTimeout(fit, 200);
  });
}

// A click on a plot, or a drag: from anywhere by the mouse, by touch from a mark alone, since a swipe scrolls the page.
function takeHands(model, frame) {
  let held = null; // "drag" or, until the finger leaves, "tap"
  const point = (event, live) => {
    const area = frame.getBoundingClientRect(); // fractions from its lower left corner
    const x = (event.clientX - area.left) / area.width, y = 1 - (event.clientY - area.top) / area.height;
    tell(model, { pointed: { x, y, live, count: model.get("touched") } });
  };
  frame.classList.add("ck-clickable");
  frame.addEventListener("pointerdown", (event) => {
    if (event.button || !event.isPrimary) return;
    held = event.pointerType !== "touch" || event.target.closest(".ck-spot") ? "drag" : "tap";
    if (held === "drag") frame.setPointerCapture(event.pointerId);
  });
  frame.addEventListener("pointermove", (event) => held === "drag" && point(event, true));
  frame.addEventListener("pointerup", (event) => { if (held) point(event, false); held = null; });
  frame.addEventListener("pointercancel", () => {
    if (held === "drag") tell(model, { pointed: { ...model.get("pointed"), live: false } });
    held = null;
  });
}

function takeArrows(model, frame) {
  const help = "arrow keys move the arm on this map, with Shift in small steps";
  filled(frame, { ...own, tabindex: 0, role: "application", "aria-roledescription": "map", "aria-label": help, title: help }, []);
  keepKeys(frame);
  frame.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const [dx, dy] = way.map((d) => (event.shiftKey ? d / 5 : d));
    model.send({ type: "step", dx, dy });
  });
}

const makers = { slider, choice, toggle, action, text, table, plot, formula };

const makeControl = (kind) => ({
  render({ model, el }) {
    el.classList.add("ck-control");
    places.set(model, el);
    const end = makers[kind](model, el) || (() => {});
    return () => {
      end();
      el.replaceChildren();
      past = past.filter(({ place }) => place !== el);
    };
  },
});
