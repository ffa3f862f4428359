// The Viewer widget: scene commands, poses and motions from the kernel in; pictures out.

function makeViewer() {
  const commands = new Map(); // key -> bytes of one meshcat command: the whole scene, for views that come later
  const views = new Set();
  let first = null; // the kernel's picture of the scene, which comes before any view
  let early = null; // {stage, pane} made while the kernel still paints that picture

  // From the kernel: commands that are new or changed, and keys that are gone.
  function update(content, buffers) {
    if (content.type === "commands") {
      content.gone.forEach((key) => commands.delete(key));
      content.keys.forEach((key, i) => commands.set(key, bytesOf(buffers[i]).slice()));
      dropEarly();
      for (const view of views) view.change(content.delete, buffers.map(bytesOf));
    }
    if (content.type === "rest") for (const view of views) view.rest(content.frame);
    if (content.type === "png" && !views.size) first = bytesOf(buffers[0]).slice();
    if (content.type === "png") for (const view of views) view.picture(bytesOf(buffers[0]));
  }

  // The first stage of a page is slow without a GPU: it is made, and its shaders are compiled, before it is asked for.
  async function rehearse(model) {
    const MeshCat = await page().meshcat;
    await pause(0);
    if (page().cost || page().views.size || views.size || !commands.size) return;
    const pane = makePane(), stage = makeStage(MeshCat, pane, model.get("quality"));
    early = { pane, stage };
    sendAll(stage.viewer, commands.values());
    await pause(0);
    if (early) stage.rehearse();
  }

  function dropEarly() {
    if (early) early.stage.destroy();
    early = null;
  }

  return {
    initialize({ model }) {
      for (const [key, data] of Object.entries(model.get("commands"))) commands.set(key, bytesOf(data));
      model.on("msg:custom", (content, buffers) => update(content, buffers));
      model.on("change:quality", dropEarly);
      rehearse(model).catch(() => {}); // a view will say what is wrong
      return () => {
        dropEarly();
        commands.clear();
        for (const empty of [{}, {}]) model.set("commands", empty); // twice: a model keeps what it was before, too
      };
    },

    async render({ model, el, signal }) {
      const begun = early, pane = begun ? begun.pane : makePane();
      early = null;
      const buttons = element("div", { ...own, class: "ck-views", role: "group", "aria-label": "views" });
      const box = pane.parentElement;
      box.append(buttons);
      const text = element("div", { class: "ck-text", "aria-live": "polite" });
      const silence = element("div", { class: "ck-silence", role: "status" });
      keepKeys(buttons);
      box.style.height = `${model.get("height")}px`;
      const wait = element("div", { class: "ck-first" }, element("p", { class: "ck-wait" }, "The 3D view is on its way …"));
      box.append(wait);
      const uncover = page().cost ? () => wait.remove() : showFirst(model, pane, wait, views, first);
      first = null;
      el.classList.add("ck-root");
      el.append(box, silence);
      const unwatch = watchKernel(model, silence);

      // --- a motion: the player says which frame, whoever draws it
      /** @type {(k: number) => void} */
      let draw = () => {};
      let wake = () => requestAnimationFrame((now) => { player.tick(now); if (player.playing()) wake(); }); // where no stage draws frames
      const player = makePlayer({
        wake: () => wake(),
        show(k) {
          draw(k);
          const lines = model.get("motion_texts");
          text.textContent = lines.length ? lines[k] : "";
          text.hidden = !lines.length;
        },
        report(k, playing) {
          model.set("frame", k);
          model.set("playing", playing);
          text.setAttribute("aria-live", playing ? "off" : "polite"); // read aloud where it rests, not 30 times a second
          if (!playing) text.textContent = `${text.textContent}`;
          model.save_changes(); // the widgets' own throttle: while the kernel is busy the latest frame waits
        },
      });
      el.append(player.bar, text);

      let MeshCat, stage;
      try {
        MeshCat = await page().meshcat;
        await pause(0); // the picture is shown first, and the stage is built in a task of its own
        if (signal && signal.aborted) {
          if (begun) begun.stage.destroy();
          return uncover();
        }
        stage = begun ? begun.stage : makeStage(MeshCat, pane, model.get("quality"));
      } catch (error) {
        uncover();
        const end = showPicture(model, pane, buttons, views, player, error);
        return () => {
          unwatch();
          end();
          el.replaceChildren();
        };
      }
      const { viewer } = stage;
      const labels = makeLabels(MeshCat.THREE, viewer, pane, stage.renderer);
      const drawGhosts = makeGhosts(MeshCat.THREE, viewer);
      const camera = makeCamera(MeshCat.THREE, viewer, pane);
      const pointer = makePointer(viewer, model, box);
      stage.resized = camera.fit;

      // --- poses: the latest one wins and is drawn once; a motion draws its own
      let moving = [], pose = null; // what moves, and where it stands
      let played = [], poses = null; // what a motion moves, and where, frame after frame
      const place = (paths, floats, k) => {
        paths.forEach((path, i) => {
          const at = 16 * (k * paths.length + i);
          if (at + 16 <= floats.length) viewer.set_transform(path, floats.subarray(at, at + 16));
        });
        stage.moved();
      };
      let slid = false, late = null;
      const follower = makeFollower(model, () => {
        player.load(null); // a hand on a slider ends a motion
        slid = true;
        stage.moved();
      });
      const handles = makeHandles(MeshCat.THREE, viewer, pane, stage.renderer, model, follower, {
        taken(what, isGuess) {
          if (!isGuess) player.load(null);
          if (what === "theta") return stage.moved();
          if (model.get("reaching").goal === what) { // the frame brings all of it along
            stage.moved();
            return stage.now();
          }
          handles.place();
          handles.draw(); // the rest waits for the kernel's answer, which would wait for a frame of the target alone
          late = late || setTimeout(stage.moved, 100);
        },
        moved: stage.moved,
        redraw: () => viewer.set_dirty(),
      });
      wake = stage.wake;
      draw = (k) => {
        place(played, poses, k);
        const thetas = model.get("motion_theta"); // of a page without a kernel, which would put the sliders there
        if (thetas) follower.put(thetas[k]);
      };
      stage.playing = player.playing;
      stage.beforeFrame.push((now) => {
        if (pose) place(moving, pose, 0);
        if ((pose || slid) && follower.isAhead()) place(...follower.pose(), 0);
        else if (pose && player.loaded()) place(played, poses, player.frame()); // further than the kernel knows
        handles.place();
        pose = null;
        slid = false;
        player.tick(now);
      });
      stage.afterFrame.push(() => labels.place(handles.draw()), uncover);

      const onPose = () => {
        moving = model.get("moving").map(splitPath);
        if (model.get("frame") >= 0) player.follow(model.get("frame"));
        else text.hidden = true;
        follower.compare();
        pose = floatsOf(model.get("pose"));
        stage.moved();
        if (late) Promise.resolve().then(stage.now); // the answer to a hand: once the rest of it is known, too
        clearTimeout(late);
        late = null;
      };
      const onMotion = (at) => {
        poses = floatsOf(model.get("motion_poses"));
        played = (model.get("motion").moving || []).map(splitPath);
        text.hidden = true;
        player.load(model.get("motion"), at); // or nothing, where there is none any more
        onPose();
      };
      const onGhosts = () => {
        drawGhosts(model.get("ghosts"));
        onPose();
        pointer.show();
      };
      const onLabels = () => {
        labels.set(model.get("labels"));
        viewer.set_dirty();
      };
      const onCamera = () => {
        camera.lens(model.get("camera"));
        offerViews(model, buttons, (_, where) => camera.show(where));
        if (model.get("camera").position) camera.show(model.get("camera"));
      };
      const onText = () => pane.setAttribute("aria-label", model.get("description"));
      takeKeys(pane, camera, player, () => camera.show(model.get("camera")));

      const view = {
        change(deleted, buffers) {
          pointer.restore();
          for (const path of deleted) viewer.delete_path(splitPath(path));
          sendAll(viewer, buffers);
          if (model.get("ghosts").length) drawGhosts(model.get("ghosts")); // their geometry may have been replaced
          onPose(); // what was drawn anew stands at the origin until it is placed
          pointer.show();
        },
        picture() {},
        rest: player.step,
      };
      viewer.set_3d_pane_size();
      view.change([], begun ? [] : [...commands.values()]);
      onLabels();
      onCamera();
      onText();
      onPose();
      const waits = model.get("playing") && model.get("frame") === 0; // the motion came before there was a view
      onMotion(waits ? null : Math.max(0, model.get("frame")));
      views.add(view);

      const deafen = listenTo(model, { pose: onPose, theta: onPose, moving: onPose, frame: onPose, labels: onLabels, ghosts: onGhosts, camera: onCamera, description: onText,
        heard: () => follower.isAhead() && onPose(), motion: () => onMotion(null), height: () => (box.style.height = `${model.get("height")}px`) });
      box.coursekit = { stage, viewer, player, follower, handles, page: page() }; // for the browser's console and the tests

      return () => { // the notebook keeps `el` and `model` of what is long gone: nothing may hang on them
        deafen();
        unwatch();
        follower.end();
        handles.end();
        pointer.end();
        uncover();
        delete box.coursekit;
        el.replaceChildren();
        views.delete(view);
        stage.destroy();
      };
    },
  };
}

