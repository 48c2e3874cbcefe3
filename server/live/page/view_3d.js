// The live world in 3D: its robots and the boxes that move.
import { makeRobot } from "./robot_model.js";
import { makeBox, pose } from "./scene.js";
import { createStage, dispose } from "./stage.js";

const HULL = { fault: 0xb03a2e, mine: 0x1d6fb8, silent: 0x7a7f7b, usual: 0x2f7a60 };

// `complain` is called with what is missing, in words; `gone()` when the browser has taken the picture away. `shown`: a promise, kept when the world is there or its want was complained of.
export function createView(world, chosen, complain, gone) {
  const robots = new Map();
  let boxes = [];
  const stage = createStage({ complain, gone, dressed() { boxes = rebuildBoxes(); } });
  const { scene } = stage;

  function rebuildBoxes() {
    for (const { object } of boxes) { scene.remove(object); dispose(object); }
    return world.boxes.map(({ about }) => {
      const object = makeBox(about.size);
      scene.add(object);
      return { object };
    });
  }

  function syncObjects() {
    for (const [id, model] of robots) {
      if (world.robots.has(id)) continue;
      scene.remove(model.root);
      dispose(model.root);
      robots.delete(id);
    }
    for (const [id, { about }] of world.robots) {
      if (robots.has(id)) continue;
      robots.set(id, makeRobot(about));
      scene.add(robots.get(id).root);
    }
    boxes = rebuildBoxes();
    stage.redraw();
  }

  function hull(now) {
    if (now.fault) return HULL.fault;
    if (now.holder === world.you) return HULL.mine;
    return now.client?.silent ? HULL.silent : HULL.usual;
  }

  function update() {
    for (const [id, model] of robots) {
      const { now } = world.robots.get(id) ?? {};
      model.root.visible = Boolean(now);
      if (now) model.update(now, hull(now));
    }
    world.boxes.forEach(({ now }, i) => { if (now && boxes[i]) pose(boxes[i].object, now.p, now.q); });
    const robot = chosen();
    if (robot?.now) stage.follow(robot.now.p, robot.now.q);
    stage.redraw();
  }

  stage.start();
  return { syncObjects, update, picture: stage.picture, shown: stage.show("/scene") };
}
