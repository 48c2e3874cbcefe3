// The recorded robot and its simulations in the world of their run, and the paths of all on the floor.
import * as THREE from "/three/build/three.module.js";
import { exaggerated, stateAt } from "./playback_data.js";
import { makeRobot } from "./robot_model.js";
import { colour } from "./scene.js";
import { createStage, dispose } from "./stage.js";

const EYE = [-0.75, -1.5, 0.8];   // from the side: one drives ahead of the other
const SEE_THROUGH = 0.42;
// The recorded path is the broad one, under the others.
const BROAD_M = 0.05, NARROW_M = 0.018, RIBBON_STEP_M = 0.02;

function tint(root, hue) {
  root.traverse((part) => {
    part.castShadow = false;
    if (!part.material) return;
    part.material.color.set(hue);
    part.material.transparent = true;
    part.material.opacity = SEE_THROUGH;
    part.material.depthWrite = false;
    // where both are at the same place, the recorded robot is seen
    part.material.polygonOffset = true;
    part.material.polygonOffsetFactor = part.material.polygonOffsetUnits = 2;
  });
}

// The path of a body, with `factor` times its deviation from the recorded one.
function pathOf(run, body, factor) {
  const recorded = run.bodies[0].pose;
  if (factor === 1 || body.pose === recorded) return body.pose;
  const far = (name) => body.pose[name].map((value, i) => {
    const from = recorded?.[name][i] ?? null;
    return value === null || from === null ? null : from + factor * (value - from);
  });
  return { x: far("x"), y: far("y"), z: far("z") };
}

// The path as a flat strip `lower_m` under the body's middle.
function makeRibbon(run, body, hue, lower_m, factor) {
  const position = [], index = [], { x, y, z } = pathOf(run, body, factor);
  const half_m = (body.kind === "recorded" ? BROAD_M : NARROW_M) / 2;
  let last = null;   // of the strip so far
  run.t_s.forEach((_, i) => {
    if (x[i] === null || y[i] === null || z[i] === null) { last = null; return; }
    const from = last, way = from ? [x[i] - from.x, y[i] - from.y] : [0, 0], length = Math.hypot(...way);
    if (from && length < RIBBON_STEP_M) return;
    last = { x: x[i], y: y[i], z: z[i] };
    if (!from) return;
    const side = [-way[1] / length * half_m, way[0] / length * half_m], at = position.length / 3;
    for (const end of [from, last]) {
      position.push(end.x + side[0], end.y + side[1], end.z - lower_m, end.x - side[0], end.y - side[1], end.z - lower_m);
    }
    index.push(at, at + 1, at + 2, at + 2, at + 1, at + 3);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
  geometry.setIndex(index);
  return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: hue, side: THREE.DoubleSide }));
}

// `shown(kind)`: whether that body is to be seen; "paths": the strips. `gone()`: as of a stage.
export function createPlaybackView(list, shown, complain, gone) {
  const stage = createStage({ complain, gone, dressed: rebuild, eye: EYE, sharpens: true });
  let run = null, bodies = [], t = 0, factor = 1;
  const ribbonOf = ({ body, hue, lower_m }) => makeRibbon(run, body, hue, lower_m, factor);

  function rebuild() {
    for (const { model, ribbon } of bodies) {
      for (const object of [model.root, ribbon]) { stage.scene.remove(object); dispose(object); }
    }
    if (!run) return;
    bodies = run.bodies.filter((body) => body.pose).map((body, i) => {
      const model = makeRobot(list.robot), hue = colour(`--${body.kind}`);
      if (body.kind !== "recorded") tint(model.root, hue);
      // a little higher each, so that none hides in another
      const made = { body, model, hue, lower_m: list.robot.ride_height - 0.006 - 0.003 * i };
      made.ribbon = ribbonOf(made);
      stage.scene.add(model.root, made.ribbon);
      return made;
    });
    update(t);
  }

  function update(now_s) {
    t = now_s;
    let followed = null;
    const recorded = run ? stateAt(run, run.bodies[0], t) : null;
    for (const { body, model, ribbon, hue } of bodies) {
      const state = body.kind === "recorded" ? recorded : exaggerated(recorded, stateAt(run, body, t), factor);
      model.root.visible = Boolean(state) && shown(body.kind);
      ribbon.visible = shown("paths") && shown(body.kind);
      if (!state) continue;
      model.update(state, hue);
      followed ??= state;
    }
    if (followed) stage.follow(followed.p, followed.q);
    stage.redraw();
  }

  stage.start();
  return {
    update,
    picture: stage.drawn,
    // Draws `times` the deviations of the simulations.
    exaggerate(times) {
      factor = times;
      for (const each of bodies) {
        stage.scene.remove(each.ribbon);
        dispose(each.ribbon);
        each.ribbon = ribbonOf(each);
        stage.scene.add(each.ribbon);
      }
      update(t);
    },
    load(next, scenePath) {
      run = next;
      t = 0;
      return stage.show(scenePath);   // has the bodies built at once: the old ones are of another run
    },
  };
}
