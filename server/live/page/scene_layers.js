// What can be shown in the scene on top, each switched by a key and a button, and kept over a reload: contact forces, trails, sensors.
// What needs more from the server is asked for only while it is shown, and not by a page that nobody sees.
import { createContactForces } from "./contact_forces.js";
import { keyIsTaken } from "./dead_man.js";
import { createSensorRays } from "./sensor_rays.js";
import { createTrails } from "./trail.js";
import { keepHere, recallHere } from "./kept.js";

const by = (id) => document.getElementById(id);
const KEYS = { KeyN: "forces", KeyB: "trail", KeyY: "sensors" };

// `seen`: the world as it is shown (past.js). `chosen()`: the robot whose forces and sensors are shown, or null. Both are shown live alone:
// what was is kept without them.
export function createLayers(stage, world, seen, link, chosen) {
  const on = Object.fromEntries(Object.values(KEYS).map((name) => [name, recallHere(`show-${name}`) === true]));
  const forces = createContactForces(stage.scene, by("forces-words"));
  const trails = createTrails(stage.scene);
  const sensors = createSensorRays(stage.scene, by("sensor-words"));
  let asked = "";   // of this connection

  function ask() {
    const message = { type: "show", contacts: on.forces && !document.hidden, sensors: on.sensors && !document.hidden ? chosen()?.about.id ?? 0 : 0 };
    const text = `${world.you} ${JSON.stringify(message)}`;
    const none = !message.contacts && message.sensors === 0;
    if (text === asked || !world.you || (none && !asked.startsWith(`${world.you} `))) return;   // a new connection shows nothing
    asked = text;
    link.send(message);
  }

  function update() {
    ask();
    const isLive = seen.robots === world.robots;
    if (on.forces && isLive) forces.update(world.robots, chosen(), world.time_s); else forces.hide();
    if (on.sensors && isLive) sensors.update(chosen()); else sensors.hide();
    if (!isLive) by("forces-words").textContent = by("sensor-words").textContent = "Live only";
    trails.show(on.trail);
    trails.update(world.robots, world.time_s);
    stage.redraw();
  }
  function show() {
    for (const name of Object.keys(on)) by(`show-${name}`).setAttribute("aria-pressed", `${on[name]}`);
    by("forces-words").hidden = !on.forces;
    by("sensor-words").hidden = !on.sensors;
    update();
  }
  function toggle(name) {
    on[name] = !on[name];
    keepHere(`show-${name}`, on[name]);
    show();
  }

  for (const name of Object.keys(on)) by(`show-${name}`).addEventListener("click", () => toggle(name));
  addEventListener("keydown", (event) => {
    if (KEYS[event.code] && !event.repeat && !keyIsTaken(event) && stage.canvas.isConnected) toggle(KEYS[event.code]);
  });
  show();
  return { update, trails };
}
