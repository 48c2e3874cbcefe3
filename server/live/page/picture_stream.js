// One camera's stream, part by part. An <img> shows such a stream by itself, but does not tell which frame it shows; the age of a picture
// that waited in a slow network is known only by its number.
import { address } from "./connection.js";

const HEAD_BYTES = 2048;   // a part's head is shorter
const text = new TextDecoder("latin1");

// Where the head of the part that begins at `from` ends, and what it says; null: it is not all there.
function head(bytes, from) {
  const words = text.decode(bytes.subarray(from, from + HEAD_BYTES)), end = words.indexOf("\r\n\r\n");
  if (end < 0) {
    if (words.length === HEAD_BYTES) throw new Error("the pictures' stream is not understood");
    return null;
  }
  const value = (name) => Number(new RegExp(`^${name}: *([0-9.]+)`, "im").exec(words.slice(0, end))?.[1]);
  return { at: from + end + 4, length: value("Content-Length"), number: value("X-Frame-Number"), time_s: value("X-Robot-Time"), age_ms: value("X-Age-Ms") };
}

// Reads until the stream ends, which throws; `take({ jpeg, number, time_s, age_ms })` gets the newest whole part each time some came:
// time_s is the robot time that it shows, age_ms its age when the server sent it.
export async function readPictures(path, signal, take) {
  const answer = await fetch(address(path), { signal });
  if (!answer.ok) throw new Error(await answer.text());
  const reader = answer.body.getReader();
  let bytes = new Uint8Array(0);
  for (;;) {
    const { done, value } = await reader.read();
    if (done) throw new Error("the stream ended");
    const joined = new Uint8Array(bytes.length + value.length);
    joined.set(bytes);
    joined.set(value, bytes.length);
    bytes = joined;
    let newest = null;
    for (let part = head(bytes, 0); part && part.at + part.length <= bytes.length; part = head(bytes, 0)) {
      newest = { jpeg: bytes.slice(part.at, part.at + part.length), number: part.number, time_s: part.time_s, age_ms: part.age_ms };
      bytes = bytes.slice(part.at + part.length);
    }
    if (newest) take(newest);
  }
}
