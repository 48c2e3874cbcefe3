// The last minutes of the world, for looking back and for plots: what every body is and how it was, by robot time. Bounded in time and in
// bodies: with many robots the moments lie farther apart.
const KEPT_S = 300;
const MOST_BODIES = 36000;   // chosen: five minutes of four robots at 30 states a second, 65 MB in V8

export function createHistory({ kept_s = KEPT_S, mostBodies = MOST_BODIES } = {}) {
  let moments = [], bodies = 0, interrupted = false;

  const sizeOf = (moment) => moment.robots.size + moment.boxes.length;
  function drop(index) {
    bodies -= sizeOf(moments[index]);
    moments.splice(index, 1);
  }
  function clear() {
    moments = [];
    bodies = 0;
  }

  // Without what is shown live alone, and would take more than all else.
  const kept = ({ contacts, scans, imu, ...state }) => state;

  // Keeps what `world` is now. Time that begins anew, after a reset, begins a new history; then it returns true.
  function take(world) {
    const moment = { t: world.time_s, robots: new Map(), boxes: world.boxes.map(({ about, now }) => ({ about, now })), gap: interrupted };
    for (const [id, { about, now }] of world.robots) if (now) moment.robots.set(id, { about, now: kept(now) });
    const last = moments.length - 1, anew = last >= 0 && moment.t < moments[last].t;
    if (anew) clear();
    else if (last >= 0 && (moment.t === moments[last].t || isClose(last, sizeOf(moment)))) {
      moment.gap ||= moments[last].gap;
      drop(last);
    }
    interrupted = false;
    moments.push(moment);
    bodies += sizeOf(moment);
    while (moments.length > 1 && (moments[0].t < moment.t - kept_s || bodies > mostBodies)) drop(0);
    return anew;
  }

  // The newest moment is always kept. Once another follows, it stays if it is far enough from the one before it for all of `kept_s` to fit.
  function isClose(last, size) {
    return last > 0 && moments[last].t - moments[last - 1].t < kept_s * size / mostBodies;
  }

  // The first moment after `t`.
  function after(t) {
    let from = 0, to = moments.length;
    while (from < to) {
      const middle = (from + to) >> 1;
      if (moments[middle].t <= t) from = middle + 1; else to = middle;
    }
    return from;
  }

  return {
    take,
    // What comes next follows on a time that nobody saw: its moment has `gap`.
    interrupt() { interrupted = true; },
    first_s: () => moments[0]?.t ?? 0,
    last_s: () => moments[moments.length - 1]?.t ?? 0,
    // The moment {t, robots, boxes, gap} nearest to `t`; null: there is none.
    at(t) {
      const next = after(t);
      if (next === 0) return moments[0] ?? null;
      return next < moments.length && moments[next].t - t < t - moments[next - 1].t ? moments[next] : moments[next - 1];
    },
    // Those from `from_s` to `to_s`, both included.
    between: (from_s, to_s) => moments.slice(after(from_s - 1e-9), after(to_s + 1e-9)),
  };
}
