// What the cameras of the chosen robot see, and how old it is. A stream is closed when nobody sees it, so that the server draws nothing
// for a hidden page, and a picture in a place of half its width is drawn in that size. Nothing is fetched before start().
import { readPictures } from "./picture_stream.js";

const MOST = 4;            // a browser has six connections to one server
const AGAIN_MS = 1000;     // after a stream broke
const LOOK_MS = 200;
const OLD_MS = 500;        // while time runs: something is too slow
const KEPT = 200;          // frames whose time is known
const HALF_UP_TO = 0.55;   // of the width
const RIGHT_SIZE_MS = 2000;   // so long a picture of the size that its place has by now is waited for

// `bigView`: of big_view.js, which may have one of the pictures.
export function createPictures(world, link, chosen, bigView) {
  const section = document.getElementById("pictures");
  let started = false, shown = "", figures = [], density = devicePixelRatio;

  // When the server's camera saw each frame, by the server's clock, as the states say.
  function note(figure, camera) {
    if (camera?.n === undefined || figure.seen_s.has(camera.n)) return;
    figure.seen_s.set(camera.n, world.sent_s - camera.age);
    if (figure.seen_s.size > KEPT) figure.seen_s.delete(figure.seen_s.keys().next().value);
  }
  // By the frame's own stamp until a state has told of it: that is from when it was sent, so it lacks the time that the picture waited on
  // its way. With the way as it is known now: that of a page that has just been busy is corrected by the next answer.
  function age_ms({ shown, seen_s }) {
    const seen_ms = seen_s.has(shown.number) ? link.here_ms(seen_s.get(shown.number)) : shown.stamped_ms - link.way_ms();
    return performance.now() - seen_ms;
  }

  function show(figure, part, size) {
    figure.jpeg = new Blob([part.jpeg], { type: "image/jpeg" });
    const url = URL.createObjectURL(figure.jpeg);
    const { picture } = figure, before = picture.src;
    picture.src = url;
    if (before) URL.revokeObjectURL(before);
    figure.shown = { number: part.number, time_s: part.time_s, stamped_ms: performance.now() - part.age_ms, size };
    for (const wake of figure.waiting.splice(0)) wake();
  }

  // Until the figure is gone; each stream until its size is no longer the right one.
  async function read(figure) {
    while (!figure.gone) {
      const stream = figure.stream = new AbortController(), { size } = figure;
      try {
        await readPictures(`${figure.picture.dataset.stream}?size=${size}`, stream.signal, (part) => show(figure, part, size));
      } catch {
        if (!stream.signal.aborted) await new Promise((again) => setTimeout(again, AGAIN_MS));
      }
    }
  }
  // The picture keeps its shape in the place that it has. What is drawn in half its size may be stretched a little, so that no place is at
  // the limit.
  function sizeFor({ picture: { clientWidth, clientHeight }, width, height, size }) {
    const most = (size === "half" ? HALF_UP_TO : 0.5) * width;
    return Math.min(clientWidth, clientHeight * width / height) * devicePixelRatio <= most ? "half" : "full";
  }
  function fit(figure) {
    const size = sizeFor(figure);
    if (figure.size === size) return;
    figure.size = size;
    if (figure.stream) figure.stream.abort(); else read(figure);
  }
  const places = new ResizeObserver((entries) => {
    for (const { target } of entries) figures.filter(({ picture }) => picture === target).forEach(fit);
  });

  function clear(words) {
    bigView.built([]);
    places.disconnect();
    for (const figure of figures) {
      figure.gone = true;
      figure.stream?.abort();
      if (figure.picture.src) URL.revokeObjectURL(figure.picture.src);
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
      const { width, height } = camera;
      places.observe(picture);
      return { camera: camera.name, width, height, picture, jpeg: null, age, size: null, stream: null, gone: false, waiting: [], seen_s: new Map(), shown: null };
    });
    bigView.built([...section.children]);
  }

  const ages_ms = () => figures.filter(({ shown }) => shown).map(age_ms);

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
    if (density !== devicePixelRatio) {   // on another screen, which changes no place
      density = devicePixelRatio;
      figures.filter(({ size }) => size).forEach(fit);
    }
    figures.forEach((figure, i) => {
      note(figure, robot.now?.cameras?.[i]);
      if (!figure.shown) return;
      const ms = age_ms(figure);
      figure.age.textContent = ms < 10000 ? `${ms.toFixed(0)} ms` : `${(ms / 1000).toFixed(0)} s`;
      figure.age.dataset.state = ms > OLD_MS && !world.paused ? "bad" : "good";
    });
  }

  document.addEventListener("visibilitychange", update);
  setInterval(update, LOOK_MS);   // ages grow without a word from the server, too
  update();
  return {
    update,
    // The newest picture of that camera: { jpeg, a Blob; time_s, of the robot }; null: it has sent none yet. Of one that has just been
    // enlarged, the first whole one.
    async shot(camera) {
      const figure = figures.find((each) => each.camera === camera), until_ms = performance.now() + RIGHT_SIZE_MS;
      while (figure?.shown && figure.shown.size !== sizeFor(figure) && performance.now() < until_ms) {
        await new Promise((again) => { figure.waiting.push(again); setTimeout(again, RIGHT_SIZE_MS); });
      }
      return figure?.shown ? { jpeg: figure.jpeg, time_s: figure.shown.time_s } : null;
    },
    oldest_ms: () => Math.max(0, ...ages_ms()),
    start() {
      started = true;
      update();
    },
  };
}
