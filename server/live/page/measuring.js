// The distance between two places that one points at: in all, horizontal, vertical, and the slope.
import * as THREE from "/three/build/three.module.js";
import { createAnnouncer } from "./announcer.js";
import { keyIsTaken } from "./dead_man.js";
import { fixed } from "./numbers.js";
import { colour } from "./scene.js";

const by = (id) => document.getElementById(id);
const MARK_M = 0.015;

// Between two places [x, y, z]; slope positive uphill. Pure.
export function measure(from, to) {
  const [dx, dy, dz] = to.map((value, k) => value - from[k]), horizontal_m = Math.hypot(dx, dy);
  return { distance_m: Math.hypot(horizontal_m, dz), horizontal_m, vertical_m: dz, slope_deg: Math.atan2(dz, horizontal_m) * 180 / Math.PI };
}

export function inWords({ distance_m, horizontal_m, vertical_m, slope_deg }) {
  return `${fixed(distance_m, 3)} m: horizontal ${fixed(horizontal_m, 3)} m, vertical ${fixed(vertical_m, 3)} m, slope ${fixed(slope_deg, 1)}\u00b0`;
}

export function createMeasuring(stage, pointing, letGoOfKeys, words) {
  const announce = createAnnouncer();
  const parent = new THREE.Group();
  const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false }));
  const marks = [0, 1].map(() => new THREE.Mesh(new THREE.OctahedronBufferGeometry(MARK_M), new THREE.MeshBasicMaterial({ depthTest: false })));
  parent.add(line, ...marks);
  for (const object of [line, ...marks]) {
    object.renderOrder = 11;
    object.frustumCulled = false;
    object.raycast = () => {};
  }
  stage.scene.add(parent);
  let from = null, to = null, done = false;

  function show(at) {
    const ends = [from ?? at, from ? to ?? at : null];
    marks.forEach((mark, i) => {
      mark.visible = ends[i] !== null;
      if (ends[i]) mark.position.copy(ends[i]);
    });
    line.visible = ends[0] !== null && ends[1] !== null;
    if (line.visible) {
      line.geometry.dispose();
      line.geometry = new THREE.BufferGeometry().setFromPoints(ends);
    }
    for (const object of [line, ...marks]) object.material.color.copy(colour("--force-body"));
    words.textContent = line.visible ? inWords(measure(ends[0].toArray(), ends[1].toArray())) + (done ? ". Esc ends." : "")
      : from ? "Click the second place." : "Click the first of two places; or arrows and Enter. Esc ends.";
    stage.redraw();
  }
  const task = {
    name: "measure",
    moved(p) { if (!done) show(p); },
    taken(p) {
      if (!p) return;
      if (from && !done) {
        to = p.clone();
        done = true;
      } else {
        from = p.clone();
        to = null;
        done = false;
      }
      show(p);
      announce.again(words.textContent);
    },
    ended() {
      parent.visible = false;
      words.textContent = "";
      words.hidden = true;
      by("measure").setAttribute("aria-pressed", "false");
    },
  };
  function toggle() {
    if (pointing.isOn("measure")) { pointing.end(); return; }
    letGoOfKeys();
    from = to = null;
    done = false;
    pointing.begin(task);   // ends the one before, which hides its words
    announce(words.textContent);
    parent.visible = true;
    words.hidden = false;
    by("measure").setAttribute("aria-pressed", "true");
  }
  parent.visible = false;
  by("measure").addEventListener("click", toggle);
  addEventListener("keydown", (event) => {
    if (event.code === "KeyM" && !event.repeat && !keyIsTaken(event) && stage.canvas.isConnected) toggle();
  });
}
