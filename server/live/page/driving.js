// Manual driving: who holds the chosen robot, and the words to the server while you do.
import { command, isMoving } from "./hand.js";
import { keyIsTaken, watchHands } from "./dead_man.js";
import { dialogIsOpen, focusStick } from "./focus.js";
import { keep, keepHere, recall, recallHere } from "./kept.js";
import { createQuestion } from "./question.js";
import { describe } from "./drive_state.js";

const REPEAT_MS = 50;   // ten words in the time after which the server takes silence for letting go
const by = (id) => document.getElementById(id);

export function createDriving(world, link) {
  let coming = 0;       // placed by this page, not in the inventory yet
  let leaving = 0;      // let go of or removed, though the newest state is from before
  let placing = false;  // asked for, not answered yet
  let held = "";        // name of the robot that is yours, by the newest message
  let lost = "";        // name of the robot that was yours when the link was lost
  let wasMine = false;
  let kept = 0;         // the robot that a reload finds again
  // Of past.js: whether one looks back, and how to stop that. Of link_health.js: words for the person. Of the 3D view: whether keys point
  // there, and whether a place is pointed at before a robot is placed.
  const driving = { chosen: 0, update, placed, refused, closed, holding, place, choose, lookingBack: () => false, live() {}, say() {},
                    isPointing: () => false, beforePlacing: () => false };
  const hands = watchHands(() => holding() !== null && !dialogIsOpen() && !driving.lookingBack() && !driving.isPointing(), speak);
  driving.held = hands.held;
  driving.hands = hands;
  driving.letGoOfKeys = hands.letGo;
  driving.ask = createQuestion(hands.letGo);

  const chosen = () => world.robots.get(driving.chosen) ?? null;
  // The robot that is yours, or null.
  function holding() {
    const robot = chosen();
    return robot?.now && world.you && robot.now.holder === world.you && driving.chosen !== leaving ? robot : null;
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
      if (hands.areFull()) hands.letGo(); else show();
    } else if (!document.hidden && holding()) {
      link.send(message(holding()));
    }
  }, REPEAT_MS);

  function take() {
    if (!chosen() || placing) return;
    leaving = 0;
    driving.live();
    link.send({ type: "take", robot: driving.chosen });
  }
  function leave(word, robot) {
    hands.letGo();
    link.send({ type: word, robot });
    if (robot === driving.chosen) leaving = robot;
    show();
  }
  function letGo() {
    lost = "";
    if (holding()) leave("let-go", driving.chosen); else hands.letGo();
  }
  // `where`: { p, yaw }, or none: at a free start.
  function place(where = {}) {
    if (placing || !link.open) return;
    placing = true;
    driving.live();
    hands.letGo();
    link.send({ type: "place", ...where });
  }
  function remove() {
    const robot = driving.chosen, about = chosen()?.about;
    if (about) driving.ask(`Remove ${about.name} from the world? This cannot be undone.`, "Remove", () => leave("remove", robot));
  }
  // Not before: a place that is refused costs nobody his robot.
  function placed(robot) {
    placing = false;
    letGo();
    coming = robot;
    update();
  }
  function refused() { placing = false; }
  function closed() {
    placing = false;
    coming = leaving = 0;
    update();
  }

  function show() {
    const robot = chosen(), mine = holding();
    const holder = driving.chosen === leaving ? 0 : robot?.now?.holder ?? 0;
    if (!link.isHeard()) {
      lost ||= held;
    } else {
      held = mine?.about.name ?? "";
      if (mine) lost = "";
    }
    const moves = mine !== null && isMoving(message(mine));
    const { state, text } = describe({ robot, mine, holder, lost, world, isHeard: link.isHeard(), moves, lookingBack: driving.lookingBack(),
                                      pointing: driving.isPointing() });
    const line = by("drive-state");
    if (line.textContent !== text) line.textContent = text;
    line.dataset.state = state;
    // Nothing here moves: what cannot be used stays where it is.
    by("take").disabled = !robot || holder !== 0 || !world.you;
    by("take").title = state === "other" ? text : "";
    by("let-go").disabled = mine === null;
    by("place").disabled = !world.you;
    by("remove").disabled = !world.you || !(robot?.about.placed && (mine || !holder));
    by("hand").classList.toggle("away", mine === null);
    if (mine && !wasMine && !(document.activeElement instanceof HTMLSelectElement)) focusStick();
    wasMine = mine !== null;
    by("postures").classList.toggle("away", !mine?.about.flipper);
    by("pace-value").textContent = robot ? `${(pace() * robot.about.max_speed).toFixed(2)} m/s` : "";
  }

  // The one that this window watched before it was loaded anew. Another server gives other robots the same numbers.
  function keptRobot() {
    const before = recallHere("robot");
    return before?.server === world.server && world.robots.has(before.id) ? before.id : null;
  }

  // The list follows the robots; the choice stays while its robot does.
  function update() {
    if (leaving && world.robots.get(leaving)?.now?.holder !== world.you) leaving = 0;
    const select = by("robot");
    const wanted = [...world.robots.values()].map(({ about }) => `${about.id}`);
    if (wanted.join() !== [...select.options].map((option) => option.value).join()) {
      const robots = [...world.robots.values()].map(({ about }) => about), isAlone = ({ name }) => robots.filter((other) => other.name === name).length === 1;
      select.replaceChildren(...robots.map((about) => new Option(isAlone(about) ? about.name : `${about.name} (${about.view})`, about.id)));
    }
    if (world.robots.has(coming)) {
      driving.chosen = coming;
      coming = 0;
    }
    if (!chosen() && driving.chosen) {   // what is still down drives no other one
      if (held && link.isHeard()) driving.say(`${held} left the world`);
      hands.letGo();
    }
    if (!chosen()) driving.chosen = keptRobot() ?? world.robots.keys().next().value ?? 0;
    if (chosen() && kept !== driving.chosen) keepHere("robot", { server: world.server, id: kept = driving.chosen });
    select.disabled = world.robots.size === 0;
    if (select.value !== `${driving.chosen}`) select.value = `${driving.chosen}`;
    show();
  }

  function choose(robot) {
    if (robot === driving.chosen || !world.robots.has(robot)) return;
    letGo();
    coming = 0;
    driving.chosen = robot;
    update();
  }
  by("robot").addEventListener("change", (event) => choose(Number(event.target.value)));
  by("take").addEventListener("click", take);
  by("let-go").addEventListener("click", letGo);
  by("place").addEventListener("click", () => { if (!driving.beforePlacing()) place(); });
  by("remove").addEventListener("click", remove);
  if (recall("pace")) by("pace").value = recall("pace");
  by("pace").addEventListener("input", () => {
    keep("pace", Number(by("pace").value));
    show();
  });
  // In tenths of the fastest.
  driving.changePace = (steps) => {
    by("pace").value = Number(by("pace").value) + 10 * steps;
    by("pace").dispatchEvent(new Event("input"));
  };
  addEventListener("keydown", (event) => {
    if (event.repeat || keyIsTaken(event)) return;
    if (event.code === "KeyT") take();
    if (event.key === "Escape") letGo();
  });
  return driving;
}
