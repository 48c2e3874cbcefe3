// Curves of chosen columns over time: real against simulated, and below it measured minus simulated, over the
// band of the noise. The cursor is not drawn here: it moves alone, and the figures at it are text.
import { fixed } from "./numbers.js";
import { penOf } from "./pen.js";
import { indexAt } from "./playback_data.js";

const VALUES_PX = 56, DIFFERENCES_PX = 44, BETWEEN_PX = 8, LEFT_PX = 58, RIGHT_PX = 12, NEAR_PX = 10, DEG = 180 / Math.PI;
const DASHES = { recorded: [], nominal: [6, 4], corrected: [] };
const WIDTHS = { recorded: 2.6, nominal: 1.5, corrected: 1.5 };
const ORDER = ["recorded", "nominal", "corrected"];
const FLOORS = { report: "report", "stated noise": "stated noise", resolution: "the least that counts" };

export const shownUnit = (unit) => unit.replace("rad", "\u00b0");
export const shownValue = (value, unit) => (unit.startsWith("rad") ? value * DEG : value);

export function titleOf(column) {
  const name = column.replace(/_(m|mps|rad|radps|a|v)$/, "");
  const words = name.replace(/_/g, " ").replace(/\b(fl|fr|rl|rr)\b/, (place) => ({ fl: "front left", fr: "front right", rl: "rear left", rr: "rear right" })[place]);
  if (column.startsWith("track") && column.endsWith("_mps")) return `${words} speed`;
  if (column.startsWith("track") && column.endsWith("_m")) return `${words} travel`;
  if (column.endsWith("_a")) return `${words} current`;
  return words;
}

// So many digits that a tenth of the noise shows.
const digitsOf = (floor) => Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(floor))));
const signed = (text) => (/[1-9]/.test(text) && !text.startsWith("\u2212") ? `+${text}` : text);

// A difference of a channel in the unit that is shown: "+0.0123 m".
export function differenceInWords(difference, channel) {
  return `${signed(fixed(shownValue(difference, channel.unit), digitsOf(shownValue(channel.floor, channel.unit))))} ${shownUnit(channel.unit)}`;
}
export const timesNoise = (value) => `${value.toFixed(value < 9.95 ? 1 : 0)} \u00d7 noise`;
// A value of a channel in the unit that is shown, without it.
export const valueInWords = (value, channel) => fixed(shownValue(value, channel.unit), digitsOf(shownValue(channel.floor, channel.unit)));

// Least and most of 1, 2, 5 times a power of ten around what there is.
function rangeOf(lines, [first, last], least = Infinity, most = -Infinity) {
  for (const { values } of lines) for (let i = first; i <= last; ++i) {
    const v = values[i];
    if (v !== null && v !== undefined) { least = Math.min(least, v); most = Math.max(most, v); }
  }
  if (least > most) return null;
  const span = Math.max(most - least, 1e-4), power = 10 ** Math.floor(Math.log10(span / 2));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => span / s <= 4);
  const from = Math.floor(least / step + 1e-6), to = Math.ceil(most / step - 1e-6);
  return { least: (to > from ? from : from - 1) * step, most: (to > from ? to : to + 1) * step, step };
}

const plain = (value, step) => fixed(value, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));

// Measured minus simulated at every time.
function differencesOf(run, channel, body) {
  const recorded = run.bodies[0].channels[channel.column], simulated = body.channels[channel.column];
  if (!recorded || !simulated) return null;
  return simulated.map((value, i) => {
    if (value === null || recorded[i] === null) return null;
    const way = recorded[i] - value;
    return shownValue(channel.wraps ? Math.atan2(Math.sin(way), Math.cos(way)) : way, channel.unit);
  });
}

function span(className, text, kind = "") {
  const made = document.createElement("span");
  made.className = className;
  made.textContent = text;
  if (kind) made.dataset.kind = kind;
  return made;
}

