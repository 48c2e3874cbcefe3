// A reading that is dragged to the plots. By pointer events: while a browser's own drag lasts, no page is told that a
// key is released, and a robot would drive on.
const FAR_PX = 6;   // less is a press

// `dropped()`: the button was let go of over the target.
export function letDrag(button, target, dropped) {
  let from = null, dragged = false;
  const over = ({ clientX, clientY }) => {
    const box = target.getBoundingClientRect();
    return clientX >= box.left && clientX <= box.right && clientY >= box.top && clientY <= box.bottom;
  };
  function end() {
    from = null;
    target.removeAttribute("data-drop");
  }
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    from = event;
    dragged = false;
    button.setPointerCapture(event.pointerId);
  });
  button.addEventListener("pointermove", (event) => {
    if (!from) return;
    dragged ||= Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > FAR_PX;
    if (dragged) target.toggleAttribute("data-drop", over(event));
  });
  button.addEventListener("pointerup", (event) => {
    if (dragged && over(event)) dropped();
    end();
  });
  button.addEventListener("pointercancel", end);
  // a click follows where the pointer was captured
  button.addEventListener("click", (event) => {
    if (dragged) event.stopImmediatePropagation();
    dragged = false;
  });
}
