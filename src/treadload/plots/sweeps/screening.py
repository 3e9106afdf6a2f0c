"""What matters among the inputs of a case: tornado, Sobol indices, Morris effects."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.shown import Shown, shown
from treadload.plots.kit.style import CASES, INK, MUTED, RULE, headline, open_axes, styled

_LOW, _HIGH = CASES[0], CASES[1]
# Inputs that a figure shows, the others being the least.
_MOST = 12
# Height of a line of letters, and where they stand on the other side, in parts of the axes.
_LINE, _FAR = 0.05, 0.72


@figure(
    "Tornado", name="tornado", main=True, title="Tornado", wide=True,
    caption="The result with one input at an end of its range, the others as in the base case.",
)  # fmt: skip
@styled
def tornado_bars(tornado: Source, *, ax: Axes | None = None) -> Figure:
    """Bars of a result from the base case to both ends of every input, the largest swing on top.

    tornado: a Tornado or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> tornado = tl.sweeps.tornado(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure")
    >>> tl.plots.tornado_bars(tornado).axes[0].get_xlabel()
    'peak pressure (kPa)'
    """
    data = fields_of(tornado, "reading_low", "reading_high", "reading_base", "swing").isel(input=slice(_MOST))
    what = _reading(data)
    figure, ax = figure_and_axes(ax, 7.4, 1.5 + 0.48 * data.sizes["input"])
    base = what.factor * float(data["reading_base"])
    rows = np.arange(data.sizes["input"])[::-1]
    names = []
    for k, row in enumerate(rows):
        how = _input(data, k)
        names.append(how.words)
        ends = [(float(data[f"reading_{end}"][k]), float(data[f"input_{end}"][k]), end) for end in ("low", "high")]
        values = [what.factor * value for value, _, _ in ends]
        # A bar on the same side for both ends: the longer one lies below.
        for number in np.argsort([-abs(value - base) if np.isfinite(value) else 0 for value in values]):
            value, (_, at, end) = values[number], ends[number]
            colour = _LOW if end == "low" else _HIGH
            if not np.isfinite(value):
                ax.annotate(f"{how.number(at)} failed ×", (base, row), xytext=(6 if end == "high" else -6, 0),
                            textcoords="offset points", ha="left" if end == "high" else "right", va="center",
                            fontsize=8, color=MUTED)  # fmt: skip
                continue
            ax.barh(row, value - base, left=base, height=0.6, color=colour)
        same = np.isfinite(values).all() and (values[0] - base) * (values[1] - base) > 0
        for value, (_, at, end) in zip(values, ends, strict=True):
            if np.isfinite(value) and not (same and abs(value - base) < max(abs(v - base) for v in values)):
                right = value >= base if value != base else end == "high"
                ax.annotate(how.number(at), (value, row), xytext=(4 if right else -4, 0), textcoords="offset points",
                            ha="left" if right else "right", va="center", fontsize=8)  # fmt: skip
    ax.axvline(base, color=INK, lw=1.0)
    ax.set_yticks(rows, names)
    ax.tick_params(axis="y", length=0)
    ax.margins(x=0.16)
    ax.set_ylim(-0.6, len(rows) - 0.4)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")
    ax.set_xlabel(what.label)
    headline(
        ax, f"What the {what.words} depends on",
        f"{_place(data)}base {what.number(float(data['reading_base']))}; blue: low end of the input, orange: high",
    )  # fmt: skip
    return figure


@figure(
    "Sobol", name="sobol", main=True, title="Sobol indices", wide=True,
    caption="Share of the variance of the result over the ranges that is due to each input.",
)  # fmt: skip
@styled
def sobol_bars(sobol: Source, *, ax: Axes | None = None) -> Figure:
    """Bars of first-order and total Sobol indices of every input with their 95 % intervals.

    sobol: a Sobol or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> ranges = {"normal_load": ("50 N", "100 N"), "friction": (0.5, 0.7)}
    >>> sobol = tl.sweeps.sobol(case, ranges, of="largest_pressure", blocks=2)
    >>> tl.plots.sobol_bars(sobol).axes[0].get_xlabel()
    'share of the variance (–)'
    """
    data = fields_of(sobol, "first_order", "total_order").isel(input=slice(_MOST))
    figure, ax = figure_and_axes(ax, 7.0, 1.6 + 0.55 * data.sizes["input"])
    rows = np.arange(data.sizes["input"])[::-1]
    for name, shift, colour, words in (
        ("total_order", 0.19, CASES[0], "total: alone and with others"),
        ("first_order", -0.19, "#8fc3e6", "first order: alone"),
    ):
        values = data[name].to_numpy()
        ax.barh(
            rows + shift, values, height=0.36, color=colour, label=words, xerr=data[f"{name}_interval"].to_numpy(),
            error_kw={"elinewidth": 1.1, "capsize": 2.5, "ecolor": INK},
        )  # fmt: skip
    ax.axvline(0, color=MUTED, lw=0.8)
    ax.set_yticks(rows, [_input(data, k).words for k in range(len(rows))])
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(-0.6, len(rows) - 0.4)
    ax.set_xlim(right=max(1.0, ax.get_xlim()[1]))
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")
    ax.set_xlabel("share of the variance (–)")
    ax.legend(loc="lower right")
    blocks = f"{_place(data)}{data.attrs.get('blocks', 0):g} blocks of {data.attrs.get('cases', 0):g} cases"
    headline(ax, f"Sobol indices of the {_reading(data).words}", f"{blocks}; bars: 95 % intervals")
    return figure


@figure(
    "Morris", name="morris", main=True, title="Morris screening",
    caption="Right: inputs that matter. High: inputs whose effect bends or depends on others.",
)  # fmt: skip
@styled
def morris_effects(morris: Source, *, ax: Axes | None = None) -> Figure:
    """Spread σ of the effects of every input against their mean size μ*, with its 95 % interval.

    morris: a Morris or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = {"profile": {"rolling_radius": 0.3, "crown_radius": 0.3, "width": 0.06}, "inflation_pressure": "8 bar"}
    >>> road = {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]}
    >>> wheel = {"normal_load": "100 N", "friction": 0.7}
    >>> case = tl.Case.from_dict({"tire": tire, "pavement": road, "rolling": wheel, "spacing": "6 mm"})
    >>> morris = tl.sweeps.morris(case, {"normal_load": ("50 N", "100 N")}, of="largest_pressure", trajectories=2)
    >>> tl.plots.morris_effects(morris).axes[0].get_xlabel()
    'μ*: mean size of the effect (kPa)'
    """
    data = fields_of(morris, "absolute_effect", "effect_deviation", "absolute_effect_interval")
    what = _reading(data)
    figure, ax = figure_and_axes(ax, 6.6, 4.6)
    star, sigma, half = (
        what.factor * data[name].to_numpy()
        for name in ("absolute_effect", "effect_deviation", "absolute_effect_interval")
    )
    ax.errorbar(
        star, sigma, xerr=half, fmt="o", ms=5.5, color=CASES[0], elinewidth=1, ecolor=RULE, capsize=2, zorder=3
    )
    top = 1.12 * float(np.nanmax(np.concatenate([star + half, [1e-12]])))
    ax.plot([0, top], [0, top], color=MUTED, lw=0.8, ls=(0, (4, 2)))
    ax.annotate("σ = μ*: bends or interacts", (0.98 * min(top, 1.1 * np.nanmax(sigma) + 1e-12),) * 2, ha="right",
                va="bottom", fontsize=8, color=MUTED)  # fmt: skip
    high = max(1.2 * float(np.nanmax(sigma)), 0.05 * top)
    line = -np.inf
    for k in np.argsort(sigma):
        # Letters of inputs that lie close to each other stand on lines of their own.
        line = max(float(sigma[k]) / high, line + _LINE)
        side = -1 if star[k] > _FAR * top else 1
        ax.annotate(
            _input(data, int(k)).words, (star[k], line * high), xytext=(7 * side, 3), textcoords="offset points",
            ha="right" if side < 0 else "left", fontsize=8.5,
        )  # fmt: skip
    ax.set_xlim(0, top)
    ax.set_ylim(0, high)
    open_axes(ax)
    ax.set_xlabel(f"μ*: mean size of the effect ({what.unit or '–'})")
    ax.set_ylabel(f"σ: spread of the effect ({what.unit or '–'})")
    trajectories = f"{data.attrs.get('trajectories', 0):g} trajectories of {data.attrs.get('cases', 0):g} cases"
    headline(ax, f"Effects on the {what.words}", f"{_place(data)}over the whole range of each input, {trajectories}")
    return figure


def _reading(data: xr.Dataset) -> Shown:
    """How the result that was asked for is drawn."""
    name = str(data.attrs.get("of", "reading"))
    values = np.concatenate(
        [np.ravel(data[key].to_numpy()) for key in ("reading_low", "reading_high", "absolute_effect") if key in data]
        or [np.zeros(1)]
    )
    return shown(xr.DataArray(values, dims="case", attrs={"units": str(data.attrs.get("unit", "1"))}), name)


def _input(data: xr.Dataset, number: int) -> Shown:
    """How an input is drawn."""
    ends = [data[name].to_numpy()[number] for name in ("input_low", "input_high")]
    attrs = {"units": str(data["key_unit"].to_numpy()[number]) or "1"}
    return shown(xr.DataArray(ends, dims="end", attrs=attrs), str(data["key"].to_numpy()[number]))


def _place(data: xr.Dataset) -> str:
    place = str(data.attrs.get("place", ""))
    return f"{place}; " if place else ""
