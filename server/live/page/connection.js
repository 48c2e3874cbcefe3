// The WebSocket to the server: opened again when it breaks, watched for age and for states that were dropped.
const PROTOCOL = 2;
// A state comes 30 times a second, also while the world is paused. Silence is counted, not read off the clock: a page that was held
// up itself has missed beats too, and has not read yet what came meanwhile.
const BEAT_MS = 100, SILENT_BEATS = 6;
const token = new URLSearchParams(location.hash.slice(1)).get("token");

// A path of this server, with the token where there is one.
export function address(path) {
  return token ? `${path}?token=${encodeURIComponent(token)}` : path;
}

// `listeners`: functions by type of message; beside them `open` and `closed`. `isHeard()`: whether what is shown is new.
export function connect(listeners) {
  const link = { dropped: 0, roundTrip_ms: null, received_ms: null, open: false, send, isHeard };
  let socket = null;
  let number = null, server = null, beats = 0;

  function send(message) {
    if (link.open) socket.send(JSON.stringify(message));
  }

  function isHeard() {
    return link.open && link.received_ms !== null && beats < SILENT_BEATS;
  }

  function take(event) {
    const message = JSON.parse(event.data);
    link.received_ms = performance.now();
    beats = 0;
    if (message.type === "hello") {
      if (message.protocol !== PROTOCOL || (server !== null && message.server !== server)) {
        location.reload();   // another server than before: it may be newer than this page, and have another world
        return;
      }
      server = message.server;
    }
    if (message.type === "pong") link.roundTrip_ms = performance.now() - message.t;
    if (message.type === "state") {
      if (number !== null && message.n > number + 1) link.dropped += message.n - number - 1;
      number = message.n;
    }
    listeners[message.type]?.(message);
  }

  function open() {
    number = null;
    socket = new WebSocket(address(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`));
    socket.onopen = () => { link.open = true; listeners.open(); };
    socket.onmessage = take;
    socket.onclose = () => {
      link.open = false;
      listeners.closed();
      setTimeout(open, 1000);
    };
  }

  open();
  setInterval(() => { ++beats; }, BEAT_MS);
  setInterval(() => send({ type: "ping", t: performance.now() }), 1000);
  return link;
}
