// Puts the playback's parts together: a run is fetched once, and from then on everything follows the clock.
import { createClock } from "./playback_clock.js";
import { createCurves, differenceInWords, floorsOf, titleOf } from "./playback_curves.js";
import { fetchList, fetchRun, indexAt, LABELS } from "./playback_data.js";
import { createLanes } from "./playback_lanes.js";
import { makePicture, savePicture } from "./playback_picture.js";
import { createReadings } from "./playback_readings.js";
import { createZoom } from "./playback_zoom.js";

const by = (id) => document.getElementById(id);
const WITHOUT_GAP = ["x_m", "pitch_rad", "track_left_mps"], MOST_AT_FIRST = 3;

const hidden = new Set();                  // kinds of bodies, "paths"
const shown = (kind) => !hidden.has(kind);
let list = null, run = null, number = -1, view = null, pointed_s = null;
let channels = [], chosenByHand = null;   // columns, once somebody has chosen

const clock = createClock(update);
const zoom = createZoom(() => lanes.draw());
const lanes = createLanes(clock, zoom, drawCurves, (t) => { pointed_s = t; readCurves(); });
const curves = createCurves(lanes.xOf, zoom);
const readings = createReadings();

function complain(text) {
  by("notice").textContent = text;
  by("notice").hidden = !text;
}

function update() {
  lanes.moveCursor();
  readings.update(clock.t, lanes.phaseAt(clock.t));
  readCurves();
  view?.update(clock.t);
  by("clock").textContent = `${clock.t.toFixed(2)} of ${clock.end.toFixed(2)} s`;
  by("play").textContent = clock.playing ? "Pause" : "Play";
}

function drawCurves() {
  if (!run) return;
  curves.draw(run, channels, shown);
  readCurves();
}

