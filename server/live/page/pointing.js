// Pointing at the ground: where a robot is to be placed, and between which two places is measured. A press that is let go of where it
// began is a click; any other turns the view. By the keyboard: arrows move the point, with Shift finely; Enter takes it; Esc ends.
import { dialogIsOpen } from "./focus.js";

const CLICK_PX = 5;
const STEP_M = 0.1, FINE_M = 0.01;
const ARROWS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };   // ahead, to the left, on the screen

// `surfaces()`: what can be pointed at beside what never moves; `clicked(x, y)`: a click while there is no task; `begins()`: before a task;
// `changed()`: one has begun or ended.
// A task: { name, moved(p or null), taken(p or null), ended(), key(code): whether it is its own }; places are THREE.Vector3 in W.
export function createPointing(stage, surfaces, { clicked, begins, changed }) {
  const { canvas } = stage;
  let task = null, at = null, pressed = null;   // `pressed`: a pointer that may become a click

  function moveTo(p) {
    at = p;
    task.moved(at);
    stage.redraw();
  }
  function end() {
    if (!task) return;
    const ended = task;
    task = at = null;
    canvas.classList.remove("pointing");
    ended.ended();
    changed();
    stage.redraw();
  }
  const under = (event) => stage.pick(event.clientX, event.clientY, surfaces())?.point ?? null;

  canvas.addEventListener("pointerdown", (event) => {
    pressed = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK_PX) pressed = null;
    if (task && !event.buttons) moveTo(under(event) ?? at);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!pressed || !event.isPrimary) return;
    pressed = null;
    if (!task) { clicked(event.clientX, event.clientY); return; }
    const p = under(event);
    if (!p) return;   // the sky
    moveTo(p);
    task?.taken(p);
  });
  canvas.addEventListener("pointercancel", () => { pressed = null; });

  // Whether the element with the focus needs the key for itself; the button that began the task does not.
  function isTaken(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || dialogIsOpen()) return true;
    const { code, target } = event;
    if (code === "Escape") return false;
    if (target instanceof HTMLButtonElement) return code === "Enter" && target.id !== task.name;
    return target instanceof HTMLSelectElement || target instanceof HTMLInputElement;
  }
  addEventListener("keydown", (event) => {
    if (!task || isTaken(event)) return;
    if (ARROWS[event.code]) {
      const [ahead, left] = ARROWS[event.code], heading = stage.heading(), step = event.shiftKey ? FINE_M : STEP_M;
      const from = at ?? stage.middle();
      const x = from.x + (at ? step : 0) * (ahead * Math.cos(heading) - left * Math.sin(heading));
      const y = from.y + (at ? step : 0) * (ahead * Math.sin(heading) + left * Math.cos(heading));
      moveTo(stage.groundAt(x, y, surfaces()) ?? at);
    } else if (event.code === "Enter") {
      if (!event.repeat) task.taken(at);
    } else if (event.code === "Escape") {
      end();
    } else if (!task.key?.(event.code)) {
      return;
    }
    event.preventDefault();
    event.stopImmediatePropagation();   // neither lets go of a robot, nor scrolls, nor presses a button
  }, { capture: true });

  return {
    // Ends the one before it. Nothing is pointed at before the pointer or a key has moved.
    begin(next) {
      end();
      begins();
      task = next;
      at = null;
      canvas.classList.add("pointing");
      task.moved(null);
      changed();
    },
    end,
    isOn: (name = null) => task !== null && (name === null || task.name === name),
  };
}
