// The chosen robot in figures.
import { fixed } from "./numbers.js";
import { angles } from "./world.js";

const ROWS = [   // label, text of a robot's state, wide
  ["Roll", (now) => degrees(angles(now.q).roll)],
  ["Left", (now) => `${fixed(now.track_mps[0], 2)} m/s`],
  ["Pitch", (now) => degrees(angles(now.q).pitch)],
  ["Right", (now) => `${fixed(now.track_mps[1], 2)} m/s`],
  ["Heading", (now) => degrees(angles(now.q).yaw)],
  ["Travel", (now) => `${fixed(now.track_m[0], 2)}, ${fixed(now.track_m[1], 2)} m`],
  ["Tracks", (now) => now.track_a.map((a) => fixed(a, 1)).join(", ") + " A"],
  ["Flippers", (now) => (now.flipper_a ? fixed(now.flipper_a.reduce((a, b) => a + b), 1) + " A" : "none")],
  ["Battery", (now) => `${fixed(now.battery_v, 1)} V, ${Math.floor(now.battery_s / 60)} min left`, true],
  ["Place", (now) => now.p.map((v) => fixed(v, 2)).join(", ") + " m", true],
  ["Angles", (now) => (now.flipper ? now.flipper.map((v) => fixed(v * 180 / Math.PI, 0)).join("\u00b0, ") + "\u00b0" : "none"), true],
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

export function createInstruments() {
  const list = document.getElementById("readings");
  const cells = ROWS.map(([label, , wide]) => {
    const term = document.createElement("dt"), value = document.createElement("dd");
    term.textContent = label;
    if (wide) value.className = "wide";
    list.append(term, value);
    return value;
  });
  return {
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
