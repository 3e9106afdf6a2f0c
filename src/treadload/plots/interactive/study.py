"""A study at one of its points: how a result responds along an input, and the map of a field that was kept."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from treadload.composing import Source
from treadload.errors import InputError
from treadload.plots.interactive.drawing import figure
from treadload.plots.interactive.theme import Theme, colour_scale, theme_of
from treadload.plots.kit.plan import MM, X_LABEL, Y_LABEL
from treadload.plots.kit.shown import shown
from treadload.plots.sweeps.reading import PLANE, View, beside

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

_SCALES = {"pressure": "pressure", "traction_x": "signed", "traction_y": "signed"}
_TALL, _LEFT, _RIGHT, _ABOVE, _BELOW = 620.0, 62.0, 96.0, 44.0, 50.0


def study_maps(study: Source) -> dict[str, str]:
    """Fields over x and y that a study has kept: name → words."""
    data = View.of(study).data
    return {
        str(name): shown(variable).words
        for name, variable in data.data_vars.items()
        if set(PLANE) <= set(variable.dims)
    }


def study_curve(
    study: Source, name: str, along: str, at: Mapping[str, int], *, theme: str | Theme = "light"
) -> Figure:
    """A result along one input through a point of a study, as a Figure of plotly; the point itself is marked.

    study: a sweep. name: of the result. along: dimension of the study. at: dimension → number of its value; left
    out, the first. Cases that failed are gaps, and crosses at the foot. Returns the figure. Raises InputError.
    """
    view, look = View.of(study), theme_of(theme)
    if along not in view.dims:
        raise InputError(f"a curve goes along a dimension of the study, {', '.join(view.dims)}, got {along!r}")
    field = view.reading(name)
    index = placed(view, at)
    cut = {dim: index.get(dim, 0) for dim in map(str, field.dims) if dim != along}
    line, axis = field.isel(cut).to_numpy(), view.data[along] if along in view.data.coords else None
    how = shown(field, name)
    numeric = axis is not None and axis.dtype.kind in "fiu"
    display = shown(axis, along) if axis is not None else None
    x = (
        axis.to_numpy() * display.factor
        if numeric and axis is not None and display is not None
        else np.arange(len(line))
    )
    values = np.where(np.isfinite(line), line * how.factor, np.nan)
    here = index[along]
    failed = view.failed({dim: number for dim, number in index.items() if dim != along})
    foot = float(np.nanmin(values)) if np.isfinite(values).any() else 0.0
    traces: list[dict[str, Any]] = [
        {"type": "scatter", "mode": "lines+markers", "x": x, "y": values, "name": how.words, "connectgaps": False,
         "line": {"color": look.cases[0], "width": 2}, "marker": {"size": 6}},
        {"type": "scatter", "mode": "markers", "x": [x[here]], "y": [values[here]], "name": "here",
         "marker": {"size": 14, "symbol": "circle-open", "color": look.slip, "line": {"width": 3}}},
        {"type": "scatter", "mode": "markers", "x": x[failed], "y": np.full(int(failed.sum()), foot),
         "name": "failed", "marker": {"size": 9, "symbol": "x", "color": look.muted}},
    ]  # fmt: skip
    what = ", ".join(part for part in (f"<b>{how.words[:1].upper()}{how.words[1:]}</b>", beside(view, field)) if part)
    across: dict[str, Any] = {"title": {"text": display.label if display is not None else along}}
    if axis is not None and not numeric:
        across |= {"tickvals": list(range(len(x))), "ticktext": [str(name) for name in axis.to_numpy()]}
    layout = {
        "height": 330, "margin": {"l": 74, "r": 20, "t": 40, "b": 52}, "showlegend": False, "xaxis": across,
        "yaxis": {"title": {"text": how.label}},
        "title": {"text": what, "x": 0.01, "font": {"size": 13}},
    }  # fmt: skip
    return figure(traces, layout, look)


def study_map(
    study: Source, name: str, at: Mapping[str, int], *, theme: str | Theme = "light", width: float = 900.0
) -> Figure:
    """A field that a study has kept at one of its points, in true scale, as a Figure of plotly.

    study: a sweep. name: of the field. at: dimension → number of its value; left out, the first. width: pixels. The
    colours are the same at every point. Returns the figure. Raises InputError.
    """
    view, look = View.of(study), theme_of(theme)
    field = view.reading(name)
    if not set(PLANE) <= set(field.dims):
        raise InputError(f"{name} is no map; the study has kept {', '.join(study_maps(study)) or 'none'}")
    index = placed(view, at)
    how = shown(field, name)
    cut = {dim: index.get(dim, 0) for dim in map(str, field.dims) if dim not in PLANE}
    values = field.isel(cut).transpose(*PLANE).to_numpy() * how.factor
    scaled = field.to_numpy() * how.factor
    finite = scaled[np.isfinite(scaled)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    signed = low < 0 < high
    if signed:
        low, high = -max(-low, high), max(-low, high)
    if name == "pressure":
        low, values = 0.0, np.where(values > 0, values, np.nan)
    x, y = (MM * view.data[dim].to_numpy() for dim in ("x", "y"))
    tall = min(_TALL, (width - _LEFT - _RIGHT) * float(np.ptp(y)) / max(float(np.ptp(x)), 1e-9))
    kind = "signed" if signed else _SCALES.get(name, "strain")
    trace = {
        "type": "heatmap", "x": x, "y": y, "z": values.astype(np.float32), "zmin": low, "zmax": high,
        "colorscale": colour_scale(kind, look.name), "hoverongaps": False,
        "colorbar": {"title": {"text": how.unit}, "thickness": 11, "outlinecolor": look.rule},
        "hovertemplate": "x %{x:.1f} mm, y %{y:.1f} mm<br>%{z:.4~g} " + how.unit + "<extra></extra>",
    }  # fmt: skip
    layout = {
        "height": round(max(200.0, tall) + _ABOVE + _BELOW),
        "margin": {"l": _LEFT, "r": _RIGHT, "t": _ABOVE, "b": _BELOW},
        "title": {"text": f"<b>{how.words[:1].upper()}{how.words[1:]}</b>", "x": 0.01, "font": {"size": 13}},
        "xaxis": {"title": {"text": X_LABEL}, "constrain": "domain", "range": [float(x.min()), float(x.max())]},
        "yaxis": {"title": {"text": Y_LABEL}, "range": [float(y.max()), float(y.min())], "scaleanchor": "x",
                  "scaleratio": 1},
    }  # fmt: skip
    return figure([trace], layout, look)


def placed(view: View, at: Mapping[str, int]) -> dict[str, int]:
    """A point of a study, a number for each of its dimensions. Raises InputError for one that it has not."""
    sizes = {dim: view.data["status"].sizes[dim] for dim in view.dims}
    for dim, number in at.items():
        if dim not in sizes or not 0 <= int(number) < sizes[dim]:
            choices = ", ".join(f"{dim} 0 to {size - 1}" for dim, size in sizes.items())
            raise InputError(f"the study has no value {number} of {dim}; it has {choices}")
    return {dim: int(at.get(dim, 0)) for dim in view.dims}