function makePane() {
  const pane = element("div", { ...own, class: "ck-pane", tabindex: 0, role: "group", "aria-roledescription": "3D view",
    title: "drag: turn (on a link: its joint), right drag: move, wheel after a click: zoom; keys: arrows, + and -, Home, Ctrl+Z" });
  pane.addEventListener("contextmenu", take); // the right button moves the picture
  element("div", { class: "ck-viewer" }, pane);
  return pane;
}

function sendAll(viewer, commands) {
  for (const bytes of commands) {
    try {
      viewer.handle_command_bytearray(bytes);
    } catch (error) {
      console.error("[coursekit] a command of the scene failed", error); // and the rest is drawn all the same
    }
  }
}

// The pane's own keys.
function takeKeys(pane, camera, player, home) {
  const acts = {
    ArrowLeft: () => camera.turn(-0.1, 0), ArrowRight: () => camera.turn(0.1, 0),
    ArrowUp: () => camera.turn(0, -0.1), ArrowDown: () => camera.turn(0, 0.1),
    "+": () => camera.turn(0, 0, 0.9), "-": () => camera.turn(0, 0, 1.1), Home: home, " ": player.toggle,
  };
  pane.addEventListener("keydown", (event) => {
    if (!acts[event.key] || event.ctrlKey || event.metaKey) return;
    take(event);
    acts[event.key]();
  });
}

