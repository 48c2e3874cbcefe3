// The part of the robot time that time line and plots show. It ends now; while one looks back it stays where it is, so that nothing slides
// away under the cursor.
import { keep, recall } from "./kept.js";

export const SPANS_S = [5, 10, 20, 30, 60, 120, 300];
const USUAL_S = 60;

export function createTimeWindow(history, past) {
  const kept_s = recall("span");
  let span_s = SPANS_S.includes(kept_s) ? kept_s : USUAL_S;
  let to_s = null;   // null: now

  // From when to when, in robot time; what is looked at is in it.
  function range() {
    const last_s = history.last_s(), at_s = past.shown_s();
    if (!past.isBack()) {
      to_s = null;
      return { from_s: last_s - span_s, to_s: last_s };
    }
    to_s = Math.min(last_s, Math.max(at_s, Math.min(to_s ?? last_s, at_s + span_s)));
    return { from_s: to_s - span_s, to_s };
  }

  // One of SPANS_S; what is looked at keeps its place in it.
  function show(next_s) {
    const { to_s: end_s } = range();
    if (past.isBack()) to_s = past.shown_s() + (end_s - past.shown_s()) * next_s / span_s;
    span_s = next_s;
    keep("span", span_s);
  }

  return {
    range,
    span_s: () => span_s,
    show,
    // Shows less (-1) or more (1) of the time.
    zoom(by) {
      const next_s = SPANS_S[SPANS_S.indexOf(span_s) + by];
      if (next_s !== undefined) show(next_s);
    },
  };
}
