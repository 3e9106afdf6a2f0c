"""A vertical section of a response: what it holds and how it is drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import same_depth
from treadload.plots.kit.layers import Layers, draw_interfaces, hatch_unknown
from treadload.plots.kit.plan import (
    DEPTH_LABEL,
    MICRO,
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    edges,
    fields_of,
    mark_peak,
    peak_of,
    plane,
)
from treadload.plots.kit.strokes import draw_strokes, strokes
from treadload.plots.kit.style import INK, measure, sequential, signed

# Directions of strains below this share of the colour scale are left out.
_SIGNIFICANT = 0.1


@dataclass(frozen=True, eq=False)
class Section:
    """Largest extension strain in a vertical section.

    data: the section, depths increasing, without the coordinate it cuts. name: "x" along travel, "y" across it.
    cut: the other coordinate, mm. across: (n,), down: (nz,), mm. values: (nz, n), microstrain.
    along, vertical: (nz, n), components of the direction in the section.
    """

    data: xr.Dataset
    name: str
    cut: float
    across: Array
    down: Array
    values: Array
    along: Array
    vertical: Array
    layers: Layers

    @classmethod
    def of(cls, response: Source, along: str | None = None, at: float | None = None) -> Section:
        """The section of a response along "travel" or "across" it, at a y or x in m or through the worst point."""
        data = fields_of(response, "principal_strain_1", "principal_direction_1", "depth")
        name, across = _axis(data, along)
        if data.sizes.get("depth", 1) < 2 or data.sizes[name] < 2:
            raise InputError(
                "a section needs at least two depths and two points, the response has "
                f"{data.sizes.get('depth', 1)} and {data.sizes[name]}; solve the response at more depths"
            )
        data = data.sortby("depth")
        top, bottom = data["depth"].to_numpy()[[0, -1]]
        if same_depth(max(top, 0.0), max(bottom, 0.0)):
            raise InputError(
                f"a section needs depths that differ and lie in the road, the response has {top:g} to {bottom:g} m"
            )
        data = data.isel({across: _position(data, across, at)})
        direction = data["principal_direction_1"].transpose("depth", name, "component").to_numpy()
        return cls(
            data,
            name,
            float(data[across]) * MM,
            data[name].to_numpy() * MM,
            data["depth"].to_numpy() * MM,
            data["principal_strain_1"].transpose("depth", name).to_numpy() * MICRO,
            direction[..., 0 if name == "x" else 1],
            direction[..., 2],
            Layers.of(data),
        )

    @property
    def aspect(self) -> float:
        """Depth of the section over its length."""
        return float(np.ptp(self.down) / np.ptp(self.across))

    @property
    def cut_in_words(self) -> str:
        """Where the section lies."""
        return f"{'y' if self.name == 'x' else 'x'} = {signed(self.cut)} mm"

    @property
    def bottom(self) -> float:
        """Its lower edge, mm."""
        return float(self.down[-1])


def draw_section(ax: Axes, section: Section, scale: Limits) -> QuadMesh:
    """Draw a section at true scale: colours cut at the interfaces, strokes, the loaded strip, the peak's mark."""
    mesh = _draw_layers(ax, section, scale)
    ax.set_aspect("equal")
    ax.set_xlim(section.across[0], section.across[-1])
    ax.set_ylim(section.bottom, section.down[0])
    ax.set_xlabel(X_LABEL if section.name == "x" else Y_LABEL)
    ax.set_ylabel(DEPTH_LABEL)
    draw_interfaces(ax, section.layers, section.bottom, on_colours=True)
    row, column = peak_of(section.values, horizontal=1)
    if section.values[row, column] > 0:
        apart = max(float(np.ptp(section.across)) / 42, float(np.ptp(section.down)) / 24)
        # No stroke reaches across an interface, where the direction jumps.
        near = np.abs(section.down[:, None] - np.array(section.layers.interfaces)).min(axis=1, initial=np.inf)
        weight = np.where(near[:, None] < apart / 2, np.nan, section.values)
        drawn = strokes(
            weight, section.along, section.vertical, section.across, section.down,
            _SIGNIFICANT * scale.high, apart,
        )  # fmt: skip
        draw_strokes(ax, drawn)
        peak = measure(float(section.values[row, column]))
        mark_peak(ax, float(section.across[column]), float(section.down[row]), peak)
    _loaded_strip(ax, section)
    return mesh


def _draw_layers(ax: Axes, section: Section, scale: Limits) -> QuadMesh:
    """One mesh per layer, as strain jumps between them, held constant from its last depth to its end."""
    down, values = section.down, section.values
    mesh: QuadMesh | None = None
    spans = section.layers.spans(section.bottom)
    for (_, top, end), rows in zip(spans, section.layers.pieces(down), strict=False):
        depths, field = down[rows], values[rows]
        if not len(depths):
            hatch_unknown(ax, top, end)
            continue
        start = max(top, float(down[0]))
        missing = (int(start < depths[0]), int(end > depths[-1]))
        field = np.pad(field, (missing, (0, 0)), mode="edge")
        depths = np.concatenate([[start][: missing[0]], depths, [end][: missing[1]]])
        if len(depths) < 2:
            continue
        drawn = ax.pcolormesh(
            section.across, depths, field, cmap=sequential("strain"), vmin=scale.low, vmax=scale.high,
            shading="gouraud", rasterized=True,
        )  # fmt: skip
        mesh = mesh or drawn
    assert mesh is not None
    return mesh


def _axis(data: xr.Dataset, along: str | None) -> tuple[str, str]:
    if along not in (None, "travel", "across"):
        raise InputError(f'along must be "travel" or "across", got {along!r}')
    if along is None:
        along = "across" if data.sizes["x"] < data.sizes["y"] and data.sizes["x"] == 1 else "travel"
    return ("x", "y") if along == "travel" else ("y", "x")


def _position(data: xr.Dataset, name: str, at: float | None) -> int:
    """Index along `name` of a section at a coordinate, m, or through the largest extension."""
    if at is not None:
        return int(np.argmin(np.abs(data[name].to_numpy() - at)))
    row, column = peak_of(plane(data.isel(depth=0), "principal_strain_1"))
    return row if name == "y" else column


def _loaded_strip(ax: Axes, section: Section) -> None:
    """A bar on the surface where the tire touches."""
    if "stress_zz" not in section.data or abs(section.down[0]) > 0:
        return
    pressed = -section.data["stress_zz"].isel(depth=0).to_numpy()
    if not pressed.max(initial=0.0) > 0:
        return
    sides = edges(section.across)
    touching = np.pad(pressed > 5e-3 * pressed.max(), 1).astype(int)
    starts, ends = np.nonzero(np.diff(touching) == 1)[0], np.nonzero(np.diff(touching) == -1)[0]
    for start, end in zip(starts, ends, strict=True):
        ax.plot([sides[start], sides[end]], [0, 0], color=INK, lw=4, solid_capstyle="butt", clip_on=False, zorder=4)
