"""Strain at one depth in two panels: its size and its direction."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from treadload.composing import Source
from treadload.damage.cracks import OBLIQUE_TOLERANCE
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import (
    MICRO,
    X_LABEL,
    Y_LABEL,
    Plan,
    colour_bar,
    draw_cells,
    empty_note,
    limits,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.strokes import draw_strokes, strokes
from treadload.plots.kit.style import headline, legend_below, measure, sequential, styled, travel_arrow
from treadload.plots.response import (
    NAMES,
    VARIABLE,
    Strain,
    draw_contact,
    horizontal,
    place_in_words,
    strain_in_numbers,
    strain_plane,
)

# Inches of a panel along travel, and of what stands beside and around it.
_MAP, _BESIDE, _AROUND = 4.6, 1.7, 1.3
# Strokes along the longer side; directions of strains below this share of the largest are left out.
_ALONG, _SIGNIFICANT = 46, 0.02
# Horizontal components below this share of the direction leave it near-vertical.
_NEAR_VERTICAL = math.sin(math.radians(45))
_DIRECTIONS = (
    ("along travel", "#d55e00"),
    ("oblique", "#8a3b74"),
    ("across travel", "#0b6fae"),
    ("near-vertical", "#00805f"),
)


@figure("Response")
@styled
def strain_panels(
    response: Source, depth: float = 0.0, strain: Strain = "principal", *, contact: Source | None = None
) -> Figure:
    """Largest extension strain in plan above, microstrain; below, the direction of that extension.

    response, depth, strain and contact: as for `strain_directions`. Strokes lie along the extension, all of one
    length but for what stands out of the horizontal, wherever it exceeds 2 % of the largest; their colour shows
    whether they point along travel, across it, obliquely or near-vertically. Returns the figure. Raises InputError as
    `strain_directions`.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> plate, x, y = tl.UniformDisc(0.15, 700e3), [-0.3, -0.15, 0.0, 0.15, 0.3], [-0.15, 0.0, 0.15]
    >>> response = tl.solve_response(plate, road, depths=[0.15], x=x, y=y)
    >>> tl.plots.strain_panels(response, depth=0.15).axes[1].get_title(loc="left")
    'Its direction'
    """
    data = strain_plane(response, depth, strain)
    plan, values = Plan.of(data), plane(data, VARIABLE[strain]) * MICRO
    figure = new_figure(_MAP + _BESIDE, 2 * (min(_MAP * plan.aspect, 4.6) + _AROUND), "compressed")
    upper, lower = figure.subplots(2, 1, sharex=True, sharey=True)
    scale = limits(values)
    mesh = draw_cells(upper, plan, values, sequential("strain"), scale)
    draw_contact(upper, contact or response)
    colour_bar(mesh, upper, "largest tensile strain (microstrain)", scale)
    title = f"Largest tensile strain {place_in_words(depth)}"
    kind = "three-dimensional" if strain == "principal" else "horizontal plane"
    headline(upper, f"{title}, {kind}", strain_in_numbers(data, strain, scale))
    row, column = peak_of(values)
    if values[row, column] > 0:
        mark_peak(upper, float(plan.x[column]), float(plan.y[row]), measure(float(values[row, column])))
    else:
        empty_note(upper, "no tensile strain here")
    upper.tick_params(labelbottom=True)
    upper.set_xlabel(X_LABEL)
    _directions(lower, data, strain, plan, values)
    draw_contact(lower, contact or response)
    headline(lower, "Its direction", f"of the tensile strain, {NAMES[strain]}; where it exceeds 2 % of the peak")
    for ax in (upper, lower):
        travel_arrow(ax)
    return figure


def _directions(ax: Axes, data: xr.Dataset, strain: Strain, plan: Plan, values: Array) -> None:
    ax.set_aspect("equal")
    ax.set_xlabel(X_LABEL)
    ax.set_ylabel(Y_LABEL)
    largest = float(np.nanmax(values))
    if not largest > 0:
        empty_note(ax, "no tensile strain here")
        return
    along_x, along_y = horizontal(data, strain)
    drawn = strokes(values, along_x, along_y, plan.x, plan.y, _SIGNIFICANT * largest, plan.span / _ALONG)
    ways = direction_class(along_x, along_y)[drawn.index[:, 0], drawn.index[:, 1]]
    draw_strokes(ax, drawn, [_DIRECTIONS[way][1] for way in ways], 1.2, backing=False)
    handles = [Line2D([], [], color=colour, lw=2.2, label=name) for name, colour in _DIRECTIONS[:3]]
    handles += [Line2D([], [], color=_DIRECTIONS[3][1], lw=0, marker="o", ms=3.5, label=_DIRECTIONS[3][0])]
    legend_below(ax, [handle for way, handle in enumerate(handles) if (ways == way).any()])


def direction_class(along_x: Array, along_y: Array) -> Array:
    """Class of directions with such horizontal components: 0 along travel, 1 oblique, 2 across, 3 near-vertical."""
    from_travel = np.arctan2(np.abs(along_y), np.abs(along_x))
    way = np.full(np.shape(along_x), 1)
    way[from_travel <= OBLIQUE_TOLERANCE] = 0
    way[from_travel >= math.pi / 2 - OBLIQUE_TOLERANCE] = 2
    way[np.hypot(along_x, along_y) < _NEAR_VERTICAL] = 3
    return way
