// The live world in 3D: its robots and the boxes that move.
import * as THREE from "/three/build/three.module.js";
import { keyIsTaken } from "./dead_man.js";
import { createMeasuring } from "./measuring.js";
import { createPlacing } from "./placing.js";
import { MODES } from "./point_of_view.js";
import { createPointing } from "./pointing.js";
import { makeRobot } from "./robot_model.js";
import { makeBox, pose } from "./scene.js";
import { createLayers } from "./scene_layers.js";
import { createStage, dispose } from "./stage.js";

// Of the deck: what a robot is up to.
const DECK = { fault: 0xb03a2e, mine: 0x1d6fb8, silent: 0x7a7f7b, usual: 0x2f7a60 };

const MARK_OVER_M = 0.4;

// `complain` is called with what is missing, in words; `gone()` when the browser has taken the picture away. `shown`: a promise, kept when the world is there or its want was complained of.
// `seen`: the world as it is shown (past.js). `bigView`: of big_view.js.
export function createView(live, seen, link, driving, chosen, complain, bigView, gone) {
  const robots = new Map();
  let boxes = [];
  const stage = createStage({ complain, gone() { pointing.end(); gone(); }, dressed() { boxes = rebuildBoxes(); } });
  const { scene } = stage;
  // Over the chosen robot, where there are several.
  const mark = new THREE.Mesh(new THREE.ConeBufferGeometry(0.04, 0.09, 12), new THREE.MeshLambertMaterial({ color: DECK.mine }));
  mark.rotation.x = -Math.PI / 2;   // its tip down
  mark.visible = false;
  scene.add(mark);
  const layers = createLayers(stage, live, seen, link, chosen);
  const words = document.getElementById("pointing-words");
  const solids = () => boxes.map(({ object }) => object);
  const models = () => [...robots.values()].map(({ root }) => root);
  const pointing = createPointing(stage, solids, { clicked: selectAt, begins: bigView.showWorld, changed: driving.update });
  bigView.whenCamera = pointing.end;
  createPlacing(stage, live, pointing, driving, words);
  createMeasuring(stage, pointing, driving.letGoOfKeys, words);
  driving.isPointing = () => pointing.isOn();

  // A click on a robot chooses it; one that is made while driving is a slip.
  function selectAt(x, y) {
    if (driving.hands.areFull()) return;
    const found = stage.pick(x, y, [...solids(), ...models()]);
    for (let part = found?.object; part; part = part.parent) {
      const hit = [...robots].find(([, { root }]) => root === part);
      if (hit) driving.choose(hit[0]);
    }
  }

  // 5 to 9: the points of view in the order of their buttons.
  addEventListener("keydown", (event) => {
    const mode = /^Digit[5-9]$/.test(event.code) && MODES[Number(event.code.slice(5)) - 5];
    if (mode && !event.repeat && !keyIsTaken(event)) stage.chooseView(mode);
  });

  function rebuildBoxes() {
    for (const { object } of boxes) { scene.remove(object); dispose(object); }
    return seen.boxes.map(({ about }) => {
      const object = makeBox(about.size);
      scene.add(object);
      return { object };
    });
  }

  function syncObjects() {
    for (const [id, model] of robots) {
      if (seen.robots.has(id)) continue;
      scene.remove(model.root);
      dispose(model.root);
      robots.delete(id);
    }
    for (const [id, { about }] of seen.robots) {
      if (robots.has(id)) continue;
      robots.set(id, makeRobot(about));
      scene.add(robots.get(id).root);
    }
    boxes = rebuildBoxes();
    stage.redraw();
  }

  function deck(now) {
    if (now.fault) return DECK.fault;
    if (now.holder === seen.you) return DECK.mine;
    return now.client?.silent ? DECK.silent : DECK.usual;
  }

  function update() {
    for (const [id, model] of robots) {
      const { now } = seen.robots.get(id) ?? {};
      model.root.visible = Boolean(now);
      if (now) model.update(now, deck(now));
    }
    seen.boxes.forEach(({ now }, i) => { if (now && boxes[i]) pose(boxes[i].object, now.p, now.q); });
    const robot = chosen();
    mark.visible = Boolean(robot?.now) && seen.robots.size > 1;
    if (mark.visible) mark.position.set(robot.now.p[0], robot.now.p[1], robot.now.p[2] + MARK_OVER_M);
    if (robot?.now) stage.follow(robot.now.p, robot.now.q);
    layers.update();
    stage.redraw();
  }

  stage.start();
  return { syncObjects, update, picture: stage.picture, shown: stage.show("/scene") };
}