// At the pointer, else at the cursor.
function readCurves() {
  if (run) curves.read(pointed_s ?? clock.t);
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

const nominalGap = () => run.gaps.find((gap) => gap.kind === "nominal");

// Of left and right, or of four flippers, only the one with most of the gap.
const familyOf = (column) => column.replace(/_(left|right|fl|fr|rl|rr)_/, "_");

// Curves in the order of this run's own gap, largest first; at first those at the top.
function chooseChannels() {
  const floors = nominalGap()?.floors ?? {}, of = (channel) => floors[channel.column] ?? -1;
  const sorted = [...run.channels].sort((a, b) => of(b) - of(a));
  const families = new Set(), isFirst = (channel) => !families.has(familyOf(channel.column)) && families.add(familyOf(channel.column));
  const largest = sorted.filter((channel) => of(channel) > 0 && isFirst(channel)).map((channel) => channel.column);
  const wanted = chosenByHand ?? (largest.length ? largest : WITHOUT_GAP).slice(0, MOST_AT_FIRST);
  const choose = (columns) => { channels = sorted.filter((channel) => columns.includes(channel.column)); };
  choose(wanted);
  by("channel-list").replaceChildren(...sorted.map((channel) => {
    const title = of(channel) < 0 ? titleOf(channel.column) : `${titleOf(channel.column)}, ${floorsOf(of(channel))}`;
    const box = checkBox(title, wanted.includes(channel.column), (on) => {
      const others = channels.map(({ column }) => column).filter((column) => column !== channel.column);
      choose(chosenByHand = on ? [...others, channel.column] : others);
      drawCurves();
    });
    box.lastChild.before(" ");
    return box;
  }));
}

// The words for the worst moment of the nominal simulation.
function worstInWords() {
  const { worst } = nominalGap() ?? {};
  if (!worst) return "";
  const channel = run.channels.find(({ column }) => column === worst.column);
  return `Worst at ${worst.t_s.toFixed(2)} s: ${titleOf(worst.column)} of the nominal simulation ${differenceInWords(worst.difference, channel)} off, ` +
    `${floorsOf(worst.difference_floors)}; all channels ${floorsOf(worst.floors)} rms`;
}

function toWorst() {
  const { worst } = nominalGap() ?? {};
  if (!worst) return;
  clock.play(false);
  clock.set(worst.t_s);
}

function takePicture() {
  const factor = Number(by("exaggerate").value), at = `${run.manoeuvre}, ${run.file}, at ${clock.t.toFixed(2)} s`;
  const { worst } = nominalGap() ?? {}, isWorst = worst && Math.abs(worst.t_s - clock.t) < 0.005;
  const differences = [...by("difference").querySelectorAll("tbody tr")].map(({ cells: [title, ...values] }) => {
    const [name, unit] = title.textContent.split(", ");
    return `${name} ${values.map((cell) => cell.textContent).join(" and ")} ${unit}`;
  }).join(", ");
  const kinds = [...by("difference").querySelectorAll("thead th")].map((head) => head.textContent).filter(Boolean).join(" and ");
  curves.read(clock.t);
  return savePicture(makePicture(view?.picture() ?? null, curves.parts(), [
    `${list.name}: ${at}${isWorst ? ". " + worstInWords() : ""}`,
    kinds && `Simulated minus recorded, ${kinds}: ${differences}`,
    view && factor > 1 && deviationInWords(factor),
  ]), `${run.file.replace(/\.csv$/, "").replace(/[^\w.-]/g, "_")}-${clock.t.toFixed(2)}s.png`);
}

const deviationInWords = (factor) => `Deviations from the recorded robot are drawn ${factor} times as large.`;

function exaggerate() {
  const factor = Number(by("exaggerate").value);
  by("exaggerate-value").textContent = `${factor}\u00d7`;
  by("exaggerated").textContent = deviationInWords(factor);
  by("exaggerated").hidden = factor === 1;
  view?.exaggerate(factor);
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
  by("worst-words").textContent = worstInWords();
  by("worst").disabled = !nominalGap()?.worst;
  by("exaggerate").disabled = !run.bodies[0].pose || run.bodies.length < 2;
  const end_s = run.t_s[run.t_s.length - 1];
  zoom.load(end_s);
  lanes.load(run, list.report);
  view?.load(run, `/playback/${next}/scene`);
  clock.load(end_s, next === list.first ? list.at_s : 0);
  lanes.draw();
}

// Space belongs to a button that has the focus, arrows to a list.
function keyIsTaken(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target instanceof HTMLSelectElement) return true;
  if (event.target instanceof HTMLInputElement && event.target.type === "range") return event.code !== "Space";
  return event.code === "Space" && event.target.closest("button, summary, input") !== null;
}

const KEYS = {
  Space: () => clock.play(!clock.playing),
  ArrowLeft: () => step(-1), ArrowRight: () => step(1),
  Home: () => { clock.play(false); clock.set(0); }, End: () => clock.set(clock.end),
};
// By what they type, wherever the keyboard has them.
const TYPED = { "+": () => zoom.nearer(clock.t), "-": () => zoom.wider(clock.t), 0: () => zoom.all(), w: toWorst };
addEventListener("keydown", (event) => {
  const act = KEYS[event.code] ?? TYPED[event.key.toLowerCase()];
  if (!run || !act || !(event.target instanceof Element) || keyIsTaken(event)) return;
  event.preventDefault();
  act();
});
for (const [id, act] of [["play", KEYS.Space], ["step-back", KEYS.ArrowLeft], ["step-on", KEYS.ArrowRight], ["to-start", KEYS.Home], ["to-end", KEYS.End],
  ["zoom-in", TYPED["+"]], ["zoom-out", TYPED["-"]], ["zoom-all", TYPED[0]], ["worst", toWorst], ["save", takePicture]]) {
  by(id).addEventListener("click", () => { if (run) act(); });
}
by("exaggerate").addEventListener("input", exaggerate);
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
    exaggerate();
    if (run) view.load(run, `/playback/${number}/scene`).then(update);
  }).catch((error) => complain(`No 3D view: ${error.message}`));
  await loading;
}).catch((error) => complain(error.message));
