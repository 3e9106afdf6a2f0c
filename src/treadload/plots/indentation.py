"""A body pressed into a road that yields: pressure under it, and the dent that it leaves."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from treadload.composing import Source
from treadload.figure_registry import figure
from treadload.plots.kit.figure import new_figure
from treadload.plots.kit.plan import MM, fields_of
from treadload.plots.kit.style import MUTED, headline, measure, sequential, styled

# Steps that one figure tells apart.
_SHOWN = 6


@figure(
    "Indentation", name="dent", main=True, title="Pressure and dent", wide=True,
    caption="Pressure under the body, and what the surface keeps of it, step by step.",
)  # fmt: skip
@styled
def indentation(result: Source) -> Figure:
    """Pressure and dent on the line along x through the middle, step by step.

    result: with pressure (Pa) and residual_displacement_z (m) over (step, y, x). Returns the figure.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(3e6, kinematic=60e6))
    >>> steel = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(210e9, 0.3))
    >>> road, cells = tl.Pavement.half_space(yielding), {"spacing": 0.002, "depth": 0.009, "layers": 3}
    >>> result = tl.contact.solve_indentation(steel, road, [150.0], **cells)
    >>> [ax.get_ylabel() for ax in tl.plots.indentation(result).axes]
    ['pressure (MPa)', 'dent, down (µm)']
    """
    data = fields_of(result, "pressure", "residual_displacement_z", "normal_load", "step", "y", "x")
    line = data.isel(y=data.sizes["y"] // 2)
    rows = sorted({round(row) for row in np.linspace(0, data.sizes["step"] - 1, min(data.sizes["step"], _SHOWN))})
    shades = sequential("strain")(np.linspace(0.25, 0.85, len(rows)))
    figure = new_figure(8.4, 5.4)
    above, below = figure.subplots(2, 1, sharex=True)
    x, loads = data["x"].to_numpy() * MM, data["normal_load"].to_numpy()
    for row, shade in zip(rows, shades, strict=True):
        above.plot(x, line["pressure"][row] * 1e-6, color=shade, label=f"{row + 1}: {measure(float(loads[row]))} N")
        below.plot(x, line["residual_displacement_z"][row] * 1e6, color=shade)
    below.axhline(0, color=MUTED, lw=0.7)
    below.invert_yaxis()
    below.set_xlabel("x, along travel (mm)")
    above.set_ylabel("pressure (MPa)")
    below.set_ylabel("dent, down (µm)")
    for ax in (above, below):
        ax.grid(True)
    above.legend(title="step: load")
    deepest = float(data["residual_displacement_z"].max()) * 1e6
    headline(above, "Indentation", f"dent of {measure(deepest)} µm; {data.attrs.get('law', '')}")
    return figure
