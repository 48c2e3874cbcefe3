// The chosen robot's outline from the side and from behind, at its pitch and roll over a level line.
import { angles } from "./world.js";

const NS = "http://www.w3.org/2000/svg";
function add(parent, name, attributes) {
  const element = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

// In words, as the sign of an angle is a convention that few know.
function leaning(positive, negative, neither, angle_deg) {
  const degrees = Math.abs(angle_deg).toFixed(1);
  return `${degrees === "0.0" ? neither : angle_deg > 0 ? positive : negative} ${degrees}\u00b0`;
}

export function createPosture() {
  const [side, back, pitched, rolled] = ["side", "back", "pitched", "rolled"].map((id) => document.getElementById(id));
  let drawn = 0, parts = null;

  function draw(about) {
    side.replaceChildren();
    back.replaceChildren();
    const { tracks, casters, body } = about;
    const front_m = tracks[0].at[0] + tracks[0].length / 2, rear_m = tracks[tracks.length - 1].at[0] - tracks[tracks.length - 1].length / 2;
    const scale = 110 / (front_m - rear_m + 2 * (about.flipper?.length ?? 0.05));
    for (const svg of [side, back]) add(svg, "line", { class: "level", x1: -58, x2: 58, y1: 0, y2: 0 });
    add(side, "text", { class: "where", x: -58, y: -33 }).textContent = "front";
    add(back, "text", { class: "where", x: -58, y: -33 }).textContent = "left";
    const outline = (group, width, height, x, y, className) => add(group, "rect", { class: className, x: (x - width / 2) * scale, y: (-y - height / 2) * scale,
      width: width * scale, height: height * scale, rx: Math.min(height, width) / 2 * scale * (className === "track" ? 1 : 0.25) });
    const front = add(side, "g", {}), rear = add(back, "g", {});
    // nose to the left, as the robot is seen from its left side
    outline(front, body[0], body[2], 0, 0, "hull");
    for (const { length, radius, at } of [...casters, ...tracks]) outline(front, length, 2 * radius, -at[0], at[2], "track");
    outline(rear, body[1], body[2], 0, 0, "hull");
    for (const { width, radius, at } of tracks) {
      for (const y of [at[1], -at[1]]) {
        add(rear, "rect", { class: "track", x: (y - width / 2) * scale, y: (-at[2] - radius) * scale, width: width * scale, height: 2 * radius * scale, rx: 2 });
      }
    }
    const arms = about.flipper ? [0, 2].filter((i) => about.flipper.has[i]).map((i) => add(front, "line", { class: "arm", "stroke-width": 1.5 * about.flipper.tip_radius * scale, "data-arm": i })) : [];
    parts = { front, rear, arms, scale };
  }

  return {
    update(robot) {
      if (!robot?.now) {
        if (drawn) { for (const element of [side, back, pitched, rolled]) element.replaceChildren(); drawn = 0; }
        return;
      }
      const { about, now } = robot;
      if (drawn !== about.id) { draw(about); drawn = about.id; }
      const { roll, pitch } = angles(now.q);
      parts.front.setAttribute("transform", `rotate(${-pitch})`);
      parts.rear.setAttribute("transform", `rotate(${roll})`);
      pitched.textContent = leaning("nose down", "nose up", "pitch", pitch);
      rolled.textContent = leaning("right down", "left down", "roll", roll);
      parts.arms.forEach((arm) => {
        const i = Number(arm.dataset.arm);
        const { length, at } = about.flipper, angle = now.flipper[i], outward = i === 0 ? -1 : 1;
        const x = outward * at[0] * parts.scale, y = -at[2] * parts.scale;
        arm.setAttribute("x1", x);
        arm.setAttribute("y1", y);
        arm.setAttribute("x2", x + outward * Math.cos(angle) * length * parts.scale);
        arm.setAttribute("y2", y - Math.sin(angle) * length * parts.scale);
      });
    },
  };
}
