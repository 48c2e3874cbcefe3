// Whether this page keeps up. While it is held up, by a picture that takes long or by another program, it says nothing, and the server lets
// its robot stand. Once may be a window that was moved; several times in a row is a page on which nobody can drive. Pure: the caller has
// the clock.
const WITHIN_MS = 5000, OFTEN = 2;   // chosen
export const PACE_MS = 50;           // as often as a word is said while driving

export function createPagePace() {
  let last_ms = null, pauses = [];
  return {
    // Called every PACE_MS. `limit_ms`: so long a pause counts.
    ticked(now_ms, limit_ms) {
      if (last_ms !== null && now_ms - last_ms >= limit_ms) pauses.push({ end_ms: now_ms, ms: now_ms - last_ms });
      pauses = pauses.filter(({ end_ms }) => end_ms > now_ms - WITHIN_MS);
      last_ms = now_ms;
    },
    // Nobody drives, or nobody sees the page, which the browser then calls once a second: what was does not count.
    rest() {
      last_ms = null;
      pauses = [];
    },
    // The longest of the last pauses, if there were several; 0 otherwise.
    heldUp_ms: () => pauses.length < OFTEN ? 0 : Math.max(...pauses.map(({ ms }) => ms)),
  };
}
