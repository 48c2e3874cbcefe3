import { keepHere, recallHere } from "./kept.js";

// What the server said last: robots by id, each with what it is (inventory) and how it is (state).
// `mine`: the numbers that this window has had at this server, a new one at each connection; `you`: the newest.
export function createWorld() {
  return { you: 0, mine: new Set(), server: 0, name: "", operatorSilence_s: 0.5, sent_s: 0, time_s: 0, paused: false, pausedBy: null, speed: 1, reached: 0, viewers: 0, pictures: false,
           robots: new Map(), boxes: [], placeable: null };
}

export function takeHello(world, message) {
  world.you = message.you;
  world.server = message.server;
  const kept = recallHere("operator");
  world.mine = new Set(kept?.server === message.server ? kept.numbers : []).add(message.you);
  keepHere("operator", { server: message.server, numbers: [...world.mine] });
  world.name = message.world;
  world.pictures = message.pictures;
  world.operatorSilence_s = message.operator_silence;
}

export function takeInventory(world, message) {
  world.placeable = message.placeable ?? null;
  const before = world.robots;
  world.robots = new Map(message.robots.map((about) => [about.id, { about, now: before.get(about.id)?.now ?? null }]));
  world.boxes = message.boxes.map((about) => ({ about, now: null }));
}

export function takeState(world, message) {
  world.sent_s = message.sent;
  world.time_s = message.t;
  world.paused = message.paused;
  world.pausedBy = message.paused_by ?? null;
  world.speed = message.speed;
  world.reached = message.reached;
  world.viewers = message.viewers;
  for (const now of message.robots) {
    const robot = world.robots.get(now.id);
    if (robot) robot.now = now;
  }
  message.boxes.forEach((now, i) => { if (world.boxes[i]) world.boxes[i].now = now; });
}

// Roll, pitch, yaw in degrees of a rotation [w, x, y, z]: turned z, y, x; pitch is positive nose down.
export function angles([w, x, y, z]) {
  const deg = 180 / Math.PI;
  return {
    roll: Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) * deg,
    pitch: Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))) * deg,
    yaw: Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * deg,
  };
}
