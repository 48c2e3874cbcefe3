// A press and a drag over something with a time axis. A finger that scrolls the page over it presses nothing: it looks only once it goes
// sideways, or is let go of where it came down.
const SLIP_PX = 8;

// `looks(event)`: at that place; `moved(event, isDragged)`: the pointer is there.
export function onDrag(element, { looks, moved = () => {} }) {
  let pointer = null, from_px = 0, looked = false;   // the one that drags
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    [pointer, from_px, looked] = [event.pointerId, event.clientX, event.pointerType !== "touch"];
    if (looked) looks(event);
  });
  element.addEventListener("pointermove", (event) => {
    if (event.pointerId === pointer) {
      looked ||= Math.abs(event.clientX - from_px) > SLIP_PX;
      if (looked) looks(event);
    }
    moved(event, pointer !== null);
  });
  element.addEventListener("pointerup", (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    if (!looked) looks(event);
  });
  element.addEventListener("pointercancel", () => { pointer = null; });
}
