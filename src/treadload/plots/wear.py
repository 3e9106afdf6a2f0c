"""What was worn off a tread since an earlier scan: unrolled, and across beside the tread then and now."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MM, fields_of
from treadload.plots.kit.style import INK, SLIP, STICK, figure_of, headline, open_axes, sequential, styled

_NOTHING = "#f3c9b0"


@figure(
    "Wear", name="wear", main=True, title="Worn off since the earlier scan", wide=True,
    caption="Unrolled from the place over the road; across: the tread then and now, and the median wear.",
)  # fmt: skip
@styled
def tread_wear(wear: Source) -> Figure:
    """Wear unrolled over the turn; right, across: its median, and the tread then and now.

    wear: with tread_wear (across, wheel_angle), its median, and tread_height and earlier_tread_height (across), m.
    Returns the figure.

    >>> import numpy as np
    >>> import xarray as xr
    >>> across, angle = np.linspace(-0.1, 0.1, 5), np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    >>> fields = {"tread_wear": (("across", "wheel_angle"), np.full((5, 8), 2e-3))}
    >>> heights = {"median_tread_wear": 2e-3, "tread_height": -2e-3, "earlier_tread_height": 0.0}
    >>> fields |= {name: ("across", np.full(5, height)) for name, height in heights.items()}
    >>> wear = xr.Dataset(fields, {"across": across, "wheel_angle": angle})
    >>> [ax.get_xlabel() for ax in tl.plots.tread_wear(wear).axes[:2]]
    ['angle from the road (degrees)', 'y (mm)']
    """
    names = ("tread_wear", "median_tread_wear", "tread_height", "earlier_tread_height")
    data = fields_of(wear, *names)
    worn, median, now, then = (data[name].to_numpy() * MM for name in names)
    across, turn = data["across"].to_numpy() * MM, np.degrees(data["wheel_angle"].to_numpy())
    figure = new_figure(11.0, 4.6)
    unrolled, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    _unrolled(unrolled, turn, across, worn)
    _across(right, across, now, then)
    mean = float(np.nanmean(median))
    headline(right, "Across", f"worn off the ribs {mean:.2f} mm on average; below: the wear, right scale")
    beside = right.twinx()
    low, high = wear_range(worn)
    beside.plot(across, median, color=STICK, lw=1.4)
    # The wear keeps to the lower third, below the treads.
    beside.set_ylim(low, low + 3 * (high - low))
    beside.set_ylabel("worn off (mm)", color=STICK, loc="bottom")
    beside.tick_params(axis="y", colors=STICK)
    beside.set_yticks(np.linspace(low, high, 3).round(2))
    beside.spines[["top", "left"]].set_visible(False)
    return figure


def _unrolled(ax: Axes, turn: Array, across: Array, worn: Array) -> None:
    ax.set_facecolor(_NOTHING)
    low, high = wear_range(worn)
    seen = turn[np.isfinite(worn).any(axis=0)]
    mesh = ax.pcolormesh(turn, across, worn, cmap=sequential("height"), vmin=low, vmax=high, rasterized=True)
    figure_of(ax).colorbar(mesh, ax=ax, label="worn off (mm)")
    ax.set(xlabel="angle from the road (degrees)", ylabel="y (mm)", xlim=(seen.min() - 2, seen.max() + 2))
    # As on the plans of contacts: the right of travel is below.
    ax.invert_yaxis()
    headline(ax, "Worn off since the earlier scan", "shaded: grooves, or nothing scanned")


def _across(ax: Axes, across: Array, now: Array, then: Array) -> None:
    ax.plot(across, then, color=SLIP, lw=1.1, label="then")
    ax.plot(across, now, color=INK, lw=1.2, label="now")
    tread = np.isfinite(then) & (then > -30)
    low, high = float(np.nanmin(now[tread])), float(np.nanmax(then[tread]))
    ax.set(
        xlabel="y (mm)",
        ylabel="height over the crown (mm)",
        ylim=(low - 0.75 * (high - low), high + 0.2 * (high - low)),
    )
    ax.legend(loc="upper center", frameon=False, ncols=2)
    open_axes(ax)


def wear_range(worn: Array) -> tuple[float, float]:
    """Where the wear, mm, lies, single points aside; a millimetre wide or more, so that noise is seen as such."""
    finite = worn[np.isfinite(worn)]
    low, high = np.quantile(finite, [0.02, 0.98]) if finite.size else (0.0, 1.0)
    wide = max(float(high - low), 1.0)
    middle = 0.5 * float(low + high)
    return middle - 0.5 * wide, middle + 0.5 * wide
