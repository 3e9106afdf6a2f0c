// What the page does by itself: one cursor on the maps, marks of what is drawn, pictures, flights to a place.
import { Plotly } from "nicegui-plotly";

window.Plotly = Plotly;
const maps = () => document.querySelector(".maps.js-plotly-plot");
let linked = null;

function attach() {
  const here = maps();
  if (!here || !here._fullLayout || !here.on) return;
  if (linked !== here) {
    linked = here;
    const below = document.querySelector(".profile.js-plotly-plot");
    window.treadloadLink(here, below, { ink: "#8a94a0", fields: [], x: [], y: [], step: 1, smooth: true });
    here.on("plotly_afterplot", mark);
    mark();
  }
}
function mark() {
  const meta = linked?.layout?.meta;
  if (meta) document.body.dataset.drawn = meta.stamp;
}
setInterval(attach, 40);

window.treadloadFly = (x, y) => {
  const here = maps();
  if (!here) return;
  const half = 60;
  Plotly.relayout(here, { "xaxis.range": [x - half, x + half], "yaxis.range": [y + half, y - half] });
  here.scrollIntoView({ block: "nearest" });
};
window.treadloadWhole = () => {
  const here = maps();
  const data = here.data.filter((trace) => trace.type === "heatmap")[0];
  if (data) Plotly.relayout(here, { "xaxis.autorange": true, "yaxis.autorange": "reversed" });
};
window.treadloadPicture = async (kind) => {
  const here = maps();
  if (!here) return;
  const size = here.getBoundingClientRect();
  await Plotly.downloadImage(here, { format: kind, width: Math.round(size.width), height: Math.round(size.height),
    scale: kind === "png" ? 2 : 1, filename: "treadload_maps" });
};
window.treadloadThumb = async () => {
  const here = maps();
  if (!here) return "";
  const first = here._fullLayout, box = first.xaxis._length / first.yaxis._length;
  const only = here.data.filter((trace) => (trace.xaxis ?? "x") === "x" && trace.type === "heatmap");
  const axis = { visible: false };
  return await Plotly.toImage({ data: only.map((trace) => ({ ...trace, showscale: false })),
    layout: { width: 144, height: Math.max(40, Math.min(70, Math.round(144 / box))), margin: { l: 0, r: 0, t: 0, b: 0 },
      xaxis: { ...axis, range: first.xaxis.range }, yaxis: { ...axis, range: first.yaxis.range },
      paper_bgcolor: first.paper_bgcolor, plot_bgcolor: first.plot_bgcolor } }, { format: "png" });
};
window.treadloadCopy = (text) => navigator.clipboard?.writeText(text);
