"""Plain figures of what has none of its own: a variable in plan, a few numbers as bars."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import Limits, Plan, at_depth, colour_bar, draw_cells, fields_of, plane
from treadload.plots.kit.round_off import round_off
from treadload.plots.kit.style import CASES, headline, measure, sequential, styled, travel_arrow
from treadload.variables import SCALES, axis_display_of

_LETTERS = 44


# Maps of one report.
_MOST = 6


def _maps(data: xr.Dataset) -> Iterator[Drawing]:
    maps = [str(name) for name, field in data.data_vars.items() if {"x", "y"} <= set(field.dims)]
    for name in maps[:_MOST]:
        yield Drawing({"name": name}, _capital(axis_display_of(name, "1").label), negligible=round_off(data, name))


@figure("Fields", name="map", title="Map", caption="In plan.", when=_maps)
@styled
def plain_map(fields: Source, name: str, *, depth: float | None = None, ax: Axes | None = None) -> Figure:
    """A variable in plan, at true scale, in its unit of display.

    fields: a result or its dataset. name: of a variable over (y, x), or (depth, y, x) and the like. depth: m; left
    out, the first of what it is over besides. Returns the figure. Raises InputError for a variable that is not a map.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> tl.plots.plain_map(contact, "initial_gap").axes[0].get_title(loc="left")
    'Separation before loading'
    """
    data = fields_of(fields, name)
    if not {"x", "y"} <= set(data[name].dims):
        over = ", ".join(map(str, data[name].dims)) or "no dimension"
        raise InputError(f"a map is drawn of a variable over y and x, {name} is over {over}")
    sheet = data[[name]] if depth is None else at_depth(data[[name]], depth)
    rest = [dim for dim in sheet[name].dims if dim not in ("x", "y")]
    notes = [_place(sheet, str(dim)) for dim in rest]
    sheet = sheet.isel(dict.fromkeys(rest, 0))
    plan, unit = Plan.of(sheet), str(data[name].attrs.get("units", "")) or "1"
    values = plane(sheet, name)
    display = axis_display_of(name, unit, float(np.nanmax(np.abs(values), initial=0.0)))
    values = values * SCALES.get(display.unit, 1.0)
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    figure, ax = figure_and_axes(ax, 6.4, min(8.0, 1.6 + 4.6 * plan.aspect))
    scale = Limits(low, high if high > low else low + 1.0)
    mesh = draw_cells(ax, plan, values, sequential("strain"), scale)
    colour_bar(mesh, ax, f"{display.label} ({display.unit or '–'})", scale)
    travel_arrow(ax)
    words = str(data[name].attrs.get("long_name", name))
    headline(ax, _capital(words), ", ".join(notes), _LETTERS)
    return figure


@figure(
    "RollingResistance", main=True, title="Rolling resistance",
    caption="The force that resists, and the energy that the materials lose per metre.",
)  # fmt: skip
@styled
def losses(resistance: Source, *, ax: Axes | None = None) -> Figure:
    """Bars of the force that resists rolling and of what the materials lose per length, N.

    resistance: a RollingResistance or its dataset. Returns the figure. Raises InputError for missing variables.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> resistance = tl.contact.rolling_resistance(contact, radius=0.3)
    >>> tl.plots.losses(resistance).axes[0].get_xlabel()
    'force, or energy per metre (N)'
    """
    data = fields_of(resistance, "rolling_resistance", "material_loss")
    values = [float(data[name]) for name in ("rolling_resistance", "material_loss")]
    figure, ax = figure_and_axes(ax, 5.4, 2.2)
    ax.barh([1, 0], values, height=0.55, color=[CASES[0], CASES[1]])
    for row, value in zip([1, 0], values, strict=True):
        ax.annotate(f"{measure(value)} N", (value, row), xytext=(4, 0), textcoords="offset points", va="center")
    ax.set_yticks([1, 0], ["resists rolling", "lost in the materials"])
    ax.set_xlim(min(0.0, *values), 1.3 * max(*values, 1e-9))
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("force, or energy per metre (N)")
    headline(
        ax, "Rolling resistance", f"{1e3 * float(data['rolling_resistance_coefficient']):.3g} N/kN, over the load"
    )
    return figure


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]


def _place(data: object, dim: str) -> str:
    first = data[dim].to_numpy()[0] if dim in data.coords else 0  # type: ignore[index, attr-defined]
    return f"{1e3 * float(first):g} mm deep" if dim == "depth" else f"{dim} {first}"
