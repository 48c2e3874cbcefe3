// A robot as three.js objects: hull, two tracks or its wheels, its flippers; belts run and flippers turn. In the colours that the
// cameras' pictures have (camera/shading.cpp); only its deck says whose it is, or how it is.
//
// Frame of the server: x forward, y left, z up.
import * as THREE from "/three/build/three.module.js";
import { penOf } from "./pen.js";

const COLOURS = { hull: 0xecba28, side: 0x606268, front: 0xde602c, rear: 0x4670b0, eye: 0xe9efe9 };
const STRIPE_M = 0.04;   // from lug to lug

function beltTexture() {
  const canvas = document.createElement("canvas");
  canvas.width = 16;
  canvas.height = 4;
  const pen = penOf(canvas);
  pen.fillStyle = "#3b3e3f";
  pen.fillRect(0, 0, 16, 4);
  pen.fillStyle = "#6c7070";
  pen.fillRect(0, 0, 5, 4);
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 4;
  return texture;
}

// The outline around two discs of radius r0 at x = 0 and r1 at x = length, counterclockwise seen from -y, closed. A
// length of 0 makes a circle.
function beltOutline(length, r0, r1) {
  const lean = Math.acos(Math.max(-1, Math.min(1, length > 0 ? (r0 - r1) / length : 0))), points = [];
  const arc = (x, r, from, to) => {
    for (let i = 0; i <= 12; ++i) {
      const a = from + (to - from) * i / 12;
      points.push([x + r * Math.cos(a), r * Math.sin(a)]);
    }
  };
  arc(length, r1, -lean, lean);
  arc(0, r0, lean, 2 * Math.PI - lean);
  points.push(points[0]);
  return points;
}

// A belt of that outline and its two flat sides. `texture` runs along it.
function makeBelt(outline, width, texture, sideMaterial) {
  const position = [], uv = [], index = [];
  let along = 0;
  outline.forEach(([x, z], i) => {
    if (i) along += Math.hypot(x - outline[i - 1][0], z - outline[i - 1][1]);
    for (const side of [-1, 1]) {
      position.push(x, side * width / 2, z);
      uv.push(along / STRIPE_M, side);
    }
    if (i) index.push(2 * i - 2, 2 * i, 2 * i - 1, 2 * i - 1, 2 * i, 2 * i + 1);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
  geometry.setAttribute("uv", new THREE.Float32BufferAttribute(uv, 2));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  const belt = new THREE.Group();
  belt.add(new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ map: texture, side: THREE.DoubleSide })));

  const shape = new THREE.Shape(outline.slice(0, -1).map(([x, z]) => new THREE.Vector2(x, z)));
  for (const side of [-1, 1]) {
    const face = new THREE.Mesh(new THREE.ShapeBufferGeometry(shape), sideMaterial);
    face.rotation.x = Math.PI / 2;   // x, z of the outline
    face.position.y = side * width / 2;
    belt.add(face);
  }
  return belt;
}

function castShadows(object) {
  object.traverse((part) => { part.castShadow = part.isMesh; });
}

export function makeRobot(about) {
  const root = new THREE.Group();
  const hullMaterial = new THREE.MeshLambertMaterial({ color: COLOURS.hull });
  const deckMaterial = new THREE.MeshLambertMaterial({ color: COLOURS.hull });
  const sideMaterial = new THREE.MeshLambertMaterial({ color: COLOURS.side, side: THREE.DoubleSide });
  const [frontMaterial, rearMaterial] = [COLOURS.front, COLOURS.rear].map((color) => new THREE.MeshLambertMaterial({ color, side: THREE.DoubleSide }));

  const [x, y, z] = about.body;
  const hull = new THREE.Mesh(new THREE.BoxBufferGeometry(x, y, z), hullMaterial);
  root.add(hull);
  // a light deck that ends in front, so that one sees where it looks
  const deck = new THREE.Mesh(new THREE.BoxBufferGeometry(0.7 * x, 1.7 * y, 0.02), deckMaterial);
  deck.position.set(0, 0, z / 2);
  const eye = new THREE.Mesh(new THREE.BoxBufferGeometry(0.05, 0.7 * y, 0.04), new THREE.MeshLambertMaterial({ color: COLOURS.eye }));
  eye.position.set(0.42 * x, 0, z / 2 + 0.02);
  root.add(deck, eye);

  const { flipper } = about;
  const addBelt = ({ length, radius, width, at }, y, texture) => {
    const runs = length - 2 * radius;
    const belt = makeBelt(beltOutline(runs, radius, radius), width, texture, sideMaterial);
    belt.position.set(at[0] - runs / 2, y, at[2]);
    root.add(belt);
  };
  // one texture for all that turns with a side
  const tracks = [1, -1].map((side) => {
    const texture = beltTexture();
    for (const track of about.tracks) addBelt(track, side * track.at[1], texture);
    return texture;
  });
  for (const caster of about.casters) addBelt(caster, caster.at[1], beltTexture());
  const places = [[1, 1], [1, -1], [-1, 1], [-1, -1]].map(([ahead, side], i) => ({ ahead, side, i }));
  const arms = !flipper ? [] : places.filter(({ i }) => flipper.has[i]).map(({ ahead, side, i }) => {
    const mount = new THREE.Group(), arm = new THREE.Group(), texture = beltTexture();
    arm.add(makeBelt(beltOutline(flipper.length, flipper.pivot_radius, flipper.tip_radius), flipper.width, texture, ahead > 0 ? frontMaterial : rearMaterial));
    mount.position.set(ahead * flipper.at[0], side * flipper.at[1], flipper.at[2]);
    if (ahead < 0) mount.rotation.z = Math.PI;
    mount.add(arm);
    root.add(mount);
    return { arm, texture, track: side > 0 ? 0 : 1, ahead, i };
  });
  castShadows(root);

  return {
    root,
    // `now`: p, q, track_m, flipper. `deck`: its colour.
    update(now, deck) {
      root.position.fromArray(now.p);
      root.quaternion.set(now.q[1], now.q[2], now.q[3], now.q[0]);
      deckMaterial.color.set(deck);
      // going forward the lower run stands still on the ground, and the outline goes forward there
      tracks.forEach((texture, side) => { texture.offset.x = (now.track_m[side] / STRIPE_M) % 1; });
      arms.forEach(({ arm, texture, track: side, ahead, i }) => {
        arm.rotation.y = -now.flipper[i];
        texture.offset.x = (ahead * now.track_m[side] / STRIPE_M) % 1;
      });
    },
  };
}
