"""What the maps share: reading datasets, cells seen from above, limits of colour, outlines, marks."""

from __future__ import annotations

import math
import textwrap
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Colormap
from matplotlib.transforms import offset_copy

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.largest import index_of_largest
from treadload.kernels.layers.depths import same_depth
from treadload.plots.kit.style import INK, MUTED, PAPER, RULE, figure_of, halo
from treadload.response.fields import number_of_depth
from treadload.units import stress_in_words

MM = 1e3
KPA = 1e-3
MICRO = 1e6

X_LABEL = "x, direction of travel (mm)"
Y_LABEL = "y, right of travel (mm)"
DEPTH_LABEL = "depth (mm)"

# Letters in a line beside a colour bar.
_LABEL = 46

# A colour scale is cut when the peak stands this far above all but the highest 0.5 % of the loaded cells.
_OUTSTANDING = 1.3
_HIGHEST = 0.995
# Shear below this part of the largest pressure is not drawn. A tire that rolls freely leaves so much, because the
# road below it gives way sideways as (1 - 2ν)/G: 2e-4 of the peak pressure on asphalt, 4e-4 on half its stiffness. It
# changes stresses in the road by less than the cells do, and tells nothing of friction.
_NEGLIGIBLE = 1e-3


def fields_of(source: Source, *names: str) -> xr.Dataset:
    """The dataset of a source; InputError if it lacks one of the variables or a grid."""
    data = dataset_of(source)
    if "point" in data.dims:
        count = data.sizes["point"]
        raise InputError(
            f"a figure needs a grid, this response is at {count} points; call solve_response with x and y"
        )
    missing = [name for name in names if name not in data.variables]
    if missing:
        present = ", ".join(sorted(map(str, data.data_vars))) or "nothing"
        raise InputError(f"this figure needs {', '.join(missing)}; the dataset has {present}")
    return without_negligible_shear(data)


def without_negligible_shear(data: xr.Dataset) -> xr.Dataset:
    """A contact whose shear is below 0.1 % of the peak pressure without that shear; any other dataset as it is.

    Such shear is real where tire and road are of different elastic constants, and round-off elsewhere; a figure would
    give it a colour scale of its own. The attribute `negligible_shear` then is a sentence for the figure, with the
    largest value.
    """
    names = ("traction_x", "traction_y")
    if "pressure" not in data or any(name not in data for name in names) or "depth" in data.dims:
        return data
    shear = float(np.nanmax(np.hypot(*(data[name].to_numpy() for name in names)), initial=0.0))
    pressure = float(np.nanmax(data["pressure"].to_numpy(), initial=0.0))
    if not 0 < shear < _NEGLIGIBLE * pressure:
        return data
    note = (
        f"shear below {100 * _NEGLIGIBLE:g} % of the peak pressure is not drawn: at most {stress_in_words(shear)} "
        f"under {stress_in_words(pressure)}"
    )
    bare = {name: data[name] * 0.0 for name in names}
    return data.assign({name: part.assign_attrs(data[name].attrs) for name, part in bare.items()}).assign_attrs(
        negligible_shear=note
    )


def at_depth(data: xr.Dataset, depth: float) -> xr.Dataset:
    """The plane (y, x) at one of a response's depths, m; InputError for a depth it does not have."""
    if "depth" not in data.dims:
        return data
    return data.isel(depth=number_of_depth(data, depth))


def plane(data: xr.Dataset, name: str) -> Array:
    """Values (y, x) of a variable."""
    return np.asarray(data[name].transpose("y", "x").to_numpy(), dtype=float)


def edges(centres: Array, otherwise: float = 1.0) -> Array:
    """Edges (n + 1,) of the cells around n centres; a single one gets the width `otherwise`."""
    if len(centres) == 1:
        return np.array([centres[0] - otherwise / 2, centres[0] + otherwise / 2])
    inner = (centres[1:] + centres[:-1]) / 2
    first, last = 2 * centres[0] - inner[0], 2 * centres[-1] - inner[-1]
    joined: Array = np.concatenate([[first], inner, [last]])
    return joined


