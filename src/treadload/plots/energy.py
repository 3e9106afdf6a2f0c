"""Energy that one passage of a wheel leaves in a viscoelastic road."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.errors import InputError
from treadload.figure_registry import figure
from treadload.plots.kit.figure import figure_and_axes
from treadload.plots.kit.layers import Layers, draw_interfaces, hatch_unknown, name_layers
from treadload.plots.kit.plan import DEPTH_LABEL, MM, Y_LABEL, colour_bar, fields_of, limits, mark_peak, peak_of
from treadload.plots.kit.style import headline, measure, sequential, styled
from treadload.response.fields import kind_of_points


@figure(
    "Response", title="Energy dissipated in one passage", wide=True, order=4,
    caption="What the wheel leaves in the viscoelastic layers as heat and damage, per unit volume, in a section "
    "across travel; hatched: not computed.",
    when=lambda data: kind_of_points(data) == "slice_across" and "dissipated_energy" in data,
)  # fmt: skip
@styled
def dissipated_energy(response: Source, *, ax: Axes | None = None) -> Figure:
    """Energy per unit volume that one passage dissipates, J/m³, across travel, down to the last lossy layer.

    response: with dissipated_energy over (depth, y), two depths and two points or more, of a road with viscoelastic
    layers under a moving load. ax: axes to draw into. Returns the figure; hatched where the energy is not known.
    Raises InputError without that variable, and where no layer loses energy.

    >>> mix = tl.materials.Prony(20e9, ((0.6, 0.1), (0.39, 10.0)), 0.35)
    >>> road = tl.Pavement.half_space(mix)
    >>> plate, y = tl.UniformDisc(0.15, 7e5), [0.0, 0.1]
    >>> response = tl.solve_response(plate, road, depths=[0.05, 0.14], x=[0.0], y=y, speed=20.0)
    >>> tl.plots.dissipated_energy(response).axes[0].get_title(loc="left")
    'Energy dissipated in one passage'
    """
    data = fields_of(response, "dissipated_energy", "depth", "y").sortby("depth").sortby("y")
    energy = data["dissipated_energy"].transpose("depth", "y").to_numpy()
    if min(energy.shape) < 2:
        raise InputError(f"a section needs at least two depths and two points, the response has {energy.shape}")
    layers, down, across = Layers.of(data), data["depth"].to_numpy() * MM, data["y"].to_numpy() * MM
    lossy = np.nonzero(np.nanmax(energy, axis=1, initial=0.0) > 0)[0]
    if not lossy.size:
        raise InputError("no layer of this road dissipates energy: all are elastic, or the wheel does not move")
    bottom = float(down[lossy[-1]])
    # Not at true scale: the layers that lose energy are thin.
    figure, ax = figure_and_axes(ax, 8.4, 3.4)
    scale = limits(energy[: lossy[-1] + 1])
    mesh = None
    for (_, top, end), rows in zip(layers.spans(bottom), layers.pieces(down), strict=False):
        kept = down[rows] <= bottom
        depths, field = down[rows][kept], energy[rows][kept]
        complete = np.isfinite(field).all(axis=1)
        if complete.sum() < 2:
            hatch_unknown(ax, top, end)
            continue
        depths, field = depths[complete], field[complete]
        if depths[0] - top > 0.01:
            hatch_unknown(ax, top, float(depths[0]))
        mesh = ax.pcolormesh(
            across, depths, field, cmap=sequential("strain"), vmin=0.0, vmax=scale.high, shading="gouraud",
            rasterized=True,
        )  # fmt: skip
    if mesh is None:
        raise InputError("the energy is known at fewer than two depths of every layer; solve the response at more")
    ax.set_xlim(across[0], across[-1])
    ax.set_ylim(bottom, 0.0)
    ax.set_xlabel(Y_LABEL)
    ax.set_ylabel(DEPTH_LABEL)
    draw_interfaces(ax, layers, bottom, on_colours=True)
    row, column = peak_of(energy, horizontal=1)
    peak = float(energy[row, column])
    mark_peak(ax, float(across[column]), float(down[row]), measure(peak))
    colour_bar(mesh, ax, "J/m³", scale, beyond=name_layers(ax, layers, bottom))
    speed = data.attrs.get("speed")
    words = "" if speed is None else f", at {float(speed) * 3.6:.4g} km/h"
    headline(ax, "Energy dissipated in one passage", f"peak {measure(peak)} J/m³, {down[row]:.3g} mm deep{words}")
    return figure
