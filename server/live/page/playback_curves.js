// Curves of chosen columns over the whole run, real against simulated. The cursor is not drawn here: it moves alone.
import { fixed } from "./numbers.js";

const STRIP_PX = 74, DEG = 180 / Math.PI;
const DASHES = { recorded: [], nominal: [6, 4], corrected: [] };
const WIDTHS = { recorded: 2.6, nominal: 1.5, corrected: 1.5 };
const ORDER = ["recorded", "nominal", "corrected"];

export const shownUnit = (unit) => (unit === "rad" ? "\u00b0" : unit);
export const shownValue = (value, unit) => (unit === "rad" ? value * DEG : value);

export function titleOf(column) {
  const name = column.replace(/_(m|mps|rad|radps|a|v)$/, "");
  const words = name.replace(/_/g, " ").replace(/\b(fl|fr|rl|rr)\b/, (place) => ({ fl: "front left", fr: "front right", rl: "rear left", rr: "rear right" })[place]);
  if (column.startsWith("track") && column.endsWith("_mps")) return `${words} speed`;
  if (column.startsWith("track") && column.endsWith("_m")) return `${words} travel`;
  if (column.endsWith("_a")) return `${words} current`;
  return words;
}

// Least and most of 1, 2, 5 times a power of ten around what there is.
function rangeOf(lines) {
  let least = Infinity, most = -Infinity;
  for (const { values } of lines) for (const v of values) if (v !== null) { least = Math.min(least, v); most = Math.max(most, v); }
  if (least > most) return null;
  const span = Math.max(most - least, 0.01), power = 10 ** Math.floor(Math.log10(span / 2));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => span / s <= 4);
  const from = Math.floor(least / step + 1e-6), to = Math.ceil(most / step - 1e-6);
  return { least: (to > from ? from : from - 1) * step, most: (to > from ? to : to + 1) * step, step };
}

const plain = (value, step) => fixed(value, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));

export function createCurves(xOf) {
  const canvas = document.getElementById("curves"), pen = canvas.getContext("2d");

  function linesOf(run, channel, shown) {
    const command = run.bodies[0].channels[`cmd_${channel.column}`];
    const lines = ORDER.flatMap((kind) => {
      const values = run.bodies.find((body) => body.kind === kind)?.channels[channel.column];
      return values && shown(kind) ? [{ kind, values: values.map((v) => (v === null ? null : shownValue(v, channel.unit))) }] : [];
    });
    return command ? [{ kind: "command", values: command }, ...lines] : lines;
  }

  function draw(run, channels, shown) {
    const ratio = devicePixelRatio, width = canvas.clientWidth, height = Math.max(1, channels.length) * STRIP_PX;
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name).trim();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    pen.lineJoin = "round";
    channels.forEach((channel, n) => {
      const top = n * STRIP_PX + 18, bottom = (n + 1) * STRIP_PX - 6;
      const lines = linesOf(run, channel, shown), range = rangeOf(lines);
      pen.fillStyle = colour("--ink");
      pen.textAlign = "left";
      pen.textBaseline = "middle";
      const title = `${titleOf(channel.column)}, ${shownUnit(channel.unit)}`;
      pen.fillText(title, xOf(0) + 8, top - 9);
      if (channel.share > 0.005) {
        const after = xOf(0) + 8 + pen.measureText(title).width + 10;
        pen.fillStyle = colour("--soft");
        pen.fillText(`${Math.round(channel.share * 100)} % of the gap in all runs`, after, top - 9);
      }
      if (!range) return;
      const y = (v) => bottom - (v - range.least) / (range.most - range.least) * (bottom - top);
      pen.strokeStyle = colour("--line");
      pen.lineWidth = 1;
      pen.textAlign = "right";
      for (let v = range.least; v <= range.most + range.step / 2; v += range.step) {
        pen.beginPath();
        pen.moveTo(xOf(0), y(v));
        pen.lineTo(xOf(run.t_s[run.t_s.length - 1]), y(v));
        pen.stroke();
      }
      pen.fillStyle = colour("--soft");
      for (const v of [range.least, range.most]) pen.fillText(plain(v, range.step), xOf(0) - 6, y(v));
      for (const { kind, values } of lines) {
        pen.strokeStyle = kind === "command" ? colour("--soft") : colour(`--${kind}`);
        pen.lineWidth = WIDTHS[kind] ?? 1;
        pen.setLineDash(DASHES[kind] ?? [2, 3]);
        pen.beginPath();
        let down = false;
        values.forEach((v, i) => {
          if (v === null) { down = false; return; }
          if (down) pen.lineTo(xOf(run.t_s[i]), y(v)); else pen.moveTo(xOf(run.t_s[i]), y(v));
          down = true;
        });
        pen.stroke();
      }
      pen.setLineDash([]);
    });
  }
  return { draw };
}