@dataclass(frozen=True)
class Plan:
    """Cells of a map: centres x (nx,), y (ny,) and edges (nx + 1,), (ny + 1,), mm."""

    x: Array
    y: Array
    x_edges: Array
    y_edges: Array

    @classmethod
    def of(cls, data: xr.Dataset) -> Plan:
        """Cells of a dataset over x and y, m."""
        x, y = (np.asarray(data[name].to_numpy(), dtype=float) * MM for name in ("x", "y"))
        for name, values in (("x", x), ("y", y)):
            if (np.diff(values) <= 0).any():
                raise InputError(
                    f"a map needs increasing coordinates, {name} does not increase everywhere; sort the dataset"
                )
        across = float(np.diff(y).mean()) if len(y) > 1 else 1.0
        along = float(np.diff(x).mean()) if len(x) > 1 else across
        return cls(x, y, edges(x, along), edges(y, across if len(y) > 1 else along))

    @property
    def cell(self) -> float:
        """Mean size of a cell, mm."""
        long, wide = np.ptp(self.x_edges) / len(self.x), np.ptp(self.y_edges) / len(self.y)
        return math.sqrt(float(long * wide))

    @property
    def span(self) -> float:
        """The longer side of the map, mm."""
        return float(max(np.ptp(self.x_edges), np.ptp(self.y_edges)))

    @property
    def aspect(self) -> float:
        """Height of the map over its length."""
        return float(np.ptp(self.y_edges) / np.ptp(self.x_edges))


@dataclass(frozen=True)
class Limits:
    """Limits of a colour scale, and whether values lie above it."""

    low: float
    high: float
    clipped: bool = False

    @property
    def extend(self) -> str:
        """What matplotlib calls the open end of a colour bar."""
        return "max" if self.clipped else "neither"


def limits(*values: Array, robust: bool = True) -> Limits:
    """One scale from 0 for all the arrays.

    Peaks at the edges of contact are singular: they grow with every finer grid. If a few cells stand far above
    all others the scale stops below them and states so (`clipped`), else it ends at the largest value.
    """
    joined = np.concatenate([np.ravel(v) for v in values]) if values else np.zeros(0)
    positive = joined[np.isfinite(joined) & (joined > 0)]
    if not positive.size:
        return Limits(0.0, 1.0)
    peak = float(positive.max())
    typical = float(np.quantile(positive[positive > 0.02 * peak], _HIGHEST))
    if not robust or peak <= _OUTSTANDING * typical:
        return Limits(0.0, peak)
    return Limits(0.0, min(peak, round_up(typical)), True)


