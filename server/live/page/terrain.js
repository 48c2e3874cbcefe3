// How ground, boxes and meshes look: lines of 1 m over level ground, contour lines over all that is inclined, colours by height,
// and sharp edges. Surfaces are those of the simulation, smoothed as the cameras' pictures are (camera/mesh_facing.hpp).
import * as THREE from "/three/build/three.module.js";

const SMOOTH_RAD = 35 * Math.PI / 180;
const MOST_EDGES_OF = 60000;   // triangles; edges of a finer mesh would be a carpet of lines

const VERTEX = `
  vPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;`;

// A line of about a pixel where v is a whole number, `wide` its change from pixel to pixel; none where lines would be closer than some
// pixels, or v stands still.
const DECLARATIONS = `
  varying vec3 vPlace;
  uniform vec3 uHigh;
  uniform vec2 uHeights;
  uniform vec3 uLine;
  uniform float uContour;
  float lineAt(float v, float wide, float pixels) {
    float away = abs(fract(v - 0.5) - 0.5) / max(wide, 1e-6);
    return clamp(0.5 * pixels + 0.5 - away, 0.0, 1.0) * clamp(1.4 - 4.0 * wide, 0.0, 1.0) * step(1e-5, wide);
  }`;

// LEVEL: nothing of it is inclined, and its colour does not rise. Most of a picture is level ground, and without a graphics card each
// operation on a pixel counts.
const FRAGMENT = `
  #ifdef LEVEL
    vec2 wide = fwidth(vPlace.xy);
    float line = 0.55 * max(lineAt(vPlace.x, wide.x, 1.6), lineAt(vPlace.y, wide.y, 1.6));
  #else
    vec3 right = dFdx(vPlace), up = dFdy(vPlace), wide = abs(right) + abs(up);
    float level = abs(normalize(cross(right, up)).z);
    diffuseColor.rgb = mix(diffuseColor.rgb, uHigh, smoothstep(uHeights.x, uHeights.y, vPlace.z));
    float line = 0.0;
    if (level > 0.2) line = 0.55 * max(lineAt(vPlace.x, wide.x, 1.6), lineAt(vPlace.y, wide.y, 1.6));
    if (level < 0.9995) {
      float c = vPlace.z * uContour, cWide = wide.z * uContour;
      line = max(line, max(0.7 * lineAt(c, cWide, 1.3), lineAt(0.2 * c, 0.2 * cWide, 2.4)));
    }
  #endif
  diffuseColor.rgb = mix(diffuseColor.rgb, uLine, line);`;

// Contour lines as far apart as a surveyor would draw them: about fifteen over the relief, every fifth a thick one.
export function contourInterval_m([least, most]) {
  return [0.01, 0.02, 0.05, 0.1, 0.2, 0.5].find((interval) => most - least <= 15 * interval) ?? 1;
}

// `base`: at the least of `heights`, `high` at the largest, `line`: of lines; each a colour. `level`: of a level plane.
export function terrainMaterial({ base, high, line, heights, level }) {
  const material = new THREE.MeshLambertMaterial({ color: base, side: THREE.DoubleSide });
  const uniforms = { uHigh: { value: high }, uLine: { value: line }, uHeights: { value: new THREE.Vector2(...heights) },
                     uContour: { value: 1 / contourInterval_m(heights) } };
  material.extensions = { derivatives: true };
  if (level) material.defines = { LEVEL: 1 };
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader.replace("#include <common>", "#include <common>\nvarying vec3 vPlace;")
      .replace("#include <begin_vertex>", `#include <begin_vertex>${VERTEX}`);
    shader.fragmentShader = shader.fragmentShader.replace("#include <common>", `#include <common>${DECLARATIONS}`)
      .replace("#include <color_fragment>", `#include <color_fragment>${FRAGMENT}`);
  };
  // lines of edges are drawn over it
  material.polygonOffset = true;
  material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
  return material;
}

// Triangles with a normal at each corner: the mean, by area, of the triangles that meet there and are inclined by less than 35 degrees to
// this one. Beside it the edges at which they are inclined by more, and those of one triangle only.
export function surfaceOf(vertices, triangles) {
  const count = triangles.length / 3, corners = 9 * count;
  const position = new Float32Array(corners), normal = new Float32Array(corners), area = new Float32Array(3 * count);

  // Files often have vertices of their own for each triangle.
  const places = new Map(), place = new Uint32Array(vertices.length / 3);
  for (let v = 0; v < place.length; ++v) {
    const key = `${vertices[3 * v]},${vertices[3 * v + 1]},${vertices[3 * v + 2]}`;
    if (!places.has(key)) places.set(key, v);
    place[v] = places.get(key);
  }
  const around = new Map();   // place: the triangles that meet there
  const a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3();
  for (let i = 0; i < count; ++i) {
    [a, b, c].forEach((p, k) => {
      p.fromArray(vertices, 3 * triangles[3 * i + k]).toArray(position, 9 * i + 3 * k);
      const at = place[triangles[3 * i + k]];
      if (!around.has(at)) around.set(at, []);
      around.get(at).push(i);
    });
    b.sub(a).cross(c.sub(a)).toArray(area, 3 * i);
  }
  const least = Math.cos(SMOOTH_RAD);
  const like = (i, j) => {
    const dot = area[3 * i] * area[3 * j] + area[3 * i + 1] * area[3 * j + 1] + area[3 * i + 2] * area[3 * j + 2];
    return dot >= least * Math.hypot(area[3 * i], area[3 * i + 1], area[3 * i + 2]) * Math.hypot(area[3 * j], area[3 * j + 1], area[3 * j + 2]);
  };
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) {
      a.set(0, 0, 0);
      for (const j of around.get(place[triangles[3 * i + k]])) if (like(i, j)) a.add(b.fromArray(area, 3 * j));
      a.normalize().toArray(normal, 9 * i + 3 * k);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normal, 3));

  const edges = [];
  if (count <= MOST_EDGES_OF) {
    const open = new Map();   // edge: the triangle on its one side
    for (let i = 0; i < count; ++i) {
      for (let k = 0; k < 3; ++k) {
        const [from, to] = [triangles[3 * i + k], triangles[3 * i + (k + 1) % 3]], ends = [place[from], place[to]];
        const key = ends[0] < ends[1] ? `${ends[0]},${ends[1]}` : `${ends[1]},${ends[0]}`;
        const line = [...vertices.subarray(3 * from, 3 * from + 3), ...vertices.subarray(3 * to, 3 * to + 3)];
        if (!open.has(key)) { open.set(key, { i, line }); continue; }
        if (!like(i, open.get(key).i)) edges.push(...line);
        open.delete(key);
      }
    }
    for (const { line } of open.values()) edges.push(...line);
  }
  return { geometry, edges: new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(edges, 3)) };
}
