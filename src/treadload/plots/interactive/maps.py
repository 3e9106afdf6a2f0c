"""Maps beside each other in true scale, with shared axes; differences of two results on one scale."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from treadload.composing import Source
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.overlap import means_over_cells
from treadload.plots.interactive.cut import Cut, sampled
from treadload.plots.interactive.drawing import Trace, cells, cut_shape, figure, heading, marks, overlays, plan_axes
from treadload.plots.interactive.field import Field, field_of
from treadload.plots.interactive.places import Place
from treadload.plots.interactive.theme import Theme, theme_of
from treadload.plots.kit.plan import MM, Limits, Plan, limits, peak_of
from treadload.plots.kit.style import measure

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

# Pixels: width that a figure is laid out for, around a map, above it for title and colour bar, between two.
WIDTH = 1100.0
_LEFT, _RIGHT, _ABOVE, _BELOW, _BETWEEN = 62.0, 18.0, 102.0, 52.0, 70.0
_TALLEST = 620.0
# The scale of a difference covers all but this share of it: edges of contact, a cell off, differ by all there is.
_QUIET = 0.995


def linked_maps(
    fields: Sequence[Field],
    *,
    cut: Cut | None = None,
    places: Sequence[Place] = (),
    theme: str | Theme = "light",
    width: float = WIDTH,
) -> Figure:
    """Maps side by side in true scale, as one Figure of plotly: who zooms or moves one moves all.

    fields: of `field_of` and its like. cut: a line that is drawn on all and can be dragged on the first, whose shape
    stands first in the layout. places: marked on all. width: pixels that it is laid out for; it fills what is there.
    Returns the figure; its `layout.height` keeps the scale. Raises InputError without a map.
    """
    traces, layout = laid_out(fields, theme=theme, width=width, cut=cut, places=places)
    return figure(traces, layout, theme_of(theme))


def laid_out(
    fields: Sequence[Field],
    *,
    theme: str | Theme,
    width: float,
    cut: Cut | None = None,
    places: Sequence[Place] = (),
    below: float = 0.0,
) -> tuple[list[Trace], dict[str, object]]:
    """Traces and layout of linked maps. below: pixels that are left free under them for something else."""
    if not fields:
        raise InputError("linked maps need one map at least")
    look = theme_of(theme)
    count = len(fields)
    panel = (width - _LEFT - _RIGHT - _BETWEEN * (count - 1)) / count
    aspect = max(field.plan.aspect for field in fields)
    tall = min(_TALLEST, max(140.0, panel * aspect))
    height = _ABOVE + tall + _BELOW + below
    inner_width, inner_height = width - _LEFT - _RIGHT, height - _ABOVE - _BELOW
    layout: dict[str, Any] = {
        "height": round(height), "margin": {"l": _LEFT, "r": _RIGHT, "t": _ABOVE, "b": _BELOW}, "shapes": [],
        "annotations": [], "showlegend": False, "uirevision": "maps",
    }  # fmt: skip
    traces: list[Trace] = []
    for number, field in enumerate(fields, start=1):
        left = (number - 1) * (panel + _BETWEEN) / inner_width
        # Round-off may lead out of the page, which plotly refuses.
        domain = (left, min(1.0, left + panel / inner_width), max(0.0, 1 - tall / inner_height), 1.0)
        axes = ("x", "y") if number == 1 else (f"x{number}", f"y{number}")
        bar = {"x": domain[0], "y": 1 + 4 / inner_height, "len": domain[1] - domain[0], "yref": "paper"}
        traces += [cells(field, axes, look, bar), *overlays(field, axes, look)]
        if places:
            traces.append(_marks(places, axes, look))
        layout |= plan_axes(number, field.plan, domain)
        title = field.title + (f" (means of {field.blocks} x {field.blocks} cells)" if field.blocks > 1 else "")
        layout["annotations"].append(heading(title, domain, look, 52, panel))
        if cut is not None:
            layout["shapes"].append(cut_shape(cut.start_mm, cut.end_mm, axes, look, number == 1))
    return traces, layout


def marked(places: Sequence[Place], count: int, *, theme: str | Theme = "light") -> Figure:
    """The marks alone that `linked_maps` puts on so many maps, as a Figure of plotly, for maps that stand already."""
    look = theme_of(theme)
    axes = [("x" if n == 1 else f"x{n}", "y" if n == 1 else f"y{n}") for n in range(1, count + 1)]
    return figure([_marks(places, pair, look) for pair in axes if places], {}, look)


def _marks(places: Sequence[Place], axes: tuple[str, str], look: Theme) -> Trace:
    spots = [(MM * place.x, MM * place.y, place.text) for place in places if place.x is not None]
    return marks(spots, axes, look, "places")


def difference_map(
    first: Source,
    second: Source,
    name: str = "pressure",
    *,
    labels: tuple[str, str] = ("A", "B"),
    depth: float | None = None,
    cut: Cut | None = None,
    theme: str | Theme = "light",
    width: float = WIDTH,
) -> Figure:
    """Two results on one scale and the first less the second, as linked maps.

    name: of a map that both have, see `choices`. labels: of the two. depth: m, of responses. Where their grids
    differ the second is brought to the first's: pressure and shear as means over its cells, which keep the load,
    anything else between its points. Returns the figure. Raises InputError where one lacks the map.
    """
    left, right = field_of(first, name, depth=depth), field_of(second, name, depth=depth)
    if left.kind == "zones":
        raise InputError("stick and slip have no difference; compare the shear")
    if left.unit != right.unit:
        right = replace(right, values=right.values * _to_unit(left, right), unit=left.unit)
    same = _same_cells(left.plan, right.plan)
    brought = right.values if same else _brought(right, left.plan)
    a, b = np.nan_to_num(left.values), np.nan_to_num(brought)
    there = np.isfinite(left.values) | np.isfinite(brought)
    difference = np.where(there, a - b, np.nan)
    sizes = np.abs(difference[there])
    most = float(np.quantile(sizes, _QUIET)) if sizes.size else 1.0
    most = most if most > 0 else float(sizes.max(initial=0.0)) or 1.0
    both = Limits(-most, most, bool(sizes.size and sizes.max() > 1.001 * most))
    if left.kind == "signed" or right.kind == "signed":
        high = max(abs(left.scale.low), left.scale.high, right.scale.high)
        shared, kind = Limits(-high, high), "signed"
    else:
        shared, kind = limits(a, b) if not left.logarithmic else Limits(
            min(left.scale.low, right.scale.low), max(left.scale.high, right.scale.high)), left.kind  # fmt: skip
    row, column = peak_of(np.abs(difference))
    unit = "decades" if left.logarithmic else left.unit
    peak = None
    if there.any() and difference[row, column]:
        text = f"{measure(float(difference[row, column]))} {unit}"
        peak = (float(left.plan.x[column]), float(left.plan.y[row]), text)
    third = Field(
        f"{name}_difference", f"{labels[0]} less {labels[1]}", unit, left.plan, difference, "signed", both,
        f"{labels[0]} less {labels[1]}", left.outlines, peak=peak,
    )  # fmt: skip
    pair = [replace(field, scale=shared, kind=kind, title=f"{label}: {field.words}")
            for field, label in ((left, labels[0]), (right, labels[1]))]  # fmt: skip
    return linked_maps([*pair, third], cut=cut, theme=theme, width=width)


def _same_cells(plan: Plan, reference: Plan) -> bool:
    return all(a.shape == b.shape and np.allclose(a, b, rtol=0, atol=1e-6) for a, b in (
        (plan.x_edges, reference.x_edges), (plan.y_edges, reference.y_edges)))  # fmt: skip


def _brought(field: Field, plan: Plan) -> Array:
    """Values of a map on the cells of another."""
    if field.kind in ("pressure", "shear"):
        means = means_over_cells(
            np.nan_to_num(field.values), field.plan.x_edges, field.plan.y_edges, plan.x_edges, plan.y_edges
        )
        return np.where(means > 0, means, np.nan)
    x, y = np.meshgrid(plan.x, plan.y)
    return sampled(field.values, field.plan.x, field.plan.y, x, y, smooth=True)


def _to_unit(field: Field, reference: Field) -> float:
    """Factor from the unit of the second map to that of the first, both of pressure."""
    pascals = {"kPa": 1e3, "MPa": 1e6}
    if field.unit not in pascals or reference.unit not in pascals:
        raise InputError(f"the two maps are in {field.unit or '1'} and {reference.unit or '1'}, which do not compare")
    return pascals[reference.unit] / pascals[field.unit]
