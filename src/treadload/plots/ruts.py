"""The rut of a life against years, layer on layer."""

from __future__ import annotations

import json
import math

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.damage.words import rut_in_words
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MM, fields_of
from treadload.plots.kit.style import INK, headline, legend_below, measure, plain, sequential, styled


@figure(
    "Life", name="rut", title="Rut against years", wide=True, order=5,
    caption=lambda data: f"R{rut_in_words(data)[1:]}. Where it is deepest, with lateral wander; what was not read in "
    "its source is in the warnings.",
    when=lambda data: "rut_depth" in data,
)  # fmt: skip
@styled
def life_rut(life: Source) -> Figure:
    """Rut against years where it is deepest, mm, layers on each other from the surface down; dashed: its limit.

    life: a Life with a rut, or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base, ruts = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0), tl.damage.Rutting(limit=0.0127)
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> road = tl.Pavement([asphalt, soil])
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [base], spacing=0.01, rutting=ruts))
    >>> tl.plots.life_rut(life).axes[0].get_ylabel()
    'rut, down (mm)'
    """
    data = fields_of(life, "rut_depth", "year")
    names = json.loads(data.attrs["rut_names"])
    depth = data["rut_depth"].transpose("rut_layer", "year").to_numpy() * MM
    rows = [k for k in range(len(names)) if depth[k, -1] > 0]
    years = np.concatenate([[0.0], data["year"].to_numpy()])
    shades = sequential("strain")(np.linspace(0.2, 0.8, len(rows)))
    figure = new_figure(7.4, 4.2)
    ax = figure.add_subplot()
    under = np.zeros(len(years))
    for row, shade in zip(rows, shades, strict=True):
        over = under + np.concatenate([[0.0], depth[row]])
        ax.fill_between(years, under, over, color=shade, lw=0, label=plain(f"{names[row]}: {depth[row, -1]:.2g} mm"))
        under = over
    ax.plot(years, under, color=INK, lw=1.2)
    limit, when = data.attrs.get("rut_limit"), float(data.attrs.get("rut_years", math.inf))
    text = f"{measure(float(under[-1]))} mm after {years[-1]:g} years"
    if limit is not None:
        ax.axhline(float(limit) * MM, color=INK, ls="--", lw=0.9)
        reached = "not reached" if math.isinf(when) else f"reached after {measure(when)} years"
        text += f"; limit of {float(limit) * MM:g} mm, dashed, {reached}"
    ax.set_xlim(0, years[-1])
    ax.set_ylim(0, 1.08 * max(float(under[-1]), 0.0 if limit is None else float(limit) * MM, 1e-6))
    ax.invert_yaxis()
    ax.set_xlabel("years from opening")
    ax.set_ylabel("rut, down (mm)")
    ax.grid(True)
    handles, _ = ax.get_legend_handles_labels()
    legend_below(ax, handles, columns=min(3, len(handles)))
    headline(ax, "Rut", text)
    return figure
