// The list of keys, opened by "?" or its button.
import { closeBeside, dialogIsOpen } from "./focus.js";

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
  closeBeside(dialog);
  addEventListener("keydown", (event) => {
    if (event.key !== "?" || event.ctrlKey || event.altKey || event.metaKey) return;
    if (dialog.open) dialog.close(); else open();
  });
}
