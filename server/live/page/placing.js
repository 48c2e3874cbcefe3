// Placing a robot where one points: its ghost follows the pointer, a click or Enter places it, Esc does not.
import * as THREE from "/three/build/three.module.js";
import { createAnnouncer } from "./announcer.js";
import { makeRobot } from "./robot_model.js";
import { dispose } from "./stage.js";

const TURN_RAD = Math.PI / 12;
const UP = new THREE.Vector3(0, 0, 1);

function makeGhost(about) {
  const model = makeRobot(about);
  model.root.traverse((part) => {
    part.castShadow = false;
    if (!part.material) return;
    part.material.transparent = true;
    part.material.opacity = 0.55;
    part.material.depthWrite = false;
  });
  return model;
}

// `words`: the element for what to do.
export function createPlacing(stage, world, pointing, driving, words) {
  const announce = createAnnouncer();
  let ghost = null, yaw = 0, place = null;

  function show() {
    if (!ghost) return;
    ghost.root.visible = place !== null;
    if (!place) return;
    const q = new THREE.Quaternion().setFromAxisAngle(UP, yaw), { x, y, z } = place;
    const flat = world.placeable.flipper ? [1, 1, 1, 1] : [];
    ghost.update({ p: [x, y, z + world.placeable.ride_height], q: [q.w, q.x, q.y, q.z], track_m: [0, 0], flipper: flat }, 0x1d6fb8);
    stage.redraw();
  }
  const task = {
    name: "place",
    moved(p) {
      place = p;
      show();
    },
    taken(p) {
      const where = p ? { p: p.toArray(), yaw } : {};
      pointing.end();
      driving.place(where);
    },
    key(code) {
      if (code !== "Comma" && code !== "Period") return false;
      yaw += code === "Comma" ? TURN_RAD : -TURN_RAD;
      show();
      return true;
    },
    ended() {
      if (ghost) {
        stage.scene.remove(ghost.root);
        dispose(ghost.root);
      }
      ghost = place = null;
      words.textContent = "";
      words.hidden = true;
      document.getElementById("place").setAttribute("aria-pressed", "false");
    },
  };
  // The robot that one held stays held, and stands: keys point now.
  driving.beforePlacing = () => {
    if (!stage.canvas.isConnected) return false;
    if (pointing.isOn("place")) {
      pointing.end();
      return true;
    }
    driving.letGoOfKeys();
    driving.live();
    pointing.begin(task);
    yaw = 0;
    if (world.placeable) {
      ghost = makeGhost(world.placeable);
      stage.scene.add(ghost.root);
    }
    show();
    words.textContent = "Click where it is to stand, or arrows and Enter; comma, full stop: turn. Enter alone: at a free start. Esc: cancel.";
    words.hidden = false;
    announce.again(words.textContent);
    document.getElementById("place").setAttribute("aria-pressed", "true");
    return true;
  };
}
