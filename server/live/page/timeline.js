// The last minute of robot time of the chosen robot: speeds, pitch, currents.
import { angles } from "./world.js";

const SPAN_S = 60;
const GAP_S = 1 / 12;   // between samples: 720 in a minute
const STRIPS = [
  { name: "speed, m/s", least: 0.5, lines: [["left", "--c1", (now) => now.track_mps[0]], ["right", "--c2", (now) => now.track_mps[1]]] },
  { name: "pitch, \u00b0", least: 10, lines: [["nose down +", "--c1", (now) => angles(now.q).pitch]] },
  { name: "currents, A", least: 5, zero: true, lines: [["tracks", "--c1", (now) => now.track_a[0] + now.track_a[1]],
    ["flippers", "--c2", (now) => (now.flipper_a ?? []).reduce((a, b) => a + b, 0)]] },
];

export function createTimeline() {
  const canvas = document.getElementById("chart"), pen = canvas.getContext("2d");
  let samples = [], robotId = 0, seen_s = 0, drawn_ms = 0;
  let pointer = null;   // x in the canvas, while the mouse is over it

  function take(time_s, robot) {
    if (robot.about.id !== robotId || time_s < seen_s) samples = [];
    robotId = robot.about.id;
    seen_s = time_s;
    if (samples.length && time_s < samples[samples.length - 1].t + GAP_S) return;
    samples.push({ t: time_s, v: STRIPS.map((strip) => strip.lines.map(([, , value]) => value(robot.now))) });
    while (samples.length && samples[0].t < time_s - SPAN_S) samples.shift();
  }

  // The least of 1, 2, 5 times a power of ten that holds everything.
  function range(strip, i) {
    let most = strip.least;
    for (const sample of samples) for (const v of sample.v[i]) most = Math.max(most, Math.abs(v));
    const power = 10 ** Math.floor(Math.log10(most));
    return [1, 2, 5, 10].find((factor) => factor * power >= most * 0.999) * power;
  }

  function draw(time_s) {
    const ratio = devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    pen.lineJoin = "round";
    const left = 40, right = width - 10, each = (height - 20) / STRIPS.length;
    const x = (t) => right - (time_s - t) / SPAN_S * (right - left);
    const at = pointer === null ? null : samples.reduce((best, s) => (Math.abs(x(s.t) - pointer) < Math.abs(x(best?.t ?? -1e9) - pointer) ? s : best), null);

    STRIPS.forEach((strip, i) => {
      const most = range(strip, i), top = i * each + 18, bottom = (i + 1) * each - 2;
      const y = (v) => bottom - (strip.zero ? v / most : (v / most + 1) / 2) * (bottom - top);
      pen.strokeStyle = colour("--line");
      pen.fillStyle = colour("--soft");
      pen.textAlign = "right";
      pen.textBaseline = "middle";
      for (const v of strip.zero ? [0, most] : [-most, 0, most]) {
        pen.beginPath();
        pen.moveTo(left, y(v));
        pen.lineTo(right, y(v));
        pen.stroke();
        pen.fillText(`${Number(v.toPrecision(2))}`.replace("-", "\u2212"), left - 5, y(v));
      }
      pen.textAlign = "left";
      pen.fillText(strip.name, left, top - 9);
      let legend = left + pen.measureText(strip.name).width + 14;
      strip.lines.forEach(([name, token], k) => {
        pen.strokeStyle = pen.fillStyle = colour(token);
        const text = at ? `${name} ${at.v[i][k].toFixed(2)}` : name;
        pen.fillText(text, legend, top - 9);
        legend += pen.measureText(text).width + 12;
        pen.lineWidth = 1.5;
        pen.beginPath();
        samples.forEach((sample, n) => (n ? pen.lineTo(x(sample.t), y(sample.v[i][k])) : pen.moveTo(x(sample.t), y(sample.v[i][k]))));
        pen.stroke();
        pen.lineWidth = 1;
      });
    });
    pen.fillStyle = colour("--soft");
    for (const [ago, align] of [[60, "left"], [45, "center"], [30, "center"], [15, "center"], [0, "right"]]) {
      pen.textAlign = align;
      pen.fillText(ago ? `\u2212${ago} s` : "now", x(time_s - ago), height - 9);
    }
    if (!at) return;
    pen.strokeStyle = colour("--soft");
    pen.beginPath();
    pen.moveTo(x(at.t), 4);
    pen.lineTo(x(at.t), height - 18);
    pen.stroke();
  }

  canvas.addEventListener("pointermove", (event) => { pointer = event.offsetX; });
  canvas.addEventListener("pointerleave", () => { pointer = null; });
  return {
    update(time_s, robot) {
      if (robot?.now) take(time_s, robot);
      const now_ms = performance.now();
      if (document.hidden || now_ms < drawn_ms + 100) return;
      drawn_ms = now_ms;
      draw(time_s);
    },
  };
}
