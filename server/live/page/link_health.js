// Whether what is shown is still true: the link in figures, and an alarm that nobody overlooks while it is not. What is shorter than the
// alarms' limits is only told in figures.
import { isPausedHere, whoPaused } from "./drive_state.js";
import { createAnnouncer } from "./announcer.js";
import { createPagePace, PACE_MS } from "./page_pace.js";

// Chosen: a person who drives notices 0.2 s (docs/live-view.md); at twice that he drives by what was.
const SLOW_MS = 400;
const FAST_AGAIN_MS = 300;   // less than SLOW_MS: a link that is just as slow does not flicker
const OLD_PICTURE_MS = 1000;
const NOTICE_MS = 5000;
const LOOK_MS = 200;

const seconds = (ms) => (ms < 10000 ? (ms / 1000).toFixed(1) : (ms / 1000).toFixed(0));

// All that is wrong with what a person sees and does here, the worst first. Pure.
export function alarms({ refusal, isHeard, newestAge_ms, roundTrip_ms, isSlow, heldUp_ms, mine, world, oldestPicture_ms }) {
  if (refusal) return [refusal];
  if (!isHeard) {
    const since = Number.isFinite(newestAge_ms) ? `for ${seconds(newestAge_ms)} s` : "yet";
    return [`No word from the server ${since}: what is shown is old, and nothing you do reaches the robot`];
  }
  const found = [];
  if (isSlow) {
    found.push(`Slow link: ${seconds(roundTrip_ms)} s there and back. What you see is old${mine ? ", and the robot obeys late" : ""}`);
  }
  if (mine && heldUp_ms) {
    found.push(`Slow browser: this page stops for ${seconds(heldUp_ms)} s at a time, and ${mine.about.name} stands meanwhile`);
  }
  if (world.paused && mine && !isPausedHere(world)) found.push(`Paused by ${whoPaused(world)}: ${mine.about.name} does not move`);
  if (!isSlow && !world.paused && oldestPicture_ms >= OLD_PICTURE_MS) found.push(`The cameras' pictures are up to ${seconds(oldestPicture_ms)} s old`);
  return found;
}

// `mine()`: the robot that is yours, or null. `oldestPicture_ms()`: of those shown; 0 without.
export function createLinkHealth(world, link, mine, oldestPicture_ms) {
  const chip = document.getElementById("link"), notice = document.getElementById("notice"), alarm = document.getElementById("alarm");
  const pace = createPagePace(), announceAlarm = createAnnouncer();
  let refused_ms = -Infinity, isSlow = false;

  function inFigures(isHeard) {
    if (!link.open) return "not connected";
    if (!isHeard) return "no link";
    const others = world.viewers > 1 ? ` \u00b7 ${world.viewers} viewers` : "";
    const dropped = link.dropped ? ` \u00b7 ${link.dropped} dropped` : "";
    return `round trip ${(link.steadyRoundTrip_ms() || link.roundTrip_ms() || 0).toFixed(0)} ms${dropped}${others}`;
  }

  function update() {
    const isHeard = link.isHeard();
    const roundTrip_ms = link.steadyRoundTrip_ms();
    isSlow = roundTrip_ms >= (isSlow ? FAST_AGAIN_MS : SLOW_MS);
    const found = alarms({ refusal: link.refusal, isHeard, newestAge_ms: link.newestAge_ms(), roundTrip_ms, isSlow, heldUp_ms: pace.heldUp_ms(), mine: mine(), world,
                           oldestPicture_ms: oldestPicture_ms() });
    const text = inFigures(isHeard), words = link.received_ms === null && !link.open && !link.refusal ? "" : found.join("\n");
    if (chip.textContent !== text) chip.textContent = text;
    chip.dataset.state = isHeard ? "good" : "bad";
    chip.toggleAttribute("data-alarm", found.length > 0);
    chip.title = "From a word to the server's answer; states that were dropped because this browser or the link is slow; viewers";
    if (alarm.textContent !== words) alarm.textContent = words;
    announceAlarm(words);
    alarm.hidden = words === "";
    if (performance.now() > refused_ms + NOTICE_MS) notice.hidden = true;
  }
  setInterval(update, LOOK_MS);
  setInterval(() => {
    if (document.hidden || !mine()) pace.rest(); else pace.ticked(performance.now(), 1000 * world.operatorSilence_s);
  }, PACE_MS);
  document.addEventListener("visibilitychange", pace.rest);
  return {
    refused(reason) {
      refused_ms = performance.now();
      notice.textContent = reason;
      notice.hidden = false;
    },
  };
}
