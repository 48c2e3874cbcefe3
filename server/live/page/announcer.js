// Words for who does not see the page. What changes by its figures alone, such as an age, is said once; `again` says it
// even so.
const SAID_MS = 10000;   // after that it need not be found any more

export function createAnnouncer() {
  const place = document.getElementById("said");
  let last = "";
  const announce = (words) => {
    const sense = words.replace(/[0-9.]+/g, "");
    if (sense === last) return;
    last = sense;
    if (!words) return;
    const said = document.createElement("p");
    said.textContent = words;
    place.append(said);
    setTimeout(() => said.remove(), SAID_MS);
  };
  announce.again = (words) => {
    last = "";
    announce(words);
  };
  return announce;
}
