// Pause, step, speed, reset: all are the whole world's, whoever drives in it.
import { keyIsTaken } from "./dead_man.js";

const CHOOSES_MS = 3000;   // an open list is closed after a choice, or given up
const RESETS_MS = 5000;    // a reset that begins later is not the one that was asked for here
const by = (id) => document.getElementById(id);

// `ask`: of question.js. `say(words)`: to the person at this page.
export function createTimeControls(world, link, ask, say) {
  let asked_ms = -Infinity;   // to reset the world, from here
  const pause = () => link.send({ type: "pause", on: !world.paused });
  by("pause").addEventListener("click", pause);
  by("step").addEventListener("click", () => link.send({ type: "step", time: 0.1 }));
  let touched_ms = -Infinity;   // the list of speeds, which then keeps what a person is about to choose
  for (const name of ["keydown", "pointerdown", "change"]) by("speed").addEventListener(name, () => { touched_ms = performance.now(); });
  by("speed").addEventListener("change", (event) => link.send({ type: "speed", value: Number(event.target.value) }));
  by("reset").addEventListener("click", () => {
    const others = [...world.robots.values()].filter(({ now }) => now?.holder && now.holder !== world.you).map(({ about }) => about.name);
    const driven = others.length ? `Another operator has ${others.join(", ")}. ` : "";
    ask(`Reset the whole world? ${driven}All robots go back to their starts; programs that drive in it continue.`, "Reset", () => {
      asked_ms = performance.now();
      link.send({ type: "reset" });
    });
  });
  addEventListener("keydown", (event) => {
    if (event.code === "KeyP" && !event.repeat && !keyIsTaken(event)) pause();
  });

  function showSpeed() {
    const select = by("speed"), value = `${world.speed}`;
    if ((document.activeElement === select && performance.now() < touched_ms + CHOOSES_MS) || select.value === value) return;
    if (![...select.options].some((option) => option.value === value)) select.add(new Option(`${value} \u00d7`, value));
    select.value = value;
  }
  return {
    // Time began anew.
    began() {
      if (performance.now() > asked_ms + RESETS_MS) say("The world was reset, by another page or a program: all robots are at their starts");
      asked_ms = -Infinity;
    },
    update() {
      by("time").textContent = `${world.time_s.toFixed(2)} s`;
      by("pause").textContent = world.paused ? "Resume" : "Pause";
      by("reached").textContent = `${world.reached.toFixed(2)} \u00d7`;
      showSpeed();
    },
  };
}
