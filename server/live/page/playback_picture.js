// A picture of what is shown, as a PNG file: the 3D view, the curves, and in words which run, when and how large the gap is.
import { penOf } from "./pen.js";

const WIDTH_PX = 1200, EDGE_PX = 24, LINE_PX = 22, MOST_VIEW_PX = 640;

// Lines that fit.
function wrapped(pen, text, width) {
  const lines = [""];
  for (const word of text.split(" ")) {
    const longer = lines[lines.length - 1] ? `${lines[lines.length - 1]} ${word}` : word;
    if (pen.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

// `view`: the canvas of the 3D view, or null; `curves`: their parts (canvas, title, readings), whose bodies (kind, text) are drawn and the
// time {from_s, to_s, t_s, xOf}; `words`: lines.
export function makePicture(view, { parts, bodies, time }, words) {
  const picture = document.createElement("canvas"), pen = penOf(picture), wide = WIDTH_PX - 2 * EDGE_PX;
  const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name).trim();
  const font = "15px system-ui, sans-serif";
  pen.font = font;
  const lines = words.filter(Boolean).flatMap((text) => wrapped(pen, text, wide));
  const viewHeight = view ? Math.min(MOST_VIEW_PX, wide * view.height / view.width) : 0;
  const scaleOf = (canvas) => wide / canvas.width;
  picture.width = WIDTH_PX;
  picture.height = Math.ceil(2 * EDGE_PX + viewHeight + LINE_PX * (lines.length + (parts.length ? 3 : 1)) +
    parts.reduce((sum, { canvas }) => sum + LINE_PX + canvas.height * scaleOf(canvas), 0));
  pen.fillStyle = colour("--panel");
  pen.fillRect(0, 0, picture.width, picture.height);

  let y = EDGE_PX;
  if (view) {
    const width = viewHeight * view.width / view.height;
    pen.drawImage(view, EDGE_PX + (wide - width) / 2, y, width, viewHeight);
    y += viewHeight;
  }
  pen.font = font;
  pen.fillStyle = colour("--ink");
  for (const line of lines) pen.fillText(line, EDGE_PX, y += LINE_PX);
  if (!parts.length) return picture;

  // whose colours these are
  let x = EDGE_PX;
  y += LINE_PX;
  for (const { kind, text } of bodies) {
    pen.fillStyle = colour(`--${kind}`);
    pen.fillRect(x, y - 9, 22, 6);
    pen.fillStyle = colour("--ink");
    pen.fillText(text, x + 30, y);
    x += 54 + pen.measureText(text).width;
  }

  // the curves with the moment, and the time below the last one
  const xIn = (canvas, t_s) => EDGE_PX + time.xOf(t_s) / canvas.clientWidth * wide;
  for (const { canvas, title, readings } of parts) {
    pen.fillText(`${title}   ${readings}`, EDGE_PX, y += LINE_PX);
    pen.drawImage(canvas, EDGE_PX, y + 4, wide, canvas.height * scaleOf(canvas));
    pen.fillRect(xIn(canvas, time.t_s) - 1, y + 4, 2, canvas.height * scaleOf(canvas));
    y += canvas.height * scaleOf(canvas);
  }
  pen.textAlign = "center";
  const { canvas } = parts[0], at = xIn(canvas, time.t_s), seconds = `${time.t_s.toFixed(2)} s`, near = pen.measureText(seconds).width;
  for (const t_s of [time.from_s, time.to_s])
    if (Math.abs(xIn(canvas, t_s) - at) > near) pen.fillText(`${t_s.toFixed(2)} s`, Math.min(xIn(canvas, t_s), WIDTH_PX - EDGE_PX - near / 2), y + LINE_PX);
  pen.fillText(seconds, Math.min(at, WIDTH_PX - EDGE_PX - near / 2), y + LINE_PX);
  return picture;
}

export async function savePicture(picture, name) {
  const file = await new Promise((resolve) => picture.toBlob(resolve, "image/png")), link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);   // the browser reads it after the click
}
