// The time line: its ruler, the phases, the marks of the report, and the cursor that is dragged over all of them.
const LEFT_PX = 58, RIGHT_PX = 12, NARROW_PX = 26;

const by = (id) => document.getElementById(id);
const percent = (share) => (share >= 0.0995 ? `${Math.round(share * 100)} %` : `${(share * 100).toFixed(1)} %`);
const seconds = (t) => t.toFixed(2);

function element(name, className, text = "") {
  const made = document.createElement(name);
  made.className = className;
  made.textContent = text;
  return made;
}

export function createLanes(clock, drawn) {
  const lanes = by("lanes"), ruler = by("ruler"), cursor = by("cursor"), about = by("about-mark");
  let run = null, hasReport = false, spans = [], dragging = false;

  const usual = () => {
    if (!run) return "";
    return run.marks.length ? "Darker: a larger part of the gap between the robot and its nominal simulation." : "";
  };
  const end = () => run.t_s[run.t_s.length - 1] || 1;
  const xOf = (t) => LEFT_PX + t / end() * Math.max(1, lanes.clientWidth - LEFT_PX - RIGHT_PX);
  const timeAt = (x) => (x - LEFT_PX) / Math.max(1, lanes.clientWidth - LEFT_PX - RIGHT_PX) * end();

  function put(made, from_s, to_s) {
    const left = xOf(Math.min(from_s, end())), width = Math.max(3, xOf(Math.min(to_s, end())) - left);
    made.style.left = `${left}px`;
    made.style.width = `${width}px`;
    made.classList.toggle("narrow", width < Math.max(NARROW_PX, 6.2 * made.textContent.length + 6));
  }

  function drawRuler() {
    const wanted = end() / Math.max(2, (lanes.clientWidth - LEFT_PX) / 90), power = 10 ** Math.floor(Math.log10(wanted));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((s) => s >= wanted);
    const ticks = [];
    for (let t = 0; t <= end() + 1e-9; t += step) {
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
    return `${mark.manoeuvre}, ${mark.phase}, ${seconds(mark.from_s)} to ${seconds(mark.to_s)} s: ${percent(mark.share)} of the gap${whose}`;
  }

  function drawMarks() {
    const lane = by("marks"), most = Math.max(...run.marks.map((mark) => mark.share), 1e-9);
    const inTime = [...run.marks].sort((a, b) => a.from_s - b.from_s);
    const made = inTime.map((mark) => {
      const button = element("button", "mark", percent(mark.share)), dark = mark.share / most;
      button.type = "button";
      button.dataset.share = mark.share;
      button.setAttribute("aria-label", tell(mark));
      button.style.backgroundColor = `rgba(var(--gap), ${(0.05 + 0.85 * dark).toFixed(3)})`;
      button.style.color = dark > 0.6 ? "var(--panel)" : "var(--ink)";
      put(button, mark.from_s, mark.to_s);
      if (button.classList.contains("narrow")) button.style.color = "transparent";
      for (const event of ["pointerenter", "focus"]) button.addEventListener(event, () => { about.textContent = tell(mark); });
      for (const event of ["pointerleave", "blur"]) button.addEventListener(event, () => { about.textContent = usual(); });
      // by the keyboard; the pointer sets the cursor where it is
      button.addEventListener("click", (event) => { if (event.detail === 0) clock.set(mark.from_s); });
      return button;
    });
    const none = hasReport ? "The report does not cover this run" :
      "No marks without a report: kenaf-gap diagnose RUNS --out DIR, then kenaf-gap play RUNS --report DIR";
    lane.replaceChildren(element("span", "name", "gap"), ...(made.length ? made : [element("span", "none", none)]));
    about.textContent = usual();
  }

  function moveCursor() {
    if (!run) return;
    cursor.style.left = `${xOf(clock.t)}px`;
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

  const drag = (event) => clock.set(timeAt(event.clientX - lanes.getBoundingClientRect().left));
  lanes.addEventListener("pointerdown", (event) => {
    if (!run || event.button !== 0) return;
    dragging = true;
    lanes.setPointerCapture(event.pointerId);
    drag(event);
  });
  lanes.addEventListener("pointermove", (event) => { if (dragging) drag(event); });
  for (const name of ["pointerup", "pointercancel"]) lanes.addEventListener(name, () => { dragging = false; });
  new ResizeObserver(draw).observe(lanes.parentElement);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);

  return {
    xOf, moveCursor, draw,
    load(next, report) { run = next; hasReport = report; draw(); },
    phaseAt(t) { return run?.phases.findLast((phase) => t >= phase.from_s)?.phase ?? ""; },
  };
}
