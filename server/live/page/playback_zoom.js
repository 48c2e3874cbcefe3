// The part of a run that the time line shows, in s. `changed()` is called when it is another one.
const LEAST_S = 0.2, FACTOR = 2;

export function createZoom(changed) {
  const zoom = { from: 0, to: 1, load, scale, pan, reveal, all: () => set(0, end), nearer: (t) => scale(t, 1 / FACTOR), wider: (t) => scale(t, FACTOR),
                 isWhole: () => zoom.from <= 0 && zoom.to >= end };
  let end = 1;

  function set(from, to) {
    const width = Math.min(end, Math.max(LEAST_S, to - from)), start = Math.max(0, Math.min(end - width, from));
    if (start === zoom.from && start + width === zoom.to) return;
    [zoom.from, zoom.to] = [start, start + width];
    changed();
  }
  function load(end_s) {
    end = end_s || 1;
    [zoom.from, zoom.to] = [0, end];
  }
  // Shows `factor` times as much; t stays where it is.
  function scale(t, factor) {
    const width = Math.min(end, Math.max(LEAST_S, (zoom.to - zoom.from) * factor)), at = (t - zoom.from) / (zoom.to - zoom.from);
    set(t - at * width, t + (1 - at) * width);
  }
  function pan(by_s) {
    set(zoom.from + by_s, zoom.to + by_s);
  }
  // Turns the page to a time that is not shown.
  function reveal(t) {
    const width = zoom.to - zoom.from;
    if (t > zoom.to) set(t - 0.1 * width, t + 0.9 * width);
    else if (t < zoom.from) set(t - 0.9 * width, t + 0.1 * width);
  }
  return zoom;
}
