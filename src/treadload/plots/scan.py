"""Four panels of a scan: the tread unrolled, across, round, and as it stands over the road."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.deferred import xarray as xr
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MM, limits
from treadload.plots.kit.style import (
    INK,
    MUTED,
    SLIP,
    STICK,
    figure_of,
    headline,
    open_axes,
    sequential,
    signed,
    styled,
)
from treadload.plots.wear import wear_range

_HOLE = "#f3c9b0"


@styled
def scan(data: xr.Dataset) -> Figure:
    """What was read from a scan, and how: unrolled depth, section across, roundness, gap over the road.

    data: of `results.scan_fields`, with the wear where an earlier scan was given. Returns the figure.
    """
    figure = new_figure(11.0, 7.6)
    axes = figure.subplots(2, 2)
    _unrolled(axes[0, 0], data)
    _across(axes[0, 1], data)
    _round(axes[1, 0], data)
    _gap(axes[1, 1], data)
    return figure


def _unrolled(ax: Axes, data: xr.Dataset) -> None:
    worn = "worn" in data
    field = (data.worn if worn else data.unrolled_depth).to_numpy() * 1e3
    across, turn = data.across.to_numpy() * 1e3, np.degrees(data.turn.to_numpy())
    ax.set_facecolor(_HOLE)
    if worn:
        low, high = wear_range(field)
        mesh = ax.pcolormesh(turn, across, field, cmap=sequential("height"), vmin=low, vmax=high, rasterized=True)
    else:
        scale = limits(field)
        mesh = ax.pcolormesh(turn, across, field, cmap=sequential("height"), vmin=0, vmax=scale.high, rasterized=True)
    figure_of(ax).colorbar(mesh, ax=ax, label="worn off (mm)" if worn else "depth below the crown (mm)")
    ax.set(xlabel="angle from the road (degrees)", ylabel="y (mm)", xlim=_seen(data))
    # As on the plans of contacts: the right of travel is below.
    ax.invert_yaxis()
    headline(
        ax,
        "Worn off since the earlier scan" if worn else "Unrolled",
        "shaded: grooves, or nothing scanned" if worn else "shaded: nothing was scanned",
    )


def _across(ax: Axes, data: xr.Dataset) -> None:
    across = data.across.to_numpy() * 1e3
    ax.plot(across, data.envelope.to_numpy() * -1e3, color=MUTED, lw=0.9, label="tops")
    ax.plot(across, data.meridian.to_numpy() * -1e3, color=INK, lw=1.2, label="median round the tire")
    if "earlier" in data:
        ax.plot(across, data.earlier.to_numpy() * -1e3, color=SLIP, lw=1.0, label="earlier scan")
    for centre, width, depth in np.asarray(data.attrs.get("grooves", ())).reshape(-1, 3):
        text = f"{width * MM:.1f} × {depth * MM:.1f}"
        ax.annotate(text, (centre * MM, -depth * MM - 3.0), ha="center", va="top", rotation=90, fontsize=8)
    top = -float(np.nanmin(data.earlier)) * MM if "earlier" in data else 0.0
    low = -float(np.nanmax(np.where(data.meridian < 0.03, data.meridian, np.nan))) * MM
    ax.set(xlabel="y (mm)", ylabel="height over the crown (mm)", ylim=(low - 14, top + 2))
    ax.legend(loc="lower center", frameon=False, ncols=3)
    open_axes(ax)
    headline(ax, "Across", "grooves: width × depth, mm")


def _round(ax: Axes, data: xr.Dataset) -> None:
    turn = np.degrees(data.turn.to_numpy())
    ax.plot(turn, data.tops.to_numpy() * -1e3, ".", ms=2, color=STICK)
    ax.set(xlabel="angle from the road (degrees)", ylabel="tops over the crown (mm)", xlim=_seen(data))
    low, high = ax.get_ylim()
    ax.set_ylim(min(low, -0.5), max(high, 0.5))
    open_axes(ax)
    headline(ax, "Round the tire", str(data.attrs["said"]))


def _gap(ax: Axes, data: xr.Dataset) -> None:
    x, y = data.x.to_numpy() * MM, data.y.to_numpy() * MM
    gap = data.initial_gap.to_numpy() * MM
    ax.set_facecolor(_HOLE)
    mesh = ax.pcolormesh(x, y, gap, cmap=sequential("height"), vmin=0, vmax=30, rasterized=True)
    share = float(data.filled.mean())
    if 0 < share < 1:
        ax.contour(x, y, data.filled.to_numpy().astype(float), levels=[0.5], colors=[SLIP], linewidths=0.7)
    figure_of(ax).colorbar(mesh, ax=ax, label="gap to the road (mm)")
    ax.set_aspect("equal")
    ax.set(xlabel="x (mm)", ylabel="y (mm)")
    ax.invert_yaxis()
    outline = f"outlined: {signed(100 * share)} % filled from the rest of the turn".replace("+", "")
    headline(ax, "Over the road", outline if share else "nothing was filled")


def _seen(data: xr.Dataset) -> tuple[float, float]:
    """Angles that have tread, degrees, with room beside them; the whole turn of a scan with tread at its ends."""
    turn = np.degrees(data.turn.to_numpy())[np.isfinite(data.tops.to_numpy())]
    if not turn.size:
        return -180.0, 180.0
    room = 0.05 * float(np.ptp(turn)) + 1.0
    return max(-180.0, float(turn.min()) - room), min(180.0, float(turn.max()) + room)
