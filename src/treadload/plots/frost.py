"""Frost in the unbound layers of a road over the year, and their moduli by season."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.climate import layer_bottoms
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import (
    MUTED,
    ORIENTATION_COLOURS,
    headline,
    legend_below,
    measure,
    open_axes,
    plain,
    styled,
)

_ICE = "#0b6fae"
_COLOURS = ORIENTATION_COLOURS[1:]
# Moduli that lie further apart than this are drawn on a logarithmic axis.
_APART = 5.0


@figure(
    "Life", name="frost", title="Frost depth and moduli by month", wide=True, order=7.5,
    caption="Frozen part of the unbound layers by day, between the uppermost and the deepest frozen point, where the "
    "climate is one of weather with frost; Young's moduli of the layers that freeze, thaw or have a stated factor by "
    "season, as the life is solved.",
    when=lambda data: "season_modulus" in data,
)  # fmt: skip
@styled
def frost_months(life: Source) -> Figure:
    """Frozen depth by day and moduli of unbound layers by season.

    life: a Life or its dataset; without frost of a weather the moduli alone are drawn, those of stress-dependent
    layers at their nominal stress. Returns the figure. Raises InputError if variables are missing, as of a life whose
    seasons have no factors on the moduli of layers.

    >>> import math
    >>> from datetime import datetime
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> air = [6 - 14 * math.cos(2 * math.pi * (hour / 24 - 15) / 365) for hour in range(0, 8760, 3)]  # °C
    >>> weather = tl.pavement.Weather(datetime(2023, 1, 1), 3.0, air, surface_temperature=air)
    >>> temperatures = tl.pavement.road_temperatures(road, weather, [0.03, 0.2])
    >>> frost = tl.pavement.frost_year(road, temperatures, tl.pavement.Frost())
    >>> climate = tl.damage.Climate.of_road(road, temperatures, parts=1).with_frost(frost, range(1, 13))
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> traffic = tl.damage.Traffic((axle,), passes_per_year=1e7)
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [base], spacing=0.01))
    >>> tl.plots.frost_months(life).axes[0].get_ylabel()
    'depth (m)'
    """
    data = fields_of(life, "season_modulus", "factored_layer", "season")
    moduli = 1e-6 * data["season_modulus"].transpose("season", "factored_layer").to_numpy()
    if not np.isfinite(moduli).any():
        raise InputError("no layer with a factor of its season has a single modulus to draw")
    names = [str(name).partition(",")[0] for name in data["season"].to_numpy()]
    # Parts of the day of one month have its moduli.
    first = [k for k, name in enumerate(names) if k == 0 or name != names[k - 1]]
    labels, moduli = [names[k] for k in first], moduli[first]
    frozen = "frost_depth" in data
    sheet = new_figure(9.6, 6.4 if frozen else 3.8)
    axes = sheet.subplots(2, 1, height_ratios=(1.15, 1)) if frozen else [sheet.add_subplot()]
    if frozen:
        _frozen(axes[0], data)
    ax = axes[-1]
    handles = []
    for column, name in enumerate(data["factored_layer"].to_numpy()):
        colour = _COLOURS[column % len(_COLOURS)]
        style = "-" if column < len(_COLOURS) else "--"
        ax.stairs(moduli[:, column], np.arange(len(labels) + 1), baseline=None, color=colour, lw=1.8, ls=style)
        handles.append(Line2D([], [], color=colour, ls=style, label=plain(str(name))))
    _months(ax, labels)
    open_axes(ax)
    ax.grid(True, axis="y")
    ax.set_ylabel("Young's modulus (MPa)")
    if np.nanmax(moduli) > _APART * np.nanmin(moduli):
        ax.set_yscale("log")
        ax.set_ylabel("Young's modulus (MPa),\nlogarithmic")
    else:
        ax.set_ylim(bottom=0)
    low, high = np.nanmin(moduli), np.nanmax(moduli)
    headline(ax, "Modulus by season", f"of layers with a factor; {measure(low)} to {measure(high)} MPa")
    legend_below(ax, handles, columns=min(4, len(handles)))
    return sheet


def _frozen(ax: Axes, data: xr.Dataset) -> None:
    """The frozen depth by day, January first."""
    month = data["day_month"].to_numpy().astype(int)
    order = np.argsort(month, kind="stable")
    month = month[order]
    at = month - 1 + _share_of_month(month)
    deep = data["frost_depth"].to_numpy()[order]
    up = np.where(deep > 0, data["thaw_depth"].to_numpy()[order], 0.0)
    ax.fill_between(at, up, deep, where=deep > 0, color=_ICE, alpha=0.35, lw=0, step="mid")
    ax.step(at, np.where(deep > 0, deep, np.nan), where="mid", color=_ICE, lw=1.4)
    bottoms = 1e-3 * layer_bottoms(data)
    for bottom in bottoms:
        ax.axhline(bottom, color=MUTED, lw=0.8, ls=(0, (4, 3)))
    deepest = float(deep.max(initial=0.0))
    ax.set_ylim(1.1 * max(deepest, float(bottoms.max(initial=0.0)), 0.1), 0)
    ax.set_ylabel("depth (m)")
    _months(ax, list(_MONTHS))
    open_axes(ax)
    days = int((deep > 0).sum())
    text = f"to {deepest:.2f} m, on {days} days; dashed: interfaces of layers" if days else "no day with frost"
    headline(ax, "Frozen depth", text)
    if days:
        legend_below(ax, [Patch(color=_ICE, alpha=0.35, label="frozen")])


_MONTHS = ("January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
           "November", "December")  # fmt: skip


def _months(ax: Axes, labels: list[str]) -> None:
    """A place for each season along the axis, months by three letters."""
    ax.set_xlim(0, len(labels))
    ax.set_xticks(np.arange(len(labels)) + 0.5, [name[:3] if name in _MONTHS else plain(name) for name in labels])
    ax.tick_params(axis="x", length=0)


def _share_of_month(month: Array) -> Array:
    """How far each day is through its month, in (0, 1); days sorted by month."""
    share = np.empty(len(month))
    for number in np.unique(month):
        there = month == number
        count = int(there.sum())
        share[there] = (np.arange(count) + 0.5) / count
    return share
