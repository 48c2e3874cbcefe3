// How well the 3D view is drawn: more simply where a picture takes long, as driving goes on by the same thread, and better again once there
// is time. Pure: the caller has the clock.
const SLOW_MS = 40;
const NEW = 2;               // the first pictures of a level compile shaders
const SPARE = 4;             // a better picture has four times the pixels
const FIRST_WAIT_MS = 5000, LONGEST_WAIT_MS = 120000;   // chosen

// `levels`: 0 is the best. `took(ms, now_ms)`: after each picture; true: the level has changed.
export function createPictureQuality(levels) {
  const quality = { level: 0, mean_ms: 0, took };
  let changed_ms = -Infinity, wait_ms = FIRST_WAIT_MS, rose = false, unseen = NEW;

  function change(by, now_ms) {
    quality.level += by;
    quality.mean_ms = 0;
    changed_ms = now_ms;
    rose = by < 0;
    unseen = NEW;
    return true;
  }
  function took(ms, now_ms) {
    if (unseen > 0) {
      --unseen;
      return false;
    }
    quality.mean_ms += 0.3 * (ms - quality.mean_ms);
    if (quality.mean_ms >= SLOW_MS && quality.level + 1 < levels) {
      // what was just tried is too much: the next try is later
      wait_ms = rose && now_ms < changed_ms + wait_ms ? Math.min(2 * wait_ms, LONGEST_WAIT_MS) : wait_ms;
      return change(1, now_ms);
    }
    if (quality.level === 0 || now_ms < changed_ms + wait_ms || quality.mean_ms * SPARE >= SLOW_MS) return false;
    if (rose) wait_ms = FIRST_WAIT_MS;   // the last try went well
    return change(-1, now_ms);
  }
  return quality;
}
