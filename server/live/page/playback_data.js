// Recorded runs and their simulations as the server hands them out (gap/playback/playback.hpp), and what they say at
// any time.
import { address } from "./connection.js";

const DEG = 180 / Math.PI;

async function ask(path) {
  const answer = await fetch(address(path));
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer;
}

export async function fetchList() {
  const list = await (await ask("/playback")).json();
  if (list.format !== "kenaf-playback/2") throw new Error("the server is of another version than this page");
  return list;
}

// Once it is simulated; `wanted()` false: nobody waits for it any more, and the answer is null.
export async function fetchRun(number, wanted) {
  for (;;) {
    const answer = await ask(`/playback/${number}`);
    if (!wanted()) return null;
    if (answer.status === 200) return answer.json();
    await new Promise((resolve) => setTimeout(resolve, 250));
    if (!wanted()) return null;
  }
}

// What the nominal simulation of a run differs by, or nothing.
export const nominalGapOf = (run) => run?.gaps.find((gap) => gap.kind === "nominal");

// The last index whose time is not after t.
export function indexAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t + 1e-9) low = middle; else high = middle - 1;
  }
  return low;
}

const blend = (a, b, f) => (a === null || b === null || a === undefined || b === undefined ? (f < 0.5 ? a : b) ?? null : a + (b - a) * f);
const turn = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
const blendAngle = (a, b, f) => {
  if (a === null || b === null || a === undefined || b === undefined) return (f < 0.5 ? a : b) ?? null;
  return a + turn(b - a) * f;
};

// Turned z, y, x: w, x, y, z.
export function rotation(roll, pitch, yaw) {
  const [cr, sr, cp, sp, cy, sy] = [roll, pitch, yaw].flatMap((angle) => [Math.cos(angle / 2), Math.sin(angle / 2)]);
  return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy];
}

// How a body is at t: p, angles, q, flipper, track_m; null where that is not known.
export function stateAt(run, body, t) {
  if (!body.pose) return null;
  const i = indexAt(run.t_s, t), j = Math.min(i + 1, run.t_s.length - 1);
  const f = j > i ? Math.max(0, Math.min(1, (t - run.t_s[i]) / (run.t_s[j] - run.t_s[i]))) : 0;
  const p = ["x", "y", "z"].map((name) => blend(body.pose[name][i], body.pose[name][j], f));
  const angles = ["roll", "pitch", "yaw"].map((name) => blendAngle(body.pose[name][i], body.pose[name][j], f));
  if ([...p, ...angles].some((value) => value === null)) return null;
  return {
    p, angles, q: rotation(...angles),
    flipper: body.flipper.map((values) => blend(values[i], values[j], f)),
    track_m: body.track_m.map((values) => blend(values[i], values[j], f)),
  };
}

// Measured minus simulated, as in the report: distance and place in mm, angles in degrees.
export function differenceOf(recorded, simulated) {
  if (!recorded || !simulated) return null;
  const place_mm = simulated.p.map((value, i) => 1000 * (recorded.p[i] - value));
  const angles_deg = simulated.angles.map((value, i) => DEG * turn(recorded.angles[i] - value));
  return { distance_mm: Math.hypot(...place_mm), place_mm, angles_deg };
}

const times = ([aw, ax, ay, az], [bw, bx, by, bz]) => [aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw];

// The simulated state with `factor` times its deviation from the recorded one: in place, in rotation (at most half a
// turn about the same axis) and in its flippers. Null where there is nothing to deviate from.
export function exaggerated(recorded, simulated, factor) {
  if (factor === 1 || !simulated) return simulated;
  if (!recorded) return null;
  const [w, x, y, z] = times([recorded.q[0], ...recorded.q.slice(1).map((v) => -v)], simulated.q), sine = Math.hypot(x, y, z);
  const half = Math.min(Math.PI / 2, factor * Math.atan2(sine, Math.abs(w))), scale = sine > 1e-9 ? Math.sign(w || 1) * Math.sin(half) / sine : 0;
  return {
    ...simulated,
    p: simulated.p.map((value, i) => recorded.p[i] + factor * (value - recorded.p[i])),
    q: times(recorded.q, [Math.cos(half), x * scale, y * scale, z * scale]),
    flipper: simulated.flipper.map((value, i) => recorded.flipper[i] + Math.max(-Math.PI, Math.min(Math.PI, factor * (value - recorded.flipper[i])))),
  };
}

// What a stage of the report compares, for readers who have not seen one: its name in the row of the marks, and what a gap there is.
const STAGES = {
  "command to drive": ["drives", "tracks and flippers respond to the commands differently than in the simulation"],
  "drive to body": ["body", "the body moves differently than in the simulation, with the same track motion"],
  "body to sensor": ["sensors", "a sensor reports a motion that differs from the motion of the body"],
};
export const stageName = (stage) => STAGES[stage]?.[0] ?? "";
export const stageMeaning = (stage) => STAGES[stage]?.[1] ?? "";
// "the gap from body to sensor": shares are of one stage alone.
export const gapInWords = (stage) => (stage ? `the gap from ${stage}` : "the gap");

export const LABELS = {
  recorded: (source) => (source === "real" ? "Real robot, as recorded" : "Recorded run"),
  nominal: () => "Nominal simulation",
  corrected: () => "Corrected simulation",
};
