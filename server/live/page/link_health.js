// Whether what is shown is still true: the age of the newest message, states that were dropped, the round trip.
export function createLinkHealth(world, link) {
  const chip = document.getElementById("link"), notice = document.getElementById("notice");
  let refused_ms = -1e9;

  function update() {
    const age_ms = link.received_ms === null ? Infinity : performance.now() - link.received_ms;
    const bad = !link.isHeard();
    let text = "not connected";
    if (link.open) {
      const others = world.viewers > 1 ? ` \u00b7 ${world.viewers} viewers` : "";
      text = bad ? `no news for ${(age_ms / 1000).toFixed(1)} s` : `live \u00b7 ${(link.roundTrip_ms ?? 0).toFixed(0)} ms \u00b7 ${link.dropped} dropped${others}`;
    }
    if (chip.textContent !== text) chip.textContent = text;
    chip.dataset.state = bad ? "bad" : "good";
    chip.title = "Round trip, states that were dropped because this browser or the link is slow, viewers";
    if (performance.now() > refused_ms + 5000 && !bad) notice.hidden = true;
    if (bad && link.received_ms !== null) {
      notice.textContent = "This view is out of date: the server does not answer";
      notice.hidden = false;
    }
  }
  setInterval(update, 200);
  return {
    refused(reason) {
      refused_ms = performance.now();
      notice.textContent = reason;
      notice.hidden = false;
    },
  };
}
