// The chosen robot in figures.
import { fixed } from "./numbers.js";
import { letDrag } from "./reading_drag.js";
import { SIGNALS } from "./signals.js";
import { angles } from "./world.js";

const ROWS = [   // label, text of a robot's state, wide, its signal (signals.js)
  ["Roll", (now) => degrees(angles(now.q).roll), false, "roll"],
  ["Left", (now) => `${fixed(now.track_mps[0], 2)} m/s`, false, "left"],
  ["Pitch", (now) => degrees(angles(now.q).pitch), false, "pitch"],
  ["Right", (now) => `${fixed(now.track_mps[1], 2)} m/s`, false, "right"],
  ["Heading", (now) => degrees(angles(now.q).yaw), false, "heading"],
  ["Travel", (now) => `${fixed(now.track_m[0], 2)}, ${fixed(now.track_m[1], 2)} m`, false, "travel"],
  ["Tracks", (now) => now.track_a.map((a) => fixed(a, 1)).join(", ") + " A", false, "tracks"],
  ["Flippers", (now) => (now.flipper_a ? fixed(now.flipper_a.reduce((a, b) => a + b), 1) + " A" : "none"), false, "flippers"],
  ["Battery", (now) => `${fixed(now.battery_v, 1)} V, ${Math.floor(now.battery_s / 60)} min left`, true, "battery"],
  ["Place", (now) => now.p.map((v) => fixed(v, 2)).join(", ") + " m", true, "place"],
  ["Angles", (now) => (now.flipper ? now.flipper.filter((v) => v !== null).map((v) => fixed(v * 180 / Math.PI, 0)).join("\u00b0, ") + "\u00b0" : "none"), true, "angles"],
  ["Program", clientText, true],
];

function degrees(value) {
  return `${fixed(value, 1)}\u00b0`;
}
function clientText(now) {
  if (now.fault) return now.fault;
  if (!now.client) return "none: placed by hand";
  if (now.client.silent) return `silent for ${now.client.age.toFixed(1)} s, stopped`;
  const late = now.client.late ? `, ${now.client.late} answers late` : "";
  return `last command ${now.client.age.toFixed(2)} s ago${late}${now.holder ? ", kept out" : ""}`;
}

// `plot(signal)`: the person pressed a reading that has one; `show(signal)`: it was dragged to the plots.
export function createInstruments(plot, show) {
  const list = document.getElementById("readings"), buttons = new Map();
  function makeButton(label, signal) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "reading";
    button.textContent = label;
    const { positive } = SIGNALS[signal];
    button.title = `Plot of ${label}${positive ? `; positive: ${positive}` : ""}`;
    letDrag(button, document.getElementById("timeline"), () => show(signal));
    button.addEventListener("click", () => plot(signal));
    buttons.set(signal, button);
    return button;
  }
  const cells = ROWS.map(([label, , wide, signal]) => {
    const term = document.createElement("dt"), value = document.createElement("dd");
    term.append(signal ? makeButton(label, signal) : label);
    if (wide) value.className = "wide";
    list.append(term, value);
    return value;
  });
  return {
    // Those signals have a plot.
    mark(signals) {
      for (const [signal, button] of buttons) button.ariaPressed = `${signals.includes(signal)}`;
    },
    update(robot) {
      ROWS.forEach(([, text], i) => {
        const words = robot?.now ? text(robot.now) : "\u2013";
        if (cells[i].textContent !== words) cells[i].textContent = words;
      });
      const bad = robot?.now && (robot.now.fault || robot.now.client?.silent);
      cells[ROWS.length - 1].dataset.state = bad ? "bad" : "";
    },
  };
}
