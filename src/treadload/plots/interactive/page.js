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

  if (!below || !load.grids?.length) return;
  maps.on("plotly_relayout", (change) => {
    const key = Object.keys(change).find((one) => one.startsWith("shapes["));
    if (!key) return;
    const cut = maps.layout.shapes[parseInt(key.slice(7), 10)];
    const inside = window.treadloadWithin(maps, cut);
    window.treadloadLine(maps, inside);
    window.treadloadProfile(below, load.grids, inside);
  });
};

// Millimetres of a unit of a figure's axes: figures are drawn in millimetres or in inches, as their titles state.
window.treadloadMillimetres = (place) => /\(in\)/.test(place?.layout?.xaxis?.title?.text ?? "") ? 25.4 : 1;

// A line {x0, y0, x1, y1}, in the unit of a map, inside the outer edges of a map: one that was moved as a whole (as long as the line
// before, and in its direction) comes back as a whole, else its ends do. One of no length gives way to the line before.
window.treadloadWithin = (maps, line, before = null) => {
  const drawn = (maps?._fullData ?? []).find((trace) => trace.type === "heatmap" && trace.visible === true);
  if (!drawn?.x?.length || !drawn?.y?.length) return line;
  const inside = { x0: line.x0, y0: line.y0, x1: line.x1, y1: line.y1 };
  const same = (key) => before && Math.abs(line[`${key}1`] - line[`${key}0`] - before[`${key}1`] + before[`${key}0`]) < 1e-6;
  const whole = same("x") && same("y");
  for (const key of ["x", "y"]) {
    const edges = drawn[key], low = edges[0], high = edges[edges.length - 1];
    const [first, end] = [`${key}0`, `${key}1`];
    const least = Math.min(line[first], line[end]), most = Math.max(line[first], line[end]);
    const shift = whole && most - least <= high - low ? Math.max(0, low - least) - Math.max(0, most - high) : 0;
    for (const one of [first, end]) inside[one] = Math.min(high, Math.max(low, line[one] + shift));
  }
  return Math.hypot(inside.x1 - inside.x0, inside.y1 - inside.y0) > 1e-6 ? inside : before ?? line;
};

// Puts the line of a cut elsewhere on all maps. Plotly would draw the whole figure anew for it.
window.treadloadLine = (maps, { x0, y0, x1, y1 }) => {
  const full = maps._fullLayout;
  (maps.layout.shapes ?? []).forEach((shape, n) => {
    if (shape.name !== "cut") return;
    const own = full.shapes[n], name = (ref) => ref.replace(/^([xy])/, "$1axis");
    Object.assign(shape, { x0, y0, x1, y1 });
    Object.assign(own, { x0, y0, x1, y1 });
    const xa = full[name(own.xref)], ya = full[name(own.yref)];
    const at = (x, y) => [xa._offset + xa.d2p(x), ya._offset + ya.d2p(y)], start = at(x0, y0), end = at(x1, y1);
    // The line, and what plotly lays over it to be caught by the mouse: a broader one and its two ends.
    for (const one of maps.querySelectorAll(`.shapelayer path[data-index="${n}"], .shapelayer [data-index="${n}"] path`))
      one.setAttribute("d", `M${start}L${end}`);
    maps.querySelectorAll(`.shapelayer [data-index="${n}"] circle`).forEach((one) => {
      const [cx, cy] = one.dataset.linePoint === "start-point" ? start : end;
      one.setAttribute("cx", cx);
      one.setAttribute("cy", cy);
    });
  });
};

