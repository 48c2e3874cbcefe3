// Where one looks from: it follows a place from where one is, stays behind or beside it, looks down on it, or is free. A drag turns the
// view in all of them; turned away from behind, from beside or from above, it goes on as "follow". Kept over a reload.
import * as THREE from "/three/build/three.module.js";
import { keepHere, recallHere } from "./kept.js";

export const MODES = ["follow", "behind", "top", "side", "free"];
const LEAST_REACH_M = 2;       // of a view that was just chosen, so that the robot is seen with what is around it
const EASE = 0.15;             // share of the way to its place that the view goes with each state
const AWAY_RAD = 0.15;         // turned so far by hand, a view is no longer from there

// From what is looked at to the eye, for a heading of yaw; x forward, y left, z up.
const directions = {
  behind: (yaw) => new THREE.Vector3(-0.857 * Math.cos(yaw), -0.857 * Math.sin(yaw), 0.514),
  side: (yaw) => new THREE.Vector3(0.98 * Math.sin(yaw), -0.98 * Math.cos(yaw), 0.2),
  // not quite from above: x is up on the screen
  top: () => new THREE.Vector3(-0.01, 0, 1),
};

// `changed()`: when the picture is to be drawn again.
export function createPointOfView(camera, controls, changed) {
  const at = new THREE.Vector3();
  let mode = "follow", yaw = 0, dragged = false;

  const offset = () => camera.position.clone().sub(controls.target);
  function show() {
    for (const name of MODES) document.getElementById(`view-${name}`)?.setAttribute("aria-pressed", `${name === mode}`);
    keepHere("view-mode", mode);
    changed();
  }
  function choose(next) {
    mode = next;
    if (directions[mode]) {
      const reach = Math.max(LEAST_REACH_M, offset().length());
      camera.position.copy(controls.target).addScaledVector(directions[mode](yaw).normalize(), reach);
    }
    show();
  }
  for (const name of MODES) document.getElementById(`view-${name}`)?.addEventListener("click", () => choose(name));

  controls.addEventListener("start", () => { dragged = true; });
  controls.addEventListener("end", () => {
    dragged = false;
    if (directions[mode] && offset().angleTo(directions[mode](yaw)) > AWAY_RAD) {
      mode = "follow";
      show();
    }
  });

  const kept = recallHere("view-eye");
  if (MODES.includes(recallHere("view-mode"))) mode = recallHere("view-mode");
  if (kept?.position?.length === 3 && kept?.target?.length === 3 && [...kept.position, ...kept.target].every(Number.isFinite)) {
    controls.target.fromArray(kept.target);
    camera.position.fromArray(kept.position);
  }
  addEventListener("pagehide", () => keepHere("view-eye", { position: camera.position.toArray(), target: controls.target.toArray() }));
  show();

  return {
    choose,
    // Looks at the place p = [x, y, z] of a robot with the rotation q = [w, x, y, z].
    follow(p, [w, x, y, z]) {
      at.fromArray(p);
      yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
      if (mode === "free") return at;
      camera.position.add(at).sub(controls.target);   // the same look at it, wherever it is
      controls.target.copy(at);
      if ((mode === "behind" || mode === "side") && !dragged) {
        const reach = offset().length(), wanted = at.clone().addScaledVector(directions[mode](yaw).normalize(), reach);
        const eye = camera.position.clone().lerp(wanted, EASE).sub(at);
        camera.position.copy(at).addScaledVector(eye.normalize(), reach);   // as far as before
      }
      return at;
    },
  };
}
