// What the cameras of the chosen robot see, and how old it is. A picture is MJPEG, which a browser shows by itself; its stream
// is closed when nobody sees it, so that the server draws nothing for a hidden page. Nothing is fetched before start().
import { address } from "./connection.js";

const MOST = 4;            // a browser has six connections to one server
const AGAIN_MS = 1000;     // after a stream broke
const OLD_S = 0.5;         // while time runs: something is too slow

export function createPictures(world, chosen) {
  const section = document.getElementById("pictures");
  let started = false, shown = "", figures = [];

  function fetchPicture(picture, robot, camera) {
    picture.src = address(`/camera/${encodeURIComponent(robot.view)}/${encodeURIComponent(camera.name)}.mjpg`);
  }

  function clear(words) {
    for (const { picture } of figures) {
      picture.onerror = null;
      picture.removeAttribute("src");   // ends its stream
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
    for (const camera of robot.cameras.slice(0, MOST)) {
      const figure = document.createElement("figure"), caption = document.createElement("figcaption");
      const name = document.createElement("span"), age = document.createElement("output"), picture = document.createElement("img");
      name.textContent = camera.name;
      age.title = "Age of the picture at the server, if the server reports it";
      caption.append(name, " ", age);
      picture.alt = `Picture of the camera ${camera.name}`;
      picture.onerror = () => setTimeout(() => { if (picture.onerror) fetchPicture(picture, robot, camera); }, AGAIN_MS);
      figure.append(picture, caption);
      section.append(figure);
      figures.push({ picture, age });
      fetchPicture(picture, robot, camera);
    }
  }

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
    figures.forEach(({ age }, i) => {
      const seconds = robot.now?.cameras?.[i]?.age;
      age.textContent = seconds === undefined ? "" : seconds < 10 ? `${(1000 * seconds).toFixed(0)} ms` : `${seconds.toFixed(0)} s`;
      age.dataset.state = seconds > OLD_S && !world.paused ? "bad" : "good";
    });
  }

  document.addEventListener("visibilitychange", update);
  update();
  return {
    update,
    start() {
      started = true;
      update();
    },
  };
}
