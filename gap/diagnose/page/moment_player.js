// Plays the moments of the page: replaces a still picture by WebGL once somebody plays, moves or turns it. Without
// WebGL the still picture stays.
//
// `data-robot` of #moment-figures: {fixed, flipper: faces [material, x, y, z, ...] in mm, counterclockwise from outside,
// has: which of the four flippers it has; pivot: of the front left one in mm}. `data-moment` of a figure: {from, step: s; now: index of the moment;
// view: {centre in m, azimuth, elevation in rad, half: width from the middle to the edge in m}; bodies: [{kind, poses:
// [x, y, z in 0.1 mm, roll, pitch, yaw and flippers fl, fr, rl, rr in 0.1 mrad] or null}]; solids, ground: faces [x, y,
// z, ...] in mm}. All relative to where the real robot is at the moment.
(() => {
  const parent = document.getElementById("moment-figures");
  if (!parent) return;
  const COLOURS = { real: { hull: "--real", belt: "--belt", flipper: "--arm", eye: "--eye" }, nominal: "--sim", corrected: "--third" };
  const SEE_THROUGH = 0.45, WIDTH = 524, HEIGHT = 300;
  const robot = JSON.parse(parent.dataset.robot);

  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const unit = (v) => { const length = Math.hypot(...v) || 1; return v.map((x) => x / length); };
  const points = (numbers) => Array.from({ length: numbers.length / 3 }, (_, i) => numbers.slice(3 * i, 3 * i + 3).map((v) => v / 1000));
  const withMaterial = (faces) => faces.map(([material, ...numbers]) => ({ material, corners: points(numbers) }));
  const parts = { fixed: withMaterial(robot.fixed), flipper: withMaterial(robot.flipper), pivot: robot.pivot.map((v) => v / 1000) };

  // Rotation by roll, pitch and yaw, as columns; turned z, y, x.
  function rotation([roll, pitch, yaw]) {
    const [cr, sr, cp, sp, cy, sy] = [roll, pitch, yaw].flatMap((angle) => [Math.cos(angle), Math.sin(angle)]);
    return [[cy * cp, sy * cp, -sp], [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr], [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr]];
  }
  const turned = (columns, v) => [0, 1, 2].map((i) => columns[0][i] * v[0] + columns[1][i] * v[1] + columns[2][i] * v[2]);

  // The robot's faces in the world. `pose`: metres and radians.
  function facesAt(pose) {
    const columns = rotation(pose.slice(3, 6)), place = (v) => turned(columns, v).map((x, i) => x + pose[i]);
    const faces = parts.fixed.map(({ material, corners }) => ({ material, corners: corners.map(place) }));
    for (let i = 0; i < 4; ++i) {
      if (!robot.has[i]) continue;
      const ahead = i < 2 ? 1 : -1, left = i % 2 ? -1 : 1, c = Math.cos(pose[6 + i]), s = Math.sin(pose[6 + i]);
      const inBody = ([x, y, z]) => [ahead * (parts.pivot[0] + c * x - s * z), left * parts.pivot[1] + ahead * y, parts.pivot[2] + s * x + c * z];
      for (const { material, corners } of parts.flipper) faces.push({ material, corners: corners.map((v) => place(inBody(v))) });
    }
    return faces;
  }

  // Between two samples; null where the pose is not known.
  function poseAt(body, place) {
    const i = Math.min(body.poses.length - 1, Math.floor(place)), a = body.poses[i], b = body.poses[Math.min(i + 1, body.poses.length - 1)];
    if (!a || !b) return null;
    return a.map((value, k) => (value + (b[k] - value) * (place - i)) / 1e4);
  }

  const style = () => getComputedStyle(document.documentElement);
  const mixer = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  function colour(name) {
    mixer.fillStyle = style().getPropertyValue(name).trim() || "#888";
    mixer.fillRect(0, 0, 1, 1);
    return [...mixer.getImageData(0, 0, 1, 1).data].slice(0, 3).map((v) => v / 255);
  }

  function program(gl) {
    const made = gl.createProgram();
    for (const [type, text] of [
      [gl.VERTEX_SHADER, "attribute vec3 p; attribute vec3 c; varying vec3 hue; uniform vec3 centre, right, up, eye; uniform vec2 scale;" +
        "void main() { vec3 d = p - centre; hue = c; gl_Position = vec4(dot(d, right) * scale.x, dot(d, up) * scale.y, -dot(d, eye) * 0.05, 1.0); }"],
      [gl.FRAGMENT_SHADER, "precision mediump float; varying vec3 hue; uniform float alpha; void main() { gl_FragColor = vec4(hue * alpha, alpha); }"]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    gl.useProgram(made);
    return made;
  }

  // Draws on a canvas; null where there is no WebGL.
  function createPainter(canvas) {
    const gl = canvas.getContext("webgl", { antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
    if (!gl) return null;
    const made = program(gl), buffer = gl.createBuffer(), where = (name) => gl.getUniformLocation(made, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    for (const [i, name] of ["p", "c"].entries()) {
      const at = gl.getAttribLocation(made, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, 12 * i);
    }
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.CULL_FACE);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

    // `hueOf(face)`: its colour in full light.
    function triangles(faces, hueOf, light) {
      const numbers = [];
      for (const face of faces) {
        const { corners } = face;
        let normal = [0, 0, 0];
        for (let i = 2; i < corners.length && !Math.hypot(...normal); ++i)
          normal = cross(corners[1].map((v, k) => v - corners[0][k]), corners[i].map((v, k) => v - corners[0][k]));
        const shade = 0.62 + 0.38 * dot(unit(normal), light), hue = hueOf(face).map((v) => Math.min(1, v * shade));
        for (let i = 2; i < corners.length; ++i) for (const corner of [corners[0], corners[i - 1], corners[i]]) numbers.push(...corner, ...hue);
      }
      return numbers;
    }
    function draw(mode, numbers) {
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.DYNAMIC_DRAW);
      gl.drawArrays(mode, 0, numbers.length / 6);
    }

    return ({ azimuth, elevation, half }, centre, ground, solids, robots) => {
      const eye = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
      const right = [-Math.sin(azimuth), Math.cos(azimuth), 0], up = cross(eye, right);
      const light = unit([0, 1, 2].map((i) => 0.35 * right[i] + 0.8 * up[i] + 0.5 * eye[i]));
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      for (const [name, value] of Object.entries({ centre, right, up, eye })) gl.uniform3fv(where(name), value);
      gl.uniform2f(where("scale"), 1 / half, canvas.width / canvas.height / half);
      gl.uniform1f(where("alpha"), 1);
      gl.disable(gl.BLEND);
      gl.disable(gl.POLYGON_OFFSET_FILL);

      const lineHue = colour("--grid");
      draw(gl.LINES, ground.flatMap((corners) => corners.flatMap((corner, i) => [...corner, ...lineHue, ...corners[(i + 1) % corners.length], ...lineHue])));
      gl.disable(gl.CULL_FACE);   // the ground may be a single sheet
      const solidHue = colour("--ground");
      draw(gl.TRIANGLES, triangles(solids.map((corners) => ({ corners })), () => solidHue, light));
      gl.enable(gl.CULL_FACE);
      const hues = new Map();
      const hue = (name) => { if (!hues.has(name)) hues.set(name, colour(name)); return hues.get(name); };
      for (const { kind, faces } of robots) {
        const numbers = triangles(faces, ({ material }) => hue(kind === "real" ? COLOURS.real[material] : COLOURS[kind]), light);
        if (kind === "real") { draw(gl.TRIANGLES, numbers); continue; }
        // its own nearest faces alone, a little behind those of the real robot where both are at the same place
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(1, 4);
        gl.colorMask(false, false, false, false);
        draw(gl.TRIANGLES, numbers);
        gl.colorMask(true, true, true, true);
        gl.enable(gl.BLEND);
        gl.uniform1f(where("alpha"), SEE_THROUGH);
        draw(gl.TRIANGLES, numbers);
        gl.uniform1f(where("alpha"), 1);
        gl.disable(gl.BLEND);
        gl.disable(gl.POLYGON_OFFSET_FILL);
      }
    };
  }

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  function setUp(figure) {
    const data = JSON.parse(figure.dataset.moment), scene = figure.querySelector(".scene"), still = scene.querySelector("svg");
    const last = data.bodies[0].poses.length - 1, view = { ...data.view }, hidden = new Set();
    const ground = data.ground.map(points), solids = data.solids.map(points);
    let place = data.now, painter, playing = false, last_ms = null;

    const play = element("button", { type: "button", textContent: "Play" });
    const slider = element("input", { type: "range", min: 0, max: last, step: "any", value: place });
    slider.setAttribute("aria-label", "Time");
    const time = element("output"), controls = element("div", { className: "controls" }, play, slider, time);
    for (const { kind } of data.bodies.slice(1)) {
      const box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => { if (box.checked) hidden.delete(kind); else hidden.add(kind); start(); });
      controls.append(element("label", {}, box, ` ${kind}`));
    }
    scene.after(controls);
    const canvas = element("canvas", { hidden: true, tabIndex: 0 });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${still.getAttribute("aria-label")}: arrow keys or dragging turn it`);
    scene.append(canvas);

    const seconds = () => data.from + place * data.step;
    function tell() {
      const text = `${seconds().toFixed(2)} s`;
      slider.value = place;
      slider.setAttribute("aria-valuetext", text);
      time.textContent = text;
      play.textContent = playing ? "Pause" : "Play";
    }
    // From the first use on; without WebGL the still picture stays.
    function start() {
      if (painter === undefined) {
        painter = createPainter(canvas);
        if (painter) {
          canvas.hidden = false;
          still.classList.add("replaced");
          new ResizeObserver(draw).observe(scene);
        } else {
          controls.replaceChildren("This browser has no WebGL: the command below shows the run.");
        }
      }
      draw();
    }
    function draw() {
      if (!painter) return;
      const width = Math.round(scene.clientWidth * devicePixelRatio);
      canvas.width = width;
      canvas.height = Math.round(width * HEIGHT / WIDTH);
      const states = data.bodies.map((body) => ({ kind: body.kind, pose: poseAt(body, place) }));
      // it follows the real robot
      const at = states[0].pose ?? [0, 0, 0], centre = data.view.centre.map((v, i) => v + at[i]);
      painter(view, centre, ground, solids, states.filter(({ kind, pose }) => pose && !hidden.has(kind)).map(({ kind, pose }) => ({ kind, faces: facesAt(pose) })));
      canvas.dataset.drawn = seconds().toFixed(2);
    }
    function show(next) {
      place = Math.max(0, Math.min(last, next));
      if (place >= last) playing = false;
      tell();
      start();
    }
    function tick(now_ms) {
      if (!playing) return;
      const passed_s = last_ms === null ? 0 : Math.min(0.25, (now_ms - last_ms) / 1000);
      last_ms = now_ms;
      show(place + passed_s / data.step);
      if (playing) requestAnimationFrame(tick);
    }
    function turn(azimuth, elevation) {
      view.azimuth += azimuth;
      view.elevation = Math.max(0.02, Math.min(1.55, view.elevation + elevation));
      start();
    }

    play.addEventListener("click", () => {
      if (!playing && place >= last) place = 0;
      playing = !playing;
      last_ms = null;
      tell();
      if (playing) requestAnimationFrame(tick);
    });
    slider.addEventListener("input", () => { playing = false; show(Number(slider.value)); });
    let from = null;
    scene.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      from = [event.clientX, event.clientY];
      scene.setPointerCapture(event.pointerId);
    });
    scene.addEventListener("pointermove", (event) => {
      if (!from) return;
      turn((from[0] - event.clientX) * 0.01, (event.clientY - from[1]) * 0.01);
      from = [event.clientX, event.clientY];
    });
    for (const name of ["pointerup", "pointercancel"]) scene.addEventListener(name, () => { from = null; });
    const TURNS = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    canvas.addEventListener("keydown", (event) => {
      if (!TURNS[event.key]) return;
      event.preventDefault();
      turn(...TURNS[event.key]);
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
    tell();
  }
  for (const figure of parent.querySelectorAll("figure.moment")) setUp(figure);
})();
