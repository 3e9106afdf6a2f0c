"""Where a road would crack first, by which criterion: the places of all criteria, and how much of each is used."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from treadload.composing import Source
from treadload.damage.cracks import opens_down
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import INK, MUTED, PAPER, halo, headline, legend_below, plain, styled

_COLOURS = {"crack": "#d55e00", "other": "#0b6fae", "none": "#9aa3ad"}
_WORDS = {"crack": "a crack opens", "other": "it splits, shoves or ruts", "none": "no damage"}
# Places nearer to each other than this, m, share a mark.
_NEAR = 0.012
_SHALLOW = 0.02
# Criteria that a mark names.
_NUMBERS = 3


@figure(
    "Life", name="first", title="All criteria side by side", wide=True, order=8,
    caption="Left: where each is worst, by its number in the order of failing. Right: its largest reading over what "
    "its law allows; beyond the dashed line it fails within the load repetitions counted.",
    when=lambda data: {"design_utilisation", "read_depth"} <= set(data) and "proposed" in data.attrs,
)  # fmt: skip
@styled
def first_places(life: Source) -> Figure:
    """Where each criterion is worst, in a section across the road, and its reading over what its law allows.

    life: a Life or its dataset; numbers follow the order in which the criteria fail. Returns the figure. Raises
    InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> [ax.get_title(loc="left") for ax in tl.plots.first_places(life).axes]
    ['Where', 'How near to its end']
    """
    data = fields_of(life, "worst_y", "design_utilisation", "life_years", "read_depth", "largest_reading")
    order = failing_order(data)
    kinds = [crack_or_not(data, k) for k in order]
    figure = new_figure(9.6, 1.7 + 0.36 * max(len(order), 4))
    section, bars = figure.subplots(1, 2, width_ratios=(1.0, 1.0))
    _section(section, 1e3 * data["worst_y"].to_numpy()[order], 1e3 * data["read_depth"].to_numpy()[order], kinds,
             data["largest_reading"].to_numpy()[order] > 0)  # fmt: skip
    _bars(bars, [str(name) for name in data["criterion"].to_numpy()[order]], data, order, kinds)
    legend_below(bars, [Patch(color=_COLOURS[kind], label=_WORDS[kind]) for kind in dict.fromkeys(kinds)])
    return figure


def failing_order(data: Source) -> list[int]:
    """Numbers of the criteria of a life, the first to fail first; those that never do by how much is used."""
    fields = fields_of(data, "life_years", "design_utilisation")
    years, used = (fields[name].to_numpy() for name in ("life_years", "design_utilisation"))
    return [int(k) for k in np.lexsort((-used, years))]


def crack_or_not(data: Source, number: int) -> str:
    """What the damage of a criterion does: "crack" where one runs down, "other", or "none" without damage."""
    fields = fields_of(data, "life_passes")
    if np.isinf(float(fields["life_passes"][number])):
        return "none"
    if "orientation_damage" not in fields:
        return "other"
    shares = fields["orientation_damage"].isel(criterion=number)
    most = str(shares["orientation"].to_numpy()[int(np.argmax(shares.to_numpy()))])
    return "crack" if opens_down(most) and float(shares.max()) > 0 else "other"


def _section(ax: Axes, y: Array, depth: Array, kinds: list[str], read: BoolArray) -> None:
    """Marks with the numbers of the criteria that are worst there; criteria side by side share one.

    read: which of them read anything at all.
    """
    shared: list[list[int]] = []
    for k in np.flatnonzero(read):
        apart = [np.hypot(y[pair[0]] - y[k], depth[pair[0]] - depth[k]) for pair in shared]
        if apart and min(apart) < 1e3 * _NEAR:
            shared[int(np.argmin(apart))].append(int(k))
        else:
            shared.append([int(k)])
    ax.axhline(0.0, color=INK, lw=1.2)
    wide = 1.25 * max(float(np.abs(y[read]).max(initial=0.0)), 100.0)
    last, level = -np.inf, 0
    for pair in sorted(shared, key=lambda pair: y[pair[0]]):
        at = (y[pair[0]], depth[pair[0]])
        # Numbers of neighbours stand below each other.
        level = (level + 1) % 4 if at[0] - last < 0.3 * wide else 0
        last = at[0]
        text = ", ".join(str(k + 1) for k in pair[:_NUMBERS]) + (" …" if len(pair) > _NUMBERS else "")
        ax.plot(*at, "o", ms=9, color=_COLOURS[kinds[pair[0]]], mec=PAPER, zorder=4, clip_on=False)
        ax.annotate(
            text, at, xytext=(0, -8 - 11 * level), textcoords="offset points", fontsize=8.5, ha="center", va="top",
            path_effects=halo(2), zorder=5,
        )  # fmt: skip
    deepest = max(float(np.nanmax(depth, initial=0.0)), 1e3 * _SHALLOW)
    ax.set_ylim(1.3 * deepest, -0.06 * deepest)
    ax.set_xlim(-wide, wide)
    ax.axvline(0.0, color=MUTED, lw=0.8, ls=":")
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_xlabel("y, right of the middle of the wheel path (mm)")
    ax.set_ylabel("depth (mm)")
    headline(ax, "Where", "each criterion at its worst, seen along travel", letters=40)


def _bars(ax: Axes, names: list[str], data: Source, order: list[int], kinds: list[str]) -> None:
    fields = fields_of(data, "design_utilisation")
    used = fields["design_utilisation"].to_numpy()[order]
    rows = np.arange(len(order))[::-1]
    ax.barh(rows, used, height=0.62, color=[_COLOURS[kind] for kind in kinds])
    for row, value in zip(rows, used, strict=True):
        ax.annotate(
            f"{value:.2g}", (value, row), xytext=(4, 0), textcoords="offset points", va="center", fontsize=8.5,
            path_effects=halo(3), zorder=4,
        )  # fmt: skip
    ax.axvline(1.0, color=INK, lw=1.2, ls=(0, (4, 2)))
    ax.set_yticks(rows, [plain(f"{k}  {name}") for k, name in enumerate(names, start=1)])
    ax.tick_params(axis="y", length=0)
    ax.set_xlim(0, 1.2 * max(1.0, float(used.max(initial=0.0))))
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.grid(True, axis="x")
    years = fields.attrs.get("design_years")
    ax.set_xlabel("reading / allowed for " + (f"{float(years):g} years" if years else "a year"))
    headline(ax, "How near to its end", "in the order of failing", letters=40)
