"""The life of a road: years by criterion, damage across the wheel path, what causes it, what it depends on."""

from __future__ import annotations

import math
import textwrap
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.typing import ColorType

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import (
    CASES,
    INK,
    PAPER,
    RULE,
    headline,
    ink_on,
    legend_below,
    measure,
    plain,
    sequential,
    signed,
    styled,
)
from treadload.units import LASTS, years_in_words

_GOVERNS, _REMAINING = "#d55e00", "#0b6fae"
# A life that is longer than this many times the design life, or than this many years, is drawn as so long.
_FAR, _LONG = 100.0, 1000.0
# Damage below this part of the largest is not drawn.
_LEAST = 1e-3
# By which inputs are changed in the figure: five per cent, one degree.
_PART = 5.0
_LETTERS = 22


_ELASTICITIES = (
    "How the governing life changes as each input grows by 5 %, temperature by 1 °C; the three that weigh most are "
    "bold. Strength: the strain or stress that the law allows."
)


@figure(
    "Life", name="years", main=True, title="Life by criterion", order=0,
    caption="Years from opening until Miner's sum is 1 at the worst place, or the rut is at its limit. Orange: what "
    "governs.",
)  # fmt: skip
@styled
def life_years(life: Source, *, ax: Axes | None = None) -> Figure:
    """Bars of the years that every criterion lasts, and until the rut's limit, with the design life.

    life: a Life or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=820e3)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> life = tl.damage.miner([[[[90e-6, 120e-6, 90e-6]]]], [base], traffic, climate, y=[-0.1, 0.0, 0.1])
    >>> f"the bar is {tl.plots.life_years(life).axes[0].patches[0].get_width():.0f} years long"
    'the bar is 10 years long'
    """
    data = fields_of(life, "life_years")
    names, years = _labels(data["criterion"]), data["life_years"].to_numpy()
    if "rut_limit" in data.attrs:
        names.append(f"rut of {1e3 * float(data.attrs['rut_limit']):g} mm")
        years = np.append(years, float(data.attrs["rut_years"]))
    design = data.attrs.get("design_years")
    far = _FAR * float(design) if design else _LONG
    shown = np.minimum(years, far)
    figure, ax = figure_and_axes(ax, 5.4, 1.5 + 0.55 * len(names))
    rows = np.arange(len(names))[::-1]
    first = int(np.argmin(years))
    colours = [_GOVERNS if k == first else _REMAINING for k in range(len(names))]
    ax.barh(rows, shown, height=0.62, color=colours)
    # Bars on a logarithmic axis have no beginning: take it only where a linear one shows nothing of the shortest.
    largest = max(shown.max(), float(design or 0))
    log = shown.min() < 0.02 * largest
    if log:
        ax.set_xscale("log")
        ax.set_xlim(10 ** math.floor(math.log10(max(shown.min(), 1e-9)) - 0.2), 4 * largest)
    else:
        ax.set_xlim(0, 1.25 * largest)
    for row, value, length in zip(rows, years, shown, strict=True):
        text = years_in_words(value) if value > LASTS else f"{measure(value)} years"
        ax.annotate(text, (length, row), xytext=(5, 0), textcoords="offset points", va="center", fontsize=8.5)
    if design:
        ax.axvline(float(design), color=INK, lw=1.2, ls=(0, (4, 2)))
        ax.annotate(
            f"design, {float(design):g} years", (float(design), 1), xycoords=("data", "axes fraction"),
            xytext=(4, -3), textcoords="offset points", va="top", fontsize=8.5,
        )  # fmt: skip
    ax.set_yticks(rows, names)
    ax.set_ylim(-0.6, len(names) - 0.1)
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")
    ends = "years until the damage is 1" + (", or the rut at its limit" if "rut_limit" in data.attrs else "")
    ax.set_xlabel(ends + (", logarithmic" if log else ""))
    headline(ax, "Life by criterion")
    return figure


