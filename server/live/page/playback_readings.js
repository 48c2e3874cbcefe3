// What there is to read at the cursor: where the recorded robot is, and how far it is from each simulation.
import { fixed } from "./numbers.js";
import { differenceOf, stateAt } from "./playback_data.js";

const by = (id) => document.getElementById(id);
const signed = (value, digits) => {
  const text = Math.abs(value).toFixed(digits);
  return Number(text) === 0 ? text : `${value < 0 ? "\u2212" : "+"}${text}`;
};
const metres = (value) => fixed(value, 3);
const ROWS = [
  ["distance, mm", (d) => d.distance_mm.toFixed(1)],
  ["x, mm", (d) => signed(d.place_mm[0], 1)], ["y, mm", (d) => signed(d.place_mm[1], 1)], ["z, mm", (d) => signed(d.place_mm[2], 1)],
  ["roll, \u00b0", (d) => signed(d.angles_deg[0], 2)], ["pitch, \u00b0", (d) => signed(d.angles_deg[1], 2)],
  ["yaw, \u00b0", (d) => signed(d.angles_deg[2], 2)],
];
const FROM = { measured: "measured", "dead reckoning": "by dead reckoning", nothing: "not known" };

export function createReadings() {
  let run = null, cells = [];

  function load(next) {
    run = next;
    const simulated = run.bodies.filter((body) => body.kind !== "recorded"), table = by("difference");
    table.replaceChildren();
    cells = [];
    if (!simulated.length) return;
    const head = table.createTHead().insertRow(), corner = document.createElement("th");
    corner.scope = "col";
    corner.textContent = "Measured minus";
    head.append(corner, ...simulated.map((body) => {
      const name = document.createElement("th");
      name.scope = "col";
      name.textContent = body.kind;
      return name;
    }));
    const rows = table.createTBody();
    for (const [name, value] of ROWS) {
      const row = rows.insertRow(), title = document.createElement("th");
      title.scope = "row";
      title.textContent = name;
      row.append(title);
      for (const body of simulated) cells.push({ cell: row.insertCell(), body, value });
    }
  }

  return {
    load,
    update(t, phase) {
      by("now-time").textContent = `${t.toFixed(2)} s`;
      by("now-phase").textContent = phase;
      if (!run) return;
      const [recorded] = run.bodies, state = stateAt(run, recorded, t), how = FROM[recorded.pose_from];
      by("place").textContent = state ? `Robot at x ${metres(state.p[0])}, y ${metres(state.p[1])}, z ${metres(state.p[2])} m${recorded.pose_from === "measured" ? "" : ` (${how})`}`
        : recorded.pose ? "Recorded: its pose was not measured here" : "Recorded: its pose is not known";
      const differences = new Map();
      for (const { cell, body, value } of cells) {
        if (!differences.has(body)) differences.set(body, differenceOf(state, stateAt(run, body, t)));
        const difference = differences.get(body);
        cell.textContent = difference ? value(difference) : "\u2013";
      }
    },
  };
}
