// What never moves: ground, boxes and meshes of the world, from the server's bytes (docs/live-view.md has their layout).
import * as THREE from "/three/build/three.module.js";
import { address } from "./connection.js";
import { contourInterval_m, surfaceOf, terrainMaterial } from "./terrain.js";

const MAGIC = 0x31564e4b;
const GROUND_M = 400;

export function colour(name) {
  return new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
}

// `heights`: between which colours rise, and contour lines are chosen for. `rises`: whether it has these colours.
function material(name, heights, rises = true, level = false) {
  return terrainMaterial({ base: colour(name), high: colour(rises ? "--high" : name), line: colour("--contour"), heights, level });
}

function lines(geometry) {
  const edges = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour("--solid-edge") }));
  edges.raycast = () => {};   // one points at surfaces
  return edges;
}

// A box without `heights` is of one colour.
export function makeBox(size, heights = null) {
  const geometry = new THREE.BoxBufferGeometry(...size);
  const box = new THREE.Mesh(geometry, material("--solid", heights ?? [0, 1], heights !== null));
  box.castShadow = box.receiveShadow = true;
  box.add(lines(new THREE.EdgesGeometry(geometry)));
  return box;
}

export function pose(object, p, q) {
  object.position.set(...p);
  object.quaternion.set(q[1], q[2], q[3], q[0]);
}

export async function fetchScene(path) {
  const answer = await fetch(address(path));
  if (!answer.ok) throw new Error(await answer.text());
  return answer.arrayBuffer();
}

// The least and the largest height of all that is no plane.
function heightsOf(boxes, surfaces) {
  const all = new THREE.Box3(), corner = new THREE.Vector3(), turn = new THREE.Quaternion();
  for (const { size, X } of boxes) {
    turn.set(X[4], X[5], X[6], X[3]);
    for (let i = 0; i < 8; ++i) {
      corner.set(...size.map((length, k) => (i >> k & 1 ? length : -length) / 2)).applyQuaternion(turn);
      all.expandByPoint(corner.add(new THREE.Vector3(X[0], X[1], X[2])));
    }
  }
  for (const { geometry } of surfaces) {
    geometry.computeBoundingBox();
    all.union(geometry.boundingBox);
  }
  const LEAST_M = 0.05;   // below, colours would make mountains of nothing
  return all.isEmpty() ? [0, 1] : [all.min.z, Math.max(all.max.z, all.min.z + LEAST_M)];
}

// In the colours of the moment.
export function makeScene(bytes) {
  const parent = new THREE.Group(), header = new Uint32Array(bytes, 0, 4);
  if (header[0] !== MAGIC) throw new Error("the server's scene is of another version");
  const [, planes, boxes, meshes] = header;
  let at = 16;
  const floats = (count) => { const out = new Float32Array(bytes, at, count); at += 4 * count; return out; };
  const integers = (count) => { const out = new Uint32Array(bytes, at, count); at += 4 * count; return out; };

  const grounds = [];
  for (let i = 0; i < planes; ++i) grounds.push(floats(7));
  const fixed = [];
  for (let i = 0; i < boxes; ++i) fixed.push({ size: floats(3), X: floats(7) });
  const surfaces = [];
  for (let i = 0; i < meshes; ++i) {
    const [vertices, triangles] = integers(2);
    surfaces.push(surfaceOf(floats(3 * vertices), integers(3 * triangles)));
  }
  const heights = heightsOf(fixed, surfaces);
  for (const X of grounds) {
    const ground = new THREE.Mesh(new THREE.PlaneBufferGeometry(GROUND_M, GROUND_M), material("--ground", heights, false, Math.hypot(X[4], X[5]) < 1e-6));
    pose(ground, X.subarray(0, 3), X.subarray(3));
    ground.receiveShadow = true;
    parent.add(ground);
  }
  for (const { size, X } of fixed) {
    const box = makeBox(size, heights);
    pose(box, X.subarray(0, 3), X.subarray(3));
    parent.add(box);
  }
  for (const { geometry, edges } of surfaces) {
    const mesh = new THREE.Mesh(geometry, material("--solid", heights));
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.add(lines(edges));
    parent.add(mesh);
  }
  parent.userData.contour_m = contourInterval_m(heights);
  return parent;
}
