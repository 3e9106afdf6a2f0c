"""A line across a map: profiles along it and the section below it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.largest import index_of_largest
from treadload.plots.interactive.drawing import Trace, figure
from treadload.plots.interactive.section_rows import SectionRows
from treadload.plots.interactive.theme import Theme, colour_scale, theme_of
from treadload.plots.kit.layers import Layers
from treadload.plots.kit.plan import DEPTH_LABEL, KPA, MM, Plan, edges, fields_of, limits, plane
from treadload.plots.kit.shown import shown
from treadload.plots.kit.style import signed
from treadload.plots.response import VARIABLE

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

# Points on a line: two a cell, and no more.
_MOST_POINTS = 1200
_HEIGHT, _SECTION_HEIGHT = 300, 330


@dataclass(frozen=True)
class Cut:
    """A line on the road from a start to an end, x and y in m. Raises InputError where it has no length."""

    start: tuple[float, float]
    end: tuple[float, float]

    def __post_init__(self) -> None:
        numbers = (*self.start, *self.end)
        if not all(math.isfinite(number) for number in numbers) or not self.length > 0:
            raise InputError(f"a cut needs two points that differ, got {self.start} and {self.end} m")

    @classmethod
    def along(cls, source: Source, y: float | None = None) -> Cut:
        """Along travel over a whole map, at a y in m, through its largest value if left out."""
        plan = Plan.of(fields_of(source))
        at = _largest(source)[1] if y is None else y
        return cls((plan.x_edges[0] / MM, at), (plan.x_edges[-1] / MM, at))

    @classmethod
    def across(cls, source: Source, x: float | None = None) -> Cut:
        """Across travel over a whole map, at an x in m, through its largest value if left out."""
        plan = Plan.of(fields_of(source))
        at = _largest(source)[0] if x is None else x
        return cls((at, plan.y_edges[0] / MM), (at, plan.y_edges[-1] / MM))

    def within(self, source: Source) -> Cut:
        """The line with each end inside the outer edges of a map; through its largest value where nothing is left."""
        plan = Plan.of(fields_of(source))
        first, last = (
            tuple(
                float(min(max(at, side[0] / MM), side[-1] / MM))
                for at, side in zip(end, (plan.x_edges, plan.y_edges), strict=True)
            )
            for end in (self.start, self.end)
        )
        return type(self).along(source) if first == last else Cut((first[0], first[1]), (last[0], last[1]))

    @property
    def length(self) -> float:
        """M."""
        return math.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    @property
    def start_mm(self) -> tuple[float, float]:
        """Start in mm."""
        return self.start[0] * MM, self.start[1] * MM

    @property
    def end_mm(self) -> tuple[float, float]:
        """End in mm."""
        return self.end[0] * MM, self.end[1] * MM

    def points(self, spacing: float) -> tuple[Array, Array, Array]:
        """Where along the line, x and y, all in m, of points at most `spacing` apart; ends included."""
        count = int(min(_MOST_POINTS, max(2, math.ceil(self.length / spacing - 1e-9) + 1)))
        share = np.linspace(0.0, 1.0, count)
        x, y = (a + share * (b - a) for a, b in zip(self.start, self.end, strict=True))
        return share * self.length, x, y

    def cells(self, data: xr.Dataset) -> tuple[Array, Array, Array]:
        """The same for the cells of a map: their centres on a line along or across travel, else points close by."""
        for axis, name in ((1, "x"), (0, "y")):
            if self.start[axis] == self.end[axis]:
                low, high = sorted((self.start[1 - axis], self.end[1 - axis]))
                at = data[name].to_numpy()
                at = at[(at >= low) & (at <= high)]
                if len(at) > 1:
                    fixed = np.full(len(at), self.start[axis])
                    return (at - low, at, fixed) if name == "x" else (at - low, fixed, at)
        return self.points(_step(data) / 4)

    def axis(self, where: Array, x: Array, y: Array) -> tuple[Array, str]:
        """What a figure along the line counts, mm, and its label: x, y, or the distance from the start."""
        if self.start[1] == self.end[1]:
            return x * MM, f"x, direction of travel (mm), at y = {signed(self.start[1] * MM)} mm"
        if self.start[0] == self.end[0]:
            return y * MM, f"y, right of travel (mm), at x = {signed(self.start[0] * MM)} mm"
        ends = [signed(number, 0) for number in (*self.start_mm, *self.end_mm)]
        return where * MM, "from x = {}, y = {} mm to x = {}, y = {} mm, distance (mm)".format(*ends)


def sampled(values: Array, x: Array, y: Array, at_x: Array, at_y: Array, *, smooth: bool) -> Array:
    """Values (..., ny, nx) at points: of the cell they lie in, or smooth between the centres; NaN beyond the map.

    x (nx,), y (ny,), at_x, at_y: in one unit. Ends reach half a cell beyond the outer centres.
    """
    sides = (edges(y), edges(x))
    inside = np.ones(np.shape(at_x), dtype=bool)
    for side, at in zip(sides, (at_y, at_x), strict=True):
        inside &= (at >= side[0] - 1e-9) & (at <= side[-1] + 1e-9)
    if not smooth:
        row, column = (np.clip(np.searchsorted(side, at, side="right") - 1, 0, len(side) - 2)
                       for side, at in zip(sides, (at_y, at_x), strict=True))  # fmt: skip
        return np.where(inside, values[..., row, column], np.nan)
    (low_y, share_y), (low_x, share_x) = _between(y, at_y), _between(x, at_x)
    high_y, high_x = np.minimum(low_y + 1, len(y) - 1), np.minimum(low_x + 1, len(x) - 1)
    upper = values[..., low_y, low_x] * (1 - share_x) + values[..., low_y, high_x] * share_x
    lower = values[..., high_y, low_x] * (1 - share_x) + values[..., high_y, high_x] * share_x
    return np.where(inside, upper * (1 - share_y) + lower * share_y, np.nan)


def profiles(
    source: Source,
    cut: Cut,
    *,
    overlaid: Mapping[str, Source] | None = None,
    names: Mapping[str, str] | None = None,
    theme: str | Theme = "light",
) -> Figure:
    """Profiles along a line, as a Figure of plotly.

    source: a contact (pressure, shear, friction times pressure, cell by cell, kPa) or a response (largest extension
    at every depth, microstrain, between its points). overlaid: label → measured footprints or other contacts, whose
    pressure is drawn with it. names: variable → label of what is drawn instead. Returns the figure.
    """
    look = theme_of(theme)
    data = fields_of(source)
    traces, unit, label = _curves(data, cut, look, names)
    for number, (words, overlay) in enumerate((overlaid or {}).items()):
        over = fields_of(overlay, "pressure")
        where, x, y = cut.cells(over)
        values = sampled(np.nan_to_num(plane(over, "pressure")), *_centres(over), x, y, smooth=False) * KPA
        at, _ = cut.axis(where, x, y)
        colour = look.cases[(2 + number) % len(look.cases)]
        traces.append(_curve(at, values, words, colour, "kPa", steps=True, width=2.2))
    return figure(traces, _profile_layout(label, unit), look)


def depth_slice(
    response: Source,
    cut: Cut | None = None,
    name: str = "principal_strain_1",
    *,
    theme: str | Theme = "light",
    height: float = _SECTION_HEIGHT,
    whole: bool = False,
) -> Figure:
    """A vertical section of a response below a line, as a Figure of plotly, as wide as its place.

    response: over (depth, y, x), or over (depth, point) where the points follow a line. cut: of a map of two
    dimensions; left out, the line on which the response stands. name: of a variable over the depth. whole: True for
    colours that reach over the whole response, so that they stay while a line moves. Values are linear in depth
    between the depths of a layer; colours stop at interfaces, where stress and strain jump. Depths have a scale of
    their own, so that x is that of the profile above. Returns the figure. Raises InputError with fewer than two
    depths, or without a line.
    """
    look = theme_of(theme)
    data = dataset_of(response)
    if name not in data:
        raise InputError(f"this section needs {name}; the dataset has {', '.join(map(str, data.data_vars))}")
    if data.sizes.get("depth", 1) < 2:
        raise InputError("a section needs at least two depths; solve the response at more depths")
    # Sorting copies whatever is in it.
    data = data[[key for key in data if key == name or not {"x", "y", "point"} & set(data[key].dims)]].sortby("depth")
    at, label, values = _below(data, name, cut)
    display = shown(data[name])
    values = values * display.factor
    reach = data[name].to_numpy() * display.factor if whole else values
    trace, shapes = section_trace(at, values, data, name, display.unit, look, reach)
    words = str(data[name].attrs.get("long_name", display.words))
    bar = {
        "title": {"text": display.unit if display.unit != "–" else "", "side": "right", "font": {"size": 11}},
        "thickness": 11, "outlinecolor": look.rule, "outlinewidth": 0.7, "orientation": "h", "tickfont": {"size": 10},
        "x": 1.0, "xanchor": "right", "y": 1.02, "yanchor": "bottom", "len": 0.42, "nticks": 6,
    }  # fmt: skip
    layout = {
        "height": height, "margin": {"l": 62, "r": 18, "t": 46, "b": 46}, "shapes": shapes,
        "title": {"text": f"<b>{words[:1].upper()}{words[1:]}</b>", "x": 0.01, "font": {"size": 13}},
        "xaxis": {"title": {"text": label}, "range": [float(at[0]), float(at[-1])]},
        "yaxis": {"title": {"text": f"{DEPTH_LABEL}, own scale"}, "autorange": "reversed"},
        "uirevision": "section",
    }  # fmt: skip
    return figure([{**trace, "colorbar": bar}], layout, look)


def section_trace(
    at: Array, values: Array, data: xr.Dataset, name: str, unit: str, look: Theme, reach: Array
) -> tuple[Trace, list[Trace]]:
    """A section and lines of its interfaces.

    at: (n,), mm. values: (nz, n) of the variable, in the unit. reach: values that the colours reach over.
    """
    layers = Layers.of(data)
    rows = SectionRows.of(data["depth"].to_numpy() * MM, layers)
    finite = reach[np.isfinite(reach)]
    both = name not in VARIABLE.values() and float(finite.min(initial=0.0)) < 0
    scale = limits(np.abs(finite) if both else finite)
    trace: Trace = {
        "type": "heatmap", "x": edges(at), "y": rows.edges, "z": rows.between(values).astype(np.float32),
        "hoverongaps": False,
        "colorscale": colour_scale("signed" if both else "strain", look.name),
        "zmin": -scale.high if both else 0.0, "zmax": scale.high, "name": "section",
        "hovertemplate": f"%{{x:.1f}} mm, %{{y:.1f}} mm deep<br>%{{z:.4~g}} {unit}<extra></extra>",
    }  # fmt: skip
    lines = [
        {"type": "line", "xref": "x domain", "x0": 0, "x1": 1, "y0": depth, "y1": depth,
         "line": {"color": look.ink, "width": 1.2}, "name": "interface"}
        for depth in layers.interfaces if depth < rows.edges[-1]
    ]  # fmt: skip
    return trace, lines


def _below(data: xr.Dataset, name: str, cut: Cut | None) -> tuple[Array, str, Array]:
    """Places along a line, mm, its label, values (nz, n) below it."""
    if "point" in data.dims:
        x, y = (data[axis].to_numpy() for axis in ("x", "y"))
        where = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        line = Cut((float(x[0]), float(y[0])), (float(x[-1]), float(y[-1])))
        at, label = line.axis(where, x, y)
        return at, label, np.asarray(data[name].transpose("depth", "point").to_numpy(), dtype=float)
    field = np.asarray(data[name].transpose("depth", "y", "x").to_numpy(), dtype=float)
    for across, axis, words in (("y", 1, "x, direction of travel"), ("x", 2, "y, right of travel")):
        if data.sizes[across] == 1 and data.sizes["x" if across == "y" else "y"] > 1:
            at = data["x" if across == "y" else "y"].to_numpy() * MM
            return (
                at,
                f"{words} (mm), at {across} = {signed(float(data[across][0]) * MM)} mm",
                np.take(field, 0, axis),
            )
    if cut is None:
        raise InputError(
            "a section of a response in plan needs a cut: Cut.along(response), Cut.across(response) or any"
        )
    where, x, y = cut.points(_step(data) / 2)
    at, label = cut.axis(where, x, y)
    return at, label, sampled(field, *_centres(data), x, y, smooth=True)


def _curves(data: xr.Dataset, cut: Cut, look: Theme, names: Mapping[str, str] | None) -> tuple[list[Trace], str, str]:
    """Curves of a contact or a response along a line, their unit and the label of the line."""
    contact = "pressure" in data
    where, x, y = cut.cells(data) if contact else cut.points(_step(data) / 2)
    at, label = cut.axis(where, x, y)
    traces: list[Trace] = []
    if names is None and contact:
        read = {
            name: sampled(np.nan_to_num(plane(data, name)), *_centres(data), x, y, smooth=False)
            for name in ("pressure", "traction_x", "traction_y", "state", "friction_coefficient")
            if name in data
        }
        traces.append(_curve(at, read["pressure"] * KPA, "pressure", look.ink, "kPa", steps=True, fill=True))
        mu = read.get("friction_coefficient", float(data["friction"]) if "friction" in data else None)
        if mu is not None:
            bound = _curve(at, mu * read["pressure"] * KPA, "friction × pressure", look.muted, "kPa", steps=True)
            bound["line"]["dash"] = "dot"
            traces.append(bound)
        if "traction_x" in read and "traction_y" in read:
            shear = np.hypot(read["traction_x"], read["traction_y"]) * KPA
            traces.append(_curve(at, shear, "shear, where it sticks", look.stick, "kPa", steps=True))
            if "state" in read:
                slipping = np.where(read["state"] == 2, shear, np.nan)
                traces.append(_curve(at, slipping, "shear, where it slips", look.slip, "kPa", steps=True, width=2.6))
        return traces, "kPa", label
    chosen = (
        dict(names) if names is not None else {VARIABLE["principal"]: "in space", VARIABLE["in-plane"]: "in plane"}
    )
    unit = ""
    for number, (name, words) in enumerate(chosen.items()):
        if name not in data:
            raise InputError(f"this profile needs {name}; the dataset has {', '.join(map(str, data.data_vars))}")
        display = shown(data[name])
        unit = unit or display.unit
        rows = range(data.sizes["depth"]) if "depth" in data[name].dims else [None]
        for row in rows:
            sheet = data[name] if row is None else data[name].isel(depth=row)
            field = np.asarray(sheet.transpose("y", "x").to_numpy(), dtype=float) * display.factor
            text = words if row is None else f"{words}, {MM * float(data['depth'][row]):g} mm deep"
            values = sampled(field, *_centres(data), x, y, smooth=not contact)
            curve = _curve(at, values, text, look.cases[(row or 0) % len(look.cases)], display.unit, steps=contact)
            curve["line"]["dash"] = ("solid", "dash", "dot")[number % 3]
            traces.append(curve)
    return traces, unit, label


def _curve(
    at: Array, values: Array, words: str, colour: str, unit: str, *, steps: bool = False, fill: bool = False,
    width: float = 1.7,
) -> Trace:  # fmt: skip
    trace: Trace = {
        "type": "scatter", "mode": "lines", "x": at.astype(np.float32), "y": values.astype(np.float32), "name": words,
        "line": {"color": colour, "width": width, "shape": "hvh" if steps else "linear"},
        "hovertemplate": f"%{{y:.4~g}} {unit}<extra>{words}</extra>",
    }  # fmt: skip
    if fill:
        trace |= {"fill": "tozeroy", "fillcolor": "rgba(128,136,148,0.18)"}
    return trace


def _profile_layout(label: str, unit: str) -> dict[str, object]:
    return {
        "height": _HEIGHT, "margin": {"l": 62, "r": 18, "t": 40, "b": 50}, "hovermode": "x unified",
        "showlegend": True, "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
        "xaxis": {"title": {"text": label}}, "yaxis": {"title": {"text": unit}, "showgrid": True},
        "uirevision": "profile",
    }  # fmt: skip


def _largest(source: Source) -> tuple[float, float]:
    """X and y, m, of the largest value that a source is about."""
    data = fields_of(source)
    for name in ("pressure", *VARIABLE.values(), "extension_strain"):
        if name in data:
            sheet = data.isel(depth=0) if "depth" in data[name].dims else data
            row, column = index_of_largest(plane(sheet, name))
            return float(data["x"][column]), float(data["y"][row])
    return float(data["x"].mean()), float(data["y"].mean())


def _centres(data: xr.Dataset) -> tuple[Array, Array]:
    return data["x"].to_numpy(), data["y"].to_numpy()


def _step(data: xr.Dataset) -> float:
    """Distance of the points of a map, m."""
    return Plan.of(data).cell / MM


def _between(centres: Array, at: Array) -> tuple[IntArray, Array]:
    """Number of the centre below, and the share of the way to the next."""
    if len(centres) == 1:
        return np.zeros(np.shape(at), dtype=int), np.zeros(np.shape(at))
    low = np.clip(np.searchsorted(centres, at, side="right") - 1, 0, len(centres) - 2)
    share = np.clip((at - centres[low]) / (centres[low + 1] - centres[low]), 0.0, 1.0)
    return low, share
