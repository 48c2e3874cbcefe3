// The WebSocket to the server: opened again when it breaks, watched for age and for states that were dropped.
const PROTOCOL = 2;
// A state comes 30 times a second, also while the world is paused. Silence is counted, not read off the clock: a page that was held
// up itself has missed beats too, and has not read yet what came meanwhile.
const BEAT_MS = 100, SILENT_BEATS = 6;
const GIVEN_UP_BEATS = 100;   // as long as the server waits. The system may hold on to a connection that is gone for minutes
const PING_MS = 500, MOST_PINGS = 100, RECENT_PINGS = 6, STEADY_PINGS = 3, RECENT_STATES = 128;
const token = new URLSearchParams(location.hash.slice(1)).get("token");

// A path of this server, with the token where there is one.
export function address(path) {
  return token ? `${path}${path.includes("?") ? "&" : "?"}token=${encodeURIComponent(token)}` : path;
}

// `listeners`: functions by type of message; beside them `open` and `closed`. `isHeard()`: whether what is shown is new.
// `roundTrip_ms()`: from a word to its answer; null before the first. `steadyRoundTrip_ms()`: that of the link, without what a page that
// was held up once added to an answer; 0 before some are known. `way_ms()`: from the server to here, without what waited for this
// page; 0 before it is known. `here_ms(t)`: when the server's time t, in s, was on this page's clock; after the first state.
// `newestAge_ms()`: of the newest message, since it left the server. `refusal`: why the server takes no connection, in words, or null.
export function connect(listeners) {
  const link = { dropped: 0, received_ms: null, open: false, refusal: null, send, isHeard, roundTrip_ms, steadyRoundTrip_ms, way_ms, here_ms, newestAge_ms };
  let socket = null, answered_ms = null, unanswered = [], recent_ms = [];   // pings: how long the newest answered one took; when the others were sent
  let apart_ms = [];   // of the last states: from the server's clock when sent to this page's when read
  let number = null, server = null, beats = 0, waited_beats = 0;   // since the last message; since the last or a try to connect

  function send(message) {
    if (link.open) socket.send(JSON.stringify(message));
  }

  // A ping that is not answered yet has taken longer than the last one as soon as it is older.
  function roundTrip_ms() {
    const waits_ms = unanswered.length ? performance.now() - unanswered[0] : 0;
    return answered_ms === null ? (unanswered.length ? waits_ms : null) : Math.max(answered_ms, waits_ms);
  }

  // The least of the newest: a link that is slow is so for all of them.
  function steadyRoundTrip_ms() {
    return recent_ms.length < STEADY_PINGS ? 0 : Math.min(...recent_ms.slice(-STEADY_PINGS));
  }

  // Half of the least of the last round trips: the others have waited, here or in a queue.
  function way_ms() {
    return recent_ms.length ? Math.min(...recent_ms) / 2 : 0;
  }

  // By the state that came soonest: the others have waited, here or in a queue.
  function here_ms(t) {
    return 1000 * t + Math.min(...apart_ms) - way_ms();
  }

  // Half of the round trip is taken for the way from the server.
  function newestAge_ms() {
    return link.received_ms === null ? Infinity : performance.now() - link.received_ms + (answered_ms ?? 0) / 2;
  }

  function isHeard() {
    return link.open && link.received_ms !== null && beats < SILENT_BEATS;
  }

  function take(event) {
    const message = JSON.parse(event.data);
    link.received_ms = performance.now();
    beats = waited_beats = 0;
    link.refusal = null;
    if (message.type === "hello") {
      if (message.protocol !== PROTOCOL || (server !== null && message.server !== server)) {
        location.reload();   // another server than before: it may be newer than this page, and have another world
        return;
      }
      server = message.server;
    }
    if (message.type === "pong") {
      answered_ms = performance.now() - message.t;
      recent_ms = [...recent_ms, answered_ms].slice(-RECENT_PINGS);
      unanswered = unanswered.filter((sent_ms) => sent_ms > message.t);
    }
    if (message.type === "state") {
      if (number !== null && message.n > number + 1) link.dropped += message.n - number - 1;
      number = message.n;
      apart_ms = [...apart_ms, link.received_ms - 1000 * message.sent].slice(-RECENT_STATES);
    }
    listeners[message.type]?.(message);
  }

  function open() {
    number = null;
    unanswered = [];
    apart_ms = [];
    waited_beats = 0;
    socket = new WebSocket(address(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`));
    socket.onopen = () => { link.open = true; listeners.open(); };
    socket.onmessage = take;
    socket.onclose = closed;
  }
  function closed() {
    if (!link.open) askWhy();
    link.open = false;
    waited_beats = 0;
    listeners.closed();
    setTimeout(open, 1000);
  }
  // A browser does not tell why a WebSocket was refused. A server that was started again may have another token.
  async function askWhy() {
    try {
      const answer = await fetch(address("/worlds"));
      link.refusal = answer.status === 401 ? `The server refuses this page: ${(await answer.text()).trim()}` : null;
    } catch {
      link.refusal = null;   // nobody is there
    }
  }
  function giveUp() {
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    closed();
  }

  open();
  setInterval(() => {
    ++beats;
    if (++waited_beats >= GIVEN_UP_BEATS) giveUp();
  }, BEAT_MS);
  setInterval(() => {
    if (!link.open) return;
    const t = performance.now();
    if (unanswered.length < MOST_PINGS) unanswered.push(t);
    send({ type: "ping", t });
  }, PING_MS);
  return link;
}
