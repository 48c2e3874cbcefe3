// The plots that a person chose, one under the other with one time axis. A press on them looks back to that time.
import { keep, recall } from "./kept.js";
import { onDrag } from "./drag.js";
import { createPlot, paint, timeAt, xOf } from "./plot.js";
import { SIGNALS, USUAL } from "./signals.js";

const DRAW_MS = 100;
const by = (id) => document.getElementById(id);

// `chosen()`: the robot's id. `changed(keys)`: which signals have a plot.
export function createPlots(history, past, timeWindow, chosen, changed) {
  const list = by("plots"), axis = by("time-axis"), kept = recall("plots");
  let plots = [], hover = null, drawn_ms = -Infinity;   // hover: the canvas and the place in the window that the pointer is at
  const timeOf = ({ canvas, clientX }) => timeAt(clientX - canvas.getBoundingClientRect().x, timeWindow.range(), canvas.clientWidth);

  function store() {
    const keys = plots.map(({ key }) => key);
    keep("plots", keys);
    by("no-plots").hidden = keys.length > 0;
    changed(keys);
    draw();
  }
  function remove(key) {
    plots.find((plot) => plot.key === key)?.root.remove();
    plots = plots.filter((plot) => plot.key !== key);
    store();
  }
  function add(key) {
    const plot = createPlot(key, () => remove(key)), { canvas } = plot;
    const at = ({ clientX }) => timeOf({ canvas, clientX });
    onDrag(canvas, { looks: (event) => past.lookAt(at(event)), moved({ clientX }) { hover = { canvas, clientX }; draw(); } });
    canvas.addEventListener("pointerleave", () => { hover = null; draw(); });
    plots.push(plot);
    list.append(plot.root);
  }

  function drawAxis(range) {
    paint(axis, (pen, width, height, colour) => {
      const wanted = timeWindow.span_s() / Math.max(2, width / 80), power = 10 ** Math.floor(Math.log10(wanted));
      const step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => s >= wanted);
      pen.fillStyle = colour("--soft");
      pen.textBaseline = "middle";
      pen.textAlign = "center";
      for (let t = Math.ceil(range.from_s / step) * step; t <= range.to_s; t += step) {
        const text = `${Number(t.toFixed(3))} s`, half = pen.measureText(text).width / 2, x = xOf(t, range, width);
        if (t >= 0 && x + half <= width) pen.fillText(text, x, height / 2);
      }
    });
  }

  function draw() {
    drawn_ms = performance.now();
    const range = timeWindow.range(), moments = history.between(range.from_s - timeWindow.span_s() / 100, range.to_s);
    const hover_s = hover && timeOf(hover), cursor_s = hover_s ?? (past.isBack() ? past.shown_s() : null);
    for (const plot of plots) plot.draw(moments, chosen(), range, cursor_s, hover_s ?? past.shown_s());
    drawAxis(range);
  }

  function show(key) {
    if (!plots.some((plot) => plot.key === key)) add(key);
    plots.find((plot) => plot.key === key).root.scrollIntoView({ block: "nearest" });
    store();
  }

  for (const key of Array.isArray(kept) ? new Set(kept) : USUAL) if (Object.hasOwn(SIGNALS, key)) add(key);
  store();
  new ResizeObserver(draw).observe(list);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  return {
    draw,
    // A second time takes the plot away.
    toggle(key) {
      if (plots.some((plot) => plot.key === key)) remove(key); else show(key);
    },
    show,
    update() { if (!document.hidden && performance.now() >= drawn_ms + DRAW_MS) draw(); },
  };
}
