// Files for the person: the shown time of the chosen robot as a run, and the large picture.
import { fileName, runFile } from "./run_file.js";

const KEPT_MS = 60000;   // a browser may ask where to put it first

function download(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), KEPT_MS);
}

// `picture()`: {name, blob, t} of what is large, and the robot time that it shows, by a promise; `complain` is called with what is wrong, in words.
export function createSaving(history, past, timeWindow, chosen, picture, complain) {
  const when = (t) => `${t.toFixed(2)}s`;
  document.getElementById("save-run").addEventListener("click", () => {
    const { from_s, to_s } = timeWindow.range(), moments = history.between(from_s, to_s), id = chosen();
    const text = runFile(moments, id);
    if (!text) return complain("No run to save: choose a robot that was there in the shown time");
    const of = moments.filter(({ robots }) => robots.has(id)), { about } = of[0].robots.get(id);
    download(fileName([past.seen.name, about.name, when(of[0].t), when(of[of.length - 1].t)], ".csv"), new Blob([text], { type: "text/csv" }));
  });
  document.getElementById("save-picture").addEventListener("click", async () => {
    try {
      const { name, blob, t } = await picture();
      download(fileName([past.seen.name, name, when(t)], ".png"), blob);
    } catch (error) {
      complain(`No picture to save: ${error.message}`);
    }
  });
}
