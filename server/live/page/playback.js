// Puts the playback's parts together: a run is fetched once, and from then on everything follows the clock.
import { checkBox, createChannels } from "./playback_channels.js";
import { createClock } from "./playback_clock.js";
import { createCurves, differenceInWords, shownUnit, timesNoise, titleOf, valueInWords } from "./playback_curves.js";
import { fetchList, fetchRun, gapInWords, indexAt, LABELS, nominalGapOf } from "./playback_data.js";
import { createLanes } from "./playback_lanes.js";
import { makePicture, savePicture } from "./playback_picture.js";
import { createReadings } from "./playback_readings.js";
import { createZoom } from "./playback_zoom.js";

const by = (id) => document.getElementById(id);

const hidden = new Set();                  // kinds of bodies, "paths"
const shown = (kind) => !hidden.has(kind);
let list = null, run = null, number = -1, view = null, pointed_s = null;

const clock = createClock(update);
const zoom = createZoom(() => lanes.draw());
const lanes = createLanes(clock, zoom, drawCurves, (t) => { pointed_s = t; readCurves(); });
const curves = createCurves(lanes.xOf, zoom);
const readings = createReadings();
const channels = createChannels(drawCurves);

let noView = "";   // why there is no 3D view; stays until another complaint is more urgent
function complain(text) {
  by("notice").textContent = text || noView;
  by("notice").hidden = !by("notice").textContent;
}
function loseView(why) {
  view = null;
  noView = `No 3D view: ${why}`;
  complain("");
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
  curves.draw(run, channels.shown(), shown);
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

// The words for the worst moment of the nominal simulation.
function worstInWords() {
  const gap = nominalGapOf(run), worst = gap?.worst;
  if (!worst) return "";
  const channel = run.channels.find(({ column }) => column === worst.column), off = differenceInWords(worst.difference, channel);
  return `Worst of this run at ${worst.t_s.toFixed(2)} s: the nominal simulation is ${timesNoise(worst.floors)} off, rms of all channels; most in ` +
    `${titleOf(worst.column)}: measured ${valueInWords(worst.recorded, channel)}, simulated ${valueInWords(worst.simulated, channel)} ${shownUnit(channel.unit)}, ` +
    `difference ${off} in the mean of ${gap.span_s} s, ${timesNoise(worst.difference_floors)}.${ofAllInWords()}`;
}

// Whether that is the worst of all runs, where the report has them.
function ofAllInWords() {
  const known = list.runs.filter(({ worst }) => worst);
  if (known.length < 2) return "";
  const most = known.reduce((a, b) => (b.worst.floors > a.worst.floors ? b : a));
  return most.file === run.file ? " It is the worst of all runs." :
    ` Worst of all runs: ${timesNoise(most.worst.floors)} at ${most.worst.t_s.toFixed(2)} s of ${most.file}.`;
}

function toWorst() {
  const worst = nominalGapOf(run)?.worst;
  if (!worst) return;
  channels.include(worst.column);
  clock.play(false);
  clock.set(worst.t_s);
}

const SAVED_MS = 4000;
async function takePicture() {
  const factor = Number(by("exaggerate").value), at = `${run.manoeuvre}, ${run.file}, at ${clock.t.toFixed(2)} s`;
  const worst = nominalGapOf(run)?.worst, isWorst = worst && Math.abs(worst.t_s - clock.t) < 0.005;
  const differences = [...by("difference").querySelectorAll("tbody tr")].map(({ cells: [title, ...values] }) => {
    const [name, unit] = title.textContent.split(", ");
    return `${name} ${values.map((cell) => cell.textContent).join(" and ")} ${unit}`;
  }).join(", ");
  const kinds = [...by("difference").querySelectorAll("thead th")].slice(1).map((head) => head.textContent).join(" and ");
  curves.read(clock.t);
  const bodies = run.bodies.filter(({ kind }) => shown(kind)).map(({ kind }) => ({ kind, text: LABELS[kind](list.source) }));
  const time = { from_s: zoom.from, to_s: zoom.to, t_s: clock.t, xOf: lanes.xOf };
  const name = `${run.file.replace(/\.csv$/, "").replace(/[^\w.-]/g, "_")}-${clock.t.toFixed(2)}s.png`;
  await savePicture(makePicture(view?.picture() ?? null, { parts: curves.parts(), bodies, time }, [
    `${list.name}: ${at}${isWorst ? ". " + worstInWords() : ""}`,
    kinds && `Measured minus simulated, ${kinds}: ${differences}`,
    view && factor > 1 && deviationInWords(factor),
  ]), name);
  lanes.say(`Picture saved as ${name} among the browser's downloads.`);
  by("save").textContent = "Picture saved";
  setTimeout(() => { by("save").textContent = "Save picture"; }, SAVED_MS);
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
  if (number !== next) return;
  if (!loaded) {   // what is shown is still the run before
    if (!run) return;
    number = list.runs.findIndex(({ file }) => file === run.file);
    by("run").value = `${number}`;
    by("world").textContent = list.runs[number].world;
    return;
  }
  complain("");
  run = loaded;
  makeLegend();
  channels.load(run);
  readings.load(run);
  by("notes").replaceChildren(...[...list.notes, ...run.notes].map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  }));
  by("worst-words").textContent = worstInWords();
  by("worst").disabled = !nominalGapOf(run)?.worst;
  by("exaggerate").disabled = !run.bodies[0].pose || run.bodies.length < 2;
  const end_s = run.t_s[run.t_s.length - 1];
  zoom.load(end_s);
  lanes.load(run, list.report);
  view?.load(run, `/playback/${next}/scene`);
  clock.load(end_s, next === list.first ? list.at_s : 0);
  lanes.draw();
}

