// Manual driving: who holds the chosen robot, and the words to the server while you do.
import { command, isMoving } from "./hand.js";
import { keyIsTaken, watchHands } from "./dead_man.js";

const REPEAT_MS = 50;   // ten words in the time after which the server takes silence for letting go
const by = (id) => document.getElementById(id);

export function createDriving(world, link) {
  let coming = 0;    // placed by this page, not in the inventory yet
  let leaving = 0;   // let go of or removed, though the newest state is from before
  const driving = { chosen: 0, update, placed, holding };
  const hands = watchHands(() => holding() !== null, speak);
  driving.held = hands.held;
  driving.letGoOfKeys = hands.letGo;

  const chosen = () => world.robots.get(driving.chosen) ?? null;
  // The robot that is yours, or null.
  function holding() {
    const robot = chosen();
    return robot?.now && robot.now.holder === world.you && driving.chosen !== leaving ? robot : null;
  }
  const pace = () => Number(by("pace").value) / 100;
  const message = (robot) => ({ ...command(hands.held, hands.stick, pace(), robot.about), robot: driving.chosen });

  // What is said on a dead link arrives when it is back, and is obeyed then: nothing but to stand.
  function speak() {
    const robot = holding();
    if (robot && (link.isHeard() || !isMoving(message(robot)))) link.send(message(robot));
    show();
  }
  setInterval(() => {
    if (!link.isHeard()) {
      if (hands.areFull()) hands.letGo();
    } else if (!document.hidden && holding()) {
      link.send(message(holding()));
    }
  }, REPEAT_MS);

  function take() {
    if (!chosen()) return;
    leaving = 0;
    link.send({ type: "take", robot: driving.chosen });
  }
  function leave(word) {
    hands.letGo();
    link.send({ type: word, robot: driving.chosen });
    leaving = driving.chosen;
    show();
  }
  function letGo() {
    if (holding()) leave("let-go"); else hands.letGo();
  }
  function placed(robot) {
    coming = robot;
    update();
  }

  function show() {
    const robot = chosen(), mine = holding();
    const holder = driving.chosen === leaving ? 0 : robot?.now?.holder ?? 0;
    let state = "none", text = "Not driving";
    if (!robot) text = world.robots.size ? text : "No robot is in the world: place one, or start a program";
    else if (mine && isMoving(message(mine))) [state, text] = ["driving", `Driving ${mine.about.name}`];
    else if (mine) [state, text] = ["held", `${mine.about.name} is at rest: hold a key or the stick to drive`];
    else if (holder) [state, text] = ["other", `Another operator drives ${robot.about.name}`];
    else if (robot.now) text = robot.about.placed ? `Not driving: ${robot.about.name} is at rest` : `Not driving: a program commands ${robot.about.name}`;
    const line = by("drive-state");
    if (line.textContent !== text) line.textContent = text;
    line.dataset.state = state;
    by("take").hidden = mine !== null;
    by("take").disabled = !robot || holder !== 0;
    by("let-go").hidden = mine === null;
    by("hand").hidden = mine === null;
    by("postures").hidden = !mine?.about.flipper;
    by("remove").hidden = !(robot?.about.placed && (mine || !holder));
    by("pace-value").textContent = robot ? `${(pace() * robot.about.max_speed).toFixed(2)} m/s` : "";
  }

  // The list follows the robots; the choice stays while its robot does.
  function update() {
    if (leaving && world.robots.get(leaving)?.now?.holder !== world.you) leaving = 0;
    const select = by("robot");
    const wanted = [...world.robots.values()].map(({ about }) => `${about.id}`);
    if (wanted.join() !== [...select.options].map((option) => option.value).join()) {
      select.replaceChildren(...[...world.robots.values()].map(({ about }) => new Option(about.name, about.id)));
    }
    if (world.robots.has(coming)) {
      driving.chosen = coming;
      coming = 0;
    }
    if (!chosen()) driving.chosen = world.robots.keys().next().value ?? 0;
    select.disabled = world.robots.size === 0;
    if (select.value !== `${driving.chosen}`) select.value = `${driving.chosen}`;
    show();
  }

  by("robot").addEventListener("change", (event) => {
    letGo();
    coming = 0;
    driving.chosen = Number(event.target.value);
    update();
  });
  by("take").addEventListener("click", take);
  by("let-go").addEventListener("click", letGo);
  by("place").addEventListener("click", () => { letGo(); link.send({ type: "place" }); });
  by("remove").addEventListener("click", () => leave("remove"));
  by("pace").addEventListener("input", show);
  addEventListener("keydown", (event) => {
    if (event.repeat || keyIsTaken(event)) return;
    if (event.code === "KeyT") take();
    if (event.key === "Escape") letGo();
  });
  return driving;
}
