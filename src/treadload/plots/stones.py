"""A window of mortar with stones: sections with and without them, and how tension and bonds are spread."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import (
    DEPTH_LABEL,
    MM,
    X_LABEL,
    Y_LABEL,
    Limits,
    colour_bar,
    edges,
    empty_note,
    fields_of,
)
from treadload.plots.kit.style import CASES, INK, headline, legend_below, open_axes, sequential, signed, styled
from treadload.plots.profile import nearest

_MEGA = 1e-6
# Inches of a section; of the curves.
_WIDE, _CURVES = 5.4, 3.6
# Tension below this part of the scale is none.
_NOTHING = 1e-3
# Of the colour scale: the share of cells whose values lie on it.
_SHOWN = 99.5


@figure(
    "Heterogeneous", name="section", main=True, title="Stones in mortar", wide=True,
    caption="Largest tension in a section with stones, which are outlined, and of the mortar alone; right: the share "
    "of the mastic, and of the stones' faces, that carries more.",
)  # fmt: skip
@styled
def stones_in_mortar(
    window: Source, *, along: Literal["travel", "across"] = "across", at: float | None = None
) -> Figure:
    """The largest tension in a vertical section with its stones and without them, and how it is spread in the mastic.

    window: a Heterogeneous or its dataset. along: the section's direction. at: its place along the other one, m, the
    nearest there is; left out, where the mastic is pulled most. Stones are outlined. Right: share of the volume with
    a tension above a value, of the mastic and of the mortar alone; share of the stones' faces with a pull above it.
    Returns the figure. Raises InputError for what is missing.

    >>> load = tl.response.GridLoad.from_arrays([[0.8e6] * 4] * 4, spacing=5e-3)
    >>> stone = tl.materials.Aggregates.from_centres(0.0, 0.0, 5.5e-3, 4e-3, tl.Elastic(60e9, 0.2))
    >>> cells = {"window": (12e-3, 12e-3), "depth": 12e-3, "spacing": 2e-3}
    >>> result = tl.response.compute_heterogeneous(load, tl.Elastic(3e9, 0.35), stone, **cells)
    >>> [ax.get_title(loc="left") for ax in tl.plots.stones_in_mortar(result).axes[:2]]
    ['Largest tension with stones', 'How stress is spread']
    """
    data = fields_of(
        window, "principal_stress_1", "tension_without_stones", "phase", "stone", "bond_pull", "face_area"
    )
    if along not in ("travel", "across"):
        raise InputError(f'along must be "travel" or "across", got {along!r}')
    name, across = ("x", "y") if along == "travel" else ("y", "x")
    if min(data.sizes[axis] for axis in ("depth", name)) < 2:
        raise InputError("a section needs at least two depths and two cells across")
    place = nearest(data, across, at) if at is not None else _worst(data, across)
    cut = data.isel({across: place})
    with_stones, alone = (cut[name].to_numpy() * _MEGA for name in ("principal_stress_1", "tension_without_stones"))
    high = float(np.nanpercentile(np.concatenate([with_stones, alone]), _SHOWN))
    scale = Limits(0.0, max(high, 1e-9), bool(max(with_stones.max(), alone.max()) > high))
    aspect = float(np.ptp(data["depth"].to_numpy()) / np.ptp(data[name].to_numpy()))
    figure = new_figure(_WIDE + _CURVES + 1.2, 2 * _WIDE * min(aspect, 0.9) + 2.4)
    axes: dict[str, Axes] = figure.subplot_mosaic(
        [["with", "curves"], ["alone", "curves"]], width_ratios=[_WIDE, _CURVES]
    )
    for key, values, title in (
        ("with", with_stones, "Largest tension with stones"),
        ("alone", alone, "Mortar alone"),
    ):
        mesh = _section(axes[key], cut, name, values, scale, outlined=key == "with")
        where = f"{across} = {signed(float(cut[across]) * MM)} mm"
        highest = float(np.max(values))
        pulled = highest > _NOTHING * scale.high
        if not pulled:
            empty_note(axes[key], "no tension here")
        headline(axes[key], title, f"section at {where}; {f'highest {highest:.2g} MPa' if pulled else 'compressed'}")
    colour_bar(mesh, axes["alone"], "MPa", scale)
    colour_bar(mesh, axes["with"], "MPa", scale)
    _curves(axes["curves"], data)
    return figure


def _worst(data: xr.Dataset, across: str) -> int:
    """Where across the section the mastic is pulled most, away from the window's sides."""
    tension = data["principal_stress_1"].where(data["phase"] == 0)
    line = tension.max([axis for axis in ("depth", "x", "y") if axis != across]).to_numpy()
    border = len(line) // 4
    inner = line[border : len(line) - border]
    return border + int(np.nanargmax(inner)) if np.isfinite(inner).any() else len(line) // 2


def _section(ax: Axes, cut: xr.Dataset, name: str, values: Array, scale: Limits, *, outlined: bool) -> QuadMesh:
    across, down = cut[name].to_numpy() * MM, cut["depth"].to_numpy() * MM
    mesh = ax.pcolormesh(
        edges(across), edges(down), np.maximum(values, 0.0), cmap=sequential("strain"), vmin=scale.low,
        vmax=scale.high, rasterized=True,
    )  # fmt: skip
    if outlined:
        _outlines(ax, cut["stone"].to_numpy(), edges(across), edges(down))
    ax.set_aspect("equal")
    ax.set_ylim(edges(down)[-1], edges(down)[0])
    ax.set_xlabel(X_LABEL if name == "x" else Y_LABEL)
    ax.set_ylabel(DEPTH_LABEL)
    return mesh


def _outlines(ax: Axes, stones: Array, across: Array, down: Array) -> None:
    """The steps around every stone."""
    rows, columns = np.nonzero(stones[:, 1:] != stones[:, :-1])
    ax.vlines(across[columns + 1], down[rows], down[rows + 1], color=INK, lw=0.9)
    rows, columns = np.nonzero(stones[1:] != stones[:-1])
    ax.hlines(down[rows + 1], across[columns], across[columns + 1], color=INK, lw=0.9)


def _curves(ax: Axes, data: xr.Dataset) -> None:
    mastic = data["phase"].to_numpy() == 0
    with_stones = data["principal_stress_1"].to_numpy()[mastic] * _MEGA
    alone = data["tension_without_stones"].to_numpy().ravel() * _MEGA
    pull, area = data["bond_pull"].to_numpy() * _MEGA, data["face_area"].to_numpy()
    handles = []
    for values, weights, colour, label in (
        (with_stones, np.ones(with_stones.size), CASES[1], "mastic between stones, largest tension"),
        (alone, np.ones(alone.size), CASES[0], "mortar alone, largest tension"),
        (pull, area, CASES[2], "pull on the stones' faces, by area"),
    ):
        if not len(values):
            continue
        order = np.argsort(values)[::-1]
        share = np.cumsum(weights[order]) / weights.sum()
        handles += ax.plot(values[order], 100 * share, color=colour, label=label)
    ax.set_yscale("log")
    ax.set_ylim(0.1, 100)
    ax.set_xlim(left=0.0)
    ax.set_yticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    ax.set_xlabel("MPa")
    ax.set_ylabel("share with more than that (%)")
    open_axes(ax)
    legend_below(ax, handles, columns=1)
    index = float(data["ravelling_index"]) if "ravelling_index" in data else float("nan")
    headline(ax, "How stress is spread", f"ravelling index {index:.2g}", 30)
