"""What one map of a page shows: cells in colour with their unit, and the outline, arrows or strokes on them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.kit.plan import (
    KPA,
    MICRO,
    Limits,
    Plan,
    at_depth,
    contact_mask,
    fields_of,
    limits,
    peak_of,
    plane,
)
from treadload.plots.kit.shown import Shown, shown
from treadload.plots.kit.strokes import choose, strokes
from treadload.plots.kit.style import measure
from treadload.plots.response import NAMES, VARIABLE, Strain, horizontal, place_in_words, strain_plane

# Cells that a map hands to a browser; more are drawn as means of blocks.
MOST_CELLS = 160_000
_ARROWS = 22
# Directions of strains, and cracks, below this share of the scale are left out.
_SIGNIFICANT = 0.2
_DECADES = 6


@dataclass(frozen=True, eq=False)
class Field:
    """A map. name: of the variable. words, unit: of what the colours show. values: (ny, nx) in the unit, NaN:
    nothing.

    kind: of its colour scale, see `theme.colour_scale`. scale: limits of the colours. outlines: (mask, plan) of what
    is framed, with a role, "contact", "stick", "slip" or "measured". arrows: (n, 4), middle and half of each, mm.
    strokes: (n, 4), the same without a head. peak: x, y, mm, and text of the largest value. logarithmic: the values
    are decades. blocks: cells on a side of a block whose mean stands for it, 1 for none.
    """

    name: str
    words: str
    unit: str
    plan: Plan
    values: Array
    kind: str
    scale: Limits
    title: str = ""
    outlines: tuple[tuple[BoolArray, Plan, str], ...] = ()
    arrows: Array = field(default_factory=lambda: np.zeros((0, 4)))
    strokes: Array = field(default_factory=lambda: np.zeros((0, 4)))
    peak: tuple[float, float, str] | None = None
    logarithmic: bool = False
    blocks: int = 1

    @property
    def label(self) -> str:
        """Of the colour bar: "contact pressure (kPa)"."""
        return f"{self.words} ({self.unit})" if self.unit else self.words


def pressure_field(contact: Source) -> Field:
    """Contact pressure, kPa. contact: with pressure (y, x), Pa."""
    data = fields_of(contact, "pressure")
    plan, values = Plan.of(data), np.nan_to_num(plane(data, "pressure") * KPA)
    return _thinned(
        Field(
            "pressure", "contact pressure", "kPa", plan, np.where(values > 0, values, np.nan), "pressure",
            limits(values), "Contact pressure", ((values > 0, plan, "contact"),), peak=_peak(plan, values, "kPa"),
        )
    )  # fmt: skip


def shear_field(contact: Source) -> Field:
    """Size of the shear on the road, kPa, with its arrows and what sticks and slips.

    contact: with traction_x, traction_y (y, x), Pa: shear exerted by the tire on the road.
    """
    data = fields_of(contact, "traction_x", "traction_y")
    plan = Plan.of(data)
    along, right = (np.nan_to_num(plane(data, name) * KPA) for name in ("traction_x", "traction_y"))
    values = np.hypot(along, right)
    scale = limits(values)
    apart = max(plan.span / _ARROWS, 2 * plan.cell)
    index = (
        choose(values, plan.x, plan.y, max(0.06 * scale.high, 1e-12), apart)
        if values.any()
        else np.zeros((0, 2), int)
    )
    rows, columns = index.T
    length = values[rows, columns] / scale.high
    cut = 0.75 * apart * np.minimum(1.0, 1.25 / np.maximum(length, 1e-12)) / scale.high
    arrows = np.stack([plan.x[columns], plan.y[rows], cut * along[rows, columns], cut * right[rows, columns]], -1)
    touching = _touching(data, values > 0)
    outlines: list[tuple[BoolArray, Plan, str]] = []
    if "state" in data and "negligible_shear" not in data.attrs:
        state = plane(data, "state")
        outlines = [(state == 1, plan, "stick"), (state == 2, plan, "slip")]
    title = str(data.attrs.get("negligible_shear", "Shear of the tire on the road"))
    return _thinned(
        Field(
            "shear", "shear on the road", "kPa", plan, np.where(touching, values, np.nan), "shear", scale,
            title, tuple(outlines), arrows, peak=_peak(plan, values, "kPa"),
        )
    )  # fmt: skip


def zones_field(contact: Source) -> Field:
    """Where the contact sticks, 1, and slips, 2. contact: with state (y, x)."""
    data = fields_of(contact, "state")
    plan, state = Plan.of(data), np.nan_to_num(plane(data, "state"))
    slipping = 100 * float((state == 2).sum() / max(1, (state > 0).sum()))
    return _thinned(
        Field(
            "state", f"stick and slip: {slipping:.0f} % of the contact slips", "", plan,
            np.where(state > 0, state, np.nan), "zones", Limits(-0.5, 2.5), "Stick and slip",
            ((state > 0, plan, "contact"),),
        )
    )  # fmt: skip


def extension_field(
    response: Source, *, depth: float = 0.0, strain: Strain = "principal", contact: Source | None = None
) -> Field:
    """Largest extension, microstrain, with strokes along its direction.

    response: with the strain and its direction over (depth, y, x). depth: one of its depths, m. strain: "principal",
    in space, whose strokes shorten as the direction leaves the plane, or "in-plane". contact: gives the outline; left
    out, the stress at the surface does.
    """
    data = strain_plane(response, depth, strain)
    plan, values = Plan.of(data), plane(data, VARIABLE[strain]) * MICRO
    scale = limits(values)
    drawn = np.zeros((0, 4))
    if np.nanmax(values, initial=0.0) > 0:
        lines = strokes(values, *horizontal(data, strain), plan.x, plan.y, _SIGNIFICANT * scale.high)
        drawn = np.concatenate([lines.middles, lines.halves], axis=1)
    return _thinned(
        Field(
            VARIABLE[strain], f"largest tensile strain, {NAMES[strain]}", "microstrain", plan, values, "strain",
            scale,
            f"Largest tensile strain {place_in_words(depth)}, {NAMES[strain]}", _outline(contact or response),
            strokes=drawn, peak=_peak(plan, values, "microstrain at a point"),
        )
    )  # fmt: skip


def variable_field(
    source: Source,
    name: str,
    *,
    depth: float | None = None,
    component: str | None = None,
    contact: Source | None = None,
) -> Field:
    """Any variable over (y, x), or over the depth and more besides, in the unit of figures.

    source: a result or its dataset. depth: m; left out, the first. component: of a direction, "x", "y" or "z"; left
    out, the first. Values of both signs get a scale about zero. contact: gives the outline.
    Raises InputError for a variable that is not a map.
    """
    data = fields_of(source, name)
    if not {"x", "y"} <= set(data[name].dims):
        over = ", ".join(map(str, data[name].dims)) or "no dimension"
        raise InputError(f"a map is drawn of a variable over y and x, {name} is over {over}")
    level = data if depth is None else at_depth(data, depth)
    notes = []
    if "component" in level[name].dims:
        level = level.sel(component=component) if component else level.isel(component=0)
        notes.append(str(level["component"].values))
    if "depth" in level[name].dims:
        depth, level = float(level["depth"][0]), level.isel(depth=0)
    level = level.isel(dict.fromkeys([dim for dim in level[name].dims if dim not in ("x", "y")], 0))
    display: Shown = shown(data[name])
    plan, values = Plan.of(level), plane(level, name) * display.factor
    if display.logarithmic:
        return _thinned(_decades(name, display.words, plan, values, _outline(contact or source)))
    words = " ".join([str(data[name].attrs.get("long_name", display.words)), *notes])
    title = f"{words[:1].upper()}{words[1:]}" + (f", {place_in_words(depth)}" if depth is not None else "")
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if low < 0:
        most = _robust(finite)
        kind, scale = "signed", Limits(-most, most, max(-low, high) > 1.001 * most)
    else:
        kind, scale = "strain", limits(values) if high > 0 else Limits(0.0, 1.0)
    unit = "" if display.unit == "–" else display.unit
    peak = _peak(plan, np.abs(values) if kind == "signed" else values, unit, values)
    return _thinned(
        Field(
            name,
            display.words,
            display.unit,
            plan,
            values,
            kind,
            scale,
            title,
            _outline(contact or source),
            peak=peak,
        )
    )


def damage_field(verdict: Source) -> Field:
    """Damage of one passage, the inverse of the passes that the law allows, in decades.

    verdict: with allowable_passes (y, x). Strokes are the traces of the cracks to expect, where the strain matters.
    """
    data = fields_of(verdict, "allowable_passes")
    plan, passes = Plan.of(data), plane(data, "allowable_passes")
    with np.errstate(divide="ignore"):
        values = -np.log10(passes)
    values = np.where(np.isfinite(values), values, np.nan)
    high = float(np.nanmax(values, initial=-300.0))
    any_damage = bool(np.isfinite(values).any())
    scale = (
        Limits(math.floor(high) - _DECADES + 1.0, max(high, math.floor(high) + 0.1)) if any_damage else Limits(-6, 0)
    )
    drawn = np.zeros((0, 4))
    if {"crack_angle", "extension_strain"} <= set(data.variables):
        extension, angle = plane(data, "extension_strain"), plane(data, "crack_angle")
        weight = np.where(np.isfinite(angle), extension, np.nan)
        most = float(np.nanmax(weight, initial=0.0))
        if most > 0:
            lines = strokes(weight, np.cos(angle), np.sin(angle), plan.x, plan.y, _SIGNIFICANT * most)
            drawn = np.concatenate([lines.middles, lines.halves], axis=1)
    peak = None
    if any_damage:
        row, column = peak_of(values)
        peak = (float(plan.x[column]), float(plan.y[row]), f"{float(passes[row, column]):.2g} load repetitions")
    return _thinned(
        Field(
            "damage", "damage of one passage", "of failure", plan, values, "strain", scale,
            "Damage of one passage, traces of the cracks", strokes=drawn, peak=peak, logarithmic=True,
        )
    )  # fmt: skip


def choices(source: Source) -> dict[str, str]:
    """All maps that `field_of` can make of a source: name → words, the plainest first."""
    data = fields_of(source)
    variables = set(data.variables)
    first = {
        "pressure": "contact pressure" if "pressure" in variables else "",
        "shear": "shear, its arrows, stick and slip" if {"traction_x", "traction_y"} <= variables else "",
        "state": "stick and slip" if "state" in variables else "",
        **{
            name: f"largest tensile strain, {NAMES[strain]}, its directions"
            for strain, name in VARIABLE.items()
            if {name, "principal_direction_1" if strain == "principal" else "in_plane_angle_1"} <= variables
        },
        "damage": "damage of one passage, traces of the cracks" if "allowable_passes" in variables else "",
    }
    further = {
        str(name): str(variable.attrs.get("long_name", str(name).replace("_", " ")))
        for name, variable in data.data_vars.items()
        if {"x", "y"} <= set(variable.dims) and variable.dtype.kind in "fiu"
    }
    plain = {name: words for name, words in first.items() if words}
    return {**plain, **{name: words for name, words in further.items() if name not in plain}}


def field_of(source: Source, name: str, *, depth: float | None = None, contact: Source | None = None) -> Field:
    """The map of a name of `choices`. depth: of a response's depths, m; left out, the first.

    Raises InputError for a name that the source does not have.
    """
    names = choices(source)
    if name not in names:
        raise InputError(f"there is no map of {name!r} here; {nearest(name, names)}")
    plain: dict[str, Callable[[Source], Field]] = {
        "pressure": pressure_field, "shear": shear_field, "state": zones_field, "damage": damage_field,
    }  # fmt: skip
    if name in plain:
        return plain[name](source)
    for strain, variable in VARIABLE.items():
        if name == variable and "its directions" in names[name]:
            first = float(np.atleast_1d(fields_of(source)["depth"].to_numpy())[0])
            read: Strain = "principal" if strain == "principal" else "in-plane"
            return extension_field(source, depth=first if depth is None else depth, strain=read, contact=contact)
    return variable_field(source, name, depth=depth, contact=contact)


def with_outline(shown_field: Field, footprint: Source) -> Field:
    """The map with the outline of a measured footprint on it."""
    data = fields_of(footprint, "pressure")
    mask = np.nan_to_num(plane(data, "pressure")) > 0
    return replace(shown_field, outlines=(*shown_field.outlines, (mask, Plan.of(data), "measured")))


def _decades(
    name: str, words: str, plan: Plan, values: Array, outline: tuple[tuple[BoolArray, Plan, str], ...]
) -> Field:
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log10(np.where(values > 0, values, np.nan))
    logs = np.where(np.isfinite(logs), logs, np.nan)
    low = float(np.nanmin(logs, initial=300.0))
    scale = (
        Limits(low, low + _DECADES, bool(np.nanmax(logs, initial=low) > low + _DECADES))
        if low < 300
        else Limits(0, 6)
    )
    return Field(
        name, words, "", plan, logs, "height", scale, words[:1].upper() + words[1:], outline, logarithmic=True
    )


def _robust(finite: Array) -> float:
    """End of a scale about zero: all but single cells that stand far out."""
    scale = limits(np.abs(finite))
    return scale.high


def _touching(data: xr.Dataset, otherwise: BoolArray) -> BoolArray:
    if "state" in data:
        return np.nan_to_num(plane(data, "state")) > 0
    return np.nan_to_num(plane(data, "pressure")) > 0 if "pressure" in data else otherwise


def _outline(source: Source) -> tuple[tuple[BoolArray, Plan, str], ...]:
    data = fields_of(source)
    mask = contact_mask(data)
    return () if mask is None else ((mask, Plan.of(data), "contact"),)


def _peak(plan: Plan, values: Array, unit: str, shown_values: Array | None = None) -> tuple[float, float, str] | None:
    row, column = peak_of(values)
    if not values.size or not values[row, column] > 0:
        return None
    text = measure(float((values if shown_values is None else shown_values)[row, column]))
    return float(plan.x[column]), float(plan.y[row]), f"{text} {unit}".strip()


def _thinned(whole: Field) -> Field:
    """The map with means of square blocks of cells, where a browser would have too many; codes by their first."""
    rows, columns = whole.values.shape
    side = math.ceil(math.sqrt(rows * columns / MOST_CELLS))
    if side < 2:
        return whole
    keep = (slice(0, rows - rows % side or None), slice(0, columns - columns % side or None))
    values = whole.values[keep]
    if whole.kind == "zones":
        values = values[::side, ::side]
    else:
        blocks = values.reshape(values.shape[0] // side, side, values.shape[1] // side, side)
        finite = np.isfinite(blocks)
        count = finite.sum(axis=(1, 3))
        with np.errstate(invalid="ignore"):
            values = np.where(finite, blocks, 0.0).sum(axis=(1, 3)) / np.where(count, count, np.nan)
    x_edges, y_edges = (edges[: size * side + 1 : side] for edges, size in (
        (whole.plan.x_edges, values.shape[1]), (whole.plan.y_edges, values.shape[0])))  # fmt: skip
    plan = Plan((x_edges[1:] + x_edges[:-1]) / 2, (y_edges[1:] + y_edges[:-1]) / 2, x_edges, y_edges)
    return replace(whole, plan=plan, values=values, blocks=side)
