// Checks of what a page shows, evaluated in it: overlaps() and pale() list what is wrong, in words.
//
// overlaps(): elements with text, controls and pictures that cover each other, leave their section or the page, or are cut off. Of what is
// in a list that scrolls the part that shows counts.
// pale(): text whose contrast with what is behind it is below 4.5 : 1 (WCAG 2.2, 1.4.3, with its formula of relative luminance).
// underAlarm(): the tools and labels that an alarm would lie over.
// nameless(): controls without a name. small(): those smaller than 24 x 24 CSS pixels (2.5.8).
(() => {
  const seen = (e) => e.checkVisibility({ visibilityProperty: true, opacityProperty: true }) && e.getClientRects().length > 0;
  const box = (e) => {
    let { left, top, right, bottom } = e.getBoundingClientRect();
    for (let at = e.parentElement; at && !at.matches("section, header, main"); at = at.parentElement) {
      if (!/auto|scroll/.test(getComputedStyle(at).overflowY)) continue;
      const list = at.getBoundingClientRect();
      [left, top, right, bottom] = [Math.max(left, list.left), Math.max(top, list.top), Math.min(right, list.right), Math.min(bottom, list.bottom)];
    }
    return { left, top, right, bottom, width: right - left, height: bottom - top };
  };
  const name = (e) => e.id ? `#${e.id}` : `${e.tagName.toLowerCase()} "${e.textContent.trim().slice(0, 20)}"`;
  const parts = () => [...document.querySelectorAll("header *, main *")]
    .filter((e) => seen(e) && !e.closest("#alarms, option"))
    .filter((e) => e.matches("button, select, input, output, img, svg, #stick, dt, dd, p, h1, .plot canvas, #time-axis, label > span"))
    .filter((e) => { const { width, height } = box(e); return width > 0 && height > 0; });
  window.overlaps = () => {
    const found = [], shown = parts();
    for (let i = 0; i < shown.length; ++i) for (let k = i + 1; k < shown.length; ++k) {
      const [a, b] = [shown[i], shown[k]];
      if (a.contains(b) || b.contains(a) || b.closest("figcaption") || a.closest("figcaption")) continue;
      const p = box(a), q = box(b);
      const w = Math.min(p.right, q.right) - Math.max(p.left, q.left), h = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
      if (w > 1 && h > 1) found.push(`${name(a)} and ${name(b)} by ${w.toFixed(0)} x ${h.toFixed(0)}`);
    }
    for (const e of shown) {
      const section = e.closest("section, header"), p = box(e), q = box(section);
      if (q.width > 0 && (p.left < q.left - 1 || p.right > q.right + 1 || p.top < q.top - 1 || p.bottom > q.bottom + 1)) found.push(`${name(e)} leaves ${name(section)}`);
      if (p.right > innerWidth + 1 || p.left < -1) found.push(`${name(e)} leaves the page`);
      if (!e.matches("select, input") && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0) found.push(`${name(e)} is cut`);
    }
    if (document.documentElement.scrollWidth > innerWidth) found.push(`the page is ${document.documentElement.scrollWidth} wide`);
    return found;
  };
  // The canvas as it was drawn last, once it is drawn: { width, height, data }, RGBA from the top left. A canvas can be read only in the
  // frame in which it was drawn.
  window.canvasPixels = () => new Promise((done) => {
    const canvas = document.getElementById("canvas"), copy = document.createElement("canvas");
    const look = () => {
      copy.width = canvas.width;
      copy.height = canvas.height;
      const pen = copy.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const picture = pen.getImageData(0, 0, copy.width, copy.height);
      if (picture.data.some((value, i) => i % 4 !== 3 && value !== 0)) done(picture); else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  // The contrast between its 70th and its 30th percentile, between two rows as shares of its height: lines alone make none.
  window.canvasContrast = async (from, to) => {
    const { width, height, data } = await canvasPixels(), all = [];
    for (let i = Math.floor(from * height) * width; i < Math.floor(to * height) * width; ++i) all.push(luminance([data[4 * i], data[4 * i + 1], data[4 * i + 2]]));
    all.sort((a, b) => a - b);
    return (all[Math.floor(0.7 * all.length)] + 0.05) / (all[Math.floor(0.3 * all.length)] + 0.05);
  };
  // How many of its pixels are others than in the picture that was kept; none, and that picture is kept, where it has another size.
  let kept = null;
  window.keepCanvas = async () => { kept = await canvasPixels(); return true; };
  window.canvasChanges = async () => {
    const now = await canvasPixels();
    if (now.width !== kept?.width || now.height !== kept.height) { kept = now; return 0; }
    let count = 0;
    for (let i = 0; i < now.data.length; i += 4) count += [0, 1, 2].some((k) => Math.abs(now.data[i + k] - kept.data[i + k]) > 24) ? 1 : 0;
    return count;
  };
  // How many of its pixels have that colour of the page's style, within `off` in each channel.
  window.canvasCount = async (name, off) => {
    const { data } = await canvasPixels(), pen = document.createElement("canvas").getContext("2d");
    pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    pen.fillRect(0, 0, 1, 1);
    const wanted = pen.getImageData(0, 0, 1, 1).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += [0, 1, 2].every((k) => Math.abs(data[i + k] - wanted[k]) <= off) ? 1 : 0;
    return count;
  };
  const sRGB = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const luminance = (c) => 0.2126 * sRGB(c[0] / 255) + 0.7152 * sRGB(c[1] / 255) + 0.0722 * sRGB(c[2] / 255);
  const colour = (text) => {
    const c = text.match(/[\d.]+/g).map(Number), scale = text.startsWith("color(srgb") ? 255 : 1;   // of a mixed colour, from 0 to 1
    return [c[0] * scale, c[1] * scale, c[2] * scale, c[3] ?? 1];
  };
  const over = (c, back) => [0, 1, 2].map((i) => c[i] * c[3] + back[i] * (1 - c[3]));
  const backOf = (e) => {
    const layers = [];
    for (let at = e; at; at = at.parentElement) { layers.push(colour(getComputedStyle(at).backgroundColor)); if (layers.at(-1)[3] === 1) break; }
    return layers.reverse().reduce((under, layer) => over(layer, under), [255, 255, 255]);
  };
  window.pale = () => [...document.querySelectorAll("body *")].filter((e) => seen(e) && [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()))
    .map((e) => {
      const style = getComputedStyle(e), back = backOf(e), ink = over(colour(e.closest("svg") ? style.fill : style.color), back);
      const [a, b] = [luminance(ink), luminance(back)], ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      return ratio < 4.5 ? `${name(e)} ${ratio.toFixed(2)}` : "";
    }).filter(Boolean);
  // A heading that receives the focus of its dialog is no control.
  const controls = () => [...document.querySelectorAll("button, select, input, [tabindex]:not(h2[tabindex='-1'])")].filter(seen);
  window.nameless = () => controls().filter((e) => !(e.ariaLabel || e.textContent.trim() || e.labels?.length)).map(name);
  window.small = () => controls().filter((e) => !e.matches("input") && (e.getBoundingClientRect().width < 24 || e.getBoundingClientRect().height < 24)).map(name);

  window.underAlarm = () => {
    const alarm = document.getElementById("alarm"), before = [alarm.textContent, alarm.hidden];
    alarm.textContent = "Slow link: 0.5 s there and back. What you see is old, and the robot obeys late";
    alarm.hidden = false;
    const a = alarm.getBoundingClientRect();
    const needed = [...document.querySelectorAll("#scene-tools button, #scene-tools p, #view-tools button, figcaption, header button, #driving button")];
    const under = needed.filter(seen).filter((e) => { const b = box(e); return b.left < a.right && a.left < b.right && b.top < a.bottom && a.top < b.bottom; });
    [alarm.textContent, alarm.hidden] = before;
    return under.map(name);
  };
})()
