// Puts the playback's parts together: a run is fetched once, and from then on everything follows the clock.
import { createClock } from "./playback_clock.js";
import { createCurves, titleOf } from "./playback_curves.js";
import { fetchList, fetchRun, indexAt, LABELS } from "./playback_data.js";
import { createLanes } from "./playback_lanes.js";
import { createReadings } from "./playback_readings.js";

const by = (id) => document.getElementById(id);
const AT_FIRST = ["x_m", "pitch_rad", "track_left_mps"], MOST_AT_FIRST = 3;

const hidden = new Set();                  // kinds of bodies, "paths"
const shown = (kind) => !hidden.has(kind);
let list = null, run = null, number = -1, view = null, channels = [];

const clock = createClock(update);
const lanes = createLanes(clock, drawCurves);
const curves = createCurves(lanes.xOf);
const readings = createReadings();

function complain(text) {
  by("notice").textContent = text;
  by("notice").hidden = !text;
}

function update() {
  lanes.moveCursor();
  readings.update(clock.t, lanes.phaseAt(clock.t));
  view?.update(clock.t);
  by("clock").textContent = `${clock.t.toFixed(2)} of ${clock.end.toFixed(2)} s`;
  by("play").textContent = clock.playing ? "Pause" : "Play";
}

function drawCurves() {
  if (run) curves.draw(run, channels, shown);
}

function step(by_samples) {
  if (!run) return;
  const i = indexAt(run.t_s, clock.t);
  // between two samples the one before is a step back
  const from = by_samples < 0 && clock.t > run.t_s[i] + 1e-9 ? i + 1 : i;
  clock.play(false);
  clock.set(run.t_s[Math.max(0, Math.min(run.t_s.length - 1, from + by_samples))]);
}

function checkBox(text, checked, changed) {
  const label = document.createElement("label"), box = document.createElement("input");
  box.type = "checkbox";
  box.checked = checked;
  box.addEventListener("change", () => changed(box.checked));
  label.append(box, text);
  return label;
}

function makeLegend() {
  const entry = (kind, text) => {
    const label = checkBox(text, shown(kind), (on) => {
      if (on) hidden.delete(kind); else hidden.add(kind);
      drawCurves();
      update();
    });
    label.dataset.kind = kind;
    if (kind !== "paths") {
      const swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.dataset.kind = kind;
      label.insertBefore(swatch, label.lastChild);
    }
    return label;
  };
  const bodies = run.bodies.map((body) => entry(body.kind, LABELS[body.kind](list.source)));
  by("legend").replaceChildren(by("legend").firstElementChild, ...bodies, entry("paths", "Paths on the floor"));
}

function chooseChannels() {
  const there = (column) => run.channels.some((channel) => channel.column === column);
  const kept = channels.map((channel) => channel.column).filter(there);
  const most = [...run.channels].filter((channel) => channel.share > 0).sort((a, b) => b.share - a.share).slice(0, 1).map((channel) => channel.column);
  const wanted = kept.length ? kept : [...new Set([...most, ...AT_FIRST])].filter(there).slice(0, MOST_AT_FIRST);
  channels = run.channels.filter((channel) => wanted.includes(channel.column));
  by("channel-list").replaceChildren(...run.channels.map((channel) => checkBox(titleOf(channel.column), channels.includes(channel), (on) => {
    channels = run.channels.filter((other) => (other === channel ? on : channels.includes(other)));
    drawCurves();
  })));
}

async function load(next) {
  number = next;
  const about = list.runs[next];
  clock.play(false);
  by("run").value = `${next}`;
  by("world").textContent = about.world;
  complain(`${about.file} is being simulated`);
  const loaded = await fetchRun(next, () => number === next).catch((error) => { complain(error.message); return null; });
  if (!loaded || number !== next) return;
  complain("");
  run = loaded;
  makeLegend();
  chooseChannels();
  readings.load(run);
  by("notes").replaceChildren(...[...list.notes, ...run.notes].map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  }));
  lanes.load(run, Boolean(list.report));
  view?.load(run, `/playback/${next}/scene`);
  clock.load(run.t_s[run.t_s.length - 1]);
}

// Space belongs to a button that has the focus, arrows to a list.
function keyIsTaken(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target instanceof HTMLSelectElement) return true;
  return event.code === "Space" && event.target.closest("button, summary, input") !== null;
}

const KEYS = {
  Space: () => clock.play(!clock.playing),
  ArrowLeft: () => step(-1), ArrowRight: () => step(1),
  Home: () => { clock.play(false); clock.set(0); }, End: () => clock.set(clock.end),
};
addEventListener("keydown", (event) => {
  if (!run || !KEYS[event.code] || !(event.target instanceof Element) || keyIsTaken(event)) return;
  event.preventDefault();
  KEYS[event.code]();
});
for (const [id, act] of [["play", KEYS.Space], ["step-back", KEYS.ArrowLeft], ["step-on", KEYS.ArrowRight], ["to-start", KEYS.Home], ["to-end", KEYS.End]]) {
  by(id).addEventListener("click", () => { if (run) act(); });
}
by("pace").addEventListener("change", (event) => { clock.pace = Number(event.target.value); });
by("run").addEventListener("change", (event) => load(Number(event.target.value)));

function tellVerdict() {
  if (!list.report) return;
  const { verdict, named } = list.report;
  by("verdict").textContent = named.length ? `${verdict}: ${named.join(", ")}` : `verdict: ${verdict}`;
  by("verdict").hidden = false;
}

fetchList().then(async (answer) => {
  list = answer;
  document.title = `Kenaf: ${list.name}`;
  tellVerdict();
  by("run").replaceChildren(...list.runs.map((about, i) => new Option(`${about.manoeuvre} \u00b7 ${about.file} \u00b7 ${about.duration_s.toFixed(1)} s`, i)));
  // curves and figures work without it, where a browser has no WebGL
  const loading = load(list.first);
  await import("./playback_view.js").then(({ createPlaybackView }) => {
    view = createPlaybackView(list, shown, complain);
    if (run) view.load(run, `/playback/${number}/scene`).then(update);
  }).catch((error) => complain(`No 3D view: ${error.message}`));
  await loading;
}).catch((error) => complain(error.message));
