// A question before something that cannot be undone. It opens with the focus on "Cancel", and its other button waits until the
// second press of a double click on what opened it is over.
const ARM_MS = 600;   // chosen: longer than the double click of common systems, 500 ms
const by = (id) => document.getElementById(id);

// `beforeAsking()`: before the question, which keeps to itself that a key came up. Returns ask(words, verb, act).
export function createQuestion(beforeAsking) {
  const dialog = by("question"), yes = by("question-yes");
  let act = null, arming = 0;

  dialog.addEventListener("close", () => { act = null; clearTimeout(arming); });
  // beside the buttons a press takes the focus from neither
  dialog.addEventListener("mousedown", (event) => { if (!event.target.closest("button")) event.preventDefault(); });
  by("question-no").addEventListener("click", () => dialog.close());
  yes.addEventListener("click", () => {
    const carryOut = act;
    dialog.close();
    carryOut?.();
  });
  return (words, verb, carryOut) => {
    if (dialog.open) return;
    beforeAsking();
    act = carryOut;
    by("question-words").textContent = words;
    yes.textContent = verb;
    yes.disabled = true;
    arming = setTimeout(() => { yes.disabled = false; }, ARM_MS);
    dialog.showModal();
    by("question-no").focus();
  };
}
