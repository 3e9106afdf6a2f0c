"""Figures of an assessment: the fatigue line, passes and cracks in plan."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from treadload.composing import Source
from treadload.damage.cracks import HORIZONTAL, ORIENTATIONS
from treadload.damage.laws.fatigue import FatigueLine
from treadload.damage.verdict import under
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import comparison, figure
from treadload.kernels.largest import index_of_largest
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.plan import (
    MICRO,
    Limits,
    Plan,
    colour_bar,
    draw_cells,
    empty_note,
    fields_of,
    frame_plan,
    limits,
    mark_peak,
    plane,
)
from treadload.plots.kit.strokes import draw_strokes, strokes
from treadload.plots.kit.style import (
    CASES,
    INK,
    MUTED,
    ORIENTATION_COLOURS,
    halo,
    headline,
    legend_below,
    measure,
    plain,
    power_of_ten,
    sequential,
    signed,
    styled,
    travel_arrow,
)
from treadload.plots.response import DRAWN

_READS = {"principal": "three-dimensional", "in-plane": "horizontal-plane"}
_MILLION = 1e6
# Cracks are drawn where the strain reaches this share of the largest.
_SIGNIFICANT = 0.2
# Share of the axis left of the last point's label; distance below which points are listed in a legend.
_LABELLED = 0.7
_CROWDED = 0.1
# Decades of passes above the fewest that get a colour of their own.
_DECADES = 6
# Passes between which figures are drawn: laws reach 10³⁰⁸, of which no axis can show a decade more.
_DRAWN = (1e-30, 1e30)


def _drawn(data: xr.Dataset) -> str:
    """The strain of an assessment in words."""
    return DRAWN["in-plane" if data.attrs.get("strain") == "in-plane" else "principal"]


@comparison(
    "Verdict", title="Fatigue line, all cases",
    caption="Each case is marked where its worst strain meets its line; below it, the load repetitions "
    "that the line allows.",
)  # fmt: skip
@figure(
    "Verdict", title="Fatigue line", wide=True,
    caption=lambda data: f"The case is marked where {_drawn(data)} at its worst meets the line; below it, the load "
    "repetitions allowed.",
)  # fmt: skip
@styled
def fatigue_line(
    verdicts: Source | Sequence[Source],
    labels: Sequence[str] | None = None,
    *,
    design_passes: float | None = None,
    ax: Axes | None = None,
) -> Figure:
    """The fatigue line, ε₆ on it, and where the worst strain of each case meets it.

    verdicts: one or several, with worst_strain, worst_passes and the attributes epsilon_6 and slope.
    labels: a name each. design_passes: traffic whose admissible strain is marked. ax: axes to draw into.
    Returns the figure. Raises InputError if labels and assessments differ in number or attributes are missing.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=[0.0])
    >>> verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2), depth=0.15)
    >>> tl.plots.fatigue_line(verdict).axes[0].get_ylabel()
    'largest tensile strain (microstrain)'
    """
    cases = [fields_of(v, "worst_strain", "worst_passes") for v in _listed(verdicts)]
    names = list(labels) if labels is not None else [""] * len(cases)
    if len(names) != len(cases) or not cases:
        raise InputError(f"give a label for each verdict: got {len(names)} labels for {len(cases)} verdicts")
    lines = [_line(case) for case in cases]
    figure, ax = figure_and_axes(ax, 7.2, 4.7)
    points = [(float(c["worst_passes"]), float(c["worst_strain"]) * MICRO) for c in cases]
    _check_drawn([n for n, strain in points if strain > 0 and math.isfinite(n)])
    reached = [n for n, strain in points if strain > 0 and math.isfinite(n)] + [_MILLION]
    low = 10.0 ** math.floor(math.log10(min(1e4, min(reached) / 4)))
    # The label stands right of its point, where the line has gone down: leave room for it.
    high = low * (max(1e7, max(reached)) / low) ** (1 / _LABELLED)
    passes = np.array([low, high])
    for number, line in enumerate(dict.fromkeys(lines)):
        style = ("-", (0, (5, 2)), (0, (1, 1.5)))[number % 3]
        ax.plot(passes, line.allowable_strain(passes) * MICRO, color=INK, lw=1.4, ls=style, zorder=2)
        _mark_million(ax, line, low)
    if design_passes is not None:
        admissible = float(lines[0].allowable_strain(design_passes)) * MICRO
        ax.axvline(design_passes, color=MUTED, lw=0.9, ls=":")
        _note(ax, design_passes, admissible, f"design traffic allows {admissible:.0f}", (5, 4), INK)
    near = _crowded([*reached], low, high)
    for number, ((n, strain), name) in enumerate(zip(points, names, strict=True)):
        _mark_case(ax, n, strain, name, CASES[number % len(CASES)], low, near)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlim(low, high)
    strains = [s for _, s in points if s > 0]
    drawn = [float(v) * MICRO for line in lines for v in line.allowable_strain(passes)]
    ax.set_ylim(min([*drawn, *strains]) / 1.25, max([*drawn, *strains]) * 1.25)
    _plain_strains(ax)
    ax.set_xlabel("load repetitions, N")
    ax.set_ylabel("largest tensile strain (microstrain)")
    ax.grid(True, which="major")
    ax.spines[["top", "right"]].set_visible(False)
    reads = sorted({_READS.get(str(c.attrs.get("strain", "principal")), "") for c in cases})
    headline(ax, "Fatigue line", f"ε = ε₆ (N / 10⁶)ᵇ; the worst {' or '.join(reads)} strain of each case on it")
    return figure


@figure(
    "Verdict", main=True, title="Allowable load repetitions",
    caption=lambda data: f"From {_drawn(data)}, under {under(data)}. The darkest places allow the fewest load "
    "repetitions; white ones a million times more, or have no tensile strain.",
)  # fmt: skip
@styled
def passes(verdict: Source, *, ax: Axes | None = None) -> Figure:
    """Passes that the fatigue line allows, in plan, on a logarithmic scale.

    verdict: with allowable_passes (y, x). The darkest cells allow the fewest; what allows a million times more
    stays white. ax: axes to draw into. Returns the figure.
    """
    data = fields_of(verdict, "allowable_passes")
    plan, values = Plan.of(data), plane(data, "allowable_passes")
    figure, ax = figure_and_axes(ax, 6.6, min(9.0, max(2.8, 4.85 * plan.aspect + 1.2)))
    finite = values[np.isfinite(values)]
    if not finite.size:
        frame_plan(ax, plan)
        empty_note(ax, f"no tensile strain here:\nthe line sets no limit{_beyond(data)}")
        headline(ax, "Allowable load repetitions")
        return figure
    row, column = np.unravel_index(int(np.nanargmin(values)), values.shape)
    least, x, y = float(finite.min()), float(plan.x[column]), float(plan.y[row])
    worst, worst_x, worst_y = (float(data[f"worst_{name}"]) for name in ("passes", "x", "y"))
    # The worst point lies between those of the map; beyond the map it is named alone.
    if worst < least and plan.x[0] <= worst_x <= plan.x[-1] and plan.y[0] <= worst_y <= plan.y[-1]:
        least, x, y = worst, worst_x, worst_y
    _check_drawn([least])
    low, high = 10.0 ** math.floor(math.log10(least)), 10.0 ** (math.floor(math.log10(least)) + _DECADES)
    mesh = draw_cells(ax, plan, np.minimum(values, 10 * high), sequential("strain").reversed(), Limits(low, high))
    mesh.set_norm(LogNorm(low, high))
    bar = colour_bar(mesh, ax, "allowable load repetitions", Limits(low, high, True))
    decades = [low * 10.0**k for k in range(_DECADES + 1)]
    bar.set_ticks(decades, labels=[_decade(passes) for passes in decades])
    bar.minorticks_off()
    mark_peak(ax, x, y, power_of_ten(least))
    headline(
        ax, "Allowable load repetitions", f"fewest {power_of_ten(least)}; {_line_in_words(data)}{_first_beyond(data)}"
    )
    travel_arrow(ax)
    return figure


@figure(
    "Verdict", title="Cracks to expect", answers=True,
    caption=lambda data: f"Traces on the surface of cracks across the largest tensile strain, evaluated from "
    f"{_drawn(data)}: longitudinal along travel, transverse across it, oblique between; planes nearer to the "
    "horizontal than 45° as points, where the road splits and no crack runs down. Drawn where a principal stress is "
    "tensile and the strain is significant; the ring marks the largest such strain.",
)  # fmt: skip
@styled
def cracks(verdict: Source, *, ax: Axes | None = None) -> Figure:
    """Traces of the cracks that the largest extension opens, in plan, coloured by their orientation.

    verdict: with extension_strain, crack_angle, crack_dip and crack_orientation (y, x). A stroke shortens as the
    crack's plane flattens; drawn where the strain is a fifth of the largest or more. ax: axes to draw into.
    Returns the figure.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=y)
    >>> verdict = tl.assess(response, tl.FatigueLine(120e-6, -0.2), depth=0.15)
    >>> tl.plots.cracks(verdict).axes[0].get_title(loc="left")
    'Cracks to expect'
    """
    data = fields_of(verdict, "extension_strain", "crack_angle", "crack_dip", "crack_orientation")
    plan, values = Plan.of(data), plane(data, "extension_strain") * MICRO
    figure, ax = figure_and_axes(ax, 6.8, min(9.2, max(3.0, 5.0 * plan.aspect + 1.45)))
    scale = limits(values)
    mesh = draw_cells(ax, plan, values, sequential("strain"), scale)
    mesh.set_alpha(0.45)
    reads = _READS.get(str(data.attrs.get("strain", "principal")), "")
    colour_bar(mesh, ax, f"tensile strain, {reads} (microstrain)", scale)
    angle, dip = plane(data, "crack_angle"), plane(data, "crack_dip")
    classes = plane(data, "crack_orientation").astype(int)
    flat = np.where(np.isnan(angle), 0.0, np.sin(np.nan_to_num(dip)))
    turned = np.nan_to_num(angle)
    # Where no principal stress is tensile the class is none: no crack opens there, however much the road extends.
    opening = np.where(classes > 0, values, 0.0)
    drawn = strokes(opening, flat * np.cos(turned), flat * np.sin(turned), plan.x, plan.y, _SIGNIFICANT * scale.high)
    if len(drawn.index) and np.nanmax(opening) > 0:
        codes = classes[drawn.index[:, 0], drawn.index[:, 1]]
        draw_strokes(ax, drawn, [ORIENTATION_COLOURS[code] for code in codes], 1.5)
        present = [code for code in range(1, len(ORIENTATIONS)) if (codes == code).any()]
        lines = [
            Line2D([], [], color=ORIENTATION_COLOURS[code], lw=2.2, label=ORIENTATIONS[code]) for code in present
        ]
        legend_below(ax, lines)
        row, column = index_of_largest(opening)
        mark_peak(ax, float(plan.x[column]), float(plan.y[row]), measure(float(opening[row, column])))
        splits = bool((codes == HORIZONTAL).all())
        title = "Planes that split, nearer to the horizontal" if splits else "Cracks to expect"
        first = _first_beyond(data) or "; first at the ring"
        headline(ax, title, f"traces across the largest tensile strain, {reads}{first}")
    else:
        empty_note(
            ax,
            "no tensile strain here"
            if not np.nanmax(values) > 0
            else f"no tensile stress\nwhere the strain is tensile{_beyond(data)}",
        )
        first = "No crack to expect in this map" if _beyond(data) else "No crack to expect"
        headline(ax, first, f"tensile strain, {reads}")
    travel_arrow(ax)
    return figure


def _beyond(data: xr.Dataset) -> str:
    """Where the first crack opens if none does in the map, on a line of its own; empty where none opens at all."""
    if "worst_strain" not in data or not float(data["worst_strain"]) > 0:
        return ""
    x, y, strain = (float(data[f"worst_{name}"]) for name in ("x", "y", "strain"))
    return f";\n{measure(strain * MICRO)} microstrain beyond the map,\nat x = {1e3 * x:.0f} mm, y = {1e3 * y:.0f} mm"


def _first_beyond(data: xr.Dataset) -> str:
    """Where the first crack opens, if only smaller strains open cracks in the map; else empty."""
    if "worst_strain" not in data:
        return ""
    inside = True
    for name in ("x", "y"):
        at, worst = data[name].to_numpy(), float(data[f"worst_{name}"])
        cell = float(at[-1] - at[0]) / max(len(at) - 1, 1)
        inside &= bool(at[0] - cell <= worst <= at[-1] + cell)
    if inside:
        return ""
    x, y, strain = (float(data[f"worst_{name}"]) for name in ("x", "y", "strain"))
    where = f"x = {1e3 * x:.0f} mm, y = {1e3 * y:.0f} mm"
    return f";\nfirst beyond the map: {measure(strain * MICRO)} microstrain at {where}"


def _decade(passes: float) -> str:
    """A power of ten in characters that need no mathematics."""
    return power_of_ten(passes).removeprefix("1.0×")


def _listed(verdicts: Source | Sequence[Source]) -> list[Source]:
    return list(verdicts) if isinstance(verdicts, Sequence) else [verdicts]


def _check_drawn(passes: Sequence[float]) -> None:
    beyond = [n for n in passes if not _DRAWN[0] <= n <= _DRAWN[1]]
    if beyond:
        low, high = _DRAWN
        raise InputError(
            f"{beyond[0]:.2g} load repetitions lie beyond all that is drawn, {low:g} to {high:g}; read the numbers"
        )


def _line(data: xr.Dataset) -> FatigueLine:
    missing = [name for name in ("epsilon_6", "slope") if name not in data.attrs]
    if missing:
        raise InputError(f"the verdict's dataset lacks the attribute {' and '.join(missing)} of its fatigue line")
    return FatigueLine(float(data.attrs["epsilon_6"]), float(data.attrs["slope"]))


def _line_in_words(data: xr.Dataset) -> str:
    if "epsilon_6" not in data.attrs:
        return "line unknown"
    return (
        f"ε₆ = {float(data.attrs['epsilon_6']) * MICRO:g} microstrain, slope {signed(float(data.attrs['slope']), 2)}"
    )


def _mark_million(ax: Axes, line: FatigueLine, low: float) -> None:
    strain = line.epsilon_6 * MICRO
    ax.plot([low, _MILLION, _MILLION], [strain, strain, 1e-3], color=MUTED, lw=0.8, ls=(0, (2, 2)), zorder=1)
    ax.plot([_MILLION], [strain], "s", ms=5, color=INK, zorder=4)
    _note(ax, _MILLION, strain, f"ε₆ = {strain:g} at 10⁶ load repetitions", (7, 5), INK)


def _crowded(passes: Sequence[float], low: float, high: float) -> bool:
    """True when points on the line are too close for a label each."""
    places = np.sort(np.log(passes)) / math.log(high / low)
    return bool((np.diff(places) < _CROWDED).any())


def _mark_case(ax: Axes, passes: float, strain: float, name: str, colour: str, low: float, crowded: bool) -> None:
    title = f"{plain(name)}: " if name else ""
    # A space first: matplotlib leaves labels that begin with an underscore out of its legends.
    if not (strain > 0 and math.isfinite(passes)):
        ax.plot([], [], "o", color=colour, label=f" {title}no tensile strain")
    else:
        ax.plot([low, passes, passes], [strain, strain, 1e-3], color=colour, lw=1.0, alpha=0.75, zorder=1.5)
        words = f"{title}{strain:.3g} microstrain", f"{power_of_ten(passes)} load repetitions"
        ax.plot(
            [passes], [strain], "o", ms=7.5, color=colour, mec="white", mew=1.2, zorder=5,
            label=" " + ", ".join(words) if crowded else "_",
        )  # fmt: skip
        if not crowded:
            _note(ax, passes, strain, "\n".join(words), (9, 2), colour)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right")


def _note(ax: Axes, x: float, y: float, text: str, shift: tuple[float, float], colour: str) -> None:
    ax.annotate(
        text, (x, y), xytext=shift, textcoords="offset points", color=colour, fontsize=8.5, ha="left", va="bottom",
        path_effects=halo(3), zorder=6, linespacing=1.3,
    )  # fmt: skip


def _plain_strains(ax: Axes) -> None:
    """Ticks 20, 50, 100, 200 instead of powers."""
    low, high = ax.get_ylim()
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    ticks = [m * 10.0**e for e in range(first, last + 1) for m in (1, 2, 5) if low <= m * 10.0**e <= high]
    ax.set_yticks(ticks, [f"{t:g}" for t in ticks])
    ax.minorticks_off()
