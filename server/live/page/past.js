// Looking back: what the page shows of the world is that of an earlier moment, while the world goes on. Nobody drives by what was, so hands
// are let go of at its beginning, and nothing that is pressed meanwhile drives.
import { createAnnouncer } from "./announcer.js";
import { fixed } from "./numbers.js";

// How long ago, for people.
export function ago(seconds) {
  const whole = Math.round(seconds);
  return seconds < 59.95 ? `${fixed(seconds, 1)} s ago` : `${Math.floor(whole / 60)} min ${whole % 60} s ago`;
}

// `begin()`: before the first look back. `show()`: after what is seen has changed, but for the world's own changes. `mine()`: the robot that is yours, or null.
// `seen`: the world as it is shown, in all that changes with time: now, or as it was.
export function createPast(world, history, { begin, show, mine }) {
  const banner = document.getElementById("past-banner"), announce = createAnnouncer();
  let at_s = null;   // null: live
  // what is not set here is the world's
  const seen = Object.create(world);

  function sayWhen() {
    banner.hidden = at_s === null;
    document.body.toggleAttribute("data-past", at_s !== null);
    if (at_s === null) return announce("");
    const robot = mine();
    const words = `Looking back: ${ago(history.last_s() - at_s)}, at ${fixed(at_s, 2)} s. The world ${world.paused ? "is paused" : "goes on"}. ` +
      `Nothing drives${robot ? `; with Space ${robot.about.name} stands` : ""}. Esc or \u201cLive\u201d returns.`;
    if (banner.textContent !== words) banner.textContent = words;
    announce(words);
  }

  function setSeen() {
    const moment = at_s === null ? null : history.at(at_s);
    if (moment) {
      Object.assign(seen, { time_s: moment.t, robots: moment.robots, boxes: moment.boxes });
    } else {
      for (const key of ["time_s", "robots", "boxes"]) delete seen[key];
    }
    sayWhen();
  }

  function lookAt(t) {
    if (t >= history.last_s()) return live();
    if (at_s === null) begin();
    at_s = Math.max(t, history.first_s());
    setSeen();
    show();
  }
  function live() {
    if (at_s === null) return;
    at_s = null;
    setSeen();
    show();
  }

  return {
    seen, lookAt, live,
    isBack: () => at_s !== null,
    // What is shown, in robot time.
    shown_s: () => at_s ?? history.last_s(),
    // After each state of the world: what was looked at may be forgotten by now. `anew`: all of it, as the time began anew.
    update(anew) {
      if (anew) at_s = null;
      if (at_s !== null) at_s = Math.max(at_s, history.first_s());
      setSeen();
    },
  };
}
