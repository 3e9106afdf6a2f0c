"""The first crack from the surface: which way it runs, where, under which load and season, and what opens it."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.damage.cracks import ORIENTATIONS
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import INK, MUTED, ORIENTATION_COLOURS, halo, headline, plain, styled
from treadload.units import repetitions_in_words

_CAUSES = ("#8a3b74", "#0b6fae", "#d55e00")
# Half the length of a crack's stroke, as a part of the drawn width and height.
_ALONG, _ACROSS = 0.16, 0.09


def _opened(data: xr.Dataset) -> list[str]:
    """Criteria with a first crack from the surface, the first to fail first."""
    shares = np.isfinite(data["cause_share"].to_numpy()).all(axis=1)
    order = np.argsort(data["life_years"].to_numpy(), kind="stable")
    return [str(data["criterion"].to_numpy()[k]) for k in order if shares[k]]


@figure(
    "Life", name="first_crack", title="First crack from the surface", wide=True, order=8.5,
    caption="Left: where a transverse and a longitudinal crack start first under the load and in the season that do "
    "most of the damage, and after how many repetitions of that load; the strain is the largest across the crack. "
    "Right: what opens the crack at the worst place: hogging beyond 80 mm from every footprint, the tread, and what "
    "braking or driving adds over the same wheels rolling freely.",
    when=lambda data: "cause_share" in data and bool(_opened(data)),
)  # fmt: skip
@styled
def first_crack(life: Source, *, criterion: str | None = None) -> Figure:
    """Where and which way the first crack from the surface runs, and shares of what opens it.

    life: a Life or its dataset. criterion: one that reads a tensile strain at the surface; left out, and for another,
    the first of these to fail. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "top")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> tl.plots.first_crack(life).axes[0].get_title(loc="left")
    'First crack: transverse'
    """
    data = fields_of(life, "crack_repetitions", "crack_place", "crack_strain", "cause_share", "damage_share")
    names = _opened(data)
    name = criterion if criterion in names else next(iter(names), None)
    figure = new_figure(9.6, 3.5)
    plan, bars = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    if name is None:
        headline(plan, "No crack from the surface")
        return figure
    at = data.sel(criterion=name)
    _plan(plan, at, name)
    _bars(bars, at)
    return figure


def _plan(ax: Axes, at: xr.Dataset, name: str) -> None:
    """Strokes of both cracks, seen from above, the first to start in its colour and with a thick stroke."""
    directions = [str(word) for word in at["direction"].to_numpy()]
    counts, places, strains = (
        at[f"crack_{key}"].to_numpy().astype(float) for key in ("repetitions", "place", "strain")
    )
    wide = 1.4 * max(float(np.nanmax(np.abs(places), initial=0.0)), 0.3) * 1e3
    first = int(np.argmin(counts))
    for level, number in enumerate(np.argsort(counts, kind="stable")):
        word, y = directions[number], 1e3 * places[number]
        middle = 0.72 - 0.46 * level
        never = math.isinf(counts[number])
        colour = MUTED if never else ORIENTATION_COLOURS[ORIENTATIONS.index(word)]
        if not never:
            along = word == "longitudinal"
            x = [y, y] if along else [y - _ALONG * wide, y + _ALONG * wide]
            z = [middle - _ACROSS, middle + _ACROSS] if along else [middle, middle]
            ax.plot(x, z, color=colour, lw=4.0 if number == first else 2.0, solid_capstyle="round", zorder=3)
        when = "never" if never else f"after {repetitions_in_words(counts[number])} repetitions"
        more = "" if never else f"\ny = {y:z.0f} mm, {1e6 * strains[number]:.3g} microstrain"
        ax.annotate(
            f"{word}: {when}{more}", (0.0 if never else y, middle - _ACROSS), xytext=(0, -3),
            textcoords="offset points", ha=_side(y / wide), va="top", fontsize=8.5, color=INK, path_effects=halo(3),
            zorder=4, linespacing=1.3,
        )  # fmt: skip
    ax.axvline(0.0, color=MUTED, lw=0.8, ls=":")
    ax.set_xlim(-wide, wide)
    ax.set_ylim(0.0, 1.0)
    ax.set_yticks([])
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.set_xlabel("y, right of the middle of the wheel path (mm)")
    share = at["damage_share"].to_numpy()
    row, season = np.unravel_index(int(share.argmax()), share.shape)
    load, part = plain(str(at["axle_class"].to_numpy()[row])), plain(str(at["season"].to_numpy()[season]))
    which = "No crack" if math.isinf(counts[first]) else f"First crack: {directions[first]}"
    headline(ax, which, f"{plain(name)}\nunder {load} in {part}, {100 * share.max():.0f} % of the damage")


def _side(part: float) -> str:
    """Where a text stands at a part of the half width, so that it stays inside."""
    return "left" if part < -0.4 else "right" if part > 0.4 else "center"


def _bars(ax: Axes, at: xr.Dataset) -> None:
    """Shares of the causes in the damage at the worst place."""
    causes, shares = [str(word) for word in at["cause"].to_numpy()], 100 * at["cause_share"].to_numpy()
    rows = np.arange(len(causes))[::-1]
    ax.barh(rows, shares, height=0.6, color=[_CAUSES[k % len(_CAUSES)] for k in range(len(causes))])
    for row, value in zip(rows, shares, strict=True):
        ax.annotate(
            f"{value:z.0f} %", (value, row), xytext=(4, 0), textcoords="offset points", va="center", fontsize=9
        )
    ax.set_yticks(rows, causes)
    ax.tick_params(axis="y", length=0)
    ax.set_xlim(0, 118)
    ax.set_xticks([0, 50, 100])
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.set_xlabel("share of the damage of that load (%)")
    headline(ax, "What opens it", f"at the worst place,\ny = {1e3 * float(at['worst_y']):z.0f} mm")
