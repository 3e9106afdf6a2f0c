"""A computed contact beside a measured footprint: maps, difference, cuts, ribs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import Drawing, figure
from treadload.kernels.arrays import Array, BoolArray
from treadload.plots.kit.figure import figure_and_axes, new_figure
from treadload.plots.kit.plan import (
    KPA,
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    Plan,
    colour_bar,
    draw_cells,
    draw_outline,
    fields_of,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.style import (
    CASES,
    MUTED,
    headline,
    measure,
    named_map,
    open_axes,
    sequential,
    signed,
    styled,
    thousands,
    travel_arrow,
)

_COMPUTED, _MEASURED = CASES[0], CASES[1]
# Width of a map, inches.
_PANEL = 4.0
_OF_RIBS = ("rib_share", "rib_left", "rib_right")
# The scale of a difference covers all but this share of it: edges of contact, a sensel off, differ by all there is.
_QUIET = 0.995


_MEANS = "Means over the sensels of the sensor, on one scale; red: more was computed than measured."


@figure(
    "FootprintComparison", name="maps", main=True, title="Computed, measured, and their difference", wide=True,
    caption=_MEANS,
)  # fmt: skip
@styled
def comparison_maps(comparison: Source) -> Figure:
    """The computed contact through the sensor and the footprint on one scale, and their difference, kPa.

    comparison: a FootprintComparison or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measured = tl.Footprint(tl.response.GridLoad(load.grid, 0.9 * load.pressure))
    >>> comparison = tl.compare(load, measured, registration="none")
    >>> [ax.get_title(loc="left") for ax in tl.plots.comparison_maps(comparison).axes[:3]]
    ['Computed, through the sensor', 'Measured', 'Difference']
    """
    data = fields_of(comparison, "computed_pressure", "measured_pressure", "pressure_difference")
    plan = Plan.of(data)
    values = [plane(data, name) * KPA for name in ("computed_pressure", "measured_pressure")]
    scale = limits(*(np.nan_to_num(field) for field in values))
    loaded = np.nan_to_num(values[0] + values[1]) > 0
    view = _view(loaded, plan)
    aspect = float((view[3] - view[2]) / (view[1] - view[0]))
    figure = new_figure(3 * _PANEL + 1.9, min(9.0, (_PANEL - 0.55) * aspect + 1.35), "compressed")
    axes: list[Axes] = list(figure.subplots(1, 3, sharex=True, sharey=True))
    titles = (("Computed, through the sensor", "seen"), ("Measured", "measured"))
    for ax, here, (title, which) in zip(axes, values, titles, strict=False):
        mesh = draw_cells(ax, plan, np.where(here > 0, here, np.nan), sequential("pressure"), scale)
        draw_outline(ax, np.nan_to_num(here) > 0, plan, MUTED, 0.5)
        at = peak_of(here)
        mark_peak(ax, float(plan.x[at[1]]), float(plan.y[at[0]]), f"{measure(float(here[at]))} kPa")
        headline(ax, title, _in_numbers(data, which), 30)
    colour_bar(mesh, axes[1], "contact pressure (kPa)", scale)
    difference = plane(data, "pressure_difference") * KPA
    most = float(np.quantile(np.abs(difference[loaded]), _QUIET)) if loaded.any() else 1.0
    both = Limits(-max(most, 1e-9), max(most, 1e-9))
    mesh = draw_cells(axes[2], plan, np.where(loaded, difference, np.nan), named_map("RdBu_r"), both)
    draw_outline(axes[2], np.nan_to_num(values[1]) > 0, plan, MUTED, 0.5)
    bar = colour_bar(mesh, axes[2], "computed less measured (kPa)", both)
    bar.ax.yaxis.set_major_locator(MaxNLocator(7, steps=[1, 2, 5, 10]))
    headline(axes[2], "Difference", _agreement(data), 30)
    for ax in axes:
        ax.set_xlim(view[0], view[1])
        ax.set_ylim(view[3], view[2])
    for ax in axes[1:]:
        ax.set_ylabel("")
    if not _askew(data):
        travel_arrow(axes[0])
    return figure


def _compared(data: xr.Dataset, beside: Mapping[str, xr.Dataset]) -> Iterator[Drawing]:
    within = beside.get("comparison")
    if within is not None and "part_of" in within.attrs:
        yield Drawing({"comparison": within})


@figure(
    "Calibration", name="comparison", title="Computed, measured, and their difference", wide=True, order=2,
    caption=_MEANS, when=_compared,
)  # fmt: skip
def calibrated_footprint(calibration: Source, comparison: Source | None = None) -> Figure:
    """The contact of the fitted tire and the first footprint that it was fitted to, and their difference, kPa.

    calibration: a Calibration. comparison: of it; needed of a dataset. Returns the figure. Raises InputError where
    there is no footprint.
    """
    comparison = comparison or next(iter(getattr(calibration, "comparisons", ())), None)
    if comparison is None:
        raise InputError("this calibration has no footprint to compare with; fit one, or give comparison=")
    return comparison_maps(comparison)


@figure(
    "FootprintComparison", name="cuts", title="Cuts", wide=True,
    caption="Pressure along travel and across it, sensel by sensel.",
)  # fmt: skip
@styled
def comparison_cuts(comparison: Source, *, x: float | None = None, y: float | None = None) -> Figure:
    """Computed and measured pressure along travel at y and across it at x, kPa, sensel by sensel.

    comparison: a FootprintComparison or its dataset. x, y: m; left out, through the middle of the rib that carries
    most, and through the centre of pressure. Returns the figure.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measured = tl.Footprint(tl.response.GridLoad(load.grid, 0.9 * load.pressure))
    >>> comparison = tl.compare(load, measured, registration="none")
    >>> figure = tl.plots.comparison_cuts(comparison, x=0.01, y=0.01)
    >>> [f"{line.get_ydata().max():.0f} kPa" for line in figure.axes[0].lines[:2]]
    ['540 kPa', '600 kPa']
    """
    data = fields_of(comparison, "computed_pressure", "measured_pressure", *(_OF_RIBS if y is None else ()))
    plan = Plan.of(data)
    row = _nearest(plan.y, _heaviest(data) if y is None else y, "y")
    column = _nearest(plan.x, float(_of_map(data, "print_centre_x", "measured")) if x is None else x, "x")
    figure = new_figure(7.2, 5.8)
    upper, lower = figure.subplots(2, 1, sharey=True)
    for ax, at, cut in ((upper, plan.x, (row, slice(None))), (lower, plan.y, (slice(None), column))):
        for name, words, colour in (
            ("measured_pressure", "measured", _MEASURED),
            ("computed_pressure", "computed, through the sensor", _COMPUTED),
        ):
            here = plane(data, name)[cut] * KPA
            if name == "measured_pressure":
                ax.fill_between(at, here, step="mid", color=colour, alpha=0.18, linewidth=0)
            ax.step(at, here, where="mid", color=colour, lw=1.5, label=words)
        loaded = np.nonzero(np.nan_to_num(plane(data, "measured_pressure") + plane(data, "computed_pressure")))
        span = at[np.unique(loaded[1 if ax is upper else 0])]
        ax.set_xlim(span[0] - 15, span[-1] + 15)
        ax.set_ylabel("contact pressure (kPa)")
        open_axes(ax)
    for edge in (data["rib_left"].to_numpy()[1:] * MM) if "rib_left" in data else ():
        lower.axvline(edge, color=MUTED, lw=0.7, ls=(0, (3, 3)))
    upper.set_ylim(bottom=0)
    upper.set_xlabel(X_LABEL)
    headline(upper, "Along travel", f"at y = {signed(plan.y[row])} mm, on the rib that carries most" if y is None
             else f"at y = {signed(plan.y[row])} mm")  # fmt: skip
    lower.set_xlabel(Y_LABEL)
    headline(lower, "Across travel", f"at x = {signed(plan.x[column])} mm; dashed: between ribs")
    handles, labels = upper.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


@figure(
    "FootprintComparison", name="ribs", title="Ribs",
    caption="Share of the load that each rib carries, from left to right.",
    when=lambda data: data.sizes.get("rib", 0) > 1,
)  # fmt: skip
@styled
def rib_shares(comparison: Source, *, ax: Axes | None = None) -> Figure:
    """Share of the load on each rib, %, computed and measured. ax: axes to draw into. Returns the figure.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measured = tl.Footprint(tl.response.GridLoad(load.grid, 0.9 * load.pressure))
    >>> comparison = tl.compare(load, measured, registration="none")
    >>> [f"{bar.get_height():.0f} %" for bar in tl.plots.rib_shares(comparison).axes[0].patches]
    ['100 %', '100 %']
    """
    data = fields_of(comparison, *_OF_RIBS)
    ribs = data["rib"].to_numpy()
    figure, ax = figure_and_axes(ax, 5.6, 3.6)
    for shift, name, words, colour in (
        (-0.2, "seen", "computed, through the sensor", _COMPUTED),
        (0.2, "measured", "measured", _MEASURED),
    ):
        values = 100 * _of_map(data, "rib_share", name)
        bars = ax.bar(ribs + shift, values, 0.38, color=colour, label=words)
        ax.bar_label(bars, [f"{value:.1f}" for value in values], fontsize=8, padding=1.5)
    ax.set_xticks(ribs)
    ax.set_xlabel("rib, from left to right of travel")
    ax.set_ylabel("share of the load (%)")
    ax.set_ylim(0, 118 * float(data["rib_share"].max()))
    open_axes(ax)
    ax.grid(visible=False, axis="x")
    headline(ax, "Load on the ribs")
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _view(loaded: BoolArray, plan: Plan) -> tuple[float, float, float, float]:
    """Left, right, top and bottom of what is loaded, with a margin, mm."""
    rows, columns = np.nonzero(loaded) if loaded.any() else (np.arange(len(plan.y)), np.arange(len(plan.x)))
    margin = 0.04 * plan.span
    return (
        max(plan.x_edges[0], plan.x_edges[columns.min()] - margin),
        min(plan.x_edges[-1], plan.x_edges[columns.max() + 1] + margin),
        max(plan.y_edges[0], plan.y_edges[rows.min()] - margin),
        min(plan.y_edges[-1], plan.y_edges[rows.max() + 1] + margin),
    )


def _in_numbers(data: xr.Dataset, which: str) -> str:
    load, area, mean = (float(_of_map(data, name, which)) for name in ("print_load", "net_area", "mean_pressure"))
    return f"{load / 1e3:.4g} kN on {thousands(area * 1e6)} mm², mean {mean * KPA:.0f} kPa"


def _agreement(data: xr.Dataset) -> str:
    if "overlap_of_pressure" not in data:
        return ""
    return f"{100 * float(data['overlap_of_pressure']):.0f} % of the pressure overlaps"


def _askew(data: xr.Dataset) -> bool:
    """True if travel does not lie along the maps."""
    return abs(float(data.get("registered_angle", 0.0))) > math.radians(5)


def _heaviest(data: xr.Dataset) -> float:
    """Middle of the rib that carries most of what was measured, m."""
    share = _of_map(data, "rib_share", "measured")
    at = int(share.argmax())
    return 0.5 * float(data["rib_left"][at] + data["rib_right"][at])


def _of_map(data: xr.Dataset, name: str, which: str) -> Array:
    """Values of a measure for one of the maps. Raises InputError if they are not there."""
    row = fields_of(data, name)[name]
    names = [str(name) for name in row["map"].to_numpy()] if "map" in row.coords else []
    if which not in names:
        raise InputError(f"{name} is not stated of the map {which!r}, only of {', '.join(names) or 'none'}")
    return np.asarray(row.isel(map=names.index(which)).to_numpy(), dtype=float)


def _nearest(at: Array, wanted: float, name: str) -> int:
    """Index of the coordinate, mm, that is nearest to a place, m."""
    if not at[0] <= wanted * MM <= at[-1]:
        raise InputError(f"{name} = {wanted:g} m lies beyond the maps, {at[0] / MM:g} to {at[-1] / MM:g} m")
    return int(np.abs(at - wanted * MM).argmin())
