"""The tread in space with the pressure on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from treadload.composing import Source
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.plots.interactive.drawing import figure
from treadload.plots.interactive.theme import Theme, colour_scale, theme_of
from treadload.plots.kit.plan import KPA, MM, X_LABEL, Y_LABEL, Plan, fields_of, limits, plane
from treadload.plots.kit.style import measure

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

# Points along each side of the surface that a browser turns without lagging.
_MOST_POINTS = 240
# Height of the box over its longer side: relief of a few millimetres would not be seen at true scale.
_HIGH = 0.22
# What is deeper than this share of the relief is cut off: what stands far from the road.
_SHOWN = 0.98
_BARE = 2e-3


def tread(contact: Source, *, theme: str | Theme = "light", height: float = 520.0) -> Figure:
    """The tread before loading, turned up, with the contact pressure in colour, as a Figure of plotly.

    contact: with initial_gap (y, x), m, NaN where there is no tread, and pressure, Pa. x and y in true
    scale, the relief exaggerated by the factor in the title. Returns the figure. Raises InputError without the tread.
    """
    look = theme_of(theme)
    data = fields_of(contact, "initial_gap", "pressure")
    step = max(1, -(-max(data.sizes["x"], data.sizes["y"]) // _MOST_POINTS))
    data = data.isel(x=slice(None, None, step), y=slice(None, None, step))
    plan, pressure = Plan.of(data), np.nan_to_num(plane(data, "pressure") * KPA)
    relief: Array = -plane(data, "initial_gap") * MM
    finite = relief[np.isfinite(relief)]
    if not finite.size:
        raise InputError("this contact has no tread to draw: its initial gap is unknown everywhere")
    low = max(float(np.quantile(finite, 1 - _SHOWN)), _lowest_touched(relief, pressure) * 1.5)
    relief = np.where(relief >= low, relief, np.nan)
    scale = limits(pressure)
    steps = colour_scale("pressure", look.name)
    colours = [[0.0, look.rubber], [_BARE, look.rubber], *([max(share, _BARE), colour] for share, colour in steps)]
    span = float(max(np.ptp(plan.x), np.ptp(plan.y)))
    deep = float(np.nanmax(relief) - np.nanmin(relief)) or 1.0
    times = _HIGH * span / deep
    surface = {
        "type": "surface", "x": plan.x, "y": plan.y, "z": relief.astype(np.float32),
        "surfacecolor": pressure.astype(np.float32), "cmin": 0.0, "cmax": scale.high, "colorscale": colours,
        "colorbar": {"title": {"text": "contact pressure (kPa)", "side": "right"}, "thickness": 12, "len": 0.7,
                     "outlinecolor": look.rule},
        "lighting": {"ambient": 0.72, "diffuse": 0.55, "specular": 0.05, "roughness": 0.9},
        "customdata": pressure.astype(np.float32), "connectgaps": False,
        "hovertemplate": "x %{x:.1f} mm, y %{y:.1f} mm<br>%{customdata:.4~g} kPa<extra></extra>",
        "name": "tread",
    }  # fmt: skip
    layout = {
        "height": height, "margin": {"l": 0, "r": 0, "t": 36, "b": 0}, "uirevision": "tread",
        "title": {"text": f"<b>Tread turned up, pressure on it</b>; relief {measure(times)} times higher than it is",
                  "x": 0.01, "font": {"size": 13}},
        "scene": {
            "xaxis": {"title": {"text": X_LABEL}}, "yaxis": {"title": {"text": Y_LABEL}},
            "zaxis": {"title": {"text": "relief (mm)"}, "nticks": 4},
            "aspectmode": "manual",
            "aspectratio": {"x": float(np.ptp(plan.x)) / span, "y": float(np.ptp(plan.y)) / span, "z": _HIGH},
            "camera": {"eye": {"x": -0.75, "y": -1.05, "z": 0.8}}, "dragmode": "orbit",
        },
    }  # fmt: skip
    return figure([surface], layout, look)


def _lowest_touched(relief: Array, pressure: Array) -> float:
    touched = relief[np.isfinite(relief) & (pressure > 0)]
    return float(touched.min()) if touched.size else -np.inf
