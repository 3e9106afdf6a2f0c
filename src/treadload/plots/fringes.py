"""A measurement with fringes, as the camera's pixels show it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MM, Limits, colour_bar, fields_of
from treadload.plots.kit.style import headline, measure, named_map, sequential, styled

# Share of the pixels whose heights and deviations the colours cover; the rest stands at walls.
_MOST = (0.002, 0.998)
_PANEL = 3.7
# What was given up: a grey that no palette has, since their low ends are white.
_GIVEN_UP = "#c9cfd6"


@styled
def fringe_scan(pixels: Source) -> Figure:
    """Modulation, phase, height and its deviation in the picture of the camera; what was given up is grey.

    pixels: `FringeScan.pixels`, with fringe_modulation, fringe_phase, fringe_height and fringe_deviation over (row,
    column). Returns the figure.

    >>> import numpy as np
    >>> import xarray as xr
    >>> names = ("fringe_modulation", "fringe_phase", "fringe_height", "fringe_deviation")
    >>> pixels = xr.Dataset({name: (("row", "column"), np.full((4, 6), 1e-3)) for name in names})
    >>> pixels = pixels.assign_coords(row=range(4), column=range(6))
    >>> [ax.get_title(loc="left") for ax in tl.plots.fringe_scan(pixels).axes[:4]]
    ['Modulation', 'Phase, unwrapped', 'Height', 'Deviation by noise']
    """
    names = ("fringe_modulation", "fringe_phase", "fringe_height", "fringe_deviation")
    data = fields_of(pixels, *names)
    modulation, phase, height, deviation = (data[name].transpose("row", "column").to_numpy() for name in names)
    rows, columns = height.shape
    figure = new_figure(2 * _PANEL + 1.6, 2 * (_PANEL * min(rows / columns, 1.4) + 0.75))
    axes = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    least = float(data.attrs.get("least_modulation", 0.0))
    kept = float(np.isfinite(height).mean())
    top = Limits(0.0, float(np.nanmax(modulation)) or 1.0)
    finite = np.isfinite(phase)
    turns = phase / (2 * np.pi)
    count = f"{np.nanmin(turns):.1f} to {np.nanmax(turns):.1f} fringes" if finite.any() else "none known"
    noise = deviation[np.isfinite(deviation)]
    middle = f"median {np.median(noise) * 1e6:.3g} µm" if noise.size else "noise unknown"
    dim = np.where(modulation >= least, modulation, np.nan)
    panels = (
        (dim, sequential("pressure"), top, "grey levels", "Modulation", f"grey: below {measure(least)}, shadow"),
        (turns, named_map("viridis"), _limits(turns), "fringes", "Phase, unwrapped", count),
        (height * MM, sequential("height"), _limits(height * MM), "mm", "Height", f"{kept:.1%} of the pixels kept"),
        (deviation * 1e6, sequential("strain"), _limits(deviation * 1e6, 0.0), "µm", "Deviation by noise", middle),
    )
    for ax, (values, colours, scale, unit, title, details) in zip(axes, panels, strict=True):
        ax.set_facecolor(_GIVEN_UP)
        image = ax.imshow(values, cmap=colours, vmin=scale.low, vmax=scale.high, interpolation="nearest")
        colour_bar(image, ax, unit, scale)
        headline(ax, title, details, 34)
    for ax in axes[2:]:
        ax.set_xlabel("column of the picture")
    for ax in axes[::2]:
        ax.set_ylabel("row")
    return figure


def _limits(values: np.ndarray, low: float | None = None) -> Limits:
    """A scale that covers all but what stands at walls."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return Limits(0.0, 1.0)
    ends = np.quantile(finite, _MOST)
    bottom = float(ends[0]) if low is None else low
    high = max(float(ends[1]), bottom + 1e-9)
    return Limits(bottom, high, bool(finite.max() > high))
