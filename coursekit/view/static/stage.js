// One meshcat viewer in a pane, tamed for a notebook: one WebGL context per page, frames only when something changed.

// Browsers keep about 16 WebGL contexts. All views of a page share one renderer and copy its picture to a 2D canvas.
function sharedRenderer(MeshCat) {
  const shared = page();
  if (shared.renderer) return shared.renderer;
  const THREE = MeshCat.THREE;
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true }); // until it is copied
  renderer.debug.checkShaderErrors = false; // to ask each program at once is to wait for it
  renderer.setPixelRatio(1);
  renderer.setClearColor(0, 0);
  renderer.outputEncoding = THREE.sRGBEncoding;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  renderer.shadowMap.autoUpdate = false; // a resting pose keeps its shadow: a third of the cost without a GPU
  shared.contextLost = false;
  const redrawAll = () => {
    shared.contextLost = false;
    for (const stage of shared.views) stage.moved();
  };
  renderer.domElement.addEventListener("webglcontextlost", (event) => {
    event.preventDefault(); // without this the browser never gives the context back
    shared.contextLost = true;
    setTimeout(() => {
      if (!shared.contextLost || shared.renderer !== renderer) return;
      shared.renderer = null; // it did not come back: start again with a new one
      try {
        sharedRenderer(MeshCat);
        redrawAll();
      } catch {} // there is none any more
    }, 3000);
  });
  renderer.domElement.addEventListener("webglcontextrestored", redrawAll);
  shared.renderer = renderer;
  return renderer;
}