@figure(
    "Life", name="damage", title="Damage across the wheel path", wide=True, order=2,
    caption="Miner's sum of every criterion, with lateral wander unless the law includes it; dots mark the worst "
    "places. Full lines are read at the surface, dashed ones below.",
)  # fmt: skip
@styled
def life_damage(life: Source, *, ax: Axes | None = None) -> Figure:
    """Damage across the wheel path by every criterion, with wander where it applies, at the end of the design life or
    of a year.

    life: a Life or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=820e3)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> life = tl.damage.miner([[[[90e-6, 120e-6, 90e-6]]]], [base], traffic, climate, y=[-0.1, 0.0, 0.1])
    >>> figure = tl.plots.life_damage(life)
    >>> f"{max(figure.axes[0].lines[0].get_ydata()):.2f} in the first year"
    '0.10 in the first year'
    """
    data = fields_of(life, "damage_per_year", "worst_y")
    factor, when = _factor(data)
    y = 1e3 * data["y"].to_numpy()
    damage = factor * data["damage_per_year"].to_numpy()
    if not _LEAST * float(damage.max()) > 0:
        raise InputError("no criterion has any damage to draw")
    figure, ax = figure_and_axes(ax, 9.6, 3.6)
    depths = data["read_depth"].to_numpy() if "read_depth" in data else np.full(len(damage), np.nan)
    top = max(float(damage.max()), 1.0)
    handles = []
    for k, (name, row, depth) in enumerate(zip(data["criterion"].to_numpy(), damage, depths, strict=True)):
        colour = CASES[k % len(CASES)]
        where = "" if math.isnan(depth) else " (surface)" if depth == 0 else f" ({1e3 * depth:g} mm deep)"
        style = "-" if depth == 0 else "--"
        if not float(row.max()) > _LEAST * float(damage.max()):
            where += ", less than is drawn"
        (line,) = ax.plot(y, np.where(row > 0, row, np.nan), style, color=colour, label=plain(f"{name}{where}"))
        worst = int(row.argmax())
        ax.plot(y[worst], row[worst], "o", ms=5, color=colour, mec=PAPER, zorder=4)
        handles.append(line)
    ax.axhline(1.0, color=INK, lw=1.0)
    ax.annotate("1: failure", (0.995, 1.0), xycoords=("axes fraction", "data"), xytext=(0, 3),
                textcoords="offset points", ha="right", fontsize=8.5)  # fmt: skip
    ax.set_yscale("log")
    least = _LEAST * float(damage.max())
    ax.set_ylim(0.7 * least, 2.2 * top)
    seen = np.flatnonzero((damage > least).any(axis=0))
    if len(seen) > 1:
        ax.set_xlim(y[seen[0]], y[seen[-1]])
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True)
    ax.set_xlabel("y, right of the middle of the wheel path (mm)")
    ax.set_ylabel(f"damage {when}")
    wander = str(data.attrs.get("wander", ""))
    wide = "life_years_with_wander"
    if wide in data and bool((data["life_years"] != data[wide]).any()):
        wander += ", except for laws that include it"
    headline(ax, "Damage across the wheel path", f"{wander}; full: surface, dashed: below")
    legend_below(ax, handles, columns=min(3, len(handles)))
    return figure


@figure(
    "Life", name="shares", title="Damage by axle class and season", wide=True, order=3,
    caption="Shares of the governing damage at its worst place by class of axles and season; blank: below 0.5 %.",
)  # fmt: skip
@styled
def life_shares(life: Source, criterion: str | None = None) -> Figure:
    """Map of the damage that every class of axles does in every season, at the worst place.

    life: a Life or its dataset. criterion: by which; left out, the governing one. Returns the figure. Raises
    InputError for an unknown criterion and if variables are missing.

    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=820e3)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e5), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> life = tl.damage.miner([[[[90e-6, 120e-6, 90e-6]]]], [base], traffic, climate, y=[-0.1, 0.0, 0.1])
    >>> figure = tl.plots.life_shares(life)
    >>> f"{figure.axes[0].collections[0].get_array().max():.0f} % by the only class in the only season"
    '100 % by the only class in the only season'
    """
    data = fields_of(life, "damage_share", "life_years")
    names = [str(name) for name in data["criterion"].to_numpy()]
    chosen = names[int(data["life_years"].to_numpy().argmin())] if criterion is None else criterion
    if chosen not in names:
        raise InputError(f"no criterion {chosen!r}; this life has {', '.join(names)}")
    share = 100 * data["damage_share"].sel(criterion=chosen).to_numpy()
    classes, seasons = _labels(data["axle_class"]), [str(name) for name in data["season"].to_numpy()]
    rows, columns = share.shape
    figure = new_figure(9.6, 1.7 + 0.36 * rows)
    grid = figure.add_gridspec(1, 2, width_ratios=[5.5, 1], wspace=0.02)
    ax, side = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    mesh = ax.pcolormesh(
        np.arange(columns + 1), np.arange(rows + 1), share, cmap=sequential("strain"), vmin=0,
        edgecolors=PAPER, linewidth=0.8,
    )  # fmt: skip
    if rows * columns <= 400:
        for row, column in np.ndindex(rows, columns):
            value = share[row, column]
            if value >= 0.5:
                ax.text(column + 0.5, row + 0.5, f"{value:.0f}", ha="center", va="center", fontsize=7.5,
                        color=ink_on(cast("ColorType", mesh.cmap(mesh.norm(value)))))  # fmt: skip
    ax.set_yticks(np.arange(rows) + 0.5, classes)
    short = [name[:3] if len(seasons) == 12 else textwrap.fill(plain(name), 10) for name in seasons]
    ax.set_xticks(np.arange(columns) + 0.5, short)
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    ax.invert_yaxis()
    headline(ax, "Damage by axle class and season", f"{plain(chosen)}: per cent of its damage at the worst place")
    totals = share.sum(axis=1)
    side.barh(np.arange(rows) + 0.5, totals, height=0.62, color=RULE)
    for row, value in enumerate(totals):
        side.annotate(f"{value:.0f} %", (value, row + 0.5), xytext=(3, 0), textcoords="offset points", va="center",
                      fontsize=8)  # fmt: skip
    side.set_ylim(rows, 0)
    side.set_xlim(0, 1.5 * totals.max() if totals.max() > 0 else 1)
    side.set_yticks([])
    side.set_xticks([])
    side.spines[:].set_visible(False)
    headline(side, "", "all seasons")
    mesh.set_rasterized(True)
    return figure