// What the page holds of fields over x and y, and reads along a line: `plots/interactive/browser_grids.py` says what a grid is.
(() => {
  const decoded = new WeakMap();
  const floats = (text) => {
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let k = 0; k < letters.length; k++) bytes[k] = letters.charCodeAt(k);
    return new Float32Array(bytes.buffer);
  };
  const fieldsOf = (grid) => decoded.get(grid) ?? decoded.set(grid, grid.fields.map(floats)).get(grid);
  const between = (at, c) => {
    const n = c.length, h = n > 1 ? (c[1] - c[0]) / 2 : 0.5, t = n > 1 ? (c[n - 1] - c[n - 2]) / 2 : 0.5;
    if (at < c[0] - h - 1e-6 || at > c[n - 1] + t + 1e-6) return null;
    let low = 0, high = n - 1;
    while (high - low > 1) { const m = (low + high) >> 1; if (c[m] <= at) low = m; else high = m; }
    const share = n > 1 ? Math.min(1, Math.max(0, (at - c[low]) / (c[high] - c[low]))) : 0;
    return [low, high, share];
  };
  // Where along a cut {x0, y0, x1, y1} the fields of a grid are read, and what they say there.
  function along(grid, cut) {
    const fields = fieldsOf(grid), nx = grid.x.length, length = Math.hypot(cut.x1 - cut.x0, cut.y1 - cut.y0);
    const level = Math.abs(cut.y1 - cut.y0) < 1e-9, upright = Math.abs(cut.x1 - cut.x0) < 1e-9;
    const ends = level ? [cut.x0, cut.x1] : [cut.y0, cut.y1];
    let centres = grid.smooth || !(level || upright) ? [] : (level ? grid.x : grid.y);
    centres = centres.filter((one) => one >= Math.min(...ends) && one <= Math.max(...ends));
    const own = centres.length > 1;
    const count = own ? centres.length : Math.max(2, Math.min(1200, Math.ceil(length / grid.step - 1e-9) + 1));
    const at = [], rows = fields.map(() => new Array(count));
    for (let k = 0; k < count; k++) {
      const s = own ? (centres[k] - ends[0]) / (ends[1] - ends[0]) : k / (count - 1);
      const x = cut.x0 + s * (cut.x1 - cut.x0), y = cut.y0 + s * (cut.y1 - cut.y0);
      at.push(level ? x : upright ? y : s * length);
      const i = between(x, grid.x), j = between(y, grid.y);
      const a = i && j && (grid.smooth ? j[0] * nx : (j[2] < 0.5 ? j[0] : j[1]) * nx + (i[2] < 0.5 ? i[0] : i[1]));
      fields.forEach((field, n) => {
        if (!i || !j) rows[n][k] = null;
        else if (!grid.smooth) rows[n][k] = field[a];
        else {
          const row = (b) => field[b + i[0]] * (1 - i[2]) + field[b + i[1]] * i[2];
          rows[n][k] = row(a) * (1 - j[2]) + row(j[1] * nx) * j[2];
        }
      });
    }
    return { at, rows };
  }
  const said = (place, cut) => {
    const unit = window.treadloadMillimetres(place) === 1 ? "mm" : "in";
    const digits = (v, least) => unit === "mm" ? least : least + (Math.abs(v) < 10 ? 2 : 1);
    const num = (v, least) => (v.toFixed(digits(v, least)).replace(/^-(0(\.0*)?)$/, "$1")).replace("-", "\u2212");
    if (Math.abs(cut.y1 - cut.y0) < 1e-9) return `x, direction of travel (${unit}), at y = ${num(cut.y0, 1)} ${unit}`;
    if (Math.abs(cut.x1 - cut.x0) < 1e-9) return `y, right of travel (${unit}), at x = ${num(cut.x0, 1)} ${unit}`;
    const end = (x, y) => `x = ${num(x, 0)}, y = ${num(y, 0)} ${unit}`;
    return `from ${end(cut.x0, cut.y0)} to ${end(cut.x1, cut.y1)}, distance (${unit})`;
  };
  const axis = (place, cut, at) =>
    ({ "xaxis.title.text": said(place, cut), "xaxis.range": [at[0], at[at.length - 1]] });

  window.treadloadProfile = (place, grids, cut) => {
    if (!(Math.hypot(cut.x1 - cut.x0, cut.y1 - cut.y0) > 0)) return null;
    const parts = grids.map((grid) => along(grid, cut));
    const x = parts.flatMap(({ at, rows }) => rows.map(() => at)), y = parts.flatMap(({ rows }) => rows);
    return Plotly.update(place, { x, y }, axis(place, cut, parts[0].at), y.map((_, n) => n));
  };
  window.treadloadSection = (place, grids, cut) => {
    if (!(Math.hypot(cut.x1 - cut.x0, cut.y1 - cut.y0) > 0)) return null;
    const { at, rows } = along(grids[0], cut), last = at.length - 1;
    const sides = at.map((one, n) => (n ? (at[n - 1] + one) / 2 : one - (at[1] - one) / 2));
    sides.push(at[last] + (at[last] - at[last - 1]) / 2);
    // Rows between the depths, of one layer each: `plots/interactive/section_rows.py`.
    const z = grids[0].rows.map(([low, high, share]) => rows[low].map((value, n) =>
      value === null || rows[high][n] === null ? null : value * (1 - share) + rows[high][n] * share));
    return Plotly.update(place, { x: [sides], z: [z] }, axis(place, cut, at), [0]);
  };
})();
