// One signal of the chosen robot over the shown time, with its values at the cursor.
import { fixed } from "./numbers.js";
import { penOf } from "./pen.js";
import { SIGNALS, axisOf, rowsOf } from "./signals.js";

const LEFT_PX = 34, RIGHT_PX = 4, EDGE_PX = 6;   // EDGE_PX: half of a number
export const COLOURS = ["--c1", "--c2", "--c3", "--c4"];

function element(name, className, text = "") {
  const made = document.createElement(name);
  made.className = className;
  made.textContent = text;
  return made;
}

// A canvas as sharp as the screen; `draw(pen, width, height, colour)` in CSS pixels.
export function paint(canvas, draw) {
  const ratio = devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
  if (!width || !height) return;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = penOf(canvas), style = getComputedStyle(document.documentElement);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "11px system-ui, sans-serif";
  pen.lineJoin = "round";
  draw(pen, width, height, (name) => style.getPropertyValue(name));
}

// The time axis of every plot.
export const xOf = (t, { from_s, to_s }, width) => LEFT_PX + (t - from_s) / (to_s - from_s) * (width - LEFT_PX - RIGHT_PX);
export const timeAt = (x, { from_s, to_s }, width) => from_s + (x - LEFT_PX) / (width - LEFT_PX - RIGHT_PX) * (to_s - from_s);

function nearest(rows, t) {
  let best = null;
  for (const row of rows) if (row && (!best || Math.abs(row[0] - t) <= Math.abs(best[0] - t))) best = row;
  return best;
}

// `removed()`: the person does not want it any more.
export function createPlot(key, removed) {
  const signal = SIGNALS[key], root = element("div", "plot"), about = element("p", "plot-about"), field = element("div", "plot-field"), canvas = element("canvas", "");
  root.dataset.signal = key;
  const name = element("strong", "", `${signal.name}, ${signal.unit}`);
  about.append(name);
  const values = signal.lines.map(([name], i) => {
    const line = element("span", `c${i + 1}`, `${signal.positive ?? name} `), value = element("output", "");
    value.ariaLive = "off";
    value.ariaLabel = `${signal.name}, ${name}`;
    line.append(value);
    about.append(line);
    return value;
  });
  canvas.role = "img";
  canvas.ariaLabel = `${signal.name} over time`;
  const remove = element("button", "plot-remove", "\u00d7");
  remove.type = "button";
  remove.title = remove.ariaLabel = `Remove the plot of ${signal.name}`;
  remove.addEventListener("click", removed);
  field.append(canvas);
  root.append(about, field, remove);
  let cache = new WeakMap(), cached = 0;   // the rows of the moments, of that robot

  function drawLine(pen, rows, column, x, y) {
    let last = null;   // the pixel and what was lowest and highest in it
    const flush = () => { if (last) { pen.lineTo(last.x, y(last.low)); pen.lineTo(last.x, y(last.high)); } };
    pen.beginPath();
    for (const row of rows) {
      const value = row?.[column];
      if (!Number.isFinite(value)) {
        flush();
        last = null;
        continue;
      }
      const at = Math.round(2 * x(row[0])) / 2;
      if (last && last.x === at) {
        [last.low, last.high] = [Math.min(last.low, value), Math.max(last.high, value)];
        continue;
      }
      if (last) flush(); else pen.moveTo(at, y(value));
      last = { x: at, low: value, high: value };
    }
    flush();
    pen.stroke();
  }

  return {
    key, root, canvas,
    // `moments`: those of `range`, and one before. `cursor_s`: null, or where a line is. `read_s`: of which moment the values are.
    draw(moments, id, range, cursor_s, read_s) {
      if (cached !== id) [cache, cached] = [new WeakMap(), id];
      const rows = rowsOf(signal, moments, id, cache), read = nearest(rows, read_s);
      values.forEach((value, i) => {
        const number = read?.[i + 1], words = Number.isFinite(number) ? fixed(number, signal.unit === "\u00b0" || signal.unit === "A" ? 1 : 2) : "\u2013";
        if (value.textContent !== words) value.textContent = words;
      });
      paint(canvas, (pen, width, height, colour) => {
        const { low, high, ticks } = axisOf(signal, rows), x = (t) => xOf(t, range, width);
        const y = (v) => height - EDGE_PX - (v - low) / (high - low) * (height - 2 * EDGE_PX);
        pen.textAlign = "right";
        pen.textBaseline = "middle";
        ticks.forEach((v, i) => {
          pen.strokeStyle = colour("--line");
          pen.beginPath();
          pen.moveTo(LEFT_PX, y(v));
          pen.lineTo(width - RIGHT_PX, y(v));
          pen.stroke();
          if (i && i < ticks.length - 1 && height / ticks.length < 14) return;
          pen.fillStyle = colour("--soft");
          pen.fillText(`${v}`.replace("-", "\u2212"), LEFT_PX - 4, y(v));
        });
        pen.save();
        pen.beginPath();
        pen.rect(LEFT_PX, 0, width - LEFT_PX - RIGHT_PX, height);
        pen.clip();
        signal.lines.forEach((_, i) => {
          pen.strokeStyle = colour(COLOURS[i]);
          pen.lineWidth = 1.5;
          drawLine(pen, rows, i + 1, x, y);
        });
        if (cursor_s !== null) {
          pen.strokeStyle = colour("--ink");
          pen.lineWidth = 1;
          pen.beginPath();
          pen.moveTo(x(cursor_s), 0);
          pen.lineTo(x(cursor_s), height);
          pen.stroke();
        }
        pen.restore();
      });
    },
  };
}
