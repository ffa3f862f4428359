// The arm follows its sliders here, in the next frame, before the kernel has answered and also where there is none. When
// the kernel speaks of the same sliders, its pose is drawn and no longer ours.

const touchesOf = (sliders) => sliders.reduce((sum, slider) => sum + (slider ? slider.get("touched") : 0), 0);
function makeFollower(model, moved) {
  let sliders = [], ahead = false, over = false;
  const touched = () => {
    ahead = true;
    moved();
  };
  const forget = () => sliders.forEach((slider) => slider && slider.off("change:touched", touched));
  const listen = async () => {
    const found = await childModels(model, model.get("drive").sliders || []);
    if (over) return; // closed meanwhile: nothing may hang on the sliders
    forget();
    sliders = found;
    ahead = false;
    sliders.forEach((slider) => slider && slider.on("change:touched", touched));
  };
  // What a hand in the picture has made of these sliders, or null, until the kernel has taken it over, whose word is of an
  // earlier moment, or a person has touched a slider since (an answer to a touch of before may lower the count).
  const hand = (what, sliders) => {
    const told = model.get("dragged") || {};
    return told.what === what && told.count > model.get("heard") && told.touched >= touchesOf(sliders) ? told.values : null;
  };
  // Joint values in radians and metres: of the hand or the sliders, and of the kernel for the joints that have none.
  const theta = () => {
    const { per } = model.get("drive"), known = model.get("theta"), held = hand("theta", sliders);
    return sliders.map((slider, k) => (slider ? (held ? held[k] : slider.get("value")) / per[k] : known[k]));
  };
  const deafen = listenTo(model, { drive: () => (ready = listen()) });
  let ready = listen();
  return {
    ready: () => ready, // the sliders are known
    sliders: () => sliders,
    hand,
    theta,
    isAhead: () => ahead,
    // a pose of the kernel is there: does it speak of what the sliders say now?
    compare() {
      const known = model.get("theta");
      if (ahead && theta().every((q, k) => Math.abs(q - known[k]) < 1e-9)) ahead = false;
    },
    // paths of the links, and of what shows the Jacobian; 16 numbers for each
    pose() {
      const arm = model.get("drive"), D = displacements(arm.screws, theta());
      const all = { ...Object.fromEntries(D.map((T, k) => [`${arm.path}/${k + 1}`, T])), ...shapesOf(arm, D) };
      return [Object.keys(all).map(splitPath), new Float64Array(Object.values(all).flat())];
    },
    // the sliders go where a motion is, in pages where no kernel puts them there
    put: (values) => sliders.forEach((slider, k) => slider && slider.set("value", values[k] * model.get("drive").per[k])),
    end() {
      over = true;
      forget();
      deafen();
    },
  };
}
