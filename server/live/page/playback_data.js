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
  if (list.format !== "kenaf-playback/1") throw new Error("the server is of another version than this page");
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
const blendAngle = (a, b, f) => {
  if (a === null || b === null || a === undefined || b === undefined) return (f < 0.5 ? a : b) ?? null;
  const way = Math.atan2(Math.sin(b - a), Math.cos(b - a));
  return a + way * f;
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

// Recorded minus simulated: distance and place in mm, angles in degrees.
export function differenceOf(recorded, simulated) {
  if (!recorded || !simulated) return null;
  const place_mm = recorded.p.map((value, i) => 1000 * (value - simulated.p[i]));
  const angles_deg = recorded.angles.map((value, i) => {
    const way = value - simulated.angles[i];
    return DEG * Math.atan2(Math.sin(way), Math.cos(way));
  });
  return { distance_mm: Math.hypot(...place_mm), place_mm, angles_deg };
}

export const LABELS = {
  recorded: (source) => (source === "real" ? "Real robot, as recorded" : "Recorded run"),
  nominal: () => "Nominal simulation",
  corrected: () => "Corrected simulation",
};
