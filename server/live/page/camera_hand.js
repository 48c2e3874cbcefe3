// Turning and zooming the camera of the robot that is held: by keys, while they are held, and by sliders. Angles as the server has
// them: pan positive to the left, tilt positive down; the sliders' right ends are right, up and near.
const TURN = 1.2;          // rad/s, while a key is held
const ZOOM = 1.5;          // factor of e in a second
const STEP_MS = 50;
const FOLLOW_MS = 1500;    // after the last word here the sliders show where the camera is
const by = (id) => document.getElementById(id);
const clamp = (value, [least, most]) => Math.max(least, Math.min(most, value));
const degrees = (radians) => radians * 180 / Math.PI;

export function createCameraHand(link, driving) {
  let wish = null, robotId = 0, wished_ms = -Infinity, unsaid = false, sent = "";

  // The first camera that turns or zooms, with where it is now; null where there is none, or the robot is not yours.
  function camera() {
    const robot = driving.holding();
    const index = (robot?.about.cameras ?? []).findIndex((each) => each.pan || each.fov[0] < each.fov[1]);
    return index < 0 || !robot.now.cameras ? null : { robot, about: robot.about.cameras[index], now: robot.now.cameras[index] };
  }

  // A slider changes more often than the server reads: its newest place goes with the next beat.
  function speak() {
    const seen = camera();
    if (!seen || !wish || !unsaid || !link.isHeard()) return;
    unsaid = false;
    const { about, robot } = seen;
    const order = { type: "look", robot: robot.about.id, camera: about.name, fov: wish.fov };
    if (about.pan) order.pan = wish.pan;
    if (about.tilt) order.tilt = wish.tilt;
    const text = JSON.stringify(order);
    if (text !== sent) link.send(order);
    sent = text;
  }

  // From 0, the widest, to 1, the nearest.
  const nearness = (fov, [least, most]) => (least < most ? Math.log(most / fov) / Math.log(most / least) : 0);
  const side = (angle, minus, plus) => `${Math.abs(degrees(angle)).toFixed(0)}\u00b0 ${Math.abs(angle) < 0.005 ? "" : angle > 0 ? plus : minus}`;

  function show({ about }) {
    by("look-pan-label").classList.toggle("away", !about.pan);
    by("look-tilt-label").classList.toggle("away", !about.tilt);
    by("look-zoom-label").classList.toggle("away", about.fov[0] === about.fov[1]);
    if (about.pan) {
      [by("look-pan").min, by("look-pan").max] = [degrees(-about.pan[1]), degrees(-about.pan[0])];
      by("look-pan").value = degrees(-wish.pan);
      by("look-pan-value").textContent = side(wish.pan, "right", "left");
    }
    if (about.tilt) {
      [by("look-tilt").min, by("look-tilt").max] = [degrees(-about.tilt[1]), degrees(-about.tilt[0])];
      by("look-tilt").value = degrees(-wish.tilt);
      by("look-tilt-value").textContent = side(wish.tilt, "up", "down");
    }
    by("look-zoom").value = 100 * nearness(wish.fov, about.fov);
    by("look-zoom-value").textContent = `${degrees(wish.fov).toFixed(0)}\u00b0 wide`;
  }

  function change(turn) {
    const seen = camera();
    if (!seen || !wish) return;
    turn(wish, seen.about);
    wish.pan = clamp(wish.pan, seen.about.pan ?? [0, 0]);
    wish.tilt = clamp(wish.tilt, seen.about.tilt ?? [0, 0]);
    wish.fov = clamp(wish.fov, seen.about.fov);
    unsaid = true;
    wished_ms = performance.now();
    show(seen);
  }
  by("look-pan").addEventListener("input", (event) => change((to) => { to.pan = -event.target.value * Math.PI / 180; }));
  by("look-tilt").addEventListener("input", (event) => change((to) => { to.tilt = -event.target.value * Math.PI / 180; }));
  by("look-zoom").addEventListener("input", (event) => change((to, { fov }) => {
    to.fov = fov[1] * (fov[0] / fov[1]) ** (event.target.value / 100);
  }));

  function turnByKeys() {
    const held = driving.held, sign = (plus, minus) => (held.has(plus) ? 1 : 0) - (held.has(minus) ? 1 : 0);
    const pan = sign("look-left", "look-right"), tilt = sign("look-down", "look-up"), zoom = sign("zoom-out", "zoom-in");
    if (held.has("look-ahead")) change((to) => { to.pan = to.tilt = 0; });
    if (!pan && !tilt && !zoom) return;
    const step_s = STEP_MS / 1000;
    change((to) => {
      to.pan += pan * TURN * step_s;
      to.tilt += tilt * TURN * step_s;
      to.fov *= Math.exp(zoom * ZOOM * step_s);
    });
  }
  setInterval(() => {
    turnByKeys();
    speak();
  }, STEP_MS);

  return {
    update() {
      const seen = camera();
      by("look").classList.toggle("away", !seen);
      if (!seen) {
        wish = null;
        return;
      }
      const follows = !wish || robotId !== seen.robot.about.id || performance.now() > wished_ms + FOLLOW_MS;
      if (!follows) return;
      unsaid = false;
      robotId = seen.robot.about.id;
      wish = { pan: seen.now.pan ?? 0, tilt: seen.now.tilt ?? 0, fov: seen.now.fov };
      sent = "";
      show(seen);
    },
  };
}
