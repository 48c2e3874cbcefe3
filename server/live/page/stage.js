// A canvas with the world in 3D: ground, light, and a point of view that follows a place, stays behind it, or is free.
// The objects in the world are put there by others (view_3d.js, playback_view.js).
import * as THREE from "/three/build/three.module.js";
import { OrbitControls } from "/three/examples/jsm/controls/OrbitControls.js";
import { createPictureQuality } from "./picture_quality.js";
import { createPointOfView } from "./point_of_view.js";
import { colour, fetchScene, makeScene } from "./scene.js";

const STILL_MS = 300;
const SUN_M = [-1, -5, 7];     // from what is followed
const HIGHEST_M = 1000;   // above all ground
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
  // These controls take all fingers on the screen for theirs, and never hear that the browser has taken one away.
  for (const name of ["touchstart", "touchmove", "touchend"]) {
    canvas.addEventListener(name, (event) => Object.defineProperty(event, "touches", { value: event.targetTouches }), { capture: true });
  }
  canvas.addEventListener("touchcancel", () => canvas.dispatchEvent(new Event("touchend")));
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
  sun.position.set(...SUN_M);

  const quality = createPictureQuality(QUALITIES.length);
  let dirty = true, drawn_ms = 0, sharp = true;
  const view = createPointOfView(camera, controls, () => { dirty = true; });

  // What a line in the scene stands for.
  function tellScale(contour_m) {
    const words = document.getElementById("view-scale");
    if (words) words.textContent = contour_m ? `Grid 1 m, contours ${contour_m < 0.1 ? `${Math.round(1000 * contour_m)} mm` : `${contour_m} m`}` : "";
  }
  let bytes = null, shows = 0, fixed = new THREE.Group();   // what never moves
  function dress() {   // in light or dark
    scene.background = colour("--sky");
    scene.fog = new THREE.Fog(scene.background, 25, 120);
    scene.remove(fixed);
    dispose(fixed);
    scene.add(fixed = bytes ? makeScene(bytes) : new THREE.Group());
    tellScale(fixed.userData.contour_m);
    dressed();
    dirty = true;
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", dress);
  controls.addEventListener("change", () => { dirty = true; });
  new ResizeObserver(() => { dirty = true; }).observe(canvas.parentElement);

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

  function drawn() {
    fit(QUALITIES[0].ratio);
    renderer.render(scene, camera);
    dirty = true;
    return canvas;
  }

  const caster = new THREE.Raycaster();
  const first = (objects) => caster.intersectObjects(objects, true).find(({ object }) => object.isMesh && object.visible) ?? null;
  return {
    scene,
    canvas,
    camera,
    chooseView: view.choose,
    // The first of `objects` and of what never moves, that is seen at a place of the window: {point, object, ...} of three.js, or null.
    pick(x, y, objects) {
      const box = canvas.getBoundingClientRect();
      caster.setFromCamera(new THREE.Vector2((x - box.x) / box.width * 2 - 1, 1 - (y - box.y) / box.height * 2), camera);
      return first([fixed, ...objects]);
    },
    // The highest surface above or below a place, with `objects`, or null.
    groundAt(x, y, objects) {
      caster.set(new THREE.Vector3(x, y, HIGHEST_M), new THREE.Vector3(0, 0, -1));
      return first([fixed, ...objects])?.point ?? null;
    },
    // Where one looks, and the direction of the screen's upper edge on the ground, as an angle about z.
    middle: () => controls.target.clone(),
    heading() {
      const ahead = camera.getWorldDirection(new THREE.Vector3());
      if (Math.hypot(ahead.x, ahead.y) < 1e-6) ahead.set(0, 1, 0).applyQuaternion(camera.quaternion);
      return Math.atan2(ahead.y, ahead.x);
    },
    redraw() { dirty = true; },
    // The canvas as it is now, drawn in full, to be copied at once: the browser clears it afterwards.
    drawn,
    // The same as PNG; a promise of a Blob.
    picture: () => new Promise((done) => drawn().toBlob(done, "image/png")),
    // Shows that world, and from now on none before it; `path` is where the server has its bytes.
    show(path) {
      const number = ++shows, newest = () => number === shows;
      bytes = null;
      dress();
      return fetchScene(path).then((answer) => { if (newest()) { bytes = answer; dress(); } })
        .catch((error) => { if (newest()) complain(`The world cannot be shown: ${error.message}`); });
    },
    // Looks at the place p = [x, y, z] by the mode; behind it is where a robot with the rotation q = [w, x, y, z] has come from.
    follow(p, q) {
      const at = view.follow(p, q);
      sun.target.position.copy(at);
      sun.position.set(...SUN_M).add(at);
      dirty = true;
    },
    start() {
      dress();
      requestAnimationFrame(draw);
    },
  };
}
