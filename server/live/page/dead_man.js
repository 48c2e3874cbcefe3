// What the operator holds down, by keys, buttons and the stick. Everything is let go of when the window loses the focus or
// is hidden: nobody drives who does not look. So it is when a list or a menu opens, which keeps to itself that a key came up.
import { dialogIsOpen, leaveControl, watchFocus } from "./focus.js";

const KEYS = {
  KeyW: "forward", ArrowUp: "forward", KeyS: "back", ArrowDown: "back",
  KeyA: "left", ArrowLeft: "left", KeyD: "right", ArrowRight: "right",
  KeyQ: "front-up", KeyE: "front-down", KeyR: "rear-up", KeyF: "rear-down",
  KeyJ: "look-left", KeyL: "look-right", KeyI: "look-up", KeyK: "look-down", KeyU: "zoom-in", KeyO: "zoom-out", KeyC: "look-ahead",
  Digit1: "flat", Digit2: "raised", Digit3: "climb", Digit4: "stand", ShiftLeft: "slowly", ShiftRight: "slowly",
};

// A list that was opened by mouse or finger and closed without a choice keeps the focus: letters drive on there, and do not look for an
// entry.
const drivesOn = (event) => event.target.hasAttribute("data-by-pointer") && event.code in KEYS && !event.code.startsWith("Arrow");

// Whether the element with the focus needs the key for itself.
export function keyIsTaken(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || dialogIsOpen()) return true;
  if (event.target instanceof HTMLSelectElement) return event.key !== "Escape" && !drivesOn(event);
  return event.target instanceof HTMLInputElement && event.code.startsWith("Arrow");
}

// `active()`: whether keys, buttons and the stick drive now. `changed()`: after each change. `letGoes` counts how often all was let go of:
// who holds something by other means (gamepad.js) has to press it anew then.
export function watchHands(active, changed) {
  const hands = { held: new Set(), stick: { x: 0, y: 0 }, letGoes: 0, areFull, letGo, hold, steer, areActive: active };
  let pointer = null;   // the one that has the stick

  function areFull() { return hands.held.size > 0 || hands.stick.x !== 0 || hands.stick.y !== 0; }
  function letGo() {
    ++hands.letGoes;
    hands.held.clear();
    pointer = null;   // the stick moves again once it is pressed again
    hands.stick.x = hands.stick.y = 0;
    drawStick();
    for (const button of document.querySelectorAll("[data-held]")) button.removeAttribute("data-held");
    changed();
  }
  function hold(name, down) {
    if (down && !active()) return;
    if (down) hands.held.add(name); else hands.held.delete(name);
    document.querySelector(`[data-hold="${name}"]`)?.toggleAttribute("data-held", down);
    changed();
  }

  addEventListener("keydown", (event) => {
    if (event.key === "Meta") letGo();   // some systems keep what is let go of while it is down to themselves
    const name = KEYS[event.code];
    if (!name || !active() || keyIsTaken(event)) return;
    if (name !== "slowly") {   // Shift is half of Shift-Tab too
      event.preventDefault();   // arrows scroll
      leaveControl();
    }
    if (event.repeat) return;
    // Shift may be down since before the hands were let go of, and says nothing anew.
    if (name !== "slowly" && event.shiftKey !== hands.held.has("slowly")) hold("slowly", event.shiftKey);
    hold(name, true);
  });
  addEventListener("keyup", (event) => {
    const name = KEYS[event.code];
    if (name) hold(name, name === "slowly" && event.shiftKey);   // of two Shifts the other one
  });
  watchFocus(letGo);
  addEventListener("blur", letGo);
  addEventListener("pagehide", letGo);
  addEventListener("contextmenu", (event) => { if (!event.defaultPrevented) letGo(); });
  document.addEventListener("visibilitychange", () => { if (document.hidden) letGo(); });

  // After a choice by mouse or finger the keys drive again; one by the keyboard goes on in its list.
  for (const select of document.querySelectorAll("select")) {
    select.addEventListener("focus", letGo);
    select.addEventListener("pointerdown", () => { select.setAttribute("data-by-pointer", ""); letGo(); });
    select.addEventListener("keydown", (event) => { if (!drivesOn(event)) select.removeAttribute("data-by-pointer"); });
    select.addEventListener("change", () => { if (select.hasAttribute("data-by-pointer")) select.blur(); });
    select.addEventListener("blur", () => select.removeAttribute("data-by-pointer"));
  }

  for (const button of document.querySelectorAll("[data-hold]")) {
    const name = button.dataset.hold;
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      hold(name, true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      button.addEventListener(end, () => hold(name, false));
    }
    button.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || !active()) return;
      event.preventDefault();
      if (!event.repeat) hold(name, true);
    });
    button.addEventListener("keyup", (event) => { if (event.key === "Enter") hold(name, false); });
    button.addEventListener("blur", () => hold(name, false));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  const stick = document.getElementById("stick"), knob = document.getElementById("stick-knob");
  function drawStick() {
    knob.style.translate = `${hands.stick.x * 2.5}rem ${-hands.stick.y * 2.5}rem`;
  }
  function restStick() {
    pointer = null;
    hands.stick.x = hands.stick.y = 0;
    drawStick();
    changed();
  }
  // A pointer moves more often than the server reads: what it changes goes with the next repeated word, begin and end at once.
  function setStick(x, y) {
    const rested = hands.stick.x === 0 && hands.stick.y === 0;
    hands.stick.x = x;
    hands.stick.y = y;
    drawStick();
    if (rested !== (hands.stick.x === 0 && hands.stick.y === 0)) changed();
  }
  function moveStick(event) {
    const box = stick.getBoundingClientRect();
    const x = (event.clientX - box.x) / box.width * 2 - 1, y = 1 - (event.clientY - box.y) / box.height * 2;
    const length = Math.max(1, Math.hypot(x, y));
    const dead = (v) => (Math.abs(v) < 0.12 ? 0 : v);
    setStick(dead(x / length), dead(y / length));
  }
  // By other means than the pointer, which goes before. To rest it comes whatever drives.
  function steer(x, y) {
    if (pointer === null && (active() || (x === 0 && y === 0))) setStick(x, y);
  }
  stick.addEventListener("pointerdown", (event) => {
    if (!active()) return;
    stick.setPointerCapture(event.pointerId);
    pointer = event.pointerId;
    moveStick(event);
  });
  stick.addEventListener("pointermove", (event) => {
    if (event.pointerId !== pointer) return;
    if (event.buttons && document.hasFocus()) moveStick(event); else letGo();
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    stick.addEventListener(end, (event) => { if (event.pointerId === pointer) restStick(); });
  }
  stick.addEventListener("contextmenu", (event) => event.preventDefault());   // a finger that rests on it opens none
  return hands;
}
