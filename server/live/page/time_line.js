// The time line under the world: look back, replay, return, and how much of the time is shown.
import { keyIsTaken } from "./dead_man.js";
import { ago } from "./past.js";
import { SPANS_S } from "./time_window.js";

const STEP_S = 1, LONG_STEP_S = 10;
const REPLAY_S = 10, FRAME_MS = 40;
const LONGEST_FRAME_MS = 200;   // a page that was held up goes on from where it was, and skips nothing
const STEPS = 1000;   // of the slider
const NOTCH = 50, LINE_PX = 33;   // a mouse's wheel turns by 100 or three lines and more, a trackpad's by little, many times
const by = (id) => document.getElementById(id);

export function createTimeLine(history, past, timeWindow, changed) {
  const slider = by("when");
  let replay = null;   // until when, in robot time, and when its last frame was, by the clock

  const lookAt = (t) => { replay = null; past.lookAt(t); };
  const move = (step_s) => lookAt(past.shown_s() + step_s);
  function live() {
    replay = null;
    past.live();
  }
  // From where one looks back to, or the last ten seconds, as fast as they were in robot time; then live again.
  function toggleReplay() {
    if (replay) {
      replay = null;
    } else {
      replay = { to_s: history.last_s(), last_ms: performance.now() };
      if (!past.isBack()) past.lookAt(history.last_s() - REPLAY_S);
    }
    update();
  }
  setInterval(() => {
    if (replay && !past.isBack()) replay = null;   // Esc, a robot that was taken over, a reset
    if (!replay) return;
    const now_ms = performance.now(), next_s = past.shown_s() + Math.min(now_ms - replay.last_ms, LONGEST_FRAME_MS) / 1000;
    replay.last_ms = now_ms;
    if (next_s >= replay.to_s) live(); else past.lookAt(next_s);
  }, FRAME_MS);
  function shown() {
    update();
    changed();
  }
  function zoom(step) {
    timeWindow.zoom(step);
    shown();
  }

  // The slider's last place is now, whatever now is when it is let go of.
  slider.addEventListener("input", () => {
    const { from_s, to_s } = timeWindow.range();
    if (slider.value === slider.max && to_s >= history.last_s()) live();
    else lookAt(Math.min(from_s + (to_s - from_s) * slider.value / STEPS, history.last_s() - 1e-9));
  });
  let turned = 0;   // of the wheel, since the last zoom
  slider.addEventListener("wheel", (event) => {
    if (!event.deltaY) return;
    event.preventDefault();
    turned += event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE_PX : 1);
    if (Math.abs(turned) < NOTCH) return;
    zoom(Math.sign(turned));
    turned = 0;
  });
  by("live").addEventListener("click", live);
  by("replay").addEventListener("click", toggleReplay);
  by("span").append(...SPANS_S.map((span_s) => new Option(`${span_s} s`, span_s)));
  by("span").addEventListener("change", () => { timeWindow.show(Number(by("span").value)); shown(); });

  addEventListener("keydown", (event) => {
    if (keyIsTaken(event)) return;
    const step_s = event.shiftKey ? LONG_STEP_S : STEP_S, onInput = event.target instanceof HTMLInputElement;
    if (event.code === "Comma") move(-step_s);
    if (event.code === "Period") move(step_s);
    if (event.key === "Home" && !onInput) lookAt(history.first_s());
    if (event.key === "End" && !onInput) live();
    if (event.key === "Backspace" && !event.repeat) toggleReplay();
    if (event.key === "+") zoom(-1);
    if (event.key === "-") zoom(1);
    if (["Home", "End"].includes(event.key) && !onInput) event.preventDefault();   // keeps the page where it is
  });

  function update() {
    const { from_s, to_s } = timeWindow.range(), at_s = past.shown_s(), back_s = history.last_s() - at_s;
    slider.value = `${Math.round((at_s - from_s) / (to_s - from_s) * STEPS)}`;
    const words = past.isBack() ? ago(back_s) : "live";
    if (by("when-value").textContent !== words) by("when-value").textContent = words;
    slider.ariaValueText = words;
    by("live").disabled = !past.isBack();
    by("replay").ariaPressed = `${replay !== null}`;
    by("span").value = `${timeWindow.span_s()}`;
  }
  return { update };
}
