"""What uniform loads miss: largest strains over depth, under the computed contact and under uniform loads."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import fields_of
from treadload.plots.kit.style import CASES, headline, styled

_PANELS = {
    "largest_extension": "Largest tensile strain",
    "largest_in_plane_extension": "Largest horizontal tensile strain",
    "largest_vertical_shear": "Largest vertical shear strain",
}


@figure(
    "UniformComparison", name="strains", main=True, title="What uniform loads miss", wide=True,
    caption="Largest strains at every depth under the computed contact and under uniform loads of the same force.",
)  # fmt: skip
@styled
def uniform_comparison(comparison: Source) -> Figure:
    """Three panels of the largest strain at each depth, a line for each load.

    comparison: a UniformComparison or its dataset. Returns the figure. Raises InputError if variables are missing.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> comparison = tl.damage.compare_uniform(contact, road, depths=[0.0, 0.05], pressure=1.5e5, mean_over=None)
    >>> figure = tl.plots.uniform_comparison(comparison)
    >>> [len(ax.lines) for ax in figure.axes[:3]]  # the computed contact, the disc and the rectangle
    [3, 3, 3]
    """
    data = fields_of(comparison, *_PANELS)
    depths = 1e3 * np.asarray(data["depth"].to_numpy())
    figure = new_figure(9.6, 4.4)
    axes = figure.subplots(1, len(_PANELS), sharey=True)
    for ax, (name, title) in zip(axes, _PANELS.items(), strict=True):
        for number, load in enumerate(data["load"].to_numpy()):
            values = 1e6 * data[name].sel(load=load).to_numpy()
            style = "o-" if number == 0 else "s--"
            ax.plot(values, depths, style, ms=3.5, color=CASES[number % len(CASES)], label=str(load))
        ax.grid(True)
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_xlabel("microstrain")
        headline(ax, title, letters=26)
    axes[0].set_ylabel("depth (mm)")
    axes[0].set_ylim(1.03 * depths.max(), -0.03 * depths.max())
    axes[0].legend(loc="lower right")
    return figure
