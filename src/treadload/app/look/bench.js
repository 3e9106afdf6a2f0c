// What the page does by itself: figures, one cursor on the maps, the line of the slice, pictures, flights to a place.
const here = (name) => document.querySelector(`.figure.${name}`);
const maps = () => { const one = here("maps"); return one?._fullLayout ? one : null; };

// The library that draws is large: it comes once the page stands.
let library = null;
const plotly = () => (library ??= import("nicegui-plotly").then(({ Plotly }) => (window.Plotly = Plotly)));
const early = setInterval(() => {
  if (!document.getElementById("bench")) return;
  clearInterval(early);
  requestAnimationFrame(() => setTimeout(plotly, 0));
}, 20);

// Of each place, what is to be drawn next, and what is being drawn.
const next = {}, busy = {};
window.treadloadDraw = (name, text, mark, config) => {
  next[name] = { text, mark, config };
  busy[name] ??= drawAll(name).finally(() => { delete busy[name]; });
  return null;
};
async function drawAll(name) {
  await plotly();
  while (next[name]) {
    const { text, mark, config } = next[name], place = here(name);
    delete next[name];
    if (!place) continue;
    const figure = JSON.parse(text), fresh = !place._fullLayout;
    await Plotly.react(place, figure.data, figure.layout, { ...config, responsive: false });
    if (fresh) begun(name, place);
    if (mark) document.body.setAttribute(`data-${name}`, mark);
  }
}
function begun(name, place) {
  new ResizeObserver(() => { if (place.isConnected && place.offsetWidth) Plotly.Plots.resize(place); }).observe(place);
  if (name !== "maps") return;
  window.treadloadLink(place, here("profile"), { ink: "#8a94a0", fields: [], x: [], y: [], step: 1, smooth: true });
  place.on("plotly_relayout", (change) => {
    const line = place.layout.shapes?.[0];
    if (putting || !line || !Object.keys(change).some((key) => key.startsWith("shapes[0]."))) return;
    emitEvent("line", { x0: line.x0, y0: line.y0, x1: line.x1, y1: line.y1 });
  });
}

// The line of the slice, put by the page; what the page says itself it need not hear.
let putting = 0;
window.treadloadLine = (ends) => {
  const place = maps(), told = {};
  (place?.layout.shapes ?? []).forEach((_, n) => {
    for (const [key, value] of Object.entries(ends)) told[`shapes[${n}].${key}`] = value;
  });
  if (!Object.keys(told).length) return;
  putting += 1;
  Plotly.relayout(place, told).finally(() => { putting -= 1; });
};

window.treadloadFly = (x, y) => {
  const place = maps(), half = 60;
  if (!place) return;
  Plotly.relayout(place, { "xaxis.range": [x - half, x + half], "yaxis.range": [y + half, y - half] });
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
