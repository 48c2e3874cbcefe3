// The time that is shown: it runs by the browser's own clock, or is set.
export function createClock(changed) {
  const clock = { t: 0, end: 0, playing: false, pace: 1, set, play, load };
  let last_ms = null;

  function set(t) {
    clock.t = Math.max(0, Math.min(clock.end, t));
    if (clock.t >= clock.end) clock.playing = false;
    changed();
  }
  function play(on) {
    if (on && clock.t >= clock.end) clock.t = 0;
    clock.playing = on && clock.end > 0;
    last_ms = null;
    changed();
    if (clock.playing) requestAnimationFrame(tick);
  }
  function tick(now_ms) {
    if (!clock.playing) return;
    // a page that was hidden goes on where it was
    const passed_s = last_ms === null ? 0 : Math.min(0.25, (now_ms - last_ms) / 1000);
    last_ms = now_ms;
    set(clock.t + passed_s * clock.pace);
    if (clock.playing) requestAnimationFrame(tick);
  }
  function load(end, at = 0) {
    clock.end = end;
    clock.playing = false;
    set(at);
    clock.playing = false;
  }
  return clock;
}
