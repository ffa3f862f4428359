// A widget's own script: short, since a browser never lets a module go. It waits for the one that all share, and asks for the
// widget that brings it, since some pages know only what is asked for.
globalThis["@key@"] ??= Promise.withResolvers();
let made;
export default {
  initialize(given) {
    given.model.widget_manager.get_model(given.model.get("script").replace("IPY_MODEL_", "")).catch(() => {});
    made = globalThis["@key@"].promise.then((make) => make(given.model.get("kind")));
    const viewer = given.model.get("kind") === "viewer"; // which hears messages before it is shown
    return viewer ? made.then((widget) => widget.initialize(given)) : undefined; // anywidget's patience is short
  },
  render: async (given) => (await made).render(given),
};