// The first view of a page waits for its script and its shaders: meanwhile the kernel's own picture stands over the pane.
// Gives what takes it away, once there is something better.
function showFirst(model, pane, cover, views, drawn) {
  const view = {
    change() {}, rest() {}, // nothing to draw yet
    picture(bytes) {
      const image = element("img", { class: "ck-cover", alt: "" });
      image.onload = () => URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
      cover.replaceChildren(image);
    },
  };
  views.add(view);
  if (drawn) view.picture(drawn);
  else model.send({ type: "need_png", width: pane.clientWidth || 640, height: pane.clientHeight || 420 });
  return () => {
    views.delete(view);
    cover.remove();
  };
}

function offerViews(model, buttons, choose) {
  buttons.replaceChildren(...Object.entries(model.get("views")).map(([name, where]) => Object.assign(
    element("button", { ...own, type: "button", class: "ck-button", title: `${name} view` }, name), { onclick: () => choose(name, where) })));
}

// No WebGL, or a policy that forbids the bundle: the picture the kernel draws, renewed at most twice a second.
function showPicture(model, pane, buttons, views, player, error) {
  const image = element("img", { class: "ck-picture", alt: model.get("description") });
  const reason = /WebGL/i.test(error.message) ? "this browser has no WebGL" : error.message;
  pane.replaceChildren(image, element("p", { class: "ck-wait" }, `A still picture in place of the 3D view: ${reason}.`));
  let timer = null, seenFrom = "home";
  const ask = () => {
    timer = timer || setTimeout(() => {
      timer = null;
      model.send({ type: "need_png", view: seenFrom, width: pane.clientWidth || 640, height: pane.clientHeight || 420 });
    }, 500);
  };
  const view = {
    change: ask,
    rest: player.step,
    picture(bytes) {
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
      image.alt = model.get("description");
      if (buttons.firstChild) return;
      offerViews(model, buttons, (name) => { // once it is known that a kernel draws
        seenFrom = name;
        ask();
      });
    },
  };
  const onMotion = () => player.load(model.get("motion"));
  views.add(view);
  const deafen = listenTo(model, { pose: ask, motion: onMotion });
  onMotion();
  ask();
  return () => {
    clearTimeout(timer);
    deafen();
    views.delete(view);
  };
}

// The kernel answers every change of a control. Where it does not, because it is busy, restarted or gone, somebody has
// to say so: sliders go on moving.
function watchKernel(model, line) {
  const PATIENCE = 2500; // milliseconds
  let timer = null, over = false, forget = () => {};
  const asked = () => {
    timer = timer || setTimeout(() => {
      line.textContent = "The kernel does not answer: it is busy, was restarted or is gone. "
        + "Numbers and plots are those of before; run the cell again if it stays so.";
    }, PATIENCE);
  };
  const answered = () => {
    clearTimeout(timer);
    timer = null;
    line.textContent = "";
  };
  const deafen = listenTo(model, { answers: answered, dragged: asked });
  childModels(model, model.get("controls") || []).then((controls) => {
    if (over) return;
    for (const control of controls) control.on("change:touched", asked);
    forget = () => controls.forEach((control) => control.off("change:touched", asked));
  });
  return () => {
    over = true;
    answered();
    forget();
    deafen();
  };
}

// The models behind references to widgets; null stays null.
function childModels(model, ids) {
  return Promise.all(ids.map((id) => id && model.widget_manager.get_model(id.replace("IPY_MODEL_", ""))));
}
