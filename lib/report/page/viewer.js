// SPDX-License-Identifier: Apache-2.0
// Draws meshes side by side under one camera: one canvas below all panes, a viewport for each pane.
(function () {
  "use strict";
  const state = document.documentElement.dataset;
  const stage = document.getElementById("viewer-stage");
  const canvas = stage.querySelector("canvas");
  const panes = Array.from(stage.querySelectorAll(".pane"));
  const data = JSON.parse(document.getElementById("viewer-data").textContent);
  const PLAIN = [0.82, 0.79, 0.745], ORANGE = [0.94, 0.47, 0.08], INNER_SIDE = 0x965ac8;
  state.viewer = "loading";

  function fail(words) {
    state.viewer = "failed";
    const notice = document.createElement("p");
    notice.className = "notice";
    notice.textContent = words;
    stage.replaceWith(notice);
    document.getElementById("viewer-buttons").remove();
  }

  function hasWebGl() {
    const probe = document.createElement("canvas");
    const context = probe.getContext("webgl2") || probe.getContext("webgl");
    return Boolean(context);
  }
  if (!hasWebGl()) {
    fail("This browser has no WebGL, so that nothing can be turned here. The pictures below show the same meshes.");
    return;
  }

  const renderer = new THREE.WebGLRenderer({canvas: canvas, antialias: true, alpha: true});
  renderer.setPixelRatio(window.devicePixelRatio || 1);
  renderer.setScissorTest(true);
  renderer.autoClear = false;
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  const headlight = new THREE.DirectionalLight(0xffffff, 0.75);
  headlight.position.set(0.3, 0.5, 1);
  camera.add(headlight);
  scene.add(camera);
  scene.add(new THREE.AmbientLight(0xffffff, 0.35));
  const models = [];

  const vector = (numbers) => new THREE.Vector3(numbers[0], numbers[1], numbers[2]);
  camera.up.copy(vector(data.up));
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;
  controls.screenSpacePanning = true;
  controls.enableZoom = false;  // until the viewer was touched: the wheel goes on scrolling the page
  canvas.addEventListener("pointerdown", () => { controls.enableZoom = true; });
  stage.addEventListener("pointerleave", () => { controls.enableZoom = false; });
  function reset() {
    camera.position.copy(vector(data.eye));
    controls.target.copy(vector(data.target));
    controls.update();
  }

  // One draw call for each pane, all of them when anything changes.
  let wanted = false;
  function draw() {
    wanted = false;
    const box = stage.getBoundingClientRect();
    if (box.width === 0) return;
    renderer.setSize(box.width, box.height, false);
    renderer.setClearColor(getComputedStyle(stage).getPropertyValue("--stage").trim() || "#ffffff");
    const distance = camera.position.distanceTo(controls.target);
    camera.near = distance / 200;
    camera.far = distance * 20;
    models.forEach((model, i) => {
      const place = panes[i].getBoundingClientRect();
      const rect = [place.left - box.left, box.bottom - place.bottom, place.width, place.height];
      renderer.setViewport(...rect);
      renderer.setScissor(...rect);
      camera.aspect = place.width / place.height;
      camera.updateProjectionMatrix();
      models.forEach((other) => { other.group.visible = other === model; });
      renderer.clear();
      renderer.render(scene, camera);
    });
  }
  function redraw() {
    if (!wanted) requestAnimationFrame(draw);
    wanted = true;
  }

  // Variance of the brightness in each pane, right after drawing: the buffer is gone later.
  function variances() {
    const gl = renderer.getContext(), ratio = renderer.getPixelRatio();
    const box = stage.getBoundingClientRect();
    return panes.map((pane) => {
      const place = pane.getBoundingClientRect();
      const width = Math.floor(place.width * ratio), height = Math.floor(place.height * ratio);
      const pixels = new Uint8Array(4 * width * height);
      gl.readPixels(Math.floor((place.left - box.left) * ratio), Math.floor((box.bottom - place.bottom) * ratio),
                    width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      let sum = 0, squares = 0;
      for (let i = 0; i < pixels.length; i += 4) {
        const grey = (pixels[i] + pixels[i + 1] + pixels[i + 2]) / 3;
        sum += grey;
        squares += grey * grey;
      }
      const count = width * height, mean = sum / count;
      return (squares / count - mean * mean).toFixed(1);
    });
  }

  const srgb = (value) => (value <= 0.0031308 ? 12.92 * value : 1.055 * Math.pow(value, 1 / 2.4) - 0.055);

  function rampColor(coloring, value) {
    if (value < coloring.orangeBelow) return ORANGE;
    const last = data.ramp.length - 1;
    const at = Math.max(0, Math.min(last, Math.round((value / coloring.high) * last)));
    return data.ramp[at].map((channel) => channel / 255);
  }

  // Colours of all vertices of a model; null: the model has nothing of the kind and is drawn plain.
  function colorsOf(model, coloring) {
    const source = coloring && model.source[coloring.attribute];
    if (!source) return null;
    const colors = new Float32Array(3 * source.count);
    for (let i = 0; i < source.count; ++i) {
      const color = coloring.attribute === "color"
        ? [srgb(source.getX(i)), srgb(source.getY(i)), srgb(source.getZ(i))]
        : rampColor(coloring, source.array[i]);
      colors.set(color, 3 * i);
    }
    return new THREE.BufferAttribute(colors, 3);
  }

  function show(coloring) {
    models.forEach((model) => {
      const colors = colorsOf(model, coloring);
      if (colors) model.geometry.setAttribute("color", colors);
      model.front.vertexColors = colors ? THREE.VertexColors : THREE.NoColors;
      model.front.color.setRGB(...(colors ? [1, 1, 1] : PLAIN));
      model.front.needsUpdate = true;
    });
    showKey(coloring);
    redraw();
  }

  function showKey(coloring) {
    const key = document.getElementById("viewer-key");
    key.textContent = "";
    if (!coloring || !coloring.highWords) return;
    const bar = document.createElement("i");
    bar.className = "bar";
    bar.style.background =
      "linear-gradient(90deg," + data.ramp.filter((c, i) => i % 9 === 0).map((c) => "rgb(" + c + ")") + ")";
    key.append(coloring.lowWords + " ", bar, " " + coloring.highWords);
  }

  function button(words, pressed, act) {
    const element = document.createElement("button");
    element.type = "button";
    element.textContent = words;
    element.setAttribute("aria-pressed", pressed);
    element.addEventListener("click", () => act(element));
    return element;
  }

  function addButtons() {
    const bar = document.getElementById("viewer-buttons");
    const present = data.colorings.filter((c) => models.some((model) => model.source[c.attribute]));
    const choices = [{label: "Plain", coloring: null}].concat(present.map((c) => ({label: c.label, coloring: c})));
    const buttons = choices.map((choice, i) => button(choice.label, i === 0, (self) => {
      buttons.forEach((other) => other.setAttribute("aria-pressed", other === self));
      show(choice.coloring);
    }));
    const wire = button("Wireframe", false, (self) => {
      const on = self.getAttribute("aria-pressed") !== "true";
      self.setAttribute("aria-pressed", on);
      models.forEach((model) => { model.front.wireframe = model.back.wireframe = on; });
      redraw();
    });
    const back = button("Reset camera", false, () => { reset(); redraw(); });
    back.removeAttribute("aria-pressed");
    const hint = document.createElement("small");
    hint.textContent = "Drag: turn. Right button: move. Click, then wheel: zoom.";
    bar.append(...buttons, wire, back, hint);
  }

  function addModel(index, gltf) {
    let loaded = null;
    gltf.scene.traverse((node) => { if (node.isMesh) loaded = node; });
    const geometry = loaded.geometry;
    const source = Object.assign({}, geometry.attributes);
    const front = new THREE.MeshLambertMaterial({side: THREE.FrontSide});
    const back = new THREE.MeshLambertMaterial({side: THREE.BackSide, color: INNER_SIDE});
    const group = new THREE.Group();
    group.add(new THREE.Mesh(geometry, front), new THREE.Mesh(geometry, back));
    scene.add(group);
    models[index] = {group: group, geometry: geometry, source: source, front: front, back: back};
  }

  function bytesOf(index) {
    const text = atob(document.getElementById("glb-" + index).textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    const link = document.getElementById("glb-link-" + index);
    link.href = URL.createObjectURL(new Blob([bytes], {type: "model/gltf-binary"}));
    return bytes.buffer;
  }

  function load(index) {
    return new Promise((resolve, reject) => {
      new THREE.GLTFLoader().parse(bytesOf(index), "", (gltf) => { addModel(index, gltf); resolve(); }, reject);
    });
  }

  function start() {
    show(null);
    reset();
    addButtons();
    draw();
    state.variance = variances().join(",");
    state.viewer = "drawn";
    controls.addEventListener("change", redraw);
    window.addEventListener("resize", redraw);
    new ResizeObserver(redraw).observe(stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  }

  Promise.all(panes.map((pane, index) => load(index)))
    .then(start)
    .catch((error) => fail("The viewer could not start: " + error.message));
})();
