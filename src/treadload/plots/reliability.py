"""The reliability of a life: probability of failure against years, and what its scatter is made of."""

from __future__ import annotations

import json

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullFormatter

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import (
    CASES,
    INK,
    MUTED,
    PAPER,
    headline,
    legend_below,
    measure,
    open_axes,
    plain,
    styled,
)

# Shares below which a part of a bar has no number in it, and inputs that are drawn.
_NUMBERED, _LEAST = 0.06, 0.002
# Colours of inputs, the most important first; what is left is grey.
_INPUTS = (*CASES[:5], "#7a8793", "#4b9cd3", "#e0a458", "#6aa84f")


@figure(
    "Reliability", name="years", main=True, title="When the road fails", wide=True,
    caption="Probability that a criterion has failed by a year; dotted: the first of them.",
)  # fmt: skip
@styled
def reliability_years(reliability: Source, *, ax: Axes | None = None) -> Figure:
    """Probability of failure against years by criterion: draws in full, the first order in dashes.

    reliability: a Reliability or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> from treadload.damage.scatter import Scatter
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> scatter = Scatter(fatigue=0.25, thickness={"asphalt": 0.002})
    >>> road = tl.Pavement([asphalt, soil])
    >>> design = tl.Design(tire, road, traffic, climate, [base], spacing=0.01, scatter=scatter)
    >>> life, draws = tl.solve_life(design), tl.life.MonteCarlo(draws=10000)
    >>> reliability = tl.life.life_reliability(design, life, held_back=0, sampling=draws)
    >>> tl.plots.reliability_years(reliability).axes[0].get_ylabel()
    'probability of failure (%)'
    """
    data = fields_of(reliability, "failure_probability", "years_at_risk")
    figure, ax = figure_and_axes(ax, 7.6, 4.2)
    years = data["year"].to_numpy()
    handles = []
    for k, name in enumerate(data["criterion"].to_numpy()):
        colour = CASES[k % (len(CASES) - 1)]
        (line,) = ax.plot(years, 100 * data["failure_probability"][k], color=colour, label=plain(str(name)))
        ax.plot(years, 100 * data["failure_probability_first_order"][k], "--", color=colour, lw=1.0)
        ax.plot(data["years_at_risk"][k], 100 * data["risk"], "o", ms=5, color=colour, mec=PAPER, zorder=4)
        handles.append(line)
    if data.sizes["criterion"] > 1:
        (line,) = ax.plot(years, 100 * data["road_failure_probability"], ":", color=INK, lw=2, label="any of them")
        handles.append(line)
    for risk in data["risk"].to_numpy():
        ax.axhline(100 * risk, color=MUTED, lw=0.6, zorder=0)
        ax.annotate(f"{100 * risk:g} %", (1, 100 * risk), xycoords=("axes fraction", "data"), xytext=(4, 0),
                    textcoords="offset points", va="center", fontsize=8, color=MUTED)  # fmt: skip
    design = data.attrs.get("design_years")
    if design is not None and years[0] <= float(design) <= years[-1]:
        ax.axvline(float(design), color=INK, lw=1.0, ls=(0, (4, 2)))
        ax.annotate(f"design, {float(design):g} years", (float(design), 0.9), xycoords=("data", "axes fraction"),
                    xytext=(4, -3), textcoords="offset points", va="top", fontsize=8.5)  # fmt: skip
    ax.set_xscale("log")
    ax.set_xlim(years[0], years[-1])
    ax.set_ylim(0, 100)
    ticks = [digit * 10.0**power for power in range(-2, 5) for digit in (1, 2, 5)]
    ax.set_xticks([tick for tick in ticks if years[0] <= tick <= years[-1]])
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    open_axes(ax)
    ax.set_xlabel("years from the opening, logarithmic")
    ax.set_ylabel("probability of failure (%)")
    risks = ", ".join(f"{100 * risk:g}" for risk in data["risk"].to_numpy())
    headline(ax, "When the road fails", f"full: draws, dashed: first order; dots: years at risks of {risks} %")
    legend_below(ax, handles, columns=min(3, len(handles)))
    return figure


@figure(
    "Reliability", name="inputs", title="What the years scatter by", wide=True,
    caption="Share of each input in the scatter of a criterion's years at the smallest risk.",
)  # fmt: skip
@styled
def reliability_inputs(reliability: Source, *, ax: Axes | None = None) -> Figure:
    """Bars of what the scatter of each criterion is made of: α² of the first order.

    reliability: a Reliability or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> from treadload.damage.scatter import Scatter
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> scatter = Scatter(fatigue=0.25, thickness={"asphalt": 0.002})
    >>> road = tl.Pavement([asphalt, soil])
    >>> design = tl.Design(tire, road, traffic, climate, [base], spacing=0.01, scatter=scatter)
    >>> life, draws = tl.solve_life(design), tl.life.MonteCarlo(draws=10000)
    >>> reliability = tl.life.life_reliability(design, life, held_back=0, sampling=draws)
    >>> tl.plots.reliability_inputs(reliability).axes[0].get_xlabel()
    'share in the scatter, α² of the first order (%)'
    """
    data = fields_of(reliability, "importance")
    shares = data["importance"].to_numpy()
    order = [k for k in np.argsort(-shares.max(axis=0)) if shares[:, k].max() > _LEAST]
    names = [plain(str(name)) for name in data["criterion"].to_numpy()]
    figure, ax = figure_and_axes(ax, 7.6, 2.0 + 0.55 * len(names))
    rows = np.arange(len(names))[::-1]
    left = np.zeros(len(names))
    words = json.loads(data.attrs.get("deviations", "[]")) or [""] * shares.shape[1]
    handles = []
    for number, k in enumerate(order):
        colour = _INPUTS[min(number, len(_INPUTS) - 1)]
        law = "" if words[k] in ("", "SN") else f", {words[k]}"
        ax.barh(rows, shares[:, k], left=left, height=0.62, color=colour, edgecolor=PAPER, linewidth=0.8)
        handles.append(Patch(color=colour, label=plain(f"{data['input'].to_numpy()[k]}{law}")))
        for row, start, share in zip(rows, left, shares[:, k], strict=True):
            if share >= _NUMBERED:
                ax.text(start + share / 2, row, f"{100 * share:.0f}", ha="center", va="center", color=PAPER,
                        fontsize=8.5)  # fmt: skip
        left = left + shares[:, k]
    ax.set_xlim(0, 1)
    ax.set_ylim(-0.6, len(names) - 0.4)
    ax.set_xticks([0, 0.25, 0.5, 0.75, 1], ["0", "25", "50", "75", "100"])
    ax.set_yticks(rows, names)
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.set_xlabel("share in the scatter, α² of the first order (%)")
    risk = 100 * float(data["risk"].to_numpy()[0])
    headline(
        ax, "What the years scatter by", f"at a risk of {measure(risk)} %; one deviation of each input beside it"
    )
    legend_below(ax, handles, columns=2)
    return figure
