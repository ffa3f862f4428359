// What a hand can take hold of in the picture: arrows and rings at a target, a point, the tool, the links. By mouse,
// touch and keys. They are HTML over the picture, so that they are found by Tab and by a screen reader, and cost no frame.
//
// A grip moves its point by one number; where the pointer goes, that number follows: along the way of the point on the
// screen. All of it ends in sliders, as if a person had moved those, and reaches the kernel as one message.

const ARROW = 88, RING = 48, EDGE = 16, NEAR = 1e-5; // pixels; and metres and radians, where an arm is at its target

// How far a handle gives way, in pixels: to each that it would lie under, by the shortest way.
const asideOf = (x, y, wide, others) => others.reduce(([dx, dy], other) => {
  const [right, down] = [x + dx - other.x, y + dy - other.y];
  const [across, along] = [(wide + other.wide) / 2 - Math.abs(right), 26 - Math.abs(down)];
  if (across <= 0 || along <= 0) return [dx, dy];
  return across < along ? [dx + (right < 0 ? -across : across), dy] : [dx, dy + (down < 0 ? -along : along)];
}, [0, 0]);

// taken(what, isPoint): a hand has moved "theta" or the target at a path; moved(): its sliders did; redraw(): handles changed
function makeHandles(THREE, viewer, pane, renderer, model, follower, { taken, moved, redraw }) {
  const layer = element("div", { class: "ck-handles", role: "group", "aria-label": "handles in the picture" });
  const lines = svg("svg", { "aria-hidden": "true" });
  layer.append(lines);
  pane.append(layer);
  let targets = [], grips = [], over = false, puts = false, ways = []; // targets: each with its sliders; ways: arms brought along

  // --- from metres to pixels: a point of the space frame on the screen
  const point = new THREE.Vector3(), eye = new THREE.Vector3();
  const project = (p) => {
    const { width, height } = renderer.size();
    viewer.scene_tree.find(["ck"]).object.localToWorld(point.set(...p)).project(viewer.camera);
    return [((point.x + 1) / 2) * width, ((1 - point.y) / 2) * height, point.z];
  };
  const perMetre = (p) => { // pixels
    const { height } = renderer.size();
    const far = viewer.scene_tree.find(["ck"]).object.localToWorld(point.set(...p)).distanceTo(eye.setFromMatrixPosition(viewer.camera.matrixWorld));
    return height / 2 / Math.tan((Math.PI / 360) * viewer.camera.fov) / far;
  };
  // An arrow from p along `way`, in metres: shorter where its end would leave the picture.
  const arrowFrom = (p, way) => {
    const { width, height } = renderer.size(), long = ARROW / perMetre(p);
    const a = project(p), b = project(p.map((x, i) => x + long * way[i]));
    const parts = [width, height].map((end, i) => (b[i] > a[i] ? end - EDGE - a[i] : a[i] - EDGE) / Math.abs(b[i] - a[i]));
    return long * Math.max(0.3, Math.min(1, ...parts.filter((part) => part > 0)));
  };
  // How far a number must go so that point p, which moves by `way` metres for 1, follows the pointer by (dx, dy) pixels.
  const follow = (p, way, dx, dy) => {
    const size = 1e-3, a = project(p), b = project(p.map((x, i) => x + size * way[i]));
    const sx = (b[0] - a[0]) / size, sy = (b[1] - a[1]) / size;
    return (dx * sx + dy * sy) / Math.max(sx * sx + sy * sy, (0.15 * perMetre(p) * Math.hypot(...way)) ** 2, 1e-9);
  };

  // --- sliders: set here at once, and told to the kernel in one message, of which the latest wins
  const put = (what, sliders, values, live) => {
    puts = true; // who calls decides when it is drawn
    if (!model.get("dragged")?.live) sliders.forEach((slider) => slider && remember(slider, pane));
    values.forEach((value, k) => {
      if (!sliders[k]) return;
      const inside = Math.min(sliders[k].get("max"), Math.max(sliders[k].get("min"), value));
      sliders[k].set("value", Number(inside.toPrecision(15)));
      sliders[k].set("touched", sliders[k].get("touched") + 1); // the arm follows, and whoever waits for the kernel
    });
    puts = false;
    const count = (model.get("dragged")?.count || 0) + 1, touched = touchesOf(sliders);
    model.set("dragged", { what, values: sliders.map((slider) => slider && slider.get("value")), live, count, touched });
    model.save_changes();
  };
  const putTarget = (target, T, live) => {
    put(target.name, target.sliders, target.per.map((per, k) => valuesOf(T)[k] * per), live);
    taken(target.name, isPoint(target));
  };
  const bringAlong = (target) => { // as far as it goes in small steps: the kernel knows all ways, and why one ends
    const T = targetPose(target), { goal, arms, ...arm } = model.get("reaching");
    viewer.set_transform(target.path, T);
    if (goal !== target.name) return;
    ways = Object.entries(arms).map(([path, theta]) => ({ path: splitPath(path), ...reachFor(arm, theta, T) }));
    for (const { path, D, far } of ways) if (far < NEAR) D.forEach((link, k) => viewer.set_transform([...path, String(k + 1)], link));
  };
  // Whether it stands elsewhere than its sliders say, of which the kernel has not spoken yet.
  const isLate = (target) => {
    const { object } = viewer.scene_tree.find(target.path);
    object.updateMatrix();
    return targetPose(target).some((x, k) => Math.abs(x - object.matrix.elements[k]) > 1e-6);
  };
  const isPoint = (target) => target.sliders.length === 3; // moved as it is turned: not at all
  const targetPose = ({ name, sliders, per }) => {
    const held = follower.hand(name, sliders);
    return poseOf([...sliders.map((slider, k) => (held ? held[k] : slider.get("value")) / per[k]), 0, 0, 0]);
  };
  const putTheta = (theta, live) => {
    const { per } = model.get("drive");
    put("theta", follower.sliders(), theta.map((q, k) => q * per[k]), live);
    taken("theta");
  };
  const ends = () => follower.sliders().map((slider, k) => slider && ["min", "max"].map((end) => slider.get(end) / model.get("drive").per[k]));

  // --- grips: where each stands, and what a pull and a key do
  const targetGrips = (target) => (isPoint(target) ? [0] : [0, 1]).flatMap((kind) => [0, 1, 2].map((k) => {
    const T = () => targetPose(target);
    const frame = () => [0, 4, 8, 12].map((j) => T().slice(j, j + 3)); // its axes and its origin
    const onRing = (turns) => {
      const A = frame(), [u, v, o] = [A[(k + 1) % 3], A[(k + 2) % 3], A[3]], long = RING / perMetre(o);
      return turns.map((turn) => o.map((x, i) => x + long * (Math.cos(turn) * u[i] + Math.sin(turn) * v[i])));
    };
    const arrow = () => {
      const A = frame(), long = arrowFrom(A[3], A[k]);
      return [A[3], A[3].map((x, i) => x + long * A[k][i])];
    };
    const place = () => (kind ? onRing([1.25 * Math.PI])[0] : arrow()[1]); // rings on the far side of the arrows
    const name = "xyz"[k];
    return {
      text: kind ? `↻${name}` : name, kind: kind ? `${name} ring` : name, place,
      path: () => (kind ? onRing(Array.from({ length: 37 }, (_, i) => (i * Math.PI) / 18)) : arrow()),
      label: kind ? `turn ${target.letter} about its ${name}` : `move ${target.letter} along its ${name}`,
      pull(dx, dy) {
        const p = place(), A = frame(), way = kind ? crossed(A[k], p.map((x, i) => x - A[3][i])) : A[k];
        putTarget(target, movedAlong(T(), kind, k, follow(p, way, dx, dy)), true);
      },
      key: (steps, live) => putTarget(target, movedAlong(T(), kind, k, steps * (kind ? Math.PI / 180 : 0.01)), live),
      end: () => putTarget(target, T(), false),
    };
  }));
  // A point that goes where the pointer goes, in the plane of the screen. place(): where it is; put(goal, live)
  const freeGrip = (text, label, place, put) => {
    let goal = null;
    return {
      text, kind: "tool", place, path: () => [], label,
      pull(dx, dy) {
        goal = goal || place();
        const [right, up] = [0, 1].map((k) => new THREE.Vector3().setFromMatrixColumn(viewer.camera.matrixWorld, k));
        const way = right.multiplyScalar(dx).addScaledVector(up, -dy).divideScalar(perMetre(goal));
        const frame = viewer.scene_tree.find(["ck"]).object.matrixWorld.clone().invert();
        way.transformDirection(frame).multiplyScalar(Math.hypot(dx, dy) / perMetre(goal));
        goal = goal.map((x, i) => x + way.toArray()[i]);
        put(goal, true);
      },
      key: (steps, live, axis = 0) => put(place().map((x, i) => (i === axis ? x + 0.01 * steps : x)), live),
      end() {
        goal = null;
        put(null, false);
      },
    };
  };
  const toolGrip = () => {
    const arm = () => model.get("drive");
    const place = () => product(displacements(arm().screws, follower.theta()).at(-1), arm().M).slice(12, 15);
    const reach = (goal, live) => putTheta(goal ? reachFor(arm(), follower.theta(), goal, ends()).q : follower.theta(), live);
    return freeGrip("tool", "move the tool", place, reach);
  };
  const pointGrip = (target) => freeGrip("?", `move ${target.letter}`, () => targetPose(target).slice(12, 15),
    (goal, live) => putTarget(target, goal ? poseOf([...goal, 0, 0, 0]) : targetPose(target), live));

  // --- one button for each grip
  const hold = (event, grip, node) => { // until the pointer is let go
    take(event);
    node.setPointerCapture(event.pointerId);
    let last = [event.clientX, event.clientY], due = null;
    const pull = () => {
      const [dx, dy] = [due[0] - last[0], due[1] - last[1]];
      [last, due] = [due, null];
      if (dx || dy) grip.pull(dx, dy);
    };
    const move = (now) => {
      if (now.pointerId !== event.pointerId) return;
      if (!due) requestAnimationFrame(() => due && !over && pull()); // once a frame is enough
      due = [now.clientX, now.clientY];
    };
    const end = () => {
      if (due) pull();
      held.abort();
      viewer.controls.enabled = true;
      grip.end();
    };
    const held = new AbortController(), { signal } = held;
    viewer.controls.enabled = false;
    node.addEventListener("pointermove", move, { signal });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) node.addEventListener(name, end, { signal });
  };
  const makeButton = (grip) => {
    const node = element("button", { ...own, type: "button", class: `ck-handle ${grip.kind}`, "aria-label": grip.label,
      title: `${grip.label}: drag it, or use the arrow keys (Shift: finer)` }, grip.text);
    const line = svg("polyline", { class: `ck-handle-line ${grip.kind}` });
    lines.append(line);
    node.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      node.focus({ preventScroll: true });
      hold(event, grip, node);
    });
    node.addEventListener("keydown", (event) => {
      const [sign, axis] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [1, 1], ArrowDown: [-1, 1], PageUp: [1, 2], PageDown: [-1, 2] }[event.key] || [0];
      event.stopPropagation();
      if (!sign) return;
      event.preventDefault();
      grip.key(sign * (event.shiftKey ? 0.1 : 1), event.repeat, axis);
    });
    layer.append(node);
    return { node, line, grip, aside: [0, 0] };
  };

  const rebuild = () => {
    lines.replaceChildren();
    grips.forEach(({ node }) => node.remove());
    grips = [...targets.flatMap(targetGrips), ...targets.filter(isPoint).map(pointGrip), ...(movesArm() ? [toolGrip()] : [])].map(makeButton);
    redraw();
  };
  const movesArm = () => follower.sliders().some(Boolean) && !targets.some(isPoint); // or else it is predicted, not tried
  const listen = async () => {
    const found = await Promise.all((model.get("handles") || []).map(async ({ path, letter, per, sliders }) =>
      ({ name: path, path: splitPath(path), letter, per, sliders: await childModels(model, sliders) })));
    await follower.ready();
    if (over) return;
    hear("off");
    targets = found;
    hear("on");
    rebuild();
  };
  const slid = () => puts || moved();
  const hear = (how) => targets.forEach(({ sliders }) => sliders.forEach((slider) => slider[how]("change:value", slid)));
  const deafen = listenTo(model, { handles: listen, drive: listen });
  listen();

  // --- a link of the arm turns its joint
  const ray = new THREE.Raycaster(), at = new THREE.Vector2();
  const linkAt = (event) => { // number of the joint, and the point where it was taken
    const { path, screws } = model.get("drive"), sliders = follower.sliders();
    if (!path || !movesArm()) return null;
    const area = pane.getBoundingClientRect();
    at.set((2 * (event.clientX - area.left)) / area.width - 1, 1 - (2 * (event.clientY - area.top)) / area.height);
    ray.setFromCamera(at, viewer.camera);
    const links = screws.map((_, k) => viewer.scene_tree.find([...splitPath(path), String(k + 1), "solid"]).object);
    const hit = ray.intersectObjects(links.filter((link) => link.visible), true)[0];
    if (!hit) return null;
    const k = links.findIndex((link) => { for (let o = hit.object; o; o = o.parent) if (o === link) return true; return false; });
    return sliders[k] ? { k, p: viewer.scene_tree.find(["ck"]).object.worldToLocal(hit.point.clone()).toArray() } : null;
  };
  const linkGrip = ({ k, p }) => {
    const carried = () => displacements(model.get("drive").screws, follower.theta());
    const inverse = new THREE.Matrix4().fromArray(carried()[k]).invert();
    const there = new THREE.Vector3(...p).applyMatrix4(inverse); // on the link, at zero
    return {
      pull(dx, dy) {
        const D = carried(), here = there.clone().applyMatrix4(new THREE.Matrix4().fromArray(D[k])).toArray();
        const way = velocityOf(k ? D[k - 1] : null, model.get("drive").screws[k], here);
        putTheta(follower.theta().map((q, j) => (j === k ? q + follow(here, way, dx, dy) : q)), true);
      },
      end: () => putTheta(follower.theta(), false),
    };
  };
  pane.addEventListener("pointerdown", (event) => {
    if (event.button || event.ctrlKey || event.shiftKey || event.target.closest(".ck-handle")) return;
    const link = linkAt(event);
    if (!link) return;
    pane.focus({ preventScroll: true });
    hold(event, linkGrip(link), pane);
  }, { capture: true });
  let rests = null;
  pane.addEventListener("pointermove", (event) => { // where the pointer rests on a link, it says so
    clearTimeout(rests);
    if (event.buttons || event.pointerType !== "mouse") return;
    rests = setTimeout(() => !over && pane.classList.toggle("ck-on-link", Boolean(linkAt(event))), 80);
  });

  return {
    // what a hand holds stands where that is, as do its sliders; a target where those are, and all arms that are at it
    place() {
      for (const { name, sliders } of [...targets, { name: "theta", sliders: follower.sliders() }]) {
        follower.hand(name, sliders)?.forEach((value, k) => sliders[k] && sliders[k].set("value", value));
      }
      targets.filter(isLate).forEach(bringAlong);
    },
    ways: () => ways,
    draw() { // gives where they stand
      const { width, height } = renderer.size(), shownAt = [];
      lines.setAttribute("viewBox", `0 0 ${width} ${height}`);
      for (const one of grips) {
        const { node, line, grip } = one, [left, top, z] = project(grip.place()), ends = grip.path().map(project);
        const wide = 12 + 8 * grip.text.length, held = !viewer.controls.enabled; // nothing gives way under a hand
        if (grip.kind === "tool" && !held) one.aside = asideOf(left, top, wide, shownAt);
        const [x, y] = [left + one.aside[0], top + one.aside[1]];
        const turned = ends.length === 2 && Math.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]) < 18; // towards us
        const shown = z < 1 && !turned && x > 0 && y > 0 && x < width && y < height;
        if (shown) shownAt.push({ x, y, wide, high: 19 });
        for (const part of [node, line]) part.style.visibility = shown ? "" : "hidden";
        node.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
        line.setAttribute("points", ends.map(([px, py]) => `${px.toFixed(1)},${py.toFixed(1)}`).join(" "));
      }
      return shownAt;
    },
    end() {
      over = true;
      hear("off");
      clearTimeout(rests);
      deafen();
      past = past.filter(({ place }) => place !== pane);
    },
  };
}
