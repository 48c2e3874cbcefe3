// What the cameras of the chosen robot see, and how old it is. A stream is closed when nobody sees it, so that the server draws nothing
// for a hidden page. Nothing is fetched before start().
import { readPictures } from "./picture_stream.js";

const MOST = 4;            // a browser has six connections to one server
const AGAIN_MS = 1000;     // after a stream broke
const OLD_MS = 500;        // while time runs: something is too slow
const KEPT = 200;          // frames whose time is known

// `bigView`: of big_view.js, which may have one of the pictures.
export function createPictures(world, link, chosen, bigView) {
  const section = document.getElementById("pictures");
  let started = false, shown = "", figures = [];

  // When the camera saw the frame, by this page's clock, later by the way: by the states, which say when the server had it, and by its own
  // stamp. The stamp is from when it was sent, so it lacks the time that the picture waited on its way; the earlier of the two is right.
  function seen_ms(figure, part) {
    return Math.min(performance.now() - part.age_ms, figure.seen.get(part.number) ?? Infinity);
  }
  function note(figure, camera) {
    if (camera?.n === undefined || figure.seen.has(camera.n)) return;
    figure.seen.set(camera.n, performance.now() - 1000 * camera.age);
    if (figure.seen.size > KEPT) figure.seen.delete(figure.seen.keys().next().value);
  }
  // With the way as it is known now: that of a page that has just been busy is corrected by the next answer.
  const age_ms = (figure) => performance.now() - figure.seen_ms + link.way_ms();

  function show(figure, part) {
    figure.jpeg = new Blob([part.jpeg], { type: "image/jpeg" });
    const url = URL.createObjectURL(figure.jpeg);
    const { picture } = figure, before = picture.src;
    picture.src = url;
    if (before) URL.revokeObjectURL(before);
    figure.seen_ms = seen_ms(figure, part);
  }

  async function read(figure) {
    while (!figure.ended.signal.aborted) {
      try {
        await readPictures(figure.picture.dataset.stream, figure.ended.signal, (part) => show(figure, part));
      } catch {
        await new Promise((again) => setTimeout(again, AGAIN_MS));
      }
    }
  }

  function clear(words) {
    bigView.built([]);
    for (const { ended, picture } of figures) {
      ended.abort();
      if (picture.src) URL.revokeObjectURL(picture.src);
    }
    figures = [];
    const none = document.createElement("p");
    none.className = "none";
    none.textContent = words;
    section.replaceChildren(none);
  }

  function build(robot) {
    clear("");
    section.replaceChildren();
    figures = robot.cameras.slice(0, MOST).map((camera) => {
      const frame = document.createElement("figure"), caption = document.createElement("figcaption");
      const name = document.createElement("span"), age = document.createElement("output"), picture = document.createElement("img");
      name.textContent = camera.name;
      age.title = "Time since the camera saw this, with the way through the network";
      age.ariaLabel = `Age of the picture of ${camera.name}`;
      age.ariaLive = "off";
      caption.append(name, " ", age);
      picture.alt = `Picture of the camera ${camera.name}`;
      picture.dataset.stream = `/camera/${encodeURIComponent(robot.view)}/${encodeURIComponent(camera.name)}.mjpg`;
      const enlarge = document.createElement("button");
      enlarge.type = "button";
      enlarge.className = "picture";
      enlarge.append(document.createElement("span"), picture);
      frame.dataset.camera = camera.name;
      frame.append(enlarge, caption);
      section.append(frame);
      const figure = { camera: camera.name, picture, jpeg: null, age, ended: new AbortController(), seen: new Map(), seen_ms: null };
      read(figure);
      return figure;
    });
    bigView.built([...section.children]);
  }

  const ages_ms = () => figures.filter((figure) => figure.seen_ms !== null).map(age_ms);

  function update() {
    const robot = chosen();
    const cameras = robot?.about.cameras ?? [];
    let wanted = "", words = "no picture";
    if (!world.pictures) words = "the cameras are off";
    else if (!robot) words = "no robot, no picture";
    else if (cameras.length === 0) words = "this robot has no camera";
    else if (started && !document.hidden && world.you) wanted = robot.about.view;
    if (wanted !== shown || (!wanted && section.textContent !== words)) {
      shown = wanted;
      if (wanted) build(robot.about); else clear(words);
    }
    figures.forEach((figure, i) => {
      note(figure, robot.now?.cameras?.[i]);
      if (figure.seen_ms === null) return;
      const ms = age_ms(figure);
      figure.age.textContent = ms < 10000 ? `${ms.toFixed(0)} ms` : `${(ms / 1000).toFixed(0)} s`;
      figure.age.dataset.state = ms > OLD_MS && !world.paused ? "bad" : "good";
    });
  }

  document.addEventListener("visibilitychange", update);
  update();
  return {
    update,
    // The newest picture of that camera, a Blob; null: it has sent none yet.
    jpeg: (camera) => figures.find((figure) => figure.camera === camera)?.jpeg ?? null,
    oldest_ms: () => Math.max(0, ...ages_ms()),
    start() {
      started = true;
      update();
    },
  };
}
