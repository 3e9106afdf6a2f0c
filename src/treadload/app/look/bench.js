// What the page does by itself: figures, one cursor on the maps, the line of the slice, pictures, flights to a place.
const here = (name) => document.querySelector(`.figure.${name}`);
const maps = () => { const one = here("maps"); return one?._fullLayout ? one : null; };

// The library that draws is large: it comes once the page stands.
let library = null;
const plotly = () => (library ??= import("nicegui-plotly").then(({ Plotly }) => (window.Plotly = Plotly)));
const early = setInterval(() => {
  if (!document.getElementById("bench")) return;
  clearInterval(early);
  document.getElementById("shell")?.remove();
  requestAnimationFrame(() => setTimeout(plotly, 0));
}, 20);

// Of each place, what is to be drawn next, and what is being drawn; figures that are added follow the one they go on.
const next = {}, busy = {};
window.treadloadDraw = (name, text, mark, config, add) => {
  next[name] = [...(add ? next[name] ?? [] : []), { text, mark, config, add }];
  busy[name] ??= drawAll(name).finally(() => { delete busy[name]; });
  return null;
};
// How long the drawing of each figure took, ms, the last time and at best; `benchmarks/page.py` reads it.
const times = (window.treadloadTimes = {});
function took(name, start, letters) {
  const end = performance.now(), { count = 0, least = Infinity } = times[name] ?? {};
  times[name] = { count: count + 1, least: Math.min(least, end - start), last: end - start, end, letters };
}
async function drawAll(name) {
  await plotly();
  while (next[name]?.length) {
    const { text, mark, config, add } = next[name].shift(), place = here(name);
    if (!place) continue;
    const start = performance.now();
    const figure = JSON.parse(text), fresh = !place._fullLayout;
    if (add && !fresh) await Plotly.addTraces(place, figure.data);
    else await Plotly.react(place, figure.data, figure.layout, { ...config, responsive: false });
    if (fresh) begun(name, place);
    if (mark) document.body.setAttribute(`data-${name}`, mark);
    if (name === "maps" && place.layout.shapes?.[0]) lies(place.layout.shapes[0]);
    if (name === "profile" || name === "section") hold(name, figure.held);
    took(add ? `${name} marks` : name, start, text.length);
  }
}
function begun(name, place) {
  new ResizeObserver(() => { if (place.isConnected && place.offsetWidth) Plotly.Plots.resize(place); }).observe(place);
  if (name !== "maps") return;
  window.treadloadLink(place, here("profile"), { ink: "#8a94a0", grids: [] });
  place.on("plotly_relayout", (change) => {
    const line = place.layout.shapes?.[0];
    if (!line || !Object.keys(change).some((key) => key.startsWith("shapes[0]."))) return;
    const { x0, y0, x1, y1 } = line;
    moved({ x0, y0, x1, y1 });
  });
}

// Maps are laid out for a width: the page is told once the window has come to rest at another.
let resting = null;
window.addEventListener("resize", () => {
  clearTimeout(resting);
  resting = setTimeout(() => emitEvent("width", { width: document.querySelector(".centre").clientWidth - 26 }), 400);
});

// The line of the slice. What lies along it is drawn here where the page holds the fields, else it is asked for.
const held = {};
let waiting = null, along = "x", at = 0, lain = null;
function hold(name, fields) {
  if (name === "profile" && !fields) delete held.section;
  held[name] = fields;
  const line = maps()?.layout.shapes?.[0];
  if (fields && line && ["x0", "y0", "x1", "y1"].some((key, n) => Math.abs(line[key] - fields.line[n]) > 1e-6)) slice(line);
}
function slice(line) {
  if (!held.profile) return false;
  if (!waiting) requestAnimationFrame(async () => {
    const cut = waiting, start = performance.now();
    waiting = null;
    await Promise.all([
      held.profile && window.treadloadProfile(here("profile"), held.profile.grids, cut),
      held.section && window.treadloadSection(here("section"), held.section.grids, cut),
    ]);
    took("slice", start, 0);
  });
  waiting = line;
  return true;
}
function moved(wanted) {
  const line = window.treadloadWithin(maps(), wanted, lain);
  if (maps()) window.treadloadLine(maps(), line);
  lies(line);
  const mm = treadloadMillimetres(maps()), ends = Object.entries(line).map(([key, end]) => [key, mm * end]);
  emitEvent("line", { ...Object.fromEntries(ends), drawn: slice(line) });
}
// The slider and the number beside it follow the line, whoever has put it.
function lies({ x0, y0, x1, y1 }) {
  lain = { x0, y0, x1, y1 };
  const slider = document.getElementById("place"), flat = Math.abs(y1 - y0) < 1e-6, upright = Math.abs(x1 - x0) < 1e-6;
  if (!slider) return;
  if (flat || upright) {
    [along, at] = flat ? ["x", y0] : ["y", x0];
    slider.value = at * treadloadMillimetres(maps());
  }
  const [unit, parts] = treadloadMillimetres(maps()) === 1 ? ["mm", 10] : ["in", 100];
  const told = `${flat ? "y" : "x"} ${String(Math.round(parts * at) / parts).replace("-", "−")} ${unit}`;
  document.getElementById("placed").textContent = flat || upright ? told : "aslant";
  slider.setAttribute("aria-valuetext", told);
}
// The line put along travel or across it, at a place, mm.
window.treadloadPut = (change) => {
  const mm = treadloadMillimetres(maps()), half = 160 / mm;
  if ("at" in change) at = change.at / mm;
  along = change.along ?? along;
  const ends = along === "x" ? { x0: -half, y0: at, x1: half, y1: at } : { x0: at, y0: -half, x1: at, y1: half };
  moved(ends);
};