export function createCurves(xOf, zoom) {
  const parent = document.getElementById("curves");
  let run = null, strips = [];   // of each channel: what is drawn, its canvas and its readings

  function load(next) {
    run = next;
    strips = [];
    parent.replaceChildren();
  }

  // The figure of a channel: a caption with what is read at the cursor, and the canvas.
  function makeStrip(channel) {
    const figure = document.createElement("figure"), caption = document.createElement("figcaption"), canvas = document.createElement("canvas");
    figure.className = "curve";
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${titleOf(channel.column)}: measured and simulated, and their difference with its noise`);
    const floor = shownValue(channel.floor, channel.unit), about = [`noise \u00b1${fixed(floor, digitsOf(floor))} (${FLOORS[channel.floor_from]})`];
    if (channel.share > 0.005) about.push(`${Math.round(channel.share * 100)} % of the gap in all runs`);
    const readings = span("readings", "");
    caption.append(span("title", `${titleOf(channel.column)}, ${shownUnit(channel.unit)}`), span("soft", about.join(", ")), readings);
    figure.append(caption, canvas);
    parent.append(figure);
    return { channel, canvas, readings };
  }

  function fill(strip, shown) {
    const { channel } = strip, command = run.bodies[0].channels[`cmd_${channel.column}`];
    const bodies = ORDER.map((kind) => run.bodies.find((body) => body.kind === kind)).filter((body) => body?.channels[channel.column] && shown(body.kind));
    strip.lines = bodies.map((body) => ({ kind: body.kind, values: body.channels[channel.column].map((v) => (v === null ? null : shownValue(v, channel.unit))) }));
    if (command) strip.lines.unshift({ kind: "command", values: command.map((v) => (v === null ? null : shownValue(v, channel.unit))) });
    strip.differences = bodies.filter((body) => body.kind !== "recorded").flatMap((body) => {
      const values = differencesOf(run, channel, body), gap = run.gaps.find((each) => each.kind === body.kind);
      const means = gap?.differences[channel.column]?.map((v) => (v === null ? null : shownValue(v, channel.unit)));
      return values && means ? [{ kind: body.kind, values, means, times: gap.difference_floors[channel.column], span_s: gap.span_s }] : [];
    });
    strip.floor = shownValue(channel.floor, channel.unit);
  }

  function draw(next, channels, shown) {
    if (next !== run || channels.length !== strips.length || channels.some((channel, i) => channel !== strips[i].channel)) {
      load(next);
      strips = channels.map(makeStrip);
    }
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name).trim();
    for (const strip of strips) {
      fill(strip, shown);
      drawStrip(strip, colour);
    }
  }

  function drawStrip({ channel, canvas, lines, differences, floor }, colour) {
    const ratio = devicePixelRatio, width = canvas.clientWidth, height = VALUES_PX + (differences.length ? BETWEEN_PX + DIFFERENCES_PX : 0);
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = penOf(canvas), left = xOf(zoom.from), right = xOf(zoom.to);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    pen.lineJoin = "round";
    pen.textBaseline = "middle";
    const seen = [Math.max(0, indexAt(run.t_s, zoom.from) - 1), Math.min(run.t_s.length - 1, indexAt(run.t_s, zoom.to) + 1)];

    // A grid with numbers at its ends; then what `trace` draws, which may not leave it.
    function frame(range, top, bottom, trace) {
      const y = (v) => bottom - (v - range.least) / (range.most - range.least) * (bottom - top);
      pen.strokeStyle = colour("--line");
      pen.lineWidth = 1;
      for (let v = range.least; v <= range.most + range.step / 2; v += range.step) {
        pen.beginPath();
        pen.moveTo(left, y(v));
        pen.lineTo(right, y(v));
        pen.stroke();
      }
      pen.fillStyle = colour("--soft");
      pen.textAlign = "right";
      for (const v of [range.least, range.most]) pen.fillText(plain(v, range.step), left - 6, y(v));
      pen.save();
      pen.beginPath();
      pen.rect(left, top - 3, right - left, bottom - top + 6);
      pen.clip();
      trace(y);
      pen.restore();
    }
    function line(count, time, value, y) {
      pen.beginPath();
      let down = false;
      for (let i = 0; i < count; ++i) {
        const v = value(i);
        if (v === null || v === undefined) { down = false; continue; }
        if (down) pen.lineTo(xOf(time(i)), y(v)); else pen.moveTo(xOf(time(i)), y(v));
        down = true;
      }
      pen.stroke();
    }
    const seenLine = (values, y) => line(seen[1] - seen[0] + 1, (i) => run.t_s[seen[0] + i], (i) => values[seen[0] + i], y);

    const range = rangeOf(lines, seen);
    if (range) frame(range, 6, VALUES_PX - 6, (y) => {
      for (const { kind, values } of lines) {
        pen.strokeStyle = kind === "command" ? colour("--soft") : colour(`--${kind}`);
        pen.lineWidth = WIDTHS[kind] ?? 1;
        pen.setLineDash(DASHES[kind] ?? [2, 3]);
        seenLine(values, y);
      }
      pen.setLineDash([]);
    });

    // the noise as a band, single samples pale, and the means that are counted in times the noise
    const differenceRange = differences.length ? rangeOf(differences, seen, -1.2 * floor, 1.2 * floor) : null;
    if (differenceRange) frame(differenceRange, VALUES_PX + BETWEEN_PX, height - 6, (y) => {
      pen.fillStyle = colour("--floor");
      const high = Math.max(2, y(-floor) - y(floor));
      pen.fillRect(left, y(0) - high / 2, right - left, high);
      for (const { kind, values, means, span_s } of differences) {
        pen.strokeStyle = colour(`--${kind}`);
        pen.lineWidth = 1;
        pen.globalAlpha = 0.4;
        seenLine(values, y);
        pen.globalAlpha = 1;
        pen.lineWidth = WIDTHS[kind];
        pen.setLineDash(DASHES[kind]);
        line(means.length, (i) => Math.min((i + 0.5) * span_s, run.t_s[run.t_s.length - 1]), (i) => means[i], y);
        pen.setLineDash([]);
      }
      pen.fillStyle = colour("--ink");
      pen.textAlign = "left";
      pen.lineWidth = 3;
      pen.strokeStyle = colour("--panel");
      for (const put of ["strokeText", "fillText"]) pen[put]("measured minus simulated", left + 8, VALUES_PX + BETWEEN_PX + 6);
    });
  }

  // Beside the cursor, as far as the title leaves room.
  function putNear(x, readings) {
    const caption = readings.parentElement, before = readings.previousElementSibling;
    const wraps = readings.offsetTop >= before.offsetTop + before.offsetHeight;
    const least = wraps ? LEFT_PX : before.offsetLeft + before.offsetWidth + NEAR_PX, most = caption.clientWidth - RIGHT_PX - readings.offsetWidth;
    const beside = x + NEAR_PX > most ? x - NEAR_PX - readings.offsetWidth : x + NEAR_PX;
    readings.style.transform = `translateX(${Math.round(Math.max(least, Math.min(most, beside)) - readings.offsetLeft)}px)`;
  }

  // What the curves are worth at t.
  function read(t) {
    if (!run) return;
    const i = indexAt(run.t_s, t);
    for (const { readings, lines, differences, floor } of strips) {
      readings.replaceChildren(...(lines ?? []).map(({ kind, values }) => {
        const value = values[i] ?? null, off = differences.find((each) => each.kind === kind), digits = digitsOf(floor);
        let text = value === null ? "\u2013" : fixed(value, digits);
        const s = off ? Math.floor(t / off.span_s + 1e-6) : 0, mean = off?.means[s] ?? null;
        if (mean !== null) text += ` (mean ${signed(fixed(mean, digits))}, ${timesNoise(Math.abs(off.times[s] ?? mean / floor))})`;
        const reading = span("reading", kind === "command" ? `commanded ${text}` : text, kind);
        reading.title = off ? `${kind}: value (measured minus simulated, mean over ${off.span_s} s, and how many times the noise that is)` : kind;
        reading.prepend(span("swatch", "", kind));
        return reading;
      }));
      putNear(xOf(t), readings);
    }
  }

  return { draw, read, parts: () => strips.map(({ canvas, channel, readings }) => ({ canvas, title: `${titleOf(channel.column)}, ${shownUnit(channel.unit)}`, readings: [...readings.children].map((reading) => reading.dataset.kind === "command" ? reading.textContent : `${reading.dataset.kind} ${reading.textContent}`).join("; ") })) };
}
