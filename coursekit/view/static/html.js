// Small helpers of all: elements, and keys and menus that the notebook must not take for its own.

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}
const element = (tag, attributes = {}, ...children) => filled(document.createElement(tag), attributes, children);
const svg = (tag, attributes, ...children) => filled(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

// JupyterLab and Notebook take arrow keys and letters for themselves, unless an element says no: "d d" deletes a cell.
const own = { "data-lm-suppress-shortcuts": "true" };
const keepKeys = (node) => node.addEventListener("keydown", (event) => event.stopPropagation());

// An event that is ours: neither the browser nor the notebook acts on it.
const take = (event) => { event.preventDefault(); event.stopPropagation(); };

// What a reader operates.
function operated(tag, attributes, ...children) {
  const node = element(tag, { ...own, ...attributes }, ...children);
  keepKeys(node);
  return node;
}

// Draw now, and when one of these changes.
function keepDrawn(model, names, draw) {
  for (const name of names) model.on(`change:${name}`, draw);
  draw();
}

// Act when these change, until what it gives is called.
function listenTo(model, acts) {
  for (const [name, act] of Object.entries(acts)) model.on(`change:${name}`, act);
  return () => Object.entries(acts).forEach(([name, act]) => model.off(`change:${name}`, act));
}

// The word that was pointed at last, of those that still are: by the mouse, by the focus.
function latestWord() {
  const told = new Map();
  return {
    word: () => [...told.values()].at(-1),
    take({ how, word }) {
      told.delete(how); // to the end
      if (word) told.set(how, word);
    },
  };
}

// JupyterLab puts its own class in place of ResizeObserver and never lets go of one, nor of what its callback can see:
// hence a function that sees nothing else, and forgets what it called.
function watchSize(pane, act) {
  let resized = act;
  const observer = new ResizeObserver(() => resized());
  observer.observe(pane);
  return () => {
    observer.disconnect();
    resized = () => {};
  };
}
