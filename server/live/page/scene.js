// What never moves: ground, boxes and meshes of the world, from the server's bytes (docs/live-view.md has their layout).
import * as THREE from "/three/build/three.module.js";
import { address } from "./connection.js";

const MAGIC = 0x31564e4b;
const GROUND_M = 400;

export function colour(name) {
  return new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
}

// Squares of 1 m, to estimate lengths.
function groundTexture() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 256;
  const pen = canvas.getContext("2d");
  pen.fillStyle = `#${colour("--ground").getHexString()}`;
  pen.fillRect(0, 0, 256, 256);
  pen.strokeStyle = `#${colour("--ground-line").getHexString()}`;
  pen.lineWidth = 5;
  pen.strokeRect(0, 0, 256, 256);
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(GROUND_M, GROUND_M);
  texture.anisotropy = 8;
  return texture;
}

export function makeBox(size) {
  const geometry = new THREE.BoxBufferGeometry(...size);
  const box = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour("--solid") }));
  box.castShadow = box.receiveShadow = true;
  box.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry), new THREE.LineBasicMaterial({ color: colour("--solid-edge") })));
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

// In the colours of the moment.
export function makeScene(bytes) {
  const parent = new THREE.Group(), header = new Uint32Array(bytes, 0, 4);
  if (header[0] !== MAGIC) throw new Error("the server's scene is of another version");
  const [, planes, boxes, meshes] = header;
  let at = 16;
  const floats = (count) => { const out = new Float32Array(bytes, at, count); at += 4 * count; return out; };
  const integers = (count) => { const out = new Uint32Array(bytes, at, count); at += 4 * count; return out; };

  for (let i = 0; i < planes; ++i) {
    const X = floats(7);
    const ground = new THREE.Mesh(new THREE.PlaneBufferGeometry(GROUND_M, GROUND_M), new THREE.MeshLambertMaterial({ map: groundTexture() }));
    pose(ground, X.subarray(0, 3), X.subarray(3));
    ground.receiveShadow = true;
    parent.add(ground);
  }
  for (let i = 0; i < boxes; ++i) {
    const size = floats(3), X = floats(7), box = makeBox(size);
    pose(box, X.subarray(0, 3), X.subarray(3));
    parent.add(box);
  }
  for (let i = 0; i < meshes; ++i) {
    const [vertices, triangles] = integers(2);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(floats(3 * vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(integers(3 * triangles), 1));
    geometry.computeVertexNormals();
    const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour("--solid"), side: THREE.DoubleSide, flatShading: vertices < 3 * triangles / 2 && triangles < 20000 }));
    mesh.castShadow = mesh.receiveShadow = true;
    parent.add(mesh);
  }
  return parent;
}