def round_up(value: float) -> float:
    """The next number with two digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / step - 1e-9) * step


def draw_cells(ax: Axes, plan: Plan, values: Array, colours: Colormap, scale: Limits) -> QuadMesh:
    """Cells (ny, nx) in colour on axes seen from above, at true scale."""
    mesh = ax.pcolormesh(
        plan.x_edges, plan.y_edges, np.ma.masked_invalid(values), cmap=colours, vmin=scale.low, vmax=scale.high,
        rasterized=True,
    )  # fmt: skip
    frame_plan(ax, plan)
    return mesh


def frame_plan(ax: Axes, plan: Plan) -> None:
    """True scale, mm, travel to the right of the page; seen from above, so that y points down the page."""
    ax.set_aspect("equal")
    ax.set_xlim(plan.x_edges[0], plan.x_edges[-1])
    ax.set_ylim(plan.y_edges[-1], plan.y_edges[0])
    ax.set_xlabel(X_LABEL)
    ax.set_ylabel(Y_LABEL)


def colour_bar(mesh: ScalarMappable, ax: Axes, label: str, scale: Limits, beyond: float = 0.0) -> Colorbar:
    """Colour bar as high as its axes, with quantity and unit; an arrow where the scale is cut.

    label: in two lines where it would be longer than the bar. beyond: points that something else takes right of the
    axes.
    """
    figure = figure_of(ax)
    # Own axes inside the map's: they follow its height whatever true scale leaves of it.
    shifted = offset_copy(ax.transAxes, figure, x=beyond, units="points")
    beside = ax.inset_axes((1.025, 0.0, 0.028, 1.0), transform=shifted)
    words = textwrap.fill(label, _LABEL, break_on_hyphens=False)
    bar = figure.colorbar(mesh, cax=beside, label=words, extend=scale.extend, extendfrac=0.035)
    bar.outline.set(edgecolor=RULE, linewidth=0.7)
    return bar


def borders(mask: BoolArray, plan: Plan) -> Array:
    """Segments (n, 2, 2) in mm between the cells of a mask (ny, nx) and the others."""
    padded = np.pad(mask, 1)
    rows, columns = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    x, y = plan.x_edges, plan.y_edges
    upright = np.stack([np.stack([x[columns], y[rows]], -1), np.stack([x[columns], y[rows + 1]], -1)], axis=1)
    rows, columns = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    level = np.stack([np.stack([x[columns], y[rows]], -1), np.stack([x[columns + 1], y[rows]], -1)], axis=1)
    segments: Array = np.concatenate([upright, level])
    return segments


def draw_outline(ax: Axes, mask: BoolArray, plan: Plan, colour: str = INK, width: float = 0.7) -> LineCollection:
    """The border of the cells in a mask (ny, nx)."""
    lines = LineCollection(list(borders(mask, plan)), colors=colour, linewidths=width, capstyle="round", zorder=2.2)
    ax.add_collection(lines, autolim=False)
    return lines


def contact_mask(data: xr.Dataset) -> BoolArray | None:
    """Cells in contact (ny, nx): from the pressure, or from the surface stress; None if neither is there."""
    if "pressure" in data:
        touching: BoolArray = plane(data, "pressure") > 0
        return touching
    if "stress_zz" not in data or "depth" not in data.coords:
        return None
    depths = np.atleast_1d(data["depth"].to_numpy())
    if not same_depth(depths.min(), 0.0):
        return None
    surface = data["stress_zz"]
    if "depth" in surface.dims:
        surface = surface.isel(depth=int(np.argmin(depths)))
    pressure = -np.asarray(surface.transpose("y", "x").to_numpy(), dtype=float)
    # Round-off and the transforms of a layered road leave a little stress beside the contact.
    loaded: BoolArray = pressure > 5e-3 * np.nanmax(pressure)
    return loaded if np.nanmax(pressure) > 0 else None


def mark_peak(ax: Axes, x: float, y: float, text: str) -> None:
    """A ring on the place (mm) of the largest value and its number beside it, on the side with room."""
    for colour, width, order in ((PAPER, 2.6, 5.0), (INK, 1.2, 5.1)):
        ax.plot([x], [y], "o", ms=9, mfc="none", mec=colour, mew=width, zorder=order, clip_on=False)
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    across, up = (x - left) / (right - left), (y - bottom) / (top - bottom)
    shift = (-9 if across > 0.5 else 9, -9 if up > 0.5 else 9)
    ax.annotate(
        text, (x, y), xytext=shift, textcoords="offset points", fontsize=8.5, fontweight="bold", color=INK,
        ha="right" if across > 0.5 else "left", va="top" if up > 0.5 else "bottom",
        path_effects=halo(3), zorder=6,
    )  # fmt: skip


def peak_of(values: Array, *, horizontal: int = 2) -> tuple[int, int]:
    """Row and column of the largest value (ny, nx); with horizontal=1 (depth, n). See `index_of_largest`."""
    row, column = index_of_largest(values, horizontal=horizontal)
    return row, column


def empty_note(ax: Axes, text: str) -> None:
    """Write in the middle of the axes that there is nothing to see."""
    ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", color=MUTED, path_effects=halo())
