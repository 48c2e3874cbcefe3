// Which curves are shown: the list of them, by this run's own gap, and what somebody chose from it.
import { timesNoise, titleOf } from "./playback_curves.js";
import { nominalGapOf } from "./playback_data.js";

const WITHOUT_GAP = ["x_m", "pitch_rad", "track_left_mps"], MOST_AT_FIRST = 3;
const EDGE_PX = 12;
const by = (id) => document.getElementById(id);

// Of left and right, or of four flippers, only the one with most of the gap.
const familyOf = (column) => column.replace(/_(left|right|fl|fr|rl|rr)_/, "_");

export function checkBox(text, checked, changed) {
  const label = document.createElement("label"), box = document.createElement("input");
  box.type = "checkbox";
  box.checked = checked;
  box.addEventListener("change", () => changed(box.checked));
  label.append(box, text);
  return label;
}

// `changed()`: other ones are shown.
export function createChannels(changed) {
  const details = by("channels"), list = by("channel-list");
  let sorted = [], shown = [], chosenByHand = null;   // columns, once somebody has chosen

  function show(columns) {
    shown = sorted.filter((channel) => columns.includes(channel.column));
    for (const box of list.querySelectorAll("input")) box.checked = columns.includes(box.dataset.column);
  }
  const columns = () => shown.map(({ column }) => column);
  function turn(column, on) {
    show(chosenByHand = [...columns().filter((other) => other !== column), ...(on ? [column] : [])]);
    changed();
  }

  // In the order of the run's gap, largest first; at first that of its worst moment, and those at the top.
  function load(run) {
    const gap = nominalGapOf(run), floors = gap?.floors ?? {}, of = (channel) => floors[channel.column] ?? -1;
    sorted = [...run.channels].sort((a, b) => of(b) - of(a));
    const note = document.createElement("p");
    note.textContent = "Nominal simulation, rms of this run:";
    note.hidden = !gap;
    list.replaceChildren(note, ...sorted.map((channel) => {
      const title = of(channel) < 0 ? titleOf(channel.column) : `${titleOf(channel.column)}, ${timesNoise(of(channel))}`;
      const label = checkBox(` ${title}`, false, (on) => turn(channel.column, on));
      label.firstChild.dataset.column = channel.column;
      return label;
    }));
    const families = new Set(), isFirst = (column) => !families.has(familyOf(column)) && families.add(familyOf(column));
    const largest = sorted.filter((channel) => of(channel) > 0).map(({ column }) => column);
    const atFirst = (gap?.worst ? [gap.worst.column, ...largest] : largest).filter(isFirst);
    show(chosenByHand ?? (atFirst.length ? atFirst : WITHOUT_GAP).slice(0, MOST_AT_FIRST));
  }

  // The list opens to where there is more room; Esc or a press beside it closes it.
  details.addEventListener("toggle", () => {
    const { top, bottom } = details.firstElementChild.getBoundingClientRect(), below = innerHeight - bottom;
    list.classList.toggle("below", below > top);
    list.style.maxHeight = `${Math.max(top, below) - EDGE_PX}px`;
  });
  addEventListener("pointerdown", (event) => { if (!details.contains(event.target)) details.open = false; }, { capture: true });
  details.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !details.open) return;
    details.open = false;
    details.firstElementChild.focus();
  });

  return { load, shown: () => shown, include(column) { if (!columns().includes(column)) turn(column, true); } };
}
