// Links the maps of a page: one cursor on all of them, a line that is dragged and what lies along it.
window.treadloadLink = function (maps, below, load) {
  const axisNames = (gd) => Object.keys(gd._fullLayout).filter((k) => /^xaxis[0-9]*$/.test(k));
  const lines = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  lines.setAttribute("style", "position:absolute;left:0;top:0;width:100%;height:100%;pointer-events:none");
  lines.setAttribute("class", "tl-cursor");
  maps.style.position = "relative";
  maps.appendChild(lines);

  function cursor(x, y) {
    lines.replaceChildren();
    if (x === null) return;
    for (const name of axisNames(maps)) {
      const xa = maps._fullLayout[name], ya = maps._fullLayout[name.replace("x", "y")];
      if (!ya) continue;
      const px = xa._offset + xa.d2p(x), py = ya._offset + ya.d2p(y);
      const box = [xa._offset, ya._offset, xa._offset + xa._length, ya._offset + ya._length];
      for (const [a, b, c, d] of [[box[0], py, box[2], py], [px, box[1], px, box[3]]]) {
        if (a < box[0] - 1 || a > box[2] + 1 || b < box[1] - 1 || b > box[3] + 1) continue;
        const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
        for (const [key, value] of Object.entries({ x1: a, y1: b, x2: c, y2: d, stroke: load.ink,
          "stroke-width": 1, "stroke-dasharray": "3 3", opacity: 0.8 })) line.setAttribute(key, value);
        lines.appendChild(line);
      }
    }
  }
  let hovering = false;
  maps.on("plotly_hover", (event) => {
    const point = event.points[0];
    if (hovering || !point || point.z === undefined) return;
    cursor(point.x, point.y);
    const others = maps._fullData
      .map((trace, number) => ({ trace, number }))
      .filter(({ trace }) => trace.type === "heatmap" && trace.visible === true)
      .map(({ number }) => ({ curveNumber: number, xval: point.x, yval: point.y }));
    hovering = true;
    const subplots = [...new Set(others.map(({ curveNumber: n }) =>
      (maps._fullData[n].xaxis || "x") + (maps._fullData[n].yaxis || "y")))];
    try { Plotly.Fx.hover(maps, others, subplots); } finally { hovering = false; }
  });
  maps.on("plotly_unhover", () => { if (!hovering) cursor(null); });

  if (!below || !load.fields.length) return;
  const floats = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const fields = load.fields.map(floats), nx = load.x.length, ny = load.y.length;
  const between = (at, c) => {
    const n = c.length, h = n > 1 ? (c[1] - c[0]) / 2 : 0.5, t = n > 1 ? (c[n - 1] - c[n - 2]) / 2 : 0.5;
    if (at < c[0] - h - 1e-6 || at > c[n - 1] + t + 1e-6) return null;
    let low = 0, high = n - 1;
    while (high - low > 1) { const m = (low + high) >> 1; if (c[m] <= at) low = m; else high = m; }
    const share = n > 1 ? Math.min(1, Math.max(0, (at - c[low]) / (c[high] - c[low]))) : 0;
    return [low, high, share];
  };
  function sample(field, x, y) {
    const i = between(x, load.x), j = between(y, load.y);
    if (!i || !j) return NaN;
    if (!load.smooth) return field[(j[2] < 0.5 ? j[0] : j[1]) * nx + (i[2] < 0.5 ? i[0] : i[1])];
    const row = (k) => field[k * nx + i[0]] * (1 - i[2]) + field[k * nx + i[1]] * i[2];
    return row(j[0]) * (1 - j[2]) + row(j[1]) * j[2];
  }
  window.treadloadSample = (n, x, y) => sample(fields[n], x, y);

  function draw(cut) {
    const length = Math.hypot(cut.x1 - cut.x0, cut.y1 - cut.y0);
    if (!(length > 0)) return;
    let count = Math.max(2, Math.min(800, Math.ceil(length / load.step) + 1));
    const along = Math.abs(cut.y1 - cut.y0) < 1e-9, across = Math.abs(cut.x1 - cut.x0) < 1e-9;
    const ends = along ? [cut.x0, cut.x1] : [cut.y0, cut.y1];
    let centres = load.smooth || !(along || across) ? [] : (along ? load.x : load.y);
    centres = centres.filter((one) => one >= Math.min(...ends) && one <= Math.max(...ends));
    if (centres.length < 2) centres = null; else count = centres.length;
    const at = [], rows = fields.map(() => []);
    for (let k = 0; k < count; k++) {
      const s = centres ? (centres[k] - ends[0]) / (ends[1] - ends[0]) : k / (count - 1);
      const x = cut.x0 + s * (cut.x1 - cut.x0), y = cut.y0 + s * (cut.y1 - cut.y0);
      at.push(along ? x : across ? y : s * length);
      fields.forEach((field, n) => rows[n].push(sample(field, x, y)));
    }
    const mm = (v) => v.toFixed(0).replace("-", "\u2212");
    const said = along ? `x, direction of travel (mm), at y = ${mm(cut.y0)} mm`
      : across ? `y, right of travel (mm), at x = ${mm(cut.x0)} mm`
      : `from (${mm(cut.x0)}, ${mm(cut.y0)}) to (${mm(cut.x1)}, ${mm(cut.y1)}) mm, distance (mm)`;
    Plotly.update(below, { x: rows.map(() => at), y: rows },
      { "xaxis.title.text": said, "xaxis.range": [at[0], at[count - 1]] }, rows.map((_, n) => n));
  }
  let busy = false;
  maps.on("plotly_relayout", (change) => {
    const key = Object.keys(change).find((one) => one.startsWith("shapes["));
    if (busy || !key) return;
    const from = parseInt(key.slice(7), 10), shapes = maps.layout.shapes, cut = shapes[from], moved = {};
    shapes.forEach((shape, n) => {
      if (n !== from && shape.name === "cut") for (const key of ["x0", "y0", "x1", "y1"]) moved[`shapes[${n}].${key}`] = cut[key];
    });
    busy = true;
    Plotly.relayout(maps, moved).finally(() => { busy = false; });
    draw(cut);
  });
};
