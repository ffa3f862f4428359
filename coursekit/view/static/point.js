// A word that a reader points at, in a formula or at a slider, shows in the picture what it means: what is drawn for it and
// hidden appears, what is translucent becomes almost opaque. The page alone does it; no kernel need answer.

function makePointer(viewer, model, box) {
  const told = latestWord();
  let undo = [];
  const restore = () => {
    undo.reverse().forEach((act) => act());
    undo = [];
  };
  const change = (thing, name, value) => {
    const before = thing[name];
    undo.push(() => (thing[name] = before));
    thing[name] = value;
  };
  const show = () => {
    restore();
    for (const path of model.get("pointers")[told.word()] || []) {
      const { object } = viewer.scene_tree.find(splitPath(path));
      for (let o = object; o; o = o.parent) if (!o.visible) change(o, "visible", true);
      object.traverse((part) => {
        for (const material of [].concat(part.material || [])) {
          if (material.transparent && material.colorWrite) change(material, "opacity", Math.max(material.opacity, 0.8));
        }
      });
    }
    viewer.set_dirty();
  };
  const listen = (/** @type {any} */ { target, detail }) => {
    if (target.closest(".ck-panel") !== box.closest(".ck-panel")) return; // another explorer's
    told.take(detail);
    show();
  };
  document.addEventListener("ck-point", listen);
  return { restore, show, end: () => document.removeEventListener("ck-point", listen) };
}
