// What points into the picture: a formula, whose parts each have a sentence of what they are now, and small figures.

// Pointing at a node, by mouse, Tab or tap, is told to the picture of its panel: it shows what the word means.
function pointsAt(node, word) {
  const say = (how, what) => node.dispatchEvent(new CustomEvent("ck-point", { bubbles: true, detail: { how, word: what } }));
  const acts = { pointerenter: ["hover", word], pointerleave: ["hover", ""], focusin: ["focus", word], focusout: ["focus", ""] };
  for (const [event, told] of Object.entries(acts)) node.addEventListener(event, () => say(...told));
}

const POINT = "Point at a part, with the mouse, Tab or a tap: the picture shows it.";

function formula(model, el) {
  const lines = element("div", { class: "ck-formula", role: "group", "aria-label": `formula. ${POINT}` });
  const meaning = element("div", { class: "ck-meaning", role: "status" }, POINT);
  const told = latestWord();
  let drawn = "";
  const say = () => {
    const says = model.get("says")[told.word()] || POINT;
    if (meaning.textContent !== says) meaning.textContent = says;
  };
  const written = (text) => { // what follows "^" is raised
    const [base, raised] = text.split("^");
    return raised ? [base, element("sup", {}, raised)] : [base];
  };
  const part = ([text, word]) => {
    if (!word) return element("span", {}, ...written(text));
    const node = operated("button", { type: "button", class: "ck-part" }, ...written(text));
    node.addEventListener("click", () => node.focus()); // not every browser does that
    pointsAt(node, word);
    return node;
  };
  const draw = () => {
    const value = model.get("value");
    el.hidden = !value.length;
    if (drawn !== JSON.stringify(value)) { // else whoever points at a part goes on
      drawn = JSON.stringify(value);
      for (const how of ["hover", "focus"]) lines.dispatchEvent(new CustomEvent("ck-point", { bubbles: true, detail: { how, word: "" } }));
      lines.replaceChildren(...value.map((line) => element("div", {}, ...line.map(part))));
    }
    say();
  };
  lines.addEventListener("ck-point", (/** @type {any} */ { detail }) => {
    told.take(detail);
    say();
  });
  el.append(lines, meaning);
  keepDrawn(model, ["value", "says"], draw);
}

// A small figure for each row of a table: a click chooses it, pointing at it shows it in the picture. `choose(i)`.
function smallFigures(choose) {
  const node = element("div", { class: "ck-figures", role: "group", "aria-label": "the rows of the table as figures" });
  const KINDS = ["ground", "goal", "arm"];
  let buttons = [];
  const make = ({ word }, i) => {
    const button = Object.assign(operated("button", { type: "button", class: "ck-one" }), { onclick: () => choose(i) });
    pointsAt(button, word);
    return button;
  };
  const fill = (button, { lines, name, note }, isChosen) => {
    const says = { none: "does not exist", outside: "outside the limits" }[note] || "";
    const drawing = svg("svg", { viewBox: "0 0 100 76", "aria-hidden": "true" },
      ...lines.map((points, k) => svg("polyline", { points, class: `ck-${KINDS[k] || "fin"}` })));
    button.replaceChildren(drawing, element("span", {}, name), element("span", { class: "ck-note" }, says));
    button.disabled = note === "none";
    button.setAttribute("aria-pressed", isChosen);
    button.classList.toggle("ck-out", Boolean(note));
  };
  return {
    node,
    draw(figures, value) {
      node.hidden = !figures.length;
      if (buttons.length !== figures.length) {
        buttons = figures.map(make);
        node.replaceChildren(...buttons);
      }
      figures.forEach((figure, i) => fill(buttons[i], figure, i === value));
    },
  };
}
