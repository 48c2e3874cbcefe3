// Which worlds are installed, and how the server is started with another: a running one keeps its world (docs/live-view.md has why).
import { address } from "./connection.js";
import { closeBeside, dialogIsOpen } from "./focus.js";

const by = (id) => document.getElementById(id);

// As a shell reads it.
const quoted = (word) => (/^[A-Za-z0-9._-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// `beforeOpening()`: as for a question. `complain` is called with what is wrong, in words.
export function createWorlds(world, beforeOpening, complain) {
  const dialog = by("worlds"), list = by("worlds-list");
  let installed = { command: "", worlds: [] };

  function show() {
    const chosen = installed.worlds[list.selectedIndex];
    by("worlds-about").textContent = chosen?.words ?? "";
    by("worlds-command").textContent = chosen ? installed.command.replace("WORLD", quoted(chosen.name)) : "";
  }
  async function open() {
    if (dialogIsOpen()) return;
    beforeOpening();
    try {
      const answer = await fetch(address("/worlds"));
      if (!answer.ok) throw new Error(await answer.text());
      installed = await answer.json();
    } catch (error) {
      return complain(`No list of worlds: ${error.message}`);
    }
    installed.worlds.sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
    list.replaceChildren(...installed.worlds.map(({ name }) => new Option(name === world.name ? `${name} (running)` : name, name)));
    list.value = world.name;
    by("worlds-copied").textContent = "";
    show();
    if (!dialogIsOpen()) dialog.showModal();
  }

  by("world").addEventListener("click", open);
  list.addEventListener("change", show);
  by("worlds-close").addEventListener("click", () => dialog.close());
  closeBeside(dialog);
  // A page that came by the network without encryption has no clipboard: there one marks the words.
  by("worlds-copy").hidden = !navigator.clipboard;
  by("worlds-copy").addEventListener("click", () => navigator.clipboard.writeText(by("worlds-command").textContent)
    .then(() => { by("worlds-copied").textContent = "Copied"; }, () => { by("worlds-copied").textContent = "Not copied: mark the words"; }));
  list.addEventListener("change", () => { by("worlds-copied").textContent = ""; });
}
