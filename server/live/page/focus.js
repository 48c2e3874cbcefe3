// Which element has the keyboard. Space means stand wherever the focus is, so it presses no button. A button that was clicked gives the
// focus back, and whoever drives has it on the stick: there Enter does nothing.
const isButton = (element) => element instanceof HTMLButtonElement && !element.closest("dialog");

// A dialog has the keyboard for itself, except Space.
export function dialogIsOpen() {
  return document.querySelector("dialog[open]") !== null;
}

// A click beside a dialog closes it; one that began in it, to mark words, does not.
export function closeBeside(dialog) {
  const isBeside = ({ target, clientX, clientY }) => {
    const { left, right, top, bottom } = dialog.getBoundingClientRect();
    return target === dialog && (clientX < left || clientX > right || clientY < top || clientY > bottom);
  };
  let began = false;
  dialog.addEventListener("pointerdown", (event) => { began = isBeside(event); });
  dialog.addEventListener("click", (event) => { if (began && isBeside(event)) dialog.close(); });
}

export function focusStick() {
  if (!dialogIsOpen()) document.getElementById("stick").focus({ preventScroll: true });
}

// Before a key drives: takes the focus off a list, and off a button, which Enter would press.
export function leaveControl() {
  const focused = document.activeElement;
  if (focused instanceof HTMLSelectElement || (isButton(focused) && !focused.matches("[data-hold]"))) focusStick();
}

// `stand()`: called for Space.
export function watchFocus(stand) {
  const isSpace = (event) => event.code === "Space" && !event.ctrlKey && !event.altKey && !event.metaKey;
  addEventListener("keydown", (event) => {
    if (isSpace(event)) {
      event.preventDefault();   // keeps a button from being pressed, a list from opening, and the page from scrolling
      event.stopPropagation();
      stand();
    } else if (event.key === "Enter" && event.repeat && event.target instanceof HTMLButtonElement) {
      event.preventDefault();
    }
  }, { capture: true });
  addEventListener("keyup", (event) => { if (isSpace(event)) event.preventDefault(); }, { capture: true });
  addEventListener("click", (event) => {
    const button = event.target instanceof Element ? event.target.closest("button") : null;
    if (!isButton(button) || event.detail === 0) return;   // 0: by the keyboard
    button.blur();
    if (event.detail > 1 && button.matches("[data-once]")) event.stopPropagation();   // the second press of a double click
  }, { capture: true });
}
