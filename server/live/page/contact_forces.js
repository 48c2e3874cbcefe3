// Where robots touch the ground, each other and boxes: a point each, an arrow for the force on the robot, and their sum in figures.
import * as THREE from "/three/build/three.module.js";
import { fixed } from "./numbers.js";
import { colour } from "./scene.js";

const M_PER_N = 0.004;       // length of an arrow
const LEAST_N = 0.02;        // less is no arrow
const POINT_M = 0.01, SHAFT_M = 0.004, HEAD_M = 0.012;   // half widths
const MOST = 2048;           // points that are drawn; the sum has all
const CORNERS = 36 + 24;     // of the triangles of an arrow and its point
const MEAN_OF = 8;           // states: about a quarter of a second. A step's forces are spikes where a lug meets an edge.
// The parts in the order of the server's numbers, by groups.
const GROUPS = ["tracks", "tracks", "flippers", "flippers", "flippers", "flippers", "casters", "body"];
const COLOURS = { tracks: "--force-tracks", flippers: "--force-flippers", casters: "--force-tracks", body: "--force-body" };

// The vector sums of a robot's contacts in N: of all, and by group.
export function sumsOf(contacts) {
  const sums = { all: [0, 0, 0] };
  for (const [part, , , , ...force] of contacts) {
    const group = sums[GROUPS[part]] ??= [0, 0, 0];
    force.forEach((value, k) => { group[k] += value; sums.all[k] += value; });
  }
  return sums;
}

// Mean vectors of the newest sums.
function meanOf(history) {
  const mean = {};
  for (const group of ["all", ...new Set(GROUPS)]) {
    const total = [0, 0, 0];
    for (const sums of history) (sums[group] ?? []).forEach((value, k) => { total[k] += value; });
    mean[group] = Math.hypot(...total) / history.length;
  }
  return mean;
}

// `words`: the element for the sum.
export function createContactForces(scene, words) {
  const position = new Float32Array(3 * CORNERS * MOST), hue = new Float32Array(3 * CORNERS * MOST);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(hue, 3));
  const material = new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide, depthTest: false, transparent: true });
  const arrows = new THREE.Mesh(geometry, material);
  arrows.frustumCulled = false;
  arrows.renderOrder = 10;   // over the robot, which would hide all of them
  arrows.visible = false;
  scene.add(arrows);

  let history = [], robotId = 0, time_s = null;
  const p = new THREE.Vector3(), f = new THREE.Vector3(), u = new THREE.Vector3(), v = new THREE.Vector3();
  let at = 0;   // corner
  function corner(along, side_u, side_v, length, paint) {
    const o = 3 * at++;
    for (let k = 0; k < 3; ++k) {
      const [uk, vk, fk] = [u.getComponent(k), v.getComponent(k), f.getComponent(k)];
      position[o + k] = p.getComponent(k) + along * length * fk + side_u * uk + side_v * vk;
    }
    [hue[o], hue[o + 1], hue[o + 2]] = [paint.r, paint.g, paint.b];
  }
  const square = [[1, 0], [0, 1], [-1, 0], [0, -1]];
  function draw(contact, paint) {
    const [, x, y, z, ...force] = contact, size_n = Math.hypot(...force);
    p.set(x, y, z);
    f.set(...force).divideScalar(size_n);
    u.set(Math.abs(f.z) < 0.9 ? 0 : 1, 0, Math.abs(f.z) < 0.9 ? 1 : 0).cross(f).normalize();
    v.crossVectors(f, u);
    const length = size_n * M_PER_N, head = Math.min(0.4 * length, 3 * HEAD_M), neck = 1 - head / length;
    square.forEach(([a, b], i) => {
      const [c, d] = square[(i + 1) % 4];
      const [s, h] = [SHAFT_M, HEAD_M];
      const shaft = [[a, b, 0], [c, d, 0], [c, d, neck], [a, b, 0], [c, d, neck], [a, b, neck]];
      for (const [m, n, along] of shaft) corner(along, m * s, n * s, length, paint);
      for (const [m, n, along] of [[a, b, neck], [c, d, neck], [0, 0, 1]]) corner(along, m * h, n * h, length, paint);
      for (const end of [1, -1]) {
        for (const [m, n, tip] of [[a, b, 0], [c, d, 0], [0, 0, end]]) corner(tip * POINT_M / length, m * POINT_M, n * POINT_M, length, paint);
      }
    });
  }

  function tell(robot, now_s) {
    const contacts = robot?.now?.contacts;
    if (robotId !== (robot?.about.id ?? 0) || now_s < time_s) history = [];
    robotId = robot?.about.id ?? 0;
    if (!contacts) {
      words.textContent = robot ? "Forces: waiting for the server" : "Forces: no robot";
      return;
    }
    if (now_s !== time_s || history.length === 0) history = [...history, sumsOf(contacts)].slice(-MEAN_OF);
    time_s = now_s;
    const mean = meanOf(history);
    const parts = [...new Set(GROUPS)].filter((group) => mean[group] >= 0.05).map((group) => `${group} ${fixed(mean[group], 1)}`);
    const of = parts.length ? ` (${parts.join(", ")})` : "";
    words.textContent = `Ground on ${robot.about.name}: ${fixed(mean.all, 1)} N${of}, ${contacts.length} points`;
    words.dataset.sum = mean.all.toFixed(3);
  }

  return {
    // `robots`: of world.js; the sum is of `robot`.
    update(robots, robot, now_s) {
      const paints = Object.fromEntries(Object.entries(COLOURS).map(([group, name]) => [group, colour(name)]));
      at = 0;
      for (const { now } of robots.values()) {
        for (const contact of now?.contacts ?? []) {
          if (at + CORNERS > CORNERS * MOST) break;
          if (Math.hypot(contact[4], contact[5], contact[6]) >= LEAST_N) draw(contact, paints[GROUPS[contact[0]]]);
        }
      }
      geometry.setDrawRange(0, at);
      geometry.attributes.position.needsUpdate = geometry.attributes.color.needsUpdate = true;
      arrows.visible = true;
      tell(robot, now_s);
    },
    hide() {
      arrows.visible = false;
      history = [];
    },
  };
}
