// A canvas with the world in 3D: ground, light, and a point of view that follows a place, stays behind it, or is free.
// The objects in the world are put there by others (view_3d.js, playback_view.js).
import * as THREE from "/three/build/three.module.js";
import { OrbitControls } from "/three/examples/jsm/controls/OrbitControls.js";
import { createPictureQuality } from "./picture_quality.js";
import { colour, fetchScene, makeScene } from "./scene.js";

const MODES = ["follow", "behind", "free"];
const STILL_MS = 300;
const QUALITIES = [{ shadows: true, ratio: 2 }, { shadows: false, ratio: 1 }, { shadows: false, ratio: 0.5 }, { shadows: false, ratio: 0.25 }];

export function dispose(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.map?.dispose();
    part.material?.dispose();
  });
}

// `dressed()` is called when the colours or the world have changed; `complain` is called with what is missing, in words; `gone()` when the
// browser has taken the picture away, as it does when a graphics driver fails; `eye` is where one looks from at first, seen from what is
// followed. `sharpens`: a picture that was made simpler is drawn in full when nothing moves.
export function createStage({ complain, gone = () => {}, dressed = () => {}, eye = [-1.6, -1.5, 1.25], sharpens = false }) {
  const canvas = document.getElementById("canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  const scene = new THREE.Scene(), sky = new THREE.HemisphereLight(0xffffff, 0xb5b0a4, 0.8);
  const sun = new THREE.DirectionalLight(0xfff4e0, 0.6);
  canvas.addEventListener("webglcontextlost", gone);
  const camera = new THREE.PerspectiveCamera(45, 1, 0.05, 300);
  camera.up.set(0, 0, 1);
  camera.position.set(...eye);
  const controls = new OrbitControls(camera, canvas);
  controls.enableKeys = false;   // the keys drive, or play
  controls.maxPolarAngle = 0.495 * Math.PI;
  controls.minDistance = 0.4;
  controls.maxDistance = 60;

  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  Object.assign(sun.shadow.camera, { left: -3, right: 3, top: 3, bottom: -3, near: 0.5, far: 20 });
  sun.shadow.bias = -0.001;
  scene.add(sky, sun, sun.target);

  const quality = createPictureQuality(QUALITIES.length);
  let mode = "follow", dirty = true, drawn_ms = 0, sharp = true;
  const at = new THREE.Vector3();

  let bytes = null, shows = 0, fixed = new THREE.Group();   // what never moves
  function dress() {   // in light or dark
    scene.background = colour("--sky");
    scene.fog = new THREE.Fog(scene.background, 25, 120);
    scene.remove(fixed);
    dispose(fixed);
    scene.add(fixed = bytes ? makeScene(bytes) : new THREE.Group());
    dressed();
    dirty = true;
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", dress);
  controls.addEventListener("change", () => { dirty = true; });
  new ResizeObserver(() => { dirty = true; }).observe(canvas.parentElement);

  function choose(next) {
    mode = next;
    for (const name of MODES) document.getElementById(`view-${name}`).setAttribute("aria-pressed", `${name === mode}`);
    dirty = true;
  }
  for (const name of MODES) document.getElementById(`view-${name}`).addEventListener("click", () => choose(name));

  function fit(most) {
    const width = canvas.parentElement.clientWidth, height = canvas.parentElement.clientHeight;
    const ratio = Math.min(most, devicePixelRatio), size = renderer.getSize(new THREE.Vector2());
    if (size.x === width && size.y === height && renderer.getPixelRatio() === ratio) return;
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    camera.aspect = width / Math.max(1, height);
    camera.updateProjectionMatrix();
  }

  function draw(now_ms) {
    if (!canvas.isConnected) return;   // cameras have taken its place
    requestAnimationFrame(draw);
    if (!dirty && !sharp && sharpens && now_ms > drawn_ms + STILL_MS) {
      sharp = true;
      fit(QUALITIES[0].ratio);
      renderer.render(scene, camera);
      drawn_ms = performance.now();
    }
    // at most a third of the time
    if (!dirty || now_ms < drawn_ms + 2 * quality.mean_ms) return;
    dirty = false;
    fit(QUALITIES[quality.level].ratio);
    sharp = QUALITIES[quality.level].ratio >= devicePixelRatio;
    controls.update();
    const began = performance.now();
    renderer.render(scene, camera);
    renderer.getContext().finish();
    drawn_ms = performance.now();
    if (quality.took(drawn_ms - began, drawn_ms)) sun.castShadow = renderer.shadowMap.enabled = QUALITIES[quality.level].shadows;
  }

  return {
    scene,
    redraw() { dirty = true; },
    // What it shows now as PNG, drawn in full; a promise of a Blob.
    picture() {
      fit(QUALITIES[0].ratio);
      renderer.render(scene, camera);   // just before it is read: afterwards a browser may have cleared it
      dirty = true;
      return new Promise((done) => canvas.toBlob(done, "image/png"));
    },
    // Shows that world, and from now on none before it; `path` is where the server has its bytes.
    show(path) {
      const number = ++shows, newest = () => number === shows;
      bytes = null;
      dress();
      return fetchScene(path).then((answer) => { if (newest()) { bytes = answer; dress(); } })
        .catch((error) => { if (newest()) complain(`The world cannot be shown: ${error.message}`); });
    },
    // Looks at the place p = [x, y, z] by the mode; behind it is where a robot with the rotation q = [w, x, y, z] has come from.
    follow(p, [w, x, y, z]) {
      at.fromArray(p);
      if (mode !== "free") {
        camera.position.add(at).sub(controls.target);   // the same look at it, wherever it is
        controls.target.copy(at);
      }
      if (mode === "behind") {
        const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
        const reach = 0.8 * camera.position.distanceTo(at);
        const wanted = new THREE.Vector3(at.x - reach * Math.cos(yaw), at.y - reach * Math.sin(yaw), at.z + 0.6 * reach);
        camera.position.lerp(wanted, 0.15);
      }
      sun.target.position.copy(at);
      sun.position.set(at.x - 1, at.y - 5, at.z + 7);
      dirty = true;
    },
    start() {
      dress();
      requestAnimationFrame(draw);
    },
  };
}
