// Driving by a gamepad, with the buttons of the operator's console (docs/operator.md): its left shoulder button is the dead-man's switch.
// What is held counts only if it was pressed since the hands were last let go of, by Space or by anything else.
const STEP_MS = 50;
const RESTS = 0.12;   // a stick that is let go of may rest this far from its middle
const DEAD_MAN = 4, STAND = 1, FASTER = 5, SLOWER = 8;
const HOLDS = { 0: "flat", 2: "climb", 3: "raised", 11: "stand", 12: "front-up", 13: "front-down", 14: "rear-down", 15: "rear-up" };

// 0 where it rests, then without a jump to 1.
function deflection(axis) {
  return Math.sign(axis) * Math.max(0, (Math.abs(axis) - RESTS) / (1 - RESTS));
}

// `changePace(steps)`; `say(words)`: to the person.
export function createGamepad(hands, changePace, say) {
  let down = new Set();         // pressed, by the newest look
  let old = null;               // of these, those from before the hands were let go of; null: all
  let seen = 0, held = new Set(), steers = false, name = null;

  const pressed = (button) => down.has(button) && !old.has(button);

  function greet(pad) {
    if (pad.id === name) return;
    name = pad.id;
    old = null;   // whatever is down now is from before
    say(pad.mapping === "standard" ? `Gamepad: ${pad.id}. Hold its left shoulder button to drive`
      : `Gamepad: ${pad.id} is not used, as this browser does not know which of its buttons is which`);
  }

  function look() {
    const pad = [...navigator.getGamepads?.() ?? []].find((each) => each?.connected);
    if (pad) greet(pad); else name = null;
    const before = down;
    down = new Set(pad?.mapping === "standard" ? [...pad.buttons.keys()].filter((i) => pad.buttons[i].pressed) : []);
    const rises = (button) => down.has(button) && !before.has(button);
    if (rises(STAND)) hands.letGo();   // B, whatever else is held
    if (seen !== hands.letGoes || !hands.areActive() || !document.hasFocus()) old = null;
    seen = hands.letGoes;
    old = new Set(old ? [...old].filter((button) => down.has(button)) : down);

    for (const [button, word] of Object.entries(HOLDS)) {
      const on = pressed(Number(button));
      if (on !== held.has(word)) hands.hold(word, on);
      if (on) held.add(word); else held.delete(word);
    }
    if (rises(FASTER) && pressed(FASTER)) changePace(1);
    if (rises(SLOWER) && pressed(SLOWER)) changePace(-1);
    if (pressed(DEAD_MAN)) hands.steer(deflection(pad.axes[2]), -deflection(pad.axes[1]));
    else if (steers) hands.steer(0, 0);
    steers = pressed(DEAD_MAN);
  }
  setInterval(look, STEP_MS);
}
