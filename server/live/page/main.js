// Puts the page's parts together: each message from the server changes `world`, and the parts show it.
import { connect } from "./connection.js";
import { createCameraHand } from "./camera_hand.js";
import { createDriving } from "./driving.js";
import { createGamepad } from "./gamepad.js";
import { createHelp } from "./help.js";
import { createLinkHealth } from "./link_health.js";
import { createPanels } from "./panels.js";
import { createPictures } from "./pictures.js";
import { createTimeControls } from "./time_controls.js";
import { createWorld, takeHello, takeInventory, takeState } from "./world.js";
import { createWorlds } from "./worlds.js";

const world = createWorld();
let view = null;   // of the world in 3D
const chosen = () => world.robots.get(driving.chosen) ?? null;

const link = connect({
  open() {},
  closed() {
    world.you = 0;
    panels.interrupt();
    driving.closed();
    pictures.update();
  },
  hello(message) {
    takeHello(world, message);
    document.getElementById("world").textContent = world.name;
    pictures.update();
  },
  inventory(message) {
    takeInventory(world, message);
    driving.update();
    pictures.update();
    view?.syncObjects();
  },
  state(message) {
    takeState(world, message);
    driving.update();
    cameraHand.update();
    pictures.update();
    timeControls.update();
    panels.update();
  },
  placed(message) { driving.placed(message.robot); },
  refused(message) {
    driving.refused();
    // a word that was under way when its robot left, or was let go of: the line above the stick says so
    if (message.request !== "drive") health.refused(message.reason);
  },
});
const driving = createDriving(world, link);
const timeControls = createTimeControls(world, link, driving.ask, (words) => health.refused(words));
createHelp(driving.letGoOfKeys);
const panels = createPanels({ world, driving, view: () => view, shot: (camera) => pictures.shot(camera), complain: (words) => health.refused(words),
                              began: timeControls.began });
const pictures = createPictures(world, link, chosen, panels.bigView);
const cameraHand = createCameraHand(link, driving);
const health = createLinkHealth(world, link, driving.holding, pictures.oldest_ms);
driving.say = health.refused;
createWorlds(world, driving.letGoOfKeys, health.refused);
createGamepad(driving.hands, driving.changePace, health.refused);

// Driving and figures work without it. Where a browser has no WebGL the cameras take its place. Pictures wait for it: their streams never
// end, and those of a few windows are all the connections that a browser has to one server.
function showCamerasInstead() {
  view = null;
  panels.bigView.restore();
  document.body.dataset.view = "cameras";
  document.getElementById("view").replaceWith(document.getElementById("pictures"));
}
import("./view_3d.js").then(({ createView }) => {
  view = createView(world, panels.seen, link, driving, panels.chosen, health.refused, panels.bigView, showCamerasInstead);
  view.syncObjects();
  return view.shown;
}).catch((error) => {
  health.refused(`No 3D view, the cameras take its place: ${error.message}`);
  showCamerasInstead();
}).finally(pictures.start);
