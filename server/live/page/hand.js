// From the keys held down to the command of a robot. Pure.
const POSTURES = {   // degrees; tip up positive; front, rear
  flat: [0, 0],
  raised: [57, 57],
  climb: [45, -20],
  stand: [-60, -60],
};
const ARM_SPEED = 1;   // rad/s
const SLOWLY = 0.3;    // of the pace; chosen

// Two keys against each other are none.
function sign(held, plus, minus) {
  return (held.has(plus) ? 1 : 0) - (held.has(minus) ? 1 : 0);
}

// Forward and turn from -1 to 1: from the keys, or from the stick {x right, y up}.
function wish(held, stick) {
  const forward = sign(held, "forward", "back") + stick.y;
  const turn = sign(held, "left", "right") - stick.x;
  return { forward: Math.max(-1, Math.min(1, forward)), turn: Math.max(-1, Math.min(1, turn)) };
}

// A drive message without the robot. `pace` from 0 to 1 of its fastest.
export function command(held, stick, pace, about) {
  const { forward, turn } = wish(held, stick);
  const left = forward - 0.7 * turn, right = forward + 0.7 * turn;
  const speed = pace * (held.has("slowly") ? SLOWLY : 1) * about.max_speed / Math.max(1, Math.abs(left), Math.abs(right));
  const message = { type: "drive", left: left * speed, right: right * speed };
  if (!about.flipper) return message;

  const posture = Object.keys(POSTURES).find((name) => held.has(name));
  const front = sign(held, "front-up", "front-down"), rear = sign(held, "rear-up", "rear-down");
  if (posture) {
    const [f, r] = POSTURES[posture].map((degrees) => degrees * Math.PI / 180);
    message.flipper_angle = [f, f, r, r];
  } else if (front || rear) {
    const arm = (direction) => (direction ? direction * ARM_SPEED : null);
    message.flipper_speed = [arm(front), arm(front), arm(rear), arm(rear)];
  }
  return message;
}

export function isMoving(message) {
  return message.left !== 0 || message.right !== 0 || "flipper_angle" in message || "flipper_speed" in message;
}
