// Where robots have been in the last minutes: a strip each, under the robot's middle. Cleared when time goes back, as by a reset.
import * as THREE from "/three/build/three.module.js";
import { colour } from "./scene.js";

const STEP_M = 0.03;         // from place to place; between them nothing is kept
const MOST = 4000;           // places: 120 m
const KEPT_S = 300;          // of robot time
const HALF_WIDTH_M = 0.02;
const OVER_GROUND_M = 0.012;
const HUES = ["--c1", "--c2", "--accent", "--c3"];

// Places thinned by distance, the oldest first: { p, side, t, jump }. `jump`: the robot was put here, and did not drive. Pure.
export function createPlaces() {
  const places = [];
  return {
    places,
    // Returns whether there are others than before. `fastest_mps`: of the robot.
    add(p, side, t, fastest_mps) {
      const last = places.at(-1);
      if (last && t < last.t) places.length = 0;
      const before = places.at(-1), way_m = before ? Math.hypot(...p.map((value, k) => value - before.p[k])) : Infinity;
      const young = places.findIndex((place) => place.t >= t - KEPT_S);
      const cut = Math.max(young < 0 ? places.length : young, places.length - MOST + 1);
      if (cut > 0) places.splice(0, cut);
      if (way_m < STEP_M) return cut > 0;
      // falls and slides are quicker than the drives
      const jump = !before || way_m > STEP_M + 0.3 + 3 * fastest_mps * (t - before.t);
      places.push({ p: [...p], side: [...side], t, jump });
      return true;
    },
    clear() { places.length = 0; },
  };
}

function stripOf(places) {
  const position = [], index = [];
  places.forEach(({ p, side, jump }, i) => {
    for (const way of [-HALF_WIDTH_M, HALF_WIDTH_M]) position.push(...p.map((value, k) => value + way * side[k]));
    if (!jump && i > 0) index.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
  geometry.setIndex(index);
  return geometry;
}

export function createTrails(scene) {
  const trails = new Map();
  let time_s = -Infinity, visible = false;

  function remove(id) {
    const { strip } = trails.get(id);
    scene.remove(strip);
    strip.geometry.dispose();
    strip.material.dispose();
    trails.delete(id);
  }
  return {
    // Also while it is not shown: it is there when it is switched on.
    update(robots, now_s) {
      if (now_s < time_s) for (const id of [...trails.keys()]) remove(id);
      time_s = now_s;
      for (const id of [...trails.keys()]) if (!robots.has(id)) remove(id);
      for (const [id, { about, now }] of robots) {
        if (!now || now.p.some((value) => value === null)) continue;
        if (!trails.has(id)) {
          const strip = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
          strip.frustumCulled = false;
          scene.add(strip);
          trails.set(id, { strip, kept: createPlaces(), drawn: 0 });
        }
        const trail = trails.get(id);
        const q = new THREE.Quaternion(now.q[1], now.q[2], now.q[3], now.q[0]);
        const under = new THREE.Vector3(0, 0, OVER_GROUND_M - about.ride_height).applyQuaternion(q).add(new THREE.Vector3(...now.p));
        const side = new THREE.Vector3(0, 1, 0).applyQuaternion(q);
        const changed = trail.kept.add(under.toArray(), side.toArray(), now_s, about.max_speed);
        if (visible && (changed || !trail.strip.visible)) {
          trail.strip.geometry.dispose();
          trail.strip.geometry = stripOf(trail.kept.places);
        }
        trail.strip.visible = visible;
        trail.strip.material.color.copy(colour(HUES[id % HUES.length]));
      }
    },
    show(on) { visible = on; },
    // How many places are kept, of all robots.
    count: () => [...trails.values()].reduce((sum, { kept }) => sum + kept.places.length, 0),
  };
}
