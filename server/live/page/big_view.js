// Which picture is the large one: the world in 3D, or a camera's, which then swap places; and full screen. Esc goes back, step by step.
import { dialogIsOpen } from "./focus.js";
import { keyIsTaken } from "./dead_man.js";
import { keep, recall } from "./kept.js";

const by = (id) => document.getElementById(id);

// `letGo()`: before full screen, in which the stick may be elsewhere. `past`: returned from by Esc too.
export function createBigView(past, letGo) {
  const view = by("view"), canvas = by("canvas"), pictures = by("pictures"), root = document.documentElement;
  let figures = [], large = null, kept = recall("large");   // the large camera's figure; the name of the one that was chosen
  const withoutWorld = () => document.body.dataset.view === "cameras";

  // In the place of a camera's picture, with a button over it that brings it back.
  const small = document.createElement("figure"), back = document.createElement("button"), caption = document.createElement("figcaption");
  small.id = "small-world";
  back.type = "button";
  back.className = "picture";
  back.append(document.createElement("span"));
  back.firstChild.textContent = "Enlarge the world in 3D";
  caption.textContent = "3D";
  small.append(back, caption);

  const nameOf = (figure) => figure.dataset.camera;
  function show() {
    document.body.toggleAttribute("data-camera-large", large !== null);
    for (const figure of figures) {
      figure.toggleAttribute("data-large", figure === large);
      const words = figure === large ? "Back to all pictures: " : "Enlarge the picture of ";
      figure.querySelector("button span").textContent = words + nameOf(figure);
    }
  }
  // All in the places that they have without a choice.
  function restore() {
    if (large && small.isConnected) {
      view.prepend(canvas);
      small.replaceWith(large);
    }
    large = null;
    show();
  }
  function enlarge(figure) {
    restore();
    if (!figure) return;
    big.whenCamera();
    if (!withoutWorld()) {
      figure.replaceWith(small);
      small.prepend(canvas);
      view.prepend(figure);
    }
    large = figure;
    show();
  }
  function choose(figure) {
    kept = figure ? nameOf(figure) : null;
    keep("large", kept);
    enlarge(figure);
  }
  // The world, the first camera, the next one, ..., the world.
  function next() {
    if (figures.length) choose(figures[large ? figures.indexOf(large) + 1 : 0] ?? null);
  }
  back.addEventListener("click", () => choose(null));

  function setFull(on) {
    if (on === document.body.hasAttribute("data-full")) return;
    letGo();
    document.body.toggleAttribute("data-full", on);
    by("full-screen").ariaPressed = `${on}`;
    // Where the browser gives no screen, it fills the window.
    if (on) root.requestFullscreen?.().catch(() => {});
    else if (document.fullscreenElement) document.exitFullscreen();
  }
  const isFull = () => document.body.hasAttribute("data-full");
  by("full-screen").addEventListener("click", () => setFull(!isFull()));
  document.addEventListener("fullscreenchange", () => { if (!document.fullscreenElement) setFull(false); });

  addEventListener("keydown", (event) => {
    if (event.repeat || keyIsTaken(event)) return;
    if (event.code === "KeyZ") next();
    if (event.code === "KeyX") setFull(!isFull());
  });
  // Before it lets go of the robot.
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.repeat || event.ctrlKey || event.altKey || event.metaKey || dialogIsOpen()) return;
    if (isFull()) setFull(false);
    else if (large) choose(null);
    else if (past.isBack()) past.live();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }, { capture: true });

  const big = {
    // Set by who points at the world: before a camera's picture takes its place.
    whenCamera() {},
    showWorld() { if (large) choose(null); },
    // Before the cameras' pictures take the world's place.
    restore,
    // These are the cameras' figures from now on; called before they are taken away, too.
    built(made) {
      figures = made;
      for (const figure of figures) figure.querySelector("button").addEventListener("click", () => choose(figure === large ? null : figure));
      enlarge(figures.find((figure) => nameOf(figure) === kept) ?? null);
    },
    // The camera's figure whose picture is the large one, or null: the world's.
    large: () => large ?? (withoutWorld() ? figures[0] ?? null : null),
  };
  return big;
}
