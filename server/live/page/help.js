// The list of keys, opened by "?" or its button.
import { dialogIsOpen } from "./focus.js";

// `beforeOpening()`: as for a question.
export function createHelp(beforeOpening) {
  const dialog = document.getElementById("help");
  function open() {
    if (dialogIsOpen()) return;
    beforeOpening();
    dialog.showModal();
  }
  document.getElementById("help-open").addEventListener("click", open);
  document.getElementById("help-close").addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });   // beside it
  addEventListener("keydown", (event) => {
    if (event.key !== "?" || event.ctrlKey || event.altKey || event.metaKey) return;
    if (dialog.open) dialog.close(); else open();
  });
}
