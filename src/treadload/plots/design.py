"""A design: how long a road lasts with every thickness that was tried."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from treadload.composing import Source
from treadload.damage.answer import RUT
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, PAPER, headline, legend_below, measure, open_axes, plain, styled


@figure(
    "ThicknessDesign", name="lives", main=True, title="How thick it must be", wide=True,
    caption="Years that every criterion lasts with each thickness that was solved, and those asked for.",
)  # fmt: skip
@styled
def design_thicknesses(design: Source, *, ax: Axes | None = None) -> Figure:
    """Years by criterion against thickness, the years that are asked for, and the thickness that lasts them.

    design: a ThicknessDesign or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> answer = tl.life.design_thickness(design, "asphalt", years=20, between=(0.03, 0.06))
    >>> tl.plots.design_thicknesses(answer).axes[0].get_xlabel()
    'thickness of asphalt (mm)'
    """
    data = fields_of(design, "trial_thickness", "trial_years", "design_thickness", "asked_years")
    figure, ax = figure_and_axes(ax, 7.6, 4.0)
    thickness, years = 1e3 * data["trial_thickness"].to_numpy(), data["trial_years"].to_numpy()
    handles = []
    for k, name in enumerate(data["criterion"].to_numpy()):
        colour = CASES[k % (len(CASES) - 1)]
        row = np.where(np.isfinite(years[:, k]), years[:, k], np.nan)
        (line,) = ax.plot(thickness, row, "-o", ms=5, mec=PAPER, color=colour, label=plain(str(name)))
        handles.append(line)
    target, chosen = float(data["asked_years"]), 1e3 * float(data["design_thickness"])
    ax.axhline(target, color=INK, lw=1.0, ls=(0, (4, 2)))
    ax.annotate(f"{target:g} years", (0, target), xycoords=("axes fraction", "data"), xytext=(4, 4),
                textcoords="offset points", fontsize=8.5)  # fmt: skip
    ax.axvline(chosen, color=INK, lw=1.0)
    ax.annotate(f"{chosen:.0f} mm", (chosen, 0), xycoords=("data", "axes fraction"), xytext=(-4, 5),
                textcoords="offset points", ha="right", fontsize=8.5)  # fmt: skip
    ax.set_yscale("log")
    finite = years[np.isfinite(years)]
    low, high = (
        (min(finite.min(), target) / 1.4, max(finite.max(), target) * 1.4)
        if finite.size
        else (target / 2, 2 * target)
    )
    ax.set_ylim(low, high)
    ax.set_yticks(
        [t for t in (digit * 10.0**power for power in range(-3, 7) for digit in (1, 2, 5)) if low <= t <= high]
    )
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_formatter(NullFormatter())
    open_axes(ax)
    layer = str(data.attrs.get("layer", "the layer"))
    ax.set_xlabel(plain(f"thickness of {layer} (mm)"))
    rutted = RUT in data["criterion"].to_numpy()
    ax.set_ylabel("years until the damage is 1" + (",\nor the rut at its limit" if rutted else ""))
    risk = data.attrs.get("at_risk")
    exact = 1e3 * float(data["exact_thickness"])
    at = "" if risk is None else f" at a risk of {measure(100 * float(risk))} %"
    needs = "" if exact > 1e3 * float(data.attrs["lower_bound"]) * (1 + 1e-9) else "at most "
    headline(
        ax, "How thick it must be", f"{target:g} years{at} need {needs}{exact:.1f} mm; dots: lives that were solved"
    )
    legend_below(ax, handles, columns=min(3, len(handles)))
    return figure
