"""What every class of axles does to the surface besides cracking it: polishing, and tearing by season."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source
from treadload.damage.indices import NO_WORK
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import INK, PAPER, RULE, headline, plain, sequential, styled

_LETTERS = 22
# Works below this part of the largest are those of a wheel that rolls freely: drawn as nothing.
_LEAST = 1e-4
# More seasons than this are not written into their cells, nor all of them named.
_MANY = 16


@figure(
    "Life", name="works", title="What polishes and tears the surface", wide=True, order=4,
    caption="Work of sliding, and elastic work of the shear in the skin, of one wheel's passage at its worst place, "
    "by class of axles and season. Indices that rank, not calibrated; 0: below a ten-thousandth of the largest.",
    when=lambda data: shears(data),
)  # fmt: skip
@styled
def life_works(life: Source) -> Figure:
    """Bars of the work of sliding of every class of axles, and a map of its work of tearing in every season, J/m².

    Of one wheel's passage at its worst place; tearing on a logarithmic scale. Below a ten-thousandth of the largest
    is drawn as nothing. life: a Life or its dataset. Returns the figure. Raises InputError if variables are missing,
    and where no wheel shears the surface.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> braking = tl.contact.Maneuver.braking(3.0)  # m/s²
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5, maneuver=braking)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.03), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [base], spacing=0.01))
    >>> [ax.get_title(loc="left") for ax in tl.plots.life_works(life).axes[:2]]
    ['Polishing', 'Ravelling']
    """
    data = fields_of(life, "largest_polishing_work", "largest_tearing_work")
    polishing = data["largest_polishing_work"].to_numpy()
    tearing = data["largest_tearing_work"].transpose("axle_class", "season").to_numpy()
    if not shears(data):
        raise InputError("no class of axles has a work of tearing to draw: none shears a surface of known modulus")
    most = float(np.nanmax(tearing))
    names = [textwrap.fill(plain(str(name)), _LETTERS) for name in data["axle_class"].to_numpy()]
    seasons = [str(name) for name in data["season"].to_numpy()]
    rows, columns = tearing.shape
    figure = new_figure(9.6, 2.0 + 0.36 * rows)
    grid = figure.add_gridspec(1, 2, width_ratios=[1.5, 5], wspace=0.04)
    bars, ax = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    middles = np.arange(rows) + 0.5

    bars.barh(middles, np.nan_to_num(polishing), height=0.62, color=RULE)
    for middle, value in zip(middles, polishing, strict=True):
        text = "unknown" if np.isnan(value) else _number(float(value), float(np.nanmax(polishing)))
        bars.annotate(text, (np.nan_to_num(value), middle), xytext=(3, 0), textcoords="offset points", va="center",
                      fontsize=8)  # fmt: skip
    bars.set_xlim(0, 1.45 * max(float(np.nanmax(polishing, initial=0.0)), 1e-12))
    bars.set_ylim(rows, 0)
    bars.set_yticks(middles, names)
    bars.tick_params(axis="y", length=0)
    bars.xaxis.set_major_locator(MaxNLocator(3))
    bars.spines[["top", "right", "left"]].set_visible(False)
    headline(bars, "Polishing", "work of sliding, J/m²")

    seen = np.ma.masked_less(np.ma.masked_invalid(tearing), _LEAST * most)
    low = float(seen.min())
    scale: Normalize = LogNorm(0.7 * low, most) if most > 3 * low else Normalize(0, most)
    mesh = ax.pcolormesh(np.arange(columns + 1), np.arange(rows + 1), seen, cmap=sequential("strain"), norm=scale,
                         edgecolors=PAPER, linewidth=0.8 if columns <= _MANY else 0)  # fmt: skip
    if columns <= _MANY:
        for row, column in np.ndindex(rows, columns):
            value = float(tearing[row, column])
            text = "–" if np.isnan(value) else _number(value, most)
            dark = value >= _LEAST * most and float(scale(value)) > 0.45
            ax.text(column + 0.5, row + 0.5, text, ha="center", va="center", fontsize=7, color=PAPER if dark else INK)
    else:
        figure.colorbar(mesh, ax=ax, label="J/m²", pad=0.01)
    step = -(-columns // _MANY)
    wrapped = [plain(name) if step > 1 else textwrap.fill(plain(name), 10) for name in seasons]
    short = [name[:3] for name in seasons] if columns == 12 else wrapped
    ax.set_xticks(np.arange(0, columns, step) + 0.5, short[::step])
    if step > 1:
        ax.tick_params(axis="x", rotation=90)
    ax.set_yticks([])
    ax.tick_params(length=0)
    ax.set_ylim(rows, 0)
    ax.spines[:].set_visible(False)
    shades = "logarithmic shades" if isinstance(scale, LogNorm) else "linear shades"
    headline(ax, "Ravelling", f"work of tearing in a skin of 1 mm, J/m²; {shades}")
    mesh.set_rasterized(True)
    return figure


def shears(data: xr.Dataset) -> bool:
    """True where a class of axles of a life does work of tearing that can be drawn."""
    needed = {"largest_polishing_work", "largest_tearing_work"}
    return needed <= set(data) and float(np.nanmax(data["largest_tearing_work"].to_numpy(), initial=0.0)) > NO_WORK


def _number(value: float, most: float) -> str:
    return "0" if value < _LEAST * most or value == 0 else f"{float(f'{value:.2g}'):g}"
