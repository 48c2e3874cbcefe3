// The time line: its ruler, the phases, the marks of the report, and the cursor that is dragged over all of them.
import { onDrag } from "./drag.js";
import { gapInWords, stageMeaning, stageName } from "./playback_data.js";

const LEFT_PX = 58, RIGHT_PX = 12, NARROW_PX = 26;
const MOST_SHADE = 0.62;   // as in the report: text on it keeps a contrast of 4.5 : 1

const by = (id) => document.getElementById(id);
const percent = (share) => (share >= 0.0995 ? `${Math.round(share * 100)} %` : `${(share * 100).toFixed(1)} %`);
const seconds = (t) => t.toFixed(2);

function element(name, className, text = "") {
  const made = document.createElement(name);
  made.className = className;
  made.textContent = text;
  return made;
}

const shade = (strength) => `color-mix(in srgb, var(--shade) ${(100 * MOST_SHADE * strength).toFixed(1)}%, var(--panel))`;

// `hovered(t)`: the pointer is at that time; null: nowhere.
export function createLanes(clock, zoom, drawn, hovered) {
  const lanes = by("lanes"), ruler = by("ruler"), cursor = by("cursor"), hover = by("hover"), about = by("about-mark");
  let run = null, report = null, spans = [];

  const usual = () => {
    if (!run?.marks.length) return "";
    const meaning = stageMeaning(report?.stage);
    return `Darker: in the report, a larger part of ${gapInWords(report?.stage)}${meaning ? `: ${meaning}` : ""}.`;
  };
  const end = () => run.t_s[run.t_s.length - 1] || 1;
  const width = () => Math.max(1, lanes.clientWidth - LEFT_PX - RIGHT_PX);
  const xOf = (t) => LEFT_PX + (t - zoom.from) / (zoom.to - zoom.from) * width();
  const timeAt = (x) => zoom.from + (x - LEFT_PX) / width() * (zoom.to - zoom.from);
  const isShown = (t) => t >= zoom.from - 1e-9 && t <= zoom.to + 1e-9;

  function put(made, from_s, to_s) {
    made.hidden = to_s < zoom.from || from_s > zoom.to;
    if (made.hidden) return;
    const left = xOf(Math.max(from_s, zoom.from)), wide = Math.max(3, xOf(Math.min(to_s, zoom.to)) - left);
    made.style.left = `${left}px`;
    made.style.width = `${wide}px`;
    made.classList.toggle("narrow", wide < Math.max(NARROW_PX, 6.2 * made.textContent.length + 6));
  }

  function drawRuler() {
    const wanted = (zoom.to - zoom.from) / Math.max(2, width() / 90), power = 10 ** Math.floor(Math.log10(wanted));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => s >= wanted);
    const ticks = [];
    for (let t = Math.ceil(zoom.from / step - 1e-6) * step; t <= zoom.to + 1e-9; t += step) {
      const tick = element("span", "", `${Number(t.toFixed(3))} s`);
      tick.style.left = `${xOf(t)}px`;
      if (xOf(t) < lanes.clientWidth - 14) ticks.push(tick);
    }
    ruler.replaceChildren(...ticks);
    ruler.setAttribute("aria-valuemax", seconds(end()));
  }

  function drawPhases() {
    spans = run.phases.map((phase) => {
      const made = element("div", "phase", phase.phase);
      made.setAttribute("role", "listitem");
      made.title = `${phase.phase}, ${seconds(phase.from_s)} to ${seconds(phase.to_s)} s`;
      put(made, phase.from_s, phase.to_s);
      return { made, phase };
    });
    by("phases").replaceChildren(element("span", "name", "phase"), ...spans.map(({ made }) => made));
  }

  function tell(mark) {
    const whose = mark.run && mark.run !== run.file ? `, times of its repeat ${mark.run}` : "";
    return `${mark.manoeuvre}, ${mark.phase}, ${seconds(mark.from_s)} to ${seconds(mark.to_s)} s: ${percent(mark.share)} of ${gapInWords(report?.stage)}${whose}`;
  }

  function drawMarks() {
    const lane = by("marks"), most = report?.largest_share || 1e-9;
    const inTime = [...run.marks].sort((a, b) => a.from_s - b.from_s);
    const made = inTime.map((mark) => {
      const button = element("button", "mark", percent(mark.share));
      button.type = "button";
      button.dataset.share = mark.share;
      button.setAttribute("aria-label", tell(mark));
      button.style.backgroundColor = shade(mark.share / most);
      put(button, mark.from_s, mark.to_s);
      for (const event of ["pointerenter", "focus"]) button.addEventListener(event, () => { about.textContent = tell(mark); });
      for (const event of ["pointerleave", "blur"]) button.addEventListener(event, () => { about.textContent = usual(); });
      // by the keyboard; the pointer sets the cursor where it is
      button.addEventListener("click", (event) => { if (event.detail === 0) clock.set(mark.from_s); });
      return button;
    });
    const none = report ? "The report does not cover this run" :
      "No marks without a report: kenaf-gap diagnose RUNS --out DIR, then kenaf-gap play RUNS --report DIR";
    const name = stageName(report?.stage), title = element("span", name ? "name two" : "name", name ? `gap of ${name}` : "gap");
    lane.replaceChildren(title, ...(made.length ? made : [element("span", "none", none)]));
    about.textContent = usual();

    // the scale of the report: of all its phases, not of this run's
    by("scale").hidden = !made.length;
    const steps = [0, 0.2, 0.4, 0.6, 0.8, 1].map((strength) => {
      const step = element("span", "step");
      step.style.backgroundColor = shade(strength);
      return step;
    });
    by("scale").replaceChildren("0 %", ...steps, percent(most));
  }

  function moveCursor() {
    if (!run) return;
    zoom.reveal(clock.t);
    cursor.hidden = !isShown(clock.t);
    cursor.style.left = `${xOf(clock.t)}px`;
    cursor.dataset.time = `${seconds(clock.t)} s`;
    cursor.classList.toggle("left", xOf(clock.t) > lanes.clientWidth - 70);
    ruler.setAttribute("aria-valuenow", seconds(clock.t));
    ruler.setAttribute("aria-valuetext", `${seconds(clock.t)} seconds`);
    for (const { made, phase } of spans) made.toggleAttribute("data-now", clock.t >= phase.from_s && clock.t < phase.to_s);
  }

  function draw() {
    if (!run) return;
    drawRuler();
    drawPhases();
    drawMarks();
    drawn();
    moveCursor();
  }

  const timeOf = (event) => Math.max(0, Math.min(end(), timeAt(event.clientX - lanes.getBoundingClientRect().left)));
  function pointAt(t) {
    hover.hidden = t === null || !isShown(t);
    if (t !== null) {
      hover.style.left = `${xOf(t)}px`;
      hover.dataset.time = `${seconds(t)} s`;
      hover.classList.toggle("left", xOf(t) > lanes.clientWidth - 70);
    }
    hovered(t);
  }
  onDrag(lanes, {
    looks(event) {
      if (!run) return;
      pointAt(null);
      clock.set(timeOf(event));
    },
    moved(event, isDragged) {
      if (run && event.pointerType === "mouse" && !isDragged) pointAt(timeOf(event));
    },
  });
  lanes.addEventListener("pointerleave", () => { if (run) pointAt(null); });
  // with Control, as maps do: alone the wheel scrolls the curves
  lanes.addEventListener("wheel", (event) => {
    if (!run) return;
    const sideways = event.deltaX || (event.shiftKey ? event.deltaY : 0);
    if (event.ctrlKey) zoom.scale(timeOf(event), Math.exp(0.002 * event.deltaY));
    else if (sideways) zoom.pan(sideways / width() * (zoom.to - zoom.from));
    else return;
    event.preventDefault();
  }, { passive: false });
  new ResizeObserver(draw).observe(lanes.parentElement);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);

  return {
    xOf, moveCursor, draw,
    say(text) { about.textContent = text; },
    load(next, ofReport) { run = next; report = ofReport; pointAt(null); draw(); },
    phaseAt(t) { return run?.phases.findLast((phase) => t >= phase.from_s)?.phase ?? ""; },
  };
}
