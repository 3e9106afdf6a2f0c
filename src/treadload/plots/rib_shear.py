"""Shear of a footprint rib by rib: thirds of ribs, computed and measured."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.figure_registry import figure
from treadload.footprint.thirds import THIRDS
from treadload.kernels.arrays import Array
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, INK, MUTED, RULE, headline, open_axes, styled

_NEEDED = ("third_load", "third_force_x", "third_force_y")
_PANELS = (
    ("third_force_y", "Lateral shear", "to the right"),
    ("third_force_x", "Longitudinal shear", "along travel"),
)
_SPREAD = 0.22


@figure(
    "FootprintComparison", name="shear", title="Shear rib by rib", wide=True,
    caption="Force of the tire on the road on the thirds of each rib, over a third of the load on the rib. Lines: "
    "all cells; circles: what the sensor would read of them; squares: what it read.",
    when=lambda data: "third_load" in data,
)  # fmt: skip
@styled
def rib_shear(comparison: Source) -> Figure:
    """Lateral and longitudinal shear of the thirds of each rib over the rib's pressure, computed and measured.

    comparison: a FootprintComparison or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> pressure = [[0] * 4 + [6e5] * 8 + [0] * 4] * 16
    >>> shear = [[0] * 4 + [6e4] * 8 + [0] * 4] * 16
    >>> load = tl.response.GridLoad.from_arrays(pressure, shear, shear, spacing=0.01)
    >>> comparison = tl.compare(load, tl.Footprint(load), registration="none")
    >>> [ax.get_title(loc="left") for ax in tl.plots.rib_shear(comparison).axes]
    ['Lateral shear', 'Longitudinal shear']
    """
    data = fields_of(comparison, *_NEEDED)
    figure = new_figure(9.4, 5.6)
    panels: list[Axes] = list(figure.subplots(2, 1, sharex=True))
    ribs = data.sizes["rib"]
    for ax, (name, title, way) in zip(panels, _PANELS, strict=True):
        for rib in range(1, ribs):
            ax.axvline(len(THIRDS) * rib - 0.5, color=RULE, lw=0.8)
        ax.axhline(0, color=MUTED, lw=0.8)
        computed, seen, measured = (_ratios(data, name, which) for which in ("computed", "seen", "measured"))
        for rib in range(ribs):
            places = len(THIRDS) * rib + np.arange(len(THIRDS))
            edges = np.concatenate([places - 0.5, places[-1:] + 0.5])
            ax.stairs(computed[rib], edges, baseline=None, color=INK, lw=1.4, label="computed" if rib == 0 else None)
            for values, shift, marker, colour, words in (
                (seen, -_SPREAD, "o", CASES[0], "computed, through the sensor"),
                (measured, _SPREAD, "s", CASES[1], "measured"),
            ):
                label = words if rib == 0 and np.isfinite(values).any() else None
                ax.plot(places + shift, values[rib], ls="", marker=marker, ms=5.5, color=colour, label=label)
        ax.set_ylabel("over the pressure (–)")
        headline(ax, title, f"positive {way}")
        open_axes(ax)
    panels[1].set_xticks(np.arange(len(THIRDS) * ribs), [name[0].upper() for _ in range(ribs) for name in THIRDS])
    for rib in range(ribs):
        panels[1].annotate(
            f"rib {rib + 1}", (len(THIRDS) * rib + 1, 0), xycoords=("data", "axes fraction"), xytext=(0, -26),
            textcoords="offset points", ha="center",
        )  # fmt: skip
    panels[1].set_xlabel("left, middle and right third of each rib, from the left of travel", labelpad=18)
    panels[1].set_xlim(-0.6, len(THIRDS) * ribs - 0.4)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def _ratios(data: xr.Dataset, name: str, which: str) -> Array:
    """(ribs, 3) force on thirds over the mean load of a third of the rib."""
    at = data.sel(map=which)
    load = at["third_load"].mean("third", skipna=True)
    return np.asarray((at[name] / load.where(load > 0)).transpose("rib", "third").to_numpy(), dtype=float)
