// What is shown of the world, and when: now, or a moment that one looks back at. The panels around the 3D view, put together.
import { createBigView } from "./big_view.js";
import { createHistory } from "./history.js";
import { createInstruments } from "./instruments.js";
import { createPast } from "./past.js";
import { penOf } from "./pen.js";
import { createPlots } from "./plots.js";
import { createPosture } from "./posture.js";
import { createSaving } from "./saving.js";
import { createTimeLine } from "./time_line.js";
import { createTimeWindow } from "./time_window.js";

async function pngOf(jpeg) {
  const image = await createImageBitmap(jpeg), canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.width, image.height];
  penOf(canvas).drawImage(image, 0, 0);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

// `view()`: of the world in 3D, or null. `shot(camera)`: a promise of its newest picture (pictures.js). `complain` is called with what is wrong, in words;
// `began` when time began anew.
export function createPanels({ world, driving, view, shot, complain, began }) {
  const history = createHistory(), chosen = () => driving.chosen;
  let bodies = "";

  function show() {
    const robot = past.seen.robots.get(driving.chosen) ?? null;
    instruments.update(robot);
    posture.update(robot);
    timeLine.update();
    plots.update();
    const now = JSON.stringify([[...past.seen.robots.keys()], past.seen.boxes.map(({ about }) => about.id)]);
    if (now !== bodies) view()?.syncObjects();
    bodies = now;
    view()?.update();
  }
  async function picture() {
    const figure = bigView.large();
    if (figure) {
      const taken = await shot(figure.dataset.camera);
      if (!taken) throw new Error("the camera has sent none yet");
      return { name: figure.dataset.camera, blob: await pngOf(taken.jpeg), t: taken.time_s };
    }
    if (!view()) throw new Error("the world is not drawn here");
    return { name: "3D", blob: await view().picture(), t: past.shown_s() };
  }

  const past = createPast(world, history, {
    begin: driving.letGoOfKeys,
    show() { show(); plots.draw(); },
    mine: driving.holding,
  });
  const timeWindow = createTimeWindow(history, past);
  const instruments = createInstruments((signal) => plots.toggle(signal), (signal) => plots.show(signal));
  const posture = createPosture();
  const plots = createPlots(history, past, timeWindow, chosen, instruments.mark);
  const timeLine = createTimeLine(history, past, timeWindow, plots.draw);
  const bigView = createBigView(past, driving.letGoOfKeys);
  createSaving(history, past, timeWindow, chosen, picture, complain);
  driving.lookingBack = past.isBack;
  driving.live = past.live;

  return {
    seen: past.seen,
    // The robot that is chosen, as it is shown.
    chosen: () => past.seen.robots.get(driving.chosen) ?? null,
    interrupt: history.interrupt,
    bigView,
    update() {
      const anew = history.take(world);
      if (anew) {
        driving.letGoOfKeys();   // a reset: where keys drove to, the robot is no more
        began();
      }
      past.update(anew);
      show();
    },
  };
}
