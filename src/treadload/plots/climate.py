"""The climate of a life over depth: hours of a month's mean day, and the coldest and the warmest season."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import DEPTH_LABEL, fields_of
from treadload.plots.kit.style import INK, MUTED, headline, legend_below, named_map, open_axes, plain, styled

_MONTHS = ("January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
           "November", "December")  # fmt: skip
_COLD, _WARM = "#0b6fae", "#d55e00"
# Moduli that lie further apart than this are drawn on a logarithmic axis.
_APART = 20.0


@figure(
    "Life", name="temperatures", title="Temperature of the road", wide=True, order=6,
    caption="Mean day of four months over depth and hour, by heat conduction below the weather; dashed: interfaces "
    "of layers.",
    when=lambda data: "day_temperature" in data,
)  # fmt: skip
@styled
def day_temperatures(life: Source, months: Sequence[int] = (1, 4, 7, 10)) -> Figure:
    """Maps of the road's temperature over depth and hour on the mean day of months, with interfaces of layers.

    life: a Life or its dataset. months: January is 1. Returns the figure. Raises InputError for other months, and
    if variables are missing, as of a life whose climate is not one of weather.

    >>> import math
    >>> from datetime import datetime
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> air = [6 - 14 * math.cos(2 * math.pi * (hour / 24 - 15) / 365) for hour in range(0, 8760, 3)]  # °C
    >>> weather = tl.pavement.Weather(datetime(2023, 1, 1), 3.0, air, surface_temperature=air)
    >>> temperatures = tl.pavement.road_temperatures(road, weather, [0.03, 0.2])
    >>> climate = tl.damage.Climate.of_road(road, temperatures, parts=1)
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> traffic = tl.damage.Traffic((axle,), passes_per_year=1e7)
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [base], spacing=0.01))
    >>> [ax.get_title(loc="left") for ax in tl.plots.day_temperatures(life, months=(1, 7)).axes[:2]]
    ['January', 'July']
    """
    data = fields_of(life, "day_temperature", "month", "hour", "profile_depth")
    chosen = list(months)
    if not chosen or any(month not in range(1, 13) for month in chosen):
        raise InputError(f"months must be numbers from 1, January, to 12, got {chosen}")
    depth, clock = 1e3 * data["profile_depth"].to_numpy(), data["hour"].to_numpy()
    # A day goes on into itself, so that maps reach from midnight to midnight.
    hour = np.concatenate([[clock[-1] - 24], clock, [clock[0] + 24]])
    days = data["day_temperature"].sel(month=chosen).to_numpy()
    days = np.concatenate([days[:, -1:], days, days[:, :1]], axis=1)
    levels = MaxNLocator(24, steps=[1, 2, 5, 10]).tick_values(float(days.min()), float(days.max()))
    columns = min(2, len(chosen))
    rows = -(-len(chosen) // columns)
    figure = new_figure(9.6, 0.9 + 2.5 * rows)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    borders = layer_bottoms(data)
    for ax, month, day in zip(axes, chosen, days, strict=False):
        filled = ax.contourf(hour, depth, day.T, levels=levels, cmap=named_map("inferno"))
        ax.axhline(depth[0], color=INK, lw=0.7)
        for border in borders[borders < depth[-1] - 1e-6]:
            ax.axhline(border, color="#ffffff", lw=1.2, ls=(0, (4, 3)))
        ax.set_xlim(0, 24)
        ax.set_ylim(depth[-1], 0)
        ax.set_xticks(range(0, 25, 6))
        surface = day[:, 0]
        span = f"surface {surface.min():.0f} to {surface.max():.0f} °C on the mean day".replace("-", "−")
        headline(ax, _MONTHS[month - 1], span)
    for ax in axes[len(chosen) :]:
        ax.set_visible(False)
    for number, ax in enumerate(axes[: len(chosen)]):
        if number + columns >= len(chosen):
            ax.set_xlabel("hour of the day")
            ax.tick_params(labelbottom=True)
        if number % columns == 0:
            ax.set_ylabel(DEPTH_LABEL)
    figure.colorbar(filled, ax=axes.tolist(), label="temperature (°C)", shrink=0.9, pad=0.02)
    return figure


@figure(
    "Life", name="moduli", title="Modulus over depth", wide=True, order=7,
    caption="Temperature and Young's modulus of the parts that courses are divided into, in the coldest and the "
    "warmest season, at the frequency at which mixes are given.",
    when=lambda data: "sublayer_modulus" in data,
)  # fmt: skip
@styled
def season_moduli(life: Source) -> Figure:
    """Temperature and modulus over depth in the coldest and the warmest season; with ageing also of the young mix.

    Those by the mean over the parts of courses that depend on temperature. life: a Life or its dataset. Returns the
    figure. Raises InputError if variables are missing, as of a life whose courses are not divided.

    >>> import math
    >>> from datetime import datetime
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> air = [6 - 14 * math.cos(2 * math.pi * (hour / 24 - 15) / 365) for hour in range(0, 8760, 3)]  # °C
    >>> weather = tl.pavement.Weather(datetime(2023, 1, 1), 3.0, air, surface_temperature=air)
    >>> temperatures = tl.pavement.road_temperatures(road, weather, [0.03, 0.2])
    >>> climate = tl.damage.Climate.of_road(road, temperatures, parts=1)
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 1, "bottom")
    >>> traffic = tl.damage.Traffic((axle,), passes_per_year=1e7)
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [base], spacing=0.01))
    >>> [ax.get_xlabel() for ax in tl.plots.season_moduli(life).axes[:2]]
    ['temperature (°C)', "Young's modulus (MPa)"]
    """
    data = fields_of(life, "sublayer_modulus", "sublayer_temperature", "sublayer_top", "sublayer_bottom")
    top, bottom = 1e3 * data["sublayer_top"].to_numpy(), 1e3 * data["sublayer_bottom"].to_numpy()
    warm, moduli = data["sublayer_temperature"].to_numpy(), 1e-6 * data["sublayer_modulus"].to_numpy()
    if not np.isfinite(moduli).any():
        raise InputError("no part of this road has a modulus of its own to draw: its materials are viscoelastic")
    young = 1e-6 * data["sublayer_modulus_young"].to_numpy() if "sublayer_modulus_young" in data else None
    moves = np.ptp(moduli, axis=0) > 0
    thick = (bottom - top) * (moves if moves.any() else 1.0)
    mean = warm @ thick / thick.sum()
    names = [plain(str(name)) for name in data["season"].to_numpy()]
    ends = dict(zip([int(mean.argmin()), int(mean.argmax())], (_COLD, _WARM), strict=True))
    figure = new_figure(9.6, 4.3)
    left, right = figure.subplots(1, 2, sharey=True)
    handles = []
    for season, colour in ends.items():
        left.plot(*_steps(warm[season], top, bottom), color=colour)
        if young is not None:
            right.plot(*_steps(young[season], top, bottom), "--", color=colour, lw=1.2)
        right.plot(*_steps(moduli[season], top, bottom), color=colour)
        handles.append(Line2D([], [], color=colour, label=names[season]))
    if young is not None:
        handles += [
            Line2D([], [], color=MUTED, label="aged, as the life is solved"),
            Line2D([], [], color=MUTED, ls="--", lw=1.2, label="young"),
        ]
    for ax in (left, right):
        open_axes(ax)
        for border in layer_bottoms(data)[:-1]:
            ax.axhline(border, color=MUTED, lw=0.8, ls=(0, (4, 3)))
    left.set_ylim(bottom[-1], 0)
    left.set_ylabel(DEPTH_LABEL)
    left.set_xlabel("temperature (°C)")
    right.set_xlabel("Young's modulus (MPa)")
    drawn = moduli[list(ends)]
    if np.nanmax(drawn) > _APART * np.nanmin(drawn):
        right.set_xscale("log")
        right.set_xlabel("Young's modulus (MPa), logarithmic")
    else:
        right.set_xlim(left=0)
    headline(left, "Temperature over depth", "of the parts of courses; dashed: interfaces of layers")
    headline(right, "Modulus over depth", "in the coldest and the warmest season")
    legend_below(right, handles, columns=2)
    return figure


def layer_bottoms(data: xr.Dataset) -> Array:
    """Depths of the bottoms of layers, mm; none where they are not known."""
    if not {"sublayer_layer", "sublayer_bottom"} <= set(data.variables):
        return np.empty(0)
    layer, bottom = data["sublayer_layer"].to_numpy(), 1e3 * data["sublayer_bottom"].to_numpy()
    last: Array = bottom[np.append(np.diff(layer) != 0, True)]
    return last


def _steps(values: Array, top: Array, bottom: Array) -> tuple[Array, Array]:
    """A line that is constant over each part."""
    return np.repeat(values, 2), np.column_stack([top, bottom]).ravel()
