// What the page adds to meshcat's scene: labels that face the reader, ghosts, and named views of the camera.

const splitPath = (path) => path.split("/").filter((name) => name);

// Coordinates of the world (z up, metres) in the frame of meshcat's camera (y up).
const yUp = ([x, y, z]) => [x, z, -y];

// What is seen of a name, or nearly, is all of it: where its middle stands, of which `half` needs room before 0 and before `end`.
const kept = (at, half, end) => (at < -Math.max(18, half) || at > end + Math.max(18, half) ? at : Math.max(half, Math.min(end - half, at)));

// HTML spans, placed after every frame: crisp at any size, readable in both themes, always facing the reader.
function makeLabels(THREE, viewer, pane, renderer) {
  const layer = element("div", { class: "ck-labels", "aria-hidden": "true" }); // the text line says the same in words
  pane.append(layer);
  const point = new THREE.Vector3(), views = pane.parentElement.querySelector(".ck-views");
  let labels = [];
  const visible = (object) => !object || (object.visible && visible(object.parent));
  return {
    set(list) {
      labels = list.map(({ path, pos, text, cls }) => ({ span: element("span", { class: `ck-label ${cls || ""}` }, text), pos,
        path: splitPath(path), isWord: !["x", "y", "z", "tick"].includes(cls), wide: 7.2 * text.length + 8 }));
      labels.sort((a, b) => b.isWord - a.isWord || a.wide - b.wide); // long names give way
      layer.replaceChildren(...labels.map((label) => label.span));
    },
    place(handles) {
      const { width, height } = renderer.size(); // not the pane's: that is 0 while JupyterLab moves the cell about
      const { offsetLeft, offsetTop, offsetWidth: wide, offsetHeight: high } = views;
      const taken = [...handles, { x: offsetLeft + wide / 2, y: offsetTop + high / 2, wide, high: high / 2 + 9 }]; // buttons, which nothing may hide
      for (const { span, pos, path, isWord, wide } of labels) {
        const object = viewer.scene_tree.find(path).object;
        point.set(...pos).applyMatrix4(object.matrixWorld).project(viewer.camera);
        const x = kept(((point.x + 1) / 2) * width, wide / 2, width);
        let y = kept(((1 - point.y) / 2) * height, 9, height);
        // words give way to each other, downwards and from the ground up; the letters of axes and the scale of the grid, by not being there
        const isTaken = () => taken.some((other) => Math.abs(other.x - x) < (other.wide + wide) / 2 && Math.abs(other.y - y) < (other.high || 13));
        let shown = point.z < 1 && x > 0 && x < width && y > 0 && y < height && visible(object);
        for (let step = 13; shown && isWord && isTaken(); y += step) if (y + step > height - 9) step = -13;
        shown = shown && !isTaken();
        span.style.display = shown ? "" : "none";
        if (!shown) continue;
        taken.push({ x, y, wide });
        span.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      }
    },
  };
}

// Translucent copies of a robot. They share its geometry, so nothing is sent. Each first writes only depth and then
// its colour: overlapping parts of one ghost do not add up, and its insides stay hidden. In quick frames each link is one
// flat mesh of fewer triangles, written once: without a GPU every mesh costs, and seven ghosts have a hundred parts.
function makeGhosts(THREE, viewer) {
  let drawn = [];
  const merged = new WeakMap(); // of links
  const merge = (parts) => {
    const points = [], faces = [];
    for (const { geometry, matrix } of parts) {
      const { attributes, index } = geometry.type === "LatheGeometry" ? new THREE.LatheGeometry(geometry.parameters.points, 6) : geometry;
      for (const i of index.array) faces.push(points.length + i);
      for (let i = 0; i < attributes.position.count; i += 1) points.push(new THREE.Vector3().fromBufferAttribute(attributes.position, i).applyMatrix4(matrix));
    }
    return new THREE.BufferGeometry().setFromPoints(points).setIndex(faces);
  };
  return function draw(ghosts) {
    for (const path of drawn) viewer.delete_path(splitPath(path));
    drawn = ghosts.map((ghost) => ghost.path);
    ghosts.forEach(({ src, path, n, color, opacity, shown }, g) => {
      const links = viewer.scene_tree.find(splitPath(src)).children;
      const offset = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4, transparent: true };
      const paint = new THREE.MeshLambertMaterial({ ...offset, opacity, emissiveIntensity: 0.35 });
      paint.color.setHex(color).convertSRGBToLinear();
      paint.emissive.copy(paint.color);
      const depth = new THREE.MeshBasicMaterial({ ...offset, colorWrite: false }), flat = new THREE.MeshBasicMaterial({ ...offset, opacity, color: paint.color });
      for (let k = 1; k <= n; k += 1) { // link 0, the base, is there already
        const solid = links[k] && links[k].children.solid && links[k].children.solid.children["<object>"].object;
        if (!solid) continue;
        const parts = [], copy = new THREE.Group();
        solid.traverse((part) => part.isMesh && parts.push(part) && part.updateMatrix());
        if (!merged.has(solid)) merged.set(solid, merge(parts));
        [depth, paint, flat].forEach((material, pass) => {
          for (const { geometry, matrix } of material === flat ? [{ geometry: merged.get(solid), matrix: solid.matrix }] : parts) {
            const mesh = new THREE.Mesh(geometry, material);
            mesh.layers.set(material === flat ? QUICK_LAYER : FULL_LAYER);
            mesh.matrixAutoUpdate = false;
            mesh.matrix.copy(matrix);
            mesh.renderOrder = 10 + 4 * g + pass;
            copy.add(mesh);
          }
        });
        viewer.set_object([...splitPath(path), String(k), "ghost"], copy);
      }
      viewer.scene_tree.find(splitPath(path)).object.visible = shown;
    });
  };
}

// Named views and keys for the camera. meshcat's set_camera leaks its controls: move the one camera instead.
function makeCamera(THREE, viewer, pane) {
  const { camera, controls } = viewer;
  const spherical = new THREE.Spherical(), offset = new THREE.Vector3();
  let shown = null; // the named view, as long as nobody turned it
  controls.addEventListener("start", () => (shown = null));
  const place = () => {
    const aspect = pane.clientWidth / pane.clientHeight;
    if (!shown || !aspect) return;
    controls.target.set(...yUp(shown.target));
    offset.set(...yUp(shown.position)).sub(controls.target).multiplyScalar(Math.max(1, shown.wide / aspect)); // narrow: step back
    camera.position.copy(controls.target).add(offset);
    controls.update();
    viewer.set_dirty();
  };
  return {
    lens: ({ size, fov }) => Object.assign(camera, { fov, near: 0.02 * size, far: 30 * size }),
    show(where) {
      shown = where;
      place();
    },
    fit: place, // after a change of the pane's size
    // turn by angles (radians), zoom by a factor
    turn(azimuth, elevation, zoom = 1) {
      shown = null;
      spherical.setFromVector3(offset.copy(camera.position).sub(controls.target));
      spherical.theta += azimuth;
      spherical.phi = Math.min(Math.PI - 0.02, Math.max(0.02, spherical.phi + elevation));
      spherical.radius *= zoom;
      camera.position.copy(controls.target).add(offset.setFromSpherical(spherical));
      controls.update();
      viewer.set_dirty();
    },
  };
}