// A picture of few pixels without smoothed edges, for frames that must be quick where there is no GPU: the page's
// own canvas smooths and copies all its pixels, however few are drawn, which takes twice as long.
function coarsePicture(THREE, context) {
  const shared = page();
  let image = null;
  const draw = (gl, scene, camera, width, height) => {
    if (!shared.coarse) { // for all views: one that is closed leaves nothing behind
      shared.coarse = new THREE.WebGLRenderTarget(width, height);
      shared.coarse.texture.encoding = THREE.sRGBEncoding;
    }
    shared.coarse.setSize(width, height);
    gl.setRenderTarget(shared.coarse);
    gl.render(scene, camera);
    gl.setRenderTarget(null);
  };
  const show = (gl) => {
    const { width, height } = context.canvas;
    if (!image || image.width !== width || image.height !== height) image = new ImageData(width, height);
    const bytes = new Uint8Array(4 * width * height);
    gl.readRenderTargetPixels(shared.coarse, 0, 0, width, height, bytes);
    for (let y = 0; y < height; y += 1) { // WebGL counts rows from below
      image.data.set(bytes.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    }
    for (let i = 3; i < image.data.length; i += 4) { // colours were multiplied by their opacity
      const alpha = image.data[i];
      if (alpha > 0 && alpha < 255) for (let k = i - 3; k < i; k += 1) image.data[k] *= 255 / alpha;
    }
    context.putImageData(image, 0, 0);
  };
  return { draw, show };
}

// What meshcat's Viewer takes for its renderer: the page's one renderer, drawing into this view's own canvas.
function canvasRenderer(MeshCat) {
  sharedRenderer(MeshCat); // throws here, and not at the first frame, where there is no WebGL
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  const inUse = new MeshCat.THREE.Vector2();
  const coarse = coarsePicture(MeshCat.THREE, context);
  let width = 1, height = 1, ratio = 1, w = 1, h = 1; // w, h: pixels of the frame that is drawn
  const facade = {
    domElement: canvas,
    coarseness: 1, // below 1: fewer pixels while something moves
    shadowsStale: true,
    shadows: true,
    size: () => ({ width, height }),
    setPixelRatio(value) { ratio = value; },
    setSize(w, h) {
      [width, height] = [w, h];
      Object.assign(canvas.style, { width: `${w}px`, height: `${h}px` });
    },
    // When the graphics process has drawn what `render` told it to. Copying before would wait for it, and the page with it.
    async drawn() {
      const context = sharedRenderer(MeshCat).getContext();
      const fence = context.fenceSync && context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
      context.flush();
      const waits = () => fence && !context.isContextLost() && context.getSyncParameter(fence, context.SYNC_STATUS) !== context.SIGNALED;
      for (let tries = 0; waits() && tries < 3000; tries += 1) await pause(4);
      if (fence) context.deleteSync(fence);
    },
    render(scene, camera) {
      const gl = sharedRenderer(MeshCat);
      [w, h] = [width, height].map((side) => Math.max(1, Math.round(side * ratio * facade.coarseness)));
      camera.layers.set(0);
      camera.layers.enable(facade.coarseness < 1 ? QUICK_LAYER : FULL_LAYER);
      gl.shadowMap.enabled = facade.shadows;
      // few pixels means that frames are slow and that a full picture follows: the shadow waits for that
      const shadowNow = facade.shadows && facade.shadowsStale && facade.coarseness === 1;
      gl.shadowMap.needsUpdate = shadowNow;
      if (shadowNow) facade.shadowsStale = false;
      if (facade.coarseness < 1) return coarse.draw(gl, scene, camera, w, h);
      gl.getSize(inUse);
      if (inUse.x < w || inUse.y < h) gl.setSize(Math.max(w, inUse.x), Math.max(h, inUse.y), false);
      gl.setViewport(0, 0, w, h);
      gl.setScissor(0, 0, w, h);
      gl.setScissorTest(true);
      gl.render(scene, camera);
    },
    show() { // the frame that was drawn
      const gl = sharedRenderer(MeshCat), { domElement } = gl;
      if (canvas.width !== w) canvas.width = w; // which empties it: not before there is something to show
      if (canvas.height !== h) canvas.height = h;
      if (facade.coarseness < 1) return coarse.show(gl);
      context.clearRect(0, 0, w, h);
      context.drawImage(domElement, 0, domElement.height - h, w, h, 0, 0, w, h);
    },
    dispose() {},
  };
  return facade;
}

// meshcat's constructor adds window listeners, takes window.onload and would start an endless loop of frames.
function quietViewer(MeshCat, pane, renderer) {
  /** @type {[string, any][]} */
  const listeners = [];
  const { addEventListener, onload } = window;
  window.addEventListener = function (/** @type {[string, any]} */ ...args) {
    listeners.push(args);
    return addEventListener.apply(window, args);
  };
  try {
    const viewer = new MeshCat.Viewer(pane, false, renderer);
    viewer.gui.domElement.style.display = "none";
    viewer.forgetListeners = () => listeners.forEach((args) => window.removeEventListener(...args));
    return viewer;
  } finally {
    delete window.addEventListener;
    if (window.addEventListener !== addEventListener) window.addEventListener = addEventListener;
    window.onload = onload;
  }
}

function release(object) {
  object.traverse((part) => {
    const materials = [].concat(part.material || []);
    for (const held of [part.geometry, part.shadow, ...materials.map(({ map }) => map), ...materials]) held?.dispose();
  });
}

// Phong in place of physically based paint: about a third cheaper without a GPU.
function plainMaterial(THREE, material) {
  if (!material.isMeshStandardMaterial) return material;
  const plain = new THREE.MeshPhongMaterial({ shininess: 30 });
  for (const name of ["transparent", "opacity", "depthTest", "depthWrite", "side", "vertexColors", "emissiveIntensity"]) plain[name] = material[name];
  plain.color.copy(material.color);
  plain.emissive.copy(material.emissive);
  return plain;
}

const FULL_LAYER = 1, QUICK_LAYER = 2; // for things of two looks: of full frames and of those of few pixels
const QUICK = 20; // milliseconds: 30 frames a second leave 33, and the page wants some of them

function makeStage(MeshCat, pane, quality) {
  const THREE = MeshCat.THREE, shared = page();
  const renderer = canvasRenderer(MeshCat);
  const viewer = quietViewer(MeshCat, pane, renderer);
  pane.append(renderer.domElement);
  renderer.shadows = quality !== "low";
  viewer.scene_tree.find(["Background"]).object.visible = false; // the pane's style sheet paints the ground, by theme
  viewer.hide_background();

  const meshcatViewer = MeshCat.Viewer.prototype;
  viewer.set_3d_pane_size = function () {
    if (!pane.isConnected || !pane.clientWidth || !pane.clientHeight) return;
    meshcatViewer.set_3d_pane_size.call(this, pane.clientWidth, pane.clientHeight);
    // paper is narrower than most windows: the style sheet makes the picture smaller there, letters and all
    pane.parentElement.style.setProperty("--ck-w", pane.clientWidth);
    pane.parentElement.style.setProperty("--ck-h", pane.clientHeight);
  };
  viewer.set_object = function (path, object) {
    const node = viewer.scene_tree.find(path.concat(["<object>"]));
    release(node.object); // meshcat frees the root alone, not a Group's parts
    node.controllers.forEach((controller) => node.folder.remove(controller));
    node.controllers = []; // meshcat keeps them: a light that is replaced twice would throw
    object.traverse((part) => {
      if (part.isLight && !part.shadow) part.castShadow = false; // meshcat switches it on for every root
      if (quality === "low" && part.material && !Array.isArray(part.material)) part.material = plainMaterial(THREE, part.material);
      if (part.material && part.material.isShadowMaterial) part.layers.set(FULL_LAYER); // quick frames would show that of an earlier pose
    });
    meshcatViewer.set_object.call(this, path, object);
  };

  let request = 0, sharpen = 0, dead = false, lastMotion = -1e9;
  // While something moves: the most pixels (as a part of each side) with which a frame takes less than QUICK.
  const levels = { auto: [1, 0.5, 0.35], low: [0.5, 0.35], high: [1] }[quality];
  const cost = new Map(shared.cost); // milliseconds of a frame at each level, as far as known, also from another view
  const levelNow = () => {
    if (!shared.cost) return levels[1] || 1; // the first frame of a page: a sharp one follows at once
    if (performance.now() - lastMotion > 150) return 1;
    return levels.find((level) => (cost.get(level) || 0) < QUICK) || levels.at(-1);
  };
  const learn = (level, took) => {
    if (!shared.cost) { // until then nothing was drawn: the page's first frame compiles shaders: another one shows what a frame costs
      shared.cost = cost;
      return viewer.set_dirty();
    }
    cost.set(level, cost.has(level) ? 0.7 * cost.get(level) + 0.3 * took : took);
    const finer = levels[levels.indexOf(level) - 1];
    if (finer < 1) cost.set(finer, 0.98 * cost.get(finer)); // so that it gets another chance
  };
  const stage = { viewer, renderer, beforeFrame: [], afterFrame: [], frames: 0, playing: () => false, resized() {} };

  const compile = () => {
    shared.compiled = true;
    sharedRenderer(MeshCat).compile(viewer.scene, viewer.camera);
  };
  const draw = async (now) => {
    request = 0;
    if (dead) return;
    if (shared.drawing) return stage.wake(); // the one renderer has a frame of ours or of another view to finish
    for (const act of stage.beforeFrame) act(now);
    // a cell out of sight is taken out of the page: it gets the pose, and is drawn when it comes back
    if (viewer.needs_render && pane.isConnected && !shared.contextLost) {
      if (!shared.compiled) {
        compile(); // not in the task of the first frame
        return stage.wake();
      }
      const wanted = levelNow();
      renderer.coarseness = wanted;
      const begun = performance.now();
      viewer.render();
      if (!shared.cost || (wanted === 1 && !(cost.get(1) < QUICK))) {
        shared.drawing = true;
        await renderer.drawn().finally(() => (shared.drawing = false));
        if (dead) return;
      }
      renderer.show();
      learn(wanted, performance.now() - begun);
      stage.frames += 1;
      clearTimeout(sharpen);
      if (wanted < 1) sharpen = setTimeout(() => viewer.set_dirty(), 300); // full sharpness once it rests
      for (const act of stage.afterFrame) act(now);
    }
    if (stage.playing()) stage.wake();
  };
  // Draw once where nobody sees it: what a picture needs is compiled then.
  stage.rehearse = async () => {
    compile();
    await pause(0); // each step is a task of its own
    if (dead || pane.isConnected) return;
    renderer.setSize(64, 48);
    viewer.render();
    stage.moved();
  };
  stage.wake = () => (request ||= dead ? 0 : requestAnimationFrame(draw));
  stage.now = () => draw(performance.now()); // and not in the browser's next frame
  viewer.set_dirty = function () {
    this.needs_render = true;
    stage.wake();
  };
  // Something in the scene moved (and not only the camera): the shadow has to follow.
  stage.moved = () => {
    renderer.shadowsStale = true;
    lastMotion = performance.now();
    viewer.set_dirty();
  };
  viewer.controls.addEventListener("change", () => (lastMotion = performance.now()));

  // The wheel belongs to the notebook until the pane has been clicked.
  viewer.controls.enableZoom = false;
  pane.addEventListener("pointerleave", () => { viewer.controls.enableZoom = false; });

  // A finger up or down scrolls the page, sideways it turns the picture; what it holds goes along, and two move and zoom.
  pane.style.touchAction = "pan-y";
  for (const name of ["touchstart", "touchmove"]) {
    pane.addEventListener(name, (event) => {
      if (event.cancelable && (event.touches.length > 1 || !viewer.controls.enabled)) event.preventDefault();
    }, { passive: false });
  }
  let stood = false; // whether the camera's stand is kept: a finger turns it a little before the page scrolls
  pane.addEventListener("pointerdown", (event) => {
    viewer.controls.enableZoom = true;
    pane.focus({ preventScroll: true });
    if (!event.isPrimary) return;
    stood = true;
    viewer.controls.saveState();
  });
  pane.addEventListener("pointerup", () => (stood = false));
  pane.addEventListener("pointercancel", () => { if (stood) viewer.controls.reset(); stood = false; });

  const unwatch = watchSize(pane, () => {
    viewer.set_3d_pane_size();
    stage.resized();
  });
  stage.destroy = () => {
    dead = true;
    cancelAnimationFrame(request);
    clearTimeout(sharpen);
    unwatch();
    shared.views.delete(stage);
    viewer.forgetListeners();
    viewer.controls.dispose();
    release(viewer.scene);
    viewer.gui.destroy();
    pane.replaceChildren();
  };
  shared.views.add(stage);
  stage.moved();
  return stage;
}
