// A run file (docs/logs.md, "The format kenaf-runs/1") of what the page saw of a robot. Pure.
import { angles } from "./world.js";

const FLIPPERS = ["fl", "fr", "rl", "rr"];
const RAD = Math.PI / 180;
const each = (names, column, values) => names.map((name, i) => [column(name), (now) => values(now)?.[i]]);
const COLUMNS = [   // name, value of a robot's state
  ...each(["left", "right"], (side) => `cmd_track_${side}_mps`, (now) => now.command?.track),
  // of a flipper that is ordered to no angle there is none
  ...each(FLIPPERS, (where) => `cmd_flipper_${where}_rad`, (now) => now.command?.flipper?.map(([mode, value]) => (mode === "angle" ? value : null))),
  ...each(["left", "right"], (side) => `track_${side}_mps`, (now) => now.track_mps),
  ...each(["left", "right"], (side) => `track_${side}_m`, (now) => now.track_m),
  ...each(FLIPPERS, (where) => `flipper_${where}_rad`, (now) => now.flipper),
  ...each(["left", "right"], (side) => `track_${side}_a`, (now) => now.track_a),
  ...each(FLIPPERS, (where) => `flipper_${where}_a`, (now) => now.flipper_a),
  ["battery_v", (now) => now.battery_v],
  ...each(["x", "y", "z"], (axis) => `${axis}_m`, (now) => now.p),
  ["roll_rad", (now) => angles(now.q).roll * RAD], ["pitch_rad", (now) => angles(now.q).pitch * RAD], ["yaw_rad", (now) => angles(now.q).yaw * RAD],
];
const cell = (value) => (Number.isFinite(value) ? `${Number(value.toFixed(5))}` : "");

// The robot `id` in these moments; a column without a value is left out. null: it was in none of them.
export function runFile(moments, id) {
  const rows = moments.filter(({ robots }) => robots.has(id)).map(({ t, robots }) => {
    const { now } = robots.get(id);
    return { t, cells: COLUMNS.map(([, value]) => cell(value(now))) };
  });
  if (!rows.length) return null;
  const used = COLUMNS.map((_, i) => i).filter((i) => rows.some(({ cells }) => cells[i] !== ""));
  const lines = rows.map(({ t, cells }) => [cell(t - rows[0].t), ...used.map((i) => cells[i])]);
  return [["t_s", ...used.map((i) => COLUMNS[i][0])], ...lines].map((line) => line.join(",")).join("\n") + "\n";
}

// Of words of the world and of people: what is safe in a file's name everywhere.
export function fileName(words, end) {
  return words.map((word) => `${word}`.replace(/[^A-Za-z0-9._-]+/g, "_").replace(/^[._]+/, "")).filter(Boolean).join("-") + end;
}
