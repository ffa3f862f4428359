// A widget's own script: short, since a browser never lets a module go. It waits for the one that all share, and asks for the
// widget that brings it, since some pages know only what is asked for.
globalThis["@key@"] ??= Promise.withResolvers();
let widget;
export default {
  async initialize(given) {
    given.model.widget_manager.get_model(given.model.get("script").replace("IPY_MODEL_", "")).catch(() => {});
    widget = (await globalThis["@key@"].promise)(given.model.get("kind"));
    return widget.initialize?.(given);
  },
  render: (given) => widget.render(given),
};
