// What the operator holds down, by keys, buttons and the stick. Everything is let go of when the window loses the focus or
// is hidden: nobody drives who does not look.
const KEYS = {
  KeyW: "forward", ArrowUp: "forward", KeyS: "back", ArrowDown: "back",
  KeyA: "left", ArrowLeft: "left", KeyD: "right", ArrowRight: "right",
  KeyQ: "front-up", KeyE: "front-down", KeyR: "rear-up", KeyF: "rear-down",
  KeyJ: "look-left", KeyL: "look-right", KeyI: "look-up", KeyK: "look-down", KeyU: "zoom-in", KeyO: "zoom-out", KeyC: "look-ahead",
  Digit1: "flat", Digit2: "raised", Digit3: "climb", Digit4: "stand",
};

// Whether the element with the focus needs the key for itself.
export function keyIsTaken(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return true;
  if (event.target instanceof HTMLSelectElement) return true;
  return event.target instanceof HTMLInputElement && event.code.startsWith("Arrow");
}

// `active()`: whether keys drive now. `changed()`: after each change.
export function watchHands(active, changed) {
  const hands = { held: new Set(), stick: { x: 0, y: 0 }, letGo };

  function letGo() {
    hands.held.clear();
    hands.stick.x = hands.stick.y = 0;
    drawStick();
    for (const button of document.querySelectorAll("[data-held]")) button.removeAttribute("data-held");
    changed();
  }
  function hold(name, down) {
    if (down) hands.held.add(name); else hands.held.delete(name);
    document.querySelector(`[data-hold="${name}"]`)?.toggleAttribute("data-held", down);
    changed();
  }

  addEventListener("keydown", (event) => {
    if (event.key === "Meta") letGo();   // some systems keep what is let go of while it is down to themselves
    const name = KEYS[event.code];
    if (!name || !active() || keyIsTaken(event)) return;
    event.preventDefault();   // arrows scroll
    if (!event.repeat) hold(name, true);
  });
  addEventListener("keyup", (event) => {
    if (KEYS[event.code]) hold(KEYS[event.code], false);
  });
  addEventListener("blur", letGo);
  addEventListener("pagehide", letGo);
  document.addEventListener("visibilitychange", () => { if (document.hidden) letGo(); });

  for (const button of document.querySelectorAll("[data-hold]")) {
    const name = button.dataset.hold;
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      hold(name, true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      button.addEventListener(end, () => hold(name, false));
    }
    button.addEventListener("keydown", (event) => { if (event.key === " " || event.key === "Enter") { event.preventDefault(); hold(name, true); } });
    button.addEventListener("keyup", (event) => { if (event.key === " " || event.key === "Enter") hold(name, false); });
    button.addEventListener("blur", () => hold(name, false));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  const stick = document.getElementById("stick"), knob = document.getElementById("stick-knob");
  function drawStick() {
    knob.style.translate = `${hands.stick.x * 2.5}rem ${-hands.stick.y * 2.5}rem`;
  }
  function moveStick(event) {
    const box = stick.getBoundingClientRect();
    const x = (event.clientX - box.x) / box.width * 2 - 1, y = 1 - (event.clientY - box.y) / box.height * 2;
    const length = Math.max(1, Math.hypot(x, y));
    const dead = (v) => (Math.abs(v) < 0.12 ? 0 : v);
    hands.stick.x = dead(x / length);
    hands.stick.y = dead(y / length);
    drawStick();
    changed();
  }
  stick.addEventListener("pointerdown", (event) => { stick.setPointerCapture(event.pointerId); moveStick(event); });
  stick.addEventListener("pointermove", (event) => { if (stick.hasPointerCapture(event.pointerId)) moveStick(event); });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    stick.addEventListener(end, () => { hands.stick.x = hands.stick.y = 0; drawStick(); changed(); });
  }
  return hands;
}