@figure("Sensitivity", name="inputs", main=True, title="What the life depends on", caption=_ELASTICITIES)
@figure(
    "Life", name="inputs", title="What the life depends on", order=1, caption=_ELASTICITIES,
    when=lambda data: "elasticity" in data,
)  # fmt: skip
@styled
def life_inputs(life: Source, *, ax: Axes | None = None, most: int = 10) -> Figure:
    """Bars of how much longer the governing criterion lasts as an input grows by 5 %, temperature by 1 °C.

    life: a Sensitivity or its dataset. most: inputs to draw. Returns the
    figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> sensitivity = tl.life.life_sensitivity(design, life)
    >>> figure = tl.plots.life_inputs(sensitivity, most=3)
    >>> f"{max(bar.get_width() for bar in figure.axes[0].patches):.0f} % longer"
    '40 % longer'
    """
    data = fields_of(life, "elasticity")
    names, values = [str(n) for n in data["input"].to_numpy()], data["elasticity"].to_numpy()
    change = np.array([life_change(n, v) for n, v in zip(names, values, strict=True)])[:most]
    names = names[:most]
    figure, ax = figure_and_axes(ax, 5.4, 1.5 + 0.29 * len(names))
    rows = np.arange(len(names))[::-1]
    ax.barh(rows, change, height=0.66, color=[_GOVERNS if v < 0 else _REMAINING for v in change])
    for row, value in zip(rows, change, strict=True):
        side = 1 if value >= 0 else -1
        ax.annotate(f"{signed(value)} %", (value, row), xytext=(4 * side, 0), textcoords="offset points",
                    va="center", ha="left" if side > 0 else "right", fontsize=8)  # fmt: skip
    ax.axvline(0, color=INK, lw=0.8)
    wide = 1.45 * max(float(np.abs(change).max()), 1e-9)
    ax.set_xlim(-wide, wide)
    labels = [plain(n.replace("temperature (per °C)", "temperature, +1 °C")) for n in names]
    ax.set_yticks(rows, [textwrap.fill(label, 26) for label in labels])
    for label in ax.get_yticklabels()[:3]:
        label.set_fontweight("bold")
    ax.tick_params(axis="y", length=0)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")
    ax.set_xlabel("change of the life as the input grows by 5 % (%)")
    headline(ax, "What the life depends on")
    ax.legend(
        handles=[Patch(color=_REMAINING, label="longer"), Patch(color=_GOVERNS, label="shorter")], loc="lower right"
    )
    return figure


def life_change(name: str, elasticity: float) -> float:
    """Change of the life, %, as the input grows by 5 %, temperature by 1 °C."""
    if name.startswith("temperature"):
        return 100 * math.expm1(elasticity)
    return float(100 * ((1 + _PART / 100) ** elasticity - 1))


def _factor(data: xr.Dataset) -> tuple[float, str]:
    """Damage at the end of the design life over that of the first year, and the words for it."""
    if "design_damage" not in data:
        return 1.0, "of the first year"
    yearly = data["damage_per_year"].max("y").to_numpy()
    row = int(yearly.argmax())
    if not yearly[row] > 0:
        return 1.0, "of the first year"
    factor = float(data["design_damage"].to_numpy()[row] / yearly[row])
    return factor, f"after {float(data.attrs['design_years']):g} years"


def _labels(names: xr.DataArray) -> list[str]:
    return [textwrap.fill(plain(str(name)), _LETTERS) for name in names.to_numpy()]