// Results of another case than that of the fields: "all" of them, or the "section", which follows the maps.
let stale = "", edited = false;
function dim() {
  const now = edited ? "all" : stale;
  if (now) document.body.dataset.stale = now; else delete document.body.dataset.stale;
}
window.treadloadEdited = () => { edited = true; dim(); };
window.treadloadStale = (what, typed) => { stale = what; if (typed) edited = false; dim(); };

// The case of a link stands behind "#". It leaves the address once it is read: a page that is loaded again keeps its form.
window.treadloadLinked = () => {
  if (!location.hash.startsWith("#case=")) return "";
  const link = location.hash.slice(1);
  history.replaceState(null, "", location.pathname + location.search);
  return link;
};
window.addEventListener("hashchange", () => { const link = treadloadLinked(); if (link) emitEvent("link", { link }); });
window.treadloadLinkTo = async (link) => {
  const address = `${location.origin}${location.pathname}#${link}`, box = document.getElementById("link");
  box.value = address;
  try { await navigator.clipboard.writeText(address); } catch { /* It stands in the box, selected. */ }
  box.focus();
  box.select();
};

window.treadloadFly = (x, y) => {
  const place = maps(), mm = treadloadMillimetres(place), half = 60 / mm;
  if (!place) return;
  [x, y] = [x / mm, y / mm];
  // A place beyond the map is shown together with the map.
  const map = place._fullData[0], ends = ({ 0: first, length, [length - 1]: last }) => [first, last];
  const [[left, right], [near, far]] = [ends(map.x), ends(map.y)];
  const beyond = x < left || x > right || y < near || y > far;
  const around = (at, low, high) => beyond ? [Math.min(low, at - half), Math.max(high, at + half)] : [at - half, at + half];
  const [top, bottom] = around(y, near, far);
  Plotly.relayout(place, { "xaxis.range": around(x, left, right), "yaxis.range": [bottom, top] });
  place.scrollIntoView({ block: "nearest" });
};
window.treadloadWhole = () => {
  const place = maps();
  if (place) Plotly.relayout(place, { "xaxis.autorange": true, "yaxis.autorange": "reversed" });
};
window.treadloadPicture = async (kind) => {
  const place = maps();
  if (!place) return;
  const size = place.getBoundingClientRect();
  await Plotly.downloadImage(place, { format: kind, width: Math.round(size.width), height: Math.round(size.height),
    scale: kind === "png" ? 2 : 1, filename: "treadload_maps" });
};
window.treadloadThumb = async () => {
  await busy.maps;
  const place = maps();
  if (!place) return "";
  const first = place._fullLayout, box = first.xaxis._length / first.yaxis._length;
  const only = place.data.filter((trace) => (trace.xaxis ?? "x") === "x" && trace.type === "heatmap");
  const axis = { visible: false };
  return await Plotly.toImage({ data: only.map((trace) => ({ ...trace, showscale: false })),
    layout: { width: 144, height: Math.max(40, Math.min(70, Math.round(144 / box))), margin: { l: 0, r: 0, t: 0, b: 0 },
      xaxis: { ...axis, range: first.xaxis.range }, yaxis: { ...axis, range: first.yaxis.range },
      paper_bgcolor: first.paper_bgcolor, plot_bgcolor: first.plot_bgcolor } }, { format: "png" });
};
window.treadloadCopy = (text) => navigator.clipboard?.writeText(text);
