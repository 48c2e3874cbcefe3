// Choices that a reload keeps, in the browser. Without its storage, as in some private windows, they last as long as the page.
const PREFIX = "kenaf.";

function read(storage, key) {
  try {
    return JSON.parse(storage().getItem(PREFIX + key));
  } catch {
    return null;
  }
}
function write(storage, key, value) {
  try {
    storage().setItem(PREFIX + key, JSON.stringify(value));
  } catch { /* it lasts as long as the page */ }
}

// Of all windows. `recall` returns what was kept, or null; whoever asks checks it, as an older page may have kept it.
const all = () => localStorage;
export const recall = (key) => read(all, key);
export const keep = (key, value) => write(all, key, value);

// Of this window alone: two windows may watch two robots.
const own = () => sessionStorage;
export const recallHere = (key) => read(own, key);
export const keepHere = (key, value) => write(own, key, value);
