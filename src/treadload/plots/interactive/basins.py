"""Deflection basins in a browser: the fit beside what a drop measured, and moduli with their bars along the road."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from treadload.composing import Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.plots.interactive.drawing import figure
from treadload.plots.interactive.theme import Theme, theme_of
from treadload.plots.kit.plan import fields_of

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

_FLAGGED, _REFUSED = 1, 2
_LABELS = {
    "deflection": ("distance from the plate's axis (m)", "deflection, down (µm)", "µm"),
    "slope": ("ahead of the wheels (m)", "slope (µm/m)", "µm/m"),
    "history": ("time (ms)", "deflection, down (µm)", "µm"),
}
# Height of a panel of moduli, pixels, and the gap between two, in parts of all.
_PANEL, _GAP = 150, 0.04


def basin_fit(backcalculation: Source, drop: int, *, theme: str | Theme = "light") -> Figure:
    """Measured readings of a drop and the fitted basin, as a Figure of plotly.

    backcalculation: a Backcalculation or its dataset. drop: its number, from 0. Of a refused drop there is no fit.
    Returns the figure. Raises InputError.
    """
    data, look = _drop_of(backcalculation, drop), theme_of(theme)
    kind = next((kind for kind in _LABELS if f"measured_{kind}" in data), "")
    if not kind:
        raise InputError("this backcalculation holds no measured readings, so that there is nothing to draw")
    across, up, unit = _LABELS[kind]
    measured, fitted = (1e6 * data[f"{name}_{kind}"].to_numpy() for name in ("measured", "fitted"))
    sensors = data["sensor"].to_numpy()
    traces: list[dict[str, Any]] = []
    if kind == "history":
        time = 1e3 * data["history_time"].to_numpy()
        for number, sensor in enumerate(sensors):
            color = look.cases[number % len(look.cases)]
            traces += _pair(time, (measured[number], fitted[number]), color, f"{sensor:g} m", unit)
    else:
        traces += _pair(sensors, (measured, fitted), look.cases[0], "", unit)
    title = f"<b>{_plain(str(data['station'].item()))}</b>, {float(data['plate_load']) / 1e3:.3g} kN: {_state(data)}"
    layout = {
        "height": 360, "margin": {"l": 74, "r": 20, "t": 44, "b": 52}, "showlegend": True,
        "legend": {"orientation": "h", "y": 1.0, "yanchor": "bottom", "x": 1, "xanchor": "right"},
        "xaxis": {"title": {"text": across}},
        "yaxis": {"title": {"text": up}, "autorange": True if kind == "slope" else "reversed"},
        "title": {"text": title, "x": 0.01, "font": {"size": 13}},
    }  # fmt: skip
    return figure(traces, layout, look)


def moduli_profile(backcalculation: Source, drop: int | None = None, *, theme: str | Theme = "light") -> Figure:
    """Moduli of every layer with their 90 % intervals along the road, a panel each, as a Figure of plotly.

    backcalculation: a Backcalculation or its dataset. drop: number of the one that is marked. Hollow: flagged, or
    without an interval. Returns the figure. Raises InputError.
    """
    data, look = fields_of(backcalculation, *_NEEDED), theme_of(theme)
    if drop is not None:
        _drop_of(data, drop)
    places, label = places_of_drops(data)
    names = [str(name) for name in data["layer_name"].to_numpy()]
    good = data["basin_status"].to_numpy() != _REFUSED
    stations = [_plain(str(name)) for name in data["station"].to_numpy()]
    traces: list[dict[str, Any]] = []
    height = (1 + _GAP) / len(names) - _GAP
    layout: dict[str, Any] = {
        "height": _PANEL * len(names) + 90, "margin": {"l": 74, "r": 20, "t": 40, "b": 52}, "showlegend": False,
        "title": {"text": "<b>Moduli along the road</b>, bars: 90 %; hollow: flagged", "x": 0.01,
                  "font": {"size": 13}},
        "xaxis": {"title": {"text": label}, "anchor": f"y{len(names)}" if len(names) > 1 else "y"},
    }  # fmt: skip
    for number, name in enumerate(names):
        axis = "y" if number == 0 else f"y{number + 1}"
        at = data.isel(layer_name=number)
        modulus, low, high = (1e-6 * at[key].to_numpy() for key in ("fitted_modulus", "modulus_low", "modulus_high"))
        barred = np.isfinite(low) & np.isfinite(high)
        solid = barred & (data["basin_status"].to_numpy() != _FLAGGED)
        color, drawn = look.cases[number % len(look.cases)], good & np.isfinite(modulus)
        for chosen, symbol in ((drawn & solid, "circle"), (drawn & ~solid, "circle-open")):
            up, down = (np.where(barred, np.abs(end - modulus), 0.0)[chosen] for end in (high, low))
            traces.append({
                "type": "scatter", "mode": "markers", "x": places[chosen], "y": modulus[chosen], "yaxis": axis,
                "name": _plain(name), "marker": {"size": 6, "symbol": symbol, "color": color},
                "text": [stations[k] for k in np.flatnonzero(chosen)],
                "error_y": {"type": "data", "array": up, "arrayminus": down, "thickness": 1, "width": 0,
                            "color": color},
                "hovertemplate": "%{text}<br>%{y:.4~g} MPa<extra></extra>",
            })  # fmt: skip
        if drop is not None and drawn[drop]:
            traces.append({
                "type": "scatter", "mode": "markers", "x": [places[drop]], "y": [modulus[drop]], "yaxis": axis,
                "name": "here", "hoverinfo": "skip",
                "marker": {"size": 14, "symbol": "circle-open", "color": look.slip, "line": {"width": 3}},
            })  # fmt: skip
        top = 1 - number * (height + _GAP)
        layout["yaxis" if number == 0 else f"yaxis{number + 1}"] = {
            "title": {"text": f"{_plain(name)}<br>(MPa)"}, "type": "log", "range": _range(modulus[drawn]),
            "domain": [max(0.0, top - height), top], "anchor": "x", "nticks": 6, "exponentformat": "none",
        }  # fmt: skip
    return figure(traces, layout, look)


_NEEDED = ("fitted_modulus", "modulus_low", "modulus_high", "basin_status", "drop_position", "station")


def places_of_drops(data: xr.Dataset) -> tuple[Array, str]:
    """Where each drop lies, m, and what the axis counts; drops in their order where a place is missing."""
    along = data["drop_position"].to_numpy()
    if np.isfinite(along).all():
        return along, "along the road (m)"
    return np.arange(1.0, len(along) + 1), "drop, in the order of the file"


def _drop_of(source: Source, drop: int) -> xr.Dataset:
    data = fields_of(source, "basin_status", "basin_misfit", "plate_load")
    count = data.sizes["basin"]
    if not 0 <= drop < count:
        raise InputError(f"there is no drop {drop}; this backcalculation has 0 to {count - 1}")
    return data.isel(basin=drop)


def _pair(x: Array, values: tuple[Array, Array], color: str, name: str, unit: str) -> list[dict[str, object]]:
    """Traces of measured readings as dots and of the fit as a line."""
    measured, fitted = values
    behind = f", {name}" if name else ""
    hover = "%{x:.4~g}: %{y:.4~g} " + unit + "<extra></extra>"
    return [
        {"type": "scatter", "mode": "lines", "x": x, "y": np.where(np.isfinite(fitted), fitted, np.nan),
         "name": f"fitted{behind}", "line": {"color": color, "width": 2}, "hovertemplate": hover},
        {"type": "scatter", "mode": "markers", "x": x, "y": measured, "name": f"measured{behind}",
         "marker": {"color": color, "size": 8}, "hovertemplate": hover, "showlegend": not name},
    ]  # fmt: skip


def _state(data: xr.Dataset) -> str:
    if int(data["basin_status"]) == _REFUSED:
        return "refused"
    flagged = ", flagged" if int(data["basin_status"]) == _FLAGGED else ""
    return f"misfit {100 * float(data['basin_misfit']):.2g} %{flagged}"


def _range(moduli: Array) -> list[float]:
    """Of a logarithmic axis, over the moduli: bars of what is undecided leave the panel."""
    if not len(moduli):
        return [0.0, 4.0]
    low, high = np.quantile(moduli, [0.01, 0.99])
    return [math.log10(low / 2.5), math.log10(high * 2.5)]


def _plain(text: str) -> str:
    """A text of a file, of which plotly would take some as markup."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