// A button that was clicked gives the focus back: Space plays then.
addEventListener("click", (event) => { if (event.detail > 0) event.target.closest?.("button")?.blur(); });

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
  if (event.code !== "Space" || !event.repeat) act();
});
for (const [id, act] of [["play", KEYS.Space], ["step-back", KEYS.ArrowLeft], ["step-on", KEYS.ArrowRight], ["to-start", KEYS.Home], ["to-end", KEYS.End],
  ["zoom-in", TYPED["+"]], ["zoom-out", TYPED["-"]], ["zoom-all", TYPED[0]], ["worst", toWorst], ["save", () => takePicture().catch((error) => complain(`No picture saved: ${error.message}`))]]) {
  by(id).addEventListener("click", () => { if (run) act(); });
}
by("exaggerate").addEventListener("input", exaggerate);
by("pace").addEventListener("change", (event) => { clock.pace = Number(event.target.value); });
by("run").addEventListener("change", (event) => load(Number(event.target.value)));

function tellVerdict() {
  if (!list.report) return;
  const { verdict, named } = list.report;
  by("verdict").textContent = named.length ? `${verdict}: ${named.join(", ")}` : `verdict: ${verdict}`;
  by("verdict").title = "The report's verdict, and the effects that it names";
  by("verdict").hidden = false;
}

const runInWords = ({ manoeuvre, file, share, worst }) => [manoeuvre, file,
  ...(worst ? [`worst ${timesNoise(worst.floors)}`] : []),
  ...(share === undefined ? [] : [`${Math.round(100 * share)} % of ${gapInWords(list.report?.stage)}`])].join(" \u00b7 ");

fetchList().then(async (answer) => {
  list = answer;
  document.title = `Kenaf: ${list.name}`;
  tellVerdict();
  by("run").replaceChildren(...list.runs.map((about, i) => new Option(runInWords(about), i)));
  // curves and figures work without it, where a browser has no WebGL
  const loading = load(list.first);
  await import("./playback_view.js").then(({ createPlaybackView }) => {
    view = createPlaybackView(list, shown, complain, () => loseView("the browser has taken it away"));
    exaggerate();
    if (run) view.load(run, `/playback/${number}/scene`).then(update);
  }).catch((error) => loseView(error.message));
  await loading;
}).catch((error) => complain(error.message));
