"""Classes of axles in standard axles, by criterion and by convention."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, PAPER, headline, legend_below, open_axes, plain, styled

_LETTERS = 26
# The axle of the French convention by load, N.
_FRENCH = 130e3


@figure(
    "Equivalents", name="axles", main=True, title="In standard axles", wide=True,
    caption=lambda data: f"Passes of the standard axle ({data.attrs['standard_axle']}) that do as much damage as one "
    "passage of a class, by every criterion; crosses: by the load alone.",
)  # fmt: skip
@styled
def standard_axles(equivalents: Source, *, ax: Axes | None = None) -> Figure:
    """Damage of one passage of each class in standard axles: dots by every criterion, crosses by the load alone.

    The crosses are (P / 130 kN)⁵ K where the standard axle has 130 kN, else the fourth power of P over its load.
    equivalents: an Equivalents or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> equivalents = tl.life.life_equivalents(design, life)
    >>> [label.get_text() for label in tl.plots.standard_axles(equivalents).axes[0].get_yticklabels()]
    ['cart']
    """
    data = fields_of(equivalents, "standard_axles", "french_axles", "axle_load", "axles")
    load = float(data.attrs["standard_axle_load"])
    names = [textwrap.fill(plain(str(name)), _LETTERS) for name in data["axle_class"].to_numpy()]
    figure, ax = figure_and_axes(ax, 7.6, 1.9 + 0.34 * len(names))
    rows = np.arange(len(names))[::-1]
    handles = []
    for k, name in enumerate(data["criterion"].to_numpy()):
        values = data["standard_axles"].to_numpy()[k]
        if not (values > 0).any():
            # No class does any damage by it, and a legend would promise dots.
            continue
        shown = np.where(values > 0, values, np.nan)
        handles += ax.plot(
            shown, rows, "o", ms=7, mec=PAPER, color=CASES[k % (len(CASES) - 1)], label=plain(str(name))
        )
    by_load, convention = data["french_axles"].to_numpy(), "(P / 130 kN)⁵ K of the group"
    if load != _FRENCH:
        by_load = data["axles"].to_numpy() * (data["axle_load"].to_numpy() / load) ** 4
        convention = f"(P / {load / 1e3:g} kN)⁴ of each axle"
    handles += ax.plot(by_load, rows, "x", ms=6, mew=1.4, color=INK, label=f"by its load: {convention}")
    ax.axvline(1.0, color=INK, lw=1.0, ls=(0, (4, 2)))
    ax.set_xscale("log")
    low, high = ax.get_xlim()
    ticks = [digit * 10.0**power for power in range(-4, 6) for digit in ((1, 2, 5) if high < 300 * low else (1,))]
    ax.set_xticks([tick for tick in ticks if low <= tick <= high])
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_yticks(rows, names)
    ax.set_ylim(-0.6, len(names) - 0.4)
    open_axes(ax)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel(f"one passage in standard axles of {load / 1e3:g} kN on dual discs, logarithmic")
    headline(
        ax, "What a passage does, in standard axles", "each at its own worst place, in the season that does most"
    )
    legend_below(ax, handles, columns=2)
    return figure
