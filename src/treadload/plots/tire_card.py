"""A tire card: deflection, footprint, ribs and stiffnesses over load, a line for each inflation pressure."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, MUTED, headline, open_axes, styled

_NEEDED = ("approach", "net_area", "gross_area", "shoulder_over_centre", "rib_share")


@figure(
    "TireCard", name="card", main=True, title="What the tire shows", wide=True,
    caption="Deflection, footprint, load of the outer ribs and slip stiffness of the freely rolling tire.",
)  # fmt: skip
@styled
def tire_card(card: Source) -> Figure:
    """Panels over the wheel's load: deflection, area, load of the shoulders, and what sticks to the road.

    card: a TireCard or its dataset; without stiffnesses the last panel shows the ribs. Returns the figure. Raises
    InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    >>> card = tl.footprint.tire_card(tire, road, [50.0, 100.0], stiffness=False, spacing=0.006)
    >>> [ax.get_ylabel() for ax in tl.plots.tire_card(card).axes]
    ['vertical load (kN)', 'area (cm²)', 'outer ribs over middle rib (–)', 'share of the load (%)']
    """
    data = fields_of(card, *_NEEDED)
    figure = new_figure(9.6, 7.4)
    (deflection, area), (shoulder, last) = figure.subplots(2, 2)
    loads = data["wheel_load"].to_numpy() / 1e3
    pressures = data["inflation_pressure"].to_numpy()
    for number, pressure in enumerate(pressures):
        row = data.isel(inflation_pressure=number)
        look = {"color": CASES[number % len(CASES)], "marker": "o", "ms": 3.5}
        label = "" if np.isnan(pressure) else f"{pressure / 1e3:.0f} kPa"
        deflection.plot(1e3 * np.append(0.0, row["approach"]), np.append(0.0, loads), label=label, **look)
        area.plot(loads, 1e4 * row["net_area"], label=label, **look)
        area.plot(loads, 1e4 * row["gross_area"], ls="--", **look)
        shoulder.plot(loads, row["shoulder_over_centre"], label=label, **look)
        _last(last, row, loads, number)
    deflection.set_xlabel("deflection (mm)")
    deflection.set_ylabel("vertical load (kN)")
    headline(deflection, "Load and deflection", "of the tire standing or rolling freely")
    area.set_ylabel("area (cm²)")
    headline(area, "Footprint", "solid: cells in contact; dashed: their outline")
    shoulder.axhline(1.0, color=MUTED, lw=0.8)
    shoulder.set_ylabel("outer ribs over middle rib (–)")
    headline(shoulder, "Load of the shoulders", "above 1 the shoulders carry more than the middle")
    for ax in (area, shoulder, last):
        ax.set_xlabel("vertical load (kN)")
    open_axes(deflection, area, shoulder, last)
    for ax in (deflection, area, last):
        ax.set_ylim(bottom=0)
    deflection.set_xlim(left=0)
    if len(pressures) > 1:
        deflection.legend(loc="upper left", title="inflation")
    return figure


def _last(ax: Axes, row: xr.Dataset, loads: np.ndarray, number: int) -> None:
    if "cornering_stiffness" not in row:
        for rib in row["rib"].to_numpy():
            line = ax.plot(loads, 100 * row["rib_share"].sel(rib=rib), "o-", ms=3.5, color=CASES[rib % len(CASES)])[0]
            if number == 0:
                line.set_label(f"rib {rib + 1}")
        if number == 0:
            ax.set_ylabel("share of the load (%)")
            ax.legend(ncols=2)
            headline(ax, "Ribs", "from left to right")
        return
    color = CASES[number % len(CASES)]
    for name, marker, words in (
        ("longitudinal_stiffness", "s", "along travel, per creepage"),
        ("cornering_stiffness", "o", "cornering, per rad"),
    ):
        ax.plot(
            loads,
            row[name].to_numpy() / (1e3 * loads),
            marker=marker,
            ms=3.5,
            color=color,
            label=words if number == 0 else None,
        )
    if number == 0:
        ax.set_ylabel("slip stiffness over load (–)")
        headline(ax, "Slip stiffness", "slopes at free rolling")
        ax.legend()
