// The signals that can be plotted: of each the lines of a robot's state, in units for people. Pure.
import { angles } from "./world.js";

const DEG = 180 / Math.PI;
const four = (values) => ["front left", "front right", "rear left", "rear right"].map((where, i) => [where, (now) => values(now)?.[i]]);

// `positive`: what a positive angle means, the label of its line. `least`: a plot shows at least this from its lowest to its highest value. `zero`: zero is in it.
export const SIGNALS = {
  speed: { name: "Speed", unit: "m/s", least: 0.5, zero: true, lines: [["left", (now) => now.track_mps[0]], ["right", (now) => now.track_mps[1]]] },
  pitch: { name: "Pitch", unit: "\u00b0", positive: "nose down", least: 10, zero: true, lines: [["pitch", (now) => angles(now.q).pitch]] },
  currents: { name: "Currents", unit: "A", least: 5, zero: true, lines: [["tracks", (now) => now.track_a[0] + now.track_a[1]],
    ["flippers", (now) => now.flipper_a?.reduce((a, b) => a + b)]] },
  roll: { name: "Roll", unit: "\u00b0", positive: "right side down", least: 10, zero: true, lines: [["roll", (now) => angles(now.q).roll]] },
  heading: { name: "Heading", unit: "\u00b0", positive: "to the left", least: 10, turns: true, lines: [["heading", (now) => angles(now.q).yaw]] },
  left: { name: "Left track", unit: "m/s", least: 0.5, zero: true, lines: [["measured", (now) => now.track_mps[0]], ["commanded", (now) => now.command?.track[0]]] },
  right: { name: "Right track", unit: "m/s", least: 0.5, zero: true, lines: [["measured", (now) => now.track_mps[1]], ["commanded", (now) => now.command?.track[1]]] },
  travel: { name: "Travel", unit: "m", least: 0.5, lines: [["left", (now) => now.track_m[0]], ["right", (now) => now.track_m[1]]] },
  tracks: { name: "Tracks", unit: "A", least: 5, zero: true, lines: [["left", (now) => now.track_a[0]], ["right", (now) => now.track_a[1]]] },
  flippers: { name: "Flippers", unit: "A", least: 5, zero: true, lines: four((now) => now.flipper_a) },
  battery: { name: "Battery", unit: "V", least: 1, lines: [["voltage", (now) => now.battery_v]] },
  place: { name: "Place", unit: "m", least: 1, lines: [["x", (now) => now.p[0]], ["y", (now) => now.p[1]], ["z", (now) => now.p[2]]] },
  angles: { name: "Flippers", unit: "\u00b0", least: 10, zero: true, lines: four((now) => now.flipper?.map((rad) => (rad === null ? null : rad * DEG))) },
};
export const USUAL = ["speed", "pitch", "currents"];

// The values of a signal's lines at each moment {t, robots, gap} of the robot `id`: rows [t, value, ...], undefined where it was not there;
// null between two rows that do not belong together. An angle that turns on over 180 degrees goes on. `cache`: the rows of this signal and
// robot so far, by moment.
export function rowsOf(signal, moments, id, cache = new WeakMap()) {
  const rows = [];
  let last = null;
  for (const moment of moments) {
    const now = moment.robots.get(id)?.now;
    if (!now || moment.gap) {
      if (rows.length && rows[rows.length - 1]) rows.push(null);
      last = null;
    }
    if (!now) continue;
    const row = cache.get(moment) ?? [moment.t, ...signal.lines.map(([, value]) => value(now))];
    cache.set(moment, row);
    if (signal.turns && last) for (let i = 1; i < row.length; ++i) row[i] -= 360 * Math.round((row[i] - last[i]) / 360);
    rows.push(row);
    last = row;
  }
  return rows;
}

// The range of the axis and its ticks: round numbers, with all that is in `rows`.
export function axisOf({ least, zero = false }, rows) {
  let low = Infinity, high = -Infinity;
  for (const row of rows) {
    for (let i = 1; row && i < row.length; ++i) {
      if (!Number.isFinite(row[i])) continue;
      low = Math.min(low, row[i]);
      high = Math.max(high, row[i]);
    }
  }
  if (low > high) low = high = 0;
  if (zero) [low, high] = [Math.min(0, low), Math.max(0, high)];
  const wanted = Math.max(least, high - low), middle = (low + high) / 2;
  if (high - low < wanted) {
    // a value at rest is in the middle, one that leaves zero begins there
    [low, high] = zero && low === 0 && high > 0 ? [0, wanted] : zero && high === 0 && low < 0 ? [-wanted, 0] : [middle - wanted / 2, middle + wanted / 2];
  }
  const power = 10 ** Math.floor(Math.log10(wanted / 2)), step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => s >= wanted / 2.5);
  const from = Math.floor(low / step + 1e-9), to = Math.ceil(high / step - 1e-9);
  const ticks = Array.from({ length: to - from + 1 }, (_, i) => Number(((from + i) * step).toPrecision(6)));
  return { low: ticks[0], high: ticks[ticks.length - 1], ticks };
}
