// What the chosen robot's range scanners, sonars and inertial sensor have before them, as the server finds it, without noise.
import * as THREE from "/three/build/three.module.js";
import { fixed } from "./numbers.js";
import { colour } from "./scene.js";

const M_PER_MPS2 = 0.03, M_PER_RADPS = 0.3;   // lengths of the inertial sensor's two arrows
const ECHO_M = 0.035;                        // size of a scanner's echo on the screen's surface
const CONE_SIDES = 16;

// Places of a scan's echoes, and of the ends of its rays without one, which are left open.
export function echoesOf(scan) {
  const q = new THREE.Quaternion(scan.q[1], scan.q[2], scan.q[3], scan.q[0]), from = new THREE.Vector3(...scan.p);
  return scan.ranges.map((range, i) => {
    if (range === null) return null;
    const share = scan.ranges.length > 1 ? i / (scan.ranges.length - 1) : 0.5, angle = scan.fov * (0.5 - share);
    return new THREE.Vector3(range * Math.cos(angle), range * Math.sin(angle), 0).applyQuaternion(q).add(from);
  });
}

export function createSensorRays(scene, words) {
  const parent = new THREE.Group();
  parent.visible = false;
  scene.add(parent);
  const make = (Kind, Material, options) => {
    const object = new Kind(new THREE.BufferGeometry(), new Material(options));
    object.frustumCulled = false;
    parent.add(object);
    return object;
  };
  const fan = make(THREE.LineSegments, THREE.LineBasicMaterial, { transparent: true, opacity: 0.35 });
  const echoes = make(THREE.Points, THREE.PointsMaterial, { size: ECHO_M });
  const cones = make(THREE.LineSegments, THREE.LineBasicMaterial, {});
  const felt = make(THREE.LineSegments, THREE.LineBasicMaterial, { depthTest: false });
  felt.renderOrder = 10;

  function fill(object, places, name) {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry().setFromPoints(places);
    object.material.color.copy(colour(name));
  }

  function coneOf(scan) {
    const range = scan.ranges[0];
    if (range === null) return [];
    const q = new THREE.Quaternion(scan.q[1], scan.q[2], scan.q[3], scan.q[0]), from = new THREE.Vector3(...scan.p), half = scan.fov / 2;
    const rim = (i) => {
      const around = 2 * Math.PI * i / CONE_SIDES;
      return new THREE.Vector3(Math.cos(half), Math.sin(half) * Math.cos(around), Math.sin(half) * Math.sin(around)).multiplyScalar(range)
        .applyQuaternion(q).add(from);
    };
    const lines = [];
    for (let i = 0; i < CONE_SIDES; ++i) {
      lines.push(rim(i), rim(i + 1));
      if (i % 4 === 0) lines.push(from, rim(i));
    }
    return lines;
  }

  function tell(robot) {
    const { scans, imu } = robot?.now ?? {};
    if (!scans) {
      words.textContent = robot ? "Sensors: waiting for the server" : "Sensors: no robot";
      return;
    }
    const nearest = (scan) => scan.ranges.reduce((least, range) => (range === null ? least : Math.min(least, range)), Infinity);
    const texts = scans.map((scan) => `${scan.name} ${Number.isFinite(nearest(scan)) ? `${fixed(nearest(scan), 2)} m` : "no echo"}`);
    if (imu) texts.push(`felt ${fixed(Math.hypot(...imu.a), 2)} m/s\u00b2, turning ${fixed(Math.hypot(...imu.w), 2)} rad/s`);
    words.textContent = texts.length ? `Nearest: ${texts.join("; ")}` : `${robot.about.name} has none of these sensors`;
  }

  return {
    update(robot) {
      const scans = robot?.now?.scans ?? [], scanners = scans.filter((scan) => !scan.sonar), found = scanners.map(echoesOf);
      const rays = scanners.flatMap((scan, i) => found[i].filter(Boolean).flatMap((end) => [new THREE.Vector3(...scan.p), end]));
      fill(fan, rays, "--c1");
      fill(echoes, found.flat().filter(Boolean), "--c1");
      fill(cones, scans.filter((scan) => scan.sonar).flatMap(coneOf), "--c2");
      const { imu } = robot?.now ?? {}, p = imu && new THREE.Vector3(...imu.p);
      const arrow = (of, scale) => [p, p.clone().addScaledVector(new THREE.Vector3(...of), scale)];
      fill(felt, imu ? [...arrow(imu.a, M_PER_MPS2), ...arrow(imu.w, M_PER_RADPS)] : [], "--force-body");
      parent.visible = true;
      tell(robot);
    },
    hide() { parent.visible = false; },
  };
}
